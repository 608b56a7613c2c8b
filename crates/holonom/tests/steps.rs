//! What holds for every step of every method: it allocates nothing and gives the same bits again.

mod common;

use common::*;
use holonom::simulation::{Method, Simulation, Status, Verdict};
use holonom::system::System;

fn systems() -> [(&'static str, System); 4] {
    [("pendulum", pendulum()), ("four-bar", four_bar(3)), ("driven", driven_pendulum()), ("surface", surface())]
}

#[test]
fn a_step_allocates_nothing() {
    for (model, system) in systems() {
        for (name, choice) in every_method() {
            let mut simulation = Simulation::new(system.clone(), Method::resolve(&choice).unwrap(), 0.005).unwrap();
            simulation.find_reactions();
            let mut go_on = |_: &Simulation| Verdict::GoOn;
            let allocations = allocation_counter::measure(|| {
                assert_eq!(simulation.run(0.2, &mut go_on), Status::Completed, "{model}, {name}");
            });
            assert_eq!(allocations.count_total, 0, "{model}, {name}");
        }
    }
}

#[test]
fn a_second_run_gives_the_same_bits() {
    for (model, system) in systems() {
        for (name, choice) in every_method() {
            let bits = || -> Vec<u64> { run(&system, &choice, 0.005, 0.2).position.iter().map(|x| x.to_bits()).collect() };
            assert_eq!(bits(), bits(), "{model}, {name}");
        }
    }
}

/// One after the other, on any thread: the same bits as a run. An accuracy is that of a call.
#[test]
fn steps_on_demand_are_those_of_a_run() {
    for (model, system) in systems() {
        for (name, choice) in every_method().into_iter().filter(|(_, choice)| choice.accuracy.is_none()) {
            let start = || Simulation::new(system.clone(), Method::resolve(&choice).unwrap(), 0.005).unwrap();
            let (mut whole, mut by_steps) = (start(), start());
            assert_eq!(whole.step_to(0.1), Status::Completed, "{model}, {name}");
            let by_steps = std::thread::spawn(move || {
                (0..20).for_each(|_| assert_eq!(by_steps.step(), Status::Completed));
                by_steps
            });
            let by_steps = by_steps.join().unwrap();
            assert_eq!(by_steps.steps(), 20, "{model}, {name}");
            let bits = |simulation: &Simulation| -> Vec<u64> {
                simulation.state().x.iter().chain(simulation.velocities()).map(|value| value.to_bits()).collect()
            };
            assert_eq!(bits(&whole), bits(&by_steps), "{model}, {name}");
            assert_eq!(whole.checkpoint().state, by_steps.checkpoint().state, "{model}, {name}");
        }
    }
}
