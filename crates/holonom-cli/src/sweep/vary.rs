//! What a key of the model is varied over, as it is typed: `lo..hi:20`, `lo..hi:20log`, or `a,b,c`.

use holonom::model::Value;
use holonom_io::{csv_number, read_value};

use crate::failure::Failure;
use crate::items::items;

/// A key of the model file and the values that it takes.
#[derive(Debug, PartialEq)]
pub struct Vary {
    pub path: String,
    pub values: Values,
}

#[derive(Debug, PartialEq)]
pub enum Values {
    Range(Range),
    List(Vec<Setting>),
}

/// Numbers from `low` to `high`, both included.
#[derive(Debug, PartialEq)]
pub struct Range {
    low: f64,
    high: f64,
    /// How many values there are in a grid.
    pub count: Option<u64>,
    /// Whether ratios are equal, not differences.
    geometric: bool,
}

/// A value for a key of the model, and how tables show it.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    pub text: String,
    pub value: Value,
}

impl Setting {
    fn number(number: f64) -> Self {
        Self { text: csv_number(number), value: Value::Number(number) }
    }

    fn typed(text: &str) -> Self {
        match read_value(text) {
            Value::Number(number) => Self::number(number),
            value => Self { text: text.into(), value },
        }
    }
}

impl Range {
    /// The value at a share (0 … 1) of the way. With equal ratios the power is the same on every machine.
    pub fn at(&self, share: f64) -> Setting {
        Setting::number(match (share, self.geometric) {
            (1.0, _) => self.high,
            (_, true) => self.low * libm::pow(self.high / self.low, share),
            (_, false) => self.low + (self.high - self.low) * share,
        })
    }
}

impl Vary {
    /// Reads what was typed behind `--vary`.
    pub fn parse(given: &str) -> Result<Self, Failure> {
        let refuse = |message: String| Failure::usage(format!("`--vary {given}` {message}"), CURE);
        let (path, values) = given.split_once('=').ok_or_else(|| refuse("has no `=`".into()))?;
        let (path, values) = (path.trim(), values.trim());
        if path.is_empty() || values.is_empty() {
            return Err(refuse("does not say what takes which values".into()));
        }
        let values = match range(values) {
            Some(range) => Values::Range(range.map_err(refuse)?),
            None => Values::List(list(values).map_err(refuse)?),
        };
        Ok(Self { path: path.into(), values })
    }

    /// Whether all its values are numbers.
    pub fn is_numeric(&self) -> bool {
        match &self.values {
            Values::Range(_) => true,
            Values::List(items) => items.iter().all(|item| matches!(item.value, Value::Number(_))),
        }
    }
}

const CURE: &str = "write --vary parameters.k=1..5:20 for 20 even values, 1..1e5:20log for even ratios, or a list such as 1,2,5";

/// A range, if the text begins with a number and two dots.
fn range(text: &str) -> Option<Result<Range, String>> {
    let (low, rest) = text.split_once("..")?;
    let low = low.trim().parse::<f64>().ok()?;
    let (high, count) = rest.split_once(':').map_or((rest, ""), |(high, count)| (high, count.trim()));
    let Ok(high) = high.trim().parse::<f64>() else {
        return Some(Err(format!("ends its range with `{}`, which is no number", high.trim())));
    };
    let digits = count.strip_suffix("log");
    let count = match digits.unwrap_or(count) {
        "" => None,
        digits => match digits.parse() {
            Ok(count) if count >= 2 => Some(count),
            _ => return Some(Err(format!("wants a whole number of at least 2 values, and this is `{digits}`"))),
        },
    };
    let range = Range { low, high, count, geometric: digits.is_some() };
    Some(match range {
        _ if !(low.is_finite() && high.is_finite()) => Err("has a range without an end".into()),
        _ if low == high => Err("has a range from a number to itself".into()),
        Range { geometric: true, .. } if low * high <= 0.0 => Err("has even ratios, for which both ends must be above 0, or below".into()),
        range => Ok(range),
    })
}

/// Values between commas.
fn list(text: &str) -> Result<Vec<Setting>, String> {
    let items = items(text);
    match items.contains(&"") {
        true => Err("has an empty place in its list".into()),
        false => Ok(items.into_iter().map(Setting::typed).collect()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn numbers(given: &str, count: u64) -> Vec<f64> {
        let Values::Range(range) = Vary::parse(given).unwrap().values else { panic!("{given} is a range") };
        assert_eq!(range.count, Some(count));
        (0..count).map(|k| range.at(k as f64 / (count - 1) as f64).text.parse().unwrap()).collect()
    }

    #[test]
    fn ranges_are_even_in_difference_or_ratio_and_end_where_they_say() {
        assert_eq!(numbers("a.b=-1..1:5", 5), [-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(numbers("k=0.1..0.7:3", 3), [0.1, 0.4, 0.7]);
        let ratios = numbers("k=1e3..1e5:5log", 5);
        assert_eq!((ratios[0], ratios[2], ratios[4]), (1e3, 1e4, 1e5));
        assert!(ratios.windows(2).all(|pair| (pair[1] / pair[0] - 10f64.sqrt()).abs() < 1e-14), "{ratios:?}");
        let Values::Range(drawn) = Vary::parse("k=-1..-1e4:log").unwrap().values else { panic!("it is a range") };
        assert_eq!((drawn.count, drawn.at(0.5).text.as_str()), (None, "-100"));
    }

    #[test]
    fn lists_hold_numbers_words_and_lists() {
        let items = |given: &str| match Vary::parse(given).unwrap().values {
            Values::List(items) => items.into_iter().map(|item| item.text).collect::<Vec<_>>(),
            Values::Range(_) => panic!("{given} is a list"),
        };
        assert_eq!(items("simulation.step=1e-3, 0.01"), ["0.001", "0.01"]);
        assert_eq!(items("p=[1, 0],\"a,b\",../x.stl,sin(t,1)"), ["[1, 0]", "\"a,b\"", "../x.stl", "sin(t,1)"]);
        assert!(Vary::parse("a=1,2").unwrap().is_numeric() && !Vary::parse("a=1,x").unwrap().is_numeric());
    }

    #[test]
    fn what_cannot_be_read_is_refused() {
        for given in ["k", "=1,2", "k=", "k=1,,2", "k=1..x:3", "k=1..2:1", "k=1..2:2.5", "k=1..1:3", "k=0..2:3log", "k=0..inf:3"] {
            assert!(Vary::parse(given).is_err(), "{given}");
        }
    }
}
