//! Springs and ropes whose numbers follow time, inputs and what moves: order, balance and channels against closed forms.

mod common;

use common::{distance, model_with_forces as model, run_every};

/// A drum that is turned, and a bob that hangs beside it.
const WINCH: &str = r#"
plane = "xz"

[body.drum]
mass = 40
inertia = 2
position = [0, 0]
angular_velocity = 0.5

[point.bob]
mass = 3
position = [0.8, -5]

[joint.shaft]
type = "revolute"
between = ["ground", "drum"]
at = [0, 0]

[force.brake]
type = "effort"
joint = "shaft"
effort = "-2*q_rate + 3*sin(t)"
"#;

/// Springs and ropes that follow joint coordinates, measures, inputs and time keep the order, and their work closes the balance.
#[test]
fn springs_and_ropes_that_follow_what_moves_keep_order_and_balance() {
    let forces = [
        "type = \"rope\"\nlength = \"4.92 + 0.2*shaft.angle + 0.1*sin(t)\"\nstiffness = 200\ndamping = 5",
        "type = \"rope\"\nlength = 4.92\nstiffness = \"200 + 20*sin(t)\"\ndamping = \"5 + shaft.angle_rate^2\"",
        "type = \"spring\"\nrest_length = \"4.92 + 0.2*shaft.angle\"\nstiffness = 200\ndamping = \"2 + t\"",
        "type = \"spring\"\nrest_length = 4.92\nstiffness = \"200 + 50*shaft.angle\"\nforce = \"-3*bob.vx + rate\"",
        "type = \"torsion\"\nstiffness = \"20 + 5*sin(t)\"\nangle = \"0.2*bob.x\"\ndamping = \"1 + 0.1*bob.vz^2\"",
    ];
    for keys in forces {
        let ends = if keys.contains("torsion") { "joint = \"shaft\"" } else { "between = [\"ground\", \"bob\"]" };
        let model = model(&format!("{WINCH}\n[force.line]\n{ends}\n{keys}\n"));
        let truth = run_every(&model, "radau", 2e-3, 1.0, 1).0;
        for method in ["conserving-ggl", "conserving", "generalized-alpha"] {
            let errors = [0.02, 0.01].map(|step| distance(&run_every(&model, method, step, 1.0, 1).0, &truth));
            let found = (errors[0] / errors[1]).log2();
            assert!((found - 2.0).abs() < 0.25, "{keys}\n{method}: order {found}, errors {errors:?}");
        }
        let (simulation, recording) = run_every(&model, "conserving-ggl", 0.01, 1.0, 1);
        let energy = simulation.audit().energy_summary();
        let throughput: f64 = recording.column("line.power").unwrap().iter().map(|power| power.abs() * 0.01).sum();
        assert!(energy.max_drift < 1e-10 * throughput, "{keys}\n{} of {throughput}", energy.max_drift);
    }
}

/// A torsion spring whose numbers follow something, along a rail that is led: q = t.
#[test]
fn a_torsion_spring_that_follows_what_moves_is_recorded_along_its_coordinate() {
    let text = r#"
gravity = [0, 0, 0]
[body.block]
mass = 2
shape = { box = [0.1, 0.1, 0.1] }
position = [2, 0, 0]
[joint.rail]
type = "prismatic"
between = ["ground", "block"]
axis = [1, 0, 0]
[drive.feed]
type = "displacement"
joint = "rail"
profile = "t"
[input.factor]
default = 2
[force.f]
type = "torsion"
joint = "rail"
stiffness = "10*factor"
angle = "block.x^2 - 4"
damping = "1 + t"
"#;
    let (_, recording) = run_every(&model(text), "radau", 0.01, 1.0, 1);
    let column = |name: &str| recording.column(name).unwrap();
    for k in 0..recording.rows() {
        let t = column("t")[k];
        let effort = -20.0 * (t - ((2.0 + t).powi(2) - 4.0)) - (1.0 + t);
        for (name, value) in [("f.effort", effort), ("f.power", effort), ("feed.effort", -effort)] {
            assert!((column(name)[k] - value).abs() < 1e-8, "{name} at {t}: {} and not {value}", column(name)[k]);
        }
    }
}

/// Formulas of springs and ropes that stand for numbers give what the numbers give, and their channels say the closed form.
#[test]
fn numbers_that_follow_are_recorded_as_numbers_are() {
    // The point is led, so that everything is known: r = 2 + t, and the coordinate of the rail is t.
    let text = |force: &str| {
        format!(
            "gravity = [0, 0, 0]\n[body.block]\nmass = 2\nshape = {{ box = [0.1, 0.1, 0.1] }}\nposition = [2, 0, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n\
             [drive.feed]\ntype = \"displacement\"\njoint = \"rail\"\nprofile = \"t\"\n[input.factor]\ndefault = 2\n\
             [force.f]\nbetween = [\"ground\", \"block\"]\n{force}\n"
        )
    };
    type Truth = fn(f64) -> f64;
    let cases: [(&str, Truth); 4] = [
        // k (r − L) + c (1 − L̇): the free length follows the rail by a quarter of it.
        ("type = \"rope\"\nlength = \"1 + 0.25*rail.displacement\"\nstiffness = 10\ndamping = 3", |t| 10.0 * (1.0 + 0.75 * t) + 3.0 * 0.75),
        // A drum beside it.
        ("type = \"rope\"\nlength = \"1 + 0.25*t\"\nstiffness = 10\ndrum = \"rail\"\nradius = 0.5", |t| 10.0 * (1.0 + 0.25 * t)),
        ("type = \"spring\"\nrest_length = \"rail.displacement^2\"\nstiffness = \"10*factor\"\ndamping = \"1 + t\"", |t| {
            20.0 * (2.0 + t - t * t) + 1.0 + t
        }),
        ("type = \"spring\"\nalong = [1, 0, 0]\nrest_length = -1\nforce = \"factor*extension + rate*rail.displacement\"", |t| {
            2.0 * (3.0 + t) + t
        }),
    ];
    for (force, tension) in cases {
        let (_, recording) = run_every(&model(&text(force)), "radau", 0.01, 1.0, 1);
        let column = |name: &str| recording.column(name).unwrap();
        for k in 0..recording.rows() {
            let t = column("t")[k];
            let expected = [("f.length", 2.0 + t), ("f.length_rate", 1.0), ("f.force", tension(t))];
            for (name, value) in expected {
                assert!((column(name)[k] - value).abs() < 1e-9, "{force}\n{name} at {t}: {} and not {value}", column(name)[k]);
            }
            // The rail's drive holds against the tension, and against the drum.
            let drum = if force.contains("drum") { 0.5 * tension(t) } else { 0.0 };
            assert!((column("feed.effort")[k] - (tension(t) - drum)).abs() < 1e-8, "{force}\n{}", column("feed.effort")[k]);
            assert!((column("f.power")[k] + tension(t) - drum).abs() < 1e-9, "{force}\n{}", column("f.power")[k]);
        }
    }
}
