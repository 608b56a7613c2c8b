//! Opens reports in a browser and uses them: they load without a complaint, show something, and react.
//!
//! Needs Chromium (`apt install chromium`), or a relative of it named in the environment variable `CHROMIUM`. To look at the
//! pages yourself, name a folder in `HOLONOM_KEEP_PAGES`.
#![cfg(feature = "viewer")]

mod chromium;
mod sample;

use chromium::{TOOLS, WINDOW, checks_in, dump_dom};
use holonom::record::{SceneWheels, WheelsKind};
use holonom_report::{Report, Run};
use sample::Sample;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const ERRORS: &str = include_str!("checks/errors.js");
const CHECKS: &str = include_str!("checks/checks.js");
const MODEL: &str = "title = \"Spherical compound pendulum\"\n\n[point.m1]\nmass = 1.0\nposition = [1, 0, 0]\n";

#[test]
fn one_run() {
    let seen = open("single", &[sample::pendulum("conserving-ggl", 0.025, 800, 1.0)]);
    loads(&seen, 8);
    moves(&seen, 20.0);
    // The space bar plays and pauses, but not in a field, and arrows step from row to row.
    assert_eq!(seen["keys"], json!([false, "Pause", "Pause", false, "Play"]), "{seen:#}");
    assert_eq!(seen["stepped"], 0.025, "{seen:#}");
    // A legend entry belongs to one plot here.
    assert_eq!((&seen["legend"]["pressed"], &seen["legend"]["changed"]), (&Value::from("false"), &Value::from(1)), "{seen:#}");
    assert_eq!(seen["legendBack"], 0, "{seen:#}");
}

#[test]
fn what_the_machine_does_comes_first() {
    let seen = open("machine", &[sample::motor()]);
    // The measure, efforts and angles; the solver's health is folded away, and a column is plotted when it is asked for.
    let health = 3;
    loads(&seen, 3 + health);
    let machine = &seen["machine"];
    assert_eq!(
        (&machine["first"], &machine["healthIsOpen"]),
        (&Value::from(vec!["lift", "crank.effort (N·m)", "hinge.angle (rad)"]), &Value::from(false))
    );
    assert_eq!((&machine["asked"], &machine["left"]), (&Value::from("crank.power (W)"), &Value::from(3)), "{seen:#}");
    assert_eq!(machine["options"], 4, "{seen:#}");
    // Another x axis makes a path of it, whose nearest row is told with its time.
    assert_eq!(machine["over"], json!(["crank.power (W) over hinge.angle (rad)", true]), "{seen:#}");
    let pointed = machine["pointed"].as_str().unwrap();
    assert!(pointed.starts_with("t = ") && pointed.contains(" W at hinge.angle = "), "{pointed}");
    // The parabola t (3 − t)/2 is highest at 1.5 s, where the table leads to.
    let extremes: Vec<&str> = machine["extremes"].as_array().unwrap().iter().map(|row| row.as_str().unwrap()).collect();
    assert!(extremes.contains(&"lift 0 0 s 1.125 1.500 s"), "{extremes:?}");
    assert_eq!((extremes.len(), &machine["wentTo"]), (4, &Value::from(1.5)), "{seen:#}");
    // Numbers and pictures can be taken away.
    let taken = &seen["taken"];
    assert_eq!(
        taken["names"],
        json!(["Slider.csv", "Slider-picture.png", "Slider-lift.png", "Slider-crank.effort-N-m.png", "Slider-hinge.angle-rad.png"])
    );
    let lines: Vec<&str> = taken["numbers"].as_str().unwrap().lines().collect();
    assert_eq!((lines.len(), lines[0], lines[1]), (301, "t,lift,crank.effort,hinge.angle", "0,0,0,0"));
    let row: Vec<f64> = lines[151].split(',').map(|number| number.parse().unwrap()).collect();
    assert_eq!(lines[151].split(',').take(2).collect::<Vec<_>>(), ["1.5", "1.125"]);
    assert!((row[2] - 2.0 * 1.5_f64.sin()).abs() < 1e-7 && (row[3] - 0.45).abs() < 1e-8, "{row:?}");
    for picture in taken["pictures"].as_array().unwrap() {
        assert_eq!((&picture[0], &picture[1]), (&Value::from("image/png"), &Value::from(true)), "{seen:#}");
        assert!(picture[2].as_u64().unwrap() > 300 && picture[3].as_u64().unwrap() > 200, "{seen:#}");
    }
}

/// Events are lines in plots at their times, with their names; those that happen too often for that are not.
#[test]
fn events_are_marked_in_plots() {
    let mut sample = sample::motor();
    let often = (1..=100).map(|k| json!({"event": "tooth", "t": 0.029 * f64::from(k), "stopped": false}));
    let seldom = [("top", 1.5), ("late", 2.392)].map(|(name, t)| json!({"event": name, "t": t, "stopped": false}));
    sample.summary["events"] = often.chain(seldom).collect();
    let seen = open("events", &[sample]);
    assert_eq!(seen["events"], json!([["top at 1.500 s", 50], ["late at 2.392 s", 80]]), "{seen:#}");
}

/// Long names of runs on a narrow screen: the legend does not go beyond it, and the choice of what is shown is free of the buttons.
#[test]
fn a_narrow_screen_has_room_for_long_names() {
    let named = |label: &str| {
        let label = format!("simulation.method={label},body.connecting_rod.mass=0.25,parameters.spin=3.125,parameters.length=12");
        sample::pendulum(&label, 0.025, 100, 1.0)
    };
    let runs = [named("generalized-alpha"), named("conserving-projected")];
    for window in [[500, 900], WINDOW] {
        let seen = open_at("narrow", &runs, &[], window);
        assert_eq!((&seen["faults"], &seen["ready"]), (&Value::Array(Vec::new()), &Value::Bool(true)), "{seen:#}");
        assert_eq!(seen["layout"], json!({"legendFits": true, "choiceIsFree": true, "choiceFits": true}), "{window:?} {seen:#}");
    }
}

#[test]
fn a_run_beside_what_was_measured() {
    let run = sample::motor();
    let measured = sample::measured(&run, "crank.power", 0.0);
    for samples in [[run, measured], [sample::measured(&sample::motor(), "crank.power", 0.0), sample::motor()]] {
        let seen = open_with("measured", &samples, &["crank.power".to_string()]);
        assert_eq!((&seen["faults"], &seen["ready"]), (&Value::Array(Vec::new()), &Value::Bool(true)), "{seen:#}");
        // What is asked for takes the place of what is shown otherwise, and has a curve for each.
        assert_eq!(seen["machine"]["first"], Value::from(vec!["crank.power (W)"]), "{seen:#}");
        assert_eq!((&seen["emptyPlots"], &seen["samples"]), (&Value::from(0), &Value::from(4)), "{seen:#}");
    }
    // The pointer is at a quarter of the time, when nothing was measured yet.
    let run = sample::motor();
    let late = sample::measured(&run, "crank.power", 1.5);
    let seen = open_with("late", &[run, late], &["crank.power".to_string()]);
    assert_eq!(seen["readout"]["names"].as_array().map(Vec::len), Some(1), "{seen:#}");
}

#[test]
fn two_runs_compared() {
    let runs = [sample::pendulum("conserving-ggl", 0.025, 800, 1.0), sample::pendulum("trapezoidal", 0.04, 500, 30.0)];
    let seen = open("compare", &runs);
    loads(&seen, 10);
    moves(&seen, 20.0);
    // The legend switches a run off in every plot.
    assert_eq!((&seen["legend"]["pressed"], &seen["legend"]["changed"]), (&Value::from("false"), &Value::from(10)), "{seen:#}");
    assert_eq!(seen["legendBack"], 0, "{seen:#}");
}

#[test]
fn ten_runs_and_one_of_them_blows_up() {
    let mut runs: Vec<Sample> = (0..9).map(|k| sample::pendulum(&format!("method {k}"), 0.05, 400, 1.0 + f64::from(k))).collect();
    runs.insert(4, sample::pendulum("wild", 0.05, 400, 1e12));
    let seen = open("ten", &runs);
    loads(&seen, 10);
    moves(&seen, 20.0);
    // It leaves the axes of energy, which the others would else be flat lines on; logarithmic axes have room for it.
    let beyond: Vec<&str> = seen["beyond"].as_array().unwrap().iter().map(|text| text.as_str().unwrap()).collect();
    assert_eq!(beyond.len(), 10, "{seen:#}");
    assert!(beyond[0].starts_with("beyond the axis: wild from 0.05000 s (to "), "{seen:#}");
    assert!(beyond[1..6].iter().all(|text| text.is_empty()), "{seen:#}");
    // Ten runs and all of them; the first is shown, and another one looks different.
    assert_eq!((&seen["choice"]["options"], &seen["choice"]["first"][0]), (&Value::from(11), &Value::from("0")), "{seen:#}");
    assert_ne!(seen["choice"]["first"][1], seen["choice"]["second"][1], "the picture does not follow the choice");
    assert_eq!(seen["samples"], 20, "a sample of every curve is in the table of how they ended and in that of the solver: {seen:#}");
    let names = seen["readout"]["names"].as_array().unwrap();
    assert_eq!(
        (names.len(), &seen["readout"]["hidden"], &seen["readout"]["left"]),
        (10, &Value::from(false), &Value::from(true)),
        "{seen:#}"
    );
    // The pointer on the legend fades the others in every plot; a double click leaves one run, a button brings all back.
    assert_eq!((&seen["highlighted"], &seen["only"]), (&Value::from(10), &Value::from(1)), "{seen:#}");
    assert_eq!(seen["all"], Value::from(vec![10, 0]), "{seen:#}");
}

#[test]
fn planar_and_stopped_early() {
    let seen = open("slider", &[sample::slider()]);
    loads(&seen, 3);
    let place = &seen["middle"]["points"]["block"];
    assert_eq!((&place[1], &place[2]), (&Value::from(0), &Value::from(0)), "the missing coordinate is 0: {seen:#}");
}

#[test]
fn solids_of_every_shape() {
    let seen = open("shapes", &[sample::bodies::shapes()]);
    loads(&seen, 3);
    bodies_move(&seen, "brick", 6);
}

#[test]
fn sketches_and_joints_in_space() {
    let seen = open("crank", &[sample::bodies::crank_in_space()]);
    loads(&seen, 3);
    bodies_move(&seen, "slider", 7);
}

#[test]
fn bodies_in_a_plane() {
    let seen = open("four-bar", &[sample::bodies::four_bar(2.5)]);
    loads(&seen, 3);
    bodies_move(&seen, "coupler", 6);
    assert_eq!(seen["middle"]["bodies"]["coupler"][1], 0, "the missing coordinate is 0: {seen:#}");
    home_leads_back(&seen);
}

/// A ring around the mechanism, fixed in the world, and the wheel that runs in it: the view has room for both.
#[test]
fn wheels_of_gears_are_in_the_picture() {
    let mut geared = sample::bodies::four_bar(2.5);
    let (joints, bodies) = (["axle", "a"].map(String::from), [Some("wheel".to_owned()), None]);
    geared.scene.wheels.push(SceneWheels {
        name: "mesh".to_owned(),
        kind: WheelsKind::Gear,
        joints,
        bodies,
        radii: [Some(1.0), Some(5.0)],
    });
    // Pixels between the wheel and the block, which keeps its place.
    let apart = |seen: &Value| {
        let [wheel, block] = [4, 3].map(|body| [0, 1].map(|k| seen["start"]["screen"][body][k].as_f64().unwrap()));
        (wheel[0] - block[0]).hypot(wheel[1] - block[1])
    };
    let [without, with] = [open("ungeared", &[sample::bodies::four_bar(2.5)]), open("geared", &[geared])].map(|seen| apart(&seen));
    assert!(with < 0.4 * without, "{with} of {without} px");
}

/// Single precision has steps of 6 cm there.
#[test]
fn far_from_the_origin_a_mechanism_looks_the_same() {
    let by = [1e6, 0.0, -1e6];
    let near = open("near", &[sample::bodies::four_bar(2.5)]);
    let far = open("far", &[sample::bodies::moved(sample::bodies::four_bar(2.5), by)]);
    bodies_move(&far, "coupler", 6);
    let numbers = |value: &Value| value.as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<f64>>();
    for (one, other) in near["middle"]["screen"].as_array().unwrap().iter().zip(far["middle"]["screen"].as_array().unwrap()) {
        let apart = numbers(one).iter().zip(numbers(other)).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 0.01, "{apart} px: {one} and {other}");
    }
    // Places that a page tells are those of the world.
    let [here, there] = [&near, &far].map(|seen| numbers(&seen["middle"]["bodies"]["coupler"]));
    let apart = (0..3).map(|k| (there[k] - here[k] - by[k]).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-6, "{here:?} {there:?}");
}

#[test]
fn names_selection_and_forces() {
    let seen = open("driven", &[sample::bodies::driven()]);
    assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
    let picked = &seen["picked"];
    assert_eq!(picked["names"], json!(["coupler body", "strut cylinder", "tie bar"]), "{seen:#}");
    let around = picked["aroundHinge"].as_array().unwrap();
    assert!(around.contains(&json!("a revolute joint")) && around.contains(&json!("motor drive of a")), "{around:?}");
    // On the coupler act its joint, spring, load and weight; its columns are plotted before all others.
    assert_eq!(picked["selected"], "Selected: coupler body ×", "{seen:#}");
    assert_eq!(picked["plots"], json!(["coupler (m/s)", "motor.effort (N·m)", "strut.effort (N)"]), "{seen:#}");
    assert_eq!(picked["forces"], json!(["b 5 N", "spring 2 N", "load 6 N", "weight 9.810 N"]), "{seen:#}");
    // What the joint does to the coupler points to the right and up, and what it does to the crank the other way.
    let [on_coupler, on_crank] = ["towards", "towardsCrank"].map(|which| {
        let towards: Vec<f64> = picked[which].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect();
        (towards[0] > 0.0, towards[1] < 0.0)
    });
    assert_eq!((on_coupler, on_crank), ((true, true), (false, false)), "{seen:#}");
    assert_eq!(picked["crankForces"], json!(["motor 7 N·m", "b 5 N", "weight 9.810 N"]), "{seen:#}");
    assert_eq!(picked["strut"], json!(["strut 30 N", "strut 30 N"]), "{seen:#}");
    // Escape leaves nothing of it, and a joint of which nothing is recorded says so.
    assert_eq!(picked["cleared"], json!([true, [], picked["first"]]), "{seen:#}");
    assert_eq!(picked["joint"], "Selected: c revolute joint, of which no column is recorded ×", "{seen:#}");
}

#[test]
fn bodies_are_seen_through_and_hidden() {
    let seen = open("looks", &[sample::bodies::driven()]);
    assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
    let looks = &seen["looks"];
    assert_eq!(looks["words"], json!(["shown", "transparent", "hidden", "shown"]), "{seen:#}");
    let pictures = looks["pictures"].as_array().unwrap();
    assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2] && pictures[0] != pictures[2], "{seen:#}");
    assert_eq!(pictures[0], pictures[3], "shown again it looks as before");
    // What is hidden is not under the pointer, and one switch hides all.
    assert_eq!((&looks["under"], &looks["all"]), (&json!(["coupler body", "coupler body", "", "coupler body"]), &json!(6)), "{seen:#}");
}

#[test]
fn bodies_of_two_runs() {
    let mut other = sample::bodies::four_bar(2.0);
    other.label = "trapezoidal".to_owned();
    let seen = open("two-linkages", &[sample::bodies::four_bar(2.5), other]);
    assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
    bodies_move(&seen, "rocker", 6);
}

/// The picture goes with what goes far beyond its own size: it stays where it is on the screen, and large.
#[test]
fn a_cart_is_followed() {
    let seen = open("cart", &[sample::bodies::cart()]);
    bodies_move(&seen, "cart", 2);
    home_leads_back(&seen);
    let screen = |moment: &str| -> Vec<f64> {
        let places = seen[moment]["screen"].as_array().unwrap().iter().flat_map(|place| place.as_array().unwrap());
        places.map(|x| x.as_f64().unwrap()).collect()
    };
    let [start, middle] = ["start", "middle"].map(screen);
    assert!(start.iter().zip(&middle).all(|(before, after)| (before - after).abs() < 1.0), "{seen:#}");
    // Both are 0.2 m of 1 m apart.
    assert!(start[1] - start[3] < -30.0, "{seen:#}");
}

/// A track is part of the machine: it is there where its car, and any symbol on it, is too small to see.
#[test]
fn a_track_is_drawn() {
    let [whole, short] = [("track", 1.0), ("no-track", 1e-3)].map(|(name, turns)| {
        let seen = open(name, &[sample::bodies::track(turns)]);
        bodies_move(&seen, "car", 1);
        assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
        seen["start"]["picture"]["different"].as_u64().unwrap()
    });
    assert!(whole > short + 500, "{whole} pixels with the track and {short} without");
}

#[test]
fn numbers_out_of_all_bounds() {
    loads(&open("blown-up", &[sample::blown_up()]), 3);
}

/// An energy of 1, and efforts up to 2, in units in which they are tiny or huge, also where single precision has no such numbers. Tiny efforts count as
/// rounding.
#[test]
fn axes_have_ticks_in_any_unit() {
    let efforts = ["0.5", "1.0", "1.5", "2.0"];
    for (unit, power, efforts) in [
        (1e-60, "·10⁻⁶⁰", &[][..]),
        (1e-25, "·10⁻²⁵", &[]),
        (1e35, "·10³⁵", &efforts),
        (1e45, "·10⁴⁵", &efforts),
        (1e300, "·10³⁰⁰", &efforts),
    ] {
        let seen = open("units", &[sample::motor_of(unit)]);
        loads(&seen, 6);
        let written = seen["written"].as_array().unwrap().iter();
        let ticks: Vec<&str> = written.filter_map(|text| text.as_str()?.strip_suffix(power)).collect();
        assert_eq!(ticks, [efforts, &["0.950", "0.975", "1.000", "1.025", "1.050"]].concat(), "{unit:e}: {}", seen["written"]);
    }
}

#[test]
fn nothing_to_show() {
    let seen = open("empty", &[sample::empty()]);
    assert_eq!((&seen["faults"], &seen["ready"]), (&Value::Array(Vec::new()), &Value::Bool(true)), "{seen:#}");
}

fn loads(seen: &Value, plots: u64) {
    assert_eq!(seen["faults"], Value::Array(Vec::new()), "{seen:#}");
    assert_eq!(seen["ready"], true);
    assert_eq!((&seen["plots"], &seen["emptyPlots"]), (&Value::from(plots), &Value::from(0)), "{seen:#}");
    let drawn = seen["start"]["picture"]["different"].as_u64().unwrap();
    assert!(drawn > 1000, "the picture is blank: {seen:#}");
}

fn moves(seen: &Value, end: f64) {
    let time = |moment: &str| seen[moment]["time"].as_f64().unwrap();
    assert_eq!((time("start"), time("middle")), (0.0, end / 2.0), "{seen:#}");
    assert_ne!(seen["start"]["picture"]["hash"], seen["middle"]["picture"]["hash"], "the picture does not follow the slider");
    assert_ne!(seen["start"]["points"]["m2"], seen["middle"]["points"]["m2"]);
    let place = seen["middle"]["points"]["m2"].as_array().unwrap();
    let length = place.iter().map(|x| x.as_f64().unwrap().powi(2)).sum::<f64>().sqrt();
    assert!((length - 2.0).abs() < 1e-5, "m2 is 2 m from the origin, not {length} m");
    assert!((time("end") - end).abs() < 1e-9 && seen["end"]["slider"] == true, "{seen:#}");
    let playing = seen["playing"].as_f64().unwrap();
    assert!(playing > 0.0 && playing < end, "playing moves time: {seen:#}");
}

/// Once at the start, after the wheel was turned, and after the view was reset.
fn home_leads_back(seen: &Value) {
    assert_eq!(seen["home"][0], seen["home"][2], "the view is not reset: {seen:#}");
    assert_ne!(seen["home"][0], seen["home"][1], "the wheel does not zoom: {seen:#}");
}

fn bodies_move(seen: &Value, name: &str, count: usize) {
    assert_eq!(seen["start"]["bodies"].as_object().unwrap().len(), count, "{seen:#}");
    assert_ne!(seen["start"]["bodies"][name], seen["middle"]["bodies"][name], "{seen:#}");
    assert_ne!(seen["start"]["picture"]["hash"], seen["middle"]["picture"]["hash"], "the picture does not follow the slider");
}

/// What the checks saw in the page.
fn open(name: &str, samples: &[Sample]) -> Value {
    open_with(name, samples, &[])
}

/// The same where some columns are asked for.
fn open_with(name: &str, samples: &[Sample], columns: &[String]) -> Value {
    open_at(name, samples, columns, WINDOW)
}

/// The same in a window of this width and height, px.
fn open_at(name: &str, samples: &[Sample], columns: &[String], window: [u32; 2]) -> Value {
    let runs: Vec<Run> =
        samples.iter().map(|s| Run { label: &s.label, recording: &s.recording, scene: &s.scene, summary: &s.summary }).collect();
    let mut page = Vec::new();
    Report { title: samples[0].summary["model"].as_str().unwrap(), model_text: MODEL, runs: &runs, columns }.write(&mut page).unwrap();
    assert!(page.len() < 3_000_000, "the page has {} bytes", page.len());
    if let Some(folder) = std::env::var_os("HOLONOM_KEEP_PAGES") {
        fs::write(Path::new(&folder).join(format!("{name}.html")), &page).unwrap();
    }
    let page = String::from_utf8(page).unwrap();
    let page = page.replacen("<head>", &format!("<head><script>{ERRORS}</script>"), 1);
    let (body, tail) = page.rsplit_once("</body>").unwrap();
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("page.html");
    fs::write(&file, format!("{body}<script>{TOOLS}{CHECKS}</script></body>{tail}")).unwrap();
    checks_in(&dump_dom(&file, folder.path(), window))
}
