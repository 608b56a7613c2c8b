//! Backward differentiation of order 1 to 5 on any sequence of steps: the derivative at the end of the step of the
//! polynomial through it and the states before (Hairer and Wanner 1996, §VII.3).
//! The first steps, before there are enough states, are taken by Radau IIA of order 5.

use super::runge_kutta::{RungeKutta, Tableau};
use super::{Integrator, Step, Work};
use crate::energy;
use crate::formulation::{Collocation, Failure, Newton, RowsAt, Sampling, SolveSettings, Stage, Timing, Workspace};
use crate::system::System;

/// States before the present one that are kept: what order 5 and its error estimate need.
const KEPT: usize = 6;

/// Error over what is allowed below which an order is as good as any.
const LEAST: f64 = 1e-10;

/// Numbers of the memory before those of the states.
const HEAD: usize = 4;

pub(super) struct Bdf {
    order: usize,
    /// Whether the order is chosen from the error estimates, up to `order`.
    varies: bool,
    starter: RungeKutta,
    stage: Collocation,
}

/// Gauss points on 0 … 1 and their weights, exact for powers through that many states.
const GAUSS: [[f64; 2]; 3] = [[0.112_701_665_379_258_31, 5.0 / 18.0], [0.5, 4.0 / 9.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];

/// The memory: how many states there are, the order in use, the power where the last step ended, how many steps were taken with that order, then for
/// each state its time, the power there and that of each worker, positions and velocities, the latest first. The powers at the first state are not
/// known.
struct History<'a> {
    n: usize,
    workers: usize,
    numbers: &'a mut [f64],
}

impl History<'_> {
    fn count(&self) -> usize {
        self.numbers[0] as usize
    }

    /// Numbers before those of the states, and of each state.
    fn sizes(&self) -> [usize; 2] {
        [HEAD + self.workers, 2 + self.workers + 2 * self.n]
    }

    /// Time, powers, positions and velocities of state `k`.
    fn entry(&self, k: usize) -> &[f64] {
        let [head, each] = self.sizes();
        &self.numbers[head + k * each..head + (k + 1) * each]
    }

    fn time(&self, k: usize) -> f64 {
        self.entry(k)[0]
    }

    /// The powers at state `k`: of all, then of each worker.
    fn powers(&self, k: usize) -> &[f64] {
        &self.entry(k)[1..2 + self.workers]
    }

    /// Takes note of the powers where a step ends, for when that state is pushed.
    fn set_power(&mut self, power: f64, of_workers: &[f64]) {
        self.numbers[2] = power;
        self.numbers[HEAD..HEAD + self.workers].copy_from_slice(of_workers);
    }

    /// Positions, then velocities, of state `k`.
    fn state(&self, k: usize) -> &[f64] {
        &self.entry(k)[2 + self.workers..]
    }

    fn push(&mut self, t: f64, x: &[f64], v: &[f64]) {
        let (n, first, [head, each]) = (self.n, 2 + self.workers, self.sizes());
        let (head, states) = self.numbers.split_at_mut(head);
        states.rotate_right(each);
        (states[0], states[1]) = (t, head[2]);
        states[2..first].copy_from_slice(&head[HEAD..]);
        states[first..first + n].copy_from_slice(&x[..n]);
        states[first + n..first + 2 * n].copy_from_slice(&v[..n]);
        head[0] = (head[0] + 1.0).min(KEPT as f64);
    }

    /// What the powers at the end of a step of an order to the time `t` and at the states before count for in its work, s: by the integral of the polynomial
    /// through as many of them as the order says and are known. How many there are, too.
    fn weights_of_work(&self, order: usize, t: f64) -> ([f64; KEPT], usize) {
        let known = order.min(self.count() - 1);
        let time = |k: usize| if k == 0 { t } else { self.time(k - 1) };
        let (start, step) = (self.time(0), t - self.time(0));
        let mut weights = [0.0; KEPT];
        for (k, weight) in weights[..=known].iter_mut().enumerate() {
            let basis = |s: f64| (0..=known).filter(|&i| i != k).map(|i| (s - time(i)) / (time(k) - time(i))).product::<f64>();
            *weight = GAUSS.iter().map(|[node, weight]| step * weight * basis(start + node * step)).sum();
        }
        (weights, known)
    }
}

impl Bdf {
    pub(super) fn new(system: &System, settings: &SolveSettings, order: u8, varies: bool) -> Self {
        Self {
            order: order.into(),
            varies,
            starter: RungeKutta::new(system, settings, Tableau::radau(5)),
            stage: Collocation::new(system, 1, settings),
        }
    }

    /// Weights of the derivative at the time `t` of the polynomial through it and the `k` states before.
    fn weights(history: &History<'_>, t: f64, k: usize) -> [f64; KEPT] {
        let mut weights = [0.0; KEPT];
        for j in 1..=k {
            let own = history.time(j - 1);
            weights[0] += 1.0 / (t - own);
            let mut weight = 1.0 / (own - t);
            for i in (1..=k).filter(|&i| i != j) {
                let other = history.time(i - 1);
                weight *= (t - other) / (own - other);
            }
            weights[j] = weight;
        }
        weights
    }
}

impl Integrator for Bdf {
    fn has_one_stage(&self) -> bool {
        false
    }

    fn carry(&self, carried: &mut Vec<f64>) {
        self.stage.carry(carried);
    }

    fn carry_on(&mut self, carried: &[f64]) {
        self.stage.carry_on(carried);
    }

    fn memory(&self, system: &System) -> usize {
        let workers = system.workers().count();
        HEAD + workers + KEPT * (2 + workers + 2 * system.coordinates())
    }

    fn step(&mut self, system: &System, start: f64, h: f64, newton: &mut Newton, work: &mut Workspace) -> Result<Step, Failure> {
        let n = system.coordinates();
        let mut memory = std::mem::take(&mut work.memory);
        let mut history = History { n, workers: work.shares.len(), numbers: &mut memory };
        history.push(start, &work.start.x, &work.start.v);
        let outcome = self.advance(system, start, h, newton, &mut history, work);
        work.memory = memory;
        outcome
    }
}

impl Bdf {
    fn advance(
        &mut self,
        system: &System,
        start: f64,
        h: f64,
        newton: &mut Newton,
        history: &mut History<'_>,
        work: &mut Workspace,
    ) -> Result<Step, Failure> {
        let n = system.coordinates();
        let order = self.order_in_use(history);
        if history.count() < self.order + usize::from(self.varies) {
            let step = self.starter.step(system, start, h, newton, work)?;
            (work.estimate.energy, work.estimate.rounded) = (0.0, 0.0);
            let power = if work.is_worked_on() { energy::power(system, start + h, |work| &work.end, work) } else { 0.0 };
            history.set_power(power, &work.powers);
            return Ok(step);
        }
        let t = start + h;
        let weights = Self::weights(history, t, order);
        self.stage.set_rate([weights[0] * h]);
        for k in 0..n {
            let (mut p, mut r) = (0.0, 0.0);
            for j in 1..=order {
                let state = history.state(j - 1);
                p += h * weights[j] * (state[k] - work.start.x[k]);
                r += h * h * weights[j] * state[n + k];
            }
            (self.stage.p[k], self.stage.r[k]) = (p, r);
            let (v, a) = (work.start.v[k], work.a[k] + work.prediction.a_change[k] / 3.0);
            self.stage.d[k] = h * (v + 0.5 * h * a);
            self.stage.u[k] = h * (v + h * a);
        }
        let timing = Timing { start, step: h, nodes: &[1.0] };
        self.stage.solve(system, timing, newton, work)?;
        self.stage.place(system, timing, 0, work);
        let mut done = 0.0;
        if work.is_worked_on() {
            work.sample(system, t);
            let power = energy::power(system, t, |work| &work.sampled, work);
            let (weights, known) = history.weights_of_work(order, t);
            done = weights[0] * power;
            work.book_powers(weights[0]);
            for (k, weight) in weights[1..=known].iter().enumerate() {
                let [all, of_workers @ ..] = history.powers(k) else { unreachable!("the power of all is first") };
                done += weight * all;
                work.shares.iter_mut().zip(of_workers).for_each(|(share, power)| *share += weight * power);
            }
            history.set_power(power, &work.powers);
        }
        work.end.x[n..].copy_from_slice(&work.sampled.x[n..]);
        work.end.v.copy_from_slice(&work.sampled.v);
        work.d.copy_from_slice(&self.stage.d);
        if self.varies {
            self.choose(order, t, history, work);
            energy_error(system, order, t, history, work);
        }
        let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start, step: h, inertia: h * h, rate: 1.0 / h };
        Ok(Step { stage, work: Work::Sum(done), estimate: Some([order as u8; 2]) })
    }

    fn order_in_use(&self, history: &History<'_>) -> usize {
        match history.numbers[1] as usize {
            chosen if self.varies && chosen > 0 => chosen,
            _ => self.order,
        }
    }

    /// Estimates the local error at the order in use, and takes the neighbour that allows longer steps for the next one.
    fn choose(&self, order: usize, t: f64, history: &mut History<'_>, work: &mut Workspace) {
        // By how much a step of an order could be longer: its error over what is allowed.
        let allowed = work.estimate.allowed * (t - history.time(0));
        let room = |order: usize, error: f64| (error / allowed).max(LEAST).powf(-1.0 / order as f64);
        let mut next = order;
        let mut best = 0.0;
        // Differences of states that steps of other orders led to hold the errors of those: what they say of an order is sure where the states
        // are of one. Else two orders can take turns, each with the shorter steps that it takes for the errors of the other.
        history.numbers[3] += 1.0;
        let is_settled = history.numbers[3] > order as f64;
        if is_settled && order > 1 {
            best = room(order - 1, local_error(order - 1, t, history, work));
            next = order - 1;
        }
        if is_settled && order < self.order && history.count() >= order + 2 {
            let higher = room(order + 1, local_error(order + 1, t, history, work));
            if higher > best {
                (best, next) = (higher, order + 1);
            }
        }
        // Another order must be worth it, and nothing is where hardly anything moves.
        let error = local_error(order, t, history, work);
        if best < 1.1 * room(order, error) || error <= LEAST * allowed {
            next = order;
        }
        if next != order {
            history.numbers[3] = 0.0;
        }
        history.numbers[1] = next as f64;
    }
}

/// What the divided differences over the states of a step to `t` with order `k` are multiplied by to estimate its local errors: ψ_1 … ψ_k, for what
/// the derivative is off by, over the leading weight of the derivative, by which that comes to the state.
fn reach(order: usize, t: f64, history: &History<'_>) -> f64 {
    let leading: f64 = (0..order).map(|j| 1.0 / (t - history.time(j))).sum();
    (0..order).map(|j| t - history.time(j)).product::<f64>() / leading
}

/// Writes the estimated local errors of a step to `t` with order `k`: what it [reaches](reach), times the divided differences over k + 2 states. Says
/// the largest, of positions over the size of the mechanism and of velocities over their unit.
fn local_error(order: usize, t: f64, history: &History<'_>, work: &mut Workspace) -> f64 {
    let n = history.n;
    let (length, speed) = (work.scales.length, work.estimate.speed);
    let time = |j: usize| if j == 0 { t } else { history.time(j - 1) };
    let reach = reach(order, t, history);
    let mut largest = 0.0_f64;
    for k in 0..2 * n {
        let mut differences = [0.0; KEPT + 1];
        differences[0] = if k < n { work.start.x[k] + work.d[k] } else { work.end.v[k - n] };
        for j in 1..=order + 1 {
            differences[j] = history.state(j - 1)[k];
        }
        for level in 1..=order + 1 {
            for j in 0..=order + 1 - level {
                differences[j] = (differences[j] - differences[j + 1]) / (time(j) - time(j + level));
            }
        }
        let error = reach * differences[0];
        if k < n {
            work.estimate.q[k] = error;
            largest = largest.max(error.abs() / length);
        } else {
            work.estimate.v[k - n] = error;
            largest = largest.max(error.abs() / speed);
        }
    }
    largest
}

/// Leaves in the workspace what the estimated local errors of a step to `t` with order `k` make of the energy: the power of those of velocities
/// less the work of all forces along those of positions. What rounding makes of it is what the weights of the states in the differences sum up to,
/// times half the last digit of each.
fn energy_error(system: &System, order: usize, t: f64, history: &History<'_>, work: &mut Workspace) {
    let time = |j: usize| if j == 0 { t } else { history.time(j - 1) };
    let weight = |j: usize| (0..=order + 1).filter(|&i| i != j).map(|i| time(j) - time(i)).product::<f64>().recip().abs();
    let weights = reach(order, t, history) * (0..=order + 1).map(weight).sum::<f64>();
    let Workspace { full, estimate, start, end, a, d, .. } = work;
    let (mut made, mut size) = (0.0, 0.0);
    system.mass.times(system.dim, &end.v, full);
    for (k, error) in estimate.v.iter().enumerate() {
        made += full[k] * error;
        size += (full[k] * end.v[k]).abs();
    }
    system.mass.times(system.dim, a, full);
    for (k, error) in estimate.q.iter().enumerate() {
        made -= full[k] * error;
        size += (full[k] * (start.x[k] + d[k])).abs();
    }
    (estimate.energy, estimate.rounded) = (made, 0.5 * f64::EPSILON * weights * size);
}
