//! Where the rows of a run are made and saved: beside the steps, or in a thread of its own while the run goes on.

use std::sync::mpsc::{Receiver, Sender, SyncSender, channel, sync_channel};
use std::thread::{Scope, ScopedJoinHandle};

use holonom::record::{Composer, Recorder, Recording, Sampler, SamplerMark, Samples};
use holonom::simulation::{Checkpoint, Divisions, Observer, Simulation};

use crate::checkpoint::Point;
use crate::keeper::Keeper;

/// Numbers that are handed over at once: to hand them over takes as long as to sample some of them.
const AT_ONCE: usize = 1 << 13;

/// Samples that wait, in such portions, and of large models in one: steps that are faster than rows wait for these, and should not while these are
/// saved.
const PORTIONS: usize = 32;

/// Numbers of rows, and samples, after which the run is saved for the first time, from which on rows are written as they are made: what it is
/// resumed from is some samples more to write.
const MANY: usize = 1 << 18;
const SAMPLES: usize = 200;

/// What is done with a run beside its rows.
pub struct Desk<'a, 'f> {
    pub keeper: Option<&'a mut Keeper<'f>>,
    /// What was put right before the start, in words.
    pub corrections: Vec<String>,
    /// Where the run was before a step that may be its last.
    pub before_end: Option<Box<Point>>,
}

/// Where a run is, without what its rows add to that.
struct Mark {
    run: Checkpoint,
    sampler: SamplerMark,
}

/// What is handed over to the thread that makes rows.
enum Work {
    Samples(Samples),
    /// To be saved if it is time to.
    Save {
        mark: Box<Mark>,
        /// Whether many rows are new.
        has_many: bool,
    },
    BeforeEnd(Option<Box<Mark>>),
}

/// Who makes the rows.
pub enum Rows<'scope, 'a, 'f> {
    /// The thread that takes the steps.
    Here(Box<Recorder>, Desk<'a, 'f>),
    /// Another one.
    There(Box<There<'scope, 'a, 'f>>),
}

/// A thread that makes rows.
pub struct There<'scope, 'a, 'f> {
    sampler: Sampler,
    samples: Samples,
    /// Whether the run is saved.
    is_kept: bool,
    /// Numbers of a row.
    columns: usize,
    /// Samples that were handed over before the run was saved.
    handed: usize,
    is_saved: bool,
    work: SyncSender<Work>,
    /// Room of samples of which rows were made.
    room: Receiver<Samples>,
    thread: ScopedJoinHandle<'scope, (Composer, Desk<'a, 'f>)>,
}

impl<'scope, 'a: 'scope, 'f: 'scope> Rows<'scope, 'a, 'f> {
    /// Has rows made in a thread of its own, where they have no forces that only the simulation finds.
    pub fn in_a_thread<'env>(
        recorder: Recorder,
        desk: Desk<'a, 'f>,
        simulation: &mut Simulation,
        scope: &'scope Scope<'scope, 'env>,
    ) -> Self {
        let columns = recorder.recording().columns().len();
        match recorder.divide(simulation) {
            Err(recorder) => Self::Here(recorder, desk),
            Ok((sampler, composer)) => {
                let (work, to_do) = sync_channel(if columns > AT_ONCE { 1 } else { PORTIONS });
                let (done, room) = channel();
                let is_kept = desk.keeper.is_some();
                let thread = scope.spawn(move || make_rows(composer, desk, &to_do, &done));
                Self::There(Box::new(There {
                    sampler,
                    samples: Samples::default(),
                    is_kept,
                    columns,
                    handed: 0,
                    is_saved: false,
                    work,
                    room,
                    thread,
                }))
            }
        }
    }

    /// Ends the thread; the simulation finds forces as before.
    pub fn join(self, simulation: &mut Simulation) -> (Recorder, Desk<'a, 'f>) {
        match self {
            Self::Here(recorder, desk) => (*recorder, desk),
            Self::There(there) => {
                let There { sampler, samples, work, thread, .. } = *there;
                // Who is not there any more has panicked, which is told by joining.
                let _ = work.send(Work::Samples(samples));
                drop(work);
                let (composer, desk) = thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
                (Recorder::join(sampler, composer, simulation), desk)
            }
        }
    }
}

impl Rows<'_, '_, '_> {
    /// Sees the state after a step; says whether rows are still made.
    pub fn after_step(&mut self, simulation: &Simulation) -> bool {
        match self {
            Self::Here(recorder, desk) => {
                let before = recorder.recording().rows();
                let _ = recorder.after_step(simulation);
                desk.see(simulation.ended_by().is_some() && recorder.recording().rows() == before, recorder.recording());
                true
            }
            Self::There(there) => {
                there.sampler.after_step(simulation, &mut there.samples);
                there.samples.size() < AT_ONCE || there.hand_over()
            }
        }
    }

    /// Sees the state inside a nominal step.
    pub fn at_division(&mut self, simulation: &Simulation) {
        match self {
            Self::Here(recorder, _) => recorder.at_division(simulation),
            Self::There(there) => there.sampler.at_division(simulation, &mut there.samples),
        }
    }

    pub fn wants_forces(&self) -> bool {
        match self {
            Self::Here(recorder, _) => recorder.wants_forces(),
            // They are found in the other thread.
            Self::There(_) => false,
        }
    }

    pub fn divisions(&self) -> Divisions {
        match self {
            Self::Here(recorder, _) => recorder.divisions(),
            Self::There(there) => there.sampler.divisions(),
        }
    }

    /// Whether there are so many new rows that the run is to be saved before it is time to: they are written meanwhile, and not at the end.
    pub fn are_many(&self) -> bool {
        matches!(self, Self::There(there) if there.has_many())
    }

    /// Saves the run if it is time to.
    pub fn save(&mut self, simulation: &Simulation) {
        match self {
            Self::Here(recorder, desk) => {
                desk.save(simulation.state().t, false, recorder.recording(), |corrections| Point::of(simulation, recorder, corrections))
            }
            Self::There(there) if !there.is_kept => (),
            Self::There(there) => {
                let has_many = there.has_many();
                there.mark(simulation, |mark| Work::Save { mark, has_many });
                there.is_saved = true;
            }
        }
    }

    /// Where the run is, or nowhere, is where it was before a step that may be its last.
    pub fn keep_before_end(&mut self, simulation: &Simulation, is_there: bool) {
        match self {
            Self::Here(recorder, desk) => desk.before_end = is_there.then(|| Box::new(Point::of(simulation, recorder, &desk.corrections))),
            Self::There(there) if is_there => there.mark(simulation, |mark| Work::BeforeEnd(Some(mark))),
            Self::There(there) => drop(there.work.send(Work::BeforeEnd(None))),
        }
    }
}

impl There<'_, '_, '_> {
    fn has_many(&self) -> bool {
        self.is_kept && !self.is_saved && self.handed >= SAMPLES.max(MANY / self.columns)
    }

    /// Hands samples over; says whether somebody takes them.
    fn hand_over(&mut self) -> bool {
        self.handed += self.samples.count();
        let room = self.room.try_recv().unwrap_or_default();
        self.work.send(Work::Samples(std::mem::replace(&mut self.samples, room))).is_ok()
    }

    /// Hands over where the run is, behind the samples up to there.
    fn mark(&mut self, simulation: &Simulation, work: impl FnOnce(Box<Mark>) -> Work) {
        let mark = Box::new(Mark { run: simulation.checkpoint(), sampler: self.sampler.mark() });
        if self.hand_over() {
            // As in joining.
            let _ = self.work.send(work(mark));
        }
    }
}

/// Makes rows until nobody hands over samples any more.
fn make_rows<'a, 'f>(
    mut composer: Composer,
    mut desk: Desk<'a, 'f>,
    to_do: &Receiver<Work>,
    done: &Sender<Samples>,
) -> (Composer, Desk<'a, 'f>) {
    let point = |composer: &Composer, Mark { mut run, sampler }: Mark, corrections: &[String]| {
        composer.complete(&mut run);
        Point { run, recorder: composer.mark(sampler), rows: composer.recording().rows(), corrections: corrections.into() }
    };
    for work in to_do {
        match work {
            Work::Samples(mut samples) => {
                let replaces = composer.take(&samples);
                desk.see(replaces, composer.recording());
                samples.clear();
                // The run may have ended.
                let _ = done.send(samples);
            }
            Work::Save { mark, has_many } => {
                let t = mark.run.state.t;
                desk.save(t, has_many, composer.recording(), |corrections| point(&composer, *mark, corrections));
            }
            Work::BeforeEnd(mark) => desk.before_end = mark.map(|mark| Box::new(point(&composer, *mark, &desk.corrections))),
        }
    }
    (composer, desk)
}

impl Desk<'_, '_> {
    /// Sees new rows; one may have taken the place of the last one.
    fn see(&mut self, replaces: bool, recording: &Recording) {
        let Some(keeper) = &mut self.keeper else { return };
        if replaces {
            keeper.begin_anew();
        }
        keeper.prepare(recording);
    }

    /// Saves the run, which is at the time `t` (s), if it is time to.
    fn save(&mut self, t: f64, has_many: bool, recording: &Recording, point: impl FnOnce(&[String]) -> Point) {
        if let Some(keeper) = self.keeper.as_mut().filter(|keeper| keeper.is_due(t, has_many)) {
            keeper.keep(recording, point(&self.corrections));
        }
    }
}
