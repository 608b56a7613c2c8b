//! The figures of the chapter: time of a step against the number of bodies, and CPU time against error.

use super::results::{Cost, Precision, Results, label};
use crate::book::draw::{Line, Picture};
use crate::book::figure::{Axis, Scale};

/// Smallest error that is shown.
const SMALLEST: f64 = 1e-8;

/// Names of the figures and their pictures.
pub fn all(results: &Results) -> Result<Vec<(String, String)>, String> {
    let by_bodies = [("chain", "Chain: time of a step"), ("four-bar", "Four-bar with N windows: time of a step")];
    let by_bodies = by_bodies.iter().map(|(problem, title)| Ok((problem.to_string(), cost(&results.times.cost, problem, title)?)));
    let mut problems: Vec<&str> = results.times.precision.iter().map(|entry| entry.problem.as_str()).collect();
    problems.dedup();
    let by_error = problems.iter().map(|problem| Ok((format!("{problem}-precision"), precision(&results.times.precision, problem)?)));
    by_bodies.chain(by_error).collect()
}

/// A curve before it is drawn.
struct Curve {
    label: String,
    points: Vec<(f64, f64)>,
}

fn cost(entries: &[Cost], problem: &str, title: &str) -> Result<String, String> {
    let mut curves: Vec<Curve> = Vec::new();
    for entry in entries.iter().filter(|entry| entry.problem == problem && entry.failed.is_none()) {
        let Some(us) = entry.us else { continue };
        let (label, point) = (label(&entry.program, &entry.setting), (f64::from(entry.bodies), us));
        match curves.iter_mut().find(|curve| curve.label == label) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve { label, points: vec![point] }),
        }
    }
    picture(title, "N", "CPU time of a step (µs)", &curves)
}

fn precision(entries: &[Precision], problem: &str) -> Result<String, String> {
    let of_problem: Vec<&Precision> = entries.iter().filter(|entry| entry.problem == problem).collect();
    let title = of_problem.first().map_or(problem, |entry| &entry.title).to_string();
    let curves: Vec<Curve> = chosen(&of_problem).into_iter().map(curve).filter(|curve| !curve.points.is_empty()).collect();
    picture(&format!("{title}: CPU time against error"), "largest error (m or rad)", "CPU time (s)", &curves)
}

/// The conserving schemes of order two, the best other method, and the best setting of each peer.
fn chosen<'a>(entries: &[&'a Precision]) -> Vec<&'a Precision> {
    let is_plain = |entry: &Precision| entry.program == "holonom" && ["conserving", "conserving-ggl"].contains(&entry.setting.as_str());
    let mut found: Vec<&Precision> = entries.iter().copied().filter(|entry| is_plain(entry)).collect();
    let mut programs: Vec<&str> = entries.iter().map(|entry| entry.program.as_str()).collect();
    programs.dedup();
    for program in programs {
        let others = entries.iter().copied().filter(|entry| entry.program == program && !is_plain(entry));
        found.extend(others.min_by(|a, b| rank(a).partial_cmp(&rank(b)).expect("times are numbers")));
    }
    found
}

/// How far a program falls short of the least error, and the time it takes to where it comes.
fn rank(entry: &Precision) -> (usize, f64) {
    let reached = entry.to.iter().rposition(Option::is_some);
    (entry.to.len() - reached.map_or(0, |goal| goal + 1), reached.and_then(|goal| entry.to[goal]).unwrap_or(f64::INFINITY))
}

fn curve(entry: &Precision) -> Curve {
    let points = entry.points.iter().filter_map(|point| point.cpu.map(|cpu| (point.error, cpu)));
    Curve { label: label(&entry.program, &entry.setting), points: points.filter(|(error, _)| *error >= SMALLEST).collect() }
}

fn picture(title: &str, x: &'static str, y: &'static str, curves: &[Curve]) -> Result<String, String> {
    let all = || curves.iter().flat_map(|curve| &curve.points);
    if all().next().is_none() {
        return Err(format!("figure `{title}`: nothing was measured"));
    }
    let (x, y) = (axis(x, all().map(|point| point.0)), axis(y, all().map(|point| point.1)));
    let curves = curves.iter().map(|curve| Line { label: &curve.label, points: curve.points.clone() }).collect();
    Picture { title, x: &x, y: &y, curves, marked: true }.svg().map_err(|fault| format!("figure `{title}`: {fault}"))
}

/// A logarithmic axis over the decades of what is on it.
fn axis(label: &'static str, values: impl Iterator<Item = f64>) -> Axis {
    let (least, most) =
        values.map(f64::log10).fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
    Axis { label, scale: Scale::Log, from: 10_f64.powf(least.floor()), to: 10_f64.powf(most.ceil().max(least.floor() + 1.0)) }
}
