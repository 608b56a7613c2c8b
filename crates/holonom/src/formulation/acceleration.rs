//! Accelerations and multipliers of a state: (3), (4), (6) and (9) as one linear system (methods §2)
//! ```text
//! [ M   Gᵀ ] [a]     [ Q               ]
//! [ G   −δ ] [λ]  =  [ −c − 2ξωΦ̇ − ω²Φ ]
//! ```
//! with δ = 1/α for a penalty and a proximal one, iterated away, otherwise. Eliminating a first, as the factorisation
//! does, leaves (G M⁻¹Gᵀ) λ = … of the paper's (4), which redundant rows do not upset.

use super::failure::Failure;
use super::independence::{independence, independent};
use super::iteration::Multipliers;
use super::newton::Newton;
use super::passes::{LinearSystem, Purpose, STIFFER, meet, pass, react};
use super::pattern::Block;
use super::rank::RHO;
use super::standing::Sure;
use super::workspace::Workspace;
use crate::linalg::Solver;
use crate::system::System;

impl Newton {
    /// Writes [M Gᵀ; G −δ] at the evaluation of the end, with the proximal δ, and factors it. False when it cannot be.
    pub fn factor_inertia(&mut self, work: &Workspace) -> bool {
        LinearSystem::factor(self, RHO, work).is_ok()
    }

    /// The same with a δ that is a thousand times smaller, for rows that hardly differ from others.
    pub fn factor_stiffer_inertia(&mut self, work: &Workspace) -> bool {
        LinearSystem::factor(self, STIFFER * RHO, work).is_ok()
    }

    /// The same with hardly any δ for rows that are independent by their geometry.
    pub fn factor_inertia_of_independent(&mut self, system: &System, t: f64, work: &Workspace) -> bool {
        self.proximal_by_independence(system, t, work);
        self.assemble_inertia(work);
        self.factor(&work.scales).is_ok()
    }

    /// Hardly any δ for rows that are independent by their geometry.
    pub(super) fn proximal_by_independence(&mut self, system: &System, t: f64, work: &Workspace) {
        let least = independent(system.coordinates());
        let shares = independence(system, &work.end.x, &work.end.at.functions.angle, t);
        self.proximal_of_others(shares.into_iter().map(|share| share > least), &work.scales);
    }

    fn assemble_inertia(&mut self, work: &Workspace) {
        let block = Block(0, 0);
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        self.kkt.write_sum(block);
        self.kkt.add_columns(block, &work.end.at.gradient, 1.0);
        self.kkt.add_rows(block, &work.end.at.gradient, 1.0);
    }

    /// Accelerations and multipliers at the end position and velocity that satisfy Φ̈ = 0: the index-1 system (3).
    /// The multipliers start from those in the workspace. They are of the order of the positions and velocities
    /// whatever these were found by, so that forces can be trusted (methods §17). Says whether there are any: velocities at a singular position
    /// may belong to no motion.
    pub fn react(&mut self, system: &System, t: f64, work: &mut Workspace) -> Result<bool, Failure> {
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        work.sampled.copy_from(&work.end);
        let is_known = react(self, Purpose::Start, system, t, work)?;
        work.add_reactions(system);
        Ok(is_known)
    }

    /// The same to be shown, where the workspace has the evaluation at the end position.
    pub fn show_reactions(&mut self, sure: Option<&Sure>, system: &System, t: f64, work: &mut Workspace) -> Result<bool, Failure> {
        react(self, Purpose::Show(sure), system, t, work)
    }

    /// What rows must add to be sure, by what they add at the evaluation of the end, which is that of the start.
    pub fn sure(&mut self, system: &System, work: &Workspace) -> Option<Sure> {
        Sure::of(self, system, work)
    }

    /// Accelerations and multipliers at the end position and velocity by the formulation itself, which must be one that
    /// gives them: with rows at acceleration level, or soft.
    pub fn accelerate(&mut self, system: &System, t: f64, work: &mut Workspace) -> Result<bool, Failure> {
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        match self.settings.multipliers {
            Multipliers::Penalty(alpha) if work.level.acceleration == 0.0 => self.push(system, t, alpha, work).map(|()| true),
            Multipliers::Penalty(alpha) => self.balance(system, t, Some(alpha), work),
            Multipliers::Augmented(_) => self.balance(system, t, None, work),
        }
    }

    /// Solves the system above at the evaluation of the end; with `penalty` as it stands, otherwise until δ no longer matters. Says whether
    /// accelerations are known: at a singular position none may meet all rows.
    fn balance(&mut self, system: &System, t: f64, penalty: Option<f64>, work: &mut Workspace) -> Result<bool, Failure> {
        let Some(alpha) = penalty else { return meet(self, system, t, work) };
        work.lambda.fill(0.0);
        self.delta.fill(1.0 / alpha);
        self.assemble_inertia(work);
        self.factor(&work.scales)?;
        work.sampled.copy_from(&work.end);
        work.begin_pass(system, t);
        pass(self, system, work)?;
        work.add_reactions(system);
        Ok(true)
    }

    /// M a = Q − αGᵀΦ (5).
    fn push(&mut self, system: &System, t: f64, alpha: f64, work: &mut Workspace) -> Result<(), Failure> {
        let n = system.coordinates();
        system.constraint_values(&work.end.at, t, &mut work.phi);
        work.lambda.iter_mut().zip(&work.phi).for_each(|(lambda, phi)| *lambda = alpha * phi);
        work.sampled.copy_from(&work.end);
        work.sum_applied_anew(system, t);
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        self.kkt.write_sum(Block(0, 0));
        self.delta.fill(1.0);
        self.factor(&work.scales)?;
        work.a[..n].fill(0.0);
        work.sum_reactions(system, &mut self.unknowns);
        self.unknowns[n..].fill(0.0);
        self.solve()?;
        work.a[..n].copy_from_slice(&self.unknowns[..n]);
        work.add_reactions(system);
        Ok(())
    }
}

impl LinearSystem for Newton {
    fn factor(&mut self, rho: f64, work: &Workspace) -> Result<f64, Failure> {
        self.proximal(1.0, None, &work.scales);
        self.delta.iter_mut().for_each(|delta| *delta *= RHO / rho);
        self.assemble_inertia(work);
        Self::factor(self, &work.scales)?;
        Ok(self.rank.proximal_leaves(rho))
    }

    fn solver(&self) -> &Solver {
        &self.kkt.solver
    }

    fn shares(&self, _: f64, work: &Workspace) -> impl Iterator<Item = f64> {
        let pivots = (0..self.delta.len()).map(|row| self.kkt.solver.pivot(self.kkt.multiplier(row, 0)) - self.delta[row]);
        pivots.zip(&work.scales.softness).map(|(pivot, softness)| pivot / softness)
    }

    fn is_even(&self, work: &Workspace) -> bool {
        !work.scales.are_light
    }

    fn unknowns(&mut self) -> &mut [f64] {
        &mut self.unknowns
    }

    fn solve(&mut self, _: &System, _: &Workspace) -> Result<(), Failure> {
        Self::solve(self)
    }

    fn accelerates(&mut self, system: &System, work: &Workspace) -> f64 {
        let (forces, rows) = self.unknowns.split_at(system.coordinates());
        work.accelerates(system, forces).max(work.scaled(rows))
    }
}
