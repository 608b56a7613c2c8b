//! The integrators, one line each: what they go with, their order, and how they are made.

use serde::{Deserialize, Serialize};

use super::composed::{self, Composed};
use super::explicit::{DOP853, DOPRI5, Explicit, RK4};
use super::generalized_alpha::GeneralizedAlpha;
use super::runge_kutta::{RungeKutta, Tableau};
use super::{Integrator, Parameters, bdf, conserving, conserving_ggl, midpoint, newmark, rattle};
use crate::formulation::{FORMULATIONS, Formulation, Level, Newton};
use crate::system::System;

/// Where the estimate of a step's local error comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Estimate {
    /// Third derivatives of positions and velocities, from the steps before: schemes of order 2 (methods §16).
    History,
    /// The integrator gives it.
    Own,
    /// The same, from the differences of many states, in which more is rounded.
    OwnOfStates,
    /// None: the step is the user's.
    None,
}

/// One line of the table of integrators.
pub struct Entry {
    /// Name, as the key `integrator` has it.
    pub name: &'static str,
    /// Equations of the paper, or who published it and when.
    pub source: &'static str,
    /// What it is, in one line.
    pub doc: &'static str,
    /// When to take it.
    pub use_for: &'static str,
    /// What it keeps beside what the formulation keeps.
    pub keeps: &'static str,
    /// What a formulation must be to go with it.
    pub takes: Takes,
    /// The formulation where none is named, by full name.
    pub usual: &'static str,
    /// Iterations it goes with.
    pub iterations: &'static [&'static str],
    /// Whether projections may follow it.
    pub projects: bool,
    /// Whether it is unstable on rows at position level (index 3) without projection of velocities.
    pub needs_projection: bool,
    /// Whether its steps end on the rows, where the formulation puts positions on them.
    pub ends_on_rows: bool,
    /// Whether it conserves energy and momenta.
    pub conserves: bool,
    /// Whether it takes energy out of what is fast for its steps.
    pub damps: bool,
    /// Values of the key `order`, the usual one first.
    pub orders: &'static [u8],
    /// The usual order of steps by accuracy.
    pub adaptive_order: u8,
    /// How its steps can be chosen by an accuracy.
    pub estimate: Estimate,
    /// Whether there is a polynomial through the step, so that results need no steps of their own.
    pub dense: bool,
    /// Order of convergence of positions, velocities and reactions that can be relied upon, for parameters, a
    /// formulation, and with or without projections.
    pub convergence: fn(&Parameters, &Formulation, bool) -> [u8; 3],
    /// Where it takes forces: shares of a step, with their weights in the change of velocity.
    pub looks: fn(&Parameters) -> Vec<[f64; 2]>,
    /// Makes it for a system, with all the room that it needs.
    pub make: fn(&System, &Newton, Parameters) -> Box<dyn Integrator>,
}

/// What a formulation must be to go with an integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// Rows at any level, or at both.
    All,
    /// Rows at one level.
    OneLevel,
    /// Rows at both levels, with a multiplier each.
    BothLevels,
    /// Positions on the rows, by multipliers or by a penalty.
    Positions,
    /// Positions on the rows by multipliers.
    PositionMultipliers,
    /// Rows at one level below that of positions, or a penalty.
    LowIndex,
    /// Accelerations from positions and velocities alone.
    Accelerations,
}

impl Entry {
    /// Whether it goes with a formulation.
    pub fn goes_with(&self, formulation: &Formulation) -> bool {
        let has_positions = (formulation.level)(1.0, 1.0) == Level::POSITION && !formulation.doubled;
        match self.takes {
            Takes::All => true,
            Takes::OneLevel => !formulation.doubled,
            Takes::BothLevels => formulation.doubled,
            Takes::Positions => has_positions,
            Takes::PositionMultipliers => has_positions && !formulation.soft,
            Takes::LowIndex => !formulation.doubled && (!has_positions || formulation.soft),
            Takes::Accelerations => formulation.gives_accelerations(),
        }
    }

    /// The formulations that it goes with.
    pub fn formulations(&self) -> impl Iterator<Item = &'static Formulation> {
        FORMULATIONS.iter().filter(|line| self.goes_with(line))
    }

    /// Whether a step needs accelerations only and solves no equations.
    pub fn is_explicit(&self) -> bool {
        self.takes == Takes::Accelerations
    }
}

/// The integrator's order in everything.
fn full(parameters: &Parameters, _: &Formulation, _: bool) -> [u8; 3] {
    [parameters.order; 3]
}

/// At both ends of a step.
fn at_ends(_: &Parameters) -> Vec<[f64; 2]> {
    vec![[0.0, 0.5], [1.0, 0.5]]
}

const NEWTON: &[&str] = &["newton"];
const LOOPS: &[&str] = &["newton", "simultaneous", "nested"];

/// All integrators.
pub const INTEGRATORS: &[Entry] = &[
    Entry {
        name: "conserving-ggl",
        source: "Kinon, Betsch and Schneider 2023",
        doc: "energy and momentum exact, Φ = 0 and Φ̇ = 0 at every step; order 4 and 6 by composition (key order)",
        use_for: "long runs, everything exact",
        keeps: "energy, momentum",
        takes: Takes::BothLevels,
        usual: "ggl",
        iterations: NEWTON,
        projects: false,
        needs_projection: false,
        ends_on_rows: true,
        conserves: true,
        damps: false,
        orders: &[2, 4, 6],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: full,
        looks: |parameters| composed::looks(parameters.order),
        make: |system, newton, parameters| {
            Composed::of(Box::new(conserving_ggl::ConservingGgl::new(system, newton)), parameters.order, system)
        },
    },
    Entry {
        name: "conserving",
        source: "(14)–(18)",
        doc: "energy and momentum exact, Φ = 0 at every step; order 4 by composition (key order)",
        use_for: "the paper's scheme; long runs",
        keeps: "energy, momentum",
        takes: Takes::Positions,
        usual: "augmented-lagrangian-3",
        iterations: LOOPS,
        projects: true,
        needs_projection: false,
        ends_on_rows: true,
        conserves: true,
        damps: false,
        orders: &[2, 4],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: |parameters, formulation, projected| match (parameters.order, projected) {
            (4, false) if !formulation.soft => [4, 2, 2],
            (4, true) => [3; 3],
            (order, _) => [order; 3],
        },
        looks: |parameters| composed::looks(parameters.order),
        make: |system, _, parameters| Composed::of(Box::new(conserving::Conserving { rows: parameters.rows }), parameters.order, system),
    },
    Entry {
        name: "trapezoidal",
        source: "García Orden and Dopico 2007, §4, (23)–(25)",
        doc: "Newmark with β = 1/4, γ = 1/2; on index 3 unstable without projection",
        use_for: "real time, with projections",
        keeps: "",
        takes: Takes::OneLevel,
        usual: "augmented-lagrangian-3",
        iterations: LOOPS,
        projects: true,
        needs_projection: true,
        ends_on_rows: true,
        conserves: false,
        damps: false,
        orders: &[2],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: full,
        looks: at_ends,
        make: |_, _, _| Box::new(newmark::Newmark { beta: 0.25, gamma: 0.5 }),
    },
    Entry {
        name: "newmark",
        source: "Newmark 1959",
        doc: "β and γ as given (keys beta, gamma): γ > 1/2 damps and is of order 1",
        use_for: "comparison with older codes",
        keeps: "",
        takes: Takes::OneLevel,
        usual: "augmented-lagrangian-3",
        iterations: LOOPS,
        projects: true,
        needs_projection: true,
        ends_on_rows: true,
        conserves: false,
        damps: true,
        orders: &[2],
        adaptive_order: 2,
        estimate: Estimate::None,
        dense: false,
        convergence: |parameters, _, _| if parameters.gamma == 0.5 { [2; 3] } else { [1; 3] },
        looks: |parameters| vec![[0.0, 1.0 - parameters.gamma], [1.0, parameters.gamma]],
        make: |_, _, parameters| Box::new(newmark::Newmark { beta: parameters.beta, gamma: parameters.gamma }),
    },
    Entry {
        name: "hht",
        source: "Hilber, Hughes and Taylor 1977; Arnold and Brüls 2007",
        doc: "generalized-α with α_m = 0, α_f = α (key alpha, 0 … 1/3, usually 0.1)",
        use_for: "structures whose high frequencies are to be damped",
        keeps: "",
        takes: Takes::OneLevel,
        usual: "augmented-lagrangian-3",
        iterations: LOOPS,
        projects: true,
        needs_projection: false,
        ends_on_rows: true,
        conserves: false,
        damps: true,
        orders: &[2],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: full,
        looks: at_ends,
        make: |_, _, parameters| Box::new(GeneralizedAlpha::hht(parameters.alpha)),
    },
    Entry {
        name: "generalized-alpha",
        source: "Arnold and Brüls 2007",
        doc: "equations of motion at the end of the step, λ of order 2 (key rho: ρ∞, 0 … 1, usually 0.8)",
        use_for: "stiff, damped mechanisms",
        keeps: "",
        takes: Takes::OneLevel,
        usual: "augmented-lagrangian-3",
        iterations: LOOPS,
        projects: true,
        needs_projection: false,
        ends_on_rows: true,
        conserves: false,
        damps: true,
        orders: &[2],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: full,
        looks: at_ends,
        make: |_, _, parameters| Box::new(GeneralizedAlpha::with_radius(parameters.rho)),
    },
    Entry {
        name: "midpoint",
        source: "(26)",
        doc: "implicit midpoint rule with the rows at the midpoint; on index 3 unstable without projection",
        use_for: "comparison",
        keeps: "momentum",
        takes: Takes::OneLevel,
        usual: "augmented-lagrangian-3",
        iterations: LOOPS,
        projects: true,
        needs_projection: true,
        ends_on_rows: false,
        conserves: false,
        damps: false,
        orders: &[2],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: |_, formulation, projected| if projected || !formulation.is_at_position() { [2; 3] } else { [2, 0, 0] },
        looks: |_| vec![[0.5, 1.0]],
        make: |_, _, _| Box::new(midpoint::Midpoint),
    },
    Entry {
        name: "rattle",
        source: "Andersen 1983",
        doc: "symplectic: kick, drift onto Φ = 0, kick onto Φ̇ = 0; forces explicit, stable for h < 2/ω",
        use_for: "long runs of mechanisms without stiff forces, cheaply",
        keeps: "Φ̇; energy up to a band",
        takes: Takes::PositionMultipliers,
        usual: "augmented-lagrangian-3",
        iterations: NEWTON,
        projects: false,
        needs_projection: false,
        ends_on_rows: true,
        conserves: false,
        damps: false,
        orders: &[2],
        adaptive_order: 2,
        estimate: Estimate::History,
        dense: false,
        convergence: full,
        looks: at_ends,
        make: |_, _, _| Box::new(rattle::Rattle),
    },
    Entry {
        name: "radau",
        source: "Hairer and Wanner 1996, §IV.5",
        doc: "Radau IIA with 1, 2, 3 stages (key order: 1, 3, 5): dissipative, accurate",
        use_for: "reference solutions; stiff mechanisms",
        keeps: "",
        takes: Takes::All,
        usual: "ggl",
        iterations: NEWTON,
        projects: true,
        needs_projection: false,
        ends_on_rows: true,
        conserves: false,
        damps: true,
        orders: &[5, 3, 1],
        adaptive_order: 5,
        estimate: Estimate::Own,
        dense: false,
        convergence: |parameters, formulation, projected| match parameters.order {
            order if projected || !formulation.is_at_position() => [order; 3],
            order => [order, order / 2 + 1, order / 2 + 1],
        },
        looks: |parameters| Tableau::radau(parameters.order).looks(),
        make: |system, newton, parameters| Box::new(RungeKutta::new(system, &newton.settings, Tableau::radau(parameters.order))),
    },
    Entry {
        name: "bdf",
        source: "Gear 1971; Hairer and Wanner 1996, §III.5",
        doc: "backward differentiation (key order, 1 … 5): order 1 and 2 dissipate; with an accuracy the order varies up to it",
        use_for: "stiff, damped mechanisms",
        keeps: "",
        takes: Takes::All,
        usual: "ggl",
        iterations: NEWTON,
        projects: true,
        needs_projection: false,
        ends_on_rows: true,
        conserves: false,
        damps: true,
        orders: &[2, 1, 3, 4, 5],
        adaptive_order: 5,
        estimate: Estimate::OwnOfStates,
        dense: false,
        convergence: full,
        looks: |_| vec![[1.0, 1.0]],
        make: |system, newton, parameters| Box::new(bdf::Bdf::new(system, &newton.settings, parameters.order, parameters.adapts)),
    },
    Entry {
        name: "gauss",
        source: "Hairer and Wanner 1996, §IV.5",
        doc: "Gauss collocation with 1, 2, 3 stages (key order: 2, 4, 6)",
        use_for: "high order without damping, on the formulations of index 1 and 0",
        keeps: "",
        takes: Takes::LowIndex,
        usual: "ode",
        iterations: NEWTON,
        projects: true,
        needs_projection: false,
        ends_on_rows: false,
        conserves: false,
        damps: false,
        orders: &[6, 4, 2],
        adaptive_order: 6,
        estimate: Estimate::None,
        dense: false,
        convergence: |parameters, formulation, projected| match parameters.order {
            order if projected || formulation.index < 2 => [order; 3],
            order => [order, (order - 2).max(2), (order - 2).max(2)],
        },
        looks: |parameters| Tableau::gauss(parameters.order).looks(),
        make: |system, newton, parameters| Box::new(RungeKutta::new(system, &newton.settings, Tableau::gauss(parameters.order))),
    },
    Entry {
        name: "rk4",
        source: "Kutta 1901",
        doc: "the classical explicit method of order 4",
        use_for: "quick looks; comparison",
        keeps: "",
        takes: Takes::Accelerations,
        usual: "ode",
        iterations: NEWTON,
        projects: true,
        needs_projection: false,
        ends_on_rows: false,
        conserves: false,
        damps: true,
        orders: &[4],
        adaptive_order: 4,
        estimate: Estimate::None,
        dense: false,
        convergence: full,
        looks: |_| RK4.looks(),
        make: |system, _, _| Box::new(Explicit::new(system, RK4)),
    },
    Entry {
        name: "dopri5",
        source: "Dormand and Prince 1980",
        doc: "explicit, order 5(4), dense output of order 4",
        use_for: "mechanisms without stiff forces, at 1e-4 … 1e-8",
        keeps: "",
        takes: Takes::Accelerations,
        usual: "ode",
        iterations: NEWTON,
        projects: true,
        needs_projection: false,
        ends_on_rows: false,
        conserves: false,
        damps: true,
        orders: &[5],
        adaptive_order: 5,
        estimate: Estimate::Own,
        dense: true,
        convergence: full,
        looks: |_| DOPRI5.looks(),
        make: |system, _, _| Box::new(Explicit::new(system, DOPRI5)),
    },
    Entry {
        name: "dop853",
        source: "Prince and Dormand 1981",
        doc: "explicit, order 8(5,3), dense output of order 7",
        use_for: "mechanisms without stiff forces, at 1e-8 and below",
        keeps: "",
        takes: Takes::Accelerations,
        usual: "ode",
        iterations: NEWTON,
        projects: true,
        needs_projection: false,
        ends_on_rows: false,
        conserves: false,
        damps: true,
        orders: &[8],
        adaptive_order: 8,
        estimate: Estimate::Own,
        dense: true,
        convergence: full,
        looks: |_| DOP853.looks(),
        make: |system, _, _| Box::new(Explicit::new(system, DOP853)),
    },
];
