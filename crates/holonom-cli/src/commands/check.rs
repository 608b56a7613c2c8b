//! `holonom check`.

use std::process::ExitCode;

use holonom::analysis::{projection_form, rank};
use holonom::projection::Solve;
use holonom::simulation::{PENALTY, Simulation};
use serde_json::json;

use crate::failure::Failure;
use crate::load;
use crate::options::CheckArguments;
use crate::table::{list, short};

/// Independence of a row below which the model is said to be near a singular configuration.
const NEAR_SINGULAR: f64 = 1e-4;

/// Validates a model and says what it is made of.
pub fn check(arguments: &CheckArguments) -> Result<ExitCode, Failure> {
    let loaded = load::load(&arguments.model.model, load::overrides(&arguments.model.set))?;
    let system = &loaded.model.system;
    let method = load::method(&loaded, None)?;
    let projection = method.projection.clone();
    let name = method.name.clone();
    let step = loaded.step().unwrap_or(1e-3);
    let simulation = Simulation::new(system, method, step).map_err(load::start_failure)?;
    let found = rank(system, &simulation.state().x, 0.0);
    let size = found.size(system);
    let (start, audit) = (simulation.start(), simulation.audit());
    let near = found.weakest.as_ref().filter(|(_, independence)| *independence < NEAR_SINGULAR);
    let form = match arguments.projection {
        true => {
            let alpha = if let Solve::Penalty(alpha) = projection.solve { alpha } else { PENALTY };
            let form = projection_form(system, &projection, alpha, step);
            Some(form.ok_or_else(|| Failure::usage("the mass matrix is not positive definite", "give every free point some mass"))?)
        }
        false => None,
    };
    if arguments.json {
        let mut value = json!({
            "model": loaded.name, "method": name, "coordinates": size.coordinates, "constraints": size.constraints,
            "rank": size.rank, "redundant": size.redundant, "dof": size.dof, "redundant_rows": found.redundant,
            "near_singular": near, "moved": start.moved, "turned": start.turned,
            "residual": { "position": audit.phi, "velocity": audit.phi_dot, "acceleration": audit.phi_ddot },
            "energy": { "kinetic": audit.kinetic, "potential": audit.potential },
        });
        if let Some(form) = form {
            value["projection"] = json!({
                "growth": form.growth, "dissipative": form.dissipative,
                "condition": form.condition, "growth_bound": form.growth_bound,
            });
        }
        println!("{}", serde_json::to_string_pretty(&value).expect("a result is plain data"));
        return Ok(ExitCode::SUCCESS);
    }
    let redundant = if found.redundant.is_empty() { "none".to_string() } else { found.redundant.join(", ") };
    let singular = match (near, &found.weakest) {
        (Some((row, independence)), _) => format!("yes: `{row}` adds only {} of itself to the others", short(*independence)),
        (None, Some((row, independence))) => format!("no: the weakest row is `{row}` with {}", short(*independence)),
        (None, None) => "no constraints".to_string(),
    };
    let items = [
        ("size", format!("{} coordinates, {} rows of rank {}", size.coordinates, size.constraints, size.rank)),
        ("freedom", format!("{} degrees of freedom", size.dof)),
        ("redundant", redundant),
        ("singular", singular),
        ("corrected", format!("positions by {} m, velocities by {} m/s", short(start.moved), short(start.turned))),
        ("residual", format!("position {}, velocity {}, acceleration {}", short(audit.phi), short(audit.phi_dot), short(audit.phi_ddot))),
        ("energy", format!("kinetic {} J, potential {} J", short(audit.kinetic), short(audit.potential))),
        ("gravity", loaded.gravity()),
        ("method", name),
    ];
    println!("{}\n{}", loaded.title(), list(&items));
    if let Some(form) = form {
        let verdict = if form.dissipative {
            "negative semidefinite: the projection never adds energy (30)"
        } else {
            "indefinite: the projection can add energy (30)"
        };
        let items = [
            ("D", verdict.to_string()),
            ("growth", format!("kinetic energy times {} at most, at this state", short(form.growth))),
            ("κ", format!("cond(M⁻¹A) = {}", short(form.condition))),
            ("bound", format!("kinetic energy times {} at most, at any state: (κ+1)²/4κ", short(form.growth_bound))),
        ];
        println!("\nvelocity projection at the start\n{}", list(&items));
    }
    Ok(ExitCode::SUCCESS)
}
