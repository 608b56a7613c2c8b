//! Which runs of a comparison can be trusted: axes are scaled to them, and only they can be best.

use crate::Run;
use serde_json::Value;

/// A drift of so many times the energy that moves in the mechanism is no error any more: the energy blew up.
const BLOWN_UP: f64 = 10.0;

/// What became of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Completed, with an energy of the right size; or measured.
    Sound,
    /// Its energy left all bounds, whether it completed or not.
    BlownUp,
    /// Ended early.
    Stopped,
}

/// The outcome of each run. What energy is of the right size, the runs say together.
pub fn outcomes(runs: &[Run]) -> Vec<Outcome> {
    let moved = moved_energy(runs);
    runs.iter().map(|run| outcome(run, moved)).collect()
}

fn outcome(run: &Run, moved: Option<f64>) -> Outcome {
    let drift = run.summary.pointer("/energy/max_drift");
    // A drift that is not finite is null in JSON.
    let size = drift.map(|drift| drift.as_f64().unwrap_or(f64::INFINITY));
    match (size, moved) {
        (Some(size), Some(moved)) if size > BLOWN_UP * moved => Outcome::BlownUp,
        _ if completed(run.summary) || is_measured(run.summary) => Outcome::Sound,
        _ => Outcome::Stopped,
    }
}

pub fn completed(summary: &Value) -> bool {
    summary["status"] == "completed"
}

/// The event that ended a run, and when, s; none of one that came to the end asked for, or stopped.
pub fn ended(summary: &Value) -> Option<(&str, f64)> {
    let event = summary["ended_by"].as_str()?;
    let last = summary["events"].as_array()?.iter().rfind(|one| one["event"] == event && one["stopped"] == true)?;
    Some((event, last["t"].as_f64()?))
}

/// Whether this is no run but what was measured.
pub fn is_measured(summary: &Value) -> bool {
    summary["status"] == "measured"
}

/// How much energy goes back and forth, J: the least of what the runs say, as errors of this kind only add to it.
fn moved_energy(runs: &[Run]) -> Option<f64> {
    let most = |run: &Run| {
        let kinetic = run.recording.column("kinetic")?.iter().copied().filter(|e| e.is_finite());
        Some(kinetic.fold(0.0, f64::max)).filter(|&most| most > 0.0)
    };
    let found: Vec<f64> = runs.iter().filter(|run| completed(run.summary)).filter_map(most).collect();
    found.into_iter().reduce(f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use holonom::record::{Recording, Scene};
    use serde_json::json;

    fn judged(cases: &[(&str, f64, Value)]) -> Vec<Outcome> {
        let recordings = cases.iter().map(|(_, kinetic, _)| {
            let mut recording = Recording::new(["t", "kinetic"].map(str::to_owned));
            recording.push(&[0.0, *kinetic]);
            recording
        });
        let recordings: Vec<Recording> = recordings.collect();
        let summaries: Vec<Value> =
            cases.iter().map(|(status, _, drift)| json!({"status": status, "energy": {"max_drift": drift}})).collect();
        let scene = Scene::default();
        let run = |(recording, summary)| Run { label: "", recording, scene: &scene, summary };
        let runs: Vec<Run> = recordings.iter().zip(&summaries).map(run).collect();
        outcomes(&runs)
    }

    #[test]
    fn runs_are_judged_by_the_energy_that_moves_in_all_of_them() {
        let found = judged(&[
            ("completed", 20.0, json!(1e-12)),
            ("completed", 5e7, json!(5.76e7)),
            ("completed", 21.0, json!(6.2)),
            ("stopped", 20.0, json!(1e-12)),
            ("stopped", 1e300, Value::Null),
        ]);
        assert_eq!(found, [Outcome::Sound, Outcome::BlownUp, Outcome::Sound, Outcome::Stopped, Outcome::BlownUp]);
        let measured = |kinetic: f64| {
            let mut recording = Recording::new(["t", "kinetic"].map(str::to_owned));
            recording.push(&[0.0, kinetic]);
            let run = Run { label: "", recording: &recording, scene: &Scene::default(), summary: &json!({"status": "measured"}) };
            outcomes(&[run])
        };
        assert_eq!(measured(0.0), [Outcome::Sound], "axes are scaled to what was measured");
    }

    #[test]
    fn without_motion_nothing_is_said_of_the_energy() {
        assert_eq!(judged(&[("completed", 0.0, json!(1e-3)), ("stopped", 0.0, json!(1.0))]), [Outcome::Sound, Outcome::Stopped]);
    }
}
