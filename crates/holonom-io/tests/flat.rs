//! Motions through positions in which all parts lie in a line, and from them, where rows become redundant.

mod common;

use common::{CONSERVING, complete, method, model};
use holonom::simulation::{Choice, Simulation, Status, Verdict};

/// A beam on `links` equal links, all in a line at the start: all but two of the links are redundant.
fn flattened(links: usize) -> String {
    let mut text = "plane = \"xy\"\ngravity = [0, -9.81]\n".to_string();
    let bar = |name: String, a: String, b: String, mass: f64| format!("[bar.{name}]\nbetween = [\"{a}\", \"{b}\"]\nmass = {mass}\n");
    for k in 0..links {
        text += &format!("[point.G{k}]\nposition = [{k}, 0]\nfixed = true\n");
        text += &format!("[point.P{k}]\nposition = [{}, 0]\nvelocity = [0, 3]\n", k + 1);
        text += &bar(format!("link{k}"), format!("G{k}"), format!("P{k}"), 1.0);
        if k > 0 {
            text += &bar(format!("beam{k}"), format!("P{}", k - 1), format!("P{k}"), 10.0);
        }
    }
    text
}

/// 4.5 J for each link, and 90 J for each beam.
#[test]
fn parallelograms_go_through_their_dead_centres() {
    for links in [2, 4, 8, 11, 20] {
        let model = model(&flattened(links));
        for of in ["conserving-ggl", "conserving", "conserving-projected"] {
            let summary = complete(&format!("{links} links"), &model, of, 1e-3, 2.5);
            let (energy, scale) = (&summary.energy, 50.0 * links as f64);
            let off = if of == "conserving-projected" { energy.max_rise } else { energy.max_drift };
            println!("{links} links, {of}: {off:.1e} J of {scale} J");
            assert!(off <= 1e-10 * scale, "{links} links, {of}: {off:e}");
        }
    }
}

/// Links half a metre apart and a coupler, all bodies, at 60 degrees and on their way down.
fn parallelogram(links: u32) -> String {
    let ((s, c), length) = (std::f64::consts::FRAC_PI_3.sin_cos(), 0.5 * f64::from(links - 1));
    let mut text = format!(
        "plane = \"xy\"\ngravity = [0, 0]\n[body.coupler]\nmass = 1\ninertia = {}\nposition = [{}, {s}]\nvelocity = [{s}, {}]\n",
        length * length / 12.0,
        0.5 * length + c,
        -c
    );
    for k in 0..links {
        let x = 0.5 * f64::from(k);
        text += &format!(
            "[body.link{k}]\nmass = 1\ninertia = {}\nposition = [{}, {}]\norientation = {{ angle = {} }}\nvelocity = [{}, {}]\n\
             angular_velocity = -1\n[joint.foot{k}]\ntype = \"revolute\"\nbetween = [\"ground\", \"link{k}\"]\nat = [{x}, 0]\n\
             [joint.head{k}]\ntype = \"revolute\"\nbetween = [\"link{k}\", \"coupler\"]\nat = [{}, {s}]\n",
            1.0 / 12.0,
            x + 0.5 * c,
            0.5 * s,
            std::f64::consts::FRAC_PI_3,
            0.5 * s,
            -0.5 * c,
            x + c
        );
    }
    text
}

/// All but two of the links are redundant. Beside the flat position rows that hold much of it come after some that hold hardly anything.
#[test]
fn many_links_of_bodies_go_through_flat_positions() {
    for links in [3, 8, 12, 20, 33] {
        for of in ["conserving", "conserving-ggl"] {
            let energy = complete(&format!("{links} links"), &model(&parallelogram(links)), of, 1e-3, 5.0).energy;
            println!("{links} links, {of}: drift {:.1e} J of {:.3} J", energy.max_drift, energy.initial);
            assert!(energy.max_drift < 1e-11 * energy.initial, "{links} links, {of}: {:e} J", energy.max_drift);
        }
    }
}

/// Four links and a coupler go flat twice: two of nine rows are redundant, and beside the flat position their rates
/// are off by the rounding of positions over the angle. The angle is ωt.
#[test]
fn a_parallelogram_of_bodies_goes_through_flat_positions() {
    let model = model(&parallelogram(4));
    for of in ["conserving-ggl", "conserving"] {
        for step in [0.01, 0.005, 0.001] {
            let mut simulation = Simulation::new(model.system.clone(), method(of), step).unwrap();
            assert_eq!(simulation.run(5.0, &mut |_: &Simulation| Verdict::GoOn), Status::Completed, "{of}, {step} s");
            let summary = simulation.audit().energy_summary();
            let x = model.bodies[0].recorded.place(&model.system.in_world(&simulation.state().x), 2);
            let off = (x[0] - 0.75 - (std::f64::consts::FRAC_PI_3 - 5.0).cos()).abs();
            println!("{of}, {step} s: drift {:.1e} J of {:.3} J, {off:.1e} m off", summary.max_drift, summary.initial);
            assert!(summary.max_drift < 1e-8 && off < step * step, "{of}, {step} s: {:.1e} J, {off:.1e} m", summary.max_drift);
        }
    }
}

/// An arm and a slider on a rod, all in a line and moving across it as neither way out of it does: they bounce, with forces that grow as
/// the increments of the step fall by little more than half. An iteration that took that for the end left 4e-6 J of 11 J.
#[test]
fn what_bounces_at_a_singular_position_keeps_the_energy() {
    let text = r#"
gravity = [0, 0, -9.81]
[body.slider]
mass = 12
position = [-4, 0, 0]
velocity = [0, 0.14, 0.14]
angular_velocity = [-0.09, 0.035, -0.037]
orientation = { axis = [1, 2, 3], angle = 1 }
shape = { box = [4, 1, 2] }
[joint.guide]
type = "prismatic"
between = ["ground", "slider"]
at = [-10, 0, 0]
axis = [0, 0.9, 0.45]
[body.arm]
mass = 11
position = [20, 0, 0]
velocity = [0, -0.73, -0.7]
angular_velocity = [-0.09, 0.035, -0.037]
shape = { box = [6, 3, 3] }
[joint.pivot]
type = "spherical"
between = ["ground", "arm"]
at = [14, 0, 0]
[joint.rod]
type = "distance"
between = ["arm", "slider"]
at = [[-15, 0, 0], [-7, 0, 0]]
[output]
reactions = true
"#;
    let model = model(text);
    for of in CONSERVING {
        let drift = complete("bounce", &model, of, 0.017, 0.85).energy.max_drift;
        println!("{of}: drift {drift:.1e} J");
        assert!(drift <= 2e-8, "{of}: drift {drift:e} J");
    }
}

/// Two windows of bodies whose middle upright is light fall through the positions in which all lie in a line, with and without shared nodes: all uprights
/// turn alike, with θ¨ Σ(m/3 + M) = g Σ(m/2 + M) sin θ. What rows hardly hold there is rounded by more, in velocities too.
#[test]
fn windows_with_a_light_upright_pass_through_a_line() {
    let (start, rate, end) = (0.2_f64, 2.0, 1.0_f64);
    for light in [1.0, 1e-1, 1e-2] {
        let uprights = [1.0, light, 1.0];
        let mut text = String::from("plane = \"xy\"\ngravity = [0, -9.81]\n");
        let (sin, cos) = start.sin_cos();
        let mut body = |name: String, mass: f64, [x, y]: [f64; 2], [vx, vy]: [f64; 2], spin: f64| {
            text += &format!("[body.{name}]\nmass = {mass}\ninertia = {}\nposition = [{x}, {y}]\nvelocity = [{vx}, {vy}]\n", mass / 12.0);
            text += &format!("angular_velocity = {spin}\n");
        };
        for (k, mass) in uprights.into_iter().enumerate() {
            let (x, half) = (k as f64, [0.5 * cos * rate, -0.5 * sin * rate]);
            body(format!("v{k}"), mass, [x + 0.5 * sin, 0.5 * cos], half, -rate);
            if k < 2 {
                body(format!("h{k}"), 1.0, [x + 0.5 + sin, cos], [cos * rate, -sin * rate], 0.0);
            }
        }
        let mut joint = |name: String, first: String, second: String, [x, y]: [f64; 2]| {
            text += &format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [\"{first}\", \"{second}\"]\nat = [{x}, {y}]\n");
        };
        for k in 0..3 {
            joint(format!("g{k}"), "ground".into(), format!("v{k}"), [k as f64, 0.0]);
        }
        for k in 0..2 {
            joint(format!("a{k}"), format!("v{k}"), format!("h{k}"), [k as f64 + sin, cos]);
            joint(format!("b{k}"), format!("h{k}"), format!("v{}", k + 1), [k as f64 + 1.0 + sin, cos]);
        }
        let inertia = uprights.iter().sum::<f64>() / 3.0 + 2.0;
        let weight = 9.81 * (0.5 * uprights.iter().sum::<f64>() + 2.0);
        let (mut angle, mut speed, h) = (start, rate, 1e-5);
        for _ in 0..(end / h).round() as u32 {
            // Störmer's rule: order 2, with steps of a fiftieth of the shortest below.
            let middle = speed + 0.5 * h * weight / inertia * f64::sin(angle);
            angle += h * middle;
            speed = middle + 0.5 * h * weight / inertia * f64::sin(angle);
        }
        for reactions in [false, true] {
            let model = model(&format!("{text}[output]\nreactions = {reactions}\n"));
            for step in [2e-3, 5e-4] {
                let (simulation, recording) = common::run(&model, Choice::default(), step, end);
                let turned = -common::last(&recording, "g0.angle");
                let drift = simulation.audit().energy_summary().max_drift;
                let error = (turned - (angle - start)).abs();
                assert!(error < 20.0 * step * step && drift < 1e-9 * weight, "{light} kg, {reactions}, {step} s: {error} rad, {drift:e} J");
            }
        }
    }
}
