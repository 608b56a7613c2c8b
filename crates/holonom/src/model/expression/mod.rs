//! Formulas in a model: parsed once to a postfix program, evaluated over plain or dual numbers without allocating.
//!
//! `+ - * / ^` with ^ strongest and to the right, then signs; functions and constants as in the tables of
//! `functions.rs`; names are variables, indices of `repeat`, and `[parameters]`. Where an expression is of what a mechanism does,
//! names have dots, as `hinge.angle`, and stand in single quotes where they have other signs: `'left-strut.force'`.

mod bound;
mod call;
mod cells;
mod curve;
mod external;
mod functions;
mod lex;
mod names;
mod of_time;
mod parse;
mod slopes;
#[cfg(test)]
mod tests;

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use num_dual::Dual2_64;
use smallvec::SmallVec;

use crate::record::Formula;
use crate::system::{Bend, EvenZeros, Number, Signal};
pub use curve::{Beyond, Curve, refusal};
pub(in crate::model) use external::central;
pub use external::{External, ExternalFunction, Functions, differences};
use functions::Function;
pub use names::{Names, Nothing, beside, nearest_beside};

/// Numbers at once, while an expression is evaluated, that are not put on the heap.
const NUMBERS: usize = 32;

/// Numbers at once of most expressions: room for more takes longer to make than these take to evaluate.
const FEW: usize = 8;

/// Whether formulas of what a mechanism does have a function of this name, but for those that a model has of its own.
pub fn is_formula_function(name: &str) -> bool {
    let functions = functions::FUNCTIONS.iter().map(|(known, ..)| *known);
    let of_motion = names::OF_PLACES.iter().map(|(known, ..)| *known).chain(names::RUNNING.iter().map(|(known, _)| *known));
    functions.chain(of_motion).chain([names::LOCAL.0]).any(|known| known == name)
}

/// A mistake in the text of an expression.
#[derive(Clone, Debug, PartialEq)]
pub struct Mistake {
    /// Character of the text, counted from 0.
    pub character: usize,
    pub message: String,
    pub cure: String,
    /// Whether this only follows from a fault that has been reported: a parameter that could not be read.
    pub known: bool,
}

impl Mistake {
    pub(super) fn new(character: usize, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { character, message: message.into(), cure: cure.into(), known: false }
    }

    /// Of what follows from a fault that has been reported.
    pub(super) fn known() -> Self {
        Self { known: true, ..Self::new(0, "", "") }
    }
}

/// What a name of the model stands for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Value {
    Known(f64),
    /// It is there, but it could not be read.
    Faulty,
}

/// What bars are in [`Scope::others`].
pub(in crate::model) const BAR: &str = "a bar";
pub(in crate::model) const BEAM: &str = "a beam";

/// The names an expression may use beside its variables.
#[derive(Clone, Copy, Default)]
pub struct Scope<'a> {
    /// `[parameters]`; none while there are no parameters yet.
    pub parameters: Option<&'a HashMap<String, Value>>,
    /// Those of them whose formulas have the unit `deg`.
    pub degrees: Option<&'a HashSet<String>>,
    /// Indices of `repeat` with their values.
    pub indices: &'a [(String, f64)],
    /// `[table.NAME]`, which are functions of one number; `None` where one could not be read.
    pub tables: Option<&'a HashMap<String, Option<Arc<Curve>>>>,
    /// Functions that a program gives.
    pub functions: Option<&'a Functions>,
    /// What the entries of the model are that are neither points nor bodies, such as `"a bar"`.
    pub others: Option<&'a HashMap<String, &'static str>>,
}

impl<'a> Scope<'a> {
    /// The value of an index or a parameter.
    pub fn value(&self, name: &str) -> Option<Value> {
        let index = self.indices.iter().find(|(index, _)| index == name).map(|&(_, value)| Value::Known(value));
        index.or_else(|| self.parameters.and_then(|parameters| parameters.get(name).copied()))
    }

    /// What an entry is, by its name with or without an index, that is neither a point nor a body.
    pub fn called(&self, name: &str) -> Option<&'static str> {
        let base = name.split('[').next().unwrap_or(name);
        self.others.and_then(|others| others.get(base).copied())
    }

    /// What is wrong with a name that has places, or the name of a coordinate, where it is that of a bar.
    pub(in crate::model) fn of_bar(&self, name: &str) -> Option<Mistake> {
        let bar = name.rsplit_once('.').map_or(name, |(owner, _)| owner);
        (self.called(bar) == Some(BAR)).then(|| {
            let cure = format!("name a point at its ends; measures also read its tension, `{bar}.force`");
            Mistake::new(0, format!("`{bar}` is a bar, which has no place and no motion of its own"), cure)
        })
    }

    /// All names, indices first.
    pub fn names(&self) -> impl Iterator<Item = &'a str> {
        let parameters = self.parameters.into_iter().flat_map(|parameters| parameters.keys().map(String::as_str));
        self.indices.iter().map(|(name, _)| name.as_str()).chain(parameters)
    }
}

/// Whether a name is a constant or a function, so that no parameter may have it.
pub fn is_reserved(name: &str) -> bool {
    functions::CONSTANTS.iter().any(|known| known.0 == name) || functions::FUNCTIONS.iter().any(|known| known.0 == name)
}

/// What a name stands for in every expression, if it is that of a number: a constant or a unit.
pub fn number_called(name: &str) -> Option<&'static str> {
    let is_in = |known: &[(&str, f64)]| known.iter().any(|known| known.0 == name);
    if is_in(functions::CONSTANTS) { Some("constant") } else { is_in(functions::UNITS).then_some("unit") }
}

/// Whether a function of places or of a whole run has this name, which a table or a function of a program would hide.
pub fn is_of_what_moves(name: &str) -> bool {
    names::OF_PLACES.iter().any(|known| known.0 == name) || names::LOCAL.0 == name || names::RUNNING.iter().any(|known| known.0 == name)
}

/// A name with the indices in its brackets worked out: `link[i-1].x` becomes `link[2].x`.
///
/// # Errors
/// An index that is no whole number, with its character in the name.
pub fn indexed(name: &str, scope: &Scope<'_>) -> Result<String, Mistake> {
    let (mut full, mut rest, mut at) = (String::new(), name, 0);
    while let Some((before, behind)) = rest.split_once('[') {
        at += before.chars().count() + 1;
        let Some((text, after)) = behind.split_once(']') else {
            return Err(Mistake::new(at, "a closing ] is missing", "write \"NAME[i]\""));
        };
        let index = Program::parse(text, &[], scope).map_err(|inner| Mistake { character: at + inner.character, ..inner })?;
        let value = index.as_constant().expect("no variables");
        if value.is_nan() || (value - value.round()).abs() > 1e-9 {
            return Err(Mistake::new(at, format!("the index `{text}` is {value}, which is no whole number"), "write \"NAME[i]\""));
        }
        full.push_str(&format!("{before}[{}]", value.round()));
        at += text.chars().count() + 1;
        rest = after;
    }
    full.push_str(rest);
    Ok(full)
}

/// The names in an expression that are not called as functions; none where it cannot be read.
pub fn names_in(text: &str) -> Vec<String> {
    lex::names(text)
}

#[derive(Clone, Debug, PartialEq)]
enum Op {
    Constant(f64),
    Variable(usize),
    Neg,
    Add,
    Sub,
    Mul,
    Div,
    IntegerPower(i32),
    RealPower(f64),
    OfOne(Function),
    OfTwo(Function),
    OfTable(Arc<Curve>),
    /// A value of a function that a program gives.
    OfMany(External, usize),
    /// Keeps the number in a cell, too.
    Keep(usize),
    /// The number in a cell.
    Kept(usize),
}

/// An expression ready to be evaluated.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    ops: Box<[Op]>,
    /// The measures whose numbers are kept, a cell each.
    kept: Box<[Arc<str>]>,
    /// Numbers it has at once: those that are kept, and those that wait for an operation.
    room: usize,
}

impl Program {
    /// Whether it calls functions of a program.
    pub(in crate::model) fn calls(&self) -> bool {
        self.ops.iter().any(|op| matches!(op, Op::OfMany(..)))
    }

    /// Parses an expression of `variables`, which are later given by their positions in this list.
    ///
    /// # Errors
    /// The first mistake in the text, with its character and a cure.
    pub fn parse(text: &str, variables: &[&str], scope: &Scope<'_>) -> Result<Self, Mistake> {
        Self::parse_with(text, variables, &mut Nothing, scope)
    }

    /// The same of an expression that also names what a mechanism does: `names` numbers that behind the variables.
    ///
    /// # Errors
    /// The first mistake in the text, with its character and a cure.
    pub fn parse_with(text: &str, variables: &[&str], names: &mut dyn Names, scope: &Scope<'_>) -> Result<Self, Mistake> {
        parse::parse(text, variables, names, scope)
    }

    /// The expression that is always `value`.
    pub fn constant(value: f64) -> Self {
        Self::new(vec![Op::Constant(value)], Vec::new())
    }

    /// The value, if it depends on no variable.
    pub fn as_constant(&self) -> Option<f64> {
        match self.ops[..] {
            [Op::Constant(value)] => Some(value),
            _ => None,
        }
    }

    /// Whether it depends on anything behind its first variables, which are so many.
    pub fn reads_behind(&self, variables: usize) -> bool {
        self.ops.iter().any(|op| matches!(op, Op::Variable(k) if *k >= variables))
    }

    /// How many variables it needs: one more than the largest number of one.
    pub fn variables(&self) -> usize {
        self.ops.iter().map(|op| if let Op::Variable(k) = op { k + 1 } else { 0 }).max().unwrap_or(0)
    }

    /// The value for values of the variables. Nothing is allocated but for more numbers at once than [`NUMBERS`].
    pub fn evaluate<N: Number>(&self, variables: &[N]) -> N {
        self.run::<N, false>(variables, |_, _, _| ())
    }

    /// Hands over where the expression bends. It has corners where the arguments of `step`, `sign` and `abs` are zero, where those of `min` and
    /// `max` are equal, where `floor` and `mod` jump, and at the knots of a table. It may have peaks where the argument of `exp` is largest, where
    /// what is divided by is smallest, where the argument of `tanh`, `cosh` or `atan` is zero, and where a table is highest or lowest.
    pub fn bends(&self, variables: &[f64], mut note: &mut dyn FnMut(Bend)) {
        self.run::<f64, true>(variables, |op, [x, y], is_scaled| match op.takes() {
            1 => tell_of_one(op, x, &mut note),
            _ => tell_of_two(op, [x, y], is_scaled, &mut note),
        });
    }

    /// The first table that is asked where it refuses to have a value, and for which argument.
    pub fn refused(&self, variables: &[f64]) -> Option<(&Curve, f64)> {
        let mut refused = None;
        self.run::<f64, true>(variables, |op, [argument, _], _| match op {
            Op::OfTable(curve) if refused.is_none() && curve.refuses(argument) => refused = Some((&**curve, argument)),
            _ => (),
        });
        refused
    }

    /// The value. With `TELLS` operations on one number and on two are shown with these, and whether the second is constant.
    fn run<'a, N: Number, const TELLS: bool>(&'a self, variables: &[N], mut show: impl FnMut(&'a Op, [f64; 2], bool)) -> N {
        let (mut few, mut many);
        let zero = N::from(0.0);
        let numbers: &mut [N] = if self.room <= FEW {
            few = [zero; FEW];
            &mut few
        } else {
            many = SmallVec::<[N; NUMBERS]>::from_elem(zero, self.room);
            &mut many
        };
        let (cells, stack) = numbers.split_at_mut(self.kept.len());
        let mut top = 0;
        for (k, op) in self.ops.iter().enumerate() {
            match op {
                Op::Constant(value) => {
                    stack[top] = N::from(*value);
                    top += 1;
                    continue;
                }
                Op::Variable(k) => {
                    stack[top] = variables[*k];
                    top += 1;
                    continue;
                }
                Op::Kept(cell) => {
                    stack[top] = cells[*cell];
                    top += 1;
                    continue;
                }
                Op::Keep(cell) => {
                    cells[*cell] = stack[top - 1];
                    continue;
                }
                // Most operations are these, which have nothing to tell.
                Op::Add | Op::Sub | Op::Mul => {
                    top -= 1;
                    let (x, y) = (stack[top - 1], stack[top]);
                    stack[top - 1] = match op {
                        Op::Add => x + y,
                        Op::Sub => x - y,
                        _ => x * y,
                    };
                    continue;
                }
                _ => {}
            }
            let begin = top - op.takes();
            if TELLS && !matches!(op, Op::OfMany(..)) {
                let is_scaled = matches!(self.ops[k - 1], Op::Constant(_));
                show(op, [stack[begin].re(), if top - begin > 1 { stack[begin + 1].re() } else { 0.0 }], is_scaled);
            }
            stack[begin] = op.of(&stack[begin..top]);
            top = begin + 1;
        }
        stack[0]
    }
}

/// Tells where an operation on the number `x` bends.
fn tell_of_one(op: &Op, x: f64, note: &mut impl FnMut(Bend)) {
    match op {
        Op::OfOne(Function::Step | Function::Sign | Function::Abs) => note(Bend::Corner(x)),
        Op::OfOne(Function::Floor) => note(Bend::Corner(at_integers(x))),
        Op::OfOne(Function::Exp) => note(Bend::Peak(x)),
        // 1/cosh, and with its square the rate of tanh, where cosh itself may be too large for a number.
        Op::OfOne(Function::Tanh | Function::Cosh) => note(Bend::Peak(-2.0 * x.abs())),
        Op::OfOne(Function::Atan) => note(Bend::Peak(-(1.0 + x * x).ln())),
        Op::IntegerPower(power) if *power < 0 => note(Bend::Peak(f64::from(*power) * x.abs().ln())),
        Op::RealPower(power) if *power < 0.0 => note(Bend::Peak(power * x.abs().ln())),
        Op::OfTable(curve) => curve.bends(x, note),
        _ => (),
    }
}

/// The same on two numbers, the second of which is constant where the first `is_scaled` by it.
fn tell_of_two(op: &Op, [x, y]: [f64; 2], is_scaled: bool, note: &mut impl FnMut(Bend)) {
    match op {
        Op::OfTwo(Function::Min | Function::Max) => note(Bend::Corner(x - y)),
        Op::OfTwo(Function::Mod) => note(Bend::Corner(at_integers(x / y))),
        Op::Div if !is_scaled => note(Bend::Peak(-y.abs().ln())),
        _ => (),
    }
}

/// What goes through zero where a number is an integer, and has its other sign as soon as `floor` has jumped.
fn at_integers(x: f64) -> f64 {
    let sign = 0.5 - x.floor().rem_euclid(2.0);
    (std::f64::consts::PI * x).sin().abs().max(f64::MIN_POSITIVE).copysign(sign)
}

impl Formula for Program {
    fn evaluate(&self, values: &[f64]) -> f64 {
        Self::evaluate(self, values)
    }
}

/// A program of the one variable t, as a known function of time.
#[derive(Clone, Debug, PartialEq)]
pub struct TimeProgram(pub Program);

impl TimeProgram {
    /// Value, rate and second derivative, as one number.
    pub fn dual(&self, t: f64) -> Dual2_64 {
        self.0.evaluate(&[Dual2_64::new(t, 1.0, 0.0)])
    }
}

impl Signal for TimeProgram {
    fn at(&self, t: f64) -> [f64; 3] {
        let value = self.dual(t);
        [value.re, value.v1, value.v2]
    }

    fn is_constant(&self) -> bool {
        self.0.as_constant().is_some()
    }

    fn even_zeros(&self) -> Option<EvenZeros> {
        self.0.even_zeros()
    }
}
