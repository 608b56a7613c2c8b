//! `holonom run --resume`: nothing goes on from another run, nor beyond what ended one.

mod common;

use std::fs;

use common::*;

/// The errors that are allowed in a step depend on the length of the run.
#[test]
fn a_run_by_accuracy_is_noted_to_differ() {
    let folder = folder();
    let words = format!("run {PAPER} --accuracy 1e-4 --no-report");
    prints(&folder, &format!("{words} --end 1 --out a"), 0);
    let output = holonom(&folder, &format!("{words} --end 2 --resume a"));
    assert!(output.status.success() && text(&output.stderr).contains("an accuracy is that of the whole run"), "{}", text(&output.stderr));
    // Without a step, it follows from the end.
    let words = "run example:double-pendulum --set simulation.accuracy=1e-4 --no-report --quiet";
    fs::write(folder.path().join("model.toml"), prints(&folder, "examples double-pendulum", 0).replace("\nstep", "\n# step")).unwrap();
    let words = words.replace("example:double-pendulum", "model.toml");
    prints(&folder, &format!("{words} --end 1 --out b"), 0);
    let message = fails(&folder, &format!("{words} --end 2 --resume b"), 2);
    assert!(
        message.contains("`simulation.step` was 0.005 and is 0.01") && message.contains("give --step 0.005, which followed from"),
        "{message}"
    );
    prints(&folder, &format!("{words} --end 2 --step 0.005 --resume b"), 0);
}

#[test]
fn another_run_is_refused_with_what_differs() {
    let folder = folder();
    let model = prints(&folder, "examples four-bar", 0);
    fs::write(folder.path().join("m.toml"), &model).unwrap();
    prints(&folder, "run m.toml --set parameters.N=2 --end 0.1 --quiet --no-report --out a", 0);
    let before: Vec<Vec<u8>> =
        files(folder.path().join("a")).iter().map(|name| fs::read(folder.path().join("a").join(name)).unwrap()).collect();
    fs::write(folder.path().join("no.json"), "{}").unwrap();
    fs::write(folder.path().join("torn.json"), "{\"provenance\": {").unwrap();
    let edit = |name: &str, from: &str, to: &str| {
        let text = fs::read_to_string(folder.path().join("a/checkpoint.json")).unwrap();
        assert!(text.contains(from), "{from}");
        fs::write(folder.path().join(name), text.replacen(from, to, 1)).unwrap();
    };
    let version = format!("\"version\":\"{}\"", env!("CARGO_PKG_VERSION"));
    edit("version.json", &version, "\"version\":\"0.0.7\"");
    edit("build.json", "\"a_squares\"", "\"squares\"");
    edit("old.json", "\"provenance\":{", "\"origin\":{");
    edit("rows.json", "\"rows\":11", "\"rows\":12");
    fs::copy(folder.path().join("a/trajectory.csv"), folder.path().join("trajectory.csv")).unwrap();
    fs::write(folder.path().join("heavy.toml"), model.replace("mass = 1", "mass = 3")).unwrap();
    for (words, told) in [
        ("m.toml --end 0.2 --resume a", vec!["`parameters.N` was 2 and is 1", "without --resume"]),
        ("m.toml --end 0.2 --set parameters.N=3 --resume a", vec!["`parameters.N` was 2 and is 3"]),
        ("m.toml --end 0.2 --set parameters.N=2 --step 0.02 --resume a", vec!["`simulation.step` was 0.01 and is 0.02"]),
        ("m.toml --end 0.2 --set parameters.N=2 --every 2 --resume a", vec!["`output.every` was 1 and is 2"]),
        ("m.toml --end 0.2 --set parameters.N=2 --method radau --resume a", vec!["the method was \"conserving-ggl\" and is \"radau\""]),
        (
            "m.toml --end 0.2 --set parameters.N=2 --set simulation.tolerance=1e-9 --resume a",
            vec!["`simulation.tolerance` was not there and is 1e-9"],
        ),
        (
            "m.toml --end 0.2 --set parameters.N=2 --set output.reactions=true --resume a",
            vec!["`output.reactions` was not there and is true"],
        ),
        ("heavy.toml --end 0.2 --set parameters.N=2 --resume a", vec!["mass", "and is 3"]),
        (&format!("{PAPER} --end 0.2 --resume a"), vec!["`parameters.N` was 2 and is not there", " more"]),
        ("m.toml --set parameters.N=2 --end 0.05 --resume a", vec!["a/checkpoint.json is at 0.1 s", "later --end"]),
        ("m.toml --set parameters.N=2 --end 0.1 --resume a", vec!["later --end"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume no.json", vec!["no.json is no checkpoint"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume torn.json", vec!["torn.json is no checkpoint"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume version.json", vec!["is of version 0.0.7, and this is"]),
        (
            "m.toml --set parameters.N=2 --end 0.2 --resume build.json",
            vec!["build.json was written by another build of holonom", "`a_squares`", "or with the build of holonom that wrote it"],
        ),
        ("m.toml --set parameters.N=2 --end 0.2 --resume old.json", vec!["is of a version before"]),
        ("m.toml --set parameters.N=2 --end 0.2 --resume rows.json", vec!["trajectory.csv has not the 12 rows", "row 12 is missing"]),
    ] {
        let message = fails(&folder, &format!("run {words}"), 2);
        told.iter().for_each(|told| assert!(message.contains(told), "{words}: {told}\n{message}"));
    }
    let after: Vec<Vec<u8>> =
        files(folder.path().join("a")).iter().map(|name| fs::read(folder.path().join("a").join(name)).unwrap()).collect();
    assert!(before == after, "nothing is touched");
    // Comments, the title, and how a number was given do not matter.
    fs::write(folder.path().join("m.toml"), model.replace("N = 1", "N = 2").replace("title = \"", "# More.\ntitle = \"My ")).unwrap();
    prints(&folder, "run m.toml --end 0.2 --quiet --no-report --resume a", 0);

    // Two points that change places would change their numbers with each other.
    let point = |name: &str, x: u32| format!("[point.{name}]\nmass = 1\nposition = [{x}, 0, 0]\n");
    let end = "[simulation]\nstep = 0.1\nend = 1\n";
    fs::write(folder.path().join("two.toml"), [point("a", 1), point("b", 2), end.into()].concat()).unwrap();
    prints(&folder, "run two.toml --quiet --no-report --out two", 0);
    fs::write(folder.path().join("two.toml"), [point("b", 2), point("a", 1), end.into()].concat()).unwrap();
    assert!(fails(&folder, "run two.toml --end 2 --resume two", 2).contains("another order"));
}

/// An unbroken run stops there, too, and so must one that goes on.
#[test]
fn a_run_that_stopped_of_itself_stays_stopped() {
    let folder = folder();
    let words = format!(
        "run {PAPER} --method trapezoidal --set simulation.iteration=simultaneous --set simulation.penalty=1e7 \
                         --set simulation.tolerance=1e-9 --set simulation.subdivide=false --no-report --quiet"
    );
    prints(&folder, &format!("{words} --out a"), 3);
    prints(&folder, &format!("{words} --end 25 --resume a"), 3);
    prints(&folder, &format!("{words} --end 25 --out whole"), 3);
    // Attempts at the step that fails are counted each time, so only the table is the same.
    let [a, whole] = ["a", "whole"].map(|name| fs::read(folder.path().join(name).join("trajectory.csv")).unwrap());
    assert!(a == whole);
    // Too small an error for so long a run: the last step is left in its midst.
    let words = "run example:double-pendulum --set simulation.accuracy=1e-6 --no-report --quiet --step 0.01 --end 2500";
    prints(&folder, &format!("{words} --out b"), 3);
    let message = fails(&folder, &format!("{words} --resume b"), 2);
    assert!(message.contains("an event or a failed step ended at "), "{message}");
}

#[test]
fn a_table_that_was_changed_is_refused_and_is_another_run() {
    let folder = folder();
    let model = "[table.law]\nfile = \"law.csv\"\n[point.p]\nmass = 1\nposition = [0, 0, 1]\n\
                 [force.f]\ntype = \"spring\"\nbetween = [\"ground\", \"p\"]\nstiffness = 1\nforce = \"law(rate)\"\n\
                 [simulation]\nstep = 0.01\nend = 0.1\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    for (number, law) in ["v,f\n-1,-1\n1,1\n", "v,f\n-1,-2\n1,2\n"].iter().enumerate() {
        fs::write(folder.path().join("law.csv"), law).unwrap();
        if number == 1 {
            assert!(fails(&folder, "run m.toml --end 1 --resume results/m-conserving-ggl", 2).contains("the file `law.csv` was changed"));
        }
        prints(&folder, "run m.toml --quiet --no-report", 0);
        assert_eq!(files(folder.path().join("results")).len(), number + 1);
    }
}

#[test]
fn a_mesh_that_was_changed_is_refused() {
    let folder = folder();
    let solid = |size: u32| format!("v 0 0 0\nv {size} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
    let model = "[body.b]\nposition = [0, 0, 0]\ndensity = 1000\nshape = { mesh = \"part.obj\" }\n[simulation]\nstep = 0.1\nend = 0.2\n";
    fs::write(folder.path().join("model.toml"), model).unwrap();
    fs::write(folder.path().join("part.obj"), solid(1)).unwrap();
    prints(&folder, "run model.toml --quiet --no-report --out a", 0);
    fs::write(folder.path().join("part.obj"), solid(2)).unwrap();
    assert!(fails(&folder, "run model.toml --end 1 --resume a", 2).contains("the file `part.obj` was changed"));
}
