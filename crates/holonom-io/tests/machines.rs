//! The machines of the book's chapter: what they answer against calculations made by hand.

mod machines {
    pub mod bicycle;
    pub mod crane;
    pub mod excavator;
    pub mod gimbal;
    pub mod jet;
    pub mod jib;
    pub mod scissor;
    pub mod wiper;
    pub mod wishbone;
}

use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Status, Summary};
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
    summary: Summary,
}

impl Run {
    /// Of a machine of the chapter with some keys set otherwise, as `--set` does.
    fn of(name: &str, changes: &[(&str, &str)]) -> Run {
        Run::of_text(name, &text(name), changes)
    }

    fn of_text(name: &str, text: &str, changes: &[(&str, &str)]) -> Run {
        let source = Source::read(name, text.as_bytes()).unwrap_or_else(|faults| panic!("{faults}"));
        let changes: Vec<_> = changes.iter().map(|(key, value)| (*key, read_value(value))).collect();
        let model = source.model_with(&changes).unwrap_or_else(|faults| panic!("{}", source.render(&faults)));
        let mut simulation = model.simulation().unwrap();
        model.find_reactions(&mut simulation);
        let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Joints);
        let end = model.end().unwrap();
        let status = simulation.run(end, &mut recorder);
        assert_eq!(status, Status::Completed, "{name}");
        let size = holonom::analysis::rank(&model.system, &simulation.state().x, end).size(&model.system);
        let summary = simulation.summary(name, end, &status, size);
        Run { recording: recorder.finish(), summary }
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

/// Solution of a few linear equations with a positive definite matrix: elimination without exchange of rows.
fn solve<const N: usize>(mut matrix: [[f64; N]; N], mut right: [f64; N]) -> [f64; N] {
    for k in 0..N {
        let (row, of_row) = (matrix[k], right[k]);
        for i in (0..N).filter(|i| *i != k) {
            let factor = matrix[i][k] / row[k];
            (0..N).for_each(|j| matrix[i][j] -= factor * row[j]);
            right[i] -= factor * of_row;
        }
    }
    std::array::from_fn(|k| right[k] / matrix[k][k])
}

/// Solution of ẏ = f(t, y) at every interval (s) up to the end (s), by `parts` steps of the classical Runge–Kutta method in each.
fn runge_kutta<const N: usize>(
    f: impl Fn(f64, [f64; N]) -> [f64; N],
    start: [f64; N],
    interval: f64,
    parts: usize,
    end: f64,
) -> Vec<[f64; N]> {
    let step = interval / parts as f64;
    let moved = |y: [f64; N], rate: [f64; N], h: f64| -> [f64; N] { std::array::from_fn(|k| y[k] + h * rate[k]) };
    let (mut y, mut states) = (start, vec![start]);
    for n in 0..(end / interval).round() as usize {
        for part in 0..parts {
            let t = n as f64 * interval + part as f64 * step;
            let a = f(t, y);
            let b = f(t + 0.5 * step, moved(y, a, 0.5 * step));
            let c = f(t + 0.5 * step, moved(y, b, 0.5 * step));
            let d = f(t + step, moved(y, c, step));
            y = std::array::from_fn(|k| y[k] + step / 6.0 * (a[k] + 2.0 * (b[k] + c[k]) + d[k]));
        }
        states.push(y);
    }
    states
}
