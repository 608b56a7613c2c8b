//! Parts of a formula that follow from time alone.

use std::f64::consts::PI;
use std::ops::Range;

use super::cells::begins;
use super::curve::Curve;
use super::functions::Function;
use super::{Op, Program};
use crate::system::EvenZeros;

/// A number that is linear in a variable, with the largest one that was added on the way.
#[derive(Clone, Copy)]
struct Line {
    slope: f64,
    offset: f64,
    size: f64,
}

impl Line {
    fn times(self, factor: f64) -> Self {
        Self { slope: self.slope * factor, offset: self.offset * factor, size: self.size * factor.abs() }
    }

    fn plus(self, other: Self) -> Self {
        Self { slope: self.slope + other.slope, offset: self.offset + other.offset, size: self.size.max(other.size) }
    }

    /// The number, where it is constant.
    fn constant(self) -> Option<f64> {
        (self.slope == 0.0).then_some(self.offset)
    }
}

/// What the operations leave, where that is linear in the one variable.
fn line(ops: &[Op]) -> Option<Line> {
    let mut waiting: Vec<Line> = Vec::new();
    for op in ops {
        let line = match op {
            Op::Constant(value) => Line { slope: 0.0, offset: *value, size: value.abs() },
            Op::Variable(_) => Line { slope: 1.0, offset: 0.0, size: 0.0 },
            Op::Neg => waiting.pop()?.times(-1.0),
            Op::Add | Op::Sub | Op::Mul | Op::Div => {
                let (last, first) = (waiting.pop()?, waiting.pop()?);
                match op {
                    Op::Add => first.plus(last),
                    Op::Sub => first.plus(last.times(-1.0)),
                    Op::Mul => {
                        first.constant().map(|factor| last.times(factor)).or_else(|| last.constant().map(|factor| first.times(factor)))?
                    }
                    _ => first.times(1.0 / last.constant()?),
                }
            }
            _ => return None,
        };
        waiting.push(line);
    }
    waiting.pop()
}

/// What changes its sign where a number comes to the next integer, as operations: with the same rounding as `floor` itself, which a function that
/// is zero at integers has not.
const AT_INTEGERS: [Op; 5] = [Op::OfOne(Function::Floor), Op::Constant(2.0), Op::OfTwo(Function::Mod), Op::Constant(0.5), Op::Sub];

impl Program {
    /// The expressions of the variable `t` alone, and of nothing else, at whose changes of sign this one jumps or has a kink, as programs of
    /// one variable: the arguments of `step`, `sign` and `abs`, the difference of those of `min` and `max`, the first of `atan2`, the cosine of
    /// that of `tan`, and what has another sign where `floor` and `mod` have jumped.
    pub fn switches(&self, t: usize) -> Vec<Self> {
        self.changes(t, Curve::kinks)
    }

    /// The same without the knots of smooth curves, at which neither its value nor its slope jumps.
    pub fn corners(&self, t: usize) -> Vec<Self> {
        self.changes(t, Curve::corners)
    }

    /// What changes sign there, of tables by these places of theirs.
    fn changes(&self, t: usize, of_table: fn(&Curve) -> Vec<Vec<Op>>) -> Vec<Self> {
        let begins = begins(&self.ops);
        let mut found = Vec::new();
        for (k, op) in self.ops.iter().enumerate() {
            let mut note = |end: usize, last: &[Op]| found.extend(self.of_time(t, begins[k]..end, &begins, last));
            match op {
                Op::OfOne(Function::Step | Function::Sign | Function::Abs) => note(k, &[]),
                Op::OfOne(Function::Floor) => note(k, &AT_INTEGERS),
                Op::OfOne(Function::Tan) => note(k, &[Op::OfOne(Function::Cos)]),
                Op::OfTable(curve) => of_table(curve).iter().for_each(|place| note(k, place)),
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

    /// The largest parts of it that are formulas of the variable `t` and of nothing else, as programs of one variable; none that calls functions of
    /// a program, which may take long.
    pub fn parts_of_time(&self, t: usize) -> Vec<Self> {
        let (begins, mut found) = (begins(&self.ops), Vec::new());
        // Whether what each operation leaves depends on nothing but t, and what is kept.
        let (mut is_own, mut of_kept) = (Vec::<bool>::new(), vec![false; self.kept.len()]);
        for (k, op) in self.ops.iter().enumerate() {
            let operands = self.operands(k, &begins);
            let own = match op {
                Op::Variable(variable) => *variable == t,
                Op::OfMany(..) => false,
                Op::Kept(cell) => of_kept[*cell],
                _ => operands.iter().all(|&last| is_own[last]),
            };
            if let Op::Keep(cell) = op {
                of_kept[*cell] = own;
            }
            if !own {
                let parts = operands.iter().rev().filter(|&&last| is_own[last]);
                found.extend(parts.filter_map(|&last| self.of_time(t, begins[last]..last + 1, &begins, &[])));
            }
            is_own.push(own);
        }
        if is_own.last() == Some(&true) {
            found.extend(self.of_time(t, 0..self.ops.len(), &begins, &[]));
        }
        found
    }

    /// The expression t − `time`.
    pub fn since(time: f64) -> Self {
        Self::new(vec![Op::Variable(0), Op::Constant(time), Op::Sub], Vec::new())
    }

    /// The times at which it is zero, where it is linear in its one variable, or the sine of what is.
    pub fn even_zeros(&self) -> Option<EvenZeros> {
        let (ops, half_turn) = match &self.ops[..] {
            [ops @ .., Op::OfOne(Function::Sin)] => (ops, PI),
            ops => (ops, f64::INFINITY),
        };
        let Line { slope, offset, size } = line(ops).filter(|line| line.slope != 0.0)?;
        Some(EvenZeros { one: -offset / slope, apart: half_turn / slope.abs(), size: size / slope.abs() })
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
