use super::{Field, List, Number, Shape};
use crate::model::entry::{Entry, Spot};
use crate::model::fault::Read;
use crate::model::value::Value;

/// The name of a point, of a body or of a place of one, `"ground"`, or a fixed place.
#[derive(Clone, Debug, PartialEq)]
pub enum Place {
    /// By name, such as `P`, `door`, `door.handle` or `ground`.
    Named(String),
    /// Coordinates in the axes of the model, m.
    Fixed(List<Number>),
}

impl Field for Place {
    const SHAPE: Shape = Shape::End;
    const LIST: Shape = Shape::Ends(2, usize::MAX);

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::Text(name) => Ok(Self::Named(name.clone())),
            // What is wrong with the numbers is said where their count is known.
            Value::List(items) => {
                let numbers: Option<Vec<Number>> = items.iter().map(number).collect();
                numbers.map(|numbers| Self::Fixed(List(numbers))).ok_or_else(|| {
                    entry.refuse(spot, "a place is the numbers of its coordinates", "write a number, or a formula in quotes, for each axis")
                })
            }
            other => {
                let message = format!("a place is wanted here, and this is {}", other.type_name());
                Err(entry.refuse(spot, message, "write \"NAME\", \"ground\" or a list of coordinates"))
            }
        }
    }

    fn write(&self) -> Value {
        match self {
            Self::Named(name) => Value::text(name),
            Self::Fixed(place) => place.write(),
        }
    }
}

fn number(value: &Value) -> Option<Number> {
    match value {
        Value::Number(number) => Some(Number::Given(*number)),
        Value::Text(text) => Some(Number::Formula(text.clone())),
        _ => None,
    }
}

impl From<&str> for Place {
    fn from(name: &str) -> Self {
        Self::Named(name.into())
    }
}

impl From<String> for Place {
    fn from(name: String) -> Self {
        Self::Named(name)
    }
}

impl<T: Into<Number>, const N: usize> From<[T; N]> for Place {
    fn from(place: [T; N]) -> Self {
        Self::Fixed(place.into())
    }
}
