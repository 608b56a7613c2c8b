//! Kinds that another crate adds: a joint, a force law, a load by a closure and a custom constraint, in a file and by hand.

use std::sync::Arc;

use holonom::model::joints::{Joint, Layout, Pair, Revolute, Seat, Sides};
use holonom::model::{
    Assembly, Body, Description, Element, Entry, Keys, Kind, Kinds, List, Model, Number, Place, Point, Read, Shape, Site, Solid, from_to,
};
use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom::system::{ConstraintFunction, Differences, Differentiated, Law, Place as Node, Reach, Response, SystemBuilder};
use holonom_io::Source;

/// a hinge that is a spherical joint whose axes stay parallel
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(name = "hinge", equations = "d = 0, u_B·v_A = 0, u_B·w_A = 0", example = "")]
struct Hinge {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    between: List<String>,
    /// where it sits at the start
    #[key(unit = "m")]
    at: Site,
    /// its direction at the start
    #[key(unit = "any", default = "needed", shape = Shape::Direction)]
    axis: Option<Site>,
}

impl Joint for Hinge {
    const LAYOUT: Layout =
        Layout { freedom: [Some(1), Some(1)], at: Seat::Given, directions: [1, 0], shares: [&[], &[]], takes_point: false };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        pair.coincide();
        pair.align();
        pair.angle();
        Ok(())
    }
}

/// a rubber band: V = ½ k (π − π₀)² where half the square of the length is above π₀
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(name = "band", equations = "V = ½ k max(½ r² − π₀, 0)²", example = "")]
struct Band {
    /// the two points
    #[key(shape = Shape::Ends(2, 2))]
    between: List<Place>,
    /// k
    #[key(unit = "N/m³")]
    stiffness: Number,
    /// π₀
    #[key(unit = "m²", default = "0")]
    slack: Option<Number>,
}

impl Element for Band {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let [a, b] = assembly.moving_pair(entry, "between", &self.between)?;
        let stiffness = self.stiffness.positive(entry, "stiffness")?;
        let slack = entry.optional("slack", &self.slack, Number::not_negative)?.unwrap_or(0.0);
        let half_square = assembly.builder.square(&from_to(&a, &b));
        assembly.builder.law(entry.name, &[half_square], Arc::new(Stretch { stiffness, slack }));
        Ok(())
    }
}

struct Stretch {
    stiffness: f64,
    slack: f64,
}

impl Law for Stretch {
    fn energy(&self, value: &[f64]) -> f64 {
        0.5 * self.stiffness * (value[0] - self.slack).max(0.0).powi(2)
    }

    fn conservative(&self) -> bool {
        true
    }

    fn at(&self, value: &[f64], _rate: &[f64], _t: f64, out: &mut Response) {
        out.force[0] = self.stiffness * (value[0] - self.slack).max(0.0);
        out.by_value[0][0] = if value[0] > self.slack { self.stiffness } else { 0.0 };
    }

    fn between(&self, reach: Reach<'_>, out: &mut Response) {
        let [from, to] = [reach.from[0], reach.to[0]].map(|value| (value - self.slack).max(0.0));
        let change = reach.to[0] - reach.from[0];
        if change == 0.0 {
            return self.at(reach.from, &[0.0], reach.middle, out);
        }
        out.force[0] = 0.5 * self.stiffness * (to + from) * (to - from) / change;
        out.by_value[0][0] = (self.stiffness * to - out.force[0]) / change;
    }
}

/// wind: a force on a point in proportion to the square of its speed
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(name = "wind", equations = "Q = −c |v| v", example = "")]
struct Wind {
    /// the point it acts on
    point: String,
    /// c
    #[key(unit = "kg/m")]
    drag: Number,
}

impl Element for Wind {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (point, drag) = (assembly.point(entry, "point", &self.point)?, self.drag.not_negative(entry, "drag")?);
        let Some(Node::Node(node)) = point.place() else {
            return Err(entry.refuse("point", "the wind blows on points of their own", "name a [point.NAME]"));
        };
        let blow = move |_x: &[f64], v: &[f64], _t: f64, force: &mut [f64]| {
            let speed = v.iter().map(|v| v * v).sum::<f64>().sqrt();
            force.iter_mut().zip(v).for_each(|(force, v)| *force = -drag * speed * v);
        };
        assembly.builder.load(entry.name, &[node], Arc::new(Differences(blow)));
        Ok(())
    }
}

/// a point on a dome z = height − x² − y²
#[derive(Clone, Debug, PartialEq, Keys)]
#[kind(name = "dome", equations = "z − h + x² + y² = 0", example = "")]
struct Dome {
    /// the point
    point: String,
    /// h
    #[key(unit = "m")]
    height: Number,
}

impl Element for Dome {
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        let (point, height) = (assembly.point(entry, "point", &self.point)?, self.height.number(entry, "height")?);
        if let Some(Node::Node(node)) = point.place() {
            assembly.builder.custom_rows(entry.name, &[node], Arc::new(Differentiated(OnDome { height })));
        }
        Ok(())
    }
}

struct OnDome {
    height: f64,
}

impl ConstraintFunction for OnDome {
    fn rows(&self) -> usize {
        1
    }

    fn evaluate<N: holonom::system::Number>(&self, x: &[N], _t: N, phi: &mut [N]) {
        phi[0] = x[2] - self.height + x[0] * x[0] + x[1] * x[1];
    }
}

fn kinds() -> Kinds {
    let mut kinds = Kinds::default();
    kinds.joints.push(Kind::of::<Hinge>());
    kinds.forces.extend([Kind::of::<Band>(), Kind::of::<Wind>()]);
    kinds.constraints.push(Kind::of::<Dome>());
    kinds
}

const FILE: &str = r#"
[body.door]
mass = 20
shape = { box = [1, 0.05, 2] }
position = [0.5, 0, 1]
velocity = [0, 0.5, 0]
angular_velocity = [0, 0, 1]
[point.ball]
mass = 1
position = [0.5, 0, 2.75]
velocity = [0, 1, 0]
[joint.hinge]
type = "hinge"
between = ["ground", "door"]
at = [0, 0, 1]
axis = [0, 0, 1]
[force.band]
type = "band"
between = ["ground", "ball"]
stiffness = 0.1
slack = 3
[force.wind]
type = "wind"
point = "ball"
drag = 0.2
[constraint.dome]
type = "dome"
point = "ball"
height = 3
"#;

fn by_hand() -> Description {
    let mut model = Description::default();
    model.point("ball", Point::new().mass(1).position([0.5, 0.0, 2.75]).velocity([0, 1, 0]));
    let door =
        Body::new([0.5, 0.0, 1.0]).mass(20).shape(Solid::cuboid([1.0, 0.05, 2.0])).velocity([0.0, 0.5, 0.0]).angular_velocity([0, 0, 1]);
    model.body("door", door);
    model.joint("hinge", Hinge::new(["ground", "door"], [0.0, 0.0, 1.0]).axis([0.0, 0.0, 1.0]));
    model.force("band", Band::new(["ground", "ball"], 0.1).slack(3));
    model.force("wind", Wind::new("ball", 0.2));
    model.constraint("dome", Dome::new("ball", 3));
    model
}

fn end(model: &Model, method: &str) -> Simulation {
    let method = Method::resolve(&Choice::default().named(method)).unwrap();
    let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap();
    assert_eq!(simulation.step_to(1.0), Status::Completed);
    simulation
}

#[test]
fn kinds_of_another_crate_are_read_and_run() {
    let file = Source::read("own.toml", FILE.as_bytes()).unwrap().knowing(kinds());
    let (of_file, of_hand) = (file.model().unwrap(), by_hand().compile().unwrap());
    assert_eq!(file.description().unwrap(), by_hand());
    for method in ["conserving-ggl", "conserving", "radau"] {
        let (one, other) = (end(&of_file, method), end(&of_hand, method));
        assert_eq!(one.state().x, other.state().x, "{method}");
        let [angle, rate] = one.coordinate("hinge.angle").unwrap();
        // Schemes of order 2 lag by (ωh)²/12.
        assert!((angle - 1.0).abs() < 1e-5 && (rate - 1.0).abs() < 1e-9, "nothing stops the door: {angle} {rate}");
        let [x, y, z] = [0, 1, 2].map(|c| one.state().x[c]);
        assert!((z - 3.0 + x * x + y * y).abs() < 1e-12, "{method}: the ball stays on the dome");
        assert!(one.audit().energy_summary().max_drift < 1e-9 || method == "radau", "{method}: what the wind takes is booked");
    }
}

/// The same hinge by the kind of this program, whose nodes are shared.
#[test]
fn a_joint_of_one_s_own_is_that_of_the_program() {
    let mut theirs = by_hand();
    *theirs.joints.get_mut("hinge").unwrap() = Revolute::new(["ground", "door"], [0.0, 0.0, 1.0]).axis([0.0, 0.0, 1.0]).into();
    let (own, theirs) = (by_hand().compile().unwrap(), theirs.compile().unwrap());
    assert!(own.system.constraints() > theirs.system.constraints(), "ours shares no nodes");
    let [own, theirs] = [&own, &theirs].map(|model| end(model, "conserving-ggl").coordinate("hinge.angle").unwrap());
    assert!((own[0] - theirs[0]).abs() < 1e-10, "{own:?} {theirs:?}");
}

#[test]
fn what_is_wrong_with_kinds_of_one_s_own_has_a_place_and_a_cure() {
    let wrong = FILE.replace("stiffness = 0.1", "stifness = 0.1").replace("height = 3", "height = \"high\"");
    let message = Source::read("own.toml", wrong.as_bytes()).unwrap().knowing(kinds()).model().err().unwrap();
    for words in ["a force of type \"band\" has no key `stifness`", "did you mean `stiffness`?", "own.toml:29:11 (constraint.dome.height)"]
    {
        assert!(message.contains(words), "{words} is missing in\n{message}");
    }
    let unknown = Source::read("own.toml", FILE.as_bytes()).unwrap().model().err().unwrap();
    assert!(unknown.contains("there is no force of type \"wind\""), "{unknown}");
}

#[test]
fn a_constraint_as_a_formula_is_that_of_a_kind_of_one_s_own() {
    let written = FILE
        .replace("type = \"dome\"\npoint = \"ball\"\nheight = 3", "type = \"expression\"\nvalue = \"ball.z - 3 + ball.x^2 + ball.y^2\"");
    let read = |text: &str| Source::read("own.toml", text.as_bytes()).unwrap().knowing(kinds()).model().unwrap();
    for method in ["conserving-ggl", "generalized-alpha", "radau"] {
        let (own, formula) = (end(&read(FILE), method), end(&read(&written), method));
        assert_eq!(own.state().x, formula.state().x, "{method}");
    }
}

/// A pendulum on a block, far from the origin, whose rod is a formula.
#[test]
fn a_rod_as_a_formula_is_a_rod() {
    let head = "plane = \"xz\"\n[point.bob]\nmass = 1\nposition = [1000.8, -0.6]\n[body.block]\nmass = 3\ninertia = 0.2\nposition = [1000, 0]\n\
        points = { eye = [0.1, 0] }\n[joint.rail]\ntype = \"prismatic\"\nbetween = [\"ground\", \"block\"]\nat = [1000, 0]\naxis = [1, 0]\n[constraint.rod]\n";
    let length = "sqrt((bob.x - block.eye.x)^2 + (bob.z - block.eye.z)^2)";
    let rod = format!("{head}type = \"distance\"\nbetween = [\"block.eye\", \"bob\"]\nlength = \"{} + 0.1*sin(t)\"\n", 0.85_f64.sqrt());
    let formula = format!("{head}type = \"expression\"\nvalue = \"{length} - {} - 0.1*sin(t)\"\n", 0.85_f64.sqrt());
    let read = |text: &str| Source::read("own.toml", text.as_bytes()).unwrap().model().unwrap();
    for method in ["radau", "conserving-ggl"] {
        let (rod, formula) = (read(&rod), read(&formula));
        let (one, other) = (end(&rod, method), end(&formula, method));
        let places = (rod.system.in_world(&one.state().x), formula.system.in_world(&other.state().x));
        let apart = places.0.iter().zip(places.1.iter()).fold(0.0_f64, |most, (one, other)| most.max((one - other).abs()));
        // The conserving scheme has another mean gradient of a length than of its square: both of order 2.
        assert!(apart < if method == "radau" { 1e-10 } else { 1e-4 }, "{method}: {apart}");
        assert!(other.audit().energy_summary().max_drift < 1e-9 || method == "radau", "{method}");
    }
}

/// So far from the origin steps are small beside positions, whose last digits are 1e-12 m there.
#[test]
fn a_wavy_surface_far_away_keeps_energy_too() {
    let text = "gravity = [0, 0, -9.81]\n[point.bead]\nmass = 2\nposition = [10000.5, 0.2, \"0.4*sin(0.5) + 0.1*0.2^3\"]\n\
        velocity = [0.8, -0.5, 0]\n[constraint.surface]\ntype = \"expression\"\n\
        value = \"bead.z - 0.4*sin(bead.x - 10000) - 0.1*bead.y^3\"\n";
    let model = Source::read("own.toml", text.as_bytes()).unwrap().model().unwrap();
    let simulation = end(&model, "conserving-ggl");
    assert!(simulation.audit().energy_summary().max_drift < 1e-9, "{}", simulation.audit().energy_summary().max_drift);
    assert!(simulation.audit().work_summary(100).iterations_per_step < 5.0);
}

/// Energy is kept, and the work of what moves is booked to the joule, where no row is quadratic; the motion is of order 2.
#[test]
fn a_wavy_surface_keeps_energy_at_both_levels() {
    let head = "gravity = [0, 0, -9.81]\n[point.bead]\nmass = 2\nposition = [0.5, 0.2, \"0.4*sin(0.5) + 0.1*0.2^3\"]\nvelocity = [0.8, -0.5, 0]\n\
        [constraint.surface]\ntype = \"expression\"\n";
    for moving in ["", " - 0.2*sin(3*t)", " - 0.1*t*bead.x"] {
        let text = format!("{head}value = \"bead.z - 0.4*sin(bead.x) - 0.1*bead.y^3{moving}\"\n");
        let model = Source::read("own.toml", text.as_bytes()).unwrap().model().unwrap();
        let at = |method: &str, step: f64| {
            let method = Method::resolve(&Choice::default().named(method)).unwrap();
            let mut simulation = Simulation::new(model.system.clone(), method, step).unwrap();
            assert_eq!(simulation.step_to(1.0), Status::Completed, "{moving}");
            simulation
        };
        let truth = at("radau", 0.002).state().x.clone();
        let error = |step: f64| {
            let simulation = at("conserving-ggl", step);
            let drift = simulation.audit().energy_summary().max_drift;
            assert!(drift < 1e-12, "{moving}: {drift} J");
            simulation.state().x.iter().zip(&truth).fold(0.0_f64, |most, (x, truth)| most.max((x - truth).abs()))
        };
        // Over four halvings: the paper's β leaps where the row is straight along the way, so that single ones are irregular.
        let order = (error(0.04) / error(0.0025)).log2() / 4.0;
        assert!((1.9..2.2).contains(&order), "{moving}: {order}");
    }
}

/// A formula that follows the time and does not push along an axis, or not as a whole, leaves that momentum alone.
#[test]
fn linear_momentum_is_kept_beside_a_formula() {
    let parts = "[body.b]\nmass = 2\ninertia = [0.1, 0.2, 0.15]\nposition = [1, 0.2, 0.1]\nvelocity = [0.1, 2, 1]\n\
        angular_velocity = [1, 2, 3]\n[point.p]\nmass = 1\nposition = [2, 0, 0]\nvelocity = [0, -1, 1]\n";
    let moved = "[constraint.c]\ntype = \"expression\"\nvalue = \"b.x - 1 - 0.03*sin(29*t)\"\n";
    let apart = "[constraint.c]\ntype = \"expression\"\n\
        value = \"sqrt((b.x-p.x)^2 + (b.y-p.y)^2 + (b.z-p.z)^2) - sqrt(1.05) - 0.2*sin(3*t)^2\"\n";
    for constraint in [moved, apart] {
        let model = Source::read("own.toml", format!("{parts}{constraint}").as_bytes()).unwrap().model().unwrap();
        for method in ["conserving", "conserving-ggl"] {
            let method = Method::resolve(&Choice::default().named(method)).unwrap();
            let mut simulation = Simulation::new(model.system.clone(), method, 0.01).unwrap();
            assert_eq!(simulation.step_to(2.0), Status::Completed);
            let drift = simulation.audit().momentum_summary().linear_drift;
            assert!(drift < 1e-13, "{constraint}: {drift} kg·m/s");
        }
    }
}

/// A closure that adds to the force, and one that writes it for half a second only: what they leave unwritten is zero at each call.
#[test]
fn loads_write_into_zeros() {
    type Push = fn(&[f64], &[f64], f64, &mut [f64]);
    let adds: Push = |_, _, _, force| force[1] += 1.0;
    let writes_at_first: Push = |_, _, t, force| {
        if t < 0.5 {
            force[1] = 1.0;
        }
    };
    for (push, way) in [(adds, 0.5), (writes_at_first, 0.375)] {
        for method in ["conserving-ggl", "radau", "generalized-alpha", "ode/dopri5", "lagrange-1/rk4"] {
            let mut builder = SystemBuilder::new(2, [0.0; 3]);
            let point = builder.free_node([0.0; 3], [0.0; 3]);
            builder.mass(Node::Node(point), Node::Node(point), 1.0);
            builder.load("push", &[point], Arc::new(Differences(push)));
            let method = Method::resolve(&Choice::default().named(method)).unwrap();
            let mut simulation = Simulation::new(builder.build(), method, 0.01).unwrap();
            assert_eq!(simulation.step_to(1.0), Status::Completed);
            // A step across the end of the push is off by some of it.
            let off = (simulation.state().x[1] - way).abs();
            assert!(off < 0.01, "{}: {off} m", simulation.method().name);
        }
    }
}
