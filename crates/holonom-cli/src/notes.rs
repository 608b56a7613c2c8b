//! What is said of a run beside its results: slips in the model, what was put right before the start, and what has no value or more than one.

use std::collections::HashSet;

use holonom::analysis::{self, Modes, Rank, Undetermined, is_at_rest, way_ahead};
use holonom::formulation::Multipliers;
use holonom::model::{Model, StartChange};
use holonom::record::{Channels, RecordedJoint, Recording, Where};
use holonom::simulation::{Simulation, Start};

use crate::load::Loaded;
use crate::message::{listed, unused_parameters};
use crate::table::short;

/// Positions over the size of the mechanism that round-off moves at the start.
const ROUNDED: f64 = 1e-12;

/// Share of the way that forces would move a mechanism that is none.
const HARDLY: f64 = 1e-3;

/// Most rows for which a run says which forces are not unique: it takes a time that grows with their cube.
const FEW_ROWS: usize = 200;

/// Which of the forces that a run has recorded redundant rows leave undetermined.
pub fn shared_forces(model: &Model, simulation: &Simulation, recording: &Recording) -> Option<String> {
    simulation.reactions().filter(|_| unforced_rows(model, recording).len() < recording.rows())?;
    let free = analysis::undetermined_of(simulation, FEW_ROWS).filter(|free| free.count() > 0)?;
    let open = open_columns(&free, model.channels.told(), model);
    let named = (!open.is_empty()).then(|| listed(&open))?;
    Some(format!(
        "redundant constraints leave open how they share forces: one way of many is shown for {named} (a bushing in place of a joint decides it)"
    ))
}

/// Components of forces and moments of joints and constraints, efforts of drives and couplers, and tensions of rods, that are left undetermined:
/// `hinge.fy .tx`, `motor.effort`.
pub fn open_columns(free: &Undetermined<'_>, channels: &Channels, model: &Model) -> Vec<String> {
    let (mut open, world) = (Vec::new(), &*free.positions());
    for (k, joint) in channels.joints.iter().enumerate() {
        let about = free.system().of_world(joint.place(world, model.dimension));
        let unique = free.are_unique(&joint.rows, &joint.nodes, about, |lambda| channels.borne(k, lambda, world));
        let columns = RecordedJoint::columns(model.axes);
        let columns: Vec<&str> = columns.iter().filter(|(k, _)| !unique[*k]).map(|(_, column)| column.as_str()).collect();
        if !columns.is_empty() {
            open.push(format!("{}.{}", joint.name, columns.join(" .")));
        }
    }
    let shared: HashSet<usize> = free.rows().into_iter().collect();
    let efforts = channels.efforts.iter().map(|effort| (&effort.name, effort.row));
    let couplings = channels.couplings.iter().map(|coupling| (&coupling.name, coupling.row));
    let efforts = efforts.chain(couplings).filter(|(_, row)| shared.contains(row));
    open.extend(efforts.map(|(name, _)| format!("{name}.effort")));
    let pushes = channels.transmissions.iter().filter(|push| shared.contains(&push.row));
    open.extend(pushes.map(|push| format!("{}.f{}", push.name, model.axes.chars().map(String::from).collect::<Vec<_>>().join(" .f"))));
    let rods = channels.rods.iter().filter(|rod| shared.contains(&rod.row));
    open.extend(rods.map(|rod| format!("{}.force", rod.name)));
    let at = Where { at: free.evaluation(), x: world, dim: model.dimension, t: free.time() };
    for hold in &channels.holds {
        let (columns, components) = (hold.columns(model.axes), hold.components(model.dimension));
        let unique = free.exerted_are_unique(hold.is_moment(), |lambda| hold.exerted(lambda, at));
        for (owner, unique) in hold.owners.iter().zip(unique) {
            let columns = columns.iter().zip(components.clone()).filter(|(_, k)| !unique[*k]);
            let columns: Vec<&str> = columns.map(|(column, _)| column.as_str()).collect();
            if !columns.is_empty() {
                open.push(format!("{owner}.{}", columns.join(" .")));
            }
        }
    }
    open
}

/// Measures that have no value in some rows.
pub fn unknown_measures(model: &Model, recording: &Recording) -> Vec<String> {
    let rows = recording.rows();
    let unforced = unforced_rows(model, recording);
    let noted = |name: &String| {
        let unknown: Vec<usize> =
            recording.column(name)?.iter().enumerate().filter(|(_, value)| !value.is_finite()).map(|(row, _)| row).collect();
        let first = unknown.first()?;
        let why = if unforced.contains(first) {
            "what it reads has none in the first of them, as no forces of joints and no accelerations are known there"
        } else {
            "a formula is outside its domain there"
        };
        Some(format!("the measure `{name}` has no finite value in {} of {rows} rows: {why}", unknown.len()))
    };
    model.channels.measures.iter().filter_map(|measure| noted(&measure.name)).collect()
}

/// Rows without forces of joints and drives, but for those in which other forces have no value, either, which is why.
fn unforced_rows(model: &Model, recording: &Recording) -> Vec<usize> {
    let told = model.channels.told();
    let of_joints = told.joints.iter().find(|joint| joint.is_known).map(|joint| format!("{}.f{}", joint.name, &model.axes[..1]));
    let of_drives = told.efforts.first().map(|effort| format!("{}.effort", effort.name));
    let of_rods = told.rods.first().map(|rod| format!("{}.force", rod.name));
    let of_others = || told.holds.iter().find_map(|hold| hold.acts(model.axes).next()).map(|(_, columns)| columns[0].clone());
    let name = of_joints.or(of_drives).or(of_rods).or_else(of_others);
    let Some(column) = name.and_then(|name| recording.column(&name)) else { return Vec::new() };
    let names = model.channels.forces.iter().flat_map(|force| force.acts(model.axes)).flatten();
    let forces: Vec<&[f64]> = names.filter_map(|name| recording.column(&name)).collect();
    let lacks_force = |row: usize| forces.iter().any(|values| values[row].is_nan());
    column.iter().enumerate().filter(|(row, force)| force.is_nan() && !lacks_force(*row)).map(|(row, _)| row).collect()
}

/// That rows have no forces of joints, as the position is singular there, or none has, as rows that follow from others by how they are meant do not by how
/// they are written.
pub fn rows_without_forces(model: &Model, recording: &Recording) -> Option<String> {
    let unforced = unforced_rows(model, recording);
    let first = recording.column("t")?[*unforced.first()?];
    if unforced.len() == recording.rows() {
        let message = "no row has accelerations, or forces of joints and drives: constraints follow from others there but for little, at a singular position, or as \
                       places and axes are written with too few digits";
        return Some(message.into());
    }
    let rows = if unforced.len() == 1 { "one row has".into() } else { format!("{} rows have", unforced.len()) };
    Some(format!(
        "{rows} no accelerations and no forces of joints and drives, first at {} s: at a singular position they do not follow from places and velocities",
        short(first)
    ))
}

/// Share of the energy that could move from which on it is said that a method has made or lost it.
const LOST: f64 = 0.01;

/// That a method has made or lost much of the energy. Where nothing is free to move, the energy is that of the drives at any step, and only their work is off.
fn lost_energy(simulation: &Simulation, is_free: bool) -> Option<String> {
    let [made, supply] = simulation.made_energy();
    let did = if made > 0.0 { "made" } else { "lost" };
    (made.abs() > LOST * supply).then(|| {
        let (made, supply) = (short(made.abs()), short(supply));
        match is_free {
            true => format!(
                "the method has {did} {made} J of the {supply} J that could move: shorter steps show what that changes, and conserving-ggl keeps the energy"
            ),
            false => format!(
                "the work of the drives, which lead all that moves, is booked {made} J off the energy, of {supply} J that could move (a shorter step, or conserving-ggl)"
            ),
        }
    })
}

/// Parts of a nominal step from which on it is said how many there are.
const MANY_PARTS: f64 = 10.0;

/// In how many parts nominal steps were taken on average, beside those that events end, where they are many.
pub fn many_parts(simulation: &Simulation) -> Option<f64> {
    let steps = simulation.steps();
    let taken = simulation.audit().work_summary(steps).steps_taken.saturating_sub(simulation.times_of_events());
    let parts = taken as f64 / steps.max(1) as f64;
    (simulation.method().accuracy.is_none() && parts >= MANY_PARTS).then_some(parts)
}

/// That nominal steps were taken in many parts, as they failed as a whole.
fn in_parts(simulation: &Simulation) -> Option<String> {
    // What is advised is another method than that of the run.
    let others = match simulation.method().name.as_str() {
        "conserving-ggl" => "radau often takes longer steps",
        _ => "conserving-ggl and radau take longer steps than most",
    };
    many_parts(simulation).map(|parts| {
        format!(
            "nominal steps failed as a whole and were taken in {parts:.0} parts on average, as if the step were {} s ({others} where redundant or singular \
             constraints are why)",
            short(simulation.nominal_step() / parts)
        )
    })
}

/// Steps by accuracy from which on it is said that another method takes fewer: one of order 5 seldom needs as many.
const MANY_STEPS: u64 = 50_000;

/// That the accuracy took very many steps, and which method takes fewer.
fn many_steps(simulation: &Simulation) -> Option<String> {
    let (method, steps) = (simulation.method(), simulation.audit().work_summary(simulation.steps()).steps_taken);
    let is_radau = method.integrator.name == "radau" && method.order() == 5;
    let accuracy = method.accuracy.filter(|_| steps >= MANY_STEPS && !is_radau)?;
    let others = match (method.order(), method.integrator.is_explicit()) {
        (..=2, _) => "one of order 5 takes far fewer: `radau`",
        (_, true) => "`radau` takes far fewer where something is stiff",
        _ => "`radau` often takes fewer",
    };
    Some(format!("`{}` took {steps} steps for an accuracy of {}: {others}", method.name, short(accuracy)))
}

/// That steps are too long for how forces without a potential change along the way, so that the energy is booked and yet wrong.
fn unsure_work(simulation: &Simulation) -> Option<String> {
    let (unsure, supply, name) = simulation.unsure_work()?;
    (unsure > LOST * supply).then(|| {
        format!(
            "the work of forces without a potential may be wrong by {} J of the {} J that could move, most of it that of `{name}`: steps are long for \
             how it changes along the way, and the balance cannot show that (a shorter step or an accuracy; a spring, a stop or an energy keeps its \
             energy at any step)",
            short(unsure),
            short(supply)
        )
    })
}

/// That forces, as those of contacts, act for a few steps only, so that their largest values are missed.
fn brief_forces(simulation: &Simulation) -> Option<String> {
    let told = |(name, t, steps): (&str, f64, f64)| {
        let steps = steps.round().max(1.0);
        format!("`{name}` for {steps} step{} at {} s", if steps > 1.0 { "s" } else { "" }, short(t))
    };
    let told: Vec<String> = simulation.brief_forces().into_iter().map(told).collect();
    (!told.is_empty()).then(|| {
        format!(
            "forces act for so few steps that their largest values may be far more than what is shown: {} (a shorter step or an accuracy)",
            listed(&told)
        )
    })
}

/// That what moves goes to and fro, or round, so fast that a step passes much of a period of it.
pub fn hasty(simulation: &Simulation) -> Option<String> {
    simulation.is_hasty().then(|| {
        format!(
            "much of the kinetic energy is in what vibrates or turns by a radian or more in each step: a method of order {} has it too slow where nothing drives it, and \
             recorded rows miss its largest values (a shorter step or an accuracy sees it; a vibration that does not matter is damped by radau and generalized-alpha)",
            simulation.method().convergence()[0]
        )
    })
}

/// That the forces that hold the constraints jump from one step to the next.
fn restless(simulation: &Simulation) -> Option<String> {
    simulation.is_restless().then(|| {
        "the forces by which the method holds the constraints jump by about as much as they are from one step to the next: steps are too long for it, or for a \
         vibration, and places and forces of joints may be far off (a shorter step; conserving-ggl and radau take longer ones than most)"
            .into()
    })
}

/// Share of the mechanism's size from which on it is said that positions are off their constraints.
const STRAYED: f64 = 1e-3;

/// That positions were far off a constraint: by methods that do not hold them, such as those of a penalty.
fn strayed(simulation: &Simulation) -> Option<String> {
    let (name, way, share) = simulation.strayed().filter(|(_, _, share)| *share > STRAYED)?;
    let settings = &simulation.method().settings;
    let cure = match settings.multipliers {
        Multipliers::Penalty(_) => {
            "rows of a penalty are springs, which a larger `penalty` makes stiffer, and augmented-lagrangian holds them"
        }
        _ if settings.iterations.is_some() => "more `iterations` or shorter steps hold it",
        _ => "shorter steps drift less, and conserving-ggl holds it",
    };
    Some(format!("positions were up to {} m off `{name}`, {} % of the mechanism's size: {cure}", short(way), short(100.0 * share)))
}

/// Share of the largest velocity from which on it is said that velocities are off their constraints: of the run, and at its end.
const SLIPPED: f64 = 0.01;
const SLIPS: f64 = 0.1;

/// That velocities were far off a constraint, or are at the end: by methods that hold positions only.
fn slipped(simulation: &Simulation) -> Option<String> {
    let far = simulation.slipped().filter(|(_, _, share)| *share > SLIPPED).map(|slip| (slip, ["were up to", "of the largest"]));
    let at_rest =
        || simulation.slips().filter(|(_, _, share)| *share > SLIPS).map(|slip| (slip, ["are still", "of the largest at the end"]));
    let ((name, off, share), [are, largest]) = far.or_else(at_rest)?;
    Some(format!(
        "velocities {are} {} m/s off `{name}`, {:.0} % {largest}: rates, energies and work are as far off (a shorter step, or conserving-ggl \
         or radau, which hold velocities as well)",
        short(off),
        100.0 * share
    ))
}

/// Sine of 45°, beyond which the moment of a bushing falls.
const STEEPEST: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// That bushings with moments turned farther than these rise.
pub fn turned_bushings(model: &Model, recording: &Recording) -> Option<String> {
    let times = recording.column("t")?;
    let columns = |names: Vec<String>| names.iter().filter_map(|name| recording.column(name)).collect::<Vec<_>>();
    let mut turned: Vec<(f64, String)> = Vec::new();
    for force in &model.channels.forces {
        let sines = columns(force.sines());
        // Of a rotation about any axis that is the size of the three.
        let sine = |row: usize| sines.iter().map(|values| values[row] * values[row]).sum::<f64>().sqrt();
        let Some(row) = (0..times.len()).find(|&row| sine(row) > STEEPEST) else { continue };
        let moments = columns(force.acts(model.axes).pop().unwrap_or_default());
        if moments.iter().any(|values| values.iter().any(|moment| *moment != 0.0)) {
            turned.push((times[row], format!("`{}`", force.name)));
        }
    }
    let first = turned.iter().map(|(t, _)| *t).reduce(f64::min)?;
    let names: Vec<String> = turned.into_iter().map(|(_, name)| name).collect();
    Some(format!(
        "{} turned by more than 45°, first at {} s: beyond it the moment of a bushing, k sin θ cos θ, falls, and beyond 90° it pushes on (for large rotations \
         take a joint with a `torsion` spring, of moment k θ)",
        listed(&names),
        short(first)
    ))
}

/// That redundant rows have held what is free to move and is not at rest without them.
fn jammed(simulation: &Simulation, rank: &Rank) -> Option<String> {
    let (system, x) = (simulation.system(), &simulation.state().x);
    let is_held = rank.size(system).dof > 0 && !rank.redundant.is_empty() && !system.is_driven() && simulation.steps() > 0;
    let moved = x.iter().zip(system.start_position()).fold(0.0, |moved: f64, (x, start)| moved.max((x - start).abs()));
    let is_held = is_held && moved <= ROUNDED * farthest(x);
    (is_held && way_ahead(system, simulation.state().t).is_some_and(|way| moved < HARDLY * way)).then(|| {
        "nothing has moved: constraints that follow from the others (redundant) hold what these leave free, as they differ from them in the last digits that are \
         written, as those of hinges whose axes are a little off (write places and axes with all digits, or put a bushing in place of a joint)"
            .into()
    })
}

/// What is not sure of the results of a run, as far as the simulation itself knows at its end; whether something is free to move is for the rank to say.
pub fn doubts(simulation: &Simulation, rank: &Rank, completed: bool) -> impl Iterator<Item = String> {
    let is_free = rank.size(simulation.system()).dof > 0;
    let of_whole = lost_energy(simulation, is_free).into_iter().chain(unsure_work(simulation)).chain(restless(simulation));
    of_whole
        .chain(jammed(simulation, rank))
        .filter(move |_| completed)
        .chain(strayed(simulation))
        .chain(slipped(simulation))
        .chain(in_parts(simulation))
        .chain(brief_forces(simulation))
        .chain(many_steps(simulation))
}

/// What looks like a slip, and what was put right before the start.
pub fn notes(loaded: &Loaded, simulation: &Simulation) -> Vec<String> {
    let model = &loaded.model;
    let unseen = model.settings.end.map_or(Vec::new(), |end| model.unseen(simulation.method(), simulation.nominal_step(), end));
    slips(loaded).chain(corrections(model, simulation)).chain(unseen).collect()
}

/// What looks like a slip in a model, or in how it is run.
pub fn slips(loaded: &Loaded) -> impl Iterator<Item = String> {
    unused_parameters(&loaded.source).into_iter().chain(loaded.model.notes.clone())
}

/// What was put right before the start, and what the rank there says of drives and of what could move.
pub fn of_start(model: &Model, simulation: &mut Simulation, rank: &Rank) -> Vec<String> {
    let mut notes = corrections(model, simulation);
    notes.extend(locked(model, rank).or_else(|| rivals(simulation, rank)));
    notes.extend(struck(model, simulation, rank));
    notes.extend(unbalanced(model, simulation, rank));
    notes
}

/// That a run of the start alone shows forces of what begins to move from rest.
fn unbalanced(model: &Model, simulation: &mut Simulation, rank: &Rank) -> Option<String> {
    let begins_at_rest = model.system.start_velocity().iter().all(|v| *v == 0.0) && !model.system.is_driven();
    let may_move = model.settings.end == Some(0.0) && begins_at_rest && rank.size(&model.system).dof > 0;
    // Accelerations do not tell where redundant rows hold what is free.
    let mut told = || if rank.redundant.is_empty() { simulation.balances() } else { None };
    (may_move && !told().unwrap_or_else(|| is_at_rest(&model.system))).then(|| {
        "forces do not balance at the start: those that are shown are of a mechanism that begins to move (equilibrium = true in [start] finds where it rests)"
            .into()
    })
}

/// That drives which move at once strike what was put to rest.
fn struck(model: &Model, simulation: &Simulation, rank: &Rank) -> Option<String> {
    // Rates of joints in [start] are meant, and other velocities that were written are told when they change.
    let begins_at_rest = model.at_equilibrium && model.system.start_velocity().iter().all(|v| *v == 0.0);
    if !begins_at_rest || rank.size(&model.system).dof == 0 {
        return None;
    }
    let changes = model.start_changes(&simulation.state().x, simulation.velocities());
    (!changes.is_empty()).then(|| {
        format!(
            "start.equilibrium: the run does not begin at rest, as drives move at t = 0 and strike what they lead: {} (let their profiles begin at rest, or \
             give all bodies and points the velocity of the vehicle)",
            changes_in_words(&changes)
        )
    })
}

/// That modes are the slowest of a mechanism with many freedoms.
pub fn slowest(modes: &Modes) -> Option<String> {
    (modes.faster > 0).then(|| {
        let (told, faster) = (modes.modes.len(), modes.faster);
        let these = if told == 1 { "this is the slowest mode".to_string() } else { format!("these are the slowest {told} modes") };
        format!("{these}: {faster} more exponents are as fast or faster and were not looked for, so that one that grows may be among them")
    })
}

/// That modes leave out what drives do.
pub fn driven(modes: &Modes) -> Option<&'static str> {
    modes.driven.then_some(
        "drives move at the start, and stand still for the modes: what their speeds do, as by centrifugal and gyroscopic forces, is not in them",
    )
}

/// That modes are those of one side of kinks.
pub fn kinked(modes: &Modes) -> Option<String> {
    (!modes.kinked.is_empty()).then(|| {
        let named = listed(&modes.kinked.iter().map(|name| format!("`{name}`")).collect::<Vec<String>>());
        format!(
            "the mechanism rests where a force has a kink or jumps: one side of a kink counts, and nothing of a jump; on the other side modes are others: {named}"
        )
    })
}

/// The largest coordinate of a place.
fn farthest(x: &[f64]) -> f64 {
    x.iter().fold(0.0, |most: f64, x| x.abs().max(most))
}

/// What was put right before the start.
pub fn corrections(model: &Model, simulation: &Simulation) -> Vec<String> {
    let mut notes = Vec::new();
    let start = simulation.start();
    if start.moved > ROUNDED * farthest(&simulation.state().x) {
        notes.push(format!("positions were moved by up to {:.2e} m onto their constraints", start.moved));
    }
    notes.extend(nowhere(start));
    let mut changes = model.start_changes(&simulation.state().x, simulation.velocities());
    notes.extend(strikes(model, &changes));
    // That parts start moving for which no velocity was written is what a drive is for.
    changes.retain(|change| !change.was_at_rest);
    if !changes.is_empty() {
        notes.push(format!("to meet the constraints, start velocities were changed: {}", changes_in_words(&changes)));
    }
    let spins = model.spins_left_out();
    if !spins.is_empty() {
        let spins: Vec<String> = spins.iter().map(|(name, spin)| format!("`{name}` by {} rad/s", short(*spin))).collect();
        notes.push(format!(
            "bodies whose moment of inertia about an axis is less than 1e-9 of the others are rods, and do not turn about themselves: {} was left out",
            listed(&spins)
        ));
    }
    notes
}

/// That beams are deformed by the velocities of a start.
pub fn strikes(model: &Model, changes: &[StartChange]) -> Option<String> {
    let struck = model.strikes(changes);
    (!struck.is_empty()).then(|| {
        format!(
            "the start strikes beams as by a hammer: nodes that joints and drives hold move at once, and others hardly: {} (let drives begin at rest, or write \
             the velocities with which a beam goes along)",
            changes_in_words(struck)
        )
    })
}

/// That constraints leave nothing that could move, and nothing that moves is imposed, where more than the start is asked for.
pub fn locked(model: &Model, rank: &Rank) -> Option<String> {
    let is_to_move = model.settings.end != Some(0.0);
    (is_to_move && rank.size(&model.system).dof == 0 && !model.system.is_driven()).then(|| {
        "the mechanism is locked: its constraints leave 0 degrees of freedom and nothing drives it, so that it stays where it is (take away a constraint, \
         or drive it in place of one)"
            .into()
    })
}

/// That two drives lead one freedom, where rows are redundant and none asks for what cannot be.
pub fn rivals(simulation: &mut Simulation, rank: &Rank) -> Option<String> {
    let [one, other] = if rank.redundant.is_empty() || simulation.start().conflict.is_some() { None } else { simulation.rivals() }?;
    Some(format!("`{one}` and `{other}` lead the same freedom, so that it is not known which of them does the work: remove one of the two"))
}

/// That no motion begins with the velocities of a start.
pub fn nowhere(start: &Start) -> Option<String> {
    let text = match &start.conflict {
        Some(conflict) => conflict.to_string(),
        None => "no motion begins with the start velocities: at this singular position no accelerations keep all constraints, and what comes is one way of \
                 many (give the velocities of one of the ways in which it can move from there)"
            .into(),
    };
    start.leads_nowhere.then_some(text)
}

/// Bodies and points with the change of their velocities at the start.
pub fn changes_in_words<'a>(changes: impl IntoIterator<Item = &'a StartChange>) -> String {
    let words = changes.into_iter().map(|change| {
        let parts = [(change.velocity, "m/s"), (change.angular_velocity, "rad/s")].into_iter().filter(|(by, _)| *by > 0.0);
        let parts: Vec<String> = parts.map(|(by, unit)| format!("{} {unit}", short(by))).collect();
        format!("`{}` by {}", change.name, parts.join(" and "))
    });
    listed(&words.collect::<Vec<_>>())
}
