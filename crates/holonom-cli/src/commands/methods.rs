//! `holonom methods`.

use std::process::ExitCode;

use holonom::formulation::{FORMULATIONS, Formulation, ITERATIONS};
use holonom::integrator::{Entry, Estimate, INTEGRATORS, Parameters};
use holonom::projection::{METRICS, SOLVES};
use holonom::simulation::{Choice, Method, NAMED, ProjectionChoice, Promise, combinations};

use crate::failure::Failure;
use crate::options::MethodsArguments;
use crate::table::{list, table};

/// Lists what methods are made of, from the tables the engine itself uses; with a name, all about what bears it.
pub fn methods(arguments: &MethodsArguments) -> Result<ExitCode, Failure> {
    match arguments.name.as_deref() {
        None => println!("{}", overview()),
        Some(name) => println!("{}", explain(name)?),
    }
    Ok(ExitCode::SUCCESS)
}

fn overview() -> String {
    let named = NAMED.iter().map(|named| (named.name, format!("{}; keeps {}", named.doc, kept(&of_name(named.name)))));
    let named: Vec<(&str, String)> = named.collect();
    let plain = |entries: &[(&'static str, &'static str)]| entries.iter().map(|&(name, doc)| (name, doc.to_string())).collect::<Vec<_>>();
    let full_names: Vec<String> = FORMULATIONS.iter().map(Formulation::full_name).collect();
    let formulations: Vec<(&str, String)> =
        FORMULATIONS.iter().zip(&full_names).map(|(line, name)| (name.as_str(), format!("{}: {}", line.source, line.doc))).collect();
    let integrators: Vec<(&str, String)> =
        INTEGRATORS.iter().map(|entry| (entry.name, format!("{}; {}", entry.doc, entry.use_for))).collect();
    let levels = [("velocity", "(10), (11): Φ̇ = 0".to_string()), ("acceleration", "(12), (13): Φ̈ = 0".to_string())];
    let iterations: Vec<(&str, String)> = ITERATIONS.iter().map(|&(name, _, doc)| (name, doc.to_string())).collect();
    let sections = [
        ("methods by name (--method, or method = in [simulation])", list(&named)),
        ("formulation (with index = in [simulation]: lagrange-2 is lagrange with index 2)", list(&formulations)),
        ("integrator", list(&integrators)),
        ("iteration", list(&iterations)),
        ("projection.levels", list(&levels)),
        ("projection.matrix", list(&plain(METRICS))),
        ("projection.solve", list(&plain(SOLVES))),
        ("what goes together: order of positions, velocities, reactions; p with projection of velocities", matrix()),
    ];
    let text: Vec<String> = sections.iter().map(|(title, body)| format!("{title}\n{body}")).collect();
    format!(
        "{}\n\n{} combinations; any of them is a --method FORMULATION/INTEGRATOR-ORDER/LEVELS, such as lagrange-2/bdf-3/velocity.\n\
         `holonom methods NAME` says all about one.",
        text.join("\n\n"),
        combinations().len()
    )
}

/// Formulations × integrators, with the orders of the integrator's usual member.
fn matrix() -> String {
    let header: Vec<&str> = std::iter::once("").chain(INTEGRATORS.iter().map(|entry| entry.name)).collect();
    let rows = FORMULATIONS.iter().map(|line| {
        let cells = INTEGRATORS.iter().map(|entry| match entry.goes_with(line) {
            true => orders(line, entry, entry.orders[0], " "),
            false => "·".into(),
        });
        std::iter::once(line.full_name()).chain(cells).collect()
    });
    table(&header, &rows.collect::<Vec<_>>())
}

/// Orders without and with projection, such as `2 0 0 p 2 2 2`.
fn orders(line: &Formulation, entry: &Entry, order: u8, gap: &str) -> String {
    let parameters = Parameters { order, ..Parameters::default() };
    let text = |projected: bool| (entry.convergence)(&parameters, line, projected).map(|order| order.to_string()).join(gap);
    let short = |orders: String| match orders.split(gap).all(|order| orders.starts_with(order)) {
        true => orders.split(gap).next().unwrap_or_default().to_string(),
        false => orders,
    };
    let projects = entry.projects && !line.doubled && !line.soft;
    match projects && text(true) != text(false) {
        true => format!("{} p{}", short(text(false)), short(text(true))),
        false => short(text(false)),
    }
}

/// Everything about one name.
fn explain(name: &str) -> Result<String, Failure> {
    let mut parts = Vec::new();
    if let Some(named) = NAMED.iter().find(|named| named.name == name) {
        parts.push(format!("method {name}\n{}", list(&of_method(&of_name(name), named.doc))));
    }
    for line in FORMULATIONS.iter().filter(|line| line.full_name() == name || line.name == name) {
        parts.push(format!("formulation {}\n{}", line.full_name(), list(&of_formulation(line))));
    }
    if let Some(entry) = INTEGRATORS.iter().find(|entry| entry.name == name) {
        parts.push(format!("integrator {name}\n{}", list(&of_integrator(entry))));
    }
    let plain = ITERATIONS.iter().map(|&(own, _, doc)| ("iteration", own, doc));
    let plain = plain.chain(METRICS.iter().map(|&(own, doc)| ("projection.matrix", own, doc)));
    let plain = plain.chain(SOLVES.iter().map(|&(own, doc)| ("projection.solve", own, doc)));
    parts.extend(plain.filter(|(_, own, _)| *own == name).map(|(kind, own, doc)| format!("{kind} {own}\n  {doc}")));
    if parts.is_empty() {
        let choice = Choice { method: Some(name.into()), ..Choice::default() };
        let method = Method::resolve(&choice).map_err(|error| Failure::usage(error.to_string(), "`holonom methods` lists every name"))?;
        parts.push(format!("method {name}\n{}", list(&of_method(&method, method.integrator.doc))));
    }
    Ok(parts.join("\n\n"))
}

/// A method that has a name.
fn of_name(name: &str) -> Method {
    let choice = Choice { method: Some(name.into()), ..Choice::default() };
    Method::resolve(&choice).expect("a named method goes together")
}

/// What a method promises for every step.
fn kept(method: &Method) -> String {
    let words: Vec<&str> = method.promises().into_iter().map(Promise::words).collect();
    if words.is_empty() { "nothing exactly".into() } else { words.join(", ") }
}

fn of_method(method: &Method, doc: &str) -> Vec<(&'static str, String)> {
    let [q, v, lambda] = method.convergence();
    vec![
        ("is", doc.into()),
        ("formulation", format!("{}, {}: {}", method.formulation.full_name(), method.formulation.source, method.formulation.doc)),
        ("integrator", format!("{}, {}: {}", method.integrator.name, method.integrator.source, method.integrator.doc)),
        ("order", format!("{q} in positions, {v} in velocities, {lambda} in reactions")),
        ("keeps", kept(method)),
        ("take it for", method.integrator.use_for.into()),
    ]
}

fn of_formulation(line: &Formulation) -> Vec<(&'static str, String)> {
    let partners = INTEGRATORS.iter().filter(|entry| entry.goes_with(line)).map(|entry| entry.name);
    let projections = if line.doubled || line.soft { "none" } else { "velocity, acceleration" };
    vec![
        ("is", line.doc.into()),
        ("source", line.source.into()),
        ("index", line.index.to_string()),
        ("keeps", line.keeps.into()),
        ("integrators", partners.collect::<Vec<_>>().join(", ")),
        ("iterations", line.iterations.join(", ")),
        ("projections", projections.into()),
    ]
}

fn of_integrator(entry: &Entry) -> Vec<(&'static str, String)> {
    let estimates = |order: u8| {
        let choice = Choice {
            integrator: Some(entry.name.into()),
            order: Some(order),
            accuracy: Some(1e-6),
            projection: entry.projects.then(|| ProjectionChoice { levels: Some(vec!["velocity".into()]), ..ProjectionChoice::default() }),
            ..Choice::default()
        };
        let bare = Choice { projection: None, ..choice.clone() };
        Method::resolve(&choice).is_ok() || Method::resolve(&bare).is_ok()
    };
    let by_accuracy: Vec<String> = entry.orders.iter().filter(|order| estimates(**order)).map(u8::to_string).collect();
    let accuracy = match (by_accuracy.is_empty(), entry.estimate) {
        (true, _) => "no: it has no error estimate".to_string(),
        (false, Estimate::History) => format!("yes, order {}; errors from the steps before", by_accuracy.join(", ")),
        (false, _) => format!("yes, order {}", by_accuracy.join(", ")),
    };
    let convergence = entry.orders.iter().map(|&order| {
        let of_partners = entry.formulations().map(|line| format!("{} {}", line.full_name(), orders(line, entry, order, " ")));
        format!("order {order}: {}", of_partners.collect::<Vec<_>>().join(", "))
    });
    let mut items = vec![
        ("is", entry.doc.into()),
        ("source", entry.source.into()),
        ("take it for", entry.use_for.into()),
        ("iterations", entry.iterations.join(", ")),
        ("projections", if entry.projects { "velocity, acceleration".into() } else { "none: not needed".to_string() }),
        ("accuracy", accuracy),
    ];
    if !entry.keeps.is_empty() {
        items.push(("keeps", format!("{}, beside what the formulation keeps", entry.keeps)));
    }
    items.extend(convergence.map(|line| ("partners", line)));
    items
}
