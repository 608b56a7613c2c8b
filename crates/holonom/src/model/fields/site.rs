use super::{Field, Number, Place, Shape};
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::value::Value;

/// Where a joint is, or how it is directed: a place or direction, its name (`"BODY.POINT"`, `"BODY.AXIS"`), or one for each body.
///
/// Whether two texts are names or the formulas of two numbers is known only when the bodies are, so that the value stays as written.
#[derive(Clone, Debug, PartialEq)]
pub struct Site(pub(in crate::model) Value);

impl Field for Site {
    const SHAPE: Shape = Shape::Site;

    fn read(_entry: &Entry<'_>, _spot: Spot<'_>, value: &Value) -> Read<Self> {
        Ok(Self(value.clone()))
    }

    fn write(&self) -> Value {
        self.0.clone()
    }
}

impl From<&str> for Site {
    fn from(name: &str) -> Self {
        Self(Value::text(name))
    }
}

impl<const N: usize> From<[f64; N]> for Site {
    fn from(numbers: [f64; N]) -> Self {
        Self(Place::from(numbers).write())
    }
}

impl<const N: usize> From<[Number; N]> for Site {
    fn from(numbers: [Number; N]) -> Self {
        Self(Place::from(numbers).write())
    }
}

impl<const N: usize> From<[[f64; N]; 2]> for Site {
    fn from(both: [[f64; N]; 2]) -> Self {
        both.map(Place::from).into()
    }
}

impl From<[&str; 2]> for Site {
    fn from(both: [&str; 2]) -> Self {
        both.map(Place::from).into()
    }
}

impl From<[Place; 2]> for Site {
    fn from(both: [Place; 2]) -> Self {
        Self(Value::List(both.iter().map(Field::write).collect()))
    }
}
