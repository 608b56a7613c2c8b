use std::ops::Deref;

use super::{Field, Number, Shape};
use crate::model::entry::{Entry, Spot, all};
use crate::model::expression::{Names, Nothing, Program};
use crate::model::fault::Read;
use crate::model::value::Value;

/// A list of values.
#[derive(Clone, Debug, PartialEq)]
pub struct List<T>(pub Vec<T>);

impl<T: Field> Field for List<T> {
    const SHAPE: Shape = T::LIST;
    const LIST: Shape = Shape::Curve;
    const MAP: Shape = Shape::Places;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        let Value::List(items) = value else { return Err(entry.wanted(spot, "a list", value)) };
        all(items.iter().enumerate().map(|(k, item)| T::read(entry, Spot { item: Some(k), ..spot }, item))).map(Self)
    }

    fn write(&self) -> Value {
        Value::List(self.0.iter().map(Field::write).collect())
    }
}

impl<T> Deref for List<T> {
    type Target = [T];

    fn deref(&self) -> &[T] {
        &self.0
    }
}

impl<T, U: Into<T>, const N: usize> From<[U; N]> for List<T> {
    fn from(items: [U; N]) -> Self {
        Self(items.into_iter().map(Into::into).collect())
    }
}

impl<T, U: Into<T>> From<Vec<U>> for List<T> {
    fn from(items: Vec<U>) -> Self {
        Self(items.into_iter().map(Into::into).collect())
    }
}

impl List<Number> {
    /// All numbers, which must be finite.
    pub fn numbers(&self, entry: &Entry<'_>, key: &str) -> Read<Vec<f64>> {
        all(self.iter().enumerate().map(|(k, item)| item.number(entry, Spot { key, item: Some(k) })))
    }

    /// As many numbers as the model has axes, zeros behind them.
    pub fn vector(&self, entry: &Entry<'_>, key: &str, dim: usize) -> Read<[f64; 3]> {
        self.check_axes(entry, key, dim, "numbers")?;
        let numbers = self.numbers(entry, key)?;
        Ok(std::array::from_fn(|k| numbers.get(k).copied().unwrap_or(0.0)))
    }

    /// As many formulas of the time as the model has axes, of a motion.
    pub fn motions(&self, entry: &Entry<'_>, key: &str, dim: usize) -> Read<Vec<Program>> {
        let programs = self.formulas_reading(entry, key, dim, &["t"], &mut Nothing)?;
        programs.iter().for_each(|program| entry.sink.moves(program));
        Ok(programs)
    }

    /// The same of formulas that also read what the mechanism does.
    pub(in crate::model) fn formulas_reading(
        &self,
        entry: &Entry<'_>,
        key: &str,
        dim: usize,
        variables: &[&str],
        names: &mut dyn Names,
    ) -> Read<Vec<Program>> {
        self.check_axes(entry, key, dim, "numbers or formulas")?;
        all(self.iter().enumerate().map(|(k, item)| item.formula_reading(entry, Spot { key, item: Some(k) }, variables, names)))
    }

    /// `N` numbers above zero.
    pub fn sizes<const N: usize>(&self, entry: &Entry<'_>, key: &str) -> Read<[f64; N]> {
        if self.len() != N {
            return Err(entry.refuse(key, format!("`{key}` wants {N} numbers, and this has {}", self.len()), format!("give {N} numbers")));
        }
        let size = |(k, item): (usize, &Number)| {
            let spot = Spot { key, item: Some(k) };
            let size = item.number(entry, spot)?;
            if size > 0.0 { Ok(size) } else { Err(entry.refuse(spot, format!("`{key}` has a size of {size}"), "give sizes above 0")) }
        };
        let sizes = all(self.iter().enumerate().map(size))?;
        Ok(std::array::from_fn(|k| sizes[k]))
    }

    fn check_axes(&self, entry: &Entry<'_>, key: &str, dim: usize, what: &str) -> Read<()> {
        if self.len() == dim {
            return Ok(());
        }
        let model = if dim == 2 { "a planar model" } else { "a model in space" };
        let message = format!("`{key}` wants {dim} {what} in {model}, and this has {}", self.len());
        Err(entry.refuse(key, message, "give one for each axis of the model"))
    }
}
