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

/// A run that ends at its start needs no step, and says where it is not at rest.
#[test]
fn the_start_alone_has_forces() {
    let folder = folder();
    let model = "plane = \"xz\"\n[point.bob]\nmass = 2\nposition = [3, 4]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\n";
    fs::write(folder.path().join("bob.toml"), model).unwrap();
    let run = |words: &str| json(&folder, &format!("run bob.toml --end 0 --no-report --json {words}"));
    let notes = |summary: &serde_json::Value| summary["notes"].to_string();
    // It falls, and the rod bears the share of its weight along it.
    let falls = run("--out falls");
    assert_eq!((&falls["steps"], &falls["status"]), (&0.into(), &"completed".into()));
    assert!((falls["peaks"]["joints"][0]["value"].as_f64().unwrap() + 0.8 * 2.0 * 9.81).abs() < 1e-12, "{falls:#}");
    assert!(notes(&falls).contains("forces do not balance at the start"), "{falls:#}");
    let hangs = run("--out hangs --set start.equilibrium=true");
    assert!((hangs["peaks"]["joints"][0]["value"].as_f64().unwrap() - 2.0 * 9.81).abs() < 1e-12, "{hangs:#}");
    assert!(!notes(&hangs).contains("balance at the start"), "{hangs:#}");
    let thrown = run("--out thrown --set point.bob.velocity=[4,-3]");
    assert!(!notes(&thrown).contains("balance at the start"), "{thrown:#}");
    let told = fails(&folder, "stability bob.toml --end 0", 2);
    assert!(told.contains("takes no step") && told.contains("--end"), "{told}");
    let told = fails(&folder, "sweep bob.toml --end 0 --vary point.bob.mass=1,2 --columns bob.magnitude", 2);
    assert!(told.contains("there is no column `bob.magnitude`"), "{told}");
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
fn check_says_what_a_model_is_made_of() {
    let folder = folder();
    let out = prints(&folder, &format!("check {PAPER}"), 0);
    for word in ["6 coordinates, 5 rows of rank 4", "2 degrees of freedom", "straight[", "singular", "residual", "(0, 0, -9.81) m/s²"] {
        assert!(out.contains(word), "{word}\n{out}");
    }
    let found = json(&folder, &format!("check {PAPER} --json"));
    assert_eq!((&found["rank"], &found["redundant"], &found["dof"]), (&4.into(), &1.into(), &2.into()));
    assert!(found["redundant_rows"][0].as_str().unwrap().starts_with("straight["));
    assert!(found["near_singular"].is_null() && found.get("projection").is_none());
    assert!(prints(&folder, &format!("check {PAPER} --set gravity=[0,0,0]"), 0).contains("none acts"));

    let model = "plane = \"xy\"\n[point.a]\nmass = 1\nposition = [1, 0]\n[point.b]\nmass = 1\nposition = [2, 0.003]\n\
                 [constraint.one]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n\
                 [constraint.two]\ntype = \"distance\"\nbetween = [\"a\", \"b\"]\n\
                 [constraint.three]\ntype = \"distance\"\nbetween = [\"ground\", \"b\"]\n";
    fs::write(folder.path().join("straight.toml"), model).unwrap();
    assert!(json(&folder, "check straight.toml --json")["near_singular"].is_array());
    assert!(prints(&folder, "check straight.toml", 0).contains("singular   yes"));
    // In a line, where the third follows from the others, and not beside it.
    fs::write(folder.path().join("line.toml"), model.replace("0.003", "0")).unwrap();
    let line = json(&folder, "check line.toml --json");
    assert_eq!((&line["redundant"], &line["singular"], &found["singular"]), (&1.into(), &true.into(), &false.into()));
    assert!(prints(&folder, "check line.toml", 0).contains("singular   yes: redundant rows are so at this position alone"));
    let message = fails(&folder, "modes line.toml", 2);
    assert!(on_one_line(&message).contains("singular position") && message.contains("cure: a run from a place beside it"), "{message}");
}

#[test]
fn a_drive_of_what_cannot_move_is_named() {
    let folder = folder();
    // The strut makes a triangle of it, which does not move; the motor begins at rest.
    let head = "plane = \"xy\"\n[body.link]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\npoints = { tip = [0.5, 0] }\n\
                [joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"link\"]\nat = [0, 0]\n\
                [drive.motor]\ntype = \"angle\"\njoint = \"pin\"\nprofile = \"0.1*t^2\"\n[simulation]\nstep = 0.01\nend = 1\n";
    let strut = "[constraint.strut]\ntype = \"distance\"\nbetween = [[0.3, 0.8], \"link.tip\"]\n";
    fs::write(folder.path().join("held.toml"), format!("{head}{strut}")).unwrap();
    let said = "`motor` asks for a motion that the other constraints do not allow";
    let found = on_one_line(&prints(&folder, "check held.toml", 0));
    assert!(found.contains(said) && !found.contains("may stay"), "{found}");
    assert_eq!(json(&folder, "check held.toml --json")["conflict"], "motor");
    let stopped = on_one_line(&prints(&folder, "run held.toml", 3));
    assert!(stopped.contains(said) && stopped.contains("at t = 0.000000 s"), "{stopped}");
    assert!(json(&folder, &format!("check {PAPER} --json"))["conflict"].is_null());
    // The same motor without the strut.
    fs::write(folder.path().join("free.toml"), head).unwrap();
    assert!(!prints(&folder, "check free.toml", 0).contains("conflict"));
}

/// Rows that keep bodies in shape are left of a contradiction as much as others, and ask for nothing.
#[test]
fn a_drive_is_named_and_not_the_shape_of_the_body_that_it_leads() {
    let folder = folder();
    let model = "[body.b0]\nmass = 0.08\ninertia = [0.0026, 0.0038, 0.0064]\nposition = [0.0447, -0.0748, 0.388]\n\
                 [joint.j0]\ntype = \"revolute\"\nbetween = [\"ground\", \"b0\"]\nat = [0.1046, 0.1413, 0.4047]\naxis = [0, 1, 0]\n\
                 [body.b1]\nmass = 0.143\ninertia = [0.0051, 0.0144, 0.0108]\nposition = [0.6966, 0.4952, 0.4138]\n\
                 points = { p1 = [0.335, 0.369, -0.266] }\n\
                 [joint.j1]\ntype = \"revolute\"\nbetween = [\"b0\", \"b1\"]\nat = [0.4677, 0.1634, 0.3025]\naxis = [-0.4448, 0.3019, -0.8432]\n\
                 [body.b2]\nmass = 7.75\ninertia = [0.575, 0.902, 0.582]\nposition = [0.563, 0.467, 0.149]\n\
                 [joint.j2]\ntype = \"spherical\"\nbetween = [\"b1\", \"b2\"]\nat = [0.536, 0.419, 0.211]\n\
                 [drive.dr]\ntype = \"angle\"\njoint = \"j0\"\nprofile = \"0.34*(1-cos(3*t))\"\n\
                 [constraint.c0]\ntype = \"point-on-line\"\npoint = \"b1.p1\"\ndirection = [0.1434, 0.7195, -0.6796]\n\
                 [simulation]\nend = 1\nstep = 0.01\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    for masses in ["", "--set body.b0.mass=8e-6 --set body.b2.mass=7e6"] {
        assert_eq!(json(&folder, &format!("check m.toml --json {masses}"))["conflict"], "dr", "{masses}");
        for method in ["conserving-ggl", "radau", "dop853 --accuracy 1e-9"] {
            let stopped = prints(&folder, &format!("run m.toml --method {method} --out out --force {masses}"), 3);
            assert!(stopped.contains("`dr` asks for a motion"), "{method} {masses}: {stopped}");
        }
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

/// Forces that redundant constraints share are named by runs as by `check`.
#[test]
fn runs_name_the_forces_that_are_not_unique() {
    let folder = folder();
    let output = holonom(&folder, "run example:spatial-four-bar --end 0.02");
    let found = json(&folder, "check example:spatial-four-bar --json")["reactions_not_unique"].as_array().unwrap().clone();
    assert!(!found.is_empty());
    for columns in found {
        assert!(text(&output.stderr).contains(columns.as_str().unwrap()), "{columns}: {}", text(&output.stderr));
    }
    assert!(holonom(&folder, "run example:slider-crank --end 0.02").stderr.is_empty());
    // Two drives of two gears that mesh, of which either could do the work.
    let gears = "[body.b]\nrepeat = \"i = 0 to 1\"\nmass = 1\ninertia = [1, 1, 1]\nposition = [\"i\", 0, 0]\n\
                 [joint.a]\nrepeat = \"i = 0 to 1\"\ntype = \"revolute\"\nbetween = [\"ground\", \"b[i]\"]\nat = \"b[i]\"\naxis = [0, 0, 1]\n\
                 [joint.mesh]\ntype = \"gear\"\njoints = [\"a[0]\", \"a[1]\"]\nratio = -1\n\
                 [drive.m]\nrepeat = \"i = 0 to 1\"\ntype = \"angle\"\njoint = \"a[i]\"\nprofile = \"(1 - 2*i)*t^2\"\n\
                 [simulation]\nend = 0.1\nstep = 0.01\n";
    fs::write(folder.path().join("gears.toml"), gears).unwrap();
    let efforts = "m[0].effort, m[1].effort, mesh.a[0].angle.effort, mesh.a[1].angle.effort";
    let output = holonom(&folder, "run gears.toml");
    assert!(text(&output.stderr).contains(&format!(": of {efforts} one way of many")), "{}", text(&output.stderr));
    assert!(on_one_line(&prints(&folder, "check gears.toml", 0)).contains(&format!("not unique: {efforts}; all others are")));
    // With teeth or a belt the bearings bear what either does: of a belt without tension at rest along both axes, of a tight one across the strands alone.
    let borne = |keys: &str| {
        let text = gears.replace("ratio = -1\n", "").replace("type = \"gear\"", keys);
        fs::write(folder.path().join("borne.toml"), text).unwrap();
        let open = json(&folder, "check borne.toml --json")["reactions_not_unique"].as_array().unwrap().clone();
        open.iter().map(|columns| columns.as_str().unwrap().to_string()).filter(|columns| columns.starts_with('a')).collect::<Vec<_>>()
    };
    assert_eq!(borne("type = \"gear\"\nratio = -1\npressure_angle = \"20*deg\""), ["a[0].fx .fy", "a[1].fx .fy"]);
    let belt = "type = \"pulley\"\nradii = [0.1, 0.1]\ncrossed = true\npretension = ";
    assert_eq!(borne(&format!("{belt}0")), ["a[0].fx .fy", "a[1].fx .fy"]);
    assert_eq!(borne(&format!("{belt}50")), ["a[0].fy", "a[1].fy"]);
    // A door on two hinges, in metres, millimetres and others.
    let door = "[parameters]\nu = 1\n[body.door]\nmass = 1\ninertia = [\"u^2\", \"u^2\", \"u^2\"]\nposition = [\"u\", 0, 0]\n\
                [joint.hinge]\nrepeat = \"i = 0 to 1\"\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\n\
                at = [0, 0, \"i*u\"]\naxis = [0, 0, 1]\n";
    fs::write(folder.path().join("door.toml"), door).unwrap();
    let open = |u| json(&folder, &format!("check door.toml --json --set parameters.u={u}"))["reactions_not_unique"].clone();
    let metres = open("1");
    assert!(!metres.as_array().unwrap().is_empty());
    ["1e-9", "1e-6", "1e3", "1e6"].iter().for_each(|u| assert_eq!(open(u), metres, "in units of {u} m"));
}

/// A moment in kg·mm² is, and a piston whose pin is at its centre but for rounding is not.
#[test]
fn a_moment_that_is_far_too_large_is_named() {
    let folder = folder();
    let model = "plane = \"xy\"\n[body.piston]\nmass = 1\ninertia = 1e-4\nposition = [0.3, 0]\n\
                 [joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"piston\"]\nat = [\"0.1 + 0.2\", 0]\n";
    let said = |model: String| {
        fs::write(folder.path().join("m.toml"), model).unwrap();
        on_one_line(&prints(&folder, "check m.toml", 0))
    };
    assert!(!said(model.into()).contains("gyration"));
    let mixed = said(model.replace("1e-4", "100").replace("0.1 + 0.2", "0.31"));
    assert!(mixed.contains("the radius of gyration of `piston` is 10 m, while its joints are within 0.01 m of its centre"), "{mixed}");
}

#[test]
fn only_the_mass_matrix_never_adds_energy() {
    let folder = folder();
    let heavy = "--set point.m2.mass=10 --projection";
    let projection = |matrix: &str| {
        let found = json(&folder, &format!("check {PAPER} {heavy} --json --set simulation.projection.matrix={matrix}"));
        found["projection"].clone()
    };
    let custom = |m1: f64, m2: f64| {
        let weights = format!("--set simulation.projection.weights.m1={m1} --set simulation.projection.weights.m2={m2}");
        projection(&format!("custom {weights}"))
    };
    let (mass, identity, like_mass, other) = (projection("mass"), projection("identity"), custom(1.0, 10.0), custom(3.0, 1.0));
    for (form, dissipative) in [(&mass, true), (&identity, false), (&like_mass, true), (&other, false)] {
        assert_eq!(form["dissipative"], dissipative, "{form}");
    }
    assert!((mass["condition"].as_f64().unwrap() - 1.0).abs() < 1e-9);
    assert!((identity["condition"].as_f64().unwrap() - 10.0).abs() < 1e-9);
    assert!((identity["growth_bound"].as_f64().unwrap() - 3.025).abs() < 1e-9);
    assert!(prints(&folder, &format!("check {PAPER} {heavy}"), 0).contains("never adds energy"));
    let out = prints(&folder, &format!("check {PAPER} {heavy} --set simulation.projection.matrix=identity"), 0);
    assert!(out.contains("can add energy"), "{out}");
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
