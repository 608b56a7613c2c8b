//! Everything mutable of a step: positions, evaluations, forces and the matrix, allocated once.

use super::failure::Failure;
use super::kept::Kept;
use super::kkt::{ALL, Kkt};
use super::level::Level;
use super::scales::Scales;
use super::stage::{Sampling, Stage};
use crate::linalg::largest;
use crate::system::{Evaluation, Response, SIZE, System};

/// Share of the rows' own stiffness that the proximal term may soften: δ = (G M⁻¹ Gᵀ)/ρ (methods §1.2, §11). With redundant
/// rows round-off grows with ρ to multipliers that mean nothing.
pub const RHO: f64 = 1e10;

/// Attempts after a change of the rank that are near a singular position.
pub(super) const SINGULAR: u32 = 32;

/// The same of rows that are not redundant. What they miss in an iteration falls with ρ; it comes to N²/ρ in a chain of N
/// links.
const RHO_REGULAR: f64 = 1e16;

/// Pivots of rows that are smaller over the rows' own stiffness belong to redundant ones.
const REDUNDANT: f64 = 1e-9;

/// Scratch of a stage. Full vectors hold D numbers a node, free nodes first.
pub struct Workspace {
    pub kkt: Kkt,
    /// What numbers of different nodes and rows are compared by.
    pub scales: Scales,
    /// The condition that the rows of a stage stand for.
    pub level: Level,
    /// Position, velocity at the start of the step (full).
    pub x0: Vec<f64>,
    pub v0: Vec<f64>,
    /// Increment of the free coordinates (n), m.
    pub d: Vec<f64>,
    /// Multipliers λ (r).
    pub lambda: Vec<f64>,
    /// Position at the end of the step (full), known nodes in place.
    pub x1: Vec<f64>,
    /// Velocity at the end of the step (full).
    pub v1: Vec<f64>,
    /// Acceleration (full), the known nodes' in place.
    pub a1: Vec<f64>,
    /// Predicted change of the accelerations over the step (full), m/s².
    pub a_change: Vec<f64>,
    /// Expected change of the multipliers (r). The first tangent of a step has it; the iteration starts without it, as what
    /// redundant rows leave undetermined of the multipliers would run away.
    pub lambda_change: Vec<f64>,
    /// Part of the increment that needs no acceleration (n), m.
    pub drift: Vec<f64>,
    /// Part of the sampled velocity that does not depend on the increment (n), m/s.
    pub offset: Vec<f64>,
    /// Sampled position and velocity (full).
    pub xs: Vec<f64>,
    pub vs: Vec<f64>,
    pub at_start: Evaluation,
    pub at_end: Evaluation,
    pub sampled: Evaluation,
    /// Φ as the stage enforces it (r), and at the start.
    pub phi: Vec<f64>,
    pub phi_start: Vec<f64>,
    /// Sum of the gradients of laws, rows, gravity and minus the loads (full), N.
    pub force: Vec<f64>,
    /// Responses of the laws, then of the rows that are functions of invariants, by the invariants they depend on.
    pub responses: Vec<Response>,
    /// Forces of the loads (D × their nodes, one after the other), N.
    pub load_force: Vec<f64>,
    /// Residual and solution of the linear system.
    pub unknowns: Vec<f64>,
    pub delta: Vec<f64>,
    /// −M g (full), N.
    pub weight: Vec<f64>,
    /// ½ vᵀ H v and H v of the invariants at the sampled velocity.
    pub half: Vec<f64>,
    pub motion: Vec<f64>,
    /// H v and H a of all rows' slots, D a slot.
    pub turned_v: Vec<f64>,
    pub turned_a: Vec<f64>,
    /// Gradients of the rows by the increment, where some hold velocities only (D a slot).
    pub(super) row_gradient: Vec<f64>,
    /// Estimated local errors of position (n), m, and velocity (n), m/s, where an integrator gives them.
    pub error_q: Vec<f64>,
    pub error_v: Vec<f64>,
    /// Local errors that are allowed, over the size of the mechanism and the step, 1/s, where steps follow from an accuracy.
    pub allowed: f64,
    /// Numbers that an integrator keeps from step to step.
    pub memory: Vec<f64>,
    /// Full and reduced scratch vectors.
    pub full: Vec<f64>,
    pub inertial: Vec<f64>,
    pub rows: Vec<f64>,
    /// Sizes of gradients (D a slot).
    pub(super) sizes: Vec<f64>,
    pub(super) dense: Vec<f64>,
    /// Rows whose pivot in the last factorisation was no redundant one's.
    regular: Vec<bool>,
    /// How many they leave, if any were counted, and whether that has changed then.
    redundant: Option<usize>,
    changes_rank: bool,
    /// Attempts to come that are near a singular position.
    singular: u32,
    /// Whether rows that were regular have hardly any proximal term in this attempt.
    pub(super) spares_regular: bool,
    /// Newton iterations and factorisations so far, those of failed attempts included.
    pub iterations: u64,
    pub factorizations: u64,
    pub(super) dissipative: bool,
    works: bool,
    /// Whether a stage between two positions looks at their gradients and nothing else.
    only_gradients: bool,
    /// What the factors were last made of.
    pub(super) kept: Kept,
}

impl Workspace {
    /// Allocates everything for a system.
    pub fn new(system: &System) -> Self {
        let (n, r, all) = (system.coordinates(), system.constraints(), system.nodes() * system.dim);
        let scales = Scales::new(system);
        let kkt = Kkt::new(system, &scales, 1, ALL);
        let evaluation = system.evaluation();
        let mut weight = vec![0.0; all];
        for (a, weight) in weight.chunks_exact_mut(system.dim).enumerate() {
            let ([m, s], g) = (system.weighing[a], system.gravity);
            (0..system.dim).for_each(|c| weight[c] = -m * g[c]);
            weight[0] -= s * g[1];
            weight[1] += s * g[0];
        }
        let loads: usize = system.loads.iter().map(|load| load.nodes.len() * system.dim).sum();
        let mut workspace = Self {
            unknowns: vec![0.0; kkt.size()],
            kept: Kept::new(system, kkt.is_changed_by_rows(), system.slots.nodes.len()),
            kkt,
            scales,
            level: Level::POSITION,
            x0: system.start_position.clone(),
            v0: system.start_velocity.clone(),
            d: vec![0.0; n],
            lambda: vec![0.0; r],
            x1: vec![0.0; all],
            v1: vec![0.0; all],
            a1: vec![0.0; all],
            a_change: vec![0.0; all],
            lambda_change: vec![0.0; r],
            drift: vec![0.0; n],
            offset: vec![0.0; n],
            xs: vec![0.0; all],
            vs: vec![0.0; all],
            half: vec![0.0; system.invariants.len()],
            motion: vec![0.0; evaluation.gradient.len()],
            turned_v: vec![0.0; evaluation.gradient.len()],
            turned_a: vec![0.0; evaluation.gradient.len()],
            row_gradient: vec![0.0; evaluation.gradient.len()],
            error_q: vec![0.0; n],
            error_v: vec![0.0; n],
            allowed: 0.0,
            memory: Vec::new(),
            at_start: evaluation.clone(),
            at_end: evaluation.clone(),
            sampled: evaluation.clone(),
            phi: vec![0.0; r],
            phi_start: vec![0.0; r],
            force: vec![0.0; all],
            responses: vec![Response::default(); system.laws.len() + system.function_rows.len()],
            load_force: vec![0.0; loads],
            delta: vec![0.0; r],
            weight,
            full: vec![0.0; all],
            inertial: vec![0.0; n],
            rows: vec![0.0; r],
            sizes: vec![0.0; evaluation.gradient.len()],
            dense: vec![0.0; 2 * SIZE * SIZE],
            regular: vec![false; r],
            redundant: None,
            changes_rank: false,
            singular: 0,
            spares_regular: false,
            iterations: 0,
            factorizations: 0,
            dissipative: system.laws.iter().any(|law| !law.law.conservative()),
            works: system.is_worked_on(),
            only_gradients: system.has_only_quadratic_rows(),
        };
        system.evaluate_again(&workspace.x0, 0.0, &mut workspace.at_start);
        workspace
    }

    /// Fills δ for the proximal term: ρ = [`RHO`], or what a penalty α in the paper's sense comes to, 1/(ϖα), kept
    /// where it neither softens the rows nor spoils the digits.
    pub fn proximal(&mut self, inertia: f64, penalty: Option<f64>) {
        for (delta, &softness) in self.delta.iter_mut().zip(&self.scales.softness) {
            *delta = match penalty {
                None => softness / RHO,
                Some(alpha) => (1.0 / (inertia * alpha)).clamp(softness / 1e12, softness / 1e8),
            };
        }
    }

    /// The same for iterations that begin without multipliers: hardly any δ for rows that were regular when last factored. Near a
    /// singular position, where the rank changes, redundancy passes from row to row and all have the δ of redundant ones.
    pub fn proximal_of_redundant(&mut self) {
        self.spares_regular = true;
        let is_singular = self.singular > 0;
        self.singular = self.singular.saturating_sub(1);
        for ((delta, &softness), &regular) in self.delta.iter_mut().zip(&self.scales.softness).zip(&self.regular) {
            *delta = softness / if regular && !is_singular { RHO_REGULAR } else { RHO };
        }
    }

    /// Puts the end position of the free nodes where the increment `d` has it, and where a stage looks at them the sampled
    /// position and velocity too. Those of the known nodes are the integrator's to set.
    pub fn place(&mut self, stage: &Stage) {
        let Self { d, x0, x1, a1, drift, .. } = self;
        x1.iter_mut().zip(&*x0).zip(&*d).for_each(|((x1, x0), d)| *x1 = x0 + d);
        if self.level.acceleration != 0.0 {
            a1.iter_mut().zip(&*d).zip(drift).for_each(|((a, d), drift)| *a = (*d - *drift) / stage.inertia);
        }
        if stage.sampling != Sampling::Between || !self.only_gradients {
            self.place_sample(stage);
        }
    }

    /// Puts the sampled position and velocity of the free nodes where the increment `d` has them.
    fn place_sample(&mut self, stage: &Stage) {
        let Self { d, x0, xs, vs, offset, .. } = self;
        let share = stage.share();
        xs.iter_mut().zip(x0).zip(&*d).for_each(|((xs, x0), d)| *xs = *x0 + share * d);
        vs.iter_mut().zip(d).zip(offset).for_each(|((v, d), offset)| *v = stage.rate * *d + *offset);
    }

    /// Whether anything does work on the system from outside its energy.
    pub fn is_worked_on(&self) -> bool {
        self.works
    }

    /// Brings the sampled state to the solution of a stage, and for the balance of work forces and gradients: the last
    /// increment is tiny, so that they are left where nothing does work.
    pub fn settle(&mut self, system: &System, stage: &Stage) {
        self.place_sample(stage);
        if self.works {
            self.place(stage);
            self.evaluate(system, stage);
        }
    }

    /// Subtracts δ and factors the matrix.
    pub fn factor(&mut self) -> Result<(), Failure> {
        self.kkt.regularise(0, &self.delta);
        self.factorizations += 1;
        if let Err(failure) = self.kkt.factor() {
            self.regular.fill(false);
            return Err(failure);
        }
        self.classify_rows(|kkt, row| kkt.solver.pivot(kkt.multiplier(row, 0)));
        Ok(())
    }

    /// Takes note of which rows are redundant by their pivots, and whether that are as many as before.
    fn classify_rows(&mut self, pivot: impl Fn(&Kkt, usize) -> f64) {
        let mut redundant = 0;
        for (row, regular) in self.regular.iter_mut().enumerate() {
            *regular = pivot(&self.kkt, row) - self.delta[row] > REDUNDANT * self.scales.softness[row];
            redundant += usize::from(!*regular);
        }
        self.changes_rank = self.redundant.replace(redundant).is_some_and(|before| before != redundant);
        if self.changes_rank {
            self.singular = SINGULAR;
        }
    }

    /// The same by the matrix of several fields, of which the first is that of the positions.
    pub(super) fn classify_rows_by(&mut self, kkt: &Kkt) {
        self.classify_rows(|_, row| kkt.solver.pivot(kkt.multiplier(row, 0)));
    }

    /// Takes note that rows became redundant, or no longer are, and that δ is to be another.
    pub(super) fn note_rank(&mut self, changes: bool) {
        (self.changes_rank, self.spares_regular) = (changes, true);
    }

    /// Whether the rank turned out to be another one in the last factorisation: rows without a proximal term to speak of may have
    /// become redundant, whose pivots are round-off. Gives them one.
    pub(super) fn guards_rank(&mut self) -> bool {
        let guards = std::mem::take(&mut self.changes_rank) && self.spares_regular;
        if guards {
            self.proximal_of_redundant();
        }
        guards
    }

    /// Replaces the residual in `unknowns` by the solution.
    pub fn solve(&mut self) -> Result<(), Failure> {
        self.kkt.solve(&mut self.unknowns);
        if self.unknowns.iter().all(|u| u.is_finite()) { Ok(()) } else { Err(Failure::NotFinite) }
    }

    /// How far multipliers, of the size of ϖλ, would move a node of their row, over the size of the mechanism: the largest.
    pub fn scaled_multipliers(&self, multipliers: impl IntoIterator<Item = f64>) -> f64 {
        let scaled = multipliers.into_iter().zip(&self.scales.reach).map(|(mu, reach)| mu.abs() * reach);
        scaled.fold(0.0, f64::max)
    }

    /// How far forces on the free nodes (kg·m) would move those that they move farthest, each by its own mass, m.
    pub(super) fn farthest(&self, system: &System, force: &[f64]) -> f64 {
        let nodes = force.chunks_exact(system.dim).zip(&self.scales.agility);
        nodes.map(|(force, agility)| agility * largest(force)).fold(0.0, f64::max)
    }

    /// What the tangent's multipliers are off by after a step of them by `mu` (r), in the same units; from here on they are
    /// those of the iteration.
    pub(super) fn turned(&mut self, inertia: f64, first: usize) -> f64 {
        let steps = self.unknowns[first..].iter().zip(&self.lambda_change).map(|(mu, change)| mu - inertia * change);
        let turned = self.scaled_multipliers(steps);
        self.lambda_change.fill(0.0);
        turned
    }

    /// Has the multipliers at hand, as they are expected to change, for the first tangent only, and starts from none: what
    /// redundant rows leave undetermined of them would add up from step to step.
    pub(super) fn expect_multipliers(&mut self) {
        for (lambda, change) in self.lambda.iter_mut().zip(&mut self.lambda_change) {
            *change += std::mem::take(lambda);
        }
    }

    /// The tangent at the multipliers that are expected.
    pub(super) fn expected_tangent(&mut self, system: &System, stage: &Stage) {
        self.shift_multipliers(1.0);
        self.tangent(system, stage, 1.0);
        self.shift_multipliers(-1.0);
    }

    fn shift_multipliers(&mut self, sign: f64) {
        self.lambda.iter_mut().zip(&self.lambda_change).for_each(|(lambda, change)| *lambda += sign * change);
    }

    /// Largest |Φ_k| in units of length: each row over its own gradient.
    pub fn scaled_violation(&self) -> f64 {
        let scaled = self.phi.iter().zip(&self.scales.gradient).map(|(phi, scale)| phi.abs() / scale);
        scaled.fold(0.0, f64::max) / self.scales.length
    }
}
