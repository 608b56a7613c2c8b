//! Dampers from weak to far stiffer than a step can follow: nothing rings, nothing is thrown, order two stays.

mod common;

use common::model;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

/// 1 kg at 10 m/s on a damper along its way, and a spring where `stiffness` is above zero.
fn text(damping: f64, stiffness: f64) -> String {
    format!(
        "gravity = [0, 0, 0]\n[point.wall]\nposition = [0, 0, 0]\nfixed = true\n\
         [point.m]\nmass = 1\nposition = [5, 0, 0]\nvelocity = [10, 0, 0]\n\
         [force.d]\ntype = \"spring\"\nbetween = [\"wall\", \"m\"]\ndamping = {damping:e}\nstiffness = {stiffness}\nrest_length = 5\n"
    )
}

fn largest(of: &[f64]) -> f64 {
    of.iter().fold(0.0, |most, v| most.max(v.abs()))
}

fn named(method: &str) -> Method {
    Method::resolve(&Choice::default().named(method)).unwrap()
}

/// Way, velocity and booked work after a second, and the largest velocity against the first on the way.
fn run(text: &str, method: &str, step: f64) -> [f64; 4] {
    let model = model(text);
    let mut simulation = Simulation::new(model.system.clone(), named(method), step).unwrap();
    let mut back = 0.0_f64;
    let mut see = |simulation: &Simulation| {
        back = back.max(-simulation.velocities()[0]);
        Verdict::GoOn
    };
    assert_eq!(simulation.run(1.0, &mut see), Status::Completed);
    let state = simulation.state();
    [state.x[0] - 5.0, simulation.velocities()[0], simulation.audit().work, back]
}

/// With c = 1e-3 … 1e9 the mass goes v₀ m/c (1 − e^(−ct/m)), or stands after the first step where that is longer, and goes back
/// by no more than a tenth of its velocity, in the first step of all.
#[test]
fn what_is_overdamped_stands_still() {
    let h = 0.01;
    for method in ["conserving-ggl", "conserving", "generalized-alpha", "lagrange-3/hht"] {
        for decade in -3..=9 {
            let c = 10.0_f64.powi(decade);
            let [way, velocity, work, back] = run(&text(c, 0.0), method, h);
            let exact = [10.0 / c * -(-c).exp_m1(), 10.0 * (-c).exp()];
            println!(
                "{method:18} c = {c:7.0e} way {way:9.6} ({:9.6}), velocity {velocity:9.2e}, back {back:8.1e}, work {work:9.2e}",
                exact[0]
            );
            // A step of z = h c/m = 1 errs by a twelfth, and generalized-α by less than a third; the first step of what is stiffer is
            // one of h v₀/2.
            let z = (h * c).min(1.0);
            let first = if h * c > 1.0 { 0.55 * h * 10.0 } else { 1e-9 };
            assert!((way - exact[0]).abs() <= z * z / 3.0 * exact[0] + first, "{method}, c = {c}");
            assert!((velocity - exact[1]).abs() <= 0.2 * z * z * c * exact[1] + 1e-8, "{method}, c = {c}: {velocity}");
            assert!(back <= if h * c > 0.5 { 1.0 } else { 1e-9 }, "{method}, c = {c}: back with {back} m/s");
            // Its kinetic energy has gone into the damper, but for what a rounded position is to it: 1e-15 m times c at a mean of 5 m/s.
            if method.starts_with("conserving") {
                assert!((work + 0.5 * (100.0 - velocity * velocity)).abs() < 1e-9 + 2e-14 * c, "{method}, c = {c}: {work}");
            }
        }
    }
}

/// Schemes that take the rate of a damper at the mean of a step, whatever it is, would turn what is overdamped round for ever. Their steps are
/// divided until it stops, but for what has less energy than the damper would take in a step; where no part is short enough the run stops.
#[test]
fn no_scheme_turns_a_motion_round_for_ever() {
    let h = 0.01;
    for method in ["trapezoidal-projected", "trapezoidal", "newmark", "midpoint", "rattle", "gauss"] {
        let mut stopped = 0;
        for decade in -3..=9 {
            let c = 10.0_f64.powi(decade);
            let mut simulation = Simulation::new(model(&text(c, 0.0)).system, named(method), h).unwrap();
            let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
            let [way, velocity] = [simulation.state().x[0] - 5.0, simulation.velocities()[0]];
            println!("{method:22} c = {c:7.0e} way {way:9.6} ({:9.6}), velocity {velocity:9.2e}, {status:?}", 10.0 / c);
            match status {
                Status::Stopped { reason, .. } => {
                    assert!(reason.contains("turns round what `d` brakes") && c > 1e6, "{method}, c = {c}: {reason}");
                    stopped += 1;
                }
                Status::Completed => {
                    let (exact, left) = (10.0 / c * -(-c).exp_m1(), (50.0 / (h * c)).sqrt());
                    assert!((way - exact).abs() <= 0.1 * exact + h * left, "{method}, c = {c}");
                    assert!(velocity.abs() <= left.max(10.0 * (-c).exp() + 1e-9), "{method}, c = {c}: {velocity}");
                }
            }
        }
        assert!(stopped <= 3, "{method}");
    }
}

/// Errors fall by four where steps are halved, with a spring beside the damper.
#[test]
fn dampers_keep_order_two() {
    for method in ["conserving-ggl", "conserving", "generalized-alpha", "lagrange-3/hht"] {
        for c in [0.5, 5.0, 50.0] {
            let model = text(c, 40.0);
            let error = |step: f64| {
                let (fine, coarse) = (run(&model, "radau", 1e-3), run(&model, method, step));
                (fine[0] - coarse[0]).hypot(fine[1] - coarse[1])
            };
            let step = 0.005_f64.min(0.05 / c);
            let order = (error(step) / error(0.5 * step)).log2();
            println!("{method:18} c = {c:4} error {:8.1e} at {} s, order {order:.3}", error(0.5 * step), 0.5 * step);
            assert!((order - 2.0).abs() < 0.15, "{method}, c = {c}: order {order}");
        }
    }
}

/// So they do of a weak damper on a beam in space whose material is damped: six dampers an element, overdamped in its fast vibrations.
#[test]
fn a_weak_damper_keeps_order_two_on_a_damped_beam() {
    let text = "gravity = [0, 0, 0]\n[beam.mast]\nfrom = [0, 0, 0]\nto = [0, 0, 2]\nelements = 12\nsection = { rectangle = [0.05, 0.05] }\n\
         modulus = 2e11\ndensity = 7850\ndamping = 1e-3\n\
         [joint.foot]\ntype = \"fixed\"\nbetween = [\"ground\", \"mast[0]\"]\nat = [0, 0, 0]\n\
         [point.t]\nmass = 2\nposition = [0.5, 0, 2]\nvelocity = [1, 0, 0]\n\
         [force.tuned]\ntype = \"spring\"\nbetween = [\"mast[12]\", \"t\"]\nalong = [1, 0, 0]\nstiffness = 400\ndamping = 10\n";
    let model = model(text);
    let end = |method: &str, step: f64| {
        let mut simulation = Simulation::new(model.system.clone(), named(method), step).unwrap();
        let moves = simulation.velocities().iter().position(|v| *v == 1.0).unwrap();
        assert_eq!(simulation.step_to(0.5), Status::Completed, "{method}");
        simulation.state().x[moves]
    };
    let exact = end("radau", 2e-3);
    for method in ["conserving-ggl", "conserving"] {
        let errors = [0.01, 0.005, 0.0025].map(|h| (end(method, h) - exact).abs());
        println!("{method:18} {errors:?}");
        assert!((0..2).all(|k| (errors[k] / errors[k + 1] - 4.0).abs() < 0.5), "{method}: {errors:?}");
    }
}

/// So they do of a weak damper that holds the mass which a damper far too strong for the step ties to another: what that does not brake it leaves alone.
#[test]
fn a_weak_damper_keeps_order_two_beside_a_strong_one() {
    let text = format!(
        "{}[point.n]\nmass = 1\nposition = [6, 0, 0]\nvelocity = [10, 0, 0]\n\
         [force.strong]\ntype = \"spring\"\nbetween = [\"m\", \"n\"]\ndamping = 1e6\nstiffness = 1e4\n",
        text(0.6, 20.0)
    );
    // Both move as one of 2 kg: ẍ + 0.3 ẋ + 10 x = 0.
    let (decay, speed) = (0.15_f64, (10.0_f64 - 0.0225).sqrt());
    let exact = 10.0 / speed * (-decay).exp() * speed.sin();
    for method in ["conserving-ggl", "conserving"] {
        let errors = [0.04, 0.02, 0.01].map(|h| (run(&text, method, h)[0] - exact).abs());
        println!("{method:18} {errors:?}");
        assert!(errors[0] < 0.02 && (0..2).all(|k| errors[k] / errors[k + 1] > 3.5), "{method}: {errors:?}");
    }
}

/// What is overdamped stands still whatever other dampers there are, also one that rows keep from doing anything, and however light it is beside other bodies.
#[test]
fn what_is_overdamped_stands_still_beside_what_is_held_or_heavy() {
    let held = format!(
        "{}[point.a]\nmass = 1\nposition = [0, 5, 0]\n[point.b]\nmass = 1\nposition = [1, 5, 0]\n\
         [constraint.rod]\ntype = \"distance\"\nbetween = [\"a\", \"b\"]\n\
         [force.held]\ntype = \"spring\"\nbetween = [\"a\", \"b\"]\ndamping = 1e9\n",
        text(1e4, 0.0)
    );
    let light = |wheels: usize| {
        let wheel = |k: usize| {
            format!(
                "[body.w{k}]\nmass = 1e-6\nshape = {{ cylinder = [0.1, 0.1] }}\nposition = [{x}, 0, 0]\nangular_velocity = [0, 0, 1]\n\
                 [joint.h{k}]\ntype = \"revolute\"\nbetween = [\"ship\", \"w{k}\"]\nat = [{x}, 0, 0]\naxis = [0, 0, 1]\n\
                 [force.brake{k}]\ntype = \"torsion\"\njoint = \"h{k}\"\ndamping = 1e-4\n",
                x = k + 2
            )
        };
        "gravity = [0, 0, 0]\n[body.ship]\nmass = 1e6\nshape = { box = [1, 0.5, 0.3] }\nposition = [0, 0, 0]\n".to_owned()
            + &(0..wheels).map(wheel).collect::<String>()
    };
    // More of them than are looked at one by one.
    let many = "gravity = [0, 0, 0]\n[point.p]\nrepeat = \"i = 1 to 1200\"\nmass = 1\nposition = [\"i\", 0, 0]\nvelocity = [1, 0, 0]\n\
                [force.d]\nrepeat = \"i = 1 to 1200\"\ntype = \"spring\"\nbetween = [[\"i - 1\", 0, 0], \"p[i]\"]\ndamping = 1e4\n\
                [force.e]\nrepeat = \"i = 2 to 1200\"\ntype = \"spring\"\nbetween = [\"p[i-1]\", \"p[i]\"]\ndamping = 1e4\n";
    let cases = [
        ("held", held, None),
        ("light", light(1), None),
        ("many light ones", light(70), None),
        ("light in real time", light(3), Some(6)),
        ("very many", many.into(), None),
    ];
    for (name, text, iterations) in cases {
        let model = model(&text);
        for method in ["conserving-ggl", "conserving"] {
            let method = Method::resolve(&Choice { iterations, ..Choice::default().named(method) }).unwrap();
            let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap();
            let first = largest(simulation.velocities());
            assert_eq!(simulation.step_to(0.02), Status::Completed);
            let left = largest(simulation.velocities()) / first;
            println!("{name}: {left:.1e}");
            // `conserving` has velocities off the rows by the square of the turn.
            assert!(left < 1e-2, "{name}: {left} of the velocity is left");
        }
    }
}

/// What is overdamped and held by a spring goes on by half a step before it stands still. Where that would load the spring with more energy than there is,
/// the step is taken in parts: a damper makes no energy.
#[test]
fn a_strong_damper_loads_no_spring() {
    let text = text(1e6, 1e8);
    // s² + 1e6 s + 1e8 = 0 of the slow motion, which begins at v₀ over the difference of both.
    let root = (0.25e12_f64 - 1e8).sqrt();
    let slow = 0.5e6 - root;
    let exact = 10.0 / (2.0 * root) * (-slow * 0.01).exp();
    for method in ["conserving-ggl", "conserving", "conserving-projected"] {
        let mut simulation = Simulation::new(model(&text).system, named(method), 1e-3).unwrap();
        let first = simulation.audit().energy();
        let mut most = first;
        let status = simulation.run(0.01, &mut |now: &Simulation| {
            most = most.max(now.audit().energy());
            Verdict::GoOn
        });
        assert_eq!(status, Status::Completed, "{method}");
        println!("{method}: {most} J of {first} J, {:e} m and {exact:e} m", simulation.state().x[0] - 5.0);
        assert!(most <= 1.01 * first, "{method}: {most} J of {first} J");
        assert!((simulation.state().x[0] - 5.0 - exact).abs() < 5e-4, "{method}");
    }
}

/// Compositions go back in time in parts of their step, where a damper makes energy: steps that are too long for that are divided, so that a bushing
/// only takes energy and the end is that of small steps; where no part is short enough, the run stops and says so.
#[test]
fn compositions_make_no_energy_of_dampers() {
    let held = |c: f64| {
        format!(
            "plane = \"xy\"\n[body.a]\nmass = 0.1\ninertia = 0.0015\nposition = [0, 0]\nvelocity = [1, 0]\nangular_velocity = 2\n\
             [force.f]\ntype = \"bushing\"\nbetween = [\"ground\", \"a\"]\nat = [1, 0.3]\nstiffness = [300, 200, 40]\n\
             damping = [{c}, {c}, {}]\n",
            0.2 * c
        )
    };
    for c in [0.5, 1.5, 5.0, 31.623] {
        let end = |simulation: &Simulation| [simulation.state().x[0], simulation.velocities()[0]];
        let mut small = Simulation::new(model(&held(c)).system, named("radau"), 1e-4).unwrap();
        assert_eq!(small.step_to(0.3), Status::Completed);
        let exact = end(&small);
        for (method, within) in [("ggl/conserving-ggl-4", 2e-4), ("ggl/conserving-ggl-6", 1e-6), ("lagrange-3/conserving-4", 2e-4)] {
            for step in [0.01, 0.005, 0.0025] {
                let mut simulation = Simulation::new(model(&held(c)).system, named(method), step).unwrap();
                let first = simulation.audit().energy();
                let mut most = first;
                let status = simulation.run(0.3, &mut |now: &Simulation| {
                    most = most.max(now.audit().energy());
                    Verdict::GoOn
                });
                assert_eq!(status, Status::Completed, "{method}, {c} N·s/m, {step} s");
                assert!(most <= first * (1.0 + 1e-12), "{method}, {c} N·s/m, {step} s: {most} J of {first} J");
                for (here, exact) in end(&simulation).into_iter().zip(exact) {
                    assert!((here - exact).abs() < within, "{method}, {c} N·s/m, {step} s: {here}, and {exact} with small steps");
                }
            }
        }
    }
    let mut simulation = Simulation::new(model(&held(1e5)).system, named("ggl/conserving-ggl-6"), 0.01).unwrap();
    let Status::Stopped { reason, .. } = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn) else { panic!("it came through") };
    assert!(reason.contains("goes back in time in parts of its step, and `f` is too strong a damper"), "{reason}");
}
