//! What the audit books of each part of a step: what the integrator did, what the projections did, and what they leave of the rows.

use super::{Audit, norm};
use crate::energy;
use crate::formulation::{Newton, Sampling, Workspace};
use crate::integrator::{Step, Work};
use crate::linalg::largest;
use crate::simulation::doubts::Haste;
use crate::simulation::{Method, State};
use crate::system::System;

/// T, V and work of a step before its projection.
#[derive(Clone, Copy)]
pub(in crate::simulation) struct Accounts {
    potential: f64,
}

impl Audit {
    /// Goes on with the power at a state where forces have changed abruptly; `work` has them.
    pub(in crate::simulation) fn change_power(&mut self, system: &System, state: &State, work: &mut Workspace) {
        self.power = power_at(system, state, work);
    }

    /// Goes on from a state a little later, which no step led to and at which `work` has the evaluation of its start: forces that do work have done
    /// what the energy has changed by.
    pub(in crate::simulation) fn move_on(&mut self, system: &System, state: &State, work: &mut Workspace) {
        system.constraint_values(&work.start.at, state.t, &mut work.phi);
        let penalty = self.penalty.map(|alpha| (alpha, work.phi.as_slice()));
        let potential = energy::potential(system, &work.forces.weight, &state.x, &work.start.at, penalty);
        let kinetic = energy::kinetic(system, &state.v);
        let change = (kinetic - self.kinetic) + (potential - self.potential);
        *(if work.is_worked_on() { &mut self.work } else { &mut self.integrator_total }) += change;
        (self.kinetic, self.potential) = (kinetic, potential);
    }

    /// Books a step that was taken back, and the iterations that it took.
    pub(in crate::simulation) fn reject(&mut self, newton: &Newton) {
        self.rejected += 1;
        self.count(newton);
    }

    fn count(&mut self, newton: &Newton) {
        (self.total_iterations, self.factorizations) = (newton.iterations, newton.factorizations);
    }

    /// Books what the integrator did: ΔE_i is the change of energy that no work accounts for (21). The workspace gets what each worker did, which had
    /// these powers at the start of the step.
    pub(in crate::simulation) fn integrated(
        &mut self,
        system: &System,
        taken: &Step,
        t: f64,
        powers: &[f64],
        work: &mut Workspace,
    ) -> Accounts {
        self.taken += 1;
        let done = match taken.work {
            Work::AtEnds(extra) => {
                let power = energy::power(system, t, |work| &work.end, work);
                let half = 0.5 * taken.stage.step;
                work.book_powers(half);
                work.shares.iter_mut().zip(powers).for_each(|(share, power)| *share += half * power);
                let done = half * (self.power + power) + extra;
                self.power = power;
                done
            }
            Work::Between(extra) => {
                // Steps by accuracy are as long as that allows.
                if work.estimate.allowed == 0.0 {
                    self.unsure.add(energy::unsure_work(system, &taken.stage, work));
                }
                energy::work_between(system, &taken.stage, work) + extra
            }
            Work::Sum(done) => done,
        };
        system.constraint_values(&work.end.at, t, &mut work.phi);
        self.phi = norm(&work.phi);
        if let Some(strays) = &mut self.strays {
            strays.look(&work.phi, &work.scales.gradient);
        }
        let penalty = self.penalty.map(|alpha| (alpha, work.phi.as_slice()));
        let potential = energy::potential(system, &work.forces.weight, &work.end.x, &work.end.at, penalty);
        let kinetic = energy::kinetic(system, &work.end.v);
        if work.estimate.allowed == 0.0 && Haste::looks_at(self.taken) {
            let Workspace { full, start, end, .. } = work;
            full.iter_mut().zip(&end.v).zip(&start.v).for_each(|((half, after), before)| *half = 0.5 * (after - before));
            self.haste.look(energy::kinetic(system, full), 0.5 * (self.kinetic + kinetic));
        }
        let change = (kinetic - self.kinetic) + (potential - self.potential);
        self.integrator_total += change - done;
        self.work += done;
        self.kinetic = kinetic;
        let [lowest, most] = self.extremes;
        self.extremes = [lowest.min(potential), most.max(self.work)];
        Accounts { potential }
    }

    /// Looks at how multipliers, which were `before`, have changed in a step of length `h` (s).
    pub(in crate::simulation) fn look_at_multipliers(&mut self, h: f64, before: &[f64], work: &Workspace) {
        if work.estimate.allowed > 0.0 {
            return;
        }
        let [mut change, mut size] = [0.0; 2];
        for ((before, after), reach) in before.iter().zip(&work.lambda).zip(&work.scales.reach) {
            let square = |number: f64| (number * reach).powi(2);
            change += 0.25 * square(after - before);
            size += 0.5 * (square(*before) + square(*after));
        }
        self.unrest.look(h, change, size);
    }

    /// ‖Φ̈‖ of the accelerations the integrator found, where it takes its forces.
    pub(in crate::simulation) fn violate_acceleration(
        &mut self,
        system: &System,
        method: &Method,
        taken: &Step,
        target: f64,
        work: &mut Workspace,
    ) {
        if method.projection.acceleration {
            return;
        }
        match taken.stage.sampling {
            Sampling::End => work.acceleration_violation(system, target),
            _ => work.sampled_acceleration_violation(system, taken.stage.time()),
        }
        self.phi_ddot = norm(&work.rows);
    }

    /// Books what the projection did: ΔE_p (29), and the violations after it. `before` are the unprojected velocities.
    pub(in crate::simulation) fn projected(
        &mut self,
        system: &System,
        method: &Method,
        before: &[f64],
        accounts: Accounts,
        target: f64,
        work: &mut Workspace,
    ) {
        self.potential = accounts.potential;
        if method.projection.velocity && !method.projection.shadow {
            self.put_on_rows(system, before, method.projection.is_by_mass(), work);
        }
        work.rate_violation(system, target);
        self.phi_dot = norm(&work.rows);
        if let Some((slips, fastest)) = &mut self.slips {
            slips.look(&work.rows, &work.scales.gradient);
            *fastest = fastest.max(largest(&work.end.v));
        }
    }

    /// Books what a projection of velocities did, which were `before`; whether it was the full one in the metric of the mass.
    pub(in crate::simulation) fn put_on_rows(&mut self, system: &System, before: &[f64], is_by_mass: bool, work: &mut Workspace) {
        let change = energy::kinetic_difference(system, &work.end.v, before, &mut work.full);
        // What its impulses do along rows that move is all but −½ Δvᵀ M Δv.
        let pushed = if system.is_driven() && is_by_mass { change + energy::kinetic(system, &work.full) } else { 0.0 };
        self.work += pushed;
        self.projection_total += change - pushed;
        self.kinetic = energy::kinetic(system, &work.end.v);
    }

    /// Books the violation of projected accelerations, which were `before`, and what the step took.
    pub(in crate::simulation) fn closed(
        &mut self,
        system: &System,
        method: &Method,
        before: &[f64],
        target: f64,
        newton: &Newton,
        work: &mut Workspace,
    ) {
        if method.projection.acceleration {
            if system.is_driven() && method.projection.is_by_mass() {
                // The next step begins with these, whose rows give vᵀ M Δa more power: Δλ goes with M Δa = −Gᵀ Δλ, and Φ̇ = 0.
                let change = work.full.iter_mut().zip(work.a.iter().zip(before));
                change.for_each(|(change, (after, before))| *change = after - before);
                self.power += 2.0 * system.mass.half_product(system.dim, &work.end.v, &work.full);
            }
            work.acceleration_violation(system, target);
            self.phi_ddot = norm(&work.rows);
        }
        let projection = &method.projection;
        if (projection.velocity || projection.acceleration) && projection.is_by_mass() && system.is_driven() {
            if projection.shadow {
                work.impulses[0].fill(0.0);
            }
            energy::add_of_projections(system, work);
        }
        self.count(newton);
        self.keep_violations();
    }
}

/// The power of all that does work at a state, W, which `work` has sampled; it gets that of each worker.
pub(super) fn power_at(system: &System, state: &State, work: &mut Workspace) -> f64 {
    let mut powers = std::mem::take(&mut work.powers);
    let power = energy::power_with(system, state.t, &state.v, &state.a, work, &mut powers);
    work.powers = powers;
    power
}
