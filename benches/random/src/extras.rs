//! Couplers of joints, springs and dampers of a random mechanism.

use crate::generate::Making;
use crate::joints::Joint;
use crate::mechanism::{Entry, Key, list, number, text, vector};

/// Adds some, more often none.
pub fn add(making: &mut Making) {
    if making.random.chance(0.3) {
        couple(making);
    }
    for k in 0..making.random.below(3) {
        if making.random.chance(0.3) {
            spring(making, k);
        }
        if making.random.chance(0.2) {
            torsion(making, k);
        }
    }
}

/// A coordinate of a joint as it is named, and whether it is an angle.
pub type Coordinate = (String, String, bool);

pub fn coordinates(joint: &Joint) -> impl Iterator<Item = Coordinate> {
    let name = |(coordinate, is_angle): &(&str, bool)| (joint.name.clone(), format!("{}.{coordinate}", joint.name), *is_angle);
    joint.coordinates.iter().map(name).collect::<Vec<_>>().into_iter()
}

fn couple(making: &mut Making) {
    let mut all: Vec<Coordinate> = making.joints.iter().flat_map(coordinates).collect();
    if all.len() < 2 {
        return;
    }
    let first = all.swap_remove(making.random.below(all.len()));
    let second = all.swap_remove(making.random.below(all.len()));
    let ratio = making.random.log_between(0.1, 10.0) * making.random.sign();
    let unit = |is_angle: bool| if is_angle { 1.0 } else { making.size };
    let size = ratio * unit(first.2) / unit(second.2);
    let joints = ("joints", list([text(&first.1), text(&second.1)]));
    let term = |name: &str, factor: f64| format!("{{ joint = {}, factor = {} }}", text(name), number(factor));
    let keys: Vec<Key> = match (first.2, second.2, making.random.chance(0.5)) {
        (true, false, true) => vec![("type", text("rack-and-pinion")), joints, ("radius", number(1.0 / size))],
        (true, true, _) if making.random.chance(0.3) => {
            let crossed = ("crossed", making.random.chance(0.5).to_string());
            vec![("type", text("pulley")), joints, ("radii", list([number(making.size), number(making.size * size.abs())])), crossed]
        }
        (_, _, true) => vec![("type", text("gear")), joints, ("ratio", number(size))],
        _ => vec![("type", text("linear")), ("terms", list([term(&first.1, 1.0), term(&second.1, size)]))],
    };
    making.entries.push(Entry { section: "joint", name: "coupler".into(), uses: vec![first.0, second.0], keys });
}

/// Stiffness and damping of a mass (kg) that go with the rate of the mechanism, each there or not.
fn laws(making: &mut Making, mass: f64) -> Vec<Key> {
    let (rate, random) = (making.rate, &mut making.random);
    let stiffness = ("stiffness", number(mass * rate * rate * random.log_between(0.1, 100.0)));
    let damping = ("damping", number(mass * rate * random.log_between(0.1, 10.0)));
    match random.below(3) {
        0 => vec![stiffness],
        1 => vec![damping],
        _ => vec![stiffness, damping],
    }
}

/// A spring between two centres, or a centre and a fixed place.
fn spring(making: &mut Making, k: usize) {
    let first = making.random.below(making.bodies.len());
    let second = making.random.below(making.bodies.len());
    let (a, b) = (&making.bodies[first], &making.bodies[second]);
    let (mut uses, mut mass) = (vec![a.name.clone()], a.mass);
    let end = match first != second && (a.centre - b.centre).norm() > 0.1 * making.size {
        true => {
            uses.push(b.name.clone());
            mass = mass.min(b.mass);
            text(&b.name)
        }
        false => vector(making.layout.dim, &(a.centre + making.random.direction(making.layout.dim) * making.size)),
    };
    let mut keys = vec![("type", text("spring")), ("between", list([text(&uses[0]), end]))];
    keys.extend(laws(making, mass));
    making.entries.push(Entry { section: "force", name: format!("spring{k}"), uses, keys });
}

/// A spring along a coordinate of a joint.
fn torsion(making: &mut Making, k: usize) {
    let all: Vec<Coordinate> = making.joints.iter().flat_map(coordinates).collect();
    if all.is_empty() {
        return;
    }
    let (joint, name, is_angle) = all[making.random.below(all.len())].clone();
    let named = making.joints.iter().find(|known| known.name == joint).expect("it is one of them");
    let masses = making.bodies.iter().filter(|body| named.between.contains(&body.name)).map(|body| body.mass);
    let mass = masses.fold(f64::INFINITY, f64::min);
    let unit = if is_angle { making.size * making.size } else { 1.0 };
    let mut keys = vec![("type", text("torsion")), ("joint", text(&name))];
    keys.extend(laws(making, mass * unit));
    making.entries.push(Entry { section: "force", name: format!("torsion{k}"), uses: vec![joint], keys });
}
