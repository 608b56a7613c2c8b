//! Ropes that get slack and taut again: against arcs of vibrations and free flight, pieced together in closed form.

use holonom::model::Model;
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom_io::Source;

const G: f64 = 9.81;

/// The free length of the rope below the place where it hangs, m, and how much longer it is at the start.
const FREE: f64 = 1.0;
const STRETCH: f64 = 0.1;

/// Stiffness between that place and the bob of 1 kg, N/m.
const STIFFNESS: f64 = 400.0;

fn model(text: &str) -> Model {
    Source::read("model.toml", text.as_bytes()).and_then(|source| source.model()).unwrap_or_else(|message| panic!("{message}\n{text}"))
}

fn run(model: &Model, choice: Choice, step: f64, end: f64) -> (Simulation, Recording) {
    let method = Method::resolve(&choice).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Nothing);
    assert_eq!(simulation.run(end, &mut recorder), Status::Completed);
    (simulation, recorder.finish())
}

/// A bob below the origin on a rope with these keys.
fn hanging(keys: &str, damping: f64) -> Model {
    model(&format!(
        "[point.bob]\nmass = 1\nposition = [0, 0, {}]\n[force.rope]\ntype = \"rope\"\n{keys}\ndamping = {damping}\n",
        -(FREE + STRETCH)
    ))
}

/// The same motion: on a rope, over a sheave at the origin, and as a pulley block with two falls, in which all damping counts four times.
fn ropes(damping: f64) -> [(&'static str, Model); 3] {
    let over = format!("between = [[-1, 0, 0], \"bob\"]\nthrough = [\"ground\"]\nlength = {}\nstiffness = {STIFFNESS}", 1.0 + FREE);
    let block =
        format!("between = [\"ground\", \"ground\"]\nthrough = [\"bob\"]\nlength = {}\nstiffness = {}", 2.0 * FREE, STIFFNESS / 4.0);
    [
        ("rope", hanging(&format!("between = [\"ground\", \"bob\"]\nlength = {FREE}\nstiffness = {STIFFNESS}"), damping)),
        ("rope over a sheave", hanging(&over, damping)),
        ("pulley block", hanging(&block, damping / 4.0)),
    ]
}

/// Stretch and its rate of a taut rope after a time: c is below critical.
fn vibrate([p, v]: [f64; 2], c: f64, t: f64) -> [f64; 2] {
    let (delta, rest) = (0.5 * c, G / STIFFNESS);
    let omega = (STIFFNESS - delta * delta).sqrt();
    let (a, b) = (p - rest, (v + delta * (p - rest)) / omega);
    let (sine, cosine) = (omega * t).sin_cos();
    let envelope = (-delta * t).exp();
    let position = envelope * (a * cosine + b * sine);
    [rest + position, envelope * omega * (b * cosine - a * sine) - delta * position]
}

fn fly([p, v]: [f64; 2], t: f64) -> [f64; 2] {
    [p + v * t + 0.5 * G * t * t, v + G * t]
}

/// Stretch and its rate after `t`, from arc to arc: a rope gets slack where its tension vanishes, and taut where it has its free length.
fn exact(c: f64, t: f64) -> [f64; 2] {
    let (mut state, mut left, mut is_taut) = ([STRETCH, 0.0], t, true);
    loop {
        let arc = |t: f64| if is_taut { vibrate(state, c, t) } else { fly(state, t) };
        let goes_on = |[p, v]: [f64; 2]| if is_taut { STIFFNESS * p + c * v > 0.0 } else { p < 0.0 || v < 0.0 };
        let step = 1e-3;
        let Some(k) = (1..).take_while(|&k| f64::from(k - 1) * step < left).find(|&k| !goes_on(arc(f64::from(k) * step))) else {
            return arc(left);
        };
        let (mut low, mut high) = (f64::from(k - 1) * step, f64::from(k) * step);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if goes_on(arc(middle)) { low = middle } else { high = middle }
        }
        if high >= left {
            return arc(left);
        }
        (state, left, is_taut) = (arc(high), left - high, !is_taut);
    }
}

/// The largest difference of place and velocity from arcs.
fn difference(recording: &Recording, c: f64) -> f64 {
    let column = |name: &str| recording.column(name).unwrap_or_else(|| panic!("no {name}"));
    let (t, z, vz) = (column("t"), column("bob.z"), column("bob.vz"));
    (0..recording.rows()).fold(0.0, |worst: f64, k| {
        let [p, v] = exact(c, t[k]);
        worst.max((-z[k] - FREE - p).abs()).max((-vz[k] - v).abs())
    })
}

#[test]
fn a_bob_on_a_rope_flies_and_falls_back_into_it() {
    assert!((0..200).any(|k| exact(0.0, 0.01 * f64::from(k))[0] < -0.05), "it flies");
    for (c, bound) in [(0.0, 1e-8), (2.0, 1e-6)] {
        for (name, model) in ropes(c) {
            let choice = Choice { method: Some("radau".into()), accuracy: Some(1e-11), ..Choice::default() };
            let (_, recording) = run(&model, choice, 0.01, 2.0);
            let off = difference(&recording, c);
            println!("{name}, c = {c}: {off:e}");
            assert!(off < bound, "{name}, c = {c}: off by {off}");
        }
    }
}

#[test]
fn the_conserving_schemes_keep_the_balance_through_slack_and_taut() {
    for method in ["conserving-ggl", "conserving"] {
        for c in [0.0, 2.0] {
            for (name, model) in ropes(c) {
                let errors = [4e-3, 1e-3].map(|step| {
                    let choice = Choice { method: Some(method.into()), ..Choice::default() };
                    let (simulation, recording) = run(&model, choice, step, 2.0);
                    let energy = simulation.audit().energy_summary();
                    assert!(energy.max_drift < 1e-12, "{name}, {method}, c = {c}: {} J", energy.max_drift);
                    difference(&recording, c)
                });
                println!("{name}, {method}, c = {c}: {errors:?}");
                assert!(errors[1] < 2e-3 && errors[1] < 0.1 * errors[0], "{name}, {method}, c = {c}: off by {errors:?}");
            }
        }
    }
}

#[test]
fn a_slack_rope_does_nothing_and_a_taut_one_only_pulls() {
    for (name, model) in ropes(4.0) {
        let (_, recording) = run(&model, Choice::default(), 1e-3, 2.0);
        let column = |suffix: &str| recording.column(&format!("rope.{suffix}")).unwrap_or_else(|| panic!("no {suffix}"));
        let (length, force, power) = (column("length"), column("force"), column("power"));
        let free = match name {
            "rope" => FREE,
            "rope over a sheave" => 1.0 + FREE,
            _ => 2.0 * FREE,
        };
        let slack = (0..recording.rows()).filter(|&k| length[k] < free).inspect(|&k| assert_eq!([force[k], power[k]], [0.0; 2], "{name}"));
        assert!(slack.count() > 50, "{name} gets slack");
        assert!(force.iter().all(|&force| force >= 0.0), "{name} pushes");
    }
}

/// Sheaves on bodies that move, in the plane and in space, far from the origin too: the same force along all stretches, so that momenta stay.
#[test]
fn ropes_between_bodies_keep_energy_and_momenta() {
    for (plane, far, turn) in [("plane = \"xy\"\n", 0.0, ""), ("", 0.0, ", 0.3"), ("", 1e5, ", 0.3")] {
        let three = |x: f64, y: f64| if plane.is_empty() { format!("[{}, {y}, 0.1]", x + far) } else { format!("[{x}, {y}]") };
        let gravity = if plane.is_empty() { "[0, 0, 0]" } else { "[0, 0]" };
        let spin = if plane.is_empty() { format!("[0.5{turn}, -1]") } else { "-1".into() };
        let lugs = if plane.is_empty() { "a = [0.2, 0, 0], b = [-0.2, 0.1, 0.05]" } else { "a = [0.2, 0], b = [-0.2, 0.1]" };
        let text = format!(
            "{plane}gravity = {gravity}\n\
             [body.A]\nshape = {{ box = [0.4, 0.2, 0.1] }}\nmass = 2\nposition = {}\nangular_velocity = {spin}\npoints = {{ {lugs} }}\n\
             [body.B]\nshape = {{ box = [0.4, 0.2, 0.1] }}\nmass = 1\nposition = {}\npoints = {{ {lugs} }}\n\
             [point.P]\nmass = 0.5\nposition = {}\nvelocity = {}\n\
             [force.rope]\ntype = \"rope\"\nbetween = [\"A.a\", \"P\"]\nthrough = [\"B.a\", \"B.b\", \"A.b\", \"B.a\"]\nlength = 4\nstiffness = 50\n",
            three(0.0, 0.0),
            three(1.0, 0.2),
            three(0.3, 1.0),
            if plane.is_empty() { "[0, 3, 1]" } else { "[0, 3]" },
        );
        let (simulation, recording) = run(&model(&text), Choice::default(), 2e-3, 4.0);
        let force = recording.column("rope.force").unwrap();
        assert!(force.contains(&0.0) && force.iter().any(|&force| force > 1.0), "it gets taut and slack");
        let (energy, momentum) = (simulation.audit().energy_summary(), simulation.audit().momentum_summary());
        println!("{far}: {} {} {}", energy.max_drift, momentum.linear_drift, momentum.angular_drift);
        assert!(energy.max_drift < 1e-10 && momentum.linear_drift < 1e-10 && momentum.angular_drift < 1e-9 * (1.0 + far));
    }
}
