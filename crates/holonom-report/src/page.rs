//! Puts the page together.

use crate::data::{RunData, origin};
use crate::escape::{html, json_in_script};
use crate::outcome::outcomes;
use crate::{Report, Run, figures, provenance, summary};
use serde::Serialize;
use serde_json::Value;
use std::io::{self, Write};

/// Nothing may be loaded from anywhere: what is not in the file does not exist.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:";

const ICON: &str = "data:image/svg+xml,%3Csvg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 16 16'%3E\
    %3Cpath d='M3 2h10M8 2l4 9' stroke='%23888' stroke-width='1.5'/%3E%3Ccircle cx='12' cy='12' r='3' fill='%230072b2'/%3E%3C/svg%3E";

pub const STYLE: &str = include_str!("style.css");

/// Style sheet and script of the viewer, if it is part of this build.
#[cfg(feature = "viewer")]
pub const VIEWER: Option<(&str, &str)> =
    Some((include_str!(concat!(env!("OUT_DIR"), "/bundle/viewer.css")), include_str!(concat!(env!("OUT_DIR"), "/bundle/viewer.js"))));
#[cfg(not(feature = "viewer"))]
pub const VIEWER: Option<(&str, &str)> = None;

pub const WITHOUT_VIEWER: &str = "<p class=\"note\">The moving picture and the plots were left out when this program was built \
    (feature <code>viewer</code>).</p>";

pub fn write(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    head(report.title, VIEWER.map_or("", |(style, _)| style), out)?;
    writeln!(out, "<header>\n<h1>{}</h1>", html(report.title))?;
    figures::write(report.runs, out)?;
    writeln!(out, "</header>\n<main>")?;
    let origin = origin(report.runs);
    let data = prepared(report.runs, origin);
    match VIEWER {
        Some(_) => stage(&data, out)?,
        None => writeln!(out, "{WITHOUT_VIEWER}")?,
    }
    health(report.runs, &data, out)?;
    writeln!(out, "<section>\n<h2>Summary</h2>")?;
    summary::write(report.runs, out)?;
    writeln!(out, "</section>")?;
    let provenances: Vec<(&str, &Value)> = report.runs.iter().map(|run| (run.label, &run.summary["provenance"])).collect();
    provenance::write(&provenances, out)?;
    if !report.model_text.is_empty() {
        model(report.model_text, out)?;
    }
    writeln!(out, "</main>")?;
    if let Some((_, script)) = VIEWER {
        scripts(&Data { origin, runs: &data, columns: report.columns }, script, out)?;
    }
    end(out)
}

/// The model file at the bottom of a page.
pub fn model(text: &str, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "<section>\n<h2>Model</h2>\n<pre class=\"model\">{}</pre>\n</section>", html(text))
}

/// What every page ends with.
pub fn end(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "</body>\n</html>")
}

fn prepared<'a>(runs: &[Run<'a>], origin: [f64; 3]) -> Vec<RunData<'a>> {
    runs.iter().zip(outcomes(runs)).map(|(run, outcome)| RunData::new(run, &runs[0], outcome, origin)).collect()
}

/// What every page begins with; `style` comes before the style sheet of all pages.
pub fn head(title: &str, style: &str, out: &mut dyn Write) -> io::Result<()> {
    write!(
        out,
        r#"<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="{POLICY}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="holonom {version}">
<title>{title}</title>
<link rel="icon" href="{ICON}">
<style>
{style}{STYLE}</style>
</head>
<body>
"#,
        version = env!("CARGO_PKG_VERSION"),
        title = html(title),
    )
}

/// Empty places which the viewer fills.
fn stage(runs: &[RunData], out: &mut dyn Write) -> io::Result<()> {
    writeln!(
        out,
        r#"<noscript><p class="note">The moving picture and the plots need JavaScript.</p></noscript>
<nav id="legend" aria-label="Runs"></nav>
<section id="motion" aria-label="Motion"></section>
<section id="machine" aria-label="Machine"></section>"#
    )?;
    for run in runs.iter().filter(|run| run.stride > 1) {
        let label = if runs.len() > 1 { format!("{}: ", html(run.label)) } else { String::new() };
        let (stride, recorded) = (run.stride, run.recorded);
        writeln!(
            out,
            "<p class=\"note\">{label}picture and plots show one in {stride} of {recorded} recorded rows; violations, iterations and \
             energy errors are the largest since the row before, and curves come to the least and the largest value of every two.</p>"
        )?;
    }
    Ok(())
}

/// How the solver did: its figures, and a place for plots. Of a single run that is sound nobody asks for it first.
fn health(runs: &[Run], data: &[RunData], out: &mut dyn Write) -> io::Result<()> {
    let is_open = if data.len() == 1 && data[0].sound { "" } else { " open" };
    writeln!(out, "<details id=\"health\"{is_open}><summary>Energy, violations and iterations</summary>")?;
    figures::solver(runs, out)?;
    writeln!(out, "<section id=\"plots\" aria-label=\"Plots\"></section></details>")
}

/// What the viewer reads.
#[derive(Serialize)]
struct Data<'a> {
    /// What the places of the picture are counted from, in world axes, m.
    origin: [f64; 3],
    runs: &'a [RunData<'a>],
    /// Columns that are plotted first, in place of those that are shown otherwise.
    columns: &'a [String],
}

fn scripts(data: &Data, script: &str, out: &mut dyn Write) -> io::Result<()> {
    let json = serde_json::to_string(data).map_err(io::Error::other)?;
    writeln!(out, "<script type=\"application/json\" id=\"holonom-data\">{}</script>", json_in_script(&json))?;
    writeln!(out, "<script>\n{script}</script>")
}

/// A list of notes, where there are any.
pub fn notes(notes: impl Iterator<Item = String>, out: &mut dyn io::Write) -> io::Result<()> {
    let items: String = notes.map(|note| format!("<li><strong>note:</strong> {}</li>", html(&note))).collect();
    if items.is_empty() { Ok(()) } else { writeln!(out, r#"<ul class="notes">{items}</ul>"#) }
}
