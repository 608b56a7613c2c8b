//! The derivatives of an expression by all of its variables at once, from its last operation back to the first (reverse mode): that takes a few
//! times as long as its value, however many variables there are.

use num_dual::Dual;
use smallvec::SmallVec;

use super::functions::{integer_power, quotient, real_power};
use super::{NUMBERS, Op, Program};
use crate::system::Number;

/// Operations of a program whose values are not put on the heap.
const OPERATIONS: usize = 256;

impl Program {
    /// The value, and what it changes by with each variable added to `slopes`.
    pub fn slopes<N: Number>(&self, variables: &[N], slopes: &mut [N]) -> N {
        let zero = N::from(0.0);
        // Of each operation: its value, and by how much the value of the program changes with it.
        let mut values: SmallVec<[N; OPERATIONS]> = SmallVec::new();
        let mut weights: SmallVec<[N; OPERATIONS]> = SmallVec::from_elem(zero, self.ops.len());
        // The operations whose numbers each took, one after the other, those whose numbers wait, and those that keep theirs.
        let mut taken: SmallVec<[usize; OPERATIONS]> = SmallVec::new();
        let mut waiting: SmallVec<[usize; NUMBERS]> = SmallVec::new();
        let mut keeps: SmallVec<[usize; NUMBERS]> = SmallVec::from_elem(0, self.kept.len());
        let mut numbers: SmallVec<[N; NUMBERS]> = SmallVec::new();
        for (k, op) in self.ops.iter().enumerate() {
            let own = waiting.len() - op.takes();
            numbers.clear();
            numbers.extend(waiting[own..].iter().map(|&last| values[last]));
            values.push(match op {
                Op::Constant(value) => N::from(*value),
                Op::Variable(k) => variables[*k],
                Op::Kept(cell) => values[keeps[*cell]],
                Op::Keep(cell) => {
                    keeps[*cell] = k;
                    numbers[0]
                }
                _ => op.of(&numbers),
            });
            taken.extend(waiting.drain(own..));
            waiting.push(k);
        }
        weights[self.ops.len() - 1] = N::from(1.0);
        let mut varied: SmallVec<[Dual<N>; NUMBERS]> = SmallVec::new();
        for (k, op) in self.ops.iter().enumerate().rev() {
            let (weight, own) = (weights[k], taken.len() - op.takes());
            let last = &taken[own..];
            // What does not reach the value may have no slope.
            if weight.re() != 0.0 || !weight.is_constant() {
                match op {
                    Op::Constant(_) => (),
                    Op::Variable(k) => slopes[*k] += weight,
                    Op::Kept(cell) => weights[keeps[*cell]] += weight,
                    Op::Keep(_) | Op::Add => last.iter().for_each(|&last| weights[last] += weight),
                    _ => {
                        varied.clear();
                        varied.extend(last.iter().map(|&last| Dual::new(values[last], zero)));
                        for (i, &last) in last.iter().enumerate().filter(|(_, last)| !matches!(self.ops[**last], Op::Constant(_))) {
                            varied[i].eps = N::from(1.0);
                            let slope = op.of(&varied).eps;
                            varied[i].eps = zero;
                            // A slope without end of what is clipped stays behind.
                            if slope.re() != 0.0 || !slope.is_constant() {
                                weights[last] += weight * slope;
                            }
                        }
                    }
                }
            }
            taken.truncate(own);
        }
        values[self.ops.len() - 1]
    }
}

impl Op {
    /// The value of an operation on some numbers.
    #[inline(always)]
    pub(super) fn of<N: Number>(&self, numbers: &[N]) -> N {
        match (self, numbers) {
            (Self::Neg, &[x]) => -x,
            (Self::IntegerPower(power), &[x]) => integer_power(x, *power),
            (Self::RealPower(power), &[x]) => real_power(x, *power),
            (Self::OfOne(function), &[x]) => function.of_one(x),
            (Self::OfTable(curve), &[x]) => curve.evaluate(x),
            (Self::Add, &[x, y]) => x + y,
            (Self::Sub, &[x, y]) => x - y,
            (Self::Mul, &[x, y]) => x * y,
            (Self::Div, &[x, y]) => quotient(x, y),
            (Self::OfTwo(function), &[x, y]) => function.of_two(x, y),
            (Self::OfMany(function, k), numbers) => function.evaluate(*k, numbers),
            _ => unreachable!("what is no operation on numbers, or one on others"),
        }
    }
}
