//! What compared runs answer: how far measures go, and the largest of what acts.

use serde_json::Value;

/// One answer of several runs.
pub struct Answer {
    /// Of the measure, drive, force, joint or column.
    pub name: String,
    /// What is told of it, such as `"largest"`.
    pub what: &'static str,
    /// `"1"` of numbers without one.
    pub unit: String,
    /// Of each run that has it.
    pub values: Vec<Option<f64>>,
    /// How large the answer of the first run is, over all that is told of it: what is round-off beside that is zero.
    pub size: f64,
}

/// Sorts of what acts in a summary.
const SORTS: [&str; 3] = ["drives", "forces", "joints"];

/// The largest of each sort and unit of a run that are among the answers.
const MOST: usize = 3;

/// What is told of a measure, and its key.
const OF_MEASURES: [(&str, &str); 3] = [("least", "min"), ("largest", "max"), ("last", "last")];

/// Share of the size below which an answer is nearly zero, so that it says nothing how many times itself a difference is.
const SMALL: f64 = 1e-3;

/// A difference that is a smaller share is beyond the figures that are shown.
const SHOWN: f64 = 5e-6;

impl Answer {
    /// How far the answer of a run is from that of the first, in percent of this; nothing where both look the same, one has none, or the first is
    /// nearly zero.
    pub fn difference(&self, run: usize) -> Option<String> {
        let first = self.values[0].filter(|first| first.abs() >= SMALL * self.size)?;
        let share = (self.values[run]? - first) / first.abs();
        let percent = 100.0 * share;
        let decimals = (1.0 - percent.abs().log10().floor()).clamp(0.0, 6.0) as usize;
        match share.abs() {
            size if size <= SHOWN || !size.is_finite() => None,
            size if size < 100.0 => Some(format!("{percent:+.decimals$} %")),
            _ => Some(format!("{percent:+.1e} %")),
        }
    }
}

/// The answers in the summaries of some runs: measures, then the largest of what drives, forces and joints exert.
pub fn answers(summaries: &[&Value]) -> Vec<Answer> {
    let measures = names(summaries, "measures", usize::MAX).into_iter().flat_map(|(name, unit)| {
        let found: Vec<Option<&Value>> = summaries.iter().map(|summary| find(summary, "measures", &name, &unit)).collect();
        let size = ["min", "max"].map(|key| number(found[0], key).map_or(0.0, f64::abs));
        OF_MEASURES.map(|(what, key)| Answer {
            name: name.clone(),
            what,
            unit: unit.clone(),
            values: found.iter().map(|measure| number(*measure, key)).collect(),
            size: size[0].max(size[1]),
        })
    });
    let peaks = SORTS.into_iter().flat_map(|sort| names(summaries, sort, MOST).into_iter().map(move |own| (sort, own)));
    let peaks = peaks.map(|(sort, (name, unit))| {
        // A motion that goes to both sides is as large on either.
        let values: Vec<Option<f64>> =
            summaries.iter().map(|summary| number(find(summary, sort, &name, &unit), "value").map(f64::abs)).collect();
        Answer { name, what: "largest", unit, size: values[0].unwrap_or(0.0), values }
    });
    measures.chain(peaks).collect()
}

/// Names and units of a sort in the order of the runs, the first few of each unit.
fn names(summaries: &[&Value], sort: &str, most: usize) -> Vec<(String, String)> {
    let mut names: Vec<(String, String)> = Vec::new();
    for summary in summaries {
        let own: Vec<(String, String)> = all(summary, sort).iter().map(|one| (text(one, "name"), text(one, "unit"))).collect();
        for (k, one) in own.iter().enumerate() {
            let is_among_first = own[..k].iter().filter(|(_, unit)| *unit == one.1).count() < most;
            if is_among_first && !names.contains(one) {
                names.push(one.clone());
            }
        }
    }
    names
}

fn find<'a>(summary: &'a Value, sort: &str, name: &str, unit: &str) -> Option<&'a Value> {
    all(summary, sort).iter().find(|one| one["name"] == name && one["unit"] == unit)
}

fn all<'a>(summary: &'a Value, sort: &str) -> &'a [Value] {
    summary["peaks"][sort].as_array().map_or(&[], Vec::as_slice)
}

fn number(of: Option<&Value>, key: &str) -> Option<f64> {
    of?[key].as_f64()
}

fn text(of: &Value, key: &str) -> String {
    of[key].as_str().unwrap_or("").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn run(lift: f64, loads: &[(&str, f64)]) -> Value {
        let joints: Vec<Value> = loads.iter().map(|(name, value)| json!({"name": name, "unit": "N", "value": value})).collect();
        json!({"peaks": {"measures": [{"name": "lift", "unit": "mm", "min": -2.0, "max": lift, "last": 0.0}], "joints": joints}})
    }

    #[test]
    fn answers_are_those_of_all_runs_with_their_differences() {
        let runs = [run(8.0, &[("a", -50.0), ("b", 40.0), ("c", 30.0), ("d", 20.0)]), run(8.04, &[("a", 50.0), ("e", 60.0)])];
        let found = answers(&runs.iter().collect::<Vec<_>>());
        let told: Vec<(&str, &str, &[Option<f64>])> = found.iter().map(|one| (one.name.as_str(), one.what, &one.values[..])).collect();
        let (both, one) = (|a, b| [Some(a), Some(b)], |a| [Some(a), None]);
        assert_eq!(
            told,
            [
                ("lift", "least", &both(-2.0, -2.0)[..]),
                ("lift", "largest", &both(8.0, 8.04)),
                ("lift", "last", &both(0.0, 0.0)),
                ("a", "largest", &both(50.0, 50.0)),
                ("b", "largest", &one(40.0)),
                ("c", "largest", &one(30.0)),
                ("e", "largest", &[None, Some(60.0)]),
            ]
        );
        let differences: Vec<Option<String>> = found.iter().map(|one| one.difference(1)).collect();
        assert_eq!(differences, [None, Some("+0.50 %".to_owned()), None, None, None, None, None]);
    }

    /// A least value of 4 beside a largest of 2000 is 50 % more at 6, and not 0.1 %.
    #[test]
    fn differences_of_least_values_are_shares_of_these() {
        let run =
            |min: f64, last: f64| json!({"peaks": {"measures": [{"name": "gap", "unit": "m", "min": min, "max": 2000.0, "last": last}]}});
        let runs = [run(4.0, 1e-9), run(6.0, 5.0)];
        let told: Vec<Option<String>> = answers(&runs.iter().collect::<Vec<_>>()).iter().map(|one| one.difference(1)).collect();
        assert_eq!(told, [Some("+50 %".to_owned()), None, None], "nothing is a share of nearly nothing");
        let below = [run(-4.0, -8.0), run(-6.0, -4.0)];
        let told: Vec<Option<String>> = answers(&below.iter().collect::<Vec<_>>()).iter().map(|one| one.difference(1)).collect();
        assert_eq!(told, [Some("-50 %".to_owned()), None, Some("+50 %".to_owned())], "a percentage has the sign of the difference");
    }

    #[test]
    fn differences_have_two_figures() {
        let of =
            |value: f64| Answer { name: String::new(), what: "", unit: String::new(), values: vec![Some(1.0), Some(value)], size: 1.0 };
        let told = [1.000_001, 1.000_123, 0.85, 3.0, 1e6].map(|value| of(value).difference(1).unwrap_or_default());
        assert_eq!(told, ["", "+0.012 %", "-15 %", "+200 %", "+1.0e8 %"]);
    }
}
