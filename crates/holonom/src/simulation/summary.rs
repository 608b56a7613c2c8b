//! The summary of a run: the keys of `summary.json`.

use serde::{Deserialize, Serialize};

use super::doubts::{Stray, Touch};
use super::{Happening, Simulation};
use crate::linalg::largest;

/// Everything a run is judged by. Keys are stable; additions are allowed.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Name that the run was given; the command takes that of the model file.
    pub model: String,
    /// How the run was computed.
    pub method: MethodSummary,
    /// `"completed"` or `"stopped"`.
    pub status: String,
    /// Time the run reached when it stopped early, s.
    pub stopped_at: Option<f64>,
    /// Why it stopped, in words; `None` when completed.
    pub reason: Option<String>,
    /// Nominal step, s.
    pub step: f64,
    /// Time the run was asked to reach, s.
    pub end: f64,
    /// The event that ended the run before, if one did.
    pub ended_by: Option<String>,
    /// Events in their order.
    pub events: Vec<Happening>,
    /// Nominal steps taken.
    pub steps: u64,
    /// How many unknowns and conditions it had.
    #[serde(flatten)]
    pub size: ModelSize,
    /// What became of the energy.
    pub energy: EnergySummary,
    /// What became of the momenta that nothing outside changes.
    pub momentum: MomentumSummary,
    /// How far it was off its constraints.
    pub violation: ViolationSummary,
    /// What it took.
    pub work: WorkSummary,
}

/// The method of a run, in the words of `[simulation]`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MethodSummary {
    /// A method that has a name, or its parts joined by strokes, such as `lagrange-2/bdf-3/velocity`.
    pub name: String,
    /// Without its index, such as `lagrange`.
    pub formulation: String,
    /// Differentiation index of the formulation, 0 … 3.
    pub index: u8,
    /// Without its order, such as `bdf`.
    pub integrator: String,
    /// Order of the integrator; the highest one where it changes from step to step.
    pub order: u8,
    /// `newton`, `simultaneous` or `nested`.
    pub iteration: String,
    /// Error of positions that steps were chosen for.
    pub accuracy: Option<f64>,
    /// What was projected after each step, and how.
    pub projection: ProjectionSummary,
}

/// The projections of a run (10)–(13), in the words of `[simulation.projection]`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ProjectionSummary {
    /// `velocity`, `acceleration`, both or none.
    pub levels: Vec<String>,
    /// The metric A: `mass`, `identity`, `tangent` or `custom`.
    pub matrix: String,
    /// `exact` or `penalty`.
    pub solve: String,
}

/// Unknowns and conditions of a system, ranked at one position.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ModelSize {
    /// n: coordinates of the free nodes.
    pub coordinates: usize,
    /// r: constraint rows.
    pub constraints: usize,
    /// Independent constraint rows.
    pub rank: usize,
    /// Constraint rows that follow from the others: r less the rank.
    pub redundant: usize,
    /// Degrees of freedom: n less the rank.
    pub dof: usize,
}

/// The balance of the energy E over a run, all in J.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct EnergySummary {
    /// E at the start.
    pub initial: f64,
    /// E at the end of the run.
    #[serde(rename = "final")]
    pub last: f64,
    /// max |E(t) − E(0) − work done on the system|
    pub max_drift: f64,
    /// Largest rise of E in one step beyond the work done in it.
    pub max_rise: f64,
    /// ΣΔE_i: what the integrator made or lost of itself (21).
    pub integrator_total: f64,
    /// ΣΔE_p: what the projections made or lost (29).
    pub projection_total: f64,
    /// Work that loads, dampers and drives did on the system.
    pub work_total: f64,
    /// |E(end) − E(0) − work − ΣΔE_i − ΣΔE_p|
    pub audit_residual: f64,
}

/// How well momenta are kept; zero in directions in which something outside acts.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct MomentumSummary {
    /// Largest change of linear momentum, kg·m/s, in directions in which nothing outside acts.
    pub linear_drift: f64,
    /// Largest change of angular momentum about the origin, kg·m²/s, about axes about which nothing outside acts.
    pub angular_drift: f64,
}

/// Largest 2-norm of all rows over the run, in their units.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct ViolationSummary {
    /// ‖Φ‖
    pub position: f64,
    /// ‖Φ̇‖, after projections.
    pub velocity: f64,
    /// ‖Φ̈‖, after projections, where the integrator takes its forces.
    pub acceleration: f64,
}

/// Counts of what a run took.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct WorkSummary {
    /// Steps of the integrator: more than the nominal ones where these were taken in parts, fewer with dense output.
    pub steps_taken: u64,
    /// Newton iterations, those of failed and rejected attempts included.
    pub iterations: u64,
    /// The same over the nominal steps, or over those taken where an accuracy chooses them.
    pub iterations_per_step: f64,
    /// Factorisations of the matrix of a step, those of projections, failed and rejected attempts included.
    pub factorizations: u64,
    /// Attempts that were taken back: failed ones that were halved, and those that erred by more than the accuracy.
    pub rejected_steps: u64,
}

/// Share of its length by which a mechanism that stands about still comes on in a run.
const STILL: f64 = 1e-6;

/// Share of the largest velocity of a run that velocities off their constraints are told from at its end.
const AT_REST: f64 = 1e-3;

/// Share of the largest size of a force that is small.
const SMALL: f64 = 0.1;

/// Share of energies that is round-off of a run.
const ROUNDED: f64 = 1e-9;

/// What rounding leaves of positions, over the size of the mechanism, as multipliers show it: these change by it over the square of the step.
const NOISE: f64 = 256.0 * f64::EPSILON;

impl Simulation {
    /// Size of the mechanism at its start, m: what circles are small beside.
    pub fn length(&self) -> f64 {
        self.work.scales.length
    }

    /// The constraint that positions were farthest off so far, how far, m, and which share of the mechanism's size that is; nothing where the method
    /// holds them.
    pub fn strayed(&self) -> Option<(&str, f64, f64)> {
        let Stray { row, way } = self.audit.farthest()?;
        Some((self.system.row_names().get(row)?.as_str(), way, way / self.work.scales.length))
    }

    /// The constraint that velocities were farthest off so far, by how much, m/s, and which share of the largest velocity that is; nothing where the
    /// method holds them, and where the mechanism stands about still.
    pub fn slipped(&self) -> Option<(&str, f64, f64)> {
        let ([farthest, _], fastest) = self.audit.slipped()?;
        self.slip(farthest, fastest, fastest)
    }

    /// The same of the last step and of the largest velocity after it, or of what is missing of a drive's where all else stands. What comes to rest may
    /// go on to swing off its constraints, and no more than that; nothing where that is little beside the largest velocity so far.
    pub fn slips(&self) -> Option<(&str, f64, f64)> {
        let ([_, last], fastest) = self.audit.slipped()?;
        self.slip(last, largest(self.velocities()).max(last.way), fastest).filter(|(_, off, _)| *off > AT_REST * fastest)
    }

    fn slip(&self, Stray { row, way: off }: Stray, velocity: f64, fastest: f64) -> Option<(&str, f64, f64)> {
        let moves = fastest * self.state.t.abs() > STILL * self.work.scales.length;
        moves.then_some((self.system.row_names().get(row)?.as_str(), off, off / velocity))
    }

    /// What the method has made of the energy so far, below zero where it has lost it, and all there was to move, J; nothing made where the
    /// mechanism stands about still, or that is round-off.
    pub fn made_energy(&self) -> [f64; 2] {
        let (made, [_, supply]) = (self.audit.made(), self.audit.supply());
        [if made.abs() > self.nothing() { made } else { 0.0 }, supply]
    }

    /// By how much the work that a step between positions books of forces without a potential may be another, J, as Simpson's rule has it with their
    /// power at the ends of steps too; all there was to move, J; and the name of the force that differs most. Nothing where that is round-off.
    pub fn unsure_work(&self) -> Option<(f64, f64, &str)> {
        let (unsure, number) = self.audit.unsure_work();
        let name = self.system.working_forces().nth(number)?;
        (unsure > self.nothing()).then(|| (unsure, self.audit.supply()[1], name))
    }

    /// Forces that begin and end to act with what moves, as those of contacts, and that equal steps have seen acting for a few steps only: of each that
    /// was largest then its name, when that was, s, and about how many steps it acted for. Their largest values may be far from those at the ends of
    /// steps. None where that is round-off, or small beside what the force was at other times.
    pub fn brief_forces(&self) -> Vec<(&str, f64, f64)> {
        let mut found: Vec<(&str, Touch)> = Vec::new();
        for (name, contact) in self.system.switching_forces().zip(&self.contacts) {
            let Some(touch) = contact.brief(SMALL).filter(|touch| touch.energy > self.nothing()) else { continue };
            match found.iter_mut().find(|(known, _)| *known == name) {
                Some((_, known)) if touch.force > known.force => *known = touch,
                Some(_) => (),
                None => found.push((name, touch)),
            }
        }
        found.into_iter().map(|(name, touch)| (name, touch.at, touch.steps)).collect()
    }

    /// Whether much of the kinetic energy is in vibrations of which equal steps of a method of order 2 pass a radian or more; not where the mechanism
    /// stands about still.
    pub fn is_hasty(&self) -> bool {
        self.method.order() <= 2 && self.audit.of_vibrations().is_some_and(|kinetic| kinetic > self.nothing())
    }

    /// Whether multipliers change from one of equal steps to the next by about as much as they are, and not by what rounded positions make of them: the step
    /// is above the method's limit, or above that of a vibration. Not where they always go to and fro, in which case the energy and velocities tell.
    pub fn is_restless(&self) -> bool {
        let length = self.work.scales.length;
        !self.method.is_unstable
            && self.audit.of_unrest().is_some_and(|pull| {
                let pull = pull - NOISE / self.step.powi(2);
                pull > 0.0 && self.judge.motion(1.0) * pull * length * length > self.nothing()
            })
    }

    /// Energy that is nothing beside what the mechanism has, J: where it stands about still, and round-off.
    fn nothing(&self) -> f64 {
        let length = self.work.scales.length;
        let still = self.judge.motion(STILL * length / self.state.t.abs());
        still + ROUNDED * (self.judge.lift(length) + self.audit.potential.abs() + self.audit.work.abs())
    }
}
