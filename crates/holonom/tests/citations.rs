//! Every citation in the sources and in the book leads somewhere: to a numbered section of `docs/methods.md`, to an entry of its
//! bibliography, or to an equation of García Orden and Dopico (2007).

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use regex_lite::Regex;

/// The last equation of García Orden and Dopico (2007).
const LAST_EQUATION: u32 = 30;

/// How far before a section the source that it belongs to is looked for, characters.
const NEAR: usize = 80;

/// A file with the lines of each comment joined, as citations go over their ends.
struct Source {
    path: PathBuf,
    all: String,
    comments: String,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn files(folder: &Path, ending: &str, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("the entry can be read").path();
        if path.is_dir() {
            files(&path, ending, found);
        } else if path.extension().is_some_and(|it| it == ending) && !path.ends_with("citations.rs") {
            found.push(path);
        }
    }
}

fn sources() -> Vec<Source> {
    let mut paths = vec![root().join("README.md"), root().join("ARCHITECTURE.md"), root().join("CONTRIBUTING.md")];
    files(&root().join("docs"), "md", &mut paths);
    files(&root().join("crates"), "rs", &mut paths);
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("the file can be read");
        let is_book = path.extension().is_some_and(|it| it == "md");
        let (mut all, mut comments) = (String::new(), String::new());
        for line in text.lines().map(str::trim).take_while(|line| !line.ends_with(" Bibliography")) {
            let said = line.trim_start_matches(['/', '!']).trim_start();
            all.extend([said, " "]);
            if is_book || line.starts_with("//") {
                comments.extend([said, " "]);
            }
        }
        Source { path, all, comments }
    };
    paths.into_iter().map(read).collect()
}

/// What stands before a place, as far as it is near.
fn before(text: &str, at: usize) -> &str {
    let start = text[..at].char_indices().rev().nth(NEAR).map_or(0, |(k, _)| k);
    &text[start..at]
}

#[test]
fn citations_lead_somewhere() {
    let methods = fs::read_to_string(root().join("docs/methods.md")).expect("the book is there");
    let heading = Regex::new(r"(?m)^##+ (\d+(?:\.\d+)?) ").unwrap();
    let sections: BTreeSet<&str> = heading.captures_iter(&methods).map(|found| found.get(1).unwrap().as_str()).collect();
    let entry = Regex::new(r"(?m)^- ([^:\n]+ \d{4}): ").unwrap();
    let bibliography: BTreeSet<&str> = entry.captures_iter(&methods).map(|found| found.get(1).unwrap().as_str()).collect();
    assert!(sections.len() > 15 && bibliography.len() > 15, "{sections:?} {bibliography:?}");

    let section = Regex::new(r"§(\d+(?:\.\d+)?|[IVX]+\.\d+)").unwrap();
    let of_methods = Regex::new(r"methods (?:§[\d.]+, )*$").unwrap();
    let name = r"(?:García Orden|García de Jalón|Van Loan|[A-ZÀ-Ž][a-zà-ž]+(?:[A-Z][a-z]+)?)";
    let work = Regex::new(&format!(r"({name}(?:, {name})*(?: and {name})?),? \(?((?:19|20)\d\d)\b")).unwrap();
    let equation = Regex::new(r"[^§\w]\((\d{1,2})\)").unwrap();

    let (mut lost, mut cited) = (Vec::new(), BTreeSet::new());
    for Source { path, all, comments } in sources() {
        let mut report = |what: &str| lost.push(format!("{}: {what}", path.display()));
        for found in work.captures_iter(all.as_str()) {
            let key = format!("{} {}", &found[1], &found[2]);
            match bibliography.get(key.as_str()) {
                Some(key) => _ = cited.insert(*key),
                None => report(&format!("{key} is not in the bibliography")),
            }
        }
        for found in section.captures_iter(all.as_str()) {
            let at = found.get(0).unwrap();
            let (near, behind) = (before(&all, at.start()), &all[at.end()..]);
            let of_source = near.contains("paper") || behind.starts_with(" of the paper") || work.is_match(near);
            if of_methods.is_match(near) && !sections.contains(&found[1]) || !of_methods.is_match(near) && !of_source {
                report(&format!("{} leads nowhere", at.as_str()));
            }
        }
        for found in equation.captures_iter(comments.as_str()) {
            let number: u32 = found[1].parse().unwrap();
            if number > LAST_EQUATION {
                report(&format!("there is no equation ({number})"));
            }
        }
    }
    lost.extend(bibliography.difference(&cited).map(|key| format!("nothing cites {key}")));
    assert!(lost.is_empty(), "{}", lost.join("\n"));
}
