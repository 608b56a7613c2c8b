//! A model as it is written, by a file or by a program.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use holonom::model::{Description, Fault, Faults, Kinds, Table, Value, key_path};
use holonom::run::RunError;
use holonom_cli::{Loaded, require_key, run_failure};
use holonom_io::{Source, model_text};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use pyo3::{PyTraverseError, PyVisit};

use crate::fault::{Placed, failure, model_error, refuse};
use crate::function::{self, Trouble, external};
use crate::value;

/// Sections of entries whose names are unique among all of them.
const NAMED: [&str; 12] = ["table", "input", "point", "body", "bar", "beam", "joint", "constraint", "drive", "force", "measure", "event"];

/// The section whose keys are names that people choose.
const PARAMETERS: &str = "parameters";

/// What a pickled draft is made of: name, text, changed description as text, folder, functions, lines.
pub type Parts = (String, Option<String>, Option<String>, Option<PathBuf>, HashMap<String, Py<PyAny>>, HashMap<String, String>);

/// A model as it is written.
#[pyclass(module = "holonom._engine")]
pub struct Draft {
    /// As messages call it.
    name: String,
    /// Text of its file, where it has one.
    text: Option<String>,
    value: Value,
    /// Whether the description is another than that of the file.
    is_changed: bool,
    /// Of the files that it names.
    folder: Option<PathBuf>,
    /// Functions that its formulas call, by their names, as `holonom._functions` has them.
    functions: HashMap<String, Py<PyAny>>,
    /// Line of the program for the path of each entry that a program has made.
    lines: HashMap<String, String>,
}

impl Draft {
    fn root(&mut self) -> &mut Table {
        self.is_changed = true;
        match &mut self.value {
            Value::Table(table) => table,
            _ => unreachable!("a description is a table"),
        }
    }

    fn section(&self, name: &str) -> Option<&Table> {
        match &self.value {
            Value::Table(root) => match root.get(name) {
                Some(Value::Table(table)) => Some(table),
                _ => None,
            },
            _ => None,
        }
    }

    fn section_mut(&mut self, name: &str) -> &mut Table {
        let root = self.root();
        if !matches!(root.get(name), Some(Value::Table(_))) {
            root.set(name, Value::Table(Table::default()));
        }
        match root.get_mut(name) {
            Some(Value::Table(table)) => table,
            _ => unreachable!("it was just put there"),
        }
    }

    /// What a program has given for some keys.
    fn read(&self, path: &str, keys: &Bound<'_, PyDict>) -> Result<Table, Fault> {
        let is_entry = |section: &str, name: &str| self.section(section).is_some_and(|entries| entries.get(name).is_some());
        let mut table = Table::default();
        let are_parameters = path == PARAMETERS;
        for (key, given) in keys {
            // A keyword of Python has an underscore behind it, and what is None is not given; a parameter is called as it is written.
            let key: String = key.extract().map_err(|_| Fault::new(path, "", "a keyword is no text", ""))?;
            let key = key.strip_suffix('_').filter(|_| !are_parameters).unwrap_or(&key);
            if are_parameters || !given.is_none() {
                table.set(key, value::read(&key_path(path, key), &given, &is_entry)?);
            }
        }
        Ok(table)
    }

    /// What is wrong with the shape of some sections by themselves.
    fn faults(sections: Table) -> Vec<Placed> {
        let read = Description::from_value(&Value::Table(sections), &Kinds::default());
        read.err().map_or(Vec::new(), |Faults(faults)| faults.into_iter().map(Placed::from).collect())
    }

    /// What the model is read from.
    fn source(&self, py: Python<'_>) -> PyResult<Source> {
        if matches!(&self.value, Value::Table(table) if table.is_empty()) && self.text.is_none() {
            return Err(refuse(py, "", "the model has no entries", "add a point or a body, and what holds it"));
        }
        let written = self.toml();
        let source = Source::read_all(&self.name, written.as_bytes()).map_err(|text| unreadable(py, text))?;
        Ok(source.beside(self.folder.as_deref().unwrap_or(".".as_ref())))
    }

    /// Kinds that its text may have, with the functions that its formulas call.
    fn kinds(&self, py: Python<'_>, trouble: &Trouble) -> PyResult<Kinds> {
        let mut kinds = Kinds::default();
        for (name, function) in &self.functions {
            let parts: function::Parts = function.bind(py).call_method0("parts")?.extract()?;
            kinds.functions.insert(name.clone(), external(name, parts, trouble));
        }
        Ok(kinds)
    }

    /// The model as it is now: the program may change its own while work on this goes on, in another thread or a function of the model.
    pub fn snapshot(draft: &Bound<'_, Self>) -> PyResult<Self> {
        Ok(draft.try_borrow()?.twin(draft.py()))
    }

    /// Tells what collects circles of the functions.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.functions.values().try_for_each(|function| visit.call(function))
    }

    /// The same model, which does not change with this one.
    fn twin(&self, py: Python<'_>) -> Self {
        Self {
            name: self.name.clone(),
            text: self.text.clone(),
            value: self.value.clone(),
            is_changed: self.is_changed,
            folder: self.folder.clone(),
            functions: self.functions.iter().map(|(name, function)| (name.clone(), function.clone_ref(py))).collect(),
            lines: self.lines.clone(),
        }
    }

    /// The model with some keys of it set to other values, ready to run.
    pub fn load(&self, py: Python<'_>, changes: &[(String, Value)]) -> PyResult<Loaded> {
        self.load_with(py, changes, &Trouble::default())
    }

    /// The same, with a place for what a function raises while it runs.
    pub fn load_with(&self, py: Python<'_>, changes: &[(String, Value)], trouble: &Trouble) -> PyResult<Loaded> {
        let source = self.changed(py, changes, trouble)?;
        let compiled = py.detach(|| source.model_with_forces_and(&[]));
        if let Some(raised) = trouble.take() {
            return Err(raised);
        }
        match compiled {
            Ok(model) => Ok(Loaded { model, name: self.stem(), source }),
            Err(faults) => Err(self.model_error(py, &source, &faults)),
        }
    }

    /// What the model is read from, with some keys of it set to other values, and a place for what a function raises.
    pub fn changed(&self, py: Python<'_>, changes: &[(String, Value)], trouble: &Trouble) -> PyResult<Source> {
        let mut source = self.source(py)?.knowing(self.kinds(py, trouble)?);
        for (key, value) in changes {
            require_key(key, &source).map_err(|fault| failure(py, fault))?;
            source.put(key, value.clone()).map_err(|text| unreadable(py, text))?;
        }
        Ok(source)
    }

    /// Name of its file without its ending.
    pub fn stem(&self) -> String {
        Path::new(&self.name).file_stem().map_or(String::new(), |stem| stem.to_string_lossy().into_owned())
    }

    /// Whether its formulas call functions, and whether any of these needs the interpreter.
    pub fn functions(&self, py: Python<'_>) -> PyResult<(bool, bool)> {
        let mut needs_interpreter = false;
        for function in self.functions.values() {
            let parts: function::Parts = function.bind(py).call_method0("parts")?.extract()?;
            needs_interpreter |= !parts.is_native();
        }
        Ok((!self.functions.is_empty(), needs_interpreter))
    }

    fn model_error(&self, py: Python<'_>, source: &Source, faults: &Faults) -> PyErr {
        // A file has the lines; a text that was made of a program's entries is nothing that its author knows.
        let file = match (&self.text, self.is_changed) {
            (Some(_), false) => return model_error(py, self.placed(faults, Some(source)), Some(source.render(faults))),
            (Some(text), true) => Source::read(&self.name, text.as_bytes()).ok(),
            (None, _) => None,
        };
        model_error(py, self.placed(faults, file.as_ref()), None)
    }

    fn placed(&self, faults: &Faults, file: Option<&Source>) -> Vec<Placed> {
        let in_file = |fault: &Fault| {
            let [line, column] = file?.place(fault)?;
            Some(format!("{}:{line}:{column}", self.name))
        };
        let place = |fault: &Fault| self.line(&fault.path).map(str::to_string).or_else(|| in_file(fault)).unwrap_or_default();
        faults.0.iter().map(|fault| Placed { place: place(fault), fault: fault.clone() }).collect()
    }

    /// The line of a program that has made the entry with a path in it.
    fn line(&self, path: &str) -> Option<&str> {
        let ends = path.char_indices().filter(|(_, c)| matches!(c, '.' | '[')).map(|(at, _)| at).chain([path.len()]);
        ends.collect::<Vec<_>>().into_iter().rev().find_map(|end| self.lines.get(&path[..end])).map(String::as_str)
    }
}

/// A text that is no description.
fn unreadable(py: Python<'_>, text: String) -> PyErr {
    model_error(py, vec![Fault::new("", "", text.clone(), "").into()], Some(text))
}

#[pymethods]
impl Draft {
    /// An empty model.
    #[new]
    fn new() -> Self {
        Self {
            name: "model".into(),
            text: None,
            value: Value::Table(Table::default()),
            is_changed: true,
            folder: None,
            functions: HashMap::new(),
            lines: HashMap::new(),
        }
    }

    // A function may hold the model that it is of: what collects such circles is told of it.
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.traverse(&visit)
    }

    fn __clear__(&mut self) {
        self.functions.clear();
    }

    /// Reads the bytes of a model file, of which messages have the name, and which names files in a folder.
    #[staticmethod]
    fn read_file(py: Python<'_>, name: String, bytes: &[u8], folder: Option<PathBuf>) -> PyResult<Self> {
        let source = Source::read(&name, bytes).map_err(|text| unreadable(py, text))?;
        let (text, value) = (Some(source.text().to_string()), source.value().clone());
        Ok(Self { name, text, value, is_changed: false, folder, functions: HashMap::new(), lines: HashMap::new() })
    }

    /// Adds an entry; `line` is that of the program.
    fn add(
        &mut self,
        py: Python<'_>,
        section: &str,
        name: &str,
        kind: Option<&str>,
        keys: &Bound<'_, PyDict>,
        line: String,
    ) -> PyResult<()> {
        let path = key_path(section, name);
        let here = |fault: Placed| Placed { place: line.clone(), ..fault };
        let fail = |faults: Vec<Placed>| model_error(py, faults.into_iter().map(here).collect(), None);
        let mut table = Table::default();
        if let Some(kind) = kind {
            table.push("type", Value::text(kind));
        }
        let given = self.read(&path, keys).map_err(|fault| fail(vec![fault.into()]))?;
        given.iter().for_each(|(key, value)| table.push(key, value.clone()));
        let entry = Value::Table(table);
        let alone = Value::Table([(name, entry.clone())].into_iter().collect());
        let faults = Self::faults([(section, alone)].into_iter().collect());
        if !faults.is_empty() {
            return Err(fail(faults));
        }
        let is_taken = |section: &&str| self.section(section).is_some_and(|entries| entries.get(name).is_some());
        let among: &[&str] = if NAMED.contains(&section) { &NAMED } else { &[section] };
        let taken = match NAMED.contains(&section) && self.functions.contains_key(name) {
            true => Some(&"function"),
            false => among.iter().find(|section| is_taken(section)),
        };
        if let Some(taken) = taken {
            let message = format!("the name `{name}` is that of a {taken} already");
            return Err(fail(vec![Fault::new(path, name, message, "give it another name: all entries share their names").into()]));
        }
        self.section_mut(section).push(name, entry);
        self.lines.insert(path, line);
        Ok(())
    }

    /// Sets keys of a section without entries, or of the model itself where the section has no name.
    fn put(&mut self, py: Python<'_>, section: &str, keys: &Bound<'_, PyDict>, line: String) -> PyResult<()> {
        let here = |fault: Placed| Placed { place: line.clone(), ..fault };
        let fail = |faults: Vec<Placed>| model_error(py, faults.into_iter().map(here).collect(), None);
        let given = self.read(section, keys).map_err(|fault| fail(vec![fault.into()]))?;
        let alone = match section {
            "" => given.clone(),
            _ => [(section, Value::Table(given.clone()))].into_iter().collect(),
        };
        let faults = Self::faults(alone);
        if !faults.is_empty() {
            return Err(fail(faults));
        }
        let table = if section.is_empty() { self.root() } else { self.section_mut(section) };
        given.iter().for_each(|(key, value)| table.set(key, value.clone()));
        given.iter().for_each(|(key, _)| drop(self.lines.insert(key_path(section, key), line.clone())));
        Ok(())
    }

    /// Sets the key with a path, such as `body.door.mass`.
    fn set(&mut self, py: Python<'_>, path: &str, given: &Bound<'_, PyAny>, line: String) -> PyResult<()> {
        let is_entry = |section: &str, name: &str| self.section(section).is_some_and(|entries| entries.get(name).is_some());
        let value =
            value::read(path, given, &is_entry).map_err(|fault| model_error(py, vec![Placed { fault, place: line.clone() }], None))?;
        let mut source = self.source(py)?;
        require_key(path, &source).map_err(|fault| failure(py, fault))?;
        source.put(path, value).map_err(|_| refuse(py, path, format!("`{path}` cannot be set"), "name a key, such as body.door.mass"))?;
        // Of what is wrong with the shape of the model, what this key brings is said here; what others lack may come later.
        if let Value::Table(table) = source.value() {
            // Faults have parts in quotes that are no bare keys, as `position[0]` and what is empty.
            let quoted = path.split('.').map(|key| key_path("", key)).collect::<Vec<_>>();
            let (whole, first) = (quoted.join("."), &quoted[0]);
            let is_below = |of: &str| of.strip_prefix(&*whole).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']));
            let is_here = |of: &str| is_below(of) || of == first;
            let faults: Vec<Placed> = Self::faults(table.clone()).into_iter().filter(|placed| is_here(&placed.fault.path)).collect();
            if !faults.is_empty() {
                return Err(model_error(py, faults.into_iter().map(|fault| Placed { place: line.clone(), ..fault }).collect(), None));
            }
        }
        (self.value, self.is_changed) = (source.value().clone(), true);
        self.lines.insert(path.into(), line);
        Ok(())
    }

    /// Adds a function that formulas call; `line` is that of the program.
    fn add_function(&mut self, py: Python<'_>, name: String, function: Py<PyAny>, line: String) -> PyResult<()> {
        let path = key_path("function", &name);
        let is_taken = |section: &&&str| self.section(section).is_some_and(|entries| entries.get(&name).is_some());
        let taken = match self.functions.contains_key(&name) {
            true => Some("function"),
            false => NAMED.iter().find(is_taken).copied(),
        };
        if let Some(taken) = taken {
            let message = format!("the name `{name}` is that of a {taken} already");
            let fault = Fault::new(path, &*name, message, "give it another name: all entries share their names");
            return Err(model_error(py, vec![Placed { fault, place: line }], None));
        }
        self.functions.insert(name, function);
        self.lines.insert(path, line);
        Ok(())
    }

    /// Takes an entry away, and says whether there was one.
    fn remove(&mut self, section: &str, name: &str) -> bool {
        let Some(entries) = self.section(section).filter(|entries| entries.get(name).is_some()) else { return false };
        let rest = entries.iter().filter(|(known, _)| *known != name).map(|(known, entry)| (known.to_string(), entry.clone()));
        let rest: Table = rest.collect();
        *self.section_mut(section) = rest;
        self.lines.remove(&key_path(section, name));
        true
    }

    /// What stands at a path; None where there is nothing.
    fn get<'py>(&self, py: Python<'py>, path: &str) -> PyResult<Option<Bound<'py, PyAny>>> {
        let at = path.split('.').filter(|part| !part.is_empty()).try_fold(&self.value, |value, part| match value {
            Value::Table(table) => table.get(part),
            _ => None,
        });
        at.map(|value| value::write(py, value)).transpose()
    }

    /// Section, kind and name of all entries.
    fn entries(&self) -> Vec<(&'static str, Option<String>, String)> {
        let kind = |entry: &Value| match entry {
            Value::Table(table) => match table.get("type") {
                Some(Value::Text(kind)) => Some(kind.clone()),
                _ => None,
            },
            _ => None,
        };
        let of = |section: &'static str| {
            let entries = self.section(section).into_iter().flat_map(Table::iter);
            entries.map(move |(name, entry)| (section, kind(entry), name.to_string()))
        };
        NAMED.into_iter().flat_map(of).collect()
    }

    /// The text of a model file with this model.
    fn toml(&self) -> String {
        match &self.text {
            Some(text) if !self.is_changed => text.clone(),
            _ => model_text(&self.value),
        }
    }

    /// What looks like a slip and was taken all the same; raises what is wrong.
    fn notes(slf: &Bound<'_, Self>) -> PyResult<Vec<String>> {
        Ok(Self::snapshot(slf)?.load(slf.py(), &[])?.model.notes)
    }

    /// All that it is made of.
    pub fn parts(&self, py: Python<'_>) -> Parts {
        let changed = self.is_changed.then(|| model_text(&self.value));
        let functions = self.functions.iter().map(|(name, function)| (name.clone(), function.clone_ref(py))).collect();
        (self.name.clone(), self.text.clone(), changed, self.folder.clone(), functions, self.lines.clone())
    }

    /// What has these parts.
    #[staticmethod]
    pub fn of_parts(py: Python<'_>, parts: Parts) -> PyResult<Self> {
        let (name, text, changed, folder, functions, lines) = parts;
        let value = match changed.as_ref().or(text.as_ref()) {
            Some(text) if !text.is_empty() => {
                Source::read_all(&name, text.as_bytes()).map_err(|text| unreadable(py, text))?.value().clone()
            }
            _ => Value::Table(Table::default()),
        };
        Ok(Self { name, text, value, is_changed: changed.is_some(), folder, functions, lines })
    }
}

/// Why a model does not run, with the cure for one that is run from a program.
pub fn run_error(py: Python<'_>, error: RunError) -> PyErr {
    match error {
        RunError::Missing { key } => {
            let example = if key == "end" { "10" } else { "0.01" };
            refuse(py, key, error.to_string(), format!("give {key}={example} here, or m.simulation({key}={example}) in the model"))
        }
        RunError::NoTimes => {
            refuse(py, "end", error.to_string(), "give end=10, step=0.01 here, or m.simulation(end=10, step=0.01) in the model")
        }
        error => failure(py, run_failure(error)),
    }
}
