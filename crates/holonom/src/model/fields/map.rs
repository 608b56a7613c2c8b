use std::ops::Deref;

use super::{Field, Shape};
use crate::model::entry::{Entry, Spot, Written, all};
use crate::model::fault::Read;
use crate::model::value::Value;

/// A table with a value for each of some names, in order.
#[derive(Clone, Debug, PartialEq)]
pub struct Map<T>(pub Vec<(String, T)>);

impl<T: Field> Field for Map<T> {
    const SHAPE: Shape = T::MAP;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        let Value::Table(table) = value else { return Err(entry.wanted(spot, "a table", value)) };
        entry.within(spot, table, |inner| {
            all(table.iter().map(|(name, value)| Ok((name.to_string(), T::read(inner, name.into(), value)?)))).map(Self)
        })
    }

    fn write(&self) -> Value {
        Value::Table(self.iter().map(|(name, value)| (name.as_str(), value.write())).collect())
    }
}

impl<T: Field> Written for Map<T> {
    fn value(&self, key: &str) -> Option<Value> {
        self.iter().find(|(name, _)| name == key).map(|(_, value)| value.write())
    }
}

impl<T> Deref for Map<T> {
    type Target = [(String, T)];

    fn deref(&self) -> &Self::Target {
        &self.0
    }
}

impl<K: Into<String>, T, U: Into<T>, const N: usize> From<[(K, U); N]> for Map<T> {
    fn from(entries: [(K, U); N]) -> Self {
        Self(entries.into_iter().map(|(name, value)| (name.into(), value.into())).collect())
    }
}
