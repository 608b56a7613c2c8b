//! `[start] equilibrium`: runs that begin where all forces balance, beside closed forms of statics.

mod common;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_6};

use common::{freedom, model, run, source};
use holonom::analysis::modes;
use holonom::simulation::Choice;

const G: f64 = 9.81;
const BEGIN: &str = "[start]\nequilibrium = true\n[simulation]\nend = 2\nstep = 0.01\n";

/// A ball of 11 mg that carries a rod of 32 g, on springs.
const RIDGE: &str = r#"
gravity = [9.39213, 2.83193, -0.0647654]
[body.b0]
mass = 1.05651e-05
position = [0.0248655, 0, -0.0124328]
shape = { sphere = 0.00155595 }
[joint.j0]
type = "spherical"
between = ["ground", "b0"]
at = [0, 0, -0.0124328]
[body.b1]
mass = 0.0316279
position = [0.0248655, 0, -0.0124328]
orientation = { quat_wxyz = [0.295088, -0.796838, -0.311193, 0.425594] }
shape = { rod = 0.00476702 }
[joint.j1]
type = "revolute"
between = ["b0", "b1"]
at = [0.049731, 0, -0.0124328]
axis = [0, 0, 1]
[joint.j2]
type = "constant-velocity"
between = ["ground", "b0"]
at = [0, 0, -0.0124328]
axes = [[0, 1, 0], [0.994356, 1, 0.106094]]
[force.light]
type = "spring"
between = [[0.030947, -0.00155121, -0.0168182],"b0"]
stiffness = 0.0148701
rest_length = 0
[force.heavy]
type = "spring"
between = [[0.0287264, 0.00295824, -0.019567],"b1"]
stiffness = 475.418
rest_length = 0
"#;

/// A boom of half a kilogram between its ball and a strong spring, and what weighs a milligram on it.
const BOOM: &str = r#"
[body.b0]
mass = 0.5413
inertia = [4.045, 5.586, 5.614]
position = [-7.112, 2.494, 3.071]
points = { e = [-0.07123, 3.372, 3.323] }
[body.b1]
mass = 1.311e-6
inertia = [5.113e-6, 7.362e-6, 8.455e-6]
position = [-4.942, 8.02, 4.968]
points = { e = [2.242, 2.155, -1.427] }
[joint.j0]
type = "spherical"
between = ["ground", "b0"]
at = [-7.041, -0.8779, -0.2522]
[force.s0]
type = "spring"
between = [[17.29, -8.309, -22.35], "b0.e"]
stiffness = 113.5
rest_length = 18.95
[joint.j1]
type = "revolute"
between = ["b0", "b1"]
at = [-7.183, 5.866, 6.395]
axis = [-0.5465, 0.7498, -0.4569]
[force.t1]
type = "torsion"
joint = "j1"
stiffness = 2.956e5
"#;

/// A planar rod of 1 kg from x = k to k + 1, hinged where it begins.
fn rod(k: usize, holder: &str) -> String {
    format!(
        "[body.r{k}]\nmass = 1\nshape = {{ rod = 1 }}\nposition = [{k}.5, 0]\n\
         [joint.h{k}]\ntype = \"revolute\"\nbetween = [\"{holder}\", \"r{k}\"]\nat = [{k}, 0]\n"
    )
}

/// What a column has at the start.
fn at_start(text: &str, column: &str) -> f64 {
    run(&model(text), Choice::default(), 0.01, 0.01).1.column(column).unwrap_or_else(|| panic!("there is no column {column}"))[0]
}

/// Says that what columns of a run record begins at these values and stays there, but for rounding.
#[track_caller]
fn assert_stays(text: &str, columns: &[(&str, f64)]) {
    let recording = run(&model(text), Choice::default(), 0.01, 2.0).1;
    for (name, value) in columns {
        let found = recording.column(name).unwrap_or_else(|| panic!("there is no column {name}"));
        let off = found.iter().fold(0.0, |off: f64, found| off.max((found - value).abs()));
        assert!(off < 1e-10 * value.abs().max(1.0), "{name} is {off:.1e} off {value}\n{text}");
    }
}

fn planar(parts: &[String]) -> String {
    format!("plane = \"xz\"\n{}{BEGIN}", parts.concat())
}

/// Rods hang, also where they are written upright: forces balance there and do not hold them.
#[test]
fn what_can_fall_hangs() {
    let across = planar(&[rod(0, "ground"), rod(1, "r0")]);
    let mut upright = across.clone();
    for k in [0, 1] {
        upright =
            upright.replace(&format!("position = [{k}.5, 0]"), &format!("position = [0, {k}.5]\norientation = {{ angle = \"90*deg\" }}"));
        upright = upright.replace(&format!("at = [{k}, 0]"), &format!("at = [0, {k}]"));
    }
    for text in [across, upright] {
        assert_stays(&text, &[("r0.z", -0.5), ("r1.z", -1.5), ("r1.x", 0.0)]);
    }
    // It falls to the same side with more nodes.
    let stop = "[force.stop]\ntype = \"torsion\"\njoint = \"h0\"\nstiffness = 5\nangle = 0\n".to_string();
    let text = planar(&[rod(0, "ground"), rod(1, "r0"), stop]);
    let text = text.replace("position = [0.5, 0]", "position = [0, 0.5]\norientation = { angle = \"90*deg\" }");
    let text = text
        .replace("position = [1.5, 0]", "position = [0, 1.5]\norientation = { angle = \"90*deg\" }")
        .replace("at = [1, 0]", "at = [0, 1]");
    let angle = |reactions: bool| {
        let model = model(&format!("{text}[output]\nreactions = {reactions}\n"));
        run(&model, Choice::default(), 0.01, 0.01).1.column("h0.angle").unwrap()[0]
    };
    assert!(angle(false).abs() > 0.5 && (angle(true) - angle(false)).abs() < 1e-10, "{} {}", angle(true), angle(false));
}

/// A light ball that carries a heavy rod by a hinge: what holds the rod still hides how the ball falls off the ridge on which the forces balance first.
#[test]
fn heavy_parts_do_not_hide_how_light_ones_fall() {
    let text = format!("{RIDGE}[start]\nequilibrium = true\n");
    let found = modes(&model(&text).system).unwrap();
    assert_eq!((found.modes.len(), found.free, found.unsure), (3, 0, 0));
    assert!(found.modes.iter().all(|mode| mode.growth == 0.0), "{:?}", found.modes.iter().map(|mode| mode.growth).collect::<Vec<_>>());
}

/// A heavy tip on two rods with hardly any mass, with springs in their hinges: their moments are those of its weight.
#[test]
fn light_parts_do_not_hide_how_heavy_ones_hang() {
    let spring = |k: usize| format!("[force.s{k}]\ntype = \"torsion\"\njoint = \"h{k}\"\nstiffness = 5e4\n");
    let tip = "[body.tip]\nmass = 1e3\ninertia = 1e-6\nposition = [2, 0]\n\
               [joint.pin]\ntype = \"revolute\"\nbetween = [\"r1\", \"tip\"]\nat = [2, 0]\n";
    for mass in ["1", "1e-7", "1e-12"] {
        let rods = [rod(0, "ground"), rod(1, "r0")].concat().replace("mass = 1", &format!("mass = {mass}"));
        let text = planar(&[rods, spring(0), spring(1), tip.to_string()]);
        let [tip, first, second] = ["tip.x", "h0.angle", "h1.angle"].map(|column| at_start(&text, column));
        let weight: f64 = mass.parse::<f64>().unwrap() * G;
        let lower = 1e3 * G * (tip - first.cos()) + weight * 0.5 * (first + second).cos();
        let upper = 1e3 * G * tip + weight * (1.5 * first.cos() + 0.5 * (first + second).cos());
        let off = (5e4 * first + upper).abs().max((5e4 * second + lower).abs());
        assert!(off < 1e-12 * upper, "{mass} kg: {off:.1e} N·m");
    }
}

/// Large forces round what hardly anything holds, here how a boom turns about itself: long steps go on all the same, to where spring and weight balance.
#[test]
fn what_hardly_anything_holds_comes_to_rest() {
    let text = format!("{BOOM}{BEGIN}");
    let tip = ["b0.e.x", "b0.e.y", "b0.e.z"].map(|column| at_start(&text, column));
    let [boom, spring] = [[-7.041, -0.8779, -0.2522], [17.29, -8.309, -22.35]].map(|from| [0, 1, 2].map(|k| tip[k] - from[k]));
    let length = spring.iter().map(|d| d * d).sum::<f64>().sqrt();
    let mut force = spring.map(|d| 113.5 * (18.95 - length) * d / length);
    force[2] -= 0.5 * 0.5413 * G;
    let moment = [0, 1, 2].map(|k| boom[(k + 1) % 3] * force[(k + 2) % 3] - boom[(k + 2) % 3] * force[(k + 1) % 3]);
    assert!(moment.iter().all(|moment| moment.abs() < 1e-3), "{moment:?} N·m");
}

/// A wheel turns by the way over its radius, also on a plate that gives way under it.
#[test]
fn wheels_roll_to_where_forces_balance() {
    for (stiffness, spring) in [(1e9, 10.0), (200.0, 50.0), (50.0, 10.0)] {
        let text = format!(
            "[body.plate]\nmass = 20\ninertia = [1, 2, 1]\nposition = [0, 0, 0]\n[body.wheel]\nmass = 4\ninertia = [0.1, 0.2, 0.1]\ncom = [0.1, 0, 0]\n\
             position = [0.2, 0, 0.3]\npoints = {{ hub = [0, 0, 0] }}\n[joint]\n\
             hinge = {{ type = \"revolute\", between = [\"ground\", \"plate\"], at = [0, 0, 0], axis = [0, 1, 0] }}\n\
             guide = {{ type = \"planar\", between = [\"plate\", \"wheel\"], at = \"wheel.hub\", axis = [0, 1, 0] }}\n\
             rolling = {{ type = \"rolling\", between = [\"plate\", \"wheel\"], at = \"wheel.hub\", axis = [0, 1, 0], normal = [0, 0, 1], radius = 0.3 }}\n\
             [force]\ntilt = {{ type = \"torsion\", joint = \"hinge\", stiffness = {stiffness} }}\n\
             pull = {{ type = \"spring\", between = [\"wheel\", [5, 0, 1]], stiffness = {spring}, rest_length = 0.5 }}\n{BEGIN}"
        );
        let [way, angle] = ["guide.x", "guide.angle"].map(|column| at_start(&text, column));
        assert!(angle > 0.3 && (way - 0.3 * angle).abs() < 1e-12, "{way} m and {angle} rad");
    }
}

/// Dampers that creep for a quarter of an hour let go as far as rounding, beside heavy and light parts.
#[test]
fn dampers_hold_nothing() {
    for (first, second) in [(1.0, 1.0), (1e3, 1e-3)] {
        let text = format!(
            "plane = \"xz\"\n[point.a]\nmass = {first}\nposition = [0.3, -0.5]\n[point.b]\nmass = {second}\nposition = [0.6, -1]\n\
             [force.k]\ntype = \"spring\"\nbetween = [\"ground\", \"a\"]\nstiffness = 1e3\nrest_length = 0.5\n\
             [force.l]\ntype = \"spring\"\nbetween = [\"a\", \"b\"]\nstiffness = 1e3\nrest_length = 0.5\ndamping = 1e6\n{BEGIN}"
        );
        let (upper, lower) = (0.5 + (first + second) * G / 1e3, 0.5 + second * G / 1e3);
        let off = (at_start(&text, "b.z") + upper + lower).abs().max(at_start(&text, "b.x").abs());
        assert!(off < 1e-12 * upper, "{off:.1e}");
    }
}

/// What falls slowly beside something fast, or comes to rest near the ridge that it is written on, falls all the same.
#[test]
fn slow_and_short_falls_are_falls() {
    let upright = "[body.r]\nmass = 100\nshape = { rod = 1 }\nposition = [0, 0.5]\norientation = { angle = \"90*deg\" }\n\
                   [joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"r\"]\nat = [0, 0]\n";
    for (damping, stiffness) in [(0.0, 1e9), (1e4, 1e4), (1e6, 1e6), (1e8, 1e3)] {
        let fast = format!(
            "[force.c]\ntype = \"torsion\"\njoint = \"h\"\ndamping = {damping}\n\
             [body.light]\nmass = 1e-3\ninertia = 1e-6\nposition = [5, 0]\n\
             [joint.g]\ntype = \"prismatic\"\nbetween = [\"ground\", \"light\"]\nat = [5, 0]\naxis = [1, 0]\n\
             [force.k]\ntype = \"torsion\"\njoint = \"g\"\nstiffness = {stiffness}\n"
        );
        let height = at_start(&planar(&[upright.into(), fast]), "r.z");
        assert!((height + 0.5).abs() < 1e-12, "{height} with {damping} and {stiffness}");
    }
    // Two springs that are too long by one in ten million hold a point 0.45 mm off their line.
    let side =
        |k: i32| format!("[force.s{k}]\ntype = \"spring\"\nbetween = [[{k}, 0], \"p\"]\nstiffness = 1e4\nrest_length = \"1 + 1e-7\"\n");
    let point = "gravity = [0, 0]\n[point.p]\nmass = 1\nposition = [0, 0]\n\
                 [constraint.v]\ntype = \"point-on-line\"\npoint = \"p\"\ndirection = [0, 1]\n";
    let height = at_start(&planar(&[point.into(), side(-1), side(1)]), "p.z");
    assert!((height.abs() - (2e-7_f64 + 1e-14).sqrt()).abs() < 1e-9, "{height}");
}

/// What is so light that rounding of all others hides its weight falls as well, from upright and from beside that.
#[test]
fn light_parts_fall() {
    for (mass, length, holder, slope) in
        [(1e-6, 0.02, 19, "90*deg"), (1e-9, 3e-3, 3, "90*deg"), (1e-14, 0.2, 19, "90*deg"), (1e-14, 0.2, 19, "89*deg")]
    {
        let hanging = |k: i32| {
            let holder = if k == 0 { "ground".to_string() } else { format!("r{}", k - 1) };
            let below = format!("position = [0, {}]\norientation = {{ angle = \"-90*deg\" }}", -0.5 - f64::from(k));
            rod(k as usize, &holder)
                .replace(&format!("position = [{k}.5, 0]"), &below)
                .replace(&format!("at = [{k}, 0]"), &format!("at = [0, -{k}]"))
        };
        let chain: Vec<String> = (0..20).map(hanging).collect();
        let hinge = -f64::from(holder + 1);
        let light = format!(
            "[body.light]\nmass = {mass}\nshape = {{ rod = {length} }}\nposition = [\"0.5*{length}*cos({slope})\", \"{hinge} + 0.5*{length}*sin({slope})\"]\n\
             orientation = {{ angle = \"{slope}\" }}\n[joint.pin]\ntype = \"revolute\"\nbetween = [\"r{holder}\", \"light\"]\nat = [0, {hinge}]\n"
        );
        let height = at_start(&planar(&[chain.concat(), light]), "light.z");
        assert!((height - hinge + 0.5 * length).abs() < 1e-12, "{height} with {mass} kg at {holder}, {slope}");
    }
}

/// Trees of hinged rods hang, whatever their masses over twelve decades and their lengths over three, from wherever they are written, as upright.
#[test]
fn trees_of_heavy_and_light_rods_hang() {
    let mut number = 0.0;
    let mut random = |least: f64, most: f64| {
        number = (number + 0.618_033_988_749_895_f64).fract();
        let shuffled = (1e4 * number * number).fract();
        least + (most - least) * shuffled
    };
    for tree in 0..20 {
        let (mut text, mut ends) = (String::new(), vec![("ground".to_string(), [0.0, 0.0])]);
        for k in 0..7 {
            let (holder, [x, z]) = ends[random(0.0, ends.len() as f64) as usize].clone();
            let (mass, length) = (10_f64.powf(random(-10.0, 2.0)), 10_f64.powf(random(-2.5, 0.5)));
            let angle = if random(0.0, 1.0) < 0.5 { FRAC_PI_2 } else { random(-3.0, 3.0) };
            let [across, up] = [length * angle.cos(), length * angle.sin()];
            text += &format!(
                "[body.r{k}]\nmass = {mass}\nshape = {{ rod = {length} }}\nposition = [{}, {}]\norientation = {{ angle = {angle} }}\n\
                 [joint.h{k}]\ntype = \"revolute\"\nbetween = [\"{holder}\", \"r{k}\"]\nat = [{x}, {z}]\n",
                x + 0.5 * across,
                z + 0.5 * up
            );
            ends.push((format!("r{k}"), [x + across, z + up]));
        }
        let recording = run(&model(&planar(&[text.clone()])), Choice::default(), 0.01, 0.01).1;
        for k in 0..7 {
            let angle = recording.column(&format!("r{k}.angle")).unwrap()[0];
            assert!(angle.sin() < -1.0 + 1e-9, "tree {tree}: rod {k} stands at {angle} rad\n{text}");
        }
    }
}

/// A joint that is put somewhere stays there while all others come to rest, and is let go in the run.
#[test]
fn what_is_given_is_held() {
    let text = planar(&[rod(0, "ground"), rod(1, "r0")]).replace("[start]", "[start.h0]\nangle = \"30*deg\"\n[start]");
    let recording = run(&model(&text), Choice::default(), 0.01, 0.1).1;
    let [held, hanging] = ["h0.angle", "r1.z"].map(|name| recording.column(name).unwrap());
    assert!((held[0] - FRAC_PI_6).abs() < 1e-12, "{}", held[0]);
    assert!((hanging[0] - (FRAC_PI_6.sin() - 0.5)).abs() < 1e-12, "{}", hanging[0]);
    assert!(held[10] < held[0] - 0.01, "it is let go");
}

/// A chain of ten rods between two pins 6 m apart: with the thrust H rod k has the slope (k − 4.5) m g/H, as the weights left of its middle leave.
#[test]
fn a_chain_hangs_as_statics_has_it() {
    let slope = |k: usize, thrust: f64| (k as f64 - 4.5) * G / thrust;
    let span = |thrust: f64| (0..10).map(|k| 1.0 / slope(k, thrust).hypot(1.0)).sum::<f64>();
    let (mut low, mut high) = (1.0, 100.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        (low, high) = if span(middle) < 6.0 { (middle, high) } else { (low, middle) };
    }
    let angle = |k: usize| slope(k, low).atan();
    // As a zigzag of two sides, with its ends in place.
    let side = 0.6_f64.acos();
    let mut parts = Vec::new();
    for k in 0..10 {
        let (falls, along) = (k < 5, k as f64 + 0.5);
        let height = -side.sin() * if falls { along } else { 10.0 - along };
        let turn = if falls { -side } else { side };
        let holder = if k == 0 { "ground".to_string() } else { format!("r{}", k - 1) };
        let at = -side.sin() * (k as f64).min(10.0 - k as f64);
        parts.push(format!(
            "[body.r{k}]\nmass = 1\nshape = {{ rod = 1 }}\nposition = [{}, {height}]\norientation = {{ angle = {turn} }}\n\
             [joint.h{k}]\ntype = \"revolute\"\nbetween = [\"{holder}\", \"r{k}\"]\nat = [{}, {at}]\n",
            0.6 * along,
            0.6 * k as f64
        ));
    }
    parts.push("[joint.end]\ntype = \"revolute\"\nbetween = [\"ground\", \"r9\"]\nat = [6, 0]\n".into());
    let middle: f64 = (0..5).map(|k| angle(k).sin()).sum();
    let last = 6.0 - 0.5 * angle(9).cos();
    assert_stays(&planar(&parts), &[("r4.z", middle - 0.5 * angle(4).sin()), ("r9.x", last), ("r0.z", 0.5 * angle(0).sin())]);
}

/// Springs give, forces that follow a body turn it, controllers reach what their gain leaves, ropes are taut or slack, and dampers and friction
/// hold nothing.
#[test]
fn forces_of_every_sort_balance() {
    let weightless = |force: &str| planar(&[rod(0, "ground"), force.into()]).replacen('\n', "\ngravity = [0, 0]\n", 1);
    let torsion = "[force.k]\ntype = \"torsion\"\njoint = \"h0\"\nstiffness = 10\ndamping = 1\n";
    let follows = "[force.f]\ntype = \"force\"\nbody = \"r0\"\nat = [1, 0]\naxes = \"body\"\nforce = [\"0\", \"3\"]\n";
    assert_stays(&weightless(&format!("{torsion}{follows}")), &[("h0.angle", 0.3)]);
    let controller = "[force.k]\ntype = \"effort\"\njoint = \"h0\"\neffort = \"100*(0.3 - q) - 10*q_rate + 2*cos(t)^2 + 2*sin(t)^2\"\n";
    assert_stays(&weightless(controller), &[("h0.angle", 0.32)]);
    let friction = "[force.k]\ntype = \"friction\"\njoint = \"h0\"\neffort = 20\nspeed = 0.01\n";
    assert_stays(&planar(&[rod(0, "ground"), friction.into()]), &[("r0.z", -0.5)]);
    let bob = "[point.bob]\nmass = 2\nposition = [0.1, -0.2]\n".to_string();
    let rope = "[force.k]\ntype = \"rope\"\nbetween = [\"ground\", \"bob\"]\nlength = 1.5\nstiffness = 1e5\n".to_string();
    assert_stays(&planar(&[bob.clone(), rope]), &[("bob.z", -1.5 - 2.0 * G / 1e5)]);
    // A formula as stiffness: its work lifts and lowers.
    let stiffening =
        "[force.k]\ntype = \"spring\"\nbetween = [\"ground\", \"bob\"]\nrest_length = 0\nstiffness = \"20 + 0*t\"\n".to_string();
    assert_stays(&planar(&[bob, stiffening]), &[("bob.z", -2.0 * G / 20.0), ("bob.x", 0.0)]);
}

/// What is driven stays where its drive has it at t = 0, however fast it moves then, and redundant rows are no obstacle.
#[test]
fn drives_and_redundant_rows_hold() {
    let driven = "[drive.d]\ntype = \"angle\"\njoint = \"h0\"\nprofile = \"0.5*t\"\n".to_string();
    let text = planar(&[rod(0, "ground"), rod(1, "r0"), driven]);
    let recording = run(&model(&text), Choice::default(), 0.01, 0.01).1;
    let [x, z] = ["r1.x", "r1.z"].map(|name| recording.column(name).unwrap()[0]);
    assert!((x - 1.0).abs() < 1e-12 && (z + 0.5).abs() < 1e-12, "{x} {z}");
    // A deck on three equal cranks, of which two would do.
    let crank = |k: usize| {
        format!(
            "[body.c{k}]\nmass = 1\nshape = {{ rod = 1 }}\nposition = [{k}, 0.5]\norientation = {{ angle = \"90*deg\" }}\n\
             [joint.a{k}]\ntype = \"revolute\"\nbetween = [\"ground\", \"c{k}\"]\nat = [{k}, 0]\n\
             [joint.b{k}]\ntype = \"revolute\"\nbetween = [\"c{k}\", \"deck\"]\nat = [{k}, 1]\n"
        )
    };
    let deck = "[body.deck]\nmass = 3\nshape = { rod = 2 }\nposition = [1, 1]\n".to_string();
    let text = planar(&[deck, crank(0), crank(1), crank(2)]);
    assert_eq!(freedom(&model(&text)), [1, 1]);
    assert_stays(&text, &[("deck.z", -1.0), ("deck.x", 1.0)]);
}

/// A velocity that all have is kept, and what moves with it stays at rest in it.
#[test]
fn what_travels_settles() {
    let cart = "[body.cart]\nmass = 10\nshape = { box = [2, 1, 0.2] }\nposition = [0, 0, 1]\nvelocity = [20, 0, 0]\n\
                [force.road]\ntype = \"force\"\nbody = \"cart\"\nforce = [\"0\", \"0\", \"981*(1 - z)\"]\n\
                [body.bob]\nmass = 1\nshape = { sphere = 0.1 }\nposition = [0.5, 0, 1]\nvelocity = [20, 0, 0]\n\
                [joint.pin]\ntype = \"revolute\"\nbetween = [\"cart\", \"bob\"]\nat = [0, 0, 1]\naxis = [0, 1, 0]\n";
    assert_stays(&format!("{cart}{BEGIN}"), &[("cart.z", 1.0 - 11.0 * G / 981.0), ("cart.vx", 20.0), ("bob.z", 0.5 - 11.0 * G / 981.0)]);
}

/// The same places in other units: mm, t and s.
#[test]
fn units_do_not_matter() {
    let text = |length: f64, mass: f64| {
        let (stiffness, gravity) = (300.0 * mass, G * length);
        format!(
            "plane = \"xz\"\ngravity = [0, {}]\n[point.a]\nfixed = true\nposition = [0, 0]\n[point.b]\nfixed = true\nposition = [{}, {}]\n\
             [point.m]\nmass = {}\nposition = [{}, {}]\n\
             [force.left]\ntype = \"spring\"\nbetween = [\"a\", \"m\"]\nstiffness = {stiffness}\nrest_length = {}\n\
             [force.right]\ntype = \"spring\"\nbetween = [\"b\", \"m\"]\nstiffness = {stiffness}\n{BEGIN}",
            -gravity,
            2.0 * length,
            0.3 * length,
            5.0 * mass,
            0.8 * length,
            0.1 * length,
            0.5 * length
        )
    };
    let place = |length: f64, mass: f64| {
        let recording = run(&model(&text(length, mass)), Choice::default(), 0.01, 0.01).1;
        ["m.x", "m.z"].map(|name| recording.column(name).unwrap()[0] / length)
    };
    let [x, z] = place(1.0, 1.0);
    for (length, mass) in [(1e3, 1e-3), (1e-6, 1e9), (1e9, 1e-6)] {
        let [other_x, other_z] = place(length, mass);
        assert!((other_x - x).abs() < 1e-11 && (other_z - z).abs() < 1e-11, "{other_x} {x}, {other_z} {z}");
    }
}

/// What nothing holds is refused, and says where it went.
#[test]
fn what_never_rests_is_refused() {
    let refused = |text: &str| source(text).model().map(|_| ()).expect_err("nothing holds it");
    let ball = "[body.ball]\nmass = 1\nshape = { sphere = 0.1 }\nposition = [0, 0, 0]\n";
    let message = refused(&format!("{ball}{BEGIN}"));
    assert!(message.contains("it goes on and on; so far it has moved `ball`"), "{message}");
    let motor = "[force.m]\ntype = \"effort\"\njoint = \"h0\"\neffort = 3\n".to_string();
    let message = refused(&planar(&[rod(0, "ground"), motor]).replacen('\n', "\ngravity = [0, 0]\n", 1));
    assert!(message.contains("it goes on and on"), "{message}");
    let text = planar(&[rod(0, "ground")]).replace("mass = 1\n", "mass = 1\nangular_velocity = 2\n");
    let message = refused(&text);
    assert!(message.contains("the velocity of `r0` is written for the pose in the file"), "{message}");
}
