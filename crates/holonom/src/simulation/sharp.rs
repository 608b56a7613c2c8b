//! Forces that turn round within so small a speed that steps jump across it, as friction that is smoothed too little, or within so small a
//! way that no step is short enough for it, as a spring whose ends pass each other.

use super::Simulation;
use crate::system::{Look, Response};

/// How many times faster something moves, by what it comes on in a step, than the speed within which such a force turns round.
const SHARP: f64 = 100.0;

/// Share of a nominal step within which a force turns round that is looked for, and that by which it must have done so to count.
const NEAR: f64 = 1e-3;
const AT_ONCE: f64 = 1e-7;

/// Share of what it was that a force has as it turns round at once: one that goes through zero has none.
const KEPT: f64 = 0.5;

impl Simulation {
    /// The force, by name, that turns round within the smallest share of the speed it acts at, and that speed, m/s or rad/s.
    pub(super) fn sharp_force(&mut self) -> Option<(&str, f64)> {
        let step = self.nominal_step();
        let Self { system, state, work, .. } = self;
        system.evaluate(&state.x, state.t, &work.start.at, &mut work.end.at);
        let speeds = |speed: &dyn Fn(f64, f64) -> f64| -> Vec<f64> { state.v.iter().zip(&state.a).map(|(v, a)| speed(*v, *a)).collect() };
        // Where it comes to rest it has not much speed left, and what pulls it then would give it one.
        let moving = [speeds(&|v, _| v), speeds(&|v, a| v + step * a)];
        let rest = speeds(&|_, _| 0.0);
        let sharpest = system.laws.iter().filter_map(|law| {
            let mut slope = Response::default();
            system.respond(law, &work.end.at, &rest, state.t, &mut slope);
            let within = |v: &Vec<f64>| {
                let mut out = Response::default();
                let rates = system.respond(law, &work.end.at, v, state.t, &mut out);
                let of_argument = |k: usize| (out.force[k].abs() / slope.by_rate[k][k].abs(), rates[k].abs());
                (0..law.arguments.len()).map(of_argument).find(|(within, speed)| *within > 0.0 && *speed > SHARP * within)
            };
            moving.iter().find_map(within).map(|(within, speed)| (&law.name, within, speed / within))
        });
        sharpest.max_by(|a, b| a.2.total_cmp(&b.2)).map(|(name, within, _)| (name.as_str(), within))
    }

    /// The force, by name, that jumps with what moves within what velocities change by in a nominal step, before or behind the present ones: where the
    /// iteration goes to and fro over a jump, the last step may have ended on either side.
    pub(super) fn jumping_force(&mut self) -> Option<&str> {
        let step = self.nominal_step();
        let Self { system, state, work, .. } = self;
        let _ = state.look_ahead(0.0, system, work);
        let [behind, ahead] = [-step, step].map(|by| {
            let end = &mut work.end;
            end.v.iter_mut().zip(state.v.iter().zip(&state.a)).for_each(|(end, (v, a))| *end = v + by * a);
            system.see(Look { x: &end.x, v: &end.v, t: state.t, at: &end.at, inputs: &state.inputs, span: None })
        });
        system.jumping_between(&behind, &ahead)
    }

    /// The force, by name, whose power turns round at once as the mechanism goes on at its present velocities.
    pub(super) fn reversing_force(&mut self) -> Option<&str> {
        let (step, laws) = (self.nominal_step(), self.system.laws.len());
        let before = self.powers(0.0);
        let after = self.powers(NEAR * step);
        let reverses = |this: &mut Self, k: usize| {
            let (mut from, mut to) = ((0.0, before[k]), (NEAR * step, after[k]));
            while from.1 * to.1 < 0.0 && to.0 - from.0 > AT_ONCE * step {
                let middle = 0.5 * (from.0 + to.0);
                let power = this.powers(middle)[k];
                *(if power * from.1 > 0.0 { &mut from } else { &mut to }) = (middle, power);
            }
            from.1 * to.1 < 0.0 && from.1.abs().min(to.1.abs()) > KEPT * before[k].abs()
        };
        let k = (0..before.len()).find(|&k| before[k] * after[k] < 0.0 && reverses(self, k))?;
        let system = &self.system;
        Some(if k < laws { &system.laws[k].name } else { &system.loads[k - laws].name })
    }

    /// The power of each law and load if the mechanism were farther by so much time at its present velocities, W.
    fn powers(&mut self, ahead: f64) -> Vec<f64> {
        let Self { system, state, work, .. } = self;
        system.powers(state.look_ahead(ahead, system, work)).collect()
    }
}
