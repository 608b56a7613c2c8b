//! Kinds that another crate adds: a joint, a force law, a load by a closure and a custom constraint, in a file and by hand.

use std::sync::Arc;

use holonom::model::joints::{Joint, Layout, Pair, Revolute, Seat, Sides};
use holonom::model::{
    Assembly, Body, Description, Element, Entry, Keys, Kind, Kinds, List, Model, Number, Place, Point, Read, Shape, Site, Solid, from_to,
};
use holonom::simulation::{Choice, Method, Simulation, Status};
use holonom::system::{ConstraintFunction, Differences, Differentiated, Law, Place as Node, Reach, Response};
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
    let method = Method::resolve(&Choice { method: Some(method.into()), ..Choice::default() }).unwrap();
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
