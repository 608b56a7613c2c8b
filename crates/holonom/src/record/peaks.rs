//! What acts most in a run: the largest efforts of drives, forces of springs and other forces, and forces of joints.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::Serialize;

use super::channels::Channels;
use super::force::quantity;
use super::joint::RecordedJoint;
use super::{Bounds, Column, Largest, Recording};
use crate::formulation::extent;
use crate::system::System;

/// The largest value of something that acts.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// Of the drive, the force or the joint.
    pub name: String,
    /// `"force"` or `"moment"`.
    pub what: &'static str,
    /// With the sign of its column; of several components their size, which has none.
    pub value: f64,
    /// N or N·m.
    pub unit: Cow<'static, str>,
    /// When it acts first, s.
    pub at: f64,
}

impl Peak {
    fn new(name: &str, value: f64, unit: Cow<'static, str>, at: f64) -> Self {
        Self { name: name.into(), what: if unit == "N" { "force" } else { "moment" }, value, unit, at }
    }
}

/// How far a measure goes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Extremes {
    /// Of the measure.
    pub name: String,
    /// As its author states it.
    pub unit: Cow<'static, str>,
    /// Its smallest value, and when, s.
    pub min: f64,
    /// When first, s.
    pub min_at: f64,
    /// Its largest value, and when, s.
    pub max: f64,
    /// When first, s.
    pub max_at: f64,
    /// Its last value.
    pub last: f64,
}

/// The largest values of a recording, the largest first.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Peaks {
    /// Of what drives exert.
    pub drives: Vec<Peak>,
    /// Of what springs and other forces exert.
    pub forces: Vec<Peak>,
    /// Of what joints, couplers, bars, rods and other constraints transmit.
    pub joints: Vec<Peak>,
    /// Of all measures, in the order of their columns.
    pub measures: Vec<Extremes>,
    /// How many of drives, forces and joints are smaller and not listed.
    pub more: [usize; 3],
}

/// Peaks of a sort that are kept.
const MOST: usize = 10;

/// Share of the largest of its sort that is round-off: of values that differ by no more the first counts.
const ROUND_OFF: f64 = 1e-9;

/// The same of the largest of all sorts, moments and forces together.
const ROUND_OFF_OF_OTHERS: f64 = 1e-12;

/// A few roundings of a place over itself, in shares of that.
const ROUNDED_PLACES: f64 = 16.0 * f64::EPSILON / ROUND_OFF_OF_OTHERS;

impl Peaks {
    /// Looks at all recorded rows, and at what was largest of forces between them. What was not recorded, or is not known, has no peak.
    pub fn of(channels: &Channels, recording: &Recording, system: &System) -> Self {
        let Some(times) = recording.column("t") else { return Self::default() };
        let peak = |name: &str, columns: &[String]| peak(name, columns, times, recording);
        let joint = |joint: &RecordedJoint| joint.acts(&channels.axes).map(|columns| peak(&joint.name, &columns));
        let told = channels.told();
        let drives = told.efforts.iter().filter_map(|effort| peak(&effort.name, &[format!("{}.effort", effort.name)]));
        let of_force = |k: usize, name: &str, columns: &[String]| {
            let unit = recording.find(columns.first()?)?.heading.unit.clone();
            let of_rows = peak(name, columns);
            let square = of_rows.as_ref().map_or(0.0, |peak| peak.value * peak.value);
            match recording.between.get(k).map(Largest::parts) {
                Some((at, between, value)) if between > (1.0 + ROUND_OFF) * square => Some(Peak::new(name, value, unit, at)),
                _ => of_rows,
            }
        };
        let drives: Vec<Peak> = drives.collect();
        let mut forces: Vec<Peak> = Vec::new();
        let mut beams: BTreeMap<(&str, String), Peak> = BTreeMap::new();
        let mut k = 0;
        for force in &channels.forces {
            for columns in force.acts(&channels.axes) {
                match force.beam() {
                    None => forces.extend(of_force(k, &force.name, &columns)),
                    Some(beam) => {
                        let key = (beam, quantity(&columns[0][force.name.len() + 1..]).to_string());
                        if let Some(peak) = of_force(k, &format!("{}.{}", force.name, key.1), &columns) {
                            // Of all elements of a beam the one in which it is largest.
                            let known = beams.entry(key).or_insert_with(|| peak.clone());
                            if peak.value.abs() > (1.0 + ROUND_OFF) * known.value.abs() {
                                *known = peak;
                            }
                        }
                    }
                }
                k += 1;
            }
        }
        forces.extend(beams.into_values());
        let couplings = told.couplings.iter().filter_map(|coupling| peak(&coupling.name, &[format!("{}.effort", coupling.name)]));
        let pushes = told.transmissions.iter().filter_map(|transmission| peak(&transmission.name, &transmission.acts(&channels.axes)));
        let rods = told.rods.iter().filter_map(|rod| peak(&rod.name, &[format!("{}.force", rod.name)]));
        let holds = told.holds.iter().flat_map(|hold| hold.acts(&channels.axes).filter_map(|(owner, columns)| peak(owner, &columns)));
        let joints: Vec<Peak> =
            told.joints.iter().flat_map(joint).flatten().chain(couplings).chain(pushes).chain(rods).chain(holds).collect();
        let [span, reach] = span(&channels.axes, recording);
        let all = || drives.iter().chain(&forces).chain(&joints);
        // A force that acts across the whole mechanism is compared with moments.
        let scale = |unit: &str, lever: f64| {
            let sizes = all().map(|peak| peak.value.abs() * if peak.unit == unit { 1.0 } else { lever });
            ROUND_OFF_OF_OTHERS * sizes.fold(0.0, f64::max)
        };
        // Arms of moments are differences of places, which far from the origin are rounded more.
        let arm = span.max(ROUNDED_PLACES * reach);
        // What only turns moves by round-off.
        let floors = if span > ROUND_OFF * extent(system) { [scale("N", 1.0 / span), scale("N·m", arm)] } else { [0.0; 2] };
        let is_something = |peak: &Peak| peak.value.abs() > floors[usize::from(peak.unit != "N")];
        let [(drives, d), (forces, f), (joints, j)] =
            [&drives, &forces, &joints].map(|peaks| largest(peaks.iter().filter(|peak| is_something(peak)).cloned().collect()));
        Self {
            drives,
            forces,
            joints,
            more: [d, f, j],
            measures: channels
                .measures
                .iter()
                .enumerate()
                .filter_map(|(k, measure)| extremes(k, &measure.name, times, recording))
                .collect(),
        }
    }
}

/// How far positions are apart along any axis over the whole recording, and from the origin, m.
fn span(axes: &str, recording: &Recording) -> [f64; 2] {
    let along = |axis: char| {
        let ending = format!(".{axis}");
        let columns = recording.columns().iter().filter(|column| column.heading.unit == "m" && column.heading.name.ends_with(&ending));
        let values = columns.flat_map(|column| &column.values).copied();
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (value.min(low), value.max(high)));
        if low > high { [0.0; 2] } else { [high - low, low.abs().max(high.abs())] }
    };
    axes.chars().map(along).fold([0.0; 2], |[span, reach], [apart, far]| [span.max(apart), reach.max(far)])
}

/// How far a measure goes, between the rows, too; none where it has no numbers.
fn extremes(measure: usize, name: &str, times: &[f64], recording: &Recording) -> Option<Extremes> {
    let column = recording.find(name)?;
    let rows = || column.values.iter().copied().zip(times.iter().copied()).filter(|(value, _)| value.is_finite());
    let between = || recording.bounds.get(measure).and_then(Bounds::sides);
    let all = || rows().chain(between().into_iter().flatten());
    let (lowest, highest) = all().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), (value, _)| (value.min(low), value.max(high)));
    // Not of the size: far from the origin a place changes by a small share of itself.
    let equal = ROUND_OFF * (highest - lowest);
    let first = |of: f64| all().filter(|(value, _)| (value - of).abs() <= equal).map(|(_, t)| t).min_by(f64::total_cmp);
    let (min_at, max_at) = (first(lowest)?, first(highest)?);
    // The end of the run may be no row.
    let last = recording.bounds.get(measure).map_or(*column.values.last()?, Bounds::last);
    let unit = column.heading.unit.clone();
    Some(Extremes { name: name.into(), unit, min: lowest, min_at, max: highest, max_at, last })
}

/// The row in which some columns of a unit are largest together; none where that is nothing.
fn peak(name: &str, columns: &[String], times: &[f64], recording: &Recording) -> Option<Peak> {
    let columns: Vec<&Column> = columns.iter().filter_map(|column| recording.find(column)).collect();
    let unit = columns.first()?.heading.unit.clone();
    let size = |row: usize| columns.iter().map(|column| column.values[row] * column.values[row]).sum::<f64>();
    let most = (0..times.len()).map(size).fold(0.0, f64::max);
    let (row, square) = (0..times.len()).map(|row| (row, size(row))).find(|(_, size)| *size > 0.0 && *size >= (1.0 - ROUND_OFF) * most)?;
    let value = if let [column] = columns[..] { column.values[row] } else { square.sqrt() };
    Some(Peak::new(name, value, unit, times[row]))
}

/// The largest of each unit, as these cannot be compared, and how many there are beside them.
fn largest(mut peaks: Vec<Peak>) -> (Vec<Peak>, usize) {
    peaks.sort_by(|a, b| (&a.unit, b.value.abs()).partial_cmp(&(&b.unit, a.value.abs())).expect("peaks are numbers"));
    let (mut kept, mut more): (Vec<Peak>, usize) = (Vec::new(), 0);
    for peak in peaks {
        let mut alike = kept.iter().filter(|kept| kept.unit == peak.unit);
        let is_nothing = alike.next().is_some_and(|largest| peak.value.abs() < ROUND_OFF * largest.value.abs());
        match (is_nothing, alike.count() + 1 < MOST) {
            (true, _) => (),
            (false, true) => kept.push(peak),
            (false, false) => more += 1,
        }
    }
    (kept, more)
}
