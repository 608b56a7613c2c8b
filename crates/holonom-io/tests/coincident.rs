//! Joints that hold the same as others, but for the last digits that are written: they lock nothing.

mod common;

use common::{freedom, model};

/// A pendulum that is pinned twice swings as one that is pinned once, wherever it hangs and however far apart the pins are as written.
#[test]
fn a_pendulum_that_is_pinned_twice_swings() {
    let pinned = |places: &[f64]| {
        let mut text = String::from("plane = \"xz\"\n[body.a]\nmass = 1\ninertia = 0.1\n");
        text += &format!("position = [{}, 0]\n", places[0] + 0.5);
        for (k, place) in places.iter().enumerate() {
            text += &format!("[joint.p{k}]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [{place}, 0]\n");
        }
        let model = model(&text);
        let [dof, _] = freedom(&model);
        let (_, recording) = common::run_every(&model, "conserving-ggl", 0.01, 1.0, 1);
        (dof, common::last(&recording, "p0.angle"))
    };
    for place in [0.0, 0.3, -700.0] {
        let (_, once) = pinned(&[place]);
        for apart in [1e-15, 3e-15, 1e-14, 1e-12, 1e-9, 1e-8] {
            let (dof, angle) = pinned(&[place, place + apart]);
            assert_eq!(dof, 1, "{place} m, {apart} m apart");
            assert!((angle - once).abs() <= 1e-9 + 10.0 * apart, "{place} m, {apart} m apart: {angle} and {once} rad");
        }
    }
}

/// A door on four hinges whose places are written with a few digits has one freedom.
#[test]
fn doors_open_however_they_are_written() {
    let axis = nalgebra::Vector3::new(0.3, -0.2, 0.93).normalize();
    for digits in [8, 12, 13, 14, 15, 16] {
        let written = |v: nalgebra::Vector3<f64>| format!("[{:.d$}, {:.d$}, {:.d$}]", v.x, v.y, v.z, d = digits);
        let foot = nalgebra::Vector3::new(0.1, 0.7, -0.4);
        let mut text = format!(
            "[body.door]\nmass = 20\ninertia = [3, 2.5, 1.5]\nposition = {}\n",
            written(foot + nalgebra::Vector3::new(0.4, 0.2, 0.5))
        );
        for k in 0..4 {
            text += &format!(
                "[joint.h{k}]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = {}\naxis = {}\n",
                written(foot + axis * (0.37 * f64::from(k))),
                written(axis)
            );
        }
        let model = model(&text);
        assert_eq!(freedom(&model)[0], 1, "{digits} digits");
        let (_, recording) = common::run_every(&model, "conserving-ggl", 0.01, 1.0, 1);
        assert!(common::last(&recording, "h0.angle").abs() > 0.1, "{digits} digits: it opens");
    }
}

/// A generic joint with one free axis is a hinge, also a quarter turn from where it starts: it holds the body with the same force there.
#[test]
fn a_generic_joint_holds_at_a_quarter_turn() {
    for (locks, axis, free) in [("rx\", \"rz", "[0, 1, 0]", "y"), ("ry\", \"rz", "[1, 0, 0]", "x"), ("rx\", \"ry", "[0, 0, 1]", "z")] {
        let driven = |kind: &str| {
            let text = format!(
                "gravity = [1, 2, -9.81]\n[body.a]\nmass = 1\ninertia = [0.1, 0.12, 0.15]\nposition = [0.5, 0.3, 0.2]\n\
                 [joint.h]\ntype = {kind}\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\n\
                 [drive.m]\ntype = \"angle\"\njoint = \"h\"\nprofile = \"pi/2*min(t, 1)^2*(3 - 2*min(t, 1))\"\n[output]\nreactions = true\n"
            );
            let model = model(&text);
            assert_eq!(freedom(&model)[0], 0, "{text}");
            common::run_every(&model, "conserving-ggl", 0.01, 2.0, 1).1
        };
        let generic = driven(&format!("\"generic\"\nlocks = [\"x\", \"y\", \"z\", \"{locks}\"]"));
        let hinge = driven(&format!("\"revolute\"\naxis = {axis}"));
        for name in ["a.x", "a.y", "a.z", "h.fx", "h.fy", "h.fz", "h.tx", "h.ty", "h.tz", "m.effort"] {
            let of = |recording: &holonom::record::Recording| common::last(recording, name);
            assert!((of(&generic) - of(&hinge)).abs() <= 1e-9, "free {free}, {name}: {} and {} of a hinge", of(&generic), of(&hinge));
        }
    }
}

/// Where a mechanism of points alone begins at the world's origin nothing tells how large it is, and a joint there holds all the same.
#[test]
fn points_at_the_origin_are_held() {
    for (joint, axis, free) in [("point-on-plane", "axis = [0, 0, 1]", 2), ("point-on-line", "axis = [1, 1, 0]", 1)] {
        let text = format!(
            "[point.bead]\nmass = 1\nposition = [0, 0, 0]\nvelocity = [1, 1, 0]\n\
             [joint.wire]\ntype = \"{joint}\"\nbetween = [\"ground\", \"bead\"]\nat = [0, 0, 0]\n{axis}\n"
        );
        let model = model(&text);
        assert_eq!(freedom(&model)[0], free, "{joint}");
        let (_, recording) = common::run_every(&model, "conserving-ggl", 0.1, 1.0, 1);
        assert!(common::last(&recording, "bead.z").abs() < 1e-12 && (common::last(&recording, "bead.y") - 1.0).abs() < 1e-12, "{joint}");
    }
}

/// A spring of no length whose end is led away from rest begins where it has no direction: x = t² − (1 − cos ωt) 2/ω².
#[test]
fn a_spring_of_no_length_begins_to_pull() {
    let text = "gravity = [0, 0, 0]\n[point.hand]\nmotion = [\"t^2\", 0, 0]\n[point.bob]\nmass = 2\nposition = [0, 0, 0]\n\
                [force.spring]\ntype = \"spring\"\nbetween = [\"hand\", \"bob\"]\nstiffness = 10\nrest_length = 0\n";
    let (model, square) = (model(text), 5.0_f64);
    let expected = 0.25 - 2.0 / square * (1.0 - (0.5 * square.sqrt()).cos());
    for method in ["conserving-ggl", "conserving", "radau"] {
        for step in [0.01, 1e-3] {
            let (_, recording) = common::run_every(&model, method, step, 0.5, 1);
            let found = common::last(&recording, "bob.x");
            assert!((found - expected).abs() < step * step, "{method}, {step} s: {found} and not {expected} m");
        }
    }
}

/// A vector of any length is a direction, also where its square is no number.
#[test]
fn directions_have_any_length() {
    for length in [1e160, 1e300, 1e-160, 1e-200] {
        let text = format!(
            "[point.bead]\nmass = 1\nposition = [1, 0, 0]\n\
             [constraint.table]\ntype = \"point-on-plane\"\npoint = \"bead\"\nthrough = [0, 0, 0]\nnormal = [0, 0, {length:e}]\n"
        );
        let (_, recording) = common::run_every(&model(&text), "conserving-ggl", 0.1, 1.0, 1);
        assert!(common::last(&recording, "bead.z").abs() < 1e-12, "{length:e}: {} m", common::last(&recording, "bead.z"));
    }
}

/// A hinge so far away that its body has no digits left beside it is refused in words, also where a direction of the body's size is 1e-201 of the way there.
#[test]
fn a_hinge_beyond_all_digits_is_refused() {
    for far in [1e20, 1e200, 1e300] {
        let text = format!(
            "[body]\na = {{ mass = 0.4, inertia = [2e-3, 1.2e-3, 1.5e-3], position = [0, 0, 0] }}\n\
             b = {{ mass = 0.3, inertia = [9e-4, 5e-4, 6e-4], position = [0, 0, 0], orientation = {{ axis = [1, 0, 0], angle = -1 }} }}\n\
             c = {{ mass = 1, shape = {{ cylinder = [0.05, 0.02] }}, position = [0, 0, 0], orientation = {{ axis = [1, 0, 0], angle = -1 }} }}\n\
             [joint]\nfar = {{ type = \"revolute\", between = [\"ground\", \"a\"], at = [{far:e}, 0, 0], axis = [0, 0, 1] }}\n\
             near = {{ type = \"revolute\", between = [\"a\", \"b\"], at = [0, 0, 0], axis = [-1, 0, 0] }}\n\
             spin = {{ type = \"revolute\", between = [\"b\", \"c\"], at = [0, 0, 0], axis = [0, 0.8414709848, 0.5403023059] }}\n"
        );
        let said = common::source(&text).model_with_forces().map(|_| ()).expect_err("no digit of the body is left");
        assert!(said.contains("rounding decides which places are the same"), "{far:e}: {said}");
    }
}
