//! The engine of holonom: dynamics of constrained mechanical systems in dependent Cartesian coordinates.
//!
//! A [`Description`](model::Description), by hand or from a TOML file, becomes a [`Model`](model::Model): what is in the mechanism, by name. It holds a
//! [`System`](system::System): nodes with masses, rows Φ = 0 and forces, without names. A [`Method`](simulation::Method) at work on a system
//! is a [`Simulation`](simulation::Simulation), and what it goes through may be kept in a [`Recording`](record::Recording). In formulas n is the number of
//! coordinates and r that of constraint rows.
//!
//! A door on a hinge with a closer, for a second:
//!
//! ```
//! use holonom::model::{Body, Description, OutputKeys, SimulationKeys, Solid, forces::Torsion, joints::Revolute};
//!
//! let mut door = Description::new("Door");
//! door.body("door", Body::new([0.5, 0.0, 1.0]).mass(20).shape(Solid::cuboid([1.0, 0.05, 2.0])));
//! door.joint("hinge", Revolute::new(["ground", "door"], [0.0, 0.0, 1.0]).axis([0.0, 0.0, 1.0]));
//! door.force("closer", Torsion::new("hinge").stiffness(5).angle(1.57));
//! door.simulation = Some(SimulationKeys::new().step(0.01));
//! door.output = Some(OutputKeys::new().reactions(true));
//! let model = door.compile()?;
//!
//! let mut simulation = model.simulation()?;
//! simulation.find_reactions();
//! for _ in 0..100 {
//!     assert_eq!(simulation.step(), holonom::simulation::Status::Completed);
//! }
//! let [angle, rate] = simulation.coordinate("hinge.angle").expect("the hinge is there");
//! let held = model.reaction(&simulation, "hinge").expect("forces were asked for");
//! println!("{angle:.3} rad, {rate:.3} rad/s, {:.1} N", held.force[2]);
//! // J φ̈ = c (1.57 − φ) with J = m (b² + t²)/12 + m b²/4.
//! let exact = 1.57 * (1.0 - (5.0_f64 / 6.670833).sqrt().cos());
//! assert!((angle - exact).abs() < 1e-4 && (held.force[2] - 20.0 * 9.81).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

// Derived code names this crate from outside.
extern crate self as holonom;

pub mod analysis;
pub mod energy;
pub mod formulation;
pub mod integrator;
pub mod linalg;
pub mod model;
pub mod projection;
pub mod record;
pub mod run;
pub mod simulation;
pub mod system;
