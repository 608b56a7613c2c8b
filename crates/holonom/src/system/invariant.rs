//! Quadratic forms of nodes: values, gradients and constant Hessians.
//!
//! Every invariant is one product of two sums of nodes, `f U·W` or `f e·(U × W)`, with `U = Σ u_a x_a + u₀`. Differences of
//! nodes are taken before they are multiplied, so that a row far from the origin loses no digits.

use super::{Place, Term};

/// An invariant of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InvariantId(pub(crate) u32);

#[derive(Clone, Copy, Debug, PartialEq)]
enum Product {
    /// ½ U·U
    Square,
    /// U·W
    Dot,
    /// e·(U × W); in the plane the scalar cross product. Number of e among the vectors.
    Cross(u32),
}

/// One of the two sums of an invariant: a range of terms and the number of its constant among the vectors.
#[derive(Clone, Copy, Debug)]
struct Sum {
    start: u32,
    end: u32,
    constant: u32,
}

impl Sum {
    fn slots(&self) -> std::ops::Range<usize> {
        self.start as usize..self.end as usize
    }
}

#[derive(Clone, Debug)]
struct Invariant {
    product: Product,
    u: Sum,
    w: Sum,
    /// Whether both sums are those of the invariant before, as for the components of one cross product.
    repeats: bool,
}

/// All invariants of a system, with one *slot* (node, gradient) for each term of each sum.
#[derive(Clone, Debug)]
pub struct Invariants {
    dim: usize,
    items: Vec<Invariant>,
    /// Constants of the sums and e of the products, zero first: most sums have no constant.
    vectors: Vec<[f64; 3]>,
    summands: Vec<Summand>,
}

/// A node of a sum.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Summand {
    node: u32,
    factor: f64,
    /// Factor of its quarter turn in the plane.
    turn: f64,
}

/// The normal of the plane of a planar model.
const NORMAL: [f64; 3] = [0.0, 0.0, 1.0];

/// A constant block of a Hessian: ∂²π/∂x_a∂x_b.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum HessianBlock {
    /// c 1
    Isotropic(f64),
    /// The skew matrix E with U·E·W = e·(U × W), times a factor.
    Skew(f64, [f64; 3]),
}

impl HessianBlock {
    /// Its factor, without sign.
    pub fn size(self) -> f64 {
        let (Self::Isotropic(factor) | Self::Skew(factor, _)) = self;
        factor.abs()
    }
}

/// A sum of factors of places is a whole number but for round-off, which would be much times a far origin.
fn whole(sum: f64) -> f64 {
    if (sum - sum.round()).abs() < 1e-12 { sum.round() } else { sum }
}

impl Invariants {
    pub(crate) fn new(dim: usize) -> Self {
        Self { dim, items: Vec::new(), vectors: vec![[0.0; 3]], summands: Vec::new() }
    }

    pub(crate) fn square(&mut self, u: &[Term]) -> InvariantId {
        self.add(Product::Square, u, &[])
    }

    pub(crate) fn dot(&mut self, u: &[Term], w: &[Term]) -> InvariantId {
        self.add(Product::Dot, u, w)
    }

    pub(crate) fn cross(&mut self, e: [f64; 3], u: &[Term], w: &[Term]) -> InvariantId {
        let e = self.vector(if self.dim == 2 { NORMAL } else { e });
        self.add(Product::Cross(e), u, w)
    }

    fn add(&mut self, product: Product, u: &[Term], w: &[Term]) -> InvariantId {
        let (u, w) = (self.sum(u), self.sum(w));
        // A square takes one sum only.
        let is_same = |last: &Invariant| last.product != Product::Square && self.are_equal(&last.u, &u) && self.are_equal(&last.w, &w);
        let repeats = self.items.last().is_some_and(is_same);
        self.items.push(Invariant { product, u, w, repeats });
        InvariantId(self.items.len() as u32 - 1)
    }

    fn sum(&mut self, terms: &[Term]) -> Sum {
        let start = self.summands.len() as u32;
        let mut constant = [0.0; 3];
        for &Term { place, factor, turn } in terms {
            match place {
                Place::Node(node) => self.summands.push(Summand { node: node.0, factor, turn }),
                Place::Fixed(x) => {
                    for c in 0..self.dim {
                        constant[c] += factor * x[c];
                    }
                    constant[0] -= turn * x[1];
                    constant[1] += turn * x[0];
                }
            }
        }
        Sum { start, end: self.summands.len() as u32, constant: self.vector(constant) }
    }

    /// Length of the shortest sum of nodes that is not nothing, and of the longest that moves with all points (one flag a node) over
    /// its share of their motion, m: how far these are from where they are held to.
    pub(crate) fn lengths(&self, is_point: &[bool], x: &[f64]) -> [f64; 2] {
        let sums = self.items.iter().flat_map(|item| [item.u, item.w]).filter(|sum| sum.start < sum.end);
        let length = |sum: Sum| match self.dim {
            2 => self.sum_at::<2>(&sum, self.summands_of(&sum), 1.0, x.as_chunks().0).iter().map(|c| c * c).sum::<f64>().sqrt(),
            _ => self.sum_at::<3>(&sum, self.summands_of(&sum), 1.0, x.as_chunks().0).iter().map(|c| c * c).sum::<f64>().sqrt(),
        };
        sums.fold([f64::INFINITY, 0.0], |[shortest, longest], sum| {
            let (length, [factor, turn]) = (length(sum), self.of_points(&sum, is_point));
            let share = factor.hypot(turn);
            let shortest = if length > 0.0 { shortest.min(length) } else { shortest };
            [shortest, if share > 0.0 { longest.max(length / share) } else { longest }]
        })
    }

    /// What a sum moves by when all points move by one.
    fn of_points(&self, sum: &Sum, is_point: &[bool]) -> [f64; 2] {
        let of_points = self.summands_of(sum).iter().filter(|own| is_point[own.node as usize]);
        of_points.fold([0.0; 2], |[f, g], own| [f + own.factor, g + own.turn]).map(whole)
    }

    /// Has the points among the nodes (one flag a node) counted from another origin: what the sums are stays as it is.
    pub(crate) fn move_origin(&mut self, is_point: &[bool], origin: [f64; 3]) {
        for k in 0..self.items.len() {
            let (u, w) = (self.items[k].u, self.items[k].w);
            let [u, w] = [u, w].map(|sum| Sum { constant: self.moved(&sum, is_point, origin), ..sum });
            (self.items[k].u, self.items[k].w) = (u, w);
        }
    }

    /// The constant of a sum whose points are counted from another origin.
    fn moved(&mut self, sum: &Sum, is_point: &[bool], origin: [f64; 3]) -> u32 {
        let [factor, turn] = self.of_points(sum, is_point);
        let mut constant = self.vectors[sum.constant as usize];
        (0..self.dim).for_each(|c| constant[c] += factor * origin[c]);
        constant[0] -= turn * origin[1];
        constant[1] += turn * origin[0];
        self.vector(constant)
    }

    fn are_equal(&self, sum: &Sum, other: &Sum) -> bool {
        let parts = |sum: &Sum| (self.summands_of(sum), &self.vectors[sum.constant as usize]);
        parts(sum) == parts(other)
    }

    fn summands_of(&self, sum: &Sum) -> &[Summand] {
        &self.summands[sum.slots()]
    }

    /// The number of a vector, which is taken in if it is another than the last and not zero.
    fn vector(&mut self, vector: [f64; 3]) -> u32 {
        let last = self.vectors.len() - 1;
        match vector {
            [0.0, 0.0, 0.0] => 0,
            _ if self.vectors[last] == vector => last as u32,
            _ => {
                self.vectors.push(vector);
                last as u32 + 1
            }
        }
    }

    /// Number of invariants.
    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    /// Number of slots of all invariants together.
    pub(crate) fn slots(&self) -> usize {
        self.summands.len()
    }

    /// The node of a slot.
    pub(crate) fn node_of(&self, slot: usize) -> u32 {
        self.summands[slot].node
    }

    /// The slots of one invariant.
    pub(crate) fn slots_of(&self, id: InvariantId) -> std::ops::Range<usize> {
        let item = &self.items[id.0 as usize];
        item.u.start as usize..item.w.end as usize
    }

    /// The blocks ∂²π/∂x_a∂x_b of an invariant, both triangles; a pair of nodes may come more than once.
    ///
    /// With factors f + gJ, J the quarter turn of the plane, a block is f_a f_b + g_a g_b + (f_a g_b − f_b g_a) J.
    pub(crate) fn hessian(&self, id: InvariantId) -> Vec<(u32, u32, HessianBlock)> {
        let item = &self.items[id.0 as usize];
        let mut blocks = Vec::new();
        let mut push = |a: u32, b: u32, isotropic: f64, skew: f64, e: [f64; 3]| {
            if isotropic != 0.0 {
                blocks.push((a, b, HessianBlock::Isotropic(isotropic)));
            }
            if skew != 0.0 {
                blocks.push((a, b, HessianBlock::Skew(skew, e)));
            }
        };
        // J is minus the skew matrix of the plane's normal.
        let product = |[f, g]: [f64; 2], [p, q]: [f64; 2]| (f * p + g * q, g * p - f * q);
        let right = if item.product == Product::Square { &item.u } else { &item.w };
        for &Summand { node: a, factor, turn } in self.summands_of(&item.u) {
            for own in self.summands_of(right) {
                let (b, (along, across)) = (own.node, product([factor, turn], [own.factor, own.turn]));
                match item.product {
                    Product::Square => push(a, b, along, across, NORMAL),
                    Product::Dot => {
                        push(a, b, along, across, NORMAL);
                        push(b, a, along, -across, NORMAL);
                    }
                    Product::Cross(e) => {
                        let e = self.vectors[e as usize];
                        // e × and J multiply to −1 in the plane; in space there are no quarter turns.
                        push(a, b, -across, along, e);
                        push(b, a, -across, -along, e);
                    }
                }
            }
        }
        blocks
    }

    pub(crate) fn value_of(&self, id: InvariantId, x: &[f64]) -> f64 {
        let item = &self.items[id.0 as usize];
        match self.dim {
            2 => self.value_in::<2>(item, 1.0, x.as_chunks().0),
            _ => self.value_in::<3>(item, 1.0, x.as_chunks().0),
        }
    }

    /// ½ vᵀ H v (one an invariant).
    pub(crate) fn half_curvature(&self, v: &[f64], half: &mut [f64]) {
        let items = self.items.iter().zip(half);
        match self.dim {
            2 => items.for_each(|(item, half)| *half = self.value_in::<2>(item, 0.0, v.as_chunks().0)),
            _ => items.for_each(|(item, half)| *half = self.value_in::<3>(item, 0.0, v.as_chunks().0)),
        }
    }

    #[inline(always)]
    fn value_in<const D: usize>(&self, item: &Invariant, constants: f64, x: &[[f64; D]]) -> f64 {
        let sum = |sum: &Sum| self.sum_at(sum, self.summands_of(sum), constants, x);
        let u = sum(&item.u);
        match item.product {
            Product::Square => 0.5 * dot(&u, &u),
            Product::Dot => dot(&u, &sum(&item.w)),
            Product::Cross(e) => dot(&u, &cross(&sum(&item.w), &self.vectors[e as usize])),
        }
    }

    /// Values (one an invariant) and gradients (D a slot) at the positions `x`.
    pub(crate) fn evaluate(&self, x: &[f64], value: &mut [f64], gradient: &mut [f64]) {
        match self.dim {
            2 => self.evaluate_in::<2>(1.0, x, value, gradient),
            _ => self.evaluate_in::<3>(1.0, x, value, gradient),
        }
    }

    /// H v of every invariant (D a slot) and ½ vᵀ H v (one an invariant): the part of value and gradient that is
    /// homogeneous in the nodes, at `v` in place of positions.
    pub(crate) fn curvature(&self, v: &[f64], half: &mut [f64], product: &mut [f64]) {
        match self.dim {
            2 => self.evaluate_in::<2>(0.0, v, half, product),
            _ => self.evaluate_in::<3>(0.0, v, half, product),
        }
    }

    /// Values and gradients with `constants` times the constants of the sums.
    fn evaluate_in<const D: usize>(&self, constants: f64, x: &[f64], value: &mut [f64], gradient: &mut [f64]) {
        let (x, gradient) = (x.as_chunks::<D>().0, gradient.as_chunks_mut::<D>().0);
        let [mut u, mut w] = [[0.0; D]; 2];
        for (item, value) in self.items.iter().zip(value) {
            let in_u = self.summands_of(&item.u);
            if !item.repeats {
                u = self.sum_at(&item.u, in_u, constants, x);
            }
            if item.product == Product::Square {
                *value = 0.5 * dot(&u, &u);
                spread(in_u, &u, &mut gradient[item.u.slots()]);
                continue;
            }
            let in_w = self.summands_of(&item.w);
            if !item.repeats {
                w = self.sum_at(&item.w, in_w, constants, x);
            }
            let [by_u, by_w] = match item.product {
                Product::Cross(e) => {
                    let e = &self.vectors[e as usize];
                    [cross(&w, e), cross(&u, e).map(|c| -c)]
                }
                _ => [w, u],
            };
            *value = dot(&u, &by_u);
            spread(in_u, &by_u, &mut gradient[item.u.slots()]);
            spread(in_w, &by_w, &mut gradient[item.w.slots()]);
        }
    }

    /// One of the sums of an invariant, of these summands, with `constants` times its constant.
    #[inline(always)]
    fn sum_at<const D: usize>(&self, sum: &Sum, summands: &[Summand], constants: f64, x: &[[f64; D]]) -> [f64; D] {
        let mut out = match sum.constant {
            0 => [0.0; D],
            k => std::array::from_fn(|c| constants * self.vectors[k as usize][c]),
        };
        for &Summand { node, factor, turn } in summands {
            let x = &x[node as usize];
            (0..D).for_each(|c| out[c] += factor * x[c]);
            if D == 2 {
                out[0] -= turn * x[1];
                out[1] += turn * x[0];
            }
        }
        out
    }
}

/// The gradients of a product by the nodes of one of its sums, from that by the sum.
#[inline]
fn spread<const D: usize>(summands: &[Summand], by_sum: &[f64; D], gradient: &mut [[f64; D]]) {
    for (slot, &Summand { factor, turn, .. }) in gradient.iter_mut().zip(summands) {
        *slot = by_sum.map(|c| factor * c);
        if D == 2 {
            slot[0] += turn * by_sum[1];
            slot[1] -= turn * by_sum[0];
        }
    }
}

#[inline]
fn dot<const D: usize>(u: &[f64; D], w: &[f64; D]) -> f64 {
    (0..D).map(|c| u[c] * w[c]).sum()
}

/// w × e; in the plane e is the normal.
#[inline]
pub(crate) fn cross<const D: usize>(w: &[f64; D], e: &[f64; 3]) -> [f64; D] {
    std::array::from_fn(|c| match D {
        2 => [w[1], -w[0]][c],
        _ => w[(c + 1) % D] * e[(c + 2) % 3] - w[(c + 2) % D] * e[(c + 1) % 3],
    })
}

/// The matrix E with U·E·W = e·(U × W).
pub(crate) fn skew(e: &[f64; 3]) -> [[f64; 3]; 3] {
    [[0.0, e[2], -e[1]], [-e[2], 0.0, e[0]], [e[1], -e[0], 0.0]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::NodeId;

    /// Sums that come again one after the other are taken once: values are those of each invariant alone, and of quadratic forms
    /// half the difference between two sides is the gradient along the way.
    #[test]
    fn values_and_gradients_of_invariants_with_the_same_sums() {
        let node = |k: u32, factor: f64| Term { place: Place::Node(NodeId(k)), factor, turn: 0.0 };
        let fixed = Term { place: Place::Fixed([0.3, -0.2, 0.5]), factor: 1.0, turn: 0.0 };
        let (u, w) = ([node(0, 1.0), fixed], [node(1, 2.0), node(0, -1.0)]);
        let axes = [[1.0, 0.0, 0.0], [0.2, 0.9, -0.4], [0.2, 0.9, -0.4]];
        let mut invariants = Invariants::new(3);
        let mut all: Vec<InvariantId> = axes.iter().map(|&e| invariants.cross(e, &u, &w)).collect();
        all.push(invariants.dot(&u, &w));
        all.push(invariants.square(&u));
        all.push(invariants.dot(&u, &[]));
        all.push(invariants.square(&w));
        all.push(invariants.cross(axes[1], &w, &u));
        let repeats: Vec<bool> = invariants.items.iter().map(|item| item.repeats).collect();
        assert_eq!(repeats, [false, true, true, true, false, false, false, false]);

        let (x, v) = ([0.4, -1.1, 0.7, 1.3, 0.2, -0.6], [0.5, 0.8, -0.3, -0.9, 0.1, 1.2]);
        let (mut value, mut gradient) = (vec![0.0; all.len()], vec![0.0; 3 * invariants.slots()]);
        invariants.evaluate(&x, &mut value, &mut gradient);
        let moved = |sign: f64| -> Vec<f64> { x.iter().zip(&v).map(|(x, v)| x + sign * v).collect() };
        for (k, &id) in all.iter().enumerate() {
            assert_eq!(value[k], invariants.value_of(id, &x), "value of {k}");
            let slots = invariants.slots_of(id);
            let nodes: Vec<u32> = slots.clone().map(|slot| invariants.node_of(slot)).collect();
            let along = super::super::along(3, &nodes, &gradient[3 * slots.start..3 * slots.end], &v);
            let expected = 0.5 * (invariants.value_of(id, &moved(1.0)) - invariants.value_of(id, &moved(-1.0)));
            assert!((along - expected).abs() <= 1e-14, "gradient of {k}: {along} instead of {expected}");
        }
    }
}
