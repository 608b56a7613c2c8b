//! Rows that are made of samples later and elsewhere have the bits of those that are made beside the steps, and so has what a run is resumed from.

use std::path::Path;

use holonom::model::Model;
use holonom::record::{Composer, Constraints, Recorder, RecorderMark, Recording, Sampler, Samples};
use holonom::simulation::{Checkpoint, Divisions, Observer, Simulation, Verdict};
use holonom_io::Source;

/// Numbers of samples that are handed over at once.
const PORTION: usize = 1000;

/// An arm of two links on a spring, with measures that read forces of joints over the whole run, an event that sets an input, and one that ends the
/// run at a nominal time.
const EVENTFUL: &str = r#"
[body.arm]
mass = 2
inertia = [0.01, 0.2, 0.2]
position = [0.5, 0, 0]

[joint.hinge]
type = "revolute"
between = ["ground", "arm"]
at = [0, 0, 0]
axis = [0, 1, 0]

[body.tip]
mass = 0.5
inertia = [0.01, 0.01, 0.01]
position = [1, 0, 0]

[joint.wrist]
type = "revolute"
between = ["arm", "tip"]
at = [1, 0, 0]
axis = [0, 1, 0]

[force.spring]
type = "spring"
between = [[0, 0, 1], "tip"]
stiffness = 300

[measure.peak]
value = "max(hinge.fx)"

[measure.power]
value = "rms(wrist.fz*wrist.angle_rate)"

[input.pull]
default = 0

[force.load]
type = "force"
body = "tip"
force = ["pull", 0, 0]

[event.level]
when = "hinge.angle - 0.05"
set = { pull = 3 }

[event.end]
when = "t - 0.2"
stop = true

[simulation]
step = 0.01
end = 0.5
"#;

/// Makes rows of portions of samples.
struct Divided {
    sampler: Sampler,
    samples: Samples,
    composer: Composer,
}

impl Divided {
    fn hand_over(&mut self) {
        self.composer.take(&self.samples);
        self.samples.clear();
    }
}

impl Observer for Divided {
    fn after_step(&mut self, simulation: &Simulation) -> Verdict {
        self.sampler.after_step(simulation, &mut self.samples);
        if self.samples.size() > PORTION {
            self.hand_over();
        }
        Verdict::GoOn
    }

    fn wants_forces(&self) -> bool {
        false
    }

    fn divisions(&self) -> Divisions {
        self.sampler.divisions()
    }

    fn at_division(&mut self, simulation: &Simulation) {
        self.sampler.at_division(simulation, &mut self.samples);
    }
}

/// What a run leaves: its columns, and what it is resumed from.
fn run(model: &Model, every: u64, steps: f64, is_divided: bool) -> (Recording, String) {
    let mut simulation = model.simulation().unwrap();
    if model.output.constraints() != Constraints::Nothing {
        model.find_reactions(&mut simulation);
    }
    let end = simulation.state().t + steps * simulation.nominal_step();
    let mut recorder = Recorder::new(&model.channels, &model.system, every, model.output.constraints());
    let status = if !is_divided {
        simulation.run(end, &mut recorder)
    } else {
        let Ok((sampler, composer)) = recorder.divide(&mut simulation) else { panic!("forces are found apart from the steps") };
        let mut divided = Divided { sampler, samples: Samples::default(), composer };
        let status = simulation.run(end, &mut divided);
        divided.hand_over();
        let Divided { sampler, composer, .. } = divided;
        let mut point = simulation.checkpoint();
        composer.complete(&mut point);
        let mark = composer.mark(sampler.mark());
        recorder = Recorder::join(sampler, composer, &mut simulation);
        assert_eq!(
            written(&point, &mark),
            written(&simulation.checkpoint(), &recorder.mark()),
            "what is put together meanwhile is what stands there at the end"
        );
        status
    };
    let point = format!("{status:?} {}", written(&simulation.checkpoint(), &recorder.mark()));
    (recorder.finish(), point)
}

fn written(point: &Checkpoint, mark: &RecorderMark) -> String {
    serde_json::to_string(&(point, mark)).unwrap()
}

fn bits(recording: &Recording) -> Vec<(&str, Vec<u64>)> {
    let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect();
    recording.columns().iter().map(|column| (&*column.heading.name, bits(&column.values))).collect()
}

#[test]
fn rows_that_are_made_later_have_the_same_bits() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples");
    let mut models: Vec<(String, Vec<u8>)> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|ending| ending == "toml"))
        .map(|path| (path.display().to_string(), std::fs::read(&path).unwrap()))
        .collect();
    models.push(("eventful".into(), EVENTFUL.into()));
    models.push((
        "eventful, without forces of joints".into(),
        format!("{}\n[output]\nreactions = false\n", &EVENTFUL.replace("hinge.fx", "tip.vx").replace("wrist.fz", "tip.vz")).into(),
    ));
    models.push(("eventful, by accuracy".into(), format!("{EVENTFUL}accuracy = 1e-6\n").into()));
    for (name, text) in &models {
        let model = Source::read(name, text).and_then(|source| source.model()).unwrap();
        for every in [1, 7] {
            let [(whole, point), (divided, other)] = [false, true].map(|is_divided| run(&model, every, 40.0, is_divided));
            assert_eq!(bits(&whole), bits(&divided), "{name}, one row in {every}");
            assert_eq!(point, other, "{name}, one row in {every}");
        }
    }
}
