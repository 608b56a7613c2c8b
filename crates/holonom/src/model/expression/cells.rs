//! What an expression reads of measures is worked out once and kept: measures of measures would grow without end if each use were written out.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

use super::parse::Parser;
use super::{Mistake, Op, Program};

impl Op {
    /// How many numbers it takes; it leaves one.
    pub(super) fn takes(&self) -> usize {
        match self {
            Self::Constant(_) | Self::Variable(_) | Self::Kept(_) => 0,
            Self::Neg | Self::IntegerPower(_) | Self::RealPower(_) | Self::OfOne(_) | Self::OfTable(_) | Self::Keep(_) => 1,
            Self::Add | Self::Sub | Self::Mul | Self::Div | Self::OfTwo(_) => 2,
            Self::OfMany(function, _) => function.arguments(),
        }
    }
}

/// Where the operations begin that the number after each operation comes of.
pub(super) fn begins(ops: &[Op]) -> Vec<usize> {
    let mut waiting = Vec::new();
    let begin_of = |(k, op): (usize, &Op)| {
        let begin = match op.takes() {
            0 => k,
            takes => waiting.drain(waiting.len() - takes..).next().expect("it takes some"),
        };
        waiting.push(begin);
        begin
    };
    ops.iter().enumerate().map(begin_of).collect()
}

impl Program {
    /// Of these operations, which keep the numbers of measures of these names.
    pub(super) fn new(ops: Vec<Op>, kept: Vec<Arc<str>>) -> Self {
        let (mut waiting, mut most) = (0, 0);
        for op in &ops {
            waiting = waiting + 1 - op.takes();
            most = most.max(waiting);
        }
        Self { room: kept.len() + most, ops: ops.into(), kept: kept.into() }
    }

    /// The last operations of the numbers that one takes, from the last number to the first.
    pub(super) fn operands(&self, k: usize, begins: &[usize]) -> Vec<usize> {
        let mut end = k;
        let before = |_| {
            let last = end - 1;
            end = begins[last];
            last
        };
        (0..self.ops[k].takes()).map(before).collect()
    }

    /// Appends some of its operations, which begin as in `begins`; what they find kept is worked out where it is first needed.
    pub(super) fn append(&self, range: Range<usize>, begins: &[usize], out: &mut Vec<Op>) {
        for op in &self.ops[range] {
            let is_keep = |op: &Op, cell: usize| matches!(op, Op::Keep(known) if *known == cell);
            match *op {
                Op::Kept(cell) if !out.iter().any(|op| is_keep(op, cell)) => {
                    let keep = self.ops.iter().position(|op| is_keep(op, cell)).expect("it was kept before");
                    self.append(begins[keep]..keep + 1, begins, out);
                }
                _ => out.push(op.clone()),
            }
        }
    }
}

impl Parser<'_> {
    /// Takes over the formula of a measure and keeps its number, but for what is kept already.
    pub(super) fn take_over(&mut self, name: &str, program: &Program) -> Result<(), Mistake> {
        if let Some(cell) = self.cell(name) {
            self.emit(Op::Kept(cell));
            return Ok(());
        }
        let begins = begins(&program.ops);
        // Where what is kept already begins, and its last operation and cell: of what begins at one place the last is the whole.
        let mut known = HashMap::new();
        for (k, op) in program.ops.iter().enumerate() {
            if let Op::Keep(cell) = op
                && let Some(cell) = self.cell(&program.kept[*cell])
            {
                known.insert(begins[k], (k, cell));
            }
        }
        let (t, mut k) = (self.variables.iter().position(|&variable| variable == "t"), 0);
        while let Some(op) = program.ops.get(k) {
            let (last, op) = match (known.get(&k), op) {
                (Some(&(last, cell)), _) => (last, Op::Kept(cell)),
                (None, Op::Variable(0)) => (k, Op::Variable(t.ok_or_else(|| self.unknown("t"))?)),
                (None, Op::Variable(of)) => (k, Op::Variable(self.variables.len() + of - 1)),
                (None, Op::Keep(cell)) => (k, self.keep(program.kept[*cell].clone())),
                (None, Op::Kept(cell)) => (k, Op::Kept(self.cell(&program.kept[*cell]).expect("it was kept before"))),
                (None, other) => (k, other.clone()),
            };
            self.emit(op);
            k = last + 1;
        }
        // What is only a number or a variable need not be kept.
        if program.ops.len() > 1 {
            let keep = self.keep(name.into());
            self.emit(keep);
        }
        Ok(())
    }

    /// The cell of a measure whose number is kept.
    fn cell(&self, name: &str) -> Option<usize> {
        self.kept.iter().position(|known| **known == *name)
    }

    fn keep(&mut self, name: Arc<str>) -> Op {
        self.kept.push(name);
        Op::Keep(self.kept.len() - 1)
    }
}
