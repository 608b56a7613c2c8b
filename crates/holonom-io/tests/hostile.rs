//! Files that nobody should have written, deep or full of faults: they are refused soon, and in short.

use std::time::{Duration, Instant};

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
