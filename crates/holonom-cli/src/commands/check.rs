//! `holonom check`.

use std::process::ExitCode;

use holonom::analysis::{Rank, forks, projection_form, rank_of, undetermined};
use holonom::model::{Model, StartChange, Value};
use holonom::projection::Solve;
use holonom::simulation::{Conflict, Method, ModelSize, PENALTY, Simulation};
use holonom_io::Source;
use serde_json::json;

use crate::failure::Failure;
use crate::found::Found;
use crate::load::{self, Loaded};
use crate::message::{listed, unused_parameters};
use crate::notes::{changes_in_words, nowhere, open_columns, rivals, strikes};
use crate::options::CheckArguments;
use crate::table::{freedom, list, short};

/// Validates a model and says what it is made of.
pub fn check(arguments: &CheckArguments) -> Result<ExitCode, Failure> {
    let (source, name) = load::open(&arguments.model.model, &load::overrides(&arguments.model.set))?;
    let Found { value, text } = checked(source, &name, arguments.projection)?;
    match arguments.json {
        true => println!("{}", serde_json::to_string_pretty(&value).expect("a result is plain data")),
        false => println!("{text}"),
    }
    Ok(ExitCode::SUCCESS)
}

/// Validates a model and says what it is made of; with the projection, what that of its method can do to the energy.
///
/// # Errors
/// A model that is not sound, or that cannot start.
pub fn checked(source: Source, name: &str, with_projection: bool) -> Result<Found, Failure> {
    let loaded = Loaded { model: source.model().map_err(Failure::Model)?, name: name.into(), source };
    let system = &loaded.model.system;
    let method = load::method(&loaded.model, None)?;
    let projection = method.projection.clone();
    let name = method.name.clone();
    let step = loaded.step().unwrap_or(1e-3);
    let mut more = loaded.model.times().map_or(Vec::new(), |[step, end]| loaded.model.unseen(&method, step, end));
    let mut simulation = Simulation::new(system.clone(), method, step).map_err(load::start_failure)?;
    let size = rank_of(&mut simulation).size(system);
    let changes = loaded.model.start_changes(&simulation.state().x, simulation.velocities());
    more.extend(strikes(&loaded.model, &changes));
    let (start, audit) = (simulation.start().clone(), simulation.audit().clone());
    let form = match with_projection {
        true => {
            let alpha = if let Solve::Penalty(alpha) = projection.solve { alpha } else { PENALTY };
            let form = projection_form(system, &projection, alpha, step);
            Some(form.ok_or_else(|| Failure::usage("the mass matrix is not positive definite", "give every free point some mass"))?)
        }
        false => None,
    };
    let (title, gravity) = (loaded.title().to_string(), loaded.gravity());
    // The room that the simulation and its model take is for the next ones. Bodies that share nodes have no rows where they are joined: what holds
    // what is asked of the model without sharing.
    drop(simulation);
    let Loaded { model, source, name: own } = loaded;
    drop(model);
    let apart = |source: &Source| {
        let mut apart = source.clone();
        apart.put("output.reactions", Value::Bool(true)).map_err(Failure::Model)?;
        Held::of(&apart, step)
    };
    // Where rows of every joint by itself forbid what these bodies together may do, as places and axes have too few digits, a run goes on all the same.
    let (plain, mut held, is_apart) = match apart(&source) {
        Ok((plain, held)) => (plain, held, true),
        Err(_) => {
            let (model, mut held) = Held::of(&source, step)?;
            held.notes.push(ONLY_SHARED.into());
            (model, held, false)
        }
    };
    held.notes.extend(unused_parameters(&source));
    held.notes.extend(more);
    // What asks for too much has a line of its own.
    held.notes.extend(nowhere(&start).filter(|_| held.conflict.is_none()));
    let found = &held.rank;
    let near = found.near_singular(&plain.system);
    let change = |change: &StartChange| {
        json!({
            "name": change.name, "velocity": change.velocity, "angular_velocity": change.angular_velocity,
            "was_at_rest": change.was_at_rest,
        })
    };
    let changed: Vec<_> = changes.iter().map(change).collect();
    let mut value = json!({
        "model": own, "method": name, "coordinates": size.coordinates, "constraints": size.constraints,
        "rank": size.rank, "redundant": size.redundant, "dof": size.dof, "redundant_rows": found.redundant,
        "rows_in_redundancies": held.involved, "reactions_not_unique": held.not_unique, "notes": held.notes,
        "conflict": held.conflict.as_ref().map(|conflict| &conflict.row), "near_singular": near, "singular": held.forks, "moved": start.moved, "start_changes": changed,
        "residual": { "position": audit.phi, "velocity": audit.phi_dot, "acceleration": audit.phi_ddot },
        "energy": { "kinetic": audit.kinetic, "potential": audit.potential + audit.lift },
    });
    if let Some(form) = &form {
        value["projection"] = json!({
            "growth": form.growth, "dissipative": form.dissipative,
            "condition": form.condition, "growth_bound": form.growth_bound,
        });
    }
    let redundant = match (found.redundant.is_empty(), &held.conflict) {
        (true, _) if !is_apart => "none".into(),
        (true, _) => none_redundant(size.redundant),
        (false, None) => format!("{}: these follow from the others and may stay", listed(&found.redundant)),
        (false, Some(_)) => format!("{}: these follow from the others", listed(&found.redundant)),
    };
    let reactions = match (found.redundant.is_empty(), held.not_unique.is_empty()) {
        _ if !is_apart => "not known, as bodies share nodes".to_string(),
        (true, _) => "all are unique".to_string(),
        (false, true) => "those of all joints are unique; multipliers of single rows are not".to_string(),
        (false, false) => format!("not unique: {}; all others are", listed(&held.not_unique)),
    };
    let singular = match (near, &found.weakest) {
        _ if held.forks => "yes: redundant rows are so at this position alone, where it can go on in several ways, or cannot go where the freedom counts it".into(),
        (Some((row, independence)), _) => format!("yes: `{row}` adds only {} of itself to the others", short(*independence)),
        (None, Some((row, independence))) => format!("no: the weakest row is `{row}` with {}", short(*independence)),
        (None, None) => "no constraints".to_string(),
    };
    let velocities = if changes.is_empty() { "none".to_string() } else { changes_in_words(&changes) };
    let corrected = format!("positions by {} m; velocities: {velocities}", short(start.moved));
    let mut items = vec![
        ("size", sizes(&size, &held.size)),
        ("freedom", freedom(size.dof as u64)),
        ("redundant", redundant),
        ("reactions", reactions),
        ("singular", singular),
        ("corrected", corrected),
        ("residual", format!("position {}, velocity {}, acceleration {}", short(audit.phi), short(audit.phi_dot), short(audit.phi_ddot))),
        ("energy", format!("kinetic {} J, potential {} J", short(audit.kinetic), short(audit.potential + audit.lift))),
        ("gravity", gravity),
        ("method", name),
    ];
    if let Some(conflict) = &held.conflict {
        items.insert(3, ("conflict", format!("in the first step {conflict}")));
    }
    let mut text = format!("{title}\n{}", list(&items));
    held.notes.iter().for_each(|note| text.push_str(&format!("\nnote: {note}")));
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
        text.push_str(&format!("\n\nvelocity projection at the start\n{}", list(&items)));
    }
    Ok(Found { value, text })
}

/// Coordinates and rows as they are solved, and where bodies share nodes those of every body and joint by itself, which redundancies
/// are told by.
fn sizes(solved: &ModelSize, plain: &ModelSize) -> String {
    let words = |size: &ModelSize| format!("{} coordinates, {} rows of rank {}", size.coordinates, size.constraints, size.rank);
    match solved == plain {
        true => words(solved),
        false => format!("{}; without shared nodes {}", words(solved), words(plain)),
    }
}

/// That no row is redundant but so many of the rows that are solved, where bodies share nodes.
fn none_redundant(solved: usize) -> String {
    match solved {
        0 => "none".into(),
        1 => "none without shared nodes; with them one row follows from the others, which makes no difference".into(),
        count => format!("none without shared nodes; with them {count} rows follow from the others, which makes no difference"),
    }
}

/// What holds a model, row by row.
struct Held {
    rank: Rank,
    size: ModelSize,
    /// Rows that take part in a redundancy.
    involved: Vec<String>,
    /// Components of forces and moments of joints that redundancies leave undetermined.
    not_unique: Vec<String>,
    /// Whether what follows from others does so at this position alone.
    forks: bool,
    /// A row that asks for what the others do not allow.
    conflict: Option<Conflict>,
    /// What looks like a slip.
    notes: Vec<String>,
}

/// What is noted of a model that can begin with shared nodes alone.
const ONLY_SHARED: &str = "rank and redundant rows are those of bodies that share nodes: the rows of every joint by itself do not allow the motion that the start \
                           has, as places or axes are off by a little (write them with all digits)";

impl Held {
    /// Of the model of a source, with that.
    fn of(source: &Source, step: f64) -> Result<(Model, Self), Failure> {
        let model = source.model().map_err(Failure::Model)?;
        let held = Self::new(&model, load::method(&model, None)?, step)?;
        Ok((model, held))
    }

    fn new(model: &Model, method: Method, step: f64) -> Result<Self, Failure> {
        let mut simulation = Simulation::new(model.system.clone(), method, step).map_err(load::start_failure)?;
        let conflict = simulation.conflict();
        let rank = rank_of(&mut simulation);
        let x = &simulation.state().x;
        let size = rank.size(&model.system);
        let (mut involved, mut not_unique) = (Vec::new(), Vec::new());
        let free = if rank.redundant.is_empty() { None } else { undetermined(&model.system, x, 0.0) };
        if let Some(free) = free {
            involved = free.rows().into_iter().map(|row| model.system.row_names()[row].clone()).collect();
            not_unique = open_columns(&free, &model.channels, model);
        }
        let forks = !rank.redundant.is_empty() && forks(&model.system) == Some(true);
        let mut notes = notes(model);
        notes.extend(rivals(&mut simulation, &rank).filter(|_| conflict.is_none()));
        Ok(Self { rank, size, involved, not_unique, forks, conflict, notes })
    }
}

/// Radius of gyration over the distance of what a body holds, beyond which units are probably mixed up.
const PROBABLE: f64 = 30.0;

/// Share of the radius of gyration within which what a body holds is at its centre, but for rounding.
const AT_CENTRE: f64 = 1e-6;

/// What was noted while the model was read, and bodies whose inertia does not go with their size.
fn notes(model: &Model) -> Vec<String> {
    let mut notes = model.notes.clone();
    for (body, drawn) in model.bodies.iter().zip(&model.scene.bodies) {
        let reach = drawn.places.iter().map(|place| place.iter().map(|c| c * c).sum::<f64>().sqrt()).fold(0.0, f64::max);
        // In the plane the moment about the normal, in space half the sum of all three.
        let share = if model.system.dimension() == 2 { 1.0 } else { 0.5 };
        let gyration = (share * body.inertia.trace() / body.mass).sqrt();
        if reach > AT_CENTRE * gyration && !(reach / PROBABLE..=reach * PROBABLE).contains(&gyration) {
            notes.push(format!(
                "the radius of gyration of `{}` is {} m, while its joints are within {} m of its centre: check mass, inertia and units",
                body.name,
                short(gyration),
                short(reach)
            ));
        }
    }
    notes
}
