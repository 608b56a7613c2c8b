//! The table of runs: sorted by the first column that was asked for, runs that did not complete at the end.

use std::cmp::Ordering;
use std::io;

use super::{SweepColumn, SweepReport, SweepRun, heading};
use crate::escape::html;
use crate::format;

/// Rows and columns of the table on the page; sweep.csv has all.
const MOST_ROWS: usize = 1000;
const MOST_COLUMNS: usize = 40;

/// `all`: the columns that differ from run to run.
pub fn write(report: &SweepReport, all: &[&SweepColumn], out: &mut dyn io::Write) -> io::Result<()> {
    let columns = &all[..all.len().min(MOST_COLUMNS)];
    let sorted_by = columns.first().map_or(String::new(), |column| format!(", sorted by {}", html(column.name)));
    writeln!(out, "<section>\n<h2>Runs{sorted_by}</h2>\n<div class=\"scroll\"><table class=\"figures compared runs\"><thead><tr>")?;
    writeln!(out, r#"<th scope="col" class="number">run</th>"#)?;
    for key in report.keys {
        writeln!(out, r#"<th scope="col" class="number">{}</th>"#, html(key.name))?;
    }
    for column in columns {
        writeln!(out, r#"<th scope="col" class="number">{}</th>"#, heading(column))?;
    }
    writeln!(out, r#"<th scope="col">status</th></tr></thead><tbody>"#)?;
    let order = order(report, columns.first());
    for &k in order.iter().take(MOST_ROWS) {
        let run = &report.runs[k];
        let class = if run.has_completed() { "" } else { r#" class="failed""# };
        writeln!(out, r#"<tr{class}><th scope="row" class="number">{}</th>"#, run.number)?;
        for value in &run.settings {
            writeln!(out, "{}", setting(value))?;
        }
        for column in columns {
            writeln!(out, "{}", cell(column.values[k]))?;
        }
        writeln!(out, "{}</tr>", status(run))?;
    }
    writeln!(out, "</tbody></table></div>")?;
    let mut notes = Vec::new();
    if order.len() > MOST_ROWS {
        notes.push(format!("{MOST_ROWS} of {} runs", order.len()));
    }
    if all.len() > MOST_COLUMNS {
        notes.push(format!("{MOST_COLUMNS} of {} columns", all.len()));
    }
    if !notes.is_empty() {
        writeln!(out, "<p class=\"note\">The table shows {}; sweep.csv has all.</p>", notes.join(" and "))?;
    }
    writeln!(out, "</section>")
}

/// Indices of the runs in the order of the table.
fn order(report: &SweepReport, by: Option<&&SweepColumn>) -> Vec<usize> {
    let mut order: Vec<usize> = (0..report.runs.len()).collect();
    let value = |k: usize| by.and_then(|column| column.values[k]).unwrap_or(f64::NAN);
    let compare = |a: usize, b: usize| -> Ordering {
        let failed = |k: usize| !report.runs[k].has_completed();
        failed(a).cmp(&failed(b)).then(value(a).total_cmp(&value(b)))
    };
    order.sort_by(|&a, &b| compare(a, b));
    order
}

/// A value of a key: a number as people read it, with all digits when the pointer rests on it.
fn setting(text: &str) -> String {
    match text.parse() {
        Ok(number) => cell(Some(number)),
        Err(_) => format!(r#"<td class="number">{}</td>"#, html(text)),
    }
}

fn cell(value: Option<f64>) -> String {
    match value {
        Some(value) => format!(r#"<td class="number" title="{value:e}">{}</td>"#, format::number(value).replace('-', "\u{2212}")),
        None => "<td></td>".to_owned(),
    }
}

fn status(run: &SweepRun) -> String {
    if run.has_completed() {
        return r#"<td><span class="badge completed">completed</span></td>"#.to_owned();
    }
    let at = run.stopped_at.map_or(String::new(), |t| format!(" at {} s", format::number(t)));
    format!(r#"<td><span class="badge stopped">{}{at}</span><span class="reason">{}</span></td>"#, html(&run.status), html(&run.reason))
}
