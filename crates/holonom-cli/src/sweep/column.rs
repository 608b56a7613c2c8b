//! A column of the table as it is typed: a column of the trajectory, a function of one over the run, such as `max(chassis.az)`, or the time of an event.

use holonom::model::nearest;

use super::reduction::Function;
use crate::failure::Failure;

/// What a column of the table shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Asked {
    /// As it was typed: what the column is called.
    pub text: String,
    /// The column of the trajectory, or the event.
    pub of: String,
    /// Whether its size is meant, without its sign.
    pub is_absolute: bool,
    /// What is made of its values over the run.
    pub function: Function,
}

const CURE: &str = "write a column of the trajectory such as chassis.az, or max(chassis.az), min(…), mean(…), rms(…), last(…), \
                    at(chassis.az, 2.5), and abs(…) inside these, or time(EVENT)";

impl Asked {
    /// The last value of a column of the trajectory.
    pub fn last(of: &str) -> Self {
        Self { text: of.into(), of: of.into(), is_absolute: false, function: Function::Last }
    }

    /// Reads what was typed.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let refuse = |message: &str| Failure::usage(format!("`{text}` {message}"), CURE);
        if text.is_empty() {
            return Err(Failure::usage("--columns has an empty place in its list", CURE));
        }
        let Some((name, inner)) = call(text).map_err(refuse)? else { return Ok(Self::last(text)) };
        let (function, inner) = match name {
            "abs" => (Function::Last, text),
            "at" => {
                let (inner, t) = inner.rsplit_once(',').ok_or_else(|| refuse("does not say when"))?;
                let t: f64 = t.trim().parse().map_err(|_| refuse("wants a number of seconds behind its comma"))?;
                if !(t.is_finite() && t >= 0.0) {
                    return Err(refuse("asks for a time that no run has"));
                }
                (Function::At(t), inner.trim())
            }
            "time" => (Function::TimeOf, inner),
            name => match Function::NAMED.iter().find(|(known, _)| *known == name) {
                Some((_, function)) => (*function, inner),
                None => {
                    let known = Function::NAMED.iter().map(|(known, _)| *known).chain(["at", "abs", "time"]);
                    let near = nearest(name, known).map_or(CURE.to_string(), |near| format!("did you mean `{near}`?"));
                    return Err(Failure::usage(format!("there is no function `{name}` of columns"), near));
                }
            },
        };
        let (is_absolute, of) = match call(inner).map_err(refuse)? {
            Some(("abs", inner)) if function != Function::TimeOf => (true, inner),
            Some(_) => return Err(refuse("has a function inside that is not abs(…)")),
            None => (false, inner),
        };
        if of.is_empty() || of.contains(['(', ')', ',']) {
            return Err(refuse("does not name one column inside its brackets"));
        }
        Ok(Self { text: text.into(), of: of.into(), is_absolute, function })
    }
}

/// Name and contents of a function, if the text is one.
fn call(text: &str) -> Result<Option<(&str, &str)>, &'static str> {
    let Some((name, rest)) = text.split_once('(') else {
        return if text.contains(')') { Err("has a bracket too many") } else { Ok(None) };
    };
    let inner = rest.strip_suffix(')').ok_or("does not end with the bracket that closes it")?;
    Ok(Some((name.trim(), inner.trim())))
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
        assert_eq!(Asked::parse("rms( m2.x )").unwrap().text, "rms( m2.x )");
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
            ("maximum(m2.x)", "there is no function `maximum`"),
            ("ms(m2.x)", "did you mean `rms`?"),
        ] {
            let message = Asked::parse(text).unwrap_err().to_string();
            assert!(message.contains(told) && message.contains("cure"), "{text}\n{message}");
        }
    }
}
