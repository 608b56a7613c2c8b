//! Every kind of the engine's tables, through a file: its example runs, its required keys are required, its derivatives
//! and its units of energy are right.

use holonom::model::{Kind, Model, constraints, drives, forces, joints};
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};
use holonom_io::Source;

fn kinds() -> impl Iterator<Item = &'static Kind> {
    constraints::KINDS.iter().chain(forces::KINDS).chain(joints::kinds()).chain(drives::KINDS)
}

fn model(text: &str) -> Result<Model, String> {
    Source::read("model.toml", text.as_bytes())?.model()
}

#[test]
fn examples_run_and_keep_their_balance_of_energy() {
    for kind in kinds() {
        let model = model(kind.example).unwrap_or_else(|message| panic!("{message}"));
        let method = Method::resolve(&Choice::default().named("conserving")).unwrap();
        let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap_or_else(|error| panic!("{}: {error}", kind.name));
        let status = simulation.run(1.0, &mut |_: &Simulation| Verdict::GoOn);
        assert_eq!(status, Status::Completed, "{}", kind.name);
        let energy = simulation.audit().energy_summary();
        assert!(energy.max_drift < 1e-9, "{}: the energy drifts by {}", kind.name, energy.max_drift);
    }
}

#[test]
fn required_keys_are_required_and_optional_ones_are_not() {
    for kind in kinds() {
        for key in kind.keys {
            let begins = format!("{} = ", key.name);
            // The last one: points come first, and may have keys of the same name.
            let Some(at) = kind.example.rfind(&format!("\n{begins}")) else {
                assert!(!key.required, "the example of {} has no {}", kind.name, key.name);
                continue;
            };
            let line_end = at + 1 + kind.example[at + 1..].find('\n').unwrap();
            let without = format!("{}{}", &kind.example[..at], &kind.example[line_end..]);
            let answer = model(&without);
            if key.required {
                let message = answer.err().unwrap_or_else(|| panic!("{} goes without {}", kind.name, key.name));
                assert!(message.contains(&format!("has no `{}`", key.name)), "{message}");
            }
        }
    }
}

#[test]
fn every_kind_refuses_keys_it_does_not_know_with_the_nearest_one() {
    for kind in kinds() {
        for key in kind.keys {
            let misspelt: String = key.name.chars().chain(['x']).collect();
            let message = model(&format!("{}{misspelt} = 1\n", kind.example)).err().expect("an unknown key");
            assert!(
                message.contains(&format!("has no key `{misspelt}`")) && message.contains(&format!("did you mean `{}`?", key.name)),
                "{message}"
            );
        }
    }
}

/// Ten thousand bars are a small model to read.
#[test]
fn long_chains_are_read_at_once() {
    let text = r#"
        plane = "xy"
        parameters = { N = 10000 }
        [point.P]
        repeat = "i = 1 to N"
        position = ["i*cos(0)", "0*i"]
        [bar.first]
        between = ["ground", "P[1]"]
        mass = 1
        [bar.rod]
        repeat = "i = 2 to N"
        between = ["P[i-1]", "P[i]"]
        mass = 1
    "#;
    let start = std::time::Instant::now();
    let model = model(text).unwrap();
    let taken = start.elapsed();
    assert_eq!((model.points.len(), model.bars.len(), model.system.constraints()), (10_000, 10_000, 10_000));
    assert!(taken.as_secs_f64() < 1.0, "{taken:?}");
}

/// Nested repetitions, and references with indices.
#[test]
fn a_net_of_springs_has_all_its_knots_and_threads() {
    let text = r#"
        parameters = { N = 4, M = 3 }
        [point.K]
        repeat = "i = 0 to N, j = 0 to M"
        mass = 0.1
        position = ["i", "j", 0]
        [force.along]
        type = "spring"
        repeat = "i = 1 to N, j = 0 to M"
        between = ["K[i-1][j]", "K[i][j]"]
        stiffness = "100*(i + 1)"
        [constraint.pinned]
        type = "fixed"
        repeat = "j = 0 to M"
        point = "K[0][j]"
        [constraint.none]
        type = "fixed"
        repeat = "j = 1 to 0"
        point = "K[99][j]"
    "#;
    let model = model(text).unwrap_or_else(|message| panic!("{message}"));
    assert_eq!((model.points.len(), model.scene.lines.len(), model.system.constraints()), (20, 16, 12));
    assert_eq!(model.points[5].name, "K[1][1]");
    assert_eq!(model.system.row_names()[0], "pinned[0][x]");
}
