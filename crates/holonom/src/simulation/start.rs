//! The start: positions and velocities put on their constraints, accelerations and multipliers found.

use super::Method;
use crate::formulation::{Level, Multipliers, Workspace};
use crate::linalg::largest;
use crate::system::System;

/// What was corrected before the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Largest move of a coordinate, m; zero when the model met its constraints.
    pub moved: f64,
    /// Largest change of a velocity, m/s.
    pub turned: f64,
}

/// Why a model cannot start.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum StartError {
    #[error("the positions at the start miss their constraints and cannot be corrected; worst: {rows}")]
    Position { rows: String },
    #[error("the velocities at the start cannot meet their constraints; worst: {rows}")]
    Velocity { rows: String },
    #[error("the formulation `{formulation}` holds positions only, and these rows hold velocities: {rows}")]
    Nonholonomic { formulation: &'static str, rows: String },
    #[error("the accelerations at the start cannot be found: the mass matrix is singular where nothing holds it")]
    Acceleration,
}

/// Violation over the size of the mechanism that counts as met: what a model file written with ten digits leaves.
const MET: f64 = 1e-9;

/// Violation that is left alone: round-off.
const ROUND_OFF: f64 = 1e-14;

/// Largest correction of a position that is made, over the size of the mechanism.
const LARGEST_MOVE: f64 = 0.05;

/// Puts a workspace at the start of a run: x1, v1, a1, λ and the evaluation `at_start`.
pub(super) fn prepare(system: &System, method: &Method, work: &mut Workspace) -> Result<Start, StartError> {
    work.x1.copy_from_slice(&system.start_position);
    work.v1.copy_from_slice(&system.start_velocity);
    system.place_known(0.0, &mut work.x1, &mut work.v1, &mut work.a1);
    let soft = matches!(method.settings.multipliers, Multipliers::Penalty(_)) && method.settings.level == Level::POSITION;
    if soft && system.is_nonholonomic() {
        let rows: Vec<String> = system.velocity_rows.iter().map(|&row| format!("`{}`", system.row_names[row as usize])).collect();
        return Err(StartError::Nonholonomic { formulation: method.formulation.name, rows: rows.join(", ") });
    }
    let mut start = Start::default();
    correct_positions(system, work, &mut start)?;
    correct_velocities(system, work, &mut start)?;
    accelerate(system, method, work)?;
    work.at_start.copy_from(&work.at_end);
    Ok(start)
}

/// Mass-weighted Newton on Φ = 0.
fn correct_positions(system: &System, work: &mut Workspace, start: &mut Start) -> Result<(), StartError> {
    let n = system.coordinates();
    for _ in 0..30 {
        system.evaluate_again(&work.x1, 0.0, &mut work.at_end);
        system.constraint_values(&work.at_end, 0.0, &mut work.phi);
        if work.scaled_violation() <= ROUND_OFF || !work.factor_inertia() {
            break;
        }
        work.unknowns[..n].fill(0.0);
        work.unknowns[n..].iter_mut().zip(&work.phi).for_each(|(unknown, phi)| *unknown = -phi);
        work.kkt.solve(&mut work.unknowns);
        work.x1[..n].iter_mut().zip(&work.unknowns).for_each(|(x, step)| *x += step);
        start.moved = work.x1.iter().zip(&system.start_position).fold(0.0, |m, (x, x0)| f64::max(m, (x - x0).abs()));
        if start.moved.is_nan() || start.moved > LARGEST_MOVE * work.scales.length {
            system.evaluate_again(&system.start_position, 0.0, &mut work.at_end);
            system.constraint_values(&work.at_end, 0.0, &mut work.phi);
            return Err(StartError::Position { rows: worst(system, &work.phi) });
        }
    }
    match work.scaled_violation() <= MET {
        true => Ok(()),
        false => Err(StartError::Position { rows: worst(system, &work.phi) }),
    }
}

/// Velocity projection with A = M (10).
fn correct_velocities(system: &System, work: &mut Workspace, start: &mut Start) -> Result<(), StartError> {
    let n = system.coordinates();
    if !work.factor_inertia() {
        return Err(StartError::Acceleration);
    }
    let mut violation = f64::INFINITY;
    for _ in 0..4 {
        work.rate_violation(system, 0.0);
        let size = largest(&work.v1);
        violation = work.rows.iter().zip(&work.scales.gradient).fold(0.0, |m, (row, scale)| f64::max(m, row.abs() / scale));
        if violation <= ROUND_OFF * size {
            break;
        }
        work.unknowns[..n].fill(0.0);
        work.unknowns[n..].iter_mut().zip(&work.rows).for_each(|(unknown, rate)| *unknown = -rate);
        work.kkt.solve(&mut work.unknowns);
        work.v1[..n].iter_mut().zip(&work.unknowns).for_each(|(v, step)| *v += step);
    }
    start.turned = work.v1.iter().zip(&system.start_velocity).fold(0.0, |m, (v, v0)| f64::max(m, (v - v0).abs()));
    let size = largest(&work.v1).max(work.scales.length);
    match violation <= MET * size {
        true => Ok(()),
        false => Err(StartError::Velocity { rows: worst(system, &work.rows) }),
    }
}

/// Accelerations and multipliers by the formulation, or where it gives none by the index-1 system (3).
fn accelerate(system: &System, method: &Method, work: &mut Workspace) -> Result<(), StartError> {
    work.lambda.fill(0.0);
    let outcome = match method.formulation.gives_accelerations() {
        true => work.accelerate(system, 0.0, &method.settings),
        false => work.react(system, 0.0),
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
