//! The start: positions and velocities put on their constraints, accelerations and multipliers found.

use super::Method;
use crate::formulation::{Level, Multipliers, Newton, Workspace};
use crate::linalg::largest;
use crate::system::System;

/// What was corrected before the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Largest move of a coordinate, m; zero when the model met its constraints.
    pub moved: f64,
    /// Largest change of the velocity of a node, m/s.
    pub turned: f64,
}

/// Why a model cannot start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StartError {
    /// Positions that miss Φ = 0 by too much.
    #[error("the positions at the start miss their constraints and cannot be corrected; worst: {rows}")]
    Position {
        /// The three rows that are missed most, by name, and by how much.
        rows: String,
    },
    /// Velocities that cannot be put on Φ̇ = 0.
    #[error("the velocities at the start cannot meet their constraints; worst: {rows}")]
    Velocity {
        /// The three rows that are missed most, by name, and by how much.
        rows: String,
    },
    /// A penalty on Φ, and rows that come of no Φ (methods §14).
    #[error("the formulation `{formulation}` holds positions only, and these rows hold velocities: {rows}")]
    Nonholonomic {
        /// Its name.
        formulation: &'static str,
        /// All rows that hold velocities only, by name.
        rows: String,
    },
    /// Inertia that is zero where nothing holds it.
    #[error("the accelerations at the start cannot be found: the mass matrix is singular where nothing holds it")]
    Acceleration,
}

/// Violation over the size of the mechanism that counts as met: what a model file written with ten digits leaves.
const MET: f64 = 1e-9;

/// Violation that is left alone: round-off.
const ROUND_OFF: f64 = 1e-14;

/// Most passes at the velocities: each leaves what δ lets the rows miss, much of it where parts are light.
const PASSES: usize = 30;

/// A pass that leaves more than this share makes little of it.
const SLOW: f64 = 0.1;

/// Largest correction of a position that is made, over the size of the mechanism.
const LARGEST_MOVE: f64 = 0.05;

/// Puts a workspace at the start of a run: position, velocity, acceleration and evaluation as the end of a step, λ, and the evaluation as the start of one.
pub(super) fn prepare(system: &System, method: &Method, newton: &mut Newton, work: &mut Workspace) -> Result<Start, StartError> {
    work.end.x.copy_from_slice(&system.start_position);
    work.end.v.copy_from_slice(&system.start_velocity);
    system.place_known(0.0, &mut work.end.x, &mut work.end.v, &mut work.a);
    let soft = matches!(method.settings.multipliers, Multipliers::Penalty(_)) && method.settings.level == Level::POSITION;
    if soft && system.is_nonholonomic() {
        let rows: Vec<String> = system.velocity_rows.iter().map(|&row| format!("`{}`", system.row_names[row as usize])).collect();
        return Err(StartError::Nonholonomic { formulation: method.formulation.name, rows: rows.join(", ") });
    }
    let mut start = Start::default();
    correct_positions(system, newton, work, &mut start)?;
    correct_velocities(system, newton, work, &mut start)?;
    work.lambda.fill(0.0);
    accelerate(system, method, 0.0, newton, work)?;
    work.start.at.copy_from(&work.end.at);
    Ok(start)
}

/// Mass-weighted Newton on Φ = 0.
fn correct_positions(system: &System, newton: &mut Newton, work: &mut Workspace, start: &mut Start) -> Result<(), StartError> {
    let n = system.coordinates();
    for _ in 0..30 {
        system.evaluate_again(&work.end.x, 0.0, &mut work.end.at);
        system.constraint_values(&work.end.at, 0.0, &mut work.phi);
        if work.scaled_violation() <= ROUND_OFF || !newton.factor_inertia(work) {
            break;
        }
        newton.unknowns[..n].fill(0.0);
        newton.unknowns[n..].iter_mut().zip(&work.phi).for_each(|(unknown, phi)| *unknown = -phi);
        newton.kkt.solve(&mut newton.unknowns);
        work.end.x[..n].iter_mut().zip(&newton.unknowns).for_each(|(x, step)| *x += step);
        start.moved = work.end.x.iter().zip(&system.start_position).fold(0.0, |m, (x, x0)| f64::max(m, (x - x0).abs()));
        if start.moved.is_nan() || start.moved > LARGEST_MOVE * work.scales.length {
            system.evaluate_again(&system.start_position, 0.0, &mut work.end.at);
            system.constraint_values(&work.end.at, 0.0, &mut work.phi);
            return Err(StartError::Position { rows: worst(system, &work.phi) });
        }
    }
    match work.scaled_violation() <= MET {
        true => Ok(()),
        false => Err(StartError::Position { rows: worst(system, &work.phi) }),
    }
}

/// The velocities on their constraints that change those of all parts as written least, in the metric of the mass: a velocity
/// projection with A = M (10), of what parts that share nodes have as well.
fn correct_velocities(system: &System, newton: &mut Newton, work: &mut Workspace, start: &mut Start) -> Result<(), StartError> {
    let n = system.coordinates();
    if !newton.factor_inertia(work) {
        return Err(StartError::Acceleration);
    }
    let (mut violation, mut size, mut is_sharp) = (f64::INFINITY, largest(&work.end.v), false);
    for _ in 0..PASSES {
        work.rate_violation(system, 0.0);
        let before = violation;
        violation = work.rows.iter().zip(&work.scales.gradient).fold(0.0, |m, (row, scale)| f64::max(m, row.abs() / scale));
        // What rows ask for that move is a velocity, too.
        size = size.max(violation);
        let differ = before.is_infinite() && system.start_impulse.iter().any(|impulse| *impulse != 0.0);
        if violation <= ROUND_OFF * size && !differ {
            break;
        }
        if violation > SLOW * before {
            // Where masses are far apart δ is much to some rows.
            if is_sharp || !newton.factor_inertia_of_independent(system, 0.0, work) {
                break;
            }
            is_sharp = true;
        }
        newton.unknowns[..n].fill(0.0);
        if differ {
            newton.unknowns[..n].copy_from_slice(&system.start_impulse);
        }
        newton.unknowns[n..].iter_mut().zip(&work.rows).for_each(|(unknown, rate)| *unknown = -rate);
        newton.kkt.solve(&mut newton.unknowns);
        work.end.v[..n].iter_mut().zip(&newton.unknowns).for_each(|(v, step)| *v += step);
    }
    start.turned = work.end.v.iter().zip(&system.start_velocity).fold(0.0, |m, (v, v0)| f64::max(m, (v - v0).abs()));
    match violation <= MET * size {
        true => Ok(()),
        false => Err(StartError::Velocity { rows: worst(system, &work.rows) }),
    }
}

/// Accelerations and multipliers by the formulation, or where it gives none by the index-1 system (3).
pub(super) fn accelerate(system: &System, method: &Method, t: f64, newton: &mut Newton, work: &mut Workspace) -> Result<(), StartError> {
    let outcome = match method.formulation.gives_accelerations() {
        true => newton.accelerate(system, t, work),
        false => newton.react(system, t, work),
    };
    outcome.map_err(|_| StartError::Acceleration)
}

/// The three rows with the largest violation, by name.
fn worst(system: &System, rows: &[f64]) -> String {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|&a, &b| rows[b].abs().total_cmp(&rows[a].abs()));
    let name = |&k: &usize| format!("`{}` by {:.3e}", system.row_names[k], rows[k]);
    order.iter().take(3).filter(|&&k| rows[k] != 0.0).map(name).collect::<Vec<_>>().join(", ")
}
