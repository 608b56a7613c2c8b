//! The numbers of a report as the viewer reads them; the other side is `viewer/src/payload.ts`.

use crate::Run;
use crate::base64;
use crate::outcome::{Outcome, is_measured};
use crate::thin::{Keep, Thinning};
use holonom::record::{Column, Recording, Scene};
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, HashSet};
use std::ops::Range;

/// Columns that go into the page as they are, and how they are thinned.
const COLUMNS: [(&str, Keep); 11] = [
    ("t", Keep::Last),
    ("energy", Keep::Last),
    ("kinetic", Keep::Last),
    ("potential", Keep::Last),
    ("work", Keep::Last),
    ("dE_integrator", Keep::Extreme),
    ("dE_projection", Keep::Extreme),
    ("phi", Keep::Max),
    ("phi_dot", Keep::Max),
    ("phi_ddot", Keep::Max),
    ("iterations", Keep::Max),
];

/// One run.
#[derive(Serialize)]
pub struct RunData<'a> {
    pub label: &'a str,
    /// Axes are scaled to the runs that are sound.
    pub sound: bool,
    /// None: that of the first run.
    scene: Option<&'a Scene>,
    /// Rows in the recording, before thinning.
    pub recorded: usize,
    /// Every `stride`-th row is here.
    pub stride: usize,
    /// Name → values, base64 of 64-bit floats. Besides those of the recording: `drift` = E − E(0) − W, and the running sums
    /// `sum_dE_integrator`, `sum_dE_projection`; they are formed here because thinning would falsify them.
    columns: BTreeMap<&'static str, String>,
    /// Name of a point → its coordinates along `scene.axes` from the origin of the page, row after row, base64 of 32-bit floats.
    points: BTreeMap<&'a str, String>,
    /// Name of a body → coordinates of its centre of mass along `scene.axes` from the origin of the page and its orientation (`qw`, `qx`,
    /// `qy`, `qz`; in a plane `angle`), row after row, base64 of 32-bit floats.
    bodies: BTreeMap<&'a str, String>,
    /// Names and times (s) of the events that are marked in plots.
    events: Vec<(&'a str, f64)>,
    /// What else was recorded: measures, then what acts and joint coordinates, then motion.
    channels: Vec<ChannelData<'a>>,
}

/// A column that may be plotted.
#[derive(Serialize)]
struct ChannelData<'a> {
    name: &'a str,
    unit: &'a str,
    meaning: &'a str,
    is_measure: bool,
    /// What is added to `values`: 0, or the middle of a column that varies little around it, which single precision would turn into stairs.
    middle: f64,
    /// What `values` are multiples of: 1, or the largest of a column whose numbers single precision does not have.
    scale: f64,
    /// Base64 of 32-bit floats.
    values: String,
    /// Least value, its time, largest value, its time, of all recorded rows; none where no value is finite.
    extremes: Option<[f64; 4]>,
}

/// A column whose middle is so many times as large as its variation counts from there.
const FLAT: f64 = 100.0;

/// Sizes of columns for which single precision has all numbers, down to 1e-8 of the largest.
const SINGLE: Range<f64> = 1e-30..1e38;

/// Numbers that a page holds per run for these; what comes last is left out where there are more.
const MAX_NUMBERS: usize = 600_000;

impl<'a> RunData<'a> {
    /// `first` is the first run of the report, `origin` what the places of its picture are counted from.
    pub fn new(run: &Run<'a>, first: &Run<'a>, outcome: Outcome, origin: [f64; 3]) -> Self {
        let (recording, scene) = (run.recording, run.scene);
        let [place, pose] = coordinates(scene);
        let thinning = Thinning::new(recording.rows(), scene.points.len() * place.len() + scene.bodies.len() * pose.len());
        let is_first = std::ptr::eq(run, first);
        Self {
            label: run.label,
            sound: outcome == Outcome::Sound,
            scene: (is_first || scene != first.scene).then_some(scene),
            recorded: recording.rows(),
            stride: thinning.stride,
            columns: columns(recording, &thinning),
            points: paths(recording, scene.points.iter().map(|point| point.name.as_str()), &place, origin, &thinning),
            bodies: paths(recording, scene.bodies.iter().map(|body| body.name.as_str()), &pose, origin, &thinning),
            events: events(run.summary),
            channels: channels(run, &thinning),
        }
    }
}

/// Most events of a run that are marked: more lines in a plot hide its curves.
const MARKED: usize = 30;

/// The events of a run in the order of their times: all where they are few, and else those that happen seldom, as long as they are few together.
fn events(summary: &Value) -> Vec<(&str, f64)> {
    let all = summary["events"].as_array().map_or(&[][..], Vec::as_slice);
    let all: Vec<(&str, f64)> = all.iter().filter_map(|event| Some((event["event"].as_str()?, event["t"].as_f64()?))).collect();
    let mut counts: BTreeMap<&str, usize> = BTreeMap::new();
    all.iter().for_each(|(name, _)| *counts.entry(name).or_default() += 1);
    let mut seldom: Vec<(usize, &str)> = counts.into_iter().map(|(name, count)| (count, name)).collect();
    seldom.sort_unstable();
    let mut room = MARKED;
    let mut fits = |count: usize| room.checked_sub(count).map(|left| room = left).is_some();
    let marked: HashSet<&str> = seldom.into_iter().take_while(|(count, _)| fits(*count)).map(|(_, name)| name).collect();
    all.into_iter().filter(|(name, _)| marked.contains(name)).collect()
}

/// World axes, whose letters end the columns of places.
const AXES: [&str; 3] = ["x", "y", "z"];

/// The middle of what moves in the first run that records places, at its start, in world axes, m. The places of a picture are counted from there, as single
/// precision would leave too few digits of a small mechanism far from the origin of its model.
pub fn origin(runs: &[Run]) -> [f64; 3] {
    let of_run = |run: &Run| -> Option<[f64; 3]> {
        let points = run.scene.points.iter().map(|point| &point.name);
        let names: Vec<&String> = points.chain(run.scene.bodies.iter().map(|body| &body.name)).collect();
        let along = |axis: &str| -> Option<f64> {
            let starts = names.iter().filter_map(|name| run.recording.column(&format!("{name}.{axis}"))?.first().copied());
            middle(starts)
        };
        // A plane has two coordinates, and the third is 0.
        let along = AXES.map(along);
        along.iter().any(Option::is_some).then(|| along.map(Option::unwrap_or_default))
    };
    runs.iter().find_map(of_run).unwrap_or_default()
}

/// The mean of those coordinates that are numbers.
pub fn middle(coordinates: impl Iterator<Item = f64>) -> Option<f64> {
    let finite: Vec<f64> = coordinates.filter(|x| x.is_finite()).collect();
    (!finite.is_empty()).then(|| finite.iter().sum::<f64>() / finite.len() as f64)
}

/// Endings of the columns of a point, and of the centre of mass and the orientation of a body.
pub fn coordinates(scene: &Scene) -> [Vec<&str>; 2] {
    let place: Vec<&str> = (0..scene.axes.len()).map(|i| &scene.axes[i..=i]).collect();
    let orientation: &[&str] = if scene.axes.len() == 3 { &["qw", "qx", "qy", "qz"] } else { &["angle"] };
    let pose = place.iter().chain(orientation).copied().collect();
    [place, pose]
}

fn columns(recording: &Recording, thinning: &Thinning) -> BTreeMap<&'static str, String> {
    let recorded = COLUMNS.iter().filter_map(|&(name, keep)| Some((name, recording.column(name)?.to_vec(), keep)));
    let derived = [
        ("drift", drift(recording), Keep::Extreme),
        ("sum_dE_integrator", running_sum(recording.column("dE_integrator")), Keep::Last),
        ("sum_dE_projection", running_sum(recording.column("dE_projection")), Keep::Last),
    ];
    let derived = derived.into_iter().filter_map(|(name, values, keep)| Some((name, values?, keep)));
    recorded.chain(derived).map(|(name, values, keep)| (name, base64::doubles(&thinning.apply(&values, keep)))).collect()
}

/// All measures, and all columns with a unit but those of the run itself.
fn channels<'a>(run: &Run<'a>, thinning: &Thinning) -> Vec<ChannelData<'a>> {
    let (recording, scene) = (run.recording, run.scene);
    let listed = run.summary.pointer("/peaks/measures").and_then(Value::as_array).into_iter().flatten();
    let measured: HashSet<&str> = listed.filter_map(|measure| measure.get("name")?.as_str()).collect();
    let is_measure = |column: &&Column| measured.contains(column.heading.name.as_str());
    let bodies = scene.bodies.iter().map(|body| body.name.as_str());
    let moving: HashSet<&str> = scene.points.iter().map(|point| point.name.as_str()).chain(bodies).collect();
    // Of bushings, which are shown with all that they do, rotations are sines without a unit.
    let bushings: HashSet<&str> = scene.bushings.iter().map(|bushing| bushing.name.as_str()).collect();
    let is_of_bushing = |name: &str| name.rsplit_once('.').is_some_and(|(owner, _)| bushings.contains(owner));
    let is_motion = |column: &&Column| column.heading.name.rsplit_once('.').is_some_and(|(owner, _)| moving.contains(owner));
    let shown = recording.columns().iter().filter(|column| {
        let heading = &column.heading;
        let is_of_run = COLUMNS.iter().any(|(name, _)| *name == heading.name);
        (heading.unit != "1" || is_measure(column) || is_of_bushing(&heading.name))
            && !is_of_run
            && !column.values.iter().all(|value| value.is_nan())
    });
    let (measures, others): (Vec<&Column>, Vec<&Column>) = shown.partition(is_measure);
    let (motion, others): (Vec<&Column>, Vec<&Column>) = others.into_iter().partition(is_motion);
    let times = recording.column("t").unwrap_or_default();
    let most = MAX_NUMBERS / thinning.kept().max(1);
    let channel = |column: &'a Column| {
        let heading = &column.heading;
        let extremes = extremes(times, &column.values);
        let (centre, span) = extremes.map_or((0.0, 0.0), |[least, _, most, _]| (0.5 * least + 0.5 * most, most - least));
        let middle = if centre.abs() > FLAT * span { centre } else { 0.0 };
        let values = if is_measured(run.summary) { bridged(times, &column.values) } else { column.values.clone() };
        let size = extremes.map_or(0.0, |[least, _, most, _]| (least - middle).abs().max((most - middle).abs()));
        let scale = if size == 0.0 || SINGLE.contains(&size) { 1.0 } else { size };
        let values: Vec<f32> = thinning.apply(&values, Keep::Range).into_iter().map(|value| ((value - middle) / scale) as f32).collect();
        ChannelData {
            name: &heading.name,
            unit: &heading.unit,
            meaning: &heading.meaning,
            is_measure: is_measure(&column),
            middle,
            scale,
            values: base64::singles(&values),
            extremes,
        }
    };
    measures.into_iter().chain(others).chain(motion).take(most).map(channel).collect()
}

/// A column whose rows without a number lie straight between those with one: sensors are not read at the same times, and curves show all of them.
fn bridged(times: &[f64], values: &[f64]) -> Vec<f64> {
    let mut bridged = values.to_vec();
    let known: Vec<usize> = (0..values.len()).filter(|row| values[*row].is_finite()).collect();
    for ends in known.windows(2) {
        let [from, to] = [ends[0], ends[1]];
        for row in from + 1..to {
            let share = (times[row] - times[from]) / (times[to] - times[from]);
            bridged[row] = (1.0 - share) * values[from] + share * values[to];
        }
    }
    bridged
}

/// The least finite value and the largest, each with the time when it is first reached.
fn extremes(times: &[f64], values: &[f64]) -> Option<[f64; 4]> {
    let finite = times.iter().zip(values).filter(|(_, value)| value.is_finite());
    finite.fold(None, |found, (&t, &value)| {
        let [least, least_at, most, most_at] = found.unwrap_or([value, t, value, t]);
        let (least, least_at) = if value < least { (value, t) } else { (least, least_at) };
        let (most, most_at) = if value > most { (value, t) } else { (most, most_at) };
        Some([least, least_at, most, most_at])
    })
}

/// E − E(0) − W, J; a recording without the column `work` has W = 0.
fn drift(recording: &Recording) -> Option<Vec<f64>> {
    let energy = recording.column("energy")?;
    let start = *energy.first()?;
    let work = recording.column("work");
    Some(energy.iter().enumerate().map(|(row, e)| e - start - work.map_or(0.0, |w| w[row])).collect())
}

fn running_sum(values: Option<&[f64]>) -> Option<Vec<f64>> {
    let mut sum = 0.0;
    let add = |v: &f64| {
        sum += v;
        sum
    };
    Some(values?.iter().map(add).collect())
}

/// What the recording has no coordinates of is left out; the viewer then draws nothing that hangs on it.
fn paths<'a>(
    recording: &Recording,
    names: impl Iterator<Item = &'a str>,
    coordinates: &[&str],
    origin: [f64; 3],
    thinning: &Thinning,
) -> BTreeMap<&'a str, String> {
    let from = |coordinate: &str| AXES.iter().position(|axis| *axis == coordinate).map_or(0.0, |k| origin[k]);
    let path = |name: &str| -> Option<String> {
        let values = coordinates.iter().map(|coordinate| {
            let values = thinning.apply(recording.column(&format!("{name}.{coordinate}"))?, Keep::Last);
            Some(values.into_iter().map(|value| value - from(coordinate)).collect())
        });
        let values: Vec<Vec<f64>> = values.collect::<Option<_>>()?;
        let rows = 0..thinning.kept();
        let numbers: Vec<f32> = rows.flat_map(|row| values.iter().map(move |values| values[row] as f32)).collect();
        Some(base64::singles(&numbers))
    };
    names.filter_map(|name| Some((name, path(name)?))).collect()
}
