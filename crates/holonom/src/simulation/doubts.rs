//! What the energy balance does not show: work of forces without a potential that steps are too long for, forces that act for a few steps only, and
//! positions and velocities off rows that a method does not hold.

use serde::{Deserialize, Serialize};

/// What is not sure of the work of forces without a potential, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct UnsureWork {
    /// By how much it would be another by Simpson's rule, and the largest of that so far.
    sum: f64,
    largest: f64,
    /// The force that differed most in one step, by its number among the working forces, and by how much.
    most: (usize, f64),
}

impl UnsureWork {
    /// Adds by how much the work of a step would be another, and that of the force that differs most.
    pub fn add(&mut self, (by, most): (f64, (usize, f64))) {
        self.sum += by;
        self.largest = self.largest.max(self.sum.abs());
        if most.1.abs() > self.most.1.abs() {
            self.most = most;
        }
    }

    /// The largest so far, J, and the number of the force that differs most.
    pub fn largest(&self) -> (f64, usize) {
        (self.largest, self.most.0)
    }
}

/// Steps at the start of a run that are all looked at for how fast motion changes, and how many there are from one look to the next later.
const FIRST: u64 = 16;
const LATER: u64 = 16;

/// Share of the kinetic energy that is in changes of velocity within a step from which on a step is fast: of a vibration a step passes a radian there.
const FAST: f64 = 0.2;

/// Share of the looks that find fast steps from which on it is no transient.
const LASTING: f64 = 0.25;

/// Fewest looks that say something.
const FEWEST: u64 = 8;

/// How fast the motion changes from step to step: sums over the looks at some of the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Haste {
    /// Looks, and those that found a fast step.
    looks: u64,
    fast: u64,
    /// Kinetic energy of half the change of velocity in the step, and the mean of those at its ends, J.
    change: f64,
    kinetic: f64,
}

impl Haste {
    /// Whether the step of this number is looked at.
    pub fn looks_at(step: u64) -> bool {
        step <= FIRST || step.is_multiple_of(LATER)
    }

    /// Looks at a step.
    pub fn look(&mut self, change: f64, kinetic: f64) {
        self.looks += 1;
        self.fast += u64::from(change > FAST * kinetic);
        self.change += change;
        self.kinetic += kinetic;
    }

    /// The mean kinetic energy, J, where much of it is in fast steps and these last: half the change of velocity over the velocity is the sine of half
    /// the angle by which a method of order 2 turns a vibration in a step, 2 atan(ωh/2).
    pub fn of_vibrations(&self) -> Option<f64> {
        let looks = self.looks as f64;
        let is_fast = self.looks >= FEWEST && self.fast as f64 > LASTING * looks && self.change > FAST * self.kinetic;
        is_fast.then(|| self.kinetic / looks)
    }
}

/// Share of the impulses of joints from steps in which their forces jump, from which on these are much of what joints bear.
const JUMPY: f64 = 0.25;

/// What multipliers do from step to step: sums over all steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Unrest {
    /// Steps in which they change by about as much as they are.
    jumps: u64,
    /// Impulses of these and of all steps, m/s over the size of the mechanism, and the time of all, s.
    jumping: f64,
    all: f64,
    time: f64,
}

impl Unrest {
    /// Looks at a step of length `h` (s): the squares of half the change of what multipliers pull at and the mean of those at its ends, 1/s⁴.
    pub fn look(&mut self, h: f64, change: f64, size: f64) {
        let impulse = h * size.sqrt();
        if change > FAST * size {
            self.jumps += 1;
            self.jumping += impulse;
        }
        self.all += impulse;
        self.time += h;
    }

    /// The mean pull, 1/s², where much of it is in steps in which it jumps.
    pub fn mean(&self) -> Option<f64> {
        (self.jumps >= FEWEST && self.jumping > JUMPY * self.all).then(|| self.all / self.time)
    }
}

/// A row and how far positions are off it, m, or velocities, m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Stray {
    pub row: usize,
    pub way: f64,
}

impl Stray {
    fn farther(self, other: Self) -> Self {
        if other.way > self.way { other } else { self }
    }
}

/// The row that positions or velocities were farthest off at the end of a nominal step, and that of the last step, which may be part of one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Strays {
    pub farthest: Stray,
    pub last: Stray,
}

impl Strays {
    /// Looks at the rows Φ or Φ̇ after a step, which are |Φ_k| over the size of their gradients off, m, or |Φ̇_k|, m/s.
    pub fn look(&mut self, rows: &[f64], gradient: &[f64]) {
        let ways = rows.iter().zip(gradient).map(|(off, gradient)| off.abs() / gradient).enumerate();
        self.last = ways.map(|(row, way)| Stray { row, way }).fold(Stray::default(), Stray::farther);
    }

    /// Keeps what was seen last, at the end of a nominal step.
    pub fn keep(&mut self) {
        self.farthest = self.farthest.farther(self.last);
    }

    /// Keeps what another knows.
    pub fn follow(&mut self, other: &Self) {
        self.farthest = self.farthest.farther(other.farthest);
    }
}

/// Most steps that a force acts for without a note. Of a half wave that four see the largest value is missed by up to 8 %, of one that fewer see by
/// up to all of it.
const FEW: f64 = 4.0;

/// Rounding of the times that steps are counted by, in steps.
const COUNTED: f64 = 1e-3;

/// A time in which a force acted that does not before and after it, as that of a contact.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Touch {
    /// When the force was last seen not to act, s.
    from: f64,
    /// The longest step since, s.
    longest: f64,
    /// The largest size that was seen of it, and when, s.
    pub force: f64,
    pub at: f64,
    /// The most that it did in one step, J.
    pub energy: f64,
    /// About how many steps it acted for.
    pub steps: f64,
}

/// What was seen at the ends of steps of a force that begins and ends to act with what moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Contact {
    /// When it was looked at last, s.
    last: f64,
    /// Whether it was seen not to act; before that nobody knows how long it has acted.
    has_rested: bool,
    now: Option<Touch>,
    /// The largest size ever, and the touch of few steps with the largest.
    largest: f64,
    brief: Option<Touch>,
}

impl Contact {
    /// Looks at the time `t` (s) at the size of the force and at its power, W.
    pub fn look(&mut self, t: f64, force: f64, power: f64) {
        let step = t - self.last;
        if force == 0.0 {
            let touch = self.now.take().map(|touch| touch.ended(t, step)).filter(|touch| touch.steps <= FEW + COUNTED);
            self.brief = touch.filter(|touch| self.brief.is_none_or(|known| touch.force > known.force)).or(self.brief);
            self.has_rested = true;
        } else if self.has_rested {
            let new = Touch { from: self.last, longest: step, force, at: t, energy: 0.0, steps: 0.0 };
            let touch = self.now.get_or_insert(new);
            touch.longest = touch.longest.max(step);
            touch.energy = touch.energy.max(power.abs() * step);
            if force > touch.force {
                (touch.force, touch.at) = (force, t);
            }
        }
        self.largest = self.largest.max(force);
        self.last = t;
    }

    /// The touch of few steps with the largest force, where that is at least such a share of the largest ever.
    pub fn brief(&self, share: f64) -> Option<Touch> {
        self.brief.filter(|touch| touch.force >= share * self.largest)
    }
}

impl Touch {
    /// The same where the force was seen not to act any more at the time `t` (s), after a last step. Steps that events divide count as whole ones.
    fn ended(self, t: f64, step: f64) -> Self {
        Self { steps: (t - self.from) / self.longest.max(step) - 1.0, ..self }
    }
}
