//! The mechanisms of the benches, from one body to ten thousand: files of the gallery and of `benches/models`.
#![allow(dead_code)] // each bench uses its share

use std::fmt;

use holonom::model::Model;
use holonom::simulation::{Choice, Method};
use holonom_io::Source;

/// A model file with a parameter that its number of bodies follows from.
struct Family {
    name: &'static str,
    text: &'static str,
    parameter: &'static str,
    sizes: &'static [usize],
    bodies: fn(usize) -> usize,
}

/// Step of all benches, s.
pub const STEP: f64 = 1e-3;

const FAMILIES: &[Family] = &[
    Family {
        name: "chain",
        text: include_str!("../../../../examples/chain.toml"),
        parameter: "N",
        sizes: &[1, 10, 100, 1_000, 10_000],
        bodies: |rods| rods,
    },
    Family {
        name: "tree",
        text: include_str!("../../../../benches/models/tree.toml"),
        parameter: "L",
        sizes: &[0, 3, 6, 9, 12],
        bodies: |levels| (2 << levels) - 1,
    },
    Family {
        name: "ladder",
        text: include_str!("../../../../examples/four-bar.toml"),
        parameter: "N",
        sizes: &[1, 5, 50, 500, 5_000],
        bodies: |windows| 2 * windows + 1,
    },
    Family {
        name: "random",
        text: include_str!("../../../../benches/models/graph.toml"),
        parameter: "n",
        sizes: &[1, 3, 10, 32, 100],
        // Its joints; some rods more close loops.
        bodies: |joints| joints * joints,
    },
    Family {
        name: "grid",
        text: include_str!("../../../../benches/models/grid.toml"),
        parameter: "n",
        sizes: GRIDS,
        bodies: |cells| 3 * cells * cells,
    },
];

/// Cells along an edge of the grid. With 58, which has ten thousand rods, the factors would take tens of gigabytes.
const GRIDS: &[usize] = &[1, 2, 6, 18, 30];

/// A mechanism: what it is of, and its parameter.
#[derive(Clone, Copy)]
pub struct Case {
    family: &'static Family,
    size: usize,
}

impl fmt::Display for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} {}", self.family.name, self.bodies())
    }
}

impl fmt::Debug for Case {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

/// All mechanisms.
pub fn cases() -> impl Iterator<Item = Case> {
    FAMILIES.iter().flat_map(|family| family.sizes.iter().map(move |&size| Case { family, size }))
}

impl Case {
    pub fn family(&self) -> &'static str {
        self.family.name
    }

    pub fn bodies(&self) -> usize {
        (self.family.bodies)(self.size)
    }

    pub fn model(&self) -> Model {
        let Family { name, text, parameter, .. } = self.family;
        let mut source = Source::read(name, text.as_bytes()).unwrap_or_else(|message| panic!("{message}"));
        source.set(&format!("parameters.{parameter}"), &self.size.to_string()).unwrap_or_else(|message| panic!("{message}"));
        source.model().unwrap_or_else(|message| panic!("{message}"))
    }
}

/// A method by its name.
pub fn method(name: &str) -> Method {
    Method::resolve(&Choice { method: Some(name.into()), ..Choice::default() }).expect("the method is in the table")
}
