//! The command as people type it: wrong use, and what it says of models, methods and the gallery.

mod common;

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command as Process, Stdio};

use common::*;

#[test]
fn wrong_use_ends_with_two_and_says_what_there_is() {
    let folder = folder();
    let message = fails(&folder, &format!("run {PAPER} --method fast"), 2);
    NAMED.iter().for_each(|name| assert!(message.contains(name), "{message}"));
    for command in ["compare", "stability"] {
        assert!(fails(&folder, &format!("{command} {PAPER} --end 0.5 --method fast"), 2).contains("trapezoidal-projected"));
    }
    for (words, told) in [
        (format!("run {PAPER} --set simulation.step"), "no `=`"),
        (format!("run {PAPER} --set simulation.stp=1"), "did you mean `step`"),
        (format!("run {PAPER} --set title.x=1"), "not a table"),
        (format!("run {PAPER} --set simulation.step=-1"), "above 0"),
        ("run example:four-bar --set parameters.n=3".into(), "did you mean `N`"),
        ("check example:slider-crank --set body.crnk.mass=3".into(), "no body `crnk`"),
        ("check example:slider-crank --set body.crnk.mass=3".into(), "did you mean `body.crank`?"),
        ("check example:chain --set point.P[1].mass=3".into(), "set it for all of them, point.P.KEY"),
        ("check example:slider-crank --set force.spring.stiffness=3".into(), "set all of a new one: force.spring={ … }"),
        ("check example:four-bar --set parameters.stiffness=3".into(), "no parameter `stiffness`"),
        ("compare example:four-bar --set N=3".into(), "write parameters.N="),
        ("sweep example:four-bar --vary N=3,4".into(), "write parameters.N="),
        (format!("stability {PAPER} --set parameters.k=3"), "no parameter `k`"),
        (format!("run {PAPER} --step abc"), "abc"),
        (format!("run {PAPER} --end 0.5 --set simulation.integrator=euler"), "conserving-ggl"),
        (format!("run {PAPER} --set simulation.order=4 --method conserving"), "`simulation.order` is set, and --method replaces it"),
        (format!("compare {PAPER} --set simulation.order=4 --method conserving"), "--method replaces it"),
        (format!("check {PAPER} --set simulation.projection.matrix=unit"), "identity"),
        (format!("check {PAPER} --set simulation.projection.matrix=custom"), "weight"),
        ("run example:nothing".into(), "four-bar"),
        ("examples nothing".into(), "four-bar"),
        ("methods nothing".into(), "holonom methods"),
        (format!("run {PAPER} --every 0"), "--every"),
        (format!("run {PAPER} --nonsense"), "--nonsense"),
    ] {
        let message = fails(&folder, &words, 2);
        assert!(message.contains(told), "{words}\n{message}");
    }
    assert!(!folder.path().join("results").exists(), "nothing is written for wrong use");
}

#[test]
fn nothing_is_said_when_nobody_reads() {
    for word in ["methods", "examples", "schema"] {
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = Process::new(env!("CARGO_BIN_EXE_holonom")).arg(word).stdout(writer).output().unwrap();
        assert!(output.stderr.is_empty(), "{word}: {}", text(&output.stderr));
    }
}

#[test]
fn a_wrong_model_is_answered_with_every_fault() {
    let folder = folder();
    let model = "[point.a]\nmas = 1\nposition = [1, 0]\n\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"b\"]\n";
    fs::write(folder.path().join("wrong.toml"), model).unwrap();
    for command in ["run", "check", "modes", "compare", "stability"] {
        let message = fails(&folder, &format!("{command} wrong.toml"), 2);
        for told in ["wrong.toml:2", "did you mean `mass`", "wrong.toml:3", "wrong.toml:7", "`b`"] {
            assert!(message.contains(told), "{told}\n{message}");
        }
    }
    fs::write(folder.path().join("broken.toml"), "[point.a\n").unwrap();
    assert!(fails(&folder, "run broken.toml", 2).contains("broken.toml:1"));
    let sound = "[point.a]\nmass = 1\nposition = [1, 0, 0]\n";
    fs::write(folder.path().join("short.toml"), sound).unwrap();
    assert!(fails(&folder, "run short.toml --end 1", 2).contains("--step"));
    assert!(fails(&folder, "run short.toml --step 0.1", 2).contains("--end"));
    assert!(fails(&folder, "run short.toml", 2).contains("neither `end` nor `step`"));
    assert!(fails(&folder, "run short.toml --accuracy 1e-6", 2).contains("no `end`"));
    assert!(fails(&folder, "run short.toml --step 0.1 --end -1", 2).contains("`end` is negative: -1"));
    prints(&folder, "run short.toml --step 0.1 --end 1", 0);
}

#[test]
fn files_that_cannot_be_used_end_with_four() {
    let folder = folder();
    fs::write(folder.path().join("file"), "").unwrap();
    for (words, told) in [
        ("run nothing.toml".to_string(), "cannot read nothing.toml"),
        ("check nothing.toml".into(), "cannot read nothing.toml"),
        (format!("run {PAPER} --end 0.1 --resume nothing.json"), "cannot read nothing.json"),
        (format!("run {PAPER} --end 0.1 --resume nothing"), "give the folder of an earlier run"),
        (format!("run {PAPER} --end 0.1 --out file/results"), "cannot create file/results"),
        (format!("compare {PAPER} --end 0.1 --method conserving --out file/results"), "cannot create file/results"),
        ("examples chain --copy file/results".into(), "cannot create file/results"),
        ("view nothing".into(), "report.html"),
    ] {
        let message = fails(&folder, &words, 4);
        assert!(message.contains(told), "{words}\n{message}");
    }
}

#[test]
fn parameters_that_nothing_uses_are_named() {
    let folder = folder();
    // `b` is used by `a` only, which nothing uses; `c` by a list, `n` by a reference and `d` through `c`.
    let model = "title = \"a and b\"\n[parameters]\na = \"2*b\"\nb = 1\nc = \"d\"\nd = 2\nn = 2\n\
                 [simulation]\nstep = 0.1\nend = 0.2\n[point.p]\nrepeat = \"i = 1 to 2\"\nmass = 1\nposition = [\"c*i\", 0, 0]\n\
                 [constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"p[n]\"]\n";
    fs::write(folder.path().join("model.toml"), model).unwrap();
    let told = "nothing uses the parameters `a`, `b`";
    let output = holonom(&folder, "run model.toml");
    assert!(text(&output.stderr).contains(&format!("note: {told}\n")), "{}", text(&output.stderr));
    assert!(prints(&folder, "check model.toml", 0).contains(told));
    assert_eq!(json(&folder, "check model.toml --json")["notes"][0], told);
    let one = holonom(&folder, "run model.toml --set gravity=[0,0,\"-a\"] --set parameters.c=3");
    assert!(text(&one.stderr).contains("nothing uses the parameter `d`\n"), "{}", text(&one.stderr));
    assert!(holonom(&folder, "run model.toml --quiet").stderr.is_empty());

    let many: String = (0..1000).map(|k| format!("a{k} = {k}\n")).collect();
    fs::write(folder.path().join("many.toml"), format!("[parameters]\n{many}[point.p]\nmass = 1\nposition = [1, 0, 0]\n")).unwrap();
    assert!(prints(&folder, "check many.toml", 0).contains("`a0`, `a1`, `a2`, `a3`, `a4`, and 995 more\n"));
}

#[test]
fn methods_are_listed_and_explained() {
    let folder = folder();
    let out = prints(&folder, "methods", 0);
    for word in NAMED.iter().chain(&["augmented-lagrangian", "penalty", "midpoint", "newton", "nested", "identity", "exact"]) {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let one = prints(&folder, "methods midpoint", 0);
    assert!(one.contains("midpoint") && !one.contains("newmark"), "{one}");
}

#[test]
fn the_gallery_is_listed_shown_copied_and_runs() {
    let folder = folder();
    let list = prints(&folder, "examples", 0);
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    for file in files(&gallery) {
        let name = file.strip_suffix(".toml").unwrap();
        assert!(list.contains(name), "{name} is not in the gallery\n{list}");
        let text = fs::read_to_string(gallery.join(&file)).unwrap();
        assert_eq!(prints(&folder, &format!("examples {name}"), 0), text);
        prints(&folder, &format!("examples {name} --copy copies"), 0);
        assert_eq!(fs::read_to_string(folder.path().join("copies").join(&file)).unwrap(), text);
        assert!(!prints(&folder, &format!("check example:{name}"), 0).contains("nothing uses"), "{name}");
        let summary = json(&folder, &format!("run copies/{file} --end 0.05 --json"));
        assert_eq!((&summary["status"], &summary["model"]), (&"completed".into(), &name.into()));
        assert!(summary["energy"]["max_drift"].as_f64().unwrap() < 1e-6, "{name}");
        let report = folder.path().join(format!("results/{name}-{}/report.html", summary["method"]["name"].as_str().unwrap()));
        assert!(report.is_file(), "{}", report.display());
    }
    fails(&folder, "examples --copy copies", 2);
}

/// A process that ends with its test.
struct Ends(Child);

impl Drop for Ends {
    fn drop(&mut self) {
        // It may have ended by itself; then there is nothing to end.
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

#[test]
fn view_serves_the_report_on_this_machine() {
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 0.1 --quiet --out a"), 0);
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let mut server = Ends(process.current_dir(&folder).args(["view", "a", "--no-browser"]).stdout(Stdio::piped()).spawn().unwrap());
    let mut line = String::new();
    BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let address = line.trim().strip_prefix("http://").unwrap_or_else(|| panic!("{line}"));
    assert!(address.starts_with("127.0.0.1:"), "{address}");
    let get = |path: &str| {
        let mut stream = TcpStream::connect(address).unwrap();
        write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").unwrap();
        let mut answer = Vec::new();
        stream.read_to_end(&mut answer).unwrap();
        text(&answer)
    };
    let (page, missing) = (get("/"), get("/summary.json"));
    assert!(page.starts_with("HTTP/1.1 200") && page.contains("text/html"), "{}", &page[..page.len().min(300)]);
    assert!(page.ends_with(&fs::read_to_string(folder.path().join("a/report.html")).unwrap()), "the page is served as it is");
    assert!(missing.starts_with("HTTP/1.1 404"), "{missing}");
}

/// A program in the folder is called as the desktop's own is.
#[cfg(target_os = "linux")]
#[test]
fn view_opens_the_browser_where_there_is_one() {
    use std::os::unix::fs::PermissionsExt;
    let folder = folder();
    prints(&folder, &format!("run {PAPER} --end 0.1 --quiet --out a"), 0);
    let (browser, opened) = (folder.path().join("xdg-open"), folder.path().join("opened"));
    fs::write(&browser, "#!/bin/sh\necho \"$1\" > opened.new && mv opened.new opened\n").unwrap();
    fs::set_permissions(&browser, fs::Permissions::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", folder.path().display(), std::env::var("PATH").unwrap());
    let mut process = Process::new(env!("CARGO_BIN_EXE_holonom"));
    let mut server = Ends(process.current_dir(&folder).env("PATH", path).args(["view", "a"]).stdout(Stdio::piped()).spawn().unwrap());
    let mut line = String::new();
    BufReader::new(server.0.stdout.take().unwrap()).read_line(&mut line).unwrap();
    let begun = std::time::Instant::now();
    while !opened.exists() && begun.elapsed() < std::time::Duration::from_secs(60) {
        std::thread::sleep(std::time::Duration::from_millis(10));
    }
    assert_eq!(fs::read_to_string(opened).unwrap(), line);
}

/// What a command that reads a model from standard input prints and says, with its exit status.
fn fed(folder: &tempfile::TempDir, model: &str, words: &str) -> (String, String, Option<i32>) {
    let mut command = assert_cmd::Command::cargo_bin("holonom").unwrap();
    let output = command.current_dir(folder).args(words.split_whitespace()).write_stdin(model).output().unwrap();
    (text(&output.stdout), text(&output.stderr), output.status.code())
}

#[test]
fn a_model_may_come_from_standard_input() {
    let folder = folder();
    let solid = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    fs::write(folder.path().join("part.obj"), solid).unwrap();
    let model = "[body.b]\nposition = [0, 0, 0]\ndensity = 1000\nshape = { mesh = \"part.obj\" }\n[simulation]\nstep = 0.1\nend = 0.2\n";
    let (out, err, status) = fed(&folder, model, "run -");
    assert!(status == Some(0) && out.ends_with("results in results/stdin-conserving-ggl\n"), "{out}\n{err}");
    assert_eq!(read_json(folder.path().join("results/stdin-conserving-ggl/summary.json"))["provenance"]["model"], model);
    // Commands that read the model several times read the same.
    for words in
        ["check -", "compare - --method radau --quiet", "stability - --method radau --quiet", "sweep - --vary body.b.density=1,2 --quiet"]
    {
        let (_, err, status) = fed(&folder, model, words);
        assert_eq!((status, err.as_str()), (Some(0), ""), "{words}");
    }
    let (_, err, status) = fed(&folder, "[point.a]\nmas = 1\n", "check -");
    assert!(status == Some(2) && err.contains("--> stdin:2:1"), "{err}");
    let (_, err, status) = fed(&folder, "", "run -");
    assert!(status == Some(2) && err.contains("stdin:1:1") && err.contains("empty"), "{err}");
}

#[test]
fn messages_have_colours_where_these_are_wanted() {
    let folder = folder();
    fs::write(folder.path().join("wrong.toml"), "[point.a]\nmas = 1\nposition = [1, 0, 0] # error: note: cure:\n").unwrap();
    let said = |words: &str, force: bool, no_color: bool| {
        let mut command = assert_cmd::Command::cargo_bin("holonom").unwrap();
        command.current_dir(&folder).args(words.split(' ')).env_remove("NO_COLOR").env_remove("CLICOLOR_FORCE");
        force.then(|| command.env("CLICOLOR_FORCE", "1"));
        no_color.then(|| command.env("NO_COLOR", "1"));
        text(&command.output().unwrap().stderr)
    };
    for words in ["check wrong.toml", "run nothing.toml", "run example:chain --method fast", "run example:chain --set x"] {
        let (plain, coloured) = (said(words, false, false), said(words, true, false));
        assert!(!plain.contains('\x1b') && coloured.contains("\x1b[1m\x1b[31merror:\x1b[0m "), "{coloured:?}");
        assert_eq!(coloured.contains("\x1b[1m\x1b[32mcure:\x1b[0m "), plain.contains("cure: "), "{coloured:?}");
        assert_eq!(said(words, true, true), plain);
        let mut bare = coloured.clone();
        ["\x1b[1m", "\x1b[31m", "\x1b[32m", "\x1b[0m"].iter().for_each(|code| bare = bare.replace(code, ""));
        assert_eq!(bare, plain);
    }
}

#[test]
fn shells_complete_commands_and_options() {
    let folder = folder();
    let listed: Vec<String> =
        prints(&folder, "--help", 0).lines().filter_map(|line| line.strip_prefix("  ")?.split(' ').next().map(str::to_string)).collect();
    let commands: Vec<&String> = listed.iter().filter(|word| word.chars().all(char::is_alphabetic) && !word.is_empty()).collect();
    assert!(commands.len() > 10, "{commands:?}");
    for shell in ["bash", "zsh", "fish"] {
        let script = prints(&folder, &format!("completions {shell}"), 0);
        for word in commands.iter().map(|word| word.as_str()).chain(["no-report", "resume", "force"]) {
            assert!(script.contains(word), "{shell}: {word}");
        }
    }
    assert!(fails_to_parse(&folder, "completions tcsh").contains("bash"));

    // What bash makes of it, where there is one.
    fs::write(folder.path().join("script"), prints(&folder, "completions bash", 0)).unwrap();
    let ask = "source ./script; COMP_WORDS=(holonom run --res); COMP_CWORD=2; _holonom holonom --res run; echo \"${COMPREPLY[@]}\"";
    if let Ok(output) = Process::new("bash").current_dir(&folder).args(["--norc", "-c", ask]).output() {
        assert_eq!(text(&output.stdout), "--resume\n", "{}", text(&output.stderr));
    }
}

/// Runs a command that the command line refuses and hands back its message.
fn fails_to_parse(folder: &tempfile::TempDir, words: &str) -> String {
    let output = holonom(folder, words);
    assert_eq!(output.status.code(), Some(2), "{words}");
    text(&output.stderr)
}

/// What the command line sets is shown as that, and not as if it stood in the file; what follows from it in the file is told with it.
#[test]
fn faults_of_what_the_command_line_sets_are_told_as_such() {
    let folder = folder();
    let model = "[parameters]\nk = 2\nm = \"k\"\n[body.arm]\nmass = \"m\"\ninertia = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\n\
                 [simulation]\nend = 1\nstep = 0.01\n";
    std::fs::write(folder.path().join("arm.toml"), model).unwrap();
    let outside = "which is set outside arm.toml, by --set or another option";
    for (words, told) in [
        ("check arm.toml --set body.arm.mass=-1", format!("--> body.arm.mass = -1, {outside}")),
        ("run arm.toml --step abc", format!("--> simulation.step = \"abc\", {outside}")),
        ("check arm.toml --set body.arm.positon=[0,0,0]", format!("--> body.arm.positon = [0, 0, 0], {outside}")),
        ("check arm.toml --set body.arm.inertia=[1,\"x\",1]", format!("--> body.arm.inertia = [1, \"x\", 1], {outside}")),
        ("check arm.toml --set parameters.k=zz", format!("--> parameters.k = \"zz\", {outside}")),
        ("check arm.toml --set parameters.k=-1", "must be above 0, with parameters.k = -1 from --set or another option".into()),
    ] {
        let message = fails(&folder, words, 2);
        assert!(message.contains(&told), "{words}\n{message}");
    }
    // What has nothing to do with it is told as ever.
    std::fs::write(folder.path().join("arm.toml"), model.replace("position = [0, 0, 0]", "position = [0, 0]")).unwrap();
    let message = fails(&folder, "check arm.toml --set parameters.k=3", 2);
    assert!(message.contains("--> arm.toml:7:12 (body.arm.position)") && !message.contains("--set"), "{message}");
}
