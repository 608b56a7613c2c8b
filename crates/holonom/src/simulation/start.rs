//! The start: positions and velocities put on their constraints, accelerations and multipliers found.

use super::conflict::{Conflict, why};
use super::method::Choice;
use super::{Method, Simulation};
use crate::formulation::{Failure, Level, Multipliers, Newton, Workspace};
use crate::linalg::largest;
use crate::system::System;

/// What was corrected before the start.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Start {
    /// Largest move of a coordinate, m; zero when the model met its constraints.
    pub moved: f64,
    /// Largest change of the velocity of a node, m/s.
    pub turned: f64,
    /// Whether no motion begins with the velocities, as at a singular position no accelerations keep all rows then.
    pub leads_nowhere: bool,
    /// What asks for a motion that the rows together do not allow, where no motion begins for that.
    pub conflict: Option<Conflict>,
}

/// What is asked of a start: time, positions and velocities of all nodes (D × nodes), and the impulse (n) by which the momenta as
/// written differ from those of the velocities.
pub(super) struct Asked<'a> {
    pub t: f64,
    pub x: &'a [f64],
    pub v: &'a [f64],
    pub impulse: &'a [f64],
    /// Angles of the equations and of what is measured, from which turns are counted, rad.
    pub angles: Option<[&'a [f64]; 2]>,
    /// Numbers from outside, where they are not the defaults.
    pub inputs: Option<&'a [f64]>,
    /// Length of the steps to come, s.
    pub step: f64,
}

impl<'a> Asked<'a> {
    /// The start of the model.
    pub fn of(system: &'a System, step: f64) -> Self {
        Self {
            t: 0.0,
            x: &system.start_position,
            v: &system.start_velocity,
            impulse: &system.start_impulse,
            angles: None,
            inputs: None,
            step,
        }
    }
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
    #[error("the velocities at the start cannot meet their constraints; worst: {rows}{why}")]
    Velocity {
        /// The three rows that are missed most, by name, and by how much.
        rows: String,
        /// Why the worst of them cannot be met, where it leads.
        why: String,
    },
    /// A penalty on Φ, and rows that come of no Φ (methods §14).
    #[error("the formulation `{formulation}` holds positions only, and these rows hold velocities: {rows}")]
    Nonholonomic {
        /// Its name.
        formulation: &'static str,
        /// All rows that hold velocities only, by name.
        rows: String,
    },
    /// A nominal step that no run gets on with.
    #[error("the nominal step is {step} s, and no run gets on with it")]
    Step {
        /// What was given, s.
        step: f64,
    },
    /// More rows on one node than the matrix of a step can have.
    #[error(
        "{rows} equations of constraints are on one and the same point or body, `{row}` and others: no matrix of a step is large enough for them"
    )]
    Crowded {
        /// The first of them, by name.
        row: String,
        /// How many there are.
        rows: usize,
    },
    /// Inertia that is zero where nothing holds it.
    #[error("the accelerations at the start cannot be found: the mass matrix is singular where nothing holds it")]
    Acceleration,
    /// Forces, or their derivatives, that are not finite.
    #[error("the accelerations at the start cannot be found: {what}")]
    NotFinite {
        /// Which force has no value or no slope, where one is found.
        what: String,
    },
    /// A time, positions, velocities, angles or inputs of a state that are not finite.
    #[error("the state has numbers that are not finite")]
    NoNumber,
    /// The state has other numbers of nodes, rows or angles than the system.
    #[error("the state is one of another system")]
    Other,
}

/// What is said where no force is found that is to blame.
const NOT_FINITE: &str =
    "forces or their derivatives are not finite there (a formula may be outside its domain, or a table outside its range)";

/// Violation over the size of the mechanism that counts as met: what a model file written with ten digits leaves.
const MET: f64 = 1e-9;

/// Violation that is left alone: round-off.
const ROUND_OFF: f64 = 1e-14;

/// Violation of positions that rounding of these makes at least: what is more becomes a velocity in the first step, unless a
/// correction does not halve it.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Share of a violation that an iteration may leave where the next takes its factors.
const NEAR: f64 = 1e-6;

/// Most passes at the velocities: each leaves what δ lets the rows miss, much of it where parts are light.
const PASSES: usize = 30;

/// Least passes where light parts are: the first leaves them round-off of what moves heavy ones, and each after it that times
/// the ratio of the masses.
const PASSES_OF_LIGHT: usize = 3;

/// A pass that leaves more than this share makes little of it.
const SLOW: f64 = 0.1;

/// Largest correction of a position that is made, over the size of the mechanism.
const LARGEST_MOVE: f64 = 0.05;

/// Puts a workspace at the start of a run: position, velocity, acceleration and evaluation as the end of a step, λ, and the evaluation as the start of one.
pub(super) fn prepare(
    system: &System,
    method: &Method,
    asked: &Asked<'_>,
    newton: &mut Newton,
    work: &mut Workspace,
) -> Result<Start, StartError> {
    let soft = matches!(method.settings.multipliers, Multipliers::Penalty(_)) && method.settings.level == Level::POSITION;
    if soft && system.is_nonholonomic() {
        let rows: Vec<String> = system.velocity_rows.iter().map(|&row| format!("`{}`", system.row_names[row as usize])).collect();
        return Err(StartError::Nonholonomic { formulation: method.formulation.name, rows: rows.join(", ") });
    }
    let mut start = Start::default();
    put(system, asked, newton, work, &mut start)?;
    correct_velocities(system, asked, newton, work, &mut start)?;
    start.leads_nowhere = !accelerate(system, method, asked.t, newton, work)?;
    work.start.at.copy_from(&work.end.at);
    Ok(start)
}

/// Puts a workspace where it is asked, and its positions on their constraints by a mass-weighted Newton iteration on Φ = 0.
pub(super) fn put(
    system: &System,
    asked: &Asked<'_>,
    newton: &mut Newton,
    work: &mut Workspace,
    start: &mut Start,
) -> Result<(), StartError> {
    work.end.x.copy_from_slice(asked.x);
    work.end.v.copy_from_slice(asked.v);
    if let Some([angles, _]) = asked.angles {
        [&mut work.start.at, &mut work.end.at].into_iter().for_each(|at| at.functions.angle.copy_from_slice(angles));
    }
    system.place_known(asked.t, &mut work.end.x, &mut work.end.v, &mut work.a);
    let n = system.coordinates();
    let (mut before, mut is_factored) = (f64::INFINITY, false);
    for _ in 0..30 {
        system.evaluate_again(&work.end.x, asked.t, &mut work.end.at);
        system.constraint_values(&work.end.at, asked.t, &mut work.phi);
        let violation = work.scaled_violation();
        let is_met = violation <= ROUNDED || violation <= ROUND_OFF && violation > 0.5 * before;
        // Factors of a place as near as that do as well.
        is_factored &= violation <= NEAR * before;
        if is_met || !is_factored && !newton.factor_inertia(work) {
            break;
        }
        (before, is_factored) = (violation, true);
        newton.unknowns[..n].fill(0.0);
        newton.unknowns[n..].iter_mut().zip(&work.phi).for_each(|(unknown, phi)| *unknown = -phi);
        newton.kkt.solve(&mut newton.unknowns);
        work.end.x[..n].iter_mut().zip(&newton.unknowns).for_each(|(x, step)| *x += step);
        let apart = |(x, x0): (&[f64], &[f64])| x.iter().zip(x0).map(|(x, x0)| (x - x0) * (x - x0)).sum::<f64>();
        let ways = work.end.x.chunks_exact(system.dim).zip(asked.x.chunks_exact(system.dim)).map(apart);
        start.moved = ways.fold(0.0, f64::max).sqrt();
        if start.moved.is_nan() || start.moved > LARGEST_MOVE * work.scales.length {
            system.evaluate_again(asked.x, asked.t, &mut work.end.at);
            system.constraint_values(&work.end.at, asked.t, &mut work.phi);
            return Err(StartError::Position { rows: worst(system, &work.phi) });
        }
    }
    match work.scaled_violation() <= MET {
        true => Ok(()),
        false => Err(StartError::Position { rows: worst(system, &work.phi) }),
    }
}

/// The positions of all nodes (D × nodes) on the rows that are nearest to `x`, at the time `t` (s), with turns counted from `angles`; `x` where there are
/// none near it.
pub(super) fn on_rows(system: &System, x: &[f64], t: f64, angles: &[f64]) -> Vec<f64> {
    let settings = Method::resolve(&Choice::default()).expect("the default method goes with everything").settings;
    let mut work = Workspace::new(system);
    let mut newton = Newton::new(system, &work.scales, settings);
    let asked = Asked { t, x, angles: Some([angles, &[]]), ..Asked::of(system, 1.0) };
    match put(system, &asked, &mut newton, &mut work, &mut Start::default()) {
        Ok(()) => work.end.x,
        Err(_) => x.to_vec(),
    }
}

/// The velocities on their constraints that change those of all parts as written least, in the metric of the mass: a velocity
/// projection with A = M (10), of what parts that share nodes have as well. Each pass solves for what is left of both equations,
/// M Δv + Gᵀλ = j and Φ̇ = 0.
pub(super) fn correct_velocities(
    system: &System,
    asked: &Asked<'_>,
    newton: &mut Newton,
    work: &mut Workspace,
    start: &mut Start,
) -> Result<(), StartError> {
    let n = system.coordinates();
    work.lambda.fill(0.0);
    let written = work.end.v.clone();
    let mut change = vec![0.0; written.len()];
    let least = if work.scales.are_light { PASSES_OF_LIGHT } else { 1 };
    let differ = asked.impulse.iter().any(|impulse| *impulse != 0.0);
    // What only parts that share nodes are written with is in the impulse.
    let of_parts = asked.impulse.chunks_exact(system.dim).zip(&work.scales.agility).map(|(impulse, agility)| largest(impulse) * agility);
    let size = of_parts.fold(largest(&work.end.v), f64::max);
    let (mut violation, mut size, mut is_factored, mut is_sharp) = (f64::INFINITY, size, false, false);
    for pass in 0..PASSES {
        work.rate_violation(system, asked.t);
        let before = violation;
        violation = work.scaled(&work.rows);
        // What rows ask for that move is a velocity, too.
        size = size.max(violation);
        let is_met = violation <= ROUND_OFF * size;
        if is_met && (pass >= least || pass == 0 && !differ) {
            break;
        }
        // What stands still on its rows needs no factors.
        if !is_factored && !newton.factor_inertia(work) {
            return Err(StartError::Acceleration);
        }
        is_factored = true;
        if !is_met && violation > SLOW * before {
            // Where masses are far apart δ is much to some rows.
            if is_sharp || !newton.factor_inertia_of_independent(system, asked.t, work) {
                break;
            }
            is_sharp = true;
        }
        change.iter_mut().zip(work.end.v.iter().zip(&written)).for_each(|(change, (v, written))| *change = v - written);
        system.mass.times(system.dim, &change, &mut work.inertial);
        work.full.fill(0.0);
        system.slots.add_forces(system.dim, &work.lambda, &work.end.at.gradient, &mut work.full);
        let pulls = work.inertial.iter().zip(&work.full).map(|(inertial, pull)| inertial + pull);
        newton.unknowns[..n].iter_mut().zip(asked.impulse).zip(pulls).for_each(|((left, impulse), pull)| *left = impulse - pull);
        newton.unknowns[n..].iter_mut().zip(&work.rows).for_each(|(unknown, rate)| *unknown = -rate);
        newton.kkt.solve(&mut newton.unknowns);
        let (steps, multipliers) = newton.unknowns.split_at(n);
        work.end.v.iter_mut().zip(steps).for_each(|(v, step)| *v += step);
        work.lambda.iter_mut().zip(multipliers).for_each(|(lambda, step)| *lambda += step);
    }
    work.lambda.fill(0.0);
    start.turned = work.end.v.iter().zip(asked.v).fold(0.0, |m, (v, v0)| f64::max(m, (v - v0).abs()));
    // What moves nothing by more than its rounding in a step is no velocity.
    let is_still = size <= f64::EPSILON * work.scales.length / asked.step;
    match is_still || violation <= MET * size {
        true => Ok(()),
        false => {
            let rows = worst(system, &work.rows);
            let first = (0..work.rows.len()).max_by(|&a, &b| work.rows[a].abs().total_cmp(&work.rows[b].abs()));
            let first = first.filter(|_| newton.factor_inertia(work));
            let why = first.and_then(|row| Some(format!("; `{}` {}", system.row_names[row], why(row, system, newton, work)?)));
            Err(StartError::Velocity { rows, why: why.unwrap_or_default() })
        }
    }
}

/// Share of what forces make of the node that they push most by which a mechanism that stands falls, and below which it is at rest; between them what is
/// stiff may be off by little.
const FALLS: f64 = 0.1;
const RESTS: f64 = 1e-6;

/// Times of what weights make that forces may make: what is more, or all there is without weights, may be round-off of what is stiff.
const BESIDE_WEIGHT: f64 = 2.0;

impl Simulation {
    /// Whether forces balance at a start from rest, as far as the accelerations there tell.
    pub fn balances(&mut self) -> Option<bool> {
        let Self { system, work, state, start, .. } = self;
        if start.leads_nowhere {
            return None;
        }
        work.end.x.copy_from_slice(&state.x);
        work.end.at.copy_from(&work.start.at);
        let ([pushed, by_weight], fastest) = (work.pushed_at_end(system, state.t), largest(&state.a[..system.coordinates()]));
        if fastest <= RESTS * pushed {
            return Some(true);
        }
        Some(false).filter(|_| fastest > FALLS * pushed && pushed <= BESIDE_WEIGHT * by_weight)
    }
}

/// Accelerations and multipliers by the formulation, or where it gives none by the index-1 system (3). Says whether all rows are met.
pub(super) fn accelerate(system: &System, method: &Method, t: f64, newton: &mut Newton, work: &mut Workspace) -> Result<bool, StartError> {
    let outcome = match method.formulation.gives_accelerations() {
        true => newton.accelerate(system, t, work),
        false => newton.react(system, t, work),
    };
    outcome.map_err(|failure| match failure {
        Failure::NotFinite => StartError::NotFinite { what: NOT_FINITE.into() },
        _ => StartError::Acceleration,
    })
}

/// The three rows with the largest violation, by name.
fn worst(system: &System, rows: &[f64]) -> String {
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by(|&a, &b| rows[b].abs().total_cmp(&rows[a].abs()));
    let name = |&k: &usize| format!("`{}` by {:.3e}", system.row_names[k], rows[k]);
    order.iter().take(3).filter(|&&k| rows[k] != 0.0).map(name).collect::<Vec<_>>().join(", ")
}
