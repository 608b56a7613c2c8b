//! Hard mechanisms, that runs once completed with wrong: light parts between heavy ones, thin rods, what hardly moves. `benches/hard` runs more of
//! them beside solutions of its own.

mod common;

use common::{CONSERVING, complete, coordinates, freedom, method, model};
use holonom::simulation::{Promise, Simulation, Status, Verdict};

/// Points in a row from the ground, released level in the plane.
fn row(masses: &[f64], length: f64) -> String {
    let mut text = "plane = \"xz\"\ngravity = [0, -9.81]\n".to_string();
    for (k, mass) in masses.iter().enumerate() {
        let (x, before) = (length * (k + 1) as f64, if k == 0 { "ground".into() } else { format!("p{}", k - 1) });
        text += &format!("[point.p{k}]\nmass = {mass}\nposition = [{x}, 0]\n");
        text += &format!("[constraint.r{k}]\ntype = \"distance\"\nbetween = [\"{before}\", \"p{k}\"]\n");
    }
    text
}

/// Energies are of the size of the heavy part's, 1 kg over 1 m.
#[test]
fn light_parts_between_heavy_ones_keep_the_energy() {
    let rows = [1e-2, 1e-3, 1e-5, 1e-7, 1e-9].map(|m| vec![m, m, 1.0]);
    let alternating = [1e-3, 1e-6].map(|m| vec![m, 1.0, m, 1.0]);
    let hanging = [1e-6, 1e-9].map(|m| vec![1.0, m, m]);
    for masses in rows.iter().chain(&alternating).chain(&hanging) {
        let model = model(&row(masses, 1.0 / masses.len() as f64));
        for of in CONSERVING {
            let summary = complete(&format!("{masses:?}"), &model, of, 0.01, 1.0);
            let (drift, rate) = (summary.energy.max_drift, summary.violation.velocity);
            println!("{masses:?}, {of}: drift {drift:.1e} J, {:.1} iterations", summary.work.iterations_per_step);
            assert!(drift <= 1e-10 * 9.81, "{masses:?}, {of}: drift {drift:e}");
            assert!(of == "conserving" || rate <= 1e-11, "{masses:?}: rates of rows {rate:e}");
            assert!(summary.violation.position <= 1e-14, "{masses:?}, {of}");
            assert_eq!([summary.size.dof, summary.size.redundant], [masses.len(), 0], "{masses:?}");
        }
    }
}

/// Two hinged rods with so much of their inertia about themselves: the motion is that of rods without any.
#[test]
fn thin_rods_move_like_rods_without_thickness() {
    let rods = |share: f64| {
        let mut text = "gravity = [0, 0, -9.81]\n".to_string();
        for (k, before) in ["ground", "b0"].iter().enumerate() {
            let i = 1.0 / 12.0;
            text += &format!("[body.b{k}]\nmass = 1\ninertia = [{}, {i}, {i}]\nposition = [{}, 0, 0]\n", share * i, k as f64 + 0.5);
            text += &format!("[joint.j{k}]\ntype = \"revolute\"\nbetween = [\"{before}\", \"b{k}\"]\nat = [{k}, 0, 0]\naxis = [0, 1, 0]\n");
        }
        text
    };
    for of in ["conserving-ggl", "conserving", "radau"] {
        let mut limit = None;
        for share in [0.0, 1e-12, 1e-9, 1e-7, 1e-4] {
            let model = model(&rods(share));
            assert_eq!(freedom(&model), [2, 0], "{share:e}");
            let mut simulation =
                Simulation::new(model.system.clone(), method(of), 0.01).unwrap_or_else(|error| panic!("{share:e}: {error}"));
            assert_eq!(simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn), Status::Completed, "{share:e}, {of}");
            let kinetic = simulation.audit().kinetic;
            let first = *limit.get_or_insert(kinetic);
            assert!((kinetic - first).abs() <= 1e-9 * first, "{share:e}, {of}: kinetic energy {kinetic} J beside {first} J");
        }
    }
}

/// A cart of 10 kg on a rail down a slope of 0.3 rad, with a wheel of no weight to speak of: both follow from the constant
/// acceleration. With reactions two rows are redundant, whose multipliers are round-off and more than the wheel's forces.
#[test]
fn a_light_wheel_rolls_as_far_as_its_cart_goes() {
    let (slope, radius, end) = (0.3_f64, 0.2, 0.4);
    for mass in [1e-3, 1e-6, 1e-9] {
        for reactions in [false, true] {
            let moment = 0.25 * mass * radius * radius;
            let text = format!(
                "gravity = [{}, 0, {}]\n[output]\nreactions = {reactions}\n\
                 [body.cart]\nmass = 10\ninertia = [0.2, 0.4, 0.5]\nposition = [0, 1, {radius}]\n\
                 [body.wheel]\nmass = {mass}\ninertia = [{moment}, {}, {moment}]\nposition = [0, 0, {radius}]\naxes = {{ axle = [0, 1, 0] }}\n\
                 [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"cart\"]\naxis = [1, 0, 0]\n\
                 [joint.axle]\ntype = \"revolute\"\nbetween = [\"cart\", \"wheel\"]\nat = [0, 0, {radius}]\naxis = [0, 1, 0]\n\
                 [joint.road]\ntype = \"rolling\"\nbetween = [\"ground\", \"wheel\"]\nat = [0, 0, {radius}]\naxis = \"wheel.axle\"\n\
                 normal = [0, 0, 1]\nradius = {radius}\n",
                9.81 * slope.sin(),
                -9.81 * slope.cos(),
                2.0 * moment,
            );
            let model = model(&text);
            let truth = 0.5 * 9.81 * slope.sin() * (10.0 + mass) / (10.0 + 1.5 * mass) * end * end / radius;
            // Between two positions a turn of δ is taken for 2 tan(δ/2): δ²/12 of it more, with up to 0.029 rad a step.
            for (of, order) in [("conserving-ggl", 1e-4), ("conserving", 1e-4), ("radau", 1e-10)] {
                let found = coordinates(&model, of, 0.005, end);
                let angle = found.iter().find(|(name, _)| name == "axle.angle").expect("the angle of the axle is measured").1;
                assert!((angle - truth).abs() <= order, "{mass:e} kg, reactions {reactions}, {of}: {angle} rad for {truth}");
            }
        }
    }
}

/// Light parts that whip about are solved in thousands of parts of a step. Once a part of 4e-15 s was left over, whose rounded positions made
/// 5e-5 J, and it took until 17 s to come.
#[test]
fn light_parts_that_whip_about_keep_the_energy_for_long() {
    for (count, mass) in [(3, 1e-7), (10, 1e-5)] {
        let masses: Vec<f64> = (0..count).map(|k| if k + 1 < count { mass } else { 1.0 }).collect();
        let summary = complete("whip", &model(&row(&masses, 1.0 / count as f64)), "conserving", 0.005, 20.0);
        let (drift, halved) = (summary.energy.max_drift, summary.work.rejected_steps);
        println!("{count} links, {mass:e} kg: drift {drift:.1e} J, {halved} steps in halves");
        assert!(halved > 100, "{count} links: {halved} steps in halves are no test");
        assert!(drift <= 1e-10 * 9.81, "{count} links, {mass:e} kg: drift {drift:e}");
    }
}

/// What trembles faster than the steps of a method that keeps no energy makes energy of nothing: 1e8 J and 18 J once, and `completed`.
#[test]
fn energy_that_nothing_supplied_ends_a_run() {
    for (masses, of, step) in [(&[1e-7, 1e-7, 1.0][..], "generalized-alpha", 0.001), (&[1e-9, 1.0], "trapezoidal-projected", 0.005)] {
        let model = model(&row(masses, 1.0 / masses.len() as f64));
        let mut simulation = Simulation::new(model.system.clone(), method(of), step).unwrap_or_else(|error| panic!("{of}: {error}"));
        let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
        let Status::Stopped { reason, .. } = &status else { panic!("{of}: {status:?}") };
        assert!(reason.contains("came from nothing"), "{of}: {reason}");
    }
}

#[test]
fn methods_say_what_they_keep() {
    let kept = |name: &str| method(name).promises().into_iter().map(Promise::words).collect::<Vec<_>>().join(", ");
    assert_eq!(kept("conserving-ggl"), "energy, momenta, Φ, Φ̇");
    assert_eq!(kept("conserving"), "energy, momenta, Φ");
    assert_eq!(kept("conserving-projected"), "energy that never rises, momenta, Φ, Φ̇");
    assert_eq!(kept("trapezoidal-projected"), "energy that something supplies, Φ, Φ̇, Φ̈");
    assert_eq!(kept("trapezoidal"), "Φ");
    assert_eq!(kept("radau"), "energy that something supplies, Φ, Φ̇");
    assert_eq!(kept("penalty/conserving"), "energy that something supplies");
}

/// Where hardly anything moves, energies are smaller than what a torque does along a rounded angle.
#[test]
fn arms_pass_through_rest_under_small_torques() {
    let arm = |efforts: [&str; 2]| {
        model(&format!(
            "plane = \"xy\"\ngravity = [0, 0]\n\
             [body.a]\nmass = 2\ninertia = 0.1\nposition = [0.25, 0]\n[body.b]\nmass = 1\ninertia = 0.05\nposition = [0.75, 0]\n\
             [joint.p]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
             [joint.q]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [0.5, 0]\n\
             [force.m]\ntype = \"effort\"\njoint = \"p\"\neffort = \"{}\"\n[force.n]\ntype = \"effort\"\njoint = \"q\"\neffort = \"{}\"\n",
            efforts[0], efforts[1]
        ))
    };
    let cases = [["-1e-4*p.angle - 8e-7", "3e-4*cos(4*t)"], ["8e-7", "0"], ["40*(1e-6*sin(t) - p.angle) - 6*p.angle_rate", "-q.angle"]];
    for efforts in cases {
        for of in ["conserving-ggl", "conserving", "conserving-projected"] {
            complete(&format!("{efforts:?}"), &arm(efforts), of, 0.01, 5.0);
        }
    }
}

/// A drive brings a balanced wheel to rest, ever more slowly: what rounded places are to its velocity is then far more than a share of its energy.
#[test]
fn drives_come_to_rest() {
    for profile in ["0.5*(tanh(10*(t - 1)) + tanh(10))", "1 - (1 + 8*t)*exp(-8*t)", "1/(1 + exp(-20*(t - 0.5)))", "0.3*(1 - exp(-6*t^2))"] {
        for mass in [1e-3, 1.0, 1e3] {
            let text = format!(
                "plane = \"xy\"\n[body.b]\nmass = {mass}\ninertia = 1\nposition = [0, 0]\n[joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"b\"]\n\
                 at = [0, 0]\n[drive.d]\ntype = \"angle\"\njoint = \"j\"\nprofile = \"{profile}\"\n"
            );
            for of in ["conserving-ggl", "conserving", "conserving-projected"] {
                complete(profile, &model(&text), of, 0.01, 3.0);
            }
        }
    }
}

/// Two links with springs under a load that follows the last, below the load at which they flutter, hardly bent: what the load does along
/// the rounding of places is far more than what moves.
#[test]
fn a_loaded_column_swings_by_next_to_nothing() {
    for (x, angle) in [(0.0, 1e-5), (0.0, 1e-7), (1e4, 1e-3)] {
        let text = format!(
            "plane = \"xz\"\ngravity = [0, 0]\n\
             [body.a]\nmass = 2\ncom = [0.5, 0]\ninertia = 1e-6\nposition = [{}, 0]\n\
             [body.b]\nmass = 1\ncom = [0.5, 0]\ninertia = 1e-6\nposition = [{}, 0]\npoints = {{ end = [0.5, 0] }}\n\
             [joint.h]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [{x}, 0]\n\
             [joint.k]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [{}, 0]\n\
             [force.spring-h]\ntype = \"torsion\"\njoint = \"h\"\nstiffness = 1\n[force.spring-k]\ntype = \"torsion\"\njoint = \"k\"\nstiffness = 1\n\
             [force.P]\ntype = \"force\"\nbody = \"b\"\nat = \"b.end\"\naxes = \"body\"\nforce = [-1.9, 0]\n[start.h]\nangle = {angle}\n",
            x + 0.5,
            x + 1.5,
            x + 1.0
        );
        for of in CONSERVING {
            let summary = complete("column", &model(&text), of, 0.02, 20.0);
            assert!(summary.energy.max_drift < 1e-12 * 1.9, "{of} at {x}: {:e}", summary.energy.max_drift);
        }
    }
}
