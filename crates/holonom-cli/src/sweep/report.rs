//! The page about a sweep, from its table.

use std::io::Write;

use holonom::model::Value;
use holonom_io::{Cells, Source, Table};
use holonom_report::{SweepColumn, SweepKey, SweepReport, SweepRun};

use super::plan::Plan;
use super::vary::{Values, Vary};
use super::watch::Columns;

/// Ratio of the largest to the least of some numbers beyond which they are shown in equal ratios.
const MANY_TIMES: f64 = 30.0;

/// Writes the page about all runs of a table, with what is said of them. The model is known by its title, or by `name`.
pub fn write_report(
    (source, name): (&Source, &str),
    set: &[String],
    plan: &Plan,
    columns: &Columns,
    (table, notes): (&Table, &[String]),
    out: &mut dyn Write,
) -> std::io::Result<()> {
    let keys: Vec<SweepKey<'_>> =
        plan.varied.iter().map(|vary| SweepKey { name: &vary.path, is_logarithmic: is_logarithmic(vary) }).collect();
    let status = 1 + keys.len();
    let first = table.columns.len() - columns.asked.len();
    let text = |column: usize, row: usize| table.columns[column].1.text(row);
    let runs: Vec<SweepRun> = (0..table.rows())
        .map(|row| SweepRun {
            number: row as u64 + 1,
            settings: (1..status).map(|k| text(k, row)).collect(),
            status: text(status, row),
            stopped_at: text(status + 1, row).parse().ok(),
            reason: text(status + 2, row),
        })
        .collect();
    let values = |cells: &Cells| if let Cells::Numbers(values) = cells { values.clone() } else { Vec::new() };
    let asked = columns.asked.iter().zip(&columns.units).zip(&table.columns[first..]);
    let columns: Vec<SweepColumn<'_>> =
        asked.map(|((asked, unit), (_, cells))| SweepColumn { name: &asked.text, unit, values: values(cells) }).collect();
    let title = match source.get("title") {
        Some(Value::Text(title)) if !title.is_empty() => title.as_str(),
        _ => name,
    };
    let report =
        SweepReport { title, notes, model_text: source.text(), set, is_grid: plan.is_grid(), keys: &keys, columns: &columns, runs: &runs };
    report.write(out)
}

/// Whether the values of a key are shown in equal ratios.
fn is_logarithmic(vary: &Vary) -> bool {
    match &vary.values {
        Values::Range(range) => range.geometric,
        Values::List(items) => {
            let numbers: Option<Vec<f64>> =
                items.iter().map(|item| if let Value::Number(number) = item.value { Some(number) } else { None }).collect();
            numbers.is_some_and(|numbers| {
                let (least, most) = (numbers.iter().copied().fold(f64::MAX, f64::min), numbers.iter().copied().fold(f64::MIN, f64::max));
                least > 0.0 && most > MANY_TIMES * least
            })
        }
    }
}
