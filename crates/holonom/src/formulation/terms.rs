//! The terms of a stage: rows, laws, loads and inertia, their residual and their tangent.

use super::kkt::{Block, LawFactors};
use super::level::Level;
use super::stage::{RowsAt, Sampling, Stage};
use super::workspace::Workspace;
use crate::system::{Between, LoadEntry, MAX_ARGUMENTS, Quantity, Reach, Response, SIZE, System, gather, scatter};

impl Workspace {
    /// Evaluates rows, laws and loads of a stage; leaves Φ in `phi` and the sum of forces in `force`.
    pub fn evaluate(&mut self, system: &System, stage: &Stage) {
        let Self { at_start, at_end, sampled, .. } = self;
        let near = &*at_start;
        match stage.sampling {
            Sampling::End => {
                system.evaluate(&self.x1, stage.end(), near, at_end);
                sampled.copy_from(at_end);
            }
            Sampling::Middle => system.evaluate(&self.xs, stage.time(), near, sampled),
            Sampling::Start => {
                system.evaluate(&self.x1, stage.end(), near, at_end);
                sampled.copy_from(at_start);
            }
            Sampling::Between => {
                system.evaluate(&self.x1, stage.end(), near, at_end);
                let span = Between { from: &self.x0, to: &self.x1, start: stage.start, step: stage.step };
                system.evaluate_between(span, at_start, at_end, sampled);
            }
        }
        self.violate(system, stage);
        self.sum_forces(system, stage);
    }

    /// Leaves what the rows of the stage stand for in `phi`, in the units of Φ.
    fn violate(&mut self, system: &System, stage: &Stage) {
        if self.level != Level::POSITION {
            self.weigh_levels(system, stage.time(), self.level.scale(stage.rate, stage.inertia));
            return;
        }
        match stage.rows {
            RowsAt::Middle => system.constraint_values(&self.sampled, stage.time(), &mut self.phi),
            RowsAt::End => system.constraint_values(&self.at_end, stage.end(), &mut self.phi),
            RowsAt::Mean => {
                system.constraint_values(&self.at_end, stage.end(), &mut self.phi);
                self.phi.iter_mut().zip(&self.phi_start).for_each(|(phi, start)| *phi = 0.5 * (*phi + start));
            }
        }
        self.violate_velocity_rows(system, stage);
    }

    /// Leaves the weighted sum of Φ̈, Φ̇ and Φ at the sampled state, with the accelerations `a1`, times `scale` in `phi`.
    pub fn weigh_levels(&mut self, system: &System, t: f64, scale: f64) {
        let level = self.level;
        system.constraint_values(&self.sampled, t, &mut self.phi);
        self.phi.iter_mut().for_each(|phi| *phi *= scale * level.position);
        if level.velocity != 0.0 {
            system.constraint_rates(&system.slots.by_row, &self.sampled, &self.vs, t, &mut self.rows);
            self.phi.iter_mut().zip(&self.rows).for_each(|(phi, rate)| *phi += scale * level.velocity * rate);
        }
        if level.acceleration != 0.0 {
            self.sampled_acceleration_violation(system, t);
            self.phi.iter_mut().zip(&self.rows).for_each(|(phi, row)| *phi += scale * level.acceleration * row);
        }
    }

    /// H v and H a of all rows at the sampled state.
    pub fn turn(&mut self, system: &System, t: f64) {
        let Self { sampled, half, turned_v, turned_a, xs, vs, a1, .. } = self;
        system.turn(sampled, xs, vs, t, half, turned_v);
        if self.level.acceleration != 0.0 {
            system.turn(sampled, xs, a1, t, half, turned_a);
        }
    }

    /// Sums gravity, laws, loads and λᵀG at the sampled state into `force`.
    fn sum_forces(&mut self, system: &System, stage: &Stage) {
        let dim = system.dim;
        self.force.copy_from_slice(&self.weight);
        self.respond(system, stage);
        for (law, response) in system.laws.iter().zip(&self.responses) {
            for (k, &id) in law.invariants.iter().enumerate() {
                let slots = system.invariants.slots_of(id);
                let gradient = &self.sampled.gradient[slots.start * dim..slots.end * dim];
                scatter(dim, &system.slots.nodes[slots], response.force[k], gradient, &mut self.force);
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
        self.kkt.add_forces(&self.lambda, &self.sampled.gradient, &mut self.force);
    }

    /// Responses of all laws at the sampled state.
    fn respond(&mut self, system: &System, stage: &Stage) {
        let between = stage.sampling == Sampling::Between;
        if self.dissipative && !between {
            system.turn(&self.sampled, &self.xs, &self.vs, stage.time(), &mut self.half, &mut self.motion);
        }
        for (law, response) in system.laws.iter().zip(&mut self.responses) {
            let mut own = Response::default();
            let m = law.arguments.len();
            if between {
                let (from, to) = (system.arguments(law, &self.at_start), system.arguments(law, &self.at_end));
                let reach = Reach { from: &from[..m], to: &to[..m], step: stage.step, middle: stage.time() };
                law.law.between(reach, &mut own);
            } else {
                let value = system.arguments(law, &self.sampled);
                let mut rate = [0.0; MAX_ARGUMENTS];
                if !law.law.conservative() {
                    for (rate, &quantity) in rate.iter_mut().zip(&law.arguments) {
                        *rate = system.along(&system.slots_of(quantity), &system.slots.nodes, &self.sampled, &self.vs);
                    }
                }
                law.law.at(&value[..m], &rate[..m], stage.time(), &mut own);
            }
            let end = if between { &self.at_end } else { &self.sampled };
            *response = system.by_invariants(law, own, &self.sampled, end, &self.vs);
        }
    }

    /// Sampled positions and velocities of a load's nodes.
    fn load_arguments(&self, system: &System, load: &LoadEntry) -> ([f64; SIZE], [f64; SIZE]) {
        let (mut x, mut v) = ([0.0; SIZE], [0.0; SIZE]);
        gather(system.dim, &load.nodes, &self.xs, &mut x);
        for (x, _) in x.chunks_exact_mut(system.dim).zip(&load.nodes).filter(|(_, node)| system.is_point[node.index()]) {
            x.iter_mut().zip(system.origin).for_each(|(x, origin)| *x += origin);
        }
        gather(system.dim, &load.nodes, &self.vs, &mut v);
        (x, v)
    }

    /// Writes minus the residual of the stage to `unknowns`: ϖ(M a + f) for the coordinates, Φ for the rows.
    pub fn residual(&mut self, system: &System, stage: &Stage) {
        let n = system.coordinates();
        let (free, known) = self.full.split_at_mut(n);
        free.iter_mut().zip(self.d.iter().zip(&self.drift)).for_each(|(full, (d, drift))| *full = d - drift);
        known.iter_mut().zip(&self.a1[n..]).for_each(|(full, a)| *full = stage.inertia * a);
        let (forces, rows) = self.unknowns.split_at_mut(n);
        system.mass.times(system.dim, &self.full, forces);
        forces.iter_mut().zip(&self.force).for_each(|(unknown, force)| *unknown = -(*unknown + stage.inertia * force));
        rows.iter_mut().zip(&self.phi).for_each(|(unknown, phi)| *unknown = -phi);
    }

    /// Assembles the tangent of the stage without its proximal term. `geometric` is 1 for the full tangent and 0 for
    /// that of Gauss and Newton, which leaves out the curvature of the rows.
    pub fn tangent(&mut self, system: &System, stage: &Stage, geometric: f64) {
        let share = stage.share();
        let weight = stage.inertia * share;
        self.kkt.clear();
        self.kkt.start_with_mass(1.0);
        if geometric != 0.0 {
            self.kkt.add_row_hessians(&self.lambda, geometric * weight);
            self.add_function_rows(system, stage, Block(0, 0));
            self.add_custom_hessians(system, stage.time(), Block(0, 0), geometric * weight);
        }
        self.add_laws(system, stage, Block(0, 0));
        self.add_loads(system, stage, Block(0, 0));
        self.kkt.write_sum(Block(0, 0));
        self.kkt.add_columns(Block(0, 0), &self.sampled.gradient, 1.0);
        if self.level != Level::POSITION {
            self.level_rows(system, stage);
            return;
        }
        let (at_end, factor) = match stage.rows {
            RowsAt::End => (true, 1.0),
            RowsAt::Mean => (true, 0.5),
            RowsAt::Middle => (false, 0.5),
        };
        self.differentiate_rows(system, stage, at_end, factor);
        let Self { kkt, row_gradient, at_end: end, sampled, .. } = self;
        let gradient = match (system.is_nonholonomic(), at_end) {
            (true, _) => row_gradient,
            (false, true) => &end.gradient,
            (false, false) => &sampled.gradient,
        };
        kkt.add_rows(Block(0, 0), gradient, factor);
    }

    /// Adds the rows of the tangent for conditions on velocity or acceleration. The dependence of H on positions is left
    /// out: it is none for quadratic rows.
    fn level_rows(&mut self, system: &System, stage: &Stage) {
        self.turn(system, stage.time());
        let (level, share, rate) = (self.level, stage.share(), stage.rate);
        let scale = level.scale(rate, stage.inertia);
        let gradient = level.position * share + level.velocity * rate + level.acceleration / stage.inertia;
        let block = Block(0, 0);
        self.kkt.add_rows(block, &self.sampled.gradient, scale * gradient);
        self.kkt.add_rows(block, &self.turned_v, scale * (level.velocity * share + 2.0 * level.acceleration * rate));
        if level.acceleration != 0.0 {
            self.kkt.add_rows(block, &self.turned_a, scale * level.acceleration * share);
        }
    }

    /// Adds the tangents of all laws, times ϖ.
    pub fn add_laws(&mut self, system: &System, stage: &Stage, block: Block) {
        let between = stage.sampling == Sampling::Between;
        let share = stage.inertia * stage.share();
        for (law, entry) in system.laws.iter().enumerate() {
            let dissipates = !between && !entry.law.conservative();
            let factors = LawFactors {
                force: share,
                value: if between { stage.inertia } else { share },
                rate: if dissipates { stage.inertia * stage.rate } else { 0.0 },
                motion: if dissipates { share } else { 0.0 },
            };
            let right = if between { &self.at_end.gradient } else { &self.sampled.gradient };
            self.kkt.add_law(block, law, &self.responses[law], factors, &self.sampled.gradient, right, &self.motion);
        }
    }

    /// Adds Σ λ_k times the change of the derivatives of the rows that are functions of invariants, times ϖ.
    pub fn add_function_rows(&mut self, system: &System, stage: &Stage, block: Block) {
        let between = stage.sampling == Sampling::Between;
        let share = stage.inertia * stage.share();
        let factors = LawFactors { force: share, value: if between { stage.inertia } else { share }, rate: 0.0, motion: 0.0 };
        for (&row, response) in system.function_rows.iter().zip(&mut self.responses[system.laws.len()..]) {
            let Quantity::Function(id) = system.rows[row as usize].quantity else { unreachable!("a row of a function") };
            let (local, lambda) = (&self.sampled.functions.local[id.0 as usize], self.lambda[row as usize]);
            *response = Response { force: local.gradient.map(|g| lambda * g), ..Response::default() };
            for (out, line) in response.by_value.iter_mut().zip(&local.hessian) {
                *out = line.map(|h| lambda * h);
            }
        }
        let right = if between { &self.at_end.gradient } else { &self.sampled.gradient };
        for k in system.laws.len()..self.responses.len() {
            self.kkt.add_law(block, k, &self.responses[k], factors, &self.sampled.gradient, right, &self.motion);
        }
    }

    /// Adds the tangents of all loads, times ϖ.
    pub fn add_loads(&mut self, system: &System, stage: &Stage, block: Block) {
        for (k, load) in system.loads.iter().enumerate() {
            let width = load.nodes.len() * system.dim;
            let (x, v) = self.load_arguments(system, load);
            let (by_position, by_velocity) = self.dense.split_at_mut(SIZE * SIZE);
            let (by_position, by_velocity) = (&mut by_position[..width * width], &mut by_velocity[..width * width]);
            by_position.fill(0.0);
            by_velocity.fill(0.0);
            load.load.tangent(&x[..width], &v[..width], stage.time(), by_position, by_velocity);
            self.kkt.add_load(block, k, by_position, -stage.inertia * stage.share());
            self.kkt.add_load(block, k, by_velocity, -stage.inertia * stage.rate);
        }
    }

    /// Adds what forces change by with velocity, times `factor`.
    pub fn add_damping(&mut self, system: &System, t: f64, block: Block, factor: f64) {
        for (law, _) in system.laws.iter().enumerate().filter(|(_, entry)| !entry.law.conservative()) {
            let factors = LawFactors { force: 0.0, value: 0.0, rate: factor, motion: 0.0 };
            let gradient = &self.sampled.gradient;
            self.kkt.add_law(block, law, &self.responses[law], factors, gradient, gradient, &self.motion);
        }
        for (k, load) in system.loads.iter().enumerate() {
            let width = load.nodes.len() * system.dim;
            let (x, v) = self.load_arguments(system, load);
            let (by_position, by_velocity) = self.dense.split_at_mut(SIZE * SIZE);
            let (by_position, by_velocity) = (&mut by_position[..width * width], &mut by_velocity[..width * width]);
            by_position.fill(0.0);
            by_velocity.fill(0.0);
            load.load.tangent(&x[..width], &v[..width], t, by_position, by_velocity);
            self.kkt.add_load(block, k, by_velocity, -factor);
        }
    }

    /// Adds Σ λ_k H_k of the custom rows at the sampled position, times `factor`.
    pub fn add_custom_hessians(&mut self, system: &System, t: f64, block: Block, factor: f64) {
        let mut first = system.rows.len();
        for (k, entry) in system.custom.iter().enumerate() {
            let rows = entry.rows.rows();
            let mut x = [0.0; SIZE];
            let width = gather(system.dim, &entry.nodes, &self.xs, &mut x);
            let hessian = &mut self.dense[..width * width];
            entry.rows.hessian(&x[..width], t, &self.lambda[first..first + rows], hessian);
            self.kkt.add_custom(block, k, hessian, factor);
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
    pub fn sample_end(&mut self, system: &System, t: f64) {
        system.evaluate(&self.x1, t, &self.at_start, &mut self.at_end);
        self.sampled.copy_from(&self.at_end);
        self.xs.copy_from_slice(&self.x1);
        self.vs.copy_from_slice(&self.v1);
        self.sum_forces(system, &Stage::moment(t));
    }

    /// Samples forces at the position `xs` and velocity `vs`, with the multipliers as they are, and evaluates there.
    pub fn sample(&mut self, system: &System, t: f64) {
        system.evaluate(&self.xs, t, &self.at_start, &mut self.sampled);
        self.sum_forces(system, &Stage::moment(t));
    }

    /// Samples forces at the end again with other multipliers, where nothing moved since.
    pub(super) fn resample_end(&mut self, system: &System, t: f64) {
        self.sum_forces(system, &Stage::moment(t));
    }

    /// Leaves Φ̈ at the sampled position, with the accelerations `a1`, in `rows`.
    pub fn sampled_acceleration_violation(&mut self, system: &System, time: f64) {
        system.constraint_curvatures(&self.sampled, &self.xs, &self.vs, time, &mut self.half, &mut self.rows);
        self.kkt.add_along(1.0, &self.sampled.gradient, &self.a1, &mut self.rows);
    }

    /// Leaves Φ̇ at the end of the step in `rows`.
    pub fn rate_violation(&mut self, system: &System, time: f64) {
        system.constraint_rates(&system.slots.by_row, &self.at_end, &self.v1, time, &mut self.rows);
    }

    /// Leaves Φ̈ at the end of the step in `rows`.
    pub fn acceleration_violation(&mut self, system: &System, time: f64) {
        system.constraint_curvatures(&self.at_end, &self.x1, &self.v1, time, &mut self.half, &mut self.rows);
        self.kkt.add_along(1.0, &self.at_end.gradient, &self.a1, &mut self.rows);
    }
}
