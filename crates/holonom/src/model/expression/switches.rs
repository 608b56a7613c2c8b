//! Where expressions jump or have kinks at known times.

use std::f64::consts::PI;
use std::ops::Range;

use super::cells::begins;
use super::functions::Function;
use super::{Op, Program};

/// What is zero where a number is an integer, and goes through zero there, as operations.
const AT_INTEGERS: [Op; 3] = [Op::Constant(PI), Op::Mul, Op::OfOne(Function::Sin)];

impl Program {
    /// The expressions of the variable `t` alone, and of nothing else, at whose zeros this one jumps or has a kink, as programs of
    /// one variable: the arguments of `step`, `sign` and `abs`, the difference of those of `min` and `max`, the first of `atan2`, the cosine of
    /// that of `tan`, and what is zero where `floor` and `mod` jump.
    pub fn switches(&self, t: usize) -> Vec<Self> {
        let begins = begins(&self.ops);
        let mut found = Vec::new();
        for (k, op) in self.ops.iter().enumerate() {
            let mut note = |end: usize, last: &[Op]| found.extend(self.of_time(t, begins[k]..end, &begins, last));
            match op {
                Op::OfOne(Function::Step | Function::Sign | Function::Abs) => note(k, &[]),
                Op::OfOne(Function::Floor) => note(k, &AT_INTEGERS),
                Op::OfOne(Function::Tan) => note(k, &[Op::OfOne(Function::Cos)]),
                Op::OfTable(curve) => curve.kinks().for_each(|kink| note(k, &kink)),
                Op::OfTwo(Function::Min | Function::Max) => note(k, &[Op::Sub]),
                Op::OfTwo(Function::Mod) => note(k, &[&[Op::Div], &AT_INTEGERS[..]].concat()),
                // What it has first ends where the second begins.
                Op::OfTwo(Function::Atan2) => note(begins[k - 1], &[]),
                // What a function of a program jumps at is not known.
                _ => (),
            }
        }
        found
    }

    /// A program of these operations and of `last` ones, where they depend on the variable `t` alone.
    fn of_time(&self, t: usize, range: Range<usize>, begins: &[usize], last: &[Op]) -> Option<Self> {
        let mut ops = Vec::new();
        self.append(range, begins, &mut ops);
        let (mut reads, mut of_others) = (false, false);
        for op in &mut ops {
            if let Op::Variable(k) = op {
                (reads, of_others) = (true, of_others || *k != t);
                *k = 0;
            }
        }
        ops.extend_from_slice(last);
        (reads && !of_others).then(|| Self::new(ops, self.kept.to_vec()))
    }
}
