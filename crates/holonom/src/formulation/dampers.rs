//! Dampers that do not ring: at which share of a step the rate is that a dissipative law takes.
//!
//! The mean rate of a step lets a damper c between masses m turn a motion round when z = h c/m is above 2: one step makes
//! (2 − z)/(2 + z) of a velocity. At the rate θ ẋ₁ + (1 − θ) ẋ₀ it is (1 − (1 − θ) z)/(1 + θ z), which is never negative with
//! θ = max(½, 1 − 1/z): then order 2 stays, as z falls with the step, and what is overdamped stands still.

use std::cell::LazyCell;

use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::newton::Newton;
use super::workspace::Workspace;
use crate::system::{Evaluation, Law, LawEntry, MAX_ARGUMENTS, Reach, Response, System};

/// z by the masses of single nodes from which on it is found with what else holds these: that may make it larger, as a rod's end
/// is lighter than the rod.
const NOTICED: f64 = 0.02;

/// z from which on it is found every [`OFTEN`] steps, and every [`SELDOM`] below; by how much it may grow meanwhile. Too large a z
/// only takes a rate later than it had to be.
const NEAR: f64 = 0.5;
const OFTEN: u32 = 16;
const SELDOM: u32 = 50;
const GROWTH: f64 = 1.25;

/// Arguments of laws whose z is found together; of more it is taken by the masses of nodes.
const MOST: usize = 64;

/// Farthest that a composition goes back through a damper, in z: what that makes of a velocity, (1 + z/2)/(1 − z/2), the other parts take back up
/// to there, and it has no bound at 2.
const BACK: f64 = 1.0;

/// How much less than the mass of a node the mass that a damper feels there may be, where it is not found.
const LIGHTER: f64 = 4.0;

/// What a dissipative law knows of the start of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Damping {
    /// Rates of its arguments.
    rate: [f64; MAX_ARGUMENTS],
    /// By how much the force on each argument changes with its own rate.
    stiffness: [f64; MAX_ARGUMENTS],
    /// z over the step, of the argument that rings most, 1/s.
    speed: f64,
    /// 2θ − 1
    late: f64,
}

impl Damping {
    /// Whether the law takes its rates later than in the middle of the step.
    pub(super) fn is_late(&self) -> bool {
        self.late > 0.0
    }

    /// Forces of a law between two positions, at the mean rate of the step or later, by values at its end. `out` arrives zeroed.
    pub(super) fn respond(&self, law: &dyn Law, reach: Reach<'_>, out: &mut Response) {
        if self.late == 0.0 {
            return law.between(reach, out);
        }
        let Reach { from, to, step, middle } = reach;
        let (mut value, mut rate) = ([0.0; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS]);
        for i in 0..from.len() {
            value[i] = 0.5 * (from[i] + to[i]);
            // 2 Δx/h − ẋ₀ is the rate at the end.
            rate[i] = (1.0 + self.late) * (to[i] - from[i]) / step - self.late * self.rate[i];
        }
        law.at(&value[..from.len()], &rate[..from.len()], middle, out);
        for i in 0..from.len() {
            for j in 0..from.len() {
                out.by_value[i][j] = 0.5 * out.by_value[i][j] + (1.0 + self.late) / step * out.by_rate[i][j];
                out.by_rate[i][j] = 0.0;
            }
        }
    }
}

/// What was last found of all dampers together.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// z over its bound by the masses of nodes.
    share: f64,
    /// Steps for which that counts.
    steps_left: u32,
}

impl Newton {
    /// Finds for each dissipative law at which share of a step of length `h` (s) it takes its rates.
    ///
    /// # Errors
    /// Where a composition goes back in time through a damper so strong that the whole step could make energy of nothing.
    pub fn fit_dampers(&mut self, system: &System, start: f64, h: f64, work: &mut Workspace) -> Result<(), Failure> {
        if !work.forces.dissipative {
            return Ok(());
        }
        let mut dampers = std::mem::take(&mut work.forces.damping);
        let mut count = 0;
        for (law, damping) in system.laws.iter().zip(&mut dampers).filter(|(law, _)| !law.law.conservative()) {
            damping.begin(system, law, start, work);
            count += law.arguments.len();
        }
        bound_by_nodes(system, &mut dampers, work);
        // A composition goes back in some of its steps. Nothing rings there, but dampers make energy.
        let share = if self.fit.share > 0.0 { self.fit.share } else { LIGHTER };
        let bound = dampers.iter().map(|damping| damping.speed).fold(0.0, f64::max);
        if let Some(law) = dampers.iter().position(|damping| -h * share * damping.speed > BACK) {
            work.forces.damping = dampers;
            return Err(Failure::GoesBack { law });
        }
        dampers.iter_mut().for_each(|damping| damping.late = 0.0);
        if h * bound > NOTICED {
            // In real time every step does the same work.
            let may_find = count <= MOST && self.settings.iterations.is_none();
            let share = self.share(system, h, bound, may_find, &dampers, work);
            if h * share * bound > 2.0 {
                be_late(system, h * share, &mut dampers, work);
            }
        }
        work.forces.damping = dampers;
        Ok(())
    }

    /// What rows and other masses make of the bound by nodes, over it: found once in a while.
    fn share(&mut self, system: &System, h: f64, bound: f64, may_find: bool, dampers: &[Damping], work: &mut Workspace) -> f64 {
        if self.fit.steps_left > 0 && (self.fit.steps_left <= OFTEN || h * self.fit.share * bound < NEAR) {
            self.fit.steps_left -= 1;
            return self.fit.share;
        }
        let Some(found) = may_find.then(|| self.find_with_rows(system, dampers, work)).flatten() else { return LIGHTER };
        self.fit = Fit { share: GROWTH * found / bound, steps_left: if GROWTH * h * found < NEAR { SELDOM } else { OFTEN } };
        self.fit.share
    }

    /// The largest z over the step with what rows and other masses hold there: Σ √(c_k c_l) |g_k w_l| with [M Gᵀ; G 0][w; μ] = [gᵀ; 0].
    fn find_with_rows(&mut self, system: &System, dampers: &[Damping], work: &mut Workspace) -> Option<f64> {
        let n = system.coordinates();
        work.end.at.copy_from(&work.start.at);
        if !self.factor_inertia(work) {
            return None;
        }
        let mut largest = 0.0_f64;
        for k in 0..dampers.len() {
            for (i, c) in dampers[k].stiffness.into_iter().enumerate().filter(|(_, c)| *c > 0.0) {
                self.unknowns.fill(0.0);
                each_slot(system, k, i, work, |node, g| {
                    let at = &mut self.unknowns[node * system.dim..];
                    at.iter_mut().zip(g).for_each(|(sum, g)| *sum += g);
                });
                self.kkt.solve(&mut self.unknowns);
                let mut sum = 0.0;
                for (l, other) in dampers.iter().enumerate() {
                    for (j, d) in other.stiffness.into_iter().enumerate().filter(|(_, d)| *d > 0.0) {
                        let mut product = 0.0;
                        each_slot(system, l, j, work, |node, g| {
                            product += g.iter().zip(&self.unknowns[node * system.dim..n]).map(|(g, w)| g * w).sum::<f64>();
                        });
                        sum += (c * d).sqrt() * product.abs();
                    }
                }
                if !sum.is_finite() {
                    return None;
                }
                largest = largest.max(sum);
            }
        }
        Some(largest)
    }
}

impl Damping {
    /// Takes rates and stiffness from the start of a step.
    fn begin(&mut self, system: &System, law: &LawEntry, t: f64, work: &Workspace) {
        let Braking { rate, slope, power } = Braking::of(system, law, t, &work.start.at, &work.start.v);
        self.rate = rate;
        // Of friction that slides the force hardly changes with the rate: what counts is what would stop it.
        let secant = |i: usize| if rate[i] == 0.0 { 0.0 } else { power[i] / (rate[i] * rate[i]) };
        self.stiffness = std::array::from_fn(|i| slope[i].abs().max(secant(i)));
    }
}

/// What dissipative laws would take in a step of length `h` (s) of motions that it turned round, J: of each argument by the less of the powers
/// at the ends of the step, at the times `t` (s); and the law that would take most. No damper turns a motion round, but a method may do so
/// where its steps are too long for the damper. What stands still but for its rounding turns round with that.
pub fn taken_of_turned(system: &System, t: [f64; 2], h: f64, work: &Workspace) -> (f64, Option<usize>) {
    let (mut sum, mut most) = (0.0, (0.0, None));
    // Velocities may be as sure as increments of rounded positions over half the step.
    let rounding = LazyCell::new(|| system.rounding(&work.end.x, &work.end.v, Some(0.5 * h.abs())));
    for (k, law) in system.laws.iter().enumerate().filter(|(_, law)| !law.law.conservative()) {
        let [from, to] = [(t[0], &work.start), (t[1], &work.end)].map(|(t, end)| Braking::of(system, law, t, &end.at, &end.v));
        let rounded = |i: usize| system.rounding_of_quantity(law.arguments[i], &work.end.at, *rounding)[1];
        let has_turned = |&i: &usize| {
            let (before, after) = (from.rate[i], to.rate[i]);
            before * after < 0.0 && before.abs().min(after.abs()) > rounded(i)
        };
        let turned = (0..law.arguments.len()).filter(has_turned);
        let taken: f64 = h.abs() * turned.map(|i| from.power[i].min(to.power[i]).max(0.0)).sum::<f64>();
        sum += taken;
        if taken > most.0 {
            most = (taken, Some(k));
        }
    }
    (sum, most.1)
}

/// What a law does to the motion of each of its arguments.
struct Braking {
    /// Rate of the argument.
    rate: [f64; MAX_ARGUMENTS],
    /// By how much the force changes with that.
    slope: [f64; MAX_ARGUMENTS],
    /// Power that the part of the force takes that turns round with the rates, W.
    power: [f64; MAX_ARGUMENTS],
}

impl Braking {
    fn of(system: &System, law: &LawEntry, t: f64, at: &Evaluation, v: &[f64]) -> Self {
        let ([values, rate], m) = (system.arguments_and_rates(law, at, v), law.arguments.len());
        let respond = |rate: &[f64; MAX_ARGUMENTS]| {
            let mut response = Response::default();
            law.law.at(&values[..m], &rate[..m], t, &mut response);
            response
        };
        let along = respond(&rate);
        // Each rate turns round alone: the force along one that hardly moves is that of the others.
        let power = |i: usize| {
            let mut turned = rate;
            turned[i] = -turned[i];
            if i < m { 0.5 * (along.force[i] - respond(&turned).force[i]) * rate[i] } else { 0.0 }
        };
        Self { rate, slope: std::array::from_fn(|i| along.by_rate[i][i]), power: std::array::from_fn(power) }
    }
}

/// Has dampers take their rates as late as it takes for them not to ring together: with Σ (1 − θ) z ≤ 1 at each node, over the z of each alone in a step of `h`
/// (s, over the share of the mass that they feel). Where as many equal ones would not ring a damper keeps the mean rate, and the others share what is left
/// alike: so a weak one stays of order 2 beside one that is overdamped.
fn be_late(system: &System, h: f64, dampers: &mut [Damping], work: &mut Workspace) {
    let [mut counts, mut left] = [&mut work.full, &mut work.inertial].map(std::mem::take);
    let (all, strong) = counts.split_at_mut(system.free);
    let each = |k: usize, damping: &Damping, see: &mut dyn FnMut(usize, f64)| {
        for (i, c) in damping.stiffness.into_iter().enumerate().filter(|(_, c)| *c > 0.0) {
            each_pull(system, k, i, work, |node, pull| match h * c * pull * work.scales.agility[node] {
                z if z > 0.0 => see(node, z),
                _ => (),
            });
        }
    };
    let is_weak = |z: f64, count: f64| 0.5 * z * count <= 1.0;
    all.fill(0.0);
    strong.fill(0.0);
    left.fill(1.0);
    for (k, damping) in dampers.iter().enumerate() {
        each(k, damping, &mut |node, _| all[node] += 1.0);
    }
    for (k, damping) in dampers.iter().enumerate() {
        each(k, damping, &mut |node, z| match is_weak(z, all[node]) {
            true => left[node] -= 0.5 * z,
            false => strong[node] += 1.0,
        });
    }
    for (k, damping) in dampers.iter_mut().enumerate() {
        let mut early = 0.5_f64;
        each(k, damping, &mut |node, z| {
            if !is_weak(z, all[node]) {
                early = early.min(left[node] / (strong[node] * z));
            }
        });
        damping.late = 1.0 - 2.0 * early;
    }
    (work.full, work.inertial) = (counts, left);
}

/// Bounds z over the step by Σ c |g| Σ |g| over the mass of each node: by Gershgorin no eigenvalue of M⁻¹ Gᵀ c G is larger where M
/// is diagonal.
fn bound_by_nodes(system: &System, dampers: &mut [Damping], work: &mut Workspace) {
    let mut pull = std::mem::take(&mut work.full);
    pull.fill(0.0);
    for (k, damping) in dampers.iter().enumerate() {
        for (i, c) in damping.stiffness.into_iter().enumerate().filter(|(_, c)| *c > 0.0) {
            each_pull(system, k, i, work, |node, of_slot| pull[node] += c * of_slot);
        }
    }
    for (k, damping) in dampers.iter_mut().enumerate() {
        damping.speed = 0.0;
        for i in (0..MAX_ARGUMENTS).filter(|&i| damping.stiffness[i] > 0.0) {
            each_slot(system, k, i, work, |node, _| damping.speed = damping.speed.max(pull[node] * work.scales.agility[node]));
        }
    }
    work.full = pull;
}

/// Shows |g| Σ |g| of an argument of a law at the start of a step, slot by slot.
fn each_pull(system: &System, law: usize, argument: usize, work: &Workspace, mut see: impl FnMut(usize, f64)) {
    let size = |g: &[f64]| g.iter().map(|g| g * g).sum::<f64>().sqrt();
    let mut all = 0.0;
    each_slot(system, law, argument, work, |_, g| all += size(g));
    each_slot(system, law, argument, work, |node, g| see(node, size(g) * all));
}

/// Shows the gradient of an argument of a law at the start of a step, free node by free node.
fn each_slot(system: &System, law: usize, argument: usize, work: &Workspace, mut see: impl FnMut(usize, &[f64])) {
    for slot in system.slots_of(system.laws[law].arguments[argument]) {
        let node = system.slots.nodes[slot] as usize;
        if node < system.free {
            see(node, &work.start.at.gradient[slot * system.dim..(slot + 1) * system.dim]);
        }
    }
}
