//! What a method keeps in every step, as data, and the judge that holds each step to it.
//!
//! Bounds follow from round-off and from the tolerance of the iteration, each from the sizes of the very terms that a figure is
//! a sum of: they are the same in every unit and for every mass.

use std::f64::consts::PI;

use super::Method;
use super::audit::Audit;
use crate::energy;
use crate::formulation::{Failure, Independence, Iteration, Level, Multipliers, RowsAt, Stage, Workspace, taken_of_turned};
use crate::linalg::largest;
use crate::projection::Solve;
use crate::system::{GaugeValues, System};

/// Something that holds after every step, whatever the mechanism and the step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Promise {
    /// The energy changes by the work that is done, and by nothing else.
    Energy,
    /// The energy rises by no more than the work that is done, where no row depends on time.
    FallingEnergy,
    /// The energy never exceeds that of the start by more than all that could have come of it and of work.
    SuppliedEnergy,
    /// Momenta that nothing outside changes.
    Momenta,
    /// Φ = 0
    Position,
    /// Φ̇ = 0
    Velocity,
    /// Φ̈ = 0
    Acceleration,
}

/// How many there are.
const PROMISES: usize = Promise::Acceleration as usize + 1;

impl Promise {
    /// What is kept, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Energy => "energy",
            Self::FallingEnergy => "energy that never rises",
            Self::SuppliedEnergy => "energy that something supplies",
            Self::Momenta => "momenta",
            Self::Position => "Φ",
            Self::Velocity => "Φ̇",
            Self::Acceleration => "Φ̈",
        }
    }
}

impl Method {
    /// What the method keeps in every step. With a fixed number of iterations that is nothing: whatever they leave is taken.
    pub fn promises(&self) -> Vec<Promise> {
        let (settings, projection) = (&self.settings, &self.projection);
        let mut kept = Vec::new();
        if settings.iterations.is_some() {
            return kept;
        }
        let goes_on = projection.velocity && !projection.shadow;
        let projects = projection.solve == Solve::Exact && projection.strength == 1.0;
        let is_exact = settings.iteration == Iteration::Newton && self.parameters.rows == RowsAt::End;
        let is_soft = matches!(settings.multipliers, Multipliers::Penalty(_));
        if self.integrator.conserves && is_exact && !is_soft {
            match goes_on {
                false => kept.extend([Promise::Energy, Promise::Momenta]),
                true if projection.is_by_mass() => kept.extend([Promise::FallingEnergy, Promise::Momenta]),
                true => (),
            }
        }
        if kept.is_empty() && !self.is_unstable {
            kept.push(Promise::SuppliedEnergy);
        }
        if projects && projection.position {
            kept.push(Promise::Position);
        }
        let is_at_position = settings.doubled || settings.level == Level::POSITION && !is_soft;
        if self.integrator.ends_on_rows && is_at_position && self.parameters.rows == RowsAt::End {
            kept.push(Promise::Position);
            if settings.doubled {
                kept.push(Promise::Velocity);
            }
        }
        if projects && projection.velocity {
            kept.push(Promise::Velocity);
        }
        if projects && projection.acceleration {
            kept.push(Promise::Acceleration);
        }
        kept
    }
}

/// Round-off that a figure may have, over the sizes of the terms that it is a sum of.
const ROUND_OFF: f64 = 256.0 * f64::EPSILON;

/// Rounding of a position, at the start and at the end of a step, over the size of the mechanism.
const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Rounding of a difference of sums, over these.
const SUMMED: f64 = 2.0 * f64::EPSILON;

/// Share of the kinetic energies at its ends and of the work that a nominal step may be off by, however many parts it was taken in.
const WHOLE: f64 = 1e-10;

/// The same of the potential energy and of the weight times the size of the mechanism, which may be far more than what moves.
const WEIGHED: f64 = 1e-12;

/// What moves by so little of the mechanism's size in a nominal step stands still.
const STILL: f64 = 1e-12;

/// Energy of nothing over all there was to move from which on nothing is left of a motion: as much as there is.
const SUPPLY: f64 = 1.0;

/// The same of energy that went nowhere, where the method damps nothing.
const LOST: f64 = 0.5;

/// Most energy that dampers may make in a step, over all that could move before it.
const MADE: f64 = 0.01;

/// Angles turn by at most so much in a step, rad, where steps are divided: schemes of order 2 lag by a twelfth of its cube.
const FARTHEST: f64 = 1.0;

/// How much farther from the solution than the iteration's tolerance a step may end: that is an estimate.
const TOLERANCES: f64 = 16.0;

/// Holds steps to what a method promises.
pub(super) struct Judge {
    /// Whether each promise is one of them.
    promises: [bool; PROMISES],
    /// Whether there are dampers to look at.
    looks_at_dampers: bool,
    /// Whether the method has those take their rates later that would turn a motion round: those do that keep the energy.
    damps_late: bool,
    /// Whether the method takes energy out of what is fast for its steps.
    damps: bool,
    /// Tolerance of the iteration, over the size of the mechanism.
    tolerance: f64,
    /// All mass that moves, kg, or what stands in for it where there is none.
    mass: f64,
    /// All weight, N.
    weight: f64,
    /// Farthest that an angle may turn in a step, rad.
    farthest: f64,
    /// Largest size of what rounded positions make of energies in the parts of the nominal step so far, J.
    stiffest: f64,
    /// Length of the shortest of these parts, s.
    shortest: f64,
    /// Measures how near a singular position is, from when that is first asked, and how many rows are redundant everywhere, as far as is known.
    independence: Option<(Box<Independence>, usize)>,
}

impl Judge {
    pub(super) fn new(system: &System, method: &Method, work: &Workspace) -> Self {
        let is_absolute = method.settings.iteration != Iteration::Newton;
        let tolerance = method.settings.tolerance / if is_absolute { work.scales.length } else { 1.0 };
        let moving: f64 = (0..system.free).map(|node| system.mass.diagonal(node)).sum();
        // Where nothing that moves has a mass, rows are solved for as if it had this one, and their round-off is that of this mass.
        let mass = moving.max(work.scales.heaviest);
        let weight = work.forces.weight.iter().map(|w| w.abs()).sum();
        let mut promises = method.promises();
        let damps_late = [Promise::Energy, Promise::FallingEnergy].iter().any(|kept| promises.contains(kept));
        let has_dampers = system.laws.iter().any(|law| !law.law.conservative());
        let looks_at_dampers = has_dampers && method.settings.iterations.is_none();
        // Where rows move, the impulse that projects velocities does work.
        for promise in promises.iter_mut().filter(|promise| **promise == Promise::FallingEnergy && system.is_driven()) {
            *promise = Promise::SuppliedEnergy;
        }
        let farthest = if method.subdivide { FARTHEST } else { PI };
        let (stiffest, shortest) = (0.0, f64::INFINITY);
        let tolerance = TOLERANCES * tolerance;
        // What projections take they have the integrator take, too, in steps that are long.
        let damps = method.integrator.damps || method.projection.velocity;
        let mut kept = [false; PROMISES];
        promises.iter().for_each(|promise| kept[*promise as usize] = true);
        Self {
            promises: kept,
            looks_at_dampers,
            damps_late,
            damps,
            tolerance,
            mass,
            weight,
            farthest,
            stiffest,
            shortest,
            independence: None,
        }
    }

    fn promises(&self, promise: Promise) -> bool {
        self.promises[promise as usize]
    }

    /// Whether the method promises anything of the energy.
    pub(super) fn holds_energy(&self) -> bool {
        self.promises(Promise::Energy) || self.promises(Promise::FallingEnergy)
    }

    /// Begins a nominal step.
    pub(super) fn begin_step(&mut self) {
        (self.stiffest, self.shortest) = (0.0, f64::INFINITY);
    }

    /// Takes note of a step of length `h` (s) that is taken, with the size of what rounded positions make of its energies, J.
    pub(super) fn take(&mut self, h: f64, of_places: f64) {
        self.stiffest = self.stiffest.max(of_places);
        self.shortest = self.shortest.min(h.abs());
    }

    /// Looks at the energy after a step of length `h` (s); `before` and `after` are the audits around it, `of_places` is the size of what
    /// rounded positions make of it, J.
    pub(super) fn energy(&self, h: f64, [before, after]: [&Audit; 2], of_places: f64, work: &Workspace) -> Result<(), Failure> {
        self.hold_energy([before.energy(), before.work], after, || self.energy_bound(h, [before, after], of_places, work))
    }

    /// The size of what laws make of rounded positions, and of what the forces that do work do along them, J: also where hardly anything moves.
    pub(super) fn of_places(&self, system: &System, work: &Workspace) -> f64 {
        if !self.holds_energy() {
            return 0.0;
        }
        let working = if work.is_worked_on() { energy::size_of_working_forces(system, work) } else { 0.0 };
        energy::size(system, work, &work.end.x) + working * work.scales.length
    }

    /// Looks at the energy after a nominal step, or so far, of length `h` (s): parts of it may each be round-off and add up to more.
    pub(super) fn whole(&self, h: f64, after: &Audit, of_places: f64, work: &Workspace) -> Result<(), Failure> {
        let before = after.start_of_step();
        let moved = after.kinetic_at_start_of_step() + (after.work - before[1]).abs();
        // Much may have acted in one part and not in those after it.
        let of_places = self.stiffest.max(of_places);
        self.hold_energy(before, after, || self.nothing(h, moved, after, work) + ROUND_OFF * of_places)
    }

    /// Looks after a nominal step of length `h` (s) at what energy nothing supplied. Shorter steps would only add more slowly to it.
    /// `known` is what was there to move farther on, where the step is inside a longer one.
    pub(super) fn supply(&self, h: f64, known: f64, after: &Audit, work: &Workspace) -> Result<(), Failure> {
        if !self.promises(Promise::SuppliedEnergy) {
            return Ok(());
        }
        let [excess, supply] = after.supply();
        let supply = supply.max(known);
        let moved = STILL * work.scales.length / h.abs();
        let nothing = self.mass * moved * moved + self.nothing(h, 0.0, after, work) + self.still(work);
        // What sets off in this step has its energy of forces that may have jumped at its end, where their work is not seen: the next step shows it.
        let sets_off = work.is_worked_on() && after.kinetic_at_start_of_step() <= nothing;
        let lost = -after.made_by_integrator();
        if !self.damps && lost > LOST * supply + nothing && !sets_off {
            return Err(Failure::Vanished { lost, supply });
        }
        // What is no number is no energy.
        match excess <= SUPPLY * supply + nothing || (sets_off && excess.is_finite()) {
            true => Ok(()),
            false => Err(Failure::Unsupplied { excess, supply }),
        }
    }

    /// Looks after a step of length `h` (s) at the times `t` (s) whether it turned round what strong dampers would have stopped, or where the method has them
    /// take their rates later, whether these have made energy; `before` and `after` are the audits around it.
    pub(super) fn dampers(
        &self,
        system: &System,
        (t, h): ([f64; 2], f64),
        [before, after]: [&Audit; 2],
        stage: &Stage,
        work: &Workspace,
    ) -> Result<(), Failure> {
        if !self.looks_at_dampers {
            return Ok(());
        }
        let nothing = || self.nothing(h, 0.0, after, work) + self.still(work);
        if self.damps_late {
            let [_, supply] = before.supply();
            return match energy::made_by_dampers(system, stage, work) {
                (made, Some(law)) if made > MADE * supply + nothing() => Err(Failure::Driving { law, made, supply }),
                _ => Ok(()),
            };
        }
        let [_, supply] = after.supply();
        match taken_of_turned(system, t, h, work) {
            (taken, Some(law)) if taken > SUPPLY * supply + nothing() => Err(Failure::Ringing { law, taken, supply }),
            _ => Ok(()),
        }
    }

    /// Energy of all weight over a length (m), J.
    pub(super) fn lift(&self, length: f64) -> f64 {
        self.weight * length
    }

    /// Energy of all mass at a speed (m/s), J.
    pub(super) fn motion(&self, speed: f64) -> f64 {
        0.5 * self.mass * speed * speed
    }

    /// Energy of what stands still as far as steps by accuracy tell, J: it comes on in the whole run by no more than its error may be. Steps that are as
    /// long as their errors allow need not damp it.
    pub(super) fn still(&self, work: &Workspace) -> f64 {
        self.motion(work.estimate.allowed * work.scales.length)
    }

    /// Energy that is nothing beside the energies after a nominal step of length `h` (s), J; `more` are others beside them.
    fn nothing(&self, h: f64, more: f64, after: &Audit, work: &Workspace) -> f64 {
        let length = work.scales.length;
        // What velocities are rounded by is most of slow ones, and most after the shortest part.
        let trembling = self.of_change(after.kinetic + more, ROUNDED * length * 2.0 / h.abs().min(self.shortest));
        WHOLE * (after.kinetic + more) + WEIGHED * (after.potential.abs() + self.weight * length) + trembling
    }

    /// Size of what a rounding of velocities at some speed (m/s) makes of the energy where the kinetic one is `kinetic`, J.
    pub(super) fn of_speeds(&self, kinetic: f64, speed: f64) -> f64 {
        (self.most_momentum(kinetic) + self.mass * ROUNDED * speed) * speed
    }

    /// Most that velocities which are off by a speed (m/s) make of a kinetic energy, J: of slow ones most is its own.
    fn of_change(&self, kinetic: f64, speed: f64) -> f64 {
        (self.mass * speed + self.most_momentum(kinetic)) * speed
    }

    /// Most that Σ m |v| may be with a kinetic energy T: √(2 T Σ m), by Cauchy and Schwarz.
    fn most_momentum(&self, kinetic: f64) -> f64 {
        (2.0 * kinetic * self.mass).sqrt()
    }

    /// Looks at how far the angles turn that are measured at both ends of a step of length `h` (s).
    pub(super) fn turns(&self, system: &System, h: f64, from: &GaugeValues, to: &GaugeValues) -> Result<(), Failure> {
        match system.largest_turn(h, from, to) {
            Some((gauge, by)) if by > self.farthest => Err(Failure::Turned { gauge, by }),
            _ => Ok(()),
        }
    }

    /// Compares what the energy changes by without work, from the energy and the work `before` (J), with a bound (J).
    fn hold_energy(&self, before: [f64; 2], after: &Audit, bound: impl Fn() -> f64) -> Result<(), Failure> {
        let promised = [Promise::Energy, Promise::FallingEnergy].into_iter().find(|&promise| self.promises(promise));
        let Some(promise) = promised else { return Ok(()) };
        let change = (after.energy() - before[0]) - (after.work - before[1]);
        // Sums of long runs may be far more than what changes.
        let summed = before[0].abs() + before[1].abs() + after.energy().abs() + after.work.abs();
        let (off, bound) = (if promise == Promise::Energy { change.abs() } else { change }, bound() + SUMMED * summed);
        if off <= bound { Ok(()) } else { Err(Failure::Broken { promise: promise.words(), by: off, bound, row: None }) }
    }

    /// Round-off of energies, of the work of rows and laws, and of velocities, which are increments of rounded positions over
    /// the step; and what the tolerance leaves of these.
    fn energy_bound(&self, h: f64, [before, after]: [&Audit; 2], of_places: f64, work: &Workspace) -> f64 {
        let scales = &work.scales;
        let kinetic = before.kinetic.abs() + after.kinetic.abs();
        let rows = work.lambda.iter().zip(&scales.gradient).map(|(lambda, g)| (lambda * g).abs()).sum::<f64>() * scales.length;
        let sizes = kinetic + of_places + (after.work - before.work).abs() + rows;
        ROUND_OFF * sizes + self.of_change(kinetic, scales.length * 2.0 / h.abs() * (ROUNDED + self.tolerance))
    }

    /// Looks for corners of rows and laws that a step goes across.
    pub(super) fn corners(&self, system: &System, work: &Workspace) -> Result<(), Failure> {
        match system.corner([&work.start.at, &work.end.at]) {
            Some((of, what)) => Err(Failure::Corner { of, what }),
            None => Ok(()),
        }
    }

    /// Looks at Φ at the end of a step at the time `t` (s), in `phi`.
    pub(super) fn positions(&mut self, system: &System, t: f64, work: &mut Workspace) -> Result<(), Failure> {
        let length = work.scales.length * (ROUND_OFF + self.tolerance);
        if !self.promises(Promise::Position) || work.phi.iter().zip(&work.scales.gradient).all(|(phi, g)| phi.abs() <= g * length) {
            return Ok(());
        }
        work.size_rows(system);
        self.compare_near_singular(Promise::Position, work.scales.length, system, t, work)
    }

    /// Looks at Φ̇ at the end of a step of length `h` (s) at the time `t` (s), in `rows`.
    pub(super) fn velocities(&mut self, system: &System, t: f64, h: f64, work: &mut Workspace) -> Result<(), Failure> {
        let speed = largest(&work.end.v);
        let reach = ROUND_OFF * speed + self.tolerance * work.scales.length / h.abs();
        if !self.promises(Promise::Velocity) || work.rows.iter().zip(&work.scales.gradient).all(|(rate, g)| rate.abs() <= g * reach) {
            return Ok(());
        }
        std::mem::swap(&mut work.phi, &mut work.rows);
        work.size_rates(system);
        // What moves fast across a row errs along it by a rounding of its speed.
        work.rows.iter_mut().zip(&work.scales.gradient).for_each(|(size, g)| *size = size.max(g * speed));
        self.compare_near_singular(Promise::Velocity, work.scales.length / h.abs(), system, t, work)
    }

    /// Looks whether as many rows that hold velocities follow from others at the end of a step, where these do, as were `left_out` of it. Φ̇ is in `rows`.
    pub(super) fn followers(&self, left_out: &[u32], follow: &[u32], work: &Workspace) -> Result<(), Failure> {
        let row = left_out.iter().find(|row| !follow.contains(row)).map_or(0, |&row| row as usize);
        match follow.len() < left_out.len() {
            true => Err(Failure::Broken { promise: Promise::Velocity.words(), by: work.rows[row].abs(), bound: 0.0, row: Some(row) }),
            false => Ok(()),
        }
    }

    /// Looks at Φ̈ at the end of a step of length `h` (s), in `rows`.
    pub(super) fn accelerations(&self, h: f64, work: &Workspace) -> Result<(), Failure> {
        if !self.promises(Promise::Acceleration) {
            return Ok(());
        }
        let scales = &work.scales;
        let speed = largest(&work.end.v);
        let centripetal = speed * speed / (scales.shortest * scales.length);
        let reach = ROUND_OFF * (largest(&work.a) / scales.shortest + centripetal) + self.tolerance * scales.length / (h * h);
        let worst = work.rows.iter().zip(&scales.gradient).enumerate().find(|(_, (value, g))| !is_within(**value, *g * reach));
        match worst {
            None => Ok(()),
            Some((row, (value, g))) => {
                Err(Failure::Broken { promise: Promise::Acceleration.words(), by: value.abs(), bound: g * reach, row: Some(row) })
            }
        }
    }

    /// Compares as below, and with larger bounds near a singular position: there rounded positions are off by more in what hardly any
    /// row holds, and redundant rows show it.
    fn compare_near_singular(&mut self, promise: Promise, unit: f64, system: &System, t: f64, work: &mut Workspace) -> Result<(), Failure> {
        self.compare(promise, unit, work).or_else(|_| {
            let (independence, redundant) = self.independence.get_or_insert_with(|| {
                let mut independence = Box::new(Independence::new(system));
                let redundant = independence.count_redundant_at_start(system);
                (independence, redundant)
            });
            // Those that are redundant everywhere are the fewest.
            *redundant = (*redundant).min(independence.count_redundant(system, &work.end.x, &work.end.at.functions.angle, t));
            let amplified = independence.amplification(*redundant);
            work.rows.iter_mut().for_each(|size| *size *= amplified);
            self.compare(promise, unit, work)
        })
    }

    /// Compares the numbers of the rows in `phi` with the sizes of their terms in `rows`.
    fn compare(&self, promise: Promise, unit: f64, work: &Workspace) -> Result<(), Failure> {
        for (row, (number, size)) in work.phi.iter().zip(&work.rows).enumerate() {
            let bound = ROUND_OFF * size + self.tolerance * work.scales.gradient[row] * unit;
            if !is_within(*number, bound) {
                return Err(Failure::Broken { promise: promise.words(), by: number.abs(), bound, row: Some(row) });
            }
        }
        Ok(())
    }
}

/// Whether a number is at most so large; what is no number is not.
fn is_within(number: f64, bound: f64) -> bool {
    number.abs() <= bound
}
