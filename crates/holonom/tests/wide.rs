//! Rows and loads on more nodes than fit on the stack.

use std::sync::Arc;

use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom::system::{ConstraintFunction, Differentiated, ForceFunction, Number, Place, System, SystemBuilder};

const NODES: usize = 15;

/// Rods between neighbours: half the squares of their lengths stay as they are.
struct Rods {
    half_squares: Vec<f64>,
}

impl ConstraintFunction for Rods {
    fn rows(&self) -> usize {
        NODES - 1
    }

    fn evaluate<N: Number>(&self, x: &[N], _t: N, phi: &mut [N]) {
        for (k, phi) in phi.iter_mut().enumerate() {
            *phi = N::from(-self.half_squares[k]);
            for c in 0..3 {
                let d = x[3 * k + 3 + c] - x[3 * k + c];
                *phi += d * d * 0.5;
            }
        }
    }
}

/// Springs of stiffness 1 and no length between each node and the next but one.
struct Springs;

impl ForceFunction for Springs {
    fn evaluate<N: Number>(&self, x: &[N], _v: &[N], _t: N, force: &mut [N]) {
        force.fill(N::from(0.0));
        for k in 0..x.len() - 6 {
            let d = x[k + 6] - x[k];
            force[k] += d;
            force[k + 6] -= d;
        }
    }
}

/// A chain of pearls on rods, pulled together by springs: each kind as one function of all nodes, or each rod and spring by itself.
fn pearls(as_functions: bool) -> System {
    let mut builder = SystemBuilder::new(3, [0.0, 0.0, -9.81]);
    let place = |k: usize| [k as f64, (1.3 * k as f64).sin(), 0.1 * (k * k % 7) as f64];
    let nodes: Vec<_> = (0..NODES).map(|k| builder.free_node(place(k), [0.0, 0.1, 0.0])).collect();
    nodes.iter().for_each(|&node| builder.mass(Place::Node(node), Place::Node(node), 1.0));
    let half_squares: Vec<f64> = (1..NODES).map(|k| (0..3).map(|c| 0.5 * (place(k)[c] - place(k - 1)[c]).powi(2)).sum::<f64>()).collect();
    if as_functions {
        builder.custom_rows("rods", &nodes, Arc::new(Differentiated(Rods { half_squares })));
        builder.load("springs", &nodes, Arc::new(Differentiated(Springs)));
        return builder.build();
    }
    let square =
        |builder: &mut SystemBuilder, a: usize, b: usize| builder.square(&[(Place::Node(nodes[b]), 1.0), (Place::Node(nodes[a]), -1.0)]);
    for (k, half_square) in half_squares.into_iter().enumerate() {
        let length = square(&mut builder, k, k + 1);
        builder.constant_row(format!("rods[{k}]"), length, half_square);
    }
    for k in 2..NODES {
        let length = square(&mut builder, k - 2, k);
        builder.law("spring", &[length], Arc::new(Linear));
    }
    builder.build()
}

/// V = π: a spring of stiffness 1 without length.
struct Linear;

impl holonom::system::Law for Linear {
    fn energy(&self, value: &[f64]) -> f64 {
        value[0]
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, _value: &[f64], _rate: &[f64], _t: f64, out: &mut holonom::system::Response) {
        out.force[0] = 1.0;
    }

    fn between(&self, _reach: holonom::system::Reach<'_>, out: &mut holonom::system::Response) {
        out.force[0] = 1.0;
    }
}

#[test]
fn a_function_of_fifteen_nodes_moves_them_as_its_parts_do() {
    for name in ["conserving", "conserving-ggl", "radau", "ode/rk4"] {
        let end = |as_functions| {
            let method = Method::resolve(&Choice { method: Some(name.into()), ..Choice::default() }).unwrap();
            let mut simulation = Simulation::new(pearls(as_functions), method, 0.01).unwrap();
            assert_eq!(simulation.step_to(0.2), Status::Completed, "{name}");
            simulation.state().x.clone()
        };
        let (one, each) = (end(true), end(false));
        let apart = one.iter().zip(&each).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Both are the same quadratic forms, summed in another order.
        assert!(apart < 1e-9, "{name}: {apart:e}");
    }
}
