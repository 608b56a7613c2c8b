//! What formulas read of how bodies turn, in steps in which these turn far.

mod common;

use common::{CONSERVING, last, model, run_every};

/// A rotor at 300 rad/s, on its axle in space and in the plane: steps of 1 ms turn it by 0.3 rad.
const ROTOR: &str = "gravity = [0, 0, 0]\n[body.rotor]\nmass = 1\ninertia = [0.02, 0.02, 0.01]\nposition = [0, 0, 0]\nangular_velocity = [0, 0, 300]\n\
                     [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"rotor\"]\nat = [0, 0, 0]\naxis = [0, 0, 1]\n";
const PLANAR: &str = "plane = \"xy\"\n[body.rotor]\nmass = 1\ninertia = 0.01\nposition = [0, 0]\nangular_velocity = 300\n\
                      [joint.axle]\ntype = \"revolute\"\nbetween = [\"ground\", \"rotor\"]\nat = [0, 0]\n";

/// A motor that falls off with the speed turns the rotor against a brake: both balance at 300 rad/s.
#[test]
fn torques_that_follow_the_speed_hold_it() {
    let torques = |[motor, brake]: [&str; 2]| {
        format!(
            "[force.motor]\ntype = \"torque\"\nbody = \"rotor\"\ntorque = {motor}\n[force.brake]\ntype = \"torque\"\nbody = \"rotor\"\ntorque = {brake}\n"
        )
    };
    let cases = [
        (ROTOR, "rotor.wz", torques(["[0, 0, \"0.3*(310 - wz)\"]", "[0, 0, -3]"])),
        (PLANAR, "rotor.angle_rate", torques(["\"0.3*(310 - w)\"", "-3"])),
    ];
    for (rotor, speed, torques) in cases {
        for method in CONSERVING {
            let (simulation, recording) = run_every(&model(&[rotor, &torques].concat()), method, 1e-3, 0.5, 1);
            let speeds = recording.column(speed).unwrap();
            assert!(speeds.iter().all(|speed| (speed - 300.0).abs() < 1e-7), "{method}: {speed} ends at {}", last(&recording, speed));
            let unsure = simulation.unsure_work().map_or(0.0, |(unsure, _, _)| unsure);
            assert!(unsure < 1e-9, "{method}: {unsure} J");
        }
    }
}

/// A force that follows the angular velocity of a body that turns freely is as large as that.
#[test]
fn forces_read_how_fast_bodies_turn() {
    let slider = "[body.slider]\nmass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 3]\n\
                  [joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"slider\"]\naxis = [1, 0, 0]\n\
                  [force.servo]\ntype = \"effort\"\njoint = \"rail\"\neffort = \"0.01*rotor.wz\"\n";
    for method in CONSERVING {
        let recording = run_every(&model(&[ROTOR, slider].concat()), method, 1e-3, 0.5, 1).1;
        let speed = last(&recording, "slider.vx");
        assert!((speed - 1.5).abs() < 1e-9, "{method}: {speed}");
    }
}
