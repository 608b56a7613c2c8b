//! What is far from the origin, and what goes there: its motion, its energies, and the iterations that it takes.

mod common;

use common::{CONSERVING, complete, coordinates, model};
use holonom::simulation::{Choice, Method, Simulation, Status, Verdict};

/// A spatial double pendulum on a carrier that goes a hundred kilometres: positions are rounded by 1e-11 m there, and an
/// iteration that wants less finds nothing but that: it took 22 a step for 2.7, and 288 of 1000 steps in halves.
#[test]
fn what_travels_takes_the_iterations_of_what_stays() {
    let travelling = |speed: f64| {
        model(&format!(
            "[body.carrier]\nmass = 2\ninertia = [0.1, 0.2, 0.15]\nposition = [0, 0, 0]\nvelocity = [{speed}, 0, 0]\n\
             [body.load]\nmass = 1\ninertia = [0.02, 0.03, 0.02]\nposition = [0.3, 0.1, -0.8]\nvelocity = [{speed}, 0, 0]\n\
             [body.top]\nmass = 1\ninertia = [0.02, 0.03, 0.02]\nposition = [0.9, 0, -0.8]\nvelocity = [{speed}, 0.4, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"carrier\"]\naxis = [1, 0, 0]\n\
             [joint.ball]\ntype = \"spherical\"\nbetween = [\"carrier\", \"load\"]\nat = [0, 0, 0]\n\
             [joint.cross]\ntype = \"universal\"\nbetween = [\"load\", \"top\"]\nat = [0.6, 0, -0.8]\naxes = [[1, 0, 0], [0, 1, 0]]\n"
        ))
    };
    for of in CONSERVING {
        let iterations = |speed: f64| {
            let summary = complete("travels", &travelling(speed), of, 0.01, 10.0);
            assert_eq!(summary.work.rejected_steps, 0, "{of}, {speed} m/s");
            summary.work.iterations_per_step
        };
        let (stays, travels) = (iterations(0.0), iterations(1e4));
        assert!(travels <= 1.1 * stays, "{of}: {travels} iterations for {stays}");
    }
}

/// Two hinged boxes far from the origin move as they do there: places of 1e7 m are rounded by 2e-9 m when they are read.
#[test]
fn far_from_the_origin_nothing_is_lost() {
    let boxes = |[x, y, z]: [f64; 3], reactions: bool| {
        let mut text = format!("gravity = [0, 0, -9.81]\n[output]\nreactions = {reactions}\n");
        for (k, before) in ["ground", "b0"].iter().enumerate() {
            let (hinge, centre) = (x + k as f64, x + k as f64 + 0.5);
            text += &format!("[body.b{k}]\nmass = 2\nshape = {{ box = [1, 0.2, 0.1] }}\nposition = [{centre}, {y}, {z}]\n");
            text += &format!("[joint.j{k}]\ntype = \"revolute\"\nbetween = [\"{before}\", \"b{k}\"]\nat = [{hinge}, {y}, {z}]\n");
            text += "axis = [0, 1, 0]\n";
        }
        text + "[force.wind]\ntype = \"force\"\nbody = \"b1\"\n" + &format!("force = [\"0\", \"0\", \"3*(x - {x})\"]\n")
    };
    for reactions in [false, true] {
        for of in ["conserving-ggl", "conserving", "generalized-alpha", "radau"] {
            let near = coordinates(&model(&boxes([0.0; 3], reactions)), of, 0.01, 1.0);
            for far in [1e4, 1e7] {
                let away = coordinates(&model(&boxes([far, 0.5 * far, -far], reactions)), of, 0.01, 1.0);
                for ((name, near), (_, away)) in near.iter().zip(&away) {
                    // The force is of the rounded place.
                    let bound = 1e-9 + 10.0 * far * f64::EPSILON;
                    assert!(
                        (near - away).abs() <= bound,
                        "{name} with {of}, reactions {reactions}: {away} rad at {far} m, {near} rad here"
                    );
                }
            }
        }
    }
}

/// A satellite that is tied to what it carries in four places, along and across no axis: its centre is a sum of these with factors that are
/// nothing but for rounding, and what is left out of them is not left out of the way from the origin.
#[test]
fn centres_far_away_are_where_they_are_written() {
    let turned = |[x, y, z]: [f64; 3]| [(2.0 * x - y + 2.0 * z) / 3.0, (2.0 * x + 2.0 * y - z) / 3.0, (2.0 * y + 2.0 * z - x) / 3.0];
    let satellite = |far: f64| {
        let way = |x: [f64; 3]| format!("{:?}", turned(x));
        let place = |x: [f64; 3]| format!("{:?}", [0, 1, 2].map(|c| turned(x)[c] + [3.0, -4.0, 2.0][c] * far));
        let mut text = "gravity = [0, 0, 0]\n".to_string();
        let bodies =
            [("hub", 50.0, [0.0; 3]), ("wheel", 4.0, [0.0, 0.0, 0.4]), ("panel", 6.0, [1.2, 0.0, 0.0]), ("arm", 3.0, [0.0, 1.0, 0.0])];
        for (name, mass, at) in bodies {
            text += &format!("[body.{name}]\nmass = {mass}\ninertia = [{0}, {0}, {0}]\nposition = {1}\n", 0.1 * mass, place(at));
        }
        let hinges = [("spin", "wheel", [0.0, 0.0, 0.4], [0.0, 0.0, 1.0]), ("fold", "panel", [0.5, 0.0, 0.0], [0.0, 1.0, 0.0])];
        for (name, body, at, axis) in hinges {
            text += &format!("[joint.{name}]\ntype = \"revolute\"\nbetween = [\"hub\", \"{body}\"]\nat = {}\n", place(at));
            text += &format!("axis = {}\n[start.{name}]\nangle_rate = 3\n", way(axis));
        }
        text += &format!("[joint.ball]\ntype = \"spherical\"\nbetween = [\"hub\", \"arm\"]\nat = {}\n", place([0.0, 0.5, 0.0]));
        let ends = [[0.3, 0.3, 0.3], [0.1, 1.1, 0.1]].map(place).join(", ");
        text += &format!("[joint.tie]\ntype = \"distance\"\nbetween = [\"hub\", \"arm\"]\nat = [{ends}]\n");
        text += &format!("[point.tip]\nmass = 5\nposition = {}\n", place([-2.0, -0.3, 0.2]));
        text + "[force.tether]\ntype = \"rope\"\nbetween = [\"hub\", \"tip\"]\nlength = 2\nstiffness = 900\n"
    };
    let near = coordinates(&model(&satellite(0.0)), "conserving-ggl", 0.01, 0.5);
    for far in [1e4, 1e6] {
        let away = coordinates(&model(&satellite(far)), "conserving-ggl", 0.01, 0.5);
        for ((name, near), (_, away)) in near.iter().zip(&away) {
            let bound = 100.0 * far * f64::EPSILON;
            assert!((near - away).abs() <= bound, "{name}: {away} at {far} m, {near} here");
        }
    }
}

/// The potential counts from the world's origin, at the start and at the end.
#[test]
fn energies_far_away_are_those_of_the_world() {
    let text = "gravity = [0, 0, -9.81]\n[body.b]\nmass = 2\nshape = { box = [1, 0.2, 0.1] }\nposition = [1e7, 0, 1e7]\n";
    let energy = complete("far", &model(text), "conserving", 0.01, 1.0).energy;
    assert!((energy.initial - 2.0 * 9.81 * 1e7).abs() <= 1e-6, "{} J at the start", energy.initial);
    assert!((energy.last - energy.initial).abs() <= 1e-6, "{} J at the start, {} J at the end", energy.initial, energy.last);
}

/// A frame of a millimetre that cannot move, a hundred times as far from the origin: its places are rounded by themselves, not by
/// that way, and unit vectors of its angles tie it to no place.
#[test]
fn small_structures_stand_still_far_from_the_origin() {
    let text = r#"
plane = "xy"
[body.a]
mass = 2
position = [0.1835, 0.0154]
shape = { box = [6e-4, 3e-4, 3e-4] }
[body.b]
mass = 1
position = [0.1844, 0.0156]
inertia = 4e-8
[joint.hinge]
type = "revolute"
between = ["ground", "a"]
at = [0.1821, 0.0158]
[joint.weld]
type = "fixed"
between = ["a", "b"]
at = [0.1841, 0.0153]
[joint.again]
type = "revolute"
between = ["b", "a"]
at = [0.18205, 0.01567]
[joint.gears]
type = "gear"
joints = ["hinge.angle", "again.angle"]
ratio = -0.8
"#;
    let model = model(text);
    assert!(model.system.origin()[0] > 0.18, "counted from {:?}", model.system.origin());
    for of in CONSERVING {
        let drift = complete("structure", &model, of, 2e-3, 0.1).energy.max_drift;
        println!("{of}: {drift:.1e} J");
        assert!(drift <= 1e-27, "{of}: {drift:e} J");
    }
}

/// Gravity turns what it pulls beside the origin, however short the lever is beside a metre: nothing is said of what it changes.
#[test]
fn momenta_that_gravity_changes_by_a_short_lever_are_not_among_those_kept() {
    let fall = |text: &str| complete("fall", &model(text), "conserving", 5e-4, 0.025).momentum;
    let beside =
        "plane = \"xy\"\ngravity = [0, -2.3]\n[body.b]\nmass = 1e5\nposition = [-0.23050168222562378, -0.6]\nshape = { sphere = 1e-4 }\n";
    let summary = fall(beside);
    assert_eq!([summary.linear_drift, summary.angular_drift], [0.0, 0.0]);
    // About the vertical axis nothing does, nor is there a push along the level.
    let thrown = "gravity = [0, 0, -9.81]\n[body.b]\nmass = 1\nposition = [0.016513755783782315, 0, 0]\nvelocity = [0.3, -0.067, -0.049]\n\
                  angular_velocity = [-3.7, 3.0, -4.1]\nshape = { sphere = 1e-5 }\n";
    let summary = fall(thrown);
    assert!(summary.linear_drift > 0.0 || summary.angular_drift > 0.0, "round-off of what is kept is measured");
    assert!(summary.linear_drift <= 1e-15 && summary.angular_drift <= 1e-17, "{summary:?}");
}

/// A bob on a spring below a hand that shakes: far from the origin the place of the hand is rounded by 2e-12 m where its formula has it, and the spring
/// makes energy of that which no shorter step makes less.
#[test]
fn a_hand_that_is_far_away_shakes_what_it_holds() {
    let end = |z: f64| {
        let text = format!(
            "plane = \"xz\"\n[point.hand]\nmotion = [0, \"{z} + 0.03*sin(25*t)\"]\n[point.bob]\nmass = 0.06\nposition = [0, {}]\n\
             [force.string]\ntype = \"spring\"\nbetween = [\"hand\", \"bob\"]\nstiffness = 800\ndamping = 0.15\n",
            z - 0.25
        );
        let choice = Choice { accuracy: Some(1e-8), ..Choice::default().named("radau") };
        common::last(&common::run(&model(&text), choice, 0.01, 1.0).1, "bob.z") - z
    };
    let (near, far) = (end(0.0), end(1e4));
    assert!((far - near).abs() < 1e-9, "{far} m below a hand that is far away, {near} m below one that is near");
}

/// A hand that shakes far away holds a light rod, which feels how its place is rounded: the run that finds no step short enough says that.
#[test]
fn runs_that_stop_for_rounded_places_say_so() {
    let reason = |z: f64| {
        let text = format!(
            "[point.hand]\nmotion = [\"{z} + 0.02*sin(9*t)\", {z}, \"{z} + 0.03*sin(25*t)\"]\n[body.rod]\nmass = 1e-4\ninertia = [1e-9, 1e-8, 1e-8]\n\
             position = [{}, {z}, {z}]\n[joint.ball]\ntype = \"spherical\"\nbetween = [\"hand\", \"rod\"]\nat = [{z}, {z}, {z}]\n\
             [point.bob]\nmass = 0.3\nposition = [{}, {z}, {z}]\n[constraint.string]\ntype = \"distance\"\nbetween = [\"rod\", \"bob\"]\n",
            z + 0.1,
            z + 0.3
        );
        let method = Method::resolve(&Choice { accuracy: Some(1e-9), ..Choice::default().named("radau") }).unwrap();
        let mut simulation = Simulation::new(model(&text).system.clone(), method, 0.01).unwrap();
        match simulation.run(0.05, &mut |_: &Simulation| Verdict::GoOn) {
            Status::Stopped { reason, .. } => reason,
            status => format!("{status:?}"),
        }
    };
    assert_eq!(reason(0.0), "Completed");
    let far = reason(1e5);
    assert!(far.contains("1.0e5 m from the origin places are rounded to 2e-11 m") && far.contains("nearer to the origin"), "{far}");
}
