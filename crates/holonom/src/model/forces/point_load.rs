//! Forces on points as formulas, spread over the nodes that a point is made of: with x = Σ c_a x_a, Q_a = c_aᵀ F (methods §6).

use std::sync::Arc;

use smallvec::SmallVec;

use crate::model::assembly::Assembly;
use crate::model::ends::End;
use crate::model::entry::Entry;
use crate::model::expression::Program;
use crate::model::fault::Read;
use crate::model::signals::{ROOM, Readings};
use crate::model::sum::Sum;
use crate::record::{Exerts, Shows};
use crate::system::{Bend, Differentiated, ForceFunction, Number};

/// A force on a point: formulas of t, its place, its velocity, and what they read beside.
struct PointLoad {
    dim: usize,
    point: Sum,
    readings: Readings,
    formulas: Vec<Program>,
}

/// Adds a force on a point, of formulas that have these readings.
pub(super) fn add(assembly: &mut Assembly<'_>, entry: &Entry<'_>, point: &End, mut readings: Readings, formulas: Vec<Program>) -> Read<()> {
    // What acts on a body where the ground holds it moves nothing either, but the bearing bears it.
    if point.body.is_none() && point.never_moves() {
        return Err(entry.refuse("point", "a force on a fixed point does nothing", "name a point that can move"));
    }
    let sum = Sum::new(&point.terms, &mut readings.reading.nodes);
    let reading = readings.reading.clone();
    let load = Arc::new(PointLoad { dim: assembly.dimension(), point: sum, readings, formulas });
    assembly.builder.load_reading(entry.name, reading, Arc::new(Differentiated(load.clone())));
    assembly.draw_load(entry, point);
    assembly.show(Shows::Load { is_moment: false, exerts: load });
    Ok(())
}

impl PointLoad {
    /// What the formulas are of.
    fn variables<N: Number>(&self, x: &[N], v: &[N], t: N) -> SmallVec<[N; ROOM]> {
        let mut variables = SmallVec::from_slice(&[t]);
        variables.extend_from_slice(&self.point.at(x, self.dim, 1.0)[..self.dim]);
        variables.extend_from_slice(&self.point.at(v, self.dim, 0.0)[..self.dim]);
        self.readings.append(x, v, &mut variables);
        variables
    }

    /// The force as it is given.
    fn given<N: Number>(&self, x: &[N], v: &[N], t: N) -> [N; 3] {
        let variables = self.variables(x, v, t);
        let mut whole = [N::from(0.0); 3];
        whole.iter_mut().zip(&self.formulas).for_each(|(whole, formula)| *whole = formula.evaluate(&variables));
        whole
    }
}

impl Exerts for PointLoad {
    fn exerted(&self, x: &[f64], v: &[f64], t: f64) -> [f64; 3] {
        self.given(x, v, t)
    }
}

impl ForceFunction for PointLoad {
    fn evaluate<N: Number>(&self, x: &[N], v: &[N], t: N, force: &mut [N]) {
        force.fill(N::from(0.0));
        self.point.spread(self.given(x, v, t), self.dim, force);
    }

    fn bends(&self, x: &[f64], v: &[f64], t: f64, note: &mut dyn FnMut(Bend)) {
        let variables = self.variables(x, v, t);
        self.formulas.iter().for_each(|formula| formula.bends(&variables, note));
    }
}
