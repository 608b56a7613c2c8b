//! The tables of kinds and keys that the reader, the schema, the manual and the tests walk.

use super::element::{self, Boxed, Element};
use super::expression::Functions;
use super::fault::Read;
use super::joints::{self, Layout};
use super::reader::Reader;
use super::{constraints, drives, forces};

/// A key of a table in a model file.
pub struct Key {
    /// What stands before the equals sign.
    pub name: &'static str,
    /// What may stand behind it.
    pub shape: Shape,
    /// Whether it must be there.
    pub required: bool,
    /// What is taken when it is not there, for people.
    pub default: &'static str,
    /// Unit, empty for what has none.
    pub unit: &'static str,
    /// What it is for, in one line.
    pub doc: &'static str,
}

/// What the value of a key looks like. A number may always be written as an expression over `[parameters]` in a text.
#[derive(Clone, Copy)]
pub enum Shape {
    /// One number.
    Number,
    /// A number without a fraction.
    Whole,
    /// Any words between quotes.
    Text,
    /// `true` or `false`.
    Flag,
    /// One of some words.
    Choice(&'static [&'static str]),
    /// As many numbers as the model has axes.
    Vector,
    /// A number or a text with an expression of the named variables.
    Formula(&'static [&'static str]),
    /// As many formulas as the model has axes.
    Formulas(&'static [&'static str]),
    /// The name of a point.
    Point,
    /// The name of a point, `"ground"`, or a fixed place as a list of numbers.
    End,
    /// Several of these; the numbers say how many at least and at most.
    Ends(usize, usize),
    /// The inertia of a body: 3 or 6 numbers or 3 × 3, in a planar model one.
    Inertia,
    /// A vector in space, a number in the plane.
    Spin,
    /// A table of named vectors.
    Places,
    /// Numbers: at least and at most so many.
    Numbers(usize, usize),
    /// Three rows of three numbers.
    Rows,
    /// A formula of t, or a table of times and values with its own keys.
    Profile(&'static [Key]),
    /// Rows of two numbers.
    Pairs,
    /// A table of named texts.
    Named,
    /// Three formulas, in a planar model one.
    Torque(&'static [&'static str]),
    /// A list of points.
    Curve,
    /// Two names of bodies.
    Members,
    /// A place, the name of one, or two of these.
    Site,
    /// A direction, the name of one, or two of these.
    Direction,
    /// Two directions or names of some.
    Directions,
    /// Two names of joints or of their coordinates.
    Coordinates,
    /// A list of tables with their own keys.
    Tables(&'static [Key]),
    /// Some words.
    Words(&'static [&'static str]),
    /// Names of points.
    Points,
    /// A table with its own keys.
    Table(&'static [Key]),
    /// A table with a number for each of some points.
    Weights,
    /// `"i = 0 to N"`
    Repeat,
}

impl Key {
    /// A key that must be there.
    pub(super) const fn required(name: &'static str, shape: Shape, unit: &'static str, doc: &'static str) -> Self {
        Self { name, shape, required: true, default: "", unit, doc }
    }

    /// A key that may be left out.
    pub(super) const fn optional(name: &'static str, shape: Shape, default: &'static str, unit: &'static str, doc: &'static str) -> Self {
        Self { name, shape, required: false, default, unit, doc }
    }
}

/// A kind of joint, constraint, drive or force: what `type` may say.
#[derive(Clone, Copy)]
pub struct Kind {
    /// As `type` has it, such as `revolute`.
    pub name: &'static str,
    /// One line.
    pub doc: &'static str,
    /// What it puts on the coordinates, as formulas.
    pub equations: &'static str,
    /// Its keys beside `type` and `repeat`.
    pub keys: &'static [Key],
    /// A small model that uses it.
    pub example: &'static str,
    /// How it sits between two bodies, of a joint.
    pub layout: Option<Layout>,
    /// What to use in a planar model, of what is in space alone.
    pub in_plane: Option<&'static str>,
    pub(super) read: fn(&Reader<'_>) -> Read<Boxed>,
}

impl Kind {
    /// The line of a kind in its table.
    pub const fn of<T: Element>() -> Self {
        Self {
            name: T::NAME,
            doc: T::DOC,
            equations: T::EQUATIONS,
            keys: T::KEYS,
            example: T::EXAMPLE,
            layout: T::LAYOUT,
            in_plane: T::IN_PLANE,
            read: element::read::<T>,
        }
    }
}

/// The kinds of elements that a reader knows, by section; of one's own are pushed to these.
#[derive(Clone)]
pub struct Kinds {
    /// Of `[joint.NAME]`: joints, then couplers.
    pub joints: Vec<Kind>,
    /// Of `[constraint.NAME]`.
    pub constraints: Vec<Kind>,
    /// Of `[drive.NAME]`.
    pub drives: Vec<Kind>,
    /// Of `[force.NAME]`.
    pub forces: Vec<Kind>,
    /// Functions that formulas may call beside those of every expression.
    pub functions: Functions,
}

impl Default for Kinds {
    fn default() -> Self {
        Self {
            joints: joints::kinds().copied().collect(),
            constraints: constraints::KINDS.to_vec(),
            drives: drives::KINDS.to_vec(),
            forces: forces::KINDS.to_vec(),
            functions: Functions::new(),
        }
    }
}

/// The key that every entry with a name may have.
pub const REPEAT: Key = Key::optional(
    "repeat",
    Shape::Repeat,
    "one entry",
    "",
    "makes NAME[0], NAME[1], …: \"i = 0 to N\", also nested: \"i = 0 to N, j = 1 to M\"",
);
