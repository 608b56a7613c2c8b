//! Numbers as people read them.

use serde_json::Value;

use crate::digits::{DIGITS, between, rounded, without_round_off};

/// Digits that a number has at most.
pub const FIGURES: usize = 6;

/// Up to six significant digits, `1.5e-9` where zeros would have to be counted.
pub fn number(value: f64) -> String {
    if value == 0.0 || (1e-3..1e6).contains(&value.abs()) {
        let decimals = if value == 0.0 { 0 } else { (5 - value.abs().log10().floor() as i32).max(0) as usize };
        return without_trailing_zeros(&format!("{value:.decimals$}")).to_owned();
    }
    let text = format!("{value:.5e}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{}e{exponent}", without_trailing_zeros(mantissa)),
        None => text, // NaN, inf
    }
}

/// Three significant digits, which errors and times have, as HTML: `1.5 × 10⁻⁹` with a real exponent.
pub fn figure(value: f64) -> String {
    significant(value, 3)
}

/// The digits that answers have, as HTML.
pub fn answer(value: f64) -> String {
    significant(rounded(value, DIGITS), DIGITS)
}

/// An answer that is zero where it is round-off beside the largest of its like.
pub fn answer_beside(value: f64, largest: f64) -> String {
    answer(without_round_off(value, largest))
}

/// An answer between two others.
pub fn answer_between(value: f64, ends: [f64; 2]) -> String {
    let (value, digits) = between(value, ends);
    significant(rounded(value, digits), digits)
}

fn significant(value: f64, digits: usize) -> String {
    let last = digits as i32 - 1;
    if value == 0.0 || (1e-2..10_f64.powi(last + 3)).contains(&value.abs()) {
        let decimals = if value == 0.0 { 0 } else { (last - value.abs().log10().floor() as i32).max(0) as usize };
        return without_trailing_zeros(&format!("{value:.decimals$}")).replace('-', "\u{2212}");
    }
    let text = format!("{value:.*e}", digits - 1).replace('-', "\u{2212}");
    match text.split_once('e') {
        Some((mantissa, exponent)) => format!("{mantissa}\u{202f}×\u{202f}10<sup>{exponent}</sup>"),
        None => text,
    }
}

/// A value of `summary.json` as text.
pub fn value(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::Bool(flag) => if *flag { "yes" } else { "no" }.to_owned(),
        Value::Number(n) if n.is_f64() => number(n.as_f64().unwrap_or(f64::NAN)),
        Value::Number(n) => n.to_string(),
        Value::String(text) => text.clone(),
        Value::Array(items) if items.is_empty() => "none".to_owned(),
        Value::Array(items) => items.iter().map(self::value).collect::<Vec<_>>().join(", "),
        Value::Object(_) => value.to_string(),
    }
}

fn without_trailing_zeros(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short_and_right() {
        for (value, text) in [
            (0.0, "0"),
            (20.0, "20"),
            (0.025, "0.025"),
            (-19.62, "-19.62"),
            (123_456.0, "123456"),
            (1.0 / 3.0, "0.333333"),
            (1.5e-9, "1.5e-9"),
            (2e7, "2e7"),
            (f64::NAN, "NaN"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn figures_have_exponents() {
        assert_eq!(figure(-1.234e-13), "\u{2212}1.23\u{202f}×\u{202f}10<sup>\u{2212}13</sup>");
        assert_eq!(figure(2.0), "2");
        assert_eq!(figure(41.26), "41.3");
        assert_eq!((answer(-389.0812), answer(0.0123456)), ("\u{2212}389.08".to_owned(), "0.012346".to_owned()));
        assert_eq!((answer(108_959.4), figure(6787.2)), ("108960".to_owned(), "6787".to_owned()));
        assert_eq!([10_000.03, 1e-14].map(|value| answer_between(value, [9_999.97, 10_000.03])), ["10000.03", "0"]);
        assert_eq!((answer_beside(1e-14, 10.0), answer_beside(2.5, 10.0)), ("0".to_owned(), "2.5".to_owned()));
    }
}
