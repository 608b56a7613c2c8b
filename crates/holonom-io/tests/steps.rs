//! Every kind of joint, constraint, drive and force in a step: nothing is allocated, and a second run has the same bits.

mod common;

use common::model;
use holonom::model::{Kind, Model, constraints, drives, forces, joints};
use holonom::simulation::{Choice, Method, NAMED, Simulation, Status, Verdict};

fn kinds() -> impl Iterator<Item = &'static Kind> {
    constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS)
}

/// All bits of the state after some steps, and how many of the steps behind the first few allocated.
fn run(model: &Model, name: &str) -> (Vec<u64>, u64) {
    let method = Method::resolve(&Choice::default().named(name)).unwrap_or_else(|error| panic!("{error}"));
    let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap_or_else(|error| panic!("{error}"));
    simulation.find_reactions();
    let mut status = Status::Completed;
    let counted = allocation_counter::measure(|| {
        status = simulation.run(0.2, &mut |_: &Simulation| Verdict::GoOn);
    });
    assert_eq!(status, Status::Completed, "{name}");
    let state = simulation.state();
    let values = [&state.x, &state.v, &state.a, &state.lambda, &state.angle, &simulation.gauges().value, &simulation.gauges().rate];
    (values.into_iter().flatten().map(|value| value.to_bits()).collect(), counted.count_total)
}

#[test]
fn steps_of_every_kind_allocate_nothing_and_repeat_their_bits() {
    let explicit =
        ["ode/dopri5/velocity", "lagrange-1/rk4", "augmented-lagrangian-3/bdf-2", "lagrange-3/rattle", "lagrange-2/radau-3", "ode/dop853"];
    let mut variants = 0;
    for kind in kinds() {
        let model = model(kind.example);
        println!("{}", kind.name);
        for name in NAMED.iter().map(|named| named.name).chain(explicit) {
            let (first, allocated) = run(&model, name);
            assert_eq!(allocated, 0, "{} with {name}", kind.name);
            assert_eq!(first, run(&model, name).0, "{} with {name}", kind.name);
            variants += 1;
        }
    }
    println!("{variants} variants");
}
