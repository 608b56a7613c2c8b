//! Model files: TOML in, a description with the place of everything in it out.

mod mesh;
mod places;
mod render;
mod toml;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use holonom::model::{Faults, Mesh, Meshes, Model, NoMeshes, Table, Value};

pub use mesh::{LARGEST_MESH, MOST_TRIANGLES, MeshError, read_mesh};
use places::Places;

/// Largest model file that is read, bytes: some 40 000 entries, while parsing takes up to fifty times as much memory.
pub const LARGEST_FILE: usize = 4 * 1024 * 1024;

/// Deepest nesting of lists and tables in a model file.
pub const DEEPEST: usize = 64;

/// A description and where everything in it stands in its file.
pub struct Source {
    name: String,
    text: String,
    /// The description; [`Source::set`] changes it.
    value: Value,
    places: Places,
    /// Where files that the model names are.
    folder: Option<PathBuf>,
}

impl Source {
    /// Reads the bytes of a model file called `name`.
    ///
    /// # Errors
    /// What is wrong with it as TOML, ready to be shown: with file, line, column and cure.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, String> {
        let text = decode(name, bytes)?;
        let mut places = Places::default();
        let value = toml::parse(&text, &mut places).map_err(|error| render::syntax(name, &text, &error))?;
        Ok(Self { name: name.into(), text, value, places, folder: None })
    }

    /// Says in which folder the files are that the model names.
    pub fn beside(mut self, folder: &Path) -> Self {
        self.folder = Some(folder.into());
        self
    }

    /// Sets a key such as `simulation.step` to a value written as in the file; what is no TOML value is a text, so that
    /// expressions need no quotes.
    ///
    /// # Errors
    /// When a part of the key before the last is no table.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        let mut parts: Vec<&str> = key.split('.').collect();
        let last = parts.pop().unwrap_or("");
        let mut table = match &mut self.value {
            Value::Table(table) => table,
            _ => unreachable!("a file is a table"),
        };
        for part in parts {
            if table.get(part).is_none() {
                table.push(part, Value::Table(Table::default()));
            }
            table = match table.get_mut(part) {
                Some(Value::Table(table)) => table,
                _ => {
                    return Err(format!(
                        "error: `{key}` cannot be set: `{part}` is not a table\n  = cure: name a key of the model file, such as simulation.step"
                    ));
                }
            };
        }
        table.set(last, toml::value(value).unwrap_or_else(|| Value::text(value)));
        self.places.forget(key);
        Ok(())
    }

    /// Reads the description as a model.
    ///
    /// # Errors
    /// Every fault of it, ready to be shown.
    pub fn model(&self) -> Result<Model, String> {
        let model = match &self.folder {
            Some(folder) => Model::from_value(&self.value, &MeshFiles(folder)),
            None => Model::from_value(&self.value, &NoMeshes),
        };
        model.map_err(|faults| self.render(&faults))
    }

    /// Faults with their places in the file.
    pub fn render(&self, faults: &Faults) -> String {
        let shown: Vec<String> = faults.0.iter().map(|fault| render::fault(&self.name, &self.text, &self.places, fault)).collect();
        let count = shown.len();
        match count {
            1 => shown.join("\n"),
            _ => format!("{}\n{count} faults", shown.join("\n")),
        }
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// Meshes in files of a folder.
struct MeshFiles<'a>(&'a Path);

impl Meshes for MeshFiles<'_> {
    fn mesh(&self, name: &str) -> Result<Arc<Mesh>, String> {
        let path = self.0.join(name);
        let size = std::fs::metadata(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?.len();
        if size > LARGEST_MESH as u64 {
            return Err(format!("{} is larger than {} MB", path.display(), LARGEST_MESH / 1_000_000));
        }
        let bytes = std::fs::read(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        read_mesh(name, &bytes).map(Arc::new).map_err(|error| error.to_string())
    }
}

/// The text of a file, if it is one and could be a model.
fn decode(name: &str, bytes: &[u8]) -> Result<String, String> {
    if bytes.len() > LARGEST_FILE {
        let message = format!("the file is larger than {} MB, and no model is", LARGEST_FILE / (1024 * 1024));
        return Err(render::whole(&format!("{name}:1:1"), &message, "use repeat for arrays of points and bars"));
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            let valid = String::from_utf8_lossy(&bytes[..error.valid_up_to()]);
            let line = 1 + valid.matches('\n').count();
            let column = 1 + valid.chars().rev().take_while(|&c| c != '\n').count();
            return Err(render::whole(
                &format!("{name}:{line}:{column}"),
                "the file is not text (UTF-8)",
                "give a model file in TOML; `holonom examples` shows some",
            ));
        }
    };
    if text.trim().is_empty() {
        return Err(render::whole(
            &format!("{name}:1:1"),
            "the file is empty",
            "begin with a point, a constraint and [simulation]; `holonom examples spherical-compound-pendulum` shows one",
        ));
    }
    if let Some(at) = too_deep(text) {
        return Err(render::at(
            name,
            text,
            at..at + 1,
            "",
            &format!("brackets are nested deeper than {DEEPEST}"),
            "close every bracket where its list or table ends, and nest fewer",
        ));
    }
    Ok(text.to_string())
}

/// The first bracket outside texts and comments that nests too deeply.
fn too_deep(text: &str) -> Option<usize> {
    let bytes = text.as_bytes();
    let (mut depth, mut at) = (0_usize, 0);
    while at < bytes.len() {
        match bytes[at] {
            b'#' => at += bytes[at..].iter().position(|&byte| byte == b'\n').unwrap_or(bytes.len() - at),
            quote @ (b'"' | b'\'') => at = end_of_text(bytes, at, quote),
            b'[' | b'{' => depth += 1,
            b']' | b'}' => depth = depth.saturating_sub(1),
            _ => (),
        }
        if depth > DEEPEST {
            return Some(at);
        }
        at += 1;
    }
    None
}

/// The last byte of a text that starts at `start`, or of its line when it is never closed.
fn end_of_text(bytes: &[u8], start: usize, quote: u8) -> usize {
    let triple = bytes[start..].starts_with(&[quote; 3]);
    let mut at = start + if triple { 3 } else { 1 };
    while at < bytes.len() {
        match bytes[at] {
            b'\\' if quote == b'"' => at += 1,
            b'\n' if !triple => return at,
            byte if byte == quote && !triple => return at,
            byte if byte == quote && bytes[at..].starts_with(&[quote; 3]) => return at + 2,
            _ => (),
        }
        at += 1;
    }
    bytes.len()
}
