//! `holonom run --resume` of what was killed, interrupted, or could not be written.

mod common;

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::{Child, Command as Process, Stdio};
use std::time::{Duration, Instant};

use common::*;
use serde_json::Value;

/// Starts a run that takes long and waits until it has been saved and has come beyond `t` (s).
fn at_work(folder: &Path, words: &str, t: f64) -> Child {
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let child = process.current_dir(folder).arg("run").args(words.split_whitespace()).spawn().unwrap();
    let begun = Instant::now();
    let is_beyond = || reached(&folder.join("a")).is_some_and(|reached| reached > t);
    while !is_beyond() && begun.elapsed() < Duration::from_secs(120) {
        std::thread::sleep(Duration::from_millis(20));
    }
    child
}

/// The time of the checkpoint in a folder, s.
fn reached(folder: &Path) -> Option<f64> {
    let value: Value = serde_json::from_slice(&fs::read(folder.join("checkpoint.json")).ok()?).unwrap();
    value["state"]["t"].as_f64()
}

/// As where a run is interrupted that was interrupted later before.
/// A kill may come after the last step.
#[test]
fn a_run_that_was_killed_before_its_results_were_written_writes_them() {
    let folder = folder();
    for (words, without) in [("--end 2", "summary.json"), ("--end 0.33 --format npz", "trajectory.npz")] {
        let run = |more: &str| prints(&folder, &format!("run {PAPER} {words} --quiet {more}"), 0);
        let [parts, whole] = ["parts", "whole"].map(|name| format!("{name}-of-{without}"));
        run(&format!("--out {parts}"));
        run(&format!("--out {whole}"));
        for name in ["summary.json", "report.html", without] {
            let _ = fs::remove_file(folder.path().join(&parts).join(name));
        }
        fs::write(folder.path().join(&parts).join("report.html.new"), "<html").unwrap();
        run(&format!("--resume {parts}"));
        assert_same(&folder.path().join(&parts), &folder.path().join(&whole), words);
    }
}

/// Files that may not grow beyond a size stand for a full disk.
#[cfg(unix)]
#[test]
fn a_resumed_run_that_cannot_be_written_leaves_the_rows_up_to_its_checkpoint() {
    let folder = folder();
    let run = |more: &str| prints(&folder, &format!("run {PAPER} --quiet {more}"), 0);
    run("--end 1 --out a");
    let out = folder.path().join("a");
    let (table, checkpoint) = (fs::read(out.join("trajectory.csv")).unwrap(), fs::read(out.join("checkpoint.json")).unwrap());
    // The limit is in blocks of 512 bytes, and ends within the rows to come.
    let command = format!(
        "trap '' XFSZ; ulimit -f {}; exec {} run {PAPER} --quiet --end 3 --resume a",
        table.len() / 512 + 8,
        env!("CARGO_BIN_EXE_holonom")
    );
    let output = Process::new("sh").current_dir(&folder).args(["-c", &command]).output().unwrap();
    let message = text(&output.stderr);
    assert!(output.status.code().is_some_and(|code| code != 0) && message.contains("cannot write"), "{message}");
    assert_eq!(files(&out), names(&["checkpoint.json", "columns.json", "trajectory.csv"]));
    assert!(fs::read(out.join("trajectory.csv")).unwrap() == table && fs::read(out.join("checkpoint.json")).unwrap() == checkpoint);
    run("--end 3 --resume a");
    run("--end 3 --out whole");
    assert_same(&out, &folder.path().join("whole"), "after a full disk");
}

#[test]
fn a_shorter_part_of_a_run_does_not_replace_a_longer_one() {
    let folder = folder();
    let out = folder.path().join("a");
    prints(&folder, &format!("run {PAPER} --end 1 --quiet --out a"), 0);
    let mut checkpoint = read_json(out.join("checkpoint.json"));
    checkpoint["state"]["t"] = 7.5.into();
    fs::write(out.join("checkpoint.json"), checkpoint.to_string()).unwrap();
    let content = || -> Vec<Vec<u8>> { files(&out).iter().map(|name| fs::read(out.join(name)).unwrap()).collect() };
    let before = content();
    let output = holonom(&folder, &format!("run {PAPER} --end 1 --out a"));
    assert_eq!((output.status.code(), text(&output.stderr).as_str()), (Some(0), "note: a holds the same run up to 7.5 s, which stays\n"));
    assert!(before == content());
}

#[test]
fn a_run_that_was_killed_or_interrupted_goes_on_to_the_same_bytes() {
    let folder = folder();
    let out = folder.path().join("a");
    let words = format!("{PAPER} --every 50 --quiet --no-report --set simulation.step=0.01");
    let long = "--end 1e9";
    let mut child = at_work(folder.path(), &format!("{words} {long} --out a"), 0.0);
    // While it is at work nobody else goes on from there, or writes there.
    for other in ["--resume a", "--out a --force"] {
        assert!(fails(&folder, &format!("run {words} {long} {other}"), 2).contains("another run is writing to a"));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(files(&out), names(&["checkpoint.json", "columns.json", "trajectory.csv"]));
    let killed = reached(&out).unwrap();
    // A run from the start may take the folder, but as long as it is behind, what is there stays.
    let before = fs::read(out.join("checkpoint.json")).unwrap();
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let again = format!("run {words} {long} --out a").replace("--quiet ", "");
    let mut child =
        process.current_dir(&folder).args(again.split_whitespace()).stderr(Stdio::piped()).stdout(Stdio::null()).spawn().unwrap();
    let mut note = String::new();
    BufReader::new(child.stderr.take().unwrap()).read_line(&mut note).unwrap();
    assert!(
        note.starts_with("note: a holds this run up to ") && note.ends_with("where it was killed; --resume a goes on from there\n"),
        "{note}"
    );
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(before, fs::read(out.join("checkpoint.json")).unwrap());

    // Every whole line can be read, and a kill may tear the last one.
    let mut table = fs::read(out.join("trajectory.csv")).unwrap();
    assert!(table.iter().filter(|&&byte| byte == b'\n').count() as f64 > killed / 0.5);
    table.extend(b"1.5,2.");
    fs::write(out.join("trajectory.csv"), table).unwrap();

    let mut child = at_work(folder.path(), &format!("{words} {long} --resume a"), killed);
    Process::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(3));
    assert_eq!(read_json(out.join("summary.json"))["status"], "stopped");
    let interrupted = reached(&out).unwrap();
    assert!(interrupted > killed && killed > 0.0);

    let end = interrupted.ceil() + 5.0;
    prints(&folder, &format!("run {words} --end {end} --resume a"), 0);
    prints(&folder, &format!("run {words} --end {end} --out whole"), 0);
    assert_same(&out, &folder.path().join("whole"), "killed");
}
