//! Tests that walk the tables of kinds and keys, and tests of reading that need no file.

use std::collections::HashSet;

use super::*;

/// All tables of kinds with the folder they come from, and its files that are no kinds.
fn folders() -> [(&'static str, Vec<&'static Kind>, &'static [&'static str]); 4] {
    [
        ("constraints", constraints::KINDS.iter().collect(), &[]),
        ("joints", joints::kinds().collect(), &["coupler", "curve", "geometry", "pair", "transmission"]),
        ("drives", drives::KINDS.iter().collect(), &["coordinate", "profile"]),
        (
            "forces",
            forces::KINDS.iter().collect(),
            &["body-load", "along-laws", "coordinate-laws", "joint", "laws", "point-load", "following", "rope-laws"],
        ),
    ]
}

#[test]
fn kinds_and_keys_have_their_own_names_and_documentation() {
    for (folder, kinds, _) in folders() {
        let mut names = HashSet::new();
        for kind in kinds {
            assert!(names.insert(kind.name), "{folder} has two of {}", kind.name);
            assert!(!kind.doc.is_empty() && !kind.equations.is_empty() && !kind.example.is_empty(), "{}", kind.name);
            check_keys(kind.name, kind.keys);
        }
    }
    for (name, keys) in [
        ("point", Point::KEYS),
        ("bar", Bar::KEYS),
        ("beam", Beam::KEYS),
        ("section", Section::KEYS),
        ("body", Body::KEYS),
        ("model", ModelKeys::KEYS),
        ("simulation", SimulationKeys::KEYS),
        ("output", OutputKeys::KEYS),
    ] {
        check_keys(name, keys);
    }
}

fn check_keys(owner: &str, keys: &[Key]) {
    let mut names = HashSet::new();
    for key in keys {
        assert!(names.insert(key.name), "{owner} has two keys {}", key.name);
        assert!(!key.doc.is_empty(), "{owner}.{} says nothing", key.name);
        assert!(key.required == key.default.is_empty(), "{owner}.{} says no default", key.name);
    }
}

#[test]
fn every_file_of_a_folder_is_in_its_table() {
    for (folder, kinds, shared) in folders() {
        let path = format!("{}/src/model/{folder}", env!("CARGO_MANIFEST_DIR"));
        let files = std::fs::read_dir(path).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap());
        let mut found: Vec<String> = files.map(|file| file.trim_end_matches(".rs").replace('_', "-")).collect();
        found.retain(|file| file != "mod" && !shared.contains(&file.as_str()));
        found.sort();
        let mut listed: Vec<&str> = kinds.iter().map(|kind| kind.name).collect();
        listed.sort_unstable();
        assert_eq!(found, listed, "{folder}");
    }
}

fn table(entries: &[(&str, Value)]) -> Value {
    Value::Table(entries.iter().map(|(key, value)| (*key, value.clone())).collect())
}

fn numbers(numbers: &[f64]) -> Value {
    Value::List(numbers.iter().map(|&number| Value::Number(number)).collect())
}

#[test]
fn a_point_on_a_rod_becomes_a_node_and_a_row() {
    let bob = table(&[("mass", Value::Number(2.0)), ("position", numbers(&[1.0, 0.0]))]);
    let rod = table(&[("type", Value::text("distance")), ("between", Value::List(vec![Value::text("ground"), Value::text("bob")]))]);
    let model = table(&[("plane", Value::text("xz")), ("point", table(&[("bob", bob)])), ("constraint", table(&[("rod", rod)]))]);
    let model = Model::from_value(&model, &NoFiles).unwrap_or_else(|faults| panic!("{faults}"));
    assert_eq!((model.dimension, model.axes, model.gravity), (2, "xz", GRAVITY));
    assert_eq!((model.system.coordinates(), model.system.row_names()), (2, &["rod".to_string()][..]));
    assert_eq!(model.system.start_position(), [1.0, 0.0]);
    assert_eq!(model.points[0].mass, 2.0);
}

#[test]
fn half_the_weight_of_a_bar_hangs_on_each_end_also_when_one_is_fixed() {
    for fixed in [Value::text("ground"), numbers(&[0.0, 0.0, 0.0])] {
        let bar = table(&[("between", Value::List(vec![fixed, Value::text("tip")])), ("mass", Value::Number(6.0))]);
        let tip = table(&[("position", numbers(&[2.0, 0.0, 0.0]))]);
        let model = table(&[("point", table(&[("tip", tip)])), ("bar", table(&[("rod", bar)]))]);
        let model = Model::from_value(&model, &NoFiles).unwrap_or_else(|faults| panic!("{faults}"));
        let inertia: f64 = model.system.mass().row(0).map(|(_, block)| block.m).sum();
        assert_eq!((inertia, model.system.weighing[0]), (2.0, [3.0, 0.0]), "m/3 of inertia, m/2 of weight");
    }
}

#[test]
fn faults_of_different_places_come_together() {
    let bob = table(&[("mass", Value::Number(-1.0)), ("position", numbers(&[1.0, 0.0])), ("colour", Value::text("red"))]);
    let rod = table(&[("type", Value::text("distanc")), ("between", Value::Number(1.0))]);
    let model = table(&[("point", table(&[("bob", bob)])), ("constraint", table(&[("rod", rod)])), ("titel", Value::text("x"))]);
    let faults = Model::from_value(&model, &NoFiles).err().expect("wrong").0;
    let paths: Vec<&str> = faults.iter().map(|fault| fault.path.as_str()).collect();
    // What is not known or of another shape first, then what is wrong with the numbers.
    assert_eq!(paths, ["titel", "point.bob.colour", "constraint.rod.type", "point.bob.mass", "point.bob.position"]);
}

#[test]
fn the_schema_knows_every_kind() {
    let Value::Table(schema) = schema() else { panic!("a table") };
    let Some(Value::Table(properties)) = schema.get("properties") else { panic!("properties") };
    for name in ["schema", "title", "gravity", "plane", "parameters", "point", "bar", "constraint", "force", "simulation", "output"] {
        assert!(properties.get(name).is_some(), "{name}");
    }
    for (_, kinds, _) in folders() {
        for kind in kinds {
            assert!(format!("{schema:?}").contains(&format!("{:?}", kind.name)), "{}", kind.name);
        }
    }
}
