//! `holonom modes`.

use std::io::Write;
use std::process::ExitCode;

use holonom::analysis::{Mode, Modes, modes};
use holonom::model::{Model, Swing};
use holonom_report::{ModeShape, ModesReport};
use serde_json::{Value, json};

use crate::failure::Failure;
use crate::folder::{Folder, holds};
use crate::load::{self, Loaded};
use crate::notes::{driven, kinked, slowest};
use crate::options::ModesArguments;
use crate::table::{short, table};

/// Modes that the screen has; the page and the file have all.
const SHOWN: usize = 40;

/// Most of what moves that is named of each mode, and its least share of what moves most.
const NAMED: usize = 4;
const LEAST: f64 = 0.05;

const NOTHING: &str = "nothing vibrates or falls off";

/// Finds the small vibrations about the start of a model.
pub fn modes_of(arguments: &ModesArguments) -> Result<ExitCode, Failure> {
    let loaded = load::load(&arguments.model.model, load::overrides(&arguments.model.set))?;
    let vibrations = Vibrations::of(loaded)?;
    let mut value = vibrations.value();
    value["provenance"] = vibrations.origin.clone();
    let folder = Folder::claim(&arguments.to, &format!("{}-modes", vibrations.loaded.name), |path| holds(path, &value))?;
    folder.write("modes.json", |out| holonom_io::write_json(&value, out))?;
    if !arguments.no_report {
        folder.write("report.html", |out| vibrations.report(out))?;
    }
    if arguments.to.json {
        println!("{}", serde_json::to_string_pretty(&value).expect("a result is plain data"));
    } else if !arguments.to.quiet {
        println!("{}\n\nresults in {}", vibrations.describe(), folder.path.display());
    }
    Ok(ExitCode::SUCCESS)
}

/// The small vibrations about the start of a model: its modes, each with what moves in it and the phase of that, rad.
pub struct Vibrations {
    loaded: Loaded,
    /// Where they come from.
    origin: Value,
    found: Modes,
    swings: Vec<Vec<(Swing, f64)>>,
}

impl Vibrations {
    /// Finds them.
    ///
    /// # Errors
    /// A model that is not at rest at its start.
    pub fn of(loaded: Loaded) -> Result<Self, Failure> {
        let found = modes(&loaded.model.system).map_err(load::modes_failure)?;
        let swings = found.modes.iter().map(|mode| swings(&loaded.model, mode, found.length)).collect();
        Ok(Self { origin: json!(loaded.origin()), loaded, found, swings })
    }

    /// As `--json` prints them, but for where they come from.
    pub fn value(&self) -> Value {
        let Self { loaded, found, swings, .. } = self;
        let of_mode = |k: usize| {
            let (mode, swings) = (&found.modes[k], &swings[k]);
            let moves: serde_json::Map<String, Value> =
                swings.iter().map(|(swing, phase)| (swing.name.clone(), json!([swing.rate, phase]))).collect();
            json!({ "number": found.number(k), "frequency": mode.frequency, "growth": mode.growth, "damping": mode.damping(), "moves": moves })
        };
        let all: Vec<Value> = (0..swings.len()).map(of_mode).collect();
        json!({ "model": loaded.name, "modes": all, "zero": found.free, "within": found.within, "faster": found.faster, "unsure": found.unsure, "driven": found.driven, "kinked": found.kinked })
    }

    /// The table of the modes.
    fn rows(&self) -> Vec<[String; 5]> {
        let found = &self.found;
        found
            .modes
            .iter()
            .zip(&self.swings)
            .enumerate()
            .map(|(k, (mode, swings))| row(found.number(k), mode, swings, found.length))
            .collect()
    }

    /// What is said below it.
    fn notes(&self) -> Vec<String> {
        let found = &self.found;
        let mut notes = Vec::new();
        if found.free > 0 {
            let (are, motions) = if found.free == 1 { ("exponent is", "a motion") } else { ("exponents are", "motions") };
            let within = if found.within > 0.0 { format!(" to within {:.0e} 1/s", found.within) } else { String::new() };
            notes.push(format!("{} more {are} zero{within}: of {motions} that nothing drives back", found.free));
        }
        notes.extend(slowest(found));
        if found.unsure > 0 {
            notes.push(format!("{} more cannot be told from rounding beside the others", found.unsure));
        }
        notes.extend(driven(found).map(str::to_string));
        notes.extend(kinked(found));
        notes
    }

    /// As the command prints them.
    pub fn describe(&self) -> String {
        let all = self.rows();
        let rows: Vec<Vec<String>> = all.iter().take(SHOWN).map(|row| row.to_vec()).collect();
        let shown = match rows.is_empty() {
            true => NOTHING.to_string(),
            false => table(&["mode", "Hz", "damping", "1/e in s", "what moves, over what moves most"], &rows),
        };
        let more = (all.len() > SHOWN).then(|| format!("{} more are faster", all.len() - SHOWN));
        let heading = format!("{}: small vibrations about the start", self.loaded.name);
        [heading, shown].into_iter().chain(more).chain(self.notes()).collect::<Vec<_>>().join("\n\n")
    }

    /// Writes the page on which the mechanism swings in them.
    pub fn report(&self, out: &mut dyn Write) -> std::io::Result<()> {
        let Loaded { model, source, .. } = &self.loaded;
        let part = |mode: &Mode, k: usize| model.sways(&mode.shape.iter().map(|entry| entry[k]).collect::<Vec<f64>>());
        let shapes = self.rows().into_iter().zip(&self.found.modes);
        let modes: Vec<ModeShape> = shapes.map(|(row, mode)| ModeShape { row, real: part(mode, 0), imaginary: part(mode, 1) }).collect();
        let nothing = modes.is_empty().then(|| NOTHING.to_string());
        let notes: Vec<String> = nothing.into_iter().chain(self.notes()).collect();
        let (title, model_text, provenance) = (self.loaded.title(), source.text(), &self.origin);
        ModesReport { title, model_text, provenance, scene: &model.scene, modes: &modes, notes: &notes }.write(out)
    }
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

fn row(number: usize, mode: &Mode, swings: &[(Swing, f64)], size: f64) -> [String; 5] {
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
    [number.to_string(), hertz, damping, time, moves.collect::<Vec<_>>().join(", ")]
}
