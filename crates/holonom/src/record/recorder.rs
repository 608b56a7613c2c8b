//! An observer that records a run: the columns of `trajectory.csv`.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::between::{Between, Bounds, Largest};
use super::composer::{Composer, Rows};
use super::measure::{Measures, RunningValue};
use super::sampler::{Sampler, SamplerMark, Samples};
use super::{Channels, Heading, Recording};
use crate::simulation::{Divisions, Observer, Simulation, Verdict};
use crate::system::System;

/// The columns that every recording begins with.
pub const COLUMNS: [&str; 11] =
    ["t", "energy", "kinetic", "potential", "work", "dE_integrator", "dE_projection", "phi", "phi_dot", "phi_ddot", "iterations"];

/// Numbers that there is room for before they are recorded. Room that is not used takes no memory, only addresses.
const ROOM: usize = 1 << 23;

/// Units and meanings of these.
pub(super) const MEANINGS: [(&str, &str); 11] = [
    ("s", "time"),
    ("J", "kinetic and potential energy"),
    ("J", "kinetic energy"),
    ("J", "potential energy"),
    ("J", "work done on the mechanism since the start"),
    ("J", "energy that the integrator has made since the last row"),
    ("J", "energy that projections have made since the last row"),
    ("1", "violation of the constraints, Euclidean norm of Φ"),
    ("1/s", "violation of their rates"),
    ("1/s²", "violation of their accelerations"),
    ("1", "iterations of the step"),
];

/// What a recording goes on from when a run is resumed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RecorderMark {
    #[serde(flatten)]
    pub(super) sampler: SamplerMark,
    /// Of each measure its running values.
    #[serde(default)]
    pub(super) sums: Vec<Vec<RunningValue>>,
    /// The largest values of forces between the rows.
    #[serde(default)]
    pub(super) between: Vec<Largest>,
    /// How far measures have gone.
    #[serde(default)]
    pub(super) bounds: Vec<Bounds>,
}

/// What is recorded of the forces of constraints, and of the accelerations, which are found with them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Constraints {
    /// Neither.
    Nothing,
    /// Accelerations, and force and moment of each joint.
    Joints,
    /// The multiplier of each row and the forces on points, too.
    Rows,
}

/// Records the start, every `every`-th step and nothing else. ΔE_i and ΔE_p of the steps between are summed into the
/// row that follows them, so that the columns add up whatever is left out.
pub struct Recorder {
    sampler: Sampler,
    rows: Rows,
    samples: Samples,
}

impl Recorder {
    /// Records channels of a system, and `constraints` where the simulation finds forces.
    pub fn new(channels: &Arc<Channels>, system: &System, every: u64, constraints: Constraints) -> Self {
        let of_sizes = channels.sizes(constraints);
        let sections = channels.sections(system, constraints, &of_sizes);
        // Where each section ends.
        let mut end = 0;
        let [_, motion, accelerated, moved, forced, inputs, ..] = sections.each_ref().map(|section| {
            end += section.len();
            end
        });
        let measured = channels.measures.iter().map(|measure| Heading::new(&measure.name, measure.unit.clone(), &*measure.meaning));
        let recording = Recording::new(sections.into_iter().flatten().chain(measured));
        let measures = Measures::new(&channels.measures, |name| recording.place(name));
        let (accelerations, coordinates) = (motion..accelerated, accelerated..moved);
        let between = Between::new(&channels.forces, &channels.axes);
        let (drives, joints) = (moved + between.columns()..forced, inputs..end);
        let divisions = match measures.divisions(&[accelerations.clone(), drives, joints]) {
            Divisions::Unseen if between.is_needed() => Divisions::Ends,
            divisions => divisions,
        };
        let place = |name: &String| recording.place(name).expect("components are recorded");
        let sizes = of_sizes.iter().map(|components| components.iter().map(place).collect()).collect();
        let sampler = Sampler::new(Arc::clone(channels), every, divisions, between.is_needed());
        let rows = Rows::new(Arc::clone(channels), constraints, [accelerations, coordinates], sizes, measures, between, recording);
        Self { sampler, rows, samples: Samples::default() }
    }

    /// Goes on from an earlier recording of the same model, where the run is resumed.
    pub fn resume(mut self, mark: &RecorderMark) -> Self {
        self.sampler.resume(&mark.sampler);
        self.rows.resume(mark);
        self
    }

    /// Appends to the rows that were recorded before, of a recording with the same columns; the row where the run was left is among them,
    /// and is not recorded once more.
    pub fn after(mut self, rows: Recording) -> Self {
        self.sampler.go_on_after(rows.columns()[0].values.last().copied());
        self.rows.recording = rows;
        self
    }

    /// Has room for so many rows more, up to some millions of numbers: columns that grow are moved again and again.
    pub fn expecting(mut self, rows: usize) -> Self {
        let recording = &mut self.rows.recording;
        recording.make_room(rows.min(ROOM / recording.columns().len()));
        self
    }

    /// What a resumed recording goes on from.
    pub fn mark(&self) -> RecorderMark {
        self.rows.mark(self.sampler.mark())
    }

    /// What was recorded so far.
    pub fn recording(&self) -> &Recording {
        &self.rows.recording
    }

    /// Ends the recording.
    pub fn finish(self) -> Recording {
        self.rows.finish()
    }

    /// Divides it into what samples states and what makes rows of the samples, which may be elsewhere by then, with what finds the forces
    /// of the constraints. Whole where rows have forces that only the simulation finds.
    pub fn divide(self, simulation: &mut Simulation) -> Result<(Sampler, Composer), Box<Self>> {
        let finder = simulation.lend_finder();
        if finder.is_none() && !self.rows.need_no_forces() {
            return Err(Box::new(self));
        }
        let Self { mut sampler, rows, .. } = self;
        sampler.is_for_finder = finder.is_some();
        Ok((sampler, Composer { rows, finder }))
    }

    /// Puts both together again; the simulation finds forces as before.
    pub fn join(mut sampler: Sampler, composer: Composer, simulation: &mut Simulation) -> Self {
        if let Some(finder) = composer.finder {
            simulation.take_back(finder);
        }
        sampler.is_for_finder = false;
        Self { sampler, rows: composer.rows, samples: Samples::default() }
    }

    /// Looks at how bodies are turned and at nothing else, so that the sign of their quaternions does not depend on when somebody looks at the rest.
    pub fn follow(&mut self, simulation: &Simulation) {
        self.sampler.follow(simulation);
    }

    /// The row of the present state, which is not kept. It counts as the row after the step before it; running values of measures follow from
    /// the rows that were looked at.
    pub fn look(&mut self, simulation: &Simulation) -> &[f64] {
        self.sampler.look(simulation, &mut self.samples);
        self.rows.compose(&self.samples.numbers, Some(simulation.found()));
        self.samples.clear();
        &self.rows.row
    }

    /// The same row where the recorder observes the run: running values of measures go on as if nobody had looked.
    pub fn look_beside_run(&mut self, simulation: &Simulation) -> &[f64] {
        let before = self.rows.measured();
        self.look(simulation);
        self.rows.go_back(before);
        &self.rows.row
    }

    /// Whether a column is of the motion alone: energies, positions, velocities, coordinates of joints and their rates.
    pub fn is_of_motion(&self, place: usize) -> bool {
        self.rows.is_of_motion(place)
    }

    /// The columns that are [of the motion](Self::is_of_motion) in their places of the row, for which no forces need be found; the others
    /// are no numbers.
    pub fn look_at_motion(&mut self, simulation: &Simulation) -> &[f64] {
        self.sampler.look_at_motion(simulation, &mut self.samples);
        self.rows.show_motion(&self.samples.numbers);
        self.samples.clear();
        &self.rows.row
    }

    /// Has rows made of what was sampled.
    fn compose(&mut self, simulation: &Simulation) {
        self.samples.iter().for_each(|(kind, sample)| self.rows.take(kind, sample, Some(simulation.found())));
        self.rows.settle();
        self.samples.clear();
    }
}

impl Observer for Recorder {
    fn wants_forces(&self) -> bool {
        self.sampler.wants_forces()
    }

    fn divisions(&self) -> Divisions {
        self.sampler.divisions()
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.sampler.at_division(simulation, &mut self.samples);
        self.compose(simulation);
    }

    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        self.sampler.after_step(simulation, &mut self.samples);
        self.compose(simulation);
        Verdict::GoOn
    }
}
