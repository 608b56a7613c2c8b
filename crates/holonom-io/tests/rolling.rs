//! Discs that roll, up to where they cannot.

mod common;

use common::model;
use holonom::simulation::{Simulation, Status, Verdict};

/// A disc that leans and is let go falls over the tangent where it touches, as an inverted pendulum, and lies flat after a time known by quadrature: no
/// step goes across to its other side, whatever its length, and the stop says why. With a little spin it turns round just above the plane instead.
#[test]
fn a_disc_that_lies_down_does_not_bounce() {
    let (radius, lean): (f64, f64) = (0.5, 20_f64.to_radians());
    let moment = (3.0 * radius * radius + 0.02 * 0.02) / 12.0 + radius * radius;
    // With φ² = lean − θ the integrand of ∫ dθ / θ̇ is smooth, also at the start.
    let (parts, last) = (1000, lean.sqrt());
    let duration = |phi: f64| 2.0 * phi / (2.0 * 9.81 * radius * (lean.sin() - (lean - phi * phi).sin()) / moment).sqrt();
    let falls: f64 = (0..parts).map(|k| duration((f64::from(k) + 0.5) * last / f64::from(parts)) * last / f64::from(parts)).sum();
    let disc = |spin: f64| {
        model(&format!(
            "gravity = [0, 0, -9.81]\n[body.disc]\nmass = 1\nshape = {{ cylinder = [{radius}, 0.02] }}\nposition = [0, 0, {}]\n\
             orientation = {{ axis = [1, 0, 0], angle = {lean} }}\nangular_velocity = [0, 0, {spin}]\naxes = {{ axle = [0, 0, 1] }}\n\
             [joint.contact]\ntype = \"rolling\"\nbetween = [\"ground\", \"disc\"]\nat = \"disc\"\naxis = \"disc.axle\"\n\
             normal = [0, 0, 1]\nradius = {radius}\n",
            radius * lean.sin()
        ))
    };
    let lying = disc(0.0);
    for of in ["conserving-ggl", "conserving", "conserving-projected", "generalized-alpha", "radau", "rk4"] {
        for step in [1e-3, 2e-3, 3e-3, 1e-2] {
            let mut simulation = common::simulation(&lying, of, step);
            let Status::Stopped { at, reason } = simulation.run(0.4, &mut |_: &Simulation| Verdict::GoOn) else {
                panic!("{of}, {step} s: it went on")
            };
            assert!(reason.contains("lies down flat on the plane"), "{of}, {step} s: {reason}");
            // Second-order methods err by the square of the longest step.
            assert!((at - falls).abs() <= 1e-4, "{of}, {step} s: {at} s for {falls}");
        }
    }
    let spinning = disc(0.3);
    for of in ["conserving-ggl", "conserving"] {
        common::run_every(&spinning, of, 2e-3, 0.6, 1);
    }
}
