//! Files that nobody should have written, deep or full of faults: they are refused soon, and in short.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};

use holonom::model::{Kind, constraints, drives, forces, joints};
use holonom::simulation::{Choice, Method, Simulation};
use holonom_io::{LARGEST_FILE, Source};

/// What is said about a file, and that it is said within a time that nobody waits for.
fn told(name: &str, bytes: &[u8]) -> String {
    let start = Instant::now();
    let answer = Source::read(name, bytes).and_then(|source| source.model().map(|_| ()));
    let (taken, limit) = (start.elapsed(), Duration::from_secs(if cfg!(debug_assertions) { 10 } else { 1 }));
    assert!(taken < limit, "{name} took {taken:?}");
    answer.err().unwrap_or_else(|| panic!("{name} is not wrong"))
}

#[test]
fn deep_files_are_refused_where_they_get_deep() {
    let many = 1 << 18;
    for (name, text) in [
        ("lists", format!("a = {}", "[".repeat(many))),
        ("tables", format!("a = {}", "{a=".repeat(many))),
        ("keys", format!("{}a = 1", "a.".repeat(many))),
        ("headers", format!("[{}a]", "a.".repeat(many))),
        ("spaced-keys", format!("{}a = 1", "a . ".repeat(many))),
    ] {
        let message = told(name, text.as_bytes());
        // Brackets are counted before anything is parsed; the dots of keys by the parser.
        assert!(message.contains("nested deeper") || message.contains("recursion limit"), "{message}");
        assert!(message.contains(&format!("--> {name}:1:")), "{message}");
        assert!(message.len() < 1000, "{}", message.len());
    }
}

#[test]
fn brackets_in_texts_and_comments_are_no_nesting() {
    let comment = "# where 0 <= x < 1: [0, 1)\n".repeat(1000);
    let text = format!("{comment}title = '[[[[ {{{{'\n[point.m]\nmass = 1\nposition = [1, 0, 0]\n");
    assert!(Source::read("fine.toml", text.as_bytes()).unwrap().model().is_ok());
}

#[test]
fn large_files_full_of_faults_are_told_in_short() {
    let many = 20_000;
    let keys: String = (0..many).map(|k| format!("key{k} = {k}\n")).collect();
    let points: String = (0..many).map(|k| format!("[point.p{k}]\nmass = -1\nposition = [1]\n")).collect();
    let rods: String = (0..many).map(|k| format!("[constraint.c{k}]\ntype = \"distance\"\nbetween = [\"p{k}\", \"q{k}\"]\n")).collect();
    let circle: String = (0..many).map(|k| format!("p{k} = \"p{}\"\n", (k + 1) % many)).collect();
    for (name, text) in [("keys", keys), ("points", points), ("rods", rods), ("circle", format!("[parameters]\n{circle}"))] {
        let message = told(name, text.as_bytes());
        assert!(message.matches("error:").count() <= 101, "{name}");
    }
}

#[test]
fn the_largest_allowed_files_end_too() {
    for (name, piece) in
        [("same-keys", "a=1\n"), ("commas", ","), ("texts", "\""), ("comments", "#\n"), ("headers", "[a]\n"), ("blanks", " ")]
    {
        told(name, piece.repeat(LARGEST_FILE / piece.len()).as_bytes());
    }
}

/// Values that nobody should write: wrong in kind, in size or in number, not finite, not known.
const HOSTILE: &[&str] = &[
    "nan",
    "inf",
    "-inf",
    "0",
    "-1",
    "1e308",
    "-1e308",
    "1e200",
    "1e-200",
    "1e-320",
    "true",
    "\"\"",
    "\" \"",
    "\".\"",
    "\"..\"",
    "\"]\"",
    "\"a[\"",
    "\"a[0]\"",
    "\"ground\"",
    "\"0/0\"",
    "\"1/0\"",
    "\"t\"",
    "\"q\"",
    "\"sqrt(t - 1)\"",
    "\"1e308*t\"",
    "[]",
    "[0, 0, 0]",
    "[0, 0]",
    "[1e308, 1e308, 1e308]",
    "[1e-320, 0, 0]",
    "[nan, 0, 0]",
    "[[0, 0, 0], [0, 0, 0]]",
    "[[1, 0, 0], [-1, 0, 0]]",
    "[[1, 0], [0, 1]]",
    "[[]]",
    "[[], [], []]",
    "[\"\", \"\"]",
    "[\"ground\", \"ground\"]",
    "[{}]",
    "[{}, {}]",
    "{}",
    "{ a = 1 }",
    "{ table = [] }",
    "{ table = [[0, 0], [1e-300, 1e300]] }",
    "{ rod = 1 }",
    "{ sphere = 1e-200 }",
    "{ box = [1e200, 1, 1] }",
    "{ mesh = \"\" }",
    "{ mesh = \"..\" }",
    "{ quat_wxyz = [1e308, 0, 0, 0] }",
    "{ axis = [1e308, 0, 0], angle = 1 }",
];

/// Lines of the examples of all kinds whose value is replaced by each of the hostile ones.
#[test]
fn hostile_values_of_any_key_never_panic() {
    let list: String = std::iter::repeat_n("0, ", 2_000).collect();
    let long = format!("[{list}0]");
    let kinds = constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS);
    for kind in kinds {
        let lines: Vec<&str> = kind.example.lines().collect();
        for (k, line) in lines.iter().enumerate() {
            let Some((key, _)) = line.split_once(" = ") else { continue };
            for value in HOSTILE.iter().copied().chain([&*long]) {
                let changed = format!("{key} = {value}");
                let text: String = lines
                    .iter()
                    .enumerate()
                    .map(|(at, &line)| if at == k { &*changed } else { line })
                    .flat_map(|line| [line, "\n"])
                    .collect();
                assert!(
                    catch_unwind(AssertUnwindSafe(|| start(kind, &text))).is_ok(),
                    "`{key} = {value:.60}` panics in line {k} of\n{}",
                    kind.example
                );
            }
        }
    }
}

/// Things with names of every sort, beside those of an example.
const NAMED: &str = "[body.beside]\nmass = 1\ninertia = [1, 1, 1]\nposition = [9, 8, 7]\npoints = { tip = [1, 0, 0] }\n\
                     [point.bead]\nmass = 1\nposition = [7, 8, 9]\n\
                     [joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"beside\"]\nat = [9, 8, 7]\naxis = [0, 0, 1]\n\
                     [point.row]\nrepeat = \"i = 0 to 1\"\nmass = 1\nposition = [\"7 + i\", 8, 9]\n";

/// A body, its place and its axes, a point, a repeated one, a joint, its coordinate, time, and what is nothing.
const NAMES: &[&str] = &[
    "beside",
    "beside.tip",
    "beside.x",
    "beside.nothing",
    "beside[0]",
    "bead",
    "bead.x",
    "row",
    "row[0]",
    "row[9]",
    "pin",
    "pin.angle",
    "pin[0]",
    "q[i]",
    "t",
    "ground",
    "ground.x",
    "nothing",
];

/// Keys that refer to something, in one kind or another.
const REFERRING: &[&str] = &["at", "axis", "axes", "between", "joint", "joints", "point", "points", "body", "ends", "curve", "plane"];

/// A name of every sort in every key, those that an example leaves out included: in place of its value, and of each item.
#[test]
fn names_of_any_sort_in_any_key_never_panic() {
    let kinds = constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS);
    let mut read = 0;
    for kind in kinds.filter(|kind| !kind.example.contains("plane = ")) {
        let lines: Vec<&str> = kind.example.lines().collect();
        let last = lines.iter().rposition(|line| line.starts_with("type = ")).expect("every kind has a type");
        let there = (0..lines.len()).filter_map(|k| lines[k].split_once(" = ").map(|(key, _)| (k, key, "")));
        let left_out = REFERRING.iter().map(|&key| (last, key, lines[last]));
        for (k, key, before) in there.chain(left_out) {
            for name in NAMES {
                for value in [format!("\"{name}\""), format!("[\"{name}\", \"ground\"]"), format!("[\"ground\", \"{name}\"]")] {
                    let changed = format!("{before}\n{key} = {value}");
                    let of_example = lines.iter().enumerate().map(|(at, &line)| if at == k { &*changed } else { line });
                    let text: String = of_example.flat_map(|line| [line, "\n"]).collect::<String>() + NAMED;
                    read += 1;
                    let tried = catch_unwind(AssertUnwindSafe(|| start(kind, &text)));
                    assert!(tried.is_ok(), "`{key} = {value}` panics in line {k} of\n{text}");
                }
            }
        }
    }
    println!("{read} models");
}

/// Reads a model, and starts it where there is nothing wrong with it.
fn start(kind: &Kind, text: &str) {
    let Ok(model) = Source::read(kind.name, text.as_bytes()).and_then(|source| source.model()) else { return };
    let method = Method::resolve(&Choice::default()).expect("the method of choice");
    let _ = Simulation::new(model.system.clone(), method, 0.01);
}
