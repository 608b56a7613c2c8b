//! Progress on a terminal: time left, energy drift, and whether steps fail and are taken in many parts. Silent when standard error is not a terminal.

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use holonom::record::Recorder;
use holonom::simulation::{Divisions, Observer, Simulation, Verdict};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::checkpoint::Point;
use crate::keeper::Keeper;
use crate::notes::many_parts;

/// Time between two changes of what the terminal shows.
const SHOWN: Duration = Duration::from_millis(100);

/// A recorder with a progress bar that saves the run from time to time and stops on an interrupt.
pub struct Watched<'a, 'f> {
    pub recorder: Recorder<'a>,
    /// Where the run was before a step that may be its last.
    pub before_end: Option<Point>,
    keeper: Option<&'a mut Keeper<'f>>,
    /// What was put right before the start, in words.
    corrections: Vec<String>,
    bar: ProgressBar,
    is_shown: bool,
    step: f64,
    end: f64,
    next_shown: Instant,
    interrupted: Arc<AtomicBool>,
}

impl<'a, 'f> Watched<'a, 'f> {
    /// Watches a run in steps of `step` to `end` (s).
    pub fn new(recorder: Recorder<'a>, step: f64, end: f64, quiet: bool, interrupted: Arc<AtomicBool>) -> Self {
        let bar = bar(1000, "{bar:30} {percent:>3} %  {eta} left  {msg}", quiet);
        let next_shown = Instant::now() + SHOWN;
        let is_shown = !bar.is_hidden();
        Self { recorder, before_end: None, keeper: None, corrections: Vec::new(), bar, is_shown, step, end, next_shown, interrupted }
    }

    /// The same run, saved while it goes on, with what was put right before its start.
    pub fn kept(mut self, keeper: Option<&'a mut Keeper<'f>>, corrections: &[String]) -> Self {
        (self.keeper, self.corrections) = (keeper, corrections.into());
        self
    }

    /// Ends the bar.
    pub fn finish(self) -> holonom::record::Recording {
        self.bar.finish_and_clear();
        self.recorder.finish()
    }

    fn show(&self, simulation: &Simulation) {
        self.bar.set_position((1000.0 * simulation.state().t / self.end) as u64);
        let drift = simulation.audit().energy_summary().max_drift;
        // Why it takes as long as it does.
        let parts = many_parts(simulation).map_or(String::new(), |parts| format!(", each step in {parts:.0} parts"));
        self.bar.set_message(format!("t = {:.3} s, energy drift {drift:.1e} J{parts}", simulation.state().t));
    }
}

impl Observer for Watched<'_, '_> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        let rows = self.recorder.recording().rows();
        self.recorder.after_step(simulation);
        if let Some(keeper) = &mut self.keeper
            && simulation.ended_by().is_some()
            && self.recorder.recording().rows() == rows
        {
            keeper.begin_anew();
        }
        // An event before the end may end the run within a step, and what is at the end itself needs no other place to go on from.
        if simulation.goes_on_unbroken() && simulation.state().t >= self.end - 1.5 * self.step {
            let is_before = simulation.state().t < self.end;
            self.before_end = is_before.then(|| Point::of(simulation, &self.recorder, &self.corrections));
        }
        if self.is_shown && Instant::now() >= self.next_shown {
            self.show(simulation);
            self.next_shown = Instant::now() + SHOWN;
        }
        if let Some(keeper) = &mut self.keeper {
            keeper.look(simulation, &self.recorder, &self.corrections);
        }
        if self.interrupted.load(Ordering::Relaxed) { Verdict::Stop } else { Verdict::GoOn }
    }

    fn wants_forces(&self) -> bool {
        self.recorder.wants_forces()
    }

    fn divisions(&self) -> Divisions {
        self.recorder.divisions()
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.recorder.at_division(simulation);
    }
}

/// A bar that counts runs, of which some are done already.
pub fn runs_bar(runs: u64, done: u64, quiet: bool) -> ProgressBar {
    let bar = bar(runs, "{bar:30} {pos} of {len} runs  {eta} left", quiet).with_position(done);
    bar.reset_eta();
    bar
}

/// A bar on standard error, where that is a terminal.
fn bar(length: u64, template: &str, quiet: bool) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if quiet || !std::io::stderr().is_terminal() {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar.with_style(ProgressStyle::with_template(template).expect("the template is valid"))
}

/// A flag that an interrupt from the keyboard sets; the second interrupt ends the program.
pub fn interrupt_flag() -> Arc<AtomicBool> {
    let flag = Arc::new(AtomicBool::new(false));
    let set = flag.clone();
    // A second handler cannot be set; then the default one ends the program, which is what is wanted.
    let _ = ctrlc::set_handler(move || {
        if set.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    });
    flag
}
