//! Descriptions: read from files and written again, and the schema that says what files look like.

use std::fs;
use std::path::{Path, PathBuf};

use holonom::model::{Description, Kinds, Model, constraints, drives, forces, joints, schema};
use holonom::simulation::{Choice, Method, Simulation};
use holonom_io::Source;

/// Name and text of the gallery, of the models of benches, and of the examples of all kinds.
fn models() -> Vec<(String, String)> {
    let mut models = Vec::new();
    for folder in ["../../examples", "../../benches/models"] {
        for entry in fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(folder)).expect(folder) {
            let path = entry.expect("an entry").path();
            if path.extension().is_some_and(|extension| extension == "toml") {
                models.push((path.display().to_string(), fs::read_to_string(&path).expect("a text")));
            }
        }
    }
    let kinds = constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS);
    models.extend(kinds.map(|kind| (kind.name.to_string(), kind.example.to_string())));
    models
}

fn source(name: &str, text: &str) -> Source {
    Source::read("model.toml", text.as_bytes()).unwrap_or_else(|faults| panic!("{name}: {faults}"))
}

/// Positions and velocities after some steps, or why there are none.
fn after_steps(model: &Model) -> Result<Vec<f64>, String> {
    let method = Method::resolve(&Choice::default()).expect("the default goes together");
    let mut simulation = Simulation::new(model.system.clone(), method, 1e-3).map_err(|error| error.to_string())?;
    let _ = simulation.step_to(0.01);
    Ok(simulation.state().x.iter().chain(&simulation.state().v).copied().collect())
}

#[test]
fn a_description_that_is_written_and_read_again_is_the_same_and_moves_the_same() {
    for (name, text) in models() {
        let source = source(&name, &text);
        let description = source.description().unwrap_or_else(|faults| panic!("{name}: {faults}"));
        let written = description.to_value();
        let again = Description::from_value(&written, &Kinds::default()).unwrap_or_else(|faults| panic!("{name}: {faults}"));
        assert_eq!(again, description, "{name}");
        let of_file = source.model().unwrap_or_else(|faults| panic!("{name}: {faults}"));
        let of_hand = again.compile().unwrap_or_else(|faults| panic!("{name}: {faults}"));
        assert_eq!(of_file.system.row_names(), of_hand.system.row_names(), "{name}");
        let [of_file, of_hand] = [&of_file, &of_hand].map(after_steps);
        let bits = |numbers: Result<Vec<f64>, String>| numbers.map(|numbers| numbers.into_iter().map(f64::to_bits).collect::<Vec<_>>());
        assert_eq!(bits(of_file), bits(of_hand), "{name}");
    }
}

#[test]
fn a_parameter_is_changed_and_the_model_compiled_again() {
    let text = "plane = \"xz\"\n[parameters]\nL = 1\n[point.bob]\nmass = 1\nposition = [\"L\", 0]\n\
                [constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\n";
    let mut description = source("pendulum", text).description().expect("sound");
    for length in [1.0, 2.5] {
        description.parameter("L", length);
        assert_eq!(description.compile().expect("sound").system.start_position(), [length, 0.0]);
    }
}

/// Models that are wrong in what a schema can say: keys, types, counts.
const OF_SHAPE: [&str; 12] = [
    "bar-with-one-end",
    "body-without-position",
    "flag-for-number",
    "joint-without-place",
    "missing-between",
    "number-for-list",
    "number-for-text",
    "section-is-no-table",
    "several-faults",
    "unknown-force-type",
    "unknown-key",
    "unknown-plane",
];

#[test]
fn the_schema_takes_every_model_and_refuses_those_of_a_wrong_shape() {
    let validator = jsonschema::validator_for(&holonom_io::to_json(&schema())).expect("a schema");
    for (name, text) in models() {
        let model: toml::Table = text.parse().unwrap_or_else(|error| panic!("{name}: {error}"));
        let model = serde_json::to_value(model).expect("plain data");
        let faults: Vec<String> = validator.iter_errors(&model).map(|error| error.to_string()).collect();
        assert!(faults.is_empty(), "{name}: {faults:?}");
    }
    let folder: PathBuf = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/wrong");
    let (mut refused, mut taken) = (0, Vec::new());
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("an entry").path();
        let Some(name) = path.file_stem().and_then(|name| name.to_str()).filter(|_| path.extension().is_some_and(|e| e == "toml")) else {
            continue;
        };
        let Ok(model) = fs::read_to_string(&path).unwrap_or_default().parse::<toml::Table>() else { continue };
        match validator.is_valid(&serde_json::to_value(model).expect("plain data")) {
            true => taken.push(name.to_string()),
            false => refused += 1,
        }
    }
    println!("{refused} wrong models are refused by the schema, {} are wrong in what it cannot say", taken.len());
    assert!(refused >= 60, "only {refused}");
    assert!(OF_SHAPE.iter().all(|name| !taken.contains(&name.to_string())), "{taken:?}");
}
