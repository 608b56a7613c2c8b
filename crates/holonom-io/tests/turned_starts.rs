//! Bodies that turn by more than half a turn on the way to the start.

mod common;

use common::{model, run};
use holonom::simulation::Choice;

/// A drum that a weight of 1 kg on a rope turns until a spring of 0.04 N·m/rad holds it: −m g r/k is four turns.
const ANGLE: f64 = -9.81 * 0.1 / 0.04;

/// Of the plane, or in space.
fn hoist(is_planar: bool) -> String {
    let text = "PLANE\n[body.drum]\nmass = 2\ninertia = DRUM\nposition = DRUM_AT\n[body.load]\nmass = 1\ninertia = LOAD\nposition = LOAD_AT\n\
         [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"drum\"]\nat = AXLE\n\
         [joint.guide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"load\"]\naxis = UP\n\
         [joint.rope]\ntype = \"rack-and-pinion\"\njoints = [\"axle\", \"guide\"]\nradius = 0.1\n\
         [force.spring]\ntype = \"torsion\"\njoint = \"axle\"\nstiffness = 0.04\n[start]\nequilibrium = true\n[simulation]\nend = 0\n";
    let (of_plane, in_space) = (0, 1);
    let of = [
        ("PLANE", ["plane = \"xz\"", ""]),
        ("DRUM_AT", ["[0, 0]", "[0, 0, 0]"]),
        ("LOAD_AT", ["[0.1, -1]", "[0.1, 0, -1]"]),
        ("DRUM", ["0.02", "[0.01, 0.02, 0.01]"]),
        ("LOAD", ["0.1", "[0.1, 0.1, 0.1]"]),
        ("AXLE", ["[0, 0]", "[0, 0, 0]\naxis = [0, -1, 0]"]),
        ("UP", ["[0, 1]", "[0, 0, 1]"]),
    ];
    of.iter().fold(text.to_string(), |text, (key, values)| text.replace(key, values[if is_planar { of_plane } else { in_space }]))
}

/// The note of a start at equilibrium tells whole turns.
#[test]
fn whole_turns_are_told() {
    for is_planar in [true, false] {
        let model = model(&hoist(is_planar));
        let notes = model.notes.join("\n");
        assert!(notes.contains("has moved `load` by 2.4525 m, `drum` by 24.525 rad"), "{notes}");
    }
}

/// The angle of a planar body goes on from the one that is written over the turns on the way to the start, in columns and measures as in what forces read.
#[test]
fn angles_of_bodies_count_the_turns_to_the_start() {
    for reactions in [false, true] {
        let reading = "[force.servo]\ntype = \"effort\"\njoint = \"axle\"\neffort = \"1e-3*(drum.angle - axle.angle)\"\n\
                       [measure.same]\nvalue = \"1e-3*(drum.angle - axle.angle)\"\n";
        let text = format!(
            "{}{reading}[output]\nreactions = {reactions}\n",
            hoist(true).replace("position = [0, 0]", "position = [0, 0]\norientation = { angle = 0.5 }")
        );
        let recording = run(&model(&text), Choice::default(), 0.01, 0.02).1;
        let turned = ANGLE + 5e-4 / 0.04;
        for (name, expected) in [("axle.angle", turned), ("drum.angle", turned + 0.5), ("servo.effort", 5e-4), ("same", 5e-4)] {
            let found = recording.column(name).unwrap();
            assert!(found.iter().all(|found| (found - expected).abs() < 1e-11), "{name} is {found:?} for {expected}");
        }
    }
}

/// Two arms that are folded by 170° each: the second is turned by 340°.
#[test]
fn angles_add_up_over_joints() {
    let text = "plane = \"xz\"\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\n[body.b]\nmass = 1\ninertia = 0.1\nposition = [1.5, 0]\n\
                [joint.shoulder]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0]\n\
                [joint.elbow]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [1, 0]\n\
                [start.shoulder]\nangle = \"170*deg\"\n[start.elbow]\nangle = \"170*deg\"\n";
    let recording = run(&model(text), Choice::default(), 0.01, 0.01).1;
    let angle = recording.column("b.angle").unwrap()[0];
    assert!((angle - 340.0_f64.to_radians()).abs() < 1e-12, "{angle}");
}
