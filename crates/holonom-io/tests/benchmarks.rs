//! The IFToMM and IVP benchmarks of the gallery against solutions computed elsewhere in 113-bit arithmetic, 15 digits.

use holonom::analysis;
use holonom::model::Model;
use holonom::record::{Constraints, Recorder, Recording};
use holonom::simulation::{Choice, Method, NAMED, Simulation, Status, Summary};
use holonom_io::Source;

/// Accuracy asked of Radau IIA: round-off leaves little more.
const ACCURACY: f64 = 1e-12;

/// Largest error of Radau IIA in m, rad, m/s: the numbers compared are up to 55 m or rad, and 150 rad/s.
const AGREES: f64 = 1e-8;

/// The same for Andrews' mechanism, of which only the angles are compared, after two and a half turns.
const ANDREWS_AGREES: f64 = 1e-9;

/// What the observed order of a method of order two may be, from a step and half of it.
const SECOND: std::ops::RangeInclusive<f64> = 1.8..=2.2;

/// Largest drift of energy of the conserving scheme over the size of its terms, and largest violation of rows and rates.
const KEPT: f64 = 1e-9;
const HELD: f64 = 1e-10;

/// The last row of a recording, by column.
type Columns<'a> = &'a dyn Fn(&str) -> f64;

struct Benchmark {
    model: &'static str,
    /// Keys of the model file with other values, as the command takes them.
    set: &'static [(&'static str, &'static str)],
    /// Quantities of the reference from the columns of a recording.
    measure: fn(Columns<'_>) -> Vec<f64>,
    /// A time at which the order of a method is observed, s, with the reference there, and the coarser step.
    early: (f64, &'static str),
    step: f64,
    /// The last time of the reference, s, and the reference there.
    late: (f64, &'static str),
    agrees: f64,
}

/// β, Θ, γ, Φ, δ, Ω, ε.
fn andrews(at: Columns<'_>) -> Vec<f64> {
    let start = [-0.0617138900142764, 0.0, 0.45527981916307, 0.222668390165886, 0.487364979543843, -0.222668390165886, 1.23054744454982];
    ["O", "F", "B", "G", "A-G", "H", "A-H"].iter().zip(start).map(|(joint, start)| start + at(&format!("{joint}.angle"))).collect()
}

/// Position and velocity of P3, the far end of rod 2: twice what the middle of rod 2 is ahead of the middle of rod 1.
fn bricard(at: Columns<'_>) -> Vec<f64> {
    ["x", "y", "z", "vx", "vy", "vz"].iter().map(|c| 2.0 * (at(&format!("rod2.{c}")) - at(&format!("rod1.{c}")))).collect()
}

/// s, ṡ, β, β̇, ψ, ψ̇.
fn governor(at: Columns<'_>) -> Vec<f64> {
    vec![
        0.5 + at("sleeve.displacement"),
        at("sleeve.displacement_rate"),
        std::f64::consts::FRAC_PI_6 + at("right-hinge.angle"),
        at("right-hinge.angle_rate"),
        at("bearing.angle"),
        at("bearing.angle_rate"),
    ]
}

/// θ, θ̇, place and speed of the slider, place, velocity and angular velocity of the rod.
fn slider_crank(at: Columns<'_>) -> Vec<f64> {
    let rod = ["x", "y", "z", "vx", "vy", "vz", "wx", "wy", "wz"].map(|c| format!("rod.{c}"));
    let first = ["A.angle", "A.angle_rate", "slider.x", "slider.vx"].map(String::from);
    first.iter().chain(&rod).map(|column| at(column)).collect()
}

/// Rotation matrix by rows, and angular velocity in body axes.
fn turned(body: &str, at: Columns<'_>) -> Vec<f64> {
    let [w, x, y, z] = ["qw", "qx", "qy", "qz"].map(|c| at(&format!("{body}.{c}")));
    let omega = ["wx", "wy", "wz"].map(|c| at(&format!("{body}.{c}")));
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
        [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
        [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let own = (0..3).map(|c| (0..3).map(|r| rows[r][c] * omega[r]).sum());
    rows.as_flattened().iter().copied().chain(own).collect()
}

/// Where the governor is among the benchmarks.
const GOVERNOR: usize = 2;

const BENCHMARKS: [Benchmark; 6] = [
    Benchmark {
        model: "andrews",
        set: &[],
        measure: andrews,
        early: (
            0.01,
            "2.16011313153153 -1.88336423110704 0.158516758001227 -0.32864107517467 0.525154774797729 0.32864107517467 \
             1.0684272046324",
        ),
        step: 5e-5,
        late: (
            0.03,
            "15.8107711951537 -15.7563710584118 0.0408222401196458 -0.53473011634208 0.524409965879954 0.53473011634208 \
             1.04808074104194",
        ),
        agrees: ANDREWS_AGREES,
    },
    Benchmark {
        model: "bricard",
        set: &[],
        measure: bricard,
        early: (1.0, "0.274481319264623 -0.886707938734672 -0.462330002687376 -1.09491945241351 0.156699079370272 -0.300534935786959"),
        step: 0.02,
        late: (
            10.0,
            "0.999730987303835 -0.999999963825817 -0.000268976512249305 -0.0324532802222992 8.72682218333837e-06 -0.0324445498778872",
        ),
        agrees: AGREES,
    },
    Benchmark {
        model: "flyball-governor",
        set: &[],
        measure: governor,
        early: (0.5, "0.743249424786326 0.0521197801583734 0.259491381543413 -0.0539052184987425 2.8076794883679 5.10341542197154"),
        step: 0.01,
        late: (10.0, "0.619622917061366 -0.747603354164332 0.390073701844645 0.808467051345577 55.9354099091024 5.54820362265493"),
        agrees: AGREES,
    },
    Benchmark {
        model: "slider-crank",
        set: &[],
        measure: slider_crank,
        early: (
            0.2,
            "1.28724232688497 9.78289046579213 0.263038972580853 0.426024565192591 0.131519486290427 0.0115973118828113 \
             0.0711907794801762 0.213012282596295 -0.109478169881398 -0.375689291442434 0.660599321899688 -2.91478075698645 \
             0.474831456483793",
        ),
        step: 0.01,
        late: (
            5.0,
            "54.3333321683132 11.4949962650421 0.240719573729615 -0.595984412044936 0.120359786864808 0.0819750669028761 \
             0.0359667917964205 -0.297992206022468 0.276261638537125 0.367553274623031 2.5199856173384 1.33746734886001 \
             -3.04833903517976",
        ),
        agrees: AGREES,
    },
    Benchmark {
        model: "heavy-top",
        set: &[],
        measure: |at| turned("top", at),
        early: (
            0.1,
            "-0.716889536651476 0.421296658925402 0.555498440517995 0.227743007555332 0.894571974345593 -0.384544022479975 \
             -0.658940448560629 -0.1491647005619 -0.737256656366692 4.80894133172809 150 1.02830075671833",
        ),
        step: 5e-4,
        late: (
            2.0,
            "-0.487449082236266 -0.150416822745642 0.860097768664777 -0.537939743844151 -0.724165591636896 -0.431514806098324 \
             0.687760295611714 -0.673022269560444 0.272078665932846 0.122233219497394 150 -5.85562458920546",
        ),
        agrees: AGREES,
    },
    // That of the reference has moments of inertia that no body has. This one is computed for this test with a
    // Taylor series of order 30 in 60 digits; it flips less sharply than the racket of the gallery, which from 1e-12 makes 1e-6.
    Benchmark {
        model: "free-body",
        set: &[("parameters.stray", "0.5")],
        measure: |at| turned("racket", at),
        early: (
            5.0,
            "-0.395374041360877 0.160053836979734 -0.904467874877838 -0.15314132183047 0.959431959093995 0.236723575963773 \
             0.905663901768191 0.232105762826183 -0.354823634918661 -0.370604386332847 5.01125257683454 0.460922123273605",
        ),
        step: 0.01,
        late: (
            30.0,
            "0.953189941155993 -0.0351889553608747 0.300317621027548 -0.115236492974646 -0.960524306109231 0.253206650900574 \
             0.279552297014243 -0.275961582097927 -0.919617158626387 -0.2564415136471 -5.01838995595982 0.434266527193311",
        ),
        agrees: AGREES,
    },
];

/// A model of the gallery with other values of some keys.
fn example(name: &str, set: &[(&str, &str)]) -> Model {
    let path = format!("{}/../../examples/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut source = Source::read(name, &std::fs::read(path).unwrap()).unwrap_or_else(|message| panic!("{message}"));
    set.iter().for_each(|(key, value)| source.set(key, value).unwrap_or_else(|message| panic!("{message}")));
    source.model().unwrap_or_else(|message| panic!("{message}"))
}

fn run(name: &str, set: &[(&str, &str)], method: &str, accuracy: Option<f64>, step: f64, end: f64) -> (Recording, Summary) {
    let model = example(name, set);
    let choice = Choice { method: Some(method.into()), accuracy, ..Choice::default() };
    let method = Method::resolve(&choice).unwrap_or_else(|error| panic!("{error}"));
    let label = format!("{name}, {}, step {step}", method.name);
    let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap_or_else(|error| panic!("{label}: {error}"));
    let mut recorder = Recorder::new(&model.channels, &model.system, 1, Constraints::Nothing);
    let status = simulation.run(end, &mut recorder);
    assert_eq!(status, Status::Completed, "{label}");
    let size = analysis::rank(&model.system, &simulation.state().x, end).size(&model.system);
    (recorder.finish(), simulation.summary("test", end, &status, size))
}

/// The largest difference of a recording's last row from a reference.
fn error(benchmark: &Benchmark, recording: &Recording, reference: &str) -> f64 {
    let last = |column: &str| *recording.column(column).unwrap_or_else(|| panic!("there is no column {column}")).last().expect("rows");
    let found = (benchmark.measure)(&last);
    let reference: Vec<f64> = reference.split_whitespace().map(|number| number.parse().expect("a number")).collect();
    assert_eq!(found.len(), reference.len());
    found.iter().zip(&reference).map(|(found, reference)| (found - reference).abs()).fold(0.0, f64::max)
}

fn check_radau(benchmarks: &[Benchmark]) {
    let mut wrong = Vec::new();
    for benchmark in benchmarks {
        let (end, reference) = benchmark.late;
        let (recording, summary) = run(benchmark.model, benchmark.set, "radau", Some(ACCURACY), 0.1 * end, end);
        let error = error(benchmark, &recording, reference);
        let line = format!("{:18} {end:5} s: error {error:8.1e} in {} steps", benchmark.model, summary.work.steps_taken);
        println!("{line}");
        if error.is_nan() || error > benchmark.agrees {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn radau_agrees_with_the_references() {
    check_radau(&BENCHMARKS[..GOVERNOR]);
    check_radau(&BENCHMARKS[GOVERNOR + 1..]);
}

/// A test of its own, as it takes longer than all others together: the springs ask for short steps.
#[test]
fn radau_agrees_with_the_reference_of_the_governor() {
    check_radau(&BENCHMARKS[GOVERNOR..=GOVERNOR]);
}

#[test]
fn conserving_schemes_are_of_second_order() {
    let mut wrong = Vec::new();
    for benchmark in &BENCHMARKS {
        let (end, reference) = benchmark.early;
        for method in ["conserving-ggl", "conserving"] {
            let error_with = |step: f64| error(benchmark, &run(benchmark.model, benchmark.set, method, None, step, end).0, reference);
            let [coarse, fine] = [benchmark.step, 0.5 * benchmark.step].map(error_with);
            let order = (coarse / fine).log2();
            let line = format!("{:18} {method:14} errors {coarse:8.1e} and {fine:8.1e}, order {order:.2}", benchmark.model);
            println!("{line}");
            if !SECOND.contains(&order) {
                wrong.push(line);
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Redundant wherever it is; ten seconds are two of its periods.
#[test]
fn bricard_keeps_energy_and_rows() {
    let (_, Summary { energy, violation, .. }) = run("bricard", &[], "conserving-ggl", None, 0.01, 10.0);
    println!(
        "drift {:.1e} J of {} J, position {:.1e}, velocity {:.1e}",
        energy.max_drift, energy.initial, violation.position, violation.velocity
    );
    assert!(energy.max_drift <= KEPT * energy.initial.abs(), "{}", energy.max_drift);
    assert!(violation.position <= HELD && violation.velocity <= HELD, "{} and {}", violation.position, violation.velocity);
}

/// The springs of the governor are hundreds of times faster than this step.
#[test]
fn every_named_method_gets_through_the_governor() {
    for named in NAMED.iter().filter(|named| named.name != "trapezoidal") {
        let (recording, summary) = run("flyball-governor", &[], named.name, None, 0.01, 10.0);
        let error = error(&BENCHMARKS[GOVERNOR], &recording, BENCHMARKS[GOVERNOR].late.1);
        println!("{:24} error {error:8.1e}, drift {:8.1e} J, {} iterations", named.name, summary.energy.max_drift, summary.work.iterations);
    }
}
