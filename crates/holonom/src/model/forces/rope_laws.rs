//! Laws of a rope: one tension along all its stretches, which follows from their whole length ℓ = Σ w_i r_i and from what a drum lets out.
//!
//! A law hands over f_i with force on the nodes −Σ f_i ∇π_i, π_i = ½ r_i²: f_i is w_i times the tension over r_i. Between two
//! positions f_i = w_i T̄ / r̄_i makes Σ f_i Δπ_i exactly T̄ Δℓ, as for a spring (`laws.rs`). Along the coordinate q of a drum of
//! radius R, which lets out R q, it is −R times the tension.

use super::laws::{length, lengths};
use crate::system::{Bend, Law, MAX_ARGUMENTS, Reach, Response};

/// By this share of its length rounding may have a rope shorter than its free length.
const ROUNDED: f64 = 1e-12;

/// Whether a rope of a length (m) that is stretched by `beyond` (m), and gets longer with a speed (m/s), is taut: also where its length is the free one,
/// as it is at the start where the latter is not written. Only there the others are asked for.
pub(super) fn is_taut(beyond: f64, speed: impl FnOnce() -> f64, length: impl FnOnce() -> f64) -> bool {
    beyond > 0.0 || (beyond >= -ROUNDED * length() && speed() > 0.0)
}

/// What goes through zero where such a rope gets taut or slack, m: where it gets longer, its damping begins to pull a rounding before its free length.
pub(super) fn taken_up(beyond: f64, speed: f64, length: f64) -> f64 {
    if speed > 0.0 { beyond + ROUNDED * length } else { beyond }
}

/// How the lengths of a rope add up.
#[derive(Clone, Copy)]
pub(super) struct Strands {
    /// w_i: how many stretches are as long as that.
    factors: [f64; MAX_ARGUMENTS],
    /// How many lengths there are. Behind them comes the coordinate of the drum, if there is one.
    lengths: usize,
    /// R, m, or m/m where the drum is a rail.
    radius: f64,
    /// Free length that is left for them where the drum is at zero, m.
    free: f64,
    /// Distances below this count as this, m.
    shortest: f64,
}

impl Strands {
    pub(super) fn new(factors: &[f64], radius: f64, free: f64, shortest: f64) -> Self {
        let mut all = [0.0; MAX_ARGUMENTS];
        all[..factors.len()].copy_from_slice(factors);
        Self { factors: all, lengths: factors.len(), radius, free, shortest }
    }

    /// Its whole length, m.
    fn whole(&self, value: &[f64]) -> f64 {
        value[..self.lengths].iter().zip(self.factors).map(|(&value, factor)| factor * length(value, self.shortest).0).sum()
    }

    /// By how much a rope is longer than its free length, m, below zero where it is slack.
    fn beyond(&self, value: &[f64]) -> f64 {
        self.whole(value) - self.free - value[self.lengths..].first().map_or(0.0, |q| self.radius * q)
    }

    /// The rate of that, m/s.
    fn speed(&self, value: &[f64], rate: &[f64]) -> f64 {
        let (lengths, drum) = rate.split_at(self.lengths);
        let whole: f64 = lengths
            .iter()
            .zip(value)
            .zip(self.factors)
            .map(|((&rate, &value), factor)| factor * rate / length(value, self.shortest).0)
            .sum();
        whole - drum.first().map_or(0.0, |rate| self.radius * rate)
    }
}

/// A step of a rope.
pub(super) struct Change {
    /// How far it is stretched at its start and at its end, 0 where it is slack, m.
    stretch: [f64; 2],
    /// Change of the whole length beyond what the drum lets out, m.
    rise: f64,
    /// s
    step: f64,
}

impl Change {
    /// Change of the stretch over that of the length: 1 while it is taut, 0 while it is slack; and how it changes with the length at the end.
    fn share(&self) -> [f64; 2] {
        let [before, after] = self.stretch;
        match (before > 0.0, after > 0.0) {
            (true, true) => [1.0, 0.0],
            (false, false) => [0.0, 0.0],
            (_, is_taut) => {
                let share = (after - before) / self.rise;
                // Of a way as short as a rounding the quotient is anything.
                let is_known = (0.0..1.0).contains(&share);
                if is_known { [share, (f64::from(is_taut) - share) / self.rise] } else { [1.0, 0.0] }
            }
        }
    }

    /// How the stretch at the end changes with the length there.
    fn slope(&self) -> f64 {
        f64::from(self.stretch[1] > 0.0)
    }
}

/// A tension that follows from the whole length.
pub(super) trait Pull: Send + Sync {
    /// Its energy, J, when it is stretched by `stretch`.
    fn energy(&self, stretch: f64) -> f64;

    fn conservative(&self) -> bool;

    /// Tension, and its derivatives by stretch and speed, of a rope that is stretched by more than zero.
    fn at(&self, stretch: f64, speed: f64) -> [f64; 3];

    /// Tension between two positions, and its derivative by the length at the second.
    fn between(&self, change: &Change) -> [f64; 2];

    /// What goes through zero where the tension bends, of a rope that is taut where `beyond`, m, is more than zero: its length beyond the free one, and
    /// what rounding may have taken from that.
    fn corner(&self, beyond: f64, speed: f64) -> f64;
}

/// V = ½ k p² with the stretch p = max(ℓ − L, 0).
pub(super) struct Elastic {
    pub stiffness: f64,
}

impl Pull for Elastic {
    fn energy(&self, stretch: f64) -> f64 {
        0.5 * self.stiffness * stretch * stretch
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, stretch: f64, _speed: f64) -> [f64; 3] {
        [self.stiffness * stretch, self.stiffness, 0.0]
    }

    /// k p̄ Δp/Δℓ
    fn between(&self, change: &Change) -> [f64; 2] {
        let ([share, bend], mean) = (change.share(), 0.5 * (change.stretch[0] + change.stretch[1]));
        [self.stiffness * mean * share, self.stiffness * (0.5 * change.slope() * share + mean * bend)]
    }

    fn corner(&self, beyond: f64, _speed: f64) -> f64 {
        beyond
    }
}

/// Tension c dℓ/dt of a taut rope, but for what would have the whole rope push: at least −k p.
pub(super) struct Damping {
    pub damping: f64,
    pub stiffness: f64,
}

impl Pull for Damping {
    fn energy(&self, _stretch: f64) -> f64 {
        0.0
    }

    fn conservative(&self) -> bool {
        false
    }

    fn at(&self, stretch: f64, speed: f64) -> [f64; 3] {
        let (tension, least) = (self.damping * speed, -self.stiffness * stretch);
        if tension >= least { [tension, 0.0, self.damping] } else { [least, -self.stiffness, 0.0] }
    }

    /// max(c Δℓ/h, −k p̄) Δp/Δℓ: the share of the step in which the rope is taut counts, so that nothing jumps where it gets taut.
    fn between(&self, change: &Change) -> [f64; 2] {
        let ([share, bend], [before, after]) = (change.share(), change.stretch);
        let damping = self.damping / change.step;
        let (tension, least) = (damping * change.rise, -0.5 * self.stiffness * (before + after));
        let [tension, slope] = if tension >= least { [tension, damping] } else { [least, -0.5 * self.stiffness * change.slope()] };
        [share * tension, share * slope + bend * tension]
    }

    /// All tension of a taut rope: where that is nothing the rope would begin to push.
    fn corner(&self, beyond: f64, speed: f64) -> f64 {
        if beyond > 0.0 { self.damping * speed + self.stiffness * beyond } else { 0.0 }
    }
}

/// A tension along all stretches of a taut rope.
pub(super) struct Taut<P> {
    pub strands: Strands,
    pub pull: P,
}

impl<P: Pull> Law for Taut<P> {
    fn energy(&self, value: &[f64]) -> f64 {
        self.pull.energy(self.strands.beyond(value).max(0.0))
    }

    fn conservative(&self) -> bool {
        self.pull.conservative()
    }

    fn bends(&self, value: &[f64], rate: &[f64], _t: f64, note: &mut dyn FnMut(Bend)) {
        let speed = self.strands.speed(value, rate);
        note(Bend::Corner(self.pull.corner(taken_up(self.strands.beyond(value), speed, self.strands.whole(value)), speed)));
    }

    fn at(&self, value: &[f64], rate: &[f64], _t: f64, out: &mut Response) {
        let beyond = self.strands.beyond(value);
        if !is_taut(beyond, || self.strands.speed(value, rate), || self.strands.whole(value)) {
            return;
        }
        let stretch = beyond.max(0.0);
        // Of each stretch the derivatives of ℓ and of dℓ/dt by its π, and that of ℓ̇ by its π̇.
        let (mut by_value, mut by_rate, mut speed) = ([[0.0; 2]; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS], 0.0);
        for (i, (&value, &rate)) in value.iter().zip(rate).enumerate() {
            if i < self.strands.lengths {
                let ((r, slope), factor) = (length(value, self.strands.shortest), self.strands.factors[i]);
                by_rate[i] = factor / r;
                by_value[i] = [factor * slope, -factor * rate / (r * r) * slope];
            } else {
                by_rate[i] = -self.strands.radius;
                by_value[i] = [-self.strands.radius, 0.0];
            }
            speed += by_rate[i] * rate;
        }
        let [tension, by_length, by_speed] = self.pull.at(stretch, speed);
        for i in 0..value.len() {
            out.force[i] = by_rate[i] * tension;
            for j in 0..value.len() {
                out.by_value[i][j] = by_rate[i] * (by_length * by_value[j][0] + by_speed * by_value[j][1]);
                out.by_rate[i][j] = by_rate[i] * by_speed * by_rate[j];
            }
        }
        for (i, &value) in value[..self.strands.lengths].iter().enumerate() {
            let (r, slope) = length(value, self.strands.shortest);
            out.by_value[i][i] -= by_rate[i] * tension / r * slope;
        }
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let stretch = [reach.from, reach.to].map(|value| self.strands.beyond(value).max(0.0));
        if stretch == [0.0; 2] {
            return;
        }
        // Of each argument: what the rope gets longer by over its change, and at its end; and how the former changes with the end.
        let (mut share, mut slope, mut bend, mut rise) = ([0.0; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS], [0.0; MAX_ARGUMENTS], 0.0);
        for i in 0..reach.from.len() {
            if i < self.strands.lengths {
                let (of_one, factor) = (lengths(reach.from[i], reach.to[i], self.strands.shortest), self.strands.factors[i]);
                (share[i], slope[i]) = (factor / of_one.mean, factor * of_one.slope);
                bend[i] = -share[i] * 0.5 * of_one.slope / of_one.mean;
                rise += factor * of_one.rise;
            } else {
                (share[i], slope[i]) = (-self.strands.radius, -self.strands.radius);
                rise -= self.strands.radius * (reach.to[i] - reach.from[i]);
            }
        }
        let [tension, by_length] = self.pull.between(&Change { stretch, rise, step: reach.step });
        for i in 0..reach.from.len() {
            out.force[i] = share[i] * tension;
            for j in 0..reach.from.len() {
                out.by_value[i][j] = share[i] * by_length * slope[j];
            }
            out.by_value[i][i] += bend[i] * tension;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn laws() -> Vec<(&'static str, Box<dyn Law>)> {
        let strands = Strands::new(&[1.0, 2.0], 0.0, 3.0, 1e-12);
        vec![
            ("elastic", Box::new(Taut { strands, pull: Elastic { stiffness: 30.0 } })),
            ("damping", Box::new(Taut { strands, pull: Damping { damping: 2.0, stiffness: 30.0 } })),
            ("damping that would push", Box::new(Taut { strands, pull: Damping { damping: 200.0, stiffness: 30.0 } })),
        ]
    }

    /// Derivatives and work of a rope from a drum, too, whose coordinate is an argument as it is.
    #[test]
    fn a_drum_is_as_exact_as_a_length() {
        let (h, strands) = (1e-6, Strands::new(&[2.0], 0.4, 1.5, 1e-12));
        let laws: [(&str, Box<dyn Law>); 2] = [
            ("elastic", Box::new(Taut { strands, pull: Elastic { stiffness: 30.0 } })),
            ("damping", Box::new(Taut { strands, pull: Damping { damping: 2.0, stiffness: 30.0 } })),
        ];
        for (name, law) in laws {
            for (from, to) in [([0.5, 0.3], [0.6, 0.2]), ([0.4, -0.5], [0.5, 0.9]), ([0.2, 1.2], [0.5, 0.1]), ([0.5, 0.3], [0.5, 0.2])] {
                let (here, now) = (at(&*law, from, [0.7, -0.3]), between(&*law, from, to));
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let of = |value, rate| at(&*law, value, rate).force[i];
                    let rate = [0.7, -0.3];
                    close(name, here.by_value[i][j], (of(moved(from, j, h), rate) - of(moved(from, j, -h), rate)) / (2.0 * h));
                    close(name, here.by_rate[i][j], (of(from, moved(rate, j, h)) - of(from, moved(rate, j, -h))) / (2.0 * h));
                    let of = |to| between(&*law, from, to).force[i];
                    close(name, now.by_value[i][j], (of(moved(to, j, h)) - of(moved(to, j, -h))) / (2.0 * h));
                }
                let work: f64 = (0..2).map(|i| now.force[i] * (to[i] - from[i])).sum();
                let rise = law.energy(&to) - law.energy(&from);
                assert!(if law.conservative() { (work - rise).abs() < 1e-13 } else { work >= 0.0 }, "{name}: {work} and {rise} J");
            }
        }
    }

    /// Half the squares of two lengths.
    fn halves(lengths: [f64; 2]) -> [f64; 2] {
        lengths.map(|length| 0.5 * length * length)
    }

    fn at(law: &dyn Law, value: [f64; 2], rate: [f64; 2]) -> Response {
        let mut out = Response::default();
        law.at(&value, &rate, 0.3, &mut out);
        out
    }

    fn between(law: &dyn Law, from: [f64; 2], to: [f64; 2]) -> Response {
        let mut out = Response::default();
        law.between(Reach { from: &from, to: &to, step: 0.1, middle: 0.3 }, &mut out);
        out
    }

    fn moved(mut value: [f64; 2], j: usize, by: f64) -> [f64; 2] {
        value[j] += by;
        value
    }

    fn close(name: &str, analytic: f64, numeric: f64) {
        assert!((analytic - numeric).abs() <= 1e-6 * (1.0 + numeric.abs()), "{name}: {analytic} against {numeric}");
    }

    #[test]
    fn derivatives_at_a_state_agree_with_differences() {
        let h = 1e-6;
        for (name, law) in laws() {
            // Taut while it gets longer and shorter, and slack.
            for (lengths, rate) in [([1.2, 1.1], [0.3, 0.2]), ([1.5, 1.0], [-0.4, -0.3]), ([0.8, 0.9], [0.3, 0.2])] {
                let value = halves(lengths);
                let here = at(&*law, value, rate);
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let of = |value, rate| at(&*law, value, rate).force[i];
                    close(name, here.by_value[i][j], (of(moved(value, j, h), rate) - of(moved(value, j, -h), rate)) / (2.0 * h));
                    close(name, here.by_rate[i][j], (of(value, moved(rate, j, h)) - of(value, moved(rate, j, -h))) / (2.0 * h));
                }
                if law.conservative() {
                    let gradient = (law.energy(&moved(value, 1, h)) - law.energy(&moved(value, 1, -h))) / (2.0 * h);
                    close(name, here.force[1], gradient);
                }
            }
        }
    }

    #[test]
    fn derivatives_between_two_positions_agree_with_differences_and_the_work_is_exact() {
        let h = 1e-6;
        for (name, law) in laws() {
            // Taut, from slack to taut and back, slack, and not moving.
            for (from, to) in [
                ([1.2, 1.1], [1.4, 1.2]),
                ([1.4, 1.2], [1.2, 1.1]),
                ([1.0, 0.9], [1.1, 1.1]),
                ([1.1, 1.1], [1.0, 0.9]),
                ([0.8, 0.9], [0.9, 0.9]),
                ([1.2, 1.1], [1.2, 1.1]),
            ] {
                let [from, to] = [from, to].map(halves);
                let here = between(&*law, from, to);
                for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    let of = |to| between(&*law, from, to).force[i];
                    close(name, here.by_value[i][j], (of(moved(to, j, h)) - of(moved(to, j, -h))) / (2.0 * h));
                }
                let work: f64 = (0..2).map(|i| here.force[i] * (to[i] - from[i])).sum();
                if law.conservative() {
                    let rise = law.energy(&to) - law.energy(&from);
                    assert!((work - rise).abs() < 1e-13, "{name}: work {work}, energy {rise}");
                } else {
                    assert!(work >= 0.0, "{name} gives {work}");
                }
            }
        }
    }

    /// A rope that gets taut by a rounding has a tension and a tangent as small as that.
    #[test]
    fn a_rounding_past_its_length_is_nothing() {
        for (name, law) in laws() {
            for (from, to) in [([1.0, 1.0], [1.0, 1.0 + 3e-16]), ([1.0, 1.0 - 2e-16], [1.0 + 3e-16, 1.0]), ([1.0, 1.0 + 3e-16], [1.0, 1.0])]
            {
                let here = between(&*law, halves(from), halves(to));
                assert!(here.force[..2].iter().all(|force| force.abs() < 1e-11), "{name}: {:?}", here.force);
                let tangent = here.by_value.iter().flatten().all(|slope| slope.is_finite() && slope.abs() < 1e4);
                assert!(tangent, "{name}: {:?}", here.by_value);
            }
        }
    }

    #[test]
    fn a_rope_never_pushes() {
        let laws = laws();
        for speed in [-100.0, -1.0, 0.0, 1.0] {
            for lengths in [[1.0, 1.0000001], [1.3, 1.2], [0.9, 0.9]] {
                let value = halves(lengths);
                let pull = |law: &dyn Law| at(law, value, [lengths[0] * speed, lengths[1] * speed]).force[0];
                assert!(pull(&*laws[0].1) + pull(&*laws[1].1) >= 0.0 && pull(&*laws[0].1) + pull(&*laws[2].1) >= 0.0);
                let next = halves(lengths.map(|length| length * (1.0 + 0.1 * speed).max(0.5)));
                let pull = |law: &dyn Law| between(law, value, next).force[0];
                assert!(pull(&*laws[0].1) + pull(&*laws[1].1) >= 0.0 && pull(&*laws[0].1) + pull(&*laws[2].1) >= 0.0);
            }
        }
    }
}
