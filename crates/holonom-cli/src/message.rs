//! What the command says on standard error.

use holonom_io::Source;

/// Names that are said one by one.
const NAMED: usize = 5;

/// Says something that is not wrong, and may be unwanted.
pub fn note(text: &str) {
    eprintln!("note: {text}");
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
    let quoted: Vec<String> = source.unused_parameters().iter().map(|name| format!("`{name}`")).collect();
    match quoted.len() {
        0 => None,
        1 => Some(format!("nothing uses the parameter {}", quoted[0])),
        _ => Some(format!("nothing uses the parameters {}", listed(&quoted))),
    }
}
