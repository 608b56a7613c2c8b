//! The largest values of forces are those of all steps, not only of the rows that are recorded.

mod common;

use common::model;
use holonom::model::Model;
use holonom::record::{Constraints, Peaks, Recorder};
use holonom::simulation::{Choice, Method, Simulation, Status};

/// A mass that falls 0.1 m onto a buffer of 1e5 N/m.
fn buffer() -> Model {
    buffer_and("")
}

fn buffer_and(more: &str) -> Model {
    model(&format!(
        "plane = \"xz\"\n[body.m]\nmass = 1\ninertia = 1\nposition = [0, 0.1]\n\
         [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m\"]\naxis = [0, 1]\n\
         [force.buffer]\ntype = \"stop\"\njoint = \"rail\"\nlower = -0.1\nstiffness = 1e5\n{more}",
    ))
}

/// With k s²/2 = m g (h + s) at the lowest place it pushes with k s = m g (1 + √(1 + 2 k h/m g)).
fn largest() -> f64 {
    let weight: f64 = 9.81;
    weight * (1.0 + (1.0 + 2.0 * 1e5 * 0.1 / weight).sqrt())
}

#[test]
fn peaks_between_rows_count() {
    let model = buffer();
    for (method, accuracy, step, every) in [
        ("radau", Some(1e-8), 0.05, 1),
        ("conserving-ggl", Some(1e-6), 0.05, 1),
        ("ode/dopri5", Some(1e-8), 0.05, 1),
        ("radau", None, 2e-5, 997),
    ] {
        let choice = Choice { accuracy, ..Choice::default().named(method) };
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), step).unwrap();
        let mut recorder = Recorder::new(&model.channels, &model.system, every, Constraints::Nothing);
        assert_eq!(simulation.run(0.4, &mut recorder), Status::Completed);
        let recording = recorder.finish();
        let of_rows = recording.column("buffer.effort").unwrap().iter().fold(0.0, |m: f64, f| m.max(f.abs()));
        let peaks = Peaks::of(&model.channels, &recording, &model.system);
        let [peak] = &peaks.forces[..] else { panic!("{method}: {:?}", peaks.forces) };
        println!("{method}: {} N of {} N, in rows {of_rows} N", peak.value, largest());
        assert!(of_rows < 0.9 * largest(), "{method}: a row has it");
        // How near a step comes to the largest force is a matter of its length.
        assert!(peak.value > 0.95 * largest() && peak.value <= (1.0 + 1e-6) * largest(), "{method}: {} N", peak.value);
    }
}

/// Measures go as far as they do in any step; what has no finite value is left out of that.
#[test]
fn extremes_of_measures_are_those_of_all_steps() {
    let text = "[measure.push]\nvalue = \"buffer.effort\"\n[measure.rise]\nvalue = \"m.az\"\n[measure.level]\nvalue = \"ln(abs(m.vz))\"\n";
    let model = buffer_and(text);
    for (method, accuracy, step, every) in [("radau", Some(1e-8), 0.05, 1), ("ode/dopri5", Some(1e-8), 0.05, 1), ("radau", None, 2e-5, 997)]
    {
        let choice = Choice { accuracy, ..Choice::default().named(method) };
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), step).unwrap();
        model.find_reactions(&mut simulation);
        let mut recorder = Recorder::new(&model.channels, &model.system, every, Constraints::Joints);
        assert_eq!(simulation.run(0.4, &mut recorder), Status::Completed);
        let peaks = Peaks::of(&model.channels, &recorder.finish(), &model.system);
        let [push, rise, level] = &peaks.measures[..] else { panic!("{:?}", peaks.measures) };
        println!("{method}: {push:?} {rise:?} {level:?}");
        assert_eq!(push.max, peaks.forces[0].value.abs(), "{method}");
        assert!((push.max_at - peaks.forces[0].at).abs() < 1e-12 && push.min.abs() < 1e-9, "{method}");
        // In its lowest place it is thrown up by k s/m − g.
        assert!((rise.max - (push.max - 9.81)).abs() < 1e-6 * push.max && (rise.min + 9.81).abs() < 1e-9, "{method}: {rise:?}");
        // At rest it has no speed.
        assert!(level.min.is_finite() && level.max < 1.0, "{method}: {level:?}");
    }
}

/// A run that is resumed knows the largest value of its first part.
#[test]
fn peaks_survive_a_checkpoint() {
    let model = buffer();
    let method = || Method::resolve(&Choice { accuracy: Some(1e-7), ..Choice::default().named("radau") }).unwrap();
    let recorder = || Recorder::new(&model.channels, &model.system, 1, Constraints::Nothing);
    let mut simulation = Simulation::new(model.system.clone(), method(), 0.05).unwrap();
    let mut first = recorder();
    assert_eq!(simulation.run(0.25, &mut first), Status::Completed);
    let (mark, checkpoint, rows) = (first.mark(), simulation.checkpoint(), first.recording().clone());
    let mark = serde_json::from_str(&serde_json::to_string(&mark).unwrap()).unwrap();
    let mut second = recorder().resume(&mark).after(rows);
    let mut resumed = Simulation::resume(model.system.clone(), method(), 0.05, checkpoint).unwrap();
    assert_eq!(resumed.run(0.3, &mut second), Status::Completed);
    assert!(Peaks::of(&model.channels, &second.finish(), &model.system).forces[0].value > 0.95 * largest());
}

/// What a drive exerts follows from forces of the constraints, which a measure of it has found wherever it looks: the moment of a crank that is led to and
/// fro in the horizontal plane is J θ″, largest where it turns round, with few rows, too.
#[test]
fn extremes_of_what_drives_exert_are_those_of_all_steps() {
    let model = model(
        "plane = \"xy\"\ngravity = [0, 0]\n[body.crank]\nmass = 1\ninertia = 2\nposition = [0, 0]\n\
         [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
         [drive.motor]\ntype = \"angle\"\njoint = \"axle\"\nprofile = \"0.5*(1 - cos(7*t))\"\n\
         [measure.moment]\nvalue = \"motor.effort\"\n[measure.power]\nvalue = \"motor.effort*axle.angle_rate\"\n",
    );
    let (moment, power) = (2.0 * 0.5 * 49.0, 2.0 * 0.25 * 343.0 * 0.5);
    for (accuracy, step, every) in [(None, 1e-3, 1), (None, 1e-3, 997), (Some(1e-8), 0.7, 1)] {
        let choice = Choice { accuracy, ..Choice::default().named("radau") };
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), step).unwrap();
        model.find_reactions(&mut simulation);
        let mut recorder = Recorder::new(&model.channels, &model.system, every, Constraints::Joints);
        assert_eq!(simulation.run(2.1, &mut recorder), Status::Completed);
        let peaks = Peaks::of(&model.channels, &recorder.finish(), &model.system);
        let [of_moment, of_power] = &peaks.measures[..] else { panic!("{:?}", peaks.measures) };
        for (found, size) in [(of_moment.max, moment), (-of_moment.min, moment), (of_power.max, power), (-of_power.min, power)] {
            assert!((found / size - 1.0).abs() < 2e-3, "{accuracy:?}, {every}: {found} and {size} by hand");
        }
    }
}

/// A wheel that only turns has no way to compare its forces with moments by: round-off of its place hides none. And a measure ends where the run does,
/// which may be no row.
#[test]
fn wheels_show_their_forces_and_measures_their_end() {
    let model = model(
        "plane = \"xz\"\n[body.wheel]\nmass = 10\ninertia = 0.2\nposition = [0, 0]\n\
         [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"wheel\"]\nat = [0, 0]\n\
         [force.crank]\ntype = \"effort\"\njoint = \"axle\"\neffort = 0.4\n\
         [measure.turned]\nvalue = \"axle.angle\"\n[output]\nreactions = true\n",
    );
    let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&Choice::default()).unwrap(), 0.01).unwrap();
    model.find_reactions(&mut simulation);
    let mut recorder = Recorder::new(&model.channels, &model.system, 7, Constraints::Joints);
    assert_eq!(simulation.run(1.0, &mut recorder), Status::Completed);
    let peaks = Peaks::of(&model.channels, &recorder.finish(), &model.system);
    assert!((peaks.joints[0].value - 98.1).abs() < 1e-9, "{:?}", peaks.joints);
    assert!((peaks.measures[0].last - 1.0).abs() < 1e-4, "{:?}", peaks.measures);
}

/// Of a beam each quantity has its own steps, also where some of its elements bear nothing: one that hangs over is not twisted.
#[test]
fn peaks_of_beams_are_of_all_steps() {
    let model = model(
        "[beam.b]\nfrom = [0, 0, 0]\nto = [1, 0, 0]\nelements = 3\nsection = { circle = 0.01 }\nmodulus = 2e11\ndensity = 7800\n\
         [joint.c]\ntype = \"fixed\"\nbetween = [\"ground\", \"b[0]\"]\nat = \"b[0]\"\n",
    );
    let found = |every: u64| {
        let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&Choice::default()).unwrap(), 1e-3).unwrap();
        let mut recorder = Recorder::new(&model.channels, &model.system, every, Constraints::Nothing);
        assert_eq!(simulation.run(0.1, &mut recorder), Status::Completed);
        let peaks = Peaks::of(&model.channels, &recorder.finish(), &model.system).forces;
        peaks.into_iter().map(|peak| (peak.name, peak.value.abs())).collect::<Vec<_>>()
    };
    let (few, all) = (found(50), found(1));
    assert!(!few.iter().any(|(name, _)| name.contains("torque")), "{few:?}");
    assert_eq!(few.len(), all.len());
    for ((name, value), (other, largest)) in few.iter().zip(&all) {
        assert!(name == other && (value / largest - 1.0).abs() < 1e-6, "{few:?} {all:?}");
    }
}
