//! A body that hundreds of others are hinged to: as fast as a chain of them, and as exact.

use std::fmt::Write;

use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom_io::Source;

/// A hub on a vertical rail with `count` equal leaves around it, each on a hinge along the rim: by symmetry each leaf moves as the only
/// one on a hub of a `count`th of the mass.
fn carousel(count: usize, hub: f64, leaf: f64) -> Simulation {
    let mut text = format!(
        "gravity = [0, 0, -9.81]\n[body.hub]\nmass = {hub}\nshape = {{ box = [1, 1, 0.1] }}\nposition = [0, 0, 0]\n\
         [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"hub\"]\naxis = [0, 0, 1]\n\
         [force.spring]\ntype = \"spring\"\nbetween = [[0, 0, 3], \"hub\"]\nstiffness = {stiffness}\nrest_length = 2\n",
        stiffness = 30.0 * hub,
    );
    for k in 0..count {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let (s, c) = angle.sin_cos();
        write!(
            text,
            "[body.l{k}]\nmass = {leaf}\nshape = {{ box = [0.4, 0.1, 0.05] }}\nposition = [{}, {}, 0]\n\
             orientation = {{ axis = [0, 0, 1], angle = {angle} }}\n\
             [joint.h{k}]\ntype = \"revolute\"\nbetween = [\"hub\", \"l{k}\"]\nat = [{c}, {s}, 0]\naxis = [{}, {c}, 0]\n",
            1.2 * c,
            1.2 * s,
            -s
        )
        .expect("a String takes everything");
    }
    let model =
        Source::read("carousel.toml", text.as_bytes()).and_then(|source| source.model()).unwrap_or_else(|faults| panic!("{faults}"));
    let method = Method::resolve(&Choice::default()).unwrap();
    Simulation::new(model.system.clone(), method, 0.01).unwrap()
}

#[test]
fn leaves_of_a_hub_move_as_the_only_one_of_a_smaller_hub() {
    const COUNT: usize = 150;
    for (hub, leaf) in [(1.0, 1.0), (1e-3, 1.0), (1e3, 1.0), (1.0, 1e-6)] {
        let mut all = carousel(COUNT, hub * COUNT as f64, leaf);
        let mut one = carousel(1, hub, leaf);
        let statuses = [&mut all, &mut one].map(|simulation| simulation.step_to(0.5));
        assert_eq!(statuses, [Status::Completed, Status::Completed]);
        let angle = one.coordinate("h0.angle").unwrap();
        assert!(angle[0].abs() > 0.01, "it has moved by {}", angle[0]);
        for k in 0..COUNT {
            let found = all.coordinate(&format!("h{k}.angle")).unwrap();
            let off = (found[0] - angle[0]).abs().max((found[1] - angle[1]).abs());
            assert!(off < 1e-9, "leaf {k} of {leaf} kg on {hub} kg each: off by {off}");
        }
        let energy = all.audit().energy_summary();
        println!("{hub} kg each, {leaf} kg: drift {:.1e} J", energy.max_drift);
    }
}

/// With rows that wait for the hub this takes an hour.
#[test]
fn two_thousand_leaves_are_as_quick_as_a_chain() {
    assert_eq!(carousel(2000, 100.0, 1.0).step(), Status::Completed);
}
