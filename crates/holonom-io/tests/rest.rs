//! What rests in equilibrium stays there: no method and no accuracy takes the rounding of positions for a motion.

mod common;

use common::model;
use holonom::simulation::Choice;

/// Runs that complete, with and without an accuracy, and nothing moves by more than that, or than a hundred-millionth, of a length (m) in a second.
fn rests(text: &str, length: f64, methods: &[(&str, Option<f64>)]) {
    let model = model(text);
    for &(method, accuracy) in methods {
        let choice = Choice { accuracy, ..Choice::default().named(method) };
        let (simulation, _) = common::run(&model, choice, 0.01, 1.0);
        let speed = simulation.velocities().iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        assert!(speed <= accuracy.unwrap_or(1e-8) * length, "{method}, {accuracy:?}: {speed:e} m/s\n{text}");
    }
}

/// A body that two joints leave no freedom, without any force: the energy of its rounding is none, also after the short steps that an accuracy begins
/// with.
#[test]
fn what_cannot_move_has_no_energy() {
    let text = "gravity = [0, 0, 0]\n[body]\nb = { mass = 1, inertia = [1, 1, 1], position = [1, 0, 0] }\n[joint]\n\
                j = { type = \"revolute\", between = [\"ground\", \"b\"], at = [-0.11912513292173245, -0.9906664939018196, 0.1425836191358525], \
                axis = [-0.8920438425700704, 0.2185116988617582, 0.39561397901663137] }\n\
                l = { type = \"point-on-plane\", between = [\"ground\", \"b\"], at = [-0.10785494805125673, -0.20849366900556415, 1.1065574593002796], \
                axis = [-0.30574370193259787, 0.7610732466741968, 0.5720911657466385] }\n";
    rests(text, 1.0, &[("conserving", Some(1e-5)), ("conserving", Some(1e-3)), ("conserving", None), ("conserving-ggl", Some(1e-5))]);
}

/// A body in the neutral place of a bushing: explicit steps that grow until their errors show let it tremble by less than the accuracy, which is no
/// energy from nothing.
#[test]
fn explicit_steps_may_grow_where_nothing_moves() {
    let text = "gravity = [0, 0, 0]\n[body]\nb = { mass = 1, inertia = [1, 1, 1], position = [1, 0, 0] }\n[force]\n\
                f = { type = \"bushing\", between = [\"ground\", \"b\"], at = [0.19077122526730517, -0.16751317944703986, -0.7073712481659125], \
                stiffness = [1e3, 1e3, 1e3, 1e3, 1e3, 1e3], damping = [1, 1, 1, 1, 1, 1] }\n";
    rests(text, 100.0, &[("ode/dop853", Some(1e-7)), ("lagrange-1/dopri5/velocity", Some(1e-5))]);
}

/// Strong friction, and a damper that all but sticks, on what does not move: steps that need not be halved are not, as velocities of shorter ones are
/// rounded by more.
#[test]
fn strong_dampers_turn_no_rounding_round() {
    let chain = "[body]\nb = { mass = 1, inertia = [1, 1, 1], position = [1, 0, 0] }\nc = { mass = 1, inertia = [1, 1, 1], position = [1, 0, 0] }\n\
                 d = { mass = 1, inertia = [1, 1, 1], position = [1, 0, 0] }\n[joint]\n\
                 j = { type = \"point-on-line\", between = [\"ground\", \"b\"], at = [-0.09273593170288105, 0.9183611861848823, 0.09738112364369148], \
                 axis = [-0.5877069449431843, 0.18339747891581928, 0.7880139031723175] }\n\
                 k = { type = \"planar\", between = [\"b\", \"c\"], at = [0.4316579958830796, 1.865675289765599, -0.4957725866875503], \
                 axis = [0.45723563287762475, -0.8707355778114848, 0.18098378258920744] }\n\
                 l = { type = \"prismatic\", between = [\"b\", \"d\"], at = [0.012369209844883544, 1.5245872850884739, -1.9927327686745668], \
                 axis = [0.8070955129130092, -0.5794086082984523, 0.11350109103148466] }\n\
                 [force]\nf = { type = \"friction\", joint = \"j\", effort = 10.0, speed = 0.001 }\n";
    let hinge = "[body]\nb = { mass = 1, inertia = [1, 1, 1], position = [1.4290764519808543, -0.34783040193980225, -0.3723788842002344], \
                 points = { p = [-0.5027681651014796, -0.1543923735325366, -0.2751139282260286] } }\n[joint]\n\
                 j = { type = \"revolute\", between = [\"ground\", \"b\"], at = [0.7967621724752822, 0.06385830720183323, -0.3998851424325327], \
                 axis = [-0.1900207797057123, -0.017185887062515226, 0.9816296392050861] }\n\
                 l = { type = \"point-on-plane\", between = [\"ground\", \"b\"], at = [1.7465699720238232, -0.4272126401242248, -0.8456195461008078], \
                 axis = [0.43589247124008834, 0.015040458180637657, -0.8998730677900774] }\n[force]\n\
                 f = { type = \"spring\", between = [\"b.p\", [2.368766543027211, 0.06281504933038745, 0.5854414625935976]], rest_length = 1.0, \
                 force = \"20*tanh(rate/0.001)\" }\n";
    for text in [chain, hinge] {
        rests(&format!("gravity = [0, 0, 0]\n{text}"), 1e-2, &[("generalized-alpha", None), ("conserving-ggl", None), ("radau", None)]);
    }
}
