//! What equal steps do not see of forces and motions over time: where a run takes an impulse that is not there, or misses one, it is noted, and where it
//! is as good as its steps there is no note.

mod common;

use common::{model, run};
use holonom::model::Model;
use holonom::simulation::{Choice, Method};

const STEP: f64 = 0.01;
const END: f64 = 2.0;

/// A point of 1 kg that a force pushes.
fn pushed(force: &str) -> Model {
    model(&format!(
        "plane = \"xy\"\ngravity = [0, 0]\n[table.shock]\npoints = [[0, 0], [1.0012, 0], [1.0022, 100], [1.0032, 0], [5, 0]]\n\
         [point.m]\nmass = 1\nposition = [0, 0]\n[force.push]\ntype = \"expression\"\npoint = \"m\"\nforce = [\"{force}\", 0]\n"
    ))
}

fn choice(method: &str) -> Choice {
    Choice { method: Some(method.into()), ..Choice::default() }
}

fn notes(model: &Model, method: &str, step: f64) -> Vec<String> {
    model.unseen(&Method::resolve(&choice(method)).unwrap(), step, END)
}

/// The speed that the force gives it.
fn speed(model: &Model, method: &str, step: f64) -> f64 {
    run(model, choice(method), step, END).0.velocities()[0]
}

/// The step that a note says would do.
fn advised(note: &str) -> f64 {
    let words = note.split("a step of ").nth(1).unwrap_or_else(|| panic!("{note}"));
    words.split(' ').next().unwrap().parse().unwrap()
}

/// Forces with their impulses in closed form, of which steps of 0.01 s make something else.
const MISSED: &[(&str, f64)] = &[
    ("shock(t)", 0.1),
    ("5 + shock(t)", 10.1),
    ("step(t - 1.001) - step(t - 1.0013)", 3e-4),
    ("100*exp(-((t - 1.003)/1e-3)^2)", 0.177_245_385),
    ("10*cos(2*pi*100*t)", 0.0),
    ("10*cos(2*pi*100*t) + 0*x", 0.0),
    ("2*step(mod(t, 0.2) - 0.197)", 0.06),
];

#[test]
fn what_steps_do_not_see_is_noted_with_a_step_that_does() {
    for method in ["conserving-ggl", "trapezoidal-projected"] {
        for &(force, impulse) in MISSED {
            let model = pushed(force);
            let found = notes(&model, method, STEP);
            let [note] = &found[..] else { panic!("{force} by {method}: {found:?}") };
            assert!(note.starts_with("force.push.force[0]: steps of 0.01 s do not see"), "{note}");
            let (off, near) = (speed(&model, method, STEP) - impulse, speed(&model, method, advised(note)) - impulse);
            assert!(
                off.abs() > 0.01 && near.abs() < 0.5 * off.abs() || off.abs() > 2e-4 && impulse < 1e-3,
                "{force} by {method}: off by {off}, then by {near}"
            );
        }
    }
}

/// The same of what changes slowly, or jumps once in a step: errors are those of a jump within a step at most.
#[test]
fn what_steps_see_is_not_noted() {
    let tau = std::f64::consts::TAU;
    for (force, impulse) in [
        ("3", 3.0 * END),
        ("1e6*t - 5e5*t^2", 5e5 * END * END - 5e5 / 3.0 * END.powi(3)),
        ("sin(2*pi*4.9*t)", (1.0 - (tau * 4.9 * END).cos()) / (tau * 4.9)),
        ("4*step(t - 1.003)", 4.0 * (END - 1.003)),
        ("4*step(t - 1)", 4.0 * (END - 1.0)),
        ("abs(t - 1.003)", 0.5 * (1.003f64.powi(2) + 0.997f64.powi(2))),
        ("step(mod(t, 0.2) - 0.1537)", 0.463),
        ("exp(-((t - 1.003)/0.05)^2)", 0.05 * std::f64::consts::PI.sqrt()),
        ("tanh((t - 1)/1e-3)", 0.0),
        ("mod(t, 0.2)", 0.1 * END),
        ("-1e-9*x*cos(t)", 0.0),
    ] {
        let model = pushed(force);
        for method in ["conserving-ggl", "trapezoidal-projected", "radau", "dopri5"] {
            assert_eq!(notes(&model, method, STEP), Vec::<String>::new(), "{force} by {method}");
        }
        for method in ["conserving-ggl", "trapezoidal-projected", "radau"] {
            let off = speed(&model, method, STEP) - impulse;
            assert!(off.abs() < 0.05 * (1.0 + impulse.abs()), "{force} by {method}: off by {off}");
        }
    }
}

/// Methods that look at the end of a step alone are as late by half a step all the time, and still miss what is over within one.
#[test]
fn what_is_looked_at_late_is_not_noted() {
    for method in ["ggl/bdf-2", "lagrange-2/bdf-2", "ggl/radau-1"] {
        for force in ["sin(0.1*t)", "t", "5 - sin(t)"] {
            assert_eq!(notes(&pushed(force), method, STEP), Vec::<String>::new(), "{force} by {method}");
        }
        assert_eq!(notes(&pushed("shock(t) + sin(t)"), method, STEP).len(), 1, "{method}");
    }
}

/// Larger numbers, shorter times and a constant beside it change nothing.
#[test]
fn units_do_not_matter() {
    let of = |force: &str| !notes(&pushed(force), "conserving-ggl", STEP).is_empty();
    for size in ["1e-9", "1", "1e9"] {
        assert!(of(&format!("{size}*shock(t)")) && of(&format!("{size}*(7 + shock(t))")) && !of(&format!("{size}*sin(t)")), "{size}");
    }
}

/// A knock of a drive shorter than a step, also of one that turns on and on; a note for the first of repeated ones alone, and none where an accuracy
/// chooses the steps.
#[test]
fn knocks_of_drives_are_noted() {
    let driven = |profile: &str| {
        model(&format!(
            "plane = \"xy\"\ngravity = [0, 0]\n[body.disc]\nrepeat = \"i = 0 to 2\"\nmass = 1\ninertia = 1\nposition = [\"i\", 0]\n\
             [joint.hub]\nrepeat = \"i = 0 to 2\"\ntype = \"revolute\"\nbetween = [\"ground\", \"disc[i]\"]\nat = [\"i\", 0]\n\
             [drive.motor]\nrepeat = \"i = 0 to 2\"\ntype = \"angle\"\njoint = \"hub[i]\"\nprofile = \"{profile}\"\n"
        ))
    };
    for method in ["conserving-ggl", "radau"] {
        for profile in ["0.1*exp(-((t - 1.003)/1e-3)^2)", "30*t + 0.1*exp(-((t - 1.003)/1e-3)^2)"] {
            let found = notes(&driven(profile), method, STEP);
            assert!(found.len() == 1 && found[0].starts_with("drive.motor.profile: "), "{profile} by {method}: {found:?}");
        }
        for profile in ["30*t", "sin(5*t)", "30*t + 0.1*exp(-((t - 1.003)/0.05)^2)"] {
            assert_eq!(notes(&driven(profile), method, STEP), Vec::<String>::new(), "{profile} by {method}");
        }
    }
    let by_accuracy = Method::resolve(&Choice { accuracy: Some(1e-6), ..choice("conserving-ggl") }).unwrap();
    assert!(pushed("shock(t)").unseen(&by_accuracy, STEP, END).is_empty());
}

/// What a force sets off at the end of a step has its energy of the force, though explicit methods see no work of it there.
#[test]
fn what_jumps_at_the_end_of_a_step_sets_off() {
    for time in [0.5, 0.4985, 0.49, 0.499_999_999_999_9] {
        let model = pushed(&format!("step(t - {time})"));
        for method in ["rk4", "dopri5", "dop853"] {
            let found = speed(&model, method, STEP);
            assert!((found - (END - time)).abs() < STEP, "{method}, {time} s: {found} m/s");
        }
    }
}
