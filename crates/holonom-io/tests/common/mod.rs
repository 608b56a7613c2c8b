//! Models of the gallery, and those that are written in a test; and their runs.
#![allow(dead_code)] // each test uses its share

use holonom::analysis::rank;
use holonom::model::Model;
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Choice, Method, Simulation, Status, Summary, Verdict};
use holonom_io::Source;

/// A model of the gallery.
pub fn example(name: &str) -> Model {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    model(&std::fs::read_to_string(path).unwrap())
}

/// A model from its text.
#[track_caller]
pub fn model(text: &str) -> Model {
    source(text).model().unwrap_or_else(|message| panic!("{message}\n{text}"))
}

/// The same with what tells the forces of joints whose bodies share nodes.
#[track_caller]
pub fn model_with_forces(text: &str) -> Model {
    source(text).model_with_forces().unwrap_or_else(|message| panic!("{message}\n{text}"))
}

/// The description of a model.
#[track_caller]
pub fn source(text: &str) -> Source {
    Source::read("model.toml", text.as_bytes()).unwrap_or_else(|message| panic!("{message}\n{text}"))
}

/// A run that completes, with every step of it.
#[track_caller]
pub fn run(model: &Model, choice: Choice, step: f64, end: f64) -> (Simulation, Recording) {
    let method = Method::resolve(&choice).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Nothing);
    assert_eq!(simulation.run(end, &mut recorder), Status::Completed);
    (simulation, recorder.finish())
}

/// A method by its name.
pub fn method(name: &str) -> Method {
    Method::resolve(&Choice::default().named(name)).unwrap_or_else(|error| panic!("{error}"))
}

/// The methods that keep the energy.
pub const CONSERVING: [&str; 2] = ["conserving-ggl", "conserving"];

/// Runs a model to its end, and says what the summary does.
pub fn complete(name: &str, model: &Model, of: &str, step: f64, end: f64) -> Summary {
    let mut simulation = Simulation::new(model.system.clone(), method(of), step).unwrap_or_else(|error| panic!("{name}, {of}: {error}"));
    let status = simulation.run(end, &mut |_: &Simulation| Verdict::GoOn);
    assert_eq!(status, Status::Completed, "{name}, {of}");
    let size = rank(&model.system, &simulation.state().x, end).size(&model.system);
    simulation.summary(name, end, &status, size)
}

/// The coordinates of joints at the end of a run, by name.
pub fn coordinates(model: &Model, of: &str, step: f64, end: f64) -> Vec<(String, f64)> {
    let mut simulation = Simulation::new(model.system.clone(), method(of), step).unwrap_or_else(|error| panic!("{of}: {error}"));
    assert_eq!(simulation.run(end, &mut |_: &Simulation| Verdict::GoOn), Status::Completed, "{of}");
    model.system.gauges().iter().cloned().zip(simulation.gauges().value.iter().copied()).collect()
}

/// A simulation that finds the forces of joints.
#[track_caller]
pub fn simulation(model: &Model, method: &str, step: f64) -> Simulation {
    let mut simulation = Simulation::new(model.system.clone(), self::method(method), step).unwrap();
    model.find_reactions(&mut simulation);
    simulation
}

/// A run with the forces of joints that completes, with one row of so many.
#[track_caller]
pub fn run_every(model: &Model, method: &str, step: f64, end: f64, every: u64) -> (Simulation, Recording) {
    let mut simulation = simulation(model, method, step);
    let mut recorder = Recorder::new(&model.channels, &model.system, every, Constraints::Joints);
    assert_eq!(simulation.run(end, &mut recorder), Status::Completed);
    (simulation, recorder.finish())
}

/// Degrees of freedom and redundant rows at the start.
#[track_caller]
pub fn freedom(model: &Model) -> [usize; 2] {
    let method = method("conserving");
    let simulation = Simulation::new(model.system.clone(), method, 1e-3).unwrap_or_else(|error| panic!("{error}"));
    let size = rank(&model.system, &simulation.state().x, 0.0).size(&model.system);
    [size.dof, size.redundant]
}

/// ‖difference‖ of the final state, seen against the same run with another step.
pub fn distance(a: &Simulation, b: &Simulation) -> f64 {
    a.state().x.iter().zip(&b.state().x).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The last value of a column.
#[track_caller]
pub fn last(recording: &Recording, name: &str) -> f64 {
    *recording.column(name).unwrap_or_else(|| panic!("there is no column {name}")).last().unwrap()
}

/// A car on four wheels without slip, at a speed (m/s), whose front wheels `i`, 2 on the left and 3 on the right, are turned by angles with this profile.
/// At every place two of the eight rows that hold the speeds of wheels follow from all others.
pub fn car(speed: f64, profile: &str) -> Model {
    model(&format!(
        r#"
[body.chassis]
mass = 1000
inertia = [300, 1200, 1300]
position = [0, 0, 0.5]
velocity = [{speed}, 0, 0]

[body.wheel]
repeat = "i = 0 to 3"
mass = 20
inertia = [0.6, 0.6, 1]
position = ["2.5*floor(i/2) - 1.25", "0.75 - 1.5*mod(i, 2)", 0.3]
orientation = {{ axis = [1, 0, 0], angle = "-90*deg" }}
velocity = [{speed}, 0, 0]
angular_velocity = [0, "{speed}/0.3", 0]

[body.knuckle]
repeat = "i = 2 to 3"
mass = 5
inertia = [0.1, 0.1, 0.1]
position = [1.25, "0.75 - 1.5*mod(i, 2)", 0.3]
velocity = [{speed}, 0, 0]

[joint.road]
repeat = "i = 0 to 3"
type = "rolling"
between = ["ground", "wheel[i]"]
at = "wheel[i]"
axis = [0, 1, 0]
normal = [0, 0, 1]
radius = 0.3

[joint.rear]
repeat = "i = 0 to 1"
type = "revolute"
between = ["chassis", "wheel[i]"]
at = "wheel[i]"
axis = [0, 1, 0]

[joint.front]
repeat = "i = 2 to 3"
type = "revolute"
between = ["knuckle[i]", "wheel[i]"]
at = "wheel[i]"
axis = [0, 1, 0]

[joint.kingpin]
repeat = "i = 2 to 3"
type = "revolute"
between = ["chassis", "knuckle[i]"]
at = "wheel[i]"
axis = [0, 0, 1]

[drive.steering]
repeat = "i = 2 to 3"
type = "angle"
joint = "kingpin[i]"
profile = "{profile}"
"#
    ))
}

/// A mass on a spring: x = 1 + cos(2 t), so that what measures say is known.
pub const OSCILLATOR: &str = r#"
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

/// The values of a column that is there.
#[track_caller]
pub fn column<'a>(recording: &'a Recording, name: &str) -> &'a [f64] {
    recording.column(name).unwrap_or_else(|| panic!("there is no column {name}"))
}

/// Asserts that a number is as by hand, but for this share.
#[track_caller]
pub fn near(name: &str, found: f64, expected: f64, share: f64) {
    assert!((found - expected).abs() <= share * (1.0 + expected.abs()), "{name}: {found} and {expected} by hand");
}
