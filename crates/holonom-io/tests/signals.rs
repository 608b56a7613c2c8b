//! Measures, tables, inputs and events, against closed forms and against the same written otherwise.

mod common;

use std::f64::consts::PI;

use common::{distance, model_with_forces as model, run_every as run, simulation, source};
use holonom::analysis::rank;
use holonom::record::{Constraints, Peaks, Recorder, Recording};
use holonom::simulation::{Checkpoint, Choice, Method, Simulation, Status, Verdict};

fn last(recording: &Recording, name: &str) -> f64 {
    *recording.column(name).unwrap_or_else(|| panic!("there is no column {name}")).last().unwrap()
}

/// A mass on a spring: x = 1 + cos(2 t), so that what measures say is known.
const OSCILLATOR: &str = r#"
gravity = [0, 0, 0]

[point.bob]
mass = 1
position = [2, 0, 0]

[point.stand]
position = [0, 3, 0]
fixed = true

[force.spring]
type = "spring"
between = ["ground", "bob"]
stiffness = 4
rest_length = 1

[constraint.line]
type = "point-on-line"
point = "bob"
through = [0, 0, 0]
direction = [1, 0, 0]
"#;

#[test]
fn measures_are_what_their_formulas_say() {
    let text = format!(
        r#"{OSCILLATOR}
[measure.away]
value = "distance(bob, stand)"
unit = "m"

[measure.closing]
value = "speed(stand, bob)"

[measure.corner]
value = "angle(bob, ground, stand)"

[measure.twice]
value = "2*pull"

[measure.pull]
value = "spring.force + 'spring.length' - bob.x"

[measure.largest]
value = "max(bob.x)"

[measure.lowest]
value = "min(bob.x)"

[measure.swing]
value = "rms(bob.x - 1)"

[measure.way]
value = "integral(bob.vx)"

[measure.kick]
value = "max(abs(bob.ax))"
"#
    );
    let model = model(&text);
    let (_, recording) = run(&model, "radau", 1e-3, PI, 1);
    let column = |name: &str| recording.column(name).unwrap();
    for k in 0..recording.rows() {
        let t = column("t")[k];
        let (x, v) = (1.0 + (2.0 * t).cos(), -2.0 * (2.0 * t).sin());
        let away = x.hypot(3.0);
        let expected = [("away", away), ("closing", x * v / away), ("pull", 4.0 * (x - 1.0)), ("twice", 8.0 * (x - 1.0)), ("way", x - 2.0)];
        for (name, value) in expected {
            // The integral of a velocity is one by straight pieces: h²/12 of its second derivative, 8 m/s³.
            let allowed = if name == "way" { 1e-6 * 8.0 / 12.0 * PI } else { 1e-9 };
            assert!((column(name)[k] - value).abs() < allowed, "{name} at {t}: {} and not {value}", column(name)[k]);
        }
        if x > 1e-3 {
            assert!((column("corner")[k] - PI / 2.0).abs() < 1e-9, "at the ground between the line and the stand");
        }
    }
    let at_end = [("largest", 2.0), ("lowest", 0.0), ("swing", 0.5_f64.sqrt()), ("kick", 4.0)];
    for (name, value) in at_end {
        assert!((last(&recording, name) - value).abs() < 2e-6, "{name}: {} and not {value}", last(&recording, name));
    }
    assert_eq!(recording.find("away").unwrap().heading.unit, "m");
    assert_eq!(recording.find("twice").unwrap().heading.meaning, "2*pull");
    let peaks = Peaks::of(&model.channels, &recording);
    let away = peaks.measures.iter().find(|measure| measure.name == "away").unwrap();
    assert!((away.max - 13.0_f64.sqrt()).abs() < 1e-12 && away.max_at < 1e-9 && (away.min - 3.0).abs() < 1e-6, "{away:?}");
}

/// What is of the whole run sees every step, whatever is recorded, and goes on where a run is resumed.
#[test]
fn running_values_see_every_step_and_are_resumed() {
    let text = format!("{OSCILLATOR}\n[measure.largest]\nvalue = \"max(bob.vx)\"\n\n[measure.way]\nvalue = \"integral(abs(bob.vx))\"\n");
    let model = model(&text);
    let (_, fine) = run(&model, "conserving", 0.01, 3.0, 1);
    let (_, coarse) = run(&model, "conserving", 0.01, 3.0, 50);
    for name in ["largest", "way"] {
        assert_eq!(last(&fine, name).to_bits(), last(&coarse, name).to_bits(), "{name}");
    }
    let mut first = simulation(&model, "conserving", 0.01);
    let mut recorder = Recorder::new(&model.channels, &model.system, 50, Constraints::Joints);
    assert_eq!(first.run(1.37, &mut recorder), Status::Completed);
    let mark = recorder.mark();
    let mut recorder = Recorder::new(&model.channels, &model.system, 50, Constraints::Joints).resume(&mark);
    assert_eq!(first.run(3.0, &mut recorder), Status::Completed);
    let resumed = recorder.finish();
    for name in ["largest", "way", "bob.x"] {
        assert!((last(&resumed, name) - last(&coarse, name)).abs() < 1e-12, "{name}");
    }
}

/// A trolley that is driven to a place over the bob that hangs on it, by what the bob does.
const CRANE: &str = r#"
plane = "xz"

[input.command]
default = 2
unit = "m"

[body.trolley]
mass = 100
inertia = 10
position = [0, 0]

[body.load]
mass = 300
inertia = 30
position = [0.5, -5]

[joint.rail]
type = "prismatic"
between = ["ground", "trolley"]
at = [0, 0]
axis = [1, 0]

[joint.pivot]
type = "revolute"
between = ["trolley", "load"]
at = [0, 0]

[measure.sway]
value = "atan2(load.x - trolley.x, trolley.z - load.z)"
unit = "rad"
"#;

const BY_MEASURES: &str = r#"
[force.controller]
type = "effort"
joint = "rail"
effort = "80*(2 - q) - 150*q_rate + 400*sway"

[force.drag]
type = "force"
body = "load"
force = ["-3*(load.vx - trolley.vx)", "rail.displacement"]
"#;

/// The same by what was there before: coordinates of joints; the angle of the load begins at that of its start.
const BY_COORDINATES: &str = r#"
[force.controller]
type = "effort"
joint = "rail"
coordinates = { a = "pivot" }
effort = "80*(2 - q) - 150*q_rate + 400*(atan2(0.5, 5) + a)"
"#;

#[test]
fn forces_that_read_measures_keep_order_and_balance() {
    let model = model(&format!("{CRANE}{BY_MEASURES}"));
    let truth = run(&model, "radau", 2e-3, 4.0, 1).0;
    for (method, order) in
        [("conserving-ggl", 2.0), ("conserving", 2.0), ("trapezoidal-projected", 2.0), ("generalized-alpha", 2.0), ("bdf", 2.0)]
    {
        let errors = [0.02, 0.01].map(|step| distance(&run(&model, method, step, 4.0, 1).0, &truth));
        let found = (errors[0] / errors[1]).log2();
        assert!((found - order).abs() < 0.15, "{method}: order {found}, errors {errors:?}");
    }
    // The conserving schemes book the work of every force exactly.
    for method in ["conserving-ggl", "conserving"] {
        let (simulation, recording) = run(&model, method, 0.02, 4.0, 1);
        let energy = simulation.audit().energy_summary();
        let throughput: f64 = recording.column("controller.power").unwrap().iter().map(|power| power.abs() * 0.02).sum();
        assert!(energy.max_drift < 1e-10 * throughput, "{method}: {} of {throughput}", energy.max_drift);
    }
}

/// The same effort by a measure of places and by the coordinate of a joint: one is a load, the other a law.
#[test]
fn a_measure_of_places_is_as_good_as_a_coordinate() {
    let by_measure = CRANE.to_string() + BY_MEASURES.split("[force.drag]").next().unwrap();
    let by_measure = run(&model(&by_measure), "radau", 0.01, 3.0, 1).0;
    let by_coordinates = run(&model(&format!("{CRANE}{BY_COORDINATES}")), "radau", 0.01, 3.0, 1).0;
    let off = distance(&by_coordinates, &by_measure);
    assert!(off < 1e-9, "{off}");
}

/// An input that is set between steps has the bits of a table that has the same values where forces are taken, in the middle of each step.
#[test]
fn inputs_set_between_steps_are_those_of_a_known_function() {
    let effort = "\n[force.controller]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"80*(COMMAND - q) - 150*q_rate + 400*sway\"\n";
    let with_input = model(&format!("{CRANE}{}", effort.replace("COMMAND", "command")));
    let course = "[table.course]\npoints = [[0, 2], [0.995, 2], [1.005, 5], [9, 5]]\n";
    let with_table = model(&format!("{CRANE}{course}{}", effort.replace("COMMAND", "course(t)")));
    for method in ["conserving-ggl", "conserving"] {
        let (mut set, mut known) = (simulation(&with_input, method, 0.02), simulation(&with_table, method, 0.02));
        for simulation in [&mut set, &mut known] {
            assert_eq!(simulation.step_to(1.0), Status::Completed);
        }
        assert!(set.set_input("command", 5.0) && !set.set_input("comand", 5.0));
        assert_eq!(set.input("command"), Some(5.0));
        // A resumed run has the input that was set.
        let resumed = Simulation::resume(with_input.system.clone(), set.method().clone(), 0.02, set.checkpoint());
        let mut resumed = resumed.expect("it is of this model");
        with_input.find_reactions(&mut resumed);
        for simulation in [&mut set, &mut known, &mut resumed] {
            assert_eq!(simulation.step_to(2.0), Status::Completed);
        }
        assert_eq!(set.state().x, known.state().x, "{method}");
        assert_eq!(set.state().x, resumed.state().x, "{method}, resumed");
    }
}

#[test]
fn tables_are_the_functions_that_they_are_told_to_be() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("law.csv"), "# measured\nspeed, force ,other\n-2,8,1\n0,0,2\n2,-8,3\n").unwrap();
    let text = r#"
gravity = [0, 0, 0]

[table.law]
file = "law.csv"
x = "speed"
y = "force"
outside = "line"

[point.bob]
mass = 2
position = [1, 0, 0]
velocity = [3, 0, 0]

[force.brake]
type = "expression"
point = "bob"
force = ["law(vx)", 0, 0]
"#;
    let model = source(text).beside(folder.path()).model().unwrap_or_else(|message| panic!("{message}"));
    let (_, recording) = run(&model, "radau", 0.01, 1.0, 1);
    // The law is −4 v, also beyond its ends.
    assert!((last(&recording, "bob.vx") - 3.0 * (-2.0_f64).exp()).abs() < 1e-10);
}

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

/// Units are factors in measures, too, and an input that is called like one comes first.
#[test]
fn what_a_model_calls_like_a_unit_comes_before_it() {
    let text = "[input.bar]\ndefault = 3\n[measure.low]\nvalue = \"bob.x/mm\"\n[measure.pressure]\nvalue = \"2*bar + 0*bob.x\"\n";
    let (_, recording) = run(&model(&format!("{OSCILLATOR}{text}")), "radau", 0.01, 0.1, 1);
    assert!((last(&recording, "low") - 1e3 * last(&recording, "bob.x")).abs() < 1e-9);
    assert_eq!(last(&recording, "pressure"), 6.0);
}

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

/// A condition that has no value at some time is nothing that "does not happen": the run stops and names it.
#[test]
fn a_condition_without_a_value_stops_the_run() {
    let text = format!("{OSCILLATOR}[event.lost]\nwhen = \"sqrt(bob.x - 0.9) - 1\"\n");
    let mut simulation = simulation(&model(&text), "conserving-ggl", 0.01);
    let Status::Stopped { at, reason } = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn) else { panic!("it is completed") };
    assert!(reason.contains("`lost`") && at < 0.5 * (-0.1_f64).acos(), "{reason} at {at} s");
}

/// An effort may name the coordinates of more joints than a byte counts.
#[test]
fn an_effort_reads_any_of_many_coordinates() {
    let count = 140;
    let model = model(&format!(
        "[body.wheel]\nrepeat = \"i = 1 to {count}\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [\"i\", 0, 0]\n\
         angular_velocity = [0, \"0.01*i\", 0]\n\
         [joint.axle]\nrepeat = \"i = 1 to {count}\"\ntype = \"revolute\"\nbetween = [\"ground\", \"wheel[i]\"]\nat = [\"i\", 0, 0]\naxis = [0, 1, 0]\n\
         [force.drag]\ntype = \"effort\"\njoint = \"axle[1]\"\neffort = \"{}\"\n",
        (2..=count).map(|i| format!("0*'axle[{i}].angle'")).collect::<Vec<_>>().join("+") + &format!("+'axle[{count}].angle_rate'")
    ));
    let (simulation, _) = run(&model, "radau", 0.02, 0.02, 1);
    // The last wheel turns at 1.4 rad/s for 0.02 s, which is the torque on the first of 1 kg m².
    let [_, rate] = simulation.coordinate("axle[1].angle").unwrap();
    assert!((rate - (0.01 + 0.02 * 0.01 * f64::from(count))).abs() < 1e-10, "{rate}");
}

/// The jump of a measure that a force reads is one of the force: steps by accuracy end there.
#[test]
fn jumps_of_measures_end_steps_as_those_of_forces() {
    let rest = "[measure.push]\nvalue = \"10*step(t - 0.4321) + 5*wave(t)\"\n\
                [table.wave]\npoints = [[0, 0], [0.1234, 1], [0.2, 0]]\noutside = \"periodic\"\n\
                [force.f]\ntype = \"expression\"\npoint = \"bob\"\nforce = [\"FORCE\", 0, 0]\n";
    let counts = ["push", "10*step(t - 0.4321) + 5*wave(t)"].map(|force| {
        let model = model(&format!("{OSCILLATOR}{}", rest.replace("FORCE", force)));
        let choice = Choice { method: Some("radau".into()), accuracy: Some(1e-10), ..Choice::default() };
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.1).unwrap();
        assert_eq!(simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn), Status::Completed);
        let size = rank(simulation.system(), &simulation.state().x, 0.0).size(simulation.system());
        let work = simulation.summary("", 1.0, &Status::Completed, size).work;
        println!("{work:?}");
        (work.rejected_steps, simulation.state().x[0].to_bits())
    });
    assert_eq!(counts[0], counts[1]);
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
