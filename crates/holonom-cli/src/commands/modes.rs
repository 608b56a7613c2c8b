//! `holonom modes`.

use std::process::ExitCode;

use holonom::analysis::{Mode, Modes, modes};
use holonom::model::{Model, Swing};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::found::Found;
use crate::load::{self, Loaded};
use crate::notes::driven;
use crate::options::ModesArguments;
use crate::table::{short, table};

/// Most of what moves that is named of each mode, and its least share of what moves most.
const NAMED: usize = 4;
const LEAST: f64 = 0.05;

/// Finds the small vibrations about the start of a model.
pub fn modes_of(arguments: &ModesArguments) -> Result<ExitCode, Failure> {
    let loaded = load::load(&arguments.model.model, load::overrides(&arguments.model.set))?;
    let Found { value, text } = vibrations(&loaded)?;
    match arguments.json {
        true => println!("{}", serde_json::to_string_pretty(&value).expect("a result is plain data")),
        false => println!("{text}"),
    }
    Ok(ExitCode::SUCCESS)
}

/// The small vibrations about the start of a model, for a program.
///
/// # Errors
/// A model that is not at rest there.
pub fn vibrations(loaded: &Loaded) -> Result<Found, Failure> {
    let found = modes(&loaded.model.system).map_err(load::modes_failure)?;
    let swings: Vec<Vec<(Swing, f64)>> = found.modes.iter().map(|mode| swings(&loaded.model, mode, found.length)).collect();
    let of_mode = |k: usize| {
        let (mode, swings) = (&found.modes[k], &swings[k]);
        let moves: serde_json::Map<String, Value> =
            swings.iter().map(|(swing, phase)| (swing.name.clone(), json!([swing.rate, phase]))).collect();
        json!({ "number": found.number(k), "frequency": mode.frequency, "growth": mode.growth, "damping": mode.damping(), "moves": moves })
    };
    let all: Vec<Value> = (0..swings.len()).map(of_mode).collect();
    let value = json!({ "model": loaded.name, "modes": all, "zero": found.free, "within": found.within, "unsure": found.unsure, "driven": found.driven });
    Ok(Found { value, text: describe(loaded, &found, &swings) })
}

/// What moves in a mode, each with its amplitude and its phase, rad; what moves most has the amplitude 1 and the phase 0.
fn swings(model: &Model, mode: &Mode, size: f64) -> Vec<(Swing, f64)> {
    let part = |k: usize| model.swings(&mode.shape.iter().map(|entry| entry[k]).collect::<Vec<f64>>());
    let parts: Vec<(Swing, f64, f64)> = part(0).into_iter().zip(part(1)).map(|(re, im)| (re.clone(), re.rate, im.rate)).collect();
    let far = |(swing, re, im): &(Swing, f64, f64)| way(swing, re.hypot(*im), size);
    let Some((_, re, im)) = parts.iter().max_by(|a, b| far(a).total_cmp(&far(b))) else { return Vec::new() };
    let (most, turned) = (re.hypot(*im), im.atan2(*re));
    let relative = |(swing, re, im): &(Swing, f64, f64)| {
        let phase = (im.atan2(*re) - turned).sin().atan2((im.atan2(*re) - turned).cos());
        (Swing { rate: re.hypot(*im) / most, ..swing.clone() }, phase)
    };
    parts.iter().map(relative).collect()
}

/// How far something moves, m: a turn counts as what it moves at the distance of the mechanism's size.
fn way(swing: &Swing, amplitude: f64, size: f64) -> f64 {
    amplitude * if swing.is_angle { size } else { 1.0 }
}

fn describe(loaded: &Loaded, found: &Modes, swings: &[Vec<(Swing, f64)>]) -> String {
    let rows: Vec<Vec<String>> =
        found.modes.iter().zip(swings).enumerate().map(|(k, (mode, swings))| row(found.number(k), mode, swings, found.length)).collect();
    let mut text = format!("{}: small vibrations about the start\n\n", loaded.name);
    if rows.is_empty() {
        text.push_str("nothing vibrates or falls off");
    } else {
        text.push_str(&table(&["mode", "Hz", "damping", "1/e in s", "what moves, over what moves most"], &rows));
    }
    if found.free > 0 {
        let (are, motions) = if found.free == 1 { ("exponent is", "a motion") } else { ("exponents are", "motions") };
        let within = if found.within > 0.0 { format!(" to within {:.0e} 1/s", found.within) } else { String::new() };
        text.push_str(&format!("\n\n{} more {are} zero{within}: of {motions} that nothing drives back", found.free));
    }
    if found.unsure > 0 {
        text.push_str(&format!("\n\n{} more cannot be told from rounding beside the others", found.unsure));
    }
    if let Some(note) = driven(found) {
        text.push_str(&format!("\n\n{note}"));
    }
    text
}

fn row(number: usize, mode: &Mode, swings: &[(Swing, f64)], size: f64) -> Vec<String> {
    let way = |swing: &Swing| way(swing, swing.rate, size);
    let mut most: Vec<&(Swing, f64)> = swings.iter().collect();
    most.sort_by(|a, b| way(&b.0).total_cmp(&way(&a.0)));
    let least = most.first().map_or(0.0, |(swing, _)| LEAST * way(swing));
    let moves = most.iter().take(NAMED).filter(|(swing, _)| way(swing) > least).map(|(swing, phase)| {
        let unit = if swing.is_angle { "rad" } else { "m" };
        format!("{} {:.2} {unit}", swing.name, swing.rate * phase.cos().signum())
    });
    let time = match mode.growth {
        0.0 => "stays".to_string(),
        growth if growth > 0.0 => format!("grows in {}", short(1.0 / growth)),
        growth => short(-1.0 / growth),
    };
    let [hertz, damping] = [mode.frequency, mode.damping()].map(|value| if mode.vibrates() { short(value) } else { "-".into() });
    vec![number.to_string(), hertz, damping, time, moves.collect::<Vec<_>>().join(", ")]
}
