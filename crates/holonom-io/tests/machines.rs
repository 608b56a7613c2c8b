//! The machines of the book's chapter: what they answer against calculations made by hand.

mod machines {
    pub mod jet;
    pub mod wiper;
}

use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::Status;
use holonom_io::{Source, read_value};

/// The model file that the chapter shows under this name.
fn text(name: &str) -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/machines.md");
    let chapter = std::fs::read_to_string(path).unwrap();
    let command = chapter.find(&format!("\nholonom run {name}.toml\n")).unwrap_or_else(|| panic!("the chapter does not run {name}.toml"));
    let start = chapter[..command].rfind("```toml\n").unwrap() + "```toml\n".len();
    chapter[start..].split("```").next().unwrap().to_string()
}

/// A run of a machine.
struct Run {
    recording: Recording,
}

impl Run {
    /// With some keys set otherwise, as `--set` does.
    fn of(name: &str, changes: &[(&str, &str)]) -> Run {
        let source = Source::read(name, text(name).as_bytes()).unwrap_or_else(|faults| panic!("{faults}"));
        let changes: Vec<_> = changes.iter().map(|(key, value)| (*key, read_value(value))).collect();
        let model = source.model_with(&changes).unwrap_or_else(|faults| panic!("{}", source.render(&faults)));
        let mut simulation = model.simulation().unwrap();
        model.find_reactions(&mut simulation);
        let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Joints);
        let end = model.end().unwrap();
        let status = simulation.run(end, &mut recorder);
        assert_eq!(status, Status::Completed, "{name}");
        Run { recording: recorder.finish() }
    }

    fn column(&self, name: &str) -> &[f64] {
        self.recording.column(name).unwrap_or_else(|| panic!("there is no column {name}"))
    }
}

/// A column agrees with its formula of time in every row, as a share of its greatest.
#[track_caller]
fn assert_follows(run: &Run, name: &str, share: f64, formula: impl Fn(f64) -> f64) {
    let (times, values) = (run.column("t"), run.column(name));
    let greatest = values.iter().fold(0.0_f64, |greatest, value| greatest.max(value.abs()));
    let mut worst = 0.0_f64;
    for (&t, &value) in times.iter().zip(values) {
        let expected = formula(t);
        let off = (value - expected).abs() / greatest;
        assert!(off <= share, "{name} at {t} s: {value} and not {expected}, {off:e} of {greatest}");
        worst = worst.max(off);
    }
    println!("{name}: {worst:.1e} of its greatest, {greatest}");
}
