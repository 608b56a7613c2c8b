//! Whether steps are long for what spins, or goes round something without turning itself, such as a mass on a string.

use std::f64::consts::{PI, TAU};

use holonom::model::Model;
use holonom::record::Recording;
use holonom::simulation::Simulation;

use crate::table::short;

/// Share of itself by which a rotation lags or leads from which on that is said.
const LAG: f64 = 0.01;

/// Angle a step, rad, below which no method of order 2 lags or leads by that much: what differs then is how few rows are recorded.
const SLOW: f64 = 0.2;

/// Turns that it makes in one sense at least: the acceleration of what swings as a pendulum turns once before it turns back.
const ROUNDS: f64 = 2.0;

/// Share of all its way by which the angle of a joint and the sum of its rate part, from which on that is said.
const PARTING: f64 = 0.05;

/// Angle below which they do not part, rad: what is round-off of a joint that stands.
const NOTHING: f64 = 1e-3;

/// Most that schemes of order 2 let such a sum part from the angle, over the cube of the angle a step by which the fastest body turns: RATTLE's is a sixth.
const MISLED: f64 = 0.25;

/// Largest angle a step, rad: what trembles from step to step is turned about in each.
const ABOUT: f64 = 2.0;

/// Radius over the size of the mechanism below which it is no motion of its own: what trembles, as with rows of a penalty, may do so in circles.
const SMALL: f64 = 0.01;

/// Rows from one to the next at which it is looked whether anything turns at all.
const APART: usize = 16;

/// Columns of the position and of the velocity of a point.
type Path<'a> = [Vec<&'a [f64]>; 2];

/// The longest way without a turn back, by the angle that something came on by.
#[derive(Default)]
struct Way {
    /// By how much it came on, and by how much it would have by its rate, rad: on the way at hand, and on the longest.
    now: [f64; 2],
    longest: [f64; 2],
}

impl Way {
    /// Goes on by another turn, or begins anew behind it.
    fn go(&mut self, goes_on: bool, [came, due]: [f64; 2]) {
        self.now = if goes_on { [self.now[0] + came, self.now[1] + due] } else { [0.0; 2] };
        if self.now[0].abs() > self.longest[0].abs() {
            self.longest = self.now;
        }
    }

    /// The share of the longest that is missing.
    fn lag(&self) -> f64 {
        1.0 - self.longest[0] / self.longest[1]
    }
}

/// That steps are long for what spins: schemes of order 2 turn it by a twelfth of the cube of the angle too little in each (methods §8.1), and RATTLE
/// by a sixth of that too much, so that angles come on by less or more than their rates say. What drives lead has its angle, and its rate is off; so is that of
/// all that turns with positions of a higher order than velocities. Whether something is free to move is for the rank to say.
pub fn long_turns(model: &Model, simulation: &Simulation, recording: &Recording, is_free: bool) -> Option<String> {
    let (method, step) = (simulation.method(), simulation.nominal_step());
    if method.accuracy.is_some() || method.order() > 2 {
        return None;
    }
    let times = recording.column("t")?;
    let lag = |name: &String| {
        let (angles, rates) = (recording.column(name)?, recording.column(&format!("{name}_rate"))?);
        let mut way = Way::default();
        for ((t, angle), rate) in times.windows(2).zip(angles.windows(2)).zip(rates.windows(2)) {
            let span = 0.5 * (t[1] - t[0]) * (rate[0] + rate[1]);
            way.go(rate[0] * rate[1] >= 0.0 && way.now[1] * span >= 0.0, [angle[1] - angle[0], span]);
        }
        (way.longest[0].abs() > TAU && rates.iter().any(|rate| rate.abs() * step > SLOW)).then(|| way.lag())
    };
    let largest = |lags: &mut dyn Iterator<Item = (String, f64)>| {
        lags.filter(|(_, lag)| lag.abs() > LAG).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    };
    let angles = model.system.gauges().iter().filter(|gauge| gauge.ends_with("angle"));
    let is_whole = simulation.work().rejected_steps == 0;
    let in_space = |name: &String| lag_in_space(name, recording, step, is_whole);
    // Bodies that no joint has an angle of, and then what goes round without turning itself.
    let Some(((name, lag), rate)) = largest(&mut angles.filter_map(|name| Some((name.clone(), lag(name)?))))
        .or_else(|| largest(&mut model.scene.bodies.iter().filter_map(|body| Some((body.name.clone(), in_space(&body.name)?)))))
        .map(|found| (found, "rate"))
        .or_else(|| Some((largest(&mut lags_round(model, simulation, recording).into_iter())?, "velocity")))
    else {
        return misled(model, simulation, recording);
    };
    let [less, lags, high] = if lag > 0.0 { ["less", "lags", "high"] } else { ["more", "leads", "low"] };
    let [of_positions, of_velocities, _] = method.convergence();
    let why = if of_positions > of_velocities || !is_free {
        format!("with velocities of order {of_velocities} its {rate} is too {high}")
    } else if model.system.is_driven() {
        format!("with a method of order {of_positions} what is free {lags}, and what drives lead has too {high} a {rate},")
    } else {
        format!("a method of order {of_positions} {lags}")
    };
    Some(format!(
        "`{name}` comes on by {:.0} % {less} than its {rate} says: {why} where steps are long for what spins (a shorter step, or gauss)",
        100.0 * lag.abs()
    ))
}

/// That the rate of a joint on something that spins is not that of its angle: what is driven round keeps its rate, and what it carries along has that of
/// a lagging rotation, so that the two differ by far more than anything lags.
fn misled(model: &Model, simulation: &Simulation, recording: &Recording) -> Option<String> {
    let times = recording.column("t")?;
    if times.len() < 2 || times.windows(2).any(|t| t[1] - t[0] > 1.5 * simulation.nominal_step()) {
        return None;
    }
    let turned = turned_by_bodies(model, recording);
    let bound: f64 = times.windows(2).zip(&turned).map(|(t, rate)| MISLED * ((t[1] - t[0]) * rate).powi(3)).sum();
    let parts = |name: &String| {
        let (angles, rates) = (recording.column(name)?, recording.column(&format!("{name}_rate"))?);
        let spans = || times.windows(2).zip(rates.windows(2)).map(|(t, rate)| 0.5 * (t[1] - t[0]) * (rate[0] + rate[1]));
        let (due, way) = (spans().sum::<f64>(), spans().map(f64::abs).sum::<f64>());
        let parted = due - (angles[angles.len() - 1] - angles[0]);
        (parted.abs() > (PARTING * way).max(NOTHING) && parted.abs() < bound).then(|| (name.clone(), parted, way))
    };
    let angles = model.system.gauges().iter().filter(|gauge| gauge.ends_with("angle"));
    let (name, parted, way) = angles.filter_map(parts).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    Some(format!(
        "`{name}` comes on by {} rad {} than its rate says, {:.0} % of all its way: it is on what spins, and with velocities of order {} and long steps its rate, and \
         dampers that read it, are off (a shorter step, or gauss)",
        short(parted.abs()),
        if parted > 0.0 { "less" } else { "more" },
        100.0 * parted.abs() / way,
        simulation.method().convergence()[1]
    ))
}

/// The rate at which the fastest body turns in each row, rad/s.
fn turned_by_bodies(model: &Model, recording: &Recording) -> Vec<f64> {
    let mut fastest = vec![0.0_f64; recording.rows()];
    for body in &model.scene.bodies {
        let of = |ending: &str| recording.column(&format!("{}.{ending}", body.name));
        let rates: Vec<&[f64]> = ["wx", "wy", "wz", "angle_rate"].into_iter().filter_map(of).collect();
        fastest.iter_mut().enumerate().for_each(|(k, most)| *most = most.max(rates.iter().map(|rate| rate[k].powi(2)).sum::<f64>().sqrt()));
    }
    fastest
}

/// The same of a body in space, of rows a step apart: a step turns it by less than half a turn, unless it is taken in parts.
fn lag_in_space(body: &str, recording: &Recording, step: f64, is_whole: bool) -> Option<f64> {
    let column = |ending: &str| recording.column(&format!("{body}.{ending}"));
    let [qw, qx, qy, qz, wx, wy, wz] = ["qw", "qx", "qy", "qz", "wx", "wy", "wz"].map(column);
    let ([qw, qx, qy, qz], [wx, wy, wz], times) = ([qw?, qx?, qy?, qz?], [wx?, wy?, wz?], recording.column("t")?);
    let rate = |k: usize| (wx[k].powi(2) + wy[k].powi(2) + wz[k].powi(2)).sqrt();
    let mut way = Way::default();
    for k in 1..times.len() {
        let span = times[k] - times[k - 1];
        // The mean of the vectors: what swings to and fro has hardly any where it turns back.
        let turn = 0.5 * span * [wx, wy, wz].map(|w| (w[k - 1] + w[k]).powi(2)).iter().sum::<f64>().sqrt();
        if span < 1.5 * step && (is_whole || turn < PI) {
            let cosine = [qw, qx, qy, qz].map(|q| q[k - 1] * q[k]).iter().sum::<f64>().abs();
            let goes_on = [wx, wy, wz].map(|w| w[k - 1] * w[k]).iter().sum::<f64>() >= 0.0;
            way.go(goes_on, [2.0 * cosine.min(1.0).acos(), turn]);
        }
    }
    (way.longest[1] > TAU && (0..times.len()).any(|k| rate(k) * step > SLOW)).then(|| way.lag())
}

/// By which share of itself a point, or the centre of mass of a body, comes on by less than its velocity says, where it goes round by more than [`SLOW`] a
/// step, of rows that are a step apart. How velocities change turns with it, and is the same where everything moves on evenly.
fn lags_round(model: &Model, simulation: &Simulation, recording: &Recording) -> Vec<(String, f64)> {
    let (channels, times, step) = (&model.channels, recording.column("t").unwrap_or_default(), simulation.nominal_step());
    let names = channels.points.iter().map(|point| &point.name).chain(channels.bodies.iter().map(|body| &body.name));
    let path = |name: &String| -> Option<Path<'_>> {
        let of = |what: &str| -> Option<Vec<_>> {
            channels.axes.chars().map(|axis| recording.column(&format!("{name}.{what}{axis}"))).collect()
        };
        Some([of("")?, of("v")?])
    };
    let paths: Vec<_> = names.filter_map(|name| Some((name, path(name)?))).collect();
    let is_step = |k: usize| (times[k] - times[k - 1] - step).abs() < 1e-6 * step;
    let rows: Vec<usize> = (1..times.len().saturating_sub(1)).filter(|&k| is_step(k) && is_step(k + 1)).collect();
    let looks = || rows.iter().copied().step_by(APART);
    let scales = [SMALL * simulation.length(), step];
    let turns = |path: &Path<'_>| looks().any(|k| turn(path, k, scales).is_some_and(|(_, [came, _])| came > SLOW));
    let turning = paths.iter().filter(|(_, path)| turns(path));
    turning.filter_map(|(name, path)| Some(((*name).clone(), lag_round(path, &rows, scales)?))).collect()
}

/// Of the longest way round in one sense, if it is long.
fn lag_round(path: &Path<'_>, rows: &[usize], scales: [f64; 2]) -> Option<f64> {
    let (mut way, mut last) = (Way::default(), (0, [0.0; 3]));
    for &k in rows {
        let Some((normal, turned)) = turn(path, k, scales) else { continue };
        way.go(last.0 + 1 == k && dot(last.1, normal) > 0.0, turned);
        last = (k, normal);
    }
    (way.longest[0] > ROUNDS * TAU).then(|| way.lag())
}

/// About which direction a point turns in the steps beside a row, by which angle in each (rad), and by which it would by its velocities: on a circle of radius r
/// second differences of places are 4r sin² of half the angle, and differences of velocities over two steps 2ωr times its sine.
fn turn([x, v]: &Path<'_>, k: usize, [least, step]: [f64; 2]) -> Option<([f64; 3], [f64; 2])> {
    let ([before, after], both) = ([change(v, [k - 1, k]), change(v, [k, k + 1])], change(v, [k - 1, k + 1]));
    let normal = [1, 2, 0].map(|i| before[i] * after[(i + 1) % 3] - before[(i + 1) % 3] * after[i]);
    let came = square(normal).sqrt().atan2(dot(before, after));
    let bend = [0, 1, 2].map(|i| change(x, [k, k + 1])[i] - change(x, [k - 1, k])[i]);
    let is_round = square(bend).sqrt() > least * 4.0 * (0.5 * came).sin().powi(2) && came < ABOUT;
    is_round.then(|| (normal, [came, step * (square(both) / square(bend)).sqrt() * (0.5 * came).tan()]))
}

/// How columns change from one row to another; one that is not there does not.
fn change(of: &[&[f64]], [from, to]: [usize; 2]) -> [f64; 3] {
    [0, 1, 2].map(|i| of.get(i).map_or(0.0, |values| values[to] - values[from]))
}

fn dot(u: [f64; 3], w: [f64; 3]) -> f64 {
    u[0] * w[0] + u[1] * w[1] + u[2] * w[2]
}

fn square(u: [f64; 3]) -> f64 {
    dot(u, u)
}
