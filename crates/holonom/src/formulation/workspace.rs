//! Everything mutable of a step: positions, evaluations, forces and the matrix, allocated once.

use super::kkt::{Block, Kkt};
use super::stage::{RowsAt, Sampling, Stage};
use crate::system::{Between, Evaluation, LoadEntry, MAX_ARGUMENTS, Reach, Response, SIZE, System, gather};

/// Share of the rows' own stiffness that the proximal term may soften: δ = (G M⁻¹ Gᵀ)/ρ (methods §1.2, §11).
pub const RHO: f64 = 1e10;

/// Scratch of a stage. Full vectors hold D numbers a node, free nodes first.
pub struct Workspace {
    pub kkt: Kkt,
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
    pub responses: Vec<Response>,
    /// Forces of the loads (D × their nodes, one after the other), N.
    pub load_force: Vec<f64>,
    /// Residual and solution of the linear system.
    pub unknowns: Vec<f64>,
    /// Size of each row of G M⁻¹ Gᵀ (r), 1/kg in the row's units.
    pub softness: Vec<f64>,
    pub delta: Vec<f64>,
    /// −M g (full), N.
    pub weight: Vec<f64>,
    /// ½ vᵀ H v and H v of the invariants at the sampled velocity.
    pub half: Vec<f64>,
    pub motion: Vec<f64>,
    /// Full and reduced scratch vectors.
    pub full: Vec<f64>,
    pub inertial: Vec<f64>,
    pub rows: Vec<f64>,
    dense: Vec<f64>,
    /// Largest distance between nodes at the start, m: the unit of increments.
    pub length: f64,
    /// Largest diagonal entry of the mass matrix, kg: the unit of momentum residuals.
    pub heaviest: f64,
    /// Factorisations so far.
    pub factorizations: u64,
    dissipative: bool,
    /// Whether anything does work on the system from outside its energy.
    works: bool,
}

impl Workspace {
    /// Allocates everything for a system.
    pub fn new(system: &System) -> Self {
        let (n, r, all) = (system.coordinates(), system.constraints(), system.nodes() * system.dim);
        let kkt = Kkt::new(system, 1);
        let evaluation = system.evaluation();
        let mut weight = vec![0.0; all];
        for (a, weight) in weight.chunks_exact_mut(system.dim).enumerate() {
            (0..system.dim).for_each(|c| weight[c] = -system.weighing[a] * system.gravity[c]);
        }
        let loads: usize = system.loads.iter().map(|load| load.nodes.len() * system.dim).sum();
        let mut workspace = Self {
            unknowns: vec![0.0; kkt.size()],
            kkt,
            x0: system.start_position.clone(),
            v0: system.start_velocity.clone(),
            d: vec![0.0; n],
            lambda: vec![0.0; r],
            x1: vec![0.0; all],
            v1: vec![0.0; all],
            a1: vec![0.0; all],
            drift: vec![0.0; n],
            offset: vec![0.0; n],
            xs: vec![0.0; all],
            vs: vec![0.0; all],
            half: vec![0.0; system.invariants.len()],
            motion: vec![0.0; evaluation.gradient.len()],
            at_start: evaluation.clone(),
            at_end: evaluation.clone(),
            sampled: evaluation,
            phi: vec![0.0; r],
            phi_start: vec![0.0; r],
            force: vec![0.0; all],
            responses: vec![Response::default(); system.laws.len()],
            load_force: vec![0.0; loads],
            softness: vec![1.0; r],
            delta: vec![0.0; r],
            weight,
            full: vec![0.0; all],
            inertial: vec![0.0; n],
            rows: vec![0.0; r],
            dense: vec![0.0; 2 * SIZE * SIZE],
            length: extent(system),
            heaviest: (0..system.free).map(|a| system.mass.diagonal(a)).fold(0.0, f64::max),
            factorizations: 0,
            dissipative: system.laws.iter().any(|law| !law.law.conservative()),
            works: system.is_worked_on(),
        };
        system.evaluate(&workspace.x0, 0.0, &mut workspace.at_start);
        workspace.measure_softness(system);
        workspace
    }

    /// G M⁻¹ Gᵀ with the mass lumped at the nodes, row by row, at the evaluation of the start. Rows whose gradient
    /// happens to vanish there get a millionth of the largest.
    fn measure_softness(&mut self, system: &System) {
        let dim = system.dim;
        for (row, slots) in self.kkt.row_slots.iter().enumerate() {
            self.softness[row] = 0.0;
            for s in slots.clone() {
                let node = self.kkt.slot_nodes[s] as usize;
                if node < system.free {
                    let lumped: f64 = system.mass.row(node).map(|(_, m)| m).sum();
                    let square: f64 = self.at_start.gradient[s * dim..s * dim + dim].iter().map(|g| g * g).sum();
                    self.softness[row] += square / lumped;
                }
            }
        }
        let largest = self.softness.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        self.softness.iter_mut().for_each(|s| *s = s.max(1e-6 * largest));
    }

    /// Fills δ for the proximal term: ρ = [`RHO`], or what a penalty α in the paper's sense comes to, 1/(ϖα), kept
    /// where it neither softens the rows nor spoils the digits.
    pub fn proximal(&mut self, inertia: f64, penalty: Option<f64>) {
        for (delta, &softness) in self.delta.iter_mut().zip(&self.softness) {
            *delta = match penalty {
                None => softness / RHO,
                Some(alpha) => (1.0 / (inertia * alpha)).clamp(softness / 1e12, softness / 1e8),
            };
        }
    }

    /// Puts the sampled position and velocity, and the end position, of the free nodes where the increment `d` has
    /// them. Those of the known nodes are the integrator's to set.
    pub fn place(&mut self, system: &System, stage: &Stage) {
        let n = system.coordinates();
        for i in 0..n {
            self.x1[i] = self.x0[i] + self.d[i];
            self.vs[i] = stage.rate * self.d[i] + self.offset[i];
        }
        let share = stage.share();
        for i in 0..n {
            self.xs[i] = self.x0[i] + share * self.d[i];
        }
    }

    /// Brings forces and gradients to the solution of a stage, for the balance of work. The last increment is tiny, so
    /// this is left out where nothing does work.
    pub fn settle(&mut self, system: &System, stage: &Stage) {
        if self.works {
            self.place(system, stage);
            self.evaluate(system, stage);
        }
    }

    /// Evaluates rows, laws and loads of a stage; leaves Φ in `phi` and the sum of forces in `force`.
    pub fn evaluate(&mut self, system: &System, stage: &Stage) {
        let Self { at_start, at_end, sampled, .. } = self;
        match stage.sampling {
            Sampling::End => {
                system.evaluate(&self.x1, stage.end(), at_end);
                sampled.copy_from(at_end);
            }
            Sampling::Middle => system.evaluate(&self.xs, stage.time(), sampled),
            Sampling::Between => {
                system.evaluate(&self.x1, stage.end(), at_end);
                let span = Between { from: &self.x0, to: &self.x1, start: stage.start, step: stage.step };
                system.evaluate_between(span, at_start, at_end, sampled);
            }
        }
        match stage.rows {
            RowsAt::Middle => system.constraint_values(sampled, stage.time(), &mut self.phi),
            RowsAt::End => system.constraint_values(at_end, stage.end(), &mut self.phi),
            RowsAt::Mean => {
                system.constraint_values(at_end, stage.end(), &mut self.phi);
                self.phi.iter_mut().zip(&self.phi_start).for_each(|(phi, start)| *phi = 0.5 * (*phi + start));
            }
        }
        self.sum_forces(system, stage);
    }

    /// Sums gravity, laws, loads and λᵀG at the sampled state into `force`.
    fn sum_forces(&mut self, system: &System, stage: &Stage) {
        let dim = system.dim;
        self.force.copy_from_slice(&self.weight);
        self.respond(system, stage);
        for (law, response) in system.laws.iter().zip(&self.responses) {
            for (k, &id) in law.invariants.iter().enumerate() {
                for s in system.invariants.slots_of(id) {
                    let node = self.kkt.slot_nodes[s] as usize * dim;
                    for c in 0..dim {
                        self.force[node + c] += response.force[k] * self.sampled.gradient[s * dim + c];
                    }
                }
            }
        }
        let mut first = 0;
        for load in &system.loads {
            let width = load.nodes.len() * dim;
            let (x, v) = self.load_arguments(system, load);
            load.load.force(&x[..width], &v[..width], stage.time(), &mut self.load_force[first..first + width]);
            for (k, node) in load.nodes.iter().enumerate().filter(|(_, node)| node.index() < system.free) {
                for c in 0..dim {
                    self.force[node.index() * dim + c] -= self.load_force[first + k * dim + c];
                }
            }
            first += width;
        }
        for (slots, &lambda) in self.kkt.row_slots.iter().zip(&self.lambda) {
            for s in slots.clone() {
                let node = self.kkt.slot_nodes[s] as usize * dim;
                for c in 0..dim {
                    self.force[node + c] += lambda * self.sampled.gradient[s * dim + c];
                }
            }
        }
    }

    /// Responses of all laws at the sampled state.
    fn respond(&mut self, system: &System, stage: &Stage) {
        if self.dissipative && stage.sampling != Sampling::Between {
            system.invariants.curvature(&self.vs, &mut self.half, &mut self.motion);
        }
        for (law, response) in system.laws.iter().zip(&mut self.responses) {
            *response = Response::default();
            let m = law.invariants.len();
            let pick = |values: &[f64]| -> [f64; MAX_ARGUMENTS] {
                let mut picked = [0.0; MAX_ARGUMENTS];
                law.invariants.iter().zip(&mut picked).for_each(|(id, out)| *out = values[id.0 as usize]);
                picked
            };
            if stage.sampling == Sampling::Between {
                let (from, to) = (pick(&self.at_start.value), pick(&self.at_end.value));
                let reach = Reach { from: &from[..m], to: &to[..m], step: stage.step, middle: stage.time() };
                law.law.between(reach, response);
            } else {
                let value = pick(&self.sampled.value);
                let mut rate = [0.0; MAX_ARGUMENTS];
                if !law.law.conservative() {
                    for (rate, &id) in rate.iter_mut().zip(&law.invariants) {
                        *rate = system.along(&system.invariants.slots_of(id), &self.kkt.slot_nodes, &self.sampled, &self.vs);
                    }
                }
                law.law.at(&value[..m], &rate[..m], stage.time(), response);
            }
        }
    }

    /// Sampled positions and velocities of a load's nodes.
    fn load_arguments(&self, system: &System, load: &LoadEntry) -> ([f64; SIZE], [f64; SIZE]) {
        let (mut x, mut v) = ([0.0; SIZE], [0.0; SIZE]);
        gather(system.dim, &load.nodes, &self.xs, &mut x);
        gather(system.dim, &load.nodes, &self.vs, &mut v);
        (x, v)
    }

    /// Writes minus the residual of the stage to `unknowns`: ϖ(M a + f) for the coordinates, Φ for the rows.
    pub fn residual(&mut self, system: &System, stage: &Stage) {
        let n = system.coordinates();
        for i in 0..n {
            self.full[i] = self.d[i] - self.drift[i];
        }
        for i in n..self.full.len() {
            self.full[i] = stage.inertia * self.a1[i];
        }
        system.mass.times(system.dim, &self.full, &mut self.inertial);
        for i in 0..n {
            self.unknowns[i] = -(self.inertial[i] + stage.inertia * self.force[i]);
        }
        for (unknown, phi) in self.unknowns[n..].iter_mut().zip(&self.phi) {
            *unknown = -phi;
        }
    }

    /// Assembles the tangent of the stage without its proximal term. `geometric` is 1 for the full tangent and 0 for
    /// that of Gauss and Newton, which leaves out the curvature of the rows.
    pub fn tangent(&mut self, system: &System, stage: &Stage, geometric: f64) {
        let share = stage.share();
        let weight = stage.inertia * share;
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        if geometric != 0.0 {
            self.kkt.add_row_hessians(Block(0, 0), &self.lambda, geometric * weight);
            self.add_custom_hessians(system, stage, geometric * weight);
        }
        self.add_laws(system, stage);
        self.add_loads(system, stage);
        self.kkt.write_sum(Block(0, 0));
        self.kkt.add_columns(Block(0, 0), &self.sampled.gradient, 1.0);
        let (gradient, factor) = match stage.rows {
            RowsAt::End => (&self.at_end.gradient, 1.0),
            RowsAt::Mean => (&self.at_end.gradient, 0.5),
            RowsAt::Middle => (&self.sampled.gradient, 0.5),
        };
        self.kkt.add_rows(Block(0, 0), gradient, factor);
    }

    /// Adds the tangents of all laws, times ϖ.
    pub fn add_laws(&mut self, system: &System, stage: &Stage) {
        let (inertia, share) = (stage.inertia, stage.share());
        for law in 0..system.laws.len() {
            let response = &self.responses[law];
            let dissipates = self.dissipative && !system.laws[law].law.conservative();
            let (right, by, turning) = match stage.sampling {
                Sampling::Between => (&self.at_end.gradient, [inertia, 0.0], 0.0),
                _ if dissipates => (&self.sampled.gradient, [inertia * share, inertia * stage.rate], inertia * share),
                _ => (&self.sampled.gradient, [inertia * share, 0.0], 0.0),
            };
            self.kkt.add_law(law, response, inertia * share, &self.sampled.gradient, right, by, (&self.motion, turning));
        }
    }

    /// Adds the tangents of all loads, times ϖ.
    pub fn add_loads(&mut self, system: &System, stage: &Stage) {
        for (k, load) in system.loads.iter().enumerate() {
            let width = load.nodes.len() * system.dim;
            let (x, v) = self.load_arguments(system, load);
            let (by_position, by_velocity) = self.dense.split_at_mut(SIZE * SIZE);
            let (by_position, by_velocity) = (&mut by_position[..width * width], &mut by_velocity[..width * width]);
            by_position.fill(0.0);
            by_velocity.fill(0.0);
            load.load.tangent(&x[..width], &v[..width], stage.time(), by_position, by_velocity);
            self.kkt.add_load(k, by_position, -stage.inertia * stage.share());
            self.kkt.add_load(k, by_velocity, -stage.inertia * stage.rate);
        }
    }

    fn add_custom_hessians(&mut self, system: &System, stage: &Stage, factor: f64) {
        let mut first = system.rows.len();
        for (k, entry) in system.custom.iter().enumerate() {
            let rows = entry.rows.rows();
            let mut x = [0.0; SIZE];
            let width = gather(system.dim, &entry.nodes, &self.xs, &mut x);
            let hessian = &mut self.dense[..width * width];
            entry.rows.hessian(&x[..width], stage.time(), &self.lambda[first..first + rows], hessian);
            self.kkt.add_custom(k, hessian, factor);
            first += rows;
        }
    }

    /// Responses of all laws at the end of the step, whatever was sampled before.
    pub fn respond_at_end(&mut self, system: &System, stage: &Stage) {
        self.xs.copy_from_slice(&self.x1);
        self.vs.copy_from_slice(&self.v1);
        self.sampled.copy_from(&self.at_end);
        self.respond(system, stage);
    }

    /// Samples forces at the end position with the multipliers as they are, and evaluates there.
    pub fn sample_end(&mut self, system: &System, time: f64) {
        system.evaluate(&self.x1, time, &mut self.at_end);
        self.sampled.copy_from(&self.at_end);
        self.xs.copy_from_slice(&self.x1);
        self.vs.copy_from_slice(&self.v1);
        let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start: time, step: 0.0, inertia: 1.0, rate: 0.0 };
        self.sum_forces(system, &stage);
    }

    /// Leaves Φ̈ at the sampled position, with the accelerations `a1`, in `rows`.
    pub fn sampled_acceleration_violation(&mut self, system: &System, time: f64) {
        system.constraint_curvatures(&self.xs, &self.vs, time, &mut self.half, &mut self.motion, &mut self.rows);
        for (row, slots) in self.rows.iter_mut().zip(&self.kkt.row_slots) {
            *row += system.along(slots, &self.kkt.slot_nodes, &self.sampled, &self.a1);
        }
    }

    /// Leaves Φ̇ at the end of the step in `rows`.
    pub fn rate_violation(&mut self, system: &System, time: f64) {
        system.constraint_rates(&self.kkt.row_slots, &self.kkt.slot_nodes, &self.at_end, &self.v1, time, &mut self.rows);
    }

    /// Leaves Φ̈ at the end of the step in `rows`.
    pub fn acceleration_violation(&mut self, system: &System, time: f64) {
        system.constraint_curvatures(&self.x1, &self.v1, time, &mut self.half, &mut self.motion, &mut self.rows);
        for (row, slots) in self.rows.iter_mut().zip(&self.kkt.row_slots) {
            *row += system.along(slots, &self.kkt.slot_nodes, &self.at_end, &self.a1);
        }
    }

    /// Subtracts δ, factors, and solves for the `unknowns`. False when the matrix cannot be factored or the solution
    /// is not finite.
    pub fn solve(&mut self) -> bool {
        self.kkt.regularise(0, &self.delta);
        self.factorizations += 1;
        if self.kkt.factor().is_err() {
            return false;
        }
        self.kkt.solver.solve(&mut self.unknowns);
        self.unknowns.iter().all(|u| u.is_finite())
    }

    /// Largest multiplier in units of mass × length: each times its row's own gradient.
    pub fn scaled_multipliers<'a>(&self, multipliers: impl IntoIterator<Item = &'a f64>) -> f64 {
        let scaled = multipliers.into_iter().zip(&self.softness).map(|(mu, softness)| mu.abs() * (softness * self.heaviest).sqrt());
        scaled.fold(0.0, f64::max) / (self.heaviest * self.length)
    }

    /// Largest |Φ_k| in units of length: each row over its own gradient.
    pub fn scaled_violation(&self) -> f64 {
        let scaled = self.phi.iter().zip(&self.softness).map(|(phi, softness)| phi.abs() / (softness * self.heaviest).sqrt());
        scaled.fold(0.0, f64::max) / self.length
    }
}

/// Diagonal of the box around all nodes at the start, at least one millimetre.
fn extent(system: &System) -> f64 {
    let mut square = 0.0;
    for c in 0..system.dim {
        let along = system.start_position.iter().skip(c).step_by(system.dim);
        let (low, high) = along.fold((0.0, 0.0), |(low, high): (f64, f64), &x| (low.min(x), high.max(x)));
        square += (high - low) * (high - low);
    }
    square.sqrt().max(1e-3)
}
