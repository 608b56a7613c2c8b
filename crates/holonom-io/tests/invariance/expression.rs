//! Expressions of a model file as texts: what they come to, and names in them replaced.

use holonom::model::{Model, NoFiles, Table, Value};

/// The text with every name, also one with dots, for which `new` has something replaced by that.
pub fn replaced(text: &str, new: impl Fn(&str) -> Option<String>) -> String {
    let characters: Vec<char> = text.chars().collect();
    let (mut out, mut at) = (String::new(), 0);
    while at < characters.len() {
        let start = at;
        let is_name = characters[at].is_alphabetic() || characters[at] == '_';
        at += match is_name {
            true => run(&characters[at..], |c| c.is_alphanumeric() || c == '_' || c == '.'),
            false => digits(&characters[at..]).max(1),
        };
        let token: String = characters[start..at].iter().collect();
        match if is_name { new(&token) } else { None } {
            Some(other) => out.push_str(&other),
            None => out.push_str(&token),
        }
    }
    out
}

/// Length of the number at the beginning, with its exponent.
fn digits(characters: &[char]) -> usize {
    let is_digit = |c: char| c.is_ascii_digit();
    let mantissa = run(characters, |c| is_digit(c) || c == '.');
    if mantissa == 0 || !matches!(characters.get(mantissa), Some('e' | 'E')) {
        return mantissa;
    }
    let sign = usize::from(matches!(characters.get(mantissa + 1), Some('+' | '-')));
    match run(&characters[(mantissa + 1 + sign).min(characters.len())..], is_digit) {
        0 => mantissa,
        exponent => mantissa + 1 + sign + exponent,
    }
}

fn run(characters: &[char], of: impl Fn(char) -> bool) -> usize {
    characters.iter().take_while(|&&c| of(c)).count()
}

/// Whether one of these names is in a text.
pub fn uses(text: &str, names: &[&str]) -> bool {
    let found = std::cell::Cell::new(false);
    replaced(text, |name| {
        found.set(found.get() || names.contains(&name));
        None
    });
    found.get()
}

/// What an expression over some parameters comes to: the engine is asked, through a key that takes any number.
pub fn number(text: &str, parameters: &Table) -> f64 {
    let pairs = |entries: Vec<(&str, Value)>| Value::Table(entries.into_iter().collect());
    let zero = Value::List(vec![Value::Number(0.0), Value::Number(0.0)]);
    let model = pairs(vec![
        ("plane", Value::text("xy")),
        ("parameters", Value::Table(parameters.clone())),
        ("point", pairs(vec![("only", pairs(vec![("mass", Value::Number(1.0)), ("position", zero)]))])),
        ("simulation", pairs(vec![("gamma", Value::text(text))])),
    ]);
    let model = Model::from_value(&model, &NoFiles).unwrap_or_else(|faults| panic!("{text}: {faults:?}"));
    model.settings.choice.gamma.expect("it was given")
}

/// A number as it is written in an expression.
pub fn written(number: f64) -> String {
    format!("({number:?})")
}
