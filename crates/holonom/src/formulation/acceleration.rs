//! Accelerations and multipliers of a state: (3), (4), (6) and (9) as one linear system (methods §6)
//! ```text
//! [ M   Gᵀ ] [a]     [ Q               ]
//! [ G   −δ ] [λ]  =  [ −c − 2ξωΦ̇ − ω²Φ ]
//! ```
//! with δ = 1/α for a penalty and a proximal one, iterated away, otherwise. Eliminating a first, as the factorisation
//! does, leaves (G M⁻¹Gᵀ) λ = … of the paper's (4), which redundant rows do not upset.

use super::failure::Failure;
use super::iteration::{Multipliers, SolveSettings};
use super::kkt::Block;
use super::level::Level;
use super::workspace::Workspace;
use crate::system::System;

/// Passes with a proximal δ; the first starts from the multipliers at hand and leaves δ of what they miss, the others are
/// for redundant rows.
const PASSES: usize = 3;

impl Workspace {
    /// Writes [M Gᵀ; G −δ] at the evaluation `at_end`, with the proximal δ, and factors it. False when it cannot be.
    pub fn factor_inertia(&mut self) -> bool {
        self.proximal(1.0, None);
        self.assemble_inertia();
        self.factor().is_ok()
    }

    fn assemble_inertia(&mut self) {
        let block = Block(0, 0);
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        self.kkt.write_sum(block);
        self.kkt.add_columns(block, &self.at_end.gradient, 1.0);
        self.kkt.add_rows(block, &self.at_end.gradient, 1.0);
    }

    /// Accelerations `a1` and multipliers at the end position and velocity that satisfy Φ̈ = 0: the index-1 system (3).
    /// The multipliers start from those in the workspace. They are of the order of the positions and velocities
    /// whatever these were found by, so that forces can be trusted (methods §1.5).
    pub fn react(&mut self, system: &System, t: f64) -> Result<(), Failure> {
        let level = std::mem::replace(&mut self.level, Level::ACCELERATION);
        let outcome = self.balance(system, t, None);
        self.level = level;
        outcome
    }

    /// Forces of the rows on all nodes, −Gᵀλ (D × nodes), N, at the evaluation `at_end`.
    pub fn constraint_forces(&self, force: &mut [f64]) {
        force.fill(0.0);
        self.kkt.add_forces(&self.lambda, &self.at_end.gradient, force);
        force.iter_mut().for_each(|force| *force = -*force);
    }

    /// Accelerations and multipliers at the end position and velocity by the formulation itself, which must be one that
    /// gives them: with rows at acceleration level, or soft.
    pub fn accelerate(&mut self, system: &System, t: f64, settings: &SolveSettings) -> Result<(), Failure> {
        match settings.multipliers {
            Multipliers::Penalty(alpha) if self.level.acceleration == 0.0 => self.push(system, t, alpha),
            Multipliers::Penalty(alpha) => self.balance(system, t, Some(alpha)),
            Multipliers::Augmented(_) => self.balance(system, t, None),
        }
    }

    /// Solves the system above; with `penalty` as it stands, otherwise until δ no longer matters.
    fn balance(&mut self, system: &System, t: f64, penalty: Option<f64>) -> Result<(), Failure> {
        let n = system.coordinates();
        match penalty {
            Some(alpha) => {
                self.lambda.fill(0.0);
                self.delta.fill(1.0 / alpha);
            }
            None => self.proximal(1.0, None),
        }
        self.sample_end(system, t);
        self.assemble_inertia();
        self.factor()?;
        let passes = if penalty.is_some() { 1 } else { PASSES };
        self.a1[..n].fill(0.0);
        for pass in 0..passes {
            self.sum_reactions(system, t, pass == 0);
            self.weigh_levels(system, t, 1.0);
            for i in 0..n {
                self.unknowns[i] = -self.inertial[i];
            }
            self.unknowns[n..].iter_mut().zip(&self.phi).for_each(|(unknown, row)| *unknown = -row);
            self.solve()?;
            self.a1[..n].iter_mut().zip(&self.unknowns).for_each(|(a, step)| *a += step);
            self.lambda.iter_mut().zip(&self.unknowns[n..]).for_each(|(lambda, step)| *lambda += step);
        }
        self.sample_end(system, t);
        Ok(())
    }

    /// M a + f + Gᵀλ at the end into `inertial`. The sampled forces hold Gᵀλ of the multipliers they were sampled with,
    /// so that later passes sample again.
    fn sum_reactions(&mut self, system: &System, t: f64, is_sampled: bool) {
        if !is_sampled {
            self.resample_end(system, t);
        }
        system.mass.times(system.dim, &self.a1, &mut self.inertial);
        self.inertial.iter_mut().zip(&self.force).for_each(|(sum, force)| *sum += force);
    }

    /// M a = Q − αGᵀΦ (5).
    fn push(&mut self, system: &System, t: f64, alpha: f64) -> Result<(), Failure> {
        let n = system.coordinates();
        system.evaluate(&self.x1, t, &self.at_start, &mut self.at_end);
        system.constraint_values(&self.at_end, t, &mut self.phi);
        self.lambda.iter_mut().zip(&self.phi).for_each(|(lambda, phi)| *lambda = alpha * phi);
        self.sample_end(system, t);
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        self.kkt.write_sum(Block(0, 0));
        self.delta.fill(1.0);
        self.factor()?;
        self.a1[..n].fill(0.0);
        self.sum_reactions(system, t, true);
        for i in 0..n {
            self.unknowns[i] = -self.inertial[i];
        }
        self.unknowns[n..].fill(0.0);
        self.solve()?;
        self.a1[..n].copy_from_slice(&self.unknowns[..n]);
        Ok(())
    }
}
