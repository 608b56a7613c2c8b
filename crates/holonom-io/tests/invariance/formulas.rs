//! Variables of formulas in other units and frames: what stands in their place.

use std::collections::HashMap;

use holonom::model::{Table, Value};

use super::change::Change;
use super::expression::{replaced, written};
use super::transform::{Coordinate, Coordinates};

/// What stands for a variable where that is not itself.
pub struct Names {
    of: HashMap<String, String>,
    letters: Vec<char>,
}

impl Names {
    pub fn new(change: &Change, letters: &str, coordinate: Option<Coordinate>, entry: &Table, coordinates: &Coordinates) -> Self {
        let mut names = Self { of: HashMap::new(), letters: letters.chars().collect() };
        names.scaled("t", 1.0 / change.time);
        ["length", "rest", "extension"].into_iter().for_each(|name| names.scaled(name, 1.0 / change.length));
        names.scaled("rate", change.time / change.length);
        coordinate.into_iter().for_each(|coordinate| names.coordinate("q", coordinate, change));
        if let Some(Value::Table(others)) = entry.get("coordinates") {
            for (name, other) in others.iter() {
                let Value::Text(other) = other else { panic!("{name} is no text") };
                names.coordinate(name, coordinates[other], change);
            }
        }
        let letters = names.letters.clone();
        for k in 0..letters.len() {
            let speed = change.time / change.length;
            names.sum("", &letters, k, 1.0 / change.length, change, |c| {
                format!("-({}+{}*t)", written(change.shift[c]), written(change.drift[c]))
            });
            names.sum("v", &letters, k, speed, change, |c| format!("-{}", written(change.drift[c])));
            names.sum("w", &letters, k, change.parity() * change.time, change, |_| String::new());
        }
        names.scaled("w", change.parity() * change.time);
        names
    }

    /// A formula of the old variables as one of the new ones.
    pub fn in_formula(&self, text: &str) -> String {
        replaced(text, |name| match name.rsplit_once('.') {
            Some((of, letter)) => self.of.get(letter).map(|new| self.with_prefix(of, new)),
            None => self.of.get(name).cloned(),
        })
    }

    /// A formula of a place's components, such as `x`, with the name of the place before them.
    fn with_prefix(&self, of: &str, formula: &str) -> String {
        let is_letter = |name: &str| self.letters.iter().any(|&letter| name.chars().eq([letter]));
        replaced(formula, |name| is_letter(name).then(|| format!("{of}.{name}")))
    }

    fn scaled(&mut self, name: &str, factor: f64) {
        if factor != 1.0 {
            self.of.insert(name.to_string(), format!("({}*{name})", written(factor)));
        }
    }

    fn coordinate(&mut self, name: &str, coordinate: Coordinate, change: &Change) {
        let factor = coordinate.factor(change);
        self.scaled(name, 1.0 / factor);
        self.scaled(&format!("{name}_rate"), change.time / factor);
    }

    /// The component k of a vector whose components are named with a prefix, less something of the frame.
    fn sum(&mut self, prefix: &str, letters: &[char], k: usize, factor: f64, change: &Change, less: impl Fn(usize) -> String) {
        let moves = change.shift != [0.0; 3] || change.drift != [0.0; 3];
        if !change.turns() && !moves {
            return self.scaled(&format!("{prefix}{}", letters[k]), factor);
        }
        let part = |j: usize| {
            let less = if moves { less(j) } else { String::new() };
            format!("{}*({prefix}{}{less})", written(change.turn[j][k] * factor), letters[j])
        };
        let parts: Vec<String> = (0..letters.len()).filter(|&j| change.turn[j][k] != 0.0).map(part).collect();
        self.of.insert(format!("{prefix}{}", letters[k]), format!("({})", parts.join(" + ")));
    }
}
