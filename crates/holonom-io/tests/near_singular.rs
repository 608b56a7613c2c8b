//! Forces beside positions where bars come to lie in a line, and exactly there, against statics.

mod common;

use std::f64::consts::PI;

use common::model;
use holonom::record::{Constraints, Recorder};
use holonom::simulation::{Choice, Method, Simulation};

/// Two bars in a flat arch bear (m g/2)/sag of thrust, however flat it is.
#[test]
fn a_flat_arch_has_the_thrust_of_statics() {
    for sag in [1e-2, 1e-3, 1e-4, 5e-5, 3e-5, 2e-5, 1.5e-5] {
        let text = format!(
            "plane = \"xy\"\ngravity = [0, -10]\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [-0.5, {half}]\n\
             [body.b]\nmass = 1\ninertia = 0.1\nposition = [0.5, {half}]\n\
             [joint.A]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [-1, 0]\n\
             [joint.B]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\nat = [1, 0]\n\
             [joint.C]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [0, {full}]\n[output]\nreactions = true\n",
            half = -0.5 * sag,
            full = -sag
        );
        for method in ["conserving-ggl", "radau"] {
            let model = model(&text);
            let simulation = common::simulation(&model, method, 0.01);
            let (thrust, expected) = (model.reaction(&simulation, "A").unwrap().force[0].abs(), 10.0 * 0.5 / sag);
            assert!((thrust / expected - 1.0).abs() < 1e-5, "{method}, sag {sag} m: {thrust} N, and {expected} N by hand");
        }
    }
}

/// A parallelogram of two cranks of 1 m and a coupler of 2 kg, of which one is driven; at 90° all lie in line.
fn parallelogram(rates: [f64; 2], start: f64, drive: &str) -> String {
    let (s, c) = start.sin_cos();
    let crank = |name: &str, x: f64, rate: f64| {
        format!(
            "[body.{name}]\nmass = 1\ninertia = 0.1\nposition = [{}, {}]\norientation = {{ angle = {start} }}\nangular_velocity = {rate}\nvelocity = [{}, {}]\n\
             [joint.{}]\ntype = \"revolute\"\nbetween = [\"ground\", \"{name}\"]\nat = [{x}, 0]\n",
            x + 0.5 * c,
            0.5 * s,
            -0.5 * rate * s,
            0.5 * rate * c,
            name.to_uppercase()
        )
    };
    let mean = 0.5 * (rates[0] + rates[1]);
    format!(
        "plane = \"xz\"\n{}{}[body.k]\nmass = 2\ninertia = 0.2\nposition = [{}, {s}]\nvelocity = [{}, {}]\nangular_velocity = {}\n\
         [joint.P]\ntype = \"revolute\"\nbetween = [\"a\", \"k\"]\nat = [{c}, {s}]\n\
         [joint.Q]\ntype = \"revolute\"\nbetween = [\"b\", \"k\"]\nat = [{}, {s}]\n{drive}",
        crank("a", 0.0, rates[0]),
        crank("b", 1.0, rates[1]),
        c + 0.5,
        -mean * s,
        mean * c,
        rates[1] - rates[0],
        c + 1.0
    )
}

/// The moment of a motor that turns it at a steady rate is that of the weights, right up to the line, and has no number on it.
#[test]
fn a_motor_has_its_moment_beside_a_dead_centre() {
    let drive = "[drive.m]\ntype = \"angle\"\njoint = \"A\"\nprofile = \"t\"\n";
    for beside in [1e-2, 1e-3, 1e-4] {
        let text = parallelogram([1.0, 1.0], -beside, drive);
        let (_, recording) = common::run_every(&common::model_with_forces(&text), "conserving-ggl", beside / 4.0, beside / 2.0, 1);
        for (row, effort) in recording.column("m.effort").unwrap().iter().enumerate() {
            let angle = -beside + beside / 4.0 * row as f64;
            let expected = (0.5 + 0.5 + 2.0) * 9.81 * angle.cos();
            assert!((effort / expected - 1.0).abs() < 1e-4, "{beside} rad: {effort} N·m in row {row}, and {expected} N·m by hand");
        }
    }
}

/// In a row still nearer to the line its moment is that of the weights, too, or there is none: what rounding leaves of velocities decides on accelerations there.
#[test]
fn a_motor_has_its_moment_or_none_as_near_as_rounding() {
    let drive = "[drive.m]\ntype = \"angle\"\njoint = \"A\"\nprofile = \"t\"\n";
    for beside in [1e-5, 3e-6, 1e-6, 2e-7] {
        let text = parallelogram([1.0, 1.0], beside - 0.5, drive);
        for method in ["conserving-ggl", "conserving", "radau", "lagrange-3/rattle", "conserving-projected"] {
            let (_, recording) = common::run_every(&common::model_with_forces(&text), method, 0.1, 1.0, 1);
            let efforts = recording.column("m.effort").unwrap();
            assert_eq!(efforts.len(), 11, "{beside} rad, {method}");
            for (row, effort) in efforts.iter().enumerate() {
                let expected = 3.0 * 9.81 * (beside - 0.5 + 0.1 * row as f64).cos();
                let is_right = (effort / expected - 1.0).abs() < 0.01;
                assert!(
                    is_right || (effort.is_nan() && row == 5),
                    "{beside} rad, {method}, row {row}: {effort} N·m, and {expected} N·m by hand"
                );
            }
        }
    }
}

/// A toggle press whose ram is driven to the dead centre at 1 s and back, in the plane or in space, against a force of 1 MN.
fn toggle(is_planar: bool) -> String {
    const ARM: f64 = 0.4;
    let (sin, cos) = 10_f64.to_radians().sin_cos();
    let at = |x: f64, z: f64| if is_planar { format!("[{x}, {z}]") } else { format!("[{x}, 0, {z}]") };
    let turned =
        |angle: f64| if is_planar { format!("{{ angle = {angle} }}") } else { format!("{{ axis = [0, -1, 0], angle = {angle} }}") };
    let (axis, inertia) = if is_planar { ("", "4") } else { ("axis = [0, -1, 0]\n", "[4, 4, 4]") };
    let head = if is_planar { "plane = \"xz\"\n" } else { "" };
    let link = |name: &str, place: String, angle: f64| {
        format!("[body.{name}]\nmass = 20\nshape = {{ box = [{ARM}, 1e-3, 1e-3] }}\nposition = {place}\norientation = {}\n", turned(angle))
    };
    let hinge = |name: &str, between: &str, place: String| {
        format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [{between}]\nat = {place}\n{axis}")
    };
    let knee = at(ARM * sin, -ARM * cos);
    let wrist = at(0.0, -2.0 * ARM * cos);
    format!(
        "{head}{}{}[body.ram]\nmass = 150\ninertia = {inertia}\nposition = {wrist}\n{}{}{}\
         [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"ram\"]\naxis = {}\n\
         [drive.screw]\ntype = \"displacement\"\njoint = \"guide\"\nprofile = \"{}*(1 - cos(pi*t))/2\"\n\
         [force.work]\ntype = \"effort\"\njoint = \"guide\"\neffort = -1e6\n",
        link("upper", at(0.5 * ARM * sin, -0.5 * ARM * cos), 10_f64.to_radians() - 0.5 * PI),
        link("lower", at(0.5 * ARM * sin, -1.5 * ARM * cos), -10_f64.to_radians() - 0.5 * PI),
        hinge("head", "\"ground\", \"upper\"", at(0.0, 0.0)),
        hinge("knee", "\"upper\", \"lower\"", knee),
        hinge("wrist", "\"lower\", \"ram\"", wrist.clone()),
        at(0.0, -1.0),
        2.0 * ARM * (1.0 - cos)
    )
}

/// Beside the dead centre of a toggle the pin at the ram bears next to nothing of what the screw bears, and at it nothing tells how they share: a row has the
/// force by hand to a thousandth of the largest, or none. Long before and after it has its force to round-off of what the screw bears.
#[test]
fn a_toggle_has_its_force_or_none_at_its_dead_centre() {
    // With the angle k of a link, k' = ω and k'' = k (ω² − π²)/4 beside the dead centre: Lagrange's equation of k without the ram, over 2 a k.
    let (a, m) = (0.4, 20.0);
    let omega2 = 2.0 * a * (1.0 - 10_f64.to_radians().cos()) * PI * PI / (4.0 * a);
    let by_hand = -(2.0 / 3.0 * m * a * a * 0.25 * (omega2 - PI * PI) + 2.0 * m * a * a * omega2 + 2.0 * m * 9.81 * a) / (2.0 * a);
    for is_planar in [true, false] {
        let model = common::model_with_forces(&toggle(is_planar));
        for method in ["radau", "conserving-ggl", "bdf", "hht", "trapezoidal-projected"] {
            for beside in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-11, 0.0] {
                let mut simulation = common::simulation(&model, method, 0.01);
                let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Joints);
                // Some methods stop beside it, and say so.
                let _ = simulation.run(1.0 - beside, &mut recorder);
                let recording = recorder.finish();
                let forces = recording.column("wrist.fz").unwrap();
                let (force, near) = (*forces.last().unwrap(), forces[forces.len() - 3]);
                assert!((near - by_hand).abs() < 0.5, "{is_planar}, {method}, {beside} s: {near} N before, and {by_hand} N by hand");
                let is_right = (force - by_hand).abs() < 1e3;
                assert!(
                    is_right || (force.is_nan() && beside < 2e-4),
                    "{is_planar}, {method}, {beside} s: {force} N, and {by_hand} N by hand"
                );
            }
        }
    }
}

/// Flat cranks turn both with the same rate, or the second alone, as the second derivative of the coupler's length says, a² − a b = 0: other rates belong to no
/// motion, which the start knows.
#[test]
fn a_start_knows_whether_a_motion_begins_with_it() {
    for (rates, begins) in
        [([1.0, 1.0], true), ([0.0, 1.0], true), ([0.0, 0.0], true), ([1.0, 0.5], false), ([1.0, 0.0], false), ([1.0, -1.0], false)]
    {
        let text = format!("gravity = [0, 0]\n{}", parallelogram(rates, 0.0, ""));
        let choice = Choice::default().named("conserving-ggl");
        let simulation = Simulation::new(model(&text).system.clone(), Method::resolve(&choice).unwrap(), 0.01).unwrap();
        assert_eq!(simulation.start().leads_nowhere, !begins, "{rates:?}");
    }
}

/// What stands still on more hinges than it needs has forces, of nothing, in every row: what round-off makes of its velocities is no motion
/// that leads nowhere, in any unit and for any mass.
#[test]
fn what_stands_still_has_forces() {
    for (length, mass, place) in [(1e-3, 1.0, 1e4), (1.0, 1e6, 0.0), (1e3, 1e-6, 0.0), (1e3, 1.0, 1e4), (1e3, 1e6, 0.0)] {
        let at = |x: f64, y: f64, z: f64| format!("[{}, {}, {}]", length * (x + place), length * y, length * z);
        let inertia = |share: f64| format!("[{}, {}, {}]", 3.0 * share, 2.5 * share, 1.5 * share);
        let square = mass * length * length;
        let mut text = format!(
            "gravity = [0, 0, 0]\n[body.door]\nmass = {mass}\ninertia = {}\nposition = {}\n\
             [body.knob]\nmass = {}\ninertia = {}\nposition = {}\n\
             [joint.screw]\ntype = \"fixed\"\nbetween = [\"door\", \"knob\"]\nat = {}\n\
             [joint.pin]\ntype = \"spherical\"\nbetween = [\"door\", \"knob\"]\nat = {}\n[output]\nreactions = true\n",
            inertia(square),
            at(0.5, 0.25, 0.5),
            1e-6 * mass,
            inertia(1e-8 * square),
            at(1.0, 0.5, 0.5),
            at(1.0, 0.5, 0.5),
            at(1.0, 0.5, 0.625)
        );
        for k in 0..4 {
            let place = at(0.0, 0.0, 0.25 * f64::from(k));
            text += &format!("[joint.h{k}]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = {place}\naxis = [0, 0, 1]\n");
        }
        let (_, recording) = common::run_every(&model(&text), "conserving-ggl", 0.005, 0.05, 1);
        for name in ["h0.fx", "screw.fz", "door.ax", "knob.alphaz"] {
            let column = recording.column(name).unwrap();
            assert!(column.iter().all(|value| value.is_finite()), "{length} m, {mass} kg, {place} away, {name}: {column:?}");
        }
    }
}

/// How far a universal joint of two shafts is short of a right angle, rad.
const SHORT: f64 = 1e-6;

/// Two shafts at a universal joint that short of a right angle, the one turning and the other at rest: where they change places both angles go round a
/// corner. The one that turns is at the angle `second`.
fn cardan(second: f64) -> String {
    let bend = PI / 2.0 - SHORT;
    let (along, across) = ([bend.cos(), bend.sin(), 0.0], [-bend.sin(), bend.cos(), 0.0]);
    let first = (SHORT.sin() * second.tan()).atan();
    let pins = [[0.0, first.cos(), first.sin()], [-second.sin() * across[0], -second.sin() * across[1], second.cos()]];
    format!(
        "gravity = [0, 0, 0]\n[body.one]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n\
         [body.two]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\nangular_velocity = {along:?}\n\
         [joint.first]\ntype = \"revolute\"\nbetween = [\"ground\", \"one\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n\
         [joint.second]\ntype = \"revolute\"\nbetween = [\"ground\", \"two\"]\nat = [0, 0, 0]\naxis = {along:?}\n\
         [joint.cross]\ntype = \"universal\"\nbetween = [\"one\", \"two\"]\nat = [0, 0, 0]\naxes = {pins:?}\n"
    )
}

/// Long steps do not pass the corner on the way straight on.
#[test]
fn steps_by_accuracy_do_not_pass_a_corner_unseen() {
    for k in 0..12 {
        let second = -0.05 - 0.12 * f64::from(k);
        let model = model(&cardan(second));
        for method in ["radau", "ggl/bdf", "ode/dopri5", "ode/dop853"] {
            let choice = Choice { accuracy: Some(1e-3), ..Choice::default().named(method) };
            let recording = common::run(&model, choice, 0.2, 4.0).1;
            // The first turns as long as the second does not, at the same speed.
            let expected = 4.0 - (PI / 2.0 - second);
            let found = common::last(&recording, "first.angle");
            assert!((found - expected).abs() < 1e-2, "{method} from {second}: {found} rad in place of {expected}");
        }
    }
}

/// In the corner round-off hides the errors of schemes of order 2 that do not hold the energy: with an accuracy beyond that they stop.
#[test]
fn an_accuracy_behind_round_off_is_refused() {
    let (second, end, h) = (1.4_f64, 2.0_f64, 1e-5);
    // Both angles have one speed together, along tan(first) = sin(1e-6) tan(second): by the rule of Runge and Kutta.
    let ratio = SHORT.sin();
    let slope = |[first, second]: [f64; 2]| {
        let (a, b) = (
            first.sin() * second.sin() + ratio * first.cos() * second.cos(),
            first.cos() * second.cos() + ratio * first.sin() * second.sin(),
        );
        [a / a.hypot(b), b / a.hypot(b)]
    };
    let start = [(ratio * second.tan()).atan(), second];
    let mut at = start;
    for _ in 0..(end / h).round() as u32 {
        let on = |share: f64, k: [f64; 2]| [at[0] + share * h * k[0], at[1] + share * h * k[1]];
        let k1 = slope(at);
        let k2 = slope(on(0.5, k1));
        let k3 = slope(on(0.5, k2));
        let k4 = slope(on(1.0, k3));
        at = std::array::from_fn(|i| at[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]));
    }
    let model = model(&cardan(second));
    for method in ["generalized-alpha", "trapezoidal-projected"] {
        let of = |accuracy: f64| Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
        let found = common::last(&common::run(&model, of(1e-7), 0.1, end).1, "first.angle");
        assert!((found - (at[0] - start[0])).abs() < 1e-6, "{method}: {found} rad in place of {}", at[0] - start[0]);
        let resolved = Method::resolve(&of(5e-10)).unwrap();
        let mut simulation = Simulation::new(model.system.clone(), resolved, 0.1).unwrap();
        let status = simulation.run(end, &mut |_: &Simulation| holonom::simulation::Verdict::GoOn);
        let holonom::simulation::Status::Stopped { at, reason } = status else { panic!("{method}: {status:?}") };
        assert!((0.1..0.3).contains(&at) && reason.contains("round-off hides"), "{method}: {at} s, {reason}");
    }
}

/// A crank that is driven past its slider, on a rod that is hardly longer, has the motion of its drive: what round-off makes of the energy there is no
/// error of it, and no run is stopped for it.
#[test]
fn a_driven_crank_passes_whatever_round_off_makes_of_the_energy() {
    let (rod, slider) = (1.00001_f64, 0.004472147135341066);
    let lean = -f64::asin(1.0 / rod);
    let text = format!(
        "plane = \"xy\"\n[body.crank]\nmass = 1\nshape = {{ rod = 1 }}\nposition = [0, 0.5]\norientation = {{ angle = \"pi/2\" }}\n\
         [body.rod]\nmass = 1\nshape = {{ rod = {rod} }}\nposition = [{}, 0.5]\norientation = {{ angle = {lean} }}\n\
         [body.slider]\nmass = 1\nposition = [{slider}, 0]\nshape = {{ box = [0.1, 0.1, 0.1] }}\n\
         [joint.main]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
         [joint.pin]\ntype = \"revolute\"\nbetween = [\"crank\", \"rod\"]\nat = [0, 1]\n\
         [joint.wrist]\ntype = \"revolute\"\nbetween = [\"rod\", \"slider\"]\nat = [{slider}, 0]\n\
         [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
         [drive.motor]\ntype = \"angle\"\njoint = \"main\"\nprofile = \"2*t\"\n",
        0.5 * slider
    );
    for accuracy in [1e-7, 1e-8] {
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named("generalized-alpha") };
        let recording = common::run(&model(&text), choice, 0.01, 0.2).1;
        let found = common::last(&recording, "slider.x");
        // The crank turns back from where it stands up, so that the slider goes ahead.
        let expected = -0.4_f64.sin() + (rod * rod - 0.4_f64.cos().powi(2)).sqrt();
        assert!((found - expected).abs() < 1e-6, "{accuracy:e}: {found} and {expected} m");
    }
}

/// A jack of which more is asked than the lever gives way is named where the run stops, whatever fails there; and no redundant rows
/// are blamed.
#[test]
fn a_drive_beyond_its_reach_is_named() {
    let text = "plane = \"xz\"\n[body.lever]\nmass = 10\nshape = { rod = 1 }\nposition = [0.5, 0]\npoints = { lug = [0.3, 0] }\n\
                [joint.pivot]\ntype = \"revolute\"\nbetween = [\"ground\", \"lever\"]\nat = [0, 0]\n\
                [drive.jack]\ntype = \"distance\"\nbetween = [[0, -0.4], \"lever.lug\"]\nstroke = \"0.1*t\"\n";
    // It is √0.8 m long, and 1.2 m where the lever stands up: 3.0557 s later.
    let model = model(text);
    for method in ["conserving-ggl", "conserving", "radau", "gauss", "ggl/bdf"] {
        let mut simulation = common::simulation(&model, method, 0.01);
        let status = simulation.run(4.0, &mut |_: &Simulation| holonom::simulation::Verdict::GoOn);
        let holonom::simulation::Status::Stopped { at, reason } = status else { panic!("{method}: {status:?}") };
        assert!((3.0..3.1).contains(&at), "{method}: {at} s, {reason}");
        assert!(reason.starts_with("`jack` ") && !reason.contains("a door"), "{method}: {reason}");
    }
}

/// A slider-crank of points whose rod is hardly longer than its crank: with the angle θ of the crank the slider is at s = cos θ + √(L² − sin² θ), and without
/// gravity θ' √(m + m s'²) stays as it is. Long steps do not pass from one of its ways to the other where the crank stands up.
#[test]
fn long_steps_stay_on_their_way_where_a_crank_stands_up() {
    for gap in [1e-4, 1e-5, 1e-6] {
        let rod = 1.0_f64 + gap;
        let slope = |angle: f64| -angle.sin() - angle.sin() * angle.cos() / (rod * rod - angle.sin().powi(2)).sqrt();
        for k in 0..8 {
            let start = -1.3 + 0.3 * f64::from(k);
            let energy = 1.0 + slope(start).powi(2);
            // Short steps by the rule of Runge and Kutta, shorter where the slope turns.
            let rate = |angle: f64| (energy / (1.0 + slope(angle).powi(2))).sqrt();
            let (mut angle, mut t) = (start, 0.0_f64);
            while t < 4.0 {
                let h = (4.0 - t).min(2e-3 * (angle.cos().abs() + (2.0 * gap).sqrt()));
                let a = rate(angle);
                let b = rate(angle + 0.5 * h * a);
                let c = rate(angle + 0.5 * h * b);
                let d = rate(angle + h * c);
                (angle, t) = (angle + h / 6.0 * (a + 2.0 * b + 2.0 * c + d), t + h);
            }
            let place = |angle: f64| angle.cos() + (rod * rod - angle.sin().powi(2)).sqrt();
            let text = format!(
                "plane = \"xy\"\ngravity = [0, 0]\n\
                 [point.P]\nmass = 1\nposition = [{}, {}]\nvelocity = [{}, {}]\n[point.S]\nmass = 1\nposition = [{}, 0]\nvelocity = [{}, 0]\n\
                 [constraint.crank]\ntype = \"distance\"\nbetween = [[0, 0], \"P\"]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"P\", \"S\"]\n\
                 [constraint.rail]\ntype = \"point-on-line\"\npoint = \"S\"\ndirection = [1, 0]\n",
                start.cos(),
                start.sin(),
                -start.sin(),
                start.cos(),
                place(start),
                slope(start)
            );
            let model = model(&text);
            for method in ["radau", "ggl/bdf", "ode/dopri5", "ode/dop853"] {
                let choice = Choice { accuracy: Some(1e-3), ..Choice::default().named(method) };
                let recording = common::run(&model, choice, 4.0, 4.0).1;
                let found = common::last(&recording, "S.x");
                assert!((found - place(angle)).abs() < 3e-2, "{method}, {gap} from {start}: {found} m in place of {}", place(angle));
            }
        }
    }
}

/// A crank that is driven to just before its dead centre, on a rod as long as itself: the slider is at 2 cos θ. The second half of a step of RATTLE meets
/// the rates of rows that hardly differ from others.
#[test]
fn rattle_has_the_velocities_of_rows_beside_a_dead_centre() {
    for (gap, bound) in [(1e-3, 1e-11), (1e-4, 1e-8), (1e-5, 1e-7), (3e-6, 1e-6)] {
        let rate = 0.5 * PI - 1.0 - gap;
        let text = format!(
            "plane = \"xz\"\ngravity = [0, -9.81]\n[body.crank]\nmass = 0.7\ninertia = 0.1\nposition = [\"0.5*cos(1)\", \"0.5*sin(1)\"]\n\
             [body.rod]\nmass = 0.9\ninertia = 0.2\nposition = [\"1.5*cos(1)\", \"0.5*sin(1)\"]\n\
             [body.slider]\nmass = 1.3\ninertia = 0.1\nposition = [\"2*cos(1)\", 0]\n\
             [joint.main]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
             [joint.pin]\ntype = \"revolute\"\nbetween = [\"crank\", \"rod\"]\nat = [\"cos(1)\", \"sin(1)\"]\n\
             [joint.wrist]\ntype = \"revolute\"\nbetween = [\"rod\", \"slider\"]\nat = [\"2*cos(1)\", 0]\n\
             [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0]\n\
             [drive.motor]\ntype = \"angle\"\njoint = \"main\"\nprofile = \"{rate}*t\"\n"
        );
        let recording = common::run(&model(&text), Choice::default().named("lagrange-3/rattle"), 0.1, 1.0).1;
        let (found, expected) = (common::last(&recording, "slider.vx"), -2.0 * (1.0 + rate).sin() * rate);
        assert!((found - expected).abs() < bound, "{gap} rad before: {found} and {expected} m/s");
    }
}
