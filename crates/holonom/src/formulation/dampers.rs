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

/// z of all together up to which no damper has to be late; below [`NEAR`] what they feel is found every [`SELDOM`] steps, else every [`OFTEN`], or at once where a
/// step is [`LONGER`] than when it was found. So much may z grow meanwhile: too large a z only takes a rate later than it had to be.
const EASY: f64 = 2.0;
const NEAR: f64 = 0.5;
const OFTEN: usize = 16;
const SELDOM: usize = 50;
const LONGER: f64 = 2.0;
const GROWTH: f64 = 1.25;

/// Arguments that are looked at for each step that goes by. In real time they are so many in each step, in turn.
const EACH_STEP: usize = 4;

/// Arguments of which this is found: that takes twice as many solutions before the first step. Of more it is taken by the masses of nodes, with how much less the
/// mass that a damper feels may be than that of the node.
const MOST: usize = 1000;
const LIGHTER: f64 = 4.0;

/// Share of a step by which rounding may have weak dampers fill more than all of it.
const ROUNDED: f64 = 1e-12;

/// Rounds in which dampers that meet are told to be weak or strong. Each leaves shares that are small enough.
const ROUNDS: usize = 4;

/// Farthest that a composition goes back through a damper, in z: what that makes of a velocity, (1 + z/2)/(1 − z/2), the other parts take back up
/// to there, and it has no bound at 2.
const BACK: f64 = 1.0;

/// What a dissipative law knows of the start of a step.
#[derive(Clone, Copy, Debug, Default)]
pub struct Damping {
    /// Rates of its arguments.
    rate: [f64; MAX_ARGUMENTS],
    /// By how much the force on each argument changes with its own rate.
    stiffness: [f64; MAX_ARGUMENTS],
    /// w_kk of each argument k, 1/kg in its units.
    own: [f64; MAX_ARGUMENTS],
    /// |w_kl|/√(w_kk w_ll) of each argument k with the one l that is looked at.
    shared: [f64; MAX_ARGUMENTS],
    /// Number of its first argument among those of all dissipative laws.
    first: usize,
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

/// What was last found of the arguments of dissipative laws.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    arguments: Vec<Felt>,
    /// Whether it is known.
    is_known: bool,
    /// Steps for which it counts.
    steps_left: usize,
    /// The argument that is looked at next in real time.
    next: usize,
    /// Length of the step where it was found, s, and the sum of all z.
    h: f64,
    sum: f64,
}

/// What an argument l feels of dampers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct Felt {
    /// w_ll: w_kl = g_k·w_l with [M Gᵀ; G 0][w_l; μ] = [g_lᵀ; 0], 1/kg in the units of l.
    own: f64,
    /// Σ ρ_kl z_k over the step, of all k, with ρ_kl = |w_kl|/√(w_kk w_ll), 1/s.
    speed: f64,
    /// Σ ρ_kl z_k/2 of the weak ones, over the step, and Σ ρ_kl of the others.
    weak: f64,
    strong: f64,
}

impl Fit {
    /// Room for the dampers of a system.
    pub fn new(system: &System) -> Self {
        let count = system.laws.iter().filter(|law| !law.law.conservative()).map(|law| law.arguments.len()).sum();
        Self { arguments: vec![Felt::default(); count], ..Self::default() }
    }

    /// Takes over another one of the same system.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { arguments, is_known, steps_left, next, h, sum } = other;
        self.arguments.copy_from_slice(arguments);
        (self.is_known, self.steps_left, self.next, self.h, self.sum) = (*is_known, *steps_left, *next, *h, *sum);
    }
}

impl Newton {
    /// Finds for each dissipative law at which share of a step of length `h` (s) it takes its rates.
    ///
    /// # Errors
    /// Where a composition goes back in time through a damper so strong that the whole step could make energy of nothing.
    pub fn fit_dampers(&mut self, system: &System, start: f64, h: f64, work: &mut Workspace) -> Result<(), Failure> {
        if self.fit.arguments.is_empty() {
            return Ok(());
        }
        let mut dampers = std::mem::take(&mut work.forces.damping);
        let mut count = 0;
        for (law, damping) in system.laws.iter().zip(&mut dampers).filter(|(law, _)| !law.law.conservative()) {
            damping.begin(system, law, start, work);
            damping.first = count;
            count += law.arguments.len();
        }
        self.feel(system, h, &mut dampers, work);
        let outcome = be_late(h, &mut dampers, &self.fit);
        work.forces.damping = dampers;
        outcome
    }

    /// Finds what dampers feel, once in a while or, in real time, where every step does the same work, of a few in each step.
    fn feel(&mut self, system: &System, h: f64, dampers: &mut [Damping], work: &mut Workspace) {
        if self.fit.arguments.len() > MOST {
            return self.feel_by_nodes(system, h.abs(), dampers, work);
        }
        let is_real_time = self.settings.iterations.is_some();
        let sum = h.abs() * self.take_own(system, dampers);
        let fit = &mut self.fit;
        let still_counts = fit.steps_left > 0 && (sum <= EASY || (fit.sum > NEAR && h.abs() <= LONGER * fit.h));
        if fit.is_known && still_counts && !is_real_time {
            fit.steps_left -= 1;
            return;
        }
        work.end.at.copy_from(&work.start.at);
        if !self.factor_inertia(work) {
            self.fit.is_known = false;
            return;
        }
        let arguments = || {
            let laws = system.laws.iter().enumerate().filter(|(_, law)| !law.law.conservative());
            laws.flat_map(|(k, law)| (0..law.arguments.len()).map(move |i| (k, i))).enumerate()
        };
        let count = self.fit.arguments.len();
        let some = if is_real_time && self.fit.is_known { count.min(EACH_STEP) } else { count };
        if !self.fit.is_known {
            for (l, of) in arguments() {
                self.push_along(system, of, work);
                self.fit.arguments[l].own = self.moved_along(system, of, work).abs();
            }
            self.take_own(system, dampers);
        }
        for (l, (law, i)) in arguments().cycle().skip(self.fit.next).take(some) {
            self.push_along(system, (law, i), work);
            let own = dampers[law].own[i];
            for (_, (law, i)) in arguments() {
                // What hardly moves at all is known from its own push, and not from that of others.
                let both = (own * dampers[law].own[i]).sqrt();
                dampers[law].shared[i] = if both > 0.0 { (self.moved_along(system, (law, i), work).abs() / both).min(1.0) } else { 0.0 };
            }
            self.fit.arguments[l] = Felt::of(self.moved_along(system, (law, i), work).abs(), h.abs(), dampers);
        }
        let sum = h.abs() * self.take_own(system, dampers);
        let fit = &mut self.fit;
        fit.is_known = fit.arguments.iter().all(|felt| felt.own.is_finite() && felt.speed.is_finite());
        fit.steps_left = (count / EACH_STEP).max(if sum > NEAR { OFTEN } else { SELDOM });
        fit.next = (fit.next + some) % count;
        (fit.h, fit.sum) = (h.abs(), sum);
    }

    /// Takes for what dampers feel in a step of `h` (s) the most that it is at one of their nodes, by the masses there.
    fn feel_by_nodes(&mut self, system: &System, h: f64, dampers: &mut [Damping], work: &mut Workspace) {
        // At each node: how many dampers, the sum of their speeds, and what is weak of it and how many are strong.
        let mut room = [&mut work.full, &mut work.inertial].map(std::mem::take);
        let [(counts, sums), (weak, strong)] = room.each_mut().map(|room| {
            room.fill(0.0);
            room.split_at_mut(system.free)
        });
        let each = |dampers: &[Damping], see: &mut dyn FnMut(usize, usize, f64)| {
            for (law, damping) in dampers.iter().enumerate() {
                for i in (0..MAX_ARGUMENTS).filter(|&i| damping.stiffness[i] > 0.0) {
                    let moves = |node: usize, pull: f64| {
                        see(damping.first + i, node, LIGHTER * pull * work.scales.agility[node] * damping.stiffness[i])
                    };
                    each_pull(system, law, i, work, moves);
                }
            }
        };
        each(dampers, &mut |_, node, speed| (counts[node], sums[node]) = (counts[node] + 1.0, sums[node] + speed));
        each(dampers, &mut |_, node, speed| match 0.5 * h * speed * counts[node] <= 1.0 {
            true => weak[node] += 0.5 * speed,
            false => strong[node] += 1.0,
        });
        self.fit.arguments.fill(Felt::default());
        each(dampers, &mut |l, node, speed| {
            let felt = &mut self.fit.arguments[l];
            let here = Felt { own: felt.own.max(speed), speed: felt.speed.max(sums[node]), weak: weak[node], strong: strong[node] };
            *felt = if here.share(h) < felt.share(h) { here } else { Felt { own: here.own, speed: here.speed, ..*felt } };
        });
        for damping in &mut *dampers {
            for i in (0..MAX_ARGUMENTS).filter(|&i| damping.stiffness[i] > 0.0) {
                damping.own[i] = self.fit.arguments[damping.first + i].own / (GROWTH * damping.stiffness[i]);
            }
        }
        self.fit.is_known = true;
        [work.full, work.inertial] = room;
    }

    /// Takes what is known of each argument alone. The sum of their z over the step, 1/s.
    fn take_own(&self, system: &System, dampers: &mut [Damping]) -> f64 {
        let mut sum = 0.0;
        for (law, damping) in system.laws.iter().zip(dampers).filter(|(law, _)| !law.law.conservative()) {
            for i in 0..law.arguments.len() {
                damping.own[i] = self.fit.arguments[damping.first + i].own;
                sum += damping.speed(i);
            }
        }
        sum
    }

    /// Leaves in the unknowns how all moves with a push along an argument of a law.
    fn push_along(&mut self, system: &System, (law, argument): (usize, usize), work: &Workspace) {
        self.unknowns.fill(0.0);
        each_slot(system, law, argument, work, |node, g| {
            let at = &mut self.unknowns[node * system.dim..];
            at.iter_mut().zip(g).for_each(|(sum, g)| *sum += g);
        });
        self.kkt.solve(&mut self.unknowns);
    }

    /// How an argument of a law moves with that.
    fn moved_along(&self, system: &System, (law, argument): (usize, usize), work: &Workspace) -> f64 {
        let mut sum = 0.0;
        each_slot(system, law, argument, work, |node, g| {
            sum += g.iter().zip(&self.unknowns[node * system.dim..]).map(|(g, w)| g * w).sum::<f64>();
        });
        sum
    }
}

impl Felt {
    /// Of an argument that has so much `shared` with each.
    fn of(own: f64, h: f64, dampers: &[Damping]) -> Self {
        let meets = || {
            let all = dampers.iter().flat_map(|damping| (0..MAX_ARGUMENTS).map(|i| (damping.shared[i], damping.speed(i))));
            all.filter(|(_, speed)| *speed > 0.0)
        };
        let mut felt = Self { own, speed: meets().map(|(shared, speed)| shared * speed).sum(), weak: 0.0, strong: f64::INFINITY };
        for _ in 0..ROUNDS {
            let share = felt.share(h);
            (felt.weak, felt.strong) = (0.0, 0.0);
            for (shared, speed) in meets() {
                match 0.5 * h * speed <= share {
                    true => felt.weak += 0.5 * shared * speed,
                    false => felt.strong += shared,
                }
            }
        }
        felt
    }

    /// The largest β with Σ ρ_kl min(z_k/2, β) ≤ 1 in a step of `h` (s), or a smaller one in other steps than that of which it was found.
    fn share(&self, h: f64) -> f64 {
        // Weak ones that fill a step but for rounding leave nothing to others, and keep what they have where there are none.
        ((1.0 + ROUNDED - h * self.weak) / self.strong).clamp(0.0, 1.0)
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

    /// z of an argument alone, over the step, 1/s.
    fn speed(&self, argument: usize) -> f64 {
        GROWTH * self.stiffness[argument] * self.own[argument]
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

/// Has dampers take their rates as late as it takes for them not to ring together in a step of `h` (s): (1 − θ) z is no more than what dampers share where each
/// is. A weak one keeps the mean rate: so it stays of order 2 beside one that is overdamped.
///
/// # Errors
/// Where a step back in time goes too far back through a damper: nothing rings there, but dampers make energy.
fn be_late(h: f64, dampers: &mut [Damping], fit: &Fit) -> Result<(), Failure> {
    let (mut largest, mut most) = (0.0, (0.0, 0));
    for (law, damping) in dampers.iter_mut().enumerate() {
        let mut early = 0.5_f64;
        for i in (0..MAX_ARGUMENTS).filter(|&i| damping.stiffness[i] > 0.0) {
            let felt = fit.arguments[damping.first + i];
            let (z, share) = if fit.is_known { (h.abs() * damping.speed(i), felt.share(h.abs())) } else { (f64::INFINITY, 0.0) };
            early = early.min(share / z);
            largest = z.max(h.abs() * felt.speed).max(largest);
            if z > most.0 {
                most = (z, law);
            }
        }
        damping.late = if h > 0.0 { 1.0 - 2.0 * early } else { 0.0 };
    }
    if h < 0.0 && largest > BACK { Err(Failure::GoesBack { law: most.1 }) } else { Ok(()) }
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
