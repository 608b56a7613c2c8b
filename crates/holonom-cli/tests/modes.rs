//! `holonom modes` as people type it, with the model of its chapter.

mod common;

use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

use common::*;

/// The model of the chapter, in a folder, and what the chapter says that the command prints.
fn chapter() -> (tempfile::TempDir, String) {
    let text = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/modes.md")).unwrap();
    let between = |from: &str| text.split_once(from).unwrap().1.split_once("```").unwrap().0.to_string();
    let folder = folder();
    fs::write(folder.path().join("quarter.toml"), between("```toml\n")).unwrap();
    (folder, between("$ holonom modes quarter.toml\n"))
}

#[test]
fn prints_what_the_book_shows() {
    let (folder, shown) = chapter();
    assert_eq!(prints(&folder, "modes quarter.toml", 0).trim_end(), shown.trim_end());
}

/// Results are kept as those of runs are, with a page.
#[test]
fn leaves_a_page_and_its_numbers() {
    let (folder, _) = chapter();
    let results = folder.path().join("results");
    let printed = json(&folder, "modes quarter.toml --json");
    let page = fs::read_to_string(results.join("quarter-modes/report.html")).unwrap();
    assert!(page.contains("chassis.z 1.00 m") && page.contains("holonom modes quarter.toml --json"));
    let kept: serde_json::Value = serde_json::from_slice(&fs::read(results.join("quarter-modes/modes.json")).unwrap()).unwrap();
    assert_eq!(kept, printed);
    // The same again takes its place, and another one does not.
    prints(&folder, "modes quarter.toml --quiet", 0);
    prints(&folder, "modes quarter.toml --quiet --no-report --set force.tyre.stiffness=200e3", 0);
    let names =
        |of: &str| fs::read_dir(results.join(of)).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect::<Vec<_>>();
    let mut kept = names("");
    kept.sort_unstable();
    assert_eq!(kept, ["quarter-modes", "quarter-modes-2"]);
    assert_eq!(names("quarter-modes-2"), ["modes.json"]);
    let message = fails(&folder, "modes quarter.toml --set force.tyre.stiffness=1e3 --out results/quarter-modes", 2);
    assert!(message.contains("holds the results of another run: holonom modes quarter.toml") && message.contains("--force"), "{message}");
}

/// A quarter of a car has the roots of its characteristic polynomial.
#[test]
fn tells_numbers_as_json() {
    let (folder, _) = chapter();
    let found = json(&folder, "modes quarter.toml --json");
    let modes = found["modes"].as_array().unwrap();
    assert_eq!((modes.len(), &found["zero"]), (2, &0.into()));
    let [wheel, chassis, tyre, spring, damper] = [40.0, 400.0, 160e3, 20e3, 1500.0];
    for mode in modes {
        let s = [mode["growth"].as_f64().unwrap(), TAU * mode["frequency"].as_f64().unwrap()];
        let times = |a: [f64; 2], b: [f64; 2]| [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]];
        let link = [spring + damper * s[0], damper * s[1]];
        let square = times(s, s);
        let below = [wheel * square[0] + tyre + link[0], wheel * square[1] + link[1]];
        let above = [chassis * square[0] + link[0], chassis * square[1] + link[1]];
        let (whole, coupled) = (times(below, above), times(link, link));
        let left = (whole[0] - coupled[0]).hypot(whole[1] - coupled[1]);
        assert!(left < 1e-9 * coupled[0].hypot(coupled[1]), "{left:e}");
    }
    let heave = &modes[0]["moves"];
    assert_eq!(heave["chassis.z"][0], 1.0);
    assert!(heave["wheel.z"][0].as_f64().unwrap() < 0.2 && heave["wheel.x"][0].as_f64().unwrap() < 1e-9, "{heave}");
}

/// The screen has the slow ones of many, the page and the file all.
#[test]
fn the_fast_ones_of_many_are_counted() {
    let folder = folder();
    let model = "plane = \"xz\"\ngravity = [0, 0]\n[body.b]\nrepeat = \"i = 1 to 43\"\nmass = 1\ninertia = \"1/(1 + i)\"\nposition = [\"i\", 0]\n\
                 [joint.j]\nrepeat = \"i = 1 to 43\"\ntype = \"revolute\"\nbetween = [\"ground\", \"b[i]\"]\nat = [\"i\", 0]\n\
                 [force.k]\nrepeat = \"i = 1 to 43\"\ntype = \"torsion\"\njoint = \"j[i]\"\nstiffness = 1\n";
    fs::write(folder.path().join("m.toml"), model).unwrap();
    let told = prints(&folder, "modes m.toml", 0);
    assert!(told.contains("\n40 ") && !told.contains("\n41 ") && told.contains("\n\n3 more are faster\n"), "{told}");
    let page = fs::read_to_string(folder.path().join("results/m-modes/report.html")).unwrap();
    assert!(page.contains("<th scope=\"row\">43</th>"));
}

#[test]
fn says_what_is_missing() {
    let (folder, _) = chapter();
    let message = fails(&folder, "modes quarter.toml --set start.equilibrium=false", 2);
    assert!(message.contains("forces do not balance") && message.contains("--set start.equilibrium=true"), "{message}");
    let message = fails(&folder, "modes example:heavy-top", 2);
    assert!(message.contains("moves at the start"), "{message}");
    assert!(prints(&folder, "modes example:robot-arm --set start.equilibrium=true", 0).contains("nothing vibrates"));
    // A door with a closer that only damps: of its two exponents one is zero.
    let door = "plane = \"xz\"\ngravity = [0, 0]\n[body.door]\nmass = 2\ninertia = 1\nposition = [1, 0]\n[joint.hinge]\ntype = \"revolute\"\n\
                between = [\"ground\", \"door\"]\nat = [0, 0]\n[force.closer]\ntype = \"torsion\"\njoint = \"hinge\"\ndamping = 3\n";
    fs::write(folder.path().join("door.toml"), door).unwrap();
    let told = prints(&folder, "modes door.toml", 0);
    assert!(told.contains("1 more exponent is zero to within ") && told.contains("1/s: of a motion that nothing drives back"), "{told}");
}
