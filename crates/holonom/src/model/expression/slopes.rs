//! The derivatives of an expression by all of its variables at once, from its last operation back to the first (reverse mode): that takes a few
//! times as long as its value, however many variables there are.

use num_dual::Dual;
use smallvec::SmallVec;

use super::functions::{integer_power, quotient, real_power};
use super::{NUMBERS, Op, Program};
use crate::system::Number;

/// Operations of a short program, and of one whose values are not put on the heap.
const SHORT: usize = 32;
const LONG: usize = 256;

/// What is known of each operation on the way back.
struct Room<'a, N> {
    values: &'a mut [N],
    /// By how much the value of the program changes with it.
    weights: &'a mut [N],
    /// The operations whose numbers each took, one after the other.
    taken: &'a mut [usize],
}

impl Program {
    /// The value, and what it changes by with each variable added to `slopes`.
    pub fn slopes<N: Number>(&self, variables: &[N], slopes: &mut [N]) -> N {
        let zero = N::from(0.0);
        let count = self.ops.len();
        let room = if count <= SHORT {
            Room { values: &mut [zero; SHORT], weights: &mut [zero; SHORT], taken: &mut [0; SHORT] }
        } else if count <= LONG {
            Room { values: &mut [zero; LONG], weights: &mut [zero; LONG], taken: &mut [0; LONG] }
        } else {
            Room { values: &mut vec![zero; count], weights: &mut vec![zero; count], taken: &mut vec![0; count] }
        };
        self.slopes_in(room, variables, slopes)
    }

    fn slopes_in<N: Number>(&self, room: Room<'_, N>, variables: &[N], slopes: &mut [N]) -> N {
        let Room { values, weights, taken } = room;
        // The operations whose numbers wait, and those that keep theirs.
        let mut waiting: SmallVec<[usize; NUMBERS]> = SmallVec::new();
        let mut keeps: SmallVec<[usize; NUMBERS]> = SmallVec::new();
        keeps.resize(self.kept.len(), 0);
        let mut count = 0;
        for (k, op) in self.ops.iter().enumerate() {
            let own = waiting.len() - op.takes();
            let last = &waiting[own..];
            values[k] = match op {
                Op::Constant(value) => N::from(*value),
                Op::Variable(k) => variables[*k],
                Op::Kept(cell) => values[keeps[*cell]],
                Op::Keep(cell) => {
                    keeps[*cell] = k;
                    values[last[0]]
                }
                _ => op.of_all(last.iter().map(|&last| values[last])),
            };
            taken[count..count + last.len()].copy_from_slice(last);
            count += last.len();
            waiting.truncate(own);
            waiting.push(k);
        }
        weights[self.ops.len() - 1] = N::from(1.0);
        for (k, op) in self.ops.iter().enumerate().rev() {
            let weight = weights[k];
            let last = &taken[count - op.takes()..count];
            count -= last.len();
            // What does not reach the value may have no slope.
            if weight.re() == 0.0 && weight.is_constant() {
                continue;
            }
            match op {
                Op::Constant(_) => (),
                Op::Variable(k) => slopes[*k] += weight,
                Op::Kept(cell) => weights[keeps[*cell]] += weight,
                Op::Keep(_) | Op::Add => last.iter().for_each(|&last| weights[last] += weight),
                _ => {
                    for (i, &varied) in last.iter().enumerate().filter(|(_, last)| !matches!(self.ops[**last], Op::Constant(_))) {
                        let one = |j: usize| N::from(if i == j { 1.0 } else { 0.0 });
                        let slope = op.of_all(last.iter().enumerate().map(|(j, &last)| Dual::new(values[last], one(j)))).eps;
                        // A slope without end of what is clipped stays behind.
                        if slope.re() != 0.0 || !slope.is_constant() {
                            weights[varied] += weight * slope;
                        }
                    }
                }
            }
        }
        values[self.ops.len() - 1]
    }
}

impl Op {
    /// [`Op::of`] of numbers one after the other: most take one or two.
    #[inline(always)]
    fn of_all<N: Number>(&self, mut numbers: impl ExactSizeIterator<Item = N>) -> N {
        let mut next = || numbers.next().expect("as many as it takes");
        match self.takes() {
            1 => self.of(&[next()]),
            2 => self.of(&[next(), next()]),
            _ => self.of(&numbers.collect::<SmallVec<[N; NUMBERS]>>()),
        }
    }

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
