//! Events: their times, what they set, and what goes on behind them.

mod common;

use std::f64::consts::PI;

use common::{OSCILLATOR, last, model_with_forces as model, run_every as run, simulation};
use holonom::analysis::rank;
use holonom::simulation::{Checkpoint, Choice, Method, Simulation, Status, Verdict};

/// A ball thrown up reaches heights and its top at times that are known; at one of them an input is set.
#[test]
fn events_happen_at_their_times() {
    let text = r#"
gravity = [0, 0, -10]

[input.wind]

[point.ball]
mass = 2
position = [0, 0, 1]
velocity = [0, 0, 5]

[force.wind-force]
type = "expression"
point = "ball"
force = ["wind", 0, 0]

[event.top]
when = "ball.vz"
direction = "falling"
set = { wind = 4 }

[event.window]
when = "ball.z - 2"

[event.late]
when = "t - 0.777"

[event.landing]
when = "ball.z"
direction = "falling"
stop = true
"#;
    let model = model(text);
    let landing = 0.5 + (0.25_f64 + 0.2).sqrt();
    let root = (0.25_f64 - 0.2).sqrt();
    let expected = [("window", 0.5 - root), ("top", 0.5), ("window", 0.5 + root), ("late", 0.777), ("landing", landing)];
    let mut expected = expected.to_vec();
    expected.sort_by(|a, b| a.1.total_cmp(&b.1));
    for (method, step) in
        [("conserving-ggl", 0.03), ("conserving", 0.0317), ("radau", 0.05), ("trapezoidal-projected", 0.07), ("generalized-alpha", 0.03)]
    {
        let (simulation, recording) = run(&model, method, step, 5.0, 1);
        let found: Vec<(&str, f64)> = simulation.events().iter().map(|event| (event.event.as_str(), event.t)).collect();
        assert_eq!(found.len(), expected.len(), "{method}: {found:?}");
        for ((name, t), (known, time)) in found.iter().zip(&expected) {
            assert!(name == known && (t - time).abs() < 1e-10, "{method}: {name} at {t}, and {known} at {time}");
        }
        assert!((simulation.state().t - landing).abs() < 1e-10 && last(&recording, "ball.z").abs() < 1e-9, "{method}");
        // From the top on the wind blows with 2 m/s².
        assert!((last(&recording, "ball.x") - (landing - 0.5).powi(2)).abs() < 1e-9, "{method}: {}", last(&recording, "ball.x"));
        let times = recording.column("t").unwrap();
        assert!((times[3] - 3.0 * step).abs() < 1e-12, "{method}: rows stay at nominal times, and not {}", times[3]);
    }
}

/// A mass that leaves a buffer, which only pushes: half a period of the mass on its spring after it came.
#[test]
fn lift_off_from_a_stop_is_found() {
    let text = r#"
gravity = [0, 0, 0]

[body.block]
mass = 1
shape = { box = [0.1, 0.1, 0.1] }
position = [0, 0, 0]
velocity = [2, 0, 0]

[joint.rail]
type = "prismatic"
between = ["ground", "block"]
at = [0, 0, 0]
axis = [1, 0, 0]

[force.buffer]
type = "stop"
joint = "rail"
stiffness = 400
upper = 0.3

[event.contact]
when = "rail.displacement - 0.3"
direction = "rising"

[event.lift-off]
when = "rail.displacement - 0.3"
direction = "falling"
"#;
    let (simulation, _) = run(&model(text), "radau", 0.002, 0.5, 1);
    let times: Vec<f64> = simulation.events().iter().map(|event| event.t).collect();
    let expected = [0.15, 0.15 + PI / 20.0];
    assert!(times.len() == 2 && times.iter().zip(expected).all(|(t, known)| (t - known).abs() < 1e-7), "{times:?}, {expected:?}");
}

/// Events a hair before, at and a hair behind nominal times: rows stay at nominal times, none stands twice, and steps are counted as such.
#[test]
fn events_beside_nominal_times_leave_rows_there() {
    for method in ["conserving-ggl", "radau", "generalized-alpha"] {
        for (beside, stop) in [-1e-9, -3e-17, 0.0, 3e-17, 1e-9, 1.4e-8, 0.004].map(|beside| [(beside, false), (beside, true)]).concat() {
            let text = format!(
                "{OSCILLATOR}[event.beside]\nwhen = \"t - 0.3 - ({beside:e})\"\nstop = {stop}\n\
                 [event.also]\nwhen = \"2*t - 0.6 - 2*({beside:e})\"\n"
            );
            let (simulation, recording) = run(&model(&text), method, 0.01, 0.6, 1);
            let of = format!("{method}, {beside:e} s beside, stop = {stop}");
            let found: Vec<&str> = simulation.events().iter().map(|event| event.event.as_str()).collect();
            // Where the first of two that come together stops the run, the other may be one rounding of time away.
            assert!(found == ["beside", "also"] || stop && found == ["beside"], "{of}: {found:?}");
            for event in simulation.events() {
                assert!((event.t - 0.3 - beside).abs() < 1e-12, "{of}: {} s", event.t - 0.3);
            }
            let end = if stop { 0.3 + beside } else { 0.6 };
            assert!((simulation.state().t - end).abs() < 2e-8, "{of}");
            let times = recording.column("t").unwrap();
            let (last, whole) = times.split_last().unwrap();
            assert!((last - end).abs() < 2e-8, "{of}");
            assert!(whole.iter().enumerate().all(|(k, t)| (t - 0.01 * k as f64).abs() < 1e-14), "{of}: {times:?}");
            assert!(times.windows(2).all(|pair| pair[1] > pair[0]), "{of}: {times:?}");
            assert_eq!(simulation.steps(), whole.len() as u64, "{of}");
            assert!((simulation.state().x[0] - 1.0 - (2.0 * simulation.state().t).cos()).abs() < 1e-3, "{of}");
            let size = rank(simulation.system(), &simulation.state().x, 0.0).size(simulation.system());
            let summary = simulation.summary("", 0.6, &Status::Completed, size);
            assert_eq!(summary.ended_by.as_deref(), stop.then_some("beside"), "{of}");
        }
    }
}

/// An event and the one that it causes, which ends the run: a hair before a nominal time, at it, a hair behind it, and within a step.
#[test]
fn the_last_row_is_what_the_events_that_ended_the_run_left() {
    for at in ["0.9999999999", "1", "1.0000000001", "1.005"] {
        let text = format!(
            "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.n]\n\
             [event.a]\nwhen = \"p.x - {at}\"\nset = {{ n = 1 }}\n[event.b]\nwhen = \"n - 0.5\"\nstop = true\n\
             [measure.most]\nvalue = \"max(n)\"\n"
        );
        for method in ["conserving-ggl", "radau", "ode/rk4", "dopri5"] {
            for every in [1, 7] {
                let (simulation, recording) = run(&model(&text), method, 0.01, 2.0, every);
                let of = format!("{at}, {method}, every {every}");
                assert_eq!(simulation.ended_by().map(|event| event.event.as_str()), Some("b"), "{of}");
                assert_eq!(["n", "most"].map(|column| last(&recording, column)), [1.0; 2], "{of}");
                let times = recording.column("t").unwrap();
                assert_eq!(times.last(), Some(&simulation.state().t), "{of}");
                assert!(times.windows(2).all(|pair| pair[1] > pair[0]), "{of}: {times:?}");
                // The row before is the one that it is without events.
                assert_eq!(recording.column("n").unwrap()[times.len() - 2], 0.0, "{of}");
            }
        }
    }
}

/// A condition that has no value at some time is nothing that "does not happen": the run stops and names it.
#[test]
fn a_condition_without_a_value_stops_the_run() {
    let text = format!("{OSCILLATOR}[event.lost]\nwhen = \"sqrt(bob.x - 0.9) - 1\"\n");
    let mut simulation = simulation(&model(&text), "conserving-ggl", 0.01);
    let Status::Stopped { at, reason } = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn) else { panic!("it is completed") };
    assert!(reason.contains("`lost`") && at < 0.5 * (-0.1_f64).acos(), "{reason} at {at} s");
}

/// An encoder: an event that moves its own threshold happens at each of them, with several in a nominal step and with several steps between.
#[test]
fn an_event_may_move_its_own_threshold() {
    let text = "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.next]\ndefault = 0.007\n[input.n]\n\
                [event.tick]\nwhen = \"p.x - next\"\ndirection = \"rising\"\nset = { next = \"next + 0.007\", n = \"n + 1\" }\n";
    for method in ["conserving-ggl", "radau", "dopri5"] {
        for step in [0.1, 0.01, 0.001] {
            let (simulation, _) = run(&model(text), method, step, 1.0, 1);
            assert_eq!(simulation.input("n"), Some(142.0), "{method}, {step} s");
            for (k, event) in simulation.events().iter().enumerate() {
                assert!((event.t - 0.007 * (k + 1) as f64).abs() < 1e-10, "{method}, {step} s: {event:?}");
            }
        }
    }
}

/// A speed that is reached once is an event once, also with methods whose velocities lie beside the rows and are put on them where inputs are set.
#[test]
fn a_speed_is_reached_once() {
    let text = "plane = \"xy\"\n[point.p]\nmass = 1\nposition = [1, 0]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"p\"]\n\
                [input.push]\ndefault = 1\n[force.f]\ntype = \"expression\"\npoint = \"p\"\nforce = [\"-push*y\", \"push*x\"]\n\
                [event.fast]\nwhen = \"p.vx^2 + p.vy^2 - 1.7\"\nset = { push = 2 }\n";
    for method in ["generalized-alpha", "lagrange-3/hht", "trapezoidal", "conserving", "radau"] {
        for step in [0.1, 0.03, 0.01] {
            let (simulation, _) = run(&model(text), method, step, 2.0, 1);
            let times: Vec<f64> = simulation.events().iter().map(|event| event.t).collect();
            assert!(times.len() == 1 && (times[0] - 1.7_f64.sqrt()).abs() < step * step, "{method}, {step} s: {times:?}");
        }
    }
}

/// It goes on from a checkpoint as it would have without, also from the very time of an event.
#[test]
fn thresholds_go_on_from_checkpoints() {
    let text = "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.next]\ndefault = 0.05\n[input.n]\n\
                [event.tick]\nwhen = \"p.x - next\"\ndirection = \"rising\"\nset = { next = \"next + 0.05\", n = \"n + 1\" }\n";
    let model = model(text);
    for of in ["conserving-ggl", "radau"] {
        for step in [0.1, 0.05, 0.02] {
            let method = || Method::resolve(&Choice::default().named(of)).unwrap();
            let mut whole = Simulation::new(model.system.clone(), method(), step).unwrap();
            for end in [0.1, 0.3, 0.5] {
                assert_eq!(whole.step_to(end), Status::Completed);
                let checkpoint = serde_json::to_string(&whole.checkpoint()).unwrap();
                let checkpoint: Checkpoint = serde_json::from_str(&checkpoint).unwrap();
                let mut rest = Simulation::resume(model.system.clone(), method(), step, checkpoint).unwrap();
                let mut clone = Simulation::resume(model.system.clone(), method(), step, whole.checkpoint()).unwrap();
                let ends = [&mut rest, &mut clone].map(|simulation| {
                    assert_eq!(simulation.step_to(1.02), Status::Completed);
                    simulation.input("n")
                });
                assert_eq!(ends, [Some(20.0); 2], "{of}, {step} s, from {end} s");
            }
        }
    }
}

/// A relay without hysteresis switches without end where either side drives it back to the other: the run ends there, and says so.
#[test]
fn a_relay_that_chatters_ends_the_run() {
    let text = "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.u]\ndefault = -1\n\
                [event.up]\nwhen = \"p.vx + p.x - 0.5\"\ndirection = \"rising\"\nset = { u = -1 }\n\
                [event.down]\nwhen = \"p.vx + p.x - 0.5\"\ndirection = \"falling\"\nset = { u = 1 }\n\
                [force.f]\ntype = \"expression\"\npoint = \"p\"\nforce = [\"2*u\", 0, 0]\n";
    for method in ["conserving-ggl", "radau", "generalized-alpha"] {
        for step in [0.1, 0.01] {
            let model = model(text);
            let method = Method::resolve(&Choice::default().named(method)).unwrap();
            let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
            match simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn) {
                Status::Stopped { at, reason } => {
                    assert!((at - 0.3660254037844386).abs() < 1e-6 && reason.contains("happens again and again"), "{at} s: {reason}");
                }
                status => panic!("{status:?}"),
            }
        }
    }
}

/// The same relay on a speed that comes to zero within the rounding of a step's end, or right behind it: wherever rounding puts it, the run does not go on.
#[test]
fn a_relay_chatters_wherever_rounding_puts_it() {
    for speed in [-0.5, -0.503, -0.52, -0.7] {
        let model = model(&format!(
            "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [{speed}, 0, 0]\n[input.u]\ndefault = 1\n\
             [event.up]\nwhen = \"p.vx\"\ndirection = \"rising\"\nset = {{ u = -1 }}\n\
             [event.down]\nwhen = \"p.vx\"\ndirection = \"falling\"\nset = {{ u = 1 }}\n\
             [force.f]\ntype = \"expression\"\npoint = \"p\"\nforce = [\"u\", 0, 0]\n"
        ));
        for (method, accuracy) in [
            ("conserving-ggl", None),
            ("conserving", None),
            ("radau", None),
            ("radau", Some(1e-6)),
            ("generalized-alpha", None),
            ("trapezoidal-projected", None),
            ("ode/rk4", None),
            ("ode/dopri5", Some(1e-6)),
            ("ode/dop853", Some(1e-8)),
            ("ggl/bdf-3", Some(1e-5)),
        ] {
            let choice = Choice { accuracy, ..Choice::default().named(method) };
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
            let Status::Stopped { at, reason } = simulation.run(2.0, &mut |_: &Simulation| Verdict::GoOn) else {
                panic!("{speed} m/s, {method} {accuracy:?}: it went on")
            };
            assert!(
                (at + speed).abs() < 1e-9 && reason.contains("happens again and again"),
                "{speed} m/s, {method} {accuracy:?}: {at} s: {reason}"
            );
        }
    }
}

/// A force of 10 N on 1 kg that is on for nine tenths of each 20 ms: its edges are nominal times, where rounding decides on which side of them they are.
#[test]
fn pulses_with_edges_at_nominal_times_miss_none() {
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [0, 0]\n[input.u]\ndefault = 1\n\
                [event.off]\nwhen = \"mod(t, 0.02) - 0.9*0.02\"\ndirection = \"rising\"\nset = { u = 0 }\n\
                [event.on]\nwhen = \"mod(t, 0.02) - 0.9*0.02\"\ndirection = \"falling\"\nset = { u = 1 }\n\
                [force.f]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"10*u\", 0]\n";
    let model = model(text);
    for method in ["conserving-ggl", "radau", "dopri5"] {
        for step in [2e-3, 1e-3, 4e-4] {
            let (simulation, recording) = run(&model, method, step, 1.0, 1);
            let found = last(&recording, "m.vx");
            assert!((found - 9.0).abs() < 1e-8, "{method}, {step} s: {found} m/s");
            let count = |name: &str| simulation.events().iter().filter(|event| event.event == name).count();
            assert_eq!([count("off"), count("on")], [50, 50], "{method}, {step} s");
        }
    }
}

/// An event of time inside a step of a method that reads what is between the ends of its steps: what it sets counts from its time on, once.
#[test]
fn what_is_set_inside_long_steps_counts_from_then_on() {
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [0, 0]\n[input.u]\n[input.n]\n\
                [event.a]\nwhen = \"step(t - 50) - 0.5\"\nset = { u = 1, n = \"n + 1\" }\n\
                [force.f]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"u\", 0]\n";
    let model = model(text);
    for method in ["dopri5", "dop853", "radau"] {
        for accuracy in [1e-4, 1e-8] {
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
            let recording = common::run(&model, choice, 10.0, 100.0).1;
            let [x, v, n] = ["m.x", "m.vx", "n"].map(|name| last(&recording, name));
            assert!((x - 1250.0).abs() < 1e-6 && (v - 50.0).abs() < 1e-8 && n == 1.0, "{method}, {accuracy:e}: {x} m, {v} m/s, {n}");
        }
    }
}

/// An input that is set where a force jumps by itself, whatever its formula of time is rounded to there: steps by accuracy end before both and go on.
#[test]
fn events_where_formulas_of_time_jump_are_no_obstacle() {
    for (force, time, speed) in [
        ("floor(t + 0.75)", "0.25", 1.5),
        ("step(t + 0.75 - 1)", "0.25", 1.5),
        ("sign(t + 0.75 - 1)", "0.25", 1.25),
        ("-floor(0.3 - 7*t)", "2.3/7", 30.6 / 7.0),
        ("mod(4*t + 0.3, 1)", "0.175", 0.5 + 0.825),
    ] {
        let text = format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [0, 0]\n[input.u]\n\
             [event.e]\nwhen = \"t - {time}\"\nset = {{ u = 1 }}\n\
             [force.f]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"u + {force}\", 0]\n"
        );
        let model = model(&text);
        for method in ["radau", "dopri5", "dop853", "ggl/bdf", "conserving-ggl"] {
            let choice = Choice { accuracy: Some(1e-6), ..Choice::default().named(method) };
            let (simulation, recording) = common::run(&model, choice, 0.01, 1.0);
            let v = last(&recording, "m.vx");
            assert!((v - speed).abs() < 1e-6 && simulation.events().len() == 1, "{force} by {method}: {v} m/s in place of {speed}");
        }
    }
}

/// Pulses of 1 N at 100 Hz whose width follows a sine: the widths are found here by halving. Steps by accuracy end where `mod` jumps, and what it did before
/// that counts.
#[test]
fn pulses_of_changing_width_miss_none() {
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [0, 0]\n[input.u]\ndefault = 1\n[input.n]\n\
                [event.off]\nwhen = \"0.5 + 0.45*sin(6*t) - mod(t, 0.01)/0.01\"\ndirection = \"falling\"\nset = { u = 0, n = \"n + 1\" }\n\
                [event.on]\nwhen = \"0.5 + 0.45*sin(6*t) - mod(t, 0.01)/0.01\"\ndirection = \"rising\"\nset = { u = 1, n = \"n + 1\" }\n\
                [force.f]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"u\", 0]\n";
    let width = |k: u32| {
        let (mut low, mut high) = (0.0, 0.01);
        for _ in 0..60 {
            let t = 0.5 * (low + high);
            *if 0.5 + 0.45 * (6.0 * (0.01 * f64::from(k) + t)).sin() > t / 0.01 { &mut low } else { &mut high } = t;
        }
        low
    };
    let speed: f64 = (0..100).map(width).sum();
    let model = model(text);
    for (method, accuracy, step) in [
        ("conserving-ggl", None, 1e-3),
        ("conserving-ggl", Some(1e-6), 0.1),
        ("radau", Some(1e-6), 0.1),
        ("radau", Some(1e-6), 0.01),
        ("dopri5", Some(1e-6), 0.1),
        ("dop853", Some(1e-6), 7e-3),
        ("ggl/bdf", Some(1e-6), 0.1),
    ] {
        let choice = Choice { accuracy, ..Choice::default().named(method) };
        let recording = common::run(&model, choice, step, 1.0).1;
        let [v, n] = ["m.vx", "n"].map(|name| last(&recording, name));
        assert!((v - speed).abs() < 1e-9 && n == 200.0, "{method}, {accuracy:?}, {step} s: {v} m/s in place of {speed}, {n}");
    }
}

/// What one event sets makes others happen at once, and what these set makes one of them happen again: each of these counts. Where that never ends,
/// the run does.
#[test]
fn what_jumps_twice_at_one_time_happens_twice() {
    let kicked = |second: &str| {
        format!(
            "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.u]\n[input.left]\ndefault = 3\n[input.count]\n\
             [event.down]\nwhen = \"u - 0.5\"\ndirection = \"falling\"\nset = {{ u = \"step(left - 0.5)\", count = \"count + 1\" }}\n\
             [event.up]\nwhen = \"u - 0.5\"\ndirection = \"rising\"\nset = {{ u = 0, left = \"{second}\" }}\n\
             [event.kick]\nwhen = \"p.x - 0.503\"\nset = {{ u = 1 }}\n"
        )
    };
    let run = |method: &str, second: &str| {
        let method = Method::resolve(&Choice::default().named(method)).unwrap();
        let mut simulation = Simulation::new(model(&kicked(second)).system.clone(), method, 0.01).unwrap();
        let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
        (simulation, status)
    };
    for method in ["conserving-ggl", "radau"] {
        let (simulation, status) = run(method, "left - 1");
        assert!(matches!(status, Status::Completed), "{status:?}");
        assert_eq!(["u", "left", "count"].map(|name| simulation.input(name)), [Some(0.0), Some(0.0), Some(3.0)]);
        let times: Vec<f64> = simulation.events().iter().map(|event| event.t).collect();
        assert!(times.len() == 7 && times.iter().all(|t| (t - 0.503).abs() < 1e-12), "{:?}", simulation.events());
        let (_, status) = run(method, "left");
        assert!(matches!(&status, Status::Stopped { reason, .. } if reason.contains("happens again and again")), "{status:?}");
    }
}

/// A threshold that is always half way to a place is passed without end before that: where steps by accuracy come to their end there, the event is named.
#[test]
fn an_event_that_happens_sooner_and_sooner_is_named() {
    let text = "gravity = [0, 0, 0]\n[point.p]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 0, 0]\n[input.goal]\ndefault = 0.25\n[input.push]\n\
                [event.nearer]\nwhen = \"p.x - goal\"\ndirection = \"rising\"\nset = { goal = \"0.5*p.x + 0.25\", push = \"-push\" }\n\
                [force.f]\ntype = \"expression\"\npoint = \"p\"\nforce = [0, \"push\", 0]\n";
    for (name, accuracy) in [("radau", 1e-8), ("dopri5", 1e-6)] {
        let method = Method::resolve(&Choice { accuracy: Some(accuracy), ..Choice::default().named(name) }).unwrap();
        let mut simulation = Simulation::new(model(text).system.clone(), method, 0.01).unwrap();
        match simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn) {
            Status::Stopped { at, reason } => assert!((at - 0.5).abs() < 1e-6 && reason.contains("`nearer` happens"), "{at} s: {reason}"),
            status => panic!("{name}: {status:?}"),
        }
    }
}
