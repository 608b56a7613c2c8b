//! Functions of a column over a run, from its values after each step: the largest, the mean, the value at a time, …

use holonom::record::{Running, RunningValue};

use super::vibration::OfMode;
use crate::interpolation::Reading;

/// A function of the values of a column over a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Function {
    Last,
    /// Over all steps.
    Running(Running),
    /// The value at a time, s.
    At(f64),
    /// Not of a column: when an event happens first, s.
    TimeOf,
    /// Not of a run: of the mode of small vibrations about the start with a number.
    Mode(OfMode, usize),
}

impl Function {
    /// Functions that need nothing but the column, by their names.
    pub const NAMED: [(&str, Self); 5] = [
        ("last", Self::Last),
        ("max", Self::Running(Running::Max)),
        ("min", Self::Running(Running::Min)),
        ("mean", Self::Running(Running::Mean)),
        ("rms", Self::Running(Running::Rms)),
    ];
}

/// What is gathered of a column over a run. Where the column has no number at a step, neither have the functions of all steps.
#[derive(Clone, Debug)]
pub enum Gathered {
    /// With the value so far.
    Running(Running, RunningValue, Option<f64>),
    At(Reading),
}

impl Gathered {
    /// Nothing yet of a function of all steps; `None` of one that is known at the end.
    pub fn new(function: Function) -> Option<Self> {
        match function {
            Function::Last | Function::TimeOf | Function::Mode(..) => None,
            Function::Running(running) => Some(Self::Running(running, RunningValue::default(), None)),
            Function::At(t) => Some(Self::At(Reading::new(t))),
        }
    }

    /// Sees the value after a step, and the one at the start.
    pub fn see(&mut self, t: f64, value: f64) {
        match self {
            Self::Running(running, sum, so_far) => *so_far = Some(sum.add(*running, t, value)),
            Self::At(reading) => reading.see(t, value),
        }
    }

    /// Sees the value where a step is divided, before and after inputs are set: a value at a time is that of its step.
    pub fn see_division(&mut self, t: f64, value: f64) {
        if let Self::Running(..) = self {
            self.see(t, value);
        }
    }

    /// What the function makes of what was seen; nothing where it has no value.
    pub fn value(&self) -> Option<f64> {
        match self {
            Self::Running(_, _, so_far) => *so_far,
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
        assert_eq!(
            [Function::Running(Running::Max), Function::Running(Running::Min)].map(|function| of(function, &rows)),
            [Some(5.0), Some(-3.0)]
        );
        assert!(Gathered::new(Function::Last).is_none());
        assert_eq!(of(Function::Running(Running::Mean), &rows), Some((-1.0 + 2.0) / 3.0));
        // Of 1 to −3 straight within 1 s and −3 to 5 within 2 s: (1 − 3 + 9)/3 + 2 (9 − 15 + 25)/3 = 15.
        assert_eq!(of(Function::Running(Running::Rms), &rows), Some(5.0_f64.sqrt()));
        assert_eq!(of(Function::At(1.0), &rows), Some(-3.0));
    }

    #[test]
    fn a_single_row_has_them_all_and_none_has_none() {
        for (function, value) in [
            (Function::Running(Running::Max), -2.0),
            (Function::Running(Running::Min), -2.0),
            (Function::Running(Running::Mean), -2.0),
            (Function::Running(Running::Rms), 2.0),
        ] {
            assert_eq!(of(function, &[(0.0, -2.0)]), Some(value));
            assert_eq!(of(function, &[]), None);
        }
        assert_eq!((of(Function::At(0.0), &[]), of(Function::At(1.0), &[(0.0, 1.0)])), (None, None));
    }

    #[test]
    fn a_step_without_a_number_shows() {
        for at in 0..3 {
            let rows: Vec<(f64, f64)> = (0..3).map(|k| (f64::from(k), if k == at { f64::NAN } else { f64::from(k) })).collect();
            for function in [
                Function::Running(Running::Max),
                Function::Running(Running::Min),
                Function::Running(Running::Mean),
                Function::Running(Running::Rms),
            ] {
                assert!(of(function, &rows).is_some_and(f64::is_nan), "{function:?} {at}");
            }
        }
    }
}
