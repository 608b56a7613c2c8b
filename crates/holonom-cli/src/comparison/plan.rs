//! What is compared with what, in which order, and what each is called.

use holonom::model::{Model, nearest};
use holonom::record::{Recorder, Recording, Scene};
use holonom::simulation::{Method, NAMED};
use serde_json::{Value, json};

use super::subject::{Headings, MEASURED, Subject};
use crate::columns::unknown;
use crate::failure::Failure;
use crate::items::items;
use crate::load::{self, Loaded};
use crate::options::CompareArguments;
use crate::output::Order;
use crate::table::short;

/// Everything that is compared; the first is what the others differ from.
pub struct Plan {
    /// The models that are run, once for each variant and step.
    pub models: Vec<Loaded>,
    pub entries: Vec<Entry>,
    /// Heading of the report.
    pub title: String,
    /// What the folder is called after.
    pub name: String,
    /// The texts of the model files.
    pub text: String,
    /// Of what is not run: nothing to draw.
    pub blank: Scene,
    /// Columns whose differences are told.
    pub columns: Vec<String>,
    /// Named methods that cannot have the accuracy of the model, and why.
    left_out: Vec<String>,
}

/// One curve of each plot.
pub struct Entry {
    pub label: String,
    pub of: Of,
}

impl Entry {
    /// What is known of it before anything runs, as in its summary.
    pub fn identity(&self) -> Value {
        match &self.of {
            Of::Run(_, order) => json!({ "provenance": order.provenance }),
            Of::Read(_, summary) => summary.clone(),
        }
    }
}

/// What a curve is of.
pub enum Of {
    /// A run that is still to be made, of the model of this index.
    Run(usize, Box<Order>),
    /// What there is already, and its summary.
    Read(Recording, Value),
}

/// A subject with its place among the models.
struct Prepared {
    subject: Subject,
    name: String,
    /// Of a model: variant, and index for each step.
    models: Vec<(Option<String>, Vec<usize>)>,
}

impl Plan {
    /// Reads everything; what is wrong is said before anything runs.
    pub fn new(arguments: &CompareArguments) -> Result<Self, Failure> {
        let subjects: Vec<Subject> = arguments.subjects.iter().map(|argument| Subject::of(argument)).collect();
        refuse_idle(arguments, &subjects)?;
        let mut models = Vec::new();
        let prepared = subjects.iter().map(|subject| prepare(subject, &subjects, arguments, &mut models));
        let prepared = prepared.collect::<Result<Vec<Prepared>, Failure>>()?;
        let mut known = Headings::new();
        for column in models.iter().flat_map(|loaded: &Loaded| headings(&loaded.model).columns().to_vec()) {
            known.entry(column.heading.name.clone()).or_insert(column.heading);
        }
        subjects.iter().for_each(|subject| subject.add_headings(&mut known));
        let (methods, left_out) = methods(arguments, &subjects, &models);
        let mut entries = Vec::new();
        for one in &prepared {
            match one.subject.read(&known)? {
                Some((recording, summary)) => entries.push(Entry { label: one.name.clone(), of: Of::Read(recording, summary) }),
                None => entries.extend(runs(one, prepared.len() > 1, &models, &methods, arguments)?),
            }
        }
        tell_apart(&mut entries);
        let shown = shown(&prepared, &models);
        let names: Vec<&str> = prepared.iter().map(|one| one.name.as_str()).collect();
        let plan = Self {
            title: if let ([_], [loaded]) = (&names[..], &shown[..]) { loaded.title().to_string() } else { names.join(" · ") },
            name: subjects[0].name(),
            text: texts(&shown),
            blank: Scene { axes: shown.first().map_or("xyz", |loaded| &loaded.model.scene.axes).to_string(), ..Scene::default() },
            columns: arguments.columns.iter().flat_map(|given| items(given)).map(str::to_string).collect(),
            models,
            entries,
            left_out,
        };
        plan.check_columns()?;
        Ok(plan)
    }

    /// Says which methods are left out, and of what was measured where no column of it is beside one of another, as where a name is spelled otherwise.
    pub fn notes(&self) -> Vec<String> {
        let names = |entry: &Entry| -> Vec<String> {
            let of = |recording: &Recording| recording.columns().iter().map(|column| column.heading.name.clone()).collect();
            match &entry.of {
                Of::Run(model, _) => of(&headings(&self.models[*model].model)),
                Of::Read(recording, _) => of(recording),
            }
        };
        let all: Vec<Vec<String>> = self.entries.iter().map(names).collect();
        let is_measured = |entry: &Entry| matches!(&entry.of, Of::Read(_, summary) if summary["status"] == MEASURED);
        let told = |(k, entry): (usize, &Entry)| {
            let others =
                || all.iter().enumerate().filter(|(other, _)| *other != k).flat_map(|(_, names)| names).filter(|name| *name != "t");
            let mut own = all[k].iter().filter(|name| *name != "t");
            if !is_measured(entry) || others().next().is_none() || own.clone().any(|name| others().any(|other| other == name)) {
                return None;
            }
            let near = own.find_map(|name| Some((name, nearest(name, others().map(String::as_str))?)));
            let near = near.map_or_else(String::new, |(name, near)| format!("; did you mean `{near}` by `{name}`?"));
            Some(format!("nothing is beside the columns of {}, as columns are compared by their names{near}", entry.label))
        };
        self.left_out.iter().cloned().chain(self.entries.iter().enumerate().filter_map(told)).collect()
    }

    /// Refuses columns without which there is no difference.
    fn check_columns(&self) -> Result<(), Failure> {
        let has = |entry: &Entry, column: &str| match &entry.of {
            Of::Run(model, _) => headings(&self.models[*model].model).find(column).is_some(),
            Of::Read(recording, _) => recording.find(column).is_some(),
        };
        let Some((first, others)) = self.entries.split_first().filter(|_| !self.columns.is_empty()) else { return Ok(()) };
        if others.is_empty() {
            return Err(Failure::usage("there is one run only, and --columns tells differences", "name something to compare it with"));
        }
        for (k, column) in self.columns.iter().enumerate() {
            if self.columns[..k].contains(column) {
                return Err(Failure::usage(format!("the column `{column}` is asked for twice"), "leave out one of them"));
            }
            if !has(first, column) {
                return Err(match &first.of {
                    Of::Run(model, _) => unknown(column, &headings(&self.models[*model].model)),
                    Of::Read(recording, _) => unknown(column, recording),
                });
            }
            if !others.iter().any(|other| has(other, column)) {
                let message = format!("only `{}` has a column `{column}`", first.label);
                return Err(Failure::usage(message, "ask for a column that another has, too: columns are compared by their names"));
            }
        }
        Ok(())
    }
}

/// Each model once, without variants and other steps.
fn shown<'a>(prepared: &[Prepared], models: &'a [Loaded]) -> Vec<&'a Loaded> {
    let mut shown: Vec<&Loaded> = prepared.iter().filter_map(|one| models.get(*one.models.first()?.1.first()?)).collect();
    shown.dedup_by(|a, b| a.name == b.name && a.source.text() == b.source.text());
    shown
}

/// The texts of model files, with their names where they are several.
fn texts(shown: &[&Loaded]) -> String {
    match shown {
        [loaded] => loaded.source.text().to_string(),
        _ => shown.iter().map(|loaded| format!("# {}\n{}", loaded.name, loaded.source.text())).collect::<Vec<_>>().join("\n"),
    }
}

/// The columns of a run of a model, without rows.
fn headings(model: &Model) -> Recording {
    Recorder::new(&model.channels, &model.system, 1, model.output.constraints()).finish()
}

/// Refuses what is said of models where there is none.
fn refuse_idle(arguments: &CompareArguments, subjects: &[Subject]) -> Result<(), Failure> {
    if subjects.iter().any(|subject| matches!(subject, Subject::Model(_))) {
        return Ok(());
    }
    let given = [
        ("--set", !arguments.set.is_empty()),
        ("--variant", !arguments.variants.is_empty()),
        ("--method", !arguments.methods.is_empty()),
        ("--step", !arguments.steps.is_empty()),
        ("--end", arguments.end.is_some()),
        ("--every", arguments.output.every.is_some()),
        // That is what it is where nobody asks for one.
        ("--format", arguments.output.formats != ["csv"]),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => {
            Err(Failure::usage(format!("nothing is run, and {option} is for runs"), format!("leave out {option}, or name a model")))
        }
        None => Ok(()),
    }
}

/// Loads a model once for each variant and step.
fn prepare(subject: &Subject, all: &[Subject], arguments: &CompareArguments, models: &mut Vec<Loaded>) -> Result<Prepared, Failure> {
    load::require_kept(&arguments.set, !arguments.methods.is_empty())?;
    let is_shared = all.iter().filter(|other| other.name() == subject.name()).count() > 1;
    let name = if is_shared { subject.argument() } else { subject.name() };
    let mut prepared = Prepared { subject: subject.clone(), name, models: Vec::new() };
    let Subject::Model(argument) = subject else { return Ok(prepared) };
    let steps: Vec<Option<&str>> = match arguments.steps.is_empty() {
        true => vec![None],
        false => arguments.steps.iter().map(|step| Some(step.as_str())).collect(),
    };
    for variant in std::iter::once(None).chain(arguments.variants.iter().map(Some)) {
        let mut indices = Vec::new();
        for step in &steps {
            let mut overrides = load::overrides(&arguments.set);
            for given in variant.into_iter().flat_map(|variant| items(variant)) {
                refuse_part(given, arguments)?;
                overrides.set(given);
            }
            overrides.number("simulation.step", *step);
            overrides.number("simulation.end", arguments.end.as_deref());
            indices.push(models.len());
            models.push(load::load_to_run(argument, overrides)?);
        }
        prepared.models.push((variant.cloned(), indices));
    }
    Ok(prepared)
}

/// Refuses a part of a variant that sets nothing, or what an option of its own sets.
fn refuse_part(given: &str, arguments: &CompareArguments) -> Result<(), Failure> {
    let Some((key, _)) = given.split_once('=') else {
        return Err(Failure::usage(
            format!("`{given}` in --variant has no `=`"),
            "write --variant KEY=VALUE,KEY=VALUE, such as --variant parameters.k=100,parameters.c=2",
        ));
    };
    let options = [
        ("simulation.step", "--step", !arguments.steps.is_empty()),
        ("simulation.end", "--end", arguments.end.is_some()),
        ("simulation.method", "--method", !arguments.methods.is_empty()),
    ];
    match options.iter().find(|(of, _, is_given)| *is_given && *of == key.trim()) {
        Some((key, option, _)) => Err(Failure::usage(format!("--variant and {option} both set `{key}`"), "leave out one of them")),
        None => Ok(()),
    }
}

/// The methods that each model is run with; `None` is its own. A single model without variants is run with all that can have its accuracy; and what
/// is said of the others.
fn methods(arguments: &CompareArguments, subjects: &[Subject], models: &[Loaded]) -> (Vec<Option<String>>, Vec<String>) {
    match (arguments.methods.is_empty(), subjects.len() == 1 && arguments.variants.is_empty()) {
        (false, _) => (arguments.methods.iter().cloned().map(Some).collect(), Vec::new()),
        (true, true) => {
            let by_accuracy = || models.iter().filter(|loaded| loaded.model.settings.choice.accuracy.is_some());
            let error = |name: &str| by_accuracy().find_map(|loaded| Method::resolve(&loaded.model.choice(Some(name))).err());
            let left_out = NAMED.iter().filter_map(|named| Some(format!("{} is left out: {}", named.name, error(named.name)?))).collect();
            (NAMED.iter().filter(|named| error(named.name).is_none()).map(|named| Some(named.name.to_string())).collect(), left_out)
        }
        (true, false) => (vec![None], Vec::new()),
    }
}

/// The runs of a model: every variant with every step and every method.
fn runs(
    one: &Prepared,
    is_one_of_many: bool,
    models: &[Loaded],
    methods: &[Option<String>],
    arguments: &CompareArguments,
) -> Result<Vec<Entry>, Failure> {
    let mut entries = Vec::new();
    for (variant, indices) in &one.models {
        for &model in indices {
            let loaded = &models[model];
            for method in methods {
                let order = Order::new(loaded, method.as_deref(), arguments.output.every, arguments.output.to.quiet)?;
                let is_named = is_one_of_many || (variant.is_none() && !arguments.variants.is_empty());
                let mut parts: Vec<String> = is_named.then(|| one.name.clone()).into_iter().chain(variant.clone()).collect();
                if methods.len() > 1 || parts.is_empty() {
                    parts.push(method.clone().unwrap_or_else(|| order.method.name.clone()));
                }
                if indices.len() > 1 {
                    parts.push(format!("{} s", short(order.provenance.step)));
                }
                entries.push(Entry { label: parts.join(", "), of: Of::Run(model, Box::new(order)) });
            }
        }
    }
    Ok(entries)
}

/// Numbers those that are called as one before them.
fn tell_apart(entries: &mut [Entry]) {
    for k in 1..entries.len() {
        let is_taken = |label: &str| entries[..k].iter().any(|entry| entry.label == label);
        if is_taken(&entries[k].label) {
            let numbered = |number: usize| format!("{} ({number})", entries[k].label);
            entries[k].label = (2..).map(numbered).find(|label| !is_taken(label)).expect("there are more numbers than entries");
        }
    }
}
