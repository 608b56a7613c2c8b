//! Made-up motions of rigid bodies: solids of every shape, a crank that drives a slider in space, a four-bar linkage in a plane.

use super::Sample;
use holonom::record::{Anchor, Heading, Line, LineKind, Recording, Scene, SceneBody, SceneJoint, SceneLoad, SceneShape};
use serde_json::json;

type Vec3 = [f64; 3];

const ROWS: u32 = 401;
const STEP: f64 = 0.01;
/// How far beside the crank the slider runs, m.
const ASIDE: f64 = 0.35;

/// Centre of mass, and the quaternion (w, x, y, z) or, in a plane, the angle.
type Pose = (Vec3, Vec<f64>);

/// One solid of every shape, turning next to each other; they hang on springs.
pub fn shapes() -> Sample {
    let shapes = [
        ("brick", SceneShape::Box { size: [0.5, 0.3, 0.2] }),
        ("drum", SceneShape::Cylinder { radius: 0.2, length: 0.35 }),
        ("globe", SceneShape::Sphere { radius: 0.25 }),
        ("stick", SceneShape::Rod { length: 0.6 }),
        ("pill", SceneShape::Capsule { radius: 0.14, length: 0.3 }),
        ("wedge", wedge()),
    ];
    let place = |i: usize| [0.8 * (i % 3) as f64, 0.8 * (i / 3) as f64, 0.0];
    let top = [0.0, 0.0, 0.1];
    let spring = |i: usize, name: &str| {
        let [x, y, _] = place(i);
        let to = Anchor::Body { body: name.to_owned(), at: top };
        Line { name: format!("{name}-spring"), kind: LineKind::Spring, from: Anchor::Fixed([x, y, 0.8]), to, along: None }
    };
    let scene = Scene {
        axes: "xyz".to_owned(),
        gravity: [0.0, 0.0, -9.81],
        lines: shapes.iter().enumerate().map(|(i, (name, _))| spring(i, name)).collect(),
        bodies: shapes.iter().map(|(name, shape)| body(name, Some(shape.clone()), &[top])).collect(),
        ..Scene::default()
    };
    let poses = |t: f64| -> Vec<Pose> {
        let pose = |i: usize| {
            let [x, y, _] = place(i);
            ([x, y, 0.08 * (5.0 * t + i as f64).sin()], turned([0.3, 0.2 * i as f64, 1.0], 1.5 * t + i as f64))
        };
        (0..shapes.len()).map(pose).collect()
    };
    sample("Solids on springs", scene, &poses)
}

/// A sample with everything in it moved.
pub fn moved(mut sample: Sample, by: Vec3) -> Sample {
    let add = |place: &mut Vec3| place.iter_mut().zip(by).for_each(|(x, by)| *x += by);
    for line in &mut sample.scene.lines {
        for end in [&mut line.from, &mut line.to] {
            if let Anchor::Fixed(place) = end {
                add(place);
            }
        }
    }
    sample.scene.joints.iter_mut().filter(|joint| joint.body.is_none()).for_each(|joint| add(&mut joint.at));
    let columns = sample.recording.columns();
    let axis = |name: &str| ["x", "y", "z"].iter().position(|axis| name.rsplit_once('.').is_some_and(|(_, ending)| ending == *axis));
    let shifts: Vec<f64> = columns.iter().map(|column| axis(&column.heading.name).map_or(0.0, |k| by[k])).collect();
    let mut recording = Recording::new(columns.iter().map(|column| column.heading.clone()));
    for row in 0..sample.recording.rows() {
        recording.push(&columns.iter().zip(&shifts).map(|(column, shift)| column.values[row] + shift).collect::<Vec<_>>());
    }
    sample.recording = recording;
    sample
}

/// A cart on one wheel that goes straight on, 20 m.
pub fn cart() -> Sample {
    let scene = Scene {
        axes: "xyz".to_owned(),
        gravity: [0.0, 0.0, -9.81],
        bodies: vec![
            body("cart", Some(SceneShape::Box { size: [0.8, 0.3, 0.2] }), &[]),
            body("wheel", Some(SceneShape::Cylinder { radius: 0.2, length: 0.05 }), &[]),
        ],
        ..Scene::default()
    };
    let poses = |t: f64| -> Vec<Pose> {
        let at = |z: f64| [5.0 * t, 0.0, z];
        vec![(at(0.4), turned([0.0, 0.0, 1.0], 0.0)), (at(0.2), turned([0.0, 1.0, 0.0], 25.0 * t))]
    };
    sample("Cart", scene, &poses)
}

/// A small car that goes once round a circle of 20 m on a track, of which so much is there, in turns.
pub fn track(turns: f64) -> Sample {
    let at = |angle: f64| [20.0 * angle.cos(), 20.0 * angle.sin(), 0.0];
    let way = std::f64::consts::TAU * turns;
    let mut rail = joint("rail", "point-on-curve", (None, Some("car")), at(0.0), None);
    rail.curve = (0..=100).map(|k| at(way * f64::from(k) / 100.0)).collect();
    let scene = Scene {
        axes: "xyz".to_owned(),
        gravity: [0.0, 0.0, -9.81],
        bodies: vec![body("car", Some(SceneShape::Box { size: [0.2, 0.1, 0.1] }), &[])],
        joints: vec![rail],
        ..Scene::default()
    };
    let round = |t: f64| at(std::f64::consts::TAU * t / (STEP * f64::from(ROWS - 1)));
    sample("Track", scene, &|t| vec![(round(t), turned([0.0, 0.0, 1.0], 0.0))])
}

/// Crank, connecting rod and slider without shapes, a wheel on a universal joint, and a symbol of every other kind.
pub fn crank_in_space() -> Sample {
    let (crank, rod) = (0.3, 0.9);
    let half = |length: f64| [0.5 * length, 0.0, 0.0];
    let back = |length: f64| [-0.5 * length, 0.0, 0.0];
    let x = Some([1.0, 0.0, 0.0]);
    let mut joints = vec![
        joint("main-bearing", "revolute", (None, Some("crank")), [0.0; 3], x),
        joint("crank-pin", "spherical", (Some("crank"), Some("rod")), half(crank), None),
        joint("wrist-pin", "universal", (Some("slider"), Some("rod")), [0.0; 3], Some([0.0, 1.0, 0.0])),
        joint("guide", "prismatic", (None, Some("slider")), [slider_at(crank, rod, 0.0), ASIDE, 0.0], x),
        joint("mast-foot", "universal", (None, Some("mast")), [0.5, 0.7, 0.0], x),
        joint("hub", "revolute", (Some("mast"), Some("wheel")), [0.0, 0.0, 0.25], Some([0.0, 0.0, 1.0])),
        joint("frame-foot", "spherical", (Some("frame"), None), [-0.2, -0.1, 0.0], None),
    ];
    let kinds = ["cylindrical", "planar", "fixed", "screw", "constant-velocity", "point-on-line", "point-on-plane", "point-on-curve"];
    let silent = ["parallel", "orientation", "distance", "generic", "gear", "rolling", "a-kind-of-tomorrow"];
    for (i, kind) in kinds.into_iter().chain(silent).enumerate() {
        let place = [-0.3 + 0.2 * (i % 8) as f64, -0.45 - 0.2 * (i / 8) as f64, 0.0];
        joints.push(joint(kind, kind, (None, None), place, Some([0.0, 0.0, 2.0])));
    }
    let wheel = SceneShape::Cylinder { radius: 0.22, length: 0.05 };
    let scene = Scene {
        axes: "xyz".to_owned(),
        gravity: [0.0, 0.0, -9.81],
        bodies: vec![
            body("crank", None, &[back(crank), half(crank)]),
            body("rod", None, &[back(rod), half(rod)]),
            body("slider", None, &[[0.0; 3]]),
            body("mast", None, &[[0.0, 0.0, -0.25], [0.0, 0.0, 0.25]]),
            body("wheel", Some(wheel), &[[0.0; 3]]),
            body("frame", None, &[[-0.2, -0.1, 0.0], [0.2, -0.1, 0.0], [0.0, 0.2, 0.0]]),
            body("jack", None, &[[0.12, 0.0, 0.0], [-0.06, 0.1, 0.0], [-0.06, -0.1, 0.0], [0.0, 0.0, 0.14]]),
        ],
        joints,
        ..Scene::default()
    };
    let poses = |t: f64| -> Vec<Pose> {
        let angle = 2.5 * t;
        let pin = [0.0, crank * angle.cos(), crank * angle.sin()];
        let end = [slider_at(crank, rod, angle), ASIDE, 0.0];
        let middle = |share: f64, from: Vec3, to: Vec3| [0, 1, 2].map(|i| from[i] + share * (to[i] - from[i]));
        let direction = [0.2 * angle.sin(), 0.15, 1.0];
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        let foot = [0.5, 0.7, 0.0];
        let head = [0, 1, 2].map(|i| foot[i] + 0.5 * direction[i] / length);
        // The axes of mast and wheel: z along the mast.
        let upright = product(&along_x(direction), &[0.5f64.sqrt(), 0.0, 0.5f64.sqrt(), 0.0]);
        vec![
            (middle(0.5, [0.0; 3], pin), along_x(pin)),
            (middle(0.5, pin, end), along_x([end[0] - pin[0], end[1] - pin[1], end[2] - pin[2]])),
            (end, vec![1.0, 0.0, 0.0, 0.0]),
            (middle(0.5, foot, head), upright.clone()),
            (head, product(&upright, &turned([0.0, 0.0, 1.0], 4.0 * t))),
            ([0.0, 0.85, 0.1], turned([0.0, 1.0, 0.2], 0.4 * angle.sin())),
            ([1.1, 0.75, 0.15], turned([0.2, 0.1, 1.0], t)),
        ]
    };
    sample("Crank and slider in space", scene, &poses)
}

/// Crank, coupler plate and rocker as sketches, with solids drawn flat beside them; `rate` of the crank in rad/s.
pub fn four_bar(rate: f64) -> Sample {
    let (crank, coupler, rocker, base) = (0.35, 1.0, 0.8, [1.0, 0.1]);
    let flat = |u: f64, w: f64| [u, 0.0, w];
    let ends = |length: f64| [flat(-0.5 * length, 0.0), flat(0.5 * length, 0.0)];
    let scene = Scene {
        axes: "xz".to_owned(),
        gravity: [0.0, 0.0, -9.81],
        lines: vec![Line {
            name: "spring".to_owned(),
            kind: LineKind::Spring,
            from: Anchor::Fixed(flat(1.5, 1.3)),
            to: Anchor::Body { body: "coupler".to_owned(), at: flat(0.0, 0.4) },
            along: None,
        }],
        bodies: vec![
            body("crank", None, &ends(crank)),
            body("coupler", None, &[flat(-0.5, -0.1), flat(0.5, -0.1), flat(0.0, 0.4)]),
            body("rocker", None, &ends(rocker)),
            body("block", Some(SceneShape::Box { size: [0.3, 0.2, 0.4] }), &[flat(0.0, 0.0)]),
            body("wheel", Some(SceneShape::Cylinder { radius: 0.2, length: 0.1 }), &[flat(0.0, 0.0)]),
            body("link", Some(SceneShape::Rod { length: 0.9 }), &ends(0.9)),
        ],
        joints: vec![
            joint("a", "revolute", (None, Some("crank")), [0.0; 3], None),
            joint("b", "revolute", (Some("crank"), Some("coupler")), ends(crank)[1], None),
            joint("c", "revolute", (Some("coupler"), Some("rocker")), flat(0.5, -0.1), None),
            joint("d", "revolute", (Some("rocker"), None), ends(rocker)[0], None),
            joint("rail", "prismatic", (Some("block"), None), [0.0; 3], Some([1.0, 0.0, 0.0])),
            joint("hinge", "revolute", (Some("block"), Some("link")), [0.0; 3], None),
            joint("axle", "revolute", (None, Some("wheel")), flat(0.0, -0.6), None),
        ],
        ..Scene::default()
    };
    let poses = |t: f64| -> Vec<Pose> {
        let angle = rate * t;
        let pin = [crank * angle.cos(), crank * angle.sin()];
        let joint = meet(pin, coupler, base, rocker);
        let towards = |from: [f64; 2], to: [f64; 2]| (to[1] - from[1]).atan2(to[0] - from[0]);
        let middle = |from: [f64; 2], to: [f64; 2]| [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        let turn = towards(pin, joint);
        let centre = middle(pin, joint);
        let slide = [0.9 + 0.2 * angle.sin(), -0.6];
        let swing = 0.5 * angle.cos() - 0.3;
        let pose = |place: [f64; 2], angle: f64| (flat(place[0], place[1]), vec![angle]);
        vec![
            pose(middle([0.0; 2], pin), angle),
            pose([centre[0] - 0.1 * turn.sin(), centre[1] + 0.1 * turn.cos()], turn),
            pose(middle(base, joint), towards(base, joint)),
            pose(slide, 0.0),
            pose([0.0, -0.6], -2.0 * angle),
            pose([slide[0] + 0.45 * swing.cos(), slide[1] + 0.45 * swing.sin()], swing),
        ]
    };
    sample("Four-bar linkage", scene, &poses)
}

/// The linkage with a motor, a cylinder, a bar and a load, and with made-up forces that never change: 5 N from the crank on the coupler, to
/// the right and up, 2 N of tension in the spring, 7 N m of the motor, 30 N of the cylinder that pushes, and a load of 6 N on the coupler.
pub fn driven() -> Sample {
    let mut sample = four_bar(2.5);
    sample.scene.joints[0].drives.push("motor".to_owned());
    let at = |body: &str, at: Vec3| Anchor::Body { body: body.to_owned(), at };
    let line = |name: &str, kind, to| Line { name: name.to_owned(), kind, from: Anchor::Fixed([1.6, 0.0, -0.5]), to, along: None };
    sample.scene.lines.push(line("strut", LineKind::Cylinder, at("rocker", [0.0; 3])));
    sample.scene.lines.push(line("tie", LineKind::Bar, Anchor::Fixed([1.6, 0.0, 0.4])));
    sample.scene.loads.push(SceneLoad { name: "load".to_owned(), at: at("coupler", [0.0; 3]) });
    let forces = [
        ("b.fx", "N", 3.0),
        ("b.fz", "N", 4.0),
        ("b.t", "N·m", 0.0),
        ("spring.force", "N", 2.0),
        ("motor.effort", "N·m", 7.0),
        ("strut.effort", "N", 30.0),
        ("load.fx", "N", 6.0),
        ("load.fz", "N", 0.0),
        ("coupler.vx", "m/s", 0.5),
        ("coupler.vz", "m/s", -0.5),
    ];
    let own = sample.recording.columns().iter().map(|column| column.heading.clone());
    let others = forces.map(|(name, unit, _)| Heading { name: name.to_owned(), unit: unit.into(), meaning: "made up".into() });
    let mut recording = Recording::new(own.chain(others));
    for row in 0..sample.recording.rows() {
        let moved = sample.recording.columns().iter().map(|column| column.values[row]);
        let values: Vec<f64> = moved.chain(forces.map(|(_, _, value)| value)).collect();
        recording.push(&values);
    }
    sample.recording = recording;
    sample
}

fn sample(title: &str, scene: Scene, poses: &dyn Fn(f64) -> Vec<Pose>) -> Sample {
    let place: Vec<String> = scene.axes.chars().map(String::from).collect();
    let turn: &[&str] = if scene.axes.len() == 3 { &["qw", "qx", "qy", "qz"] } else { &["angle"] };
    let coordinates = || place.iter().map(String::as_str).chain(turn.iter().copied());
    let names = scene.bodies.iter().flat_map(|body| coordinates().map(move |coordinate| format!("{}.{coordinate}", body.name)));
    let mut recording = Recording::new(["t", "energy", "phi"].into_iter().map(str::to_owned).chain(names));
    let kept: Vec<usize> = scene.axes.chars().map(|axis| "xyz".find(axis).unwrap()).collect();
    for row in 0..ROWS {
        let t = STEP * f64::from(row);
        let mut values = vec![t, 1.0, 0.0];
        for (centre, turn) in poses(t) {
            values.extend(kept.iter().map(|&axis| centre[axis]));
            values.extend(turn);
        }
        recording.push(&values);
    }
    let summary = json!({
        "model": title, "method": {"name": "conserving-ggl"}, "status": "completed", "step": STEP, "end": STEP * f64::from(ROWS - 1),
        "steps": ROWS - 1, "dof": 1, "redundant": 0,
    });
    Sample { label: "conserving-ggl".to_owned(), recording, scene, summary }
}

fn body(name: &str, shape: Option<SceneShape>, places: &[Vec3]) -> SceneBody {
    SceneBody { name: name.to_owned(), mass: 1.0, shape, places: places.to_vec() }
}

fn joint(name: &str, kind: &str, (body, other): (Option<&str>, Option<&str>), at: Vec3, axis: Option<Vec3>) -> SceneJoint {
    let (name, kind, drives) = (name.to_owned(), kind.to_owned(), Vec::new());
    SceneJoint {
        name,
        kind,
        body: body.map(str::to_owned),
        other: other.map(str::to_owned),
        at,
        axis,
        acts_on_other: true,
        drives,
        radius: None,
        curve: Vec::new(),
    }
}

fn wedge() -> SceneShape {
    let end = |y: f64| [[-0.2, y, -0.12], [0.3, y, -0.12], [-0.2, y, 0.25]];
    let vertices = end(-0.15).into_iter().chain(end(0.15)).collect();
    let triangles = vec![[0, 1, 2], [3, 5, 4], [0, 3, 4], [0, 4, 1], [1, 4, 5], [1, 5, 2], [2, 5, 3], [2, 3, 0]];
    SceneShape::Mesh { vertices, triangles }
}

/// Where the slider is on its line, beside the x-axis, that the rod holds to the end of the crank.
fn slider_at(crank: f64, rod: f64, angle: f64) -> f64 {
    let [across, up] = [crank * angle.cos() - ASIDE, crank * angle.sin()];
    (rod * rod - across * across - up * up).sqrt()
}

/// The left of the two places with the given distances from a and b, seen from a to b.
fn meet(a: [f64; 2], from_a: f64, b: [f64; 2], from_b: f64) -> [f64; 2] {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let square = dx * dx + dy * dy;
    let along = 0.5 * (1.0 + (from_a * from_a - from_b * from_b) / square);
    let aside = (from_a * from_a / square - along * along).sqrt();
    [a[0] + along * dx - aside * dy, a[1] + along * dy + aside * dx]
}

fn turned(axis: Vec3, angle: f64) -> Vec<f64> {
    let length = axis.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (sin, cos) = (0.5 * angle).sin_cos();
    std::iter::once(cos).chain(axis.map(|x| sin * x / length)).collect()
}

/// The shortest turn that takes the x-axis into a direction.
fn along_x([x, y, z]: Vec3) -> Vec<f64> {
    let length = (x * x + y * y + z * z).sqrt();
    turned([0.0, -z, y + 1e-12], (x / length).acos())
}

/// First turn by b, then by a.
fn product(a: &[f64], b: &[f64]) -> Vec<f64> {
    vec![
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}
