//! The energy balance of every step (20)–(30), violations, momenta and work counters.

mod booking;
mod summary;

use serde::{Deserialize, Serialize};

use super::doubts::{Haste, Stray, Strays, Unrest, UnsureWork};
use super::{Method, Promise, State, ViolationSummary};
use crate::energy;
use crate::formulation::{Level, Multipliers, Workspace};
use crate::system::System;
use booking::power_at;

/// Share of energies and works up to which their changes are round-off.
const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Everything that is booked of a run. Energies in J; sums over parts of a step where it was taken in parts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Audit {
    /// T at the present state.
    pub kinetic: f64,
    /// V at the present state; springs of a penalty formulation belong to it.
    pub potential: f64,
    /// What V is more when points are counted from the world's origin.
    pub lift: f64,
    /// Work done on the system since the start.
    pub work: f64,
    /// ΔE_i of the last nominal step (21).
    pub integrator: f64,
    /// ΔE_p of the last nominal step (21).
    pub projection: f64,
    /// ‖Φ‖ after the last step.
    pub phi: f64,
    /// ‖Φ̇‖ after the last step.
    pub phi_dot: f64,
    /// ‖Φ̈‖ after the last step, where the integrator takes its forces.
    pub phi_ddot: f64,
    /// Iterations of the last nominal step.
    pub iterations: u64,
    /// Linear and angular momentum about [`System::origin`].
    pub momenta: [f64; 6],
    first_momenta: [f64; 6],
    kept_momenta: [bool; 6],
    momentum_drift: [f64; 6],
    initial: f64,
    /// T and V at the start, the smallest V since, and all work that was put in by nominal steps, J.
    first: [f64; 2],
    lowest: f64,
    input: f64,
    /// The smallest V and the most work at the ends of steps that were taken, J: what is in the middle of a nominal step, or of a run by dense
    /// output, has been there to move.
    extremes: [f64; 2],
    before: Mark,
    max_drift: f64,
    max_rise: f64,
    integrator_total: f64,
    projection_total: f64,
    violation: ViolationSummary,
    /// Rows that positions were off, where the method does not promise Φ = 0.
    strays: Option<Strays>,
    /// Rows that velocities were off, where it does not promise Φ̇ = 0, and the largest velocity so far, m/s.
    slips: Option<(Strays, f64)>,
    total_iterations: u64,
    taken: u64,
    factorizations: u64,
    rejected: u64,
    power: f64,
    penalty: Option<f64>,
    unsure: UnsureWork,
    haste: Haste,
    unrest: Unrest,
}

/// What was booked at the start of a nominal step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Mark {
    energy: f64,
    kinetic: f64,
    work: f64,
    integrator: f64,
    projection: f64,
    iterations: u64,
}

impl Audit {
    pub(super) fn new(system: &System, method: &Method, work: &mut Workspace, state: &State) -> Self {
        let penalty = match method.settings.multipliers {
            Multipliers::Penalty(alpha) if method.settings.level == Level::POSITION => Some(alpha),
            _ => None,
        };
        work.sample_end(system, state.t);
        let power = power_at(system, state, work);
        system.constraint_values(&work.end.at, state.t, &mut work.phi);
        let potential =
            energy::potential(system, &work.forces.weight, &state.x, &work.end.at, penalty.map(|alpha| (alpha, work.phi.as_slice())));
        let kinetic = energy::kinetic(system, &state.v);
        let nodes = work.forces.weight.chunks_exact(system.dim).zip(&system.is_point).filter(|(_, is_point)| **is_point);
        let lift: f64 = nodes.flat_map(|(weight, _)| weight.iter().zip(system.origin).map(|(weight, origin)| weight * origin)).sum();
        let lift = lift + system.fixed_energy;
        let momenta = energy::momenta(system, &state.x, &state.v, &mut work.full);
        let mut kept_momenta = [true; 6];
        energy::drop_driven_momenta(system, work, &state.x, &mut kept_momenta);
        let mut audit = Self {
            kinetic,
            potential,
            lift,
            work: 0.0,
            integrator: 0.0,
            projection: 0.0,
            phi: norm(&work.phi),
            phi_dot: 0.0,
            phi_ddot: 0.0,
            iterations: 0,
            momenta,
            first_momenta: momenta,
            kept_momenta,
            momentum_drift: [0.0; 6],
            initial: kinetic + potential,
            first: [kinetic, potential],
            lowest: potential,
            input: 0.0,
            extremes: [potential, 0.0],
            before: Mark { energy: kinetic + potential, ..Mark::default() },
            max_drift: 0.0,
            max_rise: 0.0,
            integrator_total: 0.0,
            projection_total: 0.0,
            violation: ViolationSummary::default(),
            strays: (!method.promises().contains(&Promise::Position)).then(Default::default),
            slips: (!method.promises().contains(&Promise::Velocity)).then(Default::default),
            total_iterations: 0,
            taken: 0,
            factorizations: 0,
            rejected: 0,
            power,
            penalty,
            unsure: UnsureWork::default(),
            haste: Haste::default(),
            unrest: Unrest::default(),
        };
        work.rate_violation(system, state.t);
        audit.phi_dot = norm(&work.rows);
        work.acceleration_violation(system, state.t);
        audit.phi_ddot = norm(&work.rows);
        audit.keep_violations();
        audit
    }

    /// Energy of the present state, J.
    pub fn energy(&self) -> f64 {
        self.kinetic + self.potential
    }

    pub(super) fn begin_step(&mut self) {
        self.before = self.mark();
    }

    fn mark(&self) -> Mark {
        Mark {
            energy: self.energy(),
            kinetic: self.kinetic,
            work: self.work,
            integrator: self.integrator_total,
            projection: self.projection_total,
            iterations: self.total_iterations,
        }
    }

    /// What the integrator made or lost of the energy since an earlier state, over all there is to move; nothing where that is round-off. `still` is
    /// nothing beside what there is to move, `of_states` are the sizes of what laws, weights and mass make of rounded states, J; all round-off counts
    /// `amplified` times.
    pub(super) fn made_since(&self, before: &Self, amplified: f64, still: f64, of_states: impl FnOnce() -> f64) -> f64 {
        let made = (self.integrator_total - before.integrator_total).abs();
        let sizes = self.kinetic + self.potential.abs() + self.work.abs() + self.integrator_total.abs();
        let rounded = ROUNDED * amplified;
        let round_off = rounded * sizes;
        let is_round_off = made <= round_off || made <= round_off + rounded * of_states();
        if is_round_off { 0.0 } else { made / (self.supply()[1] + round_off + still) }
    }

    /// The same of an estimate of what a step made, J, of which so much is rounded.
    pub(super) fn estimated(&self, made: f64, rounded: f64, still: f64) -> f64 {
        if made.abs() <= rounded { 0.0 } else { made.abs() / (self.supply()[1] + rounded + still) }
    }

    /// What integrator and projections have made of the energy so far that no work accounts for, J.
    pub(super) fn made(&self) -> f64 {
        self.integrator_total + self.projection_total
    }

    /// The share of the integrator in that, J.
    pub(super) fn made_by_integrator(&self) -> f64 {
        self.integrator_total
    }

    /// Energy and work at the start of the nominal step, J.
    pub(super) fn start_of_step(&self) -> [f64; 2] {
        [self.before.energy, self.before.work]
    }

    /// Kinetic energy there, J.
    pub(super) fn kinetic_at_start_of_step(&self) -> f64 {
        self.before.kinetic
    }

    /// Takes over from what was booked up to the last nominal time what a step that passed it does not know.
    pub(super) fn follow(&mut self, shown: &Self) {
        self.before = shown.before;
        self.max_drift = shown.max_drift;
        self.max_rise = shown.max_rise;
        (self.input, self.lowest) = (shown.input, shown.lowest);
        self.momentum_drift = shown.momentum_drift;
        self.kept_momenta = shown.kept_momenta;
        let (own, other) = (&mut self.violation, &shown.violation);
        own.position = own.position.max(other.position);
        own.velocity = own.velocity.max(other.velocity);
        own.acceleration = own.acceleration.max(other.acceleration);
        if let (Some(own), Some(other)) = (&mut self.strays, &shown.strays) {
            own.follow(other);
        }
        if let (Some((own, fastest)), Some((other, before))) = (&mut self.slips, &shown.slips) {
            own.follow(other);
            *fastest = fastest.max(*before);
        }
    }

    /// By how much the work of forces without a potential would be another by Simpson's rule at most so far, J, and the force, by its number among
    /// [`System::working_forces`], that differs most.
    pub(super) fn unsure_work(&self) -> (f64, usize) {
        self.unsure.largest()
    }

    /// The mean kinetic energy, J, where much of it is in vibrations that steps are long for.
    pub(super) fn of_vibrations(&self) -> Option<f64> {
        self.haste.of_vibrations()
    }

    /// The mean pull of multipliers, as an acceleration over the size of the mechanism, 1/s², where they jump from step to step.
    pub(super) fn of_unrest(&self) -> Option<f64> {
        self.unrest.mean()
    }

    fn keep_violations(&mut self) {
        let kept = &mut self.violation;
        kept.position = kept.position.max(self.phi);
        kept.velocity = kept.velocity.max(self.phi_dot);
        kept.acceleration = kept.acceleration.max(self.phi_ddot);
        if let Some(strays) = &mut self.strays {
            strays.keep();
        }
        if let Some((slips, _)) = &mut self.slips {
            slips.keep();
        }
    }

    /// The row that positions were farthest off so far, where the method does not promise to hold them.
    pub(super) fn farthest(&self) -> Option<Stray> {
        self.strays.map(|strays| strays.farthest)
    }

    /// The rows that velocities were farthest off so far and in the last step, where the method does not promise to hold them, and the largest of all
    /// velocities, m/s.
    pub(super) fn slipped(&self) -> Option<([Stray; 2], f64)> {
        self.slips.map(|(slips, fastest)| ([slips.farthest, slips.last], fastest))
    }

    /// Has a nominal step that was taken in parts begin where the audit `first` was.
    pub(super) fn join_parts(&mut self, first: &Self) {
        self.before = first.mark();
        self.iterations = self.total_iterations - self.before.iterations;
        self.integrator = self.integrator_total - self.before.integrator;
        self.projection = self.projection_total - self.before.projection;
    }

    pub(super) fn end_step(&mut self, system: &System, work: &mut Workspace, state: &State, steps: u64) {
        self.iterations = self.total_iterations - self.before.iterations;
        self.integrator = self.integrator_total - self.before.integrator;
        self.projection = self.projection_total - self.before.projection;
        self.max_drift = self.max_drift.max((self.energy() - self.initial - self.work).abs());
        self.max_rise = self.max_rise.max(self.energy() - self.before.energy - (self.work - self.before.work));
        self.input += (self.work - self.before.work).max(0.0);
        self.lowest = self.lowest.min(self.potential);
        self.momenta = energy::momenta(system, &state.x, &state.v, &mut work.full);
        if steps.is_power_of_two() {
            energy::drop_driven_momenta(system, work, &state.x, &mut self.kept_momenta);
        }
        for k in 0..6 {
            self.momentum_drift[k] = self.momentum_drift[k].max((self.momenta[k] - self.first_momenta[k]).abs());
        }
    }

    /// By how much the energy exceeds that of the start and all work that was put in, and all that could have become motion, J.
    pub(crate) fn supply(&self) -> [f64; 2] {
        let input = self.input + (self.work - self.before.work).max(0.0);
        let [kinetic, potential] = self.first;
        let supply = kinetic + (potential - self.lowest.min(self.potential)) + input;
        [self.energy() - self.initial - input, supply.max(self.most_to_move())]
    }

    /// The most energy that was there to move at the end of any step, J.
    fn most_to_move(&self) -> f64 {
        let ([kinetic, potential], [lowest, most]) = (self.first, self.extremes);
        kinetic + (potential - lowest) + most
    }
}

fn norm(values: &[f64]) -> f64 {
    // The sum of nothing is −0.
    (0.0 + values.iter().map(|v| v * v).sum::<f64>()).sqrt()
}
