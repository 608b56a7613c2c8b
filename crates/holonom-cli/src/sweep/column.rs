//! A column of the table as it is typed: a column of the trajectory or a formula of some, a function of these over the run, such as `max(chassis.az)`, or
//! the time of an event; or a number of a mode of small vibrations.

use holonom::model::{is_formula_function, nearest};

use super::reduction::Function;
use super::vibration::OfMode;
use crate::failure::Failure;
use crate::items::items;

/// What a column of the table shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// As it was typed: what the column is called.
    pub text: String,
    /// The column of the trajectory, the formula of such columns, the event, or the number of the mode.
    pub of: String,
    /// Whether that is a formula.
    pub is_formula: bool,
    /// Whether its size is meant, without its sign.
    pub is_absolute: bool,
    /// What is made of its values over the run.
    pub function: Function,
}

const CURE: &str = "write a column of the trajectory such as chassis.az or a formula of some such as A.x - B.x, or max(chassis.az), min(…), mean(…), \
                    rms(…), last(…), at(chassis.az, 2.5) of these, or time(EVENT), or frequency(1), damping(1), growth(1) of a mode";

/// Signs that only a formula has. A name may have a minus, so that a difference has blanks.
const OF_FORMULAS: [char; 7] = ['+', '*', '/', '^', '(', '\'', ' '];

impl Asked {
    /// The last value of a column of the trajectory.
    pub fn last(of: &str) -> Self {
        Self { text: of.into(), of: of.into(), is_formula: false, is_absolute: false, function: Function::Last }
    }

    /// Whether it is of small vibrations about the start, and not of a run.
    pub fn is_of_mode(&self) -> bool {
        matches!(self.function, Function::Mode(..))
    }

    /// Reads what was typed.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let refuse = |message: &str| Failure::usage(format!("`{text}` {message}"), CURE);
        if text.is_empty() {
            return Err(Failure::usage("--columns has an empty place in its list", CURE));
        }
        let (function, of) = match call(text).map_err(refuse)? {
            None | Some(("abs", _)) => (Function::Last, text),
            Some(("at", inner)) => {
                let (inner, t) = inner.rsplit_once(',').ok_or_else(|| refuse("does not say when"))?;
                let t: f64 = t.trim().parse().map_err(|_| refuse("wants a number of seconds behind its comma"))?;
                if !(t.is_finite() && t >= 0.0) {
                    return Err(refuse("asks for a time that no run has"));
                }
                (Function::At(t), inner.trim())
            }
            Some(("time", inner)) => (Function::TimeOf, inner),
            Some((name, inner)) if let Some(of) = of_mode(name) => {
                let number = inner.parse().ok().filter(|number| *number > 0);
                let number = number.ok_or_else(|| refuse("wants the number of a mode in its brackets, 1, 2, …"))?;
                (Function::Mode(of, number), inner)
            }
            Some((name, inner)) => match Function::NAMED.iter().find(|(known, _)| *known == name) {
                Some((_, function)) => (*function, inner),
                None if is_formula_function(name) => (Function::Last, text),
                None => {
                    let near = nearest(name, functions()).map_or(CURE.to_string(), |near| format!("did you mean `{near}`?"));
                    return Err(Failure::usage(format!("there is no function `{name}` of columns"), near));
                }
            },
        };
        let is_time = function == Function::TimeOf;
        let is_of_columns = |(name, inner): (&str, &str)| functions().any(|known| known == name) && items(inner).len() == 1;
        let (is_absolute, of) = match call(of).map_err(refuse)? {
            Some(_) if is_time => return Err(refuse("has a function inside that is not abs(…)")),
            Some(("abs", inner)) if call(inner).map_err(refuse)?.is_some_and(is_of_columns) => {
                return Err(refuse("does not name one column inside its brackets"));
            }
            Some(("abs", inner)) if !inner.contains(OF_FORMULAS) => (true, inner),
            Some(inner) if inner.0 != "abs" && is_of_columns(inner) => return Err(refuse("has a function inside that is not abs(…)")),
            _ => (false, of),
        };
        let is_formula = of.contains(OF_FORMULAS);
        if of.is_empty() || is_time && is_formula || items(of).len() > 1 {
            return Err(refuse("does not name one column inside its brackets"));
        }
        Ok(Self { text: text.into(), of: of.into(), is_formula, is_absolute, function })
    }
}

/// Names of all functions of columns.
fn functions() -> impl Iterator<Item = &'static str> {
    Function::NAMED.iter().map(|(known, _)| *known).chain(["at", "abs", "time"]).chain(OfMode::NAMED.map(|(known, _)| known))
}

/// What is asked of a mode by the name of a function.
fn of_mode(name: &str) -> Option<OfMode> {
    OfMode::NAMED.iter().find(|(known, _)| *known == name).map(|(_, of)| *of)
}

/// Name and contents of a function, if the text is one and nothing else.
fn call(text: &str) -> Result<Option<(&str, &str)>, &'static str> {
    let (mut depth, mut closes) = (0, None);
    for (at, c) in text.char_indices() {
        match c {
            '(' => depth += 1,
            ')' if depth == 0 => return Err("has a bracket too many"),
            ')' => {
                depth -= 1;
                closes = closes.or((depth == 0).then_some(at));
            }
            _ => (),
        }
    }
    if depth > 0 {
        return Err("does not end with the bracket that closes it");
    }
    let Some((name, rest)) = text.split_once('(') else { return Ok(None) };
    let name = name.trim();
    let is_name = !name.is_empty() && name.chars().all(|c| c.is_alphanumeric() || c == '_');
    let is_whole = is_name && closes == Some(text.len() - 1);
    Ok(is_whole.then(|| (name, rest[..rest.len() - 1].trim())))
}

#[cfg(test)]
mod tests {
    use holonom::record::Running;

    use super::*;

    #[test]
    fn columns_and_functions_of_them_are_read() {
        let read = |text: &str| {
            let asked = Asked::parse(text).unwrap();
            (asked.of, asked.is_absolute, asked.function)
        };
        assert_eq!(read("m2.x"), ("m2.x".into(), false, Function::Last));
        assert_eq!(read("last(m2.x)"), ("m2.x".into(), false, Function::Last));
        assert_eq!(read("abs(m2.x)"), ("m2.x".into(), true, Function::Last));
        assert_eq!(read("max(abs(strut.force))"), ("strut.force".into(), true, Function::Running(Running::Max)));
        assert_eq!(read("at( abs( m2.x ) , 1e-1 )"), ("m2.x".into(), true, Function::At(0.1)));
        assert_eq!(read("time(lands)"), ("lands".into(), false, Function::TimeOf));
        assert_eq!(read("damping( 12 )"), ("12".into(), false, Function::Mode(OfMode::Damping, 12)));
        assert_eq!(Asked::parse("rms( m2.x )").unwrap().text, "rms( m2.x )");
    }

    #[test]
    fn formulas_are_told_from_columns() {
        let read = |text: &str| {
            let asked = Asked::parse(text).unwrap();
            (asked.of, asked.is_formula, asked.function)
        };
        assert_eq!(read("left-strut.force"), ("left-strut.force".into(), false, Function::Last));
        assert_eq!(read("a.x - b.x"), ("a.x - b.x".into(), true, Function::Last));
        assert_eq!(read("rms(a.x - b.x)"), ("a.x - b.x".into(), true, Function::Running(Running::Rms)));
        assert_eq!(read("max(abs(a.x - b.x))"), ("abs(a.x - b.x)".into(), true, Function::Running(Running::Max)));
        assert_eq!(read("max(a.x) - min(a.x)"), ("max(a.x) - min(a.x)".into(), true, Function::Last));
        assert_eq!(read("sqrt(a.vx^2+a.vy^2)"), ("sqrt(a.vx^2+a.vy^2)".into(), true, Function::Last));
        assert_eq!(read("at(min(a.x, b.x), 2)"), ("min(a.x, b.x)".into(), true, Function::At(2.0)));
        assert_eq!(read("mean(distance(a, b))"), ("distance(a, b)".into(), true, Function::Running(Running::Mean)));
    }

    #[test]
    fn what_cannot_be_read_is_refused_with_a_cure() {
        for (text, told) in [
            ("", "empty place"),
            ("max(m2.x", "closes it"),
            ("m2.x)", "too many"),
            ("max()", "one column"),
            ("max(m2.x))", "too many"),
            ("max(m2.x, m2.y)", "one column"),
            ("max(rms(m2.x))", "not abs"),
            ("abs(max(m2.x))", "one column"),
            ("abs(abs(m2.x))", "one column"),
            ("time(abs(lands))", "not abs"),
            ("at(m2.x)", "when"),
            ("at(m2.x, end)", "seconds"),
            ("at(m2.x, -1)", "no run has"),
            ("at(m2.x, NaN)", "no run has"),
            ("frequency()", "number of a mode"),
            ("frequency(0)", "number of a mode"),
            ("growth(1.5)", "number of a mode"),
            ("damping(m2)", "number of a mode"),
            ("max(frequency(1))", "not abs"),
            ("frequenzy(1)", "did you mean `frequency`?"),
            ("maximum(m2.x)", "there is no function `maximum`"),
            ("ms(m2.x)", "did you mean `rms`?"),
        ] {
            let message = Asked::parse(text).unwrap_err().to_string();
            assert!(message.contains(told) && message.contains("cure"), "{text}\n{message}");
        }
    }
}
