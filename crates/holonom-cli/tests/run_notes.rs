//! What a run says beside its results: slips in the model, and what of the results may be off.

mod common;

use std::fs;

use common::*;

#[test]
fn what_looks_like_a_slip_is_noted_by_run_and_check() {
    let folder = folder();
    let model = "[body.door]\nmass = 1\ninertia = [0, 0, 1]\ncheck_inertia = false\nposition = [0.5, 0, 0]\n\
                 [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                 [drive.motor]\ntype = \"angle\"\njoint = \"hinge\"\nprofile = \"max(t - 1, 0)\"\n\
                 [force.shaker]\ntype = \"torque\"\nbody = \"door\"\ntorque = [0, 0, \"cos(2*pi*100*t)\"]\n[simulation]\nend = 0.9\nstep = 0.01\n";
    fs::write(folder.path().join("door.toml"), model).unwrap();
    let notes = |words: &str| {
        let output = holonom(&folder, words);
        assert!(output.status.success(), "{words}");
        [text(&output.stdout), text(&output.stderr)].concat()
    };
    let inertia = "note: body.door.inertia: the moments 0, 0, 1 cannot belong to a body: 1 exceeds 0 + 0 by 1";
    let blow = "note: drive.motor.profile: its rate jumps by 1 per s at 1 s";
    let step = "note: simulation.step: the step of 5 s is longer than the run of 0.9 s";
    let unseen = "note: force.shaker.torque[2]: steps of 0.01 s do not see what this does within them: from 0 s to 0.01 s its mean is 0 and is taken to be -1 \
                  (a step of 0.005 s sees it, and so do steps by accuracy)";
    for (words, expected) in [
        ("run door.toml --no-report", [true, false, false, true]),
        ("run door.toml --no-report --end 1.2", [true, true, false, true]),
        ("run door.toml --no-report --step 5", [true, false, true, false]),
        ("run door.toml --no-report --step 0.001", [true, false, false, false]),
        ("run door.toml --no-report --accuracy 1e-4", [true, false, false, false]),
        ("run door.toml --no-report --quiet", [false, false, false, false]),
        ("check door.toml --set simulation.end=1.2", [true, true, false, true]),
        ("check door.toml --json --set simulation.step=5", [false, false, false, false]),
    ] {
        let said = notes(words);
        assert_eq!([inertia, blow, step, unseen].map(|note| said.contains(note)), expected, "{words}\n{said}");
    }
    assert_eq!(json(&folder, "check door.toml --json --set simulation.step=5")["notes"].as_array().unwrap().len(), 3);
}

/// A load that hangs at rest from a crab which a drive moves at once begins with the swing of a blow; one that has the velocity of the crab does not.
#[test]
fn drives_that_strike_what_is_at_rest_are_told() {
    let folder = folder();
    let crane = |velocity: &str, profile: &str| {
        format!(
            "plane = \"xz\"\n[body]\ncrab = {{ mass = 10, inertia = 1, position = [0, 0]{velocity} }}\n\
             load = {{ mass = 5, inertia = 1, position = [0.5, -2]{velocity} }}\n\
             [joint]\nrail = {{ type = \"prismatic\", between = [\"ground\", \"crab\"], axis = [1, 0] }}\n\
             hook = {{ type = \"revolute\", between = [\"crab\", \"load\"], at = [0, 0] }}\n\
             [drive.motor]\ntype = \"displacement\"\njoint = \"rail\"\nprofile = \"{profile}\"\n[start]\nequilibrium = true\n"
        )
    };
    for (velocity, profile, told) in [("", "3*t", true), ("", "1.5*t^2", false), (", velocity = [3, 0]", "3*t", false)] {
        fs::write(folder.path().join("m.toml"), crane(velocity, profile)).unwrap();
        let notes = text(&holonom(&folder, "run m.toml --end 0.1 --step 0.01 --no-report --out a --force").stderr);
        let notes = on_one_line(&notes);
        let note = "start.equilibrium: the run does not begin at rest, as drives move at t = 0 and strike what they lead: `crab` by 3 m/s, `load` by";
        assert_eq!(notes.contains(note), told, "{velocity} {profile}\n{notes}");
    }
}

/// What a drive moves needs no velocity of its own; one that was written and is another in the run is told.
#[test]
fn velocities_that_were_written_and_changed_are_told() {
    let folder = folder();
    let crank = |velocity: &str| {
        format!(
            "plane = \"xy\"\n[body.crank]\nmass = 1\ninertia = 1\nposition = [1, 0]\n{velocity}[joint.pin]\ntype = \"revolute\"\n\
             between = [\"ground\", \"crank\"]\nat = [0, 0]\n[drive.motor]\ntype = \"angle\"\njoint = \"pin\"\nprofile = \"2*t\"\n"
        )
    };
    for (velocity, told) in
        [("", ""), ("angular_velocity = 2\nvelocity = [0, 2]\n", ""), ("angular_velocity = 1\n", "`crank` by 2 m/s and 1 rad/s")]
    {
        fs::write(folder.path().join("m.toml"), crank(velocity)).unwrap();
        let notes = text(&holonom(&folder, "run m.toml --end 0.1 --step 0.01 --no-report --out a --force").stderr);
        assert_eq!((notes.contains("start velocities were changed"), notes.contains(told)), (!told.is_empty(), true), "{velocity}{notes}");
    }
}

/// A body that counts as a rod has no turn about itself: that one was written is not left out in silence, unless it is a rod by what is written.
#[test]
fn spins_of_rods_about_themselves_that_were_written_are_told() {
    let folder = folder();
    for (moment, told) in [("1e-6", false), ("1e-10", true), ("0", false)] {
        let text_of = format!(
            "gravity = [0, 0, 0]\n[body.needle]\nmass = 1\ninertia = [{moment}, 1, 1]\nposition = [0, 0, 0]\nangular_velocity = [7, 0, 0]\n"
        );
        fs::write(folder.path().join("m.toml"), text_of).unwrap();
        let notes = text(&holonom(&folder, "run m.toml --end 0.1 --step 0.01 --no-report --out a --force").stderr);
        assert_eq!(notes.contains("do not turn about themselves: `needle` by 7 rad/s was left out"), told, "{moment}: {notes}");
    }
}

/// A formula that is stiff beside the step makes energy that no balance shows: a ball that falls by 1 m comes up to 1 m, and no higher. A pulse of one
/// step and a step that is short for what a controller does are well.
#[test]
fn work_that_steps_get_wrong_is_told() {
    let folder = folder();
    let ball = "[point.ball]\nmass = 1\nposition = [0, 0, 1]\n[force.floor]\ntype = \"expression\"\npoint = \"ball\"\n\
                force = [0, 0, \"1e7*max(0, -z)\"]\n[measure.height]\nvalue = \"max(ball.z)\"\nunit = \"m\"\n[simulation]\nend = 5\nstep = 1e-3\n";
    let rope = "plane = \"xz\"\n[point.load]\nmass = 2\nposition = [1, 0]\nvelocity = [0.6, 0]\n[force.rope]\ntype = \"rope\"\n\
                between = [\"ground\", \"load\"]\nlength = \"1 + 0.2*sin(3*t)\"\nstiffness = 1e7\ndamping = 1000\n[simulation]\nend = 4\nstep = 0.01\n";
    let held = |effort: &str| {
        format!(
            "[body.arm]\nmass = 1\ninertia = [0.01, 0.1, 0.1]\nposition = [1, 0, 0]\n[joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\n\
             at = [0, 0, 0]\naxis = [0, 1, 0]\n[force.motor]\ntype = \"effort\"\njoint = \"pin\"\neffort = \"{effort}\"\n\
             [simulation]\nend = 4\nstep = 0.01\n"
        )
    };
    let notes = |model: &str, words: &str| {
        fs::write(folder.path().join("model.toml"), model).unwrap();
        text(&holonom(&folder, &format!("run model.toml --no-report --force --out a {words}")).stderr)
    };
    let told = |name: &str| format!(" J that could move, most of it that of `{name}`: steps are long for how it changes");
    for method in ["conserving", "conserving-ggl", "midpoint"] {
        let said = notes(ball, &format!("--method {method}"));
        assert!(said.contains(&told("floor")), "{method}: {said}");
        let said = notes(rope, &format!("--method {method}"));
        assert!(said.contains(&told("rope")), "{method}: {said}");
        for (model, words) in [
            (ball, "--step 1e-4"),
            (rope, "--step 1e-4"),
            (&held("-200*(q - 1) - 20*q_rate"), ""),
            (&held("100*(step(t - 0.5) - step(t - 0.51))"), ""),
        ] {
            let said = notes(model, &format!("--method {method} {words}"));
            assert!(!said.contains("may be wrong"), "{method}: {said}");
        }
    }
    // These damp it whatever the step is.
    for method in ["conserving", "conserving-ggl"] {
        let said = notes(&held("-2e4*(q - 1) - 2e3*q_rate"), &format!("--method {method}"));
        assert!(!said.contains("may be wrong"), "{method}: {said}");
    }
}

/// A controller that looks ten times within each nominal step divides it, and no step has failed.
#[test]
fn steps_that_events_divide_have_not_failed() {
    let folder = folder();
    let model = "plane = \"xz\"\n[body.arm]\nmass = 2\ninertia = 0.1\nposition = [0.3, 0]\n\
                 [joint.shoulder]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [0, 0]\n[input.torque]\n\
                 [event.controller]\nevery = 0.002\nset = { torque = \"-30*shoulder.angle - 3*shoulder.angle_rate\" }\n\
                 [force.motor]\ntype = \"effort\"\njoint = \"shoulder\"\neffort = \"torque\"\n";
    fs::write(folder.path().join("arm.toml"), model).unwrap();
    let out = holonom(&folder, "run arm.toml --step 0.05 --end 1 --no-report --out a");
    let said = text(&out.stdout) + &text(&out.stderr);
    assert!(said.contains("completed") && !said.contains("failed"), "{said}");
}

/// Two wheels on one axle hold it sideways twice, at positions and at velocities, which within a step ask for different motions: a method that takes it
/// in many small parts says so, one that stops names those that do not.
#[test]
fn steps_in_many_parts_are_told() {
    let folder = folder();
    let wheel = |name: &str, y: f64| {
        format!(
            "[body.{name}]\nmass = 1\nshape = {{ cylinder = [0.2, 0.02] }}\norientation = {{ axis = [1, 0, 0], angle = \"pi/2\" }}\n\
             position = [0, {y}, 0.2]\nvelocity = [{}, 0, 0]\nangular_velocity = [0, {}, 2]\n\
             [joint.axle-{name}]\ntype = \"revolute\"\nbetween = [\"cart\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             [joint.tread-{name}]\ntype = \"rolling\"\nbetween = [\"ground\", \"{name}\"]\nat = \"{name}\"\naxis = [0, 1, 0]\n\
             normal = [0, 0, 1]\nradius = 0.2\n",
            2.0 - 2.0 * y,
            10.0 - 10.0 * y
        )
    };
    let cart = "[body.cart]\nmass = 20\ninertia = [2, 3, 4]\nposition = [0.3, 0, 0.3]\nvelocity = [2, 0.6, 0]\nangular_velocity = [0, 0, 2]\n\
                [joint.foot]\ntype = \"point-on-plane\"\nbetween = [\"ground\", \"cart\"]\nat = [0.8, 0, 0]\naxis = [0, 0, 1]\n";
    fs::write(folder.path().join("cart.toml"), format!("{cart}{}{}", wheel("left", 0.4), wheel("right", -0.4))).unwrap();
    let said = |words: &str| {
        let out = holonom(&folder, &format!("run cart.toml --no-report --force --out a {words}"));
        text(&out.stdout) + &text(&out.stderr)
    };
    let in_parts = "nominal steps failed as a whole and were taken in ";
    let slow = said("--method lagrange-3/radau --step 0.02 --end 0.1");
    assert!(slow.contains("completed") && slow.contains(in_parts), "{slow}");
    let stopped = said("--method lagrange-3/bdf --step 0.05 --end 0.3");
    assert!(on_one_line(&stopped).contains("may ask for different motions within a step of this method"), "{stopped}");
    for method in ["conserving-ggl", "generalized-alpha", "trapezoidal-projected"] {
        let well = said(&format!("--method {method} --step 0.02 --end 0.3"));
        assert!(well.contains("completed") && !well.contains(in_parts), "{method}: {well}");
    }
    // A car whose front wheels are steered about one centre.
    let each = "repeat = \"i = 0 to 1\"\n";
    let wheels = |name: &str, x: f64| {
        format!(
            "[body.{name}]\n{each}mass = 20\ninertia = [0.5, 1, 0.5]\nposition = [{x}, \"0.75 - 1.5*i\", 0.3]\nvelocity = [4, 0, 0]\n\
             angular_velocity = [0, \"4/0.3\", 0]\n[joint.road-{name}]\n{each}type = \"rolling\"\nbetween = [\"ground\", \"{name}[i]\"]\n\
             at = \"{name}[i]\"\naxis = [0, 1, 0]\nnormal = [0, 0, 1]\nradius = 0.3\n"
        )
    };
    let car = format!(
        "[body.car]\nmass = 1200\ninertia = [400, 1500, 1700]\nposition = [1.2, 0, 0.55]\nvelocity = [4, 0, 0]\n{}{}\
         [joint.axle]\n{each}type = \"revolute\"\nbetween = [\"car\", \"rear[i]\"]\nat = \"rear[i]\"\naxis = [0, 1, 0]\n\
         [joint.knuckle]\n{each}type = \"universal\"\nbetween = [\"car\", \"front[i]\"]\nat = \"front[i]\"\naxes = [[0, 0, 1], [0, 1, 0]]\n\
         [drive.steering]\n{each}type = \"angle\"\njoint = \"knuckle[i].angle1\"\n\
         profile = \"atan2(2.6*tan(0.25*t^2), 2.6 - (0.75 - 1.5*i)*tan(0.25*t^2))\"\n",
        wheels("rear", 0.0),
        wheels("front", 2.6)
    );
    fs::write(folder.path().join("cart.toml"), &car).unwrap();
    for method in ["conserving-ggl", "radau"] {
        let well = said(&format!("--method {method} --step 0.05 --end 1"));
        assert!(well.contains("completed") && !well.contains(in_parts), "{method}: {well}");
    }
    // Both wheels turned by the same angle cannot roll.
    let wrong = car.replace("2.6 - (0.75 - 1.5*i)*tan", "2.6 - 0*tan");
    fs::write(folder.path().join("cart.toml"), wrong).unwrap();
    for method in ["conserving-ggl", "radau"] {
        let stopped = on_one_line(&said(&format!("--method {method} --step 0.05 --end 1")));
        assert!(stopped.contains("contradict each other, as those of wheels that do not all go round one centre"), "{method}: {stopped}");
    }
}

/// Steps that are long for what spins, and a method that loses much of the energy, are told beside figures that are all round-off.
#[test]
fn long_steps_are_told() {
    let folder = folder();
    let rotor = |drive: &str| {
        format!(
            "[body.top]\nmass = 1\ninertia = [0.01, 0.006, 0.006]\nposition = [0, 0, 0]\nangular_velocity = [600, 0, 0]\n\
             [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"top\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n{drive}\
             [simulation]\nend = 0.05\nstep = 1e-3\n"
        )
    };
    fs::write(folder.path().join("top.toml"), rotor("")).unwrap();
    let notes = |words: &str| text(&holonom(&folder, &format!("run top.toml --no-report --force --out a {words}")).stderr);
    let turns = "note: `axle.angle` comes on by 3 % less than its rate says: a method of order 2 lags";
    assert!(notes("").contains(turns), "{}", notes(""));
    assert!(!notes("--step 1e-4").contains("comes on by"), "{}", notes("--step 1e-4"));
    assert!(!notes("--method gauss").contains("comes on by"), "{}", notes("--method gauss"));
    // RATTLE turns by asin ωh, 0.6435 for 0.6.
    let turns = "note: `axle.angle` comes on by 7 % more than its rate says: a method of order 2 leads";
    assert!(notes("--method rattle").contains(turns), "{}", notes("--method rattle"));
    // So does what turns back on its way: from 600 rad/s to −600 rad/s.
    fs::write(folder.path().join("top.toml"), rotor("[force.motor]\ntype = \"effort\"\njoint = \"axle\"\neffort = -240\n")).unwrap();
    assert!(notes("").contains("`axle.angle` comes on by") && !notes("--step 1e-4").contains("comes on by"), "{}", notes(""));
    // Few rows of a rotor that turns back and forth at short steps say nothing of these.
    let spring = rotor("[force.spring]\ntype = \"torsion\"\njoint = \"axle\"\nstiffness = 100\n");
    fs::write(folder.path().join("top.toml"), spring).unwrap();
    let few = notes("--step 1e-4 --end 0.5 --every 60");
    assert!(!few.contains("comes on by"), "{few}");
    let free = "[body.top]\nmass = 1\ninertia = [0.01, 0.006, 0.006]\nposition = [0, 0, 0]\nangular_velocity = [600, 1, 0]\n\
                [simulation]\nend = 0.05\nstep = 1e-3\n";
    fs::write(folder.path().join("top.toml"), free).unwrap();
    // A body in space that no joint has an angle of: 0.6 rad a step, of which 2 atan 0.3 = 0.583 rad come on.
    assert!(notes("").contains("note: `top` comes on by 3 % less than its rate says"), "{}", notes(""));
    for words in ["--step 1e-4", "--method gauss", "--every 20", "--accuracy 1e-6"] {
        assert!(!notes(words).contains("comes on by"), "{words}: {}", notes(words));
    }
    let lost = notes("--method radau --step 5e-3");
    assert!(lost.contains("note: the method has lost ") && lost.contains(" J that could move: shorter steps"), "{lost}");
    assert!(!notes("--method radau --accuracy 1e-6").contains("the method has"));
    // Where a drive leads all that moves the energy is right at any step, and its work alone is off.
    let led = "[drive.motor]\ntype = \"angle\"\njoint = \"axle\"\nprofile = \"600*t + 3*(1 - cos(300*t))\"\n";
    fs::write(folder.path().join("top.toml"), rotor(led)).unwrap();
    let booked = notes("--method bdf");
    assert!(
        booked.contains("note: the work of the drives, which lead all that moves, is booked ") && !booked.contains("the method has"),
        "{booked}"
    );
    // What is driven does not lag.
    fs::write(folder.path().join("top.toml"), rotor("[drive.motor]\ntype = \"angle\"\njoint = \"axle\"\nprofile = \"600*t\"\n")).unwrap();
    assert!(!notes("").contains("comes on by"), "{}", notes(""));
    // Its angle is exact, and with velocities beside the rows its rate is off, as are those of a method whose positions are of a higher order.
    let rate =
        "note: `axle.angle` comes on by 3 % less than its rate says: with velocities of order 2 its rate is too high where steps are long";
    assert!(notes("--method conserving").contains(rate), "{}", notes("--method conserving"));
    let of_order_4 = notes("--method conserving-4 --step 1.5e-3");
    assert!(of_order_4.contains(" less than its rate says: with velocities of order 2 its rate is too high"), "{of_order_4}");
    // Beside what is driven something may be free.
    let other = "[point.other]\nmass = 1\nposition = [0, 0, 1]\n";
    let text = rotor("[drive.motor]\ntype = \"angle\"\njoint = \"axle\"\nprofile = \"600*t\"\n") + other;
    fs::write(folder.path().join("top.toml"), text).unwrap();
    let either = "with a method of order 2 what is free lags, and what drives lead has too high a rate, where steps are long";
    assert!(notes("--method conserving").contains(either), "{}", notes("--method conserving"));
}

/// The blade of a rotor that is driven round, on a hinge with a damper: at 25 steps a turn its angle falls by 0.07 rad and the sum of its rate rises.
#[test]
fn rates_on_what_spins_are_told() {
    let folder = folder();
    let rotor = "plane = \"xy\"\n[body.hub]\nmass = 20\ninertia = 0.7\nposition = [0, 0]\n\
                 [body.blade]\nmass = 18\ninertia = 13.5\nposition = [1.72, 0]\nvelocity = [0, \"1.72*42\"]\nangular_velocity = 42\n\
                 [joint.mast]\ntype = \"revolute\"\nbetween = [\"ground\", \"hub\"]\nat = [0, 0]\n\
                 [joint.lag]\ntype = \"revolute\"\nbetween = [\"hub\", \"blade\"]\nat = [0.22, 0]\n\
                 [force.damper]\ntype = \"torsion\"\njoint = \"lag\"\ndamping = 35\n\
                 [force.drag]\ntype = \"torque\"\nbody = \"blade\"\ntorque = -800\n[simulation]\nend = 0.6\nstep = 6e-3\n";
    let driven = "[drive.engine]\ntype = \"angle\"\njoint = \"mast\"\nprofile = \"42*t\"\n";
    let notes = |words: &str| text(&holonom(&folder, &format!("run rotor.toml --no-report --force --out a {words}")).stderr);
    fs::write(folder.path().join("rotor.toml"), rotor.to_string() + driven).unwrap();
    let said = notes("");
    assert!(said.contains("note: `lag.angle` comes on by 0.14") && said.contains(" rad less than its rate says, "), "{said}");
    let of_order_4 = notes("--method conserving-4");
    assert!(of_order_4.contains("it is on what spins, and with velocities of order 2 and long steps its rate"), "{of_order_4}");
    for words in ["--step 1e-3", "--method gauss", "--method conserving", "--accuracy 1e-4"] {
        assert!(!notes(words).contains("comes on by"), "{words}: {}", notes(words));
    }
    // What turns freely lags with all that it carries.
    fs::write(folder.path().join("rotor.toml"), rotor.replace("position = [0, 0]\n", "position = [0, 0]\nangular_velocity = 42\n"))
        .unwrap();
    assert!(!notes("").contains("`lag.angle`"), "{}", notes(""));
}

/// The same of what goes round without turning itself, in units of any size, on a carriage and far from the origin; a pendulum goes to and fro.
#[test]
fn long_steps_are_told_of_what_goes_round() {
    let folder = folder();
    let notes = |words: &str| text(&holonom(&folder, &format!("run top.toml --no-report --force --out a {words}")).stderr);
    let round = |size: f64, along: f64, far: f64| {
        format!(
            "plane = \"xy\"\ngravity = [0, {}]\n[point]\nq = {{ mass = 1, position = [{far}, 0], velocity = [{along}, {}] }}\n\
             p = {{ mass = 1, position = [{}, 0], velocity = [{along}, {}] }}\n\
             [constraint]\nrod = {{ type = \"distance\", between = [\"q\", \"p\"] }}\n[simulation]\nend = 0.05\nstep = 1e-3\n",
            -1e-6 * size,
            -300.0 * size,
            far + size,
            300.0 * size,
        )
    };
    for (size, along, far) in [(1.0, 0.0, 0.0), (1e3, 0.0, 0.0), (1e-3, 0.0, 0.0), (1.0, 1e4, 0.0), (1.0, 0.0, 1e4)] {
        fs::write(folder.path().join("top.toml"), round(size, along, far)).unwrap();
        for (words, told) in [("", "3 % less"), ("--method rattle", "7 % more")] {
            let told = format!("comes on by {told} than its velocity says");
            assert!(notes(words).contains(&told), "{size} {along} {far} {words}: {}", notes(words));
        }
        for words in ["--step 2e-4", "--method gauss"] {
            assert!(!notes(words).contains("comes on by"), "{words}: {}", notes(words));
        }
    }
    let swing = "plane = \"xy\"\ngravity = [0, -9.81]\n[point]\np = { mass = 1, position = [1, 0] }\n\
                 [constraint]\nrod = { type = \"distance\", between = [\"ground\", \"p\"] }\n[simulation]\nend = 20\nstep = 0.15\n";
    fs::write(folder.path().join("top.toml"), swing).unwrap();
    assert!(!notes("").contains("comes on by"), "{}", notes(""));
}

/// A trammel: its ends slide on the floor and along the wall, and its middle goes round the corner, which says the same. The forces of a penalty, and others where
/// positions drift, are one way of many as well, though beside the rows no row follows from the others.
#[test]
fn forces_that_redundant_rows_share_are_told_off_the_rows_as_on_them() {
    let folder = folder();
    let trammel = "plane = \"xy\"\n[body.rod]\nmass = 2\ninertia = 0.2\nposition = [0.3, 0.4]\n\
                   points = { a = [0.3, -0.4], b = [-0.3, 0.4] }\n\
                   [constraint.floor]\ntype = \"point-on-line\"\npoint = \"rod.a\"\ndirection = [1, 0]\n\
                   [constraint.wall]\ntype = \"point-on-line\"\npoint = \"rod.b\"\ndirection = [0, 1]\n\
                   [constraint.crank]\ntype = \"distance\"\nbetween = [[0, 0], \"rod\"]\n\
                   [force.push]\ntype = \"force\"\nbody = \"rod\"\nat = \"rod.a\"\nforce = [30, 0]\n[simulation]\nend = 0.2\nstep = 0.001\n";
    let notes = |words: &str| text(&holonom(&folder, &format!("run m.toml --no-report --force --out a {words}")).stderr);
    fs::write(folder.path().join("m.toml"), trammel).unwrap();
    let shared = "note: redundant constraints leave open how they share forces: one way of many is shown for crank.force";
    for method in ["conserving-ggl", "penalty/conserving", "penalty/radau", "penalty-stabilized/trapezoidal", "lagrange-1/trapezoidal"] {
        let said = notes(&format!("--method {method}"));
        assert!(said.contains(shared), "{method}: {said}");
    }
    // With nothing redundant nothing is shared.
    fs::write(
        folder.path().join("m.toml"),
        trammel.replace("[constraint.wall]\ntype = \"point-on-line\"\npoint = \"rod.b\"\ndirection = [0, 1]\n", ""),
    )
    .unwrap();
    assert!(!notes("--method penalty/conserving").contains("share forces"));
}

#[test]
fn a_row_at_a_dead_centre_has_no_forces_and_says_so() {
    let folder = folder();
    // A ram goes to where both links stretch at 1 s, and back.
    let model = "plane = \"xz\"\n[parameters]\nc = \"cos(10*deg)\"\ns = \"sin(10*deg)\"\n\
                 [body.upper]\nmass = 20\nshape = { rod = 0.4 }\nposition = [\"0.2*s\", \"-0.2*c\"]\norientation = { angle = \"10*deg - pi/2\" }\n\
                 [body.lower]\nmass = 20\nshape = { rod = 0.4 }\nposition = [\"0.2*s\", \"-0.6*c\"]\norientation = { angle = \"-10*deg - pi/2\" }\n\
                 [body.ram]\nmass = 150\ninertia = 4\nposition = [0, \"-0.8*c\"]\n\
                 [joint.head]\ntype = \"revolute\"\nbetween = [\"ground\", \"upper\"]\nat = [0, 0]\n\
                 [joint.knee]\ntype = \"revolute\"\nbetween = [\"upper\", \"lower\"]\nat = [\"0.4*s\", \"-0.4*c\"]\n\
                 [joint.wrist]\ntype = \"revolute\"\nbetween = [\"lower\", \"ram\"]\nat = \"ram\"\n\
                 [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"ram\"]\naxis = [0, -1]\n\
                 [drive.screw]\ntype = \"displacement\"\njoint = \"guide\"\nprofile = \"0.4*(1 - c)*(1 - cos(pi*t))\"\n\
                 [force.work]\ntype = \"effort\"\njoint = \"guide\"\neffort = -1e6\n\
                 [measure.root]\nvalue = \"sqrt(upper.z + 0.15)\"\n[measure.pin]\nvalue = \"wrist.fz\"\n";
    fs::write(folder.path().join("press.toml"), model).unwrap();
    let notes = on_one_line(&text(&holonom(&folder, "run press.toml --method radau --step 0.01 --end 2 --no-report --out a").stderr));
    for note in [
        "note: one row has no accelerations and no forces of joints and drives, first at 1 s: at a singular position they do not follow",
        "note: the measure `pin` has no finite value in 1 of 201 rows: what it reads has none in the first of them",
        "note: the measure `root` has no finite value in 201 of 201 rows: a formula is outside its domain there",
    ] {
        assert!(notes.contains(note), "{note}\n{notes}");
    }
}

/// The axis of one of four hinges is written 1e-7 off. Bodies share it, and move; rows of hinges by themselves hold the loop, and leave the forces open.
#[test]
fn a_loop_with_too_few_digits_starts_at_a_rate_and_has_no_forces() {
    let folder = folder();
    let body = |name: &str, position: &str| format!("[body.{name}]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = {position}\n");
    let hinge = |name: &str, between: &str, at: &str, axis: &str| {
        format!("[joint.{name}]\ntype = \"revolute\"\nbetween = {between}\nat = {at}\naxis = {axis}\n")
    };
    let model = |axis: &str| {
        [
            body("crank", "[0, 0.5, 0]"),
            body("rod", "[1, 1.2, 0]"),
            body("rocker", "[2, 0.7, 0]"),
            hinge("a", "[\"ground\", \"crank\"]", "[0, 0, 0]", "[0, 0, 1]"),
            hinge("b", "[\"crank\", \"rod\"]", "[0, 1, 0]", "[0, 0, 1]"),
            hinge("c", "[\"rod\", \"rocker\"]", "[2, 1.4, 0]", axis),
            hinge("d", "[\"ground\", \"rocker\"]", "[2, 0, 0]", "[0, 0, 1]"),
            "[start.a]\nangle_rate = 2\n".to_string(),
        ]
        .concat()
    };
    let none = "note: no row has accelerations, or forces of joints and drives";
    for (axis, is_off) in [("[0, 0, 1]", false), ("[1e-7, 0, 1]", true)] {
        fs::write(folder.path().join("loop.toml"), model(axis)).unwrap();
        let run = holonom(&folder, "run loop.toml --step 0.01 --end 0.1 --no-report --force --out a");
        let notes = on_one_line(&text(&run.stderr));
        assert!(run.status.success(), "{notes}");
        assert_eq!([notes.contains(none), notes.contains("share forces")], [is_off, !is_off], "{notes}");
    }
}

/// A vibration of 1000 rad/s, in steps that pass much of its period, is another motion: that is told of methods of order 2, where it holds the kinetic energy and goes on. A
/// stiff spring that hardly vibrates beside a swing, a damped one, and steps that see it are not told of.
#[test]
fn vibrations_that_steps_do_not_see_are_told() {
    let folder = folder();
    let bob = |start: f64, others: &str| {
        format!(
            "plane = \"xy\"\ngravity = [0, -9.81]\n[point.bob]\nmass = 1\nposition = [{start}, 0]\n[force.s]\ntype = \"spring\"\n\
             between = [\"ground\", \"bob\"]\nstiffness = 1e6\nrest_length = 1\n{others}[simulation]\nend = 2\nstep = 0.01\n"
        )
    };
    let is_told = |model: &str, words: &str| {
        fs::write(folder.path().join("bob.toml"), model).unwrap();
        let said = on_one_line(&text(&holonom(&folder, &format!("run bob.toml --no-report --force --out a {words}")).stderr));
        said.contains("note: much of the kinetic energy is in what vibrates or turns by a radian or more in each step: ")
    };
    // 50 J are in the vibration and up to 9.81 J in the swing.
    let stretched = bob(1.01, "");
    for words in ["", "--step 0.1", "--step 1.5e-3", "--step 2e-3 --method conserving", "--step 1.5e-3 --method trapezoidal"] {
        assert!(is_told(&stretched, words), "{words}");
    }
    for words in ["--step 5e-4", "--accuracy 1e-4 --end 0.1", "--method radau", "--method generalized-alpha"] {
        assert!(!is_told(&stretched, words), "{words}");
    }
    fs::write(folder.path().join("bob.toml"), &stretched).unwrap();
    let swept = on_one_line(&text(&holonom(&folder, "sweep bob.toml --vary simulation.step=0.01,5e-4 --no-report --out s").stderr));
    assert!(swept.contains("1 of 2 runs has this note, as run 1 in the column `notes`: much of the kinetic energy"), "{swept}");
    assert!(!is_told(&bob(1.0001, ""), "") && !is_told(&bob(1.01, "damping = 1e3\n"), ""));
}

/// Forces that jump from step to step are told, where the energy shows nothing of it: RATTLE passes its limit of 2/ω on a taut row of light points. Other
/// methods and steps below the limit are not told of, nor the trapezoidal rule of index 3, which finds the right places by multipliers that go to and fro.
#[test]
fn forces_that_jump_from_step_to_step_are_told() {
    let folder = folder();
    let points = [(1, 3e-6), (2, 3e-6), (3, 1.0)]
        .map(|(k, mass)| format!("[point.P{k}]\nmass = {mass}\nposition = [0, -{k}]\nvelocity = [{}, 0]\n", 1.5 * f64::from(k)));
    let rows = [("ground", 1), ("P1", 2), ("P2", 3)]
        .map(|(from, to)| format!("[constraint.r{to}]\ntype = \"distance\"\nbetween = [\"{from}\", \"P{to}\"]\n"));
    let row = format!("plane = \"xy\"\ngravity = [0, -9.81]\n{}{}[simulation]\nend = 0.4\n", points.concat(), rows.concat());
    fs::write(folder.path().join("row.toml"), row).unwrap();
    let is_told = |words: &str| {
        let said = on_one_line(&text(&holonom(&folder, &format!("run {words} --no-report --force --out a")).stderr));
        assert!(!said.contains("the method has"), "{said}");
        said.contains(
            "note: the forces by which the method holds the constraints jump by about as much as they are from one step to the next: ",
        )
    };
    for step in ["1.75e-3", "8.75e-4", "6e-4"] {
        assert!(is_told(&format!("row.toml --method lagrange-3/rattle --step {step}")), "{step}");
        assert!(!is_told(&format!("row.toml --step {step}")), "{step}");
    }
    assert!(!is_told("row.toml --method lagrange-3/rattle --step 4e-4"));
    assert!(!is_told("example:robot-arm --method trapezoidal") && !is_told("example:robot-arm --method lagrange-3/rattle"));
}
