//! Progress on a terminal: time left, energy drift, and whether steps fail and are taken in many parts. Silent when standard error is not a terminal.

use std::io::IsTerminal;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use holonom::simulation::{Divisions, Observer, Simulation, Verdict};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::desk::Rows;
use crate::keeper::PAUSE;
use crate::notes::many_parts;

/// Time between two changes of what the terminal shows.
const SHOWN: Duration = Duration::from_millis(100);

/// Has rows made, with a progress bar, saves the run from time to time and stops on an interrupt.
pub struct Watched<'scope, 'a, 'f> {
    rows: Rows<'scope, 'a, 'f>,
    bar: ProgressBar,
    is_shown: bool,
    step: f64,
    end: f64,
    next_shown: Instant,
    next_saved: Instant,
    interrupted: Arc<AtomicBool>,
}

impl<'scope, 'a, 'f> Watched<'scope, 'a, 'f> {
    /// Watches a run in steps of `step` to `end` (s).
    pub fn new(rows: Rows<'scope, 'a, 'f>, step: f64, end: f64, quiet: bool, interrupted: Arc<AtomicBool>) -> Self {
        let bar = bar(1000, "{bar:30} {percent:>3} %  {eta} left  {msg}", quiet);
        let (next_shown, next_saved) = (Instant::now() + SHOWN, Instant::now() + PAUSE);
        let is_shown = !bar.is_hidden();
        Self { rows, bar, is_shown, step, end, next_shown, next_saved, interrupted }
    }

    /// Ends the bar.
    pub fn finish(self) -> Rows<'scope, 'a, 'f> {
        self.bar.finish_and_clear();
        self.rows
    }

    fn show(&self, simulation: &Simulation) {
        self.bar.set_position((1000.0 * simulation.state().t / self.end) as u64);
        let drift = simulation.audit().energy_summary().max_drift;
        // Why it takes as long as it does.
        let parts = many_parts(simulation).map_or(String::new(), |parts| format!(", each step in {parts:.0} parts"));
        self.bar.set_message(format!("t = {:.3} s, energy drift {drift:.1e} J{parts}", simulation.state().t));
    }
}

impl Observer for Watched<'_, '_, '_> {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        let are_made = self.rows.after_step(simulation);
        // An event before the end may end the run within a step, and what is at the end itself needs no other place to go on from.
        if simulation.goes_on_unbroken() && simulation.state().t >= self.end - 1.5 * self.step {
            self.rows.keep_before_end(simulation, simulation.state().t < self.end);
        }
        let now = Instant::now();
        if self.is_shown && now >= self.next_shown {
            self.show(simulation);
            self.next_shown = now + SHOWN;
        }
        if now >= self.next_saved || self.rows.are_many() {
            self.rows.save(simulation);
            self.next_saved = now + PAUSE;
        }
        if are_made && !self.interrupted.load(Ordering::Relaxed) { Verdict::GoOn } else { Verdict::Stop }
    }

    fn wants_forces(&self) -> bool {
        self.rows.wants_forces()
    }

    fn divisions(&self) -> Divisions {
        self.rows.divisions()
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.rows.at_division(simulation);
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
