//! Events beside each other and beside nominal times: each happens once, at its time and in its order.

mod common;

use std::f64::consts::PI;

use common::{last, model_with_forces as model, run_every as run};
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

/// An event whose input turns the motion back, at the end of a step to round-off, is not seen again on the way back.
#[test]
fn what_turns_back_at_an_event_is_no_second_one() {
    let text = "[input.u]\ndefault = 1\n[point.a]\nmass = 1\nposition = [0, 0, 0]\n\
                [force.f]\ntype = \"expression\"\npoint = \"a\"\nforce = [\"u\", 0, 9.81]\n\
                [event.still]\nwhen = \"a.vx\"\nset = { u = -1 }\n\
                [event.right]\nwhen = \"a.vx - 0.05\"\ndirection = \"rising\"\nset = { u = -1 }\n\
                [event.left]\nwhen = \"a.vx + 0.05\"\ndirection = \"falling\"\nset = { u = 1 }\n";
    for (method, step) in [("conserving-ggl", 0.01), ("radau", 0.01), ("generalized-alpha", 0.05), ("conserving", 0.013)] {
        let (simulation, _) = run(&model(text), method, step, 2.02, 1);
        // Right at 0.05 s, then still and left in turns.
        let expected: Vec<(&str, f64)> = (1..=40)
            .map(|k| {
                (
                    if k == 1 {
                        "right"
                    } else if k % 2 == 0 {
                        "still"
                    } else {
                        "left"
                    },
                    0.05 * f64::from(k),
                )
            })
            .collect();
        let found: Vec<&str> = simulation.events().iter().map(|event| event.event.as_str()).collect();
        assert_eq!(found, expected.iter().map(|(name, _)| *name).collect::<Vec<_>>(), "{method}");
        for (event, (_, t)) in simulation.events().iter().zip(&expected) {
            assert!((event.t - t).abs() < 1e-10, "{method}: {event:?} and {t} s");
        }
    }
}

/// Two events that are closer together than a millionth of a step, right behind a nominal time, happen one after the other as they do in time,
/// whatever their order in the file.
#[test]
fn close_events_happen_in_the_order_of_time() {
    let early = "[event.early]\nwhen = \"p.x - 0.5\"\nset = { n = \"n + 1\" }\n";
    let late = "[event.late]\nwhen = \"t - 0.5 - 1e-9\"\nset = { n = \"2*n\" }\n";
    for (first, second) in [(early, late), (late, early)] {
        let text = format!("plane = \"xy\"\n[point.p]\nmass = 1\nposition = [0, 0]\nvelocity = [1, 0]\n[input.n]\n{first}{second}");
        for (method, accuracy) in [("radau", Some(1e-6)), ("radau", None), ("conserving-ggl", None), ("ode/dop853", Some(1e-8))] {
            let choice = Choice { accuracy, ..Choice::default().named(method) };
            let mut simulation = Simulation::new(model(&text).system, Method::resolve(&choice).unwrap(), 0.1).unwrap();
            assert_eq!(simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn), Status::Completed);
            assert_eq!(simulation.input("n"), Some(2.0), "{method}, {accuracy:?}");
        }
    }
}

/// A ball passes a height and comes back, and one event is for each way, where another divides the same step.
#[test]
fn an_event_for_each_way_through_a_height() {
    let text = "plane = \"xz\"\n[point.ball]\nmass = 1\nposition = [0, 0]\nvelocity = [1, 5]\n[input.on]\n\
                [event.up]\nwhen = \"ball.z - 1.274\"\ndirection = \"rising\"\nset = { on = 1 }\n\
                [event.down]\nwhen = \"ball.z - 1.274\"\ndirection = \"falling\"\nset = { on = 0 }\n\
                [event.e]\nwhen = \"sin(3*t) - 0.9999\"\n";
    let model = model(text);
    let root = (25.0_f64 - 2.0 * 9.81 * 1.274).sqrt();
    for method in ["radau", "gauss", "conserving-ggl", "dopri5", "generalized-alpha"] {
        let (simulation, recording) = run(&model, method, 0.02, 1.0, 1);
        let times: Vec<f64> = simulation.events().iter().filter(|event| event.event != "e").map(|event| event.t).collect();
        let exact = [(5.0 - root) / 9.81, (5.0 + root) / 9.81];
        let within = if method == "generalized-alpha" { 1e-3 } else { 1e-9 };
        assert!(times.len() == 2 && times.iter().zip(exact).all(|(t, exact)| (t - exact).abs() < within), "{method}: {times:?}");
        assert_eq!(last(&recording, "on"), 0.0, "{method}");
    }
}

/// A height that is passed at the time at which something else happens, where a method ends its steps on both sides of that time.
#[test]
fn two_events_at_one_time_of_a_formula_end() {
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[point.m]\nmass = 1\nposition = [0, 0]\nvelocity = [0, 1]\n[input.u]\n[input.n]\n\
                [event.a]\nwhen = \"m.y - 0.5\"\nset = { u = 1, n = \"n + 1\" }\n[event.e]\nwhen = \"step(t - 0.5) - 0.5\"\nset = { n = \"n + 10\" }\n\
                [force.f]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"10*u\", 0]\n";
    let model = model(text);
    for method in ["dop853", "dopri5", "radau", "conserving-ggl"] {
        let choice = Choice { accuracy: Some(1e-6), ..Choice::default().named(method) };
        let recording = common::run(&model, choice, 0.005, 1.0).1;
        let [x, v, n] = ["m.x", "m.vx", "n"].map(|name| last(&recording, name));
        assert!((x - 1.25).abs() < 1e-6 && (v - 5.0).abs() < 1e-6 && n == 11.0, "{method}: {x} m, {v} m/s, {n}");
    }
}

/// Events within a millionth of a step behind a nominal time, at which others happen, happen once.
#[test]
fn events_right_behind_a_nominal_time_happen_once() {
    let conditions = ["p.y^2 - 0.25", "p.y - 0.500000001", "floor(t/0.500000001) - 0.5", "t - 0.5"];
    let event = |(k, when): (usize, &str)| {
        format!("[input.n{k}]\n[event.e{k}]\nwhen = \"{when}\"\ndirection = \"rising\"\nset = {{ n{k} = \"n{k} + 1\" }}\n")
    };
    let events: String = conditions.into_iter().enumerate().map(event).collect();
    let text = format!(
        "plane = \"xy\"\ngravity = [0, 0]\n[point.p]\nmass = 1\nposition = [0, 0]\nvelocity = [0, 1]\n\
         [input.c]\n[event.clock]\nevery = 0.037\nset = {{ c = \"c + 1\" }}\n{events}\
         [force.f]\ntype = \"expression\"\npoint = \"p\"\nforce = [\"n0 + n1 + n2 + n3\", 0]\n"
    );
    let model = model(&text);
    for (method, accuracy) in
        [("radau", None), ("radau", Some(1e-7)), ("conserving-ggl", None), ("dopri5", Some(1e-7)), ("ggl/bdf", Some(1e-5))]
    {
        let choice = Choice { accuracy, ..Choice::default().named(method) };
        let recording = common::run(&model, choice, 0.01, 1.0).1;
        let counts = ["n0", "n1", "n2", "n3", "c"].map(|name| last(&recording, name));
        assert_eq!(counts, [1.0, 1.0, 1.0, 1.0, 28.0], "{method}, {accuracy:?}");
        assert!((last(&recording, "p.vx") - 2.0).abs() < 1e-6, "{method}, {accuracy:?}: {}", last(&recording, "p.vx"));
    }
}

/// A ball that falls on a stiff spring far from the origin, where rounding of its place decides for a moment on which side of the spring's end
/// it is. It touches it and leaves it in turn, at times that are known.
#[test]
fn what_went_through_zero_does_not_come_back_by_rounding() {
    let text = r#"
gravity = [0, 0, -10]

[point.ball]
mass = 1
position = [0, 0, 1000.2]

[force.spring]
type = "expression"
point = "ball"
force = [0, 0, "max(0, -1e6*(z - 1000))"]

[event.touches]
when = "ball.z - 1000"
direction = "falling"

[event.leaves]
when = "ball.z - 1000"
direction = "rising"
"#;
    let model = model(text);
    let (speed, rate): (f64, f64) = (2.0, 1e3);
    let contact = 2.0 / rate * (PI - (speed * rate / 10.0).atan());
    let between = contact + 0.4;
    let times = |k: usize| 0.2 + between * (k / 2) as f64 + contact * (k % 2) as f64;
    for method in ["ode/dopri5", "ode/dop853", "radau"] {
        for accuracy in [1e-6, 1e-8, 1e-10] {
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
            let (simulation, _) = common::run(&model, choice, 0.01, 2.1);
            let found = simulation.events();
            assert_eq!(found.len(), 10, "{method}, {accuracy:e}: {found:?}");
            // Errors of speed add up from touch to touch.
            for (k, event) in found.iter().enumerate() {
                let off = (event.t - times(k)).abs();
                assert!(
                    event.event == ["touches", "leaves"][k % 2] && off < 100.0 * accuracy,
                    "{method}, {accuracy:e}: {event:?}, {off:e} s off"
                );
            }
        }
    }
}

/// A pendulum that passes a mark which moves with time alone, one event for each way. Where the mark is ahead within the rounding of the time, the
/// pendulum is not.
#[test]
fn a_moving_mark_is_passed_to_and_fro() {
    let text = r#"
plane = "xz"

[body.arm]
mass = 1
inertia = 0.05
position = [0.5, 0]

[joint.pin]
type = "revolute"
between = ["ground", "arm"]
at = [0, 0]

[event.ahead]
when = "pin.angle - 0.8*sin(7*t)"
direction = "rising"

[event.behind]
when = "pin.angle - 0.8*sin(7*t)"
direction = "falling"
"#;
    let passes = |method: &str, accuracy: Option<f64>, step: f64| {
        let choice = Choice { accuracy, ..Choice::default().named(method) };
        let (simulation, _) = common::run(&model(text), choice, step, 20.0);
        simulation.events().iter().map(|event| (event.event.clone(), event.t)).collect::<Vec<_>>()
    };
    let exact = passes("radau", Some(1e-10), 0.01);
    assert_eq!(exact.len(), 12);
    for method in ["conserving-ggl", "radau", "gauss", "generalized-alpha", "trapezoidal-projected", "ode/dopri5"] {
        let accuracy = (method == "ode/dopri5").then_some(1e-9);
        for (step, within) in [(0.01, 0.1), (0.001, 1e-3)] {
            let found = passes(method, accuracy, step);
            assert_eq!(found.len(), exact.len(), "{method}, {step} s: {found:?}");
            for ((name, t), (known, time)) in found.iter().zip(&exact) {
                assert!(name == known && (t - time).abs() < within, "{method}, {step} s: {name} at {t} s, and {known} at {time} s");
            }
        }
    }
}

/// A mass that a shaken plate throws: where events latch the contact in an input, it goes as with a force that sees the gap itself.
#[test]
fn a_contact_that_events_switch_is_one() {
    let text = |force: &str| {
        format!(
            "plane = \"xz\"\n[input.contact]\ndefault = 1\n[point.ball]\nmass = 0.2\nposition = [0, 0.1]\n\
             [measure.gap]\nvalue = \"ball.z - 0.1 - 0.004*sin(90*t)\"\nunit = \"m\"\n\
             [force.plate]\ntype = \"expression\"\npoint = \"ball\"\nforce = [0, \"{force} - 2*vz\"]\n\
             [event.lost]\nwhen = \"gap\"\ndirection = \"rising\"\nset = {{ contact = 0 }}\n\
             [event.regained]\nwhen = \"gap\"\ndirection = \"falling\"\nset = {{ contact = 1 }}\n"
        )
    };
    let [switched, seen] = ["contact*(-4e5*gap)", "max(0, -4e5*gap)"].map(|force| model(&text(force)));
    for (method, step) in [("conserving-ggl", 1e-4), ("conserving-ggl", 1e-3), ("radau", 1e-4), ("gauss", 1e-3)] {
        let [(one, of_one), (other, of_other)] = [&switched, &seen].map(|model| run(model, method, step, 1.0, 1));
        for simulation in [one, other] {
            let names: Vec<&str> = simulation.events().iter().map(|event| event.event.as_str()).collect();
            let alternate = names.iter().enumerate().all(|(k, name)| *name == ["lost", "regained"][k % 2]);
            assert!(alternate && names.len() >= 13, "{method}, {step} s: {names:?}");
        }
        // Where a step takes the force across its corner the other ends at it.
        let apart = (last(&of_one, "ball.z") - last(&of_other, "ball.z")).abs();
        assert!(apart < 1e-7, "{method}, {step} s: {apart:e} m");
    }
}
