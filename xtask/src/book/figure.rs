//! What a figure is: a claim, axes, curves, and the measurements that the claim stands or falls with.

use super::results::Results;

pub struct Figure {
    pub name: &'static str,
    /// The sentence that the measurements check.
    pub claim: &'static str,
    pub title: &'static str,
    pub x: Axis,
    pub y: Axis,
    pub curves: &'static [Curve],
    /// Points of a curve in the axes' units.
    pub points: fn(&Results, &Curve) -> Vec<(f64, f64)>,
    pub measurements: &'static [Measurement],
}

pub struct Axis {
    pub label: &'static str,
    pub scale: Scale,
    pub from: f64,
    pub to: f64,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    Linear,
    Log,
}

pub struct Curve {
    pub runs: &'static str,
    pub method: &'static str,
    pub label: &'static str,
}

/// A figure that a claim stands or falls with.
pub struct Measurement {
    pub what: &'static str,
    pub measure: fn(&Results) -> f64,
    pub least: f64,
    pub most: f64,
    /// Whether round-off decides its digits, so that only the bounds can be quoted.
    pub is_seeded_by_round_off: bool,
}

impl Measurement {
    pub fn holds(&self, value: f64) -> bool {
        (self.least..=self.most).contains(&value)
    }

    pub fn claimed(&self) -> String {
        match (self.least == f64::NEG_INFINITY, self.most == f64::INFINITY) {
            (true, _) => format!("below {}", short(self.most)),
            (_, true) => format!("above {}", short(self.least)),
            _ => format!("{} … {}", short(self.least), short(self.most)),
        }
    }
}

fn short(value: f64) -> String {
    if value == 0.0 || (1e-3..1e4).contains(&value.abs()) { format!("{value}") } else { format!("{value:e}") }
}

pub const fn within(what: &'static str, measure: fn(&Results) -> f64, least: f64, most: f64) -> Measurement {
    Measurement { what, measure, least, most, is_seeded_by_round_off: false }
}

pub const fn below(what: &'static str, measure: fn(&Results) -> f64, most: f64) -> Measurement {
    within(what, measure, f64::NEG_INFINITY, most)
}

/// Round-off decides the digits.
pub const fn seeded(measurement: Measurement) -> Measurement {
    Measurement { is_seeded_by_round_off: true, ..measurement }
}

pub const fn curve(runs: &'static str, method: &'static str, label: &'static str) -> Curve {
    Curve { runs, method, label }
}

/// A method on the paper's pendulum, under its own name.
pub const fn pendulum(method: &'static str) -> Curve {
    curve("pendulum", method, method)
}

pub const fn linear(label: &'static str, from: f64, to: f64) -> Axis {
    Axis { label, scale: Scale::Linear, from, to }
}

pub const fn log(label: &'static str, from: f64, to: f64) -> Axis {
    Axis { label, scale: Scale::Log, from, to }
}
