//! What goes round something without turning itself, such as a mass on a string: whether steps are long for it.

use holonom::model::Model;
use holonom::record::Recording;
use holonom::simulation::Simulation;

/// Turns that it makes in one sense at least: the acceleration of what swings as a pendulum turns once before it turns back.
const ROUNDS: f64 = 2.0;

/// Largest angle a step, rad: what trembles from step to step is turned about in each.
const ABOUT: f64 = 2.0;

/// Radius over the size of the mechanism below which it is no motion of its own: what trembles, as with rows of a penalty, may do so in circles.
const SMALL: f64 = 0.01;

/// Rows from one to the next at which it is looked whether anything turns at all.
const APART: usize = 16;

/// Columns of the position and of the velocity of a point.
type Path<'a> = [Vec<&'a [f64]>; 2];

/// By which share of itself a point, or the centre of mass of a body, comes on by less than its velocity says, where it goes round by more than `slow` (rad)
/// a step, of rows that are a step apart. How velocities change turns with it, and is the same where everything moves on evenly.
pub fn lags(model: &Model, simulation: &Simulation, recording: &Recording, slow: f64) -> Vec<(String, f64)> {
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
    let turns = |path: &Path<'_>| looks().any(|k| turn(path, k, scales).is_some_and(|(_, [came, _])| came > slow));
    let turning = paths.iter().filter(|(_, path)| turns(path));
    turning.filter_map(|(name, path)| Some(((*name).clone(), lag(path, &rows, scales)?))).collect()
}

/// Of the longest way round in one sense, if it is long.
fn lag(path: &Path<'_>, rows: &[usize], scales: [f64; 2]) -> Option<f64> {
    let (mut way, mut longest, mut last) = ([0.0; 2], [0.0; 2], (0, [0.0; 3]));
    for &k in rows {
        let Some((normal, [came, due])) = turn(path, k, scales) else { continue };
        let goes_on = last.0 + 1 == k && dot(last.1, normal) > 0.0;
        way = if goes_on { [way[0] + came, way[1] + due] } else { [0.0; 2] };
        longest = if way[0] > longest[0] { way } else { longest };
        last = (k, normal);
    }
    (longest[0] > ROUNDS * std::f64::consts::TAU).then(|| 1.0 - longest[0] / longest[1])
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
