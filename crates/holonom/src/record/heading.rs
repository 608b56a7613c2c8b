//! What a column of a recording shows.

use std::borrow::Cow;
use std::sync::Arc;

/// Name, unit and meaning of a column.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Heading {
    /// As in the header of `trajectory.csv`, e.g. `energy` or `m1.x`.
    pub name: String,
    /// SI unit, of measures and inputs as the author states it; `"1"` of numbers without one.
    pub unit: Cow<'static, str>,
    /// What it shows, in a line: the same one for the columns of many bodies.
    pub meaning: Arc<str>,
}

impl Heading {
    pub(crate) fn new(name: impl Into<String>, unit: impl Into<Cow<'static, str>>, meaning: impl Into<Arc<str>>) -> Self {
        Self { name: name.into(), unit: unit.into(), meaning: meaning.into() }
    }
}

/// What things of one kind show: the ending of each column behind their name, its unit and its meaning.
#[derive(Default)]
pub(super) struct Endings(Vec<(String, &'static str, Arc<str>)>);

impl Endings {
    pub fn add(&mut self, ending: impl Into<String>, unit: &'static str, meaning: impl Into<Arc<str>>) {
        self.0.push((ending.into(), unit, meaning.into()));
    }

    /// The columns of one of these things.
    pub fn of<'a>(&'a self, name: &'a str) -> impl Iterator<Item = Heading> + 'a {
        self.0.iter().map(move |(ending, unit, meaning)| Heading::new(format!("{name}.{ending}"), *unit, Arc::clone(meaning)))
    }
}

/// Of a column of which only the name is known.
impl From<String> for Heading {
    fn from(name: String) -> Self {
        Self::new(name, "1", "")
    }
}

/// Units of a coordinate and of what goes with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Units {
    pub value: &'static str,
    pub rate: &'static str,
    pub effort: &'static str,
}

impl Units {
    /// Of an angle, or of a displacement.
    pub const fn of(is_angle: bool) -> Self {
        match is_angle {
            true => Self { value: "rad", rate: "rad/s", effort: "N·m" },
            false => Self { value: "m", rate: "m/s", effort: "N" },
        }
    }
}
