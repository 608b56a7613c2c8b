//! Why a run stopped, in words.

use super::Simulation;
use super::events::CHATTER;
use super::pilot::is_rough;
use crate::formulation::{Failure, Independence, Level, SMOOTH, Workspace};
use crate::linalg::largest;

/// A row that is missed by less than this share of the mechanism's size is not to blame for a step that fails.
const BLAMED: f64 = 1e-10;

/// Distance from the origin, over the mechanism's size, from which on it is said that places are rounded there.
const FAR: f64 = 1e3;

/// A row that adds less to the others, squared and over its own size, is near to one that follows from them.
const NEAR_SINGULAR: f64 = 1e-5;

impl Simulation {
    /// Why a run stopped, in words.
    pub(super) fn reason(&mut self, failure: Failure) -> String {
        let Workspace { phi, scales, .. } = &self.work;
        let missed = phi.iter().zip(&scales.gradient).map(|(phi, g)| phi.abs() / (g * scales.length));
        let worst = missed.enumerate().max_by(|a, b| a.1.total_cmp(&b.1));
        // A row at round-off is not to blame.
        let worst = worst.filter(|(_, missed)| missed.is_nan() || *missed >= BLAMED);
        let row = worst.map_or(String::new(), |(k, _)| format!("; the worst row is `{}` with {:.1e}", self.system.row_names[k], phi[k]));
        let t = self.state.t;
        if matches!(failure, Failure::NotFinite | Failure::TooSmall | Failure::JumpsBack { .. })
            && let Some(what) = self.force_without_value()
        {
            return format!("{what} at t = {t:.6} s");
        }
        let mut what = format!("{} at t = {t:.6} s{row}", failure.describe(&self.system));
        if failure == Failure::TooSmall {
            what += &self.why_too_small();
        }
        // What rows are to blame for no force is.
        let of_steps = matches!(failure, Failure::NotConverged { .. } | Failure::Crawling { .. });
        let by_accuracy = self.pilot.is_some() && matches!(failure, Failure::JumpsBack { .. } | Failure::Broken { .. });
        let may_be_sharp = (of_steps || by_accuracy) && row.is_empty();
        if may_be_sharp && let Some((force, speed)) = self.sharp_force() {
            return format!(
                "{what}; `{force}` turns round within {speed:.1e} m/s or rad/s, which steps jump across: give friction a larger `speed`"
            );
        }
        if of_steps
            && row.is_empty()
            && let Some(force) = self.jumping_force()
        {
            return format!("{what}; the force of `{force}` jumps there with what it moves ({SMOOTH})");
        }
        let is_of_rows =
            matches!(failure, Failure::NotConverged { .. } | Failure::Broken { .. } | Failure::Vanished { .. } | Failure::Singular(_));
        // What cannot move has no step that is short enough either.
        if !is_of_rows && failure != Failure::TooSmall {
            return what;
        }
        if let Some(corner) = self.corner_ahead() {
            return format!("{} at t = {t:.6} s", corner.describe(&self.system));
        }
        if let Some(conflict) = self.conflict() {
            return format!("{conflict}; {what}");
        }
        if let Some(row) = self.stuck() {
            return format!("`{row}` leads to a dead centre or to the end of its reach, beyond which there is no way: {what}");
        }
        if !is_of_rows {
            return what;
        }
        self.blocked().map_or_else(|| what.clone() + &self.disagreement(), |conflict| format!("{conflict}; {what}"))
    }

    /// The corner of a row or a law that the motion comes to within a nominal step.
    fn corner_ahead(&mut self) -> Option<Failure> {
        let step = self.nominal_step();
        let (system, work, state) = (&*self.system, &mut self.work, &self.state);
        state.load(work);
        work.end.x.iter_mut().zip(&state.x).zip(&state.v).for_each(|((end, x), v)| *end = x + step * v);
        system.evaluate(&work.end.x, state.t + step, &work.start.at, &mut work.end.at);
        let (of, what) = system.corner([&work.start.at, &work.end.at])?;
        Some(Failure::Corner { of, what })
    }

    /// Why no step is short enough for the accuracy, as far as that is known, and what to do.
    fn why_too_small(&mut self) -> String {
        if let Some(event) = self.hurrying_event() {
            return format!(
                "; the event `{event}` happens sooner and sooner after it has happened, without end (give its conditions some distance)"
            );
        }
        let less = if self.method.integrator.name == "radau" { "ask for less" } else { "ask for less, or take radau" };
        if let Some(force) = self.reversing_force() {
            return format!(
                "; the force of `{force}` turns round at once there, as that of a spring does whose ends pass each other: keep them apart, or give it `along`, \
                 with which its length has a sign"
            );
        }
        if self.is_near_singular() {
            return format!(
                "; it is near a singular position, where rows hardly differ from others and little errors of steps become large ({less})"
            );
        }
        if let Some(far) = self.far_away().filter(|_| self.redundant_rows() == 0) {
            return format!(
                "; {far:.1e} m from the origin places are rounded to {:.0e} m, and so are those of what moves as it is told, so that steps err by no less \
                 (put the mechanism nearer to the origin, or {less})",
                far * f64::EPSILON
            );
        }
        match is_rough(&self.method) {
            true => "; this method leaves velocities off the constraints, and by how much they are off differs from step to step, which hides the errors of \
                     short steps (take radau or ggl/bdf, which hold them)"
                .into(),
            false => format!(" ({less}){}", self.disagreement()),
        }
    }

    /// How far the mechanism is from the origin, m, where that is so far that rounding of places shows: of all places where it has gone there, and of those that
    /// are given over time.
    fn far_away(&self) -> Option<f64> {
        let system = &self.system;
        let gone = largest(&self.state.x);
        let given = if system.is_driven() { largest(&system.origin) } else { 0.0 };
        (gone.max(given) > FAR * self.length()).then(|| largest(&system.in_world(&self.state.x)))
    }

    /// The last event, where it has happened again and again within a nominal step.
    fn hurrying_event(&self) -> Option<&str> {
        let last = &self.happenings.last()?.event;
        let since = self.state.t - self.nominal_step();
        let times = self.happenings.iter().rev().take_while(|event| event.t >= since).filter(|event| event.event == *last).count();
        (times >= CHATTER).then_some(last)
    }

    /// Whether a row adds next to nothing to the others here, which adds more at the start or as the mechanism goes on.
    fn is_near_singular(&self) -> bool {
        let (system, state, step) = (&*self.system, &self.state, self.nominal_step());
        let mut independence = Independence::new(system);
        let ahead: Vec<f64> = state.x.iter().zip(&state.v).map(|(x, v)| x + step * v).collect();
        let at_start = independence.count_redundant_at_start(system);
        let elsewhere = [at_start, independence.count_redundant(system, &ahead, &state.angle, state.t)];
        independence.count_redundant(system, &state.x, &state.angle, state.t);
        independence.weakest(elsewhere[0].min(elsewhere[1])) < NEAR_SINGULAR
    }

    /// That redundant rows may not agree, where there are any.
    fn disagreement(&self) -> String {
        // At a singular position more rows follow from others than otherwise.
        let at_start = Independence::new(&self.system).count_redundant_at_start(&self.system);
        match self.redundant_rows().min(at_start) {
            0 => String::new(),
            redundant => {
                // Off their positions rows of wheels contradict each other. In the middle of a step they are off them, too, but steps of one stage leave out
                // what follows from others.
                let settings = &self.method.settings;
                let holds_places = settings.doubled || (settings.level == Level::POSITION && self.integrator.has_one_stage());
                let of_rates = match self.system.is_nonholonomic() {
                    false => "",
                    true if holds_places => {
                        "those that hold velocities may contradict each other, as those of wheels that do not all go round one centre; otherwise "
                    }
                    true => {
                        "those that hold velocities, as two wheels on one axle, may ask for different motions within a step of this method, and do not with radau \
                         nor with conserving-ggl; otherwise "
                    }
                };
                // Places far from the origin are rounded as they are written, by more than rows that repeat others may differ.
                let far = largest(&self.system.origin);
                let (why, cure) = match far > FAR * self.length() {
                    false => (String::new(), "write the places with all digits"),
                    true => (
                        format!(
                            ", and {far:.1e} m from the origin places cannot be written more finely than to {:.0e} m",
                            far * f64::EPSILON
                        ),
                        "put the mechanism near the origin and write the places with all digits",
                    ),
                };
                format!(
                    "; {redundant} of the equations of the constraints follow from the others (redundant): {of_rates}either they differ from these in the last \
                     digits that are written, as those of two hinges whose axes are a little off or of three distances along a line, so that nothing meets them \
                     all{why}, or the position is singular ({cure}, take away what is redundant, or put a bushing or a spring in its place)"
                )
            }
        }
    }
}
