//! Values of Python as those of a description, and back.

use holonom::model::{Fault, Table, Value, item_path, key_path};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyList, PyString, PyTuple};

/// Deepest nesting of lists and dictionaries: one that contains itself has no end.
const DEEPEST: usize = 16;

/// Reads the value of an argument. `is_entry` says whether the model has an entry of a section and a name, as handles of entries may be
/// those of another model.
pub fn read(path: &str, value: &Bound<'_, PyAny>, is_entry: &dyn Fn(&str, &str) -> bool) -> Result<Value, Fault> {
    Reading { is_entry }.value(path, value, 0)
}

struct Reading<'a> {
    is_entry: &'a dyn Fn(&str, &str) -> bool,
}

impl Reading<'_> {
    fn value(&self, path: &str, value: &Bound<'_, PyAny>, depth: usize) -> Result<Value, Fault> {
        let refuse = |message: String, cure: &str| Fault::new(path, quoted(value), message, cure);
        if depth > DEEPEST {
            return Err(refuse(format!("`{path}` is nested deeper than {DEEPEST} lists"), "give a list of numbers, or one of such lists"));
        }
        if let Ok(flag) = value.cast::<PyBool>() {
            return Ok(Value::Bool(flag.is_true()));
        }
        if let Ok(text) = value.cast::<PyString>() {
            return self.text(path, text);
        }
        if let Ok(table) = value.cast::<PyDict>() {
            return self.table(path, table, depth).map(Value::Table);
        }
        if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
            let items = value.try_iter().map_err(|error| refuse(error.to_string(), ""))?;
            let items = items.enumerate().map(|(k, item)| {
                let item = item.map_err(|error| refuse(error.to_string(), ""))?;
                self.value(&item_path(path, k), &item, depth + 1)
            });
            return items.collect::<Result<_, _>>().map(Value::List);
        }
        // Arrays and scalars of NumPy and of those that do as it does. A number for which Python has no type, as a long double, stays what it is.
        if let Ok(plain) = value.call_method0("tolist")
            && !plain.get_type().is(value.get_type())
        {
            return self.value(path, &plain, depth + 1);
        }
        match value.extract::<f64>() {
            Ok(_) if is_complex(value) => Err(refuse(format!("`{path}` is a complex number"), "give a real one, such as its .real")),
            Ok(number) if number.is_finite() => Ok(Value::Number(number)),
            Ok(number) => Err(refuse(format!("`{path}` is {number}, and a finite number is wanted"), "see where it was computed")),
            Err(_) => {
                let of = value.get_type().name().map_or("an object".to_string(), |name| format!("of type {name}"));
                Err(refuse(format!("`{path}` is {of}"), "give a number, a text, True or False, a list, a NumPy array or a dictionary"))
            }
        }
    }

    fn text(&self, path: &str, text: &Bound<'_, PyString>) -> Result<Value, Fault> {
        let word = text.to_string_lossy().into_owned();
        let section = text.getattr("section").ok().and_then(|section| section.extract::<String>().ok());
        match section {
            Some(section) if !(self.is_entry)(&section, &word) => Err(Fault::new(
                path,
                &*word,
                format!("`{path}` is the {section} `{word}` of another model"),
                "add it to this model, or name one that this model has",
            )),
            _ => Ok(Value::Text(word)),
        }
    }

    fn table(&self, path: &str, table: &Bound<'_, PyDict>, depth: usize) -> Result<Table, Fault> {
        let mut read = Table::default();
        for (key, value) in table {
            let Ok(key) = key.cast::<PyString>().map(|key| key.to_string_lossy().into_owned()) else {
                return Err(Fault::new(
                    path,
                    quoted(&key),
                    format!("`{path}` has a key that is no text: {}", quoted(&key)),
                    "name its keys",
                ));
            };
            let value = self.value(&key_path(path, &key), &value, depth + 1)?;
            read.push(key, value);
        }
        Ok(read)
    }
}

/// Whether it is a complex number of NumPy, which would leave out its imaginary part where a real one is asked for.
pub fn is_complex(value: &Bound<'_, PyAny>) -> bool {
    let kind = value.getattr("dtype").and_then(|dtype| dtype.getattr("kind")?.extract::<String>());
    kind.is_ok_and(|kind| kind == "c")
}

/// The beginning of what stands for a value in Python.
fn quoted(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map_or(String::new(), |text| text.to_string_lossy().into_owned());
    text.chars().take(60).collect()
}

/// The same value in Python.
pub fn write<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    Ok(match value {
        Value::Number(number) => number.into_pyobject(py)?.into_any(),
        Value::Text(text) => text.into_pyobject(py)?.into_any(),
        Value::Bool(flag) => flag.into_pyobject(py)?.to_owned().into_any(),
        Value::List(items) => {
            let items = items.iter().map(|item| write(py, item)).collect::<PyResult<Vec<_>>>()?;
            PyList::new(py, items)?.into_any()
        }
        Value::Table(table) => {
            let dictionary = PyDict::new(py);
            table.iter().try_for_each(|(key, value)| dictionary.set_item(key, write(py, value)?))?;
            dictionary.into_any()
        }
    })
}
