//! Ranks, redundant rows and freedom: many bodies and other units, and rows beside redundant and weak ones.

mod common;

use common::{example, freedom, model, run, run_every};
use holonom::analysis::rank;
use holonom::simulation::Choice;

/// Boxes in a row, each hinged to the one before about an axis across.
fn boxes(count: usize, alternates: bool, [mass, length]: [f64; 2], reactions: bool) -> String {
    let mut text = format!("gravity = [0, 0, {}]\n[output]\nreactions = {reactions}\n", -9.81 * length / 0.5);
    for k in 0..count {
        let (x, place) = (length * (k as f64 + 0.5), length * k as f64);
        let before = if k == 0 { "ground".into() } else { format!("b{}", k - 1) };
        let axis = if alternates && k % 2 == 1 { "[0, 0, 1]" } else { "[0, 1, 0]" };
        let size = format!("[{length}, {}, {}]", 0.2 * length, 0.1 * length);
        text += &format!("[body.b{k}]\nmass = {mass}\nshape = {{ box = {size} }}\nposition = [{x}, 0, 0]\n");
        text += &format!("[joint.j{k}]\ntype = \"revolute\"\nbetween = [\"{before}\", \"b{k}\"]\nat = [{place}, 0, 0]\naxis = {axis}\n");
    }
    text
}

#[test]
fn freedom_does_not_depend_on_size_or_units() {
    for reactions in [false, true] {
        for alternates in [false, true] {
            for count in [250, 2000] {
                let many = model(&boxes(count, alternates, [2.0, 0.5], reactions));
                assert_eq!(freedom(&many), [count, 0], "{count} boxes, alternating {alternates}, reactions {reactions}");
                let found = rank(&many.system, many.system.start_position(), 0.0);
                assert_eq!(found.near_singular(&many.system), None, "{count} boxes, alternating {alternates}, reactions {reactions}");
            }
            // In kg and m; in t and mm; 1 mg and 10 mm; in g and km.
            for unit in [[2.0, 0.5], [0.002, 500.0], [1e-6, 0.01], [2e3, 5e-4], [1e-9, 1e3]] {
                let two = model(&boxes(2, alternates, unit, reactions));
                assert_eq!(freedom(&two), [2, 0], "{unit:?}, alternating {alternates}, reactions {reactions}");
                for of in ["conserving-ggl", "conserving"] {
                    let (simulation, _) = run(&two, Choice::default().named(of), 0.01, 0.5);
                    let scale = 9.81 * unit[0] * unit[1] * unit[1];
                    let drift = simulation.audit().energy_summary().max_drift;
                    assert!(drift <= 1e-10 * scale, "{unit:?}, {of}: {drift:e}");
                }
            }
        }
    }
}

/// What the last of so many rows adds is far below what counts in a short chain. The weight of a box moves over its length by 10 J.
#[test]
fn long_chains_are_solved_in_few_iterations() {
    let many = model(&boxes(4000, false, [2.0, 0.5], true));
    for of in ["conserving-ggl", "conserving"] {
        let (simulation, _) = run(&many, Choice::default().named(of), 1e-3, 4e-3);
        let iterations = simulation.audit().work_summary(simulation.steps()).iterations_per_step;
        let drift = simulation.audit().energy_summary().max_drift;
        assert!(iterations <= 3.0 && drift <= 1e-10 * 4000.0, "{of}: {iterations} iterations, {drift:e} J");
    }
}

/// Rounding makes more of the weakest row of ten thousand boxes than it adds to the others, and it follows from none of them for that.
#[test]
fn forces_of_very_long_chains_are_known() {
    let many = model(&boxes(10_000, false, [2.0, 0.5], true));
    let (simulation, recording) = run_every(&many, "conserving", 1e-3, 10e-3, 1);
    let iterations = simulation.audit().work_summary(simulation.steps()).iterations_per_step;
    assert!(iterations <= 3.0, "{iterations} iterations");
    let forces = recording.column("j0.fz").unwrap();
    assert!(forces.len() == 11 && forces.iter().all(|force| force.is_finite()), "{forces:?}");
}

/// Light wheels are no singular positions.
#[test]
fn healthy_mechanisms_are_not_near_singular() {
    for name in ["robot-arm", "slider-crank", "stewart-platform"] {
        let model = example(name);
        let found = rank(&model.system, model.system.start_position(), 0.0);
        assert_eq!(found.near_singular(&model.system), None, "{name}");
    }
}

/// Rods to places far from the middle of a body add a millionth of themselves to those before, squared, and count; those beside them, alone and many one
/// after the other, add nothing.
#[test]
fn rods_at_far_places_count_and_their_repetitions_do_not() {
    let (mut text, mut redundant) = (String::from("[body.b]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n[body.b.points]\n"), 0);
    let (count, places) = (120, |k: usize| [400.0 + 3.0 * k as f64, 40.0 * (k % 7) as f64, 40.0 * (k % 5) as f64]);
    (0..count).for_each(|k| text += &format!("q{k} = {:?}\n", places(k)));
    for k in 0..count {
        let [x, y, z] = places(k);
        text += &format!("[point.p{k}]\nmass = 1\nposition = [{x}, {y}, {}]\n", z + 1.0);
        // None, one, two and nineteen rods more.
        let more = if k == 60 { 19 } else { k % 3 };
        (0..=more).for_each(|rod| text += &format!("[constraint.rod{k}-{rod}]\ntype = \"distance\"\nbetween = [\"b.q{k}\", \"p{k}\"]\n"));
        redundant += more;
    }
    // Rods to the ground hold the body, and most of them are redundant.
    (0..count).for_each(|k| text += &format!("[constraint.stay{k}]\ntype = \"distance\"\nbetween = [\"ground\", \"b.q{k}\"]\n"));
    assert_eq!(freedom(&model(&text)), [6 + 3 * count - count - 3, redundant + count - 3]);
}

/// Redundant rows leave round-off, which must not be divided by round-off in the rows after them.
#[test]
fn rows_after_redundant_ones_add_what_they_add() {
    let text = r#"
gravity = [0.0, 0.0, -9.81]
[body.b0]
mass = 0.0002816755966356792
position = [0.33667123997382375, -0.18499437244172967, 0.8288160847355875]
orientation = { quat_wxyz = [-0.6480273583010607, 0.44730832693735, 0.49145866106416375, -0.37208088906967096] }
inertia = [3.3543408314045745e-6, 4.0937406825527726e-7, 3.763714899659852e-6]
[body.b1]
mass = 1.0112973191410906
position = [0.5775089514357208, -0.468274712204371, 0.2513398866384495]
orientation = { quat_wxyz = [-0.6620406997332541, 0.5346649795816834, -0.5249307019839993, 0.01682942720972189] }
shape = { rod = 0.17280645294972674 }
[joint.j1]
type = "spherical"
between = ["b0", "b1"]
at = [0.4530248631218594, -0.6153436321034402, 0.3363067472898725]
[joint.j2]
type = "revolute"
between = ["b0", "b1"]
at = [0.6577111645927314, -0.41759564009139105, 0.30046087292163426]
axis = [-0.32605455438414743, 0.8999948938672173, -0.28930540710171887]
[output]
reactions = true
"#;
    assert_eq!(freedom(&model(text)), [6, 2]);
}

/// The distance row adds 1e-6 of itself, squared, to those before it, and one row after it nothing.
#[test]
fn rows_after_weak_ones_are_seen_as_redundant() {
    let text = r#"
gravity = [7.842308168755432, -5.63682501458379, -1.720612199548257]
[body.b0]
mass = 1.2311608553357236
position = [0.013713757691406387, 0.008441657042866377, 0.011693190463562668]
velocity = [-0.32366206286084903, 1.1234299826728646, 1.3334627692832974]
angular_velocity = [-47.48557639470845, 35.00857691192027, 30.59493843193126]
inertia = [1.8709373569126255e-5, 3.449895416941714e-5, 5.320832773854339e-5]
[joint.j0]
type = "point-on-line"
between = ["ground", "b0"]
at = [-0.006112506909286355, 0.008905917449979216, 0.008106983497911375]
axis = [0.10990197216794875, 0.9287986998277413, -0.35391316973502535]
[joint.j1]
type = "distance"
between = ["ground", "b0"]
at = [[-0.006112506909286355, 0.008905917449979216, 0.008106983497911375], [-0.02481615272028311, -0.00295728682749361, -0.0050377307212893015]]
[joint.j2]
type = "generic"
between = ["ground", "b0"]
at = [0.015624331473324453, 0.020403594801397487, 0.0029681058615208707]
axes = [[0.10990197216794875, 0.9287986998277413, -0.35391316973502535], [-0.041264356628367124, -0.3514994695929109, -0.9352782344029765]]
locks = ["x", "z", "ry", "rz"]
"#;
    assert_eq!(freedom(&model(text)), [0, 1]);
}

/// Two bodies at joints that hold directions to each other have the same freedom in micrometres and nanometres, where a direction is a sum of places
/// with factors of one over their distance.
#[test]
fn directions_are_held_in_any_unit_of_length() {
    let pairs = [
        ("universal", "axes = [[0, 1, 0], [0, 0, 1]]", 3),
        ("prismatic", "axis = [1, 0, 0]", 2),
        ("perpendicular", "axes = [[0, 1, 0], [0, 0, 1]]", 6),
        ("fixed", "", 1),
    ];
    for (kind, keys, dof) in pairs {
        for unit in [1e-9, 1.0, 3e6, 1e9, 1e12] {
            for reactions in [false, true] {
                let at = if kind == "perpendicular" { String::new() } else { format!("at = [{unit:e}, 0, 0]\n") };
                let inertia = 0.1 * unit * unit;
                let text = format!(
                    "[output]\nreactions = {reactions}\n\
                     [body.a]\nmass = 1\ninertia = [{inertia:e}, {inertia:e}, {inertia:e}]\nposition = [{:e}, 0, 0]\n\
                     [body.b]\nmass = 1\ninertia = [{inertia:e}, {inertia:e}, {inertia:e}]\nposition = [{:e}, {:e}, 0]\n\
                     [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 1, 0]\n\
                     [joint.pair]\ntype = \"{kind}\"\nbetween = [\"a\", \"b\"]\n{at}{keys}\n",
                    0.5 * unit,
                    1.5 * unit,
                    0.1 * unit
                );
                assert_eq!(freedom(&model(&text)), [dof, 0], "{kind}, {unit:e}, reactions {reactions}");
            }
        }
    }
}
