//! A simulation that is put at another state goes on from there as a model would that starts there.

use holonom::simulation::{Choice, Method, Simulation, StartError, State, Status};
use holonom_io::Source;

const STEP: f64 = 1e-3;

/// A wheel and one that is geared to it, on hinges, with an eccentric mass.
fn wheels(angular_velocity: f64) -> Simulation {
    let text = format!(
        r#"
[body.wheel]
mass = 2
inertia = [0.05, 0.05, 0.1]
position = [0, 0, 0]
angular_velocity = [0, 0, {angular_velocity}]

[body.pinion]
mass = 0.5
inertia = [0.005, 0.005, 0.01]
position = [0.3, 0.05, 0]

[joint.axle]
type = "revolute"
between = ["ground", "wheel"]
at = [0, 0, 0]
axis = [0, 0, 1]

[joint.shaft]
type = "revolute"
between = ["ground", "pinion"]
at = [0.3, 0, 0]
axis = [0, 0, 1]

[joint.mesh]
type = "gear"
joints = ["axle", "shaft"]
ratio = -2
"#
    );
    simulation(&text)
}

fn simulation(text: &str) -> Simulation {
    let model = Source::read("wheels.toml", text.as_bytes()).and_then(|source| source.model()).unwrap_or_else(|faults| panic!("{faults}"));
    let method = Method::resolve(&Choice::default().named("conserving-ggl")).unwrap();
    Simulation::new(model.system.clone(), method, STEP).unwrap()
}

fn run(simulation: &mut Simulation, t: f64) {
    assert_eq!(simulation.step_to(t), Status::Completed);
}

fn angle(simulation: &Simulation) -> f64 {
    simulation.coordinate("axle.angle").unwrap()[0]
}

#[test]
fn reversed_velocities_lead_back() {
    let mut simulation = wheels(10.0);
    let start = simulation.state().clone();
    run(&mut simulation, 3.0);
    let turned = angle(&simulation);
    assert!(turned > 4.0 * std::f64::consts::TAU, "{turned} rad");
    let mut state = simulation.state().clone();
    state.v.iter_mut().for_each(|v| *v = -*v);
    simulation.set_state(&state).unwrap();
    // The turns are kept, and nothing is booked of what was before.
    assert!((angle(&simulation) - turned).abs() < 1e-12);
    assert_eq!((simulation.steps(), simulation.state().t), (0, 3.0));
    run(&mut simulation, 6.0);
    let off = simulation.state().x.iter().zip(&start.x).fold(0.0, |most: f64, (x, x0)| most.max((x - x0).abs()));
    assert!(off < 1e-9 && angle(&simulation).abs() < 1e-9, "{off} m, {} rad", angle(&simulation));
}

#[test]
fn a_state_of_another_start_is_taken_as_that_start() {
    let mut simulation = wheels(10.0);
    run(&mut simulation, 0.5);
    let mut other = wheels(3.0);
    simulation.set_state(other.state()).unwrap();
    run(&mut simulation, 0.2);
    run(&mut other, 0.2);
    let off = simulation.state().x.iter().zip(&other.state().x).fold(0.0, |most: f64, (x, y)| most.max((x - y).abs()));
    assert!(off < 1e-13, "{off} m");
}

#[test]
fn inputs_are_those_of_the_state() {
    let text = "[input.push]\ndefault = 1\n[point.cart]\nmass = 2\nposition = [0, 0, 0]\n[force.engine]\ntype = \"expression\"\npoint = \"cart\"\nforce = [\"push\", 0, 0]\n";
    let mut simulation = simulation(text);
    let start = simulation.state().clone();
    assert!(simulation.set_input("push", 4.0));
    run(&mut simulation, 0.1);
    let pushed = simulation.state().clone();
    for (state, push) in [(&start, 1.0), (&pushed, 4.0)] {
        simulation.set_state(state).unwrap();
        assert_eq!(simulation.input("push"), Some(push));
        let speed = simulation.state().v[0];
        run(&mut simulation, state.t + 0.1);
        assert!((simulation.state().v[0] - speed - 0.05 * push).abs() < 1e-12, "{push} N");
    }
}

#[test]
fn velocities_are_put_on_the_constraints() {
    let mut simulation = wheels(0.0);
    let mut state: State = simulation.state().clone();
    state.v.iter_mut().enumerate().for_each(|(k, v)| *v = (k as f64).sin());
    simulation.set_state(&state).unwrap();
    let [_, rate] = simulation.coordinate("axle.angle").unwrap();
    let [_, geared] = simulation.coordinate("shaft.angle").unwrap();
    assert!(rate.abs() > 1e-3 && (geared + 2.0 * rate).abs().min((rate + 2.0 * geared).abs()) < 1e-12 * rate.abs(), "{rate} {geared}");
}

#[test]
fn what_cannot_start_leaves_the_simulation_as_it_was() {
    let mut simulation = wheels(10.0);
    run(&mut simulation, 0.1);
    let before = simulation.checkpoint();
    let mut torn = simulation.state().clone();
    torn.x[0] += 1.0;
    assert!(matches!(simulation.set_state(&torn), Err(StartError::Position { .. })));
    let mut endless = simulation.state().clone();
    endless.t = f64::INFINITY;
    assert_eq!(simulation.set_state(&endless), Err(StartError::NoNumber));
    let pendulum = self::simulation("[point.A]\nmass = 1\nposition = [1, 0, 0]\n");
    assert_eq!(simulation.set_state(pendulum.state()), Err(StartError::Other));
    assert_eq!(simulation.checkpoint(), before);
}
