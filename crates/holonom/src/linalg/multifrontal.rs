//! L U by fronts: dense squares that hand what they add to the rows below to their parents (Duff and Reid 1983), in place.
//!
//! Everything but the arithmetic is worked out beforehand, and the arithmetic is that of tiles. Pivots are taken in the
//! given order; within a front rows change places where a pivot is far below what stands under it.

use std::sync::Arc;

use pulp::{Arch, Simd, WithSimd};

use super::Singular;
use super::factor::{Factor, Pivoting};
use super::fronts::Fronts;
use super::groups::ONE_FRONT;
use super::solve::Solve;
use super::tile::{Block, DROPPED, LANES, TILE, Tile};

pub(super) struct Multifrontal {
    pub(super) plan: Arc<Fronts>,
    parts: Parts,
    /// The entries of the matrix where there is more than one front: each is put together right before it is factored. A single
    /// front has its entries in its tiles.
    values: Vec<f64>,
    numbers: Numbers,
    arch: Arch,
}

/// The tiles of all fronts: after the factorisation L (below the diagonal, which is 1) and U, on the diagonal their inverses.
pub(super) struct Parts {
    /// The columns of the pivots, and their rows beside these.
    pub(super) lower: Vec<Tile>,
    pub(super) upper: Vec<Tile>,
    /// What is left to the parents.
    pub(super) rest: Vec<Tile>,
}

/// Scratch of factorisations and solutions, and how rows changed places.
pub(super) struct Numbers {
    /// Whether a front is to be factored.
    pub(super) stale: Vec<bool>,
    /// Row of its front that came to each pivot, and whether any of a front did.
    pub(super) exchange: Vec<u32>,
    pub(super) exchanged: Vec<bool>,
    /// 1 over the pivots of all fronts.
    pub(super) reciprocal: Vec<Block>,
    /// A right side in the blocks of all fronts, and in the rows below one front.
    pub(super) y: Vec<Block>,
    pub(super) local: Vec<Block>,
    /// Rows of a block of pivots and of the pivots below them.
    pub(super) rows: Vec<Block>,
    /// What the rows of all fronts are multiplied by when their numbers are compared; those of one front, exchanged with them.
    pub(super) units: Vec<Block>,
    pub(super) own_units: Vec<Block>,
}

impl Multifrontal {
    pub(super) fn new(plan: Arc<Fronts>) -> Self {
        let most = plan.fronts.iter().map(|front| front.tail()).max().unwrap_or(0);
        let pivots = plan.fronts.iter().map(|front| front.pivots).max().unwrap_or(0);
        let blocks = plan.blocks();
        let numbers = Numbers {
            stale: vec![true; plan.fronts.len()],
            exchange: vec![0; blocks * LANES],
            exchanged: vec![false; plan.fronts.len()],
            reciprocal: vec![[0.0; LANES]; blocks],
            y: vec![[0.0; LANES]; blocks],
            local: vec![[0.0; LANES]; most],
            rows: vec![[0.0; LANES]; pivots],
            units: vec![[1.0; LANES]; blocks],
            own_units: vec![[1.0; LANES]; pivots.div_ceil(LANES)],
        };
        let values = if plan.one_front().is_some() { Vec::new() } else { vec![0.0; plan.entries.len()] };
        let [lower, upper, rest] = [plan.tiles.lower, plan.tiles.upper, plan.tiles.rest].map(|tiles| vec![[0.0; TILE]; tiles]);
        Self { parts: Parts { lower, upper, rest }, values, plan, numbers, arch: Arch::new() }
    }

    pub(super) fn twin(&self) -> Self {
        let mut twin = Self::new(self.plan.clone());
        twin.numbers.units.clone_from(&self.numbers.units);
        twin
    }

    pub(super) fn values(&self) -> &[f64] {
        if self.plan.one_front().is_some() { self.parts.lower.as_flattened() } else { &self.values }
    }

    pub(super) fn values_mut(&mut self) -> &mut [f64] {
        if self.plan.one_front().is_some() { self.parts.lower.as_flattened_mut() } else { &mut self.values }
    }

    /// Sets what the rows are multiplied by when numbers of different ones are compared.
    pub(super) fn set_units(&mut self, units: &[f64]) {
        for (&place, &unit) in self.plan.place.iter().zip(units) {
            self.numbers.units.as_flattened_mut()[place as usize] = unit;
        }
    }

    pub(super) fn factor(&mut self) -> Result<(), Singular> {
        self.numbers.stale.fill(true);
        self.factor_stale::<false>(Pivoting::EXCHANGE)
    }

    pub(super) fn factor_dropping(&mut self, least: f64) -> Result<(), Singular> {
        self.numbers.stale.fill(true);
        self.factor_stale::<true>(Pivoting::drop_below(least))
    }

    /// Factors the fronts of some unknowns and those above them anew.
    pub(super) fn factor_with(&mut self, unknowns: impl Iterator<Item = usize>) -> Result<(), Singular> {
        for unknown in unknowns {
            self.numbers.stale[self.plan.front_of(unknown)] = true;
        }
        self.factor_stale::<false>(Pivoting::EXCHANGE)
    }

    fn factor_stale<const DROPS: bool>(&mut self, pivoting: Pivoting) -> Result<(), Singular> {
        let Self { plan, parts, values, numbers, arch } = self;
        arch.dispatch(Factor::<DROPS> { plan, parts, values, numbers, pivoting })
    }

    pub(super) fn solve(&mut self, b: &mut [f64]) {
        self.arch.dispatch(Solve { plan: &self.plan, parts: &self.parts, numbers: &mut self.numbers, b });
    }

    /// Whether rows of any front changed places.
    pub(super) fn has_exchanged(&self) -> bool {
        self.numbers.exchanged.contains(&true)
    }

    /// Sizes of all pivots in the order of elimination, with those that fill up blocks.
    pub(super) fn pivots(&self) -> impl Iterator<Item = f64> {
        self.numbers.reciprocal.as_flattened().iter().map(|reciprocal| 1.0 / reciprocal.abs())
    }

    /// Size of the pivot met at a row of the matrix, and whether it was dropped.
    pub(super) fn pivot(&self, row: usize) -> (f64, bool) {
        let size = 1.0 / self.numbers.reciprocal.as_flattened()[self.plan.place[row] as usize].abs();
        let is_dropped = size > DROPPED.sqrt();
        (if is_dropped { size / DROPPED } else { size }, is_dropped)
    }
}

/// What goes faster with a single front of a size that is known.
pub(super) trait OneFront: WithSimd {
    /// The same with a single front of `B` blocks.
    fn one<S: Simd, const B: usize>(self, simd: S) -> Self::Output;
}

#[inline(always)]
pub(super) fn with_blocks<S: Simd, T: OneFront>(task: T, simd: S, blocks: usize) -> T::Output {
    match blocks {
        1 => task.one::<S, 1>(simd),
        2 => task.one::<S, 2>(simd),
        3 => task.one::<S, 3>(simd),
        _ => task.one::<S, ONE_FRONT>(simd),
    }
}
