//! A parameter study: how far a door swings in a second by the stiffness of its closer, from runs on all cores.

use holonom::simulation::Status;
use holonom_io::Source;

const DOOR: &str = r#"
[body.door]
mass = 20
shape = { box = [1, 0.05, 2] }
position = [0.5, 0, 1]
[joint.hinge]
type = "revolute"
between = ["ground", "door"]
at = [0, 0, 1]
axis = [0, 0, 1]
[force.closer]
type = "torsion"
joint = "hinge"
stiffness = 5
damping = 2
angle = 1.57
[simulation]
step = 0.01
"#;

fn swings(stiffness: f64) -> Result<f64, String> {
    let mut source = Source::read("door.toml", DOOR.as_bytes())?;
    source.set("force.closer.stiffness", &stiffness.to_string())?;
    let mut simulation = source.model()?.simulation().map_err(|error| error.to_string())?;
    match simulation.step_to(1.0) {
        Status::Completed => Ok(simulation.coordinate("hinge.angle").expect("the hinge is there")[0]),
        Status::Stopped { reason, .. } => Err(reason),
    }
}

fn main() {
    let runs = [1.0, 2.0, 5.0, 10.0, 20.0].map(|stiffness| (stiffness, std::thread::spawn(move || swings(stiffness))));
    for (stiffness, run) in runs {
        match run.join().expect("no run panics") {
            Ok(angle) => println!("{stiffness:4} N·m/rad: {angle:.3} rad"),
            Err(reason) => println!("{stiffness:4} N·m/rad: {reason}"),
        }
    }
}
