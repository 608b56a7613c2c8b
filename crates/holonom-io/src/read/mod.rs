//! Model files: TOML in, a description with the place of everything in it out.

mod columns;
mod mesh;
mod places;
mod recording;
mod render;
mod rows;
mod toml;

use std::collections::{BTreeMap, HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use holonom::model::{Description, Fault, Faults, Files, Kinds, Mesh, Model, NoFiles, NumberFile, Table, Value, unused_parameters};
use sha2::{Digest, Sha256};

use columns::Columns;
pub use columns::TableError;
pub use mesh::{LARGEST_MESH, MOST_TRIANGLES, MeshError, read_mesh};
use places::Places;
pub use recording::read_recording;
pub use rows::read_csv;

/// Largest model file that is read, bytes: some 40 000 entries, while parsing takes up to fifty times as much memory.
pub const LARGEST_FILE: usize = 4 * 1024 * 1024;

/// Largest CSV file that a model may name, bytes.
pub const LARGEST_NUMBERS: usize = 256_000_000;

/// Deepest nesting of lists and tables in a model file.
pub const DEEPEST: usize = 64;

/// A description and where everything in it stands in its file. A copy shares what was read of the files that the model names.
#[derive(Clone)]
pub struct Source {
    name: String,
    text: String,
    /// The description; [`Source::set`] changes it.
    value: Value,
    /// What stood in the file at the keys that were set.
    replaced: Vec<(String, Option<Value>)>,
    places: Places,
    /// The files that the model names, where they can be read.
    files: Option<Arc<FilesBeside>>,
    kinds: Kinds,
}

impl Source {
    /// Reads the bytes of a model file called `name`.
    ///
    /// # Errors
    /// What is wrong with it as TOML, ready to be shown: with file, line, column and cure.
    pub fn read(name: &str, bytes: &[u8]) -> Result<Self, String> {
        if bytes.len() > LARGEST_FILE {
            let message = format!("the file is larger than {} MB, and no model is", LARGEST_FILE / (1024 * 1024));
            return Err(render::whole(&format!("{name}:1:1"), &message, "use repeat for arrays of points and bars"));
        }
        Self::read_all(name, bytes)
    }

    /// The same, however long it is: of what a program has made, and not of a file that may be anything.
    ///
    /// # Errors
    /// As for a file.
    pub fn read_all(name: &str, bytes: &[u8]) -> Result<Self, String> {
        let text = decode(name, bytes)?;
        let mut places = Places::default();
        let value = toml::parse(&text, &mut places).map_err(|error| render::syntax(name, &text, &error))?;
        Ok(Self { name: name.into(), text, value, replaced: Vec::new(), places, files: None, kinds: Kinds::default() })
    }

    /// Says in which folder the files are that the model names.
    pub fn beside(mut self, folder: &Path) -> Self {
        let (meshes, numbers, sums) = Default::default();
        self.files = Some(Arc::new(FilesBeside { folder: folder.into(), meshes, numbers, sums }));
        self
    }

    /// Says which kinds of joints, constraints, drives and forces the model may have, where that is more than those of this program.
    pub fn knowing(mut self, kinds: Kinds) -> Self {
        self.kinds = kinds;
        self
    }

    /// Sets a key such as `simulation.step` to a value written as in the file; what is no TOML value is a text, so that
    /// expressions need no quotes.
    ///
    /// # Errors
    /// When a part of the key before the last is no table.
    pub fn set(&mut self, key: &str, value: &str) -> Result<(), String> {
        self.put(key, read_value(value))
    }

    /// Sets a key to a value.
    ///
    /// # Errors
    /// When a part of the key before the last is no table.
    pub fn put(&mut self, key: &str, value: Value) -> Result<(), String> {
        let before = self.get(key).cloned();
        put(&mut self.value, key, value).map_err(|part| {
            format!(
                "error: `{key}` cannot be set: `{part}` is not a table\n  = cure: name a key of the model file, such as simulation.step"
            )
        })?;
        self.places.forget(key);
        if self.replaced.iter().all(|(known, _)| known != key) {
            self.replaced.push((key.into(), before));
        }
        Ok(())
    }

    /// The keys that were set, in the order in which they first were, with what stands in the file there.
    pub fn replaced(&self) -> &[(String, Option<Value>)] {
        &self.replaced
    }

    /// The whole description, with all that was set.
    pub fn value(&self) -> &Value {
        &self.value
    }

    /// Names of the files that the model was read with beside its own, with the SHA-256 of their bytes.
    pub fn files(&self) -> BTreeMap<String, String> {
        self.files.as_ref().map(|files| files.sums.lock().expect("no reader panics").clone()).unwrap_or_default()
    }

    /// What stands at a key such as `simulation.step`.
    pub fn get(&self, key: &str) -> Option<&Value> {
        key.split('.').try_fold(&self.value, |value, part| match value {
            Value::Table(table) => table.get(part),
            _ => None,
        })
    }

    /// The parameters that nothing uses.
    pub fn unused_parameters(&self) -> Vec<&str> {
        unused_parameters(&self.value)
    }

    /// Reads the description as a model.
    ///
    /// # Errors
    /// Every fault of it, ready to be shown.
    pub fn model(&self) -> Result<Model, String> {
        self.compile(&self.value).map_err(|faults| self.render(&faults))
    }

    /// The same, with what tells the forces of joints whose bodies share nodes.
    ///
    /// # Errors
    /// Every fault of it, ready to be shown.
    pub fn model_with_forces(&self) -> Result<Model, String> {
        self.model_with_forces_and(&[]).map_err(|faults| self.render(&faults))
    }

    /// The same with some keys set to other values.
    ///
    /// # Errors
    /// Every fault of it.
    pub fn model_with_forces_and(&self, changes: &[(&str, Value)]) -> Result<Model, Faults> {
        let mut model = self.model_with(changes)?;
        if model.shares_nodes() && model.output.reactions != Some(false) {
            let apart = self.changed(&[changes, &[("output.reactions", Value::Bool(true))]].concat())?;
            if !model.tell_forces(&apart, &self.kinds, self.files_beside())? {
                let message =
                    "the parts are so small beside their distances that rounding decides which places are the same: joints have no forces";
                let cure = "write the model nearer to the origin, or leave the forces of joints out: reactions = false in [output]";
                return Err(Faults(vec![Fault::new("joint", "", message, cure)]));
            }
        }
        Ok(model)
    }

    /// Reads the description with some keys set to other values as a model, and stays as it is.
    ///
    /// # Errors
    /// Every fault of it.
    pub fn model_with(&self, changes: &[(&str, Value)]) -> Result<Model, Faults> {
        self.compile(&self.changed(changes)?)
    }

    fn changed(&self, changes: &[(&str, Value)]) -> Result<Value, Faults> {
        let mut value = self.value.clone();
        for (key, change) in changes {
            put(&mut value, key, change.clone())
                .map_err(|part| Faults(vec![Fault::new(*key, "", format!("`{part}` is not a table"), "name a key of the model file")]))?;
        }
        Ok(value)
    }

    fn compile(&self, value: &Value) -> Result<Model, Faults> {
        Model::from_value_with(value, &self.kinds, self.files_beside())
    }

    fn files_beside(&self) -> &dyn Files {
        self.files.as_ref().map_or(&NoFiles, |files| &**files)
    }

    /// The description, to be changed and compiled by hand.
    ///
    /// # Errors
    /// Every fault of its shape, ready to be shown.
    pub fn description(&self) -> Result<Description, String> {
        Description::from_value(&self.value, &self.kinds).map_err(|faults| self.render(&faults))
    }

    /// Faults with their places in the file.
    pub fn render(&self, faults: &Faults) -> String {
        // In the order of the file; what has no place in it comes last.
        let mut faults: Vec<&Fault> = faults.0.iter().collect();
        faults.sort_by_key(|fault| self.places.find(&fault.path, fault.on_key).map_or(usize::MAX, |bytes| bytes.start));
        let shown: Vec<String> = faults.into_iter().map(|fault| self.shown(fault)).collect();
        let count = shown.len();
        match count {
            1 => shown.join("\n"),
            _ => format!("{}\n{count} faults", shown.join("\n")),
        }
    }

    /// A fault with its place in the file, or in what was set outside of it.
    fn shown(&self, fault: &Fault) -> String {
        let set = |key: &str| render::setting(key, self.get(key));
        if let Some((key, _)) = self.replaced.iter().find(|(key, _)| is_within(&fault.path, key)) {
            let place = format!("{}, which is set outside {}, by --set or another option", set(key), self.name);
            return render::whole(&place, &fault.message, &fault.cure);
        }
        let named = self.parameters_of(&fault.offending);
        let is_part = |key: &str| is_within(key, &fault.path) || key.strip_prefix("parameters.").is_some_and(|name| named.contains(name));
        let parts: Vec<String> = self.replaced.iter().filter(|(key, _)| is_part(key)).map(|(key, _)| set(key)).collect();
        let message = match parts.is_empty() {
            true => fault.message.clone(),
            false => format!("{}, with {} from --set or another option", fault.message, parts.join(" and ")),
        };
        render::fault(&self.name, &self.text, &self.places, &Fault { message, ..fault.clone() })
    }

    /// The parameters that a text names, by itself and through others.
    fn parameters_of<'a>(&'a self, text: &'a str) -> HashSet<&'a str> {
        let mut found = HashSet::new();
        let Some(Value::Table(parameters)) = self.get("parameters") else { return found };
        let mut open = vec![text];
        while let Some(text) = open.pop() {
            for word in text.split(|c: char| !(c.is_alphanumeric() || c == '_')) {
                if let Some(value) = parameters.get(word).filter(|_| found.insert(word))
                    && let Value::Text(text) = value
                {
                    open.push(text);
                }
            }
        }
        found
    }

    /// Line and column, both from 1, at which a fault or the nearest thing around it stands in the file; none where nothing of it does.
    pub fn place(&self, fault: &Fault) -> Option<[usize; 2]> {
        let bytes = render::bytes(&self.text, &self.places, fault)?;
        Some(render::position(&self.text, bytes.start))
    }

    /// The text of the file.
    pub fn text(&self) -> &str {
        &self.text
    }
}

/// A value as `--set` takes it: written as in a file, and a text where it is no TOML value.
pub fn read_value(text: &str) -> Value {
    toml::value(text).unwrap_or_else(|| Value::text(text))
}

/// Whether a path is that of a key or of something in it.
fn is_within(path: &str, key: &str) -> bool {
    path.strip_prefix(key).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
}

/// Puts a value at a key of a description, with the tables around it; or says which part of the key is no table.
fn put<'a>(description: &mut Value, key: &'a str, value: Value) -> Result<(), &'a str> {
    let (tables, last) = key.rsplit_once('.').map_or((None, key), |(tables, last)| (Some(tables), last));
    let mut table = match description {
        Value::Table(table) => table,
        _ => unreachable!("a file is a table"),
    };
    for part in tables.into_iter().flat_map(|tables| tables.split('.')) {
        if table.get(part).is_none() {
            table.push(part, Value::Table(Table::default()));
        }
        table = match table.get_mut(part) {
            Some(Value::Table(table)) => table,
            _ => return Err(part),
        };
    }
    table.set(last, value);
    Ok(())
}

/// Files of a folder, each read once.
struct FilesBeside {
    folder: PathBuf,
    meshes: Mutex<HashMap<String, Arc<Mesh>>>,
    numbers: Mutex<HashMap<String, Arc<NumberFile>>>,
    /// SHA-256 of each.
    sums: Mutex<BTreeMap<String, String>>,
}

impl Files for FilesBeside {
    fn mesh(&self, name: &str) -> Result<Arc<Mesh>, String> {
        once(&self.meshes, name, || {
            let bytes = self.bytes(name, LARGEST_MESH)?;
            read_mesh(name, &bytes).map_err(|error| error.to_string())
        })
    }

    fn numbers(&self, name: &str) -> Result<Arc<NumberFile>, [String; 2]> {
        once(&self.numbers, name, || {
            let bytes = self.bytes(name, LARGEST_NUMBERS).map_err(|message| [message, "name a CSV file beside the model".into()])?;
            // Whether a cell that is empty matters is a matter of its column.
            let number = |cell: &str| if cell.trim().is_empty() { Some(f64::NAN) } else { cell.parse().ok() };
            let read =
                Columns::read(&bytes, |_, _, cell| number(cell)).map_err(|error| [format!("`{name}`: {error}"), error.cure().into()])?;
            Ok(NumberFile { names: read.names, columns: read.columns })
        })
    }
}

/// What was read of a file before, or is read now.
fn once<T, E>(known: &Mutex<HashMap<String, Arc<T>>>, name: &str, read: impl FnOnce() -> Result<T, E>) -> Result<Arc<T>, E> {
    let mut known = known.lock().expect("no reader panics");
    if let Some(known) = known.get(name) {
        return Ok(known.clone());
    }
    let read = Arc::new(read()?);
    known.insert(name.into(), read.clone());
    Ok(read)
}

impl FilesBeside {
    fn bytes(&self, name: &str, largest: usize) -> Result<Vec<u8>, String> {
        let path = self.folder.join(name);
        let size = std::fs::metadata(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?.len();
        if size > largest as u64 {
            return Err(format!("{} is larger than {} MB", path.display(), largest / 1_000_000));
        }
        let bytes = std::fs::read(&path).map_err(|error| format!("{} cannot be read: {error}", path.display()))?;
        self.sums.lock().expect("no reader panics").insert(name.into(), sha256(&bytes));
        Ok(bytes)
    }
}

/// The SHA-256 of bytes, in hexadecimal digits.
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The text of a file, if it is one and could be a model.
fn decode(name: &str, bytes: &[u8]) -> Result<String, String> {
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
