//! Time stepping: what an integrator makes of velocities and accelerations. None of them names a constraint.

mod conserving;
mod conserving_ggl;
mod midpoint;
mod newmark;

use crate::formulation::{Failure, RowsAt, SolveSettings, Stage, Workspace};
use crate::system::System;

/// Time stepping from the start values in a workspace (x0, v0, a0 in `a1`, λ) to its end values (x1, v1, a1, λ).
pub trait Integrator: Send {
    /// Takes one step; says how many iterations it took and what known motion did beyond the work of the stage's
    /// forces, J.
    fn step(&mut self, system: &System, start: f64, step: f64, settings: &SolveSettings, work: &mut Workspace) -> Result<Step, Failure>;
}

/// What a step cost, and where its forces were taken.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    pub iterations: usize,
    pub stage: Stage,
    /// Work of known motion that the stage's forces do not show, J.
    pub extra_work: f64,
}

/// Numbers that the families of integrators take.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters {
    /// Newmark's β and γ.
    pub beta: f64,
    pub gamma: f64,
    /// Which positions the conserving scheme puts on the constraints.
    pub rows: RowsAt,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { beta: 0.25, gamma: 0.5, rows: RowsAt::End }
    }
}

/// One line of the table of integrators.
pub struct Entry {
    pub name: &'static str,
    pub source: &'static str,
    pub doc: &'static str,
    /// Formulations it goes with.
    pub formulations: &'static [&'static str],
    /// Iterations it goes with.
    pub iterations: &'static [&'static str],
    /// Whether projections may follow it.
    pub projects: bool,
    pub make: fn(&System, Parameters) -> Box<dyn Integrator>,
}

const BOTH: &[&str] = &["augmented-lagrangian", "penalty"];
const LOOPS: &[&str] = &["newton", "simultaneous", "nested"];

/// All integrators.
pub const INTEGRATORS: &[Entry] = &[
    Entry {
        name: "trapezoidal",
        source: "§4, (23)–(25)",
        doc: "Newmark with β = 1/4, γ = 1/2: order 2; unstable on constraints without projection",
        formulations: BOTH,
        iterations: LOOPS,
        projects: true,
        make: |_, _| Box::new(newmark::Newmark { beta: 0.25, gamma: 0.5 }),
    },
    Entry {
        name: "newmark",
        source: "Newmark 1959",
        doc: "β and γ as given (keys beta, gamma): γ > 1/2 damps and is of order 1",
        formulations: BOTH,
        iterations: LOOPS,
        projects: true,
        make: |_, parameters| Box::new(newmark::Newmark { beta: parameters.beta, gamma: parameters.gamma }),
    },
    Entry {
        name: "midpoint",
        source: "(26)",
        doc: "implicit midpoint rule with the rows at the midpoint: order 2; unstable without projection",
        formulations: BOTH,
        iterations: LOOPS,
        projects: true,
        make: |_, _| Box::new(midpoint::Midpoint),
    },
    Entry {
        name: "conserving",
        source: "(14)–(18)",
        doc: "energy and momentum exact, Φ = 0 at every step: order 2",
        formulations: BOTH,
        iterations: LOOPS,
        projects: true,
        make: |_, parameters| Box::new(conserving::Conserving { rows: parameters.rows }),
    },
    Entry {
        name: "conserving-ggl",
        source: "Kinon, Betsch and Schneider 2023",
        doc: "energy and momentum exact, Φ = 0 and Φ̇ = 0 at every step: order 2",
        formulations: &["augmented-lagrangian"],
        iterations: &["newton"],
        projects: false,
        make: |system, _| Box::new(conserving_ggl::ConservingGgl::new(system)),
    },
];
