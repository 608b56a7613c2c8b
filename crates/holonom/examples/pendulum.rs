//! The pendulum of García Orden and Dopico (2007), two links in space for 20 s: what two methods keep of its energy.

use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom_io::Source;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let text = include_str!("../../../examples/spherical-compound-pendulum.toml");
    let model = Source::read("pendulum.toml", text.as_bytes())?.model()?;
    for name in ["trapezoidal", "conserving-ggl"] {
        let method = Method::resolve(&Choice { method: Some(name.into()), ..Choice::default() })?;
        let mut simulation = Simulation::new(model.system.clone(), method, model.step()?)?;
        match simulation.step_to(20.0) {
            Status::Completed => println!("{name}: energy off by {:.1e} J", simulation.audit().energy_summary().max_drift),
            Status::Stopped { at, reason } => println!("{name}: stopped at {at:.2} s, {reason}"),
        }
    }
    Ok(())
}
