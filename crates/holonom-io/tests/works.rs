//! What each drive and each force has done in a run.

mod common;

use common::{CONSERVING, model, run, run_every};
use holonom::model::Model;
use holonom::record::{Recording, Works};
use holonom::simulation::{Choice, Method, Simulation, Status};

/// A crank with friction, a coil with a damper, and a force by a formula; beside it bobs on springs, one of them by a formula of time, that hang from a led
/// point and from one that a formula leads.
const MACHINE: &str = r#"
plane = "xy"
gravity = [0, -9.81]
[body]
crank = { mass = 1.2, inertia = 0.01, position = [0.05, 0] }
rod = { mass = 0.8, inertia = 0.02, position = [0.3, 0] }
piston = { mass = 2, inertia = 0.01, position = [0.5, 0] }
[joint]
main = { type = "revolute", between = ["ground", "crank"], at = [0, 0] }
pin = { type = "revolute", between = ["crank", "rod"], at = [0.1, 0] }
wrist = { type = "revolute", between = ["rod", "piston"], at = [0.5, 0] }
guide = { type = "prismatic", between = ["ground", "piston"], axis = [1, 0] }
[drive]
motor = { type = "angle", joint = "main", profile = "20*t + sin(3*t)" }
[point]
hand = { motion = ["0.6 + 0.05*sin(15*t)", "0.5"] }
bob = { mass = 0.5, position = [0.6, 0.1] }
slide = { mass = 0.3, position = [1, 1] }
hook = { fixed = true, position = [1, 1.8] }
[constraint]
across = { type = "expression", value = "slide.x - 1 - 0.1*sin(5*t)" }
hoist = { type = "distance", between = ["hook", "slide"], length = "0.8 + 0.05*sin(4*t)" }
[force]
rust = { type = "friction", joint = "main", effort = 0.2, speed = 0.05, damping = 0.1 }
coil = { type = "spring", between = [[0.9, 0], "piston"], stiffness = 500, damping = 4 }
gas = { type = "effort", joint = "guide", effort = "-30 - 5*q_rate + 20*sin(20*t)" }
servo = { type = "spring", between = ["hand", "bob"], stiffness = 200, rest_length = "0.3 + 0.02*sin(7*t)", damping = 0.7 }
tie = { type = "spring", between = ["hand", "bob"], stiffness = 100, damping = 0.3 }
cord = { type = "spring", between = ["slide", "bob"], stiffness = 40, damping = 0.1 }
"#;

fn works(model: &Model, simulation: &Simulation) -> Works {
    Works::of(&model.channels, simulation)
}

fn named(works: &Works, name: &str) -> [f64; 2] {
    let own = works.drives.iter().chain(&works.forces).find(|own| own.name == name).unwrap();
    [own.work, own.stored]
}

/// All of them with what they store, J.
fn sum(works: &Works) -> f64 {
    works.drives.iter().chain(&works.forces).map(|own| own.work + own.stored).sum()
}

/// The integral of a column of power by Simpson's rule.
fn integral(recording: &Recording, name: &str) -> f64 {
    let [t, power] = ["t", name].map(|name| recording.column(name).unwrap());
    let pairs = (2..t.len()).step_by(2);
    pairs.map(|k| (t[k] - t[k - 2]) / 6.0 * (power[k - 2] + 4.0 * power[k - 1] + power[k])).sum()
}

/// Whatever the method and however it finds its work: they add up to the work of the audit, to the rounding of a thousand sums of 100 J, and come to
/// the integrals of the powers as far as the method is exact.
#[test]
fn works_add_up_to_that_of_the_audit() {
    let model = model(MACHINE);
    let (step, end) = (1e-3, 1.0);
    let (reference, recording) = run_every(&model, "radau", step, end, 1);
    let exact = works(&model, &reference);
    let sorts = [&exact.drives, &exact.forces].map(|own| own.iter().map(|own| own.name.as_str()).collect::<Vec<_>>());
    assert_eq!(sorts[0], ["motor", "hoist", "across", "hand"]);
    assert_eq!(sorts[1], ["rust", "coil", "gas", "servo", "tie", "cord"]);
    for name in sorts[1].iter().chain(&["motor"]) {
        let (own, power) = (named(&exact, name)[0], integral(&recording, &format!("{name}.power")));
        // Simpson's rule has an error of (ωh)⁴/2880, and the fastest is some 100/s; the powers of 5e3 W are rounded.
        assert!((own - power).abs() < 1e-6 * own.abs().max(1.0), "{name}: {own} J and {power} J");
    }
    let methods = ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "generalized-alpha", "radau", "hht"];
    let others =
        ["lagrange-3/rattle", "bdf-2", "bdf-5", "ode/gauss-4", "ode/rk4", "ode/dopri5", "ode/dop853", "conserving-ggl-4", "conserving-4"];
    let plain = methods.into_iter().chain(others).map(|name| (name, None));
    let chosen = ["conserving-ggl", "radau", "bdf", "ode/dopri5", "ode/dop853", "generalized-alpha"].map(|name| (name, Some(1e-6)));
    for (name, accuracy) in plain.chain(chosen) {
        let choice = Choice { accuracy, ..Choice::default().named(name) };
        let (simulation, _) = run(&model, choice, step, end);
        let (works, energy) = (works(&model, &simulation), simulation.audit().energy_summary());
        let off = sum(&works) - energy.work_total;
        assert!(off.abs() < 1e-11 && works.rest.abs() < 1e-11, "{name}: {off:e} J beside the audit, {:e} J of no one", works.rest);
        let made = energy.integrator_total + energy.projection_total;
        let rise = energy.last - energy.initial;
        assert!((rise - sum(&works) - made).abs() < 1e-10, "{name}: energy rises by {rise} J");
        for (own, exact) in works.drives.iter().chain(&works.forces).zip(exact.drives.iter().chain(&exact.forces)) {
            // Methods of order 2: (ωh)²/12 of what goes to and fro, some 10 J at 60/s.
            assert!((own.work - exact.work).abs() < 1e-2, "{name}: {} did {} J and not {} J", own.name, own.work, exact.work);
        }
    }
}

/// A spring takes what its energy grows by, gravity gives what its weight falls by, and dampers and drives do what closed forms say.
#[test]
fn works_have_closed_forms() {
    let spring = model(
        "gravity = [0, 0, -9.81]\n[point.bob]\nmass = 2\nposition = [0, 0, -1]\nvelocity = [0.3, 0, 0]\n[force.s]\ntype = \"spring\"\n\
         between = [\"ground\", \"bob\"]\nstiffness = 300\nrest_length = 1\n",
    );
    let (simulation, recording) = run(&spring, Choice::default(), 0.01, 0.7);
    let own = works(&spring, &simulation);
    let [x, z, length] = ["bob.x", "bob.z", "s.length"].map(|name| recording.column(name).unwrap());
    assert!(x.last().unwrap().abs() > 0.01 && length[0] == 1.0);
    let energy = 150.0 * (length.last().unwrap() - 1.0).powi(2);
    assert!(energy > 0.1 && (named(&own, "s")[0] + energy).abs() < 1e-12 && (named(&own, "s")[1] - energy).abs() < 1e-12);
    assert!((own.gravity - 2.0 * 9.81 * (-1.0 - z.last().unwrap())).abs() < 1e-12 && own.rest == 0.0);
    // A damper of c = 0.8 N·s/m alone has stopped e^(−2ct/m) short of all of ½ m v².
    let damper = model(
        "gravity = [0, 0, 0]\n[point.p]\nmass = 0.5\nposition = [1, 0, 0]\nvelocity = [3, 0, 0]\n[force.d]\ntype = \"spring\"\n\
         between = [\"ground\", \"p\"]\nalong = [1, 0, 0]\ndamping = 0.8\n",
    );
    let lost = |step: f64| {
        let (simulation, _) = run(&damper, Choice::default(), step, 1.0);
        named(&works(&damper, &simulation), "d")[0] + 2.25 * (1.0 - (-2.0 * 0.8 / 0.5_f64).exp())
    };
    assert!(lost(1e-3).abs() < 1e-6 && lost(1e-2).abs() < 1e-4, "{:e} {:e}", lost(1e-3), lost(1e-2));
    // A motor turns a wheel of 0.1 kg·m² up to 10 rad/s against friction of 0.3 N·m·s/rad: 5 J and 0.3 ∫ (10 t)² dt.
    let wheel = model(
        "plane = \"xy\"\n[body.w]\nmass = 1\ninertia = 0.1\nposition = [0, 0]\n[joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"w\"]\nat = [0, 0]\n\
         [drive.m]\ntype = \"angle\"\njoint = \"j\"\nprofile = \"5*t^2\"\n[force.f]\ntype = \"torsion\"\njoint = \"j\"\ndamping = 0.3\n",
    );
    let (simulation, _) = run(&wheel, Choice::default(), 1e-3, 1.0);
    let own = works(&wheel, &simulation);
    assert!((named(&own, "m")[0] - 15.0).abs() < 1e-5 && (named(&own, "f")[0] + 10.0).abs() < 1e-5, "{own:?}");
}

/// A run that goes on from its checkpoint has the bits of one that went through.
#[test]
fn works_go_on_from_a_checkpoint() {
    let model = model(MACHINE);
    for (name, accuracy) in
        [("conserving-ggl", None), ("generalized-alpha", None), ("bdf-2", None), ("radau", Some(1e-5)), ("ode/dopri5", Some(1e-5))]
    {
        let method = || Method::resolve(&Choice { accuracy, ..Choice::default().named(name) }).unwrap();
        let mut whole = Simulation::new(model.system.clone(), method(), 0.01).unwrap();
        let mut first = Simulation::new(model.system.clone(), method(), 0.01).unwrap();
        (0..7).for_each(|_| assert_eq!(first.step(), Status::Completed));
        let mut second = Simulation::resume(model.system.clone(), method(), 0.01, first.checkpoint()).unwrap();
        (0..5).for_each(|_| assert_eq!(second.step(), Status::Completed));
        (0..12).for_each(|_| assert_eq!(whole.step(), Status::Completed));
        assert_eq!(works(&model, &second), works(&model, &whole), "{name}");
    }
}

/// A motor turns a shaft against a brake at a steady speed: its work is the torque times the angle to a thousandth, though the shaft turns by a tenth of a
/// radian in a step and its rate is then 0.2 % more than what the angle comes on by, to which a steep torque curve answers with a fifth of it.
#[test]
fn work_of_what_spins_is_no_less_sure() {
    const BRAKE: f64 = 6.0;
    let speed = 157.0 - 15.0 * (BRAKE / 40.0_f64).atanh();
    for (input, share) in [("", ""), ("[input.on]\ndefault = 1\n", "on*")] {
        let text = format!(
            "gravity = [0, 0, 0]\n[body.shaft]\nmass = 5\ninertia = [0.01, 0.02, 0.02]\nposition = [0, 0, 0]\nangular_velocity = [{speed}, 0, 0]\n\
             [joint.bearing]\ntype = \"revolute\"\nbetween = [\"ground\", \"shaft\"]\nat = [0, 0, 0]\naxis = [1, 0, 0]\n{input}\
             [force.motor]\ntype = \"effort\"\njoint = \"bearing\"\neffort = \"{share}40*tanh((157 - q_rate)/15)\"\n\
             [force.brake]\ntype = \"effort\"\njoint = \"bearing\"\neffort = -{BRAKE}\n"
        );
        for method in CONSERVING {
            let (model, end) = (model(&text), 2.0);
            let (simulation, recording) = run_every(&model, method, 1e-3, end, 1);
            let turned = *recording.column("bearing.angle").unwrap().last().unwrap();
            assert!((turned - speed * end).abs() < 1e-3 * speed * end, "{method}: {turned}");
            let [work, _] = named(&works(&model, &simulation), "motor");
            assert!((work - BRAKE * speed * end).abs() < 1e-3 * BRAKE * speed * end, "{method}: {work}");
            let unsure = simulation.unsure_work().map_or(0.0, |(unsure, _, _)| unsure);
            assert!(unsure < 1e-3 * work, "{method}, {share}: {unsure} J of {work} J");
        }
    }
}
