//! What a run says of models that are sound as files and cannot move as they are meant to.

mod common;

use std::fs;

use common::{csv, folder, holonom, on_one_line, prints, text};

/// All that a run of a model says, and its exit status.
fn run(model: &str) -> (String, Option<i32>) {
    command(model, "run model.toml --no-report")
}

/// The same of a command.
fn command(model: &str, words: &str) -> (String, Option<i32>) {
    let folder = folder();
    fs::write(folder.path().join("model.toml"), model).unwrap();
    let output = holonom(&folder, words);
    (format!("{}{}", text(&output.stderr), text(&output.stdout)), output.status.code())
}

#[track_caller]
fn says(model: &str, words: &[&str], status: i32) {
    let (said, code) = run(model);
    assert_eq!(code, Some(status), "{said}");
    for word in words {
        assert!(on_one_line(&said).contains(word), "{word} is missing in\n{said}");
    }
}

/// A slider-crank that is driven at its piston, with its crank at an angle from the dead centre.
fn driven_piston(angle: f64, profile: &str) -> String {
    let (r, l) = (0.1, 0.4);
    let (sine, cosine) = angle.sin_cos();
    let (y, tilt) = (r * sine, (r / l * sine).asin());
    let wrist = r * cosine + l * tilt.cos();
    format!(
        "plane = \"xy\"\n[body]\ncrank = {{ mass = 1.2, inertia = 0.01, position = [{}, {}] }}\n\
         rod = {{ mass = 0.8, inertia = 0.02, position = [{}, {}] }}\npiston = {{ mass = 2, inertia = 0.01, position = [{wrist}, 0] }}\n\
         [joint]\nmain = {{ type = \"revolute\", between = [\"ground\", \"crank\"], at = [0, 0] }}\n\
         pin = {{ type = \"revolute\", between = [\"crank\", \"rod\"], at = [{}, {y}] }}\n\
         wrist = {{ type = \"revolute\", between = [\"rod\", \"piston\"], at = [{wrist}, 0] }}\n\
         guide = {{ type = \"prismatic\", between = [\"ground\", \"piston\"], axis = [1, 0] }}\n\
         [drive.motor]\ntype = \"displacement\"\njoint = \"guide\"\nprofile = \"{profile}\"\n[simulation]\nend = 0.01\nstep = 1e-3\n",
        0.5 * r * cosine,
        0.5 * y,
        0.5 * (r * cosine + wrist),
        0.5 * y,
        r * cosine,
    )
}

#[test]
fn a_drive_at_a_dead_centre_is_told_as_one() {
    let said = "leads in a direction in which the mechanism cannot move there: at a dead centre";
    says(&driven_piston(0.0, "-0.1*t"), &["error: ", "`motor`", said], 2);
    for profile in ["-0.1*t^2", "-0.01*t^3"] {
        says(&driven_piston(0.0, profile), &["stopped at", "`motor`", said], 3);
        says(&driven_piston(0.5, profile), &["completed"], 0);
    }
}

/// Two wheels that mesh, each with a motor of its own.
fn two_motors(profile: &str) -> String {
    let wheel = |name: &str, x: f64, profile: &str| {
        format!(
            "[body.{name}]\nmass = 1\ninertia = 0.1\nposition = [{x}, 0]\n[joint.axle-{name}]\ntype = \"revolute\"\nbetween = [\"ground\", \"{name}\"]\n\
             at = [{x}, 0]\n[drive.motor-{name}]\ntype = \"angle\"\njoint = \"axle-{name}\"\nprofile = \"{profile}\"\n"
        )
    };
    format!(
        "plane = \"xy\"\n{}{}[joint.mesh]\ntype = \"gear\"\njoints = [\"axle-a\", \"axle-b\"]\nratio = -1\n[simulation]\nend = 0.1\nstep = 0.01\n",
        wheel("a", 0.0, "t^2"),
        wheel("b", 1.0, profile)
    )
}

#[test]
fn two_drives_of_one_freedom_are_both_named() {
    let said = "`motor-b` asks for a motion that the other constraints do not allow: it leads the same freedom as `motor-a`";
    says(&two_motors("-2*t^2"), &[said, "stopped at"], 3);
    says(&two_motors("-2*t"), &["error: ", "`motor-b` leads the same freedom as `motor-a`"], 2);
    let note = "note: `motor-a` and `motor-b` lead the same freedom";
    says(&two_motors("-t^2"), &[note, "completed"], 0);
    // What does not agree is told of as a conflict alone.
    for (profile, is_noted) in [("-t^2", true), ("-2*t^2", false)] {
        let (said, code) = command(&two_motors(profile), "check model.toml");
        assert!(code == Some(0) && said.contains(note) == is_noted, "{said}");
    }
}

/// A triangle of two bars on the ground.
fn triangle(more: &str) -> String {
    let bar = |name: &str, x: f64| format!("[body.{name}]\nmass = 1\ninertia = 0.1\nposition = [{x}, 0.5]\n");
    let joint = |name: &str, between: &str, at: &str| format!("[joint.{name}]\ntype = \"revolute\"\nbetween = {between}\nat = {at}\n");
    format!(
        "plane = \"xy\"\ngravity = [0, -9.81]\n{}{}{}{}{more}[simulation]\nend = 0.1\nstep = 0.01\n",
        bar("a", 0.5),
        bar("b", 1.5),
        joint("left", "[\"ground\", \"a\"]", "[0, 0]"),
        joint("top", "[\"a\", \"b\"]", "[1, 1]"),
    )
}

#[test]
fn a_mechanism_that_cannot_move_is_noted() {
    let foot = "[joint.right]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [2, 0]\n";
    says(&triangle(foot), &["note: the mechanism is locked: its constraints leave 0 degrees of freedom", "completed"], 0);
    let drive = |joint: &str| format!("[drive.{joint}-motor]\ntype = \"angle\"\njoint = \"{joint}\"\nprofile = \"0.1*t^2\"\n");
    for sound in [String::new(), drive("left") + &drive("top")] {
        let (said, code) = run(&triangle(&sound));
        assert!(code == Some(0) && !said.contains("locked"), "{said}");
    }
}

/// A four-bar in space, one of whose hinges is a little off, has one degree of freedom by its rank, and rows that do not let it go there.
#[test]
fn a_mechanism_that_is_jammed_in_its_last_digits_is_noted() {
    let bar = |name: &str, x: f64, y: f64| format!("[body.{name}]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [{x}, {y}, 0]\n");
    let hinge = |name: &str, between: &str, at: &str, off: &str| {
        format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = [{at}, 0]\naxis = [{off}, 0, 1]\n")
    };
    let four_bar = |off: &str| {
        let bars = bar("crank", 0.0, 0.5) + &bar("rod", 1.0, 1.2) + &bar("rocker", 2.0, 0.7);
        let feet = hinge("a", "\"ground\", \"crank\"", "0, 0", "0") + &hinge("d", "\"ground\", \"rocker\"", "2, 0", "0");
        let heads = hinge("b", "\"crank\", \"rod\"", "0, 1", "0") + &hinge("c", "\"rod\", \"rocker\"", "2, 1.4", off);
        format!(
            "{bars}{feet}{heads}[force.motor]\ntype = \"effort\"\njoint = \"a\"\neffort = 2\n[simulation]\nend = 0.1\nstep = 0.01\nmethod = \"radau\"\n"
        )
    };
    let note = "note: nothing has moved: constraints that follow from the others (redundant) hold what these leave free";
    says(&four_bar("1e-5"), &[note, "completed"], 0);
    // What has no time to move, or no reason, is not held.
    let brief = four_bar("0").replace("end = 0.1\nstep = 0.01", "end = 1e-6\nstep = 1e-7");
    for sound in [four_bar("0"), four_bar("0").replace("effort = 2", "effort = 0"), brief] {
        let (said, code) = run(&sound);
        assert!(code == Some(0) && !said.contains(note), "{said}");
    }
}

#[test]
fn friction_that_is_hardly_smoothed_is_named() {
    let block = |speed: &str| {
        format!(
            "plane = \"xz\"\n[body.block]\nmass = 1\ninertia = 0.1\nposition = [0, 0]\nvelocity = [1, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\naxis = [1, 0]\n\
             [force.rust]\ntype = \"friction\"\njoint = \"rail\"\neffort = 3\nspeed = {speed}\n[simulation]\nend = 1\nstep = 0.01\n"
        )
    };
    says(&block("1e-9"), &["stopped at", "`rust` turns round within 1.0e-9 m/s or rad/s", "larger `speed`"], 3);
    says(&block("1e-3"), &["completed"], 0);
    // Under its weight a flap comes to rest between two swings.
    let flap = "plane = \"xy\"\ngravity = [0, -9.81]\n[body.flap]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"flap\"]\nat = [0, 0]\n\
                [force.rust]\ntype = \"friction\"\njoint = \"hinge\"\neffort = 3\nspeed = 1e-9\n[simulation]\nend = 3\nstep = 0.01\n";
    for method in ["conserving-ggl", "radau"] {
        let (said, code) = command(flap, &format!("run model.toml --no-report --accuracy 1e-6 --method {method}"));
        assert!(code == Some(3) && said.contains("`rust` turns round within 1.0e-9 m/s or rad/s"), "{said}");
    }
}

#[test]
fn points_in_a_line_are_not_told_of_as_a_door() {
    let point = |name: &str, x: f64| format!("[point.{name}]\nmass = 1\nposition = [{x}, 0, 0]\n");
    let rod = |name: &str, ends: &str| format!("[constraint.{name}]\ntype = \"distance\"\nbetween = {ends}\n");
    let text = format!(
        "{}{}{}{}{}[simulation]\nend = 1\nstep = 0.01\n",
        point("a", 1.0),
        point("b", 2.0),
        rod("one", "[\"ground\", \"a\"]"),
        rod("two", "[\"a\", \"b\"]"),
        rod("three", "[\"ground\", \"b\"]"),
    );
    says(&text, &["stopped at", "(redundant)", "three distances along a line"], 3);
}

#[test]
fn more_equations_on_a_point_than_fit_a_matrix_are_refused() {
    let text = "[point.a]\nmass = 1\nposition = [0, 0, 0]\n[constraint.f]\nrepeat = \"i = 1 to 100000\"\ntype = \"fixed\"\npoint = \"a\"\n\
                [simulation]\nend = 0.1\nstep = 0.01\n";
    says(text, &["error: 300000 equations of constraints", "`f[1][x]`", "cure: "], 2);
    says(&text.replace("100000", "50"), &["completed"], 0);
}

/// A coupling of rubber that is turned beyond 45°, where its moment falls, goes on without end; one that is turned by less, in any units, or that resists
/// no rotation, is what it is meant to be.
#[test]
fn bushings_that_turn_too_far_are_noted() {
    let coupling = |stiffness: &str, torque: f64, t: f64| {
        format!(
            "plane = \"xy\"\n[body.shaft]\nmass = 1\ninertia = 0.1\nposition = [0, 0]\n\
             [force.coupling]\ntype = \"bushing\"\nbetween = [\"ground\", \"shaft\"]\nat = [0, 0]\nstiffness = [1e5, 1e5, {stiffness}]\n\
             damping = [100, 100, 0]\n[force.load]\ntype = \"torque\"\nbody = \"shaft\"\ntorque = {torque}\n\
             [simulation]\nend = {t}\nstep = {}\n",
            t / 500.0
        )
    };
    // 0.1 θ'' = 12 − 20 sin θ cos θ from rest passes 45° after 0.13038 s (midpoint rule at 1e-5 s); rows are 1 ms apart.
    let note = "`coupling` turned by more than 45°, first at 0.131 s";
    says(&coupling("20", 12.0, 0.5), &[note, "`torsion` spring"], 0);
    // From rest it swings to twice its angle, here to 12 degrees; without stiffness it turns freely.
    for (stiffness, torque) in [("20", 2.0), ("0", 12.0)] {
        let (text, status) = run(&coupling(stiffness, torque, 0.5));
        assert!(status == Some(0) && !text.contains("45°"), "{text}");
    }
    // About a skew axis in space, no single sine being above 0.7.
    let space = "gravity = [0, 0, 0]\n[body.b]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\nangular_velocity = [5, 5, 5]\n\
                 [force.mount]\ntype = \"bushing\"\nbetween = [\"ground\", \"b\"]\nat = [0, 0, 0]\nstiffness = [1e3, 1e3, 1e3, 1, 1, 1]\n\
                 [simulation]\nend = 0.12\nstep = 1e-3\n";
    // 8.66 rad/s turn it by 45° in 0.0907 s, hardly slowed.
    says(space, &["`mount` turned by more than 45°, first at 0.09"], 0);
}

/// A rod that a penalty leaves soft is said to be, with how far it stretches, in any units; a larger one is not, nor are methods that hold it.
#[test]
fn positions_far_off_their_rows_are_noted() {
    let rod = |method: &str, metre: f64, second: f64| {
        format!(
            "gravity = [0, 0, {}]\n[point.bob]\nmass = 2e5\nposition = [{}, 0, {}]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\n\
             [simulation]\nend = {}\nstep = {}\nmethod = {method}\n",
            -9.81 * metre / (second * second),
            0.6 * metre,
            -0.8 * metre,
            0.5 * second,
            1e-3 * second
        )
    };
    // The row is the spring ½ α Φ² with Φ = ½ (r² − 1 m²): m r'' = m g − α Φ r comes to 0.3298 m² in half a second (Euler's rule at 1e-4 s).
    for (metre, second, way) in [(1.0, 1.0, "up to 0.329"), (1e3, 1e3, "up to 329.")] {
        let penalty = 1e7 / (metre * second * metre * second);
        let soft = format!("\"penalty/conserving\"\npenalty = {penalty:e}");
        says(
            &rod(&soft, metre, second),
            &["note: positions were ", way, " m off `rod`, 32.9", " % of the mechanism's size: rows of a penalty"],
            0,
        );
    }
    for method in ["\"penalty/conserving\"\npenalty = 1e12", "\"augmented-lagrangian/conserving\"", "\"conserving-ggl\"", "\"radau\""] {
        let (text, status) = run(&rod(method, 1.0, 1.0));
        assert!(status == Some(0) && !text.contains("positions were"), "{method}: {text}");
    }
}

/// Velocities that a method leaves far off a constraint are said to be, with what the recorded ones are off; with a third of the step they are not, nor
/// with methods that hold them. Light parts under tension show it most: the energy of all hardly feels them.
#[test]
fn velocities_far_off_their_rows_are_noted() {
    let pendulum = |method: &str, step: f64| {
        format!(
            "plane = \"xy\"\ngravity = [0, -9.81]\n[point.bob]\nmass = 1\nposition = [1, 0]\n[constraint.rod]\ntype = \"distance\"\n\
             between = [\"ground\", \"bob\"]\n[simulation]\nend = 3\nstep = {step}\nmethod = \"{method}\"\n"
        )
    };
    let folder = folder();
    fs::write(folder.path().join("model.toml"), pendulum("conserving", 0.15)).unwrap();
    let output = holonom(&folder, "run model.toml --no-report --out results");
    let said = on_one_line(&text(&output.stderr));
    let (header, rows) = csv(folder.path().join("results/trajectory.csv"));
    let [x, y, vx, vy] = ["bob.x", "bob.y", "bob.vx", "bob.vy"].map(|name| header.split(',').position(|column| column == name).unwrap());
    let off = rows.iter().map(|row| (row[x] * row[vx] + row[y] * row[vy]).abs()).fold(0.0, f64::max);
    let told = said.split_once("velocities were up to ").and_then(|(_, rest)| rest.split_once(" m/s off `rod`")).expect(&said);
    let told: f64 = told.0.parse().unwrap();
    assert!((told / off - 1.0).abs() < 1e-5, "{told} m/s, {off} in the rows");
    for (method, step) in [("conserving", 0.05), ("conserving-ggl", 0.15), ("radau", 0.15), ("conserving-projected", 0.15)] {
        let (text, status) = run(&pendulum(method, step));
        assert!(status == Some(0) && !text.contains("velocities were"), "{method}: {text}");
    }
    // A light point in the middle trembles.
    let chain = |step: f64| {
        format!(
            "plane = \"xy\"\ngravity = [0, -9.81]\n[point]\na = {{ mass = 1e-5, position = [1, 0] }}\nb = {{ mass = 1e-5, position = [2, 0] }}\n\
             c = {{ mass = 1, position = [3, 0] }}\n[constraint]\nr1 = {{ type = \"distance\", between = [\"ground\", \"a\"] }}\n\
             r2 = {{ type = \"distance\", between = [\"a\", \"b\"] }}\nr3 = {{ type = \"distance\", between = [\"b\", \"c\"] }}\n\
             [simulation]\nend = 0.4\nstep = {step}\nmethod = \"generalized-alpha\"\n"
        )
    };
    says(&chain(0.0025), &["note: velocities were up to ", " % of the largest: rates, energies and work are as far off"], 0);
    let (text, status) = run(&chain(6.25e-4));
    assert!(status == Some(0) && !text.contains("velocities were"), "{text}");
    // A pendulum that hangs still but for what it came to swing off its rod, beside a point that was much faster.
    let at_rest = |step: f64, end: f64| {
        format!(
            "plane = \"xy\"\n[point]\np = {{ mass = 1, position = [1, 0] }}\nq = {{ mass = 1, position = [5, 5], velocity = [80, 0] }}\n\
             [constraint]\nrod = {{ type = \"distance\", between = [\"ground\", \"p\"] }}\n\
             [force]\nweight = {{ type = \"constant\", point = \"p\", force = [0, -9.81] }}\n\
             d = {{ type = \"spring\", between = [[2, -1], \"p\"], stiffness = 0, damping = 5 }}\n\
             e = {{ type = \"spring\", between = [[0, 5], \"q\"], stiffness = 0, damping = 5 }}\n\
             [simulation]\nend = {end}\nstep = {step}\nmethod = \"conserving\"\n"
        )
    };
    says(&at_rest(0.14, 21.0), &["note: velocities are still 0.063", " m/s off `rod`, 100 % of the largest at the end: rates"], 0);
    for (step, end) in [(0.14, 0.7), (0.05, 21.0)] {
        let (text, status) = run(&at_rest(step, end));
        assert!(status == Some(0) && !text.contains("velocities "), "{text}");
    }
    // A drive that sets in where all else stands has velocities come to twice its rate and back to nothing, step by step.
    let sets_in = "plane = \"xy\"\n[point]\np = { mass = 1, position = [1, 0] }\nq = { mass = 1, position = [5, 5], velocity = [80, 0] }\n\
                   [drive]\nd = { type = \"distance\", between = [\"ground\", \"p\"], profile = \"1 + 0.3*max(0, t - 10.0)\" }\n\
                   [force]\ne = { type = \"spring\", between = [[0, 5], \"q\"], stiffness = 0, damping = 10 }\n\
                   [simulation]\nend = 10.2\nstep = 0.05\nmethod = \"conserving\"\n";
    says(sets_in, &["note: velocities are still 0.318 m/s off `d`, 100 % of the largest at the end"], 0);
}

/// A run that no step is short enough for says why: a spring whose ends pass each other, or a flat parallelogram, whose many links are all in line.
#[test]
fn why_no_step_is_short_enough_is_told() {
    let spring = "[point.o]\nposition = [0, 0, 0]\nfixed = true\n[body.m]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [1, 0, 0]\n\
                  velocity = [-9, 0, 0]\n[joint.line]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m\"]\nat = [1, 0, 0]\naxis = [1, 0, 0]\n\
                  [force.s]\ntype = \"spring\"\nbetween = [\"o\", \"m\"]\nstiffness = 100\nrest_length = 0.5\n\
                  [simulation]\nend = 1\nstep = 0.01\naccuracy = 1e-6\n";
    for method in ["radau", "ode/dopri5"] {
        let text = format!("{spring}method = \"{method}\"\n");
        says(
            &text,
            &["no step is short enough", "; the force of `s` turns round at once there, as that of a spring does whose ends pass"],
            3,
        );
    }
    // The spring's energy is kept all the same, and the length along an axis has a sign.
    says(spring, &["completed"], 0);
    let along = spring.replace("rest_length", "along = [1, 0, 0]\nrest_length");
    says(&format!("{along}method = \"radau\"\n"), &["completed"], 0);
    let mut flat = String::from("plane = \"xy\"\n[body.c]\nmass = 1\ninertia = 0.1\nposition = [2.5, 0]\nvelocity = [0, 6]\n");
    for i in 0..4 {
        flat += &format!(
            "[body.l{i}]\nmass = 1\ninertia = 0.1\nposition = [{i}.5, 0]\nvelocity = [0, 3]\nangular_velocity = 6\n\
             [joint.g{i}]\ntype = \"revolute\"\nbetween = [\"ground\", \"l{i}\"]\nat = [{i}, 0]\n\
             [joint.t{i}]\ntype = \"revolute\"\nbetween = [\"l{i}\", \"c\"]\nat = [{}, 0]\n",
            i + 1
        );
    }
    flat += "[simulation]\nend = 1\nstep = 0.01\naccuracy = 1e-9\n";
    says(
        &flat,
        &["no step is short enough", "; it is near a singular position, where rows hardly differ", "(ask for less, or take radau)"],
        3,
    );
    says(&format!("{flat}method = \"radau\"\n"), &["completed"], 0);
    // Four hinges of which two axes are a little off, so that no motion keeps them all: their rows, not the accuracy, are what to look at.
    let four_bar = |off: f64| {
        let mut text = String::new();
        for (body, place, velocity) in [("a", "[0, 0, 0.5]", 0.0), ("b", "[1, 0, 1]", 0.5), ("c", "[2, 0, 0.4]", 0.0)] {
            text += &format!("[body.{body}]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = {place}\nvelocity = [{velocity}, 0, 0]\n");
        }
        let axes = [format!("[0, 1, {off}]"), format!("[{off}, 1, 0]"), "[0, 1, 0]".into(), "[0, 1, 0]".into()];
        let pairs = [("ground", "a", "[0, 0, 0]"), ("a", "b", "[0, 0, 1]"), ("b", "c", "[2, 0, 1]"), ("ground", "c", "[2, 0, -0.2]")];
        for (k, ((first, second, at), axis)) in pairs.into_iter().zip(axes).enumerate() {
            text += &format!("[joint.j{k}]\ntype = \"revolute\"\nbetween = [\"{first}\", \"{second}\"]\nat = {at}\naxis = {axis}\n");
        }
        text + "[simulation]\nend = 1\nstep = 0.01\nmethod = \"radau\"\naccuracy = 1e-8\n"
    };
    says(
        &four_bar(1e-6),
        &[
            "no step is short enough for the accuracy",
            "1 of the equations of the constraints follow from the others (redundant)",
            "all digits",
        ],
        3,
    );
    says(&four_bar(1e-5), &["the velocities at the start cannot meet their constraints", "write places and axes with all digits"], 2);
    says(&four_bar(0.0), &["completed"], 0);
}

/// Rows that repeat others and stand so far from the origin that their places cannot be written finely enough: more digits are no cure.
#[test]
fn places_far_from_the_origin_are_told_where_redundant_rows_differ() {
    let slide = "gravity = [0, 0, -9.81]
        [body.b]
        mass = 1
        inertia = [0.2, 0.14, 0.17]
        position = [-17956.85504057395, -4705.651636636542, 220.04654371915373]
        [joint.slide]
        type = \"prismatic\"
        between = [\"b\", \"ground\"]
        at = [-17955.935783558412, -4705.978037393023, 219.71195589361412]
        axis = [0.3501681352891473, -0.06028221919279561, -0.6325735149879536]
        [joint.link]
        type = \"revolute-spherical\"
        between = [\"ground\", \"b\"]
        at = [[-17955.755111169245, -4705.270435391107, 219.0767145677857], [-17955.324069992217, -4704.316624584432, 219.61741769080916]]
        axis = [-0.6817862900721666, 0.5688578174667064, -0.45996547498333695]
        [simulation]
        end = 0.02
        step = 0.004\n";
    says(
        slide,
        &["1.8e4 m from the origin places cannot be written more finely than to 4e-12 m", "(put the mechanism near the origin and write"],
        3,
    );
}

/// A slider of 2 kg that runs at 1.5 m/s into a stop of 1e6 N/m is in contact for π √(m/k) = 4.44 ms, in any units.
fn impact(step: f64, second: f64, rest: &str) -> String {
    format!(
        "plane = \"xy\"\ngravity = [0, 0]\n[body.slider]\nmass = 2\ninertia = 1\nposition = [0, 0]\nvelocity = [{}, 0]\n\
         [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
         [force.buffer]\ntype = \"stop\"\njoint = \"guide\"\nupper = 0.01234\nstiffness = {}\n\
         [simulation]\nend = {}\nstep = {}\n{rest}",
        1.5 / second,
        1e6 / (second * second),
        0.05 * second,
        step * second,
    )
}

/// Contacts of which equal steps see little are noted, as the largest force that is shown is not that of the contact, v √(k m) = 2121 N; longer ones are
/// not, nor are those of steps by accuracy, which show that force, nor a force that time or an input alone switches.
#[test]
fn contacts_of_few_steps_are_noted() {
    let note = "forces act for so few steps that their largest values may be far more than what is shown";
    let (said, status) = run(&impact(8e-3, 1.0, ""));
    assert!(
        status == Some(0)
            && on_one_line(&said).contains(&format!("{note}: `buffer` for 1 step at 0.016 s (a shorter step or an accuracy)")),
        "{said}"
    );
    assert!(said.contains("buffer  -1543"), "{said}");
    says(&impact(2e-3, 1e3, ""), &[note, "`buffer` for 2 steps at 10 s"], 0);
    // An event where the contact begins divides a step, and makes it no longer.
    says(&impact(2e-3, 1.0, "[event.hit]\nwhen = \"guide.displacement - 0.01234\"\n"), &[note, "`buffer` for 2 steps at 0.01 s"], 0);
    let falling = |force: &str| format!("[point.ball]\nmass = 1\nposition = [0, 0, 1]\n{force}\n[simulation]\nend = 1\nstep = 4e-3\n");
    let floor = falling("[force.floor]\ntype = \"expression\"\npoint = \"ball\"\nforce = [0, 0, \"1e5*max(0, -z)\"]");
    let rope = falling("[force.rope]\ntype = \"rope\"\nbetween = [\"ball\", [0, 0, 1.5]]\nlength = 1.2\nstiffness = 1e5\ndamping = 1");
    says(&floor, &[note, "`floor` for 3 steps at"], 0);
    says(&rope, &[note, "`rope` for "], 0);
    let pulse = "[force.pulse]\ntype = \"expression\"\npoint = \"ball\"\nforce = [\"10*step(t - 0.499)*step(0.509 - t)\", 0, 0]";
    // What an input switches is on for four steps, again and again.
    let switched = "[input.u]\n[event.sample]\nevery = 0.02\nset = { u = \"floor(2*mod(12*t, 1))\" }\n\
                    [force.thruster]\ntype = \"effort\"\njoint = \"guide\"\neffort = \"10*max(0, u)\"\n";
    let switched = impact(1e-2, 1.0, switched).replace("upper = 0.01234", "upper = 100").replace("end = 0.05", "end = 2");
    let accurate = impact(8e-3, 1.0, "accuracy = 1e-6\n");
    says(&accurate, &["buffer -2121"], 0);
    for silent in [impact(5e-4, 1.0, ""), accurate, falling(pulse), switched] {
        let (said, status) = run(&silent);
        assert!(status == Some(0) && !said.contains(note), "{said}");
    }
}

/// A driven shaft without inertia about its axis moves no mass: it runs, in any units, and its drive bears the spring on it and nothing else.
#[test]
fn a_driven_shaft_without_inertia_about_its_axis_runs() {
    for (mass, second) in [(1.0, 1.0), (1e-12, 1.0), (1e9, 1e-6)] {
        let moment = mass / (second * second);
        for (stiffness, method) in [(0.0, "conserving-ggl"), (0.0, "conserving"), (0.0, "radau"), (3.0 * moment, "conserving-ggl")] {
            let model = format!(
                "gravity = [0, 0, {:e}]\n[body.shaft]\nmass = {mass:e}\ninertia = [{mass:e}, {mass:e}, 0]\nposition = [0, 0, 0]\n\
                 [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"shaft\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                 [drive.motor]\ntype = \"angle\"\njoint = \"axle\"\nprofile = \"0.5*sin({:e}*t)\"\n\
                 [force.spring]\ntype = \"torsion\"\njoint = \"axle\"\nstiffness = {stiffness:e}\n\
                 [simulation]\nend = {second}\nstep = {}\nmethod = \"{method}\"\n[output]\ncolumns = [\"axle.angle\", \"motor.effort\"]\n",
                -9.81 / (second * second),
                5.0 / second,
                0.01 * second
            );
            let folder = folder();
            fs::write(folder.path().join("model.toml"), &model).unwrap();
            let output = holonom(&folder, "run model.toml --no-report --out out");
            let said = text(&output.stderr);
            assert!(output.status.success() && !said.contains("note:"), "{said}{}", text(&output.stdout));
            let (header, rows) = csv(folder.path().join("out/trajectory.csv"));
            assert_eq!(header, "t,axle.angle,motor.effort");
            let off = rows.iter().map(|row| (row[2] - stiffness * row[1]).abs() / moment).fold(0.0, f64::max);
            // A rounding of the torque, of 1.5 at most, and what velocities are rounded by over a step of 0.01.
            assert!(rows.len() == 101 && off < 1e-12, "{off}");
        }
    }
}

#[test]
fn a_formulation_in_place_of_a_method_is_told() {
    for name in ["penalty", "lagrange-2"] {
        let folder = folder();
        let output = holonom(&folder, &format!("run example:four-bar --method {name}"));
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        let cure = format!("cure: `{name}` is a formulation: give --set simulation.formulation={name} in place of it");
        assert!(said.contains(&cure), "{said}");
        prints(&folder, &format!("run example:four-bar --set simulation.formulation={name} --end 0.01 --no-report"), 0);
    }
}

/// What is redundant is told by joints, and the rank of what is solved, where bodies share nodes: two hinges of a car with one direction are both needed,
/// and two of the rows of its nodes follow from the others.
#[test]
fn rows_of_shared_nodes_do_not_contradict_what_is_redundant() {
    let folder = folder();
    let body = |name: &str, y: f64| format!("[body.{name}]\nmass = 25\ninertia = [0.3, 0.8, 0.7]\nposition = [-0.2, {y}, 0.3]\n");
    let hinge = |name: &str, y: f64| {
        format!("[joint.of-{name}]\ntype = \"revolute\"\nbetween = [\"car\", \"{name}\"]\nat = [0.1, {y}, 0.35]\naxis = [0, 1, 0]\n")
    };
    let model = [body("car", 0.0), body("left", 0.6), body("right", -0.6), hinge("left", 0.5), hinge("right", -0.5)].concat();
    fs::write(folder.path().join("arms.toml"), model + "[simulation]\nend = 0.01\nstep = 0.01\n").unwrap();
    let said = text(&holonom(&folder, "check arms.toml").stdout);
    assert!(said.contains("21 rows of rank 19; without shared nodes 36 coordinates, 28 rows of rank 28"), "{said}");
    assert!(said.contains("none without shared nodes; with them 2 rows follow from the others, which makes no difference"), "{said}");
}
