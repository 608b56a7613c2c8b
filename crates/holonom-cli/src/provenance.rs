//! What was run: kept with the results, so that they can be told from others, and gone on with.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::Path;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};
use serde_json::Value;

/// The program's version, as results are marked with it.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");

/// What results of a model come from, however they are found.
#[derive(Clone, Debug, Serialize)]
pub struct Origin {
    pub version: String,
    /// When they were asked for, UTC, as in ISO 8601.
    pub date: String,
    /// What was typed.
    pub command: String,
    /// Keys of the model file that the command line replaced.
    pub overrides: Vec<Override>,
    /// SHA-256 of the files that the model names.
    pub files: BTreeMap<String, String>,
    /// Text of the model file.
    pub model: String,
}

/// Everything that the numbers of a run follow from, when it was started, and what was typed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Provenance {
    pub version: String,
    /// When the run began, UTC, as in ISO 8601.
    pub date: String,
    /// What was typed.
    pub command: String,
    /// Name of the method, step and end (s), and recorded share of the steps.
    pub method: String,
    pub step: f64,
    pub end: f64,
    pub every: u64,
    /// Keys of the model file that the command line replaced.
    pub overrides: Vec<Override>,
    /// SHA-256 of the files that the model names.
    pub files: BTreeMap<String, String>,
    /// Text of the model file.
    pub model: String,
}

/// A key of the model file that has another value in the run.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Override {
    pub key: String,
    /// In the file; null where it does not say.
    pub file: Value,
    pub run: Value,
}

/// The present time, UTC, to the second.
pub fn now() -> String {
    humantime::format_rfc3339_seconds(SystemTime::now()).to_string()
}

/// What was typed, as a shell takes it. Of the program there is its name only, and the home folder is `~`, as results say nothing of
/// the machine and its user.
pub fn command_line() -> String {
    let home = std::env::home_dir();
    let words = std::env::args_os().skip(1).map(|word| quoted(&word, home.as_deref()));
    std::iter::once("holonom".to_string()).chain(words).collect::<Vec<_>>().join(" ")
}

fn quoted(word: &OsStr, home: Option<&Path>) -> String {
    let quote = |word: &OsStr| {
        let word = word.to_string_lossy().replace('\0', "");
        shlex::try_quote(&word).expect("there is no zero in it").into_owned()
    };
    let in_home = home.filter(|home| home.components().count() > 1).and_then(|home| Path::new(word).strip_prefix(home).ok());
    match in_home {
        Some(rest) if rest.as_os_str().is_empty() => "~".to_string(),
        Some(rest) => format!("~/{}", quote(rest.as_os_str())),
        None => quote(word),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_and_the_home_folder_has_no_name() {
        let typed = |word: &str| quoted(OsStr::new(word), Some(Path::new("/home/ada")));
        for (word, told) in [
            ("run", "run"),
            ("simulation.step=1/N", "'simulation.step=1/N'"),
            ("a b", "'a b'"),
            ("/home/ada/a b/c.toml", "~/'a b/c.toml'"),
            ("/home/ada", "~"),
            ("/home/adam/c.toml", "/home/adam/c.toml"),
        ] {
            assert_eq!(typed(word), told);
        }
        assert_eq!(quoted(OsStr::new("/a"), Some(Path::new("/"))), "/a");
    }
}
