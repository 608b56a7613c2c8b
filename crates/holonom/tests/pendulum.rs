//! The paper's spherical compound pendulum (§7), against the figures of an independent implementation.

use holonom::simulation::{Choice, Method, ProjectionChoice, Simulation, Status, Verdict};
use holonom::system::{Place, System, SystemBuilder};

/// Two particles on a straight rod, horizontal at the start, turning at 0.5 rad/s (V0 of the benchmark).
fn pendulum() -> System {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let m1 = Place::Node(builder.free_node([1.0, 0.0, 0.0], [0.0, 0.5, 0.0]));
    let m2 = Place::Node(builder.free_node([2.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    builder.mass(m1, m1, 1.0);
    builder.mass(m2, m2, 1.0);
    let inner = builder.square(&[(m1, 1.0)]);
    let outer = builder.square(&[(m2, 1.0), (m1, -1.0)]);
    builder.constant_row("inner", inner, 0.5);
    builder.constant_row("outer", outer, 0.5);
    for c in 0..3 {
        let mut e = [0.0; 3];
        e[c] = 1.0;
        let straight = builder.cross(e, &[(m1, 1.0)], &[(m2, 1.0), (m1, -1.0)]);
        builder.constant_row(format!("straight[{c}]"), straight, 0.0);
    }
    builder.build()
}

fn named(name: &str) -> Choice {
    Choice { method: Some(name.into()), ..Choice::default() }
}

struct Run {
    status: Status,
    rows: Vec<[f64; 5]>,
    position: Vec<f64>,
    iterations: f64,
    momentum: f64,
    rise: f64,
    audit: f64,
}

fn run(choice: &Choice, step: f64, end: f64) -> Run {
    let system = pendulum();
    let mut simulation = Simulation::new(&system, Method::resolve(choice).unwrap(), step).unwrap();
    let mut rows = Vec::new();
    let mut observer = |s: &Simulation<'_>| {
        let audit = s.audit();
        rows.push([s.state().t, audit.energy() - 0.625, audit.phi, audit.phi_dot, audit.phi_ddot]);
        Verdict::GoOn
    };
    let status = simulation.run(end, &mut observer);
    let energy = simulation.audit().energy_summary();
    Run {
        status,
        rows,
        position: simulation.state().x.clone(),
        iterations: simulation.audit().work_summary(simulation.steps()).iterations_per_step,
        momentum: simulation.audit().momentum_summary().angular_drift,
        rise: energy.max_rise,
        audit: energy.audit_residual,
    }
}

#[test]
fn show() {
    for name in ["conserving-ggl", "conserving", "conserving-projected", "trapezoidal-projected", "trapezoidal"] {
        let r = run(&named(name), 0.025, 20.0);
        let max = |k: usize| r.rows.iter().fold(0.0, |m, row| f64::max(m, row[k].abs()));
        println!("{name}: {:?} steps {} E {:.3e} last {:.6e} phi {:.1e} {:.1e} {:.1e} its {:.2} L {:.1e} rise {:.2e} audit {:.1e} x {:?}", r.status, r.rows.len(), max(1), r.rows.last().unwrap()[1], max(2), max(3), max(4), r.iterations, r.momentum, r.rise, r.audit, &r.position[3..]);
    }
    let _ = ProjectionChoice::default();
}

#[test]
fn probe_steps() {
    for (name, iteration) in [("conserving-ggl", "newton"), ("conserving", "newton"), ("conserving-projected", "newton"), ("trapezoidal-projected", "newton"), ("conserving", "simultaneous"), ("trapezoidal-projected", "simultaneous"), ("trapezoidal-projected", "nested"), ("conserving", "nested")] {
        for h in [0.025, 0.1, 0.2, 0.25, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.25] {
            let mut c = named(name);
            c.iteration = Some(iteration.into());
            c.subdivide = Some(false);
            if iteration != "newton" { c.penalty = Some(1e7); }
            let r = run(&c, h, 20.0);
            let max = |k: usize| r.rows.iter().fold(0.0, |m, row| f64::max(m, row[k].abs()));
            println!("{name} {iteration} {h}: {} E {:.1e} its {:.2} {:?}", r.status == Status::Completed, max(1), r.iterations, r.position.get(3));
        }
    }
}

#[test]
fn probe_paper() {
    for name in ["trapezoidal", "trapezoidal-projected"] {
        let mut c = named(name);
        c.iteration = Some("simultaneous".into());
        c.penalty = Some(1e7);
        c.subdivide = Some(false);
        let r = run(&c, 0.025, 20.0);
        let first = r.rows.iter().find(|row| row[3] > 1e-2);
        println!("{name} {:?} crossing {:?} E at 3.5 {:?} its {}", r.status, first, r.rows.iter().find(|row| row[0] > 3.4999), r.iterations);
    }
    for alpha in [1e3, 1e5, 1e7, 1e9, 1e12] {
        for name in ["conserving", "trapezoidal-projected"] {
        let mut c = named(name);
        c.penalty = Some(alpha);
        let r = run(&c, 0.025, 20.0);
        println!("{name} {alpha:e} its {} x {:?}", r.iterations, r.position);
        }
    }
    for i in ["newton", "simultaneous", "nested"] {
        for name in ["conserving", "trapezoidal-projected"] {
        let mut c = named(name);
        if i != "newton" { c.penalty = Some(1e7);}
        c.iteration = Some(i.into());
        let r = run(&c, 0.025, 20.0);
        println!("{name} {i} its {} x {:?}", r.iterations, r.position);
        }
    }
}
