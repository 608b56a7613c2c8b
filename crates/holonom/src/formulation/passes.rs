//! The linear system of accelerations and multipliers is solved in passes until the proximal δ no longer matters, and near singular positions what
//! is found is looked at twice (methods §17).

use super::failure::Failure;
use super::level::Level;
use super::rank::{REDUNDANT, RHO};
use super::standing::{CLEAR, ROUND_OFF, Standing, Sure, few, standing};
use super::workspace::Workspace;
use crate::linalg::{Solver, largest};
use crate::system::System;

/// Passes with a proximal δ; the first starts from the multipliers at hand and leaves δ of what they miss, the others are
/// for redundant rows.
const PASSES: usize = 3;

/// Where a row hardly differs from others δ is much of what it adds, and each pass leaves the same share of what is missed: after so many
/// passes more, all of it is added at once, as of a geometric series.
const MOST: usize = 15;

/// What is missed is added where it is more than this share of accelerations and of multipliers, and where a pass leaves less of it than this.
const MATTERS: f64 = 1e-11;
const SLOWEST: f64 = 0.999;

/// How many times smaller δ is where passes leave too much: rows that hardly differ add less than it does. What redundant rows make of round-off
/// grows as much.
pub(super) const STIFFER: f64 = 1e3;

/// Share of the accelerations that may be left open, and by what share of themselves velocities are off the rows that round-off makes of what stands
/// still.
const KNOWN: f64 = 1e-3;
const NOISE: f64 = 1e-5;

/// By what share of themselves velocities, and of the size of the mechanism places, are off the rows that no round-off makes.
const ASTRAY: f64 = 1e-10;

/// Share of the multipliers that a pass adds where they grow without end, and what rows may be missed by, over the accelerations, where redundant
/// ones differ from the others by what they are written with.
const GROWS: f64 = 0.01;
const MISSED: f64 = 1e-6;

/// How many times more the accelerations may be off than the velocities are off the rows, over what velocities make of either: what round-off makes of
/// what stands still is no motion, and no accelerations keep it on all rows.
const FOLLOWS: f64 = 100.0;

/// Passes end where the next would change less than this share of accelerations and multipliers: of those that a step goes on with, whose errors add
/// up, and of those that are shown.
const ROUNDED: f64 = 0.1 * f64::EPSILON;
const SHOWN: f64 = 1e-12;

/// What the one solution that is all there is may miss, over the accelerations that forces make: in a long chain what links miss adds up.
const MISSES: f64 = 16.0 * f64::EPSILON;

/// What accelerations and multipliers are for.
#[derive(Clone, Copy)]
pub(super) enum Purpose<'a> {
    /// A motion begins with them.
    Start,
    /// They are shown.
    Show(Option<&'a Sure>),
}

/// The matrix of the system.
pub(super) trait LinearSystem {
    /// Factors it at the evaluation of the end with the proximal δ = (G M⁻¹ Gᵀ)/ρ. Hands back what share of the multipliers a solution may leave.
    fn factor(&mut self, rho: f64, work: &Workspace) -> Result<f64, Failure>;

    /// Its factors.
    fn solver(&self) -> &Solver;

    /// What the rows that have unknowns of it add to those before them where it was last factored in order, with the δ of this ρ, over what they would
    /// add alone.
    fn shares(&self, rho: f64, work: &Workspace) -> impl Iterator<Item = f64>;

    /// Whether no part is light beside what holds it: a solution misses about as little of each.
    fn is_even(&self, work: &Workspace) -> bool;

    /// A right side of coordinates (n) and rows (r), or its solution.
    fn unknowns(&mut self) -> &mut [f64];

    /// Replaces the right side in the unknowns by the solution.
    fn solve(&mut self, system: &System, work: &Workspace) -> Result<(), Failure>;

    /// The largest acceleration, m/s², that the right side in the unknowns is of what it acts on.
    fn accelerates(&mut self, system: &System, work: &Workspace) -> f64;
}

/// Solves the system until δ no longer matters. Says whether accelerations are known: at a singular position none may meet all rows.
pub(super) fn meet(matrix: &mut impl LinearSystem, system: &System, t: f64, work: &mut Workspace) -> Result<bool, Failure> {
    work.sampled.copy_from(&work.end);
    let pushed = work.begin_pass(system, t);
    let leaves = matrix.factor(RHO, work)?;
    let mut end = passes(matrix, Passes { leaves, pushed, most: MOST, open: ROUNDED }, system, work)?;
    if end == End::Slow {
        let leaves = matrix.factor(STIFFER * RHO, work)?;
        end = passes(matrix, Passes { leaves, pushed, most: MOST, open: ROUNDED }, system, work)?;
    }
    work.add_reactions(system);
    Ok(is_met(end, system, t, work))
}

/// The same for forces that are to be trusted. Near a singular position accelerations are known where they
/// are the same, but for little, at another place that meets the rows as well as numbers can, with the velocities that belong to it.
pub(super) fn react(
    matrix: &mut impl LinearSystem,
    purpose: Purpose<'_>,
    system: &System,
    t: f64,
    work: &mut Workspace,
) -> Result<bool, Failure> {
    let level = std::mem::replace(&mut work.level, Level::ACCELERATION);
    let outcome = react_at_level(matrix, purpose, system, t, work);
    work.level = level;
    outcome
}

fn react_at_level<L: LinearSystem>(
    matrix: &mut L,
    purpose: Purpose<'_>,
    system: &System,
    t: f64,
    work: &mut Workspace,
) -> Result<bool, Failure> {
    if let Purpose::Show(None | Some(Sure::Redundant(_))) = purpose {
        meet_rows(matrix, system, t, work)?;
    }
    let pushed = work.sum_at_rest(system, t);
    // Rows of what spins fast ask for far too much along velocities that are off them a little, and redundant ones, which ask for the same along
    // velocities that meet them all, for different forces, without bounds.
    let strays = work.strays(system, t);
    // Of what is at rest velocities are round-off.
    let astray = Some(strays).filter(|strays| *strays > ASTRAY && strays * work.of_motion() > ROUNDED * pushed);
    if astray.is_none() {
        work.weigh_end_at_rest(system, t);
    }
    let standing = match purpose {
        Purpose::Show(Some(Sure::Independent(at_start))) => standing(at_start, matrix, work),
        _ => Standing::Unknown,
    };
    match standing {
        Standing::Sure if solves_at_once(matrix, (pushed, astray), system, t, work) => return Ok(true),
        Standing::Singular => return Ok(false),
        _ => {}
    }
    let mut is_near = standing == Standing::Near;
    let open = if let Purpose::Start = purpose { ROUNDED } else { SHOWN };
    let leaves = matrix.factor(RHO, work)?;
    if let Purpose::Show(Some(Sure::Redundant(at_start))) = purpose
        && !matrix.solver().has_exchanged()
    {
        if few(REDUNDANT, matrix, work) > *at_start {
            return Ok(false);
        }
        is_near = few(CLEAR, matrix, work) > *at_start;
    }
    let is_on_rows = astray.is_some() && follow_rows(matrix, [strays, 0.0], system, t, work)?;
    let mut end = passes(matrix, Passes { leaves, pushed, most: PASSES, open }, system, work)?;
    if end != End::Met && !is_on_rows && follow_rows(matrix, [strays, 0.0], system, t, work)? {
        work.a[..system.coordinates()].fill(0.0);
        work.lambda.fill(0.0);
        end = passes(matrix, Passes { leaves, pushed, most: PASSES, open }, system, work)?;
    }
    if end != End::Slow && !is_near {
        return Ok(is_met(end, system, t, work));
    }
    // What redundant rows make of round-off would be more than what is looked for.
    let is_stiffer = end == End::Slow || standing == Standing::Near;
    let leaves = matrix.factor(if is_stiffer { STIFFER * RHO } else { RHO }, work)?;
    let n = system.coordinates();
    let (x, v, at) = (work.end.x.clone(), work.end.v.clone(), work.end.at.clone());
    let solve = |matrix: &mut L, work: &mut Workspace| {
        let pushed = work.begin_pass(system, t);
        if is_near && astray.is_some() {
            follow_rows(matrix, [strays, 0.0], system, t, work)?;
        }
        work.lambda.fill(0.0);
        passes(matrix, Passes { leaves, pushed, most: MOST, open: ROUNDED }, system, work)
    };
    let outcome = move_by_rounding(matrix, system, t, work).and_then(|()| solve(matrix, work));
    (work.end.x, work.end.v, work.end.at) = (x, v, at);
    outcome?;
    let (others, other_forces) = (work.a[..n].to_vec(), work.lambda.clone());
    let end = solve(matrix, work)?;
    let differs = work.a[..n].iter().zip(&others).fold(0.0, |m: f64, (a, other)| m.max((a - other).abs()));
    let is_sure = differs <= KNOWN * largest(&work.a[..n]).max(pushed) || work.strays(system, t) > NOISE;
    // Large forces elsewhere hide what accelerations differ by; those of the rows that hardly hold show it.
    let pairs = work.lambda.iter().zip(&other_forces);
    let are_forces_sure = !is_near
        || work.scaled_multipliers(pairs.map(|(force, other)| force - other))
            <= KNOWN * work.scaled_multipliers(work.lambda.iter().copied());
    Ok(is_met(end, system, t, work) && is_sure && are_forces_sure)
}

/// Solves the system with the factors at hand, which have hardly any δ. `pushed` is how fast forces make what they push most, m/s², and `astray` the
/// share that velocities are off the rows by, where they are. Says whether what is missed is round-off; where not, nothing is found.
fn solves_at_once(
    matrix: &mut impl LinearSystem,
    (pushed, astray): (f64, Option<f64>),
    system: &System,
    t: f64,
    work: &mut Workspace,
) -> bool {
    let is_followed = astray.is_none_or(|strays| follow_rows(matrix, [strays, ROUND_OFF], system, t, work).is_ok());
    let of = Passes { leaves: 0.0, pushed, most: MOST, open: SHOWN };
    let is_solved = is_followed && passes(matrix, of, system, work) == Ok(End::Met);
    if !is_solved {
        work.a[..system.coordinates()].fill(0.0);
        work.lambda.fill(0.0);
    }
    is_solved
}

/// Whether accelerations are known where passes ended so.
fn is_met(end: End, system: &System, t: f64, work: &mut Workspace) -> bool {
    if end == End::Met {
        return true;
    }
    let strays = work.strays(system, t);
    let [missed, of_all, of_velocities] = work.misses(system, t);
    (end == End::Grows || strays > NOISE) && missed <= (MISSED * of_all).max(FOLLOWS * strays * of_velocities)
}

/// Takes the rows along the velocities nearest to those at the end, which are off the rows by the share `strays`, that meet them but for the share
/// `open`; forces stay as they are. Says whether there are such: beside a singular position they may be too far away, and rows are taken along
/// the velocities as they are.
fn follow_rows(
    matrix: &mut impl LinearSystem,
    [strays, open]: [f64; 2],
    system: &System,
    t: f64,
    work: &mut Workspace,
) -> Result<bool, Failure> {
    work.kept_v.copy_from_slice(&work.end.v);
    let outcome = meet_rates(matrix, open, system, t, work);
    let moved = work.end.v.iter().zip(&work.kept_v).fold(0.0, |m: f64, (v, before)| m.max((v - before).abs()));
    let are_near = outcome.is_ok() && moved <= FOLLOWS * strays * largest(&work.kept_v);
    if !are_near {
        work.end.v.copy_from_slice(&work.kept_v);
    }
    work.weigh_end_at_rest(system, t);
    work.end.v.copy_from_slice(&work.kept_v);
    outcome.map(|()| are_near)
}

/// Moves places at the end that are off the rows onto them: there alone redundant rows ask for the same. Beside them they ask for forces without bounds,
/// and methods that let places drift, or hold them by springs, are there.
fn meet_rows(matrix: &mut impl LinearSystem, system: &System, t: f64, work: &mut Workspace) -> Result<(), Failure> {
    for _ in 0..PASSES {
        let Workspace { end, rows, .. } = &mut *work;
        system.constraint_values(&end.at, t, rows);
        if work.scaled(&work.rows) <= ASTRAY * work.scales.length {
            return Ok(());
        }
        matrix.factor(RHO, work)?;
        let change = correction(matrix, system, work)?;
        work.end.x.iter_mut().zip(change).for_each(|(x, change)| *x += change);
        system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
    }
    Ok(())
}

/// Moves the places at the end to others that meet the rows as well as numbers can, and the velocities onto the rows there.
fn move_by_rounding(matrix: &mut impl LinearSystem, system: &System, t: f64, work: &mut Workspace) -> Result<(), Failure> {
    work.miss_by_rounding(system, t);
    let change = correction(matrix, system, work)?;
    work.end.x.iter_mut().zip(change).for_each(|(x, change)| *x += change);
    system.evaluate(&work.end.x, t, &work.start.at, &mut work.end.at);
    meet_rates(matrix, 0.0, system, t, work)
}

/// Moves the velocities at the end onto the rows, with the factors at hand, until they are off them by no more than the share `open`.
fn meet_rates(matrix: &mut impl LinearSystem, open: f64, system: &System, t: f64, work: &mut Workspace) -> Result<(), Failure> {
    for _ in 0..PASSES {
        if work.strays(system, t) <= open {
            break;
        }
        let change = correction(matrix, system, work)?;
        work.end.v.iter_mut().zip(change).for_each(|(v, change)| *v += change);
    }
    Ok(())
}

/// The smallest change of the coordinates (n), in the metric of the mass, that takes back what stands in `rows`.
fn correction<'m>(matrix: &'m mut impl LinearSystem, system: &System, work: &Workspace) -> Result<&'m [f64], Failure> {
    let (change, rows) = matrix.unknowns().split_at_mut(system.coordinates());
    change.fill(0.0);
    rows.iter_mut().zip(&work.rows).for_each(|(row, by)| *row = -by);
    matrix.solve(system, work)?;
    Ok(&matrix.unknowns()[..system.coordinates()])
}

/// How passes end.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    Met,
    /// Multipliers grow in each pass, as rows ask for what the others do not leave.
    Grows,
    /// What is missed becomes less too slowly to be known.
    Slow,
}

/// Passes with the factors at hand.
#[derive(Clone, Copy)]
struct Passes {
    /// What share of the multipliers a solution leaves.
    leaves: f64,
    /// How fast forces but those of the rows would make what they push most, m/s²: what is little beside it is round-off where nothing moves.
    pushed: f64,
    /// How many there may be.
    most: usize,
    /// What share of accelerations and multipliers may be left open.
    open: f64,
}

fn passes(matrix: &mut impl LinearSystem, of: Passes, system: &System, work: &mut Workspace) -> Result<End, Failure> {
    let natural = of.pushed.max(work.of_motion());
    // What hardly moves is not to be known better than what forces and motion make, but where rows hardly hold it.
    let least = if of.leaves == 0.0 { natural } else { 0.0 };
    let (mut before, mut is_summed) = ([f64::INFINITY; 2], false);
    for count in 1..=of.most {
        if !std::mem::take(&mut is_summed) {
            work.sum_reactions(system, matrix.unknowns());
        }
        let [taken, whole] = take_up(matrix, system, work)?;
        let sizes = [whole[0].max(least), whole[1]];
        let is_met = if of.leaves == 0.0 && count == 1 {
            // There is none before it to compare with: its residual tells, where no part is light.
            matrix.is_even(work) && {
                work.sum_reactions(system, matrix.unknowns());
                is_summed = true;
                matrix.accelerates(system, work) <= MISSES * sizes[0]
            }
        } else {
            (0..2).all(|k| taken[k] * (taken[k] / before[k]).max(of.leaves) <= of.open * sizes[k])
        };
        if is_met {
            return Ok(End::Met);
        }
        let share = taken[1] / before[1];
        before = taken;
        if count % PASSES == 0 {
            let is_slow = share.is_nan() || share >= SLOWEST;
            let matters = [whole[0].max(natural), whole[1]];
            if (0..2).any(|k| taken[k] <= MATTERS * matters[k]) {
                return Ok(if is_slow && taken[1] >= GROWS * whole[1] { End::Grows } else { End::Met });
            }
            if is_slow {
                return Ok(End::Slow);
            }
            let rest = share / (1.0 - share);
            let (steps, multipliers) = matrix.unknowns().split_at(system.coordinates());
            work.a.iter_mut().zip(steps).for_each(|(a, step)| *a += rest * step);
            work.lambda.iter_mut().zip(multipliers).for_each(|(lambda, step)| *lambda += rest * step);
            before = [f64::INFINITY; 2];
        }
    }
    Ok(End::Slow)
}

/// Solves for what accelerations and multipliers miss, and adds it: the largest of that, and of all there is then, of accelerations and of
/// multipliers.
pub(super) fn pass(matrix: &mut impl LinearSystem, system: &System, work: &mut Workspace) -> Result<[[f64; 2]; 2], Failure> {
    work.sum_reactions(system, matrix.unknowns());
    take_up(matrix, system, work)
}

/// The same of what is missed that stands in the unknowns.
fn take_up(matrix: &mut impl LinearSystem, system: &System, work: &mut Workspace) -> Result<[[f64; 2]; 2], Failure> {
    let n = system.coordinates();
    matrix.solve(system, work)?;
    let (steps, multipliers) = matrix.unknowns().split_at(n);
    work.a.iter_mut().zip(steps).for_each(|(a, step)| *a += step);
    work.lambda.iter_mut().zip(multipliers).for_each(|(lambda, step)| *lambda += step);
    let taken = [largest(steps), work.scaled_multipliers(multipliers.iter().copied())];
    Ok([taken, [largest(&work.a[..n]), work.scaled_multipliers(work.lambda.iter().copied())]])
}

impl Workspace {
    /// Sums forces and rows at the end, without accelerations. Hands back how fast the forces would make the node that they push most, m/s²,
    /// where light ones weigh as what holds them.
    pub(super) fn begin_pass(&mut self, system: &System, t: f64) -> f64 {
        self.weigh_end_at_rest(system, t);
        self.sum_at_rest(system, t)
    }

    /// The same without the rows.
    fn sum_at_rest(&mut self, system: &System, t: f64) -> f64 {
        self.a[..system.coordinates()].fill(0.0);
        // The end is looked at in the place of the sampled state.
        std::mem::swap(&mut self.sampled, &mut self.end);
        self.sum_applied_anew(system, t);
        std::mem::swap(&mut self.sampled, &mut self.end);
        self.accelerates(system, &self.forces.sum)
    }

    /// How fast forces at the end but those of the rows, each by its size, would make the free node that they push most, and weights alone, m/s².
    pub fn pushed_at_end(&mut self, system: &System, t: f64) -> [f64; 2] {
        let rows = vec![0.0; self.lambda.len()];
        let lambda = std::mem::replace(&mut self.lambda, rows);
        std::mem::swap(&mut self.sampled, &mut self.end);
        self.sum_applied_anew(system, t);
        let pushed = self.pushed_at_most(system);
        std::mem::swap(&mut self.sampled, &mut self.end);
        self.lambda = lambda;
        [pushed, self.farthest(system, &self.forces.weight[..system.coordinates()])]
    }

    /// Leaves the rows at the end, without accelerations, in `phi`.
    fn weigh_end_at_rest(&mut self, system: &System, t: f64) {
        std::mem::swap(&mut self.sampled, &mut self.end);
        self.weigh_levels_at_rest(system, t, 1.0);
        std::mem::swap(&mut self.sampled, &mut self.end);
    }

    /// Leaves the violation of the rows, and as much more or less as rounding leaves of places, in `rows`.
    fn miss_by_rounding(&mut self, system: &System, t: f64) {
        let Self { end, scales, rows, .. } = self;
        system.constraint_values(&end.at, t, rows);
        for (k, (row, gradient)) in rows.iter_mut().zip(&scales.gradient).enumerate() {
            // No combination of rows is left out by the same signs in turn.
            let sign = if k.is_power_of_two() { -1.0 } else { 1.0 };
            *row += sign * f64::EPSILON * gradient * scales.length;
        }
    }

    /// How fast forces would make the node that they push most, m/s², where light ones weigh as what holds them.
    pub(super) fn accelerates(&self, system: &System, forces: &[f64]) -> f64 {
        let nodes = forces.chunks_exact(system.dim).zip(&self.scales.held);
        nodes.map(|(force, held)| held * largest(force)).fold(0.0, f64::max)
    }

    /// Size of the accelerations that motion asks for, v²/L, m/s²: what is little beside it is round-off where nothing pushes.
    fn of_motion(&self) -> f64 {
        largest(&self.end.v).powi(2) / self.scales.length
    }

    /// By how much the accelerations miss the rows, the size of both, and of what velocities have part in it.
    fn misses(&mut self, system: &System, t: f64) -> [f64; 3] {
        let of_motion = self.of_motion();
        let Self { phi, rows, a, end, .. } = self;
        rows.copy_from_slice(phi);
        system.slots.add_along(system.dim, 1.0, &end.at.gradient, a, rows);
        let missed = self.scaled(&self.rows);
        let of_all = self.scaled(&self.phi) + largest(&self.a[..system.coordinates()]) + of_motion;
        let Self { phi, rows, end, turned, kept_v: at_rest, .. } = self;
        at_rest.fill(0.0);
        system.constraint_curvatures(&end.at, &end.x, at_rest, t, &mut turned.half, rows);
        rows.iter_mut().zip(phi).for_each(|(row, phi)| *row = *phi - *row);
        [missed, of_all, self.scaled(&self.rows) + of_motion]
    }

    /// By how much the velocities at the end are off the rows, over their size; nothing where there are none.
    fn strays(&mut self, system: &System, t: f64) -> f64 {
        self.rate_violation(system, t);
        (self.scaled(&self.rows) / largest(&self.end.v)).max(0.0)
    }

    /// Leaves minus M a + f + Gᵀλ at the end and minus the rows, `phi` and what the accelerations add to it, in the unknowns, where the forces f
    /// are without λ.
    pub(super) fn sum_reactions(&mut self, system: &System, unknowns: &mut [f64]) {
        let Self { full, forces, end, .. } = self;
        let (accelerated, rows) = unknowns.split_at_mut(system.coordinates());
        full.copy_from_slice(&forces.sum);
        if self.lambda.iter().any(|lambda| *lambda != 0.0) {
            system.slots.add_forces(system.dim, &self.lambda, &end.at.gradient, full);
        }
        rows.iter_mut().zip(&self.phi).for_each(|(row, phi)| *row = -phi);
        // The first pass begins without accelerations.
        if self.a.iter().all(|a| *a == 0.0) {
            accelerated.iter_mut().zip(full).for_each(|(sum, force)| *sum = -*force);
            return;
        }
        system.mass.times(system.dim, &self.a, accelerated);
        accelerated.iter_mut().zip(full).for_each(|(sum, force)| *sum = -(*sum + *force));
        system.slots.add_along(system.dim, -self.level.acceleration, &end.at.gradient, &self.a, rows);
    }

    /// Adds Gᵀλ to the forces without it.
    pub(super) fn add_reactions(&mut self, system: &System) {
        system.slots.add_forces(system.dim, &self.lambda, &self.end.at.gradient, &mut self.forces.sum);
    }
}
