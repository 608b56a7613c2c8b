//! `[event.NAME]`: conditions whose times are found, and what happens then.

use std::sync::Arc;

use smallvec::SmallVec;

use super::assembly::Assembly;
use super::entry::{Entry, all};
use super::expression::Program;
use super::fault::{Read, suggest};
use super::fields::{Keys, Map, Number};
use super::key::Shape;
use super::signals::{Reader, Readings};
use crate::system::{self, Crossing, Indicator, Reading};

/// `[event.NAME]`
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("an event")]
pub struct Event {
    /// a formula that is zero when it happens, of what moves, inputs, measures and `t`
    #[key(shape = Shape::Formula(&["t"]))]
    pub when: Number,
    /// which way the formula goes through zero then
    #[key(default = "\"both\"", shape = Shape::Choice(DIRECTIONS))]
    pub direction: Option<String>,
    /// whether the run ends there
    #[key(default = "false")]
    pub stop: Option<bool>,
    /// inputs that are set there, and to what
    #[key(default = "none")]
    pub set: Option<Map<Number>>,
}

const DIRECTIONS: &[&str] = &["rising", "falling", "both"];

impl Event {
    pub(super) fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let direction = entry.optional("direction", &self.direction, |word, entry, key| entry.choice(key, word, DIRECTIONS));
        let set = entry.optional("set", &self.set, |set, entry, key| {
            let inputs: Vec<String> = assembly.signals.inputs.iter().map(|input| input.name.clone()).collect();
            let one = |(name, value): &(String, Number), entry: &Entry<'_>| {
                let input = inputs.iter().position(|known| known == name).ok_or_else(|| {
                    let cure =
                        if inputs.is_empty() { format!("add [input.{name}]") } else { suggest(name, inputs.iter().map(String::as_str)) };
                    entry.refuse_key(name, format!("there is no input `{name}`"), cure)
                })?;
                Ok((input, value.number(entry, name.as_str())?))
            };
            entry.within(key, set, |inner| all(set.iter().map(|given| one(given, inner))))
        });
        let mut readings = Readings::new(assembly.dimension(), Reading::default());
        let when = self.when.formula_reading(entry, "when", &["t"], &mut Reader::new(assembly, entry, &mut readings));
        let (direction, set, when) = (direction?, set?.unwrap_or_default(), when?);
        if when.as_constant().is_some() {
            return Err(entry.refuse("when", "this never changes, so that nothing happens", "write a formula of what moves, or of t"));
        }
        let crossing = match direction {
            Some("rising") => Crossing::Rising,
            Some("falling") => Crossing::Falling,
            _ => Crossing::Both,
        };
        let event = system::Event {
            name: entry.name.to_string(),
            reading: readings.reading.clone(),
            indicator: Arc::new(When { readings, when }),
            crossing,
            stops: self.stop.unwrap_or(false),
            set,
        };
        assembly.builder.event(event);
        Ok(())
    }
}

struct When {
    readings: Readings,
    when: Program,
}

impl Indicator for When {
    fn value(&self, x: &[f64], v: &[f64], t: f64) -> f64 {
        let mut variables = SmallVec::from_slice(&[t]);
        self.readings.append(x, v, t, &mut variables);
        self.when.evaluate(&variables)
    }
}
