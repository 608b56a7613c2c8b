//! Where a mechanism comes to rest (methods §20), by pseudo-transient continuation (Kelley and Keyes 1998): steps of implicit Euler, each from rest, at
//! a time that stands still. Short ones go down the forces, and long ones are those of Newton's iteration for their balance.

use super::fall::{Fall, Falling};
use super::follow::follow;
use super::golden::GOLDEN;
use super::places::Places;
use super::start::{Asked, Start, StartError, correct_velocities};
use crate::energy;
use crate::formulation::{Failure, Prediction, RowsAt, Sampling, Stage, Workspace, solve};
use crate::linalg::largest;
use crate::system::{Cornered, System, scatter};

/// Share of its size that all forces would move the mechanism by in the first step, were nothing in their way.
pub(super) const FIRST: f64 = 0.01;

/// Share of its size and of how far it has gone by which a mechanism moves in a step at most.
const LONGEST: f64 = 0.1;

/// Share of the size, and of how far the forces would move it, that a step moves the mechanism by at its end, and of the step before that it is then, at
/// most.
const AT_REST: f64 = 1e-12;
const QUICK: f64 = 0.1;

/// A step that rounding alone makes of forces and places, over the larger of both: no other step is a tenth of it then.
const ROUNDED: f64 = 64.0 * f64::EPSILON;

/// Share of the size that a step may be off by: in long steps large forces round what hardly anything holds by more than Newton's iteration waits for, and
/// the next step mends it.
const SOLVED: f64 = 1e-9;

/// By how much steps grow after one that is slow, and shrink after one that leads nowhere.
const GROWTH: f64 = 2.0;
const SHRINKAGE: f64 = 0.25;

/// Steps until the mechanism is at rest, and sizes that it goes until then, at most.
const MOST: usize = 5000;
const FARTHEST: f64 = 100.0;

/// The least step, over the first.
const SHORTEST: f64 = 1e-12;

/// Share of the size by which a mechanism at rest is moved to see whether it comes back, and how many times that it may then be off: along what forces
/// drive on, and along what may be free.
pub(super) const PUSH: f64 = 1e-4;
const NEAR: f64 = 0.1;
const BACK: f64 = 10.0;

/// Ridges that a mechanism may come to on its way.
const RIDGES: usize = 20;

/// Why a mechanism does not come to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Restless {
    /// It goes on and on.
    Moves,
    /// Steps however short, or however many, do not lead there.
    Stuck,
    /// A row or a law has a corner on the way, and what happens there, in words.
    Corner(Cornered, &'static str),
}

impl Places {
    /// Moves the mechanism from the start of its system to where all forces balance at the time 0, downhill on the way, and stays only where it would
    /// come back to.
    ///
    /// # Errors
    /// When that is nowhere. The mechanism is where it was last then.
    pub fn settle(&mut self) -> Result<(), Restless> {
        let x = self.system.start_position().to_vec();
        self.put(&x).map_err(|_| Restless::Stuck)?;
        self.go_down()?;
        // What rounding alone has moved stays as it was: nothing but far smaller numbers would be left of the forces, and no directions.
        let is_there = apart(&x, &self.work.end.x) <= ROUNDED * self.work.scales.length;
        if is_there { self.put(&x).map_err(|_| Restless::Stuck) } else { Ok(()) }
    }

    /// Goes on from one place of rest to the next as long as it would not come back there.
    fn go_down(&mut self) -> Result<(), Restless> {
        let mut outcome = self.come_to_rest(None);
        for _ in 0..RIDGES {
            let rest = self.work.end.x.clone();
            let mut left = None;
            for fall in self.ways_down(outcome) {
                left = self.leaves(&rest, &fall, outcome)?;
                if left.is_some() {
                    break;
                }
            }
            match left {
                Some(next) => outcome = next,
                None => return self.put(&rest).map_err(|_| Restless::Stuck).and(outcome),
            }
        }
        Err(Restless::Moves)
    }

    /// Pushes the mechanism from where it has come to, with that outcome, and has it go on, in steps as long as its fall takes where that is known. With
    /// what outcome it leaves; nothing where it comes back, or stays where it was pushed to.
    ///
    /// # Errors
    /// When it falls and comes back all the same.
    fn leaves(&mut self, rest: &[f64], fall: &Fall, before: Result<(), Restless>) -> Result<Option<Result<(), Restless>>, Restless> {
        let ahead = |share: f64| rest.iter().zip(&fall.push).map(|(x, push)| x + share * push).collect::<Vec<f64>>();
        // Light links that are stretched between what is heavy let go only a little aside.
        let Some(ahead) = [1.0, 0.01].into_iter().map(ahead).find(|ahead| self.put(ahead).is_ok()) else { return Ok(None) };
        let mut falling = fall.time.map(Falling::new);
        let outcome = self.come_to_rest(falling.as_mut());
        if before.is_err() && outcome.is_err() {
            return outcome.map(|()| None);
        }
        let near = |place: &[f64], times: f64| apart(place, &self.work.end.x) <= times * PUSH * self.work.scales.length;
        // What is free stays where it was pushed to.
        let stays = if fall.time.is_some() { near(rest, NEAR) || near(&ahead, NEAR) } else { near(rest, BACK) };
        if before.is_err() || outcome.is_err() || !stays {
            return Ok(Some(outcome));
        }
        // What falls is so light that rounding of all others hides which way is down.
        if falling.is_some_and(|falling| falling.is_seen) { Err(Restless::Stuck) } else { Ok(None) }
    }

    /// How the mechanism may leave where it has come to: not at all where it is not at rest and on no ridge, near which long steps lead nowhere.
    fn ways_down(&mut self, outcome: Result<(), Restless>) -> Vec<Fall> {
        if matches!(outcome, Err(Restless::Moves | Restless::Corner(..))) {
            return Vec::new();
        }
        let x = self.work.end.x.clone();
        let falls = self.falls();
        if self.put(&x).is_err() {
            return Vec::new();
        }
        self.begin_at_end();
        match falls {
            Ok(falls) => falls,
            Err(_) if outcome.is_ok() => self.pushed().map_or(Vec::new(), |push| vec![Fall { push, time: None }]),
            Err(_) => Vec::new(),
        }
    }

    /// A move of all nodes that the rows allow.
    pub(super) fn pushed(&mut self) -> Result<Vec<f64>, StartError> {
        let push: Vec<f64> = (0..self.work.end.v.len()).map(|k| (k as f64 * GOLDEN).fract() - 0.5).collect();
        let way = self.allowed(&push)?;
        let by = PUSH * self.work.scales.length / largest(&way).max(f64::MIN_POSITIVE);
        Ok(way.iter().map(|v| by * v).collect())
    }

    /// The velocities of all nodes at the place that meet all rows and are nearest to these.
    fn allowed(&mut self, v: &[f64]) -> Result<Vec<f64>, StartError> {
        let Self { system, newton, work, .. } = self;
        let (n, impulse) = (system.coordinates(), vec![0.0; system.coordinates()]);
        work.end.v.copy_from_slice(v);
        work.end.v[n..].fill(0.0);
        correct_velocities(system, &Asked { v, impulse: &impulse, ..Asked::of(system, 1.0) }, newton, work, &mut Start::default())?;
        work.end.v[n..].fill(0.0);
        Ok(work.end.v.clone())
    }

    /// Has wheels roll, with all else, the way of the last step, which holds rows of velocities but for the square of its length.
    fn roll(&mut self) -> bool {
        let (here, mut way) = (self.work.start.x.clone(), self.work.d.clone());
        way.resize(here.len(), 0.0);
        let mut rate = |x: &[f64], _| self.put(x).ok().and_then(|()| self.allowed(&way).ok());
        let ahead = rate(&here, 0.0).and_then(|first| follow(&here, &first, [0.0, 1.0], &mut rate));
        ahead.is_some_and(|ahead| self.put(&ahead).is_ok())
    }

    /// Takes steps until hardly any of one is left, or rounding alone; the first ones as long as a fall takes, if it falls, until that is over.
    fn come_to_rest(&mut self, mut falling: Option<&mut Falling>) -> Result<(), Restless> {
        self.begin_at_end();
        // Which rows are redundant is known from here.
        if !self.newton.factor_inertia(&self.work) {
            return Err(Restless::Stuck);
        }
        let whole = self.pushed_at_most();
        let size = self.work.scales.length;
        let mut h = (FIRST * size / whole).sqrt();
        if !h.is_finite() {
            return if whole == 0.0 { Ok(()) } else { Err(Restless::Stuck) };
        }
        let least = SHORTEST * h;
        if let Some(falling) = &falling {
            h = falling.step;
        }
        let rolls = self.system.is_nonholonomic();
        let (mut gone, mut before) = (0.0, f64::INFINITY);
        let mut stuck = Restless::Stuck;
        for _ in 0..MOST {
            let longest = LONGEST * (size + gone);
            let stepped = self.step(h);
            let corner = stepped.and_then(|_| self.system.corner([&self.work.start.at, &self.work.end.at]));
            let way = stepped.filter(|_| corner.is_none());
            if way.is_none() {
                stuck = corner.map_or(Restless::Stuck, |(of, what)| Restless::Corner(of, what));
            }
            let is_at_rest = way.is_some_and(|way| self.is_at_rest(h, way, before));
            match way {
                Some(way) if way <= longest && (is_at_rest || !rolls || self.roll()) => {
                    self.begin_at_end();
                    gone += way;
                    if is_at_rest {
                        return Ok(());
                    }
                    if gone > FARTHEST * size {
                        return Err(Restless::Moves);
                    }
                    // Ways are as the squares of steps as long as nothing is in the way.
                    let growth = match falling.as_mut().and_then(|falling| falling.growth(way, PUSH * size + gone)) {
                        Some(growth) => growth,
                        None if way <= QUICK * before => 1.0,
                        None => GROWTH.min((longest / way).sqrt()),
                    };
                    (h, before) = (growth * h, way);
                }
                way if h > least => {
                    falling = None;
                    let shrinkage = way.map_or(SHRINKAGE, |way| SHRINKAGE.max(0.5 * (longest / way).sqrt()).min(0.5));
                    (h, before) = (shrinkage * h, f64::INFINITY);
                    // What a long step leaves of the rows would be uphill for short ones.
                    let x = self.work.start.x.clone();
                    self.put(&x).map_err(|_| Restless::Stuck)?;
                    self.begin_at_end();
                }
                _ => return Err(stuck),
            }
        }
        Err(stuck)
    }

    /// Whether the last step, of length h, went hardly any way, as the one before had gone `before`, or one of rounding.
    fn is_at_rest(&mut self, h: f64, way: f64, before: f64) -> bool {
        let left = self.left(h);
        let Self { system, work, .. } = self;
        let size = work.scales.length;
        // How far all forces would move the mechanism in such a step: what they move farthest may be light, and the largest of them elsewhere.
        let reach = h * h * work.pushed_at_most(system);
        let farthest = work.farthest(system, &left);
        let pushes = work.pushes(system);
        let is_small = |way: f64, lengths: f64, share: f64| way <= share * lengths && largest(&left) <= share * h * h * largest(pushes);
        if way <= QUICK * before {
            return is_small(way, size.min(reach), AT_REST);
        }
        // What is light may be on its way where hardly any force moves it: it is not if it goes along with what is heavy, or by rounding of its own forces.
        let by_rounding = |node: usize| {
            let coordinates = node * system.dim..(node + 1) * system.dim;
            let mass: f64 = system.mass.row(node).map(|(_, block)| block.m.abs() + block.s.abs()).sum();
            largest(&left[coordinates.clone()]) <= ROUNDED * (mass * (size + reach) + h * h * largest(&pushes[coordinates]))
        };
        is_small(farthest, size + reach, ROUNDED) && (way <= SOLVED * size || (0..system.free).all(by_rounding))
    }

    /// What the last step, of length h, left of the forces on the free nodes, M d + h C d, kg·m.
    fn left(&mut self, h: f64) -> Vec<f64> {
        let Self { system, work, .. } = self;
        let mut way = work.d.clone();
        way.resize(work.end.x.len(), 0.0);
        let mut left = way.clone();
        system.mass.times(system.dim, &way, &mut left);
        left.iter_mut().zip(work.resistance(system, 0.0, &way)).for_each(|(left, resisted)| *left += h * resisted);
        left.truncate(system.coordinates());
        left
    }

    /// Has the next step begin where the last one ended, at rest.
    pub(super) fn begin_at_end(&mut self) {
        let Self { system, work, angles, gauges, .. } = self;
        work.end.v.fill(0.0);
        work.start.x.copy_from_slice(&work.end.x);
        work.start.v.fill(0.0);
        work.start.at.copy_from(&work.end.at);
        angles.copy_from_slice(&work.end.at.functions.angle);
        system.measure(&work.end.x, &work.end.v, gauges);
    }

    /// How fast all forces where the next step begins would make what they push most, m/s².
    pub(super) fn pushed_at_most(&mut self) -> f64 {
        self.start_step(1.0);
        self.work.pushed_at_most(&self.system)
    }

    /// Puts the end of a step of length h, and what is sampled, where the step begins, and evaluates the forces there.
    pub(super) fn start_step(&mut self, h: f64) -> Stage {
        let Self { system, work, .. } = self;
        let stage = Stage { sampling: Sampling::End, rows: RowsAt::End, start: -h, step: h, inertia: h * h, rate: 1.0 / h };
        let Prediction { drift, offset, a_change, lambda_change } = &mut work.prediction;
        let none = [drift, offset, a_change, lambda_change, &mut work.d, &mut work.a, &mut work.lambda, &mut work.sampled.v];
        none.into_iter().for_each(|numbers| numbers.fill(0.0));
        work.end.x.copy_from_slice(&work.start.x);
        work.sampled.x.copy_from_slice(&work.start.x);
        work.place(&stage);
        work.evaluate(system, &stage);
        stage
    }

    /// A step of implicit Euler from rest, of length h; how far the node went that went farthest, m. `None` where it leads nowhere, or uphill.
    pub(super) fn step(&mut self, h: f64) -> Option<f64> {
        let stage = self.start_step(h);
        let Self { system, newton, work, .. } = self;
        let potential = |work: &Workspace| energy::potential(system, &work.forces.weight, &work.end.x, &work.end.at, None);
        let (before, at_start) = (potential(work), supplying(system, work));
        match solve(system, &stage, newton, work) {
            Ok(()) | Err(Failure::NotConverged { increment: ..SOLVED, .. }) => {}
            Err(_) => return None,
        }
        work.place(&stage);
        work.evaluate(system, &stage);
        let mean = at_start.iter().zip(supplying(system, work)).map(|(before, after)| 0.5 * (before + after));
        let done: f64 = mean.zip(&work.d).map(|(force, d)| force * d).sum();
        let pulls = work.lambda.iter().zip(&work.scales.gradient).map(|(lambda, gradient)| lambda.abs() * gradient);
        let rounding = ROUNDED * (energy::size(system, work, &work.end.x) + work.scales.length * pulls.sum::<f64>());
        (potential(work) - before - done <= rounding).then(|| largest(&work.d))
    }
}

/// How far two places are from each other at most.
fn apart(x: &[f64], other: &[f64]) -> f64 {
    x.iter().zip(other).fold(0.0, |apart: f64, (x, other)| apart.max((x - other).abs()))
}

/// The forces on all nodes, as they were sampled last, that have no potential and may supply energy, N.
fn supplying(system: &System, work: &Workspace) -> Vec<f64> {
    let (dim, mut sum) = (system.dim, vec![0.0; work.end.x.len()]);
    for (law, response) in system.laws.iter().zip(&work.forces.responses).filter(|(law, _)| law.law.may_supply()) {
        for (&id, force) in law.invariants.iter().zip(&response.force) {
            let slots = system.invariants.slots_of(id);
            let gradient = &work.sampled.at.gradient[slots.start * dim..slots.end * dim];
            scatter(dim, &system.slots.nodes[slots], -force, gradient, &mut sum);
        }
    }
    let of_loads = system.loads.iter().flat_map(|load| &load.nodes).zip(work.forces.of_loads.chunks_exact(dim));
    of_loads.for_each(|(node, force)| (0..dim).for_each(|c| sum[node.index() * dim + c] += force[c]));
    sum
}
