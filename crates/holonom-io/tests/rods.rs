//! Tensions of bars and of rods without mass, against statics and Newton's law.

mod common;

use common::{column, model};
use holonom::record::Recording;

fn run(text: &str, end: f64) -> Recording {
    common::run_every(&model(text), "conserving-ggl", 0.002, end, 1).1
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

/// A rod of two masses that slides and turns through a ring at the origin: all methods go where the equations of both masses on one line lead, at r and
/// r + 1 m along a direction that turns, as they were integrated elsewhere.
#[test]
fn a_rod_slides_through_a_ring() {
    let [a, line] = [
        "type = \"collinear\"\npoints = [\"ground\", \"a\", \"b\"]",
        "type = \"point-on-line\"\npoint = \"a\"\nline = [\"ground\", \"b\"]",
    ];
    // The direction of the line turns away from the axis along which it is long at first.
    let turned = |p: [f64; 3], k: usize| format!("[{}, {}, {}]", p[(3 - k) % 3], p[(4 - k) % 3], p[(5 - k) % 3]);
    for constraint in [a, line, "type = \"collinear\"\npoints = [\"b\", \"a\", \"ground\"]"] {
        for k in 0..3 {
            let text = format!(
                "gravity = {}\n[point.a]\nmass = 1\nposition = {}\nvelocity = {}\n[point.b]\nmass = 1\nposition = {}\nvelocity = {}\n\
                 [constraint.straight]\n{constraint}\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"a\", \"b\"]\n",
                turned([0.0, 0.0, -9.81], k),
                turned([1.0, 0.0, 0.0], k),
                turned([1.0, 0.5, 0.0], k),
                turned([2.0, 0.0, 0.0], k),
                turned([1.0, 1.0, 0.0], k)
            );
            let model = model(&text);
            assert_eq!(common::freedom(&model), [3, 0], "{constraint}");
            for method in ["conserving", "conserving-ggl", "conserving-projected", "radau"] {
                let (_, recording) = common::run_every(&model, method, 0.01, 1.0, 1);
                let found = ["a.x", "a.y", "a.z"].map(|name| common::last(&recording, name));
                let expected = [2.26849, 0.71269, -4.28867];
                for c in 0..3 {
                    assert!((found[(c + k) % 3] - expected[c]).abs() < 3e-5, "{constraint}, {method}: {found:?}");
                }
            }
        }
    }
}
