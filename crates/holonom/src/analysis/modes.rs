//! Small vibrations about a state at rest (methods §21).

use std::f64::consts::TAU;

use crate::linalg::eigenpairs;
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
    /// By frequency; those that do not vibrate first, and of these the ones that grow.
    pub modes: Vec<Mode>,
    /// How many s are zero: two of each freedom that nothing resists, one of those that are only damped.
    pub free: usize,
    /// How many are more than 1e10 times as fast as the slowest.
    pub fast: usize,
    /// Size of the mechanism, m, by which ways are compared with turns.
    pub length: f64,
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
    /// Freedoms without mass.
    #[error("something that is free to move has no mass: its motion has no s")]
    Massless,
    /// A matrix without inverse, or one whose eigenvalues are not found.
    #[error("the linearised equations have no solution")]
    Singular,
    /// Too many freedoms for a dense analysis.
    #[error("the mechanism has {0} degrees of freedom, and modes are found of up to {MOST_FREEDOMS}")]
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

/// Most freedoms for which this dense analysis is made.
pub const MOST_FREEDOMS: usize = 1000;

/// Steps over the time in which the fastest motion turns by one radian that the slowest one is first looked for with.
const LONG: f64 = 1e4;

/// By how much windows of speeds differ in which motions are found together, how many there are, and the step over the time of the middle of one: no
/// step should be as long as what grows takes.
const WIDTH: f64 = 1e3;
const WINDOWS: i32 = 4;
const AWAY: f64 = 0.83;

/// An s over the slowest that is zero, and the share that a step leaves of what is too fast for it.
const ZERO: f64 = 1e-5;
const FAST: f64 = 1e-9;

/// Share of an s that its real part may be by round-off.
const ROUNDED: f64 = 1e-10;

impl Mode {
    /// The share of the critical damping, −1 … 1.
    pub fn damping(&self) -> f64 {
        -self.growth / self.growth.hypot(TAU * self.frequency)
    }
}

/// Finds the modes about the start of a system, which is at rest there. Drives stand still at the time 0.
///
/// # Errors
/// When it is not at rest, or too large.
pub fn modes(system: &System) -> Result<Modes, NoModes> {
    if system.start_velocity()[..system.coordinates()].iter().any(|v| *v != 0.0) {
        return Err(NoModes::Moving);
    }
    let mut places = Places::new(system.clone())?;
    let fastest = places.rest()?;
    let freedom = system.coordinates() + places.redundant_rows() - system.constraints();
    if freedom > MOST_FREEDOMS {
        return Err(NoModes::Large(freedom));
    }
    let motions = places.motions()?;
    let none = Modes { free: 2 * freedom, length: places.length(), ..Modes::default() };
    if fastest == 0.0 || freedom == 0 {
        return Ok(none);
    }
    // A long step shows the slowest motion, and one that is about as long as a motion takes shows that well.
    let pairs = |places: &mut Places, h: f64| eigenpairs(2 * freedom, &places.propagator(&motions, h)?).ok_or(NoModes::Singular);
    let h = LONG / fastest;
    let speeds = pairs(&mut places, h)?.into_iter().filter_map(|(theta, _)| Some(exponent(theta, h)?).map(|[re, im]| re.hypot(im)));
    let slowest = speeds.filter(|speed| speed * h > ZERO).fold(f64::INFINITY, f64::min);
    if slowest == f64::INFINITY {
        return Ok(none);
    }
    let mut modes = Modes { free: 0, ..none };
    let mut left = 2 * freedom;
    for window in 0..WINDOWS {
        let middle = slowest * WIDTH.powi(window);
        let h = AWAY / middle;
        for (theta, vector) in pairs(&mut places, h)? {
            let Some([re, im]) = exponent(theta, h) else { continue };
            let mode = Mode::new(system, &motions.basis, [re, im], &vector);
            match mode.speed() / middle {
                share if window == 0 && share <= ZERO => (modes.free, left) = (modes.free + 1, left.saturating_sub(1)),
                share if share >= WIDTH.sqrt() || window > 0 && share < 1.0 / WIDTH.sqrt() => {}
                _ => {
                    left = left.saturating_sub(1);
                    if im >= 0.0 {
                        modes.modes.push(mode);
                    }
                }
            }
        }
        if left == 0 {
            break;
        }
    }
    modes.fast = left;
    modes.modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency).then(b.growth.total_cmp(&a.growth)));
    Ok(modes)
}

impl Mode {
    /// With the exponent s, and shares of motions in it.
    fn new(system: &System, motions: &[Vec<f64>], [re, im]: [f64; 2], shares: &[[f64; 2]]) -> Self {
        let mut shape = vec![[0.0; 2]; system.nodes() * system.dimension()];
        for (motion, [re, im]) in motions.iter().zip(shares) {
            shape.iter_mut().zip(motion).for_each(|(shape, q)| *shape = [shape[0] + re * q, shape[1] + im * q]);
        }
        let growth = if re.abs() <= ROUNDED * re.hypot(im) { 0.0 } else { re };
        Self { growth, frequency: im / TAU, shape }
    }

    /// |s|, 1/s.
    fn speed(&self) -> f64 {
        self.growth.hypot(TAU * self.frequency)
    }
}

/// s of the share θ = 1/(1 − h s) that a step of implicit Euler leaves; `None` where hardly anything is left.
fn exponent([re, im]: [f64; 2], h: f64) -> Option<[f64; 2]> {
    let square = re * re + im * im;
    (square > FAST * FAST).then(|| [(1.0 - re / square) / h, im / square / h])
}
