//! Velocities and energies at the start: those that were written, changed as little as the constraints ask for, whatever nodes
//! bodies share and in whatever order they stand.

mod common;

use std::f64::consts::PI;

use common::model;
use holonom::energy::momenta;
use holonom::model::Model;
use holonom::simulation::{Choice, Method, Simulation};
use nalgebra::Vector3;

fn start(model: &Model) -> Simulation {
    Simulation::new(model.system.clone(), Method::resolve(&Choice::default()).unwrap(), 1e-3).unwrap()
}

/// Angular velocity of a body.
fn spin(model: &Model, name: &str) -> Vector3<f64> {
    let (simulation, body) = (start(model), model.bodies.iter().find(|body| body.name == name).unwrap());
    body.recorded.velocity(&simulation.state().x, simulation.velocities(), model.dimension)[1]
}

fn with_reactions(text: &str) -> [String; 2] {
    [false, true].map(|reactions| format!("{text}\n[output]\nreactions = {reactions}\n"))
}

/// Pushed at its centre of mass a door takes the angular momentum about its hinge: ω = m v r/(J + m r²), also far from the origin.
#[test]
fn a_pushed_door_swings() {
    let expected = 100.0 * 0.5 / ((1.0 + 0.05 * 0.05) / 12.0 + 0.25);
    for away in [0.0, 1e3] {
        let text = format!(
            "[body.door]\nmass = 20\nshape = {{ box = [1, 0.05, 2] }}\nposition = [{}, 0, 1]\nvelocity = [0, 100, 0]\n\
             [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = [{away}, 0, 0]\naxis = [0, 0, 1]\n",
            away + 0.5
        );
        for text in with_reactions(&text) {
            let model = model(&text);
            let simulation = start(&model);
            let x = model.system.in_world(&simulation.state().x);
            let [_, spin] = model.bodies[0].recorded.velocity(&x, simulation.velocities(), model.dimension);
            assert!((spin - Vector3::new(0.0, 0.0, expected)).norm() < 1e-11 * expected, "{spin}");
            let changes = model.start_changes(&simulation.state().x, simulation.velocities());
            let [change] = &changes[..] else { panic!("{changes:?}") };
            assert_eq!(change.name, "door");
            assert!((change.velocity - (100.0 - 0.5 * expected)).abs() < 1e-9, "{change:?}");
            assert!((change.angular_velocity - expected).abs() < 1e-9, "{change:?}");
        }
    }
}

/// Two wheels on one axle, welded to each other: together they have the sum of their angular momenta.
#[test]
fn bodies_that_become_one_keep_their_momentum() {
    let wheel = |name: &str, mass: f64, spin: f64| {
        format!(
            "[body.{name}]\nmass = {mass}\ninertia = [{mass}, {mass}, {mass}]\nposition = [0, 0, 0]\nangular_velocity = [0, 0, {spin}]\n"
        )
    };
    let joints = "[joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"a\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                  [joint.weld]\ntype = \"fixed\"\nbetween = [\"a\", \"b\"]\nat = [0, 0, 0]\n";
    let wheels = [wheel("a", 1e-3, 7.0), wheel("b", 1e3, -0.4)];
    let expected = (1e-3 * 7.0 - 1e3 * 0.4) / (1e-3 + 1e3);
    for order in [[0, 1], [1, 0]] {
        for text in with_reactions(&format!("{}{}{joints}", wheels[order[0]], wheels[order[1]])) {
            let spin = spin(&model(&text), "a");
            assert!((spin - Vector3::new(0.0, 0.0, expected)).norm() < 1e-12, "{spin} and {expected}");
        }
    }
}

/// What hangs on the ground has its weight there, too.
#[test]
fn potential_energy_counts_from_the_origin_whatever_is_shared() {
    let text = "gravity = [0, 0, -9.81]\n[body.rod]\nmass = 1\ninertia = [0.1, 0.1, 0.01]\nposition = [0, 0, 0.5]\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"rod\"]\nat = [0, 0, 1]\naxis = [0, 1, 0]\n";
    for text in with_reactions(text) {
        let model = model(&text);
        let initial = start(&model).audit().energy_summary().initial;
        assert!((initial - 4.905).abs() < 1e-12, "{initial}");
    }
}

/// A rod whose directions across are held by the ground alone: they have no mass, and nothing that hangs on them has.
#[test]
fn directions_that_the_ground_holds_need_no_mass() {
    let text = "[body.ball]\nmass = 1\nposition = [-0.5, 0, 0]\nshape = { sphere = 0.1 }\n\
                [body.rod]\nmass = 1\nposition = [0.3, 0, 0]\nvelocity = [2, 1, 0]\nshape = { rod = 0.6 }\n\
                [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"rod\"]\nat = [-0.3, 0, 0]\naxis = [1, 0, 0]\n\
                [joint.slide]\ntype = \"prismatic\"\nbetween = [\"ground\", \"rod\"]\nat = [-0.2, 0, 0]\naxis = [1, 0, 0]\n";
    for text in with_reactions(text) {
        let model = model(&text);
        let (simulation, rod) = (start(&model), model.bodies.iter().find(|body| body.name == "rod").unwrap());
        let [velocity, spin] = rod.recorded.velocity(&simulation.state().x, simulation.velocities(), model.dimension);
        assert!(velocity.norm() < 1e-12 && spin.norm() < 1e-12, "{velocity} {spin}");
    }
}

/// A door with a bar of 3 kg to a point, all written with 1 m/s across: the bar is as fast as the door is written at its end, whatever the ground holds
/// of the door. The least change, of ½(ω/2 − 1)² + 0.05 ω² + 3/2 ((ω − 1)² + (v − 1)² + (ω − 1)(v − 1))/3, is at ω = 25/22.
#[test]
fn a_bar_is_as_fast_as_what_carries_it() {
    let plane = "plane = \"xy\"\n[body.door]\nmass = 1\ninertia = 0.1\nposition = [0.5, 0]\nvelocity = [0, 1]\npoints = { end = [0.5, 0] }\n\
                 [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = [0, 0]\n\
                 [point.tip]\nposition = [2, 0]\nvelocity = [0, 1]\n[bar.rod]\nbetween = [\"door.end\", \"tip\"]\nmass = 3\n";
    let space = "[body.door]\nmass = 1\ninertia = [0.1, 0.1, 0.1]\nposition = [0.5, 0, 0]\nvelocity = [0, 1, 0]\npoints = { end = [0.5, 0, 0] }\n\
                 [joint.hinge]\ntype = \"revolute\"\nbetween = [\"ground\", \"door\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n\
                 [point.tip]\nposition = [2, 0, 0]\nvelocity = [0, 1, 0]\n[bar.rod]\nbetween = [\"tip\", \"door.end\"]\nmass = 3\n";
    for text in [plane, space].into_iter().flat_map(with_reactions) {
        let spin = spin(&model(&text), "door");
        assert!((spin - Vector3::new(0.0, 0.0, 25.0 / 22.0)).norm() < 1e-12, "{spin}");
    }
}

/// Two free bodies with a hinge between them, and a bar between places of both that are made of its nodes: the start leaves the momenta written,
/// 0.25 kg·m/s of the bar across, and about the origin 0.1 kg·m²/s of the body that turns and 0.25 kg·m²/s of the bar.
#[test]
fn a_bar_between_two_bodies_that_share_a_node_keeps_momenta() {
    for joint in ["revolute", "fixed"] {
        let text = format!(
            "plane = \"xy\"\n[body.a]\nmass = 1\ninertia = 0.1\nposition = [0, 0]\npoints = {{ p = [0.5, 0] }}\nangular_velocity = 1\n\
             [body.b]\nmass = 1\ninertia = 0.1\nposition = [2, 0]\npoints = {{ p = [0, 0.5] }}\n\
             [joint.o]\ntype = \"{joint}\"\nbetween = [\"a\", \"b\"]\nat = [1, 0.7]\n[bar.r]\nbetween = [\"a.p\", \"b.p\"]\nmass = 1\n"
        );
        for text in with_reactions(&text) {
            let model = model(&text);
            let simulation = start(&model);
            let momenta =
                momenta(&model.system, &simulation.state().x, simulation.velocities(), &mut vec![0.0; model.system.coordinates()]);
            for (found, expected) in [(momenta[0], 0.0), (momenta[1], 0.25), (momenta[5], 0.35)] {
                assert!((found - expected).abs() < 1e-13, "{joint}: {momenta:?}");
            }
        }
    }
}

/// Wheels in mesh whose drives both begin at rest start, though one of the rates is no zero but round-off.
#[test]
fn rates_that_are_round_off_contradict_nothing() {
    let wheel = |name: &str, x: f64, share: f64| {
        let points = [(0.0, 0.0), (0.3, 0.3), (0.7, -0.3), (1.2, 0.6), (2.5, 0.0)].map(|(t, angle)| format!("[{t}, {}]", angle / share));
        format!(
            "[body.{name}]\nmass = 1\ninertia = 0.1\nposition = [{x}, 0]\n\
             [joint.j{name}]\ntype = \"revolute\"\nbetween = [\"ground\", \"{name}\"]\nat = [{x}, 0]\n\
             [drive.d{name}]\ntype = \"angle\"\njoint = \"j{name}\"\nprofile = {{ table = [{}], ends = \"rest\" }}\n",
            points.join(", ")
        )
    };
    for ratio in [2.0, 3.0, 7.0] {
        let mesh = format!("[joint.mesh]\ntype = \"gear\"\njoints = [\"ja\", \"jb\"]\nratio = {ratio}\n");
        let simulation = start(&model(&format!("plane = \"xy\"\n{}{}{mesh}", wheel("a", 0.0, 1.0), wheel("b", 1.0, ratio))));
        assert!(simulation.velocities().iter().all(|v| v.abs() < 1e-14), "{ratio}");
    }
}

/// A light ball on the ground that a heavy point drags by a rod: its own motion is not lost beside what moves the point.
#[test]
fn light_parts_start_as_exactly_as_heavy_ones() {
    let text = "[body.ball]\nmass = 1e-6\nposition = [-22, -13, -51]\nvelocity = [-11, -9, -3]\nangular_velocity = [-0.08, 0.11, 0.07]\n\
                shape = { sphere = 23 }\n\
                [joint.socket]\ntype = \"spherical\"\nbetween = [\"ground\", \"ball\"]\nat = [-23, 31, -33]\n\
                [point.load]\nmass = 3e5\nposition = [-82, -87, 16]\nvelocity = [-2, -9, 11]\n\
                [joint.rod]\ntype = \"distance\"\nbetween = [\"ball\", \"load\"]\nat = [[4, -55, -49], [-82, -87, 16]]\n";
    let [shared, apart] = with_reactions(text).map(|text| spin(&model(&text), "ball"));
    let off = (shared - apart).norm() / apart.norm();
    assert!(off < 1e-11, "{off:e}");
}

/// A velocity that is written for the second of two bodies that become one, on joints that let it move: what it becomes is compared with what
/// was written and not with the nodes, which were at rest.
#[test]
fn a_welded_body_moves_the_one_it_is_welded_to() {
    for (joint, axis) in [("point-on-line", "[1, 0.3]"), ("revolute", ""), ("prismatic", "[0.2, 0.7]"), ("prismatic", "[1, 1]")] {
        for (position, velocity) in [("[0.5, 0.3]", "[0.9, 0.4]"), ("[-0.7, 0.11]", "[0.1, -3]"), ("[1e3, 0.2]", "[1e-3, 2e-4]")] {
            let axis = if axis.is_empty() { String::new() } else { format!("axis = {axis}\n") };
            let text = format!(
                "plane = \"xy\"\n[body.slider]\nmass = 2\ninertia = 0.5\nposition = [0, 0]\n[body.cargo]\nmass = 1\ninertia = 0.2\n\
                 position = {position}\nvelocity = {velocity}\nangular_velocity = 0.5\n\
                 [joint.slot]\ntype = \"{joint}\"\nbetween = [\"ground\", \"slider\"]\nat = [0.1, 0.2]\n{axis}\
                 [joint.weld]\ntype = \"fixed\"\nbetween = [\"slider\", \"cargo\"]\n"
            );
            let kinetic = with_reactions(&text).map(|text| start(&model(&text)).audit().kinetic);
            // Beside what the spin alone has as it is written, 0.025 J.
            assert!(kinetic[0] > 0.0 && (kinetic[0] - kinetic[1]).abs() <= 1e-13 + 1e-12 * kinetic[1], "{joint}, {position}: {kinetic:?}");
        }
    }
}

/// Two bars that are hinged together and written with velocities that differ there, a bar of 2 kg on the second: it has the velocity of the body that
/// it hangs on, whatever the order, and whether they share the node. The energy is that of a dense least-squares solution.
#[test]
fn a_bar_begins_with_the_body_that_it_hangs_on() {
    let one = "[body.b1]\nmass = 1\ninertia = 0.2\nposition = [1, 0]\nvelocity = [0.5, 1]\nangular_velocity = 3\n";
    let two = "[body.b2]\nmass = 2\ninertia = 0.3\nposition = [1.5, 0.2]\nvelocity = [-0.5, 0.3]\nangular_velocity = -1\n";
    let rest =
        "[joint.j]\ntype = \"revolute\"\nbetween = [\"b1\", \"b2\"]\nat = [1.2, 0.1]\n[bar.rod]\nbetween = [[0, 0.5], \"b2\"]\nmass = 2\n";
    for bodies in [format!("{one}{two}"), format!("{two}{one}")] {
        for text in with_reactions(&format!("plane = \"xy\"\ngravity = [0, 0]\n{bodies}{rest}")) {
            let energy = start(&model(&text)).audit().energy();
            assert!((energy - 1.3441961496).abs() < 1e-9, "{energy} J\n{text}");
        }
    }
}

/// A motion of a point is no velocity that is written, and a start may move what else there is.
#[test]
fn a_point_that_is_driven_may_stand_beside_a_start() {
    let text = "plane = \"xz\"\n[point.hand]\nmotion = [\"1 + 0.1*sin(t)\", 0]\n\
                [body.crank]\nmass = 1\nshape = { rod = 0.2 }\nposition = [0.1, 0]\npoints = { tip = [0.1, 0] }\n\
                [joint.main]\ntype = \"revolute\"\nbetween = [\"ground\", \"crank\"]\nat = [0, 0]\n\
                [force.s]\ntype = \"spring\"\nbetween = [\"hand\", \"crank.tip\"]\nstiffness = 10\n[start.main]\nangle = \"30*deg\"\n";
    let simulation = start(&model(text));
    let [crank] = &model(text).bodies[..] else { panic!("there is one body") };
    let [centre, _] = crank.recorded.velocity(&simulation.state().x, simulation.velocities(), 2);
    assert!(centre.norm() < 1e-15 && (simulation.gauges().value[0] - PI / 6.0).abs() < 1e-12, "{centre}, {:?}", simulation.gauges().value);
}

/// What begins to move at t = 0 has its speed there, and what stops has none, whichever argument of `min` and `max` is written first.
#[test]
fn motions_with_a_corner_at_the_start_begin_with_the_speed_behind_it() {
    for (profile, speed) in [("max(0, t)", 1.0), ("max(t, 0)", 1.0), ("min(t, 0)", 0.0), ("min(0, t)", 0.0), ("abs(-t)", 1.0)] {
        let slider = "plane = \"xy\"\n[point.a]\nmass = 1\nposition = [0, 0]\n";
        let axis = "[constraint.rail]\ntype = \"expression\"\nvalue = \"a.y\"\n";
        let lead = format!("[constraint.lead]\ntype = \"expression\"\nvalue = \"a.x - {profile}\"\n");
        let found = start(&model(&format!("{slider}{axis}{lead}"))).velocities()[0];
        assert!((found - speed).abs() < 1e-12, "{profile}: {found} m/s");
    }
}
