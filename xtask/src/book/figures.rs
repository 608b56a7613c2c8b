//! The figures of the chapter: what each claims, what it draws, and what is measured to check the claim.

use super::figure::{Figure, below, curve, linear, log, pendulum, seeded, within};
use super::measure::{
    energy_distance, error, errors, growth, iterations, later_over_earlier, over_time, range_of_stretch, slope, softer, vibrations,
};
use super::results::{Series, largest};

/// All figures, as the chapter has them.
pub const FIGURES: &[Figure] = &[
    Figure {
        name: "blow-up",
        claim: "trapezoidal rule and midpoint rule blow up on index 3, and projections cure it",
        title: "Index 3: violation of the velocity constraints",
        x: linear("time (s)", 0.0, 8.0),
        y: log("‖dΦ/dt‖ (m²/s)", 1e-18, 1e9),
        curves: &[
            curve("pendulum", "augmented-lagrangian-3/midpoint", "midpoint"),
            pendulum("trapezoidal"),
            pendulum("conserving"),
            pendulum("trapezoidal-projected"),
            pendulum("conserving-ggl"),
        ],
        points: |results, curve| over_time(results, curve, |run| run.column("phi_dot").to_vec()),
        measurements: &[
            within(
                "`trapezoidal`: ‖Φ̇‖ passes 1e-2 m²/s at, s",
                |results| {
                    let run = results.pendulum("trapezoidal");
                    run.first(run.column("phi_dot"), |violation| violation > 1e-2)
                },
                3.4,
                4.0,
            ),
            within("`trapezoidal`: energy is 1 J off at, s", |results| results.pendulum("trapezoidal").leaves(), 4.5, 5.5),
            within(
                "`augmented-lagrangian-3/midpoint`: energy is 1 J off at, s",
                |results| results.pendulum("augmented-lagrangian-3/midpoint").leaves(),
                1.0,
                1.5,
            ),
            seeded(below(
                "`trapezoidal` with the paper's loop (§4) and α = 1e7 stops at, s",
                |results| results.of_run("paper-loop", "trapezoidal").end(),
                7.0,
            )),
            below("`trapezoidal-projected`: largest ‖Φ̇‖", |results| results.pendulum("trapezoidal-projected").largest("phi_dot"), 1e-10),
            within("`conserving`: largest ‖Φ̇‖", |results| results.pendulum("conserving").largest("phi_dot"), 2e-3, 4e-3),
        ],
    },
    Figure {
        name: "drift",
        claim: "Φ drifts with the square of time on index 1, linearly on index 2 or with projected velocities, and not with Baumgarte",
        title: "Index 2 and 1: violation of the position constraints",
        x: log("time (s)", 0.1, 8.0),
        y: log("‖Φ‖ (m²)", 1e-9, 1e-2),
        curves: &[
            pendulum("lagrange-2/trapezoidal"),
            pendulum("lagrange-1/rk4"),
            pendulum("lagrange-2/radau-3"),
            pendulum("baumgarte/rk4"),
            curve("pendulum", "lagrange-1/rk4/velocity+acceleration", "lagrange-1/rk4 projected"),
        ],
        points: |results, curve| over_time(results, curve, |run| run.column("phi").to_vec()),
        measurements: &[
            within("`lagrange-1/rk4`: ‖Φ‖ at 8 s over ‖Φ‖ at 4 s", |results| growth(results, "lagrange-1/rk4", 4.0), 3.4, 4.6),
            within("`lagrange-2/radau-3`: ‖Φ‖ at 20 s over ‖Φ‖ at 10 s", |results| growth(results, "lagrange-2/radau-3", 10.0), 1.7, 2.3),
            within(
                "`lagrange-1/rk4/velocity+acceleration`: ‖Φ‖ at 20 s over ‖Φ‖ at 10 s",
                |results| growth(results, "lagrange-1/rk4/velocity+acceleration", 10.0),
                1.6,
                2.4,
            ),
            within(
                "`baumgarte/rk4`: largest ‖Φ‖ after 10 s over largest before",
                |results| later_over_earlier(results, "baumgarte/rk4"),
                0.5,
                1.5,
            ),
            within(
                "`baumgarte/trapezoidal`: largest ‖Φ‖ after 10 s over largest before",
                |results| later_over_earlier(results, "baumgarte/trapezoidal"),
                0.5,
                1.5,
            ),
            within(
                "`lagrange-2/trapezoidal`: largest ‖Φ‖ after 10 s over largest before",
                |results| later_over_earlier(results, "lagrange-2/trapezoidal"),
                0.5,
                1.5,
            ),
            within(
                "`baumgarte/trapezoidal`: energy after 20 s, J",
                |results| results.pendulum("baumgarte/trapezoidal").energy_gained(),
                -0.7,
                -0.4,
            ),
        ],
    },
    Figure {
        name: "redundant",
        claim: "on index 1 and 0 a drift makes redundant rows independent, and the motion is lost whatever the order",
        title: "Index 1 and 0 with a redundant row: distance of the energy from its start",
        x: linear("time (s)", 0.0, 20.0),
        y: log("|E − E₀| (J)", 1e-14, 1e2),
        curves: &[
            pendulum("ode/rk4"),
            pendulum("ode/dopri5"),
            pendulum("ode/dop853"),
            pendulum("baumgarte/rk4"),
            curve("pendulum", "lagrange-1/rk4/velocity+acceleration", "lagrange-1/rk4 projected"),
        ],
        points: |results, curve| over_time(results, curve, energy_distance),
        measurements: &[
            below(
                "`ode/dop853`: energy off within the first 4 s by, J",
                |results| {
                    let run = results.pendulum("ode/dop853");
                    largest(&run.between(0.0, 4.0, &energy_distance(run)))
                },
                1e-9,
            ),
            seeded(within(
                "`ode/dop853`: energy off within 20 s by, J",
                |results| results.pendulum("ode/dop853").energy_drift(),
                1.0,
                f64::INFINITY,
            )),
            seeded(within(
                "`ode/dopri5`: energy off within 20 s by, J",
                |results| results.pendulum("ode/dopri5").energy_drift(),
                1.0,
                f64::INFINITY,
            )),
            seeded(within(
                "`ode/rk4`: energy off within 20 s by, J",
                |results| results.pendulum("ode/rk4").energy_drift(),
                1.0,
                f64::INFINITY,
            )),
            below(
                "`lagrange-1/rk4/velocity+acceleration`: energy off within 20 s by, J",
                |results| results.pendulum("lagrange-1/rk4/velocity+acceleration").energy_drift(),
                1e-3,
            ),
            below("`baumgarte/rk4`: energy off within 20 s by, J", |results| results.pendulum("baumgarte/rk4").energy_drift(), 1e-2),
            below(
                "double pendulum, no redundant row, `ode/dop853`: energy off within 20 s by, J",
                |results| results.of_run("double-pendulum", "ode/dop853").energy_drift(),
                1e-3,
            ),
        ],
    },
    Figure {
        name: "damping",
        claim: "Radau and BDF of order 1 and 2 take energy out of a mechanism that has no damper, less the higher the order",
        title: "Damping by the integrator: distance of the energy from its start",
        x: linear("time (s)", 0.0, 20.0),
        y: log("|E − E₀| (J)", 1e-15, 1e3),
        curves: &[
            curve("pendulum", "ggl/bdf-1", "ggl/bdf-1 = ggl/radau-1"),
            pendulum("ggl/bdf-2"),
            pendulum("ggl/radau-3"),
            pendulum("ggl/radau-5"),
            pendulum("conserving-ggl"),
        ],
        points: |results, curve| over_time(results, curve, energy_distance),
        measurements: &[
            within("`ggl/bdf-1`: energy after 20 s, J", |results| results.pendulum("ggl/bdf-1").energy_gained(), -30.0, -20.0),
            below(
                "`ggl/bdf-1` and `ggl/radau-1` differ in energy after 20 s by, J",
                |results| (results.pendulum("ggl/bdf-1").energy_gained() - results.pendulum("ggl/radau-1").energy_gained()).abs(),
                1e-10,
            ),
            within("`ggl/bdf-2`: energy after 20 s, J", |results| results.pendulum("ggl/bdf-2").energy_gained(), -1.0, -0.6),
            within("`ggl/radau-3`: energy after 20 s, J", |results| results.pendulum("ggl/radau-3").energy_gained(), -0.06, -0.04),
            within("`ggl/radau-5`: energy after 20 s, J", |results| results.pendulum("ggl/radau-5").energy_gained(), -2e-5, -5e-6),
            below(
                "`ggl/radau-1`, `-3`, `-5`: largest rise of energy in a step, J",
                |results| largest(&["ggl/radau-1", "ggl/radau-3", "ggl/radau-5"].map(|method| results.pendulum(method).energy_rise())),
                1e-10,
            ),
            below("`conserving-ggl`: energy off within 20 s by, J", |results| results.pendulum("conserving-ggl").energy_drift(), 1e-10),
            within("`ggl/bdf-3`: energy after 20 s, J (it gains)", |results| results.pendulum("ggl/bdf-3").energy_gained(), 0.5, 1.5),
        ],
    },
    Figure {
        name: "energy",
        claim: "the conserving family keeps energy to round-off at any order, and with projected velocities it only loses",
        title: "Energy minus energy at the start",
        x: linear("time (s)", 0.0, 20.0),
        y: linear("E − E₀ (J)", -0.11, 0.02),
        curves: &[
            pendulum("conserving-ggl"),
            pendulum("conserving-projected"),
            pendulum("lagrange-3/rattle"),
            pendulum("ggl/radau-3"),
            pendulum("trapezoidal-projected"),
        ],
        points: |results, curve| over_time(results, curve, Series::energy_change),
        measurements: &[
            below(
                "`conserving`, `conserving-ggl`, `ggl/conserving-ggl-4`, `-6`: energy off by, J",
                |results| {
                    let family = ["conserving", "conserving-ggl", "ggl/conserving-ggl-4", "ggl/conserving-ggl-6"];
                    largest(&family.map(|method| results.pendulum(method).energy_drift()))
                },
                1e-10,
            ),
            below(
                "`penalty/conserving`, with the rows' energy ½αΦ²: energy off by, J",
                |results| results.pendulum("penalty/conserving").energy_drift(),
                1e-10,
            ),
            below(
                "`conserving-projected`: largest rise in a step, J",
                |results| results.pendulum("conserving-projected").energy_rise(),
                1e-12,
            ),
            within(
                "`conserving-projected`: energy after 20 s, J",
                |results| results.pendulum("conserving-projected").energy_gained(),
                -0.0145,
                -0.0139,
            ),
            within(
                "`lagrange-3/rattle`: energy off within 2 s, step 0.02 s over step 0.01 s",
                |results| {
                    let [coarse, fine] = ["0.02", "0.01"].map(|step| results.of_step("accuracy", "lagrange-3/rattle", step).energy_drift());
                    coarse / fine
                },
                3.4,
                4.6,
            ),
            within(
                "`trapezoidal-projected`: largest rise in a step, J",
                |results| results.pendulum("trapezoidal-projected").energy_rise(),
                2e-3,
                8e-3,
            ),
            within(
                "`trapezoidal-projected`: energy off within 20 s by, J",
                |results| results.pendulum("trapezoidal-projected").energy_drift(),
                0.09,
                0.1,
            ),
        ],
    },
    Figure {
        name: "order",
        claim: "a method of order p gains p digits where the step shrinks by ten, so that high order pays for accuracy",
        title: "Error of the position of m2 at 2 s",
        x: log("step (s)", 0.01, 0.2),
        y: log("error (m)", 1e-12, 1.0),
        curves: &[
            curve("accuracy", "lagrange-3/rattle", "lagrange-3/rattle"),
            curve("accuracy", "conserving-ggl", "conserving-ggl"),
            curve("accuracy", "ggl/conserving-ggl-4", "ggl/conserving-ggl-4"),
            curve("accuracy", "ggl/radau-5", "ggl/radau-5"),
            curve("accuracy", "ggl/conserving-ggl-6", "ggl/conserving-ggl-6"),
            curve("accuracy", "ode/dop853", "ode/dop853"),
        ],
        points: |results, curve| errors(results, curve.method),
        measurements: &[
            within("slope of `lagrange-3/rattle`", |results| slope(results, "lagrange-3/rattle"), 1.75, 2.25),
            within("slope of `conserving-ggl`", |results| slope(results, "conserving-ggl"), 1.75, 2.25),
            within("slope of `ggl/conserving-ggl-4`", |results| slope(results, "ggl/conserving-ggl-4"), 3.75, 4.25),
            within("slope of `ggl/radau-5`", |results| slope(results, "ggl/radau-5"), 4.75, 5.25),
            within("slope of `ggl/conserving-ggl-6`", |results| slope(results, "ggl/conserving-ggl-6"), 5.75, 6.25),
            within("slope of `ode/dop853`", |results| slope(results, "ode/dop853"), 7.75, 8.25),
            within("error of `conserving-ggl` at 0.025 s, m", |results| error(results, "conserving-ggl", "0.025"), 3e-3, 5e-3),
            within(
                "iterations of `ggl/conserving-ggl-6` at 0.1 s over those of `conserving-ggl` at 0.01 s",
                |results| iterations(results, "ggl/conserving-ggl-6", "0.1") / iterations(results, "conserving-ggl", "0.01"),
                0.3,
                2.0,
            ),
            within(
                "error of `conserving-ggl` at 0.01 s over that of `ggl/conserving-ggl-6` at 0.1 s",
                |results| error(results, "conserving-ggl", "0.01") / error(results, "ggl/conserving-ggl-6", "0.1"),
                100.0,
                f64::INFINITY,
            ),
        ],
    },
    Figure {
        name: "penalty",
        claim: "the violation of penalty falls as 1/α, with an integrator that survives the stiff springs",
        title: "Penalty: violation of the position constraints",
        x: linear("time (s)", 0.0, 20.0),
        y: log("‖Φ‖ (m²)", 1e-7, 1e-2),
        curves: &[
            curve("penalty-1e5", "penalty/conserving", "α = 1e5"),
            curve("penalty-1e6", "penalty/conserving", "α = 1e6"),
            curve("pendulum", "penalty/conserving", "α = 1e7"),
        ],
        points: |results, curve| over_time(results, curve, |run| run.column("phi").to_vec()),
        measurements: &[
            within("largest ‖Φ‖ at α = 1e5 over that at 1e6", |results| softer(results, "penalty-1e5", "penalty-1e6"), 9.5, 10.5),
            within("largest ‖Φ‖ at α = 1e6 over that at 1e7", |results| softer(results, "penalty-1e6", "pendulum"), 9.5, 10.5),
            seeded(within(
                "`penalty/trapezoidal` at α = 1e7: energy off within 20 s by, J",
                |results| results.pendulum("penalty/trapezoidal").energy_drift(),
                1.0,
                f64::INFINITY,
            )),
        ],
    },
    Figure {
        name: "stiff",
        claim: "at a step that does not resolve a vibration, damping methods remove it, and the low-order ones slow the swing with it",
        title: "Stiff spring, 2.5 steps a vibration: energy (0.5 J of it in the vibration)",
        x: linear("time (s)", 0.0, 10.0),
        y: linear("energy (J)", -1.2, 1.4),
        curves: &[
            curve("spring-rho-1", "generalized-alpha", "generalized-alpha, ρ∞ = 1"),
            curve("spring", "conserving-ggl", "conserving-ggl"),
            curve("spring", "generalized-alpha", "generalized-alpha, ρ∞ = 0.8"),
            curve("spring", "ggl/radau-5", "ggl/radau-5"),
            curve("spring", "ggl/bdf-2", "ggl/bdf-2"),
            curve("spring-rho-0", "generalized-alpha", "generalized-alpha, ρ∞ = 0"),
        ],
        points: |results, curve| over_time(results, curve, |run| run.column("energy").to_vec()),
        measurements: &[
            below("`conserving-ggl`: energy off by, J", |results| results.of_run("spring", "conserving-ggl").energy_drift(), 1e-10),
            within(
                "`conserving-ggl`: range of the stretch in the last 2 s, m",
                |results| range_of_stretch(results, "spring", "conserving-ggl"),
                0.018,
                0.026,
            ),
            within(
                "`conserving-ggl`: vibrations in 10 s (there are 159)",
                |results| vibrations(results, "spring", "conserving-ggl"),
                105.0,
                125.0,
            ),
            seeded(within(
                "`generalized-alpha`, ρ∞ = 1: energy off by, J",
                |results| results.of_run("spring-rho-1", "generalized-alpha").energy_drift(),
                0.1,
                f64::INFINITY,
            )),
            within(
                "`generalized-alpha`, ρ∞ = 0.8: range of the stretch in the last 2 s, m",
                |results| range_of_stretch(results, "spring", "generalized-alpha"),
                2.5e-3,
                5e-3,
            ),
            within(
                "`ggl/radau-5`: range of the stretch in the last 2 s, m",
                |results| range_of_stretch(results, "spring", "ggl/radau-5"),
                2.5e-3,
                3.5e-3,
            ),
            within("`ggl/radau-5`: energy at 10 s, J", |results| results.of_run("spring", "ggl/radau-5").last("energy"), -5e-3, 0.0),
            within(
                "`generalized-alpha`, ρ∞ = 0: energy after the first step, J",
                |results| results.of_run("spring-rho-0", "generalized-alpha").at(0.025, "energy"),
                0.15,
                0.3,
            ),
            within("`ggl/bdf-2`: energy at 10 s, J", |results| results.of_run("spring", "ggl/bdf-2").last("energy"), -0.8, -0.5),
            within(
                "`generalized-alpha`, ρ∞ = 0: energy at 10 s, J",
                |results| results.of_run("spring-rho-0", "generalized-alpha").last("energy"),
                -1.4,
                -0.9,
            ),
        ],
    },
];
