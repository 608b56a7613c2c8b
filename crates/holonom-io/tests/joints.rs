//! Every joint: freedom, motion and forces against solutions by Newton and Euler in minimal coordinates, which
//! `joints/reference.py` computes; what the conserving scheme keeps; every named method.

use std::collections::BTreeMap;

use holonom::analysis;
use holonom::model::{Model, joints};
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Choice, Method, NAMED, Simulation, Status, Summary};
use holonom_io::Source;
use serde_json::Value;

/// Largest difference from the reference, m, rad, N and so on, all of the order of one to ten.
const AGREES: f64 = 1e-8;

fn cases() -> Vec<Value> {
    serde_json::from_str(include_str!("joints/reference.json")).expect("the references are JSON")
}

fn name(case: &Value) -> &str {
    case["name"].as_str().expect("a case has a name")
}

fn model(name: &str, text: &str) -> Model {
    let source = Source::read(name, text.as_bytes()).unwrap_or_else(|message| panic!("{message}"));
    source.model().unwrap_or_else(|message| panic!("{message}"))
}

/// The model of a case, with reactions or with the nodes shared that bodies may share.
fn model_of(case: &Value, reactions: bool) -> Model {
    let text = case["model"].as_str().expect("a case has a model");
    model(name(case), &if reactions { text.to_string() } else { text.replace("reactions = true", "reactions = false") })
}

fn run(model: &Model, method: &str, accuracy: Option<f64>, step: f64, end: f64, reactions: bool) -> (Recording, Summary) {
    let choice = Choice { method: Some(method.into()), accuracy, ..Choice::default() };
    let method = Method::resolve(&choice).unwrap_or_else(|error| panic!("{error}"));
    let label = method.name.clone();
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap_or_else(|error| panic!("{label}: {error}"));
    if reactions {
        simulation.find_reactions();
    }
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, if reactions { Constraints::Rows } else { Constraints::Nothing });
    let status = simulation.run(end, &mut recorder);
    assert_eq!(status, Status::Completed, "{label}");
    let size = analysis::rank(&model.system, &simulation.state().x, end).size(&model.system);
    (recorder.finish(), simulation.summary("test", end, &status, size))
}

fn last(recording: &Recording, column: &str) -> f64 {
    *recording.column(column).unwrap_or_else(|| panic!("there is no column {column}")).last().expect("rows")
}

fn numbers(value: &Value) -> Vec<f64> {
    match value {
        Value::Array(items) => items.iter().map(|item| item.as_f64().expect("a number")).collect(),
        single => vec![single.as_f64().expect("a number")],
    }
}

/// The largest difference between a recording's last row and the bodies and coordinates of a case.
fn difference(case: &Value, recording: &Recording, dim: usize) -> f64 {
    let axes = ["x", "y", "z"];
    let mut worst = 0.0_f64;
    let mut compare = |column: String, expected: f64| worst = worst.max((last(recording, &column) - expected).abs());
    for (body, state) in case["bodies"].as_object().expect("bodies") {
        let (position, velocity) = (numbers(&state["position"]), numbers(&state["velocity"]));
        for c in 0..dim {
            compare(format!("{body}.{}", axes[c]), position[c]);
            compare(format!("{body}.v{}", axes[c]), velocity[c]);
        }
        if dim == 2 {
            compare(format!("{body}.angle"), state["angle"].as_f64().expect("an angle"));
            compare(format!("{body}.angle_rate"), state["omega"].as_f64().expect("a rate"));
            continue;
        }
        let (quaternion, omega) = (numbers(&state["quat_wxyz"]), numbers(&state["angular_velocity"]));
        let along: f64 = ["qw", "qx", "qy", "qz"].iter().zip(&quaternion).map(|(c, q)| last(recording, &format!("{body}.{c}")) * q).sum();
        for (k, column) in ["qw", "qx", "qy", "qz"].iter().enumerate() {
            compare(format!("{body}.{column}"), quaternion[k] * along.signum());
        }
        (0..3).for_each(|c| compare(format!("{body}.w{}", axes[c]), omega[c]));
    }
    for (coordinate, expected) in case["coordinates"].as_object().into_iter().flatten() {
        if recording.column(coordinate).is_some() {
            compare(coordinate.clone(), expected.as_f64().expect("a number"));
        }
    }
    worst
}

/// The largest difference of the forces at the start and the end.
fn force_difference(case: &Value, recording: &Recording, dim: usize) -> f64 {
    let own = case.get("reaction").into_iter();
    let mut worst = 0.0_f64;
    for reaction in own.chain(case["reactions"].as_array().into_iter().flatten()) {
        let joint = reaction["joint"].as_str().expect("a joint");
        for (row, state) in [(0, &reaction["start"]), (recording.rows() - 1, &reaction["end"])] {
            let columns: &[&str] = if dim == 3 { &["fx", "fy", "fz", "tx", "ty", "tz"] } else { &["fx", "fy", "t"] };
            let expected = [numbers(&state["force"]), numbers(&state["moment"])].concat();
            for (column, expected) in columns.iter().zip(expected) {
                let found = recording.column(&format!("{joint}.{column}")).expect("the force is recorded")[row];
                worst = worst.max((found - expected).abs());
            }
        }
    }
    worst
}

#[test]
fn bodies_move_and_joints_pull_as_newton_and_euler_say() {
    let mut wrong = Vec::new();
    for case in cases() {
        let end = case["end"].as_f64().expect("an end");
        let plain = model_of(&case, true);
        let dim = plain.dimension;
        let (recording, _) = run(&plain, "radau", Some(1e-12), 0.1, end, true);
        let (motion, force) = (difference(&case, &recording, dim), force_difference(&case, &recording, dim));
        let shared = model_of(&case, false);
        let (recording, _) = run(&shared, "radau", Some(1e-12), 0.1, end, false);
        let of_shared = difference(&case, &recording, dim);
        let line = format!(
            "{:28} motion {motion:7.1e}, forces {force:7.1e}, {:2} coordinates and {:2} rows; shared {of_shared:7.1e}, {:2} and {:2}",
            name(&case),
            plain.system.coordinates(),
            plain.system.constraints(),
            shared.system.coordinates(),
            shared.system.constraints(),
        );
        println!("{line}");
        if motion.max(force).max(of_shared) > AGREES || (motion + force + of_shared).is_nan() {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Whether nothing but gravity acts from outside.
fn is_free(case: &Value) -> bool {
    case["bodies"].as_object().expect("bodies").contains_key("A")
}

#[test]
fn joints_leave_the_freedom_they_say() {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    for case in cases() {
        let dim = if name(&case).starts_with("planar-") { 2 } else { 3 };
        let freedom = case["freedom"].as_u64().expect("a freedom") as usize;
        let kind = case["kind"].as_str().expect("a kind");
        *seen.entry(kind.to_string()).or_default() += 1;
        if let Some(joint) = joints::JOINTS.iter().find(|joint| joint.name == kind && kind != "generic") {
            assert_eq!(joint.layout.expect("it is a joint").freedom[usize::from(dim == 2)], Some(freedom), "{}", name(&case));
        }
        let of_first_body = if !is_free(&case) { 0 } else { 3 * (dim - 1) };
        for reactions in [true, false] {
            let model = model_of(&case, reactions);
            let rank = analysis::rank(&model.system, model.system.start_position(), 0.0);
            assert_eq!(rank.redundant, Vec::<String>::new(), "{}", name(&case));
            assert_eq!(rank.size(&model.system).dof, of_first_body + freedom, "{}", name(&case));
        }
    }
    for kind in joints::kinds() {
        assert!(seen.contains_key(kind.name), "there is a reference for `{}`", kind.name);
    }
}

/// Energy and both momenta, in J, N·s and N·m·s, all of the order of ten.
const KEPT: f64 = 1e-10;

#[test]
fn the_conserving_scheme_keeps_energy_and_momenta_in_free_flight() {
    for case in cases().iter().filter(|case| is_free(case)) {
        let text = case["model"].as_str().expect("a model").replace("gravity = [0.0, 0.0, -9.81]", "gravity = [0, 0, 0]");
        let text = text.replace("gravity = [0.0, -9.81]", "gravity = [0, 0]");
        for text in [text.clone(), text.replace("reactions = true", "reactions = false")] {
            let model = model(name(case), &text);
            let (_, summary) = run(&model, "conserving-ggl", None, 0.01, 0.5, false);
            let kept = [summary.energy.max_drift, summary.momentum.linear_drift, summary.momentum.angular_drift];
            println!("{:24} E {:7.1e} P {:7.1e} L {:7.1e}", name(case), kept[0], kept[1], kept[2]);
            assert!(kept.iter().all(|&drift| drift <= KEPT), "{}: {kept:?}", name(case));
            assert!(summary.violation.position <= KEPT && summary.violation.velocity <= KEPT, "{}: {:?}", name(case), summary.violation);
        }
    }
}

/// A thin rod has no inertia about itself. Where a joint holds one place of it, nothing may turn it about itself.
#[test]
fn thin_rods_do_not_turn_about_themselves_on_joints_that_hold_a_place() {
    for (kind, keys, freedom) in [
        ("spherical", "at = [0.5, 0, 0]", 2),
        ("distance", "at = [[0, 0, 0], [0.5, 0, 0]]", 4),
        ("revolute-spherical", "at = [[0, 0, 0], [0.5, 0, 0]]\naxis = [0, 1, 1]", 3),
        ("point-on-line", "at = [0.5, 0, 0]\naxis = [0, 1, 1]", 3),
        ("point-on-plane", "at = [0.5, 0, 0]\naxis = [0, 0, 1]", 4),
        ("point-on-curve", "at = [0.5, 0, 0]\ncurve = [[0, 0, -1], [0.5, 0, 0], [0, 0, 1]]", 3),
    ] {
        for reactions in [true, false] {
            let model = model(
                kind,
                &format!(
                    "[body.rod]\nmass = 1\nshape = {{ rod = 1 }}\nposition = [0.5, 0.5, 0]\nvelocity = [0, 0, 1]\n\
                     orientation = {{ axis = [0, 0, 1], angle_deg = 90 }}\n\
                     [joint.link]\ntype = \"{kind}\"\nbetween = [\"ground\", \"rod\"]\n{keys}\n[output]\nreactions = {reactions}\n"
                ),
            );
            let rank = analysis::rank(&model.system, model.system.start_position(), 0.0);
            assert_eq!(rank.size(&model.system).dof, freedom, "{kind}");
            let (_, summary) = run(&model, "conserving-ggl", None, 0.01, 0.5, false);
            assert!(summary.energy.max_drift < 1e-11, "{kind}: {:?}", summary.energy);
        }
    }
}

#[test]
fn joints_run_with_every_named_method() {
    for case in cases() {
        let model = model_of(&case, false);
        for method in NAMED {
            let (recording, _) = run(&model, method.name, None, 0.01, 0.5, false);
            assert!(recording.column("energy").expect("the energy").iter().all(|e| e.is_finite()), "{}, {}", name(&case), method.name);
        }
    }
}

/// A slender rod along an axis of the model that joints hold completely has nothing left that moves but directions without mass: it hangs there as it
/// does turned, with the weight on its ball and the moment of that on what keeps it upright.
#[test]
fn a_rod_that_is_held_completely_is_held_in_any_direction() {
    for (mass, output) in [(1.0, ""), (1.0, "[output]\nreactions = true\n"), (1e-6, ""), (1e6, "")] {
        for along in [[1.0, 0.0, 0.0], [0.6, 0.8, 0.0]] {
            let at = |s: f64| format!("[{}, {}, 0]", s * along[0], s * along[1]);
            let angle = f64::atan2(along[1], along[0]);
            let text = format!(
                "[body.rod]\nmass = {mass}\ninertia = [0, {mass}, {mass}]\nposition = {}\norientation = {{ axis = [0, 0, 1], angle = {angle} }}\n\
                 [joint.ball]\ntype = \"spherical\"\nbetween = [\"ground\", \"rod\"]\nat = {}\n\
                 [joint.upright]\ntype = \"orientation\"\nbetween = [\"ground\", \"rod\"]\n{output}",
                at(1.0),
                at(0.5)
            );
            let model = Source::read("rod", text.as_bytes()).unwrap().model_with_forces().unwrap();
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&Choice::default()).unwrap(), 1e-2).unwrap();
            model.find_reactions(&mut simulation);
            let mut recorder = Recorder::new(&model.channels, &model.system, 1, model.output.constraints());
            assert_eq!(simulation.run(0.1, &mut recorder), Status::Completed);
            let recording = recorder.finish();
            let of = |column: &str| recording.column(column).unwrap().last().unwrap() / (9.81 * mass);
            let label = format!("{mass} kg along {along:?}, {output}");
            assert!((of("ball.fz").abs() - 1.0).abs() < 1e-9, "{label}: {}", of("ball.fz"));
            let moment = of("upright.tx").hypot(of("upright.ty")).hypot(of("upright.tz"));
            assert!((moment - 0.5).abs() < 1e-9, "{label}: {moment}");
        }
    }
}
