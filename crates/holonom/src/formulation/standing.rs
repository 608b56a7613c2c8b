//! Whether a mechanism stands near a singular position, by what rows add to those before them there and at its start (methods §17).

use super::independence::independent;
use super::passes::LinearSystem;
use super::rank::{REDUNDANT, RHO};
use super::workspace::Workspace;
use crate::system::System;

/// ρ of hardly any δ, with which one solution is all there is where every row adds much to those before it.
pub(super) const SPARING: f64 = 1e20;

/// How many times what counts as independent that is: accelerations are known then.
const SURER: f64 = 10.0;

/// In long chains rows add less from the start. They are as sure where they add no less than this share of it.
const AS_AT_START: f64 = 0.01;

/// Share of what makes a row sure below which it adds nothing: accelerations, known to ε/σ³ where it adds σ², are round-off by far.
const ADDS_NOTHING: f64 = 1e-5;

/// Share that a row must add beside redundant ones, which add up to a hundredth of that with the δ of [`RHO`], for their number to be known.
pub(super) const CLEAR: f64 = 100.0 * REDUNDANT;

/// What rows may add that is round-off of sums of some terms.
pub(super) const ROUND_OFF: f64 = 128.0 * f64::EPSILON;

/// What the rows of a mechanism add to those before them at its start (r), by which it is told whether it stands near a singular position.
pub enum Sure {
    /// All are independent.
    Independent(Shares),
    /// How many add nothing, and all others much.
    Redundant(usize),
}

/// What independent rows add.
pub struct Shares {
    /// What each must add to be far from redundant, over what it would add alone.
    least: Vec<f64>,
    /// Where rows changed places when that was found, all pivots: which of them becomes nothing where rows become dependent is open then.
    pivots: Vec<f64>,
}

impl Sure {
    /// By what rows add at the evaluation of the end, which is that of the start. None where one hardly differs from others there.
    pub(super) fn of(matrix: &mut impl LinearSystem, system: &System, work: &Workspace) -> Option<Self> {
        matrix.factor(SPARING, work).ok()?;
        let shares: Vec<f64> = matrix.shares(SPARING, work).collect();
        let least = (SURER * independent(system.coordinates())).max(ROUND_OFF);
        if shares.iter().all(|share| *share > least) {
            let least = shares.iter().map(|share| (SURER * independent(1)).min(AS_AT_START * share)).collect();
            let pivots = if matrix.solver().has_exchanged() { matrix.solver().pivots().collect() } else { Vec::new() };
            return Some(Self::Independent(Shares { least, pivots }));
        }
        matrix.factor(RHO, work).ok()?;
        let is_clear = !matrix.solver().has_exchanged() && matrix.shares(RHO, work).all(|share| !(REDUNDANT..CLEAR).contains(&share));
        is_clear.then(|| Self::Redundant(few(REDUNDANT, matrix, work)))
    }
}

/// Where a mechanism stands at the evaluation of the end whose rows were independent at the start. The factors have hardly any δ then.
pub(super) fn standing(at_start: &Shares, matrix: &mut impl LinearSystem, work: &Workspace) -> Standing {
    if matrix.factor(SPARING, work).is_err() {
        return Standing::Unknown;
    }
    let worst = matrix.shares(SPARING, work).zip(&at_start.least).map(|(share, least)| share / least).fold(f64::INFINITY, f64::min);
    let (exchanges, before) = (matrix.solver().has_exchanged(), &at_start.pivots);
    let are_as_at_start = || matrix.solver().pivots().zip(before).all(|(pivot, before)| pivot >= AS_AT_START * before);
    if worst >= 1.0 && (!exchanges || (!before.is_empty() && are_as_at_start())) {
        Standing::Sure
    } else if exchanges || !before.is_empty() {
        Standing::Unknown
    } else if worst >= ADDS_NOTHING {
        Standing::Near
    } else {
        Standing::Singular
    }
}

/// How many rows add less than a share to those before them where the matrix was last factored, with the δ of [`RHO`].
pub(super) fn few(least: f64, matrix: &impl LinearSystem, work: &Workspace) -> usize {
    matrix.shares(RHO, work).filter(|share| *share < least).count()
}

/// Where a mechanism stands.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Standing {
    /// Every row adds enough.
    Sure,
    /// Near a singular position: a row adds little.
    Near,
    /// At a singular position, as far as numbers tell: a row adds nothing that has added something at the start, and neither its force nor the
    /// acceleration that it holds follows from places and velocities.
    Singular,
    /// Rows have changed places, and pivots do not tell.
    Unknown,
}
