//! What forces and drives do is recorded: against formulas of the motion that is recorded beside it, and by what their power adds up to.

mod common;

use common::model;
use holonom::model::joints::COUPLERS;
use holonom::model::{Kind, Model, drives, forces};
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom_io::Source;

fn run(model: &Model, step: f64, end: f64) -> (Simulation, Recording) {
    run_with(model, step, end, Constraints::Nothing)
}

fn run_with(model: &Model, step: f64, end: f64, constraints: Constraints) -> (Simulation, Recording) {
    let method = Method::resolve(&Choice::default().named("radau")).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
    simulation.find_reactions();
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, constraints);
    assert_eq!(simulation.run(end, &mut recorder), Status::Completed);
    (simulation, recorder.finish())
}

/// ∫ dt by Simpson's rule over rows that are `step` apart.
fn integral(values: &[f64], step: f64) -> f64 {
    let weight = |k: usize| if k == 0 || k + 1 == values.len() { 1.0 } else { 2.0 + 2.0 * (k % 2) as f64 };
    values.iter().enumerate().map(|(k, value)| weight(k) * value).sum::<f64>() * step / 3.0
}

/// Columns by their names.
fn columns<'a, const N: usize>(recording: &'a Recording, names: [&str; N]) -> [&'a [f64]; N] {
    names.map(|name| recording.column(name).unwrap_or_else(|| panic!("there is no column {name}")))
}

/// One row of some columns at a time.
fn each<const N: usize>(recording: &Recording, names: [&str; N], mut check: impl FnMut([f64; N])) {
    let columns = columns(recording, names);
    (0..recording.rows()).for_each(|k| check(columns.map(|column| column[k])));
}

/// A vector turned by a quaternion, w first.
fn turned(q: [f64; 4], u: [f64; 3]) -> [f64; 3] {
    let q = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(q[0], q[1], q[2], q[3]));
    let u = q * nalgebra::Vector3::from(u);
    [u.x, u.y, u.z]
}

fn close(name: &str, found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * (1.0 + expected.abs()), "{name}: {found:e}, and {expected:e} by hand");
}

fn example(kinds: &'static [Kind], name: &str) -> Model {
    let kind = kinds.iter().find(|kind| kind.name == name).unwrap();
    model(kind.example)
}

fn of_example(kinds: &'static [Kind], name: &str) -> Recording {
    run(&example(kinds, name), 0.01, 0.5).1
}

/// Without gravity all kinetic energy comes from the forces.
#[test]
fn power_adds_up_to_the_energy_that_the_mechanism_has() {
    for kind in forces::KINDS.iter().chain(drives::KINDS) {
        // A buffer's force has a corner, where the rule loses its order.
        let (step, exact) = if kind.name == "stop" { (2e-5, 1e-8) } else { (1e-4, 1e-10) };
        let (simulation, recording) = run(&model(&format!("gravity = [0, 0, 0]\n{}", kind.example)), step, 0.1);
        let power = recording.columns().iter().filter(|column| column.heading.name.ends_with(".power"));
        let (mut gained, mut throughput, mut count) = (0.0, 0.0, 0);
        for column in power {
            assert_eq!(column.heading.unit, "W");
            gained += integral(&column.values, step);
            throughput += integral(&column.values.iter().map(|power| power.abs()).collect::<Vec<_>>(), step);
            count += 1;
        }
        assert!(count > 0, "{} has no power", kind.name);
        let [kinetic] = columns(&recording, ["kinetic"]);
        let risen = kinetic[kinetic.len() - 1] - kinetic[0];
        let off = (gained - risen).abs();
        assert!(throughput > 1e-6, "{} does nothing", kind.name);
        assert!(off <= exact * throughput.max(risen.abs()), "{}: {gained} J of power, {risen} J of motion", kind.name);
        assert!(simulation.audit().energy_summary().max_drift < 1e-9);
    }
}

#[test]
fn springs_are_as_long_as_their_ends_are_apart() {
    each(
        &of_example(forces::KINDS, "spring"),
        ["bob.x", "bob.y", "bob.z", "bob.vx", "bob.vy", "bob.vz", "spring.length", "spring.length_rate", "spring.force", "spring.power"],
        |[x, y, z, vx, vy, vz, length, rate, force, power]| {
            let distance = (x * x + y * y + z * z).sqrt();
            let speed = (x * vx + y * vy + z * vz) / distance;
            let tension = 100.0 * (distance - 0.9) + 0.5 * speed + 40.0 * (distance - 1.0).powi(3) + 0.1 * speed.powi(3);
            close("length", length, distance);
            close("rate", rate, speed);
            close("force", force, tension);
            close("power", power, -tension * speed);
        },
    );
}

/// A strut along the vertical of the world, and one along an axis of the body that it hangs on.
#[test]
fn springs_along_axes_have_the_length_along_them() {
    let strut = |axis: &str| {
        format!(
            "[body.frame]\nmass = 3\ninertia = [0.3, 0.4, 0.5]\nposition = [0, 0, 0]\nangular_velocity = [0.5, -1, 2]\naxes = {{ up = [0, 0.6, 0.8] }}\n\
             [point.bob]\nmass = 1\nposition = [0.5, 0.2, 1]\nvelocity = [1, 0, -2]\n\
             [force.strut]\ntype = \"spring\"\nbetween = [\"frame\", \"bob\"]\nalong = {axis}\nstiffness = 100\nrest_length = 0.3\n\
             damping = 4\nenergy = \"10*extension^4\"\nforce = \"0.1*rate^3*length/rest + sin(t)\"\n"
        )
    };
    let names = ["t", "strut.length", "strut.length_rate", "strut.force", "strut.power", "frame.qw", "frame.qx", "frame.qy", "frame.qz"];
    for axis in ["[0, 0, 3]", "\"frame.up\""] {
        let recording = run(&model(&strut(axis)), 0.002, 0.5).1;
        let [t, length, rate, force, power, qw, qx, qy, qz] = columns(&recording, names);
        let [frame, bob, frame_v, bob_v, spin] = ["frame.", "bob.", "frame.v", "bob.v", "frame.w"]
            .map(|prefix| ["x", "y", "z"].map(|c| recording.column(&format!("{prefix}{c}")).unwrap()));
        for k in 0..recording.rows() {
            let at = |column: [&[f64]; 3]| nalgebra::Vector3::from(column.map(|column| column[k]));
            let turn = nalgebra::UnitQuaternion::new_normalize(nalgebra::Quaternion::new(qw[k], qx[k], qy[k], qz[k]));
            let (e, turning) = match axis {
                "[0, 0, 3]" => (nalgebra::Vector3::z(), nalgebra::Vector3::zeros()),
                _ => (turn * nalgebra::Vector3::new(0.0, 0.6, 0.8), at(spin)),
            };
            let d = at(bob) - at(frame);
            let (along, speed) = (d.dot(&e), (at(bob_v) - at(frame_v)).dot(&e) + d.dot(&turning.cross(&e)));
            let extension = along - 0.3;
            let tension = 100.0 * extension + 4.0 * speed + 40.0 * extension.powi(3) + 0.1 * speed.powi(3) * along / 0.3 + t[k].sin();
            close("length", length[k], along);
            close("rate", rate[k], speed);
            close("force", force[k], tension);
            close("power", power[k], -tension * speed);
        }
    }
}

/// A spring and damper along an axis of a body turns that body, too: nothing acts from outside, and both momenta stay.
#[test]
fn springs_along_axes_of_bodies_keep_energy_and_momenta() {
    for plane in [true, false] {
        let [head, at, other, spin, up, gravity] = match plane {
            true => ["plane = \"xz\"\n", "[0, 0]", "[0.5, 1]", "2", "[0.6, 0.8]", "[0, 0]"],
            false => ["", "[0, 0, 0]", "[0.5, 0.2, 1]", "[0.5, -1, 2]", "[0, 0.6, 0.8]", "[0, 0, 0]"],
        };
        let text = format!(
            "{head}gravity = {gravity}\n[body.frame]\nmass = 3\nshape = {{ box = [1, 0.5, 0.3] }}\nposition = {at}\nangular_velocity = {spin}\naxes = {{ up = {up} }}\n\
             [body.hub]\nmass = 1\nshape = {{ box = [0.2, 0.2, 0.1] }}\nposition = {other}\n\
             [force.strut]\ntype = \"spring\"\nbetween = [\"frame\", \"hub\"]\nalong = \"frame.up\"\nstiffness = 100\ndamping = 2\nenergy = \"10*extension^4\"\n"
        );
        let method = Method::resolve(&Choice::default()).unwrap();
        let mut simulation = Simulation::new(model(&text).system.clone(), method, 0.01).unwrap();
        assert_eq!(simulation.run(2.0, &mut |_: &Simulation| holonom::simulation::Verdict::GoOn), Status::Completed);
        let (energy, momentum) = (simulation.audit().energy_summary(), simulation.audit().momentum_summary());
        assert!(energy.max_drift < 1e-12 && momentum.linear_drift < 1e-12 && momentum.angular_drift < 1e-12, "{energy:?} {momentum:?}");
    }
}

/// `rest` and `extension` follow the key or the start; a parameter of that name comes first.
#[test]
fn laws_know_the_length_without_tension() {
    let spring = |head: &str, keys: &str| {
        format!(
            "{head}[point.bob]\nmass = 1\nposition = [2, 0, 0]\n[force.s]\ntype = \"spring\"\nbetween = [\"ground\", \"bob\"]\n{keys}\n"
        )
    };
    let force = |text: String| run(&model(&text), 0.01, 0.01).1.column("s.force").unwrap()[0];
    assert_eq!(force(spring("", "force = \"3*extension + rest\"")), 2.0);
    assert_eq!(force(spring("", "rest_length = 1.5\nforce = \"3*extension + rest\"")), 3.0);
    assert_eq!(force(spring("", "rest_length = 1.5\nenergy = \"3*extension^2\"")), 3.0);
    assert_eq!(force(spring("parameters = { rest = 7 }\n", "rest_length = 1.5\nforce = \"3*extension + rest\"")), 8.5);
    assert_eq!(force(spring("parameters = { rest = 7, extension = 2 }\n", "force = \"extension + rest*t\"")), 2.0);
}

#[test]
fn ropes_have_the_length_of_all_their_stretches() {
    each(
        &of_example(forces::KINDS, "rope"),
        ["bob.x", "bob.y", "bob.z", "bob.vx", "bob.vy", "bob.vz", "rope.length", "rope.length_rate", "rope.force", "rope.power"],
        |[x, y, z, vx, vy, vz, length, rate, force, power]| {
            let below = (x * x + y * y + z * z).sqrt();
            let speed = (x * vx + y * vy + z * vz) / below;
            let stretch = 1.0 + below - 1.7;
            let tension = if stretch > 0.0 { (100.0 * stretch + 0.5 * speed).max(0.0) } else { 0.0 };
            close("length", length, 1.0 + below);
            close("rate", rate, speed);
            close("force", force, tension);
            close("power", power, -tension * speed);
        },
    );
}

#[test]
fn efforts_along_joints_are_those_of_their_laws() {
    let q = ["hinge.angle", "hinge.angle_rate"];
    each(&of_example(forces::KINDS, "torsion"), [q[0], q[1], "closer.effort", "closer.power"], |[q, rate, effort, power]| {
        close("torsion", effort, -10.0 * (q - 0.1) - 0.5 * rate);
        close("its power", power, effort * rate);
    });
    each(&of_example(forces::KINDS, "friction"), [q[1], "rust.effort", "rust.power"], |[rate, effort, power]| {
        close("friction", effort, -0.2 * (rate / 0.5).tanh() - 0.1 * rate);
        close("its power", power, effort * rate);
    });
    let mut touches = 0;
    each(&of_example(forces::KINDS, "stop"), [q[0], q[1], "buffer.effort", "buffer.power"], |[q, rate, effort, power]| {
        let beyond = [(-0.02 - q).max(0.0), (q - 0.01).max(0.0)];
        touches += usize::from(beyond != [0.0; 2]);
        close("stop", effort, 50.0 * (beyond[0] - beyond[1]) - 50.0 * 0.2 * (beyond[0] + beyond[1]) * rate);
        close("its power", power, effort * rate);
    });
    assert!(touches > 0, "the stop is reached");
    let names = ["t", q[0], q[1], "rail.displacement", "rail.displacement_rate", "controller.effort", "controller.power"];
    each(&of_example(forces::KINDS, "effort"), names, |[t, q, rate, s, s_rate, effort, power]| {
        close("effort", effort, 2.0 * t.sin() - 5.0 * q - 0.3 * rate + s - 0.1 * s_rate);
        close("its power", power, effort * rate);
    });
}

#[test]
fn loads_are_those_of_their_formulas() {
    each(&of_example(forces::KINDS, "constant"), ["bob.vy", "wind.fx", "wind.fy", "wind.fz", "wind.power"], |[vy, fx, fy, fz, power]| {
        assert_eq!([fx, fy, fz], [0.0, 2.0, 0.0]);
        close("power", power, 2.0 * vy);
    });
    let names = ["t", "bob.z", "bob.vx", "bob.vy", "bob.vz", "drag.fx", "drag.fy", "drag.fz", "drag.power"];
    each(&of_example(forces::KINDS, "expression"), names, |[t, z, vx, vy, vz, fx, fy, fz, power]| {
        let expected = [-0.1 * vx * (vx * vx + vy * vy + vz * vz + 1e-12).sqrt(), t.sin(), -z.powi(3)];
        [fx, fy, fz].into_iter().zip(expected).for_each(|(found, expected)| close("expression", found, expected));
        close("power", power, fx * vx + fy * vy + fz * vz);
    });
    let names = ["t", "rocket.qw", "rocket.qx", "rocket.qy", "rocket.qz", "rocket.wy", "rocket.nozzle.x", "rocket.nozzle.vz"];
    let recording = of_example(forces::KINDS, "force");
    let (state, thrust) = (columns(&recording, names), columns(&recording, ["thrust.fx", "thrust.fy", "thrust.fz"]));
    for k in 0..recording.rows() {
        let [t, qw, qx, qy, qz, wy, x, vz] = state.map(|column| column[k]);
        let expected = turned([qw, qx, qy, qz], [0.0, 0.1 * t.sin(), 40.0 - 0.2 * vz * vz - x + 0.1 * wy]);
        (0..3).for_each(|c| close("force", thrust[c][k], expected[c]));
    }
    let names = ["t", "rotor.qw", "rotor.qx", "rotor.qy", "rotor.qz", "rotor.wx", "rotor.wz", "motor.tx", "motor.ty", "motor.tz"];
    each(&of_example(forces::KINDS, "torque"), names, |[t, qw, qx, qy, qz, wx, wz, tx, ty, tz]| {
        let expected = turned([qw, qx, qy, qz], [-0.1 * wx, 0.0, 0.033 * t.cos() - 0.01 * wz]);
        [tx, ty, tz].into_iter().zip(expected).for_each(|(found, expected)| close("torque", found, expected));
    });
}

/// The first body is the ground, so that its axes are the world's.
#[test]
fn bushings_push_back_along_all_axes() {
    let recording = of_example(forces::KINDS, "bushing");
    let [stiffness, damping] = [[2e3, 2e3, 5e3], [20.0, 20.0, 50.0]];
    let values = columns(&recording, ["mount.dx", "mount.dy", "mount.dz"]);
    let efforts = columns(&recording, ["mount.fx", "mount.fy", "mount.fz"]);
    let [t] = columns(&recording, ["t"]);
    for k in 1..recording.rows() - 1 {
        for c in 0..3 {
            let rate = (values[c][k + 1] - values[c][k - 1]) / (t[k + 1] - t[k - 1]);
            let expected = -stiffness[c] * values[c][k] - damping[c] * rate;
            // The rate is a difference, which h² spoils.
            let off = (efforts[c][k] - expected).abs();
            assert!(off < 0.05 * (1.0 + efforts[c].iter().fold(0.0, |most: f64, effort| most.max(effort.abs()))), "{c}: {off}");
        }
    }
}

/// Turned by the angle q about one axis it shows sin q, a number without a unit.
#[test]
fn bushings_show_sines_of_their_rotations() {
    for (plane, body, at, axis, column) in [
        ("", "inertia = [1, 1, 1]\nposition = [0, 0, 0]", "[0, 0, 0]", "axis = [0, 1, 0]", "k.ry"),
        ("plane = \"xy\"\n", "inertia = 1\nposition = [0, 0]", "[0, 0]", "", "k.r"),
    ] {
        let stiffness = if plane.is_empty() { "[0, 0, 0, 1, 1, 1]" } else { "[0, 0, 1]" };
        let model = model(&format!(
            "{plane}[body.b]\nmass = 1\n{body}\n[joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = {at}\n{axis}\n\
             [drive.d]\ntype = \"angle\"\njoint = \"h\"\nprofile = \"2*t\"\n\
             [force.k]\ntype = \"bushing\"\nbetween = [\"ground\", \"b\"]\nat = {at}\nstiffness = {stiffness}\n"
        ));
        let recording = run_with(&model, 0.01, 1.0, Constraints::Joints).1;
        let heading = &recording.find(column).unwrap().heading;
        assert_eq!(heading.unit, "1", "{column}");
        assert!(heading.meaning.starts_with("sine of the rotation about"), "{}", heading.meaning);
        each(&recording, ["t", column], |[t, sine]| close("sine", sine, (2.0 * t).sin()));
    }
}

/// What turns a free body is the moment of its bushing: Iα + ω × Iω, far from small angles and about three axes at once, and about the normal of a
/// plane.
#[test]
fn bushings_exert_the_moments_that_they_show() {
    let text = |plane: &str, inertia: &str, spin: &str, stiffness: &str| {
        format!(
            "{plane}[body.b]\nmass = 1\ninertia = {inertia}\nposition = {at}\nangular_velocity = {spin}\n[force.k]\ntype = \"bushing\"\n\
             between = [\"ground\", \"b\"]\nat = {at}\nstiffness = {stiffness}\ndamping = {stiffness}\n",
            at = if plane.contains("plane") { "[0, 0]" } else { "[0, 0, 0]" }
        )
    };
    let planar = run_with(&model(&text("plane = \"xy\"\n", "0.5", "3", "[0, 0, 10]")), 0.001, 0.3, Constraints::Joints).1;
    each(&planar, ["b.alpha", "k.t"], |[alpha, moment]| close("planar moment", moment, 0.5 * alpha));
    // Between two pins far from the origin, the one of the ground, its axes run from the one to the other.
    let pinned = "plane = \"xy\"\ngravity = [0, 0]\n[body.b]\nmass = 1\ninertia = 0.5\nposition = [1000, 0]\nangular_velocity = 3\n\
                  [body.c]\nmass = 1\ninertia = 0.1\nposition = [1001, 0]\n\
                  [joint.pin]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [1000, 0]\n\
                  [joint.knee]\ntype = \"revolute\"\nbetween = [\"b\", \"c\"]\nat = [1001, 0]\n\
                  [force.k]\ntype = \"bushing\"\nbetween = [\"ground\", \"b\"]\nat = [1000, 0]\nstiffness = [0, 0, 10]\n";
    let far = run_with(&model(pinned), 0.001, 0.3, Constraints::Joints).1;
    each(&far, ["b.alpha", "k.t", "b.angle", "c.ax", "c.ay"], |[alpha, moment, angle, ax, ay]| {
        close("moment far away", moment, 0.5 * alpha + angle.cos() * ay - angle.sin() * ax);
    });
    let inertia = [0.5, 0.6, 0.7];
    let spatial = run_with(
        &model(&text("gravity = [0, 0, 0]\n", "[0.5, 0.6, 0.7]", "[1.5, 1, 0.5]", "[0, 0, 0, 10, 20, 40]")),
        0.001,
        0.3,
        Constraints::Joints,
    )
    .1;
    let names = ["qw", "qx", "qy", "qz", "wx", "wy", "wz", "alphax", "alphay", "alphaz"].map(|name| format!("b.{name}"));
    let names = names.iter().map(String::as_str).chain(["k.tx", "k.ty", "k.tz"]).collect::<Vec<_>>();
    let names: [&str; 13] = names.try_into().unwrap();
    each(&spatial, names, |[qw, qx, qy, qz, wx, wy, wz, ax, ay, az, tx, ty, tz]| {
        // In the axes of the body.
        let back = |v: [f64; 3]| turned([qw, -qx, -qy, -qz], v);
        let (w, a, t) = (back([wx, wy, wz]), back([ax, ay, az]), back([tx, ty, tz]));
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            close("spatial moment", t[k], inertia[k] * a[k] + (inertia[j] - inertia[i]) * w[i] * w[j]);
        }
    });
}

#[test]
fn drives_have_power_and_all_columns_say_what_they_show() {
    let recording = of_example(drives::KINDS, "angle");
    each(&recording, ["axle.angle_rate", "motor.effort", "motor.power"], |[rate, effort, power]| {
        close("power", power, effort * rate);
        // The axle turns with t² under the moment of inertia of a disc.
        close("effort", effort, 2.0 * 0.5 * 0.01);
    });
    for kind in forces::KINDS.iter().chain(drives::KINDS) {
        for column in run(&model(kind.example), 0.01, 0.01).1.columns() {
            let heading = &column.heading;
            assert!(!heading.unit.is_empty() && heading.meaning.len() > 3, "{} of {} says nothing", heading.name, kind.name);
        }
    }
}

/// The same motion written as a length and as a stroke, of a drive and of a rod.
#[test]
fn strokes_count_from_the_length_of_the_start() {
    let text = |drive: &str, rod: &str| {
        format!(
            "plane = \"xz\"\n[body.boom]\nmass = 10\nshape = {{ box = [2, 0.1, 0.1] }}\nposition = [1, 0]\n\
             [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"boom\"]\nat = [0, 0]\n\
             [drive.cylinder]\ntype = \"distance\"\nbetween = [[1, -1], \"boom\"]\n{drive}\n\
             [point.bob]\nrepeat = \"i = 1 to 2\"\nmass = 1\nposition = [3, \"-i\"]\n\
             [constraint.rope]\nrepeat = \"i = 1 to 2\"\ntype = \"distance\"\nbetween = [[3, 0.5], \"bob[i]\"]\n{rod}\n"
        )
    };
    let [lengths, strokes] = [
        text("profile = { table = [[0, 1], [1, 1.2], [2, 0.9]] }", "length = \"i + 0.5 + 0.1*sin(t)\""),
        text("stroke = { table = [[0, 0], [1, 0.2], [2, -0.1]] }", "stroke = \"0.1*sin(t)\""),
    ]
    .map(|text| run(&model(&text), 0.01, 1.5).1);
    for name in ["hinge.angle", "cylinder.effort", "cylinder.power", "bob[1].z", "bob[2].vz"] {
        let [[length], [stroke]] = [&lengths, &strokes].map(|recording| columns(recording, [name]));
        assert!(length.iter().any(|value| *value != length[0]), "{name} changes");
        length.iter().zip(stroke).for_each(|(length, stroke)| close(name, *stroke, *length));
    }
}

/// What a coupler exerts on a wheel is what turns it, beside the motor; both sides together have no power.
#[test]
fn couplers_show_what_they_transmit() {
    // Kind; joint, body, component of its acceleration and inertia of both sides; factors of the row.
    let wheels = [("axle1", "wheel1.alphaz", 0.5 * 0.1 * 0.1), ("axle2", "wheel2.alphaz", 0.5 * 4.0 * 0.2 * 0.2)];
    let rack = [("axle", "pinion.alphaz", 0.5 * 0.1 * 0.1), ("rail", "rack.ax", 2.0)];
    for (kind, coupler, sides, factors) in [
        ("gear", "mesh", wheels, [1.0, 2.0]),
        ("pulley", "belt", wheels, [0.1, -0.2]),
        ("linear", "sum", wheels, [1.0, 2.0]),
        ("rack-and-pinion", "teeth", rack, [-0.1, 1.0]),
    ] {
        let text = COUPLERS.iter().find(|known| known.name == kind).unwrap().example;
        let motor = format!("[force.motor]\ntype = \"effort\"\njoint = \"{}\"\neffort = \"3 + t\"\n", sides[0].0);
        for output in ["", "[output]\nreactions = true\n"] {
            let source = Source::read("model.toml", format!("{text}\n{motor}{output}").as_bytes()).unwrap();
            let model = source.model_with_forces().unwrap();
            let method = Method::resolve(&Choice::default().named("radau")).unwrap();
            let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap();
            model.find_reactions(&mut simulation);
            let mut recorder = Recorder::new(&model.channels, &model.system, 1, model.output.constraints());
            assert_eq!(simulation.run(0.2, &mut recorder), Status::Completed);
            let recording = recorder.finish();
            let coordinate = |joint: &str| if joint == "rail" { "displacement" } else { "angle" };
            let column = |name: &str| recording.find(name).unwrap_or_else(|| panic!("{kind}: {name}"));
            let efforts = sides.map(|(joint, _, _)| column(&format!("{coupler}.{joint}.{}.effort", coordinate(joint))));
            assert_eq!(efforts.map(|effort| &*effort.heading.unit), ["N·m", if kind == "rack-and-pinion" { "N" } else { "N·m" }]);
            for (k, t) in recording.column("t").unwrap().iter().enumerate() {
                for (side, motor) in [(0, 3.0 + t), (1, 0.0)] {
                    let (_, acceleration, inertia) = sides[side];
                    close(kind, efforts[side].values[k] + motor, inertia * column(acceleration).values[k]);
                }
                close(kind, efforts[0].values[k] * factors[1], efforts[1].values[k] * factors[0]);
            }
        }
    }
}

/// The cylinder of the drives' example is as long as its ends are apart.
#[test]
fn driven_distances_have_their_length() {
    let text = "[body.boom]\nmass = 10\nshape = { box = [2, 0.1, 0.1] }\nposition = [1, 1, 0]\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"boom\"]\nat = [0, 1, 0]\naxis = [0, 1, 0]\n\
                [drive.cylinder]\ntype = \"distance\"\nbetween = [[1, 1, -1], \"boom\"]\n";
    for drive in ["stroke = \"0.1*sin(t)\"", "profile = \"1 + 0.1*sin(t)\""] {
        let recording = run(&model(&format!("{text}{drive}\n")), 0.01, 0.5).1;
        each(
            &recording,
            ["boom.x", "boom.z", "boom.vx", "boom.vz", "cylinder.length", "cylinder.length_rate", "cylinder.effort", "cylinder.power"],
            |[x, z, vx, vz, length, rate, effort, power]| {
                let distance = (x - 1.0).hypot(z + 1.0);
                close("length", length, distance);
                close("rate", rate, ((x - 1.0) * vx + (z + 1.0) * vz) / distance);
                close("power", power, effort * rate);
            },
        );
    }
}

/// With the normal along z a puck's x and y are those of the model; of other normals x is the world's axis farthest from them, and y is u × x.
#[test]
fn displacements_in_a_plane_go_where_they_say() {
    for kind in ["planar", "point-on-plane"] {
        for (axis, x, y) in [
            ([0, 0, 1], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
            ([0, 0, -1], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
            ([1, 0, 0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
            ([0, 1, 0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ] {
            for (name, expected) in [("x", x), ("y", y)] {
                let text = format!(
                    "gravity = [0, 0, 0]\n[body.puck]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n[joint.table]\ntype = \"{kind}\"\n\
                     between = [\"ground\", \"puck\"]\nat = [0, 0, 0]\naxis = {axis:?}\n\
                     [drive.d]\ntype = \"displacement\"\njoint = \"table.{name}\"\nprofile = \"t^2\"\n"
                );
                let (_, recording) = run(&model(&text), 0.1, 1.0);
                let found = ["puck.x", "puck.y", "puck.z"].map(|column| *recording.column(column).unwrap().last().unwrap());
                let off = found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max);
                assert!(off < 1e-12, "{kind}, axis {axis:?}, {name}: {found:?}");
            }
        }
    }
}

/// Which way x goes across an axis that is an axis of the model but for rounding is not up to that.
#[test]
fn displacements_across_an_axis_do_not_depend_on_rounding() {
    let slide = |axis: &str| {
        // The plate is turned so that its axis n points along the model's x.
        let text = format!(
            "gravity = [0, 0, 0]\n[body.plate]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\n\
             orientation = {{ axis = [-0.01, -0.1, 0.3], angle = 1.15 }}\n\
             axes = {{ n = [0.40907836252163576, -0.8595820513116555, -0.30622473835316394] }}\n\
             [body.puck]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\nvelocity = [0, 0.5, 1]\n\
             [joint.w]\ntype = \"fixed\"\nbetween = [\"ground\", \"plate\"]\n\
             [joint.j]\ntype = \"planar\"\nbetween = [\"plate\", \"puck\"]\nat = [0, 0, 0]\naxis = {axis}\n"
        );
        let recording = common::run_every(&common::model(&text), "conserving-ggl", 0.01, 0.1, 1).1;
        ["j.x", "j.y"].map(|name| common::last(&recording, name))
    };
    let ([x, y], [u, v]) = (slide("[1, 0, 0]"), slide("\"plate.n\""));
    assert!((x - 0.05).abs() < 1e-12 && (y - 0.1).abs() < 1e-12, "{x}, {y}");
    assert!((x - u).abs() < 1e-12 && (y - v).abs() < 1e-12, "{u}, {v}");
}

/// An effort may depend on a way along a curve and on two angles: more invariants than a law has.
#[test]
fn an_effort_depends_on_ways_along_curves() {
    let model = model(
        "gravity = [0, 0, 0]\n[body.a]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [2, 0, 0]\n\
         [body.b]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [4, 0, 0]\nangular_velocity = [0, 0, 1]\n\
         [point.car]\nmass = 2\nposition = [0, 3, 0]\nvelocity = [0.5, 0, 0]\n\
         [joint.ja]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [2, 0, 0]\naxis = [0, 0, 1]\n\
         [joint.jb]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [4, 0, 0]\naxis = [0, 0, 1]\n\
         [joint.track]\ntype = \"point-on-curve\"\nbetween = [\"ground\", \"car\"]\nat = [0, 3, 0]\ncurve = [[-1, 3, 0.5], [0, 3, 0], [1, 3, 0.3], [2, 3.5, 0]]\n\
         [force.controller]\ntype = \"effort\"\njoint = \"ja\"\ncoordinates = { b = \"jb\", s = \"track\" }\neffort = \"-2*q - b + s\"\n",
    );
    let recording = run(&model, 0.01, 1.0).1;
    each(&recording, ["controller.effort", "ja.angle", "jb.angle", "track.displacement"], |[effort, q, b, s]| {
        close("controller.effort", effort, -2.0 * q - b + s);
    });
}
