//! A number over time: a formula of t, or a spline through a table.

use std::sync::Arc;

use crate::model::entry::{Entry, Spot, all};
use crate::model::expression::{Program, TimeProgram};
use crate::model::fault::Read;
use crate::model::fields::{Field, Keys, List, Number};
use crate::model::key::Shape;
use crate::model::spline::Spline;
use crate::model::tables::require_inside;
use crate::model::unseen::Course;
use crate::model::value::Value;
use crate::system::Signal;

/// A number over time, as it is written.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// A formula of t, or a number that stays.
    Formula(Number),
    /// A spline through a table.
    Table(ProfileTable),
}

/// Times and values that a spline goes through.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a profile")]
pub struct ProfileTable {
    /// times and values
    #[key(unit = "s")]
    pub table: List<Row>,
    /// "rest" has it start and end at rest; natural ends go on straight
    #[key(default = "\"natural\"", shape = Shape::Choice(ENDS))]
    pub ends: Option<String>,
}

/// A row of a table: `[time, value]`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// s
    pub time: Number,
    /// In the unit of what is driven.
    pub value: Number,
}

const ENDS: &[&str] = &["natural", "rest"];

impl Field for Profile {
    const SHAPE: Shape = Shape::Profile(ProfileTable::KEYS);

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::Table(_) => <ProfileTable as Field>::read(entry, spot, value).map(Self::Table),
            Value::List(_) => {
                let message = "a profile is a formula of t or a table, and this is a list";
                let cure = format!("write {} = {{ table = [[t, value], …] }}, or a formula in quotes", spot.key);
                Err(entry.refuse(spot, message, cure))
            }
            _ => Number::read(entry, spot, value).map(Self::Formula),
        }
    }

    fn write(&self) -> Value {
        match self {
            Self::Formula(formula) => formula.write(),
            Self::Table(table) => Field::write(table),
        }
    }
}

impl Field for Row {
    const SHAPE: Shape = Shape::Numbers(2, 2);
    const LIST: Shape = Shape::Pairs;

    fn read(entry: &Entry<'_>, spot: Spot<'_>, value: &Value) -> Read<Self> {
        match value {
            Value::List(items) if items.len() == 2 => {
                let [time, value] = [0, 1].map(|k| Number::read(entry, spot, &items[k]));
                Ok(Self { time: time?, value: value? })
            }
            _ => Err(entry.refuse(spot, "a row has two numbers, such as a time and a value", "write [[t, value], [t, value], …]")),
        }
    }

    fn write(&self) -> Value {
        Value::List(vec![self.time.write(), self.value.write()])
    }
}

impl<T: Into<Number>> From<T> for Profile {
    fn from(formula: T) -> Self {
        Self::Formula(formula.into())
    }
}

impl From<ProfileTable> for Profile {
    fn from(table: ProfileTable) -> Self {
        Self::Table(table)
    }
}

impl<T: Into<Number>> From<[T; 2]> for Row {
    fn from([time, value]: [T; 2]) -> Self {
        Self { time: time.into(), value: value.into() }
    }
}

impl Profile {
    /// The number over time, which must begin smoothly; `key` is where the profile stands.
    pub(super) fn signal(&self, entry: &Entry<'_>, key: &str) -> Read<Arc<dyn Signal>> {
        let signal: Arc<dyn Signal> = match self {
            Self::Formula(formula) => {
                let formula = formula.formula(entry, key, &["t"])?;
                require_inside(entry, key, &formula, &[0.0])?;
                Arc::new(TimeProgram(formula))
            }
            Self::Table(table) => {
                let spline = entry.within(key, table, |inner| table.spline(inner))?;
                entry.sink.over_time(entry.path_of(key.into()), || vec![Course::Table(spline.clone())]);
                Arc::new(spline)
            }
        };
        let start = signal.at(0.0);
        if start.iter().any(|value| !value.is_finite()) {
            let [value, rate, second] = start;
            let message = format!("at t = 0 this profile is {value}, its rate {rate} and its second derivative {second}");
            return Err(entry.refuse(key, message, "all three must be finite: let it begin smoothly"));
        }
        Ok(signal)
    }
}

/// Arguments and values of the rows that stand at `key`.
pub(in crate::model) fn rows(rows: &[Row], entry: &Entry<'_>, key: &str) -> Read<(Vec<f64>, Vec<f64>)> {
    let row = |(k, row): (usize, &Row)| {
        let spot = Spot { key, item: Some(k) };
        let (time, value) = (row.time.number(entry, spot), row.value.number(entry, spot));
        Ok((time?, value?))
    };
    Ok(all(rows.iter().enumerate().map(row))?.into_iter().unzip())
}

impl ProfileTable {
    fn spline(&self, entry: &Entry<'_>) -> Read<Spline> {
        let ends = entry.optional("ends", &self.ends, |ends, entry, key| entry.choice(key, ends, ENDS));
        if self.table.len() < 2 {
            return Err(entry.refuse(
                "table",
                format!("a table has at least two rows, and this has {}", self.table.len()),
                "add [t, value]",
            ));
        }
        let (knots, values) = rows(&self.table, entry, "table")?;
        if let Some(k) = (1..knots.len()).find(|&k| knots[k] <= knots[k - 1]) {
            let message = format!("the time {} comes after {}", knots[k], knots[k - 1]);
            return Err(entry.refuse(Spot { key: "table", item: Some(k) }, message, "let the times rise from row to row"));
        }
        entry.sink.switches.borrow_mut().extend(knots.iter().map(|&knot| Program::since(knot)));
        let make = if ends? == Some("rest") { Spline::resting } else { Spline::natural };
        let spline = make(knots, values);
        if let Some(words) = spline.swings() {
            entry.note("table", format!("{words} (a [table.NAME] with interpolation = \"monotone\" does not: profile = \"NAME(t)\")"));
        }
        Ok(spline)
    }
}
