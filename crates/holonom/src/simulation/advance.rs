//! A nominal step: in parts where it fails as a whole, each audited, projected and judged before it becomes the state.

use super::{Audit, Simulation};
use crate::formulation::{Failure, Followers, Iteration, Sampling};
use crate::integrator::{Estimate, Step};

/// Halvings of a step before a run gives up.
const MOST_HALVINGS: u32 = 12;

/// Accelerations are differences of positions over the square of a step: from a part of it that is shorter than this share, rounding would be
/// carried on. Schemes of several steps know them from longer ones.
pub(super) const SHORT: f64 = 0.01;

/// Most parts of a length before longer ones are tried again.
const MOST_WANTED: u32 = 16;

/// Units that the parts of a nominal step are counted in: what is left may be three quarters of it, and halved as often.
const PARTS: u32 = 1 << 24;

/// Looks at the simulation inside a nominal step.
pub(super) struct Inside<'a> {
    /// Looks, and says whether the step ends there.
    pub look: &'a mut dyn FnMut(&mut Simulation) -> Result<bool, Failure>,
    /// Whether it looks inside of long parts, too, and not only where parts end.
    pub everywhere: bool,
}

impl Simulation {
    /// Takes the nominal step to `target`. Where it is taken in parts, `look` is shown where they end.
    pub(super) fn advance(&mut self, target: f64, reacts: bool, look: Option<&mut Inside<'_>>) -> Result<(), Failure> {
        let from = self.state.t;
        self.audit.begin_step();
        self.judge.begin_step();
        match self.pilot.take() {
            None => self.halve(target, look)?,
            Some(mut pilot) => {
                let outcome = match self.method.integrator.dense {
                    true => self.cruise(target, &mut pilot, look),
                    false => self.land(target, &mut pilot, look),
                };
                self.pilot = Some(pilot);
                outcome?;
            }
        }
        let h = self.state.t - from;
        self.judge.whole(h, &self.audit, 0.0, &self.work)?;
        let known = self.pilot.as_ref().map_or(0.0, |pilot| pilot.supply());
        self.judge.supply(h, known, &self.audit, &self.work)?;
        self.steps += 1;
        self.audit.end_step(&self.system, &mut self.work, &self.state, self.steps);
        self.look_at_contacts();
        if self.pilot.is_none() && h < SHORT * self.step && self.carries_accelerations() {
            self.begin_anew();
        }
        if reacts {
            self.update_reactions();
        }
        Ok(())
    }

    /// Sees which forces act that begin and end to do so with what moves.
    pub(super) fn look_at_contacts(&mut self) {
        let mut contacts = std::mem::take(&mut self.contacts);
        let acting = self.system.acting(self.look());
        contacts.iter_mut().zip(acting).for_each(|(contact, [force, power])| contact.look(self.state.t, force, power));
        self.contacts = contacts;
    }

    /// Whether a step goes on from the accelerations of the one before alone.
    pub(super) fn carries_accelerations(&self) -> bool {
        !self.method.integrator.conserves && self.method.integrator.estimate != Estimate::OwnOfStates
    }

    /// In parts where it fails as a whole. Parts are counted, and their ends reckoned from the start: the sum of their rounded
    /// lengths may miss the target by a rounding of time, and over so short a part a rounding of positions is any velocity.
    fn halve(&mut self, target: f64, mut look: Option<&mut Inside<'_>>) -> Result<(), Failure> {
        let from = self.state.t;
        let whole = target - from;
        let (mut done, mut part) = (0, PARTS);
        // Parts of this length so far, and how many there are to be before longer ones are tried again.
        let (mut taken, mut wanted) = (0, 1);
        while done < PARTS {
            part = part.min(PARTS - done);
            let end = done + part;
            let until = if end == PARTS { target } else { from + whole * f64::from(end) / f64::from(PARTS) };
            match self.substep(whole * f64::from(part) / f64::from(PARTS), until) {
                Ok(_) => {
                    (done, taken) = (end, taken + 1);
                    if taken >= wanted {
                        (part, taken) = (2 * part, 0);
                    }
                    if done < PARTS && self.ends_here(&mut look)? {
                        break;
                    }
                }
                Err(failure) if !self.method.subdivide || part <= PARTS >> MOST_HALVINGS => return Err(failure),
                Err(_) => {
                    // An attempt that fails costs more than several that do not.
                    wanted = if taken == 0 && done > 0 { (2 * wanted).min(MOST_WANTED) } else { 1 };
                    (part, taken) = (part / 2, 0);
                    self.audit.reject(&self.newton);
                }
            }
        }
        Ok(())
    }

    /// Whether the nominal step ends at the present state.
    pub(super) fn ends_here(&mut self, look: &mut Option<&mut Inside<'_>>) -> Result<bool, Failure> {
        look.as_mut().map_or(Ok(false), |inside| (inside.look)(self))
    }

    /// One step of the method. Where its result breaks a promise it is iterated until nothing but round-off is left.
    pub(super) fn substep(&mut self, step: f64, target: f64) -> Result<Step, Failure> {
        let mut outcome = self.try_step(step, target);
        if let Err(Failure::Broken { .. }) = outcome {
            let tolerance = std::mem::take(&mut self.newton.settings.tolerance);
            outcome = self.try_step(step, target);
            self.newton.settings.tolerance = tolerance;
        }
        match outcome {
            Err(failure) if self.leaves_out_others(failure) => self.try_step(step, target),
            outcome => outcome,
        }
    }

    /// Whether steps leave out other rows than those of the step that failed: the rows that follow from others, where that was not looked for, or none,
    /// where one of them does not follow after all.
    fn leaves_out_others(&mut self, failure: Failure) -> bool {
        match (failure, &mut self.newton.rank.left_out) {
            (Failure::Broken { row: Some(row), .. }, Some(left_out)) if left_out.contains(&(row as u32)) => left_out.clear(),
            (Failure::Broken { .. } | Failure::NotConverged { .. }, left_out @ None)
                if self.system.is_nonholonomic() && self.integrator.has_one_stage() =>
            {
                let followers = self.followers.get_or_insert_with(|| Box::new(Followers::new(&self.system)));
                let found = followers.find(&self.system, &self.state.x, &self.state.angle, self.state.t, &[]);
                if found.is_empty() {
                    return false;
                }
                *left_out = Some(found.to_vec());
            }
            _ => return false,
        }
        true
    }

    /// Integrates and finishes a step. One that fails leaves the start of the workspace at the present state: the last part of a composed
    /// step began elsewhere.
    fn try_step(&mut self, step: f64, target: f64) -> Result<Step, Failure> {
        let (system, work) = (&*self.system, &mut self.work);
        self.state.load(work);
        system.constraint_values(&work.start.at, self.state.t, &mut work.phi_start);
        work.shares.fill(0.0);
        let taken = self.integrator.step(system, self.state.t, step, &mut self.newton, work);
        let outcome = taken.and_then(|taken| self.finish(taken, step, target));
        if outcome.is_err() {
            let start = &mut self.work.start.at;
            start.functions.angle.copy_from_slice(&self.state.angle);
            self.system.evaluate_again(&self.state.x, self.state.t, start);
        }
        outcome
    }

    /// Audits, projects and judges what the integrator left in the workspace; it becomes the present state only then.
    pub(super) fn finish(&mut self, taken: Step, step: f64, target: f64) -> Result<Step, Failure> {
        let (system, work, method) = (&*self.system, &mut self.work, &self.method);
        for i in 0..system.coordinates() {
            work.end.x[i] = work.start.x[i] + work.d[i];
        }
        if !taken.has_settled_at(target, system, work) {
            system.evaluate(&work.end.x, target, &work.start.at, &mut work.end.at);
        }
        method.projection.place(system, target, step, &mut self.newton, work)?;
        if work.estimate.allowed > 0.0 && matches!(taken.stage.sampling, Sampling::Between | Sampling::Middle) {
            work.compare_forces(system, &taken.stage, target);
        }
        let before = self.audit.clone();
        if let Err(failure) = self.close(&before, &taken, step, target) {
            self.audit = before;
            return Err(failure);
        }
        self.commit(step, target);
        Ok(taken)
    }

    /// Audits and projects what is in the workspace, and has every promise looked at; the audit was `before`.
    fn close(&mut self, before: &Audit, taken: &Step, step: f64, target: f64) -> Result<(), Failure> {
        let (system, work, method, audit) = (&*self.system, &mut self.work, &self.method, &mut self.audit);
        let accounts = audit.integrated(system, taken, target, &self.shares.powers, work);
        self.judge.corners(system, work)?;
        self.judge.positions(system, target, work)?;
        audit.violate_acceleration(system, method, taken, target, work);
        self.found_v.copy_from_slice(&work.end.v);
        self.found_a.copy_from_slice(&work.a);
        method.projection.apply(system, target, step, &mut self.newton, work)?;
        audit.projected(system, method, &self.found_v, accounts, target, work);
        self.judge.velocities(system, target, step, work)?;
        if let Some(left_out) = &self.newton.rank.left_out {
            let followers = self.followers.get_or_insert_with(|| Box::new(Followers::new(system)));
            let found = followers.find(system, &work.end.x, &work.end.at.functions.angle, target, left_out);
            self.judge.followers(left_out, found, work)?;
        }
        audit.closed(system, method, &self.found_a, target, &self.newton, work);
        self.judge.accelerations(step, work)?;
        let of_places = self.judge.of_places(system, work);
        self.judge.energy(step, [before, audit], of_places, work)?;
        self.judge.dampers(system, ([self.state.t, target], step), [before, audit], &taken.stage, work)?;
        // A part that takes the nominal step out of its bound can be taken again.
        self.judge.whole(step, audit, of_places, work)?;
        if !system.gauges().is_empty() {
            self.next_gauges.copy_from(&self.gauges);
            system.measure(&work.end.x, &work.end.v, &mut self.next_gauges);
            self.judge.turns(system, step, &self.gauges, &self.next_gauges)?;
        }
        self.judge.take(step, of_places);
        audit.look_at_multipliers(step, &self.state.lambda, work);
        Ok(())
    }

    /// Makes the end of a step in the workspace the present state.
    fn commit(&mut self, step: f64, target: f64) {
        let work = &mut self.work;
        self.shares.add(work);
        // The paper's loops start from the paper's prediction.
        if self.method.settings.iteration == Iteration::Newton {
            self.state.remember(step, &self.found_a, work);
        }
        self.state.land(target, &self.found_a, work);
        self.shown_v.copy_from_slice(&work.end.v);
        self.shown_a.copy_from_slice(&work.a);
        let goes_on = !self.method.projection.shadow;
        self.state.v.copy_from_slice(if goes_on { &work.end.v } else { &self.found_v });
        if goes_on {
            self.state.a.copy_from_slice(&work.a);
        }
        std::mem::swap(&mut work.start.at, &mut work.end.at);
        std::mem::swap(&mut self.gauges, &mut self.next_gauges);
        self.state.measured.copy_from_slice(self.gauges.counted());
        if let (Some(left_out), Some(followers)) = (&mut self.newton.rank.left_out, &self.followers) {
            left_out.clear();
            left_out.extend_from_slice(followers.found());
        }
        self.hints.keep(&self.newton, &*self.integrator);
    }
}
