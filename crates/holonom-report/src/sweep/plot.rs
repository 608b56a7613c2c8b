//! Values of a column over one key: a curve through a grid, points of samples.

use std::io;

use super::axis::Axis;
use super::{SweepColumn, SweepReport, SweepRun, chart};
use crate::escape::html;
use crate::format;

/// Runs that a plot shows.
pub const MOST_POINTS: usize = 2000;

/// Up to so many runs the points of a curve are drawn, and each says what it is.
const MOST_TOLD: usize = 500;

/// Draws a column over the key `key`.
pub fn write(report: &SweepReport, column: &SweepColumn, key: usize, out: &mut dyn io::Write) -> io::Result<()> {
    let name = report.keys[key].name;
    let runs = || shown(report).map(|k| (&report.runs[k], column.values[k]));
    let settings = runs().map(|(run, _)| run.settings[key].as_str());
    let x = Axis::of_key(settings.collect::<Vec<_>>().into_iter(), report.keys[key].is_logarithmic);
    let sound: Vec<f64> = runs().filter(|(run, _)| run.has_completed()).filter_map(|(_, value)| value).collect();
    // Without any run that completed, the others are better than nothing.
    let values = if sound.is_empty() { runs().filter_map(|(_, value)| value).collect() } else { sound };
    let y = Axis::of_values(&values).rounded();
    chart::begin(&format!("{} over {name}", column.name), out)?;
    chart::axes(&x, name, &y, out)?;
    let place = |run: &SweepRun, value: f64| Some(chart::place(x.place(&run.settings[key])?, y.at(value)?));
    if report.is_grid && report.keys.len() == 1 && matches!(x, Axis::Numbers { .. }) {
        let mut points: Vec<(f64, Option<(f64, f64)>)> = Vec::new();
        for (run, value) in runs() {
            let point = value.filter(|_| run.has_completed()).and_then(|value| place(run, value));
            points.push((x.place(&run.settings[key]).unwrap_or(f64::NAN), point));
        }
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        curve(points.into_iter().map(|(_, point)| point), out)?;
    }
    let is_told = runs().count() <= MOST_TOLD;
    if !(report.is_grid && report.keys.len() == 1) || is_told {
        for (run, value) in runs().filter(|(run, _)| run.has_completed()) {
            let Some((value, (x, y))) = value.and_then(|value| Some((value, place(run, value)?))) else { continue };
            let title = if is_told { format!("<title>{}</title>", html(&told(report, run, value))) } else { String::new() };
            writeln!(out, r#"<circle cx="{x:.1}" cy="{y:.1}" r="{}">{title}</circle>"#, if is_told { 3 } else { 2 })?;
        }
    }
    for (run, _) in runs().filter(|(run, _)| !run.has_completed()) {
        let Some(share) = x.place(&run.settings[key]) else { continue };
        chart::cross(chart::place(share, 0.0), &failure(report, run), out)?;
    }
    chart::end(out)
}

/// Indices of the runs that plots show: of random samples the first, of a grid evenly many.
fn shown(report: &SweepReport) -> impl Iterator<Item = usize> + Clone {
    let (runs, most) = (report.runs.len(), MOST_POINTS.min(report.runs.len()));
    let is_grid = report.is_grid;
    (0..most).map(move |k| if is_grid && most > 1 { k * (runs - 1) / (most - 1) } else { k })
}

/// A line through points that breaks where there is none.
fn curve(points: impl Iterator<Item = Option<(f64, f64)>>, out: &mut dyn io::Write) -> io::Result<()> {
    let (mut path, mut is_on) = (String::new(), false);
    for point in points {
        if let Some((x, y)) = point {
            path.push_str(&format!("{}{x:.1} {y:.1}", if is_on { 'L' } else { 'M' }));
        }
        is_on = point.is_some();
    }
    writeln!(out, r#"<path class="curve" d="{path}"/>"#)
}

/// A run in a line: its number, its values of the keys, and one of its results.
pub fn told(report: &SweepReport, run: &SweepRun, value: f64) -> String {
    format!("{}: {}", called(report, run), format::number(value))
}

/// Why a run did not complete, in a line.
pub fn failure(report: &SweepReport, run: &SweepRun) -> String {
    let at = run.stopped_at.map_or(String::new(), |t| format!(" at {} s", format::number(t)));
    format!("{} {}{at}: {}", called(report, run), run.status, run.reason)
}

fn called(report: &SweepReport, run: &SweepRun) -> String {
    let settings: Vec<String> = report.keys.iter().zip(&run.settings).map(|(key, value)| format!("{} = {value}", key.name)).collect();
    format!("run {}, {}", run.number, settings.join(", "))
}
