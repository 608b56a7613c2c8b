//! Drives, formulas that are kept at zero, ropes and springs with laws of their own.

use nalgebra::Vector3;

use crate::extras::coordinates;
use crate::generate::Making;
use crate::mechanism::{Entry, Key, list, number, text, vector};

/// Seeds from this one have these as well; those below it give the mechanisms that they gave before.
pub const FROM: u64 = 1_000_000;

/// Adds some of each, more often none.
pub fn add(making: &mut Making) {
    if making.random.chance(0.4) {
        drive(making);
    }
    if making.layout.dim == 3 && making.random.chance(0.3) {
        formula(making);
    }
    if making.random.chance(0.3) {
        rope(making);
    }
    if making.random.chance(0.3) {
        law(making);
    }
}

/// A frequency of a drive, 1/s.
fn frequency(making: &mut Making) -> f64 {
    making.rate * making.random.log_between(0.1, 10.0)
}

/// A motion in the unit of a size, over time: a wave, or a spline that begins and ends at rest.
fn motion(making: &mut Making, size: f64) -> String {
    let (most, omega) = (size * making.random.log_between(1e-3, 1.0) * making.random.sign(), frequency(making));
    match making.random.below(3) {
        0 => {
            // Between steps, as differences over a step's end would not see that a spline changes there.
            let times = [0.0, 0.205, 0.605].map(|t| t / making.rate);
            let rows = times.into_iter().zip([0.0, most, 0.3 * most]).map(|(t, s)| list([number(t), number(s)]));
            format!("{{ table = {}, ends = \"rest\" }}", list(rows))
        }
        1 => text(&format!("{}*sin({}*t)", number(most), number(omega))),
        _ => text(&format!("{}*(1 - cos({}*t))", number(most), number(omega))),
    }
}

/// Drives a coordinate of a joint.
fn drive(making: &mut Making) {
    let all: Vec<_> = making.joints.iter().flat_map(coordinates).collect();
    if all.is_empty() {
        return;
    }
    let (joint, name, is_angle) = all[making.random.below(all.len())].clone();
    let (kind, size) = if is_angle { ("angle", 1.0) } else { ("displacement", making.size) };
    let keys = vec![("type", text(kind)), ("joint", text(&name)), ("profile", motion(making, size))];
    making.entries.push(Entry { section: "drive", name: "drive".into(), uses: vec![joint], keys });
}

/// Keeps a centre on a sphere, on a bowl or on a plane that goes to and fro.
fn formula(making: &mut Making) {
    let body = making.random.below(making.bodies.len());
    let (name, at) = (making.bodies[body].name.clone(), making.bodies[body].centre);
    let [x, y, z] = [("x", at.x), ("y", at.y), ("z", at.z)].map(|(axis, start)| format!("({name}.{axis} - {})", signed(start)));
    let reach = making.size * making.random.log_between(0.1, 10.0);
    let value = match making.random.below(3) {
        0 => {
            let away = making.random.direction(3) * reach;
            let square = |(c, off): (&String, f64)| format!("({c} - {})^2", signed(off));
            let sum = [&x, &y, &z].into_iter().zip(away.iter().copied()).map(square).collect::<Vec<_>>().join(" + ");
            format!("{sum} - {}", number(away.norm_squared()))
        }
        1 => format!("{z} - {}*({x}^2 + {y}^2)", signed(making.random.sign() / reach)),
        _ => format!("{x} - {}*sin({}*t)", number(0.1 * reach), number(frequency(making))),
    };
    let keys = vec![("type", text("expression")), ("value", text(&value))];
    making.entries.push(Entry { section: "constraint", name: "formula".into(), uses: vec![name], keys });
}

/// A number in a formula.
fn signed(value: f64) -> String {
    format!("({})", number(value))
}

/// A centre, and another one or a fixed place away from it: what they are of, their ends, their distance and a mass.
fn ends(making: &mut Making) -> (Vec<String>, [Vector3<f64>; 2], String, f64) {
    let dim = making.layout.dim;
    let [first, second] = [0; 2].map(|_| making.random.below(making.bodies.len()));
    let place = making.bodies[first].centre + making.random.direction(dim) * making.size;
    let (a, b) = (&making.bodies[first], &making.bodies[second]);
    if first != second && (a.centre - b.centre).norm() > 0.1 * making.size {
        return (vec![a.name.clone(), b.name.clone()], [a.centre, b.centre], text(&b.name), a.mass.min(b.mass));
    }
    (vec![a.name.clone()], [a.centre, place], vector(dim, &place), a.mass)
}

/// A rope between two ends, over a sheave or not, slack or taut at the start.
fn rope(making: &mut Making) {
    let (uses, [a, b], end, mass) = ends(making);
    let mut keys: Vec<Key> = vec![("type", text("rope")), ("between", list([text(&uses[0]), end]))];
    let mut length = (a - b).norm();
    if making.random.chance(0.4) {
        let sheave = (a + b) * 0.5 + making.random.direction(making.layout.dim) * making.size;
        length = (a - sheave).norm() + (sheave - b).norm();
        keys.push(("through", list([vector(making.layout.dim, &sheave)])));
    }
    keys.push(("length", number(length * making.random.between(0.8, 1.1))));
    keys.push(("stiffness", number(mass * making.rate * making.rate * making.random.log_between(0.1, 100.0))));
    making.entries.push(Entry { section: "force", name: "rope".into(), uses, keys });
}

/// A spring whose energy is a formula.
fn law(making: &mut Making) {
    let (uses, _, end, mass) = ends(making);
    let (stiffness, size) = (mass * making.rate * making.rate * making.random.log_between(0.1, 100.0), making.size);
    let energy = match making.random.below(3) {
        0 => format!("{}*extension^4", number(stiffness / (size * size))),
        1 => format!("{}*exp(-extension/{})", number(stiffness * size * size), number(size)),
        _ => format!("{}/length", number(stiffness * size * size * size)),
    };
    let keys = vec![("type", text("spring")), ("between", list([text(&uses[0]), end])), ("energy", text(&energy))];
    making.entries.push(Entry { section: "force", name: "law".into(), uses, keys });
}
