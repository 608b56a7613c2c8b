//! An axis of a plot: where a value lies on it, and its ticks.

use crate::digits::rounded;
use crate::format;

/// Where values lie.
#[derive(Clone, Debug, PartialEq)]
pub enum Axis {
    /// Numbers with equal differences, or equal ratios, from `low` to `high`.
    Numbers { low: f64, high: f64, is_logarithmic: bool },
    /// Words, one beside the other.
    Words(Vec<String>),
}

/// Ticks that an axis is to have, about.
const TICKS: f64 = 5.0;

/// Ratio of the largest to the least value beyond which equal ratios show more.
const MANY_DECADES: f64 = 1e3;

/// Words that have a tick.
const MOST_WORDS: usize = 8;

/// Fewest powers of ten, and 2 and 5 times them, that are enough for a logarithmic axis.
const FEWEST: usize = 3;

/// Characters that ticks have room for along the whole axis.
const ROOM: usize = 54;

impl Axis {
    /// The axis of a key: of numbers where all its values are numbers.
    pub fn of_key<'a>(values: impl Iterator<Item = &'a str> + Clone, is_logarithmic: bool) -> Self {
        let numbers: Option<Vec<f64>> = values.clone().map(|text| text.parse().ok().filter(|number: &f64| number.is_finite())).collect();
        match numbers {
            Some(numbers) => Self::over(&numbers, is_logarithmic),
            None => {
                let mut words: Vec<String> = Vec::new();
                for value in values {
                    if !words.iter().any(|word| word == value) {
                        words.push(value.into());
                    }
                }
                Self::Words(words)
            }
        }
    }

    /// The axis of the values of a column.
    pub fn of_values(values: &[f64]) -> Self {
        let (least, most) = ends(values);
        Self::over(values, least > 0.0 && most / least >= MANY_DECADES)
    }

    fn over(values: &[f64], is_logarithmic: bool) -> Self {
        let (least, most) = ends(values);
        let is_logarithmic = is_logarithmic && least * most > 0.0;
        if are_different(least, most) {
            return Self::Numbers { low: least, high: most, is_logarithmic };
        }
        // All values are alike.
        let around = if least.abs() < LEAST { 1.0 } else { 0.1 * least.abs() };
        Self::Numbers { low: least - around, high: most + around, is_logarithmic: false }
    }

    /// Moves the ends of an axis of numbers out to the next ticks.
    pub fn rounded(self) -> Self {
        match self {
            Self::Numbers { low, high, is_logarithmic: false } => {
                let step = step(low, high);
                Self::Numbers { low: (low / step).floor() * step, high: (high / step).ceil() * step, is_logarithmic: false }
            }
            Self::Numbers { low, high, is_logarithmic: true } if low > 0.0 => {
                Self::Numbers { low: 10f64.powf(low.log10().floor()), high: 10f64.powf(high.log10().ceil()), is_logarithmic: true }
            }
            other => other,
        }
    }

    /// Share of the length at which a value lies; nothing for what has no place.
    pub fn place(&self, text: &str) -> Option<f64> {
        match self {
            Self::Numbers { .. } => self.at(text.parse().ok()?),
            Self::Words(words) => {
                let k = words.iter().position(|word| word == text)?;
                Some((k as f64 + 0.5) / words.len() as f64)
            }
        }
    }

    /// The same of a number.
    pub fn at(&self, value: f64) -> Option<f64> {
        let Self::Numbers { low, high, is_logarithmic } = *self else { return None };
        let share = if is_logarithmic { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) };
        Some(share).filter(|share| share.is_finite())
    }

    /// Places and labels.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        match self {
            Self::Words(words) => {
                let stride = words.len().div_ceil(MOST_WORDS).max(1);
                let (shown, room) = (words.iter().step_by(stride), room(words.len().div_ceil(stride)));
                shown.filter_map(|word| Some((self.place(word)?, shortened(word, room)))).collect()
            }
            Self::Numbers { low, high, is_logarithmic } => {
                // Within a decade there are hardly any powers of ten to read values off.
                if let Some(powers) = is_logarithmic.then(|| logarithmic(*low, *high)).filter(|powers| powers.len() >= FEWEST) {
                    return powers.into_iter().filter_map(|value| Some((self.at(value)?, label(value)))).collect();
                }
                let decimals = (-step(*low, *high).log10().floor()).max(0.0) as usize;
                let fine =
                    |value: f64| if (1e-3..1e6).contains(&value.abs()) { minus(&format!("{value:.decimals$}")) } else { label(value) };
                even(*low, *high).into_iter().filter_map(|value| Some((self.at(value)?, fine(value)))).collect()
            }
        }
    }
}

/// A number at a tick.
pub fn label(value: f64) -> String {
    minus(&format::number(value))
}

/// A number with so many significant figures at most.
pub fn figures(value: f64, figures: usize) -> String {
    let rounded = rounded(value, figures);
    if figures <= format::FIGURES {
        return label(rounded);
    }
    let decimals = (figures as f64 - 1.0 - rounded.abs().log10().floor()).max(0.0) as usize;
    minus(&if (1e-3..1e6).contains(&rounded.abs()) { format!("{rounded:.decimals$}") } else { format!("{value:.*e}", figures - 1) })
}

fn minus(text: &str) -> String {
    text.replace('-', "\u{2212}")
}

/// Characters that each of so many ticks below a plot has room for.
pub fn room(ticks: usize) -> usize {
    ROOM / ticks.max(1)
}

/// A word of at most so many characters.
pub fn shortened(word: &str, room: usize) -> String {
    match word.chars().count() > room {
        true => word.chars().take(room - 1).chain(['…']).collect(),
        false => word.into(),
    }
}

/// Whether two numbers differ by more than round-off.
pub fn are_different(least: f64, most: f64) -> bool {
    let size = most.abs().max(least.abs());
    size > LEAST && most - least > ROUND_OFF * size
}

/// Sizes below this count as zero, as their tenth has no place among numbers.
const LEAST: f64 = 1e-290;

/// Share of values by which round-off may set them apart.
const ROUND_OFF: f64 = 1e-9;

fn ends(values: &[f64]) -> (f64, f64) {
    let finite = || values.iter().copied().filter(|value| value.is_finite());
    (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max))
}

/// Distance of even ticks: 1, 2 or 5 times a power of ten.
fn step(low: f64, high: f64) -> f64 {
    let rough = (high - low) / TICKS;
    let power = 10f64.powf(rough.log10().floor());
    let lead = [1.0, 2.0, 5.0, 10.0].into_iter().find(|lead| lead * power >= rough * (1.0 - 1e-9)).unwrap_or(10.0);
    lead * power
}

fn even(low: f64, high: f64) -> Vec<f64> {
    let step = step(low, high);
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    // Divided, as 3 × 0.1 is not 0.3.
    let value = |k: i64| if step < 1.0 { k as f64 / (1.0 / step).round() } else { k as f64 * step };
    (first..=last).map(value).collect()
}

/// Powers of ten, with 2 and 5 times them where they are few. Ends of one sign.
fn logarithmic(low: f64, high: f64) -> Vec<f64> {
    let sign = low.signum();
    let (small, large) = (low.abs().min(high.abs()), low.abs().max(high.abs()));
    let decades = large.log10() - small.log10();
    let leads: &[f64] = if decades < 2.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let stride = (decades / 6.0).ceil().max(1.0) as usize;
    let powers = (small.log10().floor() as i32..=large.log10().ceil() as i32).step_by(stride);
    let all = powers.flat_map(|power| leads.iter().map(move |lead| lead * 10f64.powi(power)));
    all.filter(|v| (small * (1.0 - 1e-9)..=large * (1.0 + 1e-9)).contains(v)).map(|v| sign * v).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<String> {
        axis.ticks().into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn numbers_have_round_ticks_and_their_places() {
        let axis = Axis::of_key(["0.1", "0.4", "0.7"].into_iter(), false);
        assert_eq!((axis.place("0.1"), axis.place("0.7")), (Some(0.0), Some(1.0)));
        assert_eq!(labels(&axis), ["0.2", "0.4", "0.6"]);
        assert_eq!(labels(&Axis::of_values(&[-3.2, 4.1]).rounded()), ["\u{2212}4", "\u{2212}2", "0", "2", "4", "6"]);
        let axis = Axis::of_key(["1000", "100000"].into_iter(), true);
        assert_eq!((labels(&axis), axis.place("10000")), (["1000", "10000", "100000"].map(String::from).to_vec(), Some(0.5)));
        assert_eq!(labels(&Axis::of_key(["20000", "80000"].into_iter(), true)), ["20000", "40000", "60000", "80000"]);
        assert_eq!(labels(&Axis::of_key(["2.1", "2.4"].into_iter(), true)), ["2.1", "2.2", "2.3", "2.4"]);
        assert_eq!(labels(&Axis::of_key(["-1", "-100"].into_iter(), true)), ["\u{2212}1", "\u{2212}10", "\u{2212}100"]);
        assert_eq!(labels(&Axis::of_values(&[1e-12, 3.0]).rounded()).len(), 5);
        assert_eq!(labels(&Axis::of_values(&[9.810001, 9.810003])), ["9.8100010", "9.8100015", "9.8100020", "9.8100025", "9.8100030"]);
    }

    #[test]
    fn words_stand_side_by_side() {
        let axis = Axis::of_key(["radau", "1", "radau"].into_iter(), false);
        assert_eq!((axis.place("radau"), axis.place("1"), axis.place("bdf")), (Some(0.25), Some(0.75), None));
        assert_eq!([shortened("trapezoidal-projected", 8), shortened("radau", 5)], ["trapezo…", "radau"]);
    }

    #[test]
    fn equal_values_and_no_numbers_are_no_fault() {
        for values in [&[2.0, 2.0][..], &[0.0], &[f64::NAN, 1.0, f64::INFINITY], &[5e-324, 1e-323], &[1e300, 1.0]] {
            let axis = Axis::of_values(values).rounded();
            assert!(axis.ticks().len() > 1, "{values:?} {axis:?}");
            assert!(axis.at(values[values.len() - 1].min(1e300)).is_some(), "{values:?} {axis:?}");
            assert!(axis.ticks().len() < 20, "{values:?}");
        }
    }
}
