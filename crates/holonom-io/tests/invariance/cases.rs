//! The models: the gallery, the example of every kind, and hard ones.

use std::sync::OnceLock;

use holonom::model::{Table, Value, constraints, drives, forces, joints};
use holonom_io::Source;

use super::motion::{self, Scale, Track};
use super::sections::{number, table};
use super::transform::{Coordinate, Coordinates};
use super::written;

/// What every model is run with.
pub const METHODS: [&str; 2] = ["conserving-ggl", "conserving"];

/// Steps of a run.
const STEPS: usize = 100;

/// Largest difference of two motions over the scale of the model.
pub const BOUND: f64 = 1e-10;

/// Models in which round-off alone makes a larger difference, and why.
const LOOSER: &[(&str, f64)] = &[
    // A place is rounded to 1e-16 m: over the 0.1 mm of the smallest body and the 0.1 ms of a step that is 1e-8 rad/s.
    ("small-on-large", 1e-8),
    // Its elements vibrate along themselves with 1e6 rad/s, which makes of a place that is rounded to 1e-17 m 1e-10 rad/s over 0.1 m.
    ("flexible-four-bar", 1e-8),
];

/// Freedom of the hard models, by counting.
pub const FREEDOM: &[(&str, usize)] = &[
    ("braced", 1),
    ("bricard-rods", 1),
    ("drifting", 14),
    ("light-on-heavy", 3),
    ("masses-apart", 6),
    ("nearly-parallel", 2),
    ("planetary", 1),
    ("rssr", 1),
    ("sarrus", 1),
    ("small-on-large", 3),
    ("stiff-and-soft", 5),
    ("thin-rods", 8),
    ("watch", 2),
];

/// A model with the runs that all others are compared with.
pub struct Case {
    pub name: String,
    /// As it is in its file.
    pub original: Table,
    pub description: Table,
    pub coordinates: Coordinates,
    pub step: f64,
    pub steps: usize,
    /// Largest difference of two motions over the scale.
    pub bound: f64,
    pub tracks: [Track; 2],
    pub scale: Scale,
}

/// All of them, run once.
pub fn cases() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| texts().into_iter().map(|(name, text)| Case::new(name, &text)).collect())
}

fn texts() -> Vec<(String, String)> {
    let folder = |folder: &str| {
        let path = format!("{}/{folder}", env!("CARGO_MANIFEST_DIR"));
        let files = std::fs::read_dir(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
        let mut files: Vec<_> = files.map(|file| file.expect("a file").path()).collect();
        files.sort();
        let read = |file: std::path::PathBuf| {
            let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
            (name, std::fs::read_to_string(&file).expect("a text"))
        };
        files.into_iter().filter(|file| file.extension().is_some_and(|ending| ending == "toml")).map(read).collect::<Vec<_>>()
    };
    let kinds = |section: &'static str, kinds: Vec<&'static holonom::model::Kind>| {
        kinds.into_iter().map(move |kind| (format!("{section}:{}", kind.name), kind.example.to_string()))
    };
    let mut texts = folder("../../examples");
    texts.extend(folder("tests/invariance/models"));
    texts.extend(kinds("joint", joints::kinds().collect()));
    texts.extend(kinds("constraint", constraints::KINDS.iter().collect()));
    texts.extend(kinds("drive", drives::KINDS.iter().collect()));
    texts.extend(kinds("force", forces::KINDS.iter().collect()));
    texts
}

/// The description of a file.
fn parsed(name: &str, text: &str) -> Table {
    let source = Source::read(name, text.as_bytes()).unwrap_or_else(|message| panic!("{message}"));
    let sections = ["title", "plane", "gravity", "parameters", "simulation"].into_iter().chain(super::sections::SECTIONS);
    let given = sections.filter_map(|key| source.get(key).map(|value| (key, value.clone())));
    given.collect()
}

impl Case {
    fn new(name: String, text: &str) -> Self {
        let original = parsed(&name, text);
        let description = written::out(&original);
        let model = motion::model(&description).unwrap_or_else(|faults| panic!("{name}: {faults}"));
        let step = table(&description, "simulation").get("step").map_or(0.01, number);
        let tracks = METHODS.map(|method| motion::run(&description, method, step, STEPS));
        for (track, method) in tracks.iter().zip(METHODS) {
            assert_eq!(track.status, "completed", "{name}, {method}");
        }
        let scale = Scale::new(&model, &tracks[0].moments);
        let bound = LOOSER.iter().find(|(known, _)| *known == name).map_or(BOUND, |&(_, bound)| bound);
        let coordinates = coordinates(&model, &description);
        Self { name, original, description, coordinates, step, steps: STEPS, bound, tracks, scale }
    }

    /// Numbers of a vector.
    pub fn dimension(&self) -> usize {
        written::letters(&self.description).len()
    }
}

/// The coordinates of the joints of a model.
fn coordinates(model: &holonom::model::Model, description: &Table) -> Coordinates {
    let mut all = Coordinates::new();
    for joint in &model.joints {
        let entry = table(&table(description, "joint"), &joint.name);
        // The third axis of a generic joint is the cross product of the others, and turns round in a mirror.
        let is_locked = |lock: &str| matches!(entry.get("locks"), Some(Value::List(locks)) if locks.contains(&Value::text(lock)));
        let generic = joint.kind == "generic";
        for coordinate in &joint.coordinates {
            let is_angle = coordinate.is_angle;
            let own = Coordinate {
                is_angle,
                is_odd: if generic { is_angle && is_locked("rz") || coordinate.name == "z" } else { is_angle },
                is_free: matches!(joint.kind, "planar" | "point-on-plane") && !is_angle,
            };
            all.insert(format!("{}.{}", joint.name, coordinate.name), own);
            if joint.coordinates.len() == 1 {
                all.insert(joint.name.clone(), own);
            }
        }
    }
    all
}
