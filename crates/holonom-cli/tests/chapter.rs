//! The schema, and the chapter of the book on the model file.

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use common::*;
use serde_json::Value;

#[test]
fn the_schema_is_json_and_knows_every_section() {
    let schema = json(&folder(), "schema");
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    for section in ["title", "gravity", "plane", "parameters", "point", "bar", "constraint", "force", "simulation", "output"] {
        assert!(schema["properties"][section].is_object(), "{section}");
    }
}

/// The chapter of the book names every key and kind that the reader knows.
#[test]
fn the_model_file_chapter_is_complete() {
    let chapter = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-file.md")).unwrap();
    let schema = json(&folder(), "schema");
    let mut known = BTreeSet::new();
    collect_keys(&schema, &mut known);
    assert!(known.contains("constraint_at") && known.contains("rest_length") && known.contains("point-on-plane"));
    let missing: Vec<&String> = known.iter().filter(|key| !chapter.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "docs/model-file.md does not name {missing:?}");
}

/// Names of all properties and of all kinds.
fn collect_keys(schema: &Value, known: &mut BTreeSet<String>) {
    if let Some(properties) = schema["properties"].as_object() {
        known.extend(properties.keys().cloned());
    }
    known.extend(schema["const"].as_str().map(str::to_string));
    match schema {
        Value::Object(table) => table.values().for_each(|value| collect_keys(value, known)),
        Value::Array(items) => items.iter().for_each(|value| collect_keys(value, known)),
        _ => (),
    }
}

/// Every example of the chapter is read, and what is marked as a whole model runs.
#[test]
fn the_models_of_the_chapter_are_sound() {
    let chapter = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/model-file.md")).unwrap();
    let folder = folder();
    let models = chapter.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let mut count = 0;
    for (k, model) in models.enumerate() {
        fs::write(folder.path().join(format!("m{k}.toml")), model).unwrap();
        prints(&folder, &format!("run m{k}.toml --end 0.02 --step 0.01 --no-report"), 0);
        count += 1;
    }
    assert!(count >= 10, "{count}");
}
