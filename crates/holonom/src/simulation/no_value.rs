//! Forces that have no value where a mechanism goes: a formula is outside its domain, or a table outside its range.

use super::Simulation;
use crate::system::{LawEntry, LoadEntry, Local, Look, System};

/// How far ahead of the present state is looked, in nominal steps.
const AHEAD: [f64; 6] = [0.0, 0.1, 0.5, 1.0, 2.0, 4.0];

impl Simulation {
    /// The force, by name, that has no finite value here, or a little later as the mechanism moves now.
    pub(super) fn force_without_value(&mut self) -> Option<&str> {
        let step = self.nominal_step();
        let Self { system, state, work, .. } = self;
        let system: &System = system;
        AHEAD.iter().find_map(|ahead| {
            let (t, end) = (state.t + ahead * step, &mut work.end);
            end.x.iter_mut().zip(state.x.iter().zip(&state.v)).for_each(|(end, (x, v))| *end = x + ahead * step * v);
            end.v.copy_from_slice(&state.v);
            system.place_known(t, &mut end.x, &mut end.v, &mut work.a);
            system.evaluate(&end.x, t, &work.start.at, &mut end.at);
            without_value(system, Look { x: &end.x, v: &end.v, t, at: &end.at, inputs: &state.inputs, span: None })
        })
    }
}

/// The first force that has no finite value at a state.
fn without_value<'a>(system: &'a System, look: Look<'_>) -> Option<&'a str> {
    let is_law_without = |law: &&LawEntry| {
        let (values, (rates, out)) = (system.arguments(law, look.at), system.respond(law, look.at, look.v, look.t));
        // Where nothing moves as it should the force is not to blame.
        values.iter().chain(&rates).all(|number| number.is_finite()) && !out.force.iter().all(|force| force.is_finite())
    };
    let is_load_without = |load: &&LoadEntry| {
        let mut out = Local::from_elem(0.0, load.nodes.len() * system.dim);
        system.load_forces(load, look, &mut out);
        !out.iter().all(|force| force.is_finite())
    };
    let law = system.laws.iter().find(is_law_without).map(|law| &law.name);
    law.or_else(|| system.loads.iter().find(is_load_without).map(|load| &load.name)).map(String::as_str)
}
