//! Rows of a recording, made of samples of states and of the forces of the constraints there.

use std::ops::Range;
use std::sync::Arc;

use smallvec::SmallVec;

use super::between::{Between, Bounds};
use super::measure::{Measures, RunningValue};
use super::sampler::{Kind, SamplerMark, Samples};
use super::{Channels, Constraints, RecorderMark, Recording};
use crate::simulation::{Checkpoint, Finder, Found};

/// Numbers of rows after which the recording takes them: they stay near the processor until then.
const NEAR: usize = 1 << 11;

/// Makes rows.
pub(super) struct Rows {
    channels: Arc<Channels>,
    constraints: Constraints,
    /// Where the columns of accelerations and those of coordinates of joints are.
    accelerations: Range<usize>,
    coordinates: Range<usize>,
    /// Of each size the columns of its components.
    sizes: Vec<SmallVec<[usize; 3]>>,
    measures: Measures,
    between: Between,
    pub row: Vec<f64>,
    /// Rows that the recording has not yet, one after the other.
    fresh: Vec<f64>,
    pub recording: Recording,
}

impl Rows {
    pub fn new(
        channels: Arc<Channels>,
        constraints: Constraints,
        [accelerations, coordinates]: [Range<usize>; 2],
        sizes: Vec<SmallVec<[usize; 3]>>,
        measures: Measures,
        between: Between,
        recording: Recording,
    ) -> Self {
        let row = Vec::with_capacity(recording.columns().len());
        Self { channels, constraints, accelerations, coordinates, sizes, measures, between, row, fresh: Vec::new(), recording }
    }

    pub fn resume(&mut self, mark: &RecorderMark) {
        for (own, sums) in self.measures.sums.iter_mut().zip(&mark.sums).filter(|(own, sums)| own.len() == sums.len()) {
            own.copy_from_slice(sums);
        }
        if mark.between.len() == self.between.largest.len() {
            self.between.largest.copy_from_slice(&mark.between);
        }
        if mark.bounds.len() == self.measures.bounds.len() {
            self.measures.bounds.copy_from_slice(&mark.bounds);
        }
    }

    pub fn mark(&self, sampler: SamplerMark) -> RecorderMark {
        let (sums, between, bounds) = (self.measures.sums.clone(), self.between.largest.clone(), self.measures.bounds.clone());
        RecorderMark { sampler, sums, between, bounds }
    }

    pub fn finish(mut self) -> Recording {
        (self.recording.between, self.recording.bounds) = (self.between.largest, self.measures.bounds);
        self.recording
    }

    /// Running values of measures and how far they have gone, to [go back](Self::go_back) to.
    pub fn measured(&self) -> (Vec<Vec<RunningValue>>, Vec<Bounds>) {
        (self.measures.sums.clone(), self.measures.bounds.clone())
    }

    pub fn go_back(&mut self, (sums, bounds): (Vec<Vec<RunningValue>>, Vec<Bounds>)) {
        (self.measures.sums, self.measures.bounds) = (sums, bounds);
    }

    pub fn is_of_motion(&self, place: usize) -> bool {
        place < self.accelerations.start || self.coordinates.contains(&place)
    }

    /// Puts a sample of the motion into its places.
    pub fn show_motion(&mut self, sample: &[f64]) {
        let (motion, coordinates) = sample.split_at(self.accelerations.start);
        self.row.clear();
        self.row.extend_from_slice(motion);
        self.row.resize(self.accelerations.end, f64::NAN);
        self.row.extend_from_slice(coordinates);
        self.row.resize(self.recording.columns().len(), f64::NAN);
    }

    /// Numbers of a sample that are no input.
    fn sampled(&self) -> usize {
        self.accelerations.start + self.coordinates.len() + self.between.columns()
    }

    /// Whether rows have nothing of the forces of constraints.
    pub fn need_no_forces(&self) -> bool {
        self.constraints == Constraints::Nothing && self.channels.told().efforts.is_empty()
    }

    /// Puts a row together of a sample, and of the forces of the constraints there, where they are found.
    pub fn compose(&mut self, sample: &[f64], found: Option<Found<'_>>) {
        let (t, sampled) = (sample[0], self.sampled());
        let Self { channels, constraints, row, .. } = self;
        let (motion, others) = sample[..sampled].split_at(self.accelerations.start);
        row.clear();
        row.extend_from_slice(motion);
        let of_constraints = found.filter(|_| *constraints != Constraints::Nothing);
        if let Some(found) = &of_constraints {
            channels.accelerations(found, row);
        }
        row.extend_from_slice(others);
        channels.efforts(found.as_ref(), t, row);
        row.extend_from_slice(&sample[sampled..sampled + channels.inputs.len()]);
        if let Some(found) = &of_constraints {
            channels.joint_forces(found, t, row);
            if *constraints == Constraints::Rows {
                channels.multipliers(found, row);
            }
        }
        for components in &self.sizes {
            row.push(components.iter().map(|&k| row[k] * row[k]).sum::<f64>().sqrt());
        }
        self.measures.append(row);
    }

    /// Does with a sample what it is for.
    pub fn take(&mut self, kind: Kind, sample: &[f64], found: Option<Found<'_>>) {
        if kind == Kind::Forces {
            return self.between.see(&sample[1..], sample[0]);
        }
        if kind == Kind::InPlaceOfLast {
            self.settle();
            if let Some(row) = self.recording.pop() {
                self.between.see(&row[self.coordinates.end..], row[0]);
            }
        }
        self.compose(sample, found);
        match kind {
            Kind::Row | Kind::InPlaceOfLast => {
                self.fresh.extend_from_slice(&self.row);
                if self.fresh.len() >= NEAR {
                    self.settle();
                }
            }
            _ => self.between.see(&self.row[self.coordinates.end..], sample[0]),
        }
    }

    /// Has the recording take the rows that it has not yet.
    pub fn settle(&mut self) {
        if !self.fresh.is_empty() {
            self.recording.extend(&self.fresh);
            self.fresh.clear();
        }
    }
}

/// Makes rows of samples apart from the simulation, and finds the forces of the constraints for them.
pub struct Composer {
    pub(super) rows: Rows,
    /// `None` where rows have nothing of these forces.
    pub(super) finder: Option<Finder>,
}

impl Composer {
    /// Makes rows of samples, in their order. Says whether one took the place of the last one before.
    pub fn take(&mut self, samples: &Samples) -> bool {
        let Self { rows, finder } = self;
        let mut replaces = false;
        let own = rows.sampled() + rows.channels.inputs.len();
        for (kind, sample) in samples.iter() {
            if let Some(finder) = finder
                && !matches!(kind, Kind::Forces | Kind::Beside { with_forces: false })
            {
                finder.find(sample[0], &sample[own..]);
            }
            rows.take(kind, sample, finder.as_ref().map(Finder::found));
            replaces |= kind == Kind::InPlaceOfLast;
        }
        rows.settle();
        replaces
    }

    /// What was recorded so far.
    pub fn recording(&self) -> &Recording {
        &self.rows.recording
    }

    /// What a resumed recording goes on from, where a sampler was after the samples that were taken so far.
    pub fn mark(&self, sampler: SamplerMark) -> RecorderMark {
        self.rows.mark(sampler)
    }

    /// Completes a checkpoint of the simulation after the last sample with the forces that were found there.
    pub fn complete(&self, checkpoint: &mut Checkpoint) {
        if let Some(finder) = &self.finder {
            checkpoint.keep(finder.reactions());
        }
    }
}
