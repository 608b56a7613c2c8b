//! What is looked at before a sweep runs: keys that can be varied, a model that is sound, columns that there are.

use std::collections::BTreeMap;

use holonom::model::{Fault, Faults, Model, Value, nearest};
use holonom::record::{COLUMNS, Constraints, Recorder};
use holonom_io::Source;

use super::column::Asked;
use super::plan::Plan;
use super::reduction::Function;
use super::run::Task;
use super::vary::{Setting, Vary};
use super::watch::{Columns, recorder};
use crate::columns::unknown;
use crate::failure::Failure;
use crate::load::{self, OF_METHOD};
use crate::message::nothing_uses;
use crate::output;

/// Refuses keys that nothing can be made of, a model that is not sound and columns that there are not; finds out what the columns take. Formulas among these
/// become measures of the model.
pub fn check(asked: &[String], source: &mut Source, method: Option<&str>, plan: &Plan) -> Result<Columns, Failure> {
    let mut asked = read(asked)?;
    make_measures(&mut asked, source)?;
    let source = &*source;
    plan.varied.iter().try_for_each(|vary| check_key(vary, source, method))?;
    let mut first = source.clone();
    for (vary, setting) in plan.varied.iter().zip(plan.settings(1)) {
        first.put(&vary.path, setting.value).map_err(Failure::Model)?;
    }
    // A value may be missing in the file and given by each run, or the values of the first run may not be possible.
    let runs = asked.is_empty() || !asked.iter().all(Asked::is_of_mode);
    let model = match compile(&first, &asked) {
        Err(faults) => {
            if let Some((message, cure)) = of_formula(&faults, &asked) {
                return Err(Failure::usage(message, cure));
            }
            let of_keys: Vec<Fault> = faults.0.iter().filter(|fault| is_of_key(fault, plan, source)).cloned().collect();
            if !of_keys.is_empty() {
                return Err(Failure::Model(first.render(&Faults(of_keys))));
            }
            sound(source, &asked, method, runs).map_err(|_| Failure::Model(first.render(&faults)))?
        }
        Ok(model) if !runs => model,
        Ok(model) => match Task::new(&model, method) {
            Ok(_) => model,
            Err(failure) => sound(source, &asked, method, runs).map_err(|_| failure)?,
        },
    };
    refuse_late(&asked, source, plan)?;
    if asked.is_empty() { Ok(usual(&model)) } else { columns(&model, asked) }
}

/// What the names of measures begin with that are made of columns.
const OWN: &str = "formula_of_column_";

/// Makes measures of the formulas asked for, which are the columns asked for then.
fn make_measures(asked: &mut [Asked], source: &mut Source) -> Result<(), Failure> {
    for (k, asked) in asked.iter_mut().enumerate().filter(|(_, asked)| asked.is_formula) {
        let name = format!("{OWN}{}", k + 1);
        source.put(&path_of(&name), Value::Text(std::mem::replace(&mut asked.of, name))).map_err(Failure::Model)?;
    }
    Ok(())
}

/// Where the formula of a measure stands.
fn path_of(measure: &str) -> String {
    format!("measure.{measure}.value")
}

/// What is wrong with a formula that was typed, and the cure.
pub fn of_formula(faults: &Faults, asked: &[Asked]) -> Option<(String, String)> {
    let typed = |fault: &Fault| asked.iter().find(|asked| asked.is_formula && path_of(&asked.of) == fault.path);
    let (fault, asked) = faults.0.iter().find_map(|fault| Some((fault, typed(fault)?)))?;
    let cure = fault.cure.split(", ").filter(|name| !name.starts_with(OWN)).collect::<Vec<_>>().join(", ");
    Some((format!("`{}`: {}", asked.text, fault.message), cure))
}

/// What looks like a slip in a plan: parameters that nothing uses in any of its runs, varied or not.
pub fn slips(source: &Source, plan: &Plan) -> Vec<String> {
    let mut first = source.clone();
    for (vary, setting) in plan.varied.iter().zip(plan.settings(1)) {
        // Where it cannot be set the plan was refused.
        let _ = first.put(&vary.path, setting.value);
    }
    let is_word = |text: &str, name: &str| text.split(|c: char| !(c.is_alphanumeric() || c == '_')).any(|word| word == name);
    let is_used = |name: &str| plan.varied.iter().any(|vary| vary.words().any(|setting| is_word(&setting.text, name)));
    let unused: Vec<&str> = first.unused_parameters().into_iter().filter(|name| !is_used(name)).collect();
    let is_varied = |name: &str| plan.varied.iter().any(|vary| vary.path.strip_prefix("parameters.") == Some(name));
    let (varied, others): (Vec<&str>, Vec<&str>) = unused.into_iter().partition(|name| is_varied(name));
    let of_varied = nothing_uses(&varied).map(|words| format!("{words}, so that its values make no difference"));
    of_varied.into_iter().chain(nothing_uses(&others)).collect()
}

/// SHA-256 of the files that runs of a plan read, by their names. Runs get them as they were read here.
pub fn files(source: &Source, plan: &Plan) -> BTreeMap<String, String> {
    let first = plan.settings(1);
    let read = |key: usize, setting: &Setting| {
        let of = |k: usize| if k == key { setting } else { &first[k] };
        let changes: Vec<(&str, Value)> = (0..first.len()).map(|k| (plan.varied[k].path.as_str(), of(k).value.clone())).collect();
        // What cannot run is refused in its own run.
        drop(source.model_with(&changes));
    };
    read(0, &first[0]);
    // Any of these may name a file.
    for (key, vary) in plan.varied.iter().enumerate() {
        vary.words().for_each(|setting| read(key, setting));
    }
    source.files()
}

/// The model as it is, if it could run where it is to.
fn sound(source: &Source, asked: &[Asked], method: Option<&str>, runs: bool) -> Result<Model, Failure> {
    let model = compile(source, asked).map_err(|faults| Failure::Model(source.render(&faults)))?;
    if runs {
        Task::new(&model, method)?;
    }
    Ok(model)
}

/// Refuses times after the end of all runs, where these have one end.
fn refuse_late(asked: &[Asked], source: &Source, plan: &Plan) -> Result<(), Failure> {
    let (Some(&Value::Number(end)), false) = (source.get("simulation.end"), plan.varied.iter().any(|vary| vary.path == "simulation.end"))
    else {
        return Ok(());
    };
    match asked.iter().find(|asked| matches!(asked.function, Function::At(t) if t > end)) {
        None => Ok(()),
        Some(late) => {
            let message = format!("`{}` asks for a time after the end of the runs, {end} s", late.text);
            Err(Failure::usage(message, "ask for an earlier time, or give a later --end"))
        }
    }
}

/// The columns asked for.
fn read(texts: &[String]) -> Result<Vec<Asked>, Failure> {
    let mut found: Vec<Asked> = Vec::new();
    for text in texts {
        let asked = Asked::parse(text)?;
        if found.iter().any(|other| other.text == asked.text) {
            return Err(Failure::usage(format!("the column `{text}` is asked for twice"), "leave out one of them"));
        }
        found.push(asked);
    }
    Ok(found)
}

/// The model of a source, with what tells the forces of joints where columns may ask for them.
fn compile(source: &Source, asked: &[Asked]) -> Result<Model, Faults> {
    if asked.is_empty() { source.model_with(&[]) } else { source.model_with_forces_and(&[]) }
}

/// Refuses a key that cannot be varied.
fn check_key(vary: &Vary, source: &Source, method: Option<&str>) -> Result<(), Failure> {
    let path = vary.path.as_str();
    if source.replaced().iter().any(|(set, _)| set == path) {
        return Err(Failure::usage(format!("`{path}` is set and varied"), "leave out one of them"));
    }
    if method.is_some() && OF_METHOD.contains(&path) {
        return Err(Failure::usage(format!("`{path}` is varied, and --method replaces it"), "leave out --method"));
    }
    if let Some(Value::Table(table)) = source.get(path) {
        let key = table.keys().next().unwrap_or("key");
        return Err(Failure::usage(format!("`{path}` is a table and has no values"), format!("name a key in it, such as {path}.{key}")));
    }
    // A parameter that nothing names would make runs that are all alike.
    load::require_key(path, source)
}

/// Whether a fault says that a varied key is none of the model file, or belongs to nothing that is there.
fn is_of_key(fault: &Fault, plan: &Plan, source: &Source) -> bool {
    let within = |outer: &str, inner: &str| inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
    plan.varied.iter().any(|vary| {
        let owner = vary.path.rsplit_once('.').map_or("", |(owner, _)| owner);
        // A path has quotes around names with other signs than those of a name.
        (fault.on_key && within(&fault.path.replace('"', ""), &vary.path)) || (source.get(owner).is_none() && within(owner, &fault.path))
    })
}

/// Where no column is asked for: the last values of the energy and of all that is recorded without the forces of constraints. Of many runs
/// nothing is found that was not asked for, but by measures.
fn usual(model: &Model) -> Columns {
    let recorders = LEVELS.map(|level| recorder(model, level));
    let mut takes = Takes { level: if model.output.reactions == Some(true) { 2 } else { 0 }, ..Takes::default() };
    let mut forces = false;
    for measure in &model.channels.measures {
        let own = Takes::of(&measure.name, model, &recorders).unwrap_or_default();
        forces |= own.needs_forces_of_steps(Function::Last);
        takes = takes.and(own);
    }
    let all = recorders[takes.level].recording();
    let written = output::columns(all, model);
    let asks_forces = model.output.reactions == Some(true);
    let is_usual = |name: &String| asks_forces || recorders[0].recording().find(name).is_some();
    let shown = written.iter().filter(|name| is_usual(name) && (*name == "energy" || !COLUMNS.contains(&name.as_str())));
    let asked: Vec<Asked> = shown.map(|name| Asked::last(name)).collect();
    let steps = takes.steps || asked.iter().any(|asked| is_orientation(&asked.of, model));
    let units = units(&asked, &recorders[takes.level]);
    Columns { units, asked, constraints: LEVELS[takes.level], runs: true, modes: false, steps, forces }
}

/// What may be recorded of the forces of constraints, the least first.
const LEVELS: [Constraints; 3] = [Constraints::Nothing, Constraints::Joints, Constraints::Rows];

/// What a column takes of a run, and the columns that it follows from.
#[derive(Clone, Copy, Debug, Default)]
struct Takes {
    /// The least of [`LEVELS`] that has it.
    level: usize,
    /// Whether it shows what drives exert.
    efforts: bool,
    /// Whether its value at a step follows from the steps before.
    steps: bool,
}

impl Takes {
    /// What the column of a name takes; `None` where there is none.
    fn of(name: &str, model: &Model, recorders: &[Recorder; 3]) -> Option<Self> {
        let level = recorders.iter().position(|recorder| recorder.recording().find(name).is_some())?;
        let owner = name.strip_suffix(".effort").or(name.strip_suffix(".power"));
        let efforts = owner.is_some_and(|owner| model.channels.efforts.iter().any(|effort| effort.name == owner));
        let own = Self { level, efforts, steps: is_orientation(name, model) };
        let Some(measure) = model.channels.measures.iter().find(|measure| measure.name == name) else { return Some(own) };
        // What a run does not record is no number in it, and so it is here.
        let read = measure.columns().filter_map(|column| Self::of(column, model, recorders)).filter(|read| read.level <= recorded(model));
        Some(read.fold(Self { steps: measure.is_running(), ..own }, Self::and))
    }

    fn and(self, other: Self) -> Self {
        Self { level: self.level.max(other.level), efforts: self.efforts || other.efforts, steps: self.steps || other.steps }
    }

    /// Whether a function of the column needs forces of constraints after every step.
    fn needs_forces_of_steps(self, function: Function) -> bool {
        (self.steps || function != Function::Last) && (self.level > 0 || self.efforts)
    }
}

/// Which of [`LEVELS`] a run records.
fn recorded(model: &Model) -> usize {
    LEVELS.iter().position(|level| *level == model.output.constraints()).expect("every level is listed")
}

/// Whether a column is part of an orientation in space: of its two quaternions, rows have the one near that of the row before.
fn is_orientation(name: &str, model: &Model) -> bool {
    model.axes.len() == 3 && [".qw", ".qx", ".qy", ".qz"].iter().any(|end| name.ends_with(end))
}

/// The columns asked for, if a run records them, with no more of the forces of constraints than they need.
fn columns(model: &Model, asked: Vec<Asked>) -> Result<Columns, Failure> {
    let recorders = LEVELS.map(|level| recorder(model, level));
    let (mut all, mut steps, mut forces) = (Takes::default(), false, false);
    for Asked { of, function, .. } in asked.iter().filter(|asked| !asked.is_of_mode()) {
        if *function == Function::TimeOf {
            if !model.system.event_names().any(|name| name == of) {
                let cure = match nearest(of, model.system.event_names()) {
                    Some(near) => format!("did you mean `{near}`?"),
                    None => "name an [event.NAME] of the model".into(),
                };
                return Err(Failure::usage(format!("there is no event `{of}`"), cure));
            }
            continue;
        }
        let Some(takes) = Takes::of(of, model, &recorders) else {
            return Err(match of.split_once('-').filter(|(from, _)| Takes::of(from, model, &recorders).is_some()) {
                Some((from, to)) => {
                    let cure = format!("names may have a minus: write a difference with blanks, `{from} - {to}`");
                    Failure::usage(format!("there is no column `{of}`"), cure)
                }
                None => unknown(of, recorders[recorded(model)].recording()),
            });
        };
        if takes.level > recorded(model) {
            return Err(Failure::usage(format!("runs of this model do not record `{of}`"), "give --set output.reactions=true"));
        }
        all = all.and(takes);
        steps |= takes.steps || *function != Function::Last;
        forces |= takes.needs_forces_of_steps(*function);
    }
    let (units, modes) = (units(&asked, &recorders[all.level]), asked.iter().any(Asked::is_of_mode));
    let runs = !asked.iter().all(Asked::is_of_mode);
    Ok(Columns { units, asked, constraints: LEVELS[all.level], runs, modes, steps, forces })
}

/// Units of columns, which functions of them keep.
fn units(asked: &[Asked], recorder: &Recorder) -> Vec<String> {
    let unit = |asked: &Asked| match asked.function {
        Function::TimeOf => "s".into(),
        Function::Mode(of, _) => of.unit().into(),
        _ => recorder.recording().find(&asked.of).map_or("1".into(), |column| column.heading.unit.to_string()),
    };
    asked.iter().map(unit).collect()
}
