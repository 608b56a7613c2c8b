//! What the command says on standard error, in colour on a terminal where `NO_COLOR` does not forbid it.

use anstyle::{AnsiColor, Style};

use holonom_io::Source;

/// Names that are said one by one.
const NAMED: usize = 5;

/// Words that begin a line, or follow its margin, with their colours.
const WORDS: [(&str, Style); 3] = [
    ("error:", AnsiColor::Red.on_default().bold()),
    ("note:", AnsiColor::Cyan.on_default().bold()),
    ("cure:", AnsiColor::Green.on_default().bold()),
];

/// Says something that is not wrong, and may be unwanted.
pub fn note(text: &str) {
    say(&format!("note: {text}"));
}

/// Says something on standard error.
pub fn say(text: &str) {
    let lines: Vec<String> = text.lines().map(painted).collect();
    anstream::eprintln!("{}", lines.join("\n"));
}

/// A line with its first word in colour, if that is one of [`WORDS`].
fn painted(line: &str) -> String {
    let start = line.len() - line.trim_start_matches([' ', '=']).len();
    let (margin, text) = line.split_at(start);
    match WORDS.iter().find_map(|(word, style)| Some((word, style, text.strip_prefix(word)?))) {
        Some((word, style, rest)) => format!("{margin}{style}{word}{style:#}{rest}"),
        None => line.to_string(),
    }
}

/// Words with commas between them; those beyond the first few are counted.
pub fn listed(words: &[String]) -> String {
    match words.len().saturating_sub(NAMED) {
        0 => words.join(", "),
        more => format!("{}, and {more} more", words[..NAMED].join(", ")),
    }
}

/// What a model does not need.
pub fn unused_parameters(source: &Source) -> Option<String> {
    nothing_uses(&source.unused_parameters())
}

/// That nothing uses some parameters.
pub fn nothing_uses(names: &[&str]) -> Option<String> {
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    match quoted.len() {
        0 => None,
        1 => Some(format!("nothing uses the parameter {}", quoted[0])),
        _ => Some(format!("nothing uses the parameters {}", listed(&quoted))),
    }
}
