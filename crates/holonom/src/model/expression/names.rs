//! What the expressions of a mechanism name beside parameters: its coordinates, forces and measures.

use super::{Mistake, Program};
use crate::model::fault::nearest;
use crate::record::Running;

/// Numbers what an expression names of a mechanism.
pub trait Names {
    /// The number of the variable that a name stands for, if there is such a thing.
    ///
    /// # Errors
    /// Something that is there and cannot be read here.
    fn variable(&mut self, name: &str) -> Result<Option<usize>, Mistake>;

    /// The formula that a name stands for: of `t`, which is its variable 0, and behind it of what is numbered here.
    ///
    /// # Errors
    /// A formula that cannot be read here.
    fn formula(&mut self, _name: &str) -> Result<Option<Program>, Mistake> {
        Ok(None)
    }

    /// The number of the variable that is a running value of a formula; none where nothing is known of the time before.
    fn running(&mut self, _running: Running, _of: Program) -> Option<usize> {
        None
    }

    /// Letters of the coordinates of places, where places can be named.
    fn axes(&self) -> Option<&'static str> {
        None
    }

    /// Whether an input or a measure has this name, or a column of every run where these can be read.
    fn has(&self, _name: &str) -> bool {
        false
    }

    /// All names, for suggestions.
    fn known(&self) -> Vec<String> {
        Vec::new()
    }
}

/// Names nothing.
pub struct Nothing;

impl Names for Nothing {
    fn variable(&mut self, _name: &str) -> Result<Option<usize>, Mistake> {
        Ok(None)
    }
}

/// Of names of columns, those of the thing that a name is of: all that begin as it does up to its last dot, and have no further one.
pub fn beside<'a>(name: &str, columns: &'a [String]) -> Vec<&'a str> {
    let Some((thing, _)) = name.rsplit_once('.') else { return Vec::new() };
    let is_beside = |column: &&str| column.rsplit_once('.').is_some_and(|(of, _)| of == thing);
    columns.iter().map(String::as_str).filter(is_beside).collect()
}

/// The one of these columns that a name means by what stands behind its last dot.
pub fn nearest_beside<'a>(name: &str, beside: &[&'a str]) -> Option<&'a str> {
    let last = |name: &str| name.rsplit('.').next().unwrap_or_default().to_string();
    let known: Vec<String> = beside.iter().map(|column| last(column)).collect();
    let near = nearest(&last(name), known.iter().map(String::as_str))?;
    known.iter().position(|known| known == near).map(|k| beside[k])
}

/// Names of the running values.
pub(super) const RUNNING: &[(&str, Running)] =
    &[("max", Running::Max), ("min", Running::Min), ("rms", Running::Rms), ("integral", Running::Integral)];

/// Functions of places, how many they take, and how they are written.
pub(super) const OF_PLACES: &[(&str, usize, &str)] =
    &[("distance", 2, "distance(A, B)"), ("speed", 2, "speed(A, B)"), ("angle", 3, "angle(A, B, C)")];

/// The function of a vector's component in the axes of a body, and how it is written.
pub(super) const LOCAL: (&str, &str) = ("local", "local(BODY, BODY.ax), or local(BODY, JOINT.fx)");

/// The component along axis `k` of a body of the vector whose components have names that begin with `vector`, as a formula of them and of the
/// body's orientation.
pub(super) fn local(body: &str, vector: &str, k: usize, axes: &str) -> String {
    let component = |axis: char| format!("'{vector}{axis}'");
    // Column k of the matrix from body axes to the world's, by the quaternion or in the plane by the angle.
    let q = |letter: usize| format!("'{body}.q{}'", ['w', 'x', 'y', 'z'][letter]);
    let entry = |j: usize| match axes.len() {
        2 if j == k => format!("cos('{body}.angle')"),
        2 => format!("{}sin('{body}.angle')", if j < k { "-" } else { "" }),
        _ if j == k => format!("(1-2*({}^2+{}^2))", q((k + 1) % 3 + 1), q((k + 2) % 3 + 1)),
        _ => {
            let (third, sign) = (3 - j - k, if (j + 1) % 3 == k { '-' } else { '+' });
            format!("2*({}*{}{sign}{}*{})", q(j + 1), q(k + 1), q(0), q(third + 1))
        }
    };
    let parts = axes.chars().enumerate().map(|(j, axis)| format!("({})*{}", entry(j), component(axis)));
    parts.collect::<Vec<_>>().join("+")
}

/// A function of places as a formula of their coordinates: a distance, its rate, or the angle at the second of three places.
pub(super) fn of_places(name: &str, places: &[String], axes: &str) -> String {
    let component = |place: &str, letters: &str| if place == "ground" { "0".to_string() } else { format!("'{place}.{letters}'") };
    let from_to = |from: usize, to: usize, prefix: &str| -> Vec<String> {
        let difference = |axis: char| {
            let letters = format!("{prefix}{axis}");
            format!("({}-{})", component(&places[to], &letters), component(&places[from], &letters))
        };
        axes.chars().map(difference).collect()
    };
    let dot = |u: &[String], w: &[String]| {
        let products: Vec<String> = u.iter().zip(w).map(|(u, w)| format!("{u}*{w}")).collect();
        products.join("+")
    };
    let length = |u: &[String]| {
        let squares: Vec<String> = u.iter().map(|u| format!("{u}^2")).collect();
        format!("sqrt({})", squares.join("+"))
    };
    match name {
        "distance" => length(&from_to(0, 1, "")),
        "speed" => {
            let (way, rate) = (from_to(0, 1, ""), from_to(0, 1, "v"));
            format!("({})/{}", dot(&way, &rate), length(&way))
        }
        _ => {
            let (u, w) = (from_to(1, 0, ""), from_to(1, 2, ""));
            let cross = |i: usize, j: usize| format!("({}*{}-{}*{})", u[i], w[j], u[j], w[i]);
            let sine = match axes.len() {
                2 => format!("abs({})", cross(0, 1)),
                _ => length(&[cross(1, 2), cross(2, 0), cross(0, 1)]),
            };
            format!("atan2({sine},{})", dot(&u, &w))
        }
    }
}
