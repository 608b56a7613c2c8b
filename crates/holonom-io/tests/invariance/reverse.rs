//! Time reversed: a run to its end, with velocities turned round and back to where it began.

use holonom::model::{Shape, Table, Value};
use holonom::simulation::{Simulation, Status, Verdict};

use super::cases::{Case, METHODS, cases};
use super::columns::{Column, Finding};
use super::expression::uses;
use super::motion::{differs, method, model, moment};
use super::sections::{entries, keys, kind};

#[test]
fn back_in_time() {
    let skipped: Vec<&str> = cases().iter().filter(|case| !is_reversible(&case.description)).map(|case| case.name.as_str()).collect();
    assert_eq!(skipped, IRREVERSIBLE, "models that depend on time or velocities");
    let column = Column { name: "back in time", bound: &|case| case.bound, keeps_rows: true };
    column.conclude(&mut |case, k| is_reversible(&case.description).then(|| there_and_back(case, METHODS[k])));
}

/// Models with drives, dampers, friction, or forces that depend on time or velocities.
const IRREVERSIBLE: &[&str] = &[
    "car-axis",
    "differential",
    "flexible-four-bar",
    "flyball-governor",
    "jansen-linkage",
    "robot-arm",
    "stewart-platform",
    "suspension",
    "flexible-pendulum",
    "planetary",
    "stiff-and-soft",
    "constraint:distance",
    "drive:angle",
    "drive:displacement",
    "drive:distance",
    "drive:point",
    "force:spring",
    "force:rope",
    "force:torsion",
    "force:bushing",
    "force:force",
    "force:torque",
    "force:effort",
    "force:friction",
    "force:stop",
    "force:expression",
];

fn there_and_back(case: &Case, name: &str) -> Finding {
    let model = model(&case.description).expect("it was read before");
    let mut there = Simulation::new(model.system.clone(), method(name), case.step).expect("it was run before");
    let first = moment(&model, &there);
    let end = case.steps as f64 * case.step;
    let mut status = there.run(end, &mut |_: &Simulation| Verdict::GoOn);
    let mut state = there.state().clone();
    state.v.iter_mut().for_each(|v| *v = -*v);
    // What was predicted for the next step was so for the other direction.
    state.a_change.fill(0.0);
    state.a_differences.fill(Default::default());
    state.lambda_change.fill(0.0);
    state.memory.fill(0.0);
    state.last_step = 0.0;
    let mut back = Simulation::resume(model.system.clone(), method(name), case.step, state).expect("it is a state of this system");
    if status == Status::Completed {
        status = back.run(2.0 * end, &mut |_: &Simulation| Verdict::GoOn);
    }
    if let Status::Stopped { reason, .. } = status {
        return Finding::stopped(reason);
    }
    let mut last = moment(&model, &back);
    last.turn_round();
    // Going on from a state, turns are counted anew.
    last.on_turn_of(&first, &case.coordinates);
    let (figure, what) = differs(&first, &last, &case.coordinates, &case.scale);
    Finding::new(figure, what, case.bound)
}

/// Whether nothing in a model depends on time or velocities.
fn is_reversible(description: &Table) -> bool {
    entries(description).iter().all(|(section, _, entry)| {
        let is_zero = |key: &str| entry.get(key).is_none_or(|value| *value == Value::Number(0.0));
        let formulas = keys(section, entry).iter().filter_map(|key| match key.shape {
            Shape::Formula(names) | Shape::Formulas(names) | Shape::Torque(names) => entry.get(key.name).map(|value| (names, value)),
            _ => None,
        });
        let mut formulas = formulas.filter(|(names, value)| {
            let not_places = names.iter().copied().filter(|name| !["length", "x", "y", "z", "q"].contains(name));
            mentions(value, &not_places.collect::<Vec<_>>())
        });
        *section != "drive" && is_zero("damping") && is_zero("dissipation") && kind(entry) != "friction" && formulas.next().is_none()
    })
}

fn mentions(value: &Value, names: &[&str]) -> bool {
    match value {
        Value::Text(text) => uses(text, names),
        Value::List(items) => items.iter().any(|item| mentions(item, names)),
        _ => false,
    }
}
