//! The work of drives, as the audit books it.

mod common;

use common::{model, run};
use holonom::simulation::Choice;

/// The work of drives, of driven rows and of a driven point, by methods that find multipliers at the ends of steps or project: of the order of the
/// method, by the closed form of a bar that swings as it is told to.
#[test]
fn the_work_of_drives_is_of_order_two() {
    let joint = "plane = \"xy\"\ngravity = [0, -9.81]\n[body.a]\nmass = 2\ninertia = 0.1\nposition = [0.5, 0]\n[joint.r]\ntype = \"revolute\"\n\
                 between = [\"ground\", \"a\"]\nat = [0, 0]\n[drive.d]\ntype = \"angle\"\njoint = \"r\"\nprofile = \"sin(3*t)\"\n";
    // A pendulum whose pivot is shaken sideways, against its energy: what else does no work.
    let pivot = "plane = \"xy\"\ngravity = [0, -9.81]\n[point.pivot]\nmotion = [\"0.1*sin(5*t)\", \"0\"]\n[point.bob]\nmass = 2\nposition = [0, -1]\n\
                 velocity = [0.5, 0]\n[constraint.rod]\ntype = \"distance\"\nbetween = [\"pivot\", \"bob\"]\n";
    for method in ["trapezoidal-projected", "lagrange-3/rattle", "conserving-projected", "generalized-alpha"] {
        let off = |step: f64| {
            let (_, recording) = run(&model(joint), Choice::default().named(method), step, 2.0);
            let [times, work] = ["t", "work"].map(|name| recording.column(name).unwrap());
            let exact = |t: f64| 0.3 * ((3.0 * (3.0 * t).cos()).powi(2) - 9.0) + 9.81 * (3.0 * t).sin().sin();
            times.iter().zip(work).map(|(&t, work)| (work - exact(t)).abs()).fold(0.0, f64::max)
        };
        let [coarse, fine] = [off(0.01), off(0.005)];
        let order = (coarse / fine).log2();
        assert!(coarse < 3e-3 && order > 1.9, "{method}: {coarse:e} J off, order {order}");
        let left = |step: f64| {
            let (simulation, _) = run(&model(pivot), Choice::default().named(method), step, 2.0);
            simulation.audit().energy_summary().max_drift
        };
        let [coarse, fine] = [left(0.01), left(0.005)];
        assert!(coarse < 2e-2 && (coarse / fine).log2() > 1.8, "{method}: {coarse:e} J and {fine:e} J are no one's");
    }
}
