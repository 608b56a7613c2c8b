//! Reads the sections of a model as they stand in a table.

use std::collections::HashSet;

use super::GROUND;
use super::bars::Bar;
use super::beams::Beam;
use super::bodies::Body;
use super::description::{Description, ModelKeys};
use super::element::Boxed;
use super::entries::Entries;
use super::event::Event;
use super::fault::{Fault, Read, Sink, nearest, suggest};
use super::fields::Keys;
use super::input::Input;
use super::key::{Key, Kind, Kinds, REPEAT, Shape};
use super::measure::Measure;
use super::points::Point;
use super::reader::Reader;
use super::start::{EQUILIBRIUM, Start, one_of};
use super::synonyms::same;
use super::tables::Curve;
use super::value::{Table, Value, key_path};

/// What could be read of a file, and what could not.
pub(super) struct Partial {
    pub description: Description,
    pub unread: Unread,
}

/// Names of the entries in which something could not be read; what refers to them is no second fault.
#[derive(Default)]
pub(super) struct Unread {
    pub tables: HashSet<String>,
    /// Inputs and measures.
    pub signals: HashSet<String>,
    pub points: HashSet<String>,
    pub bodies: HashSet<String>,
    pub bars: HashSet<String>,
    pub beams: HashSet<String>,
    pub joints: HashSet<String>,
}

/// Whether a table of starts says whether it is at equilibrium, which a joint of that name does not.
fn is_equilibrium(starts: &Table) -> bool {
    starts.get(EQUILIBRIUM.name).is_some_and(|value| !matches!(value, Value::Table(_)))
}

/// Names of the tables of a model.
const TABLES: [&str; 16] = [
    "parameters",
    "table",
    "input",
    "point",
    "body",
    "bar",
    "beam",
    "joint",
    "constraint",
    "drive",
    "force",
    "start",
    "measure",
    "event",
    "simulation",
    "output",
];

/// What to write for a table that is called like a kind.
fn as_kind(key: &str, kinds: &Kinds) -> Option<String> {
    let tables = [("joint", &kinds.joints), ("force", &kinds.forces), ("constraint", &kinds.constraints), ("drive", &kinds.drives)];
    let kind = |word: &str| tables.iter().find_map(|(table, kinds)| Some((table, same(word, kinds.iter().map(|kind| kind.name))?)));
    let (table, kind) = kind(key).or_else(|| kind(key.strip_suffix('s')?))?;
    Some(format!("write [{table}.NAME] with type = \"{kind}\""))
}

/// Reads all tables of a model. What cannot be read is left out.
pub(super) fn read(value: &Value, kinds: &Kinds, sink: &Sink) -> Read<Partial> {
    let Value::Table(table) = value else {
        return Err(sink.report(|| Fault::new("", value.quoted(), "a model is a table", "")));
    };
    let root = Reader::new("", "", table, sink);
    let tables = TABLES.map(|name| Key::optional(name, Shape::Table(&[]), "", "", ""));
    root.refuse_keys_but("a model", ModelKeys::KEYS.iter().chain(&tables), |key| as_kind(key, kinds));
    let parameters = match table.get("parameters") {
        Some(Value::Table(table)) => table.clone(),
        Some(other) => {
            root.refuse_no_table("parameters".into(), other);
            Table::default()
        }
        None => Table::default(),
    };
    let model = ModelKeys {
        schema: root.may_have("schema").unwrap_or(None),
        title: root.may_have("title").unwrap_or(None),
        gravity: root.may_have("gravity").unwrap_or(None),
        plane: root.may_have("plane").unwrap_or(None),
    };
    let mut names = Names::new(sink);
    let (tables, unread_tables) = section(&root, "table", &mut names, |reader| {
        reader.refuse_unknown_keys("a table", Curve::KEYS.iter());
        <Curve as Keys>::read(reader)
    });
    let (inputs, unread_inputs) = section(&root, "input", &mut names, |reader| keys::<Input>("an input", reader));
    let (points, unread_points) = section(&root, "point", &mut names, |reader| keys::<Point>("a point", reader));
    let (bodies, unread_bodies) = section(&root, "body", &mut names, |reader| keys::<Body>("a body", reader));
    let (bars, unread_bars) = section(&root, "bar", &mut names, |reader| keys::<Bar>("a bar", reader));
    let (beams, unread_beams) = section(&root, "beam", &mut names, |reader| keys::<Beam>("a beam", reader));
    let is_planar = table.get("plane").is_some();
    let elements =
        |names: &mut Names<'_>, name: &str, kinds: &[Kind]| section(&root, name, names, |reader| element(name, kinds, is_planar, reader));
    let (constraints, _) = elements(&mut names, "constraint", &kinds.constraints);
    let (joints, unread_joints) = elements(&mut names, "joint", &kinds.joints);
    let (drives, _) = elements(&mut names, "drive", &kinds.drives);
    let (forces, _) = elements(&mut names, "force", &kinds.forces);
    // A start has the name of its joint.
    let mut of_joints = Names::new(sink);
    let equilibrium = match table.get("start") {
        Some(Value::Table(table)) if is_equilibrium(table) => {
            Reader::new("start", "start", table, sink).must_have(EQUILIBRIUM.name).unwrap_or(false)
        }
        _ => false,
    };
    let (starts, _) = section(&root, "start", &mut of_joints, |reader| keys::<Start>("a start", reader));
    let (measures, unread_measures) = section(&root, "measure", &mut names, |reader| keys::<Measure>("a measure", reader));
    let (events, _) = section(&root, "event", &mut names, |reader| keys::<Event>("an event", reader));
    let (simulation, output) = (root.may_have("simulation").unwrap_or(None), root.may_have("output").unwrap_or(None));
    Ok(Partial {
        description: Description {
            model,
            parameters,
            tables,
            functions: kinds.functions.clone(),
            inputs,
            points,
            bodies,
            bars,
            beams,
            joints,
            constraints,
            drives,
            forces,
            starts,
            equilibrium,
            measures,
            events,
            simulation,
            output,
        },
        unread: Unread {
            tables: unread_tables,
            signals: unread_inputs.into_iter().chain(unread_measures).collect(),
            points: unread_points,
            bodies: unread_bodies,
            bars: unread_bars,
            beams: unread_beams,
            joints: unread_joints,
        },
    })
}

/// The entries of a section, and the names of those that could not be read.
fn section<T>(
    root: &Reader<'_>,
    section: &str,
    names: &mut Names<'_>,
    read: impl Fn(&Reader<'_>) -> Read<T>,
) -> (Entries<T>, HashSet<String>) {
    let (mut entries, mut unread) = (Entries::default(), HashSet::new());
    let table = match root.table.get(section) {
        None => return (entries, unread),
        Some(Value::Table(table)) => table,
        Some(other) => {
            let message = format!("`{section}` is {}, and a table of named entries is wanted", other.type_name());
            names.sink.report(|| Fault::new(section, other.quoted(), message, format!("write [{section}.NAME]")));
            unread.insert(section.to_string());
            return (entries, unread);
        }
    };
    for (name, value) in table.iter() {
        if section == "start" && name == EQUILIBRIUM.name && is_equilibrium(table) {
            continue;
        }
        let path = key_path(section, name);
        let valid = names.check(section, name);
        let Value::Table(table) = value else {
            let message = format!("`{path}` is {}, and a table is wanted", value.type_name());
            names.sink.report(|| Fault::new(&*path, value.quoted(), message, format!("write [{section}.{name}] and its keys below")));
            unread.insert(name.to_string());
            continue;
        };
        let reader = Reader::new(name, &path, table, names.sink);
        let entry = read(&reader);
        let repeat = reader.may_have::<String>(REPEAT.name);
        // What it means is not known either where a key is not known, but what is wrong with the others is told.
        if valid.is_err() || reader.has_fault() {
            unread.insert(name.to_string());
        }
        if let (Ok(()), Ok(entry), Ok(repeat)) = (valid, entry, repeat) {
            entries.add(name, entry).repeat = repeat;
        }
    }
    (entries, unread)
}

/// An entry without a `type`.
fn keys<T: Keys>(what: &str, reader: &Reader<'_>) -> Read<T> {
    reader.refuse_unknown_keys(what, T::KEYS.iter().chain([&REPEAT]));
    T::read(reader)
}

/// An entry of one of some kinds.
fn element(section: &str, kinds: &[Kind], is_planar: bool, reader: &Reader<'_>) -> Read<Boxed> {
    let names = || kinds.iter().map(|kind| kind.name);
    let any_of = |names: &[&str]| names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(" or ");
    if reader.table.get("type").is_none() {
        let fitting = Some(fitting(kinds, reader.table)).filter(|fitting| !fitting.is_empty());
        let names = fitting.unwrap_or_else(|| names().collect());
        return Err(reader.refuse_all(format!("`{}` has no `type`", reader.name), format!("add type = {}", any_of(&names))));
    }
    let text: String = reader.must_have("type")?;
    let Some(kind) = kinds.iter().find(|kind| kind.name == text) else {
        return Err(reader.refuse("type", format!("there is no {section} of type \"{text}\""), suggest(&text, names())));
    };
    // Before its keys are asked for, which no cure is.
    if let Some(cure) = kind.in_plane.filter(|_| is_planar) {
        return Err(reader.refuse_in_plane(section, kind.name, cure));
    }
    let type_key = Key::required("type", Shape::Text, "", "");
    let what = format!("a {section} of type \"{}\"", kind.name);
    let known = kind.keys.iter().chain([&type_key, &REPEAT]);
    // A key that is like none of its own, where all that is written are those of one other kind.
    let strange = reader.table.keys().find(|key| nearest(key, known.clone().map(|known| known.name)).is_none());
    if let Some(key) = strange
        && let [other] = fitting(kinds, reader.table)[..]
    {
        return Err(reader.refuse_key(key, format!("{what} has no key `{key}`"), format!("write type = \"{other}\"")));
    }
    reader.refuse_unknown_keys(&what, known);
    (kind.read)(reader)
}

/// The kinds whose keys are all that stand in a table, by their names or by what else they are called.
fn fitting<'k>(kinds: &'k [Kind], table: &Table) -> Vec<&'k str> {
    let written = || table.keys().filter(|key| *key != "type" && *key != REPEAT.name);
    let fits = |kind: &&Kind| {
        let needed = kind.keys.iter().filter(|key| key.required);
        written().all(|key| same(key, kind.keys.iter().map(|key| key.name)).is_some())
            && needed.clone().all(|needed| written().any(|key| same(key, [needed.name]).is_some()))
    };
    kinds.iter().filter(fits).map(|kind| kind.name).collect()
}

/// Names of entries so far: they are unique over all sections.
pub(super) struct Names<'a> {
    sink: &'a Sink,
    known: HashSet<String>,
}

impl<'a> Names<'a> {
    pub fn new(sink: &'a Sink) -> Self {
        Self { sink, known: HashSet::new() }
    }

    /// Refuses a name that cannot be one, or is one already.
    pub fn check(&mut self, section: &str, name: &str) -> Read<()> {
        let report = |message: String, cure: &str| self.sink.report(|| Fault::new(key_path(section, name), name, message, cure));
        if name == GROUND {
            return Err(report(format!("`{GROUND}` is the name of the origin"), "give it another name"));
        }
        if name.is_empty() || !name.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-') {
            let cure = one_of(name).filter(|_| section == "start" && name.ends_with(']'));
            return Err(report(format!("\"{name}\" cannot be a name"), cure.as_deref().unwrap_or("use letters, digits, _ and -")));
        }
        if !self.known.insert(name.to_string()) {
            return Err(report(format!("the name `{name}` is used twice"), "give one of them another name: all entries share their names"));
        }
        Ok(())
    }
}
