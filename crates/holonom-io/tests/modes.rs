//! Small vibrations about a state at rest, beside closed forms.

mod common;

use std::f64::consts::{PI, SQRT_2, TAU};

use common::model;
use holonom::analysis::{Modes, NoModes, modes};

const G: f64 = 9.81;

#[track_caller]
fn found(text: &str) -> Modes {
    modes(&model(text).system).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Real and imaginary parts of the exponents, 1/s.
#[track_caller]
fn exponents(text: &str) -> Vec<[f64; 2]> {
    found(text).modes.iter().map(|mode| [mode.growth, TAU * mode.frequency]).collect()
}

#[track_caller]
fn assert_exponents(text: &str, expected: &[[f64; 2]]) {
    let found = exponents(text);
    assert_eq!(found.len(), expected.len(), "{found:?}\n{text}");
    for ([re, im], [re0, im0]) in found.iter().zip(expected) {
        let off = (re - re0).hypot(im - im0) / re0.hypot(*im0);
        assert!(off < 1e-9, "{re} {im} for {re0} {im0}: {off:.1e}\n{text}");
    }
}

/// A rod of 1 kg and 1 m in the plane whose first end is at the place, turned by an angle.
fn rod(k: usize, holder: &str, [x, z]: [f64; 2], angle: f64) -> String {
    format!(
        "[body.r{k}]\nmass = 1\nshape = {{ rod = 1 }}\nposition = [{}, {}]\norientation = {{ angle = {angle} }}\n\
         [joint.h{k}]\ntype = \"revolute\"\nbetween = [\"{holder}\", \"r{k}\"]\nat = [{x}, {z}]\n",
        x + 0.5 * angle.cos(),
        z + 0.5 * angle.sin()
    )
}

/// A mass of 2 kg on a rail, on a spring of 50 N/m.
fn rail(damping: f64) -> String {
    format!(
        "gravity = [0, 0, 0]\n[body.m]\nmass = 2\nshape = {{ box = [0.1, 0.1, 0.1] }}\nposition = [0.3, 0, 0]\n\
         [joint.r]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n\
         [force.k]\ntype = \"torsion\"\njoint = \"r\"\nstiffness = 50\ndamping = {damping}\n"
    )
}

/// Two rods that hang: θ''s of M = [[4/3, 1/2], [1/2, 1/3]] and K = diag(3/2, 1/2) g.
#[test]
fn a_double_pendulum_has_two() {
    let text = format!("plane = \"xz\"\n{}{}", rod(0, "ground", [0.0, 0.0], -0.5 * PI), rod(1, "r0", [0.0, -1.0], -0.5 * PI));
    // det(K − ω² M) = 0 of the square p = ω²/g.
    let (a, b, c) = (4.0 / 9.0 - 0.25, -(0.5 + 2.0 / 3.0), 0.75_f64);
    let root = (b * b - 4.0 * a * c).sqrt();
    let omega = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)].map(|p: f64| (G * p).sqrt());
    assert_exponents(&text, &[[0.0, omega[0]], [0.0, omega[1]]]);
    // Upright it falls as fast as it would vibrate.
    let upright = format!("plane = \"xz\"\n{}", rod(0, "ground", [0.0, 0.0], 0.5 * PI));
    let speed = (1.5 * G).sqrt();
    assert_exponents(&upright, &[[speed, 0.0], [-speed, 0.0]]);
}

/// Dampers below and above the critical one, and with a formula of a rate.
#[test]
fn dampers_damp() {
    assert_exponents(&rail(4.0), &[[-1.0, 24.0_f64.sqrt()]]);
    let root = (225.0_f64 - 25.0).sqrt();
    assert_exponents(&rail(60.0), &[[root - 15.0, 0.0], [-15.0 - root, 0.0]]);
    // Both are of one freedom, also where the larger one is zero.
    let numbers = |text: &str| {
        let found = found(text);
        (0..found.modes.len()).map(|mode| found.number(mode)).collect::<Vec<usize>>()
    };
    assert_eq!(numbers(&rail(60.0)), [1, 1]);
    assert_eq!(numbers(&rail(60.0).replace("stiffness = 50\n", "")), [1]);
    let formula = rail(0.0).replace("damping = 0\n", "") + "[force.c]\ntype = \"effort\"\njoint = \"r\"\neffort = \"-4*q_rate - 3*q\"\n";
    assert_exponents(&formula, &[[-1.0, (26.5_f64 - 1.0).sqrt()]]);
    // Without a spring one exponent is zero.
    let free = rail(4.0).replace("stiffness = 50\n", "");
    assert_exponents(&free, &[[-2.0, 0.0]]);
    assert_eq!(found(&free).free, 1);
}

/// What falls off faster than others vibrate is numbered behind them, and numbers stay where a damper makes two exponents of a vibration, up and down.
#[test]
fn modes_keep_their_numbers_where_dampers_are_strong() {
    let other = |text: &str| {
        let renamed = text.split_once("[body.m]").unwrap().1.replace("0.3, 0, 0", "0.3, 1, 0");
        format!(
            "[body.n]{}",
            renamed.replace("joint.r]", "joint.s]").replace("\"m\"", "\"n\"").replace("force.k]", "force.l]").replace("\"r\"", "\"s\"")
        )
    };
    // ω = 5 and 50 rad/s, critical at 20 and at 200 N·s/m.
    for (slow, fast) in [(4.0, 100.0), (4.0, 300.0), (60.0, 300.0), (60.0, 100.0)] {
        let text = format!("{}{}", rail(slow), other(&rail(fast).replace("stiffness = 50", "stiffness = 5000")));
        let found = found(&text);
        let [first, second] = [(slow, 20.0), (fast, 200.0)].map(|(c, critical)| if c > critical { 2 } else { 1 });
        let numbers: Vec<usize> = (0..found.modes.len()).map(|mode| found.number(mode)).collect();
        assert_eq!(numbers, [vec![1; first], vec![2; second]].concat(), "{found:?}");
        let growth = |c: f64, omega: f64| ((c / 4.0).powi(2) - omega * omega).max(0.0).sqrt() - c / 4.0;
        for (number, exact) in [(1, growth(slow, 5.0)), (2, growth(fast, 50.0))] {
            assert!((found.growth(number).unwrap() / exact - 1.0).abs() < 1e-9, "{found:?}");
            assert_eq!(found.vibration(number).is_none(), [first, second][number - 1] == 2);
        }
    }
}

/// Two that fall off without vibrating have the numbers that they have as vibrations, before and behind one that vibrates.
#[test]
fn what_two_dampers_make_of_vibrations_stays_together() {
    let rail = |k: usize, omega: f64, damping: f64| {
        format!(
            "[body.m{k}]\nmass = 1\nshape = {{ box = [0.1, 0.1, 0.1] }}\nposition = [0, {k}, 0]\n\
             [joint.r{k}]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m{k}\"]\nat = [0, {k}, 0]\naxis = [1, 0, 0]\n\
             [force.k{k}]\ntype = \"torsion\"\njoint = \"r{k}\"\nstiffness = {}\ndamping = {damping}\n",
            omega * omega
        )
    };
    // The exponents of the first and of the last.
    for [first, last] in [[[-1.0, -100.0], [-10.0, -1000.0]], [[-5.0, -20.0], [-50.0, -200.0]], [[-2.0, -50.0], [-9.0, -1111.0]]] {
        let of = |[a, b]: [f64; 2]| ((a * b).sqrt(), -a - b);
        let ((low, weak), (high, strong)) = (of(first), of(last));
        let text = format!("gravity = [0, 0, 0]\n{}{}{}", rail(0, high, strong), rail(1, 15.0, 1.0), rail(2, low, weak));
        let found = found(&text);
        let growths: Vec<(usize, f64)> = found.modes.iter().enumerate().map(|(k, mode)| (found.number(k), mode.growth)).collect();
        let expected = [(1, first[0]), (1, first[1]), (2, -0.5), (3, last[0]), (3, last[1])];
        assert!(growths.iter().zip(expected).all(|(a, b)| a.0 == b.0 && (a.1 / b.1 - 1.0).abs() < 1e-9), "{growths:?} for {expected:?}");
    }
}

/// Six alike that hardly feel each other fall off at two rates, and none of them vibrates by rounding.
#[test]
fn what_is_repeated_does_not_vibrate() {
    let mass = |k: usize| {
        format!(
            "[body.m{k}]\nmass = 1\ninertia = 1\nposition = [0, {k}]\n[joint.r{k}]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m{k}\"]\naxis = [1, 0]\n\
             [force.k{k}]\ntype = \"torsion\"\njoint = \"r{k}\"\nstiffness = 100\ndamping = 101\n"
        )
    };
    let weak = |k: usize| format!("[force.c{k}]\ntype = \"spring\"\nbetween = [\"m{k}\", \"m{}\"]\nstiffness = 1e-9\n", k + 1);
    let text = format!("plane = \"xy\"\n{}{}", (0..6).map(mass).collect::<String>(), (0..5).map(weak).collect::<String>());
    let found = found(&text);
    let all: Vec<(usize, f64)> = found.modes.iter().enumerate().map(|(k, mode)| (found.number(k), mode.growth)).collect();
    assert!(all.len() == 12 && found.modes.iter().all(|mode| !mode.vibrates()), "{all:?}");
    for pair in all.chunks(2) {
        assert!(pair[0].0 == pair[1].0 && (pair[0].1 + 1.0).abs() < 1e-9 && (pair[1].1 + 100.0).abs() < 1e-7, "{all:?}");
    }
}

/// Fifty masses on springs between a wall and a free end: ω = 2 √(k/m) sin((2j − 1)π/(4N + 2)); the same in other units, and beside a spring that is
/// 1e10 times as stiff.
#[test]
fn a_chain_of_springs_has_its_spectrum() {
    let n = 50;
    for (length, mass) in [(1.0, 1.0), (1e3, 1e-3), (1e-6, 1e6)] {
        let mut text = "plane = \"xz\"\ngravity = [0, 0]\n".to_string();
        for k in 1..=n {
            text += &format!(
                "[body.m{k}]\nmass = {mass}\nshape = {{ box = [{0}, {0}, {0}] }}\nposition = [{1}, 0]\n\
                 [joint.r{k}]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m{k}\"]\nat = [{1}, 0]\naxis = [1, 0]\n\
                 [force.k{k}]\ntype = \"spring\"\nbetween = [\"{2}\", \"m{k}\"]\nstiffness = {3}\n",
                0.1 * length,
                k as f64 * length,
                if k == 1 { "ground".into() } else { format!("m{}", k - 1) },
                100.0 * mass
            );
        }
        let expected: Vec<[f64; 2]> = (1..=n).map(|j| [0.0, 20.0 * ((2 * j - 1) as f64 * PI / (4 * n + 2) as f64).sin()]).collect();
        assert_exponents(&text, &expected);
    }
    let two = rail(0.0).replace("damping = 0\n", "")
        + "[body.n]\nmass = 1\nshape = { box = [0.1, 0.1, 0.1] }\nposition = [1, 0, 0]\n\
           [joint.s]\ntype = \"prismatic\"\nbetween = [\"ground\", \"n\"]\nat = [1, 0, 0]\naxis = [1, 0, 0]\n\
           [force.l]\ntype = \"torsion\"\njoint = \"s\"\nstiffness = 25e10\n";
    assert_exponents(&two, &[[0.0, 5.0], [0.0, 5e5]]);
}

/// As many freedoms as one likes: points on lines, with springs from one to the next.
#[test]
fn chains_of_every_length_have_their_spectra() {
    for n in 1..=24 {
        let mut text = "gravity = [0, 0, 0]\n".to_string();
        for k in 1..=n {
            let before = if k == 1 { "ground".to_string() } else { format!("p{}", k - 1) };
            text += &format!(
                "[point.p{k}]\nmass = 1\nposition = [{k}, 0, 0]\n\
                 [joint.r{k}]\ntype = \"point-on-line\"\nbetween = [\"ground\", \"p{k}\"]\nat = [{k}, 0, 0]\naxis = [1, 0, 0]\n\
                 [force.k{k}]\ntype = \"spring\"\nbetween = [\"{before}\", \"p{k}\"]\nstiffness = 100\n"
            );
        }
        let expected: Vec<[f64; 2]> = (1..=n).map(|j| [0.0, 20.0 * ((2 * j - 1) as f64 * PI / (4 * n + 2) as f64).sin()]).collect();
        assert_exponents(&text, &expected);
    }
}

/// A pendulum in space has the same frequency twice; a deck on three cranks, of which two would do, one; a wheel that rolls against a spring
/// has its moment beside its mass.
#[test]
fn rows_hold_what_they_hold() {
    let bob = "[point.bob]\nmass = 3\nposition = [0, 0, -2]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\n";
    let omega = (G / 2.0).sqrt();
    assert_exponents(bob, &[[0.0, omega], [0.0, omega]]);
    let crank = |k: usize| {
        rod(k, "ground", [k as f64, 0.0], -0.5 * PI)
            + &format!("[joint.b{k}]\ntype = \"revolute\"\nbetween = [\"r{k}\", \"deck\"]\nat = [{k}, -1]\n")
    };
    let deck = "[body.deck]\nmass = 3\nshape = { rod = 2 }\nposition = [1, -1]\n";
    let text = format!("plane = \"xz\"\n{deck}{}{}{}", crank(0), crank(1), crank(2));
    // (3 + 3/3) θ'' = −(3 + 3/2) g θ
    assert_exponents(&text, &[[0.0, (4.5 * G / 4.0).sqrt()]]);
    let wheel = "[body.wheel]\nmass = 2\nshape = { cylinder = [0.5, 0.1] }\nposition = [0, 0, 0.5]\norientation = { axis = [1, 0, 0], angle = \"90*deg\" }\n\
                 [joint.roll]\ntype = \"rolling\"\nbetween = [\"ground\", \"wheel\"]\nat = [0, 0, 0.5]\nnormal = [0, 0, 1]\nradius = 0.5\naxis = [0, 1, 0]\n\
                 [joint.upright]\ntype = \"parallel\"\nbetween = [\"ground\", \"wheel\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n\
                 [force.k]\ntype = \"force\"\nbody = \"wheel\"\nforce = [\"-75*x\", \"0\", \"0\"]\n";
    assert_exponents(wheel, &[[0.0, 5.0]]);
}

/// Ziegler's pendulum: forces that follow the last rod make it flutter above P = (7/2 − √2) c/l.
#[test]
fn forces_that_follow_make_it_flutter() {
    let text = |force: f64| {
        format!(
            "plane = \"xz\"\ngravity = [0, 0]\n[body.a]\nmass = 1e-9\nshape = {{ rod = 1 }}\nposition = [0.5, 0]\n\
             [body.b]\nmass = 1e-9\nshape = {{ rod = 1 }}\nposition = [1.5, 0]\n\
             [body.ma]\nmass = 2\ninertia = 1e-9\nposition = [1, 0]\n[body.mb]\nmass = 1\ninertia = 1e-9\nposition = [2, 0]\n\
             [joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
             [joint.k]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n\
             [joint.fa]\ntype = \"fixed\"\nbetween = [\"a\", \"ma\"]\nat = [1, 0]\n[joint.fb]\ntype = \"fixed\"\nbetween = [\"b\", \"mb\"]\nat = [2, 0]\n\
             [force.c]\ntype = \"torsion\"\njoint = \"h\"\nstiffness = 1\n[force.d]\ntype = \"torsion\"\njoint = \"k\"\nstiffness = 1\n\
             [force.p]\ntype = \"force\"\nbody = \"b\"\nat = [2, 0]\naxes = \"body\"\nforce = [\"-{force}\", \"0\"]\n"
        )
    };
    let critical = 3.5 - SQRT_2;
    assert!(exponents(&text(0.999 * critical)).iter().all(|[re, _]| *re == 0.0));
    let beyond = exponents(&text(1.001 * critical));
    assert!(beyond.iter().any(|[re, im]| *re > 1e-3 && *im > 0.1), "{beyond:?}");
}

/// A pendulum on a spring: what its weight stretches that by is a hundredth of a nanometre to a centimetre, and swings it all the same. Six points of a taut wire.
#[test]
fn what_is_stretched_by_little_drives_back() {
    for (stiffness, rounded) in [(1e3, 1e-12), (1e6, 1e-11), (1e9, 1e-8), (1e12, 1e-4)] {
        let length = 1.0 + G / stiffness;
        let text = format!(
            "[point.b]\nmass = 1\nposition = [0, 0, -{length}]\n\
             [force.s]\ntype = \"spring\"\nbetween = [\"ground\", \"b\"]\nstiffness = {stiffness}\nrest_length = 1\n"
        );
        let found = exponents(&text);
        assert_eq!(found.len(), 3, "{found:?}\n{text}");
        for ([_, omega], expected) in found.iter().zip([G / length, G / length, stiffness].map(f64::sqrt)) {
            assert!((omega - expected).abs() < rounded * expected, "{omega} for {expected}\n{text}");
        }
    }
    let (tension, stiffness, apart) = (10.0, 1e8, 0.2);
    let mut text = "plane = \"xy\"\n".to_string();
    for k in 0..=6 {
        text += &format!("[point.p{k}]\nmass = 0.01\nposition = [{}, 0]\nfixed = {}\n", apart * f64::from(k), k == 0);
    }
    for k in 0..=6 {
        let to = if k < 6 { format!("\"p{}\"", k + 1) } else { format!("[{}, 0]", 7.0 * apart) };
        let rest = apart - tension / stiffness;
        text += &format!("[force.s{k}]\ntype = \"spring\"\nbetween = [\"p{k}\", {to}]\nstiffness = {stiffness}\nrest_length = {rest}\n");
    }
    let found = exponents(&text);
    assert_eq!(found.len(), 12, "{found:?}");
    for (k, [_, omega]) in found[..6].iter().enumerate() {
        let expected = 2.0 * (tension / apart / 0.01).sqrt() * (PI * (k as f64 + 1.0) / 14.0).sin();
        assert!((omega - expected).abs() < 1e-8 * expected, "{omega} for {expected}");
    }
}

/// A stop that just touches: one side of it counts, beside whatever else drives back.
#[test]
fn kinks_have_one_side() {
    let text = format!("{}[force.s]\ntype = \"stop\"\njoint = \"r\"\nlower = 0\nstiffness = 150\n", rail(0.0));
    let found = exponents(&text);
    let off = |omega: f64| (found[0][1] - omega).abs();
    assert!(found.len() == 1 && off(5.0).min(off(10.0)) < 1e-9, "{found:?}");
}

/// Forces that have another slope on each side of the place at rest are named: a stop that just touches, a damper that is harder one way, and a rope that is
/// just taut. What goes through it smoothly is not, nor what no motion takes through its kink.
#[test]
fn forces_at_kinks_are_named() {
    let table = "[table.d]\npoints = [[-1, -300], [0, 0], [1, 100]]\n";
    let effort = |formula: &str| format!("[force.e]\ntype = \"effort\"\njoint = \"r\"\neffort = \"{formula}\"\n");
    let stop = |lower: f64| format!("[force.s]\ntype = \"stop\"\njoint = \"r\"\nlower = {lower}\nstiffness = 150\n");
    let across = "[force.f]\ntype = \"force\"\nbody = \"m\"\nforce = [0, \"max(0, -100*y)\", 0]\n";
    for (force, named) in [
        (stop(0.0), vec!["s"]),
        (stop(-0.1), vec![]),
        (effort("-d(q_rate)"), vec!["e"]),
        (effort("-2*step(q_rate - 1e-3)"), vec![]),
        (effort("-d(q_rate + 0.5)+d(0.5)"), vec![]),
        (effort("-300*abs(q)*q - 7*abs(q_rate)*q_rate - 5*tanh(q_rate/0.01)"), vec![]),
        ("[force.w]\ntype = \"rope\"\nbetween = [\"m\", [0, 0, 7]]\nstiffness = 40\n".into(), vec!["w"]),
        (across.into(), vec![]),
    ] {
        for damping in [0.0, 3.0] {
            let found = found(&format!("{}{table}{force}", rail(damping)));
            assert_eq!(found.kinked, named, "{force}");
        }
    }
}

/// Dry friction of a rod that hangs jumps at rest, to both sides alike.
#[test]
fn forces_that_jump_at_rest_are_named() {
    for (formula, named) in [("-1e-3*sign(q_rate)", vec!["e"]), ("-1e-3*tanh(q_rate/0.1)", vec![])] {
        let hanging = rod(0, "ground", [0.0, 0.0], -0.5 * PI);
        let text = format!("plane = \"xz\"\n{hanging}[force.e]\ntype = \"effort\"\njoint = \"h0\"\neffort = \"{formula}\"\n");
        assert_eq!(found(&text).kinked, named, "{formula}");
    }
}

/// Six masses of one frequency, each led by the one before: rounding splits their exponents, and none is told to be zero.
#[test]
fn what_is_not_found_is_not_free() {
    let mut text = "gravity = [0, 0, 0]\n".to_string();
    for k in 0..6 {
        let leader = if k == 0 { String::new() } else { format!("angle = \"r{}.displacement\"\n", k - 1) };
        text += &format!(
            "[body.m{k}]\nmass = 2\ninertia = [1, 1, 1]\nposition = [{k}, 0, 1]\n\
             [joint.r{k}]\ntype = \"prismatic\"\nbetween = [\"ground\", \"m{k}\"]\naxis = [0, 0, 1]\n\
             [force.t{k}]\ntype = \"torsion\"\njoint = \"r{k}\"\nstiffness = 50\n{leader}"
        );
    }
    let found = found(&text);
    assert_eq!((found.free, found.unsure > 0), (0, true), "{found:?}");
}

/// A table of 3 kg on three parallel rods of 1 kg and 1 m, one of which is redundant, swings as one of them does: ω² (1 + 3) = (1.5 + 3) g. Where all hang
/// in a line rods may go on to either side, linear equations say nothing, and there is no number; in any unit, and however light a rod is.
#[test]
fn a_position_where_ways_fork_has_no_modes() {
    let hanging = |[dx, dz]: [f64; 2], u: f64, light: f64| {
        let rods = (0..3).map(|k| {
            let [x, z] = [k as f64 * dx * u, k as f64 * dz * u];
            let mass = if k == 0 { light } else { 1.0 };
            format!(
                "[point.p{k}]\nposition = [{x:e}, {z:e}]\nfixed = true\n[body.r{k}]\nmass = {mass:e}\nshape = {{ rod = {u:e} }}\n\
                 position = [{x:e}, {:e}]\norientation = {{ angle_deg = -90 }}\n[joint.h{k}]\ntype = \"revolute\"\n\
                 between = [\"ground\", \"r{k}\"]\nat = [{x:e}, {z:e}]\n\
                 [joint.t{k}]\ntype = \"revolute\"\nbetween = [\"r{k}\", \"table\"]\nat = [{x:e}, {:e}]\n",
                z - 0.5 * u,
                z - u
            )
        });
        let table = format!("[body.table]\nmass = 3\ninertia = {:e}\nposition = [{:e}, {:e}]\n", u * u, dx * u, (dz - 1.0) * u);
        format!("plane = \"xz\"\ngravity = [0, {:e}]\n{table}{}", -G * u, rods.collect::<String>())
    };
    for u in [1e-3, 1.0, 1e3] {
        for light in [1e-6, 1.0] {
            let omega = ((1.0 + 0.5 * light + 3.0) * G / (2.0 / 3.0 + light / 3.0 + 3.0)).sqrt();
            assert_exponents(&hanging([1.0, 0.0], u, light), &[[0.0, omega]]);
            assert_exponents(&hanging([0.8, 0.3], u, light), &[[0.0, omega]]);
            assert_eq!(modes(&model(&hanging([0.0, -0.4], u, light)).system), Err(NoModes::Forks), "in units of {u} m, {light} kg");
        }
    }
}

/// A robot of 60 kg on two wheels, whose rows are redundant beside their weight: it goes along by x, leans by θ with (M s² + C s + K)(x, θ) = 0, and turns on
/// the spot, braked by its hubs. A controller that holds it up lets it go on faster and faster, by e in nine seconds.
#[test]
fn rolling_wheels_that_share_a_load() {
    let (r, h, brake) = (0.2_f64, 0.7, 0.3);
    for [kp, kd] in [[0.0, 0.0], [150.0, 25.0]] {
        let mut text = "[body.base]\nmass = 60\ninertia = [5, 6, 2]\nposition = [0, 0, 0.9]\npoints = { top = [0, 0, 1] }\n".to_string();
        for (k, y) in [0.3, -0.3].iter().enumerate() {
            text += &format!(
                "[body.w{k}]\nmass = 4\ninertia = [0.05, 0.08, 0.05]\nposition = [0, {y}, {r}]\n\
                 [joint.hub{k}]\ntype = \"revolute\"\nbetween = [\"base\", \"w{k}\"]\nat = \"w{k}\"\naxis = [0, 1, 0]\n\
                 [joint.road{k}]\ntype = \"rolling\"\nbetween = [\"ground\", \"w{k}\"]\nat = \"w{k}\"\naxis = [0, 1, 0]\nnormal = [0, 0, 1]\nradius = {r}\n\
                 [force.motor{k}]\ntype = \"effort\"\njoint = \"hub{k}\"\n\
                 effort = \"{kp}*(base.top.x - base.x) + {kd}*(base.top.vx - base.vx) - {brake}*q_rate\"\n"
            );
        }
        let modes = found(&text);
        assert_eq!((modes.modes.len(), modes.free, modes.unsure), (4, 2, 0), "{modes:?}");
        let turned = 2.0 + 2.0 * (0.05 + 4.0 * 0.09) + 2.0 * 0.08 * (0.3 / r).powi(2);
        let turning = -2.0 * brake * (0.3 / r).powi(2) / turned;
        let determinant = |s: f64| {
            let of_x =
                [(68.0 + 2.0 * 0.08 / (r * r)) * s * s + 2.0 * brake / (r * r) * s, 60.0 * h * s * s - 2.0 / r * (kp + (kd + brake) * s)];
            let of_lean =
                [60.0 * h * s * s - 2.0 * brake / r * s, (6.0 + 60.0 * h * h) * s * s + 2.0 * (kd + brake) * s + 2.0 * kp - 60.0 * G * h];
            of_x[0] * of_lean[1] - of_x[1] * of_lean[0]
        };
        let falls: Vec<f64> = modes.modes.iter().map(|mode| mode.growth).filter(|s| (s / turning - 1.0).abs() > 1e-9).collect();
        let is_root = |s: &&f64| determinant(*s * (1.0 - 1e-9)) * determinant(*s * (1.0 + 1e-9)) < 0.0;
        assert_eq!((falls.len(), falls.iter().filter(is_root).count()), (3, 3), "{falls:?} beside {turning}");
        assert!(kp == 0.0 || (falls[0] - 0.109_241_81).abs() < 1e-8, "{falls:?}");
    }
}

/// What is free is counted, and what moves or is not at rest is refused.
#[test]
fn modes_are_about_rest() {
    let ball = "gravity = [0, 0, 0]\n[body.ball]\nmass = 1\nshape = { sphere = 0.1 }\nposition = [0, 0, 0]\n";
    let of_ball = found(ball);
    assert_eq!((of_ball.modes.len(), of_ball.free), (0, 12));
    // A cart on a rail under its weight, whose exponents are zero to the last digit.
    let cart = "plane = \"xz\"\n[body.b]\nmass = 1\ninertia = 1\nposition = [0, 0]\n\
                [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"b\"]\naxis = [1, 0]\n";
    assert_eq!(found(cart).free, 2);
    let why = |text: &str| modes(&model(text).system).expect_err("it is not at rest");
    assert_eq!(why(&ball.replacen("gravity = [0, 0, 0]\n", "", 1)), NoModes::Unbalanced);
    assert_eq!(why(&format!("{ball}velocity = [1, 0, 0]\n")), NoModes::Moving);
    let across = format!("plane = \"xz\"\n{}", rod(0, "ground", [0.0, 0.0], 0.0));
    assert_eq!(why(&across), NoModes::Unbalanced);
    assert_exponents(&format!("{across}[start]\nequilibrium = true\n"), &[[0.0, (1.5 * G).sqrt()]]);
}
