//! An element of one's own: a rubber band, slack below its length and stiffer the longer it is, that carries a mass on a rod.

use std::sync::Arc;

use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom::system::{Law, Place, Reach, Response, SystemBuilder};

/// V = ½ k (π − π₀)² where π, half the square of the length, is above π₀.
struct Band {
    /// N/m³
    stiffness: f64,
    /// m²
    slack: f64,
}

impl Band {
    fn stretch(&self, value: f64) -> f64 {
        (value - self.slack).max(0.0)
    }
}

impl Law for Band {
    fn energy(&self, value: &[f64]) -> f64 {
        0.5 * self.stiffness * self.stretch(value[0]).powi(2)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        out.force[0] = self.stiffness * self.stretch(value[0]);
        out.by_value[0][0] = if value[0] > self.slack { self.stiffness } else { 0.0 };
    }

    /// The discrete gradient ΔV/Δπ, and its derivative by π at the end: both from the half of the step where the band is tight.
    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let (from, to) = (self.stretch(reach.from[0]), self.stretch(reach.to[0]));
        let change = reach.to[0] - reach.from[0];
        if change.abs() <= 1e-9 * self.slack {
            self.at(&[0.5 * (reach.from[0] + reach.to[0])], &[0.0], reach.middle, out);
            out.by_value[0][0] *= 0.5;
            return;
        }
        let mean = 0.5 * self.stiffness * (to + from) * (to - from) / change;
        out.force[0] = mean;
        out.by_value[0][0] = (self.stiffness * to - mean) / change;
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut builder = SystemBuilder::new(2, [0.0, -9.81, 0.0]);
    let bob = builder.free_node([1.0, 0.0, 0.0], [0.0; 3]);
    let (bob, pivot, hook) = (Place::Node(bob), Place::Fixed([0.0; 3]), Place::Fixed([0.0, 1.0, 0.0]));
    builder.mass(bob, bob, 1.0);
    let rod = builder.square(&[(bob, 1.0), (pivot, -1.0)]);
    builder.constant_row("rod", rod, 0.5);
    let length = builder.square(&[(bob, 1.0), (hook, -1.0)]);
    builder.law("band", &[length], Arc::new(Band { stiffness: 10.0, slack: 0.5 }));

    let method = Method::resolve(&Choice::default())?;
    let mut simulation = Simulation::new(builder.build(), method, 0.01)?;
    let mut lowest = 0.0_f64;
    for _ in 0..1000 {
        if let Status::Stopped { reason, .. } = simulation.step() {
            return Err(reason.into());
        }
        lowest = lowest.min(simulation.state().x[1]);
    }
    println!("falls to {lowest:.3} m; energy off by {:.1e} J", simulation.audit().energy_summary().max_drift);
    Ok(())
}
