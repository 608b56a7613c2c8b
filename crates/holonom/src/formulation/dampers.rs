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

/// z from which on what dampers feel is found every [`OFTEN`] steps, and every [`SELDOM`] below; by how much it may grow meanwhile. Too large a z
/// only takes a rate later than it had to be.
const NEAR: f64 = 0.5;
const OFTEN: u32 = 16;
const SELDOM: u32 = 50;
const GROWTH: f64 = 1.25;

/// Arguments of laws of which it is found; of more z is taken by the masses of nodes.
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

/// What was last found of all dampers together.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Fit {
    /// Of each two arguments l and k of dissipative laws z of l alone, over c_l and the step, as far as a push along l moves k: |w_kl| √(w_ll/w_kk) with
    /// w_kl = g_k·w_l and [M Gᵀ; G 0][w_l; μ] = [g_lᵀ; 0], 1/kg in the units of l.
    felt: Vec<f64>,
    /// Whether it is known.
    is_known: bool,
    /// Steps for which it counts.
    steps_left: u32,
}

impl Fit {
    /// Room for the dampers of a system.
    pub fn new(system: &System) -> Self {
        let count: usize = system.laws.iter().filter(|law| !law.law.conservative()).map(|law| law.arguments.len()).sum();
        let room = if count > MOST { 0 } else { count * count };
        Self { felt: vec![0.0; room], is_known: false, steps_left: 0 }
    }

    /// Takes over another one of the same system.
    pub fn copy_from(&mut self, other: &Self) {
        self.felt.clone_from(&other.felt);
        (self.is_known, self.steps_left) = (other.is_known, other.steps_left);
    }

    /// At least the largest z of all together, over the step, 1/s.
    fn bound(&self, count: usize, dampers: &[Damping]) -> f64 {
        let mut sum = 0.0;
        each_active(dampers, |k, i| sum += GROWTH * dampers[k].stiffness[i] * self.felt[(dampers[k].first + i) * (count + 1)]);
        sum
    }
}

/// Shows the arguments of laws whose forces change with their rates.
fn each_active(dampers: &[Damping], mut see: impl FnMut(usize, usize)) {
    for (k, damping) in dampers.iter().enumerate() {
        (0..MAX_ARGUMENTS).filter(|&i| damping.stiffness[i] > 0.0).for_each(|i| see(k, i));
    }
}

/// Where dampers meet.
trait Meeting {
    /// Shows the z of an argument of a law over the step at each place where it is felt, 1/s.
    fn each(&self, law: usize, damping: &Damping, argument: usize, see: impl FnMut(usize, f64));
}

/// Each argument of a dissipative law, with its number.
struct Found<'a> {
    felt: &'a [f64],
    count: usize,
}

impl Meeting for Found<'_> {
    fn each(&self, _: usize, damping: &Damping, argument: usize, mut see: impl FnMut(usize, f64)) {
        let (c, l) = (GROWTH * damping.stiffness[argument], damping.first + argument);
        self.felt[l * self.count..][..self.count].iter().enumerate().for_each(|(k, felt)| see(k, c * felt));
    }
}

/// Each node, by its own mass.
struct ByNodes<'a> {
    system: &'a System,
    work: &'a Workspace,
}

impl Meeting for ByNodes<'_> {
    fn each(&self, law: usize, damping: &Damping, argument: usize, mut see: impl FnMut(usize, f64)) {
        let c = LIGHTER * damping.stiffness[argument];
        each_pull(self.system, law, argument, self.work, |node, pull| see(node, c * pull * self.work.scales.agility[node]));
    }
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
            damping.first = count;
            count += law.arguments.len();
        }
        // In real time every step does the same work.
        let may_find = count <= MOST && self.settings.iterations.is_none();
        let outcome = if may_find && self.find_felt(system, h, count, &dampers, work) {
            let (mut room, felt) = ([[0.0; 2 * MOST]; 2], &self.fit.felt[..]);
            be_late(h, &mut dampers, room.each_mut().map(|room| &mut room[..2 * count]), &Found { felt, count })
        } else {
            let mut room = [&mut work.full, &mut work.inertial].map(std::mem::take);
            let room_of_nodes = room.each_mut().map(|room| &mut room[..2 * system.free]);
            let outcome = be_late(h, &mut dampers, room_of_nodes, &ByNodes { system, work });
            [work.full, work.inertial] = room;
            outcome
        };
        work.forces.damping = dampers;
        outcome
    }

    /// Finds what dampers feel with rows and other masses, once in a while. Says whether it is known.
    fn find_felt(&mut self, system: &System, h: f64, count: usize, dampers: &[Damping], work: &mut Workspace) -> bool {
        let is_weak = |fit: &Fit| h.abs() * fit.bound(count, dampers) < NEAR;
        let fit = &mut self.fit;
        if fit.is_known && fit.steps_left > 0 && (fit.steps_left <= OFTEN || is_weak(fit)) {
            fit.steps_left -= 1;
            return true;
        }
        fit.is_known = false;
        work.end.at.copy_from(&work.start.at);
        if !self.factor_inertia(work) {
            return false;
        }
        let of_dissipative = || system.laws.iter().enumerate().filter(|(_, law)| !law.law.conservative());
        let arguments = || of_dissipative().flat_map(|(k, law)| (0..law.arguments.len()).map(move |i| (k, i)));
        let mut own = [0.0_f64; MOST];
        for (l, (law, i)) in arguments().enumerate() {
            self.unknowns.fill(0.0);
            each_slot(system, law, i, work, |node, g| {
                let at = &mut self.unknowns[node * system.dim..];
                at.iter_mut().zip(g).for_each(|(sum, g)| *sum += g);
            });
            self.kkt.solve(&mut self.unknowns);
            for (k, (law, i)) in arguments().enumerate() {
                let w = &self.unknowns;
                let mut product = 0.0;
                each_slot(system, law, i, work, |node, g| {
                    product += g.iter().zip(&w[node * system.dim..]).map(|(g, w)| g * w).sum::<f64>()
                });
                self.fit.felt[l * count + k] = product.abs();
            }
            own[l] = self.fit.felt[l * count + l].sqrt();
        }
        for (at, felt) in self.fit.felt.iter_mut().enumerate() {
            let (l, k) = (at / count, at % count);
            // What hardly moves at all is known from its own push, and not from that of others.
            *felt = if own[k] > 0.0 { felt.min(own[k] * own[l]) * (own[l] / own[k]) } else { 0.0 };
        }
        self.fit.is_known = self.fit.felt.iter().all(|felt| felt.is_finite());
        self.fit.steps_left = if is_weak(&self.fit) { SELDOM } else { OFTEN };
        self.fit.is_known
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

/// Has dampers take their rates as late as it takes for them not to ring together: with Σ (1 − θ) z ≤ 1 at each place where they meet, over the z of each alone in a
/// step of `h` (s). Where as many equal ones would not ring a damper keeps the mean rate, and the others share what is left alike: so a weak one stays of order 2
/// beside one that is overdamped.
///
/// # Errors
/// Where a step back in time goes too far back through a damper: nothing rings there, but dampers make energy.
fn be_late(h: f64, dampers: &mut [Damping], [counts, sums]: [&mut [f64]; 2], meeting: &impl Meeting) -> Result<(), Failure> {
    let places = counts.len() / 2;
    let ((all, strong), (sum, left)) = (counts.split_at_mut(places), sums.split_at_mut(places));
    for room in [&mut *all, strong, sum] {
        room.fill(0.0);
    }
    left.fill(1.0);
    dampers.iter_mut().for_each(|damping| damping.late = 0.0);
    let mut most = (0.0, 0);
    each_active(dampers, |k, i| {
        meeting.each(k, &dampers[k], i, |place, speed| {
            let z = h.abs() * speed;
            all[place] += f64::from(z > 0.0);
            sum[place] += z;
            if z > most.0 {
                most = (z, k);
            }
        });
    });
    let largest = sum.iter().copied().fold(0.0, f64::max);
    if h < 0.0 {
        return if largest > BACK { Err(Failure::GoesBack { law: most.1 }) } else { Ok(()) };
    }
    if largest <= 2.0 {
        return Ok(());
    }
    let is_weak = |z: f64, count: f64| 0.5 * z * count <= 1.0;
    each_active(dampers, |k, i| {
        meeting.each(k, &dampers[k], i, |place, speed| match is_weak(h * speed, all[place]) {
            true => left[place] -= 0.5 * h * speed,
            false => strong[place] += 1.0,
        });
    });
    for (k, damping) in dampers.iter_mut().enumerate() {
        let mut early = 0.5_f64;
        for i in (0..MAX_ARGUMENTS).filter(|&i| damping.stiffness[i] > 0.0) {
            meeting.each(k, damping, i, |place, speed| {
                if !is_weak(h * speed, all[place]) {
                    early = early.min(left[place] / (strong[place] * h * speed));
                }
            });
        }
        damping.late = 1.0 - 2.0 * early;
    }
    Ok(())
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
