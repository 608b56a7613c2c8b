//! A map of a column over two keys: a coloured cell for each run.

use std::collections::HashMap;
use std::io;

use super::colour::colour;
use super::{SweepColumn, SweepReport, axis, chart, plot};
use crate::escape::html;

/// Values of a key that a map shows.
pub const MOST_CELLS: usize = 64;

/// Labels along a side.
const LABELS: usize = 6;

/// Whether a map leaves out values of a key.
pub fn is_thinned(report: &SweepReport, key: usize) -> bool {
    values(report, key).len() > MOST_CELLS
}

/// Draws a column over both keys: the first goes upwards and the second to the right, but words go upwards, where they have room.
pub fn write(report: &SweepReport, column: &SweepColumn, out: &mut dyn io::Write) -> io::Result<()> {
    let has_words = |key: usize| values(report, key).iter().any(|value| value.parse::<f64>().is_err());
    let [above, beside] = if has_words(1) && !has_words(0) { [1, 0] } else { [0, 1] };
    let (up, right) = (thinned(values(report, above)), thinned(values(report, beside)));
    let longest = labelled(&up).iter().map(|(_, value)| label(value, ROOM_LEFT).chars().count()).max().unwrap_or(0);
    let left = chart::LEFT.max(14.0 + LETTER * longest as f64);
    let (rows, columns) = (places(&up), places(&right));
    let sound = report.runs.iter().zip(&column.values).filter(|(run, _)| run.has_completed()).filter_map(|(_, value)| *value);
    let (low, high) = sound.filter(|v| v.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let shades = Shades { low, high };
    chart::begin(&format!("{} over {} and {}", column.name, report.keys[beside].name, report.keys[above].name), out)?;
    // The scale of the colours takes the right edge.
    let (width, height) = ((SCALE - 14.0 - left) / right.len() as f64, (chart::BOTTOM - TOP) / up.len() as f64);
    let corner = |row: usize, column: usize| (left + column as f64 * width, chart::BOTTOM - (row + 1) as f64 * height);
    for (run, value) in report.runs.iter().zip(&column.values) {
        let (Some(&row), Some(&column)) = (rows.get(run.settings[above].as_str()), columns.get(run.settings[beside].as_str())) else {
            continue;
        };
        let (x, y) = corner(row, column);
        match value.filter(|value| run.has_completed() && value.is_finite()) {
            Some(value) => {
                let (fill, told) = (colour(shades.share(value)), html(&plot::told(report, run, value)));
                let (w, h) = (width + 0.3, height + 0.3);
                writeln!(out, r#"<rect x="{x:.2}" y="{y:.2}" width="{w:.2}" height="{h:.2}" fill="{fill}"><title>{told}</title></rect>"#)?;
            }
            None if run.has_completed() => (),
            None => chart::cross((x + 0.5 * width, y + 0.5 * height), &plot::failure(report, run), out)?,
        }
    }
    for (k, value) in labelled(&up) {
        chart::left_tick((left, corner(k, 0).1 + 0.5 * height), &label(value, ROOM_LEFT), out)?;
    }
    let below = labelled(&right);
    for (k, value) in &below {
        chart::bottom_tick(corner(0, *k).0 + 0.5 * width, &label(value, axis::room(below.len() + 1)), out)?;
    }
    writeln!(out, r#"<text class="name" x="4" y="{:.1}">{} ↑</text>"#, TOP - 9.0, html(report.keys[above].name))?;
    chart::name_below(report.keys[beside].name, out)?;
    scale(&shades, out)?;
    chart::end(out)
}

/// What the colours stand for.
struct Shades {
    low: f64,
    high: f64,
}

/// Ratio of the largest to the least value beyond which colours have equal ratios: else all but a few cells would have one colour.
const MANY_TIMES: f64 = 100.0;

impl Shades {
    fn is_logarithmic(&self) -> bool {
        self.low > 0.0 && self.high > MANY_TIMES * self.low
    }

    /// Where a value lies between the least and the largest.
    fn share(&self, value: f64) -> f64 {
        match (axis::are_different(self.low, self.high), self.is_logarithmic()) {
            (false, _) => 0.5,
            (true, true) => (value / self.low).ln() / (self.high / self.low).ln(),
            (true, false) => (value - self.low) / (self.high - self.low),
        }
    }

    /// The value of the colour in the middle.
    fn middle(&self) -> f64 {
        if self.is_logarithmic() { (self.low * self.high).sqrt() } else { 0.5 * (self.low + self.high) }
    }
}

/// Upper edge of the cells, which leaves room for the name of the key.
const TOP: f64 = chart::TOP + 14.0;

/// Left edge of the scale of the colours.
const SCALE: f64 = chart::RIGHT - 76.0;

/// The scale of the colours with the least and the largest value.
fn scale(shades: &Shades, out: &mut dyn io::Write) -> io::Result<()> {
    const STEPS: usize = 32;
    let (x, height) = (SCALE, (chart::BOTTOM - TOP) / STEPS as f64);
    for k in 0..STEPS {
        let (y, fill) = (chart::BOTTOM - (k + 1) as f64 * height, colour((k as f64 + 0.5) / STEPS as f64));
        writeln!(out, r#"<rect x="{x:.1}" y="{y:.2}" width="10" height="{:.2}" fill="{fill}"/>"#, height + 0.3)?;
    }
    for (y, value) in [(chart::BOTTOM, shades.low), (0.5 * (chart::BOTTOM + TOP) + 4.0, shades.middle()), (TOP + 8.0, shades.high)] {
        writeln!(out, r#"<text x="{:.1}" y="{y:.1}">{}</text>"#, x + 14.0, axis::label(rounded(value)))?;
    }
    Ok(())
}

/// Three figures, as many as there is room for.
fn rounded(value: f64) -> f64 {
    format!("{value:.2e}").parse().unwrap_or(value)
}

/// The values of a key, numbers by size and words as they come.
fn values<'a>(report: &'a SweepReport, key: usize) -> Vec<&'a str> {
    let mut values: Vec<&'a str> = Vec::new();
    let mut seen = HashMap::new();
    for run in report.runs {
        let text = run.settings[key].as_str();
        if seen.insert(text, ()).is_none() {
            values.push(text);
        }
    }
    if values.iter().all(|text| text.parse::<f64>().is_ok()) {
        values.sort_by(|a, b| number(a).total_cmp(&number(b)));
    }
    values
}

fn number(text: &str) -> f64 {
    text.parse().unwrap_or(f64::NAN)
}

/// At most [`MOST_CELLS`] of them, the ends among these.
fn thinned(values: Vec<&str>) -> Vec<&str> {
    match values.len() {
        count if count <= MOST_CELLS => values,
        count => (0..MOST_CELLS).map(|k| values[k * (count - 1) / (MOST_CELLS - 1)]).collect(),
    }
}

fn places<'a>(values: &[&'a str]) -> HashMap<&'a str, usize> {
    values.iter().enumerate().map(|(k, value)| (*value, k)).collect()
}

/// Values that have a label: all of a few, evenly many of others.
fn labelled<'a>(values: &[&'a str]) -> Vec<(usize, &'a str)> {
    let last = values.len().saturating_sub(1);
    let places: Vec<usize> = match values.len() {
        count if count <= LABELS => (0..count).collect(),
        _ => (0..LABELS).map(|k| (k * last + (LABELS - 1) / 2) / (LABELS - 1)).collect(),
    };
    places.into_iter().map(|k| (k, values[k])).collect()
}

/// Characters that a label to the left of a map has room for.
const ROOM_LEFT: usize = 16;

/// Width of a letter, about.
const LETTER: f64 = 7.5;

fn label(value: &str, room: usize) -> String {
    value.parse().map_or_else(|_| axis::shortened(value, room), |number| axis::label(rounded(number)))
}
