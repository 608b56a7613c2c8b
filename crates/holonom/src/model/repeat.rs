//! `repeat = "i = 0 to N"`: many entries from one, with indices.

use super::expression::{self, Mistake, Program, Scope};

/// Most entries that all repetitions of a model may make.
pub const MOST: usize = 1_000_000;

/// Beyond this size neighbouring whole numbers are no longer told apart.
const APART: f64 = 9e15;

/// Names of the indices and all their values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Repetition {
    /// Names (m) of the indices, outermost first.
    pub names: Vec<String>,
    /// Values (entries × m).
    values: Vec<f64>,
}

struct Range {
    name: String,
    low: Program,
    high: Program,
    /// Character at which the range starts.
    start: usize,
}

impl Repetition {
    /// Reads `"i = 0 to N, j = i to M"`: bounds are whole numbers, both included; a range may use the indices before it.
    ///
    /// # Errors
    /// The first mistake, with its character.
    pub fn read(text: &str, scope: &Scope<'_>, most: usize) -> Result<Self, Mistake> {
        let mut ranges: Vec<Range> = Vec::new();
        let mut start = 0;
        for part in split(text) {
            let range = range(part, start, &ranges, scope)?;
            ranges.push(range);
            start += part.chars().count() + 1;
        }
        let mut values = Vec::new();
        let mut index = Vec::new();
        let mut room = most.saturating_mul(ranges.len()).saturating_add(ranges.len());
        fill(&ranges, &mut index, &mut values, &mut room)?;
        if values.len() > most.saturating_mul(ranges.len()) {
            return Err(too_many(ranges[0].start));
        }
        Ok(Self { names: ranges.into_iter().map(|range| range.name).collect(), values })
    }

    /// The values of the indices, entry by entry.
    pub fn iter(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.names.len().max(1))
    }

    /// Number of entries.
    pub fn len(&self) -> usize {
        self.values.len() / self.names.len().max(1)
    }
}

/// Parts between commas outside brackets.
fn split(text: &str) -> impl Iterator<Item = &str> {
    let mut depth = 0_i32;
    text.split(move |c| {
        depth += i32::from(c == '(') - i32::from(c == ')');
        c == ',' && depth == 0
    })
}

fn mistake(character: usize, message: impl Into<String>, cure: impl Into<String>) -> Mistake {
    Mistake { character, message: message.into(), cure: cure.into(), known: false }
}

fn range(part: &str, start: usize, outer: &[Range], scope: &Scope<'_>) -> Result<Range, Mistake> {
    let lead = part.chars().take_while(|c| c.is_whitespace()).count();
    let wanted = || mistake(start + lead, "a repetition is an index and its range", "write repeat = \"i = 0 to N\"");
    let (name, bounds) = part.split_once('=').ok_or_else(wanted)?;
    let (low, high) = bounds.split_once(" to ").ok_or_else(wanted)?;
    let name_text = name.trim();
    let starts_well = name_text.chars().next().is_some_and(|c| c.is_alphabetic() || c == '_');
    if !starts_well || !name_text.chars().all(|c| c.is_alphanumeric() || c == '_') {
        return Err(wanted());
    }
    if expression::is_reserved(name_text) || scope.value(name_text).is_some() || outer.iter().any(|range| range.name == name_text) {
        return Err(mistake(
            start + lead,
            format!("the index `{name_text}` has the name of something else"),
            "give the index another name",
        ));
    }
    let variables: Vec<&str> = outer.iter().map(|range| range.name.as_str()).collect();
    let bound = |text: &str, offset: usize| {
        Program::parse(text, &variables, scope).map_err(|inner| Mistake { character: start + offset + inner.character, ..inner })
    };
    let offset = name.chars().count() + 1;
    let low_program = bound(low, offset)?;
    let high_program = bound(high, offset + low.chars().count() + 4)?;
    Ok(Range { name: name_text.to_string(), low: low_program, high: high_program, start: start + lead })
}

fn too_many(character: usize) -> Mistake {
    mistake(character, format!("the repetitions of this model make more than {MOST} entries"), "use smaller ranges")
}

/// Appends the values of all indices, the innermost running fastest; `room` is how many steps it may still take.
fn fill(ranges: &[Range], index: &mut Vec<f64>, values: &mut Vec<f64>, room: &mut usize) -> Result<(), Mistake> {
    let Some(range) = ranges.get(index.len()) else {
        values.extend_from_slice(index);
        return Ok(());
    };
    let [low, high] = [&range.low, &range.high].map(|bound| bound.evaluate(index.as_slice()));
    for bound in [low, high] {
        if !bound.is_finite() || (bound - bound.round()).abs() > 1e-9 {
            return Err(mistake(
                range.start,
                format!("the range of `{}` runs to {bound}, which is no whole number", range.name),
                "use whole numbers",
            ));
        }
    }
    if high.round() - low.round() > *room as f64 {
        return Err(too_many(range.start));
    }
    if high.abs().max(low.abs()) > APART && high >= low {
        let message = format!("the range of `{}` runs to {high:e}, where neighbouring whole numbers are not told apart", range.name);
        return Err(mistake(range.start, message, "use smaller numbers"));
    }
    let (low, high) = (low.round() as i64, high.round() as i64);
    for value in low..=high {
        index.push(value as f64);
        // Counted at every level: empty ranges inside of long ones make no entries and still take time.
        *room = room.checked_sub(1).ok_or_else(|| too_many(range.start))?;
        fill(ranges, index, values, room)?;
        index.pop();
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Vec<Vec<f64>>, Mistake> {
        Repetition::read(text, &Scope::default(), MOST).map(|repetition| repetition.iter().map(<[f64]>::to_vec).collect())
    }

    #[test]
    fn ranges_are_inclusive_nested_and_may_be_empty() {
        assert_eq!(read("i = 0 to 2").unwrap(), [[0.0], [1.0], [2.0]]);
        assert_eq!(read("i = 1 to 2, j = i to min(2, 5)").unwrap(), [[1.0, 1.0], [1.0, 2.0], [2.0, 2.0]]);
        assert_eq!(read("i = 1 to 0").unwrap(), Vec::<Vec<f64>>::new());
        assert_eq!(read("i = 1 to -9e18").unwrap(), Vec::<Vec<f64>>::new());
        assert_eq!(read("i = -1 to 0").unwrap().len(), 2);
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        for (text, character, words) in [
            ("i to 3", 0, "index and its range"),
            ("i = 0, j = 1 to 2", 0, "index and its range"),
            ("i = 0 to 2.5", 0, "no whole number"),
            ("i = 0 to 1e7", 0, "more than"),
            ("i = 0 to 5000, j = 0 to 5000", 15, "more than"),
            ("i = 0 to 9e18", 0, "more than 1000000"),
            ("i = -9e18 to 0", 0, "more than 1000000"),
            ("i = 0 to 1e300", 0, "more than 1000000"),
            ("i = 0 to 1e300*1e300", 0, "no whole number"),
            ("i = 1e16 to 1e16 + 4", 0, "not told apart"),
            ("i = 0 to x", 9, "not known"),
            ("i = 0 to 1, i = 0 to 1", 12, "something else"),
            ("pi = 0 to 1", 0, "something else"),
            ("i = 0 to 999999, j = 0 to 999999, k = 1 to 0", 0, "more than"),
        ] {
            let mistake = read(text).expect_err(text);
            assert!(mistake.message.contains(words) && mistake.character == character, "{text}: {mistake:?}");
        }
    }
}
