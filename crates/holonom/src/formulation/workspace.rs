//! Everything of a step but its matrix: states, rows and forces, allocated once.

use super::dampers::Damping;
use super::kkt::Kkt;
use super::level::Level;
use super::scales::Scales;
use super::stage::{Sampling, Stage};
use crate::linalg::largest;
use crate::system::{Evaluation, Response, Seen, System};

/// A state of the step. Full vectors hold D numbers a node, free nodes first, known nodes in place.
pub struct Moment {
    /// Positions (full), m.
    pub x: Vec<f64>,
    /// Velocities (full), m/s.
    pub v: Vec<f64>,
    /// Values and gradients of invariants and rows there.
    pub at: Evaluation,
}

impl Moment {
    fn new(system: &System) -> Self {
        let all = system.nodes() * system.dim;
        Self { x: vec![0.0; all], v: vec![0.0; all], at: system.evaluation() }
    }

    pub(super) fn copy_from(&mut self, other: &Self) {
        self.x.copy_from_slice(&other.x);
        self.v.copy_from_slice(&other.v);
        self.at.copy_from(&other.at);
    }
}

/// What an integrator expects of a step and what it makes of the increment.
pub struct Prediction {
    /// Part of the increment that needs no acceleration (n), m.
    pub drift: Vec<f64>,
    /// Part of the sampled velocity that does not depend on the increment (n), m/s.
    pub offset: Vec<f64>,
    /// Predicted change of the accelerations over the step (full), m/s².
    pub a_change: Vec<f64>,
    /// Expected change of the multipliers (r). The first tangent of a step has it; the iteration starts without it, as what
    /// redundant rows leave undetermined of the multipliers would run away.
    pub lambda_change: Vec<f64>,
}

/// Forces at the sampled state.
pub struct Forces {
    /// Sum of the gradients of laws, rows, gravity and minus the loads (full), N.
    pub sum: Vec<f64>,
    /// −M g (full), N.
    pub weight: Vec<f64>,
    /// Responses of the laws, then of the rows that are functions of invariants, by the invariants they depend on.
    pub responses: Vec<Response>,
    /// Forces of the loads (D × their nodes, one after the other), N.
    pub of_loads: Vec<f64>,
    /// H v of the invariants at the sampled velocity.
    pub motion: Vec<f64>,
    pub(super) dense: Vec<f64>,
    pub(super) dissipative: bool,
    /// Of each law, where it is dissipative.
    pub(super) damping: Vec<Damping>,
}

impl Forces {
    /// Whether a law, by its number, takes its rates later than in the middle of the step.
    pub(crate) fn is_late(&self, law: usize) -> bool {
        self.damping[law].is_late()
    }
}

/// How gradients turn with a motion, D a slot.
pub struct Turned {
    /// H v and H a of all rows' slots.
    pub v: Vec<f64>,
    pub a: Vec<f64>,
    /// Gradients of the rows by the increment, where some hold velocities only.
    pub(super) rows: Vec<f64>,
    /// ½ vᵀ H v of the invariants.
    pub half: Vec<f64>,
}

/// Local errors of a step, where an integrator estimates them.
pub struct LocalErrors {
    /// Of position (n), m, and velocity (n), m/s.
    pub q: Vec<f64>,
    pub v: Vec<f64>,
    /// What these errors make of the energy, where an integrator says it, and what rounding makes of that, J.
    pub energy: f64,
    pub rounded: f64,
    /// Largest velocity that loads would make more or less in the step by what they are at its ends than they made, m/s.
    pub loads: f64,
    /// Those that are allowed, over the size of the mechanism and the step, 1/s, where steps follow from an accuracy.
    pub allowed: f64,
    /// The unit of errors of velocity, m/s.
    pub speed: f64,
    /// What forces that bend depend on at the stages between the ends of the step, of explicit methods whose steps follow from an accuracy.
    pub(crate) stages: Vec<Seen>,
}

/// A step as it is tried.
pub struct Workspace {
    /// What numbers of different nodes and rows are compared by.
    pub scales: Scales,
    /// The condition that the rows of a stage stand for.
    pub level: Level,
    /// Where the step begins.
    pub start: Moment,
    /// Where it ends.
    pub end: Moment,
    /// Where forces are taken.
    pub sampled: Moment,
    /// Acceleration (full), the known nodes' in place.
    pub a: Vec<f64>,
    /// Increment of the free coordinates (n), m.
    pub d: Vec<f64>,
    /// Multipliers λ (r).
    pub lambda: Vec<f64>,
    /// What the integrator expects of the step.
    pub prediction: Prediction,
    /// Forces where they are taken.
    pub forces: Forces,
    /// How gradients turn with velocities and accelerations.
    pub turned: Turned,
    /// Φ as the stage enforces it (r).
    pub phi: Vec<f64>,
    /// Φ at the start of the step (r).
    pub phi_start: Vec<f64>,
    /// Local errors of the step, where the integrator estimates them.
    pub estimate: LocalErrors,
    /// Numbers from outside.
    pub inputs: Vec<f64>,
    /// Numbers that an integrator keeps from step to step.
    pub memory: Vec<f64>,
    /// Scratch of all coordinates (full).
    pub full: Vec<f64>,
    /// Velocities (full), m/s, that are put back after others were tried; zeros where what stands still is looked at.
    pub(super) kept_v: Vec<f64>,
    /// Scratch of the free coordinates (n).
    pub inertial: Vec<f64>,
    /// Scratch of the rows (r), in which their violation is left.
    pub rows: Vec<f64>,
    /// Sizes of gradients (D a slot).
    pub(super) sizes: Vec<f64>,
    /// What each of the system's workers has done in the step so far, J.
    pub shares: Vec<f64>,
    /// The power of each of them where it was found last, W.
    pub powers: Vec<f64>,
    /// Multipliers of the last projections of velocities and of accelerations (r each).
    pub impulses: [Vec<f64>; 2],
    works: bool,
    /// Whether a stage between two positions looks at their gradients and nothing else.
    only_gradients: bool,
}

impl Workspace {
    /// Allocates everything for a system.
    pub fn new(system: &System) -> Self {
        let (n, r, all) = (system.coordinates(), system.constraints(), system.nodes() * system.dim);
        let slots = system.slots.nodes.len() * system.dim;
        let mut weight = vec![0.0; all];
        for (a, weight) in weight.chunks_exact_mut(system.dim).enumerate() {
            let ([m, s], g) = (system.weighing[a], system.gravity);
            (0..system.dim).for_each(|c| weight[c] = -m * g[c]);
            weight[0] -= s * g[1];
            weight[1] += s * g[0];
        }
        let loads: usize = system.loads.iter().map(|load| load.nodes.len() * system.dim).sum();
        let mut start = Moment::new(system);
        start.x.copy_from_slice(&system.start_position);
        start.v.copy_from_slice(&system.start_velocity);
        system.evaluate_again(&start.x, 0.0, &mut start.at);
        let custom = system.custom.iter().map(|custom| 2 * (custom.nodes.len() * system.dim).pow(2));
        let dense = system.loads.iter().map(|load| load.room(system.dim)).chain(custom).max().unwrap_or(0);
        Self {
            scales: Scales::new(system),
            level: Level::POSITION,
            start,
            end: Moment::new(system),
            sampled: Moment::new(system),
            a: vec![0.0; all],
            d: vec![0.0; n],
            lambda: vec![0.0; r],
            prediction: Prediction { drift: vec![0.0; n], offset: vec![0.0; n], a_change: vec![0.0; all], lambda_change: vec![0.0; r] },
            forces: Forces {
                sum: vec![0.0; all],
                weight,
                responses: vec![Response::default(); system.laws.len() + system.function_rows.len()],
                of_loads: vec![0.0; loads],
                motion: vec![0.0; slots],
                dense: vec![0.0; dense],
                damping: vec![Damping::default(); system.laws.len()],
                dissipative: system.laws.iter().any(|law| !law.law.conservative())
                    || system.loads.iter().any(|load| !load.reading.senses.is_empty()),
            },
            turned: Turned { v: vec![0.0; slots], a: vec![0.0; slots], rows: vec![0.0; slots], half: vec![0.0; system.invariants.len()] },
            phi: vec![0.0; r],
            phi_start: vec![0.0; r],
            estimate: LocalErrors {
                q: vec![0.0; n],
                v: vec![0.0; n],
                energy: 0.0,
                rounded: 0.0,
                loads: 0.0,
                allowed: 0.0,
                speed: f64::INFINITY,
                stages: Vec::new(),
            },
            inputs: system.inputs.iter().map(|(_, default)| *default).collect(),
            memory: Vec::new(),
            full: vec![0.0; all],
            kept_v: vec![0.0; all],
            inertial: vec![0.0; n],
            rows: vec![0.0; r],
            sizes: vec![0.0; slots],
            shares: vec![0.0; system.workers().count()],
            powers: vec![0.0; system.workers().count()],
            impulses: [vec![0.0; r], vec![0.0; r]],
            works: system.is_worked_on(),
            only_gradients: system.has_only_quadratic_rows(),
        }
    }

    /// Gives back the room of what steps need beside the forces of rows at the end: it can take none after that.
    pub(crate) fn leave_steps(&mut self) {
        let Self { start, sampled, d, prediction, turned, forces, phi_start, estimate, inertial, sizes, .. } = self;
        *sampled = Moment { x: Vec::new(), v: Vec::new(), at: Evaluation::default() };
        // Angles at the end are counted from those at the start.
        *start = Moment {
            at: Evaluation { functions: std::mem::take(&mut start.at.functions), ..Evaluation::default() },
            x: Vec::new(),
            v: Vec::new(),
        };
        let of_steps = [&mut prediction.drift, &mut prediction.offset, &mut prediction.a_change, &mut prediction.lambda_change];
        let of_tangents = [&mut forces.motion, &mut turned.v, &mut turned.a, &mut turned.rows];
        let others = [d, phi_start, inertial, sizes, &mut estimate.q, &mut estimate.v];
        of_steps.into_iter().chain(of_tangents).chain(others).for_each(|numbers| *numbers = Vec::new());
    }

    /// Puts the end position of the free nodes where the increment `d` has it, and where a stage looks at them the sampled
    /// position and velocity too. Those of the known nodes are the integrator's to set.
    pub fn place(&mut self, stage: &Stage) {
        let Self { d, start, end, a, prediction, .. } = self;
        end.x.iter_mut().zip(&start.x).zip(&*d).for_each(|((x1, x0), d)| *x1 = x0 + d);
        if self.level.acceleration != 0.0 {
            a.iter_mut().zip(&*d).zip(&prediction.drift).for_each(|((a, d), drift)| *a = (*d - *drift) / stage.inertia);
        }
        if stage.sampling != Sampling::Between || !self.only_gradients {
            self.place_sample(stage);
        }
    }

    /// Puts the sampled position and velocity of the free nodes where the increment `d` has them.
    fn place_sample(&mut self, stage: &Stage) {
        let Self { d, start, sampled, prediction, .. } = self;
        let share = stage.share();
        sampled.x.iter_mut().zip(&start.x).zip(&*d).for_each(|((xs, x0), d)| *xs = *x0 + share * d);
        sampled.v.iter_mut().zip(d).zip(&prediction.offset).for_each(|((v, d), offset)| *v = stage.rate * *d + *offset);
    }

    /// Whether anything does work on the system from outside its energy.
    pub fn is_worked_on(&self) -> bool {
        self.works
    }

    /// Adds the powers that were found last, times a number, to what the workers have done in the step.
    pub fn book_powers(&mut self, time: f64) {
        self.shares.iter_mut().zip(&self.powers).for_each(|(share, power)| *share += time * power);
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

    /// How far multipliers, of the size of ϖλ, would move a node of their row, over the size of the mechanism: the largest.
    pub fn scaled_multipliers(&self, multipliers: impl IntoIterator<Item = f64>) -> f64 {
        let scaled = multipliers.into_iter().zip(&self.scales.reach).map(|(mu, reach)| mu.abs() * reach);
        scaled.fold(0.0, f64::max)
    }

    /// How far forces on the free nodes (kg·m) would move those that they move farthest, each by its own mass, m.
    pub fn farthest(&self, system: &System, force: &[f64]) -> f64 {
        let nodes = force.chunks_exact(system.dim).zip(&self.scales.agility);
        nodes.map(|(force, agility)| agility * largest(force)).fold(0.0, f64::max)
    }

    /// What the tangent's multipliers are off by after a step of them by `mu` (r), in the same units; from here on they are
    /// those of the iteration.
    pub(super) fn turned(&mut self, inertia: f64, mu: &[f64]) -> f64 {
        let steps = mu.iter().zip(&self.prediction.lambda_change).map(|(mu, change)| mu - inertia * change);
        let turned = self.scaled_multipliers(steps);
        self.prediction.lambda_change.fill(0.0);
        turned
    }

    /// Starts from the multipliers at hand, as they are expected to change, where they `have_one_solution`. Otherwise has those for
    /// the first tangent only, and starts from none: what redundant rows leave undetermined of them would add up from step to step.
    pub(super) fn expect_multipliers(&mut self, have_one_solution: bool) {
        for (lambda, change) in self.lambda.iter_mut().zip(&mut self.prediction.lambda_change) {
            let expected = std::mem::take(lambda) + std::mem::take(change);
            *(if have_one_solution { lambda } else { change }) = expected;
        }
    }

    /// Whether rows are all that bends, each with constant second derivatives, and no point is light.
    pub(super) fn are_rows_quadratic(&self) -> bool {
        self.only_gradients && !self.scales.are_points_light
    }

    /// The tangent at the multipliers that are expected.
    pub(super) fn expected_tangent(&mut self, system: &System, stage: &Stage, kkt: &mut Kkt) {
        self.shift_multipliers(1.0);
        self.tangent(system, stage, 1.0, kkt);
        self.shift_multipliers(-1.0);
    }

    fn shift_multipliers(&mut self, sign: f64) {
        self.lambda.iter_mut().zip(&self.prediction.lambda_change).for_each(|(lambda, change)| *lambda += sign * change);
    }

    /// Largest |Φ_k| in units of length: each row over its own gradient.
    pub fn scaled_violation(&self) -> f64 {
        self.scaled(&self.phi) / self.scales.length
    }

    /// The largest of some numbers of the rows, each over the size of its row's gradient.
    pub fn scaled(&self, rows: &[f64]) -> f64 {
        rows.iter().zip(&self.scales.gradient).map(|(row, scale)| row.abs() / scale).fold(0.0, f64::max)
    }
}
