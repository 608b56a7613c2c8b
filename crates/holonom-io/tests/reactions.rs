//! Forces and moments of joints against Newton and Euler: on the second body, about the joint's place there, whichever side the
//! ground is.

mod common;

use std::f64::consts::PI;

use common::model;
use holonom::model::{BodyInfo, Model};
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom_io::Source;
use nalgebra::{Quaternion, UnitQuaternion, Vector3};

/// Largest difference, of forces and moments of the order of ten, N and N·m.
const AGREES: f64 = 1e-9;

const AT: [f64; 3] = [0.3, -0.2, 0.5];
const GRAVITY: [f64; 3] = [1.0, -2.0, -9.81];

/// Keys of the joints beside `type` and `between`.
const JOINTS: &[(&str, &str)] = &[
    ("spherical", "at = AT"),
    ("revolute", "at = AT\naxis = [1, 2, 3]"),
    ("prismatic", "at = AT\naxis = [1, 2, 3]"),
    ("cylindrical", "at = AT\naxis = [1, 2, 3]"),
    ("planar", "at = AT\naxis = [1, 2, 3]"),
    ("universal", "at = AT\naxes = [[1, 2, 3], [3, 0, -1]]"),
    ("constant-velocity", "at = AT\naxes = [[1, 2, 3], [1, 2, 2]]"),
    ("fixed", "at = AT"),
    ("screw", "at = AT\naxis = [1, 2, 3]\npitch = 0.4"),
    ("parallel", "at = AT\naxis = [1, 2, 3]"),
    ("perpendicular", "at = AT\naxes = [[1, 2, 3], [3, 0, -1]]"),
    ("orientation", "at = AT"),
    ("point-on-line", "at = AT\naxis = [1, 2, 3]"),
    ("point-on-plane", "at = AT\naxis = [1, 2, 3]"),
    ("distance", "at = [AT, [1.1, 0.4, 0.9]]"),
    ("revolute-spherical", "at = [AT, [0.9, 0.4, 0.3]]\naxis = [1, 0, 3]"),
    ("generic", "at = AT\naxes = [[1, 2, 3], [3, 0, -1]]\nlocks = [\"x\", \"z\", \"ry\"]"),
];

fn text(kind: &str, keys: &str, between: [&str; 2], reactions: bool) -> String {
    let body = |name: &str, x: f64, spin: &str| {
        format!(
            "[body.{name}]\nmass = 1.5\ninertia = [0.3, 0.4, 0.5, 0.02, -0.01, 0.03]\nposition = [{x}, 0.1, 0.8]\n\
             velocity = [0.3, -0.5, 0.2]\nangular_velocity = {spin}\n"
        )
    };
    let bodies = [("A", -0.4, "[0.5, -0.3, 0.7]"), ("B", 0.9, "[1.0, 2.0, -0.5]")];
    let bodies = bodies.iter().filter(|(name, ..)| between.contains(name)).map(|(name, x, spin)| body(name, *x, spin));
    format!(
        "gravity = {GRAVITY:?}\n{}[joint.j]\ntype = \"{kind}\"\nbetween = {between:?}\n{}\n[output]\nreactions = {reactions}\n",
        bodies.collect::<String>(),
        keys.replace("AT", &format!("{AT:?}"))
    )
}

fn run(model: &Model, method: &str) -> (Simulation, Recording) {
    let method = Method::resolve(&Choice::default().named(method)).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, 0.005).unwrap();
    model.find_reactions(&mut simulation);
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Rows);
    assert_eq!(simulation.run(0.5, &mut recorder), Status::Completed);
    (simulation, recorder.finish())
}

fn last(recording: &Recording, ending: &str) -> Vector3<f64> {
    Vector3::from(["x", "y", "z"].map(|axis| *recording.column(&format!("j.{ending}{axis}")).unwrap().last().unwrap()))
}

/// What moves a body beside gravity: force, and moment about a place.
fn balance(body: &BodyInfo, simulation: &Simulation, about: Vector3<f64>) -> [Vector3<f64>; 2] {
    let x = simulation.system().in_world(&simulation.state().x);
    let [_, spin] = body.recorded.velocity(&x, simulation.velocities(), 3);
    // Of three orthogonal directions e, ½ Σ e × ë is the angular acceleration.
    let [acceleration, twist] = body.recorded.velocity(&x, &simulation.reactions().unwrap().a, 3);
    let turned = body.recorded.orientation(&x) * body.recorded.start.transpose();
    let inertia = turned * body.inertia * turned.transpose();
    let force = body.mass * (acceleration - Vector3::from(GRAVITY));
    [force, inertia * twist + spin.cross(&(inertia * spin)) + (body.recorded.place(&x, 3) - about).cross(&force)]
}

#[test]
fn forces_of_joints_are_those_of_newton_and_euler() {
    let (mut worst, mut cases) = (0.0_f64, 0);
    for (kind, keys) in JOINTS {
        for between in [["ground", "B"], ["B", "ground"], ["A", "B"], ["B", "A"]] {
            let model = model(&text(kind, keys, between, true));
            for method in ["conserving-ggl", "radau"] {
                let (simulation, recording) = run(&model, method);
                let joint = &model.channels.joints[0];
                let x = simulation.system().in_world(&simulation.state().x);
                let about = Vector3::from(joint.place(&x, 3));
                let find = |name: &str| model.bodies.iter().find(|body| body.name == name);
                let (body, sign) = match find(between[1]) {
                    Some(body) => (body, 1.0),
                    None => (find(between[0]).unwrap(), -1.0),
                };
                if between[1] == "ground" && keys.starts_with("at = AT") {
                    assert!((about - Vector3::from(AT)).norm() < 1e-12, "{kind}: the place on the ground stays");
                }
                let expected = balance(body, &simulation, about).map(|vector| sign * vector);
                let off = [("f", expected[0]), ("t", expected[1])].map(|(ending, vector)| (last(&recording, ending) - vector).norm());
                worst = off.iter().fold(worst, |worst, off| worst.max(*off));
                cases += 1;
                assert!(off.iter().all(|off| *off < AGREES), "{kind} between {between:?}, {method}: off by {off:?}");
            }
        }
    }
    println!("{cases} cases, worst {worst:.1e}");
}

/// Where bodies share nodes, the same mechanism without shared nodes tells the force; accelerations are those that are recorded.
#[test]
fn forces_of_joints_are_known_where_bodies_share_nodes() {
    let (mut worst, mut shared) = (0.0_f64, 0);
    for (kind, keys) in JOINTS {
        for between in [["ground", "B"], ["B", "ground"], ["A", "B"], ["B", "A"]] {
            let text = text(kind, keys, between, false).replace("[output]\nreactions = false\n", "");
            let source = Source::read("model.toml", text.as_bytes()).unwrap();
            let model = source.model_with_forces().unwrap();
            shared += usize::from(model.shares_nodes());
            for method in ["conserving-ggl", "radau"] {
                let (simulation, recording) = run(&model, method);
                let joint = &model.channels.told().joints[0];
                let about = Vector3::from(joint.place(&simulation.reacting_positions(), 3));
                let find = |name: &str| model.bodies.iter().find(|body| body.name == name);
                let (body, sign) = match find(between[1]) {
                    Some(body) => (body, 1.0),
                    None => (find(between[0]).unwrap(), -1.0),
                };
                let value = |suffix: &str| *recording.column(&format!("{}.{suffix}", body.name)).unwrap().last().unwrap();
                let vector = |suffixes: [&str; 3]| Vector3::from(suffixes.map(value));
                let turn = UnitQuaternion::new_normalize(Quaternion::new(value("qw"), value("qx"), value("qy"), value("qz")));
                let turned = turn.to_rotation_matrix().into_inner() * body.recorded.start.transpose();
                let (inertia, spin) = (turned * body.inertia * turned.transpose(), vector(["wx", "wy", "wz"]));
                let force = body.mass * (vector(["ax", "ay", "az"]) - Vector3::from(GRAVITY));
                let twist = vector(["alphax", "alphay", "alphaz"]);
                let moment = inertia * twist + spin.cross(&(inertia * spin)) + (vector(["x", "y", "z"]) - about).cross(&force);
                let off = [("f", force), ("t", moment)].map(|(ending, expected)| (last(&recording, ending) - sign * expected).norm());
                worst = off.iter().fold(worst, |worst, off| worst.max(*off));
                assert!(off.iter().all(|off| *off < AGREES), "{kind} between {between:?}, {method}: off by {off:?}");
            }
        }
    }
    assert!(shared > 20, "only {shared} models share nodes");
    println!("{shared} models share nodes, worst {worst:.1e}");
}

/// Where bodies share nodes a joint's force is in no equation: it is not said to be zero.
#[test]
fn forces_that_are_not_known_are_no_numbers() {
    for (kind, keys) in JOINTS {
        let (shared, plain) = (model(&text(kind, keys, ["ground", "B"], false)), model(&text(kind, keys, ["ground", "B"], true)));
        let (_, recording) = run(&shared, "conserving-ggl");
        let shares = shared.system.constraints() < plain.system.constraints();
        assert_eq!(last(&recording, "f")[0].is_nan(), shares, "{kind}");
    }
}

/// A motor between two bodies, and what is recorded of it and of its joint, against Newton and Euler of both bodies: the second feels the
/// joint's force and moment and the effort, the first all of it the other way.
#[test]
fn a_motor_and_its_joint_tell_what_both_bodies_feel() {
    let text = "plane = \"xz\"\n\
                [body.a]\nmass = 2\ninertia = 0.3\nposition = [0.5, 0]\npoints = { root = [-0.5, 0], tip = [0.5, 0] }\n\
                [body.b]\nmass = 1\ninertia = 0.1\nposition = [1.3, 0.2]\n\
                [joint.base]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
                [joint.elbow]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n";
    let imposed = "[drive.motor]\ntype = \"angle\"\njoint = \"elbow\"\nprofile = \"sin(3*t)\"\n";
    let given = "[force.motor]\ntype = \"effort\"\njoint = \"elbow\"\neffort = \"5*sin(3*t) - q\"\n";
    for motor in [imposed, given] {
        let source = Source::read("motor.toml", format!("{text}{motor}").as_bytes()).unwrap();
        let (_, recording) = run(&source.model_with_forces().unwrap(), "radau");
        for k in 0..recording.rows() {
            let of = |name: &str| recording.column(name).unwrap_or_else(|| panic!("no {name}"))[k];
            let pair = |name: &str, ending: &str| [of(&format!("{name}.{ending}x")), of(&format!("{name}.{ending}z"))];
            // Moment of a force at a place about a centre, from x to z.
            let turns = |at: [f64; 2], about: [f64; 2], [fx, fz]: [f64; 2]| (at[0] - about[0]) * fz - (at[1] - about[1]) * fx;
            let (base, elbow, effort) = (pair("base", "f"), pair("elbow", "f"), of("motor.effort"));
            let (root, tip, a, b) = (pair("a.root", ""), pair("a.tip", ""), pair("a", ""), pair("b", ""));
            let close = |what: &str, left: f64, right: f64| {
                assert!((left - right).abs() < AGREES, "{motor}{what} at {}: {left} and not {right}", of("t"));
            };
            let weight = [0.0, -9.81];
            for (c, axis) in ["ax", "az"].into_iter().enumerate() {
                close("force on b", 1.0 * of(&format!("b.{axis}")), elbow[c] + 1.0 * weight[c]);
                close("force on a", 2.0 * of(&format!("a.{axis}")), base[c] - elbow[c] + 2.0 * weight[c]);
            }
            close("moment on b", 0.1 * of("b.alpha"), of("elbow.t") + effort + turns(tip, b, elbow));
            let on_a = turns(root, a, base) - turns(tip, a, elbow) + of("base.t") - of("elbow.t") - effort;
            close("moment on a", 0.3 * of("a.alpha"), on_a);
            close("moment of a hinge", of("elbow.t"), 0.0);
            close("power", of("motor.power"), effort * of("elbow.angle_rate"));
        }
    }
}

/// A motor that turns a rotor and what meshes with it takes the torque of both, also by methods that leave velocities off the rows: they are off by a
/// hundredth of a rad/s, and a row of an angle asks for the spin times that.
#[test]
fn a_drive_of_fast_rotors_takes_what_they_take() {
    let text = "gravity = [0, 0, 0]\n[body.a]\nmass = 1\ninertia = [1, 1, 0.2]\nposition = [0, 0, 0]\n\
                [body.b]\nmass = 1\ninertia = [1, 1, 0.1]\nposition = [1, 0, 0]\n\
                [joint.a-axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.b-axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [1, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.mesh]\ntype = \"gear\"\njoints = [\"a-axle\", \"b-axle\"]\nratio = -0.5\n\
                [drive.motor]\ntype = \"angle\"\njoint = \"a-axle\"\nprofile = \"30*t + 0.1*sin(10*t)\"\n";
    for reactions in [false, true] {
        let model = model(&format!("{text}[output]\nreactions = {reactions}\n"));
        for method in ["conserving-ggl", "conserving", "generalized-alpha", "lagrange-3/hht", "lagrange-3/bdf", "radau"] {
            let (_, recording) = run(&model, method);
            let [times, efforts] = ["t", "motor.effort"].map(|name| recording.column(name).unwrap());
            for (t, effort) in times.iter().zip(efforts) {
                let expected = (0.2 + 4.0 * 0.1) * -10.0 * (10.0 * t).sin();
                assert!((effort - expected).abs() < AGREES, "{method}, {reactions}: {effort} and not {expected} at {t} s");
            }
        }
    }
}

/// Both wheels of an axle hold it sideways: how they share the force is one choice of many, and no method makes it larger than what it holds, though
/// some leave velocities off the rows. Both together bear m v ω.
#[test]
fn redundant_treads_share_what_there_is() {
    let wheel = |name: &str, y: f64, speed: f64| {
        format!(
            "[body.{name}]\nmass = 1\nshape = {{ cylinder = [0.2, 0.02] }}\norientation = {{ axis = [1, 0, 0], angle = \"pi/2\" }}\n\
             position = [0, {y}, 0.2]\nvelocity = [{speed}, 0, 0]\nangular_velocity = [0, {}, 2]\n\
             [joint.axle-{name}]\ntype = \"revolute\"\nbetween = [\"cart\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             [joint.tread-{name}]\ntype = \"rolling\"\nbetween = [\"ground\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             normal = [0, 0, 1]\nradius = 0.2\n",
            speed / 0.2
        )
    };
    let text = format!(
        "[body.cart]\nmass = 20\ninertia = [2, 3, 4]\nposition = [0, 0, 0.3]\nvelocity = [2, 0, 0]\nangular_velocity = [0, 0, 2]\n{}{}\
         [joint.foot]\ntype = \"point-on-plane\"\nbetween = [\"ground\", \"cart\"]\nat = [0.8, 0, 0]\naxis = [0, 0, 1]\n\
         [measure.side]\nvalue = \"sqrt('tread-left.fx'^2 + 'tread-left.fy'^2)\"\n\
         [measure.both]\nvalue = \"sqrt(('tread-left.fx' + 'tread-right.fx')^2 + ('tread-left.fy' + 'tread-right.fy')^2)\"\n",
        wheel("left", 0.4, 1.2),
        wheel("right", -0.4, 2.8)
    );
    let model = common::model(&text);
    // The middle of the masses is on the axle: 22 kg at 2 m/s that turn by 2 rad/s, at a constant speed.
    for (method, step) in
        [("radau", 0.01), ("conserving-ggl", 0.01), ("conserving", 0.01), ("conserving", 0.001), ("generalized-alpha", 0.002)]
    {
        let (_, recording) = common::run_every(&model, method, step, 0.5, 1);
        let [side, both] = ["side", "both"].map(|name| recording.column(name).unwrap());
        for (side, both) in side.iter().zip(both) {
            assert!((both - 88.0).abs() < 0.2, "{method}, {step} s: {both} N");
            assert!((side - 44.0).abs() < 1.0, "{method}, {step} s: {side} N");
        }
    }
}

/// A deck on three cranks, one more than it needs, has about the forces of its motion with methods that hold rows by springs or let them drift, too: beside the
/// rows three cranks ask for different things, which no forces of any size meet.
#[test]
fn methods_beside_the_rows_have_forces_of_redundant_joints() {
    let (s, c) = (PI / 3.0).sin_cos();
    let mut text = format!("plane = \"xz\"\n[body.deck]\nmass = 10\ninertia = 4\nposition = [{}, {}]\n", 1.0 + c, -s);
    for k in 0..3 {
        text += &format!(
            "[body.crank{k}]\nmass = 2\nshape = {{ rod = 1 }}\nposition = [{}, {}]\norientation = {{ angle = {} }}\n\
             [joint.top{k}]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank{k}\"]\nat = [{k}, 0]\n\
             [joint.pin{k}]\ntype = \"revolute\"\nbetween = [\"crank{k}\", \"deck\"]\nat = [{}, {}]\n",
            f64::from(k) + 0.5 * c,
            -0.5 * s,
            -PI / 3.0,
            f64::from(k) + c,
            -s
        );
    }
    let model = common::model_with_forces(&text);
    let (_, reference) = common::run_every(&model, "radau", 0.01, 1.0, 1);
    for method in [
        "penalty/conserving",
        "penalty/generalized-alpha",
        "penalty-stabilized/trapezoidal",
        "baumgarte/trapezoidal",
        "lagrange-2/trapezoidal",
    ] {
        let (_, recording) = common::run_every(&model, method, 0.01, 1.0, 1);
        for name in ["pin0.fz", "pin1.fz", "top2.fz"] {
            for (row, (force, expected)) in recording.column(name).unwrap().iter().zip(reference.column(name).unwrap()).enumerate() {
                assert!((force - expected).abs() < 0.5, "{method}, {name}, row {row}: {force} N for {expected} N");
            }
        }
    }
}

/// A carriage on two rails that glides where nothing pushes it has forces: none.
#[test]
fn where_nothing_pushes_forces_are_zero() {
    let text = "gravity = [0, 0, 0]\n[body.z]\nmass = 2\ninertia = [1, 1, 2]\nposition = [0, 0, 0]\nvelocity = [1, 2, 3]\n\
                [joint.rail1]\ntype = \"prismatic\"\nbetween = [\"ground\", \"z\"]\naxis = [1, 2, 3]\nat = [0.1, 0, 0]\n\
                [joint.rail2]\ntype = \"prismatic\"\nbetween = [\"ground\", \"z\"]\naxis = [1, 2, 3]\nat = [0, 0.3, 0]\n";
    let model = common::model(text);
    for method in ["conserving-ggl", "radau", "trapezoidal-projected"] {
        let (_, recording) = common::run_every(&model, method, 0.005, 0.1, 1);
        // 2 kg at 3.7 m/s that turned within a metre would need 28 N.
        for name in ["rail1.fx", "rail1.tz", "rail2.fy", "z.ax"] {
            assert!(recording.column(name).unwrap().iter().all(|value| value.abs() < 1e-4), "{method}: {name}");
        }
    }
}

/// A belt pulls at the shaft of a hinge on the ground, where the arm that hangs there has no node that moves: the bearing bears it, and the arm's weight.
#[test]
fn a_bearing_bears_what_acts_on_its_body_there() {
    for output in ["", "[output]\nreactions = true\n"] {
        let text = format!(
            "plane = \"xz\"\ngravity = [0, -10]\n[body.arm]\nmass = 1\ninertia = 0.1\nposition = [0, -0.5]\npoints = {{ hub = [0, 0.5] }}\n\
             [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = \"arm.hub\"\n\
             [force.belt]\ntype = \"constant\"\npoint = \"arm.hub\"\nforce = [-100, 0]\n{output}"
        );
        let (_, recording) = common::run_every(&common::model_with_forces(&text), "conserving-ggl", 0.01, 0.1, 1);
        for (name, expected) in [("hinge.fx", 100.0), ("hinge.fz", 10.0), ("belt.fx", -100.0), ("arm.ax", 0.0)] {
            let found = recording.column(name).unwrap();
            assert!(found.iter().all(|value| (value - expected).abs() < AGREES), "{name}: {found:?}");
        }
    }
}

/// A thin disc sits on a shaft, and a second shaft on the disc: of the axis, which lies across the disc, it has no node, and yet both hinges bear the bending
/// moments of the weights and of the force on the second shaft, with the disc thin and not. A model that was not told how to find them does not say.
#[test]
fn hinges_of_a_thin_disc_bear_bending() {
    for kind in ["revolute", "cylindrical"] {
        for inertia in ["[2, 1, 1]", "[2, 1.5, 0.5]", "[1.9, 1, 1]"] {
            let text = format!(
                "gravity = [0, 0, -10]\n[body.disc]\nmass = 3\ninertia = {inertia}\nposition = [0, 0, 0]\n\
                 [body.shaft]\nmass = 1\ninertia = [1.5, 1.6, 1.7]\nposition = [1, 0, 0]\n\
                 [joint.bearing]\ntype = \"{kind}\"\nbetween = [\"ground\", \"disc\"]\nat = [-0.3, 0, 0]\naxis = [1, 0, 0]\n\
                 [joint.hinge]\ntype = \"revolute\"\nbetween = [\"disc\", \"shaft\"]\nat = [0.5, 0, 0]\naxis = [1, 0, 0]\n\
                 [force.f]\ntype = \"force\"\nbody = \"shaft\"\nat = [1.2, 1, 1]\nforce = [3, 4, 0]\n"
            );
            let (_, recording) = common::run_every(&common::model_with_forces(&text), "radau", 0.01, 0.1, 1);
            let first = |name: &str| recording.column(name).unwrap()[0];
            // Of the force (0.7, 1, 1) × (3, 4, 0) about the hinge, and of the weight 0.5 · 10.
            // About the bearing arms are 0.8 m longer, and there is 0.3 · 30 of the disc.
            let expected = [("hinge.ty", -8.0), ("hinge.tz", 0.2), ("bearing.ty", -25.0), ("bearing.tz", -3.0), ("bearing.fz", 40.0)];
            for (name, expected) in expected {
                assert!((first(name) - expected).abs() < AGREES, "{kind}, {inertia}: {name} is {}", first(name));
            }
            let (_, recording) = common::run_every(&model(&text), "radau", 0.01, 0.1, 1);
            let untold = recording.column("hinge.ty").unwrap()[0];
            assert!(untold.is_nan(), "{kind}, {inertia}: {untold}");
        }
    }
}

/// A slider that a strut holds and a drive asks to start from rest: no forces do both, and the row of the start has none.
#[test]
fn a_drive_that_is_held_at_rest_has_no_forces() {
    for heavy in [1.0, 1e6] {
        let text = format!(
            "plane = \"xy\"\n[body.slider]\nmass = {heavy}\ninertia = {heavy}\nposition = [0, 0]\npoints = {{ lug = [0.1, 0.2] }}\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\nat = [0, 0]\naxis = [1, 2]\n\
             [bar.strut]\nbetween = [\"slider.lug\", [2, 0.3]]\nmass = {heavy}\n\
             [drive.push]\ntype = \"displacement\"\njoint = \"rail\"\n\
             profile = {{ table = [[0, 0], [0.05, 0.02], [0.1, 0.05], [0.2, 0.01]], ends = \"rest\" }}\n[output]\nreactions = true\n"
        );
        let model = common::model(&text);
        let mut simulation = common::simulation(&model, "radau", 0.002);
        model.find_reactions(&mut simulation);
        let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Rows);
        let Status::Stopped { at: 0.0, reason } = simulation.run(0.1, &mut recorder) else { panic!("it moved") };
        assert!(reason.contains("`push` asks for a motion that the other constraints do not allow"), "{reason}");
        let recording = recorder.finish();
        for name in ["push.effort", "rail.fx", "slider.ax"] {
            assert!(recording.column(name).unwrap()[0].is_nan(), "{heavy}: {name}");
        }
    }
}

/// A simulation that was asked for its own forces, and not as its model finds them, tells none of joints where bodies share nodes.
#[test]
fn forces_of_another_system_are_not_taken_for_those_of_joints() {
    let text = "plane = \"xy\"\ngravity = [0, -10]\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [1, 0]\n[body.b]\nmass = 1\ninertia = 0.1\nposition = [3, 0]\n\
                [joint.one]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
                [joint.two]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [2, 0]\n";
    let model = common::model_with_forces(text);
    let method = Method::resolve(&Choice::default()).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap();
    simulation.find_reactions();
    assert_eq!(model.reaction(&simulation, "two"), None);
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Joints);
    assert_eq!(simulation.run(0.02, &mut recorder), Status::Completed);
    assert!(recorder.finish().find("two.fy").unwrap().values.iter().all(|force| force.is_nan()));
    model.find_reactions(&mut simulation);
    assert!(model.reaction(&simulation, "two").is_some());
}

/// Hinges of a long chain that hangs at rest bear the weights below, of equal links and of ones a million times lighter between others; a step later, too.
#[test]
fn hinges_of_a_chain_at_rest_bear_what_hangs_on_them() {
    for (count, masses) in [(300, [2.0, 2.0]), (60, [2.0, 2e-6])] {
        let text = format!(
            "gravity = [0, 0, -9.81]\n[body.b]\nrepeat = \"i = 1 to {count}\"\nmass = \"{} + {}*mod(i, 2)\"\nshape = {{ box = [0.1, 0.1, 0.5] }}\n\
             position = [0, 0, \"0.25 - 0.5*i\"]\n[joint.first]\ntype = \"revolute\"\nbetween = [\"ground\", \"b[1]\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n\
             [joint.h]\nrepeat = \"i = 2 to {count}\"\ntype = \"revolute\"\nbetween = [\"b[i-1]\", \"b[i]\"]\nat = [0, 0, \"0.5 - 0.5*i\"]\naxis = [0, 1, 0]\n",
            masses[1],
            masses[0] - masses[1]
        );
        let (_, recording) = common::run_every(&common::model_with_forces(&text), "conserving-ggl", 1e-3, 1e-3, 1);
        let weight = |link: usize| 9.81 * if link % 2 == 1 { masses[0] } else { masses[1] };
        let all: f64 = (1..=count).map(weight).sum();
        for link in 1..=count {
            let name = if link == 1 { "first.fz".to_string() } else { format!("h[{link}].fz") };
            let below: f64 = (link..=count).map(weight).sum();
            for force in recording.column(&name).unwrap() {
                // Round-off of the sum.
                assert!((force - below).abs() < 1e-13 * all, "{masses:?} kg, {name}: {force} N, and {below} N below");
            }
        }
    }
}
