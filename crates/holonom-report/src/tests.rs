//! The page as a whole.

use crate::{Report, Run};
use holonom::record::{Anchor, Line, LineKind, PointKind, Recording, Scene, ScenePoint};
#[cfg(feature = "viewer")]
use holonom::record::{SceneBody, SceneLoad, SceneShape};
use serde_json::{Value, json};

const COLUMNS: [&str; 11] =
    ["t", "energy", "kinetic", "potential", "work", "dE_integrator", "dE_projection", "phi", "phi_dot", "phi_ddot", "iterations"];

fn recording(rows: usize, poison: f64) -> Recording {
    let point = ["x", "y", "vx", "vy"].map(|axis| format!("tip.{axis}"));
    let mut recording = Recording::new(COLUMNS.map(str::to_owned).into_iter().chain(point));
    for row in 0..rows {
        recording.push(&[row as f64, poison, 1.0, poison, 0.0, poison, 0.0, 1e-12, poison, 0.0, 2.0, 1.0, poison, 0.0, 0.0]);
    }
    recording
}

fn scene() -> Scene {
    Scene {
        axes: "xy".to_owned(),
        gravity: [0.0, -9.81, 0.0],
        points: vec![
            ScenePoint { name: "tip".to_owned(), kind: PointKind::Free, mass: 1.0 },
            ScenePoint { name: "unrecorded".to_owned(), kind: PointKind::Free, mass: 1.0 },
        ],
        lines: vec![Line {
            name: "rod".to_owned(),
            kind: LineKind::Rod,
            from: Anchor::Fixed([0.0; 3]),
            to: Anchor::Point("tip".to_owned()),
            along: None,
        }],
        ..Scene::default()
    }
}

fn page(title: &str, model_text: &str, recording: &Recording, summary: &Value) -> String {
    let scene = scene();
    let runs = [Run { label: title, recording, scene: &scene, summary }];
    let mut out = Vec::new();
    Report { title, model_text, runs: &runs, columns: &[] }.write(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

#[cfg(feature = "viewer")]
fn embedded(page: &str) -> Value {
    let (_, rest) = page.split_once(r#"id="holonom-data">"#).expect("the data are in the page");
    serde_json::from_str(rest.split_once("</script>").unwrap().0).expect("valid JSON")
}

#[test]
fn foreign_text_stays_text() {
    let nasty = "</script></pre><script>alert(1)</script><!-- & \"'";
    let page = page(nasty, nasty, &recording(3, 0.0), &json!({"reason": nasty, "status": nasty, nasty: nasty}));
    assert!(!page.contains("alert(1)</script>"));
    assert!(!page.contains("</pre><script>"));
    assert_eq!(page.matches("<!--").count(), 0);
    assert!(page.contains("&lt;/script&gt;"));
}

#[test]
fn status_and_figures_are_readable_without_a_script() {
    let summary = json!({
        "status": "stopped", "stopped_at": 1.5, "reason": "no convergence", "step": 0.01, "steps": 150,
        "method": {"name": "conserving"}, "energy": {"max_drift": 1.5e-9}, "dof": 2, "redundant": 0,
    });
    let page = page("t", "m", &recording(3, 0.0), &summary);
    for part in ["stopped at 1.5 s", "no convergence", "conserving", "10<sup>\u{2212}9</sup>", "degrees of freedom", "energy.max_drift"] {
        assert!(page.contains(part), "{part}");
    }
    assert!(!page.contains("time per step"), "the summary has no time");
}

#[test]
fn what_was_run_and_what_was_changed_stands_above_the_model() {
    let provenance = |key: &str, run: Value| {
        json!({"version": "9.8.7", "date": "2026-01-02T03:04:05Z", "command": "holonom run '<m>'", "model": "secret",
               "overrides": [{"key": "simulation.end", "file": 1.0, "run": "2*T<"}, {"key": key, "file": null, "run": run}]})
    };
    let summary = json!({"status": "completed", "provenance": provenance("parameters.k", json!(0.123456789012345))});
    let alone = page("t", "m", &recording(3, 0.0), &summary);
    for part in [
        "holonom 9.8.7",
        "2026-01-02T03:04:05Z",
        "holonom run &#39;&lt;m&gt;&#39;",
        ">parameters.k<",
        "<td>–</td>",
        "0.123456789012345",
        "2*T&lt;",
    ] {
        assert!(alone.contains(part), "{part}");
    }
    assert!(!alone.contains("secret") && !alone.contains(">provenance.") && !alone.contains(">runs</th>"));
    assert!(!page("t", "m", &recording(3, 0.0), &json!({"status": "completed"})).contains("What was run"));

    // What was changed for one run only says for which.
    let of = |key: &str| json!({"status": "completed", "provenance": provenance(key, json!(3))});
    let page = compared(&[("first", 1.0, of("parameters.a")), ("second", 1.0, of("parameters.b"))]);
    for (key, labels) in [("simulation.end", "all"), ("parameters.a", "first"), ("parameters.b", "second")] {
        let (_, row) = page.split_once(&format!("<th scope=\"row\">{key}</th>")).expect(key);
        assert!(row.split_once("</tr>").unwrap().0.ends_with(&format!("<td>{labels}</td>")), "{key}");
    }
}

#[test]
fn a_measure_that_is_zero_but_for_rounding_shows_zero() {
    let measure =
        |last: f64| json!({"name": "travel", "unit": "mm", "min": -80.0, "min_at": 0.75, "max": 80.0, "max_at": 0.25, "last": last});
    for (last, shown) in [(-2.08e-14, "0"), (0.25, "0.25"), (1e-9, "1.00")] {
        let page = page("t", "m", &recording(3, 0.0), &json!({"status": "completed", "peaks": {"measures": [measure(last)]}}));
        let row = page.split_once("travel").unwrap().1.split_once("</tr>").unwrap().0;
        assert!(row.contains(&format!(r#"0.25 s</small></td><td class="number">{shown}"#)), "{row}");
    }
}

#[test]
fn measures_beyond_a_dozen_are_folded() {
    let folded = |count: usize| {
        let measures: Vec<Value> = (0..count).map(|k| json!({"name": format!("m{k}-"), "unit": "m", "min": 0.0, "max": 1.0})).collect();
        let page = page("t", "m", &recording(3, 0.0), &json!({"status": "completed", "peaks": {"measures": measures}}));
        let (before, rest) = page.split_once("<details><summary>3 more measures</summary>")?;
        Some(before.contains("m11-") && !before.contains("m12-") && rest.split_once("</details>")?.0.contains("m14-"))
    };
    assert_eq!((folded(15), folded(12)), (Some(true), None));
}

#[test]
fn an_accuracy_stands_in_place_of_the_nominal_step() {
    let mut summary = json!({"step": 1e-5, "steps": 5000, "method": {"name": "radau", "accuracy": 1e-8}, "work": {"steps_taken": 93}});
    assert!(page("t", "m", &recording(3, 0.0), &summary).contains(" radau · accuracy 1e-8 · 93 steps taken<"));
    summary["method"]["accuracy"] = Value::Null;
    assert!(page("t", "m", &recording(3, 0.0), &summary).contains(" radau · step 1e-5 s · 5000 steps<"));
}

#[test]
fn notes_stand_right_below_how_the_run_ended() {
    let page = page("t", "m", &recording(3, 0.0), &json!({"status": "completed", "notes": ["a < b"]}));
    let (header, rest) = page.split_once("</header>").unwrap();
    assert!(header.contains("<strong>note:</strong> a &lt; b") && !rest.contains("a &lt; b"));
}

/// The rotations of bushings are sines, and plotted as all that bushings do; other numbers without a unit, such as orientations, are not.
#[cfg(feature = "viewer")]
#[test]
fn sines_of_bushings_are_plotted() {
    let mut recording = Recording::new(["t", "mount.r", "other"].map(str::to_owned));
    recording.push(&[0.0, 0.5, 1.0]);
    let bushings = vec![SceneLoad { name: "mount".to_owned(), at: Anchor::Fixed([0.0; 3]) }];
    let scene = Scene { bushings, ..scene() };
    let runs = [Run { label: "a", recording: &recording, scene: &scene, summary: &json!({"status": "completed"}) }];
    let mut out = Vec::new();
    Report { title: "t", model_text: "m", runs: &runs, columns: &[] }.write(&mut out).unwrap();
    let data = embedded(&String::from_utf8(out).unwrap());
    let names: Vec<&str> = data["runs"][0]["channels"].as_array().unwrap().iter().map(|one| one["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["mount.r"]);
}

#[test]
fn an_event_that_happens_often_takes_one_row() {
    let event = |name: &str, t: f64, stopped: bool| json!({"event": name, "t": t, "stopped": stopped});
    let mut events: Vec<Value> = (1..=60).map(|k| event("bounce", f64::from(k), false)).collect();
    events.push(event("end <stop>", 61.0, true));
    let page = page("t", "m", &recording(3, 0.0), &json!({"status": "completed", "events": events}));
    let table = page.split_once("<caption>Events</caption>").unwrap().1.split_once("</table>").unwrap().0;
    assert_eq!(table.matches("<tr>").count(), 2, "{table}");
    assert!(table.contains(r#"bounce <small>60 times</small></th><td>1, 2, 3, 4, … <small>s</small>"#), "{table}");
    assert!(table.contains(r#"end &lt;stop&gt; <small>end of the run</small></th><td>61 <small>s</small>"#), "{table}");
}

/// A page that compares runs of summaries, each with a recording of its kinetic energy.
fn compared(cases: &[(&str, f64, Value)]) -> String {
    let recordings: Vec<Recording> = cases.iter().map(|(_, kinetic, _)| moving(*kinetic)).collect();
    let scene = scene();
    let pairs = cases.iter().zip(&recordings);
    let runs: Vec<Run> = pairs.map(|((label, _, summary), recording)| Run { label, recording, scene: &scene, summary }).collect();
    let mut out = Vec::new();
    Report { title: "t", model_text: "m", runs: &runs, columns: &[] }.write(&mut out).unwrap();
    String::from_utf8(out).unwrap()
}

fn moving(kinetic: f64) -> Recording {
    let mut recording = Recording::new(["t", "energy", "kinetic", "tip.x", "tip.y"].map(str::to_owned));
    recording.push(&[0.0, 1.0, kinetic, 1.0, 0.0]);
    recording
}

fn summary(status: &str, drift: f64, time: f64) -> Value {
    json!({
        "label": "not shown", "status": status, "step": 0.01, "end": 2.0, "dof": 1, "method": {"formulation": "ggl", "index": 2},
        "energy": {"max_drift": drift}, "time": {"us_per_step": time},
    })
}

#[test]
fn runs_are_compared_in_a_table_with_the_best_marked() {
    let page = compared(&[
        ("exact", 9.0, summary("completed", 2e-13, 40.0)),
        ("as exact", 9.0, summary("completed", 3e-13, 41.0)),
        ("blown up", 9e9, summary("completed", 1e10, 1.0)),
        ("stopped", 9.0, summary("stopped", 1e-14, 2.0)),
    ]);
    let body = |class: &str| {
        let (_, table) = page.split_once(&format!(r#"<table class="{class}">"#)).unwrap();
        table.split_once("<tbody>").unwrap().1.split_once("</tbody>").unwrap().0
    };
    let table = body("figures compared");
    let best: Vec<&str> = table.split("class=\"best\">").skip(1).map(|rest| rest.split_once("</strong>").unwrap().0).collect();
    let power = "\u{202f}×\u{202f}10<sup>\u{2212}13</sup>";
    assert_eq!(best, [&format!("2.00{power}"), "40", &format!("3.00{power}"), "41"]);
    // How the runs ended is said at the top, too.
    assert_eq!(["answers", "figures compared"].map(|class| body(class).matches("energy blew up").count()), [1, 1]);
    assert!(page.contains("4 runs compared · 2 s · step 0.01 s · 1 degree of freedom"));
    assert!(table.contains("ggl, index\u{a0}2") && !table.contains("step 0.01 s"));
}

/// Columns of more than eight runs are wider than a page: their tables stand one above the other.
#[test]
fn many_runs_are_compared_without_scrolling() {
    for (count, parts) in [(8, vec![8]), (9, vec![5, 4]), (12, vec![6, 6]), (20, vec![7, 7, 6])] {
        let names: Vec<String> = (0..count).map(|k| format!("run {k}")).collect();
        let of = |k: usize| {
            let mut summary = summary("completed", 0.1 + k as f64, 1.0);
            summary["peaks"] = json!({ "joints": [{"name": "hinge", "unit": "N", "value": 50.0 + k as f64, "at": 1.0}] });
            summary
        };
        let runs: Vec<(&str, f64, Value)> = names.iter().enumerate().map(|(k, name)| (name.as_str(), 9.0, of(k))).collect();
        let page = compared(&runs);
        for table in ["answers", "summary compact"] {
            let begin = format!(r#"<table class="{table}">"#);
            let tables = page.split(&begin).skip(1).map(|rest| rest.split_once("</table>").unwrap().0);
            let columns: Vec<usize> = tables.clone().map(|table| table.matches(r#"<th scope="col""#).count()).collect();
            assert_eq!(columns, parts, "{table} of {count} runs");
            for (table, columns) in tables.zip(&parts) {
                let rows = table.split_once("<tbody>").unwrap().1.split("<tr>").skip(1);
                assert!(rows.clone().count() > 0 && rows.clone().all(|row| row.matches("<td").count() == *columns), "{table}");
            }
        }
        assert!(names.iter().all(|name| page.matches(&format!("{name}</th>")).count() >= 2), "{count} runs");
    }
}

#[test]
fn answers_come_before_the_health_of_the_solver() {
    let run = |lift: f64, drift: f64| {
        let mut summary = summary("completed", drift, 1.0);
        summary["peaks"] = json!({
            "measures": [{"name": "<lift>", "unit": "mm", "min": -2e-15, "max": lift, "last": 1.0}],
            "joints": [{"name": "hinge", "unit": "N", "value": 49.883_451, "at": 1.0}],
        });
        summary
    };
    let mut second = run(8.04, 0.2);
    second["differences"] = json!({"tip.x": {"largest": 0.0123, "at": 1.5, "rms": 0.01}});
    let page = compared(&[("a", 9.0, run(8.0, 0.1)), ("b", 9.0, second)]);
    let table = page.split_once(r#"<table class="answers">"#).unwrap().1.split_once("</table>").unwrap().0;
    let rows: Vec<&str> = table.split_once("<tbody>").unwrap().1.split("<tr>").skip(1).collect();
    let begins = ["tip.x largest difference", "&lt;lift&gt; least", "&lt;lift&gt; largest", "&lt;lift&gt; last", "hinge largest <small>N"];
    assert!(
        rows.len() == 5 && rows.iter().zip(begins).all(|(row, begin)| row.contains(&format!(r#"<th scope="row">{begin}"#))),
        "{rows:?}"
    );
    assert!(rows[0].contains(r#"<td class="number">–</td>"#) && rows[0].contains("0.0123 <small>at 1.5 s"), "{}", rows[0]);
    assert!(rows[1].contains(r#"<td class="number">0</td>"#) && rows[2].contains("8.04 <small>+0.50 %"), "{rows:?}");
    assert!(rows[4].matches(r#"<td class="number">49.883</td>"#).count() == 2, "{}", rows[4]);
    assert!(page.find("class=\"answers\"") < page.find("energy drift"), "{page}");
    // Differences lead the summary.
    let of_each = page.split_once("Of each run").unwrap().1.split_once("<tbody>").unwrap().1;
    assert!(of_each.starts_with("\n<tr><th scope=\"row\">differences.tip.x.largest"), "{of_each}");
}

#[test]
fn what_differs_between_runs_is_said_of_each() {
    let with_step = |step: f64| json!({"step": step, "end": 2.0, "label": "a label"});
    let page = compared(&[("a", 1.0, with_step(0.01)), ("b", 1.0, with_step(0.02))]);
    assert!(page.contains("2 runs compared · 2 s<") && page.contains("step 0.01 s</small>") && page.contains("step 0.02 s</small>"));
    let (shared, differing) = page.split_once("Of each run").unwrap();
    let row = |key: &str| format!(r#"<th scope="row">{key}"#);
    assert!(shared.contains(&row("end")) && !shared.contains(&row("step")));
    assert!(differing.contains(&row("step")) && !differing.contains(&row("end")) && !page.contains(&row("label")));
}

#[test]
#[cfg(feature = "viewer")]
fn axes_are_told_which_runs_are_sound() {
    let page = compared(&[("a", 9.0, summary("completed", 0.1, 1.0)), ("b", 9e9, summary("completed", 1e10, 1.0))]);
    let runs = &embedded(&page)["runs"];
    assert_eq!((&runs[0]["sound"], &runs[1]["sound"]), (&json!(true), &json!(false)));
}

#[test]
fn nothing_is_loaded_from_elsewhere() {
    let page = page("t", "m", &recording(3, 0.0), &json!({}));
    for way in ["<link rel=\"stylesheet", "<script src", "@import", "url(http", "src=\"http", "href=\"http"] {
        assert!(!page.contains(way), "{way}");
    }
    assert!(page.contains("default-src 'none'"));
}

#[test]
#[cfg(feature = "viewer")]
fn every_column_is_in_the_page() {
    let page = page("t", "m", &recording(5, 0.5), &json!({}));
    let run = &embedded(&page)["runs"][0];
    for name in COLUMNS.into_iter().chain(["drift", "sum_dE_integrator", "sum_dE_projection"]) {
        // 5 rows of 8 bytes
        assert_eq!(run["columns"][name].as_str().map(str::len), Some(56), "{name}");
    }
    // 5 rows of 2 coordinates of 4 bytes
    assert_eq!(run["points"]["tip"].as_str().map(str::len), Some(56));
    assert!(run["points"].get("unrecorded").is_none());
    assert_eq!(run["scene"]["lines"][0]["to"], json!({"point": "tip"}));
}

/// A page about a body called "top", in space or in the plane xy, whose columns are given; the run of its data.
#[cfg(feature = "viewer")]
fn with_body(axes: &str, columns: &[&str]) -> Value {
    let names = std::iter::once("t".to_owned()).chain(columns.iter().map(|column| format!("top.{column}")));
    let mut recording = Recording::new(names);
    recording.push(&vec![0.0; columns.len() + 1]);
    let shape = SceneShape::Mesh { vertices: vec![[0.1, 0.0, 0.0]; 3], triangles: vec![[0, 1, 2]] };
    let scene = Scene {
        axes: axes.to_owned(),
        bodies: vec![SceneBody { name: "top".to_owned(), mass: 1.0, shape: Some(shape), places: Vec::new() }],
        ..Scene::default()
    };
    let run = |label| Run { label, recording: &recording, scene: &scene, summary: &Value::Null };
    let mut out = Vec::new();
    Report { title: "t", model_text: "m", runs: &[run("a"), run("b")], columns: &[] }.write(&mut out).unwrap();
    embedded(&String::from_utf8(out).unwrap())["runs"].take()
}

#[test]
#[cfg(feature = "viewer")]
fn bodies_have_a_place_and_an_orientation() {
    // base64 of one row of 7 and of 3 coordinates of 4 bytes
    let runs = with_body("xyz", &["x", "y", "z", "vx", "qw", "qx", "qy", "qz"]);
    assert_eq!(runs[0]["bodies"]["top"].as_str().map(str::len), Some(40));
    let runs = with_body("xy", &["x", "y", "angle"]);
    assert_eq!(runs[0]["bodies"]["top"].as_str().map(str::len), Some(16));
    assert!(with_body("xyz", &["x", "y", "z"])[0]["bodies"].get("top").is_none(), "without orientation there is nothing to draw");
}

#[test]
#[cfg(feature = "viewer")]
fn a_mesh_is_in_the_page_once_and_in_few_digits() {
    let runs = with_body("xyz", &[]);
    let shape = &runs[0]["scene"]["bodies"][0]["shape"];
    assert_eq!((&shape["kind"], shape["vertices"][0].to_string()), (&json!("mesh"), "[0.1,0.0,0.0]".to_owned()));
    assert_eq!(runs[1]["scene"], Value::Null, "the second run has the scene of the first");
}

#[test]
#[cfg(feature = "viewer")]
fn ends_of_lines_can_be_on_bodies() {
    let anchor = Anchor::Body { body: "top".to_owned(), at: [1.0, 2.0, 3.0] };
    assert_eq!(serde_json::to_value(anchor).unwrap(), json!({"body": {"body": "top", "at": [1.0, 2.0, 3.0]}}));
}

#[test]
#[cfg(feature = "viewer")]
fn not_a_number_does_not_break_the_page() {
    for poison in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let page = page("t", "m", &recording(5, poison), &json!({}));
        assert_eq!(embedded(&page)["runs"][0]["recorded"], 5);
    }
}

#[test]
#[cfg(feature = "viewer")]
fn long_recordings_are_thinned_and_say_so() {
    let page = page("t", "m", &recording(40_001, 0.0), &json!({}));
    assert_eq!(embedded(&page)["runs"][0]["stride"], 11);
    assert!(page.contains("one in 11 of 40001 recorded rows"));
}

#[test]
#[cfg(not(feature = "viewer"))]
fn without_the_viewer_the_page_says_so() {
    let page = page("t", "m", &recording(5, f64::NAN), &json!({}));
    assert!(page.contains("left out") && !page.contains("<script"));
}

#[test]
fn no_rows_and_no_runs_are_fine() {
    page("t", "m", &recording(0, 0.0), &json!({}));
    let mut out = Vec::new();
    Report { title: "t", model_text: "m", runs: &[], columns: &[] }.write(&mut out).unwrap();
}

/// Sensors are read at different times, and cells between are empty; before the first number and after the last there is nothing.
#[cfg(feature = "viewer")]
#[test]
fn measured_curves_go_straight_across_empty_cells() {
    let heading = |name: &str, unit: &'static str| holonom::record::Heading { name: name.into(), unit: unit.into(), meaning: "".into() };
    let mut recording = Recording::new([heading("t", "s"), heading("strut.force", "N")]);
    let rows = [(0.0, f64::NAN), (1.0, 2.0), (2.0, f64::NAN), (3.0, f64::NAN), (5.0, 10.0), (6.0, f64::NAN)];
    rows.iter().for_each(|(t, force)| recording.push(&[*t, *force]));
    let values = |status: &str| {
        let data = embedded(&page("t", "m", &recording, &json!({ "status": status })));
        data["runs"][0]["channels"][0]["values"].as_str().unwrap().to_string()
    };
    const NONE: f32 = f32::NAN;
    assert_eq!(values("measured"), crate::base64::singles(&[NONE, 2.0, 4.0, 6.0, 10.0, NONE]));
    assert_eq!(values("completed"), crate::base64::singles(&[NONE, 2.0, NONE, NONE, 10.0, NONE]), "a run has nothing there");
}
