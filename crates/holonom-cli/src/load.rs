//! From what was typed to a model and a method.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::sync::Mutex;

use holonom::analysis::NoModes;
use holonom::formulation::FORMULATIONS;
use holonom::model::{Model, Table, Value, nearest};
use holonom::run::RunError;
use holonom::simulation::{Method, MethodError, StartError};
use holonom_io::Source;

use crate::failure::Failure;
use crate::provenance::{Origin, Override, Provenance, VERSION, command_line, now};
use crate::table::short;

/// The gallery: name and text of every example.
pub const EXAMPLES: &[(&str, &str)] = &[
    ("spherical-compound-pendulum", include_str!("../../../examples/spherical-compound-pendulum.toml")),
    ("simple-pendulum", include_str!("../../../examples/simple-pendulum.toml")),
    ("double-pendulum", include_str!("../../../examples/double-pendulum.toml")),
    ("four-bar", include_str!("../../../examples/four-bar.toml")),
    ("spring-pendulum", include_str!("../../../examples/spring-pendulum.toml")),
    ("car-axis", include_str!("../../../examples/car-axis.toml")),
    ("chain", include_str!("../../../examples/chain.toml")),
    ("free-body", include_str!("../../../examples/free-body.toml")),
    ("heavy-top", include_str!("../../../examples/heavy-top.toml")),
    ("rolling-disc", include_str!("../../../examples/rolling-disc.toml")),
    ("slider-crank", include_str!("../../../examples/slider-crank.toml")),
    ("spatial-four-bar", include_str!("../../../examples/spatial-four-bar.toml")),
    ("bricard", include_str!("../../../examples/bricard.toml")),
    ("andrews", include_str!("../../../examples/andrews.toml")),
    ("jansen-linkage", include_str!("../../../examples/jansen-linkage.toml")),
    ("flyball-governor", include_str!("../../../examples/flyball-governor.toml")),
    ("differential", include_str!("../../../examples/differential.toml")),
    ("suspension", include_str!("../../../examples/suspension.toml")),
    ("stewart-platform", include_str!("../../../examples/stewart-platform.toml")),
    ("flexible-four-bar", include_str!("../../../examples/flexible-four-bar.toml")),
    ("robot-arm", include_str!("../../../examples/robot-arm.toml")),
];

/// A model that was read, with where it came from.
pub struct Loaded {
    /// What it compiles to.
    pub model: Model,
    /// Name of the file without its ending, or of the example.
    pub name: String,
    /// What it was read from.
    pub source: Source,
}

/// Keys of the model file that the command line sets.
#[derive(Clone)]
pub struct Overrides(Vec<String>);

/// The overrides of `--set`.
pub fn overrides(set: &[String]) -> Overrides {
    Overrides(set.to_vec())
}

impl Overrides {
    /// Sets a key, written as on the command line.
    pub fn set(&mut self, given: &str) {
        self.0.push(given.into());
    }

    /// Sets a key to a number or an expression, if one was given.
    pub fn number(&mut self, key: &str, given: Option<&str>) {
        if let Some(given) = given {
            self.0.push(format!("{key}={given}"));
        }
    }

    /// The overrides as they are written, in their order.
    pub fn given(&self) -> &[String] {
        &self.0
    }
}

/// The text of an example.
pub fn example(name: &str) -> Result<&'static str, Failure> {
    EXAMPLES.iter().find(|(known, _)| *known == name).map(|(_, text)| *text).ok_or_else(|| {
        let known: Vec<&str> = EXAMPLES.iter().map(|(name, _)| *name).collect();
        Failure::usage(format!("there is no example `{name}`"), format!("take one of: {}", known.join(", ")))
    })
}

/// The bytes of a file, but no more than show that it is too large for a model.
fn read_at_most(file: impl Read) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    file.take(holonom_io::LARGEST_FILE as u64 + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The model on standard input. That can be read once only, and some commands need the model more often.
fn standard_input() -> std::io::Result<Vec<u8>> {
    static READ: Mutex<Option<Vec<u8>>> = Mutex::new(None);
    let mut read = READ.lock().expect("no reader panics");
    match &*read {
        Some(bytes) => Ok(bytes.clone()),
        None => Ok(read.insert(read_at_most(std::io::stdin().lock())?).clone()),
    }
}

/// Reads a model file, or an example, with the overrides of the command line.
pub fn load(argument: &str, overrides: Overrides) -> Result<Loaded, Failure> {
    let (source, name) = open(argument, &overrides)?;
    let model = source.model().map_err(Failure::Model)?;
    Ok(Loaded { model, name, source })
}

/// The same for a run that records forces.
pub fn load_to_run(argument: &str, overrides: Overrides) -> Result<Loaded, Failure> {
    let (source, name) = open(argument, &overrides)?;
    let model = source.model_with_forces().map_err(Failure::Model)?;
    Ok(Loaded { model, name, source })
}

/// The name of a model file that is standard input.
pub const STANDARD_INPUT: &str = "-";

/// What the model of standard input is called.
pub const STDIN: &str = "stdin";

/// Reads a model file, or an example, as a description with the overrides of the command line; and its name.
pub fn open(argument: &str, overrides: &Overrides) -> Result<(Source, String), Failure> {
    let fail = |source| Failure::unread(argument, source, "give a model file, or an example, such as example:four-bar");
    // The name, the file as messages call it, its bytes, and the folder of the files that it names.
    let (name, shown, bytes, folder) = match (argument, argument.strip_prefix("example:")) {
        (_, Some(name)) => (name.to_string(), format!("{name}.toml"), example(name)?.as_bytes().to_vec(), None),
        (STANDARD_INPUT, _) => (STDIN.to_string(), STDIN.to_string(), standard_input().map_err(fail)?, Some(Path::new(""))),
        _ => {
            let path = Path::new(argument);
            let bytes = File::open(path).and_then(read_at_most).map_err(fail)?;
            let name = path.file_stem().map_or_else(|| argument.to_string(), |stem| stem.to_string_lossy().into_owned());
            (name, argument.to_string(), bytes, path.parent())
        }
    };
    let mut source = Source::read(&shown, &bytes).map_err(Failure::Model)?;
    if let Some(folder) = folder {
        source = source.beside(folder);
    }
    for given in &overrides.0 {
        let (key, value) = split(given)?;
        require_key(key, &source)?;
        source.set(key, value).map_err(Failure::Model)?;
    }
    Ok((source, name))
}

/// Keys that the name of a method on the command line replaces.
pub const OF_METHOD: [&str; 6] = [
    "simulation.method",
    "simulation.formulation",
    "simulation.index",
    "simulation.integrator",
    "simulation.order",
    "simulation.projection.levels",
];

/// Refuses to set what the name of a method on the command line replaces, as nothing would come of it.
pub fn require_kept(set: &[String], names_method: bool) -> Result<(), Failure> {
    let replaced = set.iter().filter_map(|given| split(given).ok()).find(|(key, _)| OF_METHOD.contains(key));
    match replaced.filter(|_| names_method) {
        Some((key, _)) => Err(Failure::usage(
            format!("`{key}` is set, and --method replaces it"),
            "leave out one of the two; an order goes with the name of an integrator, as in --method ggl/conserving-ggl-4",
        )),
        None => Ok(()),
    }
}

/// Refuses a parameter that the model does not have, as nothing would come of it, and the bare name of one that it has; and a key of a body, joint
/// or another entry that the model does not have, as a new one would be made.
pub fn require_key(key: &str, source: &Source) -> Result<(), Failure> {
    let parameters = match source.get("parameters") {
        Some(Value::Table(table)) => table,
        _ => &Table::default(),
    };
    match key.strip_prefix("parameters.") {
        Some(name) if parameters.get(name).is_none() => {
            let cure = nearest(name, parameters.keys())
                .map_or("add it to [parameters], and name it in the model".to_string(), |near| format!("did you mean `{near}`?"));
            Err(Failure::usage(format!("the model has no parameter `{name}`"), cure))
        }
        None if parameters.get(key).is_some() && of_file(key).is_none() => {
            Err(Failure::usage(format!("`{key}` is a parameter and no key of the model file"), format!("write parameters.{key}=…")))
        }
        _ => require_entry(key, source),
    }
}

/// Refuses a key of an entry that is not there. All of an entry at once may be new, and `[start]` names the joints of the model.
fn require_entry(key: &str, source: &Source) -> Result<(), Failure> {
    let [section, name, _] = key.splitn(3, '.').collect::<Vec<_>>()[..] else { return Ok(()) };
    let has_entries = || matches!(of_file(section), Some(Value::Table(shape)) if shape.get("propertyNames").is_some());
    let entries = match source.get(section) {
        Some(Value::Table(table)) => table,
        _ => &Table::default(),
    };
    if section == "start" || entries.get(name).is_some() || !has_entries() {
        return Ok(());
    }
    if let Some((all, _)) = name.split_once('[').filter(|(all, _)| entries.get(all).is_some()) {
        let cure = format!("set it for all of them, {section}.{all}.KEY, by a formula of the index where they differ");
        return Err(Failure::usage(format!("`{name}` is one of those that `{section}.{all}` repeats, and cannot be set alone"), cure));
    }
    let cure = nearest(name, entries.keys()).map_or_else(
        || format!("name one that is there, or set all of a new one: {section}.{name}={{ … }}"),
        |near| format!("did you mean `{section}.{near}`?"),
    );
    Err(Failure::usage(format!("the model has no {section} `{name}`"), cure))
}

/// What the schema says of a key outside all tables, or of a table, if a model file may have one of this name.
fn of_file(key: &str) -> Option<Value> {
    let Value::Table(schema) = holonom::model::schema() else { return None };
    match schema.get("properties") {
        Some(Value::Table(keys)) => keys.get(key).cloned(),
        _ => None,
    }
}

/// Key and value of an override.
fn split(given: &str) -> Result<(&str, &str), Failure> {
    let parts = given.split_once('=').map(|(key, value)| (key.trim(), value.trim()));
    parts.ok_or_else(|| Failure::usage(format!("`--set {given}` has no `=`"), "write --set KEY=VALUE, such as --set parameters.N=40"))
}

/// Nominal step of a model, s: with an accuracy, the interval of the results.
pub fn step(model: &Model) -> Result<f64, Failure> {
    model.step().map_err(run_failure)
}

/// End of a model's run, s.
pub fn end(model: &Model) -> Result<f64, Failure> {
    model.end().map_err(run_failure)
}

fn json(value: Option<&Value>) -> serde_json::Value {
    value.map_or(serde_json::Value::Null, holonom_io::to_json)
}

impl Loaded {
    /// Nominal step, s: with an accuracy, the interval of the results.
    ///
    /// # Errors
    /// A model without one.
    pub fn step(&self) -> Result<f64, Failure> {
        step(&self.model)
    }

    /// End of the run, s.
    ///
    /// # Errors
    /// A model without one.
    pub fn end(&self) -> Result<f64, Failure> {
        end(&self.model)
    }

    /// Recorded share of the steps.
    pub fn every(&self) -> u64 {
        self.model.output.every.map_or(1, u64::from)
    }

    /// Name of a run's report: the model's title, or the file's name.
    pub fn title(&self) -> &str {
        if self.model.title.is_empty() { &self.name } else { &self.model.title }
    }

    /// What results of this model come from.
    pub fn origin(&self) -> Origin {
        let replaced = |(key, file): &(String, Option<Value>)| Override {
            key: key.clone(),
            file: json(file.as_ref()),
            run: json(self.source.get(key)),
        };
        Origin {
            version: VERSION.into(),
            date: now(),
            command: command_line(),
            overrides: self.source.replaced().iter().map(replaced).collect(),
            files: self.source.files(),
            model: self.source.text().into(),
        }
    }

    /// What a run by a method is. The command line may have named the method, and the share of the steps that is recorded.
    ///
    /// # Errors
    /// A model without step or end.
    pub fn provenance(&self, method: &Method, named: Option<&str>, every: Option<u64>) -> Result<Provenance, Failure> {
        let [step, end] = self.model.times().map_err(run_failure)?;
        let Origin { version, date, command, mut overrides, files, model } = self.origin();
        let option = |key: &str, run| Override { key: key.into(), file: json(self.source.get(key)), run };
        overrides.extend(named.map(|name| option("simulation.method", name.into())));
        overrides.extend(every.map(|every| option("output.every", every.into())));
        let (method, every) = (method.name.clone(), every.unwrap_or_else(|| self.every()));
        Ok(Provenance { version, date, command, method, step, end, every, overrides, files, model })
    }

    /// Gravity for people.
    pub fn gravity(&self) -> String {
        let [x, y, z] = self.model.gravity;
        let text = format!("({}, {}, {}) m/s²", short(x), short(y), short(z));
        if self.model.gravity == [0.0; 3] { format!("{text}: none acts") } else { text }
    }
}

/// What a model lacks to run, with its cure.
pub fn run_failure(error: RunError) -> Failure {
    match error {
        RunError::NoTimes => {
            Failure::usage(error.to_string(), "add both there, or give --end 10 --step 0.01; --accuracy 1e-6 chooses the steps")
        }
        RunError::Missing { key } => {
            let example = if key == "end" { 10.0 } else { 0.01 };
            Failure::usage(error.to_string(), format!("add `{key} = …` there, or give --{key} {example}"))
        }
        RunError::Method(error) => method_failure(error),
        RunError::Start(error) => start_failure(error),
    }
}

/// The method of a model, or the one named on the command line.
pub fn method(model: &Model, name: Option<&str>) -> Result<Method, Failure> {
    Method::resolve(&model.choice(name)).map_err(method_failure)
}

/// A method that cannot be, with its cure.
pub fn method_failure(error: MethodError) -> Failure {
    let formulation = match &error {
        MethodError::Unknown { kind: "method", given, .. } => {
            FORMULATIONS.iter().any(|line| line.full_name() == *given || line.name == given).then_some(given)
        }
        _ => None,
    };
    let cure = match formulation {
        Some(name) => format!("`{name}` is a formulation: give --set simulation.formulation={name} in place of it"),
        None => "`holonom methods` shows what there is and what goes together".into(),
    };
    Failure::usage(error.to_string(), cure)
}

/// A model without modes, with its cure.
pub fn modes_failure(error: NoModes) -> Failure {
    let cure = match &error {
        NoModes::Start(_) | NoModes::Singular => "`holonom check` says more of the start",
        NoModes::Moving => "remove the velocities",
        NoModes::Unbalanced => {
            "write equilibrium = true in [start], or --set start.equilibrium=true; where it is there, take the places of joints out beside it"
        }
        NoModes::Forks => "a run from a place beside it shows how it moves",
        NoModes::Massless => "give every free point some mass",
        NoModes::Large(_) => "take a model of a part of it",
    };
    Failure::usage(error.to_string(), cure)
}

/// A model that cannot start, with its cure.
pub fn start_failure(error: StartError) -> Failure {
    let cure = match &error {
        StartError::Acceleration => {
            "something that can turn or move has no inertia, such as a rod about itself: give it some, or hold it with a joint"
        }
        StartError::Crowded { .. } => "take away those that only repeat what others hold already, or spread them over several bodies",
        StartError::NoNumber => "begin from a state of numbers, or from the model's start",
        StartError::NotFinite { .. } => "change the formula or the table, or begin elsewhere",
        StartError::Nonholonomic { .. } => "take another formulation, such as the default",
        StartError::Step { .. } => "give a step above 0",
        StartError::Velocity { .. } => {
            "move what is named there, or take away or loosen one of the constraints; rows that only repeat others must do so to the last digit: write \
             places and axes with all digits, near the origin"
        }
        _ => "move what is named there, or take away or loosen one of the constraints",
    };
    Failure::usage(error.to_string(), cure)
}
