//! The terms of a stage: rows, laws, loads and inertia, their residual and their tangent.

use super::kkt::Kkt;
use super::law_groups::{LawFactors, LawTangents};
use super::level::Level;
use super::pattern::Block;
use super::stage::{RowsAt, Sampling, Stage};
use super::workspace::{Moment, Workspace};
use crate::system::{Between, Direction, LoadEntry, Look, MAX_ARGUMENTS, Quantity, Reach, Response, Slopes, System, gather, scatter};

impl Workspace {
    /// Evaluates rows, laws and loads of a stage; leaves Φ in `phi` and the sum of forces in `forces`.
    pub fn evaluate(&mut self, system: &System, stage: &Stage) {
        let Self { start, end, sampled, .. } = self;
        if stage.sampling != Sampling::Middle {
            system.evaluate(&end.x, stage.end(), &start.at, &mut end.at);
        }
        match stage.sampling {
            Sampling::End => sampled.at.copy_from(&end.at),
            Sampling::Middle => system.evaluate(&sampled.x, stage.time(), &start.at, &mut sampled.at),
            Sampling::Start => sampled.at.copy_from(&start.at),
            Sampling::Between => {
                let span = Between { from: &start.x, to: &end.x, start: stage.start, step: stage.step };
                system.evaluate_between(span, &start.at, &end.at, &mut sampled.at);
            }
        }
        self.violate(system, stage);
        match stage.sampling {
            Sampling::Between => self.respond_between(system, stage),
            _ => self.respond(system, stage.time()),
        }
        self.sum_forces(system, stage.time(), (stage.sampling == Sampling::Between).then_some(stage.step));
    }

    /// Leaves what the rows of the stage stand for in `phi`, in the units of Φ.
    fn violate(&mut self, system: &System, stage: &Stage) {
        if self.level != Level::POSITION {
            self.weigh_levels(system, stage.time(), self.level.scale(stage.rate, stage.inertia));
            return;
        }
        match stage.rows {
            RowsAt::Middle => system.constraint_values(&self.sampled.at, stage.time(), &mut self.phi),
            RowsAt::End => system.constraint_values(&self.end.at, stage.end(), &mut self.phi),
            RowsAt::Mean => {
                system.constraint_values(&self.end.at, stage.end(), &mut self.phi);
                self.phi.iter_mut().zip(&self.phi_start).for_each(|(phi, start)| *phi = 0.5 * (*phi + start));
            }
        }
        self.violate_velocity_rows(system, stage);
    }

    /// Leaves the weighted sum of Φ̈, Φ̇ and Φ at the sampled state, with the accelerations `a`, times `scale` in `phi`.
    pub fn weigh_levels(&mut self, system: &System, t: f64, scale: f64) {
        self.weigh_levels_at_rest(system, t, scale);
        if self.level.acceleration != 0.0 {
            let factor = scale * self.level.acceleration;
            system.slots.add_along(system.dim, factor, &self.sampled.at.gradient, &self.a, &mut self.phi);
        }
    }

    /// The same without accelerations.
    pub(super) fn weigh_levels_at_rest(&mut self, system: &System, t: f64, scale: f64) {
        let level = self.level;
        system.constraint_values(&self.sampled.at, t, &mut self.phi);
        self.phi.iter_mut().for_each(|phi| *phi *= scale * level.position);
        if level.velocity != 0.0 {
            system.constraint_rates(&system.slots.by_row, &self.sampled.at, &self.sampled.v, t, &mut self.rows);
            self.phi.iter_mut().zip(&self.rows).for_each(|(phi, rate)| *phi += scale * level.velocity * rate);
        }
        if level.acceleration != 0.0 {
            let Self { sampled, turned, rows, .. } = self;
            system.constraint_curvatures(&sampled.at, &sampled.x, &sampled.v, t, &mut turned.half, rows);
            self.phi.iter_mut().zip(&self.rows).for_each(|(phi, row)| *phi += scale * level.acceleration * row);
        }
    }

    /// H v and H a of all rows at the sampled state.
    pub fn turn(&mut self, system: &System, t: f64) {
        let Self { sampled, turned, a, .. } = self;
        system.turn(&sampled.at, &sampled.x, Direction::velocity(&sampled.v), t, &mut turned.half, &mut turned.v);
        if self.level.acceleration != 0.0 {
            system.turn(&sampled.at, &sampled.x, Direction { nodes: a, time: 0.0 }, t, &mut turned.half, &mut turned.a);
        }
    }

    /// Sums gravity, laws as they have responded, loads and λᵀG at the sampled state, or between the ends of a step of this length.
    fn sum_forces(&mut self, system: &System, t: f64, between: Option<f64>) {
        self.sum_applied(system, t, between);
        system.slots.add_forces(system.dim, &self.lambda, &self.sampled.at.gradient, &mut self.forces.sum);
    }

    /// The same without λᵀG.
    fn sum_applied(&mut self, system: &System, t: f64, between: Option<f64>) {
        let dim = system.dim;
        self.forces.sum.copy_from_slice(&self.forces.weight);
        for (law, response) in system.laws.iter().zip(&self.forces.responses) {
            for (k, &id) in law.invariants.iter().enumerate() {
                let slots = system.invariants.slots_of(id);
                let gradient = &self.sampled.at.gradient[slots.start * dim..slots.end * dim];
                scatter(dim, &system.slots.nodes[slots], response.force[k], gradient, &mut self.forces.sum);
            }
        }
        let mut first = 0;
        for load in &system.loads {
            let width = load.nodes.len() * dim;
            let Self { start, end, sampled, inputs, forces, .. } = &mut *self;
            let look = look(start, end, sampled, inputs, t, between);
            system.load_forces(load, look, &mut forces.of_loads[first..first + width]);
            for (k, node) in load.nodes.iter().enumerate().filter(|(_, node)| node.index() < system.free) {
                for c in 0..dim {
                    self.forces.sum[node.index() * dim + c] -= self.forces.of_loads[first + k * dim + c];
                }
            }
            first += width;
        }
    }

    /// Responses of all laws at the sampled state.
    fn respond(&mut self, system: &System, t: f64) {
        let Self { sampled, turned, forces, .. } = self;
        if forces.dissipative {
            system.turn(&sampled.at, &sampled.x, Direction::velocity(&sampled.v), t, &mut turned.half, &mut forces.motion);
        }
        self.respond_without_motion(system, t);
    }

    /// The same without H v, which tangents alone need.
    fn respond_without_motion(&mut self, system: &System, t: f64) {
        let Self { sampled, forces, .. } = self;
        for (law, response) in system.laws.iter().zip(&mut forces.responses) {
            let value = system.arguments(law, &sampled.at);
            let mut rate = [0.0; MAX_ARGUMENTS];
            if !law.law.conservative() {
                for (rate, &quantity) in rate.iter_mut().zip(&law.arguments) {
                    *rate = system.along(&system.slots_of(quantity), &system.slots.nodes, &sampled.at, &sampled.v);
                }
            }
            let m = law.arguments.len();
            *response = Response::default();
            law.law.at(&value[..m], &rate[..m], t, response);
            system.by_invariants(law, response, &sampled.at, &sampled.at, &sampled.v);
        }
    }

    /// The same between both ends of a stage, by discrete gradients.
    fn respond_between(&mut self, system: &System, stage: &Stage) {
        let Self { start, end, sampled, forces, .. } = self;
        for ((law, response), damping) in system.laws.iter().zip(&mut forces.responses).zip(&forces.damping) {
            let (from, to) = (system.arguments(law, &start.at), system.arguments(law, &end.at));
            let m = law.arguments.len();
            let reach = Reach { from: &from[..m], to: &to[..m], step: stage.step, middle: stage.time() };
            *response = Response::default();
            damping.respond(law.law.as_ref(), reach, response);
            system.by_invariants(law, response, &sampled.at, &end.at, &sampled.v);
        }
    }

    /// Writes minus the residual of the stage to `unknowns`: ϖ(M a + f) for the coordinates, Φ for the rows.
    pub fn residual(&mut self, system: &System, stage: &Stage, unknowns: &mut [f64]) {
        let n = system.coordinates();
        let (free, known) = self.full.split_at_mut(n);
        free.iter_mut().zip(self.d.iter().zip(&self.prediction.drift)).for_each(|(full, (d, drift))| *full = d - drift);
        known.iter_mut().zip(&self.a[n..]).for_each(|(full, a)| *full = stage.inertia * a);
        let (forces, rows) = unknowns.split_at_mut(n);
        system.mass.times(system.dim, &self.full, forces);
        forces.iter_mut().zip(&self.forces.sum).for_each(|(unknown, force)| *unknown = -(*unknown + stage.inertia * force));
        rows.iter_mut().zip(&self.phi).for_each(|(unknown, phi)| *unknown = -phi);
    }

    /// Assembles the tangent of the stage without its proximal term. `geometric` is 1 for the full tangent and 0 for
    /// that of Gauss and Newton, which leaves out the curvature of the rows.
    pub fn tangent(&mut self, system: &System, stage: &Stage, geometric: f64, kkt: &mut Kkt) {
        let share = stage.share();
        let weight = stage.inertia * share;
        kkt.clear();
        kkt.start_with_mass(1.0);
        if geometric != 0.0 {
            kkt.add_row_hessians(&self.lambda, geometric * weight);
            self.add_function_rows(system, stage, Block(0, 0), kkt);
            self.add_custom_hessians(system, stage.time(), Block(0, 0), geometric * weight, kkt);
        }
        self.add_laws(system, stage, Block(0, 0), kkt);
        self.add_loads(system, stage, Block(0, 0), kkt);
        kkt.write_sum(Block(0, 0));
        kkt.add_columns(Block(0, 0), &self.sampled.at.gradient, 1.0);
        if self.level != Level::POSITION {
            self.level_rows(system, stage, kkt);
            return;
        }
        let (at_end, factor) = match stage.rows {
            RowsAt::End => (true, 1.0),
            RowsAt::Mean => (true, 0.5),
            RowsAt::Middle => (false, 0.5),
        };
        self.differentiate_rows(system, stage, at_end, factor);
        let gradient = match (system.is_nonholonomic(), at_end) {
            (true, _) => &self.turned.rows,
            (false, true) => &self.end.at.gradient,
            (false, false) => &self.sampled.at.gradient,
        };
        kkt.add_rows(Block(0, 0), gradient, factor);
    }

    /// Adds the rows of the tangent for conditions on velocity or acceleration. The dependence of H on positions is left
    /// out: it is none for quadratic rows.
    fn level_rows(&mut self, system: &System, stage: &Stage, kkt: &mut Kkt) {
        self.turn(system, stage.time());
        let (level, share, rate) = (self.level, stage.share(), stage.rate);
        let scale = level.scale(rate, stage.inertia);
        let gradient = level.position * share + level.velocity * rate + level.acceleration / stage.inertia;
        let block = Block(0, 0);
        kkt.add_rows(block, &self.sampled.at.gradient, scale * gradient);
        kkt.add_rows(block, &self.turned.v, scale * (level.velocity * share + 2.0 * level.acceleration * rate));
        if level.acceleration != 0.0 {
            kkt.add_rows(block, &self.turned.a, scale * level.acceleration * share);
        }
    }

    /// Adds the tangents of all laws, times ϖ.
    pub fn add_laws(&self, system: &System, stage: &Stage, block: Block, kkt: &mut Kkt) {
        let between = stage.sampling == Sampling::Between;
        let share = stage.inertia * stage.share();
        let factors = |law: usize| {
            let dissipates = !between && !system.laws[law].law.conservative();
            Some(LawFactors {
                force: share,
                value: if between { stage.inertia } else { share },
                rate: if dissipates { stage.inertia * stage.rate } else { 0.0 },
                motion: if dissipates { share } else { 0.0 },
            })
        };
        kkt.add_laws(block, 0..system.laws.len(), &self.law_tangents(between), factors);
    }

    /// What the tangents of laws are made of at a sampled state, or between the ends of a step.
    fn law_tangents(&self, between: bool) -> LawTangents<'_> {
        let Self { sampled, end, forces, .. } = self;
        let right = if between { &end.at.gradient } else { &sampled.at.gradient };
        LawTangents { responses: &forces.responses, left: &sampled.at.gradient, right, motion: &forces.motion }
    }

    /// Adds Σ λ_k times the change of the derivatives of the rows that are functions of invariants, times ϖ.
    pub fn add_function_rows(&mut self, system: &System, stage: &Stage, block: Block, kkt: &mut Kkt) {
        let between = stage.sampling == Sampling::Between;
        let share = stage.inertia * stage.share();
        let factors = LawFactors { force: share, value: if between { stage.inertia } else { share }, rate: 0.0, motion: 0.0 };
        for (&row, response) in system.function_rows.iter().zip(&mut self.forces.responses[system.laws.len()..]) {
            let Quantity::Function(id) = system.rows[row as usize].quantity else { unreachable!("a row of a function") };
            let (local, lambda) = (&self.sampled.at.functions.local[id.0 as usize], self.lambda[row as usize]);
            *response = Response { force: local.gradient.map(|g| lambda * g), ..Response::default() };
            for (out, line) in response.by_value.iter_mut().zip(&local.hessian) {
                *out = line.map(|h| lambda * h);
            }
        }
        let rows = system.laws.len()..self.forces.responses.len();
        kkt.add_laws(block, rows, &self.law_tangents(between), |_| Some(factors));
    }

    /// Adds the tangents of all loads, times ϖ.
    pub fn add_loads(&mut self, system: &System, stage: &Stage, block: Block, kkt: &mut Kkt) {
        let between = (stage.sampling == Sampling::Between).then_some(stage.step);
        for (k, load) in system.loads.iter().enumerate() {
            let [by_position, by_velocity] = self.load_tangents(system, load, stage.time(), between, 1.0 / stage.share());
            kkt.add_load(block, k, by_position, -stage.inertia * stage.share());
            kkt.add_load(block, k, by_velocity, -stage.inertia * stage.rate);
        }
    }

    /// Derivatives of a load at the sampled state by the positions of its nodes and by their velocities. Between the ends of a step its
    /// quantities change with the second, and their gradients `bend` times as much.
    pub(super) fn load_tangents(&mut self, system: &System, load: &LoadEntry, t: f64, between: Option<f64>, bend: f64) -> [&[f64]; 2] {
        let Self { start, sampled, end, inputs, forces, .. } = self;
        let look = look(start, end, sampled, inputs, t, between);
        let slopes = match between {
            Some(_) => Slopes { gradient: &end.at.gradient, motion: None, bend },
            None => Slopes { gradient: &sampled.at.gradient, motion: Some(&forces.motion), bend: 1.0 },
        };
        system.load_tangents(load, look, slopes, &mut forces.dense);
        let size = (load.nodes.len() * system.dim).pow(2);
        let (by_position, rest) = forces.dense.split_at(size);
        [by_position, &rest[..size]]
    }

    /// Adds what forces change by with velocity, times `factor`.
    pub fn add_damping(&mut self, system: &System, t: f64, block: Block, factor: f64, kkt: &mut Kkt) {
        let factors = LawFactors { force: 0.0, value: 0.0, rate: factor, motion: 0.0 };
        kkt.add_laws(block, 0..system.laws.len(), &self.law_tangents(false), |law| {
            (!system.laws[law].law.conservative()).then_some(factors)
        });
        for (k, load) in system.loads.iter().enumerate() {
            let [_, by_velocity] = self.load_tangents(system, load, t, None, 1.0);
            kkt.add_load(block, k, by_velocity, -factor);
        }
    }

    /// Adds Σ λ_k H_k of the custom rows at the sampled position, times `factor`.
    pub fn add_custom_hessians(&mut self, system: &System, t: f64, block: Block, factor: f64, kkt: &mut Kkt) {
        let mut first = system.rows.len();
        for (k, entry) in system.custom.iter().enumerate() {
            let rows = entry.rows.rows();
            let x = gather(system.dim, &entry.nodes, &self.sampled.x);
            let hessian = &mut self.forces.dense[..x.len() * x.len()];
            hessian.fill(0.0);
            entry.rows.hessian(&x, t, &self.lambda[first..first + rows], hessian);
            kkt.add_custom(block, k, hessian, factor);
            first += rows;
        }
    }

    /// Responses of all laws at the end of the step, whatever was sampled before.
    pub fn respond_at_end(&mut self, system: &System, t: f64) {
        self.sampled.copy_from(&self.end);
        self.respond(system, t);
    }

    /// Samples forces at the end position with the multipliers as they are, and evaluates there.
    pub fn sample_end(&mut self, system: &System, t: f64) {
        system.evaluate(&self.end.x, t, &self.start.at, &mut self.end.at);
        self.respond_at_end(system, t);
        self.sum_forces(system, t, None);
    }

    /// Samples forces at the sampled position and velocity, with the multipliers as they are, and evaluates there.
    pub fn sample(&mut self, system: &System, t: f64) {
        system.evaluate(&self.sampled.x, t, &self.start.at, &mut self.sampled.at);
        self.respond(system, t);
        self.sum_forces(system, t, None);
    }

    /// Sums forces but those of the rows at the sampled state, which has its evaluation, where no tangent is asked for.
    pub(super) fn sum_applied_anew(&mut self, system: &System, t: f64) {
        self.respond_without_motion(system, t);
        self.sum_applied(system, t, None);
    }

    /// Leaves Φ̈ at the sampled position, with the accelerations `a`, in `rows`.
    pub fn sampled_acceleration_violation(&mut self, system: &System, time: f64) {
        system.constraint_curvatures(&self.sampled.at, &self.sampled.x, &self.sampled.v, time, &mut self.turned.half, &mut self.rows);
        system.slots.add_along(system.dim, 1.0, &self.sampled.at.gradient, &self.a, &mut self.rows);
    }

    /// Leaves Φ̇ at the end of the step in `rows`.
    pub fn rate_violation(&mut self, system: &System, time: f64) {
        system.constraint_rates(&system.slots.by_row, &self.end.at, &self.end.v, time, &mut self.rows);
    }

    /// Leaves Φ̈ at the end of the step in `rows`.
    pub fn acceleration_violation(&mut self, system: &System, time: f64) {
        system.constraint_curvatures(&self.end.at, &self.end.x, &self.end.v, time, &mut self.turned.half, &mut self.rows);
        system.slots.add_along(system.dim, 1.0, &self.end.at.gradient, &self.a, &mut self.rows);
    }
}

/// What loads see of the state sampled, or of a step of the length `between`.
fn look<'a>(start: &'a Moment, end: &'a Moment, sampled: &'a Moment, inputs: &'a [f64], t: f64, between: Option<f64>) -> Look<'a> {
    let span = between.map(|step| (&start.at.value[..], &end.at.value[..], step));
    Look { x: &sampled.x, v: &sampled.v, t, at: &sampled.at, inputs, span }
}
