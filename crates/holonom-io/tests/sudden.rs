//! Steps chosen by accuracy where something happens suddenly, or begins anew: pulses, jumps, events and samples between nominal times.

mod common;

use common::model;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};
use holonom::system::Place;

/// A millisecond's pulse that is written in the model is not stepped over: 1 kg has 1 m/s afterwards.
#[test]
fn pulses_in_formulas_are_seen() {
    let text = "gravity = [0, 0, 0]\n[point.m]\nmass = 1\nposition = [0, 0, 0]\n[force.kick]\ntype = \"expression\"\npoint = \"m\"\n\
                force = [\"1000*(step(t - START) - step(t - START - 1e-3))\", 0, 0]\n";
    for method in ["conserving-ggl", "conserving", "trapezoidal-projected", "generalized-alpha", "radau", "lagrange-3/bdf", "ode/dop853"] {
        // At a nominal step, and between two.
        for start in [0.5, 0.537] {
            let model = model(&text.replace("START", &start.to_string()));
            let choice = Choice { method: Some(method.into()), accuracy: Some(1e-4), ..Choice::default() };
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.1).unwrap();
            let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
            assert_eq!(status, Status::Completed, "{method}");
            let (state, audit) = (simulation.state(), simulation.audit());
            let expected = [1.0 - start - 0.5e-3, 1.0];
            let off = (state.x[0] - expected[0]).abs().max((simulation.velocities()[0] - expected[1]).abs());
            assert!(off < 1e-10, "{method}: {} and {}", state.x[0], simulation.velocities()[0]);
            assert!((audit.work - 0.5).abs() < 1e-6, "{method}: work {}", audit.work);
            assert_eq!(state.t, 1.0);
        }
    }
}

/// What jumps at the very start, at which it is a third thing, pushes from there on: 1 kg goes t² far under 2 N.
#[test]
fn jumps_at_the_start_are_behind_it() {
    for (force, way) in [("2*sign(t)", 1.0), ("2*step(t)", 1.0), ("2*sign(t) - 4*step(t - 0.5)", 0.5)] {
        let text = format!(
            "gravity = [0, 0, 0]\n[point.m]\nmass = 1\nposition = [0, 0, 0]\n[force.push]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"{force}\", 0, 0]\n"
        );
        let model = model(&text);
        for method in ["conserving-ggl", "trapezoidal-projected", "radau", "bdf", "dopri5", "dop853"] {
            let choice = Choice { method: Some(method.into()), accuracy: Some(1e-6), ..Choice::default() };
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
            let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
            assert_eq!(status, Status::Completed, "{force} by {method}");
            let off = simulation.state().x[0] - way;
            assert!(off.abs() < 1e-9, "{force} by {method}: off by {off}");
        }
    }
}

/// A point of 1 kg that goes straight until an event at t = 1 s pushes it by 2 cos 3t, with running values, and a condition that is met six times.
const PUSHED: &str = r#"
gravity = [0, 0, 0]
[input.push]
[input.passes]
[point.p]
mass = 1
position = [0.1, 0, 0]
velocity = [1, 0, 0]
[force.f]
type = "expression"
point = "p"
force = ["push*cos(3*t)", 0, 0]
[event.touched]
when = "p.x - 1.1"
set = { push = 2 }
[event.passed]
when = "sin(4*t) - 0.5"
set = { passes = "passes + 1" }
[measure.way]
value = "integral(p.x)"
[measure.farthest]
value = "max(p.vx)"
"#;

#[test]
fn what_happens_between_nominal_times_is_seen() {
    // Closed forms at the end, `after` so long a push.
    let end = 4.0_f64;
    let after = end - 1.0;
    let x = 0.1 + end + 2.0 / 9.0 * (3.0_f64.cos() - (3.0 * end).cos()) - 2.0 / 3.0 * 3.0_f64.sin() * after;
    let way = {
        let pushed = 2.0 / 9.0 * (3.0_f64.cos() * after - ((3.0 * end).sin() - 3.0_f64.sin()) / 3.0);
        0.1 * end + 0.5 * end * end + pushed - 3.0_f64.sin() / 3.0 * after * after
    };
    let fastest = 1.0 + 2.0 / 3.0 * (1.0 - 3.0_f64.sin());
    let model = model(PUSHED);
    for method in ["conserving", "conserving-ggl", "trapezoidal-projected", "generalized-alpha", "radau", "bdf", "dopri5", "dop853"] {
        // One nominal step, and many.
        for step in [end, 0.1, 0.01] {
            let choice = Choice { accuracy: Some(1e-8), ..Choice::default().named(method) };
            let (simulation, recording) = common::run(&model, choice, step, end);
            let last = recording.rows() - 1;
            let at = |name: &str| recording.column(name).unwrap()[last];
            let (place, done) = (at("p.x"), at("work"));
            assert!((place - x).abs() < 1e-7, "{method}, {step}: {place}");
            // Trapezoids between times that are no farther apart than an eighth of a step.
            assert!((at("way") - way).abs() < 1e-4, "{method}, {step}: {} and {way}", at("way"));
            assert!((at("farthest") - fastest).abs() < 1e-3, "{method}, {step}: {} and {fastest}", at("farthest"));
            // sin 4t is ½ twice in each turn.
            assert_eq!(at("passes"), 6.0, "{method}, {step}: {:?}", simulation.events());
            let balance = at("energy") - 0.5 - done;
            assert!(balance.abs() < 1e-7, "{method}, {step}: {balance}");
        }
    }
}

/// A stop that pushes from its first touch on, by a formula of the place alone: the mass comes back with the velocity that it came with, also
/// where a step from a place before it would end far inside, and at a nominal time that is the moment of the touch.
#[test]
fn loads_that_jump_with_the_place_are_seen() {
    let text = "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [2, 0, 0]\n[force.stop]\ntype = \"expression\"\n\
                point = \"p\"\nforce = [\"-(50 + 200*(x - 1))*step(x - 1)\", 0, 0]\n";
    let model = model(text);
    // x = 0.75 + a cos ωs + b sin ωs inside, from x = 1 and v = 2 on; out again at half the phase before and behind the farthest place.
    let (omega, a, b) = (200_f64.sqrt(), 0.25, 2.0 / 200_f64.sqrt());
    let inside = 2.0 * (b / a).atan() / omega;
    let end = 1.0 - 2.0 * (3.0 - 0.5 - inside);
    for method in ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "rattle", "generalized-alpha", "radau"]
    {
        for accuracy in [1e-3, 1e-5, 1e-6] {
            for step in [3.0, 0.5, 0.37] {
                let choice = Choice { method: Some(method.into()), accuracy: Some(accuracy), ..Choice::default() };
                let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), step).unwrap();
                assert_eq!(simulation.run(3.0, &mut |_: &Simulation| Verdict::GoOn), Status::Completed);
                let off = (simulation.state().x[0] - end).abs();
                // A jump is found to round-off of a velocity over the step.
                assert!(off <= 10.0 * accuracy + 3e-5, "{method}, {accuracy:e}, {step}: {off:e}");
            }
        }
    }
}

/// Where events take samples, steps grow again after each of them.
#[test]
fn steps_grow_again_after_samples() {
    let text = "plane = \"xz\"\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n[body.b]\nmass = 1\ninertia = 0.1\nposition = [1.5, 0]\n\
                [joint.j1]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
                [joint.j2]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n\
                [force.s]\ntype = \"spring\"\nbetween = [\"ground\", \"b\"]\nstiffness = K\nrest_length = 1.4\n\
                [input.n]\n[event.e]\nevery = 0.013\nset = { n = \"n + 1\" }\n";
    for stiffness in ["100", "1080", "2060", "3040", "4020"] {
        let model = model(&text.replace('K', stiffness));
        let choice = Choice { method: Some("lagrange-1/dopri5".into()), accuracy: Some(1e-6), ..Choice::default() };
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
        let status = simulation.run(2.0, &mut |simulation: &Simulation| {
            let taken = simulation.audit().work_summary(simulation.steps()).steps_taken;
            if taken < 20_000 { Verdict::GoOn } else { Verdict::Stop }
        });
        assert_eq!(status, Status::Completed, "{stiffness} N/m");
    }
}

/// A drive that jerks from rest to rest in 4 ms has put in energy and taken it back: what is left of it, be it round-off or what a weak spring has, is no
/// matter of the accuracy, and did not come from nothing. In the middle of a run from rest, from its start, and with the spring.
#[test]
fn short_motions_of_drives_leave_nothing_to_miss() {
    let jerk = |s: f64| s.powi(3) * (10.0 - 15.0 * s + 6.0 * s * s);
    let text = |kind: &str, begin: f64, spring: &str| {
        let s = format!("max(0, min(1, (t - {begin})/0.004))");
        let w = if kind == "slow first" { format!("({s})^2") } else { s };
        format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[body.slider]\nmass = 100\ninertia = 0.1\nposition = [0, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
             [drive.d]\ntype = \"displacement\"\njoint = \"rail\"\nprofile = \"0.01*({w})^3*(10 - 15*({w}) + 6*({w})^2)\"\n{spring}"
        )
    };
    let spring = "[point.m]\nmass = 0.5\nposition = [1, 0]\n\
                  [force.s]\ntype = \"spring\"\nbetween = [\"slider\", \"m\"]\nstiffness = 5\nrest_length = 1\n";
    // 0.5 m'' = 5 (x − m), with the way x of the slider, by Heun's rule.
    let (h, mut m, mut v) = (1e-5, 0.0_f64, 0.0_f64);
    for k in 0..50_000 {
        let pull = |t: f64, m: f64| 10.0 * (0.01 * jerk(((t - 0.1) / 0.004).clamp(0.0, 1.0).powi(2)) - m);
        let (t, a) = (h * f64::from(k), pull(h * f64::from(k), m));
        let b = pull(t + h, m + h * v);
        (m, v) = (m + h * v + 0.5 * h * h * a, v + 0.5 * h * (a + b));
    }
    for method in ["dopri5", "dop853", "radau"] {
        for exponent in 2..=7 {
            let accuracy = 10f64.powi(-exponent);
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
            for (kind, begin, spring) in [("even", 0.1, ""), ("even", 0.0, ""), ("slow first", 0.1, spring)] {
                let model = model(&text(kind, begin, spring));
                let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.02).unwrap();
                let status = simulation.run(0.5, &mut |_: &Simulation| Verdict::GoOn);
                assert_eq!(status, Status::Completed, "{method}, {accuracy:e}, {kind}, {begin}");
                let Some(point) = model.points.first() else { continue };
                let Place::Node(node) = point.place else { panic!("it moves") };
                let off = (simulation.state().x[2 * node.index()] - 1.0 - m).abs();
                assert!(off <= 10.0 * accuracy.min(1e-4), "{method}, {accuracy:e}: {off:e} m");
            }
        }
    }
}

/// A slider that is led, and a force along it that an event sets anew every 37 ms: each time the motion begins anew. Velocities that the method leaves
/// off the rows would be a multiple of it after each, and soon anything.
#[test]
fn motions_that_begin_anew_again_and_again_stay_on_their_rows() {
    let text = "gravity = [0, 0, 0]\n[body.b]\nmass = 1\ninertia = [0.3, 0.5, 0.6]\nposition = [0, 0, 0]\n\
                [joint.rail]\ntype = \"JOINT\"\nbetween = [\"ground\", \"b\"]AT\naxis = [0, 0, 1]\n\
                [drive.lead]\ntype = \"KIND\"\njoint = \"rail\"\nprofile = \"0.1*sin(2*t)\"\n\
                [input.u]\ndefault = 0\n[event.sample]\nevery = PERIOD\nset = { u = \"sin(100*t)\" }\n\
                [force.push]\ntype = \"expression\"\npoint = \"b\"\nforce = [0, 0, \"3*u\"]\n";
    for (joint, at, kind, speed) in [("prismatic", "", "displacement", "b.vz"), ("revolute", "\nat = [0, 0, 0]", "angle", "b.wz")] {
        for period in ["0.037", "0.05"] {
            let model = model(&text.replace("JOINT", joint).replace("AT", at).replace("KIND", kind).replace("PERIOD", period));
            for method in ["generalized-alpha", "lagrange-3/hht", "radau", "conserving-ggl"] {
                for accuracy in [1e-3, 1e-4, 1e-5] {
                    let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
                    let (_, recording) = common::run(&model, choice, 0.01, 1.0);
                    let off = |(t, v): (&f64, &f64)| (v - 0.2 * (2.0 * t).cos()).abs();
                    let times = recording.column("t").unwrap();
                    let most = times.iter().zip(recording.column(speed).unwrap()).map(off).fold(0.0, f64::max);
                    assert!(most < 100.0 * accuracy, "{joint}, every {period} s, {method}, {accuracy:e}: {most:e}");
                }
            }
        }
    }
}
