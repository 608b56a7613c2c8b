//! Rows that ask for what the others do not allow, such as a drive of what has no freedom left.

use std::fmt;

use super::Simulation;
use crate::formulation::{Newton, Workspace};
use crate::system::System;

/// Passes of the solve: what δ lets the rows miss is left to the next.
const PASSES: usize = 5;

/// Share of what rows ask for that is left where they contradict each other; less is left by curvature and by δ.
const CONTRADICTS: f64 = 1e-3;

/// Share of a motion along a row alone that is left where nothing can move that way.
const BLOCKED: f64 = 1e-2;

/// Rows that ask for less than this share of the mechanism's size ask for nothing.
const NOTHING: f64 = 1e-10;

/// How many times the mass that a row moves is what it was at the start where it leads hardly anywhere, and most rows that are looked at.
const STUCK: f64 = 100.0;
const MOST: usize = 50;

/// A row that asks for a motion which all rows together do not allow.
#[derive(Clone, Debug, PartialEq)]
pub struct Conflict {
    /// Its name.
    pub row: String,
    /// What it does, with the cure, of a row that leads: it leads where nothing can move, or what another leads. Empty where that is not known.
    pub why: String,
}

impl fmt::Display for Conflict {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` asks for a motion that the other constraints do not allow", self.row)?;
        if self.why.is_empty() { Ok(()) } else { write!(f, ": it {}", self.why) }
    }
}

impl Conflict {
    fn new(row: usize, system: &System, newton: &mut Newton, work: &Workspace) -> Self {
        Self { row: system.row_names[row].clone(), why: why(row, system, newton, work).unwrap_or_default() }
    }
}

/// Why nothing can move along a row that leads, as that of a drive, in words, with the cure, if that is so at the place where the matrix of the
/// inertia was factored.
pub(super) fn why(row: usize, system: &System, newton: &mut Newton, work: &Workspace) -> Option<String> {
    Some(match bar(row, system, newton, work)? {
        Bar::Leading(other) => {
            format!("leads the same freedom as `{}` (remove one of the two, or give both the same motion)", system.row_names[other])
        }
        Bar::Constant => {
            "leads in a direction in which the mechanism cannot move there: at a dead centre, or as other constraints hold what it leads \
                          (start away from the dead centre, lead another joint, or take away a constraint)"
                .into()
        }
    })
}

/// What keeps anything from moving along a row alone.
enum Bar {
    /// Another row that leads.
    Leading(usize),
    /// Rows that do not lead.
    Constant,
}

/// What bars the motion along a row that leads, if anything does, at the place where the matrix of the inertia was factored.
fn bar(row: usize, system: &System, newton: &mut Newton, work: &Workspace) -> Option<Bar> {
    let leads = |row: usize| system.rows.get(row).is_some_and(|row| !row.is_constant());
    let size = |row: usize| work.scales.gradient[row] * work.scales.length;
    let mut asked = vec![0.0; work.phi.len()];
    asked[row] = size(row);
    let left = unmet(system, newton, work, &asked);
    let is_left = |row: usize| left[row].abs() > BLOCKED * size(row);
    let other = || (0..left.len()).find(|&other| other != row && leads(other) && is_left(other));
    (leads(row) && is_left(row)).then(|| other().map_or(Bar::Constant, Bar::Leading))
}

/// What is left of `asked` (r) when all rows are asked for it at once, to first order, with the matrix of the inertia as it was last factored.
pub(super) fn unmet(system: &System, newton: &mut Newton, work: &Workspace, asked: &[f64]) -> Vec<f64> {
    let n = system.coordinates();
    let mut left = asked.to_vec();
    for _ in 0..PASSES {
        newton.unknowns[..n].fill(0.0);
        newton.unknowns[n..].iter_mut().zip(&left).for_each(|(unknown, left)| *unknown = -left);
        newton.kkt.solve(&mut newton.unknowns);
        let mut along = vec![0.0; work.end.x.len()];
        along[..n].copy_from_slice(&newton.unknowns[..n]);
        system.slots.add_along(system.dim, 1.0, &work.end.at.gradient, &along, &mut left);
    }
    left
}

impl Simulation {
    /// The row that asks for a motion in the step to come which all rows together do not allow, to first order, at the present
    /// state: no increment d has G d = −Φ(q, t + h). Nothing of the simulation changes.
    pub fn conflict(&mut self) -> Option<Conflict> {
        self.ask(Self::contradiction)
    }

    /// A row that leads where nothing can move, as a drive at a dead centre or one of two of the same freedom, though it asks for next to nothing in
    /// the step to come. Nothing of the simulation changes.
    pub(super) fn blocked(&mut self) -> Option<Conflict> {
        self.first_leading(|row, system, newton, work| {
            why(row, system, newton, work).map(|why| Conflict { row: system.row_names[row].clone(), why })
        })
    }

    /// Two rows that lead, by name, as those of two drives, where one of them leaves nothing for the other to lead. Nothing of the simulation changes.
    pub fn rivals(&mut self) -> Option<[String; 2]> {
        self.first_leading(|row, system, newton, work| match bar(row, system, newton, work) {
            Some(Bar::Leading(other)) => Some([row, other].map(|row| system.row_names[row].clone())),
            _ => None,
        })
    }

    /// What is found first of a row that leads, at the present state.
    fn first_leading<T>(&mut self, find: impl Fn(usize, &System, &mut Newton, &Workspace) -> Option<T>) -> Option<T> {
        self.ask(|own| {
            let (system, newton, work, state) = (&*own.system, &mut own.newton, &mut own.work, &own.state);
            work.end.x.copy_from_slice(&state.x);
            work.end.v.copy_from_slice(&state.v);
            system.place_known(state.t, &mut work.end.x, &mut work.end.v, &mut work.a);
            system.evaluate(&work.end.x, state.t, &work.start.at, &mut work.end.at);
            let mut leading = (0..system.rows.len()).filter(|&row| !system.rows[row].is_constant()).take(MOST).peekable();
            let can_be_asked = leading.peek().is_some() && newton.factor_inertia(work);
            can_be_asked.then(|| leading.find_map(|row| find(row, system, newton, work))).flatten()
        })
    }

    /// Asks something with the matrix of the steps, which go on as if nobody had.
    pub(super) fn ask<T>(&mut self, question: impl FnOnce(&mut Self) -> T) -> T {
        let counters = (self.newton.iterations, self.newton.factorizations);
        let answer = question(self);
        self.hints.restore(&mut self.newton, &mut *self.integrator);
        (self.newton.iterations, self.newton.factorizations) = counters;
        answer
    }

    /// The row that leads, by name, as that of a drive, which moves many times the mass that it did at the start: it comes to a dead centre, or to the
    /// end of its reach. Nothing of the simulation changes.
    pub(super) fn stuck(&mut self) -> Option<&str> {
        let system = self.system.clone();
        let leading: Vec<usize> = (0..system.rows.len()).filter(|&row| !system.rows[row].is_constant()).take(MOST).collect();
        let (x, t) = (self.state.x.clone(), self.state.t);
        let [now, first] = self.ask(|own| [(&x, t), (&system.start_position, 0.0)].map(|(x, t)| own.masses(&leading, x, t)));
        let growth = now?.into_iter().zip(first?).map(|(now, first)| now / first);
        let (row, growth) = leading.into_iter().zip(growth).max_by(|a, b| a.1.total_cmp(&b.1))?;
        (growth > STUCK).then(|| self.system.row_names[row].as_str())
    }

    /// The mass that each of some rows moves at a place and time, in units of its own: the diagonal of (G M⁻¹Gᵀ)⁻¹.
    fn masses(&mut self, rows: &[usize], x: &[f64], t: f64) -> Option<Vec<f64>> {
        let (system, newton, work) = (&*self.system, &mut self.newton, &mut self.work);
        work.end.x.copy_from_slice(x);
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        let is_known = rows.is_empty() || newton.factor_inertia(work);
        let of_row = |&row: &usize| {
            let multiplier = system.coordinates() + row;
            newton.unknowns.fill(0.0);
            newton.unknowns[multiplier] = 1.0;
            newton.kkt.solve(&mut newton.unknowns);
            newton.unknowns[multiplier].abs()
        };
        is_known.then(|| rows.iter().map(of_row).collect())
    }

    fn contradiction(&mut self) -> Option<Conflict> {
        let t = self.state.t + self.nominal_step();
        let (system, newton, work, state) = (&*self.system, &mut self.newton, &mut self.work, &self.state);
        work.end.x.copy_from_slice(&state.x);
        work.end.v.copy_from_slice(&state.v);
        system.place_known(t, &mut work.end.x, &mut work.end.v, &mut work.a);
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
        system.constraint_values(&work.end.at, t, &mut work.phi);
        let asked = work.phi.clone();
        let most = work.scaled_violation();
        if most.is_nan() || most <= NOTHING || !newton.factor_inertia(work) {
            return None;
        }
        let left = unmet(system, newton, work, &asked);
        let share = |row: usize| left[row].abs() / (work.scales.gradient[row] * work.scales.length);
        if !(0..left.len()).any(|row| share(row) > CONTRADICTS * most) {
            return None;
        }
        // The softer a row the more is left of it. What is left over that, as a force, times what the row asks for is its part in the contradiction, in
        // one unit for all rows: of what moves, not of what holds.
        let part = |row: usize| (left[row] * asked[row] / work.scales.softness[row]).abs();
        let worst = |rows: &mut dyn Iterator<Item = usize>| rows.max_by(|&a, &b| part(a).total_cmp(&part(b)));
        let is_written = |row: &usize| !system.rows.get(*row).is_some_and(|row| row.is_implied);
        let row = worst(&mut (0..left.len()).filter(is_written)).or_else(|| worst(&mut (0..left.len())))?;
        Some(Conflict::new(row, system, newton, work))
    }
}
