//! An observer that records a run: the columns of `trajectory.csv`.

use std::borrow::Cow;
use std::ops::Range;

use nalgebra::{Quaternion, UnitQuaternion};
use serde::{Deserialize, Serialize};
use smallvec::SmallVec;

use super::between::{Between, Bounds, Largest};
use super::measure::{Measures, RunningValue};
use super::{Channels, Heading, Recording};
use crate::simulation::{Divisions, Observer, Simulation, Verdict};
use crate::system::System;

/// The columns that every recording begins with.
pub const COLUMNS: [&str; 11] =
    ["t", "energy", "kinetic", "potential", "work", "dE_integrator", "dE_projection", "phi", "phi_dot", "phi_ddot", "iterations"];

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
    /// Steps seen, the start included.
    seen: u64,
    /// ΔE_i and ΔE_p since the last row, J, and those in it.
    since: [f64; 2],
    last: [f64; 2],
    /// Quaternions (w, x, y, z) of the bodies in the last row, of two signs the one near the row before.
    orientations: Vec<[f64; 4]>,
    /// Of each measure its running values.
    #[serde(default)]
    sums: Vec<Vec<RunningValue>>,
    /// The largest values of forces between the rows.
    #[serde(default)]
    between: Vec<Largest>,
    /// How far measures have gone.
    #[serde(default)]
    bounds: Vec<Bounds>,
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
pub struct Recorder<'a> {
    channels: Cow<'a, Channels>,
    every: u64,
    seen: u64,
    /// ΔE_i and ΔE_p since the last row, J.
    since: [f64; 2],
    last: [f64; 2],
    resumed: bool,
    /// Time of the step that was seen last, s.
    seen_at: f64,
    constraints: Constraints,
    measures: Measures,
    /// Where they are looked at beside the rows.
    divisions: Divisions,
    between: Between,
    orientations: Vec<UnitQuaternion<f64>>,
    /// Where the columns of accelerations and those of coordinates of joints are.
    accelerations: Range<usize>,
    coordinates: Range<usize>,
    /// Of each size the columns of its components.
    sizes: Vec<SmallVec<[usize; 3]>>,
    row: Vec<f64>,
    recording: Recording,
}

impl<'a> Recorder<'a> {
    /// Records channels of a system, and `constraints` where the simulation finds forces.
    pub fn new(channels: &'a Channels, system: &System, every: u64, constraints: Constraints) -> Self {
        Self::of(Cow::Borrowed(channels), system, every, constraints)
    }

    fn of(channels: Cow<'a, Channels>, system: &System, every: u64, constraints: Constraints) -> Self {
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
        Self {
            row: Vec::with_capacity(recording.columns().len()),
            orientations: vec![UnitQuaternion::identity(); channels.bodies.len()],
            channels,
            every: every.max(1),
            seen: 0,
            since: [0.0; 2],
            last: [0.0; 2],
            resumed: false,
            seen_at: f64::NAN,
            constraints,
            measures,
            divisions,
            between,
            accelerations,
            coordinates,
            sizes,
            recording,
        }
    }

    /// The same recorder with channels of its own, which goes wherever its simulation goes.
    pub fn into_owned(self) -> Recorder<'static> {
        Recorder { channels: Cow::Owned(self.channels.into_owned()), ..self }
    }

    /// Goes on from an earlier recording of the same model, where the run is resumed.
    pub fn resume(mut self, mark: &RecorderMark) -> Self {
        (self.seen, self.since, self.last, self.resumed) = (mark.seen, mark.since, mark.last, true);
        for (own, [w, x, y, z]) in self.orientations.iter_mut().zip(&mark.orientations) {
            *own = UnitQuaternion::new_unchecked(Quaternion::new(*w, *x, *y, *z));
        }
        for (own, sums) in self.measures.sums.iter_mut().zip(&mark.sums).filter(|(own, sums)| own.len() == sums.len()) {
            own.copy_from_slice(sums);
        }
        if mark.between.len() == self.between.largest.len() {
            self.between.largest.copy_from_slice(&mark.between);
        }
        if mark.bounds.len() == self.measures.bounds.len() {
            self.measures.bounds.copy_from_slice(&mark.bounds);
        }
        self
    }

    /// Appends to the rows that were recorded before, of a recording with the same columns; the row where the run was left is among them,
    /// and is not recorded once more.
    pub fn after(mut self, rows: Recording) -> Self {
        self.recording = rows;
        self
    }

    /// What a resumed recording goes on from.
    pub fn mark(&self) -> RecorderMark {
        let orientations = self.orientations.iter().map(|q| [q.w, q.i, q.j, q.k]).collect();
        let (sums, between, bounds) = (self.measures.sums.clone(), self.between.largest.clone(), self.measures.bounds.clone());
        RecorderMark { seen: self.seen, since: self.since, last: self.last, orientations, sums, between, bounds }
    }

    /// What was recorded so far.
    pub fn recording(&self) -> &Recording {
        &self.recording
    }

    /// Ends the recording.
    pub fn finish(mut self) -> Recording {
        (self.recording.between, self.recording.bounds) = (self.between.largest, self.measures.bounds);
        self.recording
    }

    /// Looks at how bodies are turned and at nothing else, so that the sign of their quaternions does not depend on when somebody looks at the rest.
    pub fn follow(&mut self, simulation: &Simulation) {
        self.channels.follow(simulation, &mut self.orientations);
    }

    /// The row of the present state, which is not kept. It counts as the row after the step before it; running values of measures follow from
    /// the rows that were looked at.
    pub fn look(&mut self, simulation: &Simulation) -> &[f64] {
        self.last = [simulation.audit().integrator, simulation.audit().projection];
        self.fill(simulation);
        &self.row
    }

    /// The same row where the recorder observes the run: running values of measures go on as if nobody had looked.
    pub fn look_beside_run(&mut self, simulation: &Simulation) -> &[f64] {
        let (sums, bounds) = (self.measures.sums.clone(), self.measures.bounds.clone());
        self.look(simulation);
        (self.measures.sums, self.measures.bounds) = (sums, bounds);
        &self.row
    }

    /// Whether a column is of the motion alone: energies, positions, velocities, coordinates of joints and their rates.
    pub fn is_of_motion(&self, place: usize) -> bool {
        place < self.accelerations.start || self.coordinates.contains(&place)
    }

    /// The columns that are [of the motion](Self::is_of_motion) in their places of the row, for which no forces need be found; the others
    /// are no numbers.
    pub fn look_at_motion(&mut self, simulation: &Simulation) -> &[f64] {
        self.last = [simulation.audit().integrator, simulation.audit().projection];
        self.fill_motion(simulation);
        self.row.resize(self.accelerations.end, f64::NAN);
        self.fill_coordinates(simulation);
        self.row.resize(self.recording.columns().len(), f64::NAN);
        &self.row
    }

    fn fill_motion(&mut self, simulation: &Simulation) {
        let (audit, state) = (simulation.audit(), simulation.state());
        self.row.clear();
        let lift = audit.lift;
        let [integrator, projection] = self.last;
        self.row.extend([state.t, audit.energy() + lift, audit.kinetic, audit.potential + lift, audit.work, integrator, projection]);
        self.row.extend([audit.phi, audit.phi_dot, audit.phi_ddot, audit.iterations as f64]);
        self.channels.motion(simulation, &mut self.orientations, &mut self.row);
    }

    fn fill_coordinates(&mut self, simulation: &Simulation) {
        let gauges = simulation.gauges();
        gauges.value.iter().zip(&gauges.rate).for_each(|(&value, &rate)| self.row.extend([value, rate]));
    }

    /// Puts together what is to be recorded of the present state.
    fn fill(&mut self, simulation: &Simulation) {
        self.fill_motion(simulation);
        if self.constraints != Constraints::Nothing {
            self.channels.accelerations(simulation, &mut self.row);
        }
        self.fill_coordinates(simulation);
        self.channels.forces(simulation, &mut self.row);
        self.row.extend_from_slice(&simulation.state().inputs);
        if self.constraints != Constraints::Nothing {
            self.channels.joint_forces(simulation, &mut self.row);
        }
        if self.constraints == Constraints::Rows {
            self.channels.multipliers(simulation, &mut self.row);
        }
        for components in &self.sizes {
            self.row.push(components.iter().map(|&k| self.row[k] * self.row[k]).sum::<f64>().sqrt());
        }
        self.measures.append(&mut self.row);
    }

    /// Records the end of a run at the time of the step that was seen last, in place of its row where there is one.
    fn replace_last(&mut self, simulation: &Simulation) {
        let is_there = self.recording.columns()[0].values.last() == Some(&self.seen_at);
        match is_there.then(|| self.recording.pop()).flatten() {
            Some(row) => self.between.see(&row[self.coordinates.end..], self.seen_at),
            None => self.last = std::mem::take(&mut self.since),
        }
        self.fill(simulation);
        self.recording.push(&self.row);
    }
}

impl Observer for Recorder<'_> {
    fn wants_forces(&self) -> bool {
        self.divisions == Divisions::Inside || self.seen.is_multiple_of(self.every)
    }

    fn divisions(&self) -> Divisions {
        self.divisions
    }

    fn at_division(&mut self, simulation: &Simulation) {
        if self.channels.measures.is_empty() {
            self.between.look(&self.channels.forces, simulation);
        } else {
            self.fill(simulation);
            self.between.see(&self.row[self.coordinates.end..], simulation.state().t);
        }
    }

    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        let before = std::mem::replace(&mut self.seen_at, simulation.state().t);
        if before == self.seen_at && simulation.ended_by().is_some() {
            self.replace_last(simulation);
            return Verdict::GoOn;
        }
        if std::mem::take(&mut self.resumed) {
            // Where the run was left, that row is the first once more, unless it is there.
            if self.recording.rows() == 0 && (self.seen.max(1) - 1).is_multiple_of(self.every) {
                self.fill(simulation);
                self.recording.push(&self.row);
            }
            return Verdict::GoOn;
        }
        self.since[0] += simulation.audit().integrator;
        self.since[1] += simulation.audit().projection;
        let is_kept = self.seen.is_multiple_of(self.every) || simulation.ended_by().is_some();
        if is_kept {
            self.last = std::mem::take(&mut self.since);
        }
        match is_kept {
            true => {
                self.fill(simulation);
                self.recording.push(&self.row);
            }
            false => self.at_division(simulation),
        }
        self.seen += 1;
        Verdict::GoOn
    }
}
