//! `[event.NAME]`: conditions whose times are found, and what happens then or at a fixed rate.

use std::sync::Arc;

use smallvec::SmallVec;

use super::assembly::Assembly;
use super::entry::{Entry, all};
use super::expression::{Program, indexed};
use super::fault::{Read, suggest};
use super::fields::{Keys, Map, Number};
use super::key::Shape;
use super::settings::require_countable;
use super::signals::{Reader, Readings};
use crate::system::{self, Crossing, Indicator, Reading, Trigger};

/// `[event.NAME]`
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("an event")]
pub struct Event {
    /// a formula that is zero when it happens, of what moves, inputs, measures and `t`
    #[key(default = "needed without `every`", shape = Shape::Formula(&["t"]))]
    pub when: Option<Number>,
    /// which way the formula goes through zero then
    #[key(default = "\"both\"", shape = Shape::Choice(DIRECTIONS))]
    pub direction: Option<String>,
    /// the period with which it happens, from t = 0 on
    #[key(unit = "s", default = "none")]
    pub every: Option<Number>,
    /// whether the run ends there
    #[key(default = "false")]
    pub stop: Option<bool>,
    /// inputs that are set there, and to what: formulas of what moves, inputs, measures and `t`
    #[key(default = "none")]
    pub set: Option<Map<Number>>,
}

const DIRECTIONS: &[&str] = &["rising", "falling", "both"];

impl Event {
    /// Adds the event to a run that ends at `end` (s), where that is known.
    pub(super) fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, end: Option<f64>) -> Read<()> {
        let mut readings = Readings::new(assembly.dimension(), Reading::default());
        let moment = self.moment(assembly, entry, end, &mut readings);
        let set = entry.optional("set", &self.set, |set, entry, key| {
            let inputs: Vec<String> = assembly.signals.inputs.iter().map(|input| input.name.clone()).collect();
            let mut one = |(name, value): &(String, Number), entry: &Entry<'_>| {
                let full = indexed(name, &entry.scope).map_err(|mistake| entry.mistaken(name.as_str().into(), mistake))?;
                let input = inputs.iter().position(|known| *known == full).ok_or_else(|| {
                    let cure = match entry.scope.parameters.is_some_and(|known| known.contains_key(&full)) {
                        true => format!("parameters stay as they are: take `{full}` out of [parameters], and add [input.{full}] with its number as the default"),
                        false if inputs.is_empty() => format!("add [input.{full}]"),
                        false => suggest(&full, inputs.iter().map(String::as_str)),
                    };
                    entry.refuse_key(name, format!("there is no input `{full}`"), cure)
                })?;
                let mut reader = Reader::new(assembly, entry, &mut readings);
                Ok((input, value.formula_reading(entry, name.as_str(), &["t"], &mut reader)?))
            };
            entry.within(key, set, |inner| all(set.iter().map(|given| one(given, inner))))
        });
        let (moment, set) = (moment?, set?.unwrap_or_default());
        if matches!(moment, Moment::Every(_)) && set.is_empty() {
            return Err(entry.refuse("every", "nothing happens then", "set an input: set = { NAME = \"formula\" }"));
        }
        let reading = readings.reading.clone();
        let readings = Arc::new(readings);
        let of = |formula: Program| Arc::new(Formula { readings: readings.clone(), formula }) as Arc<dyn Indicator>;
        let event = system::Event {
            name: entry.name.to_string(),
            reading,
            trigger: match moment {
                Moment::When(formula, crossing) => Trigger::When(of(formula), crossing),
                Moment::Every(period) => Trigger::Every(period),
            },
            stops: self.stop.unwrap_or(false),
            set: set.into_iter().map(|(input, formula)| (input, of(formula))).collect(),
        };
        assembly.builder.event(event);
        Ok(())
    }

    fn moment(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>, end: Option<f64>, readings: &mut Readings) -> Read<Moment> {
        match (&self.when, &self.every) {
            (Some(when), None) => {
                let direction = entry.optional("direction", &self.direction, |word, entry, key| entry.choice(key, word, DIRECTIONS));
                let when = when.formula_reading(entry, "when", &["t"], &mut Reader::new(assembly, entry, readings));
                let (direction, when) = (direction?, when?);
                if when.as_constant().is_some() {
                    let cure = "write a formula of what moves, or of t";
                    return Err(entry.refuse("when", "this never changes, so that nothing happens", cure));
                }
                let crossing = match direction {
                    Some("rising") => Crossing::Rising,
                    Some("falling") => Crossing::Falling,
                    _ => Crossing::Both,
                };
                Ok(Moment::When(when, crossing))
            }
            (None, Some(period)) => {
                let of_conditions = [("direction", self.direction.is_some()), ("stop", self.stop == Some(true))];
                if let Some((key, _)) = of_conditions.into_iter().find(|(_, is_given)| *is_given) {
                    let message = format!("`{key}` is of a condition, and this happens all the time");
                    return Err(entry.refuse(key, message, "remove it, or write when = \"formula\" in place of `every`"));
                }
                let period = period.positive(entry, "every")?;
                end.map_or(Ok(()), |end| require_countable(entry, "every", "periods", [end, period]))?;
                Ok(Moment::Every(period))
            }
            (Some(_), Some(_)) => {
                Err(entry.refuse("every", "an event happens on a condition or with a period, and this has both", "make two events of it"))
            }
            (None, None) => {
                let cure = "add when = \"formula that is zero then\", or every = 0.01";
                Err(entry.refuse_all(format!("`{}` has neither `when` nor `every`", entry.name), cure))
            }
        }
    }
}

/// When an event happens.
enum Moment {
    When(Program, Crossing),
    Every(f64),
}

/// A formula of what an event reads.
struct Formula {
    readings: Arc<Readings>,
    formula: Program,
}

impl Indicator for Formula {
    fn value(&self, x: &[f64], v: &[f64], t: f64) -> f64 {
        let mut variables = SmallVec::from_slice(&[t]);
        self.readings.append(x, v, &mut variables);
        self.formula.evaluate(&variables)
    }
}
