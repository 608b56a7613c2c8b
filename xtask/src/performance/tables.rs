//! The tables of the chapter.

use super::results::{Cost, Count, Precision, Results};
use crate::book::table::figure;

/// Names of the tables in the chapter, and the tables.
pub fn all(results: &Results) -> Vec<(&'static str, String)> {
    vec![
        ("machine", machine(results)),
        ("cost", cost(&results.times.cost)),
        ("precision", precision(&results.times.goals, &results.times.precision)),
        ("gallery", counts(&results.counts.gallery)),
        ("counts", counts(&results.counts.benches)),
    ]
}

fn machine(results: &Results) -> String {
    let times = &results.times;
    let versions: Vec<String> = times.versions.iter().map(|(program, version)| format!("{program} {version}")).collect();
    format!(
        "| | |\n|---|---|\n| processor | {}, {} cores |\n| load at the start | {} |\n| rounds | {}, against precision {} |\n| peers | {} |\n",
        times.machine.processor,
        times.machine.cores,
        times.machine.load,
        times.rounds.cost,
        times.rounds.precision,
        versions.join(", ")
    )
}

/// µs a step; each problem's first line is what the others are compared with.
fn cost(entries: &[Cost]) -> String {
    let mut text = String::from(
        "| problem | program | µs a step | over the first | error | energy, J | position | velocity |\n|---|---|---|---|---|---|---|---|\n",
    );
    let mut title = "";
    let mut first = None;
    for entry in entries {
        let problem = if entry.title == title {
            String::new()
        } else {
            first = entry.us;
            format!("**{}**, h = {:e} s, {} s", entry.title, entry.step, entry.end)
        };
        title = &entry.title;
        let time = match (&entry.failed, entry.us) {
            (Some(reason), _) => [format!("fails: {reason}"), "–".into()],
            (None, us) => [shown(us), shown(us.zip(first).map(|(us, first)| us / first))],
        };
        let rest = [entry.error, entry.drift, entry.position, entry.velocity].map(shown);
        text += &format!("| {problem} | {} {} | {} | {} |\n", entry.program, entry.setting, time.join(" | "), rest.join(" | "));
    }
    text
}

/// CPU seconds to an error; the least of each column of a problem is bold.
fn precision(goals: &[f64], entries: &[Precision]) -> String {
    let columns: String = goals.iter().map(|goal| format!(" {goal:e} |")).collect();
    let mut text = format!("| problem | program |{columns}\n|---|---|{}\n", "---|".repeat(goals.len()));
    for (k, entry) in entries.iter().enumerate() {
        let is_first = k == 0 || entries[k - 1].title != entry.title;
        let problem = if is_first { format!("**{}**", entry.title) } else { String::new() };
        let cells: Vec<String> = (0..goals.len()).map(|goal| time_to(entries, entry, goal)).collect();
        let cells = match &entry.failed {
            Some(reason) => format!("fails: {reason}{}", " | –".repeat(goals.len() - 1)),
            None => cells.join(" | "),
        };
        text += &format!("| {problem} | {} {} | {cells} |\n", entry.program, entry.setting);
    }
    text
}

fn time_to(entries: &[Precision], entry: &Precision, goal: usize) -> String {
    let rivals = entries.iter().filter(|other| other.title == entry.title).filter_map(|other| other.to[goal]);
    let least = rivals.fold(f64::INFINITY, f64::min);
    match entry.to[goal] {
        Some(time) if time == least => format!("**{}**", figure(time)),
        time => shown(time),
    }
}

fn counts(entries: &[Count]) -> String {
    let mut text =
        String::from("| mechanism | method | step, s | iterations | factorisations | 1000 instructions |\n|---|---|---|---|---|---|\n");
    for entry in entries {
        let thousands = entry.instructions / 1e3;
        let instructions = if thousands < 100.0 { format!("{thousands:.1}") } else { format!("{thousands:.0}") };
        let [iterations, factorizations] = [entry.iterations, entry.factorizations].map(|count| format!("{count:.2}"));
        text += &format!("| {} | `{}` | {} | {iterations} | {factorizations} | {instructions} |\n", entry.name, entry.method, entry.step);
    }
    text
}

fn shown(value: Option<f64>) -> String {
    value.map_or("–".into(), figure)
}
