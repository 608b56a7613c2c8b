//! A mechanism as it is written: a header and entries with names, as a model file has them.

use std::collections::HashSet;
use std::fmt::Write;

use nalgebra::Vector3;

/// A key with its value in TOML.
pub type Key = (&'static str, String);

/// An entry `[section.name]`.
#[derive(Clone)]
pub struct Entry {
    pub section: &'static str,
    pub name: String,
    /// Names of the entries that it cannot be without.
    pub uses: Vec<String>,
    pub keys: Vec<Key>,
}

/// A mechanism, with what its figures are measured by.
#[derive(Clone)]
pub struct Mechanism {
    /// Keys before all entries.
    pub header: Vec<Key>,
    pub entries: Vec<Entry>,
    pub reactions: bool,
    /// Length that its bodies are of within a factor of ten, m.
    pub size: f64,
    /// Its time scale: speed over size, 1/s.
    pub rate: f64,
    /// What its energies are rounded to: weight times distance from the origin, J.
    pub weight: f64,
}

/// Nominal steps of a run.
pub const STEPS: u32 = 50;

impl Mechanism {
    /// Step of a run, s: a hundredth of the time scale.
    pub fn step(&self) -> f64 {
        0.01 / self.rate
    }

    /// End of a run, s.
    pub fn end(&self) -> f64 {
        f64::from(STEPS) * self.step()
    }

    /// Whether rows may depend on time.
    pub fn depends_on_time(&self) -> bool {
        self.entries.iter().any(|entry| ["drive", "constraint"].contains(&entry.section))
    }

    /// The model file.
    pub fn toml(&self) -> String {
        let mut text = String::new();
        let mut line = |line: std::fmt::Arguments<'_>| writeln!(text, "{line}").expect("a String takes everything");
        self.header.iter().for_each(|(key, value)| line(format_args!("{key} = {value}")));
        for entry in &self.entries {
            line(format_args!("\n[{}.{}]", entry.section, entry.name));
            entry.keys.iter().for_each(|(key, value)| line(format_args!("{key} = {value}")));
        }
        line(format_args!("\n[simulation]\nstep = {}\nend = {}", number(self.step()), number(self.end())));
        line(format_args!("\n[output]\nreactions = {}", self.reactions));
        text
    }

    /// Without an entry and all that cannot be without it.
    pub fn without(&self, entry: usize) -> Self {
        let mut gone: HashSet<&str> = HashSet::from([self.entries[entry].name.as_str()]);
        // What is used stands before what uses it.
        for entry in &self.entries {
            if entry.uses.iter().any(|name| gone.contains(name.as_str())) {
                gone.insert(&entry.name);
            }
        }
        let entries = self.entries.iter().filter(|entry| !gone.contains(entry.name.as_str())).cloned().collect();
        Self { entries, ..self.clone() }
    }
}

/// A number in TOML that is read back to the bit.
pub fn number(value: f64) -> String {
    format!("{value:?}")
}

/// A text in TOML.
pub fn text(value: &str) -> String {
    format!("\"{value}\"")
}

/// A list in TOML.
pub fn list(items: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", items.into_iter().collect::<Vec<_>>().join(", "))
}

/// A vector in TOML with as many numbers as the model has axes.
pub fn vector(dim: usize, v: &Vector3<f64>) -> String {
    list(v.iter().take(dim).map(|&c| number(c)))
}
