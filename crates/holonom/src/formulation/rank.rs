//! Which rows are redundant, by the pivots of the matrix, and the proximal term δ that each row has for it.

use serde::{Deserialize, Serialize};

use super::failure::Failure;
use super::independence::independent;
use super::kkt::Kkt;
use super::newton::Newton;
use super::scales::Scales;

/// Share of the rows' own stiffness that the proximal term may soften: δ = (G M⁻¹ Gᵀ)/ρ (methods §3). With redundant
/// rows round-off grows with ρ to multipliers that mean nothing.
pub const RHO: f64 = 1e10;

/// Attempts after a change of the rank that are near a singular position.
pub(super) const SINGULAR: u32 = 32;

/// δ of a regular row over the least that such a row must add. With N rows in a chain an iteration leaves up to N² times that, and
/// a redundant row after them seems to add N times that.
const SPARE: f64 = 1e-7;

/// Where a row has δ of [`RHO`] or more it is redundant when its pivot, over its own stiffness, is smaller than this.
pub(super) const REDUNDANT: f64 = 1e-9;

/// Smaller pivots, over the rows' own stiffness, are round-off in rows with hardly any δ.
const ROUND_OFF: f64 = 100.0 * f64::EPSILON;

/// What rounding makes of the pivots of a chain's last rows, over their own stiffness and for each coordinate of the chain. A regular row that adds
/// less than [`WEAK`] times that is weak: its pivot may be anything as small, and has a δ that rules over it. Only chains of thousands have any.
const ROUNDED: f64 = 0.01 * f64::EPSILON;
const WEAK: f64 = 100.0;
const RULING: f64 = 3.0;

/// δ over the rows' own stiffness that leaves nothing of a row: its multiplier is nothing beside all others.
const LEFT_OUT: f64 = 1e100;

/// What the last factorisations said of the rows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Rank {
    /// Rows whose pivot was no redundant one's (r).
    regular: Vec<bool>,
    /// Those of them that are weak, ascending.
    weak: Vec<usize>,
    /// How many they leave, if any were counted, and whether that has changed then.
    redundant: Option<usize>,
    changes: bool,
    /// Attempts to come that are near a singular position.
    singular: u32,
    /// Rows that hold velocities only and follow from the others, which steps leave out; `None` as long as that is not looked for.
    #[serde(default)]
    pub left_out: Option<Vec<u32>>,
    /// What a row with hardly any proximal term must add to be regular, and what rounding makes of that.
    least: f64,
    rounded: f64,
    /// Whether rows that were regular have hardly any proximal term in this attempt.
    pub(super) spares_regular: bool,
    /// The least that a regular row adds to those before it, over what it would add alone.
    pub(super) weakest: f64,
}

impl Rank {
    pub(super) fn new(rows: usize, coordinates: usize) -> Self {
        let least = independent(coordinates).max(ROUND_OFF);
        Self {
            regular: vec![false; rows],
            weak: Vec::new(),
            redundant: None,
            changes: false,
            singular: 0,
            left_out: None,
            least,
            rounded: ROUNDED * coordinates as f64,
            spares_regular: false,
            weakest: 1.0,
        }
    }

    /// Whether a row was no redundant one when last factored.
    pub(super) fn is_regular(&self, row: usize) -> bool {
        self.regular[row]
    }

    /// Whether no row was redundant when last factored, nor has a proximal term to speak of: multipliers have one solution then.
    pub(super) fn is_full(&self) -> bool {
        self.spares_regular && self.redundant == Some(0)
    }

    /// Has rows that are left out have no multiplier.
    pub(super) fn leave_out_of(&self, multipliers: &mut [f64]) {
        self.left_out.iter().flatten().for_each(|&row| multipliers[row as usize] = 0.0);
    }

    /// Share of what rows hold that an iteration with proximal terms may leave.
    pub(super) fn leaves(&self) -> f64 {
        if self.spares_regular { 0.0 } else { self.rho_leaves(RHO) }
    }

    /// Share of what the multipliers miss that a solution with δ of this ρ may leave.
    pub(super) fn proximal_leaves(&self, rho: f64) -> f64 {
        if self.redundant == Some(0) { self.rho_leaves(rho) } else { 1.0 }
    }

    /// Share of what the weakest row holds that δ of this ρ leaves.
    fn rho_leaves(&self, rho: f64) -> f64 {
        (1.0 / (rho * self.weakest)).min(1.0)
    }

    /// Becomes the same, without any allocation where no row is weak.
    pub fn copy_from(&mut self, other: &Self) {
        let Self { regular, weak, redundant, changes, singular, left_out, least: _, rounded: _, spares_regular, weakest } = other;
        self.regular.copy_from_slice(regular);
        self.weak.clone_from(weak);
        self.left_out.clone_from(left_out);
        (self.redundant, self.changes, self.singular) = (*redundant, *changes, *singular);
        (self.spares_regular, self.weakest) = (*spares_regular, *weakest);
    }

    /// Takes note of which rows are redundant by their pivots in the first field, and whether that are as many as before.
    pub(super) fn classify(&mut self, outcome: &Result<(), Failure>, kkt: &Kkt, delta: &[f64], scales: &Scales) {
        if outcome.is_err() {
            self.regular.fill(false);
            self.weak.clear();
            return;
        }
        let share = |row: usize| (kkt.solver.pivot(kkt.multiplier(row, 0)) - delta[row]) / scales.softness[row];
        let mut redundant = 0;
        self.weakest = 1.0;
        for (row, regular) in self.regular.iter_mut().enumerate() {
            let share = share(row);
            let is_spared = delta[row] < 0.5 * scales.softness[row] / RHO;
            if delta[row] > LEFT_OUT * scales.softness[row] {
                *regular = false;
                continue;
            }
            *regular = share > if is_spared { self.least } else { REDUNDANT } || (is_spared && self.weak.binary_search(&row).is_ok());
            if *regular {
                self.weakest = self.weakest.min(share);
            } else {
                redundant += 1;
            }
        }
        self.weak.clear();
        if self.weakest < WEAK * self.rounded {
            let weak = (0..self.regular.len()).filter(|&row| self.regular[row] && share(row) < WEAK * self.rounded);
            self.weak.extend(weak);
            self.weakest = self.weakest.max(self.rounded);
        }
        self.changes = self.redundant.replace(redundant).is_some_and(|before| before != redundant);
        if self.changes {
            self.singular = SINGULAR;
        }
    }
}

impl Newton {
    /// Fills δ for the proximal term: ρ = [`RHO`], or what a penalty α in the paper's sense comes to, 1/(ϖα), kept
    /// where it neither softens the rows nor spoils the digits.
    pub fn proximal(&mut self, inertia: f64, penalty: Option<f64>, scales: &Scales) {
        for (delta, &softness) in self.delta.iter_mut().zip(&scales.softness) {
            *delta = match penalty {
                None => softness / RHO,
                Some(alpha) => (1.0 / (inertia * alpha)).clamp(softness / 1e12, softness / 1e8),
            };
        }
    }

    /// Hardly any δ for all rows where none was redundant when last factored; ρ = [`RHO`] for all where any was, or where the rank has just
    /// changed. With δ for the redundant rows alone these would be those that come last in the elimination. Beside a dead centre such a row may
    /// hold much, after rows that hold hardly anything: what these are off by their rounding is much of that row, and no multiplier takes it back.
    pub(super) fn proximal_by_rank(&mut self, scales: &Scales) {
        let rank = &mut self.rank;
        let shares = rank.singular > 0 || rank.redundant.is_some_and(|redundant| redundant > 0);
        rank.spares_regular = !shares;
        rank.singular = rank.singular.saturating_sub(1);
        if shares {
            self.proximal(1.0, None, scales);
        } else {
            let part = SPARE * rank.least;
            self.delta.iter_mut().zip(&scales.softness).for_each(|(delta, softness)| *delta = part * softness);
            rank.weak.iter().for_each(|&row| self.delta[row] = RULING * rank.rounded * scales.softness[row]);
        }
        self.leave_out(scales);
    }

    /// Has rows that are left out hold nothing.
    pub(super) fn leave_out(&mut self, scales: &Scales) {
        for &row in self.rank.left_out.iter().flatten() {
            self.delta[row as usize] = LEFT_OUT * LEFT_OUT * scales.softness[row as usize];
        }
    }

    /// Hardly any δ for the rows that are regular, and ρ = [`RHO`] for the others.
    pub(super) fn proximal_of_others(&mut self, is_regular: impl Iterator<Item = bool>, scales: &Scales) {
        for ((delta, softness), is_regular) in self.delta.iter_mut().zip(&scales.softness).zip(is_regular) {
            *delta = softness * if is_regular { SPARE * self.rank.least } else { 1.0 / RHO };
        }
    }

    /// Where the rank changed in the last factorisation and rows have hardly any proximal term, gives them one.
    pub(super) fn guards_rank(&mut self, scales: &Scales) -> bool {
        let guards = std::mem::take(&mut self.rank.changes) && self.rank.spares_regular;
        if guards {
            self.proximal_by_rank(scales);
        }
        guards
    }
}
