//! The cross section of a beam as it is written: `section = { circle = 0.02 }` and so on.

use std::f64::consts::PI;

use crate::model::entry::{Entry, Spot, Written, all};
use crate::model::fault::{Read, Refused};
use crate::model::fields::{Keys, List, Number};
use crate::model::key::Shape;
use crate::model::value::Value;
use crate::record::SceneShape;

/// The cross section of a beam: a circle, a tube, a rectangle, or the numbers of a profile.
#[derive(Clone, Debug, PartialEq, Keys)]
#[table("a section", refuse_bare)]
pub struct Section {
    /// radius
    #[key(unit = "m", default = "none")]
    pub circle: Option<Number>,
    /// outer and inner radius
    #[key(unit = "m", default = "none", shape = Shape::Numbers(2, 2))]
    pub tube: Option<List<Number>>,
    /// width along y and height along z of the beam; in a planar model width across the plane and height in it
    #[key(unit = "m", default = "none", shape = Shape::Numbers(2, 2))]
    pub rectangle: Option<List<Number>>,
    /// of a profile
    #[key(unit = "m²", default = "none")]
    pub area: Option<Number>,
    /// of a profile, [∫ z² dA, ∫ y² dA], for bending about y and z of the beam; in a planar model one, for bending in the plane
    #[key(unit = "m⁴", default = "none", shape = Shape::Numbers(1, 2))]
    pub second_moments: Option<List<Number>>,
    /// of a profile in space: its torsion constant
    #[key(unit = "m⁴", default = "none")]
    pub torsion: Option<Number>,
}

/// What a beam needs of its section. In a planar model bending is about z, across the plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Numbers {
    /// m²
    pub area: f64,
    /// For bending about y and about z, m⁴.
    pub second: [f64; 2],
    /// m⁴
    pub torsion: f64,
    /// Shear coefficients along y and z (Cowper 1966); of a profile 1.
    pub shear: [f64; 2],
    /// How it is drawn.
    pub outline: Outline,
}

/// The outline of a section: of a profile the rectangle with its area's radii of gyration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outline {
    /// Radius, m.
    Circle(f64),
    /// Edges along y and z, m.
    Rectangle([f64; 2]),
}

/// Corners of a circle as it is drawn.
const CORNERS: usize = 12;

impl Outline {
    /// Its largest dimension, m.
    pub fn size(self) -> f64 {
        match self {
            Self::Circle(radius) => 2.0 * radius,
            Self::Rectangle([y, z]) => y.max(z),
        }
    }

    /// A prism with this outline between two places along x, m.
    pub fn prism(self, from: f64, to: f64) -> SceneShape {
        let corners: Vec<[f64; 2]> = match self {
            Self::Circle(radius) => {
                (0..CORNERS).map(|k| 2.0 * PI * k as f64 / CORNERS as f64).map(|a| [radius * a.cos(), radius * a.sin()]).collect()
            }
            Self::Rectangle([y, z]) => [[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]].map(|[a, b]| [a * y, b * z]).to_vec(),
        };
        let n = corners.len();
        let end = |x: f64| corners.iter().map(move |[y, z]| [x, *y, *z]);
        let vertices = end(from).chain(end(to)).collect();
        let next = |k: usize| (k + 1) % n;
        let sides = (0..n).flat_map(|k| [[k, next(k), n + k], [next(k), n + next(k), n + k]]);
        let caps = (1..n - 1).flat_map(|k| [[0, k + 1, k], [n, n + k, n + k + 1]]);
        SceneShape::Mesh { vertices, triangles: sides.chain(caps).map(|triangle| triangle.map(|k| k as u32)).collect() }
    }
}

impl Section {
    /// Its numbers, of a material with this Poisson's ratio; `entry` is its table.
    pub(super) fn evaluate(&self, entry: &Entry<'_>, dim: usize, poisson: f64) -> Read<Numbers> {
        let kinds = ["circle", "tube", "rectangle", "area"];
        let given: Vec<&str> = kinds.into_iter().filter(|name| self.value(name).is_some()).collect();
        if let [first, second, ..] = given[..] {
            return Err(entry.refuse_key(second, format!("`{first}` and `{second}` are two sections"), "keep one of the two"));
        }
        if let Some(name) = ["second_moments", "torsion"].into_iter().find(|name| self.area.is_none() && self.value(name).is_some()) {
            return Err(entry.refuse_key(name, format!("`{name}` is of a profile, which has an `area`"), "add area = …, or remove it"));
        }
        match self {
            Self { circle: Some(radius), .. } => Ok(round(radius.positive(entry, "circle")?, 0.0, poisson)),
            Self { tube: Some(radii), .. } => {
                let [outer, inner] = radii.sizes(entry, "tube")?;
                if inner >= outer {
                    return Err(entry.refuse("tube", "the inner radius is not below the outer one", "write tube = [OUTER, INNER]"));
                }
                Ok(round(outer, inner, poisson))
            }
            Self { rectangle: Some(edges), .. } => {
                let [width, height] = edges.sizes(entry, "rectangle")?;
                // The height of a planar section is along y of the beam, which is in the plane.
                Ok(if dim == 2 { rectangle(height, width, poisson) } else { rectangle(width, height, poisson) })
            }
            Self { area: Some(area), .. } => self.profile(entry, dim, area),
            // What it says is under a name that is not known, which has been told.
            _ if entry.has_fault() => Err(Refused),
            _ => Err(entry.refuse_all("this section says nothing", format!("give one of {}", kinds.join(", ")))),
        }
    }

    fn profile(&self, entry: &Entry<'_>, dim: usize, area: &Number) -> Read<Numbers> {
        let area = area.positive(entry, "area");
        let wanted = if dim == 2 { 1 } else { 2 };
        let second = match &self.second_moments {
            None => {
                Err(entry
                    .refuse_all("a profile needs its `second_moments`", "add second_moments = [∫ z² dA, ∫ y² dA]; in a planar model one"))
            }
            Some(list) if list.len() != wanted => {
                let message = format!("`second_moments` wants {wanted} numbers, and this has {}", list.len());
                Err(entry.refuse("second_moments", message, "give ∫ z² dA and ∫ y² dA; in a planar model ∫ y² dA alone"))
            }
            Some(list) => all(list.iter().enumerate().map(|(k, item)| item.positive(entry, Spot { key: "second_moments", item: Some(k) }))),
        };
        let torsion = match &self.torsion {
            Some(torsion) => torsion.positive(entry, "torsion"),
            None if dim == 2 => Ok(0.0),
            None => Err(entry.refuse_all("a profile in space needs its `torsion`", "add torsion = …, its torsion constant in m⁴")),
        };
        let (area, second, torsion) = (area?, second?, torsion?);
        let second = if dim == 2 { [0.0, second[0]] } else { [second[0], second[1]] };
        // ∫ z² dA is that of the height along z.
        let edge = |second: f64| (12.0 * second / area).sqrt();
        let outline = Outline::Rectangle(if dim == 2 { [edge(second[1]); 2] } else { [edge(second[1]), edge(second[0])] });
        Ok(Numbers { area, second, torsion, shear: [1.0; 2], outline })
    }
}

fn refuse_bare(entry: &Entry<'_>, spot: Spot<'_>, _value: &Value) -> Refused {
    entry.refuse(spot, "a section is a table", "write section = { circle = RADIUS }, { rectangle = [WIDTH, HEIGHT] } and so on")
}

/// A circle, or a tube.
fn round(outer: f64, inner: f64, poisson: f64) -> Numbers {
    let ratio = inner / outer;
    let area = PI * outer.powi(2) * (1.0 - ratio.powi(2));
    let second = 0.25 * PI * outer.powi(4) * (1.0 - ratio.powi(4));
    let (m, one) = ((1.0 + ratio.powi(2)).powi(2), 1.0 + poisson);
    let shear = 6.0 * one * m / ((7.0 + 6.0 * poisson) * m + (20.0 + 12.0 * poisson) * ratio.powi(2));
    Numbers { area, second: [second; 2], torsion: 2.0 * second, shear: [shear; 2], outline: Outline::Circle(outer) }
}

/// A rectangle with edges along y and z.
fn rectangle(y: f64, z: f64, poisson: f64) -> Numbers {
    let shear = 10.0 * (1.0 + poisson) / (12.0 + 11.0 * poisson);
    let (long, short) = (y.max(z), y.min(z));
    // Saint-Venant's series (Timoshenko and Goodier 1970, §109); twelve terms are round-off.
    let odd = (0..12).map(|k| f64::from(2 * k + 1));
    let sum: f64 = odd.map(|n| (0.5 * n * PI * long / short).tanh() / n.powi(5)).sum();
    let torsion = long * short.powi(3) / 3.0 * (1.0 - 192.0 / PI.powi(5) * short / long * sum);
    Numbers {
        area: y * z,
        second: [y * z.powi(3) / 12.0, z * y.powi(3) / 12.0],
        torsion,
        shear: [shear; 2],
        outline: Outline::Rectangle([y, z]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sections_have_the_numbers_of_the_tables() {
        // Torsion constants over a b³ of rectangles: Timoshenko and Goodier 1970, §109.
        for (ratio, factor) in [(1.0, 0.1406), (1.5, 0.1958), (2.0, 0.229), (10.0, 0.312)] {
            let numbers = rectangle(0.3 * ratio, 0.3, 0.3);
            assert!((numbers.torsion / (0.3 * ratio * 0.3_f64.powi(3)) - factor).abs() < 6e-4, "{ratio}");
            assert_eq!(numbers.torsion, rectangle(0.3, 0.3 * ratio, 0.3).torsion);
        }
        // Cowper 1966: a circle has 6 (1 + ν)/(7 + 6 ν), a thin tube 2 (1 + ν)/(4 + 3 ν).
        assert!((round(0.1, 0.0, 0.3).shear[0] - 7.8 / 8.8).abs() < 1e-12);
        assert!((round(0.1, 0.0999999, 0.3).shear[0] - 2.6 / 4.9).abs() < 1e-6);
        let tube = round(0.05, 0.04, 0.3);
        assert!((tube.area - PI * 9e-4).abs() < 1e-15 && (tube.torsion - 0.5 * PI * (6.25e-6 - 2.56e-6)).abs() < 1e-18);
    }
}
