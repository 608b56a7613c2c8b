//! The crane by Lagrange's equations in the trolley's place, the angle of the rope and the angle of the drum, with the integral of
//! the controller as a state of its own, by the classical Runge–Kutta method of small steps.

use std::f64::consts::TAU;

use crate::{Run, assert_follows, solve};

const GRAVITY: f64 = 9.81;
const DRUM: f64 = 0.2;
const ROPE: f64 = 6.0;
const LOAD: f64 = 500.0;
const WIND: f64 = 300.0;

/// x, φ, θ, their rates, and the integral of the deviation.
type State = [f64; 7];

/// What the controllers want of 1, and its rate.
fn wanted(t: f64) -> [f64; 2] {
    let turn = TAU * t.min(8.0) / 8.0;
    [(turn - turn.sin()) / TAU, (1.0 - turn.cos()) / 8.0]
}

/// Force of the trolley's motor and torque of the drum's.
fn motors(t: f64, [x, _, drum, x_rate, _, drum_rate, integral]: State) -> [f64; 2] {
    let [way, rate] = wanted(t);
    let trolley = 1500.0 * (5.0 * way - x) + 300.0 * integral + 2500.0 * (5.0 * rate - x_rate);
    [trolley, 2e4 * (-10.0 * way - drum) + 3e3 * (-10.0 * rate - drum_rate) - LOAD * GRAVITY * DRUM]
}

/// What the load takes of the rope.
fn rope_force(t: f64, state: State) -> f64 {
    let [_, sway, drum, _, sway_rate, ..] = state;
    let [_, _, _, x_second, _, drum_second, _] = rates(t, state);
    let along = DRUM * drum_second + x_second * sway.sin() - (ROPE + DRUM * drum) * sway_rate * sway_rate;
    LOAD * (GRAVITY * sway.cos() - along) + WIND * sway.sin()
}

fn rates(t: f64, state: State) -> State {
    let [x, sway, drum, x_rate, sway_rate, drum_rate, _] = state;
    let (sin, cos) = sway.sin_cos();
    let (rope, rope_rate) = (ROPE + DRUM * drum, DRUM * drum_rate);
    let [trolley_motor, drum_motor] = motors(t, state);
    let mass = [
        [200.0 + 60.0 + 5.0 + LOAD, LOAD * rope * cos, LOAD * DRUM * sin],
        [LOAD * rope * cos, LOAD * rope * rope + 40.05, 0.0],
        [LOAD * DRUM * sin, 0.0, 0.5 * 60.0 * DRUM * DRUM + LOAD * DRUM * DRUM],
    ];
    let forces = [
        trolley_motor + WIND - LOAD * (2.0 * rope_rate * sway_rate * cos - rope * sway_rate * sway_rate * sin),
        WIND * rope * cos - LOAD * rope * (2.0 * rope_rate * sway_rate + GRAVITY * sin),
        drum_motor + WIND * DRUM * sin + LOAD * DRUM * (rope * sway_rate * sway_rate + GRAVITY * cos),
    ];
    let [x_second, sway_second, drum_second] = solve(mass, forces);
    [x_rate, sway_rate, drum_rate, x_second, sway_second, drum_second, 5.0 * wanted(t)[0] - x]
}

/// The states at every hundredth of a second.
fn motion(end: f64) -> Vec<State> {
    crate::runge_kutta(rates, [0.0; 7], 0.01, 100, end)
}

fn at(states: &[State], t: f64) -> State {
    states[(t / 0.01).round() as usize]
}

#[test]
fn the_load_of_the_crane_swings_as_lagrange_has_it() {
    let run = Run::of("crane", &[]);
    let states = motion(30.0);
    assert_follows(&run, "trolley.x", 1e-7, |t| at(&states, t)[0]);
    assert_follows(&run, "sway", 1e-7, |t| at(&states, t)[1].to_degrees());
    assert_follows(&run, "length", 1e-7, |t| ROPE + DRUM * at(&states, t)[2]);
    assert_follows(&run, "accumulated", 1e-7, |t| at(&states, t)[6]);
    assert_follows(&run, "trolley-motor.effort", 1e-6, |t| motors(t, at(&states, t))[0]);
    assert_follows(&run, "drum-motor.effort", 1e-6, |t| motors(t, at(&states, t))[1]);
    assert_follows(&run, "rope-force", 1e-6, |t| rope_force(t, at(&states, t)));
    // The integral part takes the wind: nothing else is left in the end.
    assert!((run.column("accumulated").last().unwrap() + WIND / 300.0).abs() < 1e-3);
}

/// The work of the motors and of the wind is all that changes the energy, and errors fall with the square of the step.
#[test]
fn the_balance_of_the_crane_closes_and_its_order_is_two() {
    let states = motion(10.0);
    let error = |step: &str| {
        let run = Run::of("crane", &[("simulation.method", "conserving-ggl"), ("simulation.end", "10"), ("simulation.step", step)]);
        let energy = &run.summary.energy;
        let share = energy.audit_residual.abs() / energy.work_total.abs();
        println!(
            "step {step} s: {share:.1e} of {} J is not accounted for, the method adds {:e} J",
            energy.work_total, energy.integrator_total
        );
        assert!(share < 1e-12 && energy.integrator_total.abs() < 1e-12 * energy.work_total.abs());
        let last = at(&states, 10.0);
        let expected = [("trolley.x", last[0]), ("sway", last[1].to_degrees()), ("accumulated", last[6])];
        expected.map(|(name, expected)| run.column(name).last().unwrap() - expected)
    };
    let errors = ["0.01", "0.005", "0.0025"].map(error);
    for pair in errors.windows(2) {
        for (coarse, fine) in pair[0].iter().zip(pair[1]) {
            let order = (coarse / fine).abs().log2();
            println!("error {fine:e}, order {order}");
            assert!((order - 2.0).abs() < 0.1, "order {order}: {errors:?}");
        }
    }
}

/// The chapter's integrator, of what jumps at an event: sin t, and from 1 s on three times as steep.
#[test]
fn a_mass_on_a_damper_integrates_what_jumps() {
    let text = r#"
gravity = [0, 0, 0]

[input.gain]
default = 1

[event.jump]
when = "t - 1.003"
set = { gain = 3 }

[point.integrator]
mass = 1
position = [0, 0, 0]

[force.integrand]
type = "expression"
point = "integrator"
force = ["gain*cos(t) - vx", 0, 0]

[measure.accumulated]
value = "integrator.x + integrator.vx"

[simulation]
end = 5
step = 0.01
method = "radau"
"#;
    let run = Run::of_text("integrator", text, &[]);
    assert_follows(&run, "accumulated", 1e-9, |t| if t < 1.003 { t.sin() } else { 3.0 * t.sin() - 2.0 * 1.003_f64.sin() });
}
