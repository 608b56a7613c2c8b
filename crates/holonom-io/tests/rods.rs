//! Tensions of bars and of rods without mass, against statics and Newton's law.

mod common;

use common::model;
use holonom::record::Recording;

fn run(text: &str, end: f64) -> Recording {
    common::run_every(&model(text), "conserving-ggl", 0.002, end, 1).1
}

fn column<'a>(recording: &'a Recording, name: &str) -> &'a [f64] {
    recording.column(name).unwrap_or_else(|| panic!("there is no column {name}"))
}

/// What a rod of any length pulls its bob with is what gravity leaves of the bob's acceleration, also where the length is driven.
#[test]
fn rods_pull_what_they_hold() {
    for length in ["1", "1 + 0.2*sin(3*t)"] {
        let text = format!(
            "plane = \"xz\"\n[point.bob]\nmass = 2\nposition = [0.6, -0.8]\nvelocity = [0.8, 0.6]\n\
             [constraint.rod]\ntype = \"distance\"\nbetween = [\"ground\", \"bob\"]\nlength = \"{length}\"\n"
        );
        let recording = run(&text, 1.0);
        let [tension, x, z, ax, az] = ["rod.force", "bob.x", "bob.z", "bob.ax", "bob.az"].map(|name| column(&recording, name));
        for k in 0..recording.rows() {
            let pull = -2.0 * (ax[k] * x[k] + (az[k] + 9.81) * z[k]) / x[k].hypot(z[k]);
            assert!((tension[k] - pull).abs() <= 1e-11 * (1.0 + pull.abs()), "{length}: {} N, and {pull} N by hand", tension[k]);
        }
        assert!(tension[recording.rows() - 1].abs() > 1.0);
    }
}

/// A bar that hangs with a weight bears this and, at the mean over its length, half of itself; a prop is pushed, with less than zero.
#[test]
fn bars_bear_half_of_themselves() {
    let text = "plane = \"xz\"\n[point.weight]\nmass = 1\nposition = [0, -2]\n[bar.link]\nbetween = [[0, 0], \"weight\"]\nmass = 3\n\
                [point.top]\nmass = 4\nposition = [1, 1]\n[constraint.prop]\ntype = \"distance\"\nbetween = [[1, 0], \"top\"]\n";
    let recording = run(text, 0.01);
    for (name, expected) in [("link.force", 9.81 * 2.5), ("prop.force", -9.81 * 4.0)] {
        let found = column(&recording, name)[0];
        assert!((found - expected).abs() < 1e-11, "{name}: {found} N, and {expected} N by hand");
    }
}

/// A triangle of rods on a pin and a roller, with a weight of 100 N at its top, 3 m above the middle of its base of 8 m: sides −50/0.6, base 50 · 4/3.
#[test]
fn members_of_a_truss_have_the_forces_of_statics() {
    let text = "plane = \"xz\"\ngravity = [0, -10]\n[point.roller]\nmass = 1\nposition = [8, 0]\n[point.top]\nmass = 10\nposition = [4, 3]\n\
                [constraint.left]\ntype = \"distance\"\nbetween = [\"ground\", \"top\"]\n\
                [constraint.right]\ntype = \"distance\"\nbetween = [\"top\", \"roller\"]\n\
                [constraint.base]\ntype = \"distance\"\nbetween = [\"ground\", \"roller\"]\n\
                [constraint.floor]\ntype = \"point-on-line\"\npoint = \"roller\"\nthrough = [0, 0]\ndirection = [1, 0]\n";
    let recording = run(text, 0.01);
    for (name, expected) in [("left.force", -250.0 / 3.0), ("right.force", -250.0 / 3.0), ("base.force", 200.0 / 3.0)] {
        let found = column(&recording, name)[0];
        assert!((found - expected).abs() < 1e-10, "{name}: {found} N, and {expected} N by hand");
    }
}
