//! The page of modes in a browser: the mechanism swings in the one that is chosen.
//!
//! Needs Chromium, as `browser.rs` does.
#![cfg(feature = "viewer")]

mod chromium;
mod sample;

use chromium::{TOOLS, WINDOW, checks_in, dump_dom};
use holonom::model::Sway;
use holonom_report::{ModeShape, ModesReport};
use sample::Sample;
use serde_json::{Value, json};
use std::fs;

const ERRORS: &str = include_str!("checks/errors.js");
const CHECKS: &str = include_str!("checks/modes.js");

#[test]
fn a_mechanism_swings_in_space() {
    let seen = open(&sample::bodies::shapes(), "brick", [1400, 1000]);
    swings(&seen, "brick", 2);
}

#[test]
fn a_mechanism_swings_in_a_plane() {
    for window in [WINDOW, [500, 900]] {
        swings(&open(&sample::bodies::four_bar(2.0), "crank", window), "crank", 2);
    }
}

/// The first mode moves a body up, the second another one in a circle, the third turns the first.
fn swings(seen: &Value, name: &str, up: usize) {
    assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
    assert_eq!((&seen["keys"], &seen["rows"]), (&json!(["Pause", "Play"]), &json!([0, 1, 2, 0])), "{seen:#}");
    assert!(seen["playing"].as_f64().unwrap() > 0.0, "{seen:#}");
    assert_eq!(seen["labels"], json!(["mode 1: 1.5 Hz", "mode 2: 2.5 Hz", "mode 3: grows in 0.25 s", "mode 1: 1.5 Hz"]), "{seen:#}");
    assert_eq!(seen["scrolled"], json!([0, true]), "{seen:#}");
    let place = |of: &Value| -> Vec<f64> { of[name].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect() };
    let rest = place(&seen["rest"]);
    let [there, back, middle] = [0, 1, 2].map(|k| place(&seen["places"][k]));
    for k in 0..3 {
        let moved = there[k] - rest[k];
        assert!((moved + back[k] - rest[k]).abs() < 1e-6 && (middle[k] - rest[k]).abs() < 1e-6, "{seen:#}");
        assert!(if k == up { (0.05..0.5).contains(&moved) } else { moved.abs() < 1e-6 }, "{seen:#}");
    }
    let mut pictures: Vec<i64> = seen["pictures"].as_array().unwrap().iter().map(|hash| hash.as_i64().unwrap()).collect();
    pictures.sort_unstable();
    pictures.dedup();
    assert_eq!(pictures.len(), 4, "{seen:#}");
}

/// What the checks saw in the page of three modes.
fn open(sample: &Sample, first: &str, window: [u32; 2]) -> Value {
    let scene = &sample.scene;
    let (axes, is_planar) = (scene.axes.chars(), scene.axes.len() == 2);
    let turn: &[&str] = if is_planar { &["angle"] } else { &["qw", "qx", "qy", "qz"] };
    let names: Vec<String> = axes.map(String::from).chain(turn.iter().map(|name| name.to_string())).collect();
    // Numbers of a rate: which body, which of its coordinates, and how fast.
    let part = |of: &[(&str, usize, f64)]| {
        let bodies = scene.bodies.iter().map(|body| {
            let pose = names.iter().map(|name| sample.recording.column(&format!("{}.{name}", body.name)).unwrap()[0]).collect();
            let mut rate = vec![0.0; if is_planar { 3 } else { 6 }];
            of.iter().filter(|(name, ..)| *name == body.name).for_each(|(_, k, speed)| rate[*k] = *speed);
            Sway { name: body.name.clone(), pose, rate }
        });
        [Vec::new(), bodies.collect()]
    };
    let up = scene.axes.len() - 1;
    let other = scene.bodies.last().unwrap().name.as_str();
    let mode = |row: [&str; 5], real, imaginary| ModeShape { row: row.map(str::to_owned), real: part(real), imaginary: part(imaginary) };
    let modes = [
        mode(["1", "1.5", "0", "stays", "up"], &[(first, up, 7e-40)], &[]),
        mode(["2", "2.5", "0.1", "2", "round"], &[(other, 0, 3e50)], &[(other, up, 3e50)]),
        mode(["3", "-", "-", "grows in 0.25", "turns"], &[(first, scene.axes.len(), 1.0)], &[]),
    ];
    let notes = ["2 more exponents are zero".to_string()];
    let provenance = &Value::Null;
    let mut page = Vec::new();
    ModesReport { title: "A & B", model_text: "", provenance, scene, modes: &modes, notes: &notes }.write(&mut page).unwrap();
    let page = String::from_utf8(page).unwrap().replacen("<head>", &format!("<head><script>{ERRORS}</script>"), 1);
    assert!(page.contains("A &amp; B") && page.contains(&notes[0]));
    let (body, tail) = page.rsplit_once("</body>").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("page.html");
    fs::write(&file, format!("{body}<script>{TOOLS}{CHECKS}</script></body>{tail}")).unwrap();
    checks_in(&dump_dom(&file, folder.path(), window))
}

#[test]
fn nothing_that_vibrates_is_said() {
    let mut page = Vec::new();
    let (scene, notes) = (&sample::bodies::shapes().scene, ["nothing vibrates or falls off".to_string()]);
    ModesReport { title: "Still", model_text: "", provenance: &Value::Null, scene, modes: &[], notes: &notes }.write(&mut page).unwrap();
    let page = String::from_utf8(page).unwrap();
    assert!(page.contains(&notes[0]) && !page.contains("<table") && !page.contains("<script"), "{page}");
}
