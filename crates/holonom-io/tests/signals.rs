//! Measures, tables and inputs, against closed forms and against the same written otherwise.

mod common;

use std::f64::consts::PI;

use common::{OSCILLATOR, distance, last, model_with_forces as model, run_every as run, simulation, source};
use holonom::analysis::rank;
use holonom::record::{Constraints, Peaks, Recorder};
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

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
    assert_eq!(&*recording.find("twice").unwrap().heading.meaning, "2*pull");
    let peaks = Peaks::of(&model.channels, &recording, &model.system);
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

/// Units are factors in measures, too, and a parameter that is called like one comes first.
#[test]
fn what_a_model_calls_like_a_unit_comes_before_it() {
    let text = "[parameters]\nbar = 3\n[measure.low]\nvalue = \"bob.x/mm\"\n[measure.pressure]\nvalue = \"2*bar + 0*bob.x\"\n";
    let (_, recording) = run(&model(&format!("{OSCILLATOR}{text}")), "radau", 0.01, 0.1, 1);
    assert!((last(&recording, "low") - 1e3 * last(&recording, "bob.x")).abs() < 1e-9);
    assert_eq!(last(&recording, "pressure"), 6.0);
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

/// Written out, the first of sixty measures, each of which reads the two before it, would have 10¹² terms; a chain of ten thousand is read without
/// recursion. What jumps within one of them ends steps as where it is written in the force.
#[test]
fn measures_of_measures_are_worked_out_once() {
    let chain = |count: usize, formula: &dyn Fn(usize) -> String| -> String {
        (0..count).map(|k| format!("[measure.a{k}]\nvalue = \"{}\"\n", formula(k))).collect()
    };
    let last = |k: usize| format!("[measure.a{k}]\nvalue = \"1 - bob.x\"\n");
    let of_two = chain(60, &|k| format!("0.5*a{} + 0.5*a{}", k + 1, k + 2)) + &last(60) + &last(61);
    let of_one = chain(10_000, &|k| format!("a{} + 0", k + 1)) + &last(10_000);
    for measures in [of_two, of_one] {
        let force = "[force.f]\ntype = \"expression\"\npoint = \"bob\"\nforce = [\"5*a0\", 0, 0]\n";
        // With the spring of 4 N/m about 1 m the frequency is 3 rad/s.
        let (simulation, _) = run(&model(&format!("{OSCILLATOR}{measures}{force}")), "radau", 2e-2, 1.0, 1);
        assert!((simulation.state().x[0] - 1.0 - 3.0_f64.cos()).abs() < 1e-8);
    }
    let jumps =
        ["step(late)*late + step(late)*(1 + late)", "step(t - 0.4321)*(t - 0.4321) + step(t - 0.4321)*(1 + (t - 0.4321))"].map(|push| {
            let text = format!(
                "{OSCILLATOR}[measure.late]\nvalue = \"t - 0.4321\"\n[measure.push]\nvalue = \"{push}\"\n\
             [force.f]\ntype = \"expression\"\npoint = \"bob\"\nforce = [\"push + 0*push\", 0, 0]\n"
            );
            let choice = Choice { method: Some("radau".into()), accuracy: Some(1e-10), ..Choice::default() };
            common::run(&model(&text), choice, 0.1, 1.0).0.state().x[0].to_bits()
        });
    assert_eq!(jumps[0], jumps[1]);
}
