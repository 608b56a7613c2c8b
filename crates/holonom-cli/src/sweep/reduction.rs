//! Functions of a column over a run, from its values after each step: the largest, the mean, the value at a time, …

use crate::interpolation::Reading;
use crate::mean::Mean;

/// A function of the values of a column over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Function {
    Last,
    Max,
    Min,
    /// Over time.
    Mean,
    /// Root of the mean of the squares over time.
    Rms,
    /// The value at a time, s.
    At(f64),
}

impl Function {
    /// Functions that need nothing but the column, by their names.
    pub const NAMED: [(&str, Self); 5] =
        [("last", Self::Last), ("max", Self::Max), ("min", Self::Min), ("mean", Self::Mean), ("rms", Self::Rms)];
}

/// What is gathered of a column over a run. Steps in which the column has no number are left out.
#[derive(Clone, Debug)]
pub enum Gathered {
    Max(Option<f64>),
    Min(Option<f64>),
    Mean(Mean),
    Rms(Mean),
    At(Reading),
}

impl Gathered {
    /// Nothing yet of a function of all steps; `None` of one that needs the last only.
    pub fn new(function: Function) -> Option<Self> {
        match function {
            Function::Last => None,
            Function::Max => Some(Self::Max(None)),
            Function::Min => Some(Self::Min(None)),
            Function::Mean => Some(Self::Mean(Mean::default())),
            Function::Rms => Some(Self::Rms(Mean::default())),
            Function::At(t) => Some(Self::At(Reading::new(t))),
        }
    }

    /// Sees the value after a step, and the one at the start.
    pub fn see(&mut self, t: f64, value: f64) {
        match self {
            Self::Max(most) if !value.is_nan() => *most = Some(most.map_or(value, |most| most.max(value))),
            Self::Min(least) if !value.is_nan() => *least = Some(least.map_or(value, |least| least.min(value))),
            Self::Max(_) | Self::Min(_) => (),
            Self::Mean(mean) => mean.see(t, value),
            Self::Rms(mean) => mean.see(t, value * value),
            Self::At(reading) => reading.see(t, value),
        }
    }

    /// What the function makes of what was seen; nothing where it has no value.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Max(found) | Self::Min(found) => *found,
            Self::Mean(mean) => mean.value(),
            Self::Rms(mean) => mean.value().map(f64::sqrt),
            Self::At(reading) => reading.value(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(function: Function, rows: &[(f64, f64)]) -> Option<f64> {
        let mut gathered = Gathered::new(function).unwrap();
        rows.iter().for_each(|&(t, value)| gathered.see(t, value));
        gathered.value()
    }

    #[test]
    fn functions_of_a_few_rows_are_those_by_hand() {
        // Steps of unequal length weigh as long as they are.
        let rows = [(0.0, 1.0), (1.0, -3.0), (3.0, 5.0)];
        assert_eq!([Function::Max, Function::Min].map(|function| of(function, &rows)), [Some(5.0), Some(-3.0)]);
        assert!(Gathered::new(Function::Last).is_none());
        assert_eq!(of(Function::Mean, &rows), Some((-1.0 + 2.0) / 3.0));
        assert_eq!(of(Function::Rms, &rows), Some(((5.0 + 34.0) / 3.0_f64).sqrt()));
        assert_eq!(of(Function::At(1.0), &rows), Some(-3.0));
    }

    #[test]
    fn a_single_row_has_them_all_and_none_has_none() {
        for (function, value) in [(Function::Max, -2.0), (Function::Min, -2.0), (Function::Mean, -2.0), (Function::Rms, 2.0)] {
            assert_eq!(of(function, &[(0.0, -2.0)]), Some(value));
            assert_eq!(of(function, &[]), None);
        }
        assert_eq!((of(Function::At(0.0), &[]), of(Function::At(1.0), &[(0.0, 1.0)])), (None, None));
    }

    #[test]
    fn steps_without_a_number_are_left_out() {
        let rows = [(0.0, f64::NAN), (1.0, 1.0), (2.0, 3.0), (3.0, f64::NAN), (4.0, 5.0), (5.0, 5.0)];
        assert_eq!((of(Function::Max, &rows), of(Function::Min, &rows), of(Function::Mean, &rows)), (Some(5.0), Some(1.0), Some(3.5)));
        assert_eq!(of(Function::Rms, &[(0.0, f64::NAN), (1.0, f64::NAN)]), None);
    }
}
