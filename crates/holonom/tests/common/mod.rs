//! Systems that several tests share, with reference values computed elsewhere in 113-bit arithmetic.
#![allow(dead_code)] // each test uses its share

use std::sync::Arc;

use holonom::simulation::{Choice, Method, ProjectionChoice, Simulation, Status, Verdict, combinations};
use holonom::system::{ConstraintFunction, Differentiated, Number, Place, Signal, System, SystemBuilder};

/// The paper's spherical compound pendulum: 1 kg at 1 m and 2 m on a straight rod, horizontal along x, azimuth rate
/// 0.5 rad/s. Five rows of rank four.
pub fn pendulum() -> System {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let m1 = Place::Node(builder.free_node([1.0, 0.0, 0.0], [0.0, 0.5, 0.0]));
    let m2 = Place::Node(builder.free_node([2.0, 0.0, 0.0], [0.0, 1.0, 0.0]));
    builder.mass(m1, m1, 1.0);
    builder.mass(m2, m2, 1.0);
    let inner = builder.square(&[(m1, 1.0)]);
    let outer = builder.square(&[(m2, 1.0), (m1, -1.0)]);
    builder.constant_row("inner-rod", inner, 0.5);
    builder.constant_row("outer-rod", outer, 0.5);
    for c in 0..3 {
        let mut e = [0.0; 3];
        e[c] = 1.0;
        let straight = builder.cross(e, &[(m1, 1.0)], &[(m2, 1.0), (m1, -1.0)]);
        builder.constant_row(format!("straight[{c}]"), straight, 0.0);
    }
    builder.build()
}

/// Energy of the pendulum, J.
pub const PENDULUM_ENERGY: f64 = 0.625;

/// r2 of the pendulum at t = 2 s, m.
pub const PENDULUM_AT_2: [f64; 3] = [-1.27229634990966, -0.953716555813986, -1.21313096126217];

/// IFToMM A02 with `n` windows of uniform rods.
pub fn four_bar(n: usize) -> System {
    let mut builder = SystemBuilder::new(2, [0.0, -9.81, 0.0]);
    let ground: Vec<Place> = (0..=n).map(|i| Place::Fixed([i as f64, 0.0, 0.0])).collect();
    let top: Vec<Place> = (0..=n).map(|i| Place::Node(builder.free_node([i as f64, 1.0, 0.0], [1.0, 0.0, 0.0]))).collect();
    let verticals = (0..=n).map(|i| (ground[i], top[i]));
    let horizontals = (0..n).map(|i| (top[i], top[i + 1]));
    for (k, (a, b)) in verticals.chain(horizontals).enumerate() {
        bar(&mut builder, &format!("bar[{k}]"), a, b, 1.0, 1.0);
    }
    builder.build()
}

/// A uniform rigid rod between two places.
pub fn bar(builder: &mut SystemBuilder, name: &str, a: Place, b: Place, mass: f64, length: f64) {
    builder.mass(a, a, mass / 3.0);
    builder.mass(b, b, mass / 3.0);
    builder.mass(a, b, mass / 6.0);
    let square = builder.square(&[(b, 1.0), (a, -1.0)]);
    builder.constant_row(name, square, 0.5 * length * length);
}

/// A support that swings: x = 0.3 sin 5t.
struct Swing;

impl Signal for Swing {
    fn at(&self, t: f64) -> [f64; 3] {
        let (s, c) = (5.0 * t).sin_cos();
        [0.3 * s, 1.5 * c, -7.5 * s]
    }
}

/// A pendulum on a swinging support, its rod a bar with mass, so that the known node takes part in the mass matrix.
pub fn driven_pendulum() -> System {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let tip = Place::Node(builder.free_node([0.6, 0.0, -0.8], [1.5, 0.2, 0.0]));
    let still = Arc::new(holonom::system::Constant(0.0));
    let support = Place::Node(builder.known_node([Arc::new(Swing), still.clone(), still]));
    bar(&mut builder, "rod", support, tip, 1.0, 1.0);
    builder.mass(tip, tip, 0.5);
    builder.build()
}

/// Keeps a point on the surface z = 0.4 sin x + 0.1 y³ + 0.2 t: nothing quadratic.
struct Surface;

impl ConstraintFunction for Surface {
    fn rows(&self) -> usize {
        1
    }

    fn evaluate<N: Number>(&self, x: &[N], t: N, phi: &mut [N]) {
        phi[0] = x[2] - x[0].sin() * 0.4 - x[1] * x[1] * x[1] * 0.1 - t * 0.2;
    }
}

/// A particle on a rising wavy surface, by a custom row.
pub fn surface() -> System {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let node = builder.free_node([0.5, 0.2, 0.4 * 0.5_f64.sin() + 0.1 * 0.008], [0.3, -0.2, 0.0]);
    builder.mass(Place::Node(node), Place::Node(node), 2.0);
    builder.custom_rows("surface", &[node], Arc::new(Differentiated(Surface)));
    builder.build()
}

/// A method by its name.
pub fn named(name: &str) -> Choice {
    Choice { method: Some(name.into()), ..Choice::default() }
}

/// The same with the paper's loop: penalty 1e7, tolerance 1e-9, no subdivision.
pub fn paper_loop(name: &str, iteration: &str) -> Choice {
    Choice { iteration: Some(iteration.into()), penalty: Some(1e7), tolerance: Some(1e-9), subdivide: Some(false), ..named(name) }
}

/// The same with projections of the given metric and way of solving.
pub fn projected(name: &str, matrix: &str, solve: &str) -> Choice {
    let projection = ProjectionChoice { matrix: Some(matrix.into()), solve: Some(solve.into()), ..ProjectionChoice::default() };
    Choice { projection: Some(projection), ..named(name) }
}

/// Every combination that the tables allow, with its name; penalties so soft that explicit methods are stable. Where
/// errors can be estimated, once more with steps by accuracy.
pub fn every_method() -> Vec<(String, Choice)> {
    let named = |mut choice: Choice| {
        let method = Method::resolve(&choice).expect("a combination goes together");
        choice.penalty = method.formulation.soft.then_some(1e3);
        (format!("{}, {}", method.name, method.iteration), choice)
    };
    let fixed: Vec<(String, Choice)> = combinations().into_iter().map(named).collect();
    let by_accuracy = |(name, choice): &(String, Choice)| {
        let choice = Choice { accuracy: Some(1e-3), ..choice.clone() };
        Method::resolve(&choice).is_ok().then(|| (format!("{name}, by accuracy"), choice))
    };
    let adaptive: Vec<(String, Choice)> = fixed.iter().filter_map(by_accuracy).collect();
    fixed.into_iter().chain(adaptive).collect()
}

/// What a run leaves for a test to look at.
pub struct Run {
    pub status: Status,
    pub steps: Vec<Row>,
    pub position: Vec<f64>,
    pub summary: holonom::simulation::Summary,
}

/// One recorded step.
pub struct Row {
    pub t: f64,
    pub energy: f64,
    pub work: f64,
    pub phi: f64,
    pub phi_dot: f64,
    pub phi_ddot: f64,
}

impl Run {
    /// Largest value of a column.
    pub fn largest(&self, column: impl Fn(&Row) -> f64) -> f64 {
        self.steps.iter().map(column).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The first step at or after a time.
    pub fn at(&self, t: f64) -> &Row {
        self.steps.iter().find(|row| row.t >= t - 1e-9).expect("the run got so far")
    }
}

/// Runs a system by a method.
pub fn run(system: &System, choice: &Choice, step: f64, end: f64) -> Run {
    let method = Method::resolve(choice).expect("the method is valid");
    let mut simulation = Simulation::new(system.clone(), method, step).expect("the system starts");
    let mut steps = Vec::new();
    let mut observer = |simulation: &Simulation| {
        let audit = simulation.audit();
        steps.push(Row {
            t: simulation.state().t,
            energy: audit.energy(),
            work: audit.work,
            phi: audit.phi,
            phi_dot: audit.phi_dot,
            phi_ddot: audit.phi_ddot,
        });
        Verdict::GoOn
    };
    let status = simulation.run(end, &mut observer);
    let size = holonom::analysis::rank(system, &simulation.state().x, simulation.state().t).size(system);
    let summary = simulation.summary("test", end, &status, size);
    Run { status, steps, position: simulation.state().x.clone(), summary }
}
