//! What was run, above the model file: what the command line changed of it, when, and by which version.

use crate::escape::html;
use serde_json::Value;
use std::io;

/// A key that was changed, with what stands in the file and what was run.
type Change<'a> = [&'a Value; 3];

/// Writes what the summaries of some runs, each with its label, say of where they come from; nothing where they do not.
pub fn write(runs: &[(&str, &Value)], out: &mut dyn io::Write) -> io::Result<()> {
    let Some((_, first)) = runs.iter().find(|(_, of)| of.is_object()) else { return Ok(()) };
    writeln!(out, "<section>\n<h2>What was run</h2>")?;
    let word = |key: &str| html(first[key].as_str().unwrap_or(""));
    writeln!(
        out,
        "<p class=\"method\">holonom {} · {}</p>\n<pre class=\"model\">{}</pre>",
        word("version"),
        word("date"),
        word("command")
    )?;
    changes(runs, out)?;
    writeln!(out, "</section>")
}

/// A table of what differs from the model file, and in which runs where that is not so in all.
fn changes(runs: &[(&str, &Value)], out: &mut dyn io::Write) -> io::Result<()> {
    let mut found: Vec<(Change<'_>, Vec<&str>)> = Vec::new();
    for (label, provenance) in runs {
        for change in provenance["overrides"].as_array().into_iter().flatten() {
            let change = ["key", "file", "run"].map(|key| &change[key]);
            match found.iter_mut().find(|(known, _)| *known == change) {
                Some((_, labels)) => labels.push(label),
                None => found.push((change, vec![label])),
            }
        }
    }
    if found.is_empty() {
        return Ok(());
    }
    let of_some = found.iter().any(|(_, labels)| labels.len() < runs.len());
    let head = if of_some { "<th scope=\"col\">runs</th>" } else { "" };
    writeln!(
        out,
        "<p class=\"note\">The command line changed the model file below:</p>\n<div class=\"scroll\"><table class=\"summary\"><thead><tr>\
         <th scope=\"col\">key</th><th scope=\"col\">in the file</th><th scope=\"col\">as it ran</th>{head}</tr></thead><tbody>"
    )?;
    for ([key, file, run], labels) in found {
        let labels = if labels.len() < runs.len() { labels.join(", ") } else { "all".into() };
        let cell = if of_some { format!("<td>{}</td>", html(&labels)) } else { String::new() };
        writeln!(out, "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td>{cell}</tr>", text(key), text(file), text(run))?;
    }
    writeln!(out, "</tbody></table></div>")
}

/// A value with every digit, as it stands in a file but for quotes.
fn text(value: &Value) -> String {
    match value {
        Value::Null => "–".to_owned(),
        Value::String(text) => html(text),
        value => html(&value.to_string()),
    }
}
