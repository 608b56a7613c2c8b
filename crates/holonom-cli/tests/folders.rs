//! Where results go: never over those of another run.

mod common;

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;
use std::process::{Child, Command as Process, Stdio};

use common::*;
use serde_json::Value;

const USUAL: &str = "results/spherical-compound-pendulum-conserving-ggl";

/// Every file of a folder with its bytes, but for what tells when the run was, how it was typed and what it took.
fn content(path: &Path) -> Vec<(String, Vec<u8>)> {
    let without_time = |name: &str, bytes: Vec<u8>| {
        if !["summary.json", "checkpoint.json"].contains(&name) {
            return bytes;
        }
        let mut value: Value = serde_json::from_slice(&bytes).unwrap();
        value["provenance"]["date"].take();
        value["provenance"]["command"].take();
        value["time"].take();
        value.to_string().into_bytes()
    };
    let files = files(path).into_iter().filter(|name| name != "report.html");
    files.map(|name| (name.clone(), without_time(&name, fs::read(path.join(&name)).unwrap()))).collect()
}

#[test]
fn the_same_run_goes_to_the_same_folder_and_another_to_another() {
    let folder = folder();
    let model = prints(&folder, &format!("examples {}", PAPER.trim_start_matches("example:")), 0);
    fs::write(folder.path().join("pendulum.toml"), &model).unwrap();
    let first = folder.path().join("results/pendulum-conserving-ggl");
    let out = prints(&folder, "run pendulum.toml --end 0.5", 0);
    assert!(out.ends_with("results in results/pendulum-conserving-ggl\n"), "{out}");
    let before = content(&first);
    assert_eq!(before.len(), 4);
    // Another way to say the same.
    prints(&folder, "run pendulum.toml --set simulation.end=0.50 --set simulation.step=0.025 --quiet", 0);
    prints(&folder, "run pendulum.toml --set simulation.step=0.025 --end 0.5 --quiet", 0);
    assert_eq!(files(folder.path().join("results")), names(&["pendulum-conserving-ggl"]));
    let changed = |name: &str| name == "summary.json" || name == "checkpoint.json";
    let numbers = |content: &[(String, Vec<u8>)]| -> Vec<_> { content.iter().filter(|(name, _)| !changed(name)).cloned().collect() };
    assert_eq!(numbers(&before), numbers(&content(&first)));
    prints(&folder, "run pendulum.toml --end 0.5", 0);
    assert_eq!(before, content(&first));

    for (number, words) in (2..).zip([
        "--end 1",
        "--end 0.5 --step 0.05",
        "--end 0.5 --every 2",
        "--end 0.5 --set point.m1.mass=2",
        "--end 0.5 --set simulation.subdivide=false",
    ]) {
        let output = holonom(&folder, &format!("run pendulum.toml {words}"));
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        let chosen = format!("results/pendulum-conserving-ggl-{number}");
        assert!(out.ends_with(&format!("results in {chosen}\n")), "{words}\n{out}");
        assert_eq!(err, format!("note: results/pendulum-conserving-ggl holds another run; this one goes to {chosen}\n"), "{words}");
        assert!(holonom(&folder, &format!("run pendulum.toml {words} --quiet")).stderr.is_empty());
    }
    fs::write(folder.path().join("pendulum.toml"), model.replace("title", "# Another model.\ntitle")).unwrap();
    prints(&folder, "run pendulum.toml --end 0.5 --quiet", 0);
    assert_eq!(files(folder.path().join("results")).len(), 7);
    assert_eq!(before, content(&first));
    // Another method has a name of its own.
    prints(&folder, "run pendulum.toml --end 0.5 --method lagrange-2/bdf-3/velocity --quiet", 0);
    assert!(folder.path().join("results/pendulum-lagrange-2-bdf-3-velocity/summary.json").exists());
    // Levels of projections are joined by either sign.
    prints(&folder, "run pendulum.toml --end 0.5 --method lagrange-3/trapezoidal/velocity,acceleration --quiet", 0);
    assert!(folder.path().join("results/pendulum-lagrange-3-trapezoidal-velocity+acceleration/summary.json").exists());
}

#[test]
fn a_mesh_that_was_changed_makes_another_run() {
    let folder = folder();
    let solid = |size: u32| format!("v 0 0 0\nv {size} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let model = "[body.b]\nposition = [0, 0, 0]\ndensity = 1000\nshape = { mesh = \"part.obj\" }\n[simulation]\nstep = 0.1\nend = 0.2\n";
    fs::write(folder.path().join("model.toml"), model).unwrap();
    for size in [1, 2, 1] {
        fs::write(folder.path().join("part.obj"), solid(size)).unwrap();
        prints(&folder, "run model.toml --quiet --no-report", 0);
    }
    assert_eq!(files(folder.path().join("results")), names(&["model-conserving-ggl", "model-conserving-ggl-2"]));
}

#[test]
fn a_folder_that_was_asked_for_is_overwritten_by_force_only() {
    let folder = folder();
    let out = folder.path().join("a");
    prints(&folder, &format!("run {PAPER} --end 0.5 --quiet --out a --format npz --format csv"), 0);
    fs::write(out.join("mine.txt"), "mine").unwrap();
    let before = content(&out);
    for words in
        ["run --end 1", "compare --end 0.5 --method conserving-ggl", "stability --end 0.5 --method radau", "sweep --vary point.m1.mass=1,2"]
    {
        let (command, options) = words.split_once(' ').unwrap();
        let message = fails(&folder, &format!("{command} {PAPER} {options} --out a"), 2);
        for told in ["a holds the results of another run: holonom run example:spherical", "--force"] {
            assert!(message.contains(told), "{told}\n{message}");
        }
        assert_eq!(before, content(&out), "{words}");
    }
    prints(&folder, &format!("run {PAPER} --end 0.5 --quiet --out a --no-report"), 0);
    assert!(out.join("report.html").exists() && out.join("trajectory.npz").exists(), "the same results stay");
    // What is left of the other run would be taken for this one's.
    prints(&folder, &format!("run {PAPER} --end 1 --quiet --out a --no-report --force"), 0);
    assert_eq!(files(&out), names(&["checkpoint.json", "columns.json", "mine.txt", "summary.json", "trajectory.csv"]));
    assert_eq!(csv(out.join("trajectory.csv")).1.last().unwrap()[0], 1.0);
    prints(&folder, &format!("compare {PAPER} --end 0.1 --method radau --method ggl/bdf-2 --quiet --out a --force"), 0);
    assert!(out.join("ggl-bdf-2.csv").exists() && !out.join("trajectory.csv").exists());
    prints(&folder, &format!("stability {PAPER} --end 0.5 --method radau --quiet --out a --force --no-report"), 0);
    assert_eq!(files(&out), names(&["mine.txt", "stability.json"]));
    prints(&folder, &format!("sweep {PAPER} --end 0.1 --vary point.m1.mass=1,2 --quiet --out a --force"), 0);
    assert!(!out.join("stability.json").exists() && out.join("sweep.csv").exists());
    prints(&folder, &format!("sweep {PAPER} --end 0.1 --vary point.m1.mass=1,3 --quiet --out a --force"), 0);
    assert!(fs::read_to_string(out.join("sweep.csv")).unwrap().contains("\n2,3,completed"));
    assert_eq!(fs::read(out.join("mine.txt")).unwrap(), b"mine");

    // Without a name of a folder, force takes the usual one.
    for end in ["0.1", "0.2"] {
        prints(&folder, &format!("run {PAPER} --end {end} --quiet --force"), 0);
    }
    assert_eq!(files(folder.path().join("results")).len(), 1);
    assert_eq!(csv(folder.path().join(USUAL).join("trajectory.csv")).1.last().unwrap()[0], 0.2);
}

#[test]
fn results_that_do_not_say_where_they_come_from_are_another_run() {
    let folder = folder();
    let usual = folder.path().join(USUAL);
    fs::create_dir_all(&usual).unwrap();
    for name in ["summary.json", "checkpoint.json", "trajectory.csv"] {
        fs::write(usual.join(name), "{}").unwrap();
        prints(&folder, &format!("run {PAPER} --end 0.1 --quiet"), 0);
        assert_eq!((files(&usual), fs::read(usual.join(name)).unwrap()), (names(&[name]), b"{}".to_vec()));
        fs::remove_file(usual.join(name)).unwrap();
    }
    prints(&folder, &format!("run {PAPER} --end 0.1 --quiet"), 0);
    assert!(usual.join("summary.json").exists(), "an empty folder is free");
}

#[test]
fn comparisons_searches_and_sweeps_have_folders_of_their_own_too() {
    let folder = folder();
    for (command, ways) in [
        ("compare", ["--method radau", "--method radau --step 0.05"]),
        ("stability", ["--method radau", "--method radau --method conserving"]),
        ("sweep", ["--vary point.m1.mass=1,2", "--vary point.m1.mass=1,3"]),
    ] {
        let run = |way: &str| prints(&folder, &format!("{command} {PAPER} --end 0.2 {way}"), 0);
        let usual = format!("results/spherical-compound-pendulum-{command}");
        for (way, path) in
            [(ways[0], usual.clone()), (ways[1], format!("{usual}-2")), (ways[0], usual.clone()), (ways[1], format!("{usual}-2"))]
        {
            let out = run(way);
            assert!(out.ends_with(&format!("results in {path}\n")), "{command} {way}\n{out}");
        }
    }
    assert_eq!(files(folder.path().join("results")).len(), 6);
}

#[test]
fn the_commands_of_the_chapter_on_results_run() {
    let folder = folder();
    let chapter = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/results.md")).unwrap();
    let commands: Vec<&str> =
        chapter.lines().filter(|line| line.starts_with("holonom run ")).filter_map(|line| line.strip_prefix("holonom ")).collect();
    let printed: Vec<String> = commands.iter().map(|words| prints(&folder, words, 0)).collect();
    let told: Vec<&str> = printed.iter().map(|out| out.trim_end().rsplit_once(' ').unwrap().1).collect();
    assert_eq!(told, ["results/four-bar-conserving-ggl", "results/four-bar-conserving-ggl-2", "long", "long"]);
    let refused = fails(&folder, &format!("{} --set parameters.N=2", commands[3].replace("--end 2", "--end 3")), 2);
    assert!(chapter.contains(&format!("```text\n{refused}```\n")), "{refused}");
    // The table of files has all that there are.
    prints(&folder, "run example:four-bar --end 0.1 --quiet --format npz --out b", 0);
    for name in files(folder.path().join("long")).iter().chain(&files(folder.path().join("b"))).filter(|name| !name.ends_with(".npz")) {
        assert!(chapter.contains(&format!("\n| `{name}` |")), "{name}");
    }
}

/// Runs that begin at the same moment find each other's folders free.
#[test]
fn runs_at_the_same_time_do_not_meet() {
    let folder = folder();
    let run = |mass: u32| -> Child {
        let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
        process.current_dir(&folder).args(["run", PAPER, "--end", "2", "--no-report", "--set", &format!("point.m1.mass={mass}")]);
        process.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    };
    let mut runs: Vec<Child> = (1..=6).map(run).collect();
    runs.iter_mut().for_each(|run| assert!(run.wait().unwrap().success()));
    let results = folder.path().join("results");
    let masses = files(&results).into_iter().map(|name| read_json(results.join(name).join("summary.json")));
    let masses: BTreeSet<u64> = masses.map(|summary| summary["provenance"]["overrides"][0]["run"].as_u64().unwrap()).collect();
    assert_eq!(masses, (1..=6).collect());
}
