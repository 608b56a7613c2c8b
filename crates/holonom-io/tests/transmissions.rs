//! Forces of teeth, belts and racks, and what the bearings of their wheels bear, against statics by hand and Newton's law.

mod common;

use common::model;
use holonom::record::{Anchor, Recording, WheelsKind};

/// A run of the model's own with the forces of all joints, also where bodies share nodes.
fn run(text: &str, end: f64) -> Recording {
    let apart = model(&format!("{text}\n[output]\nreactions = true\n"));
    common::run_every(&apart, "conserving-ggl", 0.01, end, 1).1
}

fn first(recording: &Recording, names: &[&str]) -> Vec<f64> {
    names.iter().map(|name| recording.column(name).unwrap_or_else(|| panic!("there is no column {name}"))[0]).collect()
}

fn close(what: &str, found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
    let off = found.iter().zip(expected).fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()));
    assert!(found.len() == expected.len() && off <= 1e-10 * size, "{what}: {found:?} and {expected:?} by hand");
}

/// Two wheels at rest about z at x = 0 and x = `apart`, on the ground, with a moment of 10 N·m on the first and what holds it on the second. The
/// axes of the joints point along `signs` z, and those with `turned` name the wheel first.
fn pair(apart: f64, signs: [f64; 2], turned: [bool; 2], coupler: &str, hold: f64) -> String {
    let mut text = String::from("gravity = [0, 0, 0]\n");
    for k in 0..2 {
        let (name, x) = (["a", "b"][k], [0.0, apart][k]);
        let between = if turned[k] { format!("\"{name}\", \"ground\"") } else { format!("\"ground\", \"{name}\"") };
        // An effort acts along the coordinate.
        let effort = [10.0, hold][k] * signs[k] * if turned[k] { -1.0 } else { 1.0 };
        text += &format!(
            "[body.{name}]\nmass = 1\nshape = {{ cylinder = [0.1, 0.02] }}\nposition = [{x}, 0, 0]\n\
             [joint.axle_{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = [{x}, 0, 0]\naxis = [0, 0, {}]\n\
             [force.on_{name}]\ntype = \"effort\"\njoint = \"axle_{name}\"\neffort = {effort}\n",
            signs[k]
        );
    }
    text + &format!("[joint.mesh]\njoints = [\"axle_a\", \"axle_b\"]\n{coupler}\n")
}

/// How the coordinates of a pair count about z, as a product.
fn product(signs: [f64; 2], turned: [bool; 2]) -> f64 {
    signs[0] * signs[1] * if turned[0] == turned[1] { 1.0 } else { -1.0 }
}

/// What the axle of `body` bears, on the body, whatever is named first.
fn borne(recording: &Recording, body: &str, is_first: bool) -> Vec<f64> {
    let sign = if is_first { -1.0 } else { 1.0 };
    first(recording, &[&format!("axle_{body}.fx"), &format!("axle_{body}.fy"), &format!("axle_{body}.fz")])
        .iter()
        .map(|f| sign * f)
        .collect()
}

const WAYS: [([f64; 2], [bool; 2]); 4] =
    [([1.0, 1.0], [false, false]), ([1.0, -1.0], [false, false]), ([-1.0, 1.0], [true, false]), ([1.0, 1.0], [false, true])];

/// Wheels of 0.1 and 0.2 m outside of each other: teeth push with 100 N across, and apart with that times tan 20°. Inside a ring of
/// 0.3 m they meet on the other side, and push the pinion to its own centre.
#[test]
fn bearings_bear_what_teeth_push() {
    let apart = 100.0 * f64::to_radians(20.0).tan();
    for (signs, turned) in WAYS {
        let product = product(signs, turned);
        for (distance, ratio, hold, on_first) in [(0.3, -2.0, 20.0, [-apart, -100.0, 0.0]), (0.2, 3.0, -30.0, [apart, 100.0, 0.0])] {
            let coupler = format!("type = \"gear\"\nratio = {}\npressure_angle = \"20*deg\"", ratio * product);
            let recording = run(&pair(distance, signs, turned, &coupler, hold), 0.02);
            let (a, b) = (borne(&recording, "a", turned[0]), borne(&recording, "b", turned[1]));
            close("teeth", &first(&recording, &["mesh.fx", "mesh.fy", "mesh.fz"]), &on_first);
            close("first", &a, &on_first.map(|f| -f));
            close("second", &b, &on_first);
        }
    }
}

/// The same ring with its pinion, the ring named first: 30 N·m on it push with 100 N across, and the rim outwards.
#[test]
fn a_ring_that_is_named_first_is_pushed_outwards() {
    let apart = 100.0 * f64::to_radians(20.0).tan();
    for (signs, turned) in WAYS {
        let coupler = format!("type = \"gear\"\nratio = {}\npressure_angle = \"20*deg\"", product(signs, turned) / 3.0);
        // 10 N·m on the ring of 0.3 m.
        let recording = run(&pair(0.2, signs, turned, &coupler, -10.0 / 3.0), 0.02);
        let (a, b) = (borne(&recording, "a", turned[0]), borne(&recording, "b", turned[1]));
        let on_ring = [apart / 3.0, -100.0 / 3.0, 0.0];
        close("teeth", &first(&recording, &["mesh.fx", "mesh.fy", "mesh.fz"]), &on_ring);
        close("ring", &a, &on_ring.map(|f| -f));
        close("pinion", &b, &on_ring);
    }
}

/// Wheels whose joints have their places beside each other along the axes, on a carrier that is free: what it bears turns it as Newton and Euler say.
#[test]
fn wheels_beside_each_other_turn_their_carrier_by_all_that_it_bears() {
    for coupler in ["type = \"gear\"\nratio = -2\npressure_angle = \"20*deg\"", "type = \"pulley\"\nradii = [0.1, 0.05]\npretension = 20"] {
        let text = format!(
            "gravity = [0, 0, 0]\n[body.carrier]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\n\
             [body.a]\nmass = 1\ninertia = [0.01, 0.01, 0.02]\nposition = [0, 0, 0]\n\
             [body.b]\nmass = 1\ninertia = [0.01, 0.01, 0.02]\nposition = [0.3, 0, 0.1]\n\
             [joint.one]\ntype = \"revolute\"\nbetween = [\"carrier\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
             [joint.two]\ntype = \"revolute\"\nbetween = [\"carrier\", \"b\"]\nat = [0.3, 0, 0.1]\naxis = [0, 0, 1]\n\
             [joint.mesh]\njoints = [\"one\", \"two\"]\n{coupler}\n[force.e]\ntype = \"effort\"\njoint = \"one\"\neffort = 3\n"
        );
        let recording = run(&text, 0.02);
        let of = |name: &str| -> Vec<f64> {
            first(&recording, &["x", "y", "z"].map(|axis| format!("{name}{axis}")).each_ref().map(String::as_str))
        };
        let ([f, m], [g, n]) = (["one.f", "one.t"].map(of), ["two.f", "two.t"].map(of));
        let arm = [0.3, 0.0, 0.1];
        let moment = |k: usize| -(m[k] + n[k] + arm[(k + 1) % 3] * g[(k + 2) % 3] - arm[(k + 2) % 3] * g[(k + 1) % 3]);
        let turned = [moment(0), moment(1), moment(2) - 3.0];
        close(coupler, &turned, &of("carrier.alpha").iter().map(|alpha| 0.1 * alpha).collect::<Vec<_>>());
        assert!(f.iter().chain(&g).any(|f| f.abs() > 1.0));
    }
}

/// A belt over wheels of 0.1 and 0.2 m, 0.5 m apart, rises by 0.1 m where it is open and by 0.3 m where it crosses itself: the strand that pulls has
/// 100 N more than the other, which has none of a chain. Whether wheels turn against each other does not depend on how their joints are written.
#[test]
fn bearings_bear_what_belts_pull() {
    for (signs, turned) in WAYS {
        for is_crossed in [false, true] {
            for pretension in [0.0, 300.0] {
                let hold = if is_crossed { 20.0 } else { -20.0 };
                let coupler = format!("type = \"pulley\"\nradii = [0.1, 0.2]\ncrossed = {is_crossed}\npretension = {pretension}");
                let recording = run(&pair(0.5, signs, turned, &coupler, hold), 0.02);
                let sine: f64 = if is_crossed { 0.3 / 0.5 } else { -0.1 / 0.5 };
                let sum = f64::max(100.0, 2.0 * pretension);
                // The moment on the first wheel is against the sense of z: its upper strand pulls.
                let pull = [sum * (1.0 - sine * sine).sqrt(), -100.0 * sine, 0.0];
                close("belt", &first(&recording, &["mesh.fx", "mesh.fy", "mesh.fz"]), &pull);
                close("first", &borne(&recording, "a", turned[0]), &pull.map(|f| -f));
                close("second", &borne(&recording, "b", turned[1]), &pull);
            }
        }
    }
}

/// A pinion of 0.1 m drives a rack with 100 N that a load holds: teeth push it away with tan 20° of that, and the rail bears the moment about its place,
/// whichever of the two joints is named first.
#[test]
fn rails_bear_what_pinions_push() {
    let both = "gravity = [0, 0, 0]\n[body.pinion]\nmass = 1\nshape = { cylinder = [0.1, 0.02] }\nposition = [0, 0, 0]\n\
                [body.rack]\nmass = 2\nshape = { box = [1, 0.02, 0.02] }\nposition = [0.2, -0.15, 0]\n\
                [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"pinion\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"rack\"]\nat = [0.2, -0.15, 0]\naxis = [1, 0, 0]\n\
                [joint.mesh]\ntype = \"rack-and-pinion\"\njoints = [\"axle\", \"rail\"]\nradius = 0.1\npressure_angle = \"20*deg\"\n\
                [force.motor]\ntype = \"effort\"\njoint = \"axle\"\neffort = 10\n\
                [force.load]\ntype = \"effort\"\njoint = \"rail\"\neffort = -100\n";
    let apart = 100.0 * f64::to_radians(20.0).tan();
    for text in [both.to_string(), both.replace("[\"axle\", \"rail\"]", "[\"rail\", \"axle\"]")] {
        let recording = run(&text, 0.02);
        // The rack is below, turns the pinion back by 10 N·m, and pushes it up.
        close("teeth", &first(&recording, &["mesh.fx", "mesh.fy", "mesh.fz"]), &[-100.0, apart, 0.0]);
        close("axle", &first(&recording, &["axle.fx", "axle.fy", "axle.tz"]), &[100.0, -apart, 0.0]);
        close("rail", &first(&recording, &["rail.fx", "rail.fy", "rail.fz"]), &[0.0, apart, 0.0]);
        // Teeth push at (0, −0.1), which is (−0.2, 0.05) from the place of the rail, with (100, −apart).
        let moment = -0.2 * -apart - 0.05 * 100.0;
        close("rail", &first(&recording, &["rail.tx", "rail.ty", "rail.tz"]), &[0.0, 0.0, -moment]);
    }
}

/// A planet on an arm that turns about a sun on the ground, askew in space and under gravity: its bearing and the teeth give it its acceleration.
#[test]
fn a_planet_moves_by_its_bearing_and_its_teeth() {
    let text = "[body.arm]\nmass = 1\nshape = { box = [0.3, 0.05, 0.05] }\nposition = [0.15, 0, 0.1]\n\
                [body.planet]\nmass = 2\nshape = { cylinder = [0.1, 0.04] }\nposition = [0.3, 0, 0.1]\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [0, 0, 0.1]\naxis = [0, 0.6, 0.8]\n\
                [joint.axle]\ntype = \"revolute\"\nbetween = [\"planet\", \"arm\"]\nat = [0.3, 0, 0.1]\naxis = [0, 0.6, 0.8]\n\
                [joint.mesh]\ntype = \"gear\"\njoints = [\"hinge\", \"axle\"]\nratio = -0.5\npressure_angle = 0.3\n\
                [force.motor]\ntype = \"effort\"\njoint = \"hinge\"\neffort = \"3 - 0.2*q_rate\"\n";
    let recording = run(text, 0.5);
    // The planet is the first body of its joint, and the ground the first wheel.
    for (axis, weight) in [("x", 0.0), ("y", 0.0), ("z", -9.81 * 2.0)] {
        let [bearing, teeth, a] =
            ["axle.f", "mesh.f", "planet.a"].map(|name| recording.column(&format!("{name}{axis}")).expect("it is recorded"));
        for row in 0..recording.rows() {
            let (sum, change) = (-bearing[row] - teeth[row] + weight, 2.0 * a[row]);
            assert!((sum - change).abs() <= 1e-9 * (1.0 + teeth[row].abs()), "{axis}: {sum} and {change} in row {row}");
        }
        assert!(teeth.iter().any(|f| f.abs() > 0.1), "teeth push along {axis}");
    }
}

/// What the picture has of wheels: pitch radii whose sum, or difference for a wheel inside another, is the distance of the axes, and the ratio theirs.
#[test]
fn wheels_are_drawn_with_their_radii() {
    let drawn = |signs: [f64; 2], turned: [bool; 2], coupler: &str| {
        let model = model(&pair(0.3, signs, turned, coupler, 0.0));
        let [wheels] = &model.scene.wheels[..] else { panic!("{:?}", model.scene.wheels) };
        assert_eq!((&wheels.joints, &wheels.bodies), (&["axle_a", "axle_b"].map(String::from), &["a", "b"].map(|name| Some(name.into()))));
        (wheels.kind, wheels.radii.map(|radius| radius.expect("a wheel is round")))
    };
    for (signs, turned) in [([1.0, 1.0], [false; 2]), ([-1.0, 1.0], [false; 2]), ([1.0, -1.0], [true, false]), ([1.0, 1.0], [true; 2])] {
        // Outside teeth have the wheels turn against each other, however the joints are written.
        let sense = signs[0] * signs[1] * if turned[0] == turned[1] { 1.0 } else { -1.0 };
        let (kind, radii) = drawn(signs, turned, &format!("type = \"gear\"\nratio = {}", -2.0 * sense));
        assert_eq!(kind, WheelsKind::Gear);
        close("outside", &radii, &[0.1, 0.2]);
        let (_, radii) = drawn(signs, turned, &format!("type = \"gear\"\nratio = {}", 2.0 * sense));
        close("inside", &radii, &[0.3, 0.6]);
    }
    let belt = |crossed: bool| drawn([1.0; 2], [false; 2], &format!("type = \"pulley\"\nradii = [0.1, 0.15]\ncrossed = {crossed}"));
    assert_eq!([belt(false), belt(true)], [WheelsKind::Belt, WheelsKind::CrossedBelt].map(|kind| (kind, [0.1, 0.15])));
}

/// A curve goes through its points, in the axes of the body that has it, and a bushing is on both of its bodies.
#[test]
fn curves_discs_and_bushings_are_drawn_where_they_are() {
    let model = model(
        "plane = \"xy\"\n[body.cam]\nmass = 1\ninertia = 1\nposition = [1, 2]\norientation = { angle = \"90*deg\" }\n\
         [body.follower]\nmass = 1\ninertia = 1\nposition = [2, 2]\n\
         [joint.groove]\ntype = \"point-on-curve\"\nbetween = [\"cam\", \"follower\"]\nat = [2, 2]\nclosed = true\n\
         curve = [[2, 2], [1, 3], [0, 2], [1, 1]]\n\
         [force.mount]\ntype = \"bushing\"\nbetween = [\"ground\", \"follower\"]\nat = [2, 2.5]\nstiffness = [1, 1, 1]\n",
    );
    let curve = &model.scene.joints[0].curve;
    // A quarter turn back from the axes of the model.
    for [x, y] in [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]] {
        assert!(curve.iter().any(|place| (place[0] - x).hypot(place[1] - y) < 1e-12), "[{x}, {y}] is not in {curve:?}");
    }
    let apart = |k: usize| (curve[0][k] - curve[curve.len() - 1][k]).abs();
    assert!(apart(0).max(apart(1)) < 1e-12, "it is closed: {curve:?}");
    let bushing = &model.scene.bushings[0];
    assert_eq!((bushing.name.as_str(), &bushing.at), ("mount", &Anchor::Body { body: "follower".into(), at: [0.0, 0.5, 0.0] }));
    assert!(model.scene.bodies[1].places.contains(&[0.0, 0.5, 0.0]), "{:?}", model.scene.bodies[1].places);
}
