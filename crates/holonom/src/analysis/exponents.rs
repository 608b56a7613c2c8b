//! Exponents of motions e^(s t) as steps of implicit Euler show them (methods §21).

use std::f64::consts::TAU;

use super::modes::{Mode, NoModes};
use crate::linalg::{Eigenpair, eigenpairs};
use crate::simulation::{Motions, Places, Rest, Spot};
use crate::system::System;

/// The other step that motions are looked at with, and by what share of an s both may differ.
const OTHER: f64 = 1.37;
const AGREE: f64 = 1e-4;

/// An s over the slowest that may be zero, and the share that a step leaves of what is too fast for it.
pub(super) const SLOWER: f64 = 0.5;
const FAST: f64 = 1e-9;

/// By how many times what both steps differ by a real part is round-off.
const UNSURE: f64 = 10.0;

/// Share of an s that its real or imaginary part may be by round-off.
const ROUNDED: f64 = 1e-10;

/// An exponent as steps of two lengths have it.
pub(super) struct Found {
    pub s: [f64; 2],
    pub shares: Vec<[f64; 2]>,
    /// Whether both agree, and by what their real parts differ.
    pub is_sure: bool,
    apart: f64,
}

impl Found {
    pub fn speed(&self) -> f64 {
        self.s[0].hypot(self.s[1])
    }
}

/// The exponents that a step of length h shows, with their shares of the motions.
pub(super) fn look(places: &mut Places, spot: &Spot, motions: &Motions, h: f64) -> Result<Vec<Eigenpair>, NoModes> {
    let pairs = eigenpairs(2 * motions.basis.len(), &places.propagator(motions, spot, h)?).ok_or(NoModes::Singular)?;
    Ok(pairs.into_iter().filter_map(|(theta, shares)| Some((exponent(theta, h)?, shares))).collect())
}

/// The same, and whether a step of another length, a little beside, agrees.
pub(super) fn look_twice(places: &mut Places, rest: &Rest, motions: &Motions, h: f64) -> Result<Vec<Found>, NoModes> {
    let first = look(places, &rest.spots[0], motions, h)?;
    look_again(places, rest, motions, h, first)
}

/// Whether a step of another length, a little beside, agrees with what one of length h shows: what rounding makes of a zero is another number there.
pub(super) fn look_again(
    places: &mut Places,
    rest: &Rest,
    motions: &Motions,
    h: f64,
    first: Vec<Eigenpair>,
) -> Result<Vec<Found>, NoModes> {
    let second = look(places, &rest.spots[1], motions, OTHER * h)?;
    let found = first.into_iter().map(|(s, shares)| {
        let apart = |other: &[f64; 2]| (s[0] - other[0]).hypot(s[1] - other[1]);
        let nearest = second.iter().map(|(other, _)| other).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        // What is zero in both is not sure.
        let is_sure = nearest.is_some_and(|other| apart(other) < AGREE * s[0].hypot(s[1]));
        Found { s, shares, is_sure, apart: nearest.map_or(f64::INFINITY, |other| (s[0] - other[0]).abs()) }
    });
    Ok(found.collect())
}

impl Mode {
    /// What is found of a motion; `None` of the second of the two exponents of a vibration.
    pub(super) fn of(system: &System, motions: &[Vec<f64>], found: &Found) -> Option<Self> {
        let [re, im] = found.s;
        let vibrates = im.abs() > ROUNDED * found.speed();
        if vibrates && im < 0.0 {
            return None;
        }
        // Exponents of several that are equal may come as those of a vibration: what moves in the one is the real part, in the other the imaginary part.
        let is_whole = vibrates || im == 0.0;
        let share = |[re, other]: [f64; 2]| if is_whole { [re, other] } else { [if im > 0.0 { re } else { other }, 0.0] };
        let mut shape = vec![[0.0; 2]; system.nodes() * system.dimension()];
        for (motion, [re, im]) in motions.iter().zip(found.shares.iter().map(|part| share(*part))) {
            shape.iter_mut().zip(motion).for_each(|(shape, q)| *shape = [shape[0] + re * q, shape[1] + im * q]);
        }
        let rounding = (ROUNDED * found.speed()).max(UNSURE * found.apart);
        let growth = if re.abs() <= rounding { 0.0 } else { re };
        Some(Self { growth, frequency: if vibrates { im / TAU } else { 0.0 }, shape })
    }
}

/// s of the share θ = 1/(1 − h s) that a step of implicit Euler leaves; `None` where hardly anything is left.
fn exponent([re, im]: [f64; 2], h: f64) -> Option<[f64; 2]> {
    let square = re * re + im * im;
    (square > FAST * FAST).then(|| [(1.0 - re / square) / h, im / square / h])
}
