//! Rows that hold velocities only, Ψ = B(q) v = 0: rolling without slip (methods §14).
//!
//! Where the other rows are conditions on positions, these are what comes of Ψ over the time of the stage, so that they
//! are of the size of an increment: B Δq between two positions, Ψ over ∂v/∂Δq at a state.

use super::stage::{Sampling, Stage};
use super::workspace::{Turned, Workspace};
use crate::system::{Direction, InvariantId, MAX_ARGUMENTS, System};

impl Workspace {
    /// Puts what the velocity rows stand for into `phi`.
    pub(super) fn violate_velocity_rows(&mut self, system: &System, stage: &Stage) {
        if system.velocity_rows.is_empty() {
            return;
        }
        for (way, (x1, x0)) in self.full.iter_mut().zip(self.end.x.iter().zip(&self.start.x)) {
            *way = x1 - x0;
        }
        for &row in &system.velocity_rows {
            let slots = &system.slots.rows[row as usize];
            let along = |at, v| system.along(slots, &system.slots.nodes, at, v);
            self.phi[row as usize] = match stage.sampling {
                Sampling::Between => along(&self.sampled.at, &self.full),
                Sampling::Start => 0.5 * (along(&self.start.at, &self.full) + along(&self.end.at, &self.full)),
                Sampling::End | Sampling::Middle => along(&self.sampled.at, &self.sampled.v) / stage.rate,
            };
        }
    }

    /// Fills `turned.rows` with the gradients of all rows by the increment, where those of the positions are that at the
    /// end or the one sampled, times `factor`: the velocity rows' are divided by it. Without velocity rows nothing is
    /// filled.
    pub(super) fn differentiate_rows(&mut self, system: &System, stage: &Stage, at_end: bool, factor: f64) {
        if system.velocity_rows.is_empty() {
            return;
        }
        let Self { turned, start, end, sampled, full, .. } = self;
        turned.rows.copy_from_slice(if at_end { &end.at.gradient } else { &sampled.at.gradient });
        for (way, (x1, x0)) in full.iter_mut().zip(end.x.iter().zip(&start.x)) {
            *way = x1 - x0;
        }
        match stage.sampling {
            Sampling::Between => {
                let change = |id: InvariantId| end.at.value[id.0 as usize] - start.at.value[id.0 as usize];
                system.turn_functions(0..system.functions.len(), &end.at, &mut turned.v, |k, base| {
                    let rise: [f64; MAX_ARGUMENTS] = std::array::from_fn(|i| base.get(i).map_or(0.0, |&id| change(id)));
                    let (mean, there) = (&sampled.at.functions.local[k], &end.at.functions.local[k]);
                    std::array::from_fn(|i| [0.0, mean.gradient[i] + 0.5 * there.bend(i, &rise)])
                });
            }
            Sampling::Start => {
                let way = Direction { nodes: full, time: stage.step };
                system.turn(&end.at, &end.x, way, stage.end(), &mut turned.half, &mut turned.v)
            }
            Sampling::End | Sampling::Middle => {
                system.turn(&sampled.at, &sampled.x, Direction::velocity(&sampled.v), stage.time(), &mut turned.half, &mut turned.v)
            }
        }
        let share = stage.share() / stage.rate;
        for &row in &system.velocity_rows {
            let slots = &system.slots.rows[row as usize];
            for i in slots.start * system.dim..slots.end * system.dim {
                turned.rows[i] = match stage.sampling {
                    Sampling::Between => turned.v[i],
                    Sampling::Start => 0.5 * (start.at.gradient[i] + end.at.gradient[i] + turned.v[i]),
                    Sampling::End | Sampling::Middle => sampled.at.gradient[i] + share * turned.v[i],
                } / factor;
            }
        }
    }

    /// Fills `turned.rows` with those of the velocity rows alone, or of all others; zero elsewhere.
    pub(super) fn part_of_rows(&mut self, system: &System, gradient: Source, velocity: bool) {
        let Turned { rows: row_gradient, v: turned_v, .. } = &mut self.turned;
        let from = match gradient {
            Source::Sampled => &self.sampled.at.gradient,
            Source::Turned => turned_v,
        };
        if velocity {
            row_gradient.fill(0.0);
        } else {
            row_gradient.copy_from_slice(from);
        }
        for &row in &system.velocity_rows {
            let slots = &system.slots.rows[row as usize];
            let own = slots.start * system.dim..slots.end * system.dim;
            match velocity {
                true => row_gradient[own.clone()].copy_from_slice(&from[own]),
                false => row_gradient[own].fill(0.0),
            }
        }
    }
}

/// Which gradients: those sampled, or their change with the velocity, H v.
#[derive(Clone, Copy)]
pub(super) enum Source {
    Sampled,
    Turned,
}
