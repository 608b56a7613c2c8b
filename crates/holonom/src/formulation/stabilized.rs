//! Rows at both levels, Φ = 0 and Φ̇ = 0, with a multiplier each (Gear–Gupta–Leimkuhler), for the conserving scheme
//! (methods §9; Kinon, Betsch and Schneider 2023).
//!
//! Unknowns in units of length and mass × length: d = Δq, u = ½h v_{n+1}, μ = ϖλ − hγ and γ' = hγ with ϖ = ½h². With
//! w = h v̄ the equations are
//! ```text
//! M (d − h v_n) + ϖ (DV − f) + Ḡᵀμ + ½ K_Φ(γ') w = 0        M (w − d) + Ḡᵀγ' = 0
//! Φ(q_{n+1}) = 0                                             G(q_{n+1}) u + ½h Φ_t = 0
//! ```
//! Those on the left are solved for d and μ and, with that d, those on the right for u and γ': two matrices of the size of
//! one level. What γ' does on the left, ½ (H w)ᵀγ', is some (hω)²/4 of the whole when things turn with ω, and met by sweeps
//! over the two.

use super::coupled::Coupled;
use super::failure::Failure;
use super::iteration::{Multipliers, OneStage, predict, restart};
use super::kkt::Kkt;
use super::newton::{Change, Equations, Newton, RESTARTS, attempt, iterate};
use super::pattern::Block;
use super::round_off::are_forces_round_off;
use super::stage::Stage;
use super::sweep::Sweeps;
use super::workspace::Workspace;
use crate::linalg::largest;
use crate::system::{Direction, MAX_ARGUMENTS, NO_CHANGE, System};

/// Scratch of the second level; the first is the workspace's.
pub struct Stabilized {
    /// The matrix of u and γ'.
    pub(super) kkt: Kkt,
    /// ½h v_{n+1} of all nodes (full), m; known nodes in place.
    pub u: Vec<f64>,
    /// Multiplier of the position rows, ϖλ − hγ (r).
    pub mu: Vec<f64>,
    /// Multiplier of the velocity rows, hγ (r).
    pub gamma: Vec<f64>,
    /// Multipliers λ of the last step (r), for the first tangent.
    pub lambda_start: Vec<f64>,
    /// What γ' is expected to change by in the first iteration (r); its matrices have it.
    pub gamma_change: Vec<f64>,
    /// h v̄ of all nodes (full), m.
    pub(super) w: Vec<f64>,
    /// H w, H u and H v_n, D a slot.
    pub(super) turned_w: Vec<f64>,
    pub(super) turned_u: Vec<f64>,
    turned_start: Vec<f64>,
    /// ∂Φ̇/∂v between the ends of the step (D a slot).
    pub(super) velocity_gradient: Vec<f64>,
    /// What γ' pulls with in the first equation, ½ H w + DΦ − D_vΦ̇ (D a slot).
    pub(super) pull: Vec<f64>,
    /// ½h Φ̇ (r).
    rate: Vec<f64>,
    /// What time alone changes the rates of the custom rows by over the step.
    pub(super) rate_by_time: Vec<f64>,
    /// Residual and solution for u and γ'.
    pub(super) unknowns: Vec<f64>,
    pub(super) sweeps: Sweeps,
    /// Whether the curvature of the rows under γ' counts beside the mass.
    pub(super) curves: bool,
    /// Forces on all nodes (full).
    pub(super) force: Vec<f64>,
    /// Both levels in one matrix, made when sweeps do not contract for the first time.
    coupled: Option<Box<Coupled>>,
    /// Steps to come that are solved with it.
    pub coupled_steps: u32,
}

/// Steps with both levels in one matrix before sweeps are tried again.
const COUPLED: u32 = 16;

impl Stabilized {
    /// Allocates everything for a system, with a matrix like that of `newton`.
    pub fn new(system: &System, newton: &Newton) -> Self {
        let (r, all) = (system.constraints(), system.nodes() * system.dim);
        let kkt = newton.kkt.twin();
        let (slots, size) = (system.slots.nodes.len() * system.dim, kkt.size());
        Self {
            kkt,
            u: vec![0.0; all],
            mu: vec![0.0; r],
            gamma: vec![0.0; r],
            lambda_start: vec![0.0; r],
            gamma_change: vec![0.0; r],
            w: vec![0.0; all],
            turned_w: vec![0.0; slots],
            turned_u: vec![0.0; slots],
            turned_start: vec![0.0; slots],
            velocity_gradient: vec![0.0; slots],
            pull: vec![0.0; slots],
            rate: vec![0.0; r],
            rate_by_time: vec![0.0; r - system.rows.len()],
            unknowns: vec![0.0; size],
            sweeps: Sweeps::new(size),
            curves: false,
            force: vec![0.0; all],
            coupled: None,
            coupled_steps: 0,
        }
    }

    fn is_coupled(&self) -> bool {
        self.coupled_steps > 0
    }

    /// Solves both levels in one matrix from here on.
    fn couple(&mut self, system: &System) {
        self.coupled_steps = COUPLED;
        self.coupled.get_or_insert_with(|| Box::new(Coupled::new(system)));
    }

    fn factor_coupled(&mut self, system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        let mut coupled = self.coupled.take().unwrap_or_else(|| Box::new(Coupled::new(system)));
        let outcome = coupled.factor(self, system, stage, newton, work);
        self.coupled = Some(coupled);
        outcome
    }

    /// Replaces both residuals by increments; nothing is left.
    fn solve_coupled(&mut self, system: &System, newton: &mut Newton) -> f64 {
        if let Some(coupled) = &mut self.coupled {
            coupled.solve(system.coordinates(), system.dim, &mut newton.unknowns, &mut self.unknowns);
        }
        0.0
    }

    /// Newton on increments, velocities and both multipliers from the values in the workspaces.
    pub fn solve(&mut self, system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        system.invariants.curvature(&work.start.v, &mut work.turned.half, &mut self.turned_start);
        iterate(&mut BothLevels { own: self, system, stage, is_near: false }, newton, work)
    }

    /// Residual of both levels at the unknowns (of d and μ, then of u and γ'), and their tangent for [`Self::entry`].
    pub fn linearise(&mut self, system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) -> Vec<f64> {
        system.invariants.curvature(&work.start.v, &mut work.turned.half, &mut self.turned_start);
        BothLevels { own: self, system, stage, is_near: false }.evaluate(true, newton, work);
        let mut coupled = self.coupled.take().unwrap_or_else(|| Box::new(Coupled::new(system)));
        coupled.assemble(self, system, stage, work);
        self.coupled = Some(coupled);
        newton.unknowns.iter().chain(&self.unknowns).map(|unknown| -unknown).collect()
    }

    /// The tangent's derivative of a residual by an unknown, without the proximal term.
    pub fn entry(&self, system: &System, residual: usize, unknown: usize) -> f64 {
        self.coupled.as_ref().map_or(0.0, |coupled| coupled.entry(system, residual, unknown))
    }

    /// w, and H times w and u.
    pub fn turn(&mut self, system: &System, stage: &Stage, work: &mut Workspace) {
        let half = 0.5 * stage.step;
        self.w.iter_mut().zip(&self.u).zip(&work.start.v).for_each(|((w, u), v)| *w = u + half * v);
        let to_end = Direction { nodes: &self.u, time: half };
        system.turn_rows(&work.end.at, &work.end.x, to_end, stage.end(), &mut work.turned.half, &mut self.turned_u);
        // The Hessians of invariants are constant; the slots of functions come later.
        let turned = self.turned_u.iter().zip(&self.turned_start);
        self.turned_w.iter_mut().zip(turned).for_each(|(w, (u, start))| *w = u + half * start);
        self.velocity_gradient.copy_from_slice(&work.sampled.at.gradient);
        self.turn_functions(system, stage.step, work);
        self.turn_custom(system, stage, work);
        self.pull.iter_mut().zip(&self.turned_w).for_each(|(pull, turned)| *pull = 0.5 * turned);
        if !(system.functions.is_empty() && system.custom.is_empty()) {
            for ((pull, position), velocity) in self.pull.iter_mut().zip(&work.sampled.at.gradient).zip(&self.velocity_gradient) {
                *pull += position - velocity;
            }
        }
    }

    /// Where rows are functions g of invariants, the rates Φ̇ = Σ g_i π̇_i have the discrete derivatives
    /// ```text
    /// D_v Φ̇ = Σ ḡ_i ∇π̄_i        D_q Φ̇ = Σ ḡ_i H_i v̄ + Σ mean(π̇_j) (D g_j)_i ∇π̄_i
    /// ```
    /// with ḡ the mean of the two ends and D g_j·Δπ = Δg_j, so that D_vΦ̇·Δv + D_qΦ̇·Δq = ΔΦ̇. As D_vΦ̇ is not DΦ there,
    /// the first equation gets (DΦ − D_vΦ̇)ᵀγ' more.
    fn turn_functions(&mut self, system: &System, step: f64, work: &Workspace) {
        if system.functions.is_empty() {
            return;
        }
        let (from, to) = (&work.start.at, &work.end.at);
        let mean = |k: usize| -> [f64; MAX_ARGUMENTS] {
            let (a, b) = (&from.functions.local[k], &to.functions.local[k]);
            std::array::from_fn(|i| 0.5 * (a.gradient[i] + b.gradient[i]))
        };
        system.turn_functions(system.functions_of_rows(), &work.sampled.at, &mut self.velocity_gradient, |k, _| {
            mean(k).map(|factor| [factor, 0.0])
        });
        let (v0, u) = (&work.start.v, &self.u);
        system.turn_functions(system.functions_of_rows(), &work.sampled.at, &mut self.turned_w, |k, base| {
            let (start, end) = (system.rates(base, from, v0), system.rates(base, to, u));
            let rates: [f64; MAX_ARGUMENTS] = std::array::from_fn(|j| end[j] + 0.5 * step * start[j]);
            let (a, b) = (&from.functions.local[k], &to.functions.local[k]);
            let change: [f64; MAX_ARGUMENTS] =
                std::array::from_fn(|i| base.get(i).map_or(0.0, |id| to.value[id.0 as usize] - from.value[id.0 as usize]));
            // Of the change of the gradients along the rates, what the mean Hessian leaves.
            let along = |i: usize| 0.5 * (a.bend(i, &rates) + b.bend(i, &rates));
            let rise: f64 = (0..base.len()).map(|j| rates[j] * (b.gradient[j] - a.gradient[j])).sum();
            let rest = rise - (0..base.len()).map(|i| along(i) * change[i]).sum::<f64>();
            // Arguments of different units are weighed by what they do to the rate.
            let weight: [f64; MAX_ARGUMENTS] = std::array::from_fn(|i| (a.bend(i, &rates).abs() + b.bend(i, &rates).abs()).powi(2));
            let size: f64 = (0..base.len()).map(|i| weight[i] * change[i] * change[i]).sum();
            let scale: f64 = base.iter().enumerate().map(|(i, id)| weight[i] * to.value[id.0 as usize].powi(2)).sum();
            let factor = if size > NO_CHANGE * NO_CHANGE * scale { rest / size } else { 0.0 };
            let mean = mean(k);
            std::array::from_fn(|i| [mean[i], along(i) + factor * weight[i] * change[i]])
        });
    }

    fn residual(&mut self, system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) {
        let (n, dim) = (system.coordinates(), system.dim);
        work.residual(system, stage, &mut newton.unknowns);
        self.force.fill(0.0);
        system.slots.add_forces(dim, &self.gamma, &self.pull, &mut self.force);
        newton.unknowns.iter_mut().zip(&self.force[..n]).for_each(|(unknown, force)| *unknown -= force);
        // The second equation takes the same path through the mass matrix, over all nodes.
        for i in 0..work.full.len() {
            let increment = if i < n { work.d[i] } else { work.end.x[i] - work.start.x[i] };
            work.full[i] = self.w[i] - increment;
        }
        system.mass.times(dim, &work.full, &mut work.inertial);
        self.force.fill(0.0);
        system.slots.add_forces(dim, &self.gamma, &self.velocity_gradient, &mut self.force);
        for (i, unknown) in self.unknowns[..n].iter_mut().enumerate() {
            *unknown = -work.inertial[i] - self.force[i];
        }
        for row in 0..self.rate.len() {
            self.rate[row] = 0.5 * stage.step * system.explicit_rate(row, &work.end.at, stage.end());
        }
        system.slots.add_along(dim, 1.0, &work.end.at.gradient, &self.u, &mut self.rate);
        self.unknowns[n..].iter_mut().zip(&self.rate).for_each(|(unknown, rate)| *unknown = -rate);
    }

    fn tangent(&mut self, system: &System, stage: &Stage, newton: &mut Newton, work: &mut Workspace) {
        let block = Block(0, 0);
        work.expected_tangent(system, stage, &mut newton.kkt);
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        self.kkt.write_sum(block);
        self.kkt.add_columns(block, &self.velocity_gradient, 1.0);
        self.kkt.add_rows(block, &work.end.at.gradient, 1.0);
        self.kkt.regularise(0, &newton.delta);
    }

    /// Adds the solution to the unknowns; the largest increment over the size of the mechanism.
    fn advance(&mut self, system: &System, newton: &Newton, work: &mut Workspace) -> f64 {
        let n = system.coordinates();
        work.d.iter_mut().zip(&newton.unknowns).for_each(|(d, step)| *d += step);
        self.u.iter_mut().zip(&self.unknowns[..n]).for_each(|(u, turn)| *u += turn);
        self.mu.iter_mut().zip(&newton.unknowns[n..]).for_each(|(mu, step)| *mu += step);
        self.gamma.iter_mut().zip(&self.unknowns[n..]).for_each(|(gamma, step)| *gamma += step);
        largest(&newton.unknowns[..n]).max(largest(&self.unknowns[..n])) / work.scales.unit
    }

    /// Whether the residuals of both levels are round-off.
    fn is_met(&mut self, system: &System, stage: &Stage, moves: bool, newton: &Newton, work: &mut Workspace) -> bool {
        let (n, dim) = (system.coordinates(), system.dim);
        // γ' pulls at the first level, too, as μ does.
        for (lambda, (mu, gamma)) in work.lambda.iter_mut().zip(self.mu.iter().zip(&self.gamma)) {
            *lambda = (mu.abs() + gamma.abs()) / stage.inertia;
        }
        if !work.is_met(system, stage, moves, &newton.unknowns, &newton.rank)
            || (moves && !are_forces_round_off(&self.unknowns[..n], &work.full[..n]))
        {
            return false;
        }
        let nothing = work.nothing();
        work.rows.iter_mut().zip(&work.scales.gradient).for_each(|(size, g)| *size = g * nothing);
        for slot in &system.slots.by_row {
            let (g, x) = (slot.slot as usize * dim, slot.node as usize * dim);
            let size = |g: &[f64], x: &[f64]| largest(g) * largest(x);
            let (g, x) = (g..g + dim, x..x + dim);
            let own = size(&work.end.at.gradient[g.clone()], &self.u[x.clone()]);
            work.rows[slot.row as usize] += own + size(&self.turned_u[g], &work.end.x[x]);
        }
        // Velocities are rounded by as much more as a row hardly holds.
        let amplified = 1.0 / newton.rank.weakest.sqrt();
        work.rows.iter_mut().for_each(|size| *size *= amplified);
        newton.rank.are_rows_round_off(&self.unknowns[n..], &work.rows)
    }

    /// Work of known motion in the step that the stage's forces do not show, J: through the velocity rows,
    /// γ·(Ḡ Δv + H v̄ Δx − Δċ) over the known nodes, and through inertia, as Δq/h is not v̄ here. It is added to the shares of rows and nodes.
    pub fn work(&self, system: &System, stage: &Stage, work: &mut Workspace) -> f64 {
        let (dim, h) = (system.dim, stage.step);
        let mut sum = 0.0;
        let mut shares = std::mem::take(&mut work.shares);
        let [_, _, of_rows, of_nodes] = system.workers().split(&mut shares);
        let mut driven = system.driven_rows.iter().zip(of_rows).peekable();
        for known in system.free..system.nodes() {
            for (node, mass) in system.mass.row(known).filter(|&(node, _)| node < system.free) {
                let [mut push, mut slip, mut lag, mut pull] = [[0.0; 3]; 4];
                for c in 0..dim {
                    let (k, i) = (known * dim + c, node * dim + c);
                    push[c] = work.end.v[k] - work.start.v[k];
                    slip[c] = (self.w[i] - work.d[i]) / h;
                    lag[c] = (work.end.x[k] - work.start.x[k]) / h - 0.5 * (work.start.v[k] + work.end.v[k]);
                    pull[c] = work.end.v[i] - work.start.v[i];
                }
                let own = mass.product(&push, &slip) + mass.product(&lag, &pull);
                (sum, of_nodes[known - system.free]) = (sum + own, of_nodes[known - system.free] + own);
            }
        }
        for (row, slots) in system.slots.rows.iter().enumerate() {
            let mut along = match row.checked_sub(system.rows.len()) {
                Some(custom) => self.rate_by_time[custom],
                None => system.explicit_rate(row, &work.end.at, stage.end()) - system.explicit_rate(row, &work.start.at, stage.start),
            };
            if let Some((_, share)) = driven.next_if(|(driven, _)| **driven as usize == row) {
                *share += self.gamma[row] / h * along;
            }
            for s in slots.clone().filter(|&s| system.slots.nodes[s] as usize >= system.free) {
                let node = system.slots.nodes[s] as usize * dim;
                for c in 0..dim {
                    let (g, turned) = (self.velocity_gradient[s * dim + c], self.turned_w[s * dim + c] / h);
                    let own =
                        g * (work.end.v[node + c] - work.start.v[node + c]) + turned * (work.end.x[node + c] - work.start.x[node + c]);
                    along += own;
                    of_nodes[node / dim - system.free] += self.gamma[row] / h * own;
                }
            }
            sum += self.gamma[row] / h * along;
        }
        work.shares = shares;
        sum
    }
}

/// Rows at both levels as Newton's iteration sees them.
struct BothLevels<'a> {
    own: &'a mut Stabilized,
    system: &'a System,
    stage: &'a Stage,
    /// Whether the attempt began at the solution without velocity rows.
    is_near: bool,
}

impl BothLevels<'_> {
    /// Solves the step with the rows at position level alone, in one attempt; whether that worked.
    fn start_from_positions(&mut self, newton: &mut Newton, work: &mut Workspace) -> bool {
        predict(self.stage, work);
        work.lambda.copy_from_slice(&self.own.lambda_start);
        let mut positions = OneStage { system: self.system, stage: self.stage, multipliers: Multipliers::Augmented(None) };
        attempt(&mut positions, false, newton, work).is_ok()
    }
}

impl Equations for BothLevels<'_> {
    fn begin(&mut self, newton: &mut Newton, work: &mut Workspace) {
        newton.proximal_by_rank(&work.scales);
        let is_full = newton.rank.is_full();
        work.expect_multipliers(is_full);
        if is_full {
            let Stabilized { mu, gamma, gamma_change, .. } = &mut *self.own;
            mu.iter_mut().zip(&work.lambda).for_each(|(mu, lambda)| *mu = self.stage.inertia * lambda);
            gamma.iter_mut().zip(gamma_change).for_each(|(gamma, change)| *gamma += std::mem::take(change));
        }
        let Stabilized { mu, gamma, gamma_change, .. } = &mut *self.own;
        [mu, gamma, gamma_change, &mut work.prediction.lambda_change]
            .into_iter()
            .for_each(|multipliers| newton.rank.leave_out_of(multipliers));
    }

    /// From the solution without velocity rows. If that leads nowhere, the step is too long for rows at both levels, and shares of
    /// the free flight do no better. If there is none at hand, from these: what is left of looking for it says nothing.
    fn restart(&mut self, again: usize, newton: &mut Newton, work: &mut Workspace) -> bool {
        if again == 0 {
            self.is_near = self.start_from_positions(newton, work);
        } else if self.is_near {
            return false;
        }
        if !self.is_near {
            let Some(&share) = RESTARTS.get(again) else { return false };
            restart(share, work);
        }
        for i in 0..self.system.coordinates() {
            self.own.u[i] = work.d[i] - 0.5 * self.stage.step * work.start.v[i];
        }
        self.own.mu.fill(0.0);
        self.own.gamma.fill(0.0);
        self.own.gamma_change.fill(0.0);
        true
    }

    fn evaluate(&mut self, _is_new: bool, newton: &mut Newton, work: &mut Workspace) {
        let Self { own, system, stage, .. } = self;
        work.lambda.iter_mut().zip(&own.mu).for_each(|(lambda, mu)| *lambda = mu / stage.inertia);
        work.place(stage);
        work.evaluate(system, stage);
        own.turn(system, stage, work);
        own.residual(system, stage, newton, work);
    }

    fn is_met(&mut self, moves: bool, newton: &mut Newton, work: &mut Workspace) -> bool {
        self.own.is_met(self.system, self.stage, moves, newton, work)
    }

    fn factor(&mut self, _is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        if self.own.is_coupled() {
            return self.own.factor_coupled(self.system, self.stage, newton, work);
        }
        self.own.tangent(self.system, self.stage, newton, work);
        newton.factor(&work.scales)?;
        self.own.kkt.factor()
    }

    fn guards_rank(&mut self, newton: &mut Newton, work: &Workspace) -> bool {
        newton.guards_rank(&work.scales)
    }

    fn rest_of_first(&self, change: &Change, newton: &Newton, work: &Workspace) -> f64 {
        newton.rest_of_first(change.increment, change.multipliers.max(change.left), work)
    }

    fn advance(&mut self, is_first: bool, newton: &mut Newton, work: &mut Workspace) -> Result<Change, Failure> {
        let Self { own, system, stage, .. } = self;
        let left = match own.is_coupled() {
            true => own.solve_coupled(system, newton),
            false => match own.sweep(system, is_first, newton, work)? {
                Some(left) => left,
                None => {
                    own.couple(system);
                    own.residual(system, stage, newton, work);
                    own.factor_coupled(system, stage, newton, work)?;
                    own.solve_coupled(system, newton)
                }
            },
        };
        if !own.unknowns.iter().chain(&newton.unknowns).all(|unknown| unknown.is_finite()) {
            return Err(Failure::NotFinite);
        }
        let increment = own.advance(system, newton, work);
        let n = system.coordinates();
        let steps = own.unknowns[n..].iter().zip(&own.gamma_change).map(|(step, change)| step - change);
        let multipliers = work.turned(stage.inertia, &newton.unknowns[n..]).max(work.scaled_multipliers(steps));
        own.gamma_change.fill(0.0);
        Ok(Change { increment, multipliers, left })
    }
}
