//! Steps chosen by accuracy: the error at the end against reference solutions computed elsewhere in 113-bit arithmetic.

mod common;

use common::{example, model};
use holonom::simulation::{Choice, Method, Simulation, Status, Summary, Verdict};
use holonom::system::Place;

struct Reference {
    model: &'static str,
    end: f64,
    point: &'static str,
    place: &'static [f64],
}

/// Sizes are about one or two metres, so that errors relative to them are errors in metres or half as much.
const REFERENCES: [Reference; 6] = [
    Reference {
        model: "spherical-compound-pendulum",
        end: 2.0,
        point: "m2",
        place: &[-1.27229634990966, -0.953716555813986, -1.21313096126217],
    },
    Reference { model: "simple-pendulum", end: 2.0, point: "bob", place: &[-0.793566195343322, -0.608483930443792] },
    Reference { model: "double-pendulum", end: 2.0, point: "m2", place: &[0.458295895031555, -1.29605879684337] },
    Reference { model: "car-axis", end: 0.5, point: "right", place: &[1.04357714997553, 0.404338653154628] },
    Reference { model: "spring-pendulum", end: 2.0, point: "bob", place: &[0.787163379341288, -0.619690574822012] },
    Reference { model: "four-bar", end: 0.5, point: "P[0]", place: &[0.701512678910477, 0.712656973113886] },
];

/// Error at the end, m, and the summary.
fn run(reference: &Reference, end: f64, place: &[f64], method: &str, accuracy: f64) -> (f64, Summary) {
    let model = example(reference.model);
    let choice = Choice { method: Some(method.into()), accuracy: Some(accuracy), ..Choice::default() };
    let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.1 * end).unwrap();
    let status = simulation.run(end, &mut |_: &Simulation| Verdict::GoOn);
    assert_eq!(status, Status::Completed, "{}, {method}, {accuracy:e}", reference.model);
    let point = model.points.iter().find(|point| point.name == reference.point).expect("the point is there");
    let Place::Node(node) = point.place else { panic!("{} moves", reference.point) };
    let found = &simulation.state().x[node.index() * model.dimension..];
    let error = place.iter().zip(found).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    let size = holonom::analysis::rank(&model.system, &simulation.state().x, end).size(&model.system);
    (error, simulation.summary("test", end, &status, size))
}

/// From 1e-3 to 1e-9 the error stays within ten times of what was asked for, in nine cases of ten.
#[test]
fn errors_are_what_was_asked_for() {
    let (mut cases, mut kept) = (0, 0);
    for method in ["conserving-ggl", "radau", "bdf", "ode/dopri5/velocity", "ode/dop853/velocity"] {
        for reference in &REFERENCES[..5] {
            let mut line = format!("{method:20} {:28}", reference.model);
            for exponent in 3..=9 {
                let accuracy = 10f64.powi(-exponent);
                let (error, summary) = run(reference, reference.end, reference.place, method, accuracy);
                line += &format!(" {:8.1e}", error);
                cases += 1;
                kept += i32::from(error <= 10.0 * accuracy);
                if method == "conserving-ggl" {
                    assert!(summary.energy.max_drift <= 1e-10, "{}: {}", reference.model, summary.energy.max_drift);
                }
            }
            println!("{line}");
        }
    }
    println!("{kept} of {cases} cases within ten times of the accuracy");
    assert!(10 * kept >= 9 * cases);
}

/// What BDF loses of a rotation has the same sign in step after step, and what the velocity is off by adds up along many turns, also where a brake
/// does work: the angle is that of the closed form. The units of the mechanism do not matter.
#[test]
fn bdf_keeps_the_angle_of_a_braked_shaft() {
    let cases = [(1.0, "ggl/bdf", 1e-3), (1.0, "ggl/bdf", 1e-5), (1.0, "ggl/bdf", 1e-7), (1.0, "ode/bdf", 1e-4), (1000.0, "ggl/bdf", 1e-3)];
    for (unit, method, accuracy) in cases {
        let text = format!(
            "plane = \"xy\"\n[body.s]\nmass = 1\ninertia = {}\nposition = [0, 0]\nangular_velocity = 100\npoints = {{ tip = [{}, 0] }}\n\
             [joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"s\"]\nat = [0, 0]\n\
             [force.d]\ntype = \"torsion\"\njoint = \"j\"\ndamping = {}\n",
            0.01 * unit * unit,
            0.3 * unit,
            0.001 * unit * unit
        );
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
        let (_, recording) = common::run(&model(&text), choice, 0.5, 3.0);
        let angle = recording.column("j.angle").unwrap()[recording.rows() - 1];
        let error = (angle - 1000.0 * (1.0 - (-0.3_f64).exp())).abs();
        assert!(error < 10.0 * accuracy, "{method}, {accuracy:e}, unit {unit}: off by {error:e}");
    }
}

/// In steps so short that differences of states are round-off these say nothing of the energy: a mass of 1 kg at 1 m/s is back from a stop of 1e10 N/m
/// after half a period of its contact, in any unit of mass.
#[test]
fn bdf_sees_no_energy_in_round_off() {
    for mass in [1.0, 1e-6] {
        let text = format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[body.block]\nmass = {mass}\ninertia = {}\nposition = [-0.5, 0]\nvelocity = [1, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\naxis = [1, 0]\n\
             [force.stop]\ntype = \"stop\"\njoint = \"rail\"\nupper = 0.5\nstiffness = {}\n",
            0.01 * mass,
            1e10 * mass
        );
        for accuracy in [1e-8, 1e-9] {
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named("ggl/bdf") };
            let (_, recording) = common::run(&model(&text), choice, 0.05, 1.0);
            let error = (common::last(&recording, "block.x") + 0.5 - 1e-5 * std::f64::consts::PI).abs();
            assert!(error < 10.0 * accuracy, "{mass} kg, {accuracy:e}: off by {error:e}");
        }
    }
}

/// Errors of steps of `lagrange-3/radau` are hidden by velocities off their rows: a run that finds no step short enough names methods that hold them.
#[test]
fn methods_without_rows_of_velocities_name_those_with_them() {
    let pendulum = "plane = \"xy\"\ngravity = [0, -9.81]\n[body.rod]\nshape = { rod = 1 }\nmass = 1\nposition = [0.5, 0]\n\
                    [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"rod\"]\nat = [0, 0]\n";
    let choice = Choice { accuracy: Some(1e-5), ..Choice::default().named("lagrange-3/radau") };
    let mut simulation = Simulation::new(model(pendulum).system.clone(), Method::resolve(&choice).unwrap(), 0.1).unwrap();
    let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
    let Status::Stopped { reason, .. } = &status else { panic!("{status:?}") };
    assert!(reason.contains("take radau or ggl/bdf"), "{reason}");
}

/// Radau IIA of order 5 on the GGL form gives ten digits and more.
#[test]
fn radau_gives_ten_digits() {
    let ends = [(0, 5.0, PENDULUM_AT_5.as_slice()), (2, 5.0, DOUBLE_AT_5.as_slice()), (3, 3.0, CAR_AT_3.as_slice())];
    let shorter = [1, 4, 5].map(|k: usize| (k, REFERENCES[k].end, REFERENCES[k].place));
    for (k, end, place) in ends.into_iter().chain(shorter) {
        let (error, summary) = run(&REFERENCES[k], end, place, "radau", 1e-12);
        println!("{:28} {end} s: error {error:.1e}, {} iterations", REFERENCES[k].model, summary.work.iterations);
        assert!(error < 1e-10, "{}: {error:e}", REFERENCES[k].model);
    }
}

const PENDULUM_AT_5: [f64; 3] = [-0.345203349034276, -1.69420997241737, -1.0052299324916];
const DOUBLE_AT_5: [f64; 2] = [0.267403405386398, -1.62507455103253];
const CAR_AT_3: [f64; 2] = [1.04174252488543, 0.373911027265366];

/// Dense output: results between the steps are as good as those at their ends, cost no steps, and their balance of energy
/// closes.
#[test]
fn dense_output_takes_no_steps() {
    let model = example("spherical-compound-pendulum");
    for method in ["ode/dopri5", "ode/dopri5/velocity", "ode/dop853/velocity"] {
        let run = |interval: f64| {
            let choice = Choice { method: Some(method.into()), accuracy: Some(1e-7), ..Choice::default() };
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), interval).unwrap();
            let (mut rows, mut changes) = (Vec::new(), 0.0);
            let status = simulation.run(2.0, &mut |simulation: &Simulation| {
                let audit = simulation.audit();
                changes += audit.integrator + audit.projection;
                rows.push((simulation.state().t, simulation.state().x[3..].to_vec(), simulation.velocities()[..3].to_vec()));
                Verdict::GoOn
            });
            assert_eq!(status, Status::Completed);
            let size = holonom::analysis::rank(&model.system, &simulation.state().x, 2.0).size(&model.system);
            let summary = simulation.summary("test", 2.0, &status, size);
            assert!((summary.energy.last - summary.energy.initial - changes).abs() < 1e-12, "{method}: {changes}");
            (rows, summary.work.iterations)
        };
        let ((sparse, few), (dense, many)) = (run(2.0), run(0.01));
        assert_eq!(few, many, "{method}: iterations");
        assert_eq!(sparse.last(), dense.last(), "{method}");
        // r2 and v1 of the pendulum at 0.5 s in 113-bit arithmetic.
        let (_, place, _) = dense.iter().find(|(t, ..)| (t - 0.5).abs() < 1e-9).expect("there is a row");
        for (found, inner) in place.iter().zip([0.722991489655185, 0.210003143628563, -0.65816562167307]) {
            assert!((found - 2.0 * inner).abs() < 1e-6, "{method}: {place:?}");
        }
        // Rates of positions are velocities, between steps and across their ends.
        for w in dense.windows(3) {
            for c in 0..3 {
                let slope = (w[2].1[c] - w[0].1[c]) / (w[2].0 - w[0].0);
                assert!((slope - 2.0 * w[1].2[c]).abs() < 5e-3, "{method} at {} s: {slope} and {}", w[1].0, w[1].2[c]);
            }
        }
    }
}

/// What cannot tell its errors says so, and who can.
#[test]
fn integrators_without_estimate_are_refused() {
    for (method, word) in [("ode/rk4", "rk4"), ("ggl/conserving-ggl-4", "order 4"), ("trapezoidal", "unstable")] {
        let choice = Choice { method: Some(method.into()), accuracy: Some(1e-6), ..Choice::default() };
        let message = Method::resolve(&choice).err().expect("it is refused").to_string();
        assert!(message.contains(word), "{message}");
    }
}

/// Windows of bars that come to lie in a line, where a second way opens and the motion goes on all the same.
#[test]
fn steps_by_accuracy_pass_singular_positions() {
    for windows in 1..=3 {
        let mut text = "plane = \"xy\"\ngravity = [0, -9.81]\n".to_string();
        for k in 0..=windows {
            text += &format!("[point.b{k}]\nposition = [{k}, 0]\nfixed = true\n[point.t{k}]\nposition = [{k}, 1]\nvelocity = [1, 0]\n");
            text += &format!("[bar.v{k}]\nbetween = [\"b{k}\", \"t{k}\"]\nmass = 1\n");
        }
        for k in 0..windows {
            text += &format!("[bar.h{k}]\nbetween = [\"t{k}\", \"t{}\"]\nmass = 1\n", k + 1);
        }
        let model = model(&text);
        let place = |method: &str, accuracy: f64| {
            let choice = Choice { method: Some(method.into()), accuracy: Some(accuracy), ..Choice::default() };
            let mut simulation = Simulation::new(model.system.clone(), Method::resolve(&choice).unwrap(), 0.05).unwrap();
            let status = simulation.run(2.0, &mut |_: &Simulation| Verdict::GoOn);
            assert_eq!(status, Status::Completed, "{windows} windows, {method} at {accuracy}");
            simulation.state().x.clone()
        };
        let reference = place("radau", 1e-9);
        for method in ["conserving-ggl", "conserving", "trapezoidal-projected", "generalized-alpha", "radau"] {
            for accuracy in [1e-3, 1e-5, 1e-6] {
                let found = place(method, accuracy);
                let off = found.iter().zip(&reference).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                println!("{windows} windows, {method:22} {accuracy:7.0e}: off by {off:.1e} m");
                assert!(off < 10.0 * accuracy * (1.0 + windows as f64), "{windows} windows, {method} at {accuracy}: off by {off:e} m");
            }
        }
    }
}

/// Explicit methods stay on the rows, so that a pendulum has its period after a hundred swings: by the arithmetic and geometric mean of
/// Gauss it is 2π/agm(1, cos(θ₀/2)) √(l/g), a quarter of which after any number of them it hangs down.
#[test]
fn explicit_methods_stay_on_their_rows() {
    let (amplitude, g, swings) = (2.0_f64, 9.81, 100.0);
    let (mut a, mut b) = (1.0, (amplitude / 2.0).cos());
    for _ in 0..6 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    let end = (swings + 0.25) * std::f64::consts::TAU / a / f64::sqrt(g);
    let text = format!(
        "plane = \"xz\"\n[point.b]\nmass = 1\nposition = [\"sin({amplitude})\", \"-cos({amplitude})\"]\n\
         [constraint.c]\ntype = \"distance\"\nbetween = [[0, 0], \"b\"]\n"
    );
    for (method, accuracy) in [("ode/dopri5", 1e-4), ("ode/dopri5", 1e-7), ("lagrange-1/dop853", 1e-5), ("baumgarte/dopri5", 1e-6)] {
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
        let (simulation, recording) = common::run(&model(&text), choice, end / 400.0, end);
        let off = recording.column("b.x").unwrap()[recording.rows() - 1].abs();
        let violation = simulation.audit().violation_summary();
        println!("{method} {accuracy:e}: {off:.1e}, {violation:?}, {} steps", simulation.audit().work_summary(1).steps_taken);
        assert!(off <= 10.0 * accuracy, "{method} at {accuracy:e}: {off:e} m from the lowest place");
        assert!(violation.position <= 1e-14 && violation.velocity <= 1e-12, "{method}: {violation:?}");
    }
}

/// What stands still, or begins to move later, takes steps by any accuracy: there is no energy that could be off.
#[test]
fn what_stands_still_is_no_error() {
    let text = "[body.a]\nmass = 1\ninertia = [0.1, 0.15, 0.2]\nposition = [0.27, 0.42, 0.1]\n\
                [joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
    let later = "[force.m]\ntype = \"effort\"\njoint = \"h\"\neffort = \"step(t - 0.5)\"\n";
    for method in ["radau", "ggl/bdf", "conserving-ggl", "ode/dopri5"] {
        for (motor, angle) in [("", 0.0), (later, 0.5 * 0.25 / (0.2 + 0.27 * 0.27 + 0.42 * 0.42))] {
            let choice = Choice { accuracy: Some(1e-6), ..Choice::default().named(method) };
            let (_, recording) = common::run(&model(&format!("{text}{motor}")), choice, 0.05, 1.0);
            let found = common::last(&recording, "h.angle");
            assert!((found - angle).abs() <= 1e-5, "{method}: {found} rad and {angle} rad by hand");
        }
    }
}

/// Where a curve turns back within a millimetre, short steps change what it is a function of by next to nothing, and keep the energy all the same.
#[test]
fn tight_bends_keep_the_energy() {
    let text = "plane = \"xy\"\n[point.b]\nmass = 1\nposition = [0, 0]\nvelocity = [-5.708187251030109, -0.5777401567176609]\n\
                [joint.c]\ntype = \"point-on-curve\"\nbetween = [\"ground\", \"b\"]\nat = [0, 0]\nclosed = false\n\
                curve = [[0, 0], [-1.7549823431045186, -0.21193929814961443], [-1.006418519537844, -0.19209572406803743]]\n";
    for method in ["conserving-ggl", "conserving"] {
        let choice = Choice { accuracy: Some(1e-4), ..Choice::default().named(method) };
        let (simulation, _) = common::run(&model(text), choice, 0.02, 0.4);
        assert!(simulation.audit().energy_summary().max_drift < 1e-9, "{method}");
    }
}

/// A single point has the size of what holds it, wherever that is: the same steps and the same motion.
#[test]
fn a_pendulum_is_the_same_far_away() {
    let run = |place: f64, method: &str| {
        let text = format!(
            "plane = \"xz\"\n[point.b]\nmass = 1\nposition = [\"{place} + sin(0.5)\", \"-cos(0.5)\"]\n\
             [constraint.c]\ntype = \"distance\"\nbetween = [[{place}, 0], \"b\"]\n"
        );
        let choice = Choice { accuracy: Some(1e-5), ..Choice::default().named(method) };
        let (simulation, recording) = common::run(&model(&text), choice, 0.1, 1.0);
        (recording.column("b.z").unwrap()[recording.rows() - 1], simulation.audit().iterations)
    };
    for method in ["conserving-ggl", "radau", "ggl/bdf"] {
        let (here, iterations) = run(0.0, method);
        for place in [10.0, 1e4] {
            let (there, more) = run(place, method);
            assert!(
                (there - here).abs() < 1e-5 && more < 2 * iterations,
                "{method} at {place} m: {there} and {here}, {more} and {iterations}"
            );
        }
    }
}

/// A damper that takes next to nothing leaves the errors of explicit methods as they are: it does not hide what they make of the energy.
#[test]
fn a_weak_damper_leaves_the_error() {
    let text = std::fs::read_to_string(format!("{}/../../examples/bricard.toml", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let damper = "[force.damper]\ntype = \"torsion\"\njoint = \"p0\"\ndamping = 1e-9\n";
    let end = |text: &str, method: &str, accuracy: f64| {
        let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
        common::run(&model(text), choice, 0.1, 2.0).0.state().x.clone()
    };
    let truth = end(&text, "radau", 1e-11);
    for accuracy in [1e-6, 1e-8] {
        let found = end(&format!("{text}\n{damper}"), "ode/dopri5", accuracy);
        let error = truth.iter().zip(&found).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(error <= 10.0 * accuracy, "{accuracy:e}: {error:e} m");
    }
}

#[test]
fn accuracies_below_round_off_are_refused() {
    let resolve = |accuracy| Method::resolve(&Choice { accuracy: Some(accuracy), ..Choice::default().named("radau") });
    assert!(resolve(1e-13).is_ok());
    for accuracy in [1e-15, 0.0, -1e-6, f64::NAN, f64::INFINITY] {
        let error = resolve(accuracy).err().expect("no such accuracy").to_string();
        assert!(error.contains("1e-13"), "{error}");
    }
}

/// A block that is braked in 0.5 s and creeps then: steps of its own time, 0.5 µs, show nothing but the rounding of velocities, and get longer as
/// velocities farther apart show that they may.
#[test]
fn what_creeps_takes_long_steps() {
    let text = "plane = \"xy\"\ngravity = [0, 0]\n[body.block]\nmass = 1\ninertia = 1\nposition = [0, 0]\nvelocity = [1, 0]\n\
                [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\nat = [0, 0]\naxis = [1, 0]\n\
                [force.rub]\ntype = \"friction\"\njoint = \"rail\"\neffort = 2\nspeed = 1e-6\n\
                [force.pull]\ntype = \"effort\"\njoint = \"rail\"\neffort = 1\n";
    let model = model(text);
    let end = 0.5 + 1e-6 * 0.5_f64.atanh();
    for method in ["conserving-ggl", "conserving", "generalized-alpha"] {
        for accuracy in [1e-6, 1e-7, 1e-8, 1e-9] {
            let choice = Choice { accuracy: Some(accuracy), ..Choice::default().named(method) };
            let (simulation, recording) = common::run(&model, choice, 0.1, 2.0);
            let error = common::last(&recording, "block.x") - end;
            let size = holonom::analysis::rank(&model.system, &simulation.state().x, 2.0).size(&model.system);
            let steps = simulation.summary("test", 2.0, &Status::Completed, size).work.steps_taken;
            println!("{method}, {accuracy:e}: {steps} steps, {error:.1e} m");
            assert!(error.abs() <= 1e-11, "{method}, {accuracy:e}: {error:e} m");
            assert!(steps < 10_000, "{method}, {accuracy:e}: {steps} steps");
        }
    }
}
