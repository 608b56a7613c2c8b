//! Stages that are solved together: collocation (Radau, Gauss) and, with one stage, backward differentiation.
//!
//! The integrator relates positions, velocities and accelerations of the s stages,
//! ```text
//! q̇_i = Σ_j B_ij d_j / h + p_i        a_i = Σ_j B_ij v_j / h + r_i        d_i = q_i − q_0
//! ```
//! (collocation: B = A⁻¹ of its tableau, p = 0, r_i = −Σ_j B_ij v_0/h), and the formulation says what the rows stand for.
//! With rows at one level q̇ = v and the unknowns are d_i and h²λ_i. With rows at both (Gear, Gupta and Leimkuhler) they
//! are d_i, u_i = h v_i, ν_i = h μ_i and h²λ_i of
//! ```text
//! M (h q̇_i − u_i) + G_iᵀν_i = 0      h² (M a_i − Q_i) + G_iᵀ h²λ_i = 0      Φ_i = 0      h Φ̇_i = 0
//! ```

mod equations;

use super::failure::Failure;
use super::iteration::SolveSettings;
use super::kkt::Kkt;
use super::level::Level;
use super::newton::{Newton, iterate};
use super::pattern::{ALL, Block, OWN_STAGE, TWO_LEVELS};
use super::scales::Scales;
use super::stage::{RowsAt, Sampling, Stage};
use super::velocity_rows::Source;
use super::workspace::Workspace;
use crate::system::System;
use equations::Stages;

/// When the stages are: t_i = start + c_i step.
#[derive(Clone, Copy, Debug)]
pub struct Timing<'a> {
    /// Time at the start of the step, s.
    pub start: f64,
    /// Length of the step, s.
    pub step: f64,
    /// c (s)
    pub nodes: &'a [f64],
}

/// Unknowns and scratch of s coupled stages. Arrays of n numbers a stage follow one another.
pub struct Collocation {
    kkt: Kkt,
    stages: usize,
    doubled: bool,
    /// B (s × s), row-major.
    rate: Vec<f64>,
    /// B² (s × s).
    square: Vec<f64>,
    /// Increments d_i (s × n), m.
    pub d: Vec<f64>,
    /// h v_i (s × n), m.
    pub u: Vec<f64>,
    /// h p_i (s × n), m.
    pub p: Vec<f64>,
    /// h² r_i (s × n), m.
    pub r: Vec<f64>,
    /// h² a_i (s × n), m.
    pub a: Vec<f64>,
    /// h²λ_i (s × r).
    pub lambda: Vec<f64>,
    /// ν_i (s × r).
    nu: Vec<f64>,
    unknowns: Vec<f64>,
    /// Sizes of the terms that residuals are sums of.
    sizes: Vec<f64>,
    /// δ of the rows (r) of each level, and whether nothing moved them when last factored.
    delta: Vec<f64>,
    idle: Vec<bool>,
    /// Whether rows were ever factored, whether the last factorisation changed what moves, and attempts to come that are near that.
    is_known: bool,
    changes_rank: bool,
    singular: u32,
}

impl Collocation {
    /// Adds what the last factorisations said of the rows, as numbers.
    pub fn carry(&self, carried: &mut Vec<f64>) {
        carried.extend([f64::from(u8::from(self.is_known)), f64::from(self.singular)]);
        carried.extend(self.idle.iter().map(|&idle| f64::from(u8::from(idle))));
    }

    /// Takes that over.
    pub fn carry_on(&mut self, carried: &[f64]) {
        let [is_known, singular, flags @ ..] = carried else { return };
        (self.is_known, self.singular) = (*is_known != 0.0, *singular as u32);
        self.idle.iter_mut().zip(flags).for_each(|(idle, flag)| *idle = *flag != 0.0);
    }

    /// Room for `stages` stages of a system under a formulation.
    pub fn new(system: &System, stages: usize, settings: &SolveSettings) -> Self {
        let doubled = settings.doubled;
        let coupling = match (doubled, settings.level == Level::POSITION) {
            (true, _) => TWO_LEVELS,
            (false, true) if !system.is_nonholonomic() => OWN_STAGE,
            (false, _) => ALL,
        };
        let kkt = Kkt::new(system, &Scales::new(system), if doubled { 2 * stages } else { stages }, coupling);
        let (n, rows) = (stages * system.coordinates(), stages * system.constraints());
        let [d, u, p, r, a] = std::array::from_fn(|_| vec![0.0; n]);
        let [lambda, nu] = std::array::from_fn(|_| vec![0.0; rows]);
        let (matrix, levels) = (vec![0.0; stages * stages], if doubled { 2 } else { 1 });
        Self {
            unknowns: vec![0.0; kkt.size()],
            sizes: vec![0.0; kkt.size()],
            delta: vec![0.0; levels * system.constraints()],
            idle: vec![false; levels * system.constraints()],
            is_known: false,
            changes_rank: false,
            singular: 0,
            kkt,
            stages,
            doubled,
            rate: matrix.clone(),
            square: matrix,
            d,
            u,
            p,
            r,
            a,
            lambda,
            nu,
        }
    }

    /// Sets B (s × s), row-major.
    pub fn set_rate(&mut self, rate: impl IntoIterator<Item = f64>) {
        let s = self.stages;
        self.rate.iter_mut().zip(rate).for_each(|(own, given)| *own = given);
        for i in 0..s {
            for j in 0..s {
                self.square[i * s + j] = (0..s).map(|k| self.rate[i * s + k] * self.rate[k * s + j]).sum();
            }
        }
    }

    /// Newton on all stages from the increments in `d` (and `u` with rows at both levels), with the multipliers of the
    /// workspace.
    pub fn solve(&mut self, system: &System, timing: Timing<'_>, newton: &mut Newton, work: &mut Workspace) -> Result<(), Failure> {
        let h2 = timing.step * timing.step;
        for lambda in self.lambda.chunks_exact_mut(work.lambda.len().max(1)) {
            lambda.iter_mut().zip(&work.lambda).for_each(|(own, given)| *own = h2 * given);
        }
        self.nu.fill(0.0);
        iterate(&mut Stages { own: self, system, timing }, newton, work)?;
        self.relate();
        Ok(())
    }

    /// Puts a workspace's sampled state at stage `i`: position, velocity, acceleration and multipliers, known motion in
    /// place. Says the time.
    pub fn place(&self, system: &System, timing: Timing<'_>, i: usize, work: &mut Workspace) -> f64 {
        let (n, r, h) = (system.coordinates(), work.lambda.len(), timing.step);
        let t = timing.start + timing.nodes[i] * h;
        system.place_known(t, &mut work.sampled.x, &mut work.sampled.v, &mut work.a);
        for k in 0..n {
            work.sampled.x[k] = work.start.x[k] + self.d[i * n + k];
            work.sampled.v[k] = self.u[i * n + k] / h;
            work.a[k] = self.a[i * n + k] / (h * h);
        }
        for k in 0..r {
            work.lambda[k] = self.lambda[i * r + k] / (h * h);
        }
        t
    }

    /// Velocities (where they follow from positions) and accelerations of all stages.
    fn relate(&mut self) {
        let (s, n) = (self.stages, self.d.len() / self.stages);
        if !self.doubled {
            self.u.copy_from_slice(&self.p);
            for (i, j) in pairs(s) {
                let b = self.rate[i * s + j];
                (0..n).for_each(|k| self.u[i * n + k] += b * self.d[j * n + k]);
            }
        }
        self.a.copy_from_slice(&self.r);
        for (i, j) in pairs(s) {
            let b = self.rate[i * s + j];
            (0..n).for_each(|k| self.a[i * n + k] += b * self.u[j * n + k]);
        }
    }

    /// Minus the residual of all stages into `unknowns`, and with `tangent` their matrix.
    fn assemble(&mut self, system: &System, timing: Timing<'_>, soft: Option<f64>, tangent: bool, work: &mut Workspace) {
        self.relate();
        for i in 0..self.stages {
            let t = self.place(system, timing, i, work);
            work.sample(system, t);
            match self.doubled {
                true => self.residual_of_both(system, timing, i, t, work),
                false => self.residual(system, timing, i, t, soft, work),
            }
            if tangent {
                match self.doubled {
                    true => self.tangent_of_both(system, timing, i, t, work),
                    false => self.tangent(system, timing, i, t, work),
                }
            }
        }
    }

    /// h² (M a + f) of the sampled state into `inertial`.
    fn momentum(system: &System, h: f64, work: &mut Workspace) {
        system.mass.times(system.dim, &work.a, &mut work.inertial);
        for (sum, force) in work.inertial.iter_mut().zip(&work.forces.sum) {
            *sum = h * h * (*sum + force);
        }
    }

    /// Writes minus the n numbers of `inertial` to the coordinates of a field.
    fn write(&mut self, dim: usize, field: usize, work: &Workspace) {
        for (node, values) in work.inertial.chunks_exact(dim).enumerate() {
            let first = self.kkt.coordinate(node, field, 0);
            (0..dim).for_each(|c| self.unknowns[first + c] = -values[c]);
        }
    }

    fn residual(&mut self, system: &System, timing: Timing<'_>, i: usize, t: f64, soft: Option<f64>, work: &mut Workspace) {
        let (h, r) = (timing.step, work.lambda.len());
        Self::momentum(system, h, work);
        self.write(system.dim, i, work);
        let scale = work.level.scale(1.0 / h, h * h);
        work.weigh_levels(system, t, scale);
        if work.level == Level::POSITION {
            for &row in &system.velocity_rows {
                let slots = &system.slots.rows[row as usize];
                work.phi[row as usize] = h * system.along(slots, &system.slots.nodes, &work.sampled.at, &work.sampled.v);
            }
        }
        for row in 0..r {
            let give = soft.map_or(0.0, |alpha| scale / alpha * work.lambda[row]);
            self.unknowns[self.kkt.multiplier(row, i)] = give - work.phi[row];
        }
    }

    fn residual_of_both(&mut self, system: &System, timing: Timing<'_>, i: usize, t: f64, work: &mut Workspace) {
        let (s, n, r, h, dim) = (self.stages, system.coordinates(), work.lambda.len(), timing.step, system.dim);
        Self::momentum(system, h, work);
        self.write(dim, s + i, work);
        work.full.fill(0.0);
        for k in 0..n {
            let rate: f64 = (0..s).map(|j| self.rate[i * s + j] * self.d[j * n + k]).sum();
            work.full[k] = rate + self.p[i * n + k] - self.u[i * n + k];
        }
        system.mass.times(dim, &work.full, &mut work.inertial);
        self.write(dim, i, work);
        system.constraint_values(&work.sampled.at, t, &mut work.phi);
        system.constraint_rates(&system.slots.by_row, &work.sampled.at, &work.sampled.v, t, &mut work.rows);
        for row in 0..r {
            self.unknowns[self.kkt.multiplier(row, i)] = -work.phi[row];
            self.unknowns[self.kkt.multiplier(row, s + i)] = -h * work.rows[row];
            // Rows on velocities have no part in the first equation.
            if system.velocity_rows.binary_search(&(row as u32)).is_ok() {
                continue;
            }
            let nu = self.nu[i * r + row];
            for slot in system.slots.rows[row].clone().filter(|&slot| self.kkt.is_free(slot)) {
                let to = self.kkt.coordinate(system.slots.nodes[slot] as usize, i, 0);
                (0..dim).for_each(|c| self.unknowns[to + c] -= nu * work.sampled.at.gradient[slot * dim + c]);
            }
        }
    }

    fn tangent(&mut self, system: &System, timing: Timing<'_>, i: usize, t: f64, work: &mut Workspace) {
        let (s, h) = (self.stages, timing.step);
        let level = work.level;
        let scale = level.scale(1.0 / h, h * h);
        if level != Level::POSITION || system.is_nonholonomic() {
            work.turn(system, t);
        }
        for j in 0..s {
            let (own, b, c) = (f64::from(i == j), self.rate[i * s + j], self.square[i * s + j]);
            let block = Block(i, j);
            self.kkt.start_with_mass(c);
            if i == j {
                self.add_forces(system, t, h, b / h, block, i, work);
            } else {
                work.add_damping(system, t, block, h * b, &mut self.kkt);
            }
            self.kkt.write_sum(block);
            if level == Level::POSITION {
                self.position_rows(system, block, b, h, work);
                continue;
            }
            let gradient = level.position * own + level.velocity * b / h + level.acceleration * c / (h * h);
            self.kkt.add_rows(block, &work.sampled.at.gradient, scale * gradient);
            if level != Level::POSITION {
                self.kkt.add_rows(block, &work.turned.v, scale * (level.velocity * own + 2.0 * level.acceleration * b / h));
            }
            if level.acceleration != 0.0 && i == j {
                self.kkt.add_rows(block, &work.turned.a, scale * level.acceleration);
            }
        }
        self.kkt.add_columns(Block(i, i), &work.sampled.at.gradient, 1.0);
    }

    /// Adds the rows of a stage: conditions on its position, and hΨ of those on velocities.
    fn position_rows(&mut self, system: &System, block: Block, rate: f64, h: f64, work: &mut Workspace) {
        let is_own = block.0 == block.1;
        if !system.is_nonholonomic() {
            if is_own {
                self.kkt.add_rows(block, &work.sampled.at.gradient, 1.0);
            }
            return;
        }
        if is_own {
            work.part_of_rows(system, Source::Sampled, false);
            self.kkt.add_rows(block, &work.turned.rows, 1.0);
            work.part_of_rows(system, Source::Turned, true);
            self.kkt.add_rows(block, &work.turned.rows, h);
        }
        work.part_of_rows(system, Source::Sampled, true);
        self.kkt.add_rows(block, &work.turned.rows, rate);
    }

    fn tangent_of_both(&mut self, system: &System, timing: Timing<'_>, i: usize, t: f64, work: &mut Workspace) {
        let (s, h) = (self.stages, timing.step);
        work.turn(system, t);
        for j in 0..s {
            let b = self.rate[i * s + j];
            self.kkt.start_with_mass(b);
            if i == j {
                self.add_slips(system, t, h, i, work);
            }
            self.kkt.write_sum(Block(i, j));
            self.kkt.start_with_mass(b);
            if i == j {
                work.add_damping(system, t, Block(s + i, s + i), h, &mut self.kkt);
            }
            self.kkt.write_sum(Block(s + i, s + j));
        }
        self.kkt.start_with_mass(-1.0);
        self.kkt.write_sum(Block(i, s + i));
        self.kkt.start_with_mass(0.0);
        self.add_forces(system, t, h, 0.0, Block(s + i, i), i, work);
        self.kkt.write_sum(Block(s + i, i));
        let gradient = &work.sampled.at.gradient;
        self.kkt.add_columns(Block(s + i, s + i), gradient, 1.0);
        self.kkt.add_rows(Block(s + i, s + i), gradient, 1.0);
        self.kkt.add_rows(Block(s + i, i), &work.turned.v, h);
        // Of rows on velocities ν is zero, to the bit.
        if system.is_nonholonomic() {
            work.part_of_rows(system, Source::Sampled, false);
        }
        let gradient = if system.is_nonholonomic() { &work.turned.rows } else { &work.sampled.at.gradient };
        self.kkt.add_columns(Block(i, i), gradient, 1.0);
        self.kkt.add_rows(Block(i, i), gradient, 1.0);
    }

    /// Adds the stiffness of rows, laws and loads of stage `i` to a block, and their damping times `rate`.
    #[expect(clippy::too_many_arguments)] // what a stage is, and where it goes
    fn add_forces(&mut self, system: &System, t: f64, h: f64, rate: f64, block: Block, i: usize, work: &mut Workspace) {
        let r = work.lambda.len();
        self.kkt.add_row_hessians(&self.lambda[i * r..(i + 1) * r], 1.0);
        let stage = stage(t, h, h * h, rate);
        work.add_laws(system, &stage, block, &mut self.kkt);
        work.add_function_rows(system, &stage, block, &mut self.kkt);
        work.add_loads(system, &stage, block, &mut self.kkt);
        work.add_custom_hessians(system, t, block, h * h, &mut self.kkt);
    }

    /// Adds the curvature of the rows of stage `i` under ν to its own block, all of it: of redundant rows ν is round-off, which may
    /// be much beside light nodes, and leaves them where they are only as a whole.
    fn add_slips(&mut self, system: &System, t: f64, h: f64, i: usize, work: &mut Workspace) {
        let r = work.lambda.len();
        work.lambda.copy_from_slice(&self.nu[i * r..(i + 1) * r]);
        system.velocity_rows.iter().for_each(|&row| work.lambda[row as usize] = 0.0);
        self.kkt.add_row_hessians(&work.lambda, 1.0);
        let stage = stage(t, h, 1.0, 1.0 / h);
        work.add_function_rows(system, &stage, Block(i, i), &mut self.kkt);
        work.add_custom_hessians(system, t, Block(i, i), 1.0, &mut self.kkt);
        let lambda = &self.lambda[i * r..(i + 1) * r];
        work.lambda.iter_mut().zip(lambda).for_each(|(own, lambda)| *own = lambda / (h * h));
    }

    /// Residual of all stages at the unknowns, in the order of [`Self::add`], and their tangent for [`Self::entry`].
    pub fn linearise(&mut self, system: &System, timing: Timing<'_>, work: &mut Workspace) -> Vec<f64> {
        self.kkt.clear();
        self.assemble(system, timing, None, true, work);
        self.unknowns.iter().map(|unknown| -unknown).collect()
    }

    /// The tangent's derivative of a residual by an unknown.
    pub fn entry(&self, residual: usize, unknown: usize) -> f64 {
        self.kkt.solver.entry(residual, unknown)
    }

    /// Adds increments to all unknowns.
    pub fn add(&mut self, system: &System, increments: &[f64], work: &Workspace) {
        self.unknowns.copy_from_slice(increments);
        self.advance(system, work);
    }

    /// Adds the solution to the unknowns; the largest increment over the size of the mechanism.
    fn advance(&mut self, system: &System, work: &Workspace) -> f64 {
        let (s, n, r, dim) = (self.stages, system.coordinates(), work.lambda.len(), system.dim);
        let mut largest = 0.0_f64;
        for field in 0..self.kkt.fields {
            let (values, multipliers) = match (self.doubled, field < s) {
                (false, _) => (&mut self.d, &mut self.lambda),
                (true, true) => (&mut self.d, &mut self.nu),
                (true, false) => (&mut self.u, &mut self.lambda),
            };
            let i = field % s;
            for node in 0..system.free {
                let from = self.kkt.coordinate(node, field, 0);
                for c in 0..dim {
                    let step = self.unknowns[from + c];
                    values[i * n + node * dim + c] += step;
                    largest = if step.is_finite() { largest.max(step.abs()) } else { f64::INFINITY };
                }
            }
            for row in 0..r {
                multipliers[i * r + row] += self.unknowns[self.kkt.multiplier(row, field)];
            }
        }
        largest / work.scales.unit
    }

    /// Largest increment of a multiplier: how far it would move a node of its row, over the size of the mechanism.
    fn turned(&self, work: &Workspace) -> f64 {
        let multipliers = &self.unknowns[self.kkt.multiplier(0, 0)..];
        let of_field = |field| work.scaled_multipliers(multipliers.iter().copied().skip(field).step_by(self.kkt.fields));
        (0..self.kkt.fields).map(of_field).fold(0.0, f64::max)
    }
}

/// The terms of a stage at time `t`, whose forces count `inertia` and whose velocities change by `rate` with its position.
fn stage(t: f64, h: f64, inertia: f64, rate: f64) -> Stage {
    Stage { sampling: Sampling::End, rows: RowsAt::End, start: t - h, step: h, inertia, rate }
}

fn pairs(s: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..s * s).map(move |k| (k / s, k % s))
}
