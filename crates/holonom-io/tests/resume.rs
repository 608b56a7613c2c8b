//! A run that was stopped and resumed from its checkpoint has the bits of one that was not, in every column.

mod common;

use std::path::Path;

use holonom::analysis;
use holonom::model::Model;
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Checkpoint, Choice, Method, NAMED, Observer, Simulation, Status, Verdict};
use holonom_io::Source;

/// Nominal steps of a run, and how often one with a named method is stopped, and one with another.
const STEPS: u64 = 60;
const STOPS: [u64; 2] = [10, 2];

/// Integrators that no named method has, and some of other orders.
const OTHERS: &[&str] = &[
    "ode/dopri5/velocity",
    "ode/dop853",
    "lagrange-1/rk4",
    "augmented-lagrangian-3/bdf-2",
    "lagrange-3/rattle",
    "lagrange-2/radau-3",
    "lagrange-2/gauss",
    "lagrange-3/hht",
    "penalty-3/newmark",
];

/// What follows a point of a curve: which of those nearby is the nearest is found from that of the step before.
const BARREL_CAM: &str = r#"
[body.cam]
mass = 4
inertia = [0.02, 0.02, 0.006]
position = [0, 0, 0]
angular_velocity = [0, 0, 18]

[joint.shaft]
type = "revolute"
between = ["ground", "cam"]
at = [0, 0, 0]
axis = [0, 0, 1]

[body.pin]
mass = 0.8
inertia = [1e-3, 1e-3, 1e-3]
position = [0.05, 0, 0]

[joint.guide]
type = "planar"
between = ["ground", "pin"]
at = [0.05, 0, 0]
axis = [0, 1, 0]

[force.spring]
type = "spring"
between = [[0.3, 0, 0], "pin"]
stiffness = 300
rest_length = 0.2

[joint.groove]
type = "point-on-curve"
between = ["cam", "pin"]
at = [0.05, 0, 0]
closed = true
curve = [[0.05, 0, 0], [0.03, 0.04, 0.04], [-0.02, 0.05, 0.06], [-0.05, 0.01, 0], [-0.03, -0.04, -0.05], [0.02, -0.05, -0.04]]

[simulation]
step = 1e-3
"#;

/// The gallery, and a curve and wheels that follow from others, which no model there has.
fn models() -> Vec<(String, Model)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut found: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    found.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    found.sort();
    let name = |path: &Path| path.file_stem().unwrap().to_string_lossy().into_owned();
    // Rows of wheels follow from others: steps find these out on their way, and leave them out.
    let car = common::car(4.0, "atan2(2.5*tan(t^2), 2.5 - (0.75 - 1.5*mod(i, 2))*tan(t^2))");
    let own = [("barrel-cam".into(), common::model(BARREL_CAM)), ("steered-car".into(), car)];
    found.iter().map(|path| (name(path), model(path))).chain(own).collect()
}

fn model(path: &Path) -> Model {
    let name = path.file_name().unwrap().to_string_lossy();
    Source::read(&name, &std::fs::read(path).unwrap()).and_then(|source| source.model()).unwrap()
}

/// Stops after some nominal steps.
struct Until {
    recorder: Recorder,
    left: u64,
}

impl Observer for Until {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        self.recorder.after_step(simulation);
        self.left -= 1;
        if self.left == 0 { Verdict::Stop } else { Verdict::GoOn }
    }
}

/// A method at work on a model.
struct Case<'a> {
    model: &'a Model,
    choice: Choice,
    step: f64,
    every: u64,
}

impl Case<'_> {
    fn method(&self) -> Option<Method> {
        Method::resolve(&self.choice).ok()
    }

    fn watch(&self, simulation: &mut Simulation, left: u64) -> Until {
        simulation.find_reactions();
        Until { recorder: Recorder::new(&self.model.channels, &self.model.system, self.every, Constraints::Rows), left }
    }

    fn end(&self) -> f64 {
        STEPS as f64 * self.step
    }

    /// The whole run, or nothing where the method refuses the model.
    fn whole(&self) -> Option<(Recording, String)> {
        let mut simulation = Simulation::new(self.model.system.clone(), self.method()?, self.step).ok()?;
        let mut watch = self.watch(&mut simulation, u64::MAX);
        let status = simulation.run(self.end(), &mut watch);
        Some((watch.recorder.finish(), written(&simulation, &status)))
    }

    /// The rows of a run that is stopped after `first` steps, and of what is resumed from its checkpoint as it is written.
    fn in_parts(&self, first: u64) -> ([Recording; 2], String) {
        let mut simulation = Simulation::new(self.model.system.clone(), self.method().unwrap(), self.step).unwrap();
        let mut watch = self.watch(&mut simulation, first + 1);
        let status = simulation.run(self.end(), &mut watch);
        let (kept, mark) = (serde_json::to_string(&simulation.checkpoint()).unwrap(), watch.recorder.mark());
        let before = watch.recorder.finish();
        if !matches!(&status, Status::Stopped { reason, .. } if reason == "interrupted") {
            return ([before.clone(), Recording::default()], written(&simulation, &status));
        }
        let kept: Checkpoint = serde_json::from_str(&kept).unwrap();
        let mut simulation = Simulation::resume(self.model.system.clone(), self.method().unwrap(), self.step, kept).unwrap();
        let mut watch = self.watch(&mut simulation, u64::MAX);
        watch.recorder = watch.recorder.resume(&mark);
        let status = simulation.run(self.end(), &mut watch);
        ([before, watch.recorder.finish()], written(&simulation, &status))
    }
}

/// The summary, and what goes on from the end.
fn written(simulation: &Simulation, status: &Status) -> String {
    let summary =
        simulation.summary("", 0.0, status, analysis::rank(simulation.system(), &simulation.state().x, 0.0).size(simulation.system()));
    format!("{} {}", serde_json::to_string(&summary).unwrap(), serde_json::to_string(&simulation.checkpoint()).unwrap())
}

/// The first difference between the rows of a run and those of its parts, of which the second begins with the last of the first.
fn difference(whole: &Recording, [before, after]: &[Recording; 2]) -> Option<String> {
    for (k, column) in whole.columns().iter().enumerate() {
        let values = |part: &Recording| part.columns().get(k).map(|column| column.values.clone()).unwrap_or_default();
        let (first, rest) = (values(before), values(after));
        let join = whole.rows() + 1 - rest.len().max(1);
        for (row, value) in column.values.iter().enumerate() {
            let of_parts = [first.get(row), row.checked_sub(join - 1 + usize::from(rest.is_empty())).and_then(|at| rest.get(at))];
            for found in of_parts.into_iter().flatten() {
                if found.to_bits() != value.to_bits() && !(found.is_nan() && value.is_nan()) {
                    return Some(format!("{} in row {row}: {value:e} and {found:e}", column.heading.name));
                }
            }
        }
    }
    None
}

/// Where two texts begin to differ.
fn diff(a: &str, b: &str) -> String {
    let at = a.bytes().zip(b.bytes()).take_while(|(a, b)| a == b).count();
    let around = |text: &str| String::from_utf8_lossy(&text.as_bytes()[at.saturating_sub(80)..text.len().min(at + 80)]).into_owned();
    format!("at the end\n  {}\n  {}", around(a), around(b))
}

#[test]
fn a_resumed_run_has_the_same_bits() {
    let mut cases = 0;
    let mut wrong = Vec::new();
    for (name, model) in models() {
        let mut seed = name.bytes().fold(1_u64, |sum, byte| sum.wrapping_mul(31).wrapping_add(u64::from(byte)));
        let methods = NAMED.iter().map(|named| (named.name, STOPS[0])).chain(OTHERS.iter().map(|name| (*name, STOPS[1])));
        let by_accuracy = |(method, stops): (&'static str, u64)| {
            // What damps nothing takes steps as short as the vibrations of an elastic bar along itself.
            let is_slow = name == "flexible-four-bar" && method != "radau";
            let own = ((stops == STOPS[0] || method == "ode/dop853") && !is_slow).then_some((method, stops, Some(1e-4)));
            [Some((method, stops, None)), own].into_iter().flatten()
        };
        for (method, stops, accuracy) in methods.flat_map(by_accuracy) {
            let choice = Choice { method: Some(method.into()), accuracy, ..Choice::default() };
            let step = model.settings.step.unwrap_or(0.01);
            let case = Case { model: &model, choice, step, every: 1 };
            let Some((whole, ended)) = case.whole() else { continue };
            for _ in 0..stops {
                seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                let first = 1 + (seed >> 33) % (STEPS - 1);
                let (parts, ended_in_parts) = case.in_parts(first);
                cases += 1;
                let how = difference(&whole, &parts);
                let how = how.or_else(|| (ended != ended_in_parts).then(|| diff(&ended, &ended_in_parts)));
                if let Some(how) = how {
                    wrong.push(format!("{name}, {method}, accuracy {accuracy:?}, stopped after {first}: {how}"));
                    break;
                }
            }
        }
    }
    println!("{cases} runs");
    assert!(wrong.is_empty(), "{} of {cases} runs:\n{}", wrong.len(), wrong.join("\n"));
}

/// Steps that are far too long: none of their parts is taken, either.
const TOO_LONG: f64 = 1e7;

/// What cannot be integrated, projected or kept as promised leaves the state before it, but for what is counted.
#[test]
fn a_rejected_step_leaves_no_trace() {
    let (mut cases, mut wrong) = (0, Vec::new());
    for (name, model) in models() {
        for method in NAMED.iter().map(|named| named.name).chain(OTHERS.iter().copied()) {
            let choice = Choice::default().named(method);
            let case = Case { model: &model, choice, step: model.settings.step.unwrap_or(0.01), every: 1 };
            let (Some(method_found), Some(_)) = (case.method(), case.whole()) else { continue };
            let mut simulation = Simulation::new(model.system.clone(), method_found, case.step).unwrap();
            let mut watch = case.watch(&mut simulation, 1 + STEPS / 2);
            let _ = simulation.run(case.end(), &mut watch);
            let before = simulation.checkpoint();
            let long = TOO_LONG * case.step;
            let mut simulation = Simulation::resume(model.system.clone(), case.method().unwrap(), long, before.clone()).unwrap();
            let _ = simulation.run(before.state.t + 2.0 * long, &mut |_: &Simulation| Verdict::GoOn);
            if simulation.state().t != before.state.t {
                continue;
            }
            cases += 1;
            let [kept, mut found] = [&before, &simulation.checkpoint()].map(|checkpoint| serde_json::to_value(checkpoint).unwrap());
            // `before` is what a nominal step begins with.
            let counted =
                ["iterations", "total_iterations", "factorizations", "rejected", "before"].map(|what| format!("progress/audit/{what}"));
            for counted in counted.into_iter().chain(["grid", "progress/counters"].map(String::from)) {
                let at = format!("/run/{counted}");
                *found.pointer_mut(&at).unwrap() = kept.pointer(&at).unwrap().clone();
            }
            if kept != found {
                wrong.push(format!("{name}, {method}: {}", diff(&kept.to_string(), &found.to_string())));
            }
        }
    }
    println!("{cases} rejected steps");
    assert!(cases > 100, "only {cases} of the steps were rejected");
    assert!(wrong.is_empty(), "{} of {cases} steps:\n{}", wrong.len(), wrong.join("\n"));
}
