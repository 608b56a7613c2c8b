//! Forces that turn round within so small a speed that steps jump across it, as friction that is smoothed too little.

use super::Simulation;

/// How many times faster something moves, by what it comes on in a step, than the speed within which such a force turns round.
const SHARP: f64 = 100.0;

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
            let (_, slope) = system.respond(law, &work.end.at, &rest, state.t);
            let within = |v: &Vec<f64>| {
                let (rates, out) = system.respond(law, &work.end.at, v, state.t);
                let of_argument = |k: usize| (out.force[k].abs() / slope.by_rate[k][k].abs(), rates[k].abs());
                (0..law.arguments.len()).map(of_argument).find(|(within, speed)| *within > 0.0 && *speed > SHARP * within)
            };
            moving.iter().find_map(within).map(|(within, speed)| (&law.name, within, speed / within))
        });
        sharpest.max_by(|a, b| a.2.total_cmp(&b.2)).map(|(name, within, _)| (name.as_str(), within))
    }
}
