//! The schema, and the chapters of the book on the model file and on joints.

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use common::*;
use holonom::model::joints::{COUPLERS, JOINTS, kinds};
use holonom::model::{Body, Key, Keys, Kind, Model, drives, forces};
use holonom_io::Source;
use serde_json::Value;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn chapter(name: &str) -> String {
    fs::read_to_string(root().join("docs").join(name)).unwrap()
}

#[test]
fn the_schema_is_json_and_knows_every_section() {
    let schema = json(&folder(), "schema");
    assert_eq!(schema["$schema"], "https://json-schema.org/draft/2020-12/schema");
    let sections = ["title", "gravity", "plane", "parameters", "simulation", "output"];
    let named = ["table", "input", "point", "body", "bar", "beam", "joint", "constraint", "drive", "force", "start", "measure", "event"];
    for section in sections.into_iter().chain(named) {
        assert!(schema["properties"][section].is_object(), "{section}");
    }
}

/// The chapters name every key and kind that the reader knows.
#[test]
fn the_model_file_chapter_is_complete() {
    let chapters = [chapter("model-file.md"), chapter("joints.md")].concat();
    let schema = json(&folder(), "schema");
    let mut known = BTreeSet::new();
    collect_keys(&schema, &mut known);
    assert!(known.contains("constraint_at") && known.contains("rest_length") && known.contains("point-on-plane"));
    let missing: Vec<&String> = known.iter().filter(|key| !chapters.contains(&format!("`{key}`"))).collect();
    assert!(missing.is_empty(), "docs/model-file.md and docs/joints.md do not name {missing:?}");
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

/// The part of a chapter below a heading, up to the next of any level.
fn section<'a>(chapter: &'a str, heading: &str) -> &'a str {
    let start = chapter.find(&format!("\n{heading}\n")).unwrap_or_else(|| panic!("there is no section {heading}")) + heading.len() + 2;
    let end = chapter[start..].find("\n#").map_or(chapter.len(), |end| start + end);
    &chapter[start..end]
}

/// A text on one line, without the marks that hold no words.
fn flat(text: &str) -> String {
    text.replace(['`', '"', '\\'], "").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// The row of a table that begins with a key, and has one of its defaults and units.
fn assert_tells(part: &str, of: &str, key: &Key) {
    let rows = part
        .lines()
        .filter(|line| line.starts_with('|') && line.split('|').nth(1).is_some_and(|cell| cell.contains(&format!("`{}`", key.name))));
    let rows: Vec<&str> = rows.collect();
    assert!(!rows.is_empty(), "`{of}`: no row of a table is about `{}`", key.name);
    let tells = |text: &str| rows.iter().any(|row| flat(row).contains(&flat(text)));
    assert!(tells(key.default), "`{of}`: `{}` has the default {:?}, not in {rows:?}", key.name, key.default);
    assert!(tells(key.unit), "`{of}`: `{}` has the unit {:?}, not in {rows:?}", key.name, key.unit);
}

#[test]
fn the_keys_of_bodies_drives_and_forces_are_as_the_reader_has_them() {
    let text = chapter("model-file.md");
    let part = |heading: &str| section(&text, heading);
    Body::KEYS.iter().for_each(|key| assert_tells(part("## Bodies: `[body.NAME]`"), "body", key));
    for kind in drives::KINDS {
        assert!(part("## Drives: `[drive.NAME]`").contains(&format!("| `{}` |", kind.name)), "{}", kind.name);
        kind.keys.iter().for_each(|key| assert_tells(part("## Drives: `[drive.NAME]`"), kind.name, key));
    }
    let about = &text[text.find("\n## Forces").expect("there is a part about forces")..];
    for kind in forces::KINDS {
        assert!(part("## Forces: `[force.NAME]`").contains(&format!("| `{}` |", kind.name)), "{}", kind.name);
        let heading = about.lines().find(|line| line.starts_with("### ") && line.contains(&format!("`{}`", kind.name)));
        let below = section(about, heading.unwrap_or_else(|| panic!("there is no section about the force `{}`", kind.name)));
        // The key of the joint is told once for all that act along a coordinate.
        for key in kind.keys.iter().filter(|key| key.name != "joint") {
            assert!(below.contains(&format!("`{}`", key.name)), "the section about the force `{}` does not name `{}`", kind.name, key.name);
        }
    }
}

/// Each joint has a section with what the code says of it.
#[test]
fn the_chapter_on_joints_is_as_the_code_has_it() {
    let text = chapter("joints.md");
    let common = section(&text, "## What they have in common");
    for kind in kinds() {
        let part = section(&text, &format!("### `{}`", kind.name));
        says(part, kind, "doc", kind.doc);
        says(part, kind, "equations", kind.equations);
        for key in kind.keys {
            assert!(part.contains(&format!("`{}`", key.name)), "`{}` does not name its key `{}`", kind.name, key.name);
            // Keys of several joints are in one table for all.
            let place = if flat(part).contains(&flat(key.doc)) { part } else { common };
            assert!(flat(place).contains(&flat(key.doc)), "`{}`: the meaning of `{}` is {:?}", kind.name, key.name, key.doc);
            assert_tells(place, kind.name, key);
        }
        let picture = format!("figures/joints/{}.png", kind.name);
        assert!(part.contains(&picture) && root().join("docs").join(&picture).exists(), "{picture}");
    }
    let sections = text.matches("\n### ").count();
    assert_eq!(sections, JOINTS.len() + COUPLERS.len(), "a section is about no joint");
}

fn says(part: &str, kind: &Kind, what: &str, words: &str) {
    // Sentences begin with a capital.
    let (part, words) = (flat(part).to_lowercase(), flat(words).to_lowercase());
    assert!(part.contains(&words), "docs/joints.md: `{}` has the {what}\n{words}", kind.name);
}

#[test]
fn freedom_and_coordinates_of_joints_are_as_the_code_has_them() {
    let text = chapter("joints.md");
    for joint in JOINTS {
        let (name, part) = (joint.name, section(&text, &format!("### `{}`", joint.name)));
        let row = |first: &str| {
            part.lines().find(|line| line.starts_with(&format!("| {first} |"))).unwrap_or_else(|| panic!("`{name}`: {first}"))
        };
        let [space, plane] = joint.layout.expect("it is a joint").freedom;
        let plane = plane.map_or("not there in the plane".to_string(), |freedom| format!("{freedom} in the plane"));
        let freedom = format!("{} in space, {plane} |", space.expect("every joint is in space"));
        assert!(row("freedom").contains(&freedom), "`{name}`: {freedom}");
        let model = model(joint.example);
        let built = model.joints.iter().find(|built| built.kind == name).expect("the example has the joint");
        let coordinates: Vec<&str> = built.coordinates.iter().map(|coordinate| coordinate.name).collect();
        let told = row("coordinates");
        assert!(coordinates.iter().all(|coordinate| told.contains(&format!("`{coordinate}`"))), "`{name}`: {coordinates:?}");
        assert_eq!(coordinates.is_empty(), told == "| coordinates | none |", "`{name}`: {coordinates:?}");
    }
}

fn model(text: &str) -> Model {
    Source::read("example.toml", text.as_bytes()).and_then(|source| source.model()).unwrap_or_else(|faults| panic!("{faults:?}"))
}

/// Every example of the chapters is read and runs.
#[test]
fn the_models_of_the_chapters_are_sound() {
    let folder = folder();
    let mut count = 0;
    for name in ["model-file", "joints"] {
        let chapter = chapter(&format!("{name}.md"));
        for model in chapter.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()) {
            let file = format!("{name}-{count}.toml");
            fs::write(folder.path().join(&file), model).unwrap();
            prints(&folder, &format!("run {file} --end 0.02 --step 0.01 --no-report"), 0);
            count += 1;
        }
    }
    assert!(count >= 40, "{count}");
}

/// The rows of a table in a chapter are those of a run with the same value in the first column, to five figures.
fn assert_shows(shown: &str, head: &str, rows: &[Vec<f64>]) {
    let mut lines = shown.lines();
    let place = |name: &str| head.split(',').position(|known| known == name).unwrap_or_else(|| panic!("there is no column {name}"));
    let places: Vec<usize> = lines.next().unwrap().split(',').map(place).collect();
    for line in lines {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        let row = rows.iter().find(|row| (row[places[0]] - cells[0]).abs() < 1e-9).unwrap_or_else(|| panic!("no row is that of {line}"));
        for (&place, cell) in places.iter().zip(cells) {
            assert!((row[place] - cell).abs() <= 1e-4 * cell.abs() + 1e-9, "{line}: {} and not {cell}", row[place]);
        }
    }
}

/// Folder of the results that a run names.
fn results(out: &str, folder: &tempfile::TempDir) -> PathBuf {
    let named = out.lines().find_map(|line| line.strip_prefix("results in ")).expect("a run says where its results are");
    folder.path().join(named)
}

/// Runs a command of a chapter, which prints the lines of its answer.
fn answers(folder: &tempfile::TempDir, command: &str, answer: &str) -> String {
    let words = command.strip_prefix("holonom ").unwrap().replace('"', "");
    let out = prints(folder, &format!("{words} --no-report"), 0);
    assert!(!answer.is_empty(), "{command} is told to print nothing");
    for line in answer.lines() {
        assert!(out.lines().any(|printed| printed == line), "{command} does not print\n{line}\nbut\n{out}");
    }
    out
}

/// Each machine of its chapter is run by the commands below it, and answers with the lines below these.
#[test]
fn the_machines_of_the_chapter_answer_what_it_says() {
    let folder = folder();
    let chapter = chapter("machines.md");
    let mut count = 0;
    for rest in chapter.split("```toml\n").skip(1) {
        let blocks: Vec<&str> = rest.split("```").step_by(2).map(str::trim_start).collect();
        let told = blocks.windows(2).filter_map(|pair| Some((pair[0].trim(), pair[1].strip_prefix("text\n")?)));
        let told: Vec<(&str, &str)> = told.filter(|(command, _)| command.starts_with("holonom ")).collect();
        let [(command, answer), others @ ..] = &told[..] else { panic!("a model is followed by its command and its answer") };
        assert_eq!(*command, blocks[1].trim(), "a model is followed by its command");
        let file = command.split_whitespace().find(|word| word.ends_with(".toml")).unwrap();
        fs::write(folder.path().join(file), blocks[0]).unwrap();
        let out = answers(&folder, command, answer);
        others.iter().for_each(|(command, answer)| _ = answers(&folder, command, answer));
        if let Some(shown) = rest.split("```csv\n").nth(1) {
            let (head, rows) = csv(results(&out, &folder).join("trajectory.csv"));
            assert_shows(shown.split("```").next().unwrap(), &head, &rows);
        }
        count += 1;
    }
    assert_eq!(count, 8);
}

/// The gallery page shows and names every model of the gallery.
#[test]
fn the_gallery_page_is_complete() {
    let page = chapter("gallery.md");
    for entry in fs::read_dir(root().join("examples")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let picture = format!("figures/gallery/{name}.png");
            assert!(page.contains(&format!("holonom run example:{name}")) && page.contains(&picture), "{name}");
            assert!(root().join("docs").join(&picture).exists(), "{picture}");
        }
    }
}

/// A joint is a page: prints the lines of code and of words of each file (`--nocapture` shows them).
#[test]
fn a_joint_is_one_short_file() {
    let folder = root().join("crates/holonom/src/model/joints");
    for kind in kinds() {
        let file = folder.join(format!("{}.rs", kind.name.replace('-', "_")));
        let text = fs::read_to_string(&file).unwrap();
        let (mut code, mut words, mut in_kind) = (0, 0, false);
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            in_kind |= line.starts_with("#[kind(");
            if in_kind || line.starts_with("//") || line.starts_with("#[key(") {
                words += 1
            } else {
                code += 1
            }
            in_kind &= line != ")]";
        }
        println!("{:20} {code:3} lines of code, {words:3} of names, words, equations, keys and example", kind.name);
        assert!(code <= 80, "{} has {code} lines of code", file.display());
    }
}

/// What the chapters on sweeps and comparisons tell to type for examples runs as it stands there.
#[test]
fn commands_on_sweeps_and_comparisons_run() {
    let folder = folder();
    for name in ["sweep.md", "compare.md"] {
        let chapter = chapter(name);
        let commands: Vec<&str> = chapter.lines().filter(|line| line.starts_with("holonom ") && line.contains(" example:")).collect();
        assert!(!commands.is_empty(), "docs/{name} has no command");
        for command in commands {
            let words = command.strip_prefix("holonom ").unwrap();
            let mut process = std::process::Command::new("sh");
            // Shorter than in the book, where that says nothing of it.
            let end = if words.contains("--end") || words.contains("at(") { "" } else { " --end 0.2" };
            let program = assert_cmd::cargo::cargo_bin("holonom");
            let output = process.current_dir(&folder).args(["-c", &format!("\"{}\" {words}{end}", program.display())]).output().unwrap();
            assert!(output.status.success(), "docs/{name}: {command}\n{}", text(&output.stderr));
        }
    }
}

/// The README's crank: what it prints is what a run prints, and the torque of the motor follows from the kinetic energy E over the angle:
/// T = dE/dθ, as the speed is constant.
#[test]
fn the_crank_of_the_readme_answers_its_question() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let (_, crank) = readme.split_once("\n## A machine and its question\n").unwrap();
    let block = |fence: &str| crank.split_once(&format!("\n{fence}\n")).unwrap().1.split("```").next().unwrap();
    let folder = folder();
    fs::write(folder.path().join("crank.toml"), block("```toml")).unwrap();
    let out = prints(&folder, "run crank.toml --no-report", 0);
    let told = block("`holonom run crank.toml` answers before it says anything of itself:\n```");
    assert!(told.lines().count() > 5 && out.starts_with(told), "{told}\n{out}");

    let (r, l, omega) = (0.1_f64, 0.4_f64, 1500.0 * std::f64::consts::TAU / 60.0);
    // Σ m (dr/dθ)² + I (dφ/dθ)², with sin φ = r/l sin θ.
    let reduced = |theta: f64| {
        let (sine, cosine) = theta.sin_cos();
        let tilt = (r / l * sine).asin();
        let turn = r * cosine / (l * tilt.cos());
        let rod = [-r * sine - 0.5 * l * tilt.sin() * turn, r * cosine - 0.5 * l * tilt.cos() * turn];
        let piston = -r * sine - l * tilt.sin() * turn;
        let inertia = |mass: f64, length: f64| mass * length * length / 12.0;
        inertia(1.2, r)
            + 1.2 * r * r / 4.0
            + 0.8 * (rod[0] * rod[0] + rod[1] * rod[1])
            + inertia(0.8, l) * turn * turn
            + 2.0 * piston * piston
    };
    let (header, rows) = csv(folder.path().join("results/crank-conserving-ggl/trajectory.csv"));
    let effort = header.split(',').position(|name| name == "motor.effort").unwrap();
    let largest = rows.iter().map(|row| row[effort].abs()).fold(0.0, f64::max);
    for row in &rows {
        let (theta, d) = (omega * row[0], 1e-4);
        let torque = 0.5 * omega * omega * (reduced(theta + d) - reduced(theta - d)) / (2.0 * d);
        // The difference is off by d²/6 of a third derivative, some 1e-8 of the torque.
        assert!((row[effort] - torque).abs() < 1e-7 * largest, "{} s: {} and not {torque}", row[0], row[effort]);
    }
    assert!((largest - 389.08).abs() < 5e-3, "{largest}");
}
