//! The tables that are written into the chapter.

use super::chapter::ROUND_OFF;
use super::figure::Figure;
use super::results::{Results, Series};

/// What becomes of a run.
enum Fate {
    /// It follows the motion.
    Follows,
    /// It leaves the motion, at a time that the step decides.
    BlowsUp,
    /// It leaves the motion, at a time that round-off decides: there is no figure to quote.
    Lost,
}

/// The methods of the table, as it has them.
const METHODS: &[(&str, Fate)] = &[
    ("conserving-ggl", Fate::Follows),
    ("ggl/conserving-ggl-4", Fate::Follows),
    ("ggl/conserving-ggl-6", Fate::Follows),
    ("conserving", Fate::Follows),
    ("penalty/conserving", Fate::Follows),
    ("conserving-projected", Fate::Follows),
    ("lagrange-3/rattle", Fate::Follows),
    ("trapezoidal-projected", Fate::Follows),
    ("generalized-alpha", Fate::Follows),
    ("lagrange-3/hht", Fate::Follows),
    ("ggl/radau-5", Fate::Follows),
    ("ggl/radau-3", Fate::Follows),
    ("ggl/radau-1", Fate::Follows),
    ("ggl/bdf-5", Fate::Follows),
    ("ggl/bdf-4", Fate::Follows),
    ("ggl/bdf-3", Fate::Follows),
    ("ggl/bdf-2", Fate::Follows),
    ("ggl/bdf-1", Fate::Follows),
    ("lagrange-2/trapezoidal", Fate::Follows),
    ("lagrange-2/radau-3", Fate::Follows),
    ("lagrange-1/rk4/velocity+acceleration", Fate::Follows),
    ("baumgarte/rk4", Fate::Follows),
    ("baumgarte/trapezoidal", Fate::Follows),
    ("penalty-stabilized/trapezoidal", Fate::Follows),
    ("lagrange-1/trapezoidal", Fate::Lost),
    ("ode/rk4", Fate::Lost),
    ("ode/dopri5", Fate::Lost),
    ("ode/dop853", Fate::Lost),
    ("penalty/trapezoidal", Fate::Lost),
    ("trapezoidal", Fate::BlowsUp),
    ("augmented-lagrangian-3/midpoint", Fate::BlowsUp),
];

/// Every method on the paper's pendulum.
pub fn methods(results: &Results) -> Result<String, String> {
    let mut text = String::from("| method | energy after 20 s, J | largest ‖Φ‖ | largest ‖Φ̇‖ |\n|---|---|---|---|\n");
    for (name, fate) in METHODS {
        let run = results.pendulum(name);
        let [energy, position, velocity] = row(run, fate).map_err(|fault| format!("`{name}` {fault}"))?;
        text += &format!("| `{name}` | {energy} | {position} | {velocity} |\n");
    }
    Ok(text)
}

fn row(run: &Series, fate: &Fate) -> Result<[String; 3], String> {
    let blank = String::from("–");
    match fate {
        Fate::Follows if run.end() > 19.99 && run.largest("phi") < 1.0 => {
            Ok([figure(run.energy_gained()), figure(run.largest("phi")), figure(run.largest("phi_dot"))])
        }
        Fate::Follows => Err(format!("does not follow the motion any more: it ends at {} s", run.end())),
        Fate::BlowsUp | Fate::Lost if run.leaves().is_infinite() => Err("follows the motion now".into()),
        Fate::BlowsUp => Ok([format!("1 J off at {} s", figure(run.leaves())), blank.clone(), blank]),
        Fate::Lost => Ok(["more than 1 J off".into(), blank.clone(), blank]),
    }
}

/// What was measured for a figure, and what is claimed of it.
pub fn measured(drawn: &Figure, results: &Results) -> String {
    let mut text = String::from("| measured | here | checked |\n|---|---|---|\n");
    for measurement in drawn.measurements {
        let claimed = measurement.claimed();
        let value = match measurement.is_seeded_by_round_off {
            true => "holds".into(),
            false => figure((measurement.measure)(results)),
        };
        text += &format!("| {} | {value} | {claimed} |\n", measurement.what);
    }
    text
}

/// Three digits, or the word for what is none.
pub fn figure(value: f64) -> String {
    match value.abs() {
        size if size < ROUND_OFF => "round-off".into(),
        size if (1e-3..1e4).contains(&size) => {
            let digits = (2 - size.log10().floor() as i32).max(0) as usize;
            format!("{value:.digits$}")
        }
        _ => format!("{value:.2e}"),
    }
}
