//! A number over time: a formula of t, or a spline through a table.

use std::sync::Arc;

use crate::model::entry::{Entry, Spot, all};
use crate::model::expression::{Program, TimeProgram};
use crate::model::fault::Read;
use crate::model::key::{Key, Shape};
use crate::model::spline::Spline;
use crate::model::value::Value;
use crate::system::Signal;

/// The key of the profile of a drive, in a unit.
pub(super) const fn key(unit: &'static str, doc: &'static str) -> Key {
    Key::required("profile", Shape::Profile(&TABLE), unit, doc)
}

/// Keys of a profile that is a table.
static TABLE: [Key; 2] = [
    Key::required("table", Shape::Pairs, "s", "times and values"),
    Key::optional("ends", Shape::Choice(ENDS), "\"natural\"", "", "\"rest\" has it start and end at rest; natural ends go on straight"),
];

const ENDS: &[&str] = &["natural", "rest"];

/// The signal at `profile`.
pub(super) fn read(entry: &Entry<'_>) -> Read<Arc<dyn Signal>> {
    let signal: Arc<dyn Signal> = match entry.value("profile")? {
        Value::Table(_) => Arc::new(table(entry)?),
        Value::List(_) => {
            let message = "a profile is a formula of t or a table, and this is a list";
            return Err(entry.refuse("profile", message, "write profile = { table = [[t, value], …] }, or a formula in quotes"));
        }
        _ => Arc::new(TimeProgram(entry.formula("profile", &["t"])?)),
    };
    let start = signal.at(0.0);
    if start.iter().any(|value| !value.is_finite()) {
        let [value, rate, second] = start;
        let message = format!("at t = 0 this profile is {value}, its rate {rate} and its second derivative {second}");
        return Err(entry.refuse("profile", message, "all three must be finite: let it begin smoothly"));
    }
    Ok(signal)
}

fn table(entry: &Entry<'_>) -> Read<Spline> {
    let table = entry.table("profile")?;
    entry.inside("profile", table, |inner| {
        inner.refuse_unknown_keys("a profile", &TABLE.iter().collect::<Vec<_>>());
        let ends = inner.optional("ends", |inner, key| inner.choice(key, ENDS));
        let rows = inner.list("table")?;
        let row = |(k, row): (usize, &Value)| match row {
            Value::List(items) if items.len() == 2 => {
                all(items.iter().map(|item| inner.number_in(Spot { key: "table", item: Some(k) }, item)))
            }
            _ => {
                Err(inner.refuse(Spot { key: "table", item: Some(k) }, "a row has a time and a value", "write [[t, value], [t, value], …]"))
            }
        };
        if rows.len() < 2 {
            return Err(inner.refuse("table", format!("a table has at least two rows, and this has {}", rows.len()), "add [t, value]"));
        }
        let rows = all(rows.iter().enumerate().map(row))?;
        if let Some(k) = (1..rows.len()).find(|&k| rows[k][0] <= rows[k - 1][0]) {
            let message = format!("the time {} comes after {}", rows[k][0], rows[k - 1][0]);
            return Err(inner.refuse(Spot { key: "table", item: Some(k) }, message, "let the times rise from row to row"));
        }
        inner.sink.switches.borrow_mut().extend(rows.iter().map(|row| Program::since(row[0])));
        let (knots, values) = (rows.iter().map(|row| row[0]).collect(), rows.iter().map(|row| row[1]).collect());
        Ok(if ends? == Some("rest") { Spline::resting(knots, values) } else { Spline::natural(knots, values) })
    })
}
