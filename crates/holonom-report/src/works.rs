//! Who put energy into the mechanism and who took it out: the works of a run, the largest first.

use serde_json::Value;

/// Share of the largest below which a work is nothing.
const NOTHING: f64 = 1e-9;

/// What something has done in a run.
pub struct Work {
    /// Of the drive or the force, or gravity.
    pub name: String,
    /// Its work, J.
    pub work: f64,
    /// By how much its own energy has grown, J; none where that is nothing.
    pub stored: Option<f64>,
}

/// The works of a summary, so many of the largest, and how many there are beside them; none where nothing but gravity acts. Of those that
/// are nothing beside the largest only drives stay.
pub fn largest(summary: &Value, most: usize) -> (Vec<Work>, usize) {
    let number = |of: &Value, key: &str| of[key].as_f64().unwrap_or(0.0);
    let by = &summary["work_by"];
    let list = |sort: &str| by[sort].as_array().map_or(&[][..], Vec::as_slice);
    let own = |own: &Value| (own["name"].as_str().unwrap_or("").to_owned(), number(own, "work"), number(own, "stored"));
    let mut works: Vec<(String, f64, f64)> = list("drives").iter().chain(list("forces")).map(own).collect();
    if works.is_empty() {
        return (Vec::new(), 0);
    }
    works.push(("gravity".to_owned(), number(by, "gravity"), 0.0));
    let size = |work: f64, stored: f64| work.abs().max(stored.abs());
    let least = NOTHING * works.iter().map(|(_, work, stored)| size(*work, *stored)).fold(0.0, f64::max);
    let mut works: Vec<Work> = works
        .into_iter()
        .enumerate()
        .filter(|(k, (_, work, stored))| *k < list("drives").len() || size(*work, *stored) > least)
        .map(|(_, (name, work, stored))| {
            let work = if work.abs() > least { work } else { 0.0 };
            Work { name, work, stored: (stored.abs() > least).then_some(stored) }
        })
        .collect();
    works.sort_by(|a, b| size(b.work, b.stored.unwrap_or(0.0)).total_cmp(&size(a.work, a.stored.unwrap_or(0.0))));
    let more = works.len().saturating_sub(most);
    works.truncate(most);
    (works, more)
}
