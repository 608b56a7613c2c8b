//! `[input.NAME]`: numbers from outside, which the program that runs a model sets between steps.

use super::entry::Entry;
use super::fault::Read;
use super::fields::{Keys, Number};
use super::parameters::{require_no_number, require_own_name};
use crate::record::RecordedInput;

/// `[input.NAME]`
#[derive(Clone, Debug, Default, PartialEq, Keys)]
#[table("an input")]
pub struct Input {
    /// what it is until it is set
    #[key(default = "0")]
    pub default: Option<Number>,
    /// for people
    #[key(default = "none")]
    pub unit: Option<String>,
    /// one line for people
    #[key(default = "none")]
    pub meaning: Option<String>,
}

impl Input {
    /// How it is recorded, and what it is until it is set.
    pub(super) fn recorded(&self, entry: &Entry<'_>) -> Read<(RecordedInput, f64)> {
        require_own_name(entry)?;
        require_no_number(entry)?;
        let default = entry.optional("default", &self.default, Number::number)?.unwrap_or(0.0);
        let unit = self.unit.clone().unwrap_or_else(|| "1".into());
        let meaning = self.meaning.clone().unwrap_or_else(|| "input".into());
        Ok((RecordedInput { name: entry.name.into(), unit, meaning }, default))
    }
}
