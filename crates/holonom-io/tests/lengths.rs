//! Springs, dampers and ropes of any length: what is so short that it has no direction is told by the size of the mechanism.

mod common;

use common::{model, run_every, source};

/// Lengths by a power of four round nothing differently: in such units every figure is the same to its last bit, also where a spring begins without a
/// length or goes through that. Lengths below 1e-9 counted as 1e-9 m in whatever unit, and no method took a step of this one in units of 1e10 m.
#[test]
fn springs_do_not_depend_on_the_unit_of_length() {
    let written = |m: f64| {
        let place = |x: f64, y: f64| format!("[{:e}, {:e}]", x * m, y * m);
        let mut text = String::from("plane = \"xy\"\ngravity = [0, 0]\n");
        for (name, at, v) in
            [("a", place(2.0, 0.0), place(0.0, 1.0)), ("b", place(0.0, 0.0), place(0.3, 0.1)), ("c", place(-1.0, 0.0), place(4.0, 0.0))]
        {
            text += &format!("[point.{name}]\nmass = 1\nposition = {at}\nvelocity = {v}\n");
        }
        text += &format!(
            "[force.linear]\ntype = \"spring\"\nbetween = [\"ground\", \"a\"]\nstiffness = 100\ndamping = 0.5\nrest_length = {m:e}\n"
        );
        text += &format!(
            "[force.soft]\ntype = \"spring\"\nbetween = [\"ground\", \"b\"]\nstiffness = 4\ndamping = 0.5\nrest_length = {:e}\n",
            0.1 * m
        );
        text += "[force.formula]\ntype = \"spring\"\nbetween = [\"a\", \"b\"]\nenergy = \"5*extension^2\"\nforce = \"0.2*rate + t*extension\"\n";
        text += "[force.following]\ntype = \"spring\"\nbetween = [\"b\", \"c\"]\nstiffness = \"20 + 5*sin(t)\"\ndamping = \"0.1*t\"\n";
        text += "[force.rope]\ntype = \"rope\"\nbetween = [\"ground\", \"c\"]\nthrough = [\"a\"]\nstiffness = 30\ndamping = 0.3\n";
        text +=
            &format!("[force.winch]\ntype = \"rope\"\nbetween = [\"a\", \"c\"]\nlength = \"{:e}*(1 + 0.1*t)\"\nstiffness = 30\n", 2.0 * m);
        model(&text)
    };
    let columns = |of: &str, m: f64| {
        let (_, recording) = run_every(&written(m), of, 0.01, 2.0, 1);
        let names = ["a", "b", "c"].into_iter().flat_map(|name| ["x", "y", "vx", "vy"].map(|what| format!("{name}.{what}")));
        let forces = ["linear", "soft", "formula", "following", "rope", "winch"].into_iter();
        let names = names.chain(forces.flat_map(|name| ["length", "length_rate", "force"].map(|what| format!("{name}.{what}"))));
        names.map(|name| (recording.column(&name).unwrap().iter().map(|value| value / m).collect(), name)).collect::<Vec<(Vec<f64>, _)>>()
    };
    for of in ["conserving-ggl", "conserving", "generalized-alpha", "radau"] {
        let here = columns(of, 1.0);
        for power in [-100, -34, 34, 100] {
            for ((there, _), (here, name)) in columns(of, 2_f64.powi(power)).iter().zip(&here) {
                let first = here.iter().zip(there).position(|(here, there)| here != there);
                assert_eq!(first, None, "{of}, in units of 2^{} m: the first row in which {name} is another", -power);
            }
        }
    }
}

/// What of a profile counts as rounding where it begins, at the coordinate 0 of its joint, is told by the size of the mechanism: a tenth of that is none.
#[test]
fn profiles_begin_at_zero_in_any_unit() {
    let driven = |m: f64, begins: f64| {
        let text = format!(
            "plane = \"xy\"\n[body.a]\nmass = 1\ninertia = {:e}\nposition = [{m:e}, 0]\n[body.b]\nmass = 1\ninertia = {:e}\nposition = [{:e}, 0]\n\
             [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"a\"]\naxis = [1, 0]\n\
             [joint.pin]\ntype = \"revolute\"\nbetween = [\"a\", \"b\"]\nat = [{m:e}, 0]\n\
             [drive.push]\ntype = \"displacement\"\njoint = \"rail\"\nprofile = \"{:e} + {m:e}*t\"\n",
            m * m,
            m * m,
            2.0 * m,
            begins * m
        );
        source(&text).model().map(|_| ())
    };
    for m in [1e-9, 1e-3, 1.0, 1e3, 1e9] {
        assert!(driven(m, 1e-4).is_ok(), "{m} m");
        let refused = driven(m, 0.1).expect_err("it begins elsewhere");
        assert!(refused.contains("at t = 0, and the joint is at 0"), "{refused}");
    }
}
