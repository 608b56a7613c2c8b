//! What is looked at before a sweep runs: keys that can be varied, a model that is sound, columns that there are.

use holonom::model::{Fault, Faults, Model, Value, nearest};
use holonom::record::{COLUMNS, Recorder};
use holonom_io::Source;

use super::plan::Plan;
use super::run::{Task, constraints};
use super::vary::Vary;
use crate::failure::Failure;
use crate::load::{self, OF_METHOD, Overrides};
use crate::options::SweepArguments;
use crate::output;

/// Refuses keys that nothing can be made of and a model that is not sound; names the columns whose last values are kept.
pub fn check(arguments: &SweepArguments, overrides: &Overrides, source: &Source, plan: &Plan) -> Result<Vec<String>, Failure> {
    plan.varied.iter().try_for_each(|vary| check_key(vary, arguments, overrides, source))?;
    let mut with_first = overrides.clone();
    plan.varied.iter().zip(plan.settings(1)).for_each(|(vary, setting)| with_first.number(&vary.path, Some(&setting.text)));
    let (first, _) = load::open(&arguments.model.model, &with_first)?;
    let method = arguments.method.name.as_deref();
    // A value may be missing in the file and given by each run, or the values of the first run may not be possible.
    let model = match first.model_with(&[]) {
        Err(faults) => {
            let of_keys: Vec<Fault> = faults.0.iter().filter(|fault| is_of_key(fault, plan, source)).cloned().collect();
            if !of_keys.is_empty() {
                return Err(Failure::Model(first.render(&Faults(of_keys))));
            }
            sound(source, method).map_err(|_| Failure::Model(first.render(&faults)))?
        }
        Ok(model) => match Task::new(&model, method) {
            Ok(_) => model,
            Err(failure) => sound(source, method).map_err(|_| failure)?,
        },
    };
    columns(&model, &arguments.columns)
}

/// The model as it is, if it could run.
fn sound(source: &Source, method: Option<&str>) -> Result<Model, Failure> {
    let model = source.model().map_err(Failure::Model)?;
    Task::new(&model, method)?;
    Ok(model)
}

fn check_key(vary: &Vary, arguments: &SweepArguments, overrides: &Overrides, source: &Source) -> Result<(), Failure> {
    let path = vary.path.as_str();
    if overrides.has(path) {
        return Err(Failure::usage(format!("`{path}` is set and varied"), "leave out one of them"));
    }
    if arguments.method.name.is_some() && OF_METHOD.contains(&path) {
        return Err(Failure::usage(format!("`{path}` is varied, and --method replaces it"), "leave out --method"));
    }
    if let Some(Value::Table(table)) = source.get(path) {
        let key = table.keys().next().unwrap_or("key");
        return Err(Failure::usage(format!("`{path}` is a table and has no values"), format!("name a key in it, such as {path}.{key}")));
    }
    // A parameter that nothing names would make runs that are all alike.
    load::require_key("--vary", path, source)
}

/// Whether a fault says that a varied key is none of the model file, or belongs to nothing that is there.
fn is_of_key(fault: &Fault, plan: &Plan, source: &Source) -> bool {
    let within = |outer: &str, inner: &str| inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    plan.varied.iter().any(|vary| {
        let owner = vary.path.rsplit_once('.').map_or("", |(owner, _)| owner);
        (fault.on_key && within(&fault.path, &vary.path)) || (source.get(owner).is_none() && within(owner, &fault.path))
    })
}

/// The columns asked for, or the energy and all of the motion.
fn columns(model: &Model, asked: &[String]) -> Result<Vec<String>, Failure> {
    let recorder = Recorder::new(&model.channels, &model.system, 1, constraints(model));
    let all: Vec<&str> = recorder.recording().columns().iter().map(|column| column.heading.name.as_str()).collect();
    if let Some(unknown) = asked.iter().find(|name| !all.contains(&name.as_str())) {
        let cure = match nearest(unknown, all.iter().copied()) {
            Some(near) => format!("did you mean `{near}`?"),
            None => format!("take some of: {}", all.join(", ")),
        };
        return Err(Failure::usage(format!("there is no column `{unknown}`"), cure));
    }
    if !asked.is_empty() {
        return Ok(asked.to_vec());
    }
    let written = match &model.output.points {
        Some(points) => output::columns(recorder.recording(), points, model),
        None => all.iter().map(|name| name.to_string()).collect(),
    };
    Ok(written.into_iter().filter(|name| name == "energy" || !COLUMNS.contains(&name.as_str())).collect())
}
