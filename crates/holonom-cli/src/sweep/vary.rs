//! What a key of the model is varied over, as it is typed: `lo..hi:20`, `lo..hi:20log`, or `a,b,c`.

use holonom::model::Value;
use holonom_io::{csv_number, read_value, to_json};

use crate::failure::Failure;
use crate::items::items;

/// A key of the model file and the values that it takes.
#[derive(Debug, PartialEq)]
pub struct Vary {
    /// Path of the key in the model file.
    pub path: String,
    /// What it takes.
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
    pub geometric: bool,
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

    /// A value that a program gives; texts are as they are typed.
    pub fn of(value: Value) -> Self {
        match value {
            Value::Number(number) => Self::number(number),
            Value::Text(text) => Self { value: Value::Text(text.clone()), text },
            value => Self { text: to_json(&value).to_string(), value },
        }
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
            (_, false) => self.without_round_off(self.low + (self.high - self.low) * share),
        })
    }

    /// A value of an even grid to fifteen digits of its larger end: what rounding adds behind them is not what was asked for.
    fn without_round_off(&self, value: f64) -> f64 {
        let digits = 14.0 - self.low.abs().max(self.high.abs()).log10().floor();
        if self.count.is_none() || !(0.0..=300.0).contains(&digits) {
            return value;
        }
        format!("{value:.*}", digits as usize).parse::<f64>().expect("it is a number") + 0.0
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

    /// A key and its values, as a program gives them.
    pub fn of(path: &str, values: Vec<Value>) -> Self {
        Self { path: path.into(), values: Values::List(values.into_iter().map(Setting::of).collect()) }
    }

    /// The values of a list.
    pub fn each(&self) -> impl Iterator<Item = &Setting> {
        let items = if let Values::List(items) = &self.values { items.as_slice() } else { &[] };
        items.iter()
    }

    /// The values that are no numbers.
    pub fn words(&self) -> impl Iterator<Item = &Setting> {
        self.each().filter(|item| !matches!(item.value, Value::Number(_)))
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
    let high = high.trim();
    let Ok(high) = high.parse::<f64>() else {
        let what = if high.is_empty() { "nothing".into() } else { format!("`{high}`, which is no number") };
        return Some(Err(format!("ends its range with {what}")));
    };
    let digits = count.strip_suffix("log");
    let count = match digits.unwrap_or(count) {
        "" => None,
        digits => match digits.parse() {
            Ok(count) if count >= 2 => Some(count),
            _ => return Some(Err(format!("asks for `{digits}` values, and a range has a whole number of at least 2"))),
        },
    };
    let range = Range { low, high, count, geometric: digits.is_some() };
    Some(match range {
        _ if !(low.is_finite() && high.is_finite()) => Err("has a range whose ends are not both finite numbers".into()),
        _ if low == high => Err("has a range from a number to itself".into()),
        _ if low > high => Err(format!("has a range that runs backwards: write {}..{}", csv_number(high), csv_number(low))),
        Range { geometric: true, .. } if low <= 0.0 && high >= 0.0 => {
            Err("has even ratios, for which both ends must be above 0, or below".into())
        }
        range => Ok(range),
    })
}

/// Values between commas.
fn list(text: &str) -> Result<Vec<Setting>, String> {
    let items = items(text);
    if items.contains(&"") {
        return Err("has an empty place in its list".into());
    }
    if let Some(mistyped) = items.iter().find(|item| is_like_range(item)) {
        return Err(format!("has `{mistyped}` in a list, which looks like a range"));
    }
    let settings: Vec<Setting> = items.into_iter().map(Setting::typed).collect();
    match settings.iter().find(|setting| matches!(setting.value, Value::Number(number) if !number.is_finite())) {
        Some(setting) => Err(format!("has `{}` in its list, which is no finite number", setting.text)),
        None => Ok(settings),
    }
}

/// Whether a value was probably meant as a range: it ends with a number of values, as `20-30:5` does, or has numbers beside two dots.
fn is_like_range(item: &str) -> bool {
    let is_number = |text: &str| text.trim().parse::<f64>().is_ok();
    let is_count = |text: &str| {
        let count = text.trim();
        count == "log" || is_number(count.strip_suffix("log").unwrap_or(count))
    };
    let begins_text = item.starts_with(['"', '\'', '[', '{']);
    let has_count = item.rsplit_once(':').is_some_and(|(_, count)| is_count(count));
    let has_ends = item.split_once("..").is_some_and(|(low, high)| is_number(low) || is_number(high));
    !begins_text && (has_count || has_ends)
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
        assert_eq!(numbers("k=1.6..2.1:6", 6), [1.6, 1.7, 1.8, 1.9, 2.0, 2.1]);
        assert_eq!(numbers("k=-3e-9..6e-9:4", 4), [-3e-9, 0.0, 3e-9, 6e-9]);
        let ratios = numbers("k=1e3..1e5:5log", 5);
        assert_eq!((ratios[0], ratios[2], ratios[4]), (1e3, 1e4, 1e5));
        assert!(ratios.windows(2).all(|pair| (pair[1] / pair[0] - 10f64.sqrt()).abs() < 1e-14), "{ratios:?}");
        // Ends whose product is zero.
        assert!((numbers("k=1e-200..1e-180:3log", 3)[1] / 1e-190 - 1.0).abs() < 1e-14);
        let Values::Range(drawn) = Vary::parse("k=-1e4..-1:log").unwrap().values else { panic!("it is a range") };
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
    fn what_cannot_be_read_is_refused_with_a_cure() {
        for (given, told) in [
            ("k", "no `=`"),
            ("=1,2", "what takes which"),
            ("k=", "what takes which"),
            ("k=1,,2", "empty place"),
            ("k=1..x:3", "`x`, which is no number"),
            ("k=1..", "ends its range with nothing"),
            ("k=1..:3", "ends its range with nothing"),
            ("k=..2:3", "looks like a range"),
            ("k=..2", "looks like a range"),
            ("k=20-30:5", "`20-30:5` in a list, which looks like a range"),
            ("k=20:30:5", "looks like a range"),
            ("k=20..30,40..50", "which is no number"),
            ("k=10,20..30:5", "looks like a range"),
            ("k=a..b:5", "looks like a range"),
            ("k=1-2:5log", "looks like a range"),
            ("k=1-2:log", "looks like a range"),
            ("k=1..2:1", "at least 2"),
            ("k=1..2:0", "at least 2"),
            ("k=1..2:-3", "at least 2"),
            ("k=1..2:2.5", "at least 2"),
            ("k=1..2:NaN", "at least 2"),
            ("k=1..1:3", "to itself"),
            ("k=3..2:3", "backwards: write 2..3"),
            ("k=0..2:3log", "even ratios"),
            ("k=0..inf:3", "finite"),
            ("k=NaN..3:4", "finite"),
            ("k=1,nan", "no finite number"),
            ("k=-inf,1", "no finite number"),
        ] {
            let message = Vary::parse(given).unwrap_err().to_string();
            assert!(message.contains(told) && message.contains("1..5:20"), "{given}\n{message}");
        }
        for given in ["mesh.file=../a.stl,C:\\b.stl", "f=sin(t),2*t", "title='1..2:3'", "p=[1,0],[2,0]"] {
            assert!(Vary::parse(given).is_ok(), "{given}");
        }
    }
}
