//! `holonom check`: what it says of a model, its drives, its forces that are not unique and its projection, and what runs say of the same.

mod common;

use std::fs;

use common::*;

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

/// A table on four legs: which of them bears how much is open, along the upright alone, and what holds it to its place is not. Its largest forces are on
/// the screen, and every column says what it is.
#[test]
fn forces_of_constraints_that_are_not_unique_are_named() {
    let folder = folder();
    let table = "[body.table]\nmass = 20\nshape = { box = [2, 1, 0.1] }\nposition = [0, 0, 1]\n\
                 points = { a = [1, 0.5, -1], b = [-1, 0.5, -1], c = [-1, -0.5, -1], d = [1, -0.5, -1], pin = [0, 0, -1] }\n\
                 [constraint]\na = { type = \"point-on-plane\", point = \"table.a\", normal = [0, 0, 1] }\n\
                 b = { type = \"point-on-plane\", point = \"table.b\", normal = [0, 0, 1] }\n\
                 c = { type = \"point-on-plane\", point = \"table.c\", normal = [0, 0, 1] }\n\
                 d = { type = \"expression\", value = \"3*table.d.z\" }\n\
                 pin = { type = \"point-on-line\", point = \"table.pin\", direction = [0, 0, 1] }\n\
                 [simulation]\nend = 0.02\nstep = 0.01\n";
    fs::write(folder.path().join("table.toml"), table).unwrap();
    let open = "a.fz, b.fz, c.fz, d.table.d.fz";
    let output = holonom(&folder, "run table.toml --out r");
    let said = on_one_line(&text(&output.stderr));
    assert!(said.contains(&format!(": one way of many is shown for {open} (")), "{said}");
    assert!(on_one_line(&prints(&folder, "check table.toml", 0)).contains(&format!("not unique: {open}; all others are")));
    // Each of them bears the same where nothing says otherwise.
    let said = text(&output.stdout);
    assert!(["a 49.05 N", "b 49.05 N", "c 49.05 N", "d.table.d 49.05 N"].iter().all(|peak| on_one_line(&said).contains(peak)), "{said}");
    let told = fs::read_to_string(folder.path().join("r/columns.json")).unwrap();
    for meaning in ["force of the plane on the point, along z of the world", "force of the constraint on this place, along z of the world"]
    {
        assert!(told.contains(meaning), "{told}");
    }
    // With three legs nothing is shared.
    fs::write(folder.path().join("three.toml"), table.replace("d = { type = \"expression\", value = \"3*table.d.z\" }\n", "")).unwrap();
    assert!(text(&holonom(&folder, "run three.toml").stderr).is_empty());
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
    assert!(text(&output.stderr).contains(&format!(": one way of many is shown for {efforts}")), "{}", text(&output.stderr));
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

/// A four-bar in space one of whose hinges is off by less than bodies that share nodes see moves in a run, and `check` does not refuse it.
#[test]
fn what_runs_is_checked() {
    let folder = folder();
    let body = |name: &str, at: &str| format!("[body.{name}]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = {at}\n");
    let hinge = |name: &str, between: &str, at: &str, off: &str| {
        format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = {at}\naxis = [{off}, 0, 1]\n")
    };
    let bodies = body("crank", "[0, 0.5, 0]") + &body("rod", "[1, 1.2, 0]") + &body("rocker", "[2, 0.7, 0]");
    let loops = hinge("a", "\"ground\", \"crank\"", "[0, 0, 0]", "0")
        + &hinge("b", "\"crank\", \"rod\"", "[0, 1, 0]", "0")
        + &hinge("c", "\"rod\", \"rocker\"", "[2, 1.4, 0]", "1e-7")
        + &hinge("d", "\"ground\", \"rocker\"", "[2, 0, 0]", "0");
    for moved in ["[start.a]\nangle_rate = 2\n", "[drive.motor]\ntype = \"angle\"\njoint = \"a\"\nprofile = \"2*t\"\n"] {
        fs::write(folder.path().join("m.toml"), format!("{bodies}{loops}{moved}")).unwrap();
        prints(&folder, "run m.toml --end 0.1 --step 0.01 --no-report --out a --force", 0);
        let found = json(&folder, "check m.toml --json");
        assert_eq!(found["redundant"], 1);
        let notes = found["notes"].to_string();
        assert!(notes.contains("those of bodies that share nodes"), "{notes}");
        assert!(prints(&folder, "check m.toml", 0).contains("reactions  not known"), "{moved}");
        fails(&folder, "check m.toml --set output.reactions=true", 2);
    }
}
