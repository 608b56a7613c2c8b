//! Ropes that get slack and taut again: against arcs of vibrations and free flight, pieced together in closed form.

mod common;

use common::{model, run};
use holonom::model::Model;
use holonom::record::Recording;
use holonom::simulation::Choice;

const G: f64 = 9.81;

/// The free length of the rope below the place where it hangs, m, and how much longer it is at the start.
const FREE: f64 = 1.0;
const STRETCH: f64 = 0.1;

/// Stiffness between that place and the bob of 1 kg, N/m.
const STIFFNESS: f64 = 400.0;

/// A bob below the origin on a rope with these keys.
fn hanging(keys: &str, damping: f64) -> Model {
    model(&format!(
        "[point.bob]\nmass = 1\nposition = [0, 0, {}]\n[force.rope]\ntype = \"rope\"\n{keys}\ndamping = {damping}\n",
        -(FREE + STRETCH)
    ))
}

/// The same motion: on a rope, over a sheave at the origin, and as a pulley block with two falls, in which all damping counts four times.
fn ropes(damping: f64) -> [(&'static str, Model); 3] {
    let over = format!("between = [[-1, 0, 0], \"bob\"]\nthrough = [\"ground\"]\nlength = {}\nstiffness = {STIFFNESS}", 1.0 + FREE);
    let block =
        format!("between = [\"ground\", \"ground\"]\nthrough = [\"bob\"]\nlength = {}\nstiffness = {}", 2.0 * FREE, STIFFNESS / 4.0);
    [
        ("rope", hanging(&format!("between = [\"ground\", \"bob\"]\nlength = {FREE}\nstiffness = {STIFFNESS}"), damping)),
        ("rope over a sheave", hanging(&over, damping)),
        ("pulley block", hanging(&block, damping / 4.0)),
    ]
}

/// A body flies until the damping of a rope begins to pull: rows between the steps of a method by accuracy are those of the flight up to there.
#[test]
fn rows_before_a_rope_pulls_are_of_free_flight() {
    let text = "plane = \"xz\"\ngravity = [0, -9.81]\n[body.load]\nmass = 100\ninertia = 20\nposition = [0, -1]\npoints = { b = [0.5, 0.3] }\nvelocity = [1, 0]\n\
                angular_velocity = 1\n[force.rope]\ntype = \"rope\"\nbetween = [[1, 0], \"load.b\"]\nstiffness = 1e5\ndamping = 800\nlength = 2.75\n";
    let model = model(text);
    for accuracy in (12..=28).map(|quarter| 10_f64.powf(-f64::from(quarter) / 4.0)) {
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named("ode/dop853") };
        let (_, recording) = run(&model, choice, 0.01, 0.6);
        let [t, z] = ["t", "load.z"].map(|name| recording.column(name).unwrap());
        for (t, z) in t.iter().zip(z).filter(|(t, _)| **t < 0.514) {
            let off = (z + 1.0 + 0.5 * G * t * t).abs();
            assert!(off < 10.0 * accuracy, "accuracy {accuracy:e}: {off:e} m off at {t} s");
        }
    }
}

/// Stretch and its rate of a taut rope after a time: c is below critical.
fn vibrate([p, v]: [f64; 2], c: f64, t: f64) -> [f64; 2] {
    let (delta, rest) = (0.5 * c, G / STIFFNESS);
    let omega = (STIFFNESS - delta * delta).sqrt();
    let (a, b) = (p - rest, (v + delta * (p - rest)) / omega);
    let (sine, cosine) = (omega * t).sin_cos();
    let envelope = (-delta * t).exp();
    let position = envelope * (a * cosine + b * sine);
    [rest + position, envelope * omega * (b * cosine - a * sine) - delta * position]
}

fn fly([p, v]: [f64; 2], t: f64) -> [f64; 2] {
    [p + v * t + 0.5 * G * t * t, v + G * t]
}

/// Stretch and its rate after `t`, from arc to arc: a rope gets slack where its tension vanishes, and taut where it has its free length.
fn exact(c: f64, t: f64) -> [f64; 2] {
    let (mut state, mut left, mut is_taut) = ([STRETCH, 0.0], t, true);
    loop {
        let arc = |t: f64| if is_taut { vibrate(state, c, t) } else { fly(state, t) };
        let goes_on = |[p, v]: [f64; 2]| if is_taut { STIFFNESS * p + c * v > 0.0 } else { p < 0.0 || v < 0.0 };
        let step = 1e-3;
        let Some(k) = (1..).take_while(|&k| f64::from(k - 1) * step < left).find(|&k| !goes_on(arc(f64::from(k) * step))) else {
            return arc(left);
        };
        let (mut low, mut high) = (f64::from(k - 1) * step, f64::from(k) * step);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if goes_on(arc(middle)) { low = middle } else { high = middle }
        }
        if high >= left {
            return arc(left);
        }
        (state, left, is_taut) = (arc(high), left - high, !is_taut);
    }
}

/// The largest difference of place and velocity from arcs.
fn difference(recording: &Recording, c: f64) -> f64 {
    let column = |name: &str| recording.column(name).unwrap_or_else(|| panic!("no {name}"));
    let (t, z, vz) = (column("t"), column("bob.z"), column("bob.vz"));
    (0..recording.rows()).fold(0.0, |worst: f64, k| {
        let [p, v] = exact(c, t[k]);
        worst.max((-z[k] - FREE - p).abs()).max((-vz[k] - v).abs())
    })
}

#[test]
fn a_bob_on_a_rope_flies_and_falls_back_into_it() {
    assert!((0..200).any(|k| exact(0.0, 0.01 * f64::from(k))[0] < -0.05), "it flies");
    for (c, bound) in [(0.0, 1e-8), (2.0, 1e-6)] {
        for (name, model) in ropes(c) {
            let choice = Choice { method: Some("radau".into()), accuracy: Some(1e-11), ..Choice::default() };
            let (_, recording) = run(&model, choice, 0.01, 2.0);
            let off = difference(&recording, c);
            println!("{name}, c = {c}: {off:e}");
            assert!(off < bound, "{name}, c = {c}: off by {off}");
        }
    }
}

#[test]
fn the_conserving_schemes_keep_the_balance_through_slack_and_taut() {
    for method in ["conserving-ggl", "conserving"] {
        for c in [0.0, 2.0] {
            for (name, model) in ropes(c) {
                let errors = [4e-3, 1e-3].map(|step| {
                    let choice = Choice::default().named(method);
                    let (simulation, recording) = run(&model, choice, step, 2.0);
                    let energy = simulation.audit().energy_summary();
                    assert!(energy.max_drift < 1e-12, "{name}, {method}, c = {c}: {} J", energy.max_drift);
                    difference(&recording, c)
                });
                println!("{name}, {method}, c = {c}: {errors:?}");
                assert!(errors[1] < 2e-3 && errors[1] < 0.1 * errors[0], "{name}, {method}, c = {c}: off by {errors:?}");
            }
        }
    }
}

#[test]
fn a_slack_rope_does_nothing_and_a_taut_one_only_pulls() {
    for (name, model) in ropes(4.0) {
        let (_, recording) = run(&model, Choice::default(), 1e-3, 2.0);
        let column = |suffix: &str| recording.column(&format!("rope.{suffix}")).unwrap_or_else(|| panic!("no {suffix}"));
        let (length, force, power) = (column("length"), column("force"), column("power"));
        let free = match name {
            "rope" => FREE,
            "rope over a sheave" => 1.0 + FREE,
            _ => 2.0 * FREE,
        };
        let slack = (0..recording.rows()).filter(|&k| length[k] < free).inspect(|&k| assert_eq!([force[k], power[k]], [0.0; 2], "{name}"));
        assert!(slack.count() > 50, "{name} gets slack");
        assert!(force.iter().all(|&force| force >= 0.0), "{name} pushes");
    }
}

/// Sheaves on bodies that move, in the plane and in space, far from the origin too: the same force along all stretches, so that momenta stay.
#[test]
fn ropes_between_bodies_keep_energy_and_momenta() {
    for (plane, far, turn) in [("plane = \"xy\"\n", 0.0, ""), ("", 0.0, ", 0.3"), ("", 1e5, ", 0.3")] {
        let three = |x: f64, y: f64| if plane.is_empty() { format!("[{}, {y}, 0.1]", x + far) } else { format!("[{x}, {y}]") };
        let gravity = if plane.is_empty() { "[0, 0, 0]" } else { "[0, 0]" };
        let spin = if plane.is_empty() { format!("[0.5{turn}, -1]") } else { "-1".into() };
        let lugs = if plane.is_empty() { "a = [0.2, 0, 0], b = [-0.2, 0.1, 0.05]" } else { "a = [0.2, 0], b = [-0.2, 0.1]" };
        let text = format!(
            "{plane}gravity = {gravity}\n\
             [body.A]\nshape = {{ box = [0.4, 0.2, 0.1] }}\nmass = 2\nposition = {}\nangular_velocity = {spin}\npoints = {{ {lugs} }}\n\
             [body.B]\nshape = {{ box = [0.4, 0.2, 0.1] }}\nmass = 1\nposition = {}\npoints = {{ {lugs} }}\n\
             [point.P]\nmass = 0.5\nposition = {}\nvelocity = {}\n\
             [force.rope]\ntype = \"rope\"\nbetween = [\"A.a\", \"P\"]\nthrough = [\"B.a\", \"B.b\", \"A.b\", \"B.a\"]\nlength = 4\nstiffness = 50\n",
            three(0.0, 0.0),
            three(1.0, 0.2),
            three(0.3, 1.0),
            if plane.is_empty() { "[0, 3, 1]" } else { "[0, 3]" },
        );
        let (simulation, recording) = run(&model(&text), Choice::default(), 2e-3, 4.0);
        let force = recording.column("rope.force").unwrap();
        assert!(force.contains(&0.0) && force.iter().any(|&force| force > 1.0), "it gets taut and slack");
        let (energy, momentum) = (simulation.audit().energy_summary(), simulation.audit().momentum_summary());
        println!("{far}: {} {} {}", energy.max_drift, momentum.linear_drift, momentum.angular_drift);
        assert!(energy.max_drift < 1e-10 && momentum.linear_drift < 1e-10 && momentum.angular_drift < 1e-9 * (1.0 + far));
    }
}

/// A weight on a drum that turns freely, in space and in the plane: the stretch p vibrates about that of its tension, with
/// p̈ = g − k p (1/m + R²/I), and the drum turns with I θ̈ = R k p.
#[test]
fn a_drum_lets_out_what_the_weight_pulls() {
    let (m, inertia, radius, k) = (2.0, 0.05, 0.2, 300.0);
    let stiffness: f64 = k * (1.0 / m + radius * radius / inertia);
    let (omega, rest) = (stiffness.sqrt(), G / stiffness);
    let exact = |t: f64| {
        let p = rest * (1.0 - (omega * t).cos());
        let turned = radius * k * rest / inertia * (0.5 * t * t - (1.0 - (omega * t).cos()) / (omega * omega));
        [p, turned]
    };
    let space = format!(
        "[body.drum]\nmass = 5\ninertia = [{inertia}, {inertia}, {inertia}]\nposition = [0, 0, 0]\n\
         [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"drum\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n\
         [point.weight]\nmass = {m}\nposition = [0, 0, -3]\n"
    );
    let plane = format!(
        "plane = \"xy\"\ngravity = [0, -9.81]\n[body.drum]\nmass = 5\ninertia = {inertia}\nposition = [0, 0]\n\
         [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"drum\"]\nat = [0, 0]\n[point.weight]\nmass = {m}\nposition = [0, -3]\n"
    );
    // The same drum the other way round, and rope that is tied to the axis as a place of the drum.
    for (of, text, end, radius) in
        [("space", &space, "[0, 0, 0]", radius), ("plane", &plane, "[0, 0]", radius), ("back", &space, "\"drum\"", -radius)]
    {
        let model = model(&format!(
            "{text}[force.rope]\ntype = \"rope\"\nbetween = [{end}, \"weight\"]\ndrum = \"shaft\"\nradius = {radius}\nstiffness = {k}\n"
        ));
        for (method, step, tolerance) in [("conserving-ggl", 2e-4, 2e-5), ("conserving", 2e-4, 2e-5), ("radau", 1e-3, 1e-9)] {
            let (simulation, recording) = run(&model, Choice::default().named(method), step, 1.0);
            let last = |name: &str| *recording.column(name).unwrap_or_else(|| panic!("there is no column {name}")).last().unwrap();
            let [p, turned] = exact(1.0);
            let found = [last("rope.force") / k, last("shaft.angle") * radius.signum(), last("rope.length") - 3.0];
            let known = [p, turned, p + radius.abs() * turned];
            let errors: Vec<f64> = found.iter().zip(known).map(|(found, known)| (found - known).abs()).collect();
            assert!(errors.iter().all(|error| *error < tolerance), "{of}, {method}: {errors:?}");
            assert!((last("rope.effort") - radius * last("rope.force")).abs() < 1e-9, "{of}, {method}");
            let drift = simulation.audit().energy_summary().max_drift;
            assert!(method == "radau" || drift < 1e-11, "{of}, {method}: {drift} J");
        }
    }
}

/// A damped rope of which one stretch keeps its length, as a rod holds both its ends: order 2 as without, and whatever the entries' order, as what
/// rounding leaves of the rate of that stretch says nothing of the damper.
#[test]
fn a_stretch_that_keeps_its_length_leaves_the_order() {
    let text = "plane = \"xy\"\ngravity = [0, -9.81]\n[point.a]\nmass = 1\nposition = [1, 0]\n[point.load]\nmass = 1\nposition = [1.2, -1]\n\
                [constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n[force.r]\ntype = \"rope\"\nbetween = [\"ground\", \"load\"]\n\
                through = [\"a\"]\nlength = 1.9\nstiffness = 2000\ndamping = 20\n";
    let place = |method: &str, step: f64| common::last(&run(&model(text), Choice::default().named(method), step, 0.016).1, "load.y");
    let exact = place("radau", 1e-4);
    for method in ["conserving-ggl", "conserving", "conserving-projected"] {
        let [coarse, fine] = [1e-3, 5e-4].map(|step| (place(method, step) - exact).abs());
        assert!(coarse < 2e-5 && ((coarse / fine).log2() - 2.0).abs() < 0.1, "{method}: {coarse:e} m, and {fine:e} m with half the step");
    }
}

/// The kink where the tension of a damped rope ends while it is still longer than its length, and where a stop lets go of what leaves it fast: steps
/// by accuracy end there. The rope's motion is a damped vibration and then a free flight.
#[test]
fn the_end_of_a_damped_tension_is_landed_on() {
    let rope = "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [1.074, 0]\nvelocity = [0.05, 0]\n\
                [force.r]\ntype = \"rope\"\nbetween = [\"ground\", \"m\"]\nlength = 1\nstiffness = 387.0\ndamping = 2.44\n";
    let stop = |force: &str| {
        format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[body.b]\nmass = 1\ninertia = 1\nposition = [0.3, 0]\nvelocity = [-1, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"b\"]\naxis = [1, 0]\n{force}"
        )
    };
    let by_kind = stop(
        "[force.s]\ntype = \"stop\"\njoint = \"rail\"\nlower = -0.2\nstiffness = 49\ndissipation = 1.83\n[force.f]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"20\"\n",
    );
    let by_formula =
        stop("[force.s]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"20 + 49*max(0, -0.2 - q)*max(0, 1 - 1.83*q_rate)\"\n");
    // m ẍ + c ẋ + k p = 0 until c ẋ + k p is zero.
    let (k, c): (f64, f64) = (387.0, 2.44);
    let rate = f64::sqrt(k - 0.25 * c * c);
    let at = |t: f64| {
        let ([p, v], decay) = ([0.074, 0.05], (-0.5 * c * t).exp());
        let b = (v + 0.5 * c * p) / rate;
        let (sine, cosine) = (rate * t).sin_cos();
        let place = decay * (p * cosine + b * sine);
        [place, decay * rate * (b * cosine - p * sine) - 0.5 * c * place]
    };
    let (mut low, mut high) = (0.05, 0.1);
    for _ in 0..200 {
        let t = 0.5 * (low + high);
        let [p, v] = at(t);
        *(if k * p + c * v > 0.0 { &mut low } else { &mut high }) = t;
    }
    let [p, v] = at(low);
    let free = 1.0 + p + v * (0.3 - low);
    let place = |text: &str, method: &str, accuracy: f64, end: f64, name: &str| {
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
        common::last(&run(&model(text), choice, 0.01, end).1, name)
    };
    let alone = place(&by_formula, "ode/dop853", 1e-11, 1.0, "b.x");
    for (method, accuracy) in [("radau", 1e-5), ("radau", 1e-7), ("radau", 1e-8), ("ggl/bdf", 1e-7), ("ode/dopri5", 1e-8)] {
        let off = (place(rope, method, accuracy, 0.3, "m.x") - free).abs();
        assert!(off <= 10.0 * accuracy, "{method}, {accuracy:e}: the rope is off by {off:e} m");
        let off = (place(&by_kind, method, accuracy, 1.0, "b.x") - alone).abs();
        assert!(off <= 10.0 * accuracy, "{method}, {accuracy:e}: the stop is off by {off:e} m");
    }
}

/// Each of two drums turns with its own angle, many times, and so far apart from the other: the motors lower weights at constant speed, one over a sheave.
#[test]
fn motors_of_drums_bear_their_own_ropes() {
    let text = "plane = \"xz\"\n[body.one]\nmass = 10\ninertia = 1\nposition = [0, 0]\n[body.two]\nmass = 10\ninertia = 1\nposition = [2, 0]\n\
                [joint.a]\ntype = \"revolute\"\nbetween = [\"ground\", \"one\"]\nat = [0, 0]\n\
                [joint.b]\ntype = \"revolute\"\nbetween = [\"ground\", \"two\"]\nat = [2, 0]\n\
                [point.p]\nmass = 100\nposition = [-3, -20]\n[point.q]\nmass = 100\nposition = [2, -20]\n\
                [force.over]\ntype = \"rope\"\nbetween = [\"one\", \"p\"]\nthrough = [[-3, 0]]\ndrum = \"a\"\nradius = 0.6\nstiffness = 1e4\ndamping = 1000\n\
                [force.down]\ntype = \"rope\"\nbetween = [\"two\", \"q\"]\ndrum = \"b\"\nradius = 0.5\nstiffness = 1e4\ndamping = 1000\n\
                [drive.ma]\ntype = \"angle\"\njoint = \"a\"\nprofile = \"-0.2*t\"\n[drive.mb]\ntype = \"angle\"\njoint = \"b\"\nprofile = \"-t\"\n";
    for reactions in ["", "[output]\nreactions = true\n"] {
        for every in [1, 60] {
            let model = common::model_with_forces(&format!("{text}{reactions}"));
            let recording = common::run_every(&model, "radau", 0.1, 12.0, every).1;
            for (name, expected) in [("ma.effort", -0.6), ("mb.effort", -0.5)] {
                let found = common::last(&recording, name);
                let expected = expected * 100.0 * G;
                assert!((found - expected).abs() < 1e-6 * expected.abs(), "{name}: {found} and {expected} N·m by hand");
            }
        }
    }
}

/// A winch pulls at a rope that is tied to the ground at both ends until its torque is that of the tension.
#[test]
fn a_winch_tightens_a_rope_between_fixed_places() {
    for (reactions, sheaves) in [("", ""), ("[output]\nreactions = true\n", ""), ("", "through = [[5, 0], [5, 3]]\n")] {
        let model = model(&format!(
            "plane = \"xz\"\n[body.winch]\nmass = 10\ninertia = 0.2\nposition = [0, 0]\n\
             [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"winch\"]\nat = [0, 0]\n\
             [force.guy]\ntype = \"rope\"\nbetween = [\"winch\", [{}, 0]]\n{sheaves}drum = \"shaft\"\nradius = 0.2\nstiffness = 1e4\n\
             [force.crank]\ntype = \"effort\"\njoint = \"shaft\"\neffort = \"-50 - 20*q_rate\"\n{reactions}",
            if sheaves.is_empty() { 5 } else { 0 }
        ));
        let recording = run(&model, Choice::default(), 0.01, 3.0).1;
        let length = if sheaves.is_empty() { 5.0 } else { 8.0 + f64::sqrt(34.0) };
        for (name, expected) in [("guy.force", 250.0), ("guy.length", length), ("shaft.angle", -250.0 / 1e4 / 0.2)] {
            let found = common::last(&recording, name);
            assert!((found - expected).abs() < 1e-9 * f64::abs(expected), "{name}: {found} in place of {expected}");
        }
    }
}

/// A rope between the ground and the middle of a wheel, which a joint holds where it is, pulls all the same and the joint bears it, whether the wheel shares the
/// place with the ground or not.
#[test]
fn a_rope_to_what_a_joint_holds_shows_its_tension() {
    for reactions in ["", "[output]\nreactions = true\n"] {
        let model = common::model_with_forces(&format!(
            "plane = \"xy\"\ngravity = [0, -10]\n[body.wheel]\nmass = 2\ninertia = 0.5\nposition = [0, 0]\nangular_velocity = 1\n\
             [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"wheel\"]\nat = [0, 0]\n\
             [force.guy]\ntype = \"rope\"\nbetween = [\"wheel\", [0, -2]]\nlength = 1.5\nstiffness = 1000\n{reactions}"
        ));
        let recording = common::run_every(&model, "conserving-ggl", 0.01, 0.1, 1).1;
        for (name, expected) in [("guy.force", 500.0), ("guy.length", 2.0), ("axle.fy", 520.0)] {
            let found = common::last(&recording, name);
            assert!((found - expected).abs() < 1e-12 * expected, "{reactions}{name}: {found} in place of {expected}");
        }
    }
}

/// A rope of the length that it has at the start, on an arm that turns away: whatever rounding makes of both lengths, it pulls with c ℓ̇ from the first
/// row on, and the arm feels what is shown.
#[test]
fn a_rope_that_is_just_taut_pulls_where_its_ends_part() {
    for place in 0..40 {
        let [x, y] = [0.5 + 0.017 * f64::from(place), -0.3 + 0.013 * f64::from(place)];
        for damping in ["10", "10 + 0*t"] {
            let model = common::model_with_forces(&format!(
                "plane = \"xy\"\n[body.arm]\nmass = 1\ninertia = 0.1\nposition = [{x}, {y}]\nangular_velocity = 2\npoints = {{ p = [0.3, 0.1] }}\n\
                 [joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [{x}, {y}]\n\
                 [force.r]\ntype = \"rope\"\nbetween = [[-1, 0.1], \"arm.p\"]\nstiffness = 100\ndamping = \"{damping}\"\n"
            ));
            let recording = common::run_every(&model, "conserving-ggl", 1e-3, 1e-3, 1).1;
            let first = |name: &str| recording.column(name).unwrap()[0];
            // From the end on the ground to that on the arm, which moves with 2 rad/s about the pin.
            let [along, across] = [x + 0.3 + 1.0, y + 0.1 - 0.1];
            let length = f64::hypot(along, across);
            let arm = (across * 0.3 - along * 0.1) / length;
            let expected = (10.0 * 2.0 * arm).max(0.0);
            assert!((first("r.force") - expected).abs() < 1e-9, "{place}: {} in place of {expected}", first("r.force"));
            assert!((0.1 * first("arm.alpha") + expected * arm).abs() < 1e-9, "{place}: {}", first("arm.alpha"));
        }
    }
}
