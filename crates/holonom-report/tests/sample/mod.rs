//! Synthetic runs: the spherical compound pendulum, integrated here in the plainest way, with made-up errors.
#![allow(dead_code)] // each test uses its share

pub mod bodies;

use holonom::record::{Anchor, Heading, Line, LineKind, PointKind, Recording, Scene, ScenePoint};
use serde_json::{Value, json};

const GRAVITY: f64 = 9.81;
const LENGTHS: [f64; 2] = [1.0, 2.0];

/// What `Run` borrows.
pub struct Sample {
    pub label: String,
    pub recording: Recording,
    pub scene: Scene,
    pub summary: Value,
}

/// `size` scales the made-up errors and how fast energy gets lost.
pub fn pendulum(label: &str, step: f64, steps: usize, size: f64) -> Sample {
    let recording = recording(step, steps, size);
    let scene = scene();
    let summary = summary(label, step, steps, &recording);
    Sample { label: label.to_owned(), recording, scene, summary }
}

/// The slider with last rows as a run leaves them that blew up.
pub fn blown_up() -> Sample {
    let mut sample = slider();
    for (i, value) in [1e30, 1e300, f64::INFINITY, f64::NAN].into_iter().enumerate() {
        sample.recording.push(&[3.0 + 0.01 * i as f64, value, value, value, value, value, value]);
    }
    sample
}

/// A run that stopped before its first row, of a model without points.
pub fn empty() -> Sample {
    let mut sample = slider();
    sample.recording = Recording::new(["t", "energy", "phi"].map(str::to_owned));
    sample.scene = Scene { axes: "xyz".to_owned(), ..Scene::default() };
    sample
}

/// A column of a run as it was measured from a time (s) on: every third row of it, a little off, and nothing else.
pub fn measured(run: &Sample, column: &str, from: f64) -> Sample {
    let heading = run.recording.find(column).unwrap().heading.clone();
    let mut recording = Recording::new([Heading::from("t".to_owned()), heading]);
    let (times, values) = (run.recording.column("t").unwrap(), run.recording.column(column).unwrap());
    let rows = times.iter().zip(values).filter(|(t, _)| **t >= from);
    rows.step_by(3).for_each(|(&t, &value)| recording.push(&[t, 1.02 * value + 0.01]));
    let scene = Scene { axes: run.scene.axes.clone(), ..Scene::default() };
    let summary = json!({"label": "measured", "model": "measured", "status": "measured", "rows": recording.rows()});
    Sample { label: "measured".to_owned(), recording, scene, summary }
}

/// The slider with a motor, of which effort, power and angle are recorded, and a measure without a unit; it completes.
pub fn motor() -> Sample {
    motor_of(1.0)
}

/// The same with so many times the effort and the energy.
pub fn motor_of(unit: f64) -> Sample {
    let mut sample = slider();
    let heading =
        |name: &str, unit: &'static str, meaning: &str| Heading { name: name.to_owned(), unit: unit.into(), meaning: meaning.into() };
    let own = sample.recording.columns().iter().map(|column| column.heading.clone());
    let others = [
        heading("crank.effort", "N·m", "moment that the drive exerts along its motion"),
        heading("crank.power", "W", "power that the drive gives to the mechanism"),
        heading("hinge.angle", "rad", "angle, from the start"),
        heading("lift", "1", "t*(3 - t)/2"),
    ];
    let mut recording = Recording::new(own.chain(others));
    for row in 0..sample.recording.rows() {
        let mut values: Vec<f64> = sample.recording.columns().iter().map(|column| column.values[row]).collect();
        let t = values[0];
        values[1] *= unit;
        values.extend([unit * 2.0 * t.sin(), 2.0 * t.sin() * 0.3, 0.3 * t, 0.5 * t * (3.0 - t)]);
        recording.push(&values);
    }
    sample.recording = recording;
    sample.summary["peaks"] =
        json!({"measures": [{"name": "lift", "unit": "1", "min": 0.0, "min_at": 0.0, "max": 1.125, "max_at": 1.5, "last": 0.01495}]});
    sample.summary["status"] = json!("completed");
    sample.summary["stopped_at"] = json!(null);
    sample.summary["reason"] = json!(null);
    sample
}

/// A planar slider on a spring, which stops early.
pub fn slider() -> Sample {
    let names = ["t", "energy", "phi", "block.x", "block.z", "block.vx", "block.vz"];
    let mut recording = Recording::new(names.map(str::to_owned));
    for i in 0..300 {
        let t = 0.01 * i as f64;
        let x = 1.0 + 0.4 * (5.0 * t).sin();
        recording.push(&[t, 1.0, 0.0, x, 0.0, 2.0 * (5.0 * t).cos(), 0.0]);
    }
    let line = |name: &str, kind, from| Line { name: name.to_owned(), kind, from: Anchor::Fixed(from), to: point("block"), along: None };
    let scene = Scene {
        axes: "xz".to_owned(),
        gravity: [0.0, 0.0, -GRAVITY],
        points: vec![ScenePoint { name: "block".to_owned(), kind: PointKind::Free, mass: 1.0 }],
        lines: vec![line("spring", LineKind::Spring, [0.0; 3]), line("rail", LineKind::Guide, [2.0, 0.0, 0.0])],
        ..Scene::default()
    };
    let summary = json!({
        "model": "Slider", "method": {"name": "baumgarte"}, "status": "stopped", "stopped_at": 2.99,
        "reason": "the iteration did not converge", "step": 0.01, "end": 20.0, "steps": 299, "dof": 1, "redundant": 0,
    });
    Sample { label: "baumgarte".to_owned(), recording, scene, summary }
}

fn point(name: &str) -> Anchor {
    Anchor::Point(name.to_owned())
}

fn scene() -> Scene {
    let mass = |name: &str| ScenePoint { name: name.to_owned(), kind: PointKind::Free, mass: 1.0 };
    let line = |name: &str, kind, from, to| Line { name: name.to_owned(), kind, from, to, along: None };
    Scene {
        axes: "xyz".to_owned(),
        gravity: [0.0, 0.0, -GRAVITY],
        points: vec![mass("m1"), mass("m2")],
        lines: vec![
            line("inner-rod", LineKind::Rod, Anchor::Fixed([0.0; 3]), point("m1")),
            line("outer-rod", LineKind::Rod, point("m1"), point("m2")),
            line("straight", LineKind::Guide, Anchor::Fixed([0.0; 3]), point("m2")),
        ],
        ..Scene::default()
    }
}

fn recording(step: f64, steps: usize, size: f64) -> Recording {
    let columns = "t energy kinetic potential work dE_integrator dE_projection phi phi_dot phi_ddot iterations";
    let axes = ["x", "y", "z", "vx", "vy", "vz"];
    let points = ["m1", "m2"].into_iter().flat_map(|name| axes.map(|axis| format!("{name}.{axis}")));
    let mut recording = Recording::new(columns.split(' ').map(str::to_owned).chain(points));
    let (mut direction, mut rate, mut lost) = ([1.0, 0.0, 0.0], [0.0, 0.5, 0.0], 0.0);
    for i in 0..=steps {
        let t = step * i as f64;
        let kinetic: f64 = LENGTHS.iter().map(|l| 0.5 * l * l * dot(rate, rate)).sum();
        let potential: f64 = LENGTHS.iter().map(|l| GRAVITY * l * direction[2]).sum();
        let wave = (3.0 * t).sin();
        let loss = if i == 0 { 0.0 } else { size * 1e-6 * (1.0 + wave) };
        lost += loss;
        let noise = if i == 0 { 0.0 } else { size * 1e-13 * (1.2 + (17.0 * t).sin()) };
        let iterations = if i == 0 { 0.0 } else { 2.0 + f64::from(u8::from(wave > 0.8)) };
        let mut row = vec![t, kinetic + potential - lost, kinetic, potential - lost, 0.0];
        row.extend([2.0 * loss * wave, -loss - 2.0 * loss * wave, noise, 8.0 * noise, size * 3e-6 * (1.1 + wave), iterations]);
        row.extend(LENGTHS.iter().flat_map(|l| direction.map(|x| l * x).into_iter().chain(rate.map(|v| l * v))));
        recording.push(&row);
        (direction, rate) = advance(direction, rate, step);
    }
    recording
}

/// Small explicit steps with the length corrected after each.
fn advance(mut direction: [f64; 3], mut rate: [f64; 3], step: f64) -> ([f64; 3], [f64; 3]) {
    // Gravity on both masses over their moment of inertia about the origin.
    let pull = GRAVITY * LENGTHS.iter().sum::<f64>() / LENGTHS.iter().map(|l| l * l).sum::<f64>();
    let small = step / 200.0;
    for _ in 0..200 {
        let along = pull * direction[2] - dot(rate, rate);
        let acceleration = [along * direction[0], along * direction[1], along * direction[2] - pull];
        for i in 0..3 {
            rate[i] += small * acceleration[i];
            direction[i] += small * rate[i];
        }
        let length = dot(direction, direction).sqrt();
        direction = direction.map(|x| x / length);
    }
    (direction, rate)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

fn summary(method: &str, step: f64, steps: usize, recording: &Recording) -> Value {
    let most = |name: &str| recording.column(name).unwrap().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
    let energy = recording.column("energy").unwrap();
    let (first, last) = (energy[0], energy[steps]);
    json!({
        "model": "Spherical compound pendulum",
        "method": {
            "name": method, "formulation": "ggl", "index": 2, "integrator": "energy-conserving", "iteration": "newton",
            "projection": {"levels": ["velocity", "acceleration"], "matrix": "mass", "solve": "exact"},
        },
        "status": "completed", "stopped_at": null, "reason": null,
        "step": step, "end": step * steps as f64, "steps": steps,
        "coordinates": 6, "constraints": 5, "rank": 4, "redundant": 1, "dof": 2,
        "energy": {
            "initial": first, "final": last, "max_drift": first - last, "max_rise": 0.0,
            "integrator_total": 1.2e-4, "projection_total": -1.2e-4, "work_total": 0.0, "audit_residual": 2.1e-14,
        },
        "momentum": {"linear_drift": 0.0, "angular_drift": 3.2e-13},
        "violation": {"position": most("phi"), "velocity": most("phi_dot"), "acceleration": most("phi_ddot")},
        "work": {"iterations": 1720, "iterations_per_step": 2.15, "factorizations": 1720, "rejected_steps": 0},
        "time": {"cpu_s": 0.0104, "us_per_step": 12.96, "realtime_factor": 1923.1},
    })
}
