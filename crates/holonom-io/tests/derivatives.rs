//! Derivatives are never trusted: the assembled tangent of every registered kind against differences of its residual.

mod common;

use common::model;
use holonom::formulation::{
    ALL, Collocation, Iteration, Kkt, Level, Multipliers, Newton, RowsAt, Sampling, SolveSettings, Stabilized, Stage, Timing, Workspace,
};
use holonom::model::{Model, constraints, drives, forces, joints};
use holonom::simulation::{Choice, Method};

/// Step of the central differences, m.
const NUDGE: f64 = 3e-7;

/// Differences of smooth residuals of the order of one are good to this.
const TOLERANCE: f64 = 1e-7;

const STAGES: &[(Sampling, RowsAt)] = &[
    (Sampling::End, RowsAt::End),
    (Sampling::Middle, RowsAt::Middle),
    (Sampling::Between, RowsAt::End),
    (Sampling::Between, RowsAt::Mean),
];

/// A number between −1 and 1 that is the same in every run.
fn noise(k: usize) -> f64 {
    (12.9898 * (k as f64 + 1.0)).sin()
}

/// The stage's residual (coordinates, then rows) at the increment in the workspace.
fn residual(model: &Model, stage: &Stage, work: &mut Workspace) -> Vec<f64> {
    work.place(stage);
    work.evaluate(&model.system, stage);
    let mut unknowns = vec![0.0; model.system.coordinates() + model.system.constraints()];
    work.residual(&model.system, stage, &mut unknowns);
    unknowns.iter().map(|unknown| -unknown).collect()
}

/// Fails where an entry of a tangent is not the difference of the residual; `at` takes that with one unknown changed by so much.
fn assert_tangent(what: &str, unknowns: usize, entry: impl Fn(usize, usize) -> f64, mut at: impl FnMut(usize, f64) -> Vec<f64>) {
    for column in 0..unknowns {
        let [after, before, far, back] = [1.0, -1.0, 2.0, -2.0].map(|times| at(column, times * NUDGE));
        // Forces of stiff elements are rounded by more than small entries change.
        let rounding = f64::EPSILON * after.iter().fold(0.0_f64, |most, r| most.max(r.abs())) / NUDGE;
        for row in 0..after.len() {
            let difference = (8.0 * (after[row] - before[row]) - (far[row] - back[row])) / (12.0 * NUDGE);
            let found = entry(row, column);
            let is_near = (found - difference).abs() <= TOLERANCE * (1.0 + difference.abs()) + rounding;
            assert!(is_near, "{what}: entry ({row}, {column}) is {found} and should be {difference}");
        }
    }
}

fn check(name: &str, text: &str) {
    let model = model(text);
    let system = &model.system;
    let n = system.coordinates();
    let levels: &[Level] =
        if system.has_only_quadratic_rows() { &[Level::POSITION, Level::VELOCITY, Level::ACCELERATION] } else { &[Level::POSITION] };
    for (&level, &(sampling, rows)) in levels.iter().flat_map(|level| STAGES.iter().map(move |stage| (level, stage))) {
        // Rows of velocities and accelerations are evaluated where forces are.
        if level != Level::POSITION && sampling == Sampling::Between {
            continue;
        }
        let step = 0.1;
        let (inertia, rate) = if sampling == Sampling::End { (0.25 * step * step, 2.0 / step) } else { (0.5 * step * step, 1.0 / step) };
        let stage = Stage { sampling, rows, start: 0.3, step, inertia, rate };
        let mut work = Workspace::new(system);
        work.level = level;
        work.end.x.copy_from_slice(system.start_position());
        let (mut x0, mut v0, mut a0) = (work.start.x.clone(), work.start.v.clone(), vec![0.0; work.start.x.len()]);
        system.place_known(stage.start, &mut x0, &mut v0, &mut a0);
        (work.start.x, work.start.v) = (x0, v0);
        let (mut x1, mut v1) = (work.end.x.clone(), work.end.v.clone());
        system.place_known(stage.end(), &mut x1, &mut v1, &mut a0);
        (work.end.x, work.end.v) = (x1, v1);
        for i in n..work.end.x.len() {
            work.sampled.x[i] = if sampling == Sampling::End { work.end.x[i] } else { 0.5 * (work.start.x[i] + work.end.x[i]) };
            work.sampled.v[i] = (work.end.x[i] - work.start.x[i]) / step;
        }
        // What is smaller than 1 m is moved less.
        let way = 0.05 * system.start_position()[..n].iter().fold(0.0_f64, |most, x| most.max(x.abs())).min(1.0);
        (0..n).for_each(|i| work.d[i] = way * noise(i));
        (0..n).for_each(|i| work.prediction.offset[i] = 0.3 * noise(i + 7));
        (0..work.lambda.len()).for_each(|k| work.lambda[k] = 3.0 * noise(k + 3));
        let x0 = work.start.x.clone();
        system.evaluate_again(&x0, stage.start, &mut work.start.at);
        residual(&model, &stage, &mut work);
        let mut kkt = Kkt::new(system, &work.scales, 1, ALL);
        work.tangent(system, &stage, 1.0, &mut kkt);
        let at = |column: usize, by: f64| {
            let kept = work.d[column];
            work.d[column] = kept + by;
            let residual = residual(&model, &stage, &mut work);
            work.d[column] = kept;
            residual
        };
        let what = format!("{name}, {level:?}, {sampling:?}, {rows:?}");
        assert_tangent(&what, n, |row, column| kkt.solver.entry(row, column), at);
    }
}

/// Two stages that are solved together, with nothing zero: increments, multipliers of both levels and the start.
fn check_coupled(name: &str, text: &str) {
    let model = model(text);
    let system = &model.system;
    let timing = Timing { start: 0.3, step: 0.1, nodes: &[1.0 / 3.0, 1.0] };
    for doubled in [false, true] {
        let settings = SolveSettings {
            doubled,
            level: Level::POSITION,
            multipliers: Multipliers::Augmented(None),
            iteration: Iteration::Newton,
            tolerance: 0.0,
            max_iterations: 1,
            iterations: None,
        };
        let mut work = Workspace::new(system);
        work.level = settings.level;
        let mut stages = Collocation::new(system, 2, &settings);
        stages.set_rate([1.5, 0.5, -4.5, 2.5]);
        let size = stages.linearise(system, timing, &mut work).len();
        let unknowns: Vec<f64> = (0..size).map(|k| 0.03 * noise(k)).collect();
        stages.add(system, &unknowns, &work);
        let _ = stages.linearise(system, timing, &mut work);
        let assembled: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| stages.entry(i, j)).collect()).collect();
        let at = |column: usize, by: f64| {
            let mut nudge = vec![0.0; size];
            nudge[column] = by;
            stages.add(system, &nudge, &work);
            let residual = stages.linearise(system, timing, &mut work);
            nudge[column] = -by;
            stages.add(system, &nudge, &work);
            residual
        };
        assert_tangent(&format!("{name}, doubled: {doubled}"), size, |row, column| assembled[row][column], at);
    }
}

/// Rows at position and velocity level of the conserving scheme, with nothing zero.
fn check_both_levels(name: &str, text: &str) {
    let model = model(text);
    let system = &model.system;
    // The curvature of rows that are functions is left out beside γ.
    if !system.has_only_quadratic_rows() {
        return;
    }
    let (n, r, step) = (system.coordinates(), system.constraints(), 0.1);
    let stage = Stage { sampling: Sampling::Between, rows: RowsAt::End, start: 0.3, step, inertia: 0.5 * step * step, rate: 1.0 / step };
    let settings = Method::resolve(&Choice::default()).expect("the default goes together").settings;
    let mut work = Workspace::new(system);
    let mut newton = Newton::new(system, &work.scales, settings);
    let mut both = Stabilized::new(system, &newton);
    let Workspace { start, end, a, .. } = &mut work;
    system.place_known(stage.start, &mut start.x, &mut start.v, a);
    system.place_known(stage.end(), &mut end.x, &mut end.v, a);
    system.evaluate_again(&start.x, stage.start, &mut start.at);
    (0..n).for_each(|i| start.v[i] = noise(i + 11));
    (n..both.u.len()).for_each(|i| both.u[i] = 0.5 * step * end.v[i]);
    let size = 2 * (n + r);
    let add = |increments: &[f64], both: &mut Stabilized, work: &mut Workspace| {
        let (first, second) = increments.split_at(n + r);
        for (values, steps) in [(&mut work.d, &first[..n]), (&mut both.mu, &first[n..]), (&mut both.gamma, &second[n..])] {
            values.iter_mut().zip(steps).for_each(|(value, step)| *value += step);
        }
        both.u.iter_mut().zip(&second[..n]).for_each(|(u, step)| *u += step);
    };
    add(&(0..size).map(|k| 0.05 * noise(k)).collect::<Vec<_>>(), &mut both, &mut work);
    both.linearise(system, &stage, &mut newton, &mut work);
    let assembled: Vec<Vec<f64>> = (0..size).map(|i| (0..size).map(|j| both.entry(system, i, j)).collect()).collect();
    let at = |column: usize, by: f64| {
        let mut nudge = vec![0.0; size];
        nudge[column] = by;
        add(&nudge, &mut both, &mut work);
        let residual = both.linearise(system, &stage, &mut newton, &mut work);
        nudge[column] = -by;
        add(&nudge, &mut both, &mut work);
        residual
    };
    assert_tangent(&format!("{name}, both levels"), size, |row, column| assembled[row][column], at);
}

#[test]
fn every_kind_has_the_tangent_of_its_residual() {
    let mut kinds = 0;
    for kind in constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS) {
        check(kind.name, kind.example);
        check_coupled(kind.name, kind.example);
        check_both_levels(kind.name, kind.example);
        kinds += 1;
    }
    println!("{kinds} kinds");
    assert!(kinds >= 9);
}

/// Along an axis of the world and along one of a body that is neither of the two ends, by numbers and by formulas.
#[test]
fn springs_along_axes_have_the_tangent_of_their_residual() {
    let body = |name: &str, at: &str| {
        format!(
            "[body.{name}]\nmass = 1\ninertia = [0.1, 0.2, 0.25]\nposition = {at}\nangular_velocity = [1, 0.5, 2]\n\
             points = {{ lug = [0.3, 0.1, 0.2] }}\naxes = {{ up = [0.2, 0.1, 1] }}\n"
        )
    };
    let bodies = [body("A", "[0, 0, 0]"), body("B", "[0.5, 0.2, 1]"), body("C", "[1, 1, 0]")].concat();
    for axis in ["[1, 2, -1]", "\"A.up\"", "\"C.up\""] {
        let text = format!(
            "{bodies}[force.strut]\ntype = \"spring\"\nbetween = [\"A.lug\", \"B.lug\"]\nalong = {axis}\nstiffness = 20\n\
             rest_length = -0.2\ndamping = 3\nenergy = \"extension^4 + sin(length)\"\nforce = \"rate^3*length + 2*extension*rest - cos(t)\"\n"
        );
        check(axis, &text);
        check_coupled(axis, &text);
        check_both_levels(axis, &text);
    }
}

#[test]
fn every_example_has_the_tangent_of_its_residual() {
    let folder = format!("{}/../../examples", env!("CARGO_MANIFEST_DIR"));
    for file in std::fs::read_dir(folder).unwrap() {
        let path = file.unwrap().path();
        check(&path.display().to_string(), &std::fs::read_to_string(&path).unwrap());
    }
}

/// Forces, torques and efforts that read what other bodies do: places, velocities, angular velocities, joint coordinates and measures of
/// them, in space and in the plane.
#[test]
fn what_reads_other_bodies_has_the_tangent_of_its_residual() {
    let with_arm = |text: &str| format!("{ARM}{text}");
    let in_the_plane = FEEDBACK_IN_THE_PLANE.to_string();
    for (name, text) in [("space", with_arm(FEEDBACK_IN_SPACE)), ("plane", in_the_plane), ("springs and ropes", with_arm(FOLLOWING))] {
        check(name, &text);
        check_coupled(name, &text);
        check_both_levels(name, &text);
    }
}

/// A point and an arm, whose places and coordinate are read.
const ARM: &str = r#"
[point.bob]
mass = 1
position = [1, 0.3, 0.5]
velocity = [0.1, 0.2, 0]

[body.arm]
mass = 2
inertia = [0.2, 0.2, 0.3, 0.01, 0.02, 0]
position = [0.5, 0.2, 0]
angular_velocity = [0.1, 0.3, -0.2]

[body.arm.points]
tip = [0.4, 0.1, 0.1]

[joint.shoulder]
type = "revolute"
between = ["ground", "arm"]
at = [0, 0, 0]
axis = [0.2, 1, 0.1]
"#;

const FEEDBACK_IN_SPACE: &str = r#"
[table.soft]
points = [[-9, -3], [-1, -2], [0, 0], [1, 1], [9, 4]]
interpolation = "cubic"

[body.fin]
mass = 1
inertia = [0.1, 0.1, 0.2]
position = [0.9, 0.4, 0.3]

[joint.slot]
type = "cylindrical"
between = ["arm", "fin"]
at = [0.9, 0.4, 0.3]
axis = [1, 0, 0.3]

[measure.stretch]
value = "distance(bob, arm.tip)^2 + 0.3*speed(fin, bob) + t"

[force.motor]
type = "effort"
joint = "shoulder"
effort = "soft(stretch) - 0.4*slot.displacement*slot.angle_rate + 0.2*fin.wy*q - bob.vx*arm.tip.vz"

[force.thrust]
type = "force"
body = "fin"
axes = "body"
force = ["arm.wx*shoulder.angle", "stretch + wx", "angle(bob, arm, fin)*slot.displacement_rate"]

[force.wheel]
type = "torque"
body = "arm"
reaction = "fin"
torque = ["shoulder.angle_rate + bob.x", "fin.vz", "sin(slot.angle)"]

[force.pull]
type = "expression"
point = "bob"
force = ["arm.tip.x - x", "fin.wz*vx", "-shoulder.angle*z"]
"#;

const FEEDBACK_IN_THE_PLANE: &str = r#"
plane = "xz"

[body.trolley]
mass = 3
inertia = 0.4
position = [0.1, 0]

[body.load]
mass = 2
inertia = 0.2
position = [0.5, -1]
angular_velocity = 0.3

[joint.rail]
type = "prismatic"
between = ["ground", "trolley"]
at = [0, 0]
axis = [1, 0]

[joint.pivot]
type = "revolute"
between = ["trolley", "load"]
at = [0.1, 0]

[force.controller]
type = "effort"
joint = "rail"
effort = "3*pivot.angle - 0.2*load.angle_rate*q_rate + atan2(load.x - trolley.x, trolley.z - load.z)"

[force.fan]
type = "torque"
body = "load"
torque = "rail.displacement*load.vx - rail.displacement_rate"
"#;

/// Springs and ropes whose numbers follow what moves; the ropes are taut.
const FOLLOWING: &str = r#"
[input.command]
default = 0.2

[measure.height]
value = "bob.z + 0.5*arm.tip.x"

[force.spring]
type = "spring"
between = ["arm.tip", "bob"]
stiffness = "20 + 3*sin(t) + shoulder.angle"
rest_length = "0.3 + 0.2*height + command"
damping = "2 + bob.vx^2"
force = "rate*length - height*extension + arm.wy"

[force.guided]
type = "spring"
between = ["ground", "bob"]
along = [1, 2, -1]
stiffness = 5
rest_length = "shoulder.angle*bob.x"
damping = 1

[force.rope]
type = "rope"
between = [[0, 0, 2], "bob"]
through = ["arm.tip"]
length = "0.5 + 0.2*shoulder.angle + 0.1*bob.x^2 + 0.01*sin(t)"
stiffness = "30 + bob.vz"
damping = "1 + 0.3*height^2"

[force.winch]
type = "rope"
between = [[0, 1, 1], "bob"]
length = "0.3 + 0.05*bob.y"
stiffness = 40
damping = 2
drum = "shoulder"
radius = 0.3

[force.hinge]
type = "torsion"
joint = "shoulder"
stiffness = "3 + bob.x^2"
angle = "0.2*height + sin(t)"
damping = "0.5 + 0.1*bob.vy^2"
"#;
