//! Columns of small vibrations about the start: numbers of a mode, as `holonom modes` tells them.

use holonom::analysis::{Mode, Modes};

use super::column::Asked;
use super::reduction::Function;
use crate::notes::{driven, kinked, slowest};
use crate::table::short;

/// A number of a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OfMode {
    Frequency,
    Damping,
    Growth,
}

impl OfMode {
    /// All of them, by their names.
    pub const NAMED: [(&str, Self); 3] = [("frequency", Self::Frequency), ("damping", Self::Damping), ("growth", Self::Growth)];

    /// Its SI unit.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Frequency => "Hz",
            Self::Damping => "1",
            Self::Growth => "1/s",
        }
    }

    fn value(self, modes: &Modes, number: usize) -> Option<f64> {
        match self {
            Self::Frequency => modes.vibration(number).map(|mode| mode.frequency),
            Self::Damping => modes.vibration(number).map(Mode::damping),
            Self::Growth => modes.growth(number),
        }
    }
}

/// Puts the numbers of modes into the values of the columns that ask for them.
pub fn fill(values: &mut [Option<f64>], asked: &[Asked], modes: &Modes) {
    for (value, asked) in values.iter_mut().zip(asked) {
        if let Function::Mode(of, number) = asked.function {
            *value = of.value(modes, number);
        }
    }
}

/// What is said of the modes of a run.
pub fn notes(modes: &Modes) -> Vec<String> {
    let growing = modes.modes.iter().enumerate().filter(|(_, mode)| mode.growth > 0.0);
    let unstable = growing.max_by(|(_, a), (_, b)| a.growth.total_cmp(&b.growth)).map(|(k, mode)| {
        let time = short(1.0 / mode.growth);
        format!("the start is not stable, as mode {} grows by the factor e in {time} s", modes.number(k))
    });
    let unsure = (modes.unsure > 0)
        .then(|| format!("{} exponents cannot be told from rounding beside the others, and modes are counted without them", modes.unsure));
    unstable.into_iter().chain(slowest(modes)).chain(unsure).chain(driven(modes).map(String::from)).chain(kinked(modes)).collect()
}
