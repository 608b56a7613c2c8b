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
    let above_names = labelled(&up, |_| ROOM_LEFT);
    let left = chart::LEFT.max(14.0 + longest(above_names.iter().map(|(_, name)| name)));
    let (rows, columns) = (places(&up), places(&right));
    let sound = report.runs.iter().zip(&column.values).filter(|(run, _)| run.has_completed()).filter_map(|(_, value)| *value);
    let (low, high) = sound.filter(|v| v.is_finite()).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    let shades = Shades { low, high };
    let names = names(&[shades.low, shades.middle(), shades.high]);
    let bar = (chart::RIGHT - BAR - longest(names.iter())).min(SCALE);
    chart::begin(&format!("{} over {} and {}", column.name, report.keys[beside].name, report.keys[above].name), out)?;
    // The scale of the colours takes the right edge.
    let (width, height) = ((bar - 14.0 - left) / right.len() as f64, (chart::BOTTOM - TOP) / up.len() as f64);
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
    for (k, name) in &above_names {
        chart::left_tick((left, corner(*k, 0).1 + 0.5 * height), name, out)?;
    }
    for (k, name) in labelled(&right, |count| axis::room(count + 1)) {
        chart::bottom_tick(corner(0, k).0 + 0.5 * width, &name, out)?;
    }
    writeln!(out, r#"<text class="name" x="4" y="{:.1}">{} ↑</text>"#, TOP - 9.0, html(report.keys[above].name))?;
    chart::name_below(report.keys[beside].name, out)?;
    scale(bar, &names, out)?;
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

/// Left edge of the scale of the colours, if its labels are no longer than usual, and its width with the gap to these.
const SCALE: f64 = chart::RIGHT - 76.0;
const BAR: f64 = 14.0;

/// The scale of the colours, from `x` on, with the least value, that in the middle and the largest.
fn scale(x: f64, names: &[String], out: &mut dyn io::Write) -> io::Result<()> {
    const STEPS: usize = 32;
    let height = (chart::BOTTOM - TOP) / STEPS as f64;
    for k in 0..STEPS {
        let (y, fill) = (chart::BOTTOM - (k + 1) as f64 * height, colour((k as f64 + 0.5) / STEPS as f64));
        writeln!(out, r#"<rect x="{x:.1}" y="{y:.2}" width="10" height="{:.2}" fill="{fill}"/>"#, height + 0.3)?;
    }
    for (y, name) in [chart::BOTTOM, 0.5 * (chart::BOTTOM + TOP) + 4.0, TOP + 8.0].into_iter().zip(names) {
        writeln!(out, r#"<text x="{:.1}" y="{y:.1}">{name}</text>"#, x + BAR)?;
    }
    Ok(())
}

/// Figures of a label, and most of them.
const FIGURES: usize = 3;
const MOST_FIGURES: usize = 12;

/// Labels of numbers in their order, with as many figures as tell them apart.
fn names(values: &[f64]) -> Vec<String> {
    let with = |figures: usize| values.iter().map(|value| axis::figures(*value, figures)).collect::<Vec<_>>();
    let are_told_apart = |names: &Vec<String>| {
        let pairs = values.windows(2).zip(names.windows(2));
        pairs.into_iter().all(|(values, names)| names[0] != names[1] || !axis::are_different(values[0], values[1]))
    };
    (FIGURES..=MOST_FIGURES).map(with).find(are_told_apart).unwrap_or_else(|| with(FIGURES))
}

/// Room that the longest of some labels takes.
fn longest<'a>(names: impl Iterator<Item = &'a String>) -> f64 {
    LETTER * names.map(|name| name.chars().count()).max().unwrap_or(0) as f64
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

/// Labels, all of a few, evenly many of others, and which of the values have them; words have so much `room` where there are so many.
fn labelled(values: &[&str], room: impl Fn(usize) -> usize) -> Vec<(usize, String)> {
    let last = values.len().saturating_sub(1);
    let places: Vec<usize> = match values.len() {
        count if count <= LABELS => (0..count).collect(),
        _ => (0..LABELS).map(|k| (k * last + (LABELS - 1) / 2) / (LABELS - 1)).collect(),
    };
    let numbers: Vec<f64> = places.iter().map(|&k| number(values[k])).collect();
    let room = room(places.len());
    let word = |(k, name): (usize, String)| (k, if number(values[k]).is_nan() { axis::shortened(values[k], room) } else { name });
    places.into_iter().zip(names(&numbers)).map(word).collect()
}

/// Characters that a label to the left of a map has room for.
const ROOM_LEFT: usize = 16;

/// Width of a letter, about.
const LETTER: f64 = 7.5;
