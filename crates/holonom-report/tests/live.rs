//! The widget of notebooks in a browser, with a kernel of a few lines: it draws the frames it is sent, and sends what is pressed and drawn.
//!
//! Needs Chromium, as `browser.rs` does.
#![cfg(feature = "viewer")]

mod chromium;
mod sample;

use chromium::{TOOLS, WINDOW, checks_in, dump_dom};
use holonom_report::{Frames, LIVE};
use serde_json::{Value, json};
use std::fs;

/// What stands in for anywidget and the kernel: a model of values with listeners.
const KERNEL: &str = include_str!("checks/live.js");

#[test]
fn a_widget_shows_frames_and_sends_inputs() {
    let sample = sample::motor();
    let frames = Frames::new(&sample.scene, |name| sample.recording.column(name).is_some());
    let columns = frames.columns();
    let row = |row: usize| columns.iter().map(|name| sample.recording.column(name).unwrap()[row]).collect::<Vec<f64>>();
    let (script, style) = LIVE.unwrap();
    let given = json!({ "layout": serde_json::to_string(&frames).unwrap(), "style": style, "frames": [row(0), row(100), row(200)] });
    let folder = tempfile::tempdir().unwrap();
    let page = folder.path().join("page.html");
    let encoded = format!("data:text/javascript;base64,{}", data_encoding::BASE64.encode(script.as_bytes()));
    let kernel = KERNEL.replace("GIVEN", &given.to_string().replace("</", "<\\/")).replace("SCRIPT", &encoded);
    fs::write(&page, format!("<!DOCTYPE html><meta charset=utf-8><body><div id=cell></div><script>{TOOLS}</script><script type=module>{kernel}</script></body>"))
        .unwrap();
    let seen = checks_in(&dump_dom(&page, folder.path(), WINDOW));
    assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
    // The picture has something in it and follows the frames, also back to the start.
    assert!(seen["pictures"][0]["different"].as_u64().unwrap() > 500, "{seen:#}");
    assert_ne!(seen["pictures"][0]["hash"], seen["pictures"][1]["hash"], "{seen:#}");
    assert_eq!(seen["times"], json!(["0.00 s", "2.00 s", "0.00 s"]), "{seen:#}");
    // What is pressed and drawn is sent, and what the kernel says is shown.
    assert_eq!(seen["sent"], json!([{ "playing": true }, { "_restarts": 1 }, { "values": { "torque": 2.5 } }, { "speed": 2 }]), "{seen:#}");
    assert_eq!(seen["slider"], json!(["0 N·m", "2.5 N·m", "-5 N·m", "0"]), "{seen:#}");
    assert_eq!((&seen["button"], &seen["ended"]), (&Value::from("Pause"), &Value::from("it ended")), "{seen:#}");
    // The style sheet stays inside.
    assert_eq!(seen["outside"], "rgba(0, 0, 0, 0)", "{seen:#}");
    assert_eq!(seen["listeners"], json!([4, 0]), "{seen:#}");
}
