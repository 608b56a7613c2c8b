//! Coordinates that follow others by a formula or a table, against the equation of motion in one coordinate and closed forms.

mod common;

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, SQRT_2, TAU};

use common::{last, model, model_with_forces, run_every};

/// A leading part of inertia 0.5 that begins with `speed`, and a part of inertia 0.3 that follows by `lift`, each on a hinge or on a rail, far apart
/// and with numbers in other units: lengths times `length`, masses times `mass`, the place moved by `far` (m).
fn pair(kinds: [&str; 2], lift: &str, speed: f64, [length, mass, far]: [f64; 3]) -> String {
    let part = |k: usize, inertia: f64, speed: f64| {
        let at = far + 3.0 * k as f64 * length;
        let (name, is_hinge) = (["leading", "following"][k], kinds[k] == "revolute");
        let (m, j) = (mass * inertia, mass * inertia * if is_hinge { 1.0 } else { length * length });
        let velocity = if is_hinge { format!("angular_velocity = [0, 0, {speed}]") } else { format!("velocity = [{speed}, 0, 0]") };
        let joint = if is_hinge { format!("at = [{at}, 0, 0]\naxis = [0, 0, 1]") } else { "axis = [1, 0, 0]".into() };
        format!(
            "[body.{name}]\nmass = {m}\ninertia = [{j}, {j}, {j}]\nposition = [{at}, 0, 0]\n{velocity}\n\
             [joint.{}]\ntype = \"{}\"\nbetween = [\"ground\", \"{name}\"]\n{joint}\n",
            ["first", "second"][k],
            kinds[k]
        )
    };
    let [first, second] = [part(0, 0.5, speed), part(1, 0.3, 0.0)];
    format!("gravity = [0, 0, 0]\n{first}{second}[joint.cam]\ntype = \"cam\"\njoints = [\"first\", \"second\"]\nlift = \"{lift}\"\n")
}

/// (I + m f'²) q̈ + m f' f'' q̇² = 0 by Runge's and Kutta's classical method: q and q̇ at the end, and what drives the follower there, m (f'' q̇² + f' q̈).
fn truth(f: impl Fn(f64) -> [f64; 2], speed: f64, end: f64) -> [f64; 3] {
    let bend = |[q, v]: [f64; 2]| {
        let [slope, bend] = f(q);
        -0.3 * slope * bend * v * v / (0.5 + 0.3 * slope * slope)
    };
    let steps = 40_000;
    let h = end / f64::from(steps);
    let mut y = [0.0, speed];
    for _ in 0..steps {
        let slope = |y: [f64; 2]| [y[1], bend(y)];
        let along = |k: [f64; 2], s: f64| [y[0] + s * k[0], y[1] + s * k[1]];
        let a = slope(y);
        let b = slope(along(a, h / 2.0));
        let c = slope(along(b, h / 2.0));
        let d = slope(along(c, h));
        y = std::array::from_fn(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]));
    }
    let [slope, curved] = f(y[0]);
    [y[0], y[1], 0.3 * (curved * y[1] * y[1] + slope * bend(y))]
}

/// Hinges and rails lead hinges and rails, many turns, near and far, in any unit: the motion is that in one coordinate, and the efforts are those
/// that the follower needs and the leading part feels by the slope.
#[test]
fn what_follows_moves_as_in_one_coordinate() {
    let wave = |q: f64| [0.4 * (1.0 - (2.0 * q).cos()), 0.8 * (2.0 * q).sin(), 1.6 * (2.0 * q).cos()];
    let speed = 5.0;
    let [q, _, effort] = truth(|q| [wave(q)[1], wave(q)[2]], speed, 4.0);
    assert!(q > TAU, "the leading part turns more than once");
    for kinds in [["revolute", "revolute"], ["revolute", "prismatic"], ["prismatic", "revolute"], ["prismatic", "prismatic"]] {
        for [length, mass, far] in [[1.0, 1.0, 0.0], [1e3, 1e-3, 0.0], [1.0, 1e6, 0.0], [1.0, 1.0, 1e4]] {
            if length != 1.0 && kinds != ["prismatic", "prismatic"] {
                continue;
            }
            let lift = format!("{length:e}*0.4*(1 - cos(2*q/{length:e})) + 7");
            let text = pair(kinds, &lift, speed * length, [length, mass, far]);
            let own = if kinds[0] == "revolute" { ["first.angle", "angle"] } else { ["first.displacement", "displacement"] };
            let other = if kinds[1] == "revolute" { "angle" } else { "displacement" };
            for (method, share) in [("radau", 1e-9), ("ode/dop853", 1e-10), ("conserving-ggl", 2e-4), ("generalized-alpha", 2e-3)] {
                let (simulation, recording) = run_every(&model_with_forces(&text), method, 0.002, 4.0, 2000);
                let found = last(&recording, own[0]) / length;
                // Far away places are rounded to so much more.
                let within = share + if far > 0.0 { 1e-8 } else { 0.0 };
                assert!((found - q).abs() < within * q, "{kinds:?}, {length}, {mass}, {far}, {method}: {found}, and {q} in one coordinate");
                let along = last(&recording, &format!("cam.second.{other}.effort")) / (mass * length);
                let back = last(&recording, &format!("cam.first.{}.effort", own[1])) / (mass * length);
                assert!((along - effort).abs() < 100.0 * within * effort.abs(), "{kinds:?}, {method}: {along}, and {effort} by hand");
                let expected = -wave(found)[1] * along;
                assert!(
                    (back - expected).abs() < 100.0 * within.min(1e-8) * expected.abs(),
                    "{kinds:?}, {method}: {back}, and {expected} by the slope"
                );
                let energy = simulation.audit().energy_summary();
                let keeps = method != "conserving-ggl" || energy.max_drift < 1e-12 * energy.initial;
                assert!(keeps, "{kinds:?}, {length}, {mass}, {far}: {} of {} J", energy.max_drift, energy.initial);
            }
        }
    }
}

/// A Geneva wheel with four slots and a crank that turns evenly: a quarter turn each time, at rest between, and the moment that its inertia needs,
/// by the closed form of the angle and its second derivative.
#[test]
fn a_geneva_wheel_turns_by_quarters() {
    let text = "gravity = [0, 0, 0]\n[body.crank]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [0, 0, 0]\n\
                [body.wheel]\nmass = 1\ninertia = [0.2, 0.2, 0.2]\nposition = [1, 0, 0]\n\
                [joint.shaft]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"wheel\"]\nat = [1, 0, 0]\naxis = [0, 0, 1]\n\
                [drive.motor]\ntype = \"angle\"\njoint = \"shaft\"\nprofile = \"2*pi*t\"\n\
                [parameters]\nslot = \"pi/4\"\n[joint.pin]\ntype = \"cam\"\njoints = [\"shaft\", \"axle\"]\n\
                lift = \"pi/2*floor(q/(2*pi)) + atan2(sin(min(max(mod(q, 2*pi) - pi, -slot), slot)), \
                sqrt(2) - cos(min(max(mod(q, 2*pi) - pi, -slot), slot)))\"\n";
    for method in ["conserving-ggl", "radau"] {
        let (_, recording) = run_every(&model_with_forces(text), method, 1e-3, 3.0, 1);
        let [times, angles, moments, needed] =
            ["t", "axle.angle", "pin.axle.angle.effort", "motor.effort"].map(|name| recording.column(name).unwrap());
        for (((&t, &angle), &moment), &needed) in times.iter().zip(angles).zip(moments).zip(needed) {
            let at = (t - t.floor()) * TAU - TAU / 2.0;
            let inside = at.clamp(-FRAC_PI_4, FRAC_PI_4);
            let turned = FRAC_PI_2 * t.floor() + inside.sin().atan2(SQRT_2 - inside.cos()) + FRAC_PI_4;
            assert!((angle - turned).abs() < 1e-9, "{method} at {t} s: {angle}, and {turned} by the closed form");
            // Where a slot begins or ends its moment jumps.
            if (at.abs() - FRAC_PI_4).abs() < 0.01 {
                continue;
            }
            let (bottom, is_inside) = (3.0 - 2.0 * SQRT_2 * at.cos(), at.abs() < FRAC_PI_4);
            let slope = if is_inside { (SQRT_2 * at.cos() - 1.0) / bottom } else { 0.0 };
            let bend = if is_inside { -SQRT_2 * at.sin() / (bottom * bottom) } else { 0.0 };
            let expected = 0.2 * bend * TAU * TAU;
            assert!((moment - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{method} at {t} s: {moment} N·m, and {expected} N·m");
            let expected = slope * expected;
            assert!((needed - expected).abs() < 1e-8 * (1.0 + expected.abs()), "{method} at {t} s: {needed} N·m, and {expected} N·m");
        }
        assert!((last(&recording, "axle.angle") - 3.0 * FRAC_PI_2).abs() < 1e-9);
    }
}

/// A start that turns the shaft moves what follows it, and a table by splines serves as a formula does.
#[test]
fn a_start_elsewhere_moves_the_follower() {
    // The last point is the first again, but for rounding.
    let points: Vec<String> = (0..=36).map(|k| format!("[\"{k}*pi/18\", \"0.8*sin({k}*pi/36)^2\"]")).collect();
    let table = format!("[table.lobe]\npoints = [{}]\ninterpolation = \"cubic\"\noutside = \"periodic\"\n", points.join(", "));
    let start = "[start]\nfirst.angle = 1.2\n";
    for (lift, table, within) in [("0.4*(1 - cos(q))", "", 1e-12), ("lobe(q)", table.as_str(), 1e-5)] {
        let text = format!("{}{start}{table}", pair(["revolute", "prismatic"], lift, 0.0, [1.0, 1.0, 0.0]));
        let model = model(&text);
        let (_, recording) = run_every(&model, "conserving-ggl", 1e-3, 1e-3, 1);
        let found = last(&recording, "second.displacement");
        assert!((found - 0.4 * (1.0 - 1.2_f64.cos())).abs() < within, "{lift}: {found} m");
    }
}

/// A bead at the bottom of a wire that hardly moves swings as the linear oscillator that it is there, and takes no more iterations than one that moves
/// fast: how a curve changes within a step is not what rounding leaves of it.
#[test]
fn a_bead_that_hardly_moves_swings() {
    for (turned, speed) in [(0.0, 1e-3), (0.0, 1e-6), (0.0, 1e-9), (0.3, 1e-9)] {
        let place = |x: f64, z: f64| {
            let (sine, cosine) = f64::sin_cos(turned);
            format!("[{}, {}]", cosine * x - sine * z, sine * x + cosine * z)
        };
        let text = format!(
            "plane = \"xz\"\ngravity = {}\n[point.bead]\nmass = 1\nposition = [0, 0]\nvelocity = {}\n\
             [joint.wire]\ntype = \"point-on-curve\"\nbetween = [\"ground\", \"bead\"]\nat = [0, 0]\ncurve = [{}, [0, 0], {}]\n",
            place(0.0, -9.81),
            place(speed, 0.0),
            place(-1.0, 1.0),
            place(1.0, 1.0)
        );
        let model = model(&text);
        for method in ["conserving-ggl", "conserving"] {
            let (simulation, recording) = common::run_every(&model, method, 0.01, 1.0, 1);
            // A natural spline over chords √2 has z = (3 s²/2 − s³/(2√2))/√2/√2 there, and x = s/√2: z = (3/2) x².
            let frequency = (3.0 * 9.81_f64).sqrt();
            let [t, s] = ["t", "wire.displacement"].map(|name| recording.column(name).unwrap());
            for (t, s) in t.iter().zip(s) {
                let expected = speed / frequency * (frequency * t).sin() * std::f64::consts::SQRT_2;
                assert!((s - expected).abs() < 0.02 * speed, "{method}, {speed} m/s: {s} and not {expected} m at {t} s");
            }
            let work = simulation.audit().work_summary(100);
            assert!(work.iterations_per_step < 3.0 && work.rejected_steps == 0, "{method}, {speed} m/s: {work:?}");
        }
    }
}
