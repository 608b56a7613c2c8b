//! The formulations: how constraints enter the equations of motion, one line each.

use super::level::Level;

/// One line of the table of formulations.
pub struct Formulation {
    /// Name, as the key `formulation` has it.
    pub name: &'static str,
    /// Differentiation index, as the key `index` has it; 0 for ordinary differential equations.
    pub index: u8,
    /// Equations of the paper, or who published it and when.
    pub source: &'static str,
    /// Its equations, in one line.
    pub doc: &'static str,
    /// Which of Φ, Φ̇, Φ̈ it keeps, and how well.
    pub keeps: &'static str,
    /// Rows at position and velocity level, with a multiplier each.
    pub doubled: bool,
    /// λ is a penalty times the row's condition, not an unknown.
    pub soft: bool,
    /// Iterations that the multipliers may be found by.
    pub iterations: &'static [&'static str],
    /// The rows' condition, from the frequency ω (1/s) and damping ratio ξ of the user.
    pub level: fn(omega: f64, xi: f64) -> Level,
}

impl Formulation {
    /// Name with index where there are several of the name: `lagrange-2`.
    pub fn full_name(&self) -> String {
        match FORMULATIONS.iter().filter(|other| other.name == self.name).count() {
            1 => self.name.into(),
            _ => format!("{}-{}", self.name, self.index),
        }
    }

    /// Whether the condition needs accelerations, so that it gives them from positions and velocities alone.
    pub fn gives_accelerations(&self) -> bool {
        self.soft || (self.level)(1.0, 1.0).acceleration != 0.0
    }

    /// Whether positions alone are put on the rows: index 3.
    pub fn is_at_position(&self) -> bool {
        self.index == 3
    }
}

const NEWTON: &[&str] = &["newton"];
const LOOPS: &[&str] = &["newton", "simultaneous", "nested"];

fn stabilized(omega: f64, xi: f64) -> Level {
    Level { acceleration: 1.0, velocity: 2.0 * xi * omega, position: omega * omega }
}

/// All formulations.
pub const FORMULATIONS: &[Formulation] = &[
    Formulation {
        name: "augmented-lagrangian",
        index: 3,
        source: "(7), (17)–(18)",
        doc: "M a + Gᵀλ + Gᵀ(αΦ) = Q with Φ = 0 by iterated multipliers",
        keeps: "Φ",
        doubled: false,
        soft: false,
        iterations: LOOPS,
        level: |_, _| Level::POSITION,
    },
    Formulation {
        name: "augmented-lagrangian",
        index: 2,
        source: "(8)",
        doc: "the same with 2ξωΦ̇ + ω²Φ = 0: Φ decays at the rate ω/2ξ (keys omega, xi)",
        keeps: "Φ up to the step's error",
        doubled: false,
        soft: false,
        iterations: LOOPS,
        level: |omega, xi| Level { acceleration: 0.0, velocity: 2.0 * xi * omega, position: omega * omega },
    },
    Formulation {
        name: "augmented-lagrangian",
        index: 1,
        source: "(9)",
        doc: "the same with Φ̈ + 2ξωΦ̇ + ω²Φ = 0: Φ decays as an oscillator of frequency ω and damping ratio ξ",
        keeps: "Φ and Φ̇ up to the step's error",
        doubled: false,
        soft: false,
        iterations: LOOPS,
        level: stabilized,
    },
    Formulation {
        name: "lagrange",
        index: 3,
        source: "(1)",
        doc: "M a + Gᵀλ = Q, Φ = 0, solved together",
        keeps: "Φ",
        doubled: false,
        soft: false,
        iterations: NEWTON,
        level: |_, _| Level::POSITION,
    },
    Formulation {
        name: "lagrange",
        index: 2,
        source: "(2)",
        doc: "M a + Gᵀλ = Q, Φ̇ = 0: Φ drifts away linearly with time",
        keeps: "Φ̇",
        doubled: false,
        soft: false,
        iterations: NEWTON,
        level: |_, _| Level::VELOCITY,
    },
    Formulation {
        name: "lagrange",
        index: 1,
        source: "(3)",
        doc: "M a + Gᵀλ = Q, Φ̈ = 0: Φ drifts away with the square of time",
        keeps: "Φ̈",
        doubled: false,
        soft: false,
        iterations: NEWTON,
        level: |_, _| Level::ACCELERATION,
    },
    Formulation {
        name: "ggl",
        index: 2,
        source: "Gear, Gupta and Leimkuhler 1985",
        doc: "q̇ = v − M⁻¹Gᵀμ, M v̇ + Gᵀλ = Q with Φ = 0 and Φ̇ = 0",
        keeps: "Φ, Φ̇",
        doubled: true,
        soft: false,
        iterations: NEWTON,
        level: |_, _| Level::POSITION,
    },
    Formulation {
        name: "ode",
        index: 0,
        source: "(4)",
        doc: "(3) with λ eliminated, with the terms of rows that depend on time: Φ drifts, which redundant rows bear only so far",
        keeps: "Φ̈",
        doubled: false,
        soft: false,
        iterations: NEWTON,
        level: |_, _| Level::ACCELERATION,
    },
    Formulation {
        name: "baumgarte",
        index: 1,
        source: "Baumgarte 1972",
        doc: "M a + Gᵀλ = Q, Φ̈ + 2ξωΦ̇ + ω²Φ = 0 (keys omega, xi)",
        keeps: "Φ and Φ̇ up to the step's error",
        doubled: false,
        soft: false,
        iterations: NEWTON,
        level: stabilized,
    },
    Formulation {
        name: "penalty",
        index: 0,
        source: "(5), (14)",
        doc: "M a + Gᵀ(αΦ) = Q: constraints as stiff springs; Φ → 0 as α → ∞ (key penalty)",
        keeps: "nothing exactly",
        doubled: false,
        soft: true,
        iterations: NEWTON,
        level: |_, _| Level::POSITION,
    },
    Formulation {
        name: "penalty-stabilized",
        index: 0,
        source: "(6)",
        doc: "M a + Gᵀα(Φ̈ + 2ξωΦ̇ + ω²Φ) = Q (keys penalty, omega, xi)",
        keeps: "nothing exactly",
        doubled: false,
        soft: true,
        iterations: NEWTON,
        level: stabilized,
    },
];
