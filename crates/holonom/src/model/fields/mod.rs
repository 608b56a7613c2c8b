//! What the values of keys may be: the types of the fields of every kind.
//!
//! A type here reads a value of a file and writes it again. Numbers stay what was written, numbers or formulas over parameters, until
//! the description is compiled.

mod list;
mod map;
mod number;
mod place;
mod rows;
mod site;
mod turn;

pub use holonom_derive::Keys;
pub use list::List;
pub use map::Map;
pub use number::Number;
pub use place::Place;
pub use rows::Rows;
pub use site::Site;
pub use turn::Turn;

use super::entry::{Entry, Spot, Written};
use super::fault::Read;
use super::key::{Key, Shape};
use super::reader::Reader;
use super::value::{Table, Value};

/// A type that the value of a key may have.
pub trait Field: Sized {
    /// What such a value looks like.
    const SHAPE: Shape;
    /// What a list of them looks like.
    const LIST: Shape = Shape::Points;
    /// What a table of them looks like.
    const MAP: Shape = Shape::Named;

    /// Reads a value.
    ///
    /// # Errors
    /// A value of another shape; the fault is recorded.
    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self>;

    /// The value as it would be written.
    fn write(&self) -> Value;
}

/// A struct whose fields are the keys of a table; `#[derive(Keys)]` implements it.
pub trait Keys: Written + Sized {
    /// The keys in order.
    const KEYS: &'static [Key];

    /// Reads all keys of a table. Keys that are not known are not looked at.
    ///
    /// # Errors
    /// What is missing or of another shape; the faults are recorded.
    fn read(reader: &Reader<'_>) -> Read<Self>;

    /// The table as it would be written.
    fn write(&self) -> Table {
        Self::KEYS.iter().filter_map(|key| Some((key.name, self.value(key.name)?))).collect()
    }
}

/// What is known of a kind beside its keys; `#[derive(Keys)]` implements it where `#[kind(…)]` is given.
pub trait Described: Keys {
    /// What `type` says.
    const NAME: &'static str;
    /// One line.
    const DOC: &'static str;
    /// What it puts on the coordinates, as formulas.
    const EQUATIONS: &'static str;
    /// A small model that uses it.
    const EXAMPLE: &'static str;
}

impl Field for String {
    const SHAPE: Shape = Shape::Text;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::Text(text) => Ok(text.clone()),
            other => Err(entry.wanted(spot, if spot.item.is_some() { "texts" } else { "a text" }, other)),
        }
    }

    fn write(&self) -> Value {
        Value::text(self)
    }
}

impl Field for bool {
    const SHAPE: Shape = Shape::Flag;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::Bool(flag) => Ok(*flag),
            other => Err(entry.wanted(spot, "true or false", other)),
        }
    }

    fn write(&self) -> Value {
        Value::Bool(*self)
    }
}
