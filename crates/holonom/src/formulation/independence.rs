//! How independent the rows are: geometry alone, whatever the masses and units.

use std::borrow::BorrowMut;

use smallvec::SmallVec;

use super::kkt::Kkt;
use super::pattern::{ALL, Block};
use super::scales::Scales;
use crate::system::{Evaluation, System};

/// What a row must add to those before it, squared and over its own size, to count: well above round-off, well below any row
/// that holds something.
const INDEPENDENT: f64 = 1e-9;

/// Coordinates of a mechanism for which that is so. The farther a row is from the ends of what it holds, the less it adds: at the first hinge of an
/// open chain the inverse cube of the number of links.
const MANY: f64 = 1000.0;

/// What a row must add to those before it, squared and over its own size, to count in a system of so many coordinates.
pub fn independent(coordinates: usize) -> f64 {
    INDEPENDENT * (MANY / coordinates as f64).min(1.0).powi(3)
}

/// What a row must add for the pivots of the rows after it to be known better than `INDEPENDENT`. What adds less is measured
/// again, after all others.
const PLAIN: f64 = 1e-5;

/// Pivots below this share of what must be added are nothing, after rows that are plain.
const NOTHING: f64 = 0.1;

/// Pivots up to this may be round-off. At most so many of these rows are measured again, each of which costs a solution of the whole
/// system; where there are more, all are redundant ones.
const ROUND_OFF: f64 = 1e-13;
const MOST: usize = 100;

/// Share of itself that a row adds to the others below which it adds nothing.
const LEAST_SHARE: f64 = 1e-10;

/// Weighted sums of rows that are measured before it is said that none of the rows adds anything, and what each must leave for that, over what a
/// row must add to count. Of a row that counts, weights that are as good as random leave less than a thousandth in one case of a thousand.
const SUMS: usize = 3;
const LEFT_OF_SUM: f64 = 1e-6;

/// Rows that are measured again without room being made for them.
const FEW: usize = 4;

/// Gradients below this share of what they become when the mechanism moves by its own size have vanished.
pub const VANISHED: f64 = 1e-9;

/// How much each row (r) adds to those before it that count, squared: 1 for a row of its own, 0 for one that follows from
/// others. Directions are nodes with a length, so that all coordinates are lengths and weigh alike; rows are scaled to unit
/// gradients (methods §13). The pivots of [1 Gᵀ; G 0] are minus these numbers. Rows that add little are dropped from it, as what
/// they leave is near round-off, which would be divided by it in the rows after them; what they add to all others is the
/// part of their gradients that these leave, and that those measured before leave of it. What is followed, as a place on a curve, is found from what
/// it is `near` these positions.
pub fn independence(system: &System, x: &[f64], near: &[f64], t: f64) -> Vec<f64> {
    Independence::new(system).shares(system, x, near, t)
}

/// Room for finding that at many positions, with a matrix of its own or one that is lent.
pub struct Independence<K = Kkt> {
    kkt: K,
    /// What a row must add to count.
    least: f64,
    at: Evaluation,
    natural: Vec<f64>,
    /// Of each row (r), when last measured.
    shares: Vec<f64>,
    /// The rows that were not plain.
    dropped: Vec<usize>,
    /// What the plain rows leave of a gradient, and what all rows leave of those of the others, each of length one and one after the other.
    left: Vec<f64>,
    others: Vec<f64>,
}

impl Independence {
    /// Plans the matrix of a system.
    pub fn new(system: &System) -> Self {
        Self::like(system, &Kkt::new(system, &Scales::new(system), 1, ALL))
    }

    /// With the pattern of a matrix of the system with one field.
    pub fn like(system: &System, kkt: &Kkt) -> Self {
        Self::within(system, kkt.twin())
    }
}

impl<K: BorrowMut<Kkt>> Independence<K> {
    /// In the room of a matrix of the system with one field, whose values and factors are lost.
    pub fn within(system: &System, own: K) -> Self {
        let rows = system.slots.rows.len();
        let (natural, at) = natural_sizes(system);
        let kkt: &Kkt = own.borrow();
        let others = Vec::with_capacity(FEW * kkt.free * kkt.dim);
        let least = independent(kkt.free * kkt.dim);
        let left = vec![0.0; kkt.size()];
        Self { kkt: own, left, least, at, natural, shares: vec![0.0; rows], dropped: Vec::with_capacity(rows), others }
    }

    /// What [`independence`] gives at the positions `x` and the time `t`.
    pub fn shares(mut self, system: &System, x: &[f64], near: &[f64], t: f64) -> Vec<f64> {
        self.measure(system, x, near, t);
        self.shares
    }

    /// How many rows follow from others at the positions `x` and the time `t`.
    pub fn count_redundant(&mut self, system: &System, x: &[f64], near: &[f64], t: f64) -> usize {
        self.measure(system, x, near, t);
        self.shares.iter().filter(|share| **share <= self.least).count()
    }

    /// Leaves in `left` what all other rows leave of the gradients of the rows that hold velocities only, by the unit of these (n each), at the positions `x`
    /// and the time `t`.
    pub(super) fn project_velocity_rows(&mut self, system: &System, x: &[f64], near: &[f64], t: f64, left: &mut Vec<f64>) {
        let rows = &system.velocity_rows;
        self.measure_without(system, x, near, t, rows);
        let Self { kkt, at, left: room, others, least, .. } = self;
        let kkt: &mut Kkt = kkt.borrow_mut();
        let coordinates = kkt.free * kkt.dim;
        let mut beside = Beside { kkt, gradient: &at.gradient, least: *least, left: room, others };
        left.clear();
        for &row in rows {
            beside.leave(&[row as usize], |_| 1.0);
            left.extend_from_slice(&beside.left[..coordinates]);
        }
    }

    /// The same at the start.
    pub fn count_redundant_at_start(&mut self, system: &System) -> usize {
        let near = system.evaluation().functions.angle;
        self.count_redundant(system, &system.start_position, &near, 0.0)
    }

    /// Measures at the positions `x` and the time `t`.
    fn measure(&mut self, system: &System, x: &[f64], near: &[f64], t: f64) {
        self.measure_without(system, x, near, t, &[]);
    }

    /// The same of all rows but some, whose gradients it leaves by their units.
    fn measure_without(&mut self, system: &System, x: &[f64], near: &[f64], t: f64, without: &[u32]) {
        let Self { kkt, at, natural, shares, dropped, left, others, least } = self;
        let kkt: &mut Kkt = kkt.borrow_mut();
        at.count_on(near);
        system.evaluate_again(x, t, at);
        for (row, natural) in natural.iter().enumerate() {
            let free = system.slots.rows[row].clone().filter(|&slot| kkt.is_free(slot));
            let square: f64 = free.flat_map(|slot| &at.gradient[slot * kkt.dim..(slot + 1) * kkt.dim]).map(|g| g * g).sum();
            let size = square.sqrt();
            let factor = if size > VANISHED * natural { 1.0 / size } else { 0.0 };
            at.gradient[kkt.gradient_of(row)].iter_mut().for_each(|g| *g *= factor);
        }
        let mut set_aside: SmallVec<[f64; 64]> = SmallVec::new();
        for &row in without {
            let gradient = &mut at.gradient[kkt.gradient_of(row as usize)];
            set_aside.extend_from_slice(gradient);
            gradient.fill(0.0);
        }
        let block = Block(0, 0);
        kkt.clear();
        kkt.start_with_weights(std::iter::repeat(&1.0));
        kkt.write_sum(block);
        kkt.add_columns(block, &at.gradient, 1.0);
        kkt.add_rows(block, &at.gradient, 1.0);
        let mut set_aside = set_aside.iter();
        for &row in without {
            at.gradient[kkt.gradient_of(row as usize)].iter_mut().zip(&mut set_aside).for_each(|(g, own)| *g = *own);
        }
        if kkt.solver.factor_dropping(PLAIN).is_err() {
            shares.fill(0.0);
            return;
        }
        others.clear();
        shares.iter_mut().enumerate().for_each(|(row, share)| *share = kkt.solver.pivot(kkt.multiplier(row, 0)));
        let mut nothing = NOTHING * *least;
        if shares.iter().filter(|share| (nothing..ROUND_OFF).contains(share)).count() > MOST {
            nothing = ROUND_OFF;
        }
        dropped.clear();
        for (row, share) in shares.iter_mut().enumerate().filter(|(row, _)| kkt.solver.is_dropped(kkt.multiplier(*row, 0))) {
            if *share < nothing || without.binary_search(&(row as u32)).is_ok() {
                *share = 0.0;
            } else {
                dropped.push(row);
            }
        }
        Beside { kkt, gradient: &at.gradient, least: *least, left, others }.measure(dropped, shares);
    }

    /// How many times larger than elsewhere round-off is where rows were last measured: one over the root of the least share, without those of as
    /// many rows as are `redundant`.
    pub fn amplification(&mut self, redundant: usize) -> f64 {
        1.0 / self.weakest(redundant).max(LEAST_SHARE).sqrt()
    }

    /// Gradients of all rows (D a slot) when last measured, of length one.
    pub fn gradients(&self) -> &[f64] {
        &self.at.gradient
    }

    /// By how much a row has turned at most since its gradients were `before`, rad; without bound above a sixth of a turn.
    pub fn turned_since(&self, before: &[f64]) -> f64 {
        let kkt: &Kkt = self.kkt.borrow();
        let square = |slots: &std::ops::Range<usize>| {
            let place = slots.start * kkt.dim..slots.end * kkt.dim;
            self.at.gradient[place.clone()].iter().zip(&before[place]).map(|(now, before)| (now - before) * (now - before)).sum::<f64>()
        };
        let chord = kkt.slots.rows.iter().map(square).fold(0.0, f64::max).sqrt();
        if chord < 1.0 { 2.0 * (0.5 * chord).asin() } else { f64::INFINITY }
    }

    /// The least share of a row when last measured, without as many of the least as are `redundant`; 1 where there is no other. The shares are in no
    /// order then.
    pub fn weakest(&mut self, redundant: usize) -> f64 {
        self.shares.sort_unstable_by(f64::total_cmp);
        self.shares.get(redundant).copied().unwrap_or(1.0)
    }
}

/// How rows are measured beside the plain ones, and beside the `others` that were measured before and count.
struct Beside<'a> {
    kkt: &'a mut Kkt,
    gradient: &'a [f64],
    least: f64,
    left: &'a mut [f64],
    others: &'a mut Vec<f64>,
}

impl Beside<'_> {
    /// Finds what each of some rows adds, squared, which takes solutions of the whole system. After a redundant row it is first asked whether any of the
    /// next ones adds anything, and of ever more of them as long as none does.
    fn measure(&mut self, mut rows: &[usize], shares: &mut [f64]) {
        let mut group = 1;
        while let Some((&row, rest)) = rows.split_first() {
            let (next, behind) = rows.split_at(group.min(rows.len()));
            if next.len() > 1 && self.add_nothing(next) {
                next.iter().for_each(|&row| shares[row] = 0.0);
                (rows, group) = (behind, 2 * group);
                continue;
            }
            shares[row] = self.leave(&[row], |_| 1.0);
            self.count(shares[row]);
            (rows, group) = (rest, if shares[row] > self.least { 1 } else { 2 });
        }
    }

    /// Whether none of some rows adds anything, by weighted sums of them.
    fn add_nothing(&mut self, rows: &[usize]) -> bool {
        let bound = LEFT_OF_SUM * self.least;
        (1..=SUMS).all(|sum| self.leave(rows, |k| (12.9898 * sum as f64 * (k as f64 + 1.0).powi(2)).sin()) < bound)
    }

    /// What is left of a sum of rows with these weights, squared.
    fn leave(&mut self, rows: &[usize], weight: impl Fn(usize) -> f64) -> f64 {
        let Self { kkt, gradient, left, others, .. } = self;
        let coordinates = kkt.free * kkt.dim;
        left.fill(0.0);
        for (k, &row) in rows.iter().enumerate() {
            let weight = weight(k);
            for slot in kkt.slots.rows[row].clone().filter(|&slot| kkt.is_free(slot)) {
                let node = kkt.slots.nodes[slot] as usize;
                (0..kkt.dim).for_each(|c| left[kkt.coordinate(node, 0, c)] += weight * gradient[slot * kkt.dim + c]);
            }
        }
        // Twice, as the round-off of the first pass is large where little is left. The others are as little themselves, and are taken off once.
        for _ in 0..2 {
            left[coordinates..].fill(0.0);
            kkt.solver.solve(left);
        }
        let left = &mut left[..coordinates];
        for other in others.chunks_exact(coordinates) {
            let along = product(other, left);
            left.iter_mut().zip(other).for_each(|(left, other)| *left -= along * other);
        }
        product(left, left)
    }

    /// Has what is left of a row that adds this much be one of the others where it counts.
    fn count(&mut self, share: f64) {
        if share > self.least {
            let coordinates = self.kkt.free * self.kkt.dim;
            self.others.extend(self.left[..coordinates].iter().map(|left| left / share.sqrt()));
        }
    }
}

/// Product of two vectors, in sums side by side: each addition of one sum waits for the last.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let (blocks, rest) = (a.chunks_exact(8).zip(b.chunks_exact(8)), a.len() / 8 * 8);
    let add = |mut sums: [f64; 8], (a, b): (&[f64], &[f64])| {
        (0..8).for_each(|k| sums[k] += a[k] * b[k]);
        sums
    };
    let tail: f64 = a[rest..].iter().zip(&b[rest..]).map(|(a, b)| a * b).sum();
    tail + blocks.fold([0.0; 8], add).iter().sum::<f64>()
}

/// By how much the gradient of each row (r) changes when all nodes move by the size of the mechanism, here and there: the
/// largest of its nodes. From a thousandth of such a move beside an evaluation at the start, which is handed back, too.
pub fn natural_sizes(system: &System) -> (Vec<f64>, Evaluation) {
    let (share, dim) = (1e-3, system.dim);
    let reach = share * extent(system);
    let start = system.start_position.iter().enumerate();
    let moved: Vec<f64> = start.map(|(k, x)| x + reach * (12.9898 * (k as f64 + 1.0)).sin()).collect();
    let mut here = system.evaluation();
    system.evaluate_again(&system.start_position, 0.0, &mut here);
    let mut there = here.clone();
    system.evaluate_again(&moved, 0.0, &mut there);
    let change =
        |slot: usize| (0..dim).map(|c| (there.gradient[slot * dim + c] - here.gradient[slot * dim + c]).powi(2)).sum::<f64>().sqrt();
    let natural = system.slots.rows.iter().map(|slots| slots.clone().map(change).fold(0.0, f64::max) / share).collect();
    (natural, here)
}

/// Diagonal of the box around the origin and all nodes at the start, or the size that is known of the mechanism where that is
/// more; where both are nothing any unit will do.
pub(crate) fn extent(system: &System) -> f64 {
    let mut square = 0.0;
    for c in 0..system.dim {
        let along = system.start_position.iter().skip(c).step_by(system.dim);
        let (low, high) = along.fold((0.0, 0.0), |(low, high): (f64, f64), &x| (low.min(x), high.max(x)));
        square += (high - low) * (high - low);
    }
    let size = square.sqrt().max(system.size);
    if size > 0.0 { size } else { 1.0 }
}
