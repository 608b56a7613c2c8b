//! `holonom stability`.

use std::process::ExitCode;

use holonom::analysis::largest_step;
use holonom::simulation::{Method, NAMED, Simulation, Status, Verdict};
use serde_json::json;

use crate::failure::Failure;
use crate::load;
use crate::options::StabilityArguments;
use crate::table::{short, table};

/// Largest step tried, over the length of the run: beyond it there is little left to complete.
const LARGEST_SHARE: f64 = 0.1;

/// Ratio between the step that completes and the step that fails at which the search ends.
const RATIO: f64 = 1.01;

/// Energy above its start, over the exchanged energy, at which a run counts as unstable although it went on.
const EXPLODED: f64 = 1e6;

/// Searches the largest step of each method. Steps are never subdivided here.
pub fn stability(arguments: &StabilityArguments) -> Result<ExitCode, Failure> {
    let mut overrides = load::overrides(&arguments.model.set);
    overrides.number("simulation.step", arguments.step.as_deref());
    overrides.number("simulation.end", arguments.end.as_deref());
    let loaded = load::load(&arguments.model.model, overrides)?;
    let methods: Vec<String> = match arguments.methods.is_empty() {
        true => NAMED.iter().map(|named| named.name.to_string()).collect(),
        false => arguments.methods.clone(),
    };
    let (first, end) = (loaded.step()?, loaded.end()?);
    let (mut rows, mut results) = (Vec::new(), Vec::new());
    for name in &methods {
        let mut choice = load::choice(&loaded, Some(name))?;
        choice.subdivide = Some(false);
        Method::resolve(&choice).map_err(load::method_failure)?;
        let found = largest_step(first, LARGEST_SHARE * end, RATIO, |step| {
            let method = Method::resolve(&choice).expect("the choice was resolved before");
            let Ok(mut simulation) = Simulation::new(&loaded.model.system, method, step) else { return false };
            let mut exploded = false;
            let status = simulation.run(end, &mut |simulation: &Simulation<'_>| {
                let energy = simulation.audit().energy_summary();
                exploded = !energy.last.is_finite() || energy.max_drift > EXPLODED * (energy.initial.abs() + energy.work_total.abs() + 1.0);
                if exploded { Verdict::Stop } else { Verdict::GoOn }
            });
            status == Status::Completed
        });
        let fails = found.fails.map_or("none tried".to_string(), short);
        let completes = if found.completes > 0.0 { short(found.completes) } else { "none".into() };
        rows.push(vec![name.clone(), completes, fails, found.runs.to_string()]);
        results.push(json!({ "method": name, "completes": found.completes, "fails": found.fails, "runs": found.runs }));
    }
    if arguments.json {
        println!("{}", serde_json::to_string_pretty(&results).expect("a result is plain data"));
    } else {
        let header = ["method", "completes s", "fails s", "runs"];
        println!("{}\nlargest step that completes {} s, up to {} s\n", loaded.title(), short(end), short(LARGEST_SHARE * end));
        println!("{}", table(&header, &rows));
    }
    Ok(ExitCode::SUCCESS)
}
