//! The velocities at the start: the smallest change of what was written, in the metric of the mass, however it is written.

use faer::Mat;
use faer::linalg::solvers::Solve;
use holonom::analysis;
use holonom::model::{BodyInfo, Model};
use holonom::simulation::{Choice, Method, Simulation, StartError};
use nalgebra::Vector3;

use crate::mechanism::Mechanism;
use crate::random::Random;
use crate::rank::Agreement;

/// Difference of velocities over those written that is round-off, in the metric of the mass: the root of a kinetic energy. It is
/// of parts that are alike and rows that are far from redundant; that of light or thin parts grows with the root of the ratio, and where
/// a row adds little to the others as much as that is little.
const ROUND_OFF: f64 = 1e-12;

/// Singular value over the largest below which rows leave a motion free.
const FREE: f64 = 1e-9;

/// Mass of a free motion over the largest of a node that is no round-off.
const MASSLESS: f64 = 1e-14;

/// The motion of a body: velocity of its centre, m/s, and angular velocity, rad/s.
type Motion = [Vector3<f64>; 2];

/// Compares the start with those of the same mechanism written in other orders, with and without nodes that bodies share, and
/// with a dense solution.
pub fn compare(seed: u64, mechanism: &Mechanism, model: &Model) -> Agreement {
    let Ok(motions) = motions(mechanism, model) else { return Agreement::Unclear };
    let as_written: Vec<Motion> = model.bodies.iter().map(|body| [body.velocity.into(), body.angular_velocity.into()]).collect();
    let energy = kinetic(model, &as_written);
    if energy == 0.0 {
        return Agreement::Unclear;
    }
    let weakest = analysis::rank(&model.system, model.system.start_position(), 0.0).weakest;
    let bound = ROUND_OFF * (spread(mechanism, model) / weakest.map_or(1.0, |(_, share)| share)).sqrt();
    let mut plain = mechanism.clone();
    plain.reactions = true;
    let source = holonom_io::Source::read("model.toml", plain.toml().as_bytes()).and_then(|source| source.model());
    // Where a motion has no mass, its velocity is anything: whether such a start is refused is a matter of round-off.
    let Some(left) = source.ok().and_then(|model| left(&plain, &model)) else { return Agreement::Unclear };
    if left.is_nan() || left > bound {
        return Agreement::Differ("of the start and a dense solution", format!("{left:.1e} of the velocities as written"));
    }
    let mut others = vec![mechanism.clone(); 4];
    others[0].reactions = !mechanism.reactions;
    others[1].entries.reverse();
    others[2].entries = shuffled(seed, mechanism);
    others[3] = Mechanism { reactions: !mechanism.reactions, ..others[2].clone() };
    for (how, other) in ["reactions", "reversed", "shuffled", "shuffled, reactions"].into_iter().zip(&others) {
        let source = holonom_io::Source::read("model.toml", other.toml().as_bytes()).and_then(|source| source.model());
        let written = match source {
            Ok(written) => written,
            Err(message) => return Agreement::Differ("of a start that is refused", format!("{how}: {message}")),
        };
        let found = match self::motions(other, &written) {
            Ok(found) => found,
            Err(error) => return Agreement::Differ("of a start that is refused", format!("{how}: {error}")),
        };
        let difference: Vec<Motion> = model
            .bodies
            .iter()
            .zip(&motions)
            .map(|(body, motion)| {
                let at = written.bodies.iter().position(|other| other.name == body.name).expect("the same bodies");
                [0, 1].map(|k| motion[k] - found[at][k])
            })
            .collect();
        let off = (kinetic(model, &difference) / energy).sqrt();
        if off.is_nan() || off > bound {
            return Agreement::Differ("of starts", format!("{off:.1e} of the velocities as written, {how}"));
        }
    }
    Agreement::Agree
}

fn shuffled(seed: u64, mechanism: &Mechanism) -> Vec<crate::mechanism::Entry> {
    let mut random = Random::new(!seed);
    let mut entries = mechanism.entries.clone();
    (1..entries.len()).rev().for_each(|k| entries.swap(k, random.below(k + 1)));
    entries
}

fn start(mechanism: &Mechanism, model: &Model) -> Result<Simulation, StartError> {
    let method = Method::resolve(&Choice::default()).expect("the default goes together");
    Simulation::new(model.system.clone(), method, mechanism.step())
}

fn motions(mechanism: &Mechanism, model: &Model) -> Result<Vec<Motion>, StartError> {
    let simulation = start(mechanism, model)?;
    let (x, v) = (&*model.system.in_world(&simulation.state().x), simulation.velocities());
    Ok(model.bodies.iter().map(|body| body.recorded.velocity(x, v, model.dimension)).collect())
}

/// The largest mass over the smallest, of a body also that which its least moment of inertia has at the size of the mechanism.
fn spread(mechanism: &Mechanism, model: &Model) -> f64 {
    let moment = |body: &BodyInfo| body.inertia.symmetric_eigenvalues().iter().copied().filter(|i| *i > 0.0).fold(f64::INFINITY, f64::min);
    let bodies = model.bodies.iter().flat_map(|body| [body.mass, moment(body) / (mechanism.size * mechanism.size)]);
    let masses = bodies.chain(model.points.iter().map(|point| point.mass)).filter(|mass| mass.is_finite());
    let [least, most] = masses.fold([f64::INFINITY, 0.0], |[least, most]: [f64; 2], mass| [least.min(mass), most.max(mass)]);
    most / least
}

/// Twice the kinetic energy of the bodies with these motions, J.
fn kinetic(model: &Model, motions: &[Motion]) -> f64 {
    let of = |(body, [velocity, spin]): (&BodyInfo, &Motion)| body.mass * velocity.norm_squared() + spin.dot(&(body.inertia * spin));
    model.bodies.iter().zip(motions).map(of).sum()
}

/// What is left to gain of the kinetic energy of the change by motions that the rows allow, its root over that of all as written:
/// with N, the columns of which are a basis of these motions, that of y in NᵀMN y = NᵀM (v − v₀). Nothing where a motion has no
/// mass, or the rows have no clear rank.
fn left(mechanism: &Mechanism, model: &Model) -> Option<f64> {
    let (simulation, system) = (start(mechanism, model).ok()?, &model.system);
    let n = system.coordinates();
    let rows = analysis::constraint_jacobian(system, &simulation.state().x, 0.0);
    if rows.is_empty() {
        return None;
    }
    let lengths: Vec<f64> = rows.iter().map(|row| row.iter().map(|g| g * g).sum::<f64>().sqrt()).collect();
    let svd = Mat::from_fn(rows.len().max(n), n, |i, j| rows.get(i).map_or(0.0, |row| row[j] / lengths[i])).svd().ok()?;
    let values = svd.S().column_vector();
    let free: Vec<usize> = (0..n).filter(|&k| values[k] <= FREE * values[0]).collect();
    let basis = Mat::from_fn(n, free.len(), |i, j| svd.V()[(i, free[j])]);
    let change = Mat::from_fn(n, 1, |i, _| simulation.velocities()[i] - system.start_velocity()[i]);
    let mass = Mat::from_fn(n, n, |i, j| entry(model, i, j));
    let (pull, inertia) = (basis.transpose() * &mass * &change, basis.transpose() * &mass * &basis);
    let masses = inertia.self_adjoint_eigenvalues(faer::Side::Lower).ok()?;
    let heaviest = (0..n).map(|i| entry(model, i, i)).fold(0.0, f64::max);
    if masses.first()? <= &(MASSLESS * heaviest) {
        return None;
    }
    let y = inertia.llt(faer::Side::Lower).ok()?.solve(&pull);
    let left = (y.transpose() * &inertia * &y)[(0, 0)];
    let written = Mat::from_fn(n, 1, |i, _| system.start_velocity()[i]);
    let all = (written.transpose() * &mass * &written)[(0, 0)] + (change.transpose() * &mass * &change)[(0, 0)];
    if all > 0.0 { Some((left / all).sqrt()) } else { None }
}

/// An entry of the mass matrix.
fn entry(model: &Model, i: usize, j: usize) -> f64 {
    let dim = model.dimension;
    let block = model.system.mass().row(i / dim).find(|&(b, _)| b == j / dim).map(|(_, block)| block);
    match (block, i % dim, j % dim) {
        (None, ..) => 0.0,
        (Some(block), c, d) if c == d => block.m,
        (Some(block), 0, 1) => -block.s,
        (Some(block), 1, 0) => block.s,
        _ => 0.0,
    }
}
