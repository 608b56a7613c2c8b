//! What people get to read when something is wrong with a model file.
//!
//! Each `wrong/NAME.toml` has its whole message in `wrong/NAME.txt`. `HOLONOM_BLESS=1 cargo test -p holonom-io --test wrong`
//! writes the messages anew; read them before they are kept.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use holonom::model::{Kind, constraints, drives, forces, joints};
use holonom::simulation::{Choice, Method, Simulation};
use holonom_io::{DEEPEST, LARGEST_FILE, Source};

/// Longest time to refuse a file that is not worth parsing.
const PROMPT: Duration = Duration::from_millis(500);

/// Mutations of each example of the gallery, and of that of each kind.
const MUTATIONS: [usize; 2] = [300, 60];

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(name)
}

/// Model files of a folder, in order.
fn models(name: &str) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> = fs::read_dir(folder(name)).expect(name).map(|entry| entry.expect(name).path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    paths
}

fn file_name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).expect("names of test files are plain")
}

/// What is wrong with a file, if anything. The meshes that it names are beside the wrong models.
fn refusal(name: &str, bytes: &[u8]) -> Option<String> {
    Source::read(name, bytes).and_then(|source| source.beside(Path::new("tests/wrong")).model()).err()
}

/// Name and text of the gallery's examples, and of those of all kinds.
fn examples() -> [Vec<(String, String)>; 2] {
    let gallery = models("../../examples").into_iter().map(|path| (file_name(&path).to_string(), fs::read_to_string(&path).expect("text")));
    let kinds = constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS);
    [gallery.collect(), kinds.map(|kind: &Kind| (format!("{}.toml", kind.name), kind.example.to_string())).collect()]
}

/// Every error of a message says what, where and how to put it right.
fn assert_complete(name: &str, message: &str) {
    assert!(message.starts_with("error: "), "{name}: no error in {message:?}");
    for error in message.split("error: ").skip(1) {
        let lines: Vec<&str> = error.lines().collect();
        assert!(!lines[0].trim().is_empty(), "{name}: nothing is said in\n{error}");
        let place = lines.iter().find_map(|line| line.trim_start().strip_prefix("--> ")).unwrap_or_default();
        let numbers = place.strip_prefix(name).and_then(|rest| rest.strip_prefix(':')).unwrap_or_default();
        let mut numbers = numbers.split([':', ' ']).map(str::parse::<usize>);
        let placed = matches!((numbers.next(), numbers.next()), (Some(Ok(1..)), Some(Ok(1..))));
        assert!(placed, "{name}: no file, line and column in\n{error}");
        let cure = lines.iter().find_map(|line| line.trim_start().strip_prefix("= cure: "));
        assert!(cure.is_some_and(|cure| !cure.trim().is_empty()), "{name}: no cure in\n{error}");
    }
}

#[test]
fn wrong_files_have_the_messages_that_are_written_down() {
    let bless = std::env::var_os("HOLONOM_BLESS").is_some_and(|value| value == "1");
    let paths = models("tests/wrong");
    assert!(paths.len() >= 200, "only {} files", paths.len());
    let mut different = Vec::new();
    for path in paths {
        let name = file_name(&path);
        let message = refusal(name, &fs::read(&path).expect(name)).unwrap_or_else(|| panic!("{name} is taken for a sound model"));
        let written = path.with_extension("txt");
        if bless {
            fs::write(&written, &message).expect(name);
        } else if fs::read_to_string(&written).unwrap_or_default() != message {
            different.push(format!("{name} now says\n{message}"));
        }
    }
    assert!(different.is_empty(), "{}\n{} messages differ from what is written down", different.join("\n"), different.len());
}

#[test]
fn every_message_has_file_line_column_and_cure() {
    for path in models("tests/wrong") {
        let name = file_name(&path);
        let message = refusal(name, &fs::read(&path).expect(name)).unwrap_or_else(|| panic!("{name} is taken for a sound model"));
        assert_complete(name, &message);
    }
}

#[test]
fn no_message_is_without_its_file() {
    for path in models("tests/wrong") {
        let written = path.with_extension("txt");
        assert!(written.is_file(), "{} is missing", written.display());
    }
    for entry in fs::read_dir(folder("tests/wrong")).expect("the folder is there") {
        let path = entry.expect("the folder can be read").path();
        // The folder has the files that models name.
        assert!(path.is_dir() || path.with_extension("toml").is_file(), "{} has no model file", path.display());
    }
}

#[test]
fn several_faults_are_reported_at_once() {
    let text = fs::read(folder("tests/wrong/several-faults.toml")).expect("it is there");
    let message = refusal("several-faults.toml", &text).expect("it is wrong");
    for word in ["`plane` cannot be", "positoin", "ends too early", "type \"dist\"", "simulation.step", "`methd`", "`outputs`"] {
        assert!(message.contains(word), "{word} is missing in\n{message}");
    }
}

/// Refuses a file at once, with a short message that says `word`.
fn assert_prompt(name: &str, bytes: &[u8], word: &str) {
    let start = Instant::now();
    let message = refusal(name, bytes).expect(name);
    let took = start.elapsed();
    assert!(took < PROMPT, "{name} took {took:?}");
    assert!(message.contains(word) && message.len() < 1000, "{message}");
    assert_complete(name, &message);
}

#[test]
fn files_too_large_are_refused_without_parsing() {
    assert_prompt("brackets.toml", &vec![b'['; 100_000_000], "MB");
    let mut large = b"schema = 1\n".repeat(20 * 1024 * 1024 / 11);
    assert_prompt("large.toml", &large, "MB");
    // Just small enough to be looked at, and still refused before it is parsed.
    large.truncate(LARGEST_FILE - DEEPEST - 1);
    large.resize(LARGEST_FILE, b'[');
    assert_prompt("deep.toml", &large, "nested");
    assert_prompt("brackets.toml", &vec![b'['; LARGEST_FILE], "nested");
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let every: Vec<u8> = (0..=255).collect();
    assert_prompt("bytes.toml", &every, "not text");
    assert_prompt("program.toml", b"\x7fELF\x02\x01\x01\x00\x00\xff\xfe\x90", "not text");
    assert_prompt("utf16.toml", b"\xff\xfes\x00c\x00h\x00e\x00m\x00a\x00", "not text");
    assert_prompt("second-line.toml", b"schema = 1\ntitle = \"\xe9\"\n", "not text");
    let message = refusal("second-line.toml", b"schema = 1\ntitle = \"\xe9\"\n").expect("no text");
    assert!(message.contains("second-line.toml:2:10"), "{message}");
}

#[test]
fn white_space_alone_is_an_empty_file() {
    for text in ["", "\n", " \t\r\n\n"] {
        let message = refusal("white.toml", text.as_bytes()).expect("no model");
        assert!(message.contains("empty"), "{message}");
        assert_complete("white.toml", &message);
    }
}

/// Numbers that look random and are the same in every run (xorshift64).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    fn below(&mut self, end: usize) -> usize {
        (self.next() % end.max(1) as u64) as usize
    }
}

/// Changes, removes or repeats something.
fn mutate(bytes: &mut Vec<u8>, random: &mut Random) {
    /// Bytes that mean something in a model file.
    const TELLING: &[u8] = b"[]{}\"'=.,#\n\r\t \\-+*/^()0129eEintxy\xff\x00\xc3";
    let at = random.below(bytes.len());
    match random.below(6) {
        0 if !bytes.is_empty() => bytes[at] = random.next() as u8,
        1 if !bytes.is_empty() => bytes[at] = TELLING[random.below(TELLING.len())],
        2 => bytes.insert(at, TELLING[random.below(TELLING.len())]),
        3 => {
            let end = (at + 1 + random.below(20)).min(bytes.len());
            bytes.drain(at.min(end)..end);
        }
        4 => duplicate_line(bytes, random),
        _ => bytes.truncate(if random.below(10) == 0 { at } else { bytes.len() }),
    }
}

fn duplicate_line(bytes: &mut Vec<u8>, random: &mut Random) {
    let lines: Vec<Vec<u8>> = bytes.split_inclusive(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
    if lines.is_empty() {
        return;
    }
    let (from, to) = (random.below(lines.len()), random.below(lines.len()));
    let mut changed = lines.clone();
    changed.insert(to, lines[from].clone());
    *bytes = changed.concat();
}

#[test]
fn mutated_examples_never_panic_and_their_messages_are_complete() {
    for (examples, mutations) in examples().iter().zip(MUTATIONS) {
        assert!(!examples.is_empty());
        let mut refused = 0;
        for (name, original) in examples {
            assert_eq!(refusal(name, original.as_bytes()), None);
            let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ original.len() as u64);
            for k in 0..mutations {
                let mut bytes = original.clone().into_bytes();
                for _ in 0..=random.below(4) {
                    mutate(&mut bytes, &mut random);
                }
                let outcome = catch_unwind(AssertUnwindSafe(|| refusal(name, &bytes)));
                let shown = String::from_utf8_lossy(&bytes);
                let message = outcome.unwrap_or_else(|_| panic!("mutation {k} of {name} panics:\n{shown}"));
                if let Some(message) = message {
                    refused += 1;
                    assert_complete(name, &message);
                }
            }
        }
        assert!(2 * refused > examples.len() * mutations, "only {refused} mutations were refused: too tame");
    }
}

/// In a test of its own, as systems have their own words for it.
#[test]
fn meshes_that_are_missing_are_named() {
    let text = b"[body.crank]\nmass = 1\nshape = { mesh = \"nowhere.stl\" }\nposition = [0, 0, 0]\n";
    let message = refusal("missing.toml", text).expect("there is no mesh");
    assert!(message.contains("nowhere.stl cannot be read") && message.contains("missing.toml:3:18 (body.crank.shape.mesh)"), "{message}");
    assert_complete("missing.toml", &message);
}

/// Files that are read without a fault, but whose bodies cannot be put together or cannot move as they are told.
#[test]
fn models_that_cannot_start_name_what_contradicts() {
    let crank = "[body.crank]\nmass = 1\ninertia = [0.1, 0.2, 0.25]\nposition = [0.5, 0, 0]\npoints = { tip = [0.5, 0, 0] }\n\
                 [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n";
    let drive = |name: &str, profile: &str| format!("[drive.{name}]\ntype = \"angle\"\njoint = \"hinge\"\nprofile = \"{profile}\"\n");
    let driven_and_welded = format!("{crank}{}[joint.weld]\ntype = \"fixed\"\nbetween = [\"ground\", \"crank\"]\n", drive("motor", "t"));
    // A rod of one metre between the crank's tip and a pin three metres away from it.
    let rod = "[body.rod]\nmass = 1\ninertia = [0.1, 0.2, 0.25]\nposition = [1.5, 0, 0]\npoints = { tip = [0.5, 0, 0] }\n\
               [joint.knee]\ntype = \"spherical\"\nbetween = [\"crank\", \"rod\"]\nat = [1, 0, 0]\n\
               [joint.pin]\ntype = \"spherical\"\nbetween = [\"ground\", \"rod\"]\nat = [[4, 0, 0], \"rod.tip\"]\n";
    let open_loop = format!("{crank}{rod}");
    for (name, text, words) in [
        ("a joint driven and welded", &*driven_and_welded, &["the velocities at the start cannot meet", "`motor`", "`weld["][..]),
        ("a loop that does not close", &open_loop, &["the positions at the start miss", "worst: `", "["]),
    ] {
        let model =
            Source::read(name, text.as_bytes()).and_then(|source| source.model()).unwrap_or_else(|message| panic!("{name}: {message}"));
        let method = Method::resolve(&Choice::default()).expect("the method of choice");
        let error = Simulation::new(model.system.clone(), method, 0.01).err().unwrap_or_else(|| panic!("{name} starts")).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{name}: {error}");
    }
}
