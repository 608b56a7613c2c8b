//! Functions of invariants that are no quadratic forms themselves: sums of invariants, of angles, of curves over these and of smooth
//! functions. Rows, laws and outputs take them like invariants.
//!
//! A function of invariants keeps what they keep: it does not change under rigid motion, and its discrete derivative,
//! with D·Δπ = Δg, makes momenta and energy exact (methods §8).

use super::part::first_of;
use super::{Derivatives, InvariantId, Invariants, MAX_ARGUMENTS, Part};

/// A function of a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FunctionId(pub(crate) u32);

/// What a row keeps, what a law acts on, what is recorded: an invariant or a function of some.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A quadratic form of nodes, as it is.
    Invariant(InvariantId),
    /// A sum of invariants, of angles and of smooth functions of them.
    Function(FunctionId),
}

impl From<InvariantId> for Quantity {
    fn from(id: InvariantId) -> Self {
        Self::Invariant(id)
    }
}

impl From<FunctionId> for Quantity {
    fn from(id: FunctionId) -> Self {
        Self::Function(id)
    }
}

#[derive(Clone)]
struct Summand {
    part: Part,
    factor: f64,
    /// Position of its first argument among those of the function, and how many it has.
    first: usize,
    arguments: usize,
}

/// A sum of parts with its arguments and slots.
#[derive(Clone)]
struct Function {
    summands: Vec<Summand>,
    base: Vec<InvariantId>,
    /// Its first slot among those of all functions.
    slot: usize,
    slots: usize,
    /// Its first angle among those of all functions.
    angle: usize,
}

/// All functions of a system.
#[derive(Clone, Default)]
pub(crate) struct Functions {
    items: Vec<Function>,
    /// For each slot of a function the slot of the invariant that it comes from, and which argument that is.
    source: Vec<(u32, u8)>,
    /// Angles at the start, from which turns are counted.
    start: Vec<f64>,
}

/// Evaluated functions: value and derivatives by their arguments, and the angles counted.
#[derive(Clone, Debug, Default)]
pub(crate) struct FunctionValues {
    pub local: Vec<Derivatives>,
    /// Angles counted over turns, and other numbers that are followed.
    pub angle: Vec<f64>,
}

impl Functions {
    pub fn add(&mut self, invariants: &Invariants, parts: &[(Part, f64)]) -> FunctionId {
        let mut function = Function { summands: Vec::new(), base: Vec::new(), slot: self.source.len(), slots: 0, angle: self.start.len() };
        for (part, factor) in parts {
            let of = part.arguments();
            self.start.extend(part.followed_from());
            let summand = Summand { part: part.clone(), factor: *factor, first: function.base.len(), arguments: of.len() };
            function.summands.push(summand);
            function.base.extend(of);
        }
        assert!(function.base.len() <= MAX_ARGUMENTS, "a function has at most {MAX_ARGUMENTS} arguments");
        for (k, &id) in function.base.iter().enumerate() {
            self.source.extend(invariants.slots_of(id).map(|s| (s as u32, k as u8)));
        }
        function.slots = self.source.len() - function.slot;
        self.items.push(function);
        FunctionId(self.items.len() as u32 - 1)
    }

    pub fn len(&self) -> usize {
        self.items.len()
    }

    /// Whether a function is a condition on velocities alone.
    pub fn is_pfaffian(&self, id: FunctionId) -> bool {
        self.items[id.0 as usize].summands.iter().any(|summand| matches!(summand.part, Part::Pfaffian { .. }))
    }

    /// What happens where a step between these invariants goes across a corner of a function.
    pub fn corner(&self, id: FunctionId, pi: [&[f64]; 2]) -> Option<&'static str> {
        self.items[id.0 as usize].summands.iter().find_map(|summand| summand.part.corner(pi))
    }

    pub fn is_empty(&self) -> bool {
        self.items.is_empty()
    }

    pub fn slots(&self) -> usize {
        self.source.len()
    }

    /// Slots of the invariants that the slots of the functions come from.
    pub fn sources(&self) -> impl Iterator<Item = usize> + '_ {
        self.source.iter().map(|&(s, _)| s as usize)
    }

    /// The slots of a function among those of all functions.
    pub fn slots_of(&self, id: FunctionId) -> std::ops::Range<usize> {
        let function = &self.items[id.0 as usize];
        function.slot..function.slot + function.slots
    }

    /// The invariants a function depends on.
    pub fn base(&self, id: FunctionId) -> &[InvariantId] {
        self.base_of(id.0 as usize)
    }

    /// The invariants the k-th function depends on.
    pub fn base_of(&self, k: usize) -> &[InvariantId] {
        &self.items[k].base
    }

    /// Has angles counted from these at the start.
    pub fn begin_at(&mut self, angles: &[f64]) {
        self.start.iter_mut().zip(angles).for_each(|(own, angle)| *own = *angle);
    }

    /// Room for values, with the angles of the start.
    pub fn values(&self) -> FunctionValues {
        FunctionValues { local: vec![Derivatives::default(); self.items.len()], angle: self.start.clone() }
    }

    /// The angles of a function among those of all.
    pub fn angles_of(&self, id: FunctionId) -> std::ops::Range<usize> {
        let k = id.0 as usize;
        self.items[k].angle..self.items.get(k + 1).map_or(self.start.len(), |next| next.angle)
    }

    /// Values and derivatives at the invariants `pi`, with angles counted from those that `out` holds.
    pub fn evaluate(&self, pi: &[f64], out: &mut FunctionValues) {
        for (function, local) in self.items.iter().zip(&mut out.local) {
            *local = Derivatives::default();
            let mut angle = function.angle;
            for summand in &function.summands {
                let mut part = summand.part.at(pi, &mut out.angle[angle..]);
                angle += usize::from(summand.part.is_followed());
                summand.add(&mut part, local);
            }
        }
    }

    /// The slope of a part that is a curve, by its coordinate, at the invariants `pi`.
    pub fn slope(&self, id: FunctionId, part: usize, pi: &[f64], values: &FunctionValues) -> f64 {
        let function = &self.items[id.0 as usize];
        let followed = function.angle + function.summands[..part].iter().filter(|summand| summand.part.is_followed()).count();
        let Part::Curve { of, curve } = &function.summands[part].part else { panic!("the part is a curve") };
        curve.at(of.at(pi, &mut first_of(&values.angle[followed..])).value)[1]
    }

    /// Discrete derivatives between two positions, and values half way.
    pub fn evaluate_between(&self, pi: [&[f64]; 2], from: &FunctionValues, to: &FunctionValues, out: &mut FunctionValues) {
        for (angle, (a, b)) in out.angle.iter_mut().zip(from.angle.iter().zip(&to.angle)) {
            *angle = 0.5 * (a + b);
        }
        for (k, (function, local)) in self.items.iter().zip(&mut out.local).enumerate() {
            *local = Derivatives::default();
            let mut angle = function.angle;
            for summand in &function.summands {
                let mut part = summand.part.between(pi, [&from.angle[angle..], &to.angle[angle..]]);
                angle += usize::from(summand.part.is_followed());
                summand.add(&mut part, local);
            }
            local.value = 0.5 * (from.local[k].value + to.local[k].value);
        }
    }

    /// Fills the slots of some functions (D a slot): for each argument `factor` times what the slots of the invariant hold in
    /// `inner`, plus `bend` times its gradient.
    pub fn compose(
        &self,
        dim: usize,
        of: impl Iterator<Item = usize>,
        parts: impl Fn(usize, &[InvariantId]) -> [[f64; 2]; MAX_ARGUMENTS],
        inner: &[f64],
        gradient: &[f64],
        out: &mut [f64],
    ) {
        match dim {
            2 => self.compose_in::<2>(of, parts, inner, gradient, out),
            _ => self.compose_in::<3>(of, parts, inner, gradient, out),
        }
    }

    fn compose_in<const D: usize>(
        &self,
        of: impl Iterator<Item = usize>,
        parts: impl Fn(usize, &[InvariantId]) -> [[f64; 2]; MAX_ARGUMENTS],
        inner: &[f64],
        gradient: &[f64],
        out: &mut [f64],
    ) {
        let [inner, gradient] = [inner, gradient].map(|slots| slots.as_chunks::<D>().0);
        let out = out.as_chunks_mut::<D>().0;
        for k in of {
            let function = &self.items[k];
            let (parts, slots) = (parts(k, &function.base), function.slot..function.slot + function.slots);
            for (out, &(source, argument)) in out[slots.clone()].iter_mut().zip(&self.source[slots]) {
                let ([factor, bend], source) = (parts[argument as usize], source as usize);
                let (inner, gradient) = (&inner[source], &gradient[source]);
                *out = std::array::from_fn(|c| factor * inner[c] + bend * gradient[c]);
            }
        }
    }
}

impl Summand {
    /// Adds the derivatives of this part to those of the function.
    fn add(&self, part: &mut Derivatives, sum: &mut Derivatives) {
        sum.value += self.factor * part.value;
        for i in 0..self.arguments {
            sum.gradient[self.first + i] += self.factor * part.gradient[i];
            for j in 0..self.arguments {
                sum.hessian[self.first + i][self.first + j] += self.factor * part.hessian[i][j];
            }
        }
    }
}
