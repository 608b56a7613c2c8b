use super::{Field, List, Number, Shape};
use crate::model::entry::{Entry, Spot, all};
use crate::model::fault::Read;
use crate::model::value::Value;

/// A matrix of three rows of three numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows(pub Vec<List<Number>>);

impl Field for Rows {
    const SHAPE: Shape = Shape::Rows;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        let Value::List(items) = value else { return Err(entry.wanted(spot, "a list", value)) };
        let row = |(k, item): (usize, &Value)| {
            let spot = Spot { item: Some(k), ..spot };
            let Value::List(numbers) = item else {
                return Err(entry.refuse(spot, "a row of a matrix is a list of three numbers", "write three rows of three numbers"));
            };
            // The place of a number in its row is not told, so that what is wrong is always the row.
            all(numbers.iter().map(|number| Number::read(entry, spot, number))).map(List)
        };
        all(items.iter().enumerate().map(row)).map(Self)
    }

    fn write(&self) -> Value {
        Value::List(self.0.iter().map(Field::write).collect())
    }
}

impl<T: Into<Number>> From<[[T; 3]; 3]> for Rows {
    fn from(rows: [[T; 3]; 3]) -> Self {
        Self(rows.into_iter().map(Into::into).collect())
    }
}

impl Rows {
    /// The numbers, which must be finite; `what` is what messages call the matrix, `cure` says how it is written.
    pub fn numbers(&self, entry: &Entry<'_>, key: &str, what: &str, cure: &str) -> Read<[[f64; 3]; 3]> {
        if self.0.len() != 3 {
            return Err(entry.refuse(key, format!("{what} has three rows, and this has {}", self.0.len()), cure));
        }
        let row = |(k, row): (usize, &List<Number>)| {
            let spot = Spot { key, item: Some(k) };
            if row.len() != 3 {
                return Err(entry.refuse(spot, format!("a row of {what} has three numbers"), cure));
            }
            all(row.iter().map(|number| number.number(entry, spot)))
        };
        let rows = all(self.0.iter().enumerate().map(row))?;
        Ok([0, 1, 2].map(|i| [0, 1, 2].map(|j| rows[i][j])))
    }
}
