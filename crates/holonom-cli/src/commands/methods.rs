//! `holonom methods`.

use std::process::ExitCode;

use holonom::formulation::{FORMULATIONS, ITERATIONS};
use holonom::integrator::INTEGRATORS;
use holonom::projection::{METRICS, SOLVES};
use holonom::simulation::NAMED;

use crate::failure::Failure;
use crate::options::MethodsArguments;
use crate::table::list;

/// Lists what methods are made of, from the tables the engine itself uses; with a name, only what bears it.
pub fn methods(arguments: &MethodsArguments) -> Result<ExitCode, Failure> {
    let sections = sections();
    let wanted = |name: &str| arguments.name.as_deref().is_none_or(|wanted| wanted == name);
    let mut shown = 0;
    for (title, entries) in &sections {
        let entries: Vec<(&str, String)> =
            entries.iter().filter(|(name, _)| wanted(name)).map(|(name, doc)| (*name, doc.clone())).collect();
        if !entries.is_empty() {
            println!("{}{title}\n{}", if shown > 0 { "\n" } else { "" }, list(&entries));
            shown += entries.len();
        }
    }
    match (&arguments.name, shown) {
        (Some(name), 0) => Err(Failure::usage(format!("nothing is called `{name}`"), "`holonom methods` lists every name")),
        _ => Ok(ExitCode::SUCCESS),
    }
}

type Section = (&'static str, Vec<(&'static str, String)>);

fn sections() -> Vec<Section> {
    let named = NAMED.iter().map(|named| (named.name, format!("{}; keeps {}", named.doc, named.keeps)));
    let formulations = FORMULATIONS.iter().map(|line| (line.name, format!("{}: {}", line.source, line.doc)));
    let integrators = INTEGRATORS.iter().map(|entry| {
        let projections = if entry.projects { "projections: yes" } else { "projections: not needed" };
        let partners = format!("with {}; iterations {}; {projections}", entry.formulations.join(", "), entry.iterations.join(", "));
        (entry.name, format!("{}: {}\n{:18}{partners}", entry.source, entry.doc, ""))
    });
    let plain = |entries: &[(&'static str, &'static str)]| entries.iter().map(|&(name, doc)| (name, doc.to_string())).collect();
    vec![
        ("methods by name (--method, or method = in [simulation])", named.collect()),
        ("formulation", formulations.collect()),
        ("integrator", integrators.collect()),
        ("iteration", ITERATIONS.iter().map(|&(name, _, doc)| (name, doc.to_string())).collect()),
        ("projection.levels", vec![("velocity", "(10), (11): Φ̇ = 0".into()), ("acceleration", "(12), (13): Φ̈ = 0".into())]),
        ("projection.matrix", plain(METRICS)),
        ("projection.solve", plain(SOLVES)),
    ]
}
