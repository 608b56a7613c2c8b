//! `[table.NAME]`: curves through given points, which formulas call as functions of one number.

use std::collections::HashMap;
use std::sync::Arc;

use super::drives::{Row, rows};
use super::entry::{Entry, Spot};
use super::expression::{self, Beyond, Program};
use super::fault::{Read, Sink, suggest};
use super::fields::{Keys, List};
use super::key::Shape;
use super::parameters::{require_no_function, require_own_name};

/// `[table.NAME]`
#[derive(Clone, Debug, Default, PartialEq, Keys)]
#[table("a table")]
pub struct Curve {
    /// rows of argument and value, with rising arguments
    #[key(default = "those of `file`")]
    pub points: Option<List<Row>>,
    /// a CSV file with a line of names, beside the model
    #[key(default = "none")]
    pub file: Option<String>,
    /// its column of arguments
    #[key(default = "the first")]
    pub x: Option<String>,
    /// its column of values
    #[key(default = "the second")]
    pub y: Option<String>,
    /// what lies between the points: straight lines, a spline with two derivatives, or cubics that never overshoot
    #[key(default = "\"linear\"", shape = Shape::Choice(INTERPOLATIONS))]
    pub interpolation: Option<String>,
    /// what lies beyond them: the last value, a straight line, nothing (a run that comes there stops), or the same again
    #[key(default = "\"hold\"", shape = Shape::Choice(BEYOND))]
    pub outside: Option<String>,
}

const INTERPOLATIONS: &[&str] = &["linear", "cubic", "monotone"];
const BEYOND: &[&str] = &["hold", "line", "refuse", "periodic"];

/// Share of the range of a periodic table's values by which its last may differ from its first, by rounding.
const ROUNDED: f64 = 1e-12;

impl Curve {
    /// What the keys come to.
    pub(super) fn curve(&self, entry: &Entry<'_>) -> Read<expression::Curve> {
        require_own_name(entry)?;
        require_no_function(entry)?;
        let interpolation =
            entry.optional("interpolation", &self.interpolation, |word, entry, key| entry.choice(key, word, INTERPOLATIONS));
        let outside = entry.optional("outside", &self.outside, |word, entry, key| entry.choice(key, word, BEYOND));
        let points = self.numbers(entry);
        let (interpolation, outside, (key, knots, mut values)) = (interpolation?, outside?, points?);
        let spot = |k| Spot { key, item: (key == "points").then_some(k) };
        if knots.len() < 2 {
            let message = format!("a table has at least two points, and this has {}", knots.len());
            return Err(entry.refuse(key, message, "add points with other arguments"));
        }
        if let Some(k) = (1..knots.len()).find(|&k| knots[k].is_nan() || knots[k] <= knots[k - 1]) {
            let message = format!("in row {} the argument {} comes after {}", k + 1, knots[k], knots[k - 1]);
            return Err(entry.refuse(spot(k), message, "let the arguments rise from row to row"));
        }
        let beyond = match outside {
            Some("line") => Beyond::Line,
            Some("refuse") => Beyond::Refuse,
            Some("periodic") => Beyond::Periodic,
            _ => Beyond::Hold,
        };
        let last = knots.len() - 1;
        let range = values.iter().fold(0.0, |range: f64, value| range.max((value - values[0]).abs()));
        if beyond == Beyond::Periodic && ((values[last] - values[0]).abs() > ROUNDED * range || last < 2) {
            let message = match last {
                1 => "a periodic table has at least three points, the last of them the first again".into(),
                _ => format!("a periodic table ends with the value it begins with, and this goes from {} to {}", values[0], values[last]),
            };
            return Err(entry.refuse("outside", message, "add the first value again, one period later"));
        }
        if beyond == Beyond::Periodic {
            values[last] = values[0];
        }
        let curve = match interpolation {
            Some("cubic") => expression::Curve::cubic(knots, values, beyond),
            Some("monotone") => expression::Curve::monotone(knots, values, beyond),
            _ => expression::Curve::linear(knots, values, beyond),
        };
        if let Some(words) = curve.swings() {
            entry.note(key, format!("{words} (interpolation = \"monotone\" does not)"));
        }
        Ok(curve)
    }

    /// Arguments and values, and the key that they come from.
    fn numbers(&self, entry: &Entry<'_>) -> Read<(&'static str, Vec<f64>, Vec<f64>)> {
        let columns = [("x", &self.x), ("y", &self.y)];
        match (&self.points, &self.file) {
            (Some(points), None) => {
                if let Some((key, _)) = columns.iter().find(|(_, name)| name.is_some()) {
                    return Err(entry.refuse(*key, format!("`{key}` is a column of a file, and this table has none"), "remove it"));
                }
                let (x, y) = rows(points, entry, "points")?;
                Ok(("points", x, y))
            }
            (None, Some(name)) => {
                let file = entry.files.numbers(name).map_err(|[message, cure]| entry.refuse("file", message, cure))?;
                let place = |(k, (key, name)): (usize, &(&'static str, &Option<String>))| -> Read<usize> {
                    Ok(match name {
                        Some(name) => file.names.iter().position(|known| known == name).ok_or_else(|| {
                            let cure = suggest(name, file.names.iter().map(String::as_str));
                            entry.refuse(*key, format!("the file has no column `{name}`"), cure)
                        })?,
                        None if k < file.columns.len() => k,
                        None => {
                            return Err(entry.refuse("file", format!("the file has only {k} column"), "a table has arguments and values"));
                        }
                    })
                };
                let column = |at: usize| -> Read<Vec<f64>> {
                    let column = &file.columns[at];
                    match column.iter().position(|value| !value.is_finite()) {
                        None => Ok(column.clone()),
                        Some(row) => {
                            let message = format!("row {} of column `{}` holds no finite number", row + 1, file.names[at]);
                            Err(entry.refuse("file", message, "every number must be finite"))
                        }
                    }
                };
                let [x, y] = [0, 1].map(|k| place((k, &columns[k])));
                let (x, y) = (x?, y?);
                if x == y {
                    let message = format!("arguments and values are both the column `{}`", file.names[x]);
                    let key = if self.y.is_some() { "y" } else { "x" };
                    return Err(entry.refuse(
                        key,
                        message,
                        "without `x` arguments are the first column, and without `y` values the second: name both",
                    ));
                }
                let [x, y] = [x, y].map(column);
                Ok(("file", x?, y?))
            }
            (Some(_), Some(_)) => Err(entry.refuse("file", "a table has `points` or a `file`, and this has both", "remove one of them")),
            (None, None) => {
                Err(entry.refuse_all(format!("the table `{}` has no points", entry.name), "add points = [[x, y], …], or a file"))
            }
        }
    }
}

/// Refuses a formula that has no value for these values of its variables, as it asks a table beyond its ends.
pub(super) fn require_inside<'s>(entry: &Entry<'_>, spot: impl Into<Spot<'s>>, formula: &Program, at: &[f64]) -> Read<()> {
    let refused = if formula.evaluate(at).is_finite() { None } else { formula.refused(at) };
    let Some((curve, argument)) = refused else { return Ok(()) };
    let is_it = |known: &Option<Arc<expression::Curve>>| known.as_deref().is_some_and(|known| std::ptr::eq(known, curve));
    let name = entry.scope.tables.into_iter().flatten().find_map(|(name, known)| is_it(known).then_some(name.as_str()));
    let [message, cure] = expression::refusal(name.unwrap_or_default(), curve, argument);
    Err(entry.refuse(spot, format!("where the run starts {message}"), cure))
}

/// Tables by name, `None` where one could not be read.
pub(super) type Tables = HashMap<String, Option<Arc<expression::Curve>>>;

/// Refuses the names of parameters for what formulas know by name.
pub(super) fn require_unlike_parameters<'n>(
    section: &str,
    names: impl Iterator<Item = &'n str>,
    parameters: &HashMap<String, expression::Value>,
    sink: &Sink,
) {
    for name in names.filter(|name| parameters.contains_key(*name)) {
        let message = format!("`{name}` is also a parameter");
        sink.report(|| super::Fault::new(super::key_path(section, name), name, message, "give one of them another name"));
    }
}
