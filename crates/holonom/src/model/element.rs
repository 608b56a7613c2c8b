//! What joints, constraints, drives and forces of any kind have in common.

use std::fmt::Debug;

use super::assembly::Assembly;
use super::entry::{Entry, Written};
use super::fault::Read;
use super::fields::{Described, Keys};
use super::joints::{AnyJoint, Joint, Layout, OTHERS_IN_PLANE, pair};
use super::value::Table;

/// An element of a model: a joint, a coupler, a constraint, a drive or a force.
pub trait Element: Described + Debug + Send + Sync + 'static {
    /// How it sits between two bodies, of a joint.
    const LAYOUT: Option<Layout> = None;

    /// Whether it looks at other entries of its section, as couplers at joints, and is built when all of these are there.
    const NEEDS_OTHERS: bool = false;

    /// What to use in a planar model, of what is in space alone.
    const IN_PLANE: Option<&'static str> = None;

    /// Itself as a joint between two bodies, if it is one.
    fn as_joint(&self) -> Option<&dyn AnyJoint> {
        None
    }

    /// Keys and names of the bodies that it turns or whose axes it follows: a plate or a rod may lack some of these.
    fn turns(&self) -> Vec<(&'static str, &str)> {
        Vec::new()
    }

    /// Adds what it is to the system.
    ///
    /// # Errors
    /// What is wrong with its keys; the faults are recorded.
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()>;
}

impl<T: Joint> Element for T {
    const LAYOUT: Option<Layout> = Some(<T as Joint>::LAYOUT);

    const IN_PLANE: Option<&'static str> = match <T as Joint>::LAYOUT.freedom[1] {
        Some(_) => None,
        None => Some(OTHERS_IN_PLANE),
    };

    fn as_joint(&self) -> Option<&dyn AnyJoint> {
        Some(self)
    }

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        pair::build(assembly, entry, self)
    }
}

/// An element of any kind.
pub trait AnyElement: Written + Debug + Send + Sync {
    /// Whether it looks at other entries of its section, as couplers at joints, and is built when all of these are there.
    fn needs_others(&self) -> bool;

    /// Itself as a joint between two bodies, if it is one.
    fn as_joint(&self) -> Option<&dyn AnyJoint>;

    /// Keys and names of the bodies that it turns or whose axes it follows.
    fn turns(&self) -> Vec<(&'static str, &str)>;

    /// The table as it would be written, `type` first.
    fn write(&self) -> Table;

    /// Adds what it is to the system.
    ///
    /// # Errors
    /// What is wrong with its keys; the faults are recorded.
    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()>;
}

impl<T: Element> AnyElement for T {
    fn needs_others(&self) -> bool {
        T::NEEDS_OTHERS
    }

    fn as_joint(&self) -> Option<&dyn AnyJoint> {
        Element::as_joint(self)
    }

    fn turns(&self) -> Vec<(&'static str, &str)> {
        Element::turns(self)
    }

    fn write(&self) -> Table {
        let keys = T::KEYS.iter().map(|key| key.name);
        ["type"].into_iter().chain(keys).filter_map(|key| Some((key, self.value(key)?))).collect()
    }

    fn build(&self, assembly: &mut Assembly<'_>, entry: &Entry<'_>) -> Read<()> {
        Element::build(self, assembly, entry)
    }
}

/// An element in a description; alike are those that are written alike.
#[derive(Clone, Debug)]
pub struct Boxed(pub(super) std::sync::Arc<dyn AnyElement>);

impl<T: Element> From<T> for Boxed {
    fn from(element: T) -> Self {
        Self(std::sync::Arc::new(element))
    }
}

impl PartialEq for Boxed {
    fn eq(&self, other: &Self) -> bool {
        self.0.write() == other.0.write()
    }
}

/// Reads an element of a kind.
pub(super) fn read<T: Element>(reader: &super::reader::Reader<'_>) -> Read<Boxed> {
    Ok(<T as Keys>::read(reader)?.into())
}
