//! Small vibrations about a state at rest (methods §21).

use std::f64::consts::TAU;

use super::exponents::{Found, SLOWER, look_twice};
use super::slowest;
use crate::linalg::largest;
use crate::simulation::{NoRest, Places, StartError};
use crate::system::System;

/// A motion e^(s t) of the linearised equations.
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// Real part of s, 1/s: how fast it grows, or where it is negative falls off.
    pub growth: f64,
    /// Imaginary part of s over 2π, Hz; zero of what does not vibrate.
    pub frequency: f64,
    /// Real and imaginary parts of the velocities of all nodes (D × nodes), of any size; those of a vibration belong together.
    pub shape: Vec<[f64; 2]>,
}

/// What the linearised equations have.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Modes {
    /// In the order of their numbers.
    pub modes: Vec<Mode>,
    /// Of each the number.
    pub(super) numbers: Vec<usize>,
    /// Of each number the real part of s, of two the larger one.
    pub(super) growths: Vec<f64>,
    /// How many s are zero: two of each freedom that nothing resists, one of those that are only damped.
    pub free: usize,
    /// Within which of zero rounding has them, 1/s.
    pub within: f64,
    /// How many are faster than these, and are not looked for.
    pub faster: usize,
    /// How many rounding leaves open, beside those that are much faster or much slower.
    pub unsure: usize,
    /// Size of the mechanism, m, by which ways are compared with turns.
    pub length: f64,
    /// Whether drives, which stand still here, move at the start.
    pub driven: bool,
    /// Names of the forces that have kinks there, of which one side counts, or jump, of which nothing does.
    pub kinked: Vec<String>,
}

/// Why there are no modes.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum NoModes {
    /// A start that cannot be.
    #[error(transparent)]
    Start(#[from] StartError),
    /// Velocities at the start.
    #[error("the mechanism moves at the start, and modes are small vibrations about a state at rest")]
    Moving,
    /// Forces that do not balance at the start.
    #[error("forces do not balance at the start, and modes are small vibrations about a state at rest")]
    Unbalanced,
    /// A singular position.
    #[error(
        "the mechanism is at a singular position, from which it can go on in several ways or cannot go where its rows seem to let it, and motions there are no small vibrations"
    )]
    Forks,
    /// Freedoms without mass.
    #[error("something that is free to move has no mass, so that its motion has no frequency")]
    Massless,
    /// Forces of the rows at rest, or eigenvalues, that are not found.
    #[error("the forces that hold the mechanism at rest, or its motions about that, cannot be found")]
    Singular,
    /// Many freedoms, and no motion that is slower than the others.
    #[error(
        "of {0} degrees of freedom the slowest motions are looked for, and none can be told: more are free than are looked at, or all are as fast"
    )]
    Large(usize),
}

impl From<NoRest> for NoModes {
    fn from(reason: NoRest) -> Self {
        match reason {
            NoRest::Unbalanced => Self::Unbalanced,
            NoRest::Massless => Self::Massless,
            NoRest::Singular => Self::Singular,
        }
    }
}

/// Most freedoms of which all motions are found, and not the slowest alone.
pub const MOST_FREEDOMS: usize = 150;

/// Motions without order that are looked at at a singular position: each would show it.
const SOME: usize = 30;

/// By how much windows of speeds differ in which motions are found together, how many there are, and the step over the time of the middle of one: no
/// step should be as long as what grows takes.
const WIDTH: f64 = 1e3;
const WINDOWS: i32 = 4;
const AWAY: f64 = 0.83;

/// The shortest step that shows the slowest motion, over the longest.
const SHORTER: f64 = 2e-4;

/// The cosine of two shapes above which the same moves in them, and how far two exponents are apart, over the larger, that are not one that comes twice.
const ALIKE: f64 = 0.9;
const APART: f64 = 1e-6;

/// A speed over that of the mechanism's size in its fastest motion that is none.
const STILL: f64 = 1e-12;

impl Mode {
    /// The share of the critical damping, −1 … 1.
    pub fn damping(&self) -> f64 {
        // Nothing taken away, and not −0, where it stays.
        0.0 - self.growth / self.growth.hypot(TAU * self.frequency)
    }

    /// The size of the product of its shape with that of another.
    fn product(&self, other: &Self) -> f64 {
        let terms = self.shape.iter().zip(&other.shape).map(|([ar, ai], [br, bi])| [ar * br + ai * bi, ar * bi - ai * br]);
        let [re, im] = terms.fold([0.0; 2], |sum, term| [sum[0] + term[0], sum[1] + term[1]]);
        re.hypot(im)
    }

    /// Whether it vibrates, and does not only grow or fall off.
    pub fn vibrates(&self) -> bool {
        self.frequency > 0.0
    }
}

impl Modes {
    /// The number of a mode, counted from 1. What does not vibrate has two exponents under each number, which may be zero: two in which the same moves, as damping
    /// makes them of one vibration, and of those left the largest and the smallest, the next ones, and so on. What grows without vibrating comes first, by how fast; the others go by the natural frequency, |s| or √(s₁ s₂), so that they keep
    /// their numbers where damping makes two exponents of one vibration.
    pub fn number(&self, mode: usize) -> usize {
        self.numbers[mode]
    }

    /// The mode with a number that vibrates.
    pub fn vibration(&self, number: usize) -> Option<&Mode> {
        self.modes.iter().zip(&self.numbers).find(|(mode, own)| **own == number && mode.vibrates()).map(|(mode, _)| mode)
    }

    /// How fast the motion with a number grows, 1/s; of two exponents the larger one.
    pub fn growth(&self, number: usize) -> Option<f64> {
        self.growths.get(number.checked_sub(1)?).copied()
    }

    /// Numbers the modes, and puts them in that order.
    pub(super) fn numbered(mut self) -> Self {
        self.modes.sort_by(|a, b| b.growth.total_cmp(&a.growth));
        let (swinging, still): (Vec<Mode>, Vec<Mode>) = self.modes.into_iter().partition(Mode::vibrates);
        let mut all: Vec<(f64, f64, Vec<Mode>)> = Vec::new();
        let rate = |mode: &Option<Mode>| mode.as_ref().map_or(0.0, |mode| mode.growth);
        let mut number = |first: Option<Mode>, last: Option<Option<Mode>>| {
            let growth = rate(&first);
            let speed = if growth > 0.0 { -growth } else { (growth * last.as_ref().map_or(growth, rate)).sqrt() };
            all.push((speed, growth, [first, last.flatten()].into_iter().flatten().collect()));
        };
        let mut still: Vec<Option<Mode>> = still.into_iter().map(Some).collect();
        for [first, last] in of_one_vibration(&still) {
            let first = still[first].take();
            number(first, Some(still[last].take()));
        }
        still.retain(Option::is_some);
        let growing = still.partition_point(|mode| mode.as_ref().is_some_and(|mode| mode.growth > 0.0));
        still.splice(growing..growing, std::iter::repeat_with(|| None).take(self.free));
        while !still.is_empty() {
            let (first, last) = (still.remove(0), still.pop());
            number(first, last);
        }
        all.extend(swinging.into_iter().map(|mode| (mode.growth.hypot(TAU * mode.frequency), mode.growth, vec![mode])));
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.growths = all.iter().map(|(_, growth, _)| *growth).collect();
        self.numbers = (1..).zip(&all).flat_map(|(number, (_, _, modes))| vec![number; modes.len()]).collect();
        self.modes = all.into_iter().flat_map(|(_, _, modes)| modes).collect();
        self
    }
}

/// Pairs of these, the larger exponent first, in which the same moves: those that are most alike first.
fn of_one_vibration(still: &[Option<Mode>]) -> Vec<[usize; 2]> {
    let modes: Vec<&Mode> = still.iter().flatten().collect();
    let sizes: Vec<f64> = modes.iter().map(|mode| mode.product(mode).sqrt()).collect();
    let pairs = (0..still.len()).flat_map(|last| (0..last).map(move |first| [first, last]));
    let likeness = |[first, last]: [usize; 2]| {
        let (a, b) = (modes[first], modes[last]);
        let is_apart = a.growth - b.growth > APART * a.growth.abs().max(b.growth.abs());
        let likeness = if is_apart { a.product(b) / (sizes[first] * sizes[last]) } else { 0.0 };
        (likeness > ALIKE).then_some((likeness, [first, last]))
    };
    let mut alike: Vec<(f64, [usize; 2])> = pairs.filter_map(likeness).collect();
    alike.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut is_taken = vec![false; still.len()];
    alike.retain(|(_, pair)| {
        let is_left = pair.iter().all(|k| !is_taken[*k]);
        pair.iter().for_each(|k| is_taken[*k] |= is_left);
        is_left
    });
    alike.into_iter().map(|(_, pair)| pair).collect()
}

/// Finds the modes about the start of a system, which is at rest there. Drives stand still at the time 0.
///
/// # Errors
/// When it is not at rest, or nothing can be told of its motions.
pub fn modes(system: &System) -> Result<Modes, NoModes> {
    if !stands(system) {
        return Err(NoModes::Moving);
    }
    let mut places = Places::new(system.clone())?;
    let rest = places.rest(system.start_position().to_vec())?;
    let freedom = places.freedom();
    let motions = places.motions(if freedom > MOST_FREEDOMS { SOME } else { freedom })?;
    if places.forks(&motions) {
        return Err(NoModes::Forks);
    }
    let speed = places.velocities()?.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let driven = freedom > 0 && speed > STILL * places.length() * rest.speed;
    places.put(system.start_position())?;
    let kinked = places.kinked(&motions, &rest);
    let none = Modes { free: 2 * freedom, length: places.length(), driven, kinked, ..Modes::default() };
    if rest.speed == 0.0 || freedom == 0 {
        return Ok(none.numbered());
    }
    if freedom > MOST_FREEDOMS {
        return slowest::slowest(system, &mut places, &rest, &motions, none);
    }
    let mut seen = |h: f64| look_twice(&mut places, &rest, &motions, h);
    // A long step shows the slowest motion, and one that is about as long as a motion takes shows that well. What rounding makes of a zero is slower than
    // a long step.
    let mut long = rest.long_step();
    let least = SHORTER * long;
    let slow = loop {
        match seen(long) {
            // Forces of redundant rows may be too much for what a long step can be told from.
            Err(NoModes::Singular) if long > least => long *= 0.1,
            outcome => break outcome?,
        }
    };
    let Some(slowest) = slowest_speed(&slow, long) else {
        return Ok(Modes { within: slow.iter().fold(0.0, |most, found| found.speed().max(most)), ..none }.numbered());
    };
    let mut modes = Modes { free: 0, ..none };
    let mut left = 2 * freedom;
    for window in 0..WINDOWS {
        let middle = slowest * WIDTH.powi(window);
        for found in seen(AWAY / middle)? {
            let share = found.speed() / middle;
            let is_here = share < WIDTH.sqrt() && (window == 0 || share >= 1.0 / WIDTH.sqrt());
            if window == 0 && !found.is_sure && share < SLOWER {
                (modes.free, left) = (modes.free + 1, left.saturating_sub(1));
                modes.within = modes.within.max(share * middle);
            } else if found.is_sure && is_here {
                left = left.saturating_sub(1);
                modes.modes.extend(Mode::of(system, &motions.basis, &found));
            }
        }
        if left == 0 {
            break;
        }
    }
    modes.unsure = left;
    Ok(modes.numbered())
}

/// The speed of the slowest motion that a step of length h tells from what rounding makes of a zero, 1/s.
fn slowest_speed(found: &[Found], h: f64) -> Option<f64> {
    let told = found.iter().filter(|found| found.is_sure || found.speed() * h >= 1.0);
    told.map(Found::speed).min_by(f64::total_cmp)
}

/// Whether a system is at rest at its start, and forces balance there.
pub fn is_at_rest(system: &System) -> bool {
    stands(system) && Places::new(system.clone()).is_ok_and(|mut places| places.rest(system.start_position().to_vec()).is_ok())
}

/// How far what moves most at the start of a system would go in a time (s), as fast and with the accelerations that it has there, m. `None` where that
/// cannot be told.
pub fn way_ahead(system: &System, time: f64) -> Option<f64> {
    let pushed = Places::new(system.clone()).ok()?.set_off(system.start_position().to_vec()).ok()?;
    Some(largest(&system.start_velocity()[..system.coordinates()]) * time + 0.5 * pushed * time * time)
}

fn stands(system: &System) -> bool {
    system.start_velocity()[..system.coordinates()].iter().all(|v| *v == 0.0)
}

/// Whether rows that follow from others at the start say something of their own beside it: at a singular position a mechanism can go on in several ways, or
/// cannot go where its rows seem to let it. `None` where that cannot be told.
pub fn forks(system: &System) -> Option<bool> {
    let mut places = Places::new(system.clone()).ok()?;
    places.put(system.start_position()).ok()?;
    let motions = places.motions(SOME).ok()?;
    Some(places.forks(&motions))
}
