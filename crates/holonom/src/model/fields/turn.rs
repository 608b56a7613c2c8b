use super::{Field, List, Number, Shape};
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::value::Value;

/// A vector of rotation: three numbers or formulas in space, in a planar model one about the normal.
#[derive(Clone, Debug, PartialEq)]
pub enum Turn {
    /// One component for each of the three axes.
    InSpace(List<Number>),
    /// About the normal, from the first axis of the plane towards the second.
    InPlane(Number),
}

impl Field for Turn {
    const SHAPE: Shape = Shape::Spin;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::List(_) => List::read(entry, spot, value).map(Self::InSpace),
            Value::Number(_) | Value::Text(_) => Number::read(entry, spot, value).map(Self::InPlane),
            other => Err(entry.wanted(spot, "a list of three numbers, or in a planar model one number", other)),
        }
    }

    fn write(&self) -> Value {
        match self {
            Self::InSpace(numbers) => numbers.write(),
            Self::InPlane(number) => number.write(),
        }
    }
}

impl<T: Into<Number>> From<[T; 3]> for Turn {
    fn from(numbers: [T; 3]) -> Self {
        Self::InSpace(numbers.into())
    }
}

impl From<f64> for Turn {
    fn from(number: f64) -> Self {
        Self::InPlane(number.into())
    }
}

impl From<&str> for Turn {
    fn from(formula: &str) -> Self {
        Self::InPlane(formula.into())
    }
}

impl Turn {
    /// The vector; in a planar model its one number is the last, about the normal.
    pub fn vector(&self, entry: &Entry<'_>, key: &str, dim: usize) -> Read<[f64; 3]> {
        match (self, dim) {
            (Self::InPlane(number), 2) => number.number(entry, key).map(|number| [0.0, 0.0, number]),
            (Self::InPlane(_), _) => Err(entry.wanted(key.into(), "a list", &self.write())),
            (Self::InSpace(_), 2) => Err(entry.wanted(key.into(), "a number", &self.write())),
            (Self::InSpace(numbers), _) => numbers.vector(entry, key, dim),
        }
    }
}
