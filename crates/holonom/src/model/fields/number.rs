use super::{Field, Shape};
use crate::model::entry::{Entry, Spot};
use crate::model::expression::{Names, Nothing, Program};
use crate::model::fault::Read;
use crate::model::unseen::Course;
use crate::model::value::Value;

/// A number, or a formula over parameters and, where a key says so, other variables.
#[derive(Clone, Debug, PartialEq)]
pub enum Number {
    /// The number itself.
    Given(f64),
    /// As an expression, evaluated when the model is compiled.
    Formula(String),
}

impl Field for Number {
    const SHAPE: Shape = Shape::Number;
    const LIST: Shape = Shape::Numbers(0, usize::MAX);
    const MAP: Shape = Shape::Weights;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::Number(number) => Ok(Self::Given(*number)),
            Value::Text(text) => Ok(Self::Formula(text.clone())),
            other => Err(entry.wanted(spot, "a number", other)),
        }
    }

    fn write(&self) -> Value {
        match self {
            Self::Given(number) => Value::Number(*number),
            Self::Formula(text) => Value::text(text),
        }
    }
}

impl From<f64> for Number {
    fn from(number: f64) -> Self {
        Self::Given(number)
    }
}

impl From<i32> for Number {
    fn from(number: i32) -> Self {
        Self::Given(number.into())
    }
}

impl From<u32> for Number {
    fn from(number: u32) -> Self {
        Self::Given(number.into())
    }
}

impl From<&str> for Number {
    fn from(formula: &str) -> Self {
        Self::Formula(formula.into())
    }
}

impl From<String> for Number {
    fn from(formula: String) -> Self {
        Self::Formula(formula)
    }
}

impl Number {
    /// The number, which must be finite; `at` is where it stands, for messages.
    pub fn number<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>) -> Read<f64> {
        let at = at.into();
        match self {
            Self::Given(number) => finite(*number, entry, at, "every number must be finite"),
            Self::Formula(text) => {
                Ok(program(text, entry, at, &[], &mut Nothing)?.as_constant().expect("a formula without variables is a constant"))
            }
        }
    }

    /// A number above zero.
    pub fn positive<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>) -> Read<f64> {
        let at = at.into();
        let number = self.number(entry, at)?;
        if number > 0.0 {
            return Ok(number);
        }
        Err(entry.refuse(at, format!("`{}` is {number}, and must be above 0", at.key), "give a number above 0"))
    }

    /// A number of at least zero.
    pub fn not_negative<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>) -> Read<f64> {
        let at = at.into();
        let number = self.number(entry, at)?;
        if number >= 0.0 {
            return Ok(number);
        }
        Err(entry.refuse(at, format!("`{}` is negative: {number}", at.key), "it must be at least 0"))
    }

    /// A whole number of at least `least`.
    pub fn whole<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>, least: u32) -> Read<u32> {
        let at = at.into();
        let number = self.number(entry, at)?;
        if number.fract() == 0.0 && number >= f64::from(least) && number <= f64::from(u32::MAX) {
            return Ok(number as u32);
        }
        let (wanted, cure) = match number > f64::from(u32::MAX) {
            true => (format!("up to {}", u32::MAX), format!("write {} = {}, or less", at.key, u32::MAX)),
            false => (format!("of at least {least}"), format!("write {} = {}, or more", at.key, least.max(1))),
        };
        Err(entry.refuse(at, format!("`{}` wants a whole number {wanted}, and this is {number}", at.key), cure))
    }

    /// A formula of some variables.
    pub fn formula<'s>(&self, entry: &Entry<'_>, at: impl Into<Spot<'s>>, variables: &[&str]) -> Read<Program> {
        let at = at.into();
        let program = self.formula_reading(entry, at, variables, &mut Nothing)?;
        // A motion, as forces are formulas of more.
        if variables == ["t"] && !program.switches(0).is_empty() {
            entry.sink.motion(entry.path_of(at), &program);
        }
        if variables == ["t"] {
            entry.sink.moves(&program);
        }
        Ok(program)
    }

    /// The same of a formula that also reads what the mechanism does.
    pub(in crate::model) fn formula_reading<'s>(
        &self,
        entry: &Entry<'_>,
        at: impl Into<Spot<'s>>,
        variables: &[&str],
        names: &mut dyn Names,
    ) -> Read<Program> {
        let text = match self {
            Self::Given(_) => return self.number(entry, at).map(Program::constant),
            Self::Formula(text) => text,
        };
        let at = at.into();
        let program = program(text, entry, at, variables, names)?;
        if let Some(t) = variables.iter().position(|name| *name == "t") {
            entry.sink.switches.borrow_mut().extend(program.switches(t));
            entry.sink.over_time(entry.path_of(at), || program.parts_of_time(t).into_iter().map(Course::Formula).collect());
        }
        Ok(program)
    }
}

fn program(text: &str, entry: &Entry<'_>, at: Spot<'_>, variables: &[&str], names: &mut dyn Names) -> Read<Program> {
    let program = Program::parse_with(text, variables, names, &entry.scope).map_err(|mistake| entry.mistaken(at, mistake))?;
    if let Some(number) = program.as_constant() {
        finite(number, entry, at, "every number must be finite: look for a division by zero, or a function where it has no value")?;
    }
    Ok(program)
}

fn finite(number: f64, entry: &Entry<'_>, at: Spot<'_>, cure: &str) -> Read<f64> {
    if number.is_finite() {
        return Ok(number);
    }
    let message = if number.is_nan() { "this is not a number (NaN)" } else { "this number is infinite" };
    Err(entry.refuse(at, message, cure))
}
