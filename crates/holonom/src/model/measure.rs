//! `[measure.NAME]`: formulas of what the mechanism does, recorded like any other column and read by others.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::entry::Entry;
use super::expression::{Mistake, Names, Program, beside, nearest_beside};
use super::fault::{Fault, Read, Sink, nearest};
use super::fields::{Field, Keys, Number};
use super::key::Shape;
use super::parameters::require_no_number;
use super::value::key_path;
use crate::record::{COLUMNS, MeasureReads, RecordedMeasure, Running, Series};

/// `[measure.NAME]`
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a measure")]
pub struct Measure {
    /// a formula of any recorded columns and other measures, by their names: `distance(hook, drum.top)`, `max(strut.force)`
    #[key(shape = Shape::Formula(&["t"]))]
    pub value: Number,
    /// as the author states it
    #[key(default = "none")]
    pub unit: Option<String>,
    /// one line for people
    #[key(default = "the formula")]
    pub meaning: Option<String>,
}

/// The columns of a model while formulas of them are read.
pub(super) struct Columns<'a> {
    /// Names of all columns that are recorded, and of all measures.
    pub known: &'a HashSet<String>,
    /// Why columns that there might be are not recorded.
    pub missing: &'a dyn Fn(&str) -> Option<Mistake>,
    pub axes: &'static str,
}

/// What one formula reads, in the order of its variables.
struct Reads<'a> {
    columns: &'a Columns<'a>,
    reads: Vec<MeasureReads>,
    series: Vec<Series>,
}

impl Names for Reads<'_> {
    fn variable(&mut self, name: &str) -> Result<Option<usize>, Mistake> {
        if !self.columns.known.contains(name) {
            return (self.columns.missing)(name).map_or(Ok(None), Err);
        }
        let is = |read: &MeasureReads| matches!(read, MeasureReads::Column(known) if known == name);
        if let Some(known) = self.reads.iter().position(is) {
            return Ok(Some(known));
        }
        self.reads.push(MeasureReads::Column(name.to_string()));
        Ok(Some(self.reads.len() - 1))
    }

    fn running(&mut self, running: Running, of: Program) -> Option<usize> {
        self.series.push(Series { running, of: Arc::new(of) });
        self.reads.push(MeasureReads::Series(self.series.len() - 1));
        Some(self.reads.len() - 1)
    }

    fn axes(&self) -> Option<&'static str> {
        Some(self.columns.axes)
    }

    fn has(&self, name: &str) -> bool {
        self.columns.known.contains(name)
    }

    fn known(&self) -> Vec<String> {
        let mut known: Vec<String> = self.columns.known.iter().cloned().collect();
        known.sort_unstable();
        known
    }
}

impl Measure {
    /// What is recorded of it.
    pub(super) fn recorded(&self, entry: &Entry<'_>, columns: &Columns<'_>) -> Read<RecordedMeasure> {
        require_no_number(entry)?;
        let mut reads = Reads { columns, reads: Vec::new(), series: Vec::new() };
        let program = match &self.value {
            Number::Given(_) => Program::constant(self.value.number(entry, "value")?),
            Number::Formula(text) => {
                Program::parse_with(text, &[], &mut reads, &entry.scope).map_err(|mistake| entry.mistaken("value".into(), mistake))?
            }
        };
        let text = Field::write(&self.value).quoted();
        Ok(RecordedMeasure {
            name: entry.name.to_string(),
            unit: self.unit.clone().unwrap_or_else(|| "1".into()),
            meaning: self.meaning.clone().unwrap_or_else(|| text.trim_matches('"').to_string()),
            formula: Arc::new(program),
            reads: reads.reads,
            series: reads.series,
        })
    }
}

/// Puts measures into an order in which each comes after all it reads.
pub(super) fn sorted(measures: Vec<RecordedMeasure>, sink: &Sink) -> Vec<RecordedMeasure> {
    let place: HashMap<&str, usize> = measures.iter().enumerate().map(|(k, measure)| (measure.name.as_str(), k)).collect();
    let needs: Vec<Vec<usize>> =
        measures.iter().map(|measure| measure.columns().filter_map(|name| place.get(name).copied()).collect()).collect();
    let (mut order, mut state) = (Vec::new(), vec![0_u8; measures.len()]);
    for first in 0..measures.len() {
        // Depth first, without recursion: a chain of measures may be long.
        let mut way = vec![(first, 0)];
        while let Some((measure, next)) = way.pop() {
            if state[measure] == 2 {
                continue;
            }
            state[measure] = 1;
            match needs[measure].get(next) {
                None => {
                    state[measure] = 2;
                    order.push(measure);
                }
                Some(&need) if state[need] == 1 => {
                    let from = way.iter().position(|&(on_way, _)| on_way == need).unwrap_or(way.len());
                    let round = way[from..].iter().map(|&(on_way, _)| on_way).chain([measure, need]);
                    let round: Vec<&str> = round.map(|on_way| measures[on_way].name.as_str()).collect();
                    let base = round[0].split('[').next().unwrap_or(round[0]);
                    let message = format!("measures go round in a circle: {}", round.join(" → "));
                    sink.report(|| {
                        Fault::new(key_path(&key_path("measure", base), "value"), base, message, "let one of them read no other")
                    });
                    return Vec::new();
                }
                Some(&need) => way.extend([(measure, next + 1), (need, 0)]),
            }
        }
    }
    let mut measures: Vec<Option<RecordedMeasure>> = measures.into_iter().map(Some).collect();
    order.into_iter().filter_map(|k| measures[k].take()).collect()
}

/// Refuses a measure or input with the name of a column that every recording has.
pub(super) fn require_free_name(entry: &Entry<'_>) -> Read<()> {
    if COLUMNS.contains(&entry.name) {
        let message = format!("`{}` is the name of a column that every run has", entry.name);
        return Err(entry.refuse_all(message, "give it another name"));
    }
    Ok(())
}

/// The name of a column that is like a name, for a cure.
pub(super) fn like(name: &str, known: &[String]) -> String {
    let beside = beside(name, known);
    let near = if beside.is_empty() { nearest(name, known.iter().map(String::as_str)) } else { nearest_beside(name, &beside) };
    match near {
        Some(near) => format!("did you mean `{near}`?"),
        None if beside.is_empty() => "name one of these, such as BODY.x, BODY.vx or JOINT.angle".into(),
        None => format!("known are: {}", beside.join(", ")),
    }
}
