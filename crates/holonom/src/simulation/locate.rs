//! Finds the time of an event.

use super::Simulation;
use super::bracket::Bracket;
use super::checkpoint::Moment;
use super::events::{LOCATED, MOST_TRIES};
use crate::formulation::Failure;

impl Simulation {
    /// Goes to where the first event happens in the part that began at `before` and was to end at `until`. The k-th event has happened after the time
    /// `low`, and `beside` is what the indicators are where the part ended. Says when the event happens, a time by which it has happened, which it is,
    /// and what the indicators are then. All that comes before `lower` is done once.
    #[expect(clippy::too_many_arguments)] // what is known of the event and of the part
    pub(super) fn locate(
        &mut self,
        mut before: Moment,
        [lower, low, until]: [f64; 3],
        (mut k, mut beside): (usize, Vec<f64>),
        from: &[f64],
        shortest: f64,
        wants_forces: bool,
        crossed: &dyn Fn(&[f64]) -> Option<usize>,
    ) -> Result<(f64, f64, usize, Vec<f64>), Failure> {
        let end = self.state.t;
        let mut here = end;
        if lower > before.t() && low - lower > 2.0 * shortest {
            self.restore(&before);
            self.advance(lower, wants_forces, None)?;
            before = self.moment();
            here = lower;
        }
        let begin = before.t();
        // None has happened at its beginning, and the k-th has at its end.
        let mut bracket = Bracket::new([low, end], [from[k], beside[k]]);
        let width = (LOCATED * (end - begin)).max(f64::EPSILON * end.abs());
        for _ in 0..MOST_TRIES {
            if bracket.high - bracket.low <= width {
                break;
            }
            if bracket.high - begin <= 1.5 * shortest {
                // Over so short a time all that moves goes straight: the first of those that happen in it is the one.
                self.restore(&before);
                let happens = |at: &usize| self.system.events[*at].trigger.is_between(from[*at], beside[*at]);
                let time = |at: usize| (Bracket::new([begin, bracket.high], [from[at], beside[at]]).secant(), at);
                let first = (0..beside.len()).filter(happens).map(time).min_by(|a, b| a.0.total_cmp(&b.0));
                let (t, k) = first.unwrap_or((bracket.secant(), k));
                return Ok((t, bracket.high, k, beside));
            }
            here = bracket.next(width).max(begin + shortest).min(bracket.high);
            self.restore(&before);
            self.advance(here, wants_forces, None)?;
            let now = self.indicate().inspect_err(|_| self.restore(&before))?;
            match crossed(&now) {
                Some(other) => {
                    bracket.at_low = if other == k { bracket.at_low } else { from[other] };
                    bracket = bracket.narrowed(here, now[other], true);
                    k = other;
                    beside = now;
                }
                None => bracket = bracket.narrowed(here, now[k], false),
            }
        }
        let (mut high, mut ahead) = (bracket.high, width);
        loop {
            let lands = if until - high < shortest { until } else { high };
            if here != lands {
                self.restore(&before);
                self.advance(lands, wants_forces, None)?;
                here = lands;
            }
            // What an iteration leaves may have the event a little later than when it was looked for: it would happen again.
            if lands == until || crossed(&self.indicate()?).is_some() {
                return Ok((high, high, k, beside));
            }
            (high, ahead) = ((high + ahead).min(until), 2.0 * ahead);
        }
    }
}
