//! Steps by accuracy end where forces jump or have kinks with what moves: stops, ropes, friction, and what formulas say of places and rates. The
//! truths are closed forms.

mod common;

use common::model;
use holonom::record::{Constraints, Recorder};
use holonom::simulation::{Choice, Method, Simulation, Status};

const METHODS: [&str; 6] = ["conserving-ggl", "conserving", "generalized-alpha", "radau", "ggl/bdf", "ode/dopri5"];

/// The last row of some columns.
fn last<const N: usize>(text: &str, method: &str, accuracy: f64, step: f64, end: f64, names: [&str; N]) -> [f64; N] {
    let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
    let (simulation, recording) = common::run(&model(text), choice, step, end);
    assert_eq!(simulation.state().t, end, "{method}, step {step}");
    let row = recording.rows() - 1;
    names.map(|name| recording.column(name).unwrap_or_else(|| panic!("{name} is recorded"))[row])
}

/// A block of 1 kg on a rail, from `place` with the velocity `speed`.
fn block(place: f64, speed: f64, force: &str) -> String {
    format!(
        "plane = \"xy\"\ngravity = [0, 0]\n[body.b]\nmass = 1\ninertia = 0.01\nposition = [{place}, 0]\nvelocity = [{speed}, 0]\n\
         [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"b\"]\naxis = [1, 0]\n[force.f]\n{force}\n"
    )
}

/// Stiff stops and ropes, in their own units all the same motion: steps end where they touch and where they let go, and the error at the end is
/// within ten times of what was asked for, also after as short a contact as 30 µs.
#[test]
fn contacts_are_landed_on() {
    let stop = "plane = \"xy\"\ngravity = [0, 0]\n[body.block]\nmass = 1\ninertia = 0.01\nposition = [-0.5, 0]\nvelocity = [1, 0]\n\
                [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\naxis = [1, 0]\n\
                [force.stop]\ntype = \"stop\"\njoint = \"rail\"\nupper = 0.5\nstiffness = K\n";
    let rope = "plane = \"xy\"\ngravity = [0, 0]\n[point.block]\nmass = 1\nposition = [0.5, 0]\nvelocity = [1, 0]\n\
                [point.hook]\nposition = [0, 0]\nfixed = true\n\
                [force.rope]\ntype = \"rope\"\nbetween = [\"hook\", \"block\"]\nlength = 1.0\nstiffness = K\n";
    // In contact for half a swing, from half a second on; then back with the speed that it came with.
    let at = |k: f64| -(0.5 - std::f64::consts::PI / k.sqrt());
    let methods = [("radau", 1e-9), ("ggl/bdf", 1e-7), ("conserving-ggl", 1e-6), ("generalized-alpha", 1e-6), ("ode/dopri5", 1e-8)];
    for (text, touch) in [(stop, 0.0), (rope, 1.0)] {
        for stiffness in [1e4, 1e7, 1e10] {
            let text = text.replace('K', &stiffness.to_string());
            for (method, accuracy) in methods {
                for step in [1.0, 0.03] {
                    let [place] = last(&text, method, accuracy, step, 1.0, ["block.x"]);
                    let off = (place - touch - at(stiffness)).abs();
                    assert!(off <= 10.0 * accuracy, "{method}, {stiffness:e} N/m, touching at {touch} m, step {step}: off by {off:e} m");
                }
            }
        }
    }
}

/// How far a block is beyond a stop at a time: a damped spring pulls it from rest, 0.1 m away, to where it just touches the stop. On both sides it
/// swings about that place, with `k` without the stop and with `stiff` in contact, and half swings follow each other.
fn settling(t: f64, [k, stiff, damping]: [f64; 3]) -> f64 {
    let decay = damping / 2.0;
    let rate = |k: f64| (k - decay * decay).sqrt();
    let free = rate(k);
    let touch = (std::f64::consts::PI - (free / decay).atan()) / free;
    if t < touch {
        return -0.1 * (-decay * t).exp() * ((free * t).cos() + decay / free * (free * t).sin());
    }
    let (mut speed, mut left) = (0.1 * (free + decay * decay / free) * (-decay * touch).exp() * (free * touch).sin(), t - touch);
    for side in [rate(k + stiff), free].into_iter().cycle() {
        let half = std::f64::consts::PI / side;
        if left < half {
            return speed / side * (-decay * left).exp() * (side * left).sin();
        }
        (speed, left) = (-speed * (-decay * half).exp(), left - half);
    }
    unreachable!("there are swings without end")
}

/// What settles at a stop touches it more and more lightly. A step of an explicit method in which only a stage inside of it is in contact is turned back by
/// the stop before it comes there, and hardly anything of that is in the estimate of its error: it is taken again. Motions were off by up to 300 times of
/// what was asked for.
#[test]
fn what_settles_at_a_stop_is_not_kicked_away() {
    for (k, stiff, damping) in [(4000.0, 2e6, 30.0), (4900.0, 2e6, 28.0)] {
        for metre in [1.0, 1e3] {
            let text = format!(
                "plane = \"xy\"\ngravity = [0, 0]\n[body.b]\nmass = 1\ninertia = {}\nposition = [{}, 0]\n\
                 [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"b\"]\naxis = [1, 0]\n\
                 [force.pull]\ntype = \"torsion\"\njoint = \"rail\"\nstiffness = {k}\nangle = {}\ndamping = {damping}\n\
                 [force.stop]\ntype = \"stop\"\njoint = \"rail\"\nupper = {}\nstiffness = {stiff}\n",
                metre * metre,
                -0.1 * metre,
                0.1 * metre,
                0.1 * metre,
            );
            let model = model(&text);
            for (method, accuracy) in ["ode/dopri5", "ode/dop853"].iter().flat_map(|method| [1e-5, 1e-6, 1e-7].map(|a| (method, a))) {
                let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
                let (_, recording) = common::run(&model, choice, 0.01, 1.0);
                let rows = recording.column("t").unwrap().iter().zip(recording.column("b.x").unwrap());
                let off = rows.map(|(t, x)| (x / metre - settling(*t, [k, stiff, damping])).abs()).fold(0.0, f64::max);
                assert!(off <= accuracy, "{method}, {accuracy:e}, {metre} m: off by {off:e}");
            }
        }
    }
}

/// A strip of 2 cm in which 100 N brake 1 kg, narrower than steps are long and reached at a nominal time: 2 J are gone behind it, whatever says
/// so, a force on a body, an effort along the rail, or the tension of a spring.
#[test]
fn loads_in_narrow_strips_are_seen() {
    let forces = [
        "type = \"force\"\nbody = \"b\"\nforce = [\"-100*(step(x - 1) - step(x - 1.02))\", 0]",
        "type = \"effort\"\njoint = \"rail\"\neffort = \"-100*(step(q - 1) - step(q - 1.02))\"",
        "type = \"spring\"\nbetween = [[-1, 0], \"b\"]\nforce = \"100*(step(length - 2) - step(length - 2.02))\"",
        "type = \"effort\"\njoint = \"rail\"\neffort = \"-50*(sign(q - 1) - sign(q - 1.02))\"",
    ];
    let slow = 21.0_f64.sqrt();
    let inside = (5.0 - slow) / 100.0;
    let end = 1.02 + slow * (1.0 - 0.2 - inside);
    for force in forces {
        let text = block(0.0, 5.0, force);
        for method in METHODS {
            for step in [0.005, 0.1, 1.0] {
                let [place, speed, work] = last(&text, method, 1e-6, step, 1.0, ["b.x", "b.vx", "work"]);
                let off = (place - end).abs().max((speed - slow).abs() / 5.0);
                assert!(off < 1e-5, "{method}, step {step}, {force}: {place} for {end} m, {speed} for {slow} m/s");
                assert!((work + 2.0).abs() < 1e-4, "{method}, step {step}, {force}: work {work}");
            }
        }
    }
}

/// Two links that swing, and a moment that lets go where the second passes an angle: what has gone on to get behind the jump has the velocities and the
/// energy that belong there, so that steps become no shorter.
#[test]
fn a_moment_that_lets_go_of_a_linkage_is_passed() {
    for angle in [0.1, 0.2, 0.35, 0.5] {
        let text = format!(
            "plane = \"xz\"\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n[body.b]\nmass = 0.5\ninertia = 0.05\nposition = [1.4, 0]\n\
             [joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
             [joint.k]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n\
             [force.e]\ntype = \"effort\"\njoint = \"k\"\neffort = \"-10*step(q - {angle})\"\n"
        );
        let names = ["a.x", "a.z", "b.x", "b.z"];
        let expected = last(&text, "ode/dop853", 1e-10, 0.05, 1.0, names);
        for accuracy in [1e-6, 1e-7, 1e-9] {
            let found = last(&text, "radau", accuracy, 0.05, 1.0, names);
            let off = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max);
            assert!(off <= 20.0 * accuracy, "{angle} rad, accuracy {accuracy:e}: off by {off:e} m");
        }
    }
}

/// A ball thrown up against a ceiling a hair below where it would turn: it is in touch for 9 ms of steps that are half a second long.
#[test]
fn a_touch_within_a_step_is_seen() {
    let (speed, g, share) = (10.0_f64, 9.81, 1e-4);
    let height = speed * speed / (2.0 * g) * (1.0 - share);
    let text = block(0.0, speed, &format!("type = \"stop\"\njoint = \"rail\"\nupper = {height}\nstiffness = 1e7"))
        .replace("gravity = [0, 0]", &format!("gravity = [{}, 0]", -g));
    // In touch: p = g/ω² (cos ωs − 1) + v/ω sin ωs, from the speed v that is left; then down with that speed.
    let (omega, left) = (1e7_f64.sqrt(), speed * share.sqrt());
    let touch = 2.0 * (left * omega / g).atan() / omega;
    let fall = 2.0 - (speed - left) / g - touch;
    let end = height - left * fall - 0.5 * g * fall * fall;
    for method in METHODS {
        for step in [0.01, 0.5, 2.0] {
            let [place] = last(&text, method, 1e-6, step, 2.0, ["b.x"]);
            assert!((place - end).abs() < 1e-5, "{method}, step {step}: {place} for {end} m");
        }
    }
}

/// Friction stops a block in a tenth of a second, at a time at which steps end, with nothing that bends before it: the way is v²/2a, and what it
/// creeps at the end.
#[test]
fn friction_stops_where_it_should() {
    for creep in [1e-2, 1e-4] {
        let text = block(0.0, 1.0, &format!("type = \"friction\"\njoint = \"rail\"\neffort = 10\nspeed = {creep}"));
        // ∫ v dv / (10 tanh(v/c)) = 0.05 + c² π²/120 but for exp(−2/c).
        let end = 0.05 + creep * creep * std::f64::consts::PI.powi(2) / 120.0;
        for method in METHODS {
            for step in [0.02, 0.25, 0.5] {
                let [place] = last(&text, method, 1e-7, step, 0.5, ["b.x"]);
                assert!((place - end).abs() < 1e-6, "{method}, {creep} m/s, step {step}: {place} for {end} m");
            }
        }
    }
}

/// A spring that pulls with the same force on either side: a quarter of a period is v/a, over and over, and steps grow again between.
#[test]
fn jumps_are_passed_over_and_over() {
    let text = block(0.0, 1.0, "type = \"effort\"\njoint = \"rail\"\neffort = \"-sign(q - 0.3)\"");
    // From 0.3 m with √1.6 m/s, half a period of 2 √1.6 s, sixteen times.
    let fast = 1.6_f64.sqrt();
    let since: f64 = 20.0 - (fast - 1.0);
    let (half, sides) = (since.rem_euclid(2.0 * fast), (since / (2.0 * fast)).floor());
    let end = 0.3 + if sides % 2.0 == 0.0 { 1.0 } else { -1.0 } * (fast * half - 0.5 * half * half);
    for method in METHODS {
        let choice = Choice { accuracy: Some(1e-6), ..Choice::default().named(method) };
        let (simulation, recording) = common::run(&model(&text), choice, 0.1, 20.0);
        let place = recording.column("b.x").unwrap()[recording.rows() - 1];
        assert!((place - end).abs() < 1e-5, "{method}: {place} for {end} m");
        let taken = simulation.audit().work_summary(simulation.steps()).steps_taken;
        assert!(taken < 4000, "{method}: {taken} steps");
    }
}

/// BDF's steps grow again behind a force that jumps at a place, wherever that lies between the times that steps end at, also where what follows
/// is a step so short that the place is still rounded to that of the jump. From 0.2 m, with what a spring leaves of 1 m/s, a damper stops the block, and the spring brings it back.
#[test]
fn steps_of_bdf_grow_behind_a_jump() {
    let spring = "type = \"torsion\"\njoint = \"rail\"\nstiffness = 10\n[force.d]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"-20*step(q - 0.2)*q_rate\"";
    let text = block(0.0, 1.0, spring);
    let [place] = last(&text, "radau", 1e-9, 3.0, 3.0, ["b.x"]);
    for (method, most) in [("ggl/bdf", 2000), ("lagrange-3/bdf", 2000), ("ode/bdf", 2000), ("ggl/bdf-3", 10_000)] {
        for (accuracy, step) in [(1e-6, 1.1), (1e-6, 0.37), (1e-6, 0.3), (10_f64.powf(-4.5), 0.3), (10_f64.powf(-5.5), 0.3)] {
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
            let (simulation, recording) = common::run(&model(&text), choice, step, 3.0);
            let found = recording.column("b.x").unwrap()[recording.rows() - 1];
            assert!((found - place).abs() < 10.0 * accuracy, "{method}, {accuracy:e}, step {step}: {found} for {place} m");
            let taken = simulation.audit().work_summary(simulation.steps()).steps_taken;
            assert!(taken < most, "{method}, {accuracy:e}, step {step}: {taken} steps");
        }
    }
}

/// The same behind a damped rope that gets taut at once at the end of 5 m of fall, which takes 1 s to the last digit.
#[test]
fn steps_of_bdf_grow_behind_a_damped_rope() {
    let text = "plane = \"xz\"\ngravity = [0, -10]\n[point.j]\nmass = 80\nposition = [0, 5]\n\
                [force.r]\ntype = \"rope\"\nbetween = [[0, 10], \"j\"]\nlength = 10\nstiffness = 400\ndamping = 30\n";
    let [place] = last(text, "radau", 1e-9, 3.0, 3.0, ["j.z"]);
    for step in [0.5, 0.6, 1.1] {
        let choice = Choice { accuracy: Some(1e-5), ..Choice::default().named("ggl/bdf") };
        let (simulation, recording) = common::run(&model(text), choice, step, 3.0);
        let found = recording.column("j.z").unwrap()[recording.rows() - 1];
        assert!((found - place).abs() < 1e-3, "step {step}: {found} for {place} m");
        let taken = simulation.audit().work_summary(simulation.steps()).steps_taken;
        assert!(taken < 2000, "step {step}: {taken} steps");
    }
}

/// Peaks of formulas that are far narrower than steps are seen, in time and at a place: of 1 N·s, and of 0.5 J.
#[test]
fn narrow_peaks_are_seen() {
    let bell = "exp(-((t - 0.37123)/2e-5)^2)/(2e-5*sqrt(pi))";
    let (steep, smooth) = ("0.5/2e-5/cosh((t - 0.37123)/2e-5)^2", "(tanh((t - 0.37103)/2e-5) - tanh((t - 0.37143)/2e-5))/8e-4");
    let force = |of: &str| block(-1.0, 0.0, &format!("type = \"force\"\nbody = \"b\"\nforce = [\"{of}\", 0]"));
    let at_place = "type = \"effort\"\njoint = \"rail\"\neffort = \"0.5*exp(-((q - 1.3)/1e-4)^2)/(1e-4*sqrt(pi))\"";
    for method in METHODS.into_iter().chain(["ode/dop853"]) {
        for of in [bell, steep, smooth] {
            let [x] = last(&force(of), method, 1e-6, 0.01, 1.0, ["b.x"]);
            assert!((x + 0.37123).abs() <= 1e-5, "{method}, {of}: {x}");
        }
        let [speed] = last(&block(-1.0, 2.0, at_place), method, 1e-6, 0.01, 1.0, ["b.vx"]);
        assert!((speed - 5f64.sqrt()).abs() <= 2e-5, "{method} at a place: {speed}");
    }
}

/// The same where they begin or end at a corner, as a blow does that falls off, or in a table: each gives the block 1.5 J, or 1 N·s.
#[test]
fn peaks_at_corners_and_in_tables_are_seen() {
    let table = |interpolation: &str, points: &str| {
        block(0.0, 1.0, "type = \"effort\"\njoint = \"rail\"\neffort = \"T(q)\"")
            + &format!("[table.T]\ninterpolation = \"{interpolation}\"\npoints = {points}\n")
    };
    let decay = block(0.0, 1.0, "type = \"effort\"\njoint = \"rail\"\neffort = \"1.5e5*step(q - 0.53)*exp(-max(q - 0.53, 0)/1e-5)\"");
    let blow = "2e5*(exp(-max(t - 0.53, 0)/1e-5) - exp(-2*max(t - 0.53, 0)/1e-5))";
    let blow = block(0.0, 1.0, &format!("type = \"force\"\nbody = \"b\"\nforce = [\"{blow}\", 0]"));
    let narrow = "[[-9, 0], [0.53, 0], [0.531, 1500], [0.532, 0], [9, 0]]";
    for method in METHODS.into_iter().chain(["ode/dop853"]) {
        for (of, text) in
            [("decay", &decay), ("blow", &blow), ("linear", &table("linear", narrow)), ("monotone", &table("monotone", narrow))]
        {
            let [speed] = last(text, method, 1e-6, 0.1, 1.0, ["b.vx"]);
            assert!((speed - 2.0).abs() <= 2e-5, "{method}, {of}: {speed}");
        }
    }
}

/// Friction by a formula of a sign holds by jumping to and fro, for which no step is short enough: what is said names it.
#[test]
fn a_sign_that_holds_is_named() {
    let text = block(0.0, 1.0, "type = \"effort\"\njoint = \"rail\"\neffort = \"-2*sign(q_rate) + 3*sin(t)\"")
        + "[force.other]\ntype = \"stop\"\njoint = \"rail\"\nlower = -9\nstiffness = 1e5\n";
    let model = model(&text);
    for name in ["radau", "ggl/bdf", "generalized-alpha"] {
        let choice = Choice { accuracy: Some(1e-6), ..Choice::default().named(name) };
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
        let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Nothing);
        let Status::Stopped { at, reason } = simulation.run(10.0, &mut recorder) else { panic!("{name} came through") };
        // It slides until it holds what pushes, which is less than 2 N at that time.
        assert!(reason.contains("the force of `f` jumps to and fro") && 3.0 * at.sin() > -2.0, "{name} at {at} s: {reason}");
    }
}

/// The same of equal steps, whose iteration goes to and fro over the jump, for efforts, forces and torques; a force that has a kink there is not named.
#[test]
fn a_sign_that_holds_is_named_by_equal_steps() {
    let arm = "gravity = [0, 0, -9.81]\nplane = \"xz\"\n[body.arm]\nmass = 1\ninertia = 0.02\nposition = [0.3, 0]\n\
               [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [0, 0]\n\
               [force.drag]\ntype = \"effort\"\njoint = \"hinge\"\neffort = \"-0.01*q_rate*abs(q_rate)\"\n";
    for force in [
        "type = \"effort\"\njoint = \"hinge\"\neffort = \"-0.6*sign(q_rate)\"",
        "type = \"force\"\nbody = \"arm\"\nforce = [\"-2*sign(vx)\", \"-2*sign(vz)\"]",
        "type = \"torque\"\nbody = \"arm\"\ntorque = \"-0.6*sign(w)\"",
    ] {
        for name in ["conserving-ggl", "radau"] {
            let method = Method::resolve(&Choice::default().named(name)).unwrap();
            let mut simulation = Simulation::new(model(&format!("{arm}[force.rub]\n{force}\n")).system, method, 5e-3).unwrap();
            let Status::Stopped { reason, .. } = simulation.step_to(10.0) else { panic!("{name}, {force}: it went on") };
            assert!(reason.contains("the force of `rub` jumps there") && reason.contains("tanh"), "{name}, {force}: {reason}");
        }
    }
}

/// A hinge that gravity pulls at and an effort by the sign of its angle holds: each method says so after a few thousand steps, also those that grow fine
/// enough for a million of them in a hundredth of a second.
#[test]
fn a_sign_of_an_angle_that_holds_is_named() {
    let text = "gravity = [0, 0, -9.81]\n[body.a]\nmass = 1\nshape = { box = [1, 0.1, 0.1] }\nposition = [0.5, 0, 0]\n\
                [joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, -1, 0]\n\
                [force.f]\ntype = \"effort\"\njoint = \"h\"\neffort = \"-10*sign(q)\"\n";
    for name in ["radau", "ggl/bdf", "conserving-ggl"] {
        let choice = Choice { accuracy: Some(1e-4), ..Choice::default().named(name) };
        let mut simulation = Simulation::new(model(text).system.clone(), Method::resolve(&choice).unwrap(), 0.1).unwrap();
        let Status::Stopped { reason, .. } = simulation.step_to(5.0) else { panic!("{name}: it went on") };
        assert!(reason.contains("the force of `f` jumps to and fro"), "{name}: {reason}");
        assert!(simulation.audit().work_summary(1).steps_taken < 10_000, "{name}");
    }
}

/// A run that comes to where a formula has no value stops and names its force, and no other.
#[test]
fn a_force_without_a_value_is_named() {
    let text = block(0.0, 1.0, "type = \"effort\"\njoint = \"rail\"\neffort = \"sqrt(0.3 - q)\"")
        + "[force.other]\ntype = \"force\"\nbody = \"b\"\nforce = [\"-0.1/(2 - x)\", 0]\n";
    let model = model(&text);
    for name in METHODS {
        for accuracy in [None, Some(1e-6)] {
            let choice = Choice { accuracy, ..Choice::default().named(name) };
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
            let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Nothing);
            let Status::Stopped { at, reason } = simulation.run(1.0, &mut recorder) else { panic!("{name} came through") };
            assert!(reason.contains("the force of `f` has no value there") && at < 0.3, "{name}, {accuracy:?}, {at} s: {reason}");
        }
    }
}

/// A contact that is written with a clip inside a clip, whose outer one stays at zero on one side, and an event at the kink itself: the block comes
/// back as from a spring.
#[test]
fn clips_in_clips_and_events_at_kinks_are_landed_on() {
    let place = -(0.5 - std::f64::consts::PI / 1e4_f64.sqrt());
    let inside = "max(b.x, 0)";
    let forms = [
        format!("max({inside}, 0)"),
        format!("abs({inside})"),
        format!("{inside}*step({inside})"),
        format!("sqrt({inside})*sqrt({inside})"),
    ];
    let methods = [("radau", 1e-9), ("ggl/bdf", 1e-7), ("conserving-ggl", 1e-6), ("generalized-alpha", 1e-6), ("ode/dopri5", 1e-8)];
    for form in forms {
        let force = format!("type = \"effort\"\njoint = \"rail\"\neffort = \"-1e4*{form}\"");
        for event in ["", "[event.touch]\nwhen = \"b.x\"\n", "[event.turn]\nwhen = \"1 + b.x^2 - 1\"\n[event.leave]\nwhen = \"-b.x\"\n"] {
            for (method, accuracy) in methods {
                let [x] = last(&(block(-0.5, 1.0, &force) + event), method, accuracy, 0.03, 1.0, ["b.x"]);
                let off = (x - place).abs();
                assert!(off <= 10.0 * accuracy, "{form}, {event}, {method}: off by {off:e} m");
            }
        }
    }
}

/// Three shoes on a hub that spins up touch their drum at the same time but for rounding, and an event waits for one of them: all stay alike, and
/// where they are is the same with the event and without.
#[test]
fn several_bends_at_one_time_are_passed() {
    let shoes = "plane = \"xy\"\n[body.hub]\nmass = 0.5\ninertia = 4e-4\nposition = [0, 0]\n[body.shoe]\nrepeat = \"i = 0 to 2\"\nmass = 0.18\n\
                 inertia = 6e-5\nposition = [\"0.055*cos(i*tau/3)\", \"0.055*sin(i*tau/3)\"]\n[joint.shaft]\ntype = \"revolute\"\n\
                 between = [\"ground\", \"hub\"]\nat = [0, 0]\n[joint.slide]\nrepeat = \"i = 0 to 2\"\ntype = \"prismatic\"\nbetween = [\"hub\", \"shoe[i]\"]\n\
                 axis = [\"cos(i*tau/3)\", \"sin(i*tau/3)\"]\n[force.lining]\nrepeat = \"i = 0 to 2\"\ntype = \"effort\"\njoint = \"slide[i]\"\n\
                 effort = \"-4e5*max(q - 0.004, 0)\"\n[drive.engine]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"50*t^2\"\n";
    let event = "[event.bite]\nwhen = \"slide[0].displacement - 0.004\"\n";
    for (method, accuracy) in [("radau", 1e-9), ("radau", 1e-6), ("ggl/bdf", 1e-7), ("conserving-ggl", 1e-5), ("ode/dopri5", 1e-8)] {
        let names = ["slide[0].displacement", "slide[1].displacement", "slide[2].displacement"];
        let [without, with] = ["", event].map(|event| last(&[shoes, event].concat(), method, accuracy, 1e-3, 0.15, names));
        for k in 0..3 {
            assert!(
                (with[k] - without[0]).abs() <= 20.0 * accuracy * 0.1,
                "{method}, {accuracy:e}: {with:?} m, and {without:?} m without the event"
            );
        }
    }
}

/// Two cylinders of an engine fire a turn apart, by one table that is the same again after every turn: both have their corners at the same places but for
/// rounding, as have the two ends of the table. The speed follows from the work of the table, which is that of a polygon.
#[test]
fn corners_of_two_periodic_tables_at_one_place_are_passed() {
    let knots = [3.0, 1.0, 2.0, -1.0, 3.0];
    let work_to = |place: f64| {
        let (turns, place) = (place.div_euclid(4.0), place.rem_euclid(4.0));
        let until = |place: f64| -> f64 {
            let of_piece = |k: usize| {
                let share = (place - k as f64).clamp(0.0, 1.0);
                share * (knots[k] + 0.5 * share * (knots[k + 1] - knots[k]))
            };
            (0..4).map(of_piece).sum()
        };
        turns * until(4.0) + until(place)
    };
    let table = "[table.gas]\npoints = [[0, 3], [1, 1], [2, 2], [3, -1], [4, 3]]\noutside = \"periodic\"\n";
    for place in [0.1, 0.2, 1.0 / 3.0, 0.6981311111111111, 0.7] {
        for turn in [4, 8] {
            let other = format!("[force.second]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"gas(q + {})\"\n", place + f64::from(turn));
            let force = format!("type = \"effort\"\njoint = \"rail\"\neffort = \"gas(q + {place})\"");
            let text = block(0.0, 1.3, &force) + &other + table;
            for (method, accuracy) in
                [("radau", 1e-7), ("ggl/bdf", 1e-6), ("conserving-ggl", 1e-5), ("ode/dopri5", 1e-8), ("ode/dop853", 1e-6)]
            {
                let [q, rate] = last(&text, method, accuracy, 0.1, 3.0, ["rail.displacement", "rail.displacement_rate"]);
                let expected = (1.3 * 1.3 + 4.0 * (work_to(place + q) - work_to(place))).sqrt();
                assert!((rate - expected).abs() <= 10.0 * accuracy * expected, "{place}, {method}: {rate} m/s, not {expected}");
            }
        }
    }
}

/// A slide is knocked to and fro within a fifth of a second in the course of 200 s, and a mass hangs on it by a spring: what is left of its motion is an integral of
/// the knock with a sine. Steps by accuracy are far longer before it.
#[test]
fn a_knock_of_a_drive_is_not_passed_unseen() {
    let (width, begin, end, rate) = (0.05, 55.0123, 200.0, 50.0_f64.sqrt());
    let knock = |t: f64| 0.1 * (-((t - begin) / width).powi(2)).exp();
    // What vanishes with all its derivatives at both ends is integrated by equal parts to round-off.
    let part = 1e-3;
    let moved: f64 = (-1000..1000).map(|k| begin + part * f64::from(k)).map(|t| part * rate * knock(t) * (rate * (end - t)).sin()).sum();
    let text = |moves: &str| {
        format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [1, 0]\n\
             [constraint.rail]\ntype = \"point-on-line\"\npoint = \"m\"\ndirection = [1, 0]\n[point.p]\n{moves}\n\
             [force.s]\ntype = \"spring\"\nbetween = [\"p\", \"m\"]\nstiffness = 50\nrest_length = 1\n"
        )
    };
    let bump = "0.1*exp(-((t - 55.0123)/0.05)^2)";
    let driven = format!("mass = 1\nposition = [0, 0]\n[drive.d]\ntype = \"point\"\npoint = \"p\"\nprofile = [\"{bump}\", 0]");
    let carried = format!("motion = [\"{bump}\", 0]");
    for (moves, method, accuracy) in [
        (&driven, "radau", 1e-7),
        (&driven, "ggl/bdf", 1e-6),
        (&driven, "ode/dopri5", 1e-7),
        (&driven, "ode/dop853", 1e-6),
        (&driven, "conserving-ggl", 1e-4),
        (&carried, "radau", 1e-6),
    ] {
        let text = format!("{}[simulation]\nend = {end}\nstep = 10\naccuracy = {accuracy:e}\n", text(moves));
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
        let found = common::last(&common::run(&model(&text), choice, 10.0, end).1, "m.x");
        assert!((found - 1.0 - moved).abs() < accuracy, "{method}, {accuracy:e}: {found} m in place of {}", 1.0 + moved);
    }
}
