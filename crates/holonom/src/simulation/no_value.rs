//! Forces that have no value where a mechanism goes, as a formula is outside its domain or a table outside its range, or no slope.

use super::{Simulation, State};
use crate::formulation::Workspace;
use crate::system::{LawEntry, LoadEntry, Local, Look, Response, System};

/// How far ahead of the present state is looked, in nominal steps.
const AHEAD: [f64; 6] = [0.0, 0.1, 0.5, 1.0, 2.0, 4.0];

/// What a force lacks.
#[derive(Clone, Copy)]
pub(super) enum Lack {
    Value,
    Slope,
}

impl Lack {
    /// In words.
    fn words(self) -> &'static str {
        match self {
            Self::Value => "has no value there (a formula is outside its domain, or a table outside its range)",
            Self::Slope => "has no slope there (as a root has none at zero, nor a power below 1: round it off, as sqrt(x + small))",
        }
    }
}

/// The force that has no value at a state, or no slope, in words.
pub(super) fn lacking(system: &System, state: &State, work: &mut Workspace, ahead: &[f64]) -> Option<String> {
    let mut find = |lack: Lack| {
        let name = ahead.iter().find_map(|ahead| without(lack, system, state.look_ahead(*ahead, system, work)))?;
        Some(format!("the force of `{name}` {}", lack.words()))
    };
    find(Lack::Value).or_else(|| find(Lack::Slope))
}

impl Simulation {
    /// The force that has no finite value here, or a little later as the mechanism moves now, or else one without finite derivatives; in words.
    pub(super) fn force_without_value(&mut self) -> Option<String> {
        let ahead = AHEAD.map(|steps| steps * self.nominal_step());
        lacking(&self.system, &self.state, &mut self.work, &ahead)
    }
}

/// The first force that lacks something at a state.
fn without<'a>(lack: Lack, system: &'a System, look: Look<'_>) -> Option<&'a str> {
    let are_finite = |numbers: &[f64]| numbers.iter().all(|number| number.is_finite());
    let is_law_without = |law: &&LawEntry| {
        let (values, mut out) = (system.arguments(law, look.at), Response::default());
        let rates = system.respond(law, look.at, look.v, look.t, &mut out);
        let is_there = match lack {
            Lack::Value => are_finite(&out.force),
            Lack::Slope => are_finite(out.by_value.as_flattened()) && are_finite(out.by_rate.as_flattened()),
        };
        // Where nothing moves as it should the force is not to blame.
        are_finite(&values) && are_finite(&rates) && !is_there
    };
    let is_load_without = |load: &&LoadEntry| match lack {
        Lack::Value => {
            let mut out = Local::from_elem(0.0, load.nodes.len() * system.dim);
            system.load_forces(load, look, &mut out);
            !are_finite(&out)
        }
        Lack::Slope => {
            let [x, v] = &system.read(&load.reading, look);
            let [mut by_position, mut by_velocity] = [vec![0.0; x.len() * x.len()], vec![0.0; x.len() * x.len()]];
            load.load.tangent(x, v, look.t, &mut by_position, &mut by_velocity);
            !are_finite(&by_position) || !are_finite(&by_velocity)
        }
    };
    let law = system.laws.iter().find(is_law_without).map(|law| &law.name);
    law.or_else(|| system.loads.iter().find(is_load_without).map(|load| &load.name)).map(String::as_str)
}
