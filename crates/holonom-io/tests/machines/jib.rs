//! The jib crane by the moments about its hinge.

use crate::{Run, assert_follows};

#[test]
fn hinge_and_tie_of_the_jib() {
    for reach in [0.5, 2.0, 4.0] {
        let run = Run::of("jib", &[("parameters.reach", &reach.to_string()), ("output.reactions", "true")]);
        assert_eq!(run.column("t"), [0.0]);
        // The tie rises by 3 m over 4 m, and pulls at the tip.
        let weight = 80.0 * 9.81;
        let tie = (2.0 * weight + reach * 5000.0) / (4.0 * 0.6);
        let [across, up] = [0.8 * tie, weight + 5000.0 - 0.6 * tie];
        let is = |name: &str, value: f64| assert_follows(&run, name, 1e-14, |_| value);
        is("tie.force", tie);
        is("hinge.fx", across);
        is("hinge.fz", up);
        is("hinge.f", across.hypot(up));
        is("load.f", 5000.0);
    }
}
