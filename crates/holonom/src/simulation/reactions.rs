//! Forces of the constraints, by the index-1 system (3) at the states shown (methods §17).

use std::ops::Range;

use serde::{Deserialize, Serialize};

use super::Simulation;
use crate::system::{NodeId, System};

/// Forces of the constraints at a state, of the order of its positions and velocities.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Reactions {
    /// Multipliers λ (r).
    pub lambda: Vec<f64>,
    /// Accelerations of all nodes (D × nodes), m/s².
    pub a: Vec<f64>,
    /// Forces of the constraints on the nodes, −Gᵀλ (D × nodes), N. Redundant rows leave λ undetermined, not these.
    pub force: Vec<f64>,
}

impl Simulation {
    /// Has the forces of the constraints found at the start and at every nominal step. A run that is resumed has them already
    /// where the one before had them.
    pub fn find_reactions(&mut self) {
        if self.reactions.is_some() {
            return;
        }
        let (r, all) = (self.system.constraints(), self.state.x.len());
        self.reactions = Some(Reactions { lambda: vec![0.0; r], a: vec![0.0; all], force: vec![0.0; all] });
        self.react();
    }

    /// Forces of the constraints at the present state, if they were asked for.
    pub fn reactions(&self) -> Option<&Reactions> {
        self.reactions.as_ref()
    }

    /// Force (3) and moment about a place (3) of some rows on some nodes, points or directions, at the present state, N
    /// and N·m. `None` unless forces of the constraints were asked for.
    pub fn wrench(&self, rows: Range<usize>, nodes: &[(NodeId, bool)], about: [f64; 3]) -> Option<([f64; 3], [f64; 3])> {
        let reactions = self.reactions.as_ref()?;
        let gradient = &self.work.start.at.gradient;
        let about = self.system.of_world(about);
        Some(wrench(&self.system, rows, &reactions.lambda, gradient, nodes, about, &self.state.x))
    }

    /// Finds the forces of the constraints at the present state, where they are wanted.
    pub(super) fn react(&mut self) {
        let Some(reactions) = &mut self.reactions else { return };
        let (system, newton, work, state) = (&*self.system, &mut self.newton, &mut self.work, &self.state);
        work.end.x.copy_from_slice(&state.x);
        work.end.v.copy_from_slice(&self.shown_v);
        work.a.copy_from_slice(&state.a);
        work.lambda.copy_from_slice(&reactions.lambda);
        system.place_known(state.t, &mut work.end.x, &mut work.end.v, &mut work.a);
        // A penalty's force is its own; that of every other formulation errs, and the constraints' is meant.
        let outcome = match self.method.formulation.soft {
            true => newton.accelerate(system, state.t, work),
            false => newton.react(system, state.t, work),
        };
        if outcome.is_err() {
            work.lambda.fill(f64::NAN);
        }
        reactions.lambda.copy_from_slice(&work.lambda);
        reactions.a.copy_from_slice(&work.a);
        work.constraint_forces(system, &mut reactions.force);
    }
}

/// Force (3) and moment about a place (3) of some rows with the multipliers `lambda` and gradients (D a slot) on some nodes,
/// points or directions, at the positions `x`.
pub(crate) fn wrench(
    system: &System,
    rows: Range<usize>,
    lambda: &[f64],
    gradient: &[f64],
    nodes: &[(NodeId, bool)],
    about: [f64; 3],
    x: &[f64],
) -> ([f64; 3], [f64; 3]) {
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for row in rows {
        for s in system.slots.rows[row].clone() {
            let Some(&(node, is_point)) = nodes.iter().find(|(node, _)| node.index() == system.slots.nodes[s] as usize) else { continue };
            let (mut push, mut arm) = ([0.0; 3], [0.0; 3]);
            for c in 0..system.dim {
                push[c] = -lambda[row] * gradient[s * system.dim + c];
                arm[c] = x[node.index() * system.dim + c] - if is_point { about[c] } else { 0.0 };
            }
            for c in 0..3 {
                let (i, j) = ((c + 1) % 3, (c + 2) % 3);
                force[c] += if is_point { push[c] } else { 0.0 };
                moment[c] += arm[i] * push[j] - arm[j] * push[i];
            }
        }
    }
    (force, moment)
}
