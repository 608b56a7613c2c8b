//! The mechanisms of the benches are what their comments say: of so many bodies, movable, redundant where they are to be, and
//! consistent at the start.

use holonom::analysis;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};
use holonom_io::Source;

/// Largest correction of the start, m, and m/s: round-off of positions.
const ASSEMBLED: f64 = 1e-12;

/// Largest drift of energy over 20 steps, J, of some tens of kilograms.
const KEPT: f64 = 1e-10;

fn model(name: &str, parameters: &[(&str, usize)]) -> Model {
    let path = format!("{}/../../benches/models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut source = Source::read(name, &std::fs::read(path).unwrap()).unwrap_or_else(|message| panic!("{message}"));
    for (parameter, value) in parameters {
        source.set(&format!("parameters.{parameter}"), &value.to_string()).unwrap();
    }
    source.model().unwrap_or_else(|message| panic!("{message}"))
}

struct Found {
    bodies: usize,
    redundant: usize,
    freedom: usize,
}

/// Runs a model for 20 steps.
fn run(model: &Model) -> Found {
    let method = Method::resolve(&Choice::default()).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, 1e-3).unwrap();
    let moved = simulation.state().x.iter().zip(model.system.start_position()).map(|(now, given)| (now - given).abs());
    assert!(moved.fold(0.0, f64::max) < ASSEMBLED, "the model is assembled as it is written");
    let turned = simulation.state().v.iter().zip(model.system.start_velocity()).map(|(now, given)| (now - given).abs());
    assert!(turned.fold(0.0, f64::max) < ASSEMBLED, "its velocities are consistent");
    let status = simulation.run(0.02, &mut |_: &Simulation| Verdict::GoOn);
    assert_eq!(status, Status::Completed);
    let size = analysis::rank(&model.system, &simulation.state().x, 0.02).size(&model.system);
    let (redundant, freedom) = (size.redundant, size.dof);
    let summary = simulation.summary("bench", 0.02, &status, size);
    assert!(summary.energy.max_drift < KEPT, "energy drifts by {:e} J", summary.energy.max_drift);
    let start = model.system.start_position();
    let distance = simulation.state().x.iter().zip(start).map(|(now, then)| (now - then).abs()).fold(0.0, f64::max);
    assert!(distance > 1e-4, "it moves");
    Found { bodies: model.bars.len() + model.bodies.len(), redundant, freedom }
}

#[test]
fn a_tree_has_a_freedom_for_each_rod() {
    let found = run(&model("tree", &[("L", 4)]));
    assert_eq!([found.bodies, found.redundant, found.freedom], [31, 0, 31]);
}

#[test]
fn a_grid_shears_row_by_row_and_its_double_rods_are_redundant() {
    for n in [1, 2, 5] {
        let found = run(&model("grid", &[("n", n)]));
        assert_eq!([found.bodies, found.redundant, found.freedom], [3 * n * n, n * (n - 1), n]);
    }
}

#[test]
fn a_random_mechanism_closes_loops_and_moves() {
    let n = 12;
    let mechanism = model("graph", &[("n", n)]);
    let found = run(&mechanism);
    let loops = found.bodies - n * n;
    assert!((6..24).contains(&loops), "a tenth of 121 joints close a loop, {loops} do");
    assert_eq!([found.redundant, found.freedom], [0, n * n - loops]);
    assert!(mechanism.bars.iter().all(|bar| (0.5..=1.5).contains(&bar.length)), "rods are 0.5 to 1.5 m long");
}

#[test]
fn a_spatial_chain_has_a_freedom_for_each_rod() {
    let found = run(&model("spatial-chain", &[("N", 6)]));
    assert_eq!([found.bodies, found.redundant, found.freedom], [6, 0, 6]);
}

#[test]
fn rods_without_inertia_about_themselves_have_the_same_freedom() {
    let found = run(&model("spatial-chain", &[("N", 6), ("stray", 0)]));
    assert_eq!([found.redundant, found.freedom], [0, 6]);
}
