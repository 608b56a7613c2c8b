//! Events of conditions that stay at zero: rounding decides on which side of zero they are, and makes none.

mod common;

use common::model_with_forces as model;
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

const METHODS: [(&str, Option<f64>); 8] = [
    ("conserving-ggl", None),
    ("conserving", None),
    ("generalized-alpha", None),
    ("radau", None),
    ("bdf-2", None),
    ("conserving-ggl", Some(1e-4)),
    ("radau", Some(1e-6)),
    ("ode/dop853", Some(1e-6)),
];

/// The times of the events of a model that runs to `end` (s), and what its input `n` is then.
fn run(text: &str, (method, accuracy): (&str, Option<f64>), end: f64) -> (Vec<f64>, f64) {
    let choice = Choice { accuracy, ..Choice::default().named(method) };
    let mut simulation = Simulation::new(model(text).system, Method::resolve(&choice).unwrap(), 0.01).unwrap();
    let status = simulation.run(end, &mut |_: &Simulation| Verdict::GoOn);
    assert_eq!(status, Status::Completed, "{method}, {accuracy:?}");
    (simulation.events().iter().map(|event| event.t).collect(), simulation.input("n").unwrap())
}

/// A hinge that is led to an angle in 1 s and dwells there, with lengths times `scale`, `far` from the origin.
fn dwelling(scale: f64, far: f64, event: &str) -> String {
    format!(
        "plane = \"xz\"\n[body.arm]\nmass = 1\ninertia = {}\nposition = [{}, 0]\n\
         [joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"arm\"]\nat = [{far}, 0]\n\
         [drive.d]\ntype = \"angle\"\njoint = \"j\"\nprofile = {{ table = [[0, 0], [1, 0.5]], ends = \"rest\" }}\n\
         [input.n]\ndefault = 0\n[event.e]\nset = {{ n = \"n + 1\" }}\n{event}\n",
        0.1 * scale * scale,
        far + 0.5 * scale
    )
}

#[test]
fn what_dwells_at_a_condition_comes_to_it_once() {
    for (scale, far) in [(1.0, 0.0), (1e3, 0.0), (1e-3, 0.0), (1.0, 1e4)] {
        for method in METHODS {
            for (event, times) in [
                ("when = \"j.angle - 0.5\"\ndirection = \"rising\"", 1),
                // It comes from below, and never leaves.
                ("when = \"j.angle - 0.5\"\ndirection = \"falling\"", 0),
            ] {
                let (found, n) = run(&dwelling(scale, far, event), method, 3.0);
                assert_eq!((found.len(), n), (times, times as f64), "{method:?}, scale {scale}, {far} m away, {event}: {found:?}");
                // It comes to rest there, and is there to round-off a little earlier.
                assert!(found.iter().all(|t| (t - 1.0).abs() < 1e-5), "{method:?}: {found:?}");
            }
        }
    }
}

/// A rigid triangle that swings, whose side never gets longer; each count would brake it.
#[test]
fn what_constraints_keep_never_happens() {
    let text = "plane = \"xz\"\n[point.a]\nmass = 1\nposition = [1, 0]\n[point.b]\nmass = 1\nposition = [0.7, -0.8]\n\
                [constraint.oa]\ntype = \"distance\"\nbetween = [\"ground\", \"a\"]\n\
                [constraint.ob]\ntype = \"distance\"\nbetween = [\"ground\", \"b\"]\n\
                [constraint.ab]\ntype = \"distance\"\nbetween = [\"a\", \"b\"]\n\
                [input.n]\ndefault = 0\n[event.longer]\nwhen = \"distance(a, b) - sqrt(0.09 + 0.64)\"\nset = { n = \"n + 1\" }\n\
                [event.moves]\nwhen = \"(distance(a, b) - sqrt(0.09 + 0.64))*a.vx\"\nset = { n = \"n + 1\" }\n\
                [force.f]\ntype = \"expression\"\npoint = \"a\"\nforce = [\"-n*vx\", \"-n*vz\"]\n";
    for method in METHODS {
        assert_eq!(run(text, method, 2.0), (Vec::new(), 0.0), "{method:?}");
    }
}

/// A trolley that a drive holds on a jib that slews, and its speed along it.
#[test]
fn what_a_drive_holds_never_happens() {
    let text = "[body.m]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [1, 0, 0]\nangular_velocity = [0, 0, 3]\nvelocity = [0, 3, 0]\n\
                [body.o]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [2, 0, 0]\nangular_velocity = [0, 0, 3]\nvelocity = [0, 6, 0]\n\
                [joint.j]\ntype = \"revolute\"\nbetween = [\"ground\", \"m\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                [joint.k]\ntype = \"prismatic\"\nbetween = [\"m\", \"o\"]\naxis = [1, 0, 0]\n\
                [drive.d]\ntype = \"displacement\"\njoint = \"k\"\nprofile = \"0\"\n[input.n]\ndefault = 0\n\
                [event.e]\nwhen = \"k.displacement\"\nset = { n = \"n + 1\" }\n";
    for method in METHODS {
        assert_eq!(run(text, method, 2.0), (Vec::new(), 0.0), "{method:?}");
    }
}
