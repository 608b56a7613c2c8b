use super::pair::Pair;
use super::{Joint, Layout, Seat, Sides};
use crate::model::entry::Spot;
use crate::model::fault::{Read, suggest};
use crate::model::fields::{Keys, List, Site};
use crate::model::geometry::{cross, norm, scale, unit};
use crate::model::key::Shape;

/// any of the six motions of two bodies against each other locked, along and about three axes of the first body; locks of rotation
/// hold for any others, but two alone are those of a joint with one free axis: locked rx and ry leave rz
#[derive(Clone, Debug, PartialEq, Keys, Sides)]
#[kind(
    name = "generic",
    equations = "x: d·x_A = 0, y: d·y_A = 0, z: d·z_A = 0, rx: y_A·z_B = 0, ry: z_A·x_B = 0, rz: x_A·y_B = 0; of two with one free axis f_B·m_A = 0 and f_B·n_A = 0",
    example = r#"
[body.load]
mass = 1
shape = { box = [0.2, 0.1, 0.1] }
position = [0, 0, 0]

[joint.guide]
type = "generic"
between = ["ground", "load"]
at = [0, 0, 0]
locks = ["x", "y", "rx", "ry", "rz"]
"#
)]
pub struct Generic {
    /// the two bodies, or a body and "ground"
    #[key(shape = Shape::Members)]
    pub between: List<String>,
    /// where it sits at the start: a place, "BODY.POINT", or one for each body
    #[key(unit = "m")]
    pub at: Site,
    /// which motions are locked
    #[key(shape = Shape::Words(&LOCKS))]
    pub locks: List<String>,
    /// the x axis at the start, and a direction towards the y axis
    #[key(unit = "any", default = "those of the model", shape = Shape::Directions)]
    pub axes: Option<Site>,
}

const LOCKS: [&str; 6] = ["x", "y", "z", "rx", "ry", "rz"];

impl Joint for Generic {
    const LAYOUT: Layout = Layout { freedom: [Some(6), None], at: Seat::Given, directions: [0, 0], shares: [&[], &[]], takes_point: false };

    fn rows(&self, pair: &mut Pair<'_, '_>) -> Read<()> {
        let locks = locks(pair, &self.locks)?;
        let axes = axes(pair, self.axes.as_ref())?;
        pair.geometry.triad = [axes; 2];
        for k in 0..3 {
            match locks[k] {
                true => pair.stay(k),
                false => pair.displacement(LOCKS[k], k),
            }
        }
        let free: Vec<usize> = (0..3).filter(|&k| !locks[3 + k]).collect();
        for k in (0..3).filter(|&k| locks[3 + k]) {
            match free[..] {
                // At a quarter turn about the free axis the others' own rows would be those of one lock.
                [free] => pair.perpendicular(free, 3 - k - free),
                _ => pair.perpendicular((k + 2) % 3, (k + 1) % 3),
            }
        }
        if let [free] = free[..] {
            let form = pair.angle_between([(free + 1) % 3, (free + 2) % 3]);
            pair.coordinate_about("angle", form, true, Some(free));
        }
        Ok(())
    }
}

fn locks(pair: &Pair<'_, '_>, words: &[String]) -> Read<[bool; 6]> {
    let mut locks = [false; 6];
    for (k, word) in words.iter().enumerate() {
        match LOCKS.iter().position(|lock| *lock == word) {
            Some(lock) => locks[lock] = true,
            None => {
                let spot = Spot { key: "locks", item: Some(k) };
                return Err(pair.entry.refuse(spot, format!("there is no lock \"{word}\""), suggest(word, LOCKS)));
            }
        }
    }
    match locks.contains(&true) {
        true => Ok(locks),
        false => {
            Err(pair.entry.refuse("locks", "a joint without locks holds nothing", "lock some of x, y, z, rx, ry, rz, or remove the joint"))
        }
    }
}

/// x, y and z of the joint at the start.
fn axes(pair: &Pair<'_, '_>, given: Option<&Site>) -> Read<[[f64; 3]; 3]> {
    let Some(given) = given else { return Ok([0, 1, 2].map(unit)) };
    let [x, towards] = super::geometry::directions(pair.assembly, pair.entry, "axes", given)?;
    let z = cross(x, towards);
    let size = norm(z);
    if size < 1e-6 {
        return Err(pair.entry.refuse("axes", "the two axes are parallel", "give an x axis, and a direction towards the y axis"));
    }
    let z = scale(z, 1.0 / size);
    Ok([x, cross(z, x), z])
}
