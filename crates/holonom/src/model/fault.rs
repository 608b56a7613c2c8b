//! What is wrong with a model. All faults are collected and reported together.

use std::cell::{Cell, RefCell};
use std::fmt;

use super::expression::Program;
use super::unseen::{Course, OverTime};
use super::value::key_path;
use super::{knocks, synonyms};

/// One thing that is wrong, where it is, and how to put it right.
#[derive(Clone, Debug, PartialEq)]
pub struct Fault {
    /// Where in the description, e.g. `constraint.inner-rod.between[1]`; empty for the model as a whole.
    pub path: String,
    /// What was written there, for people.
    pub offending: String,
    /// Character of a text value at which it goes wrong, counted from 0, where that is known.
    pub character: Option<usize>,
    /// Whether it is the key at the end of the path that is wrong, and not its value.
    pub on_key: bool,
    /// What is wrong and what was expected.
    pub message: String,
    /// What to do about it; empty where the message says it all.
    pub cure: String,
}

impl Fault {
    /// A fault at a path.
    pub fn new(path: impl Into<String>, offending: impl Into<String>, message: impl Into<String>, cure: impl Into<String>) -> Self {
        Self { path: path.into(), offending: offending.into(), character: None, on_key: false, message: message.into(), cure: cure.into() }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        write!(f, "{}", self.message)?;
        if !self.cure.is_empty() {
            write!(f, " ({})", self.cure)?;
        }
        Ok(())
    }
}

/// All faults of a model, in the order in which they were found; never empty.
#[derive(Clone, Debug, PartialEq)]
pub struct Faults(pub Vec<Fault>);

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (k, fault) in self.0.iter().enumerate() {
            write!(f, "{}{fault}", if k > 0 { "\n" } else { "" })?;
        }
        Ok(())
    }
}

impl std::error::Error for Faults {}

/// Says that something could not be read and that the fault has been recorded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refused;

/// Something read, or a fault recorded.
pub type Read<T> = Result<T, Refused>;

/// Most faults that are kept: more are of no use to anybody, and finding near names costs time.
const MOST: usize = 100;

/// Where faults are collected while a model is read.
#[derive(Debug, Default)]
pub struct Sink {
    faults: RefCell<Vec<Fault>>,
    dropped: Cell<usize>,
    /// Functions of time at whose zeros something of the model changes abruptly, found while formulas are read.
    pub switches: RefCell<Vec<Program>>,
    /// Motions that are told by formulas of time which may change abruptly, with their paths; of a repeated entry the first.
    pub motions: RefCell<Vec<(String, Program)>>,
    /// Motions that may have short peaks.
    pub peaked: RefCell<Vec<Program>>,
    /// Parts of forces and motions that follow from time alone; of a repeated entry those of the first.
    pub over_time: RefCell<Vec<OverTime>>,
    /// What looks like a slip and is no fault, with its path.
    notes: RefCell<Vec<(String, String)>>,
}

impl Sink {
    /// Records a fault; it is only made when there is still room for it.
    pub fn report(&self, fault: impl FnOnce() -> Fault) -> Refused {
        if self.faults.borrow().len() < MOST {
            let fault = fault();
            self.faults.borrow_mut().push(fault);
        } else {
            self.dropped.set(self.dropped.get() + 1);
        }
        Refused
    }

    /// Records a motion that may have short peaks.
    pub fn moves(&self, formula: &Program) {
        if knocks::may_have(formula) {
            self.peaked.borrow_mut().push(formula.clone());
        }
    }

    /// Records a motion that may change abruptly.
    pub fn motion(&self, path: String, formula: &Program) {
        let mut motions = self.motions.borrow_mut();
        if motions.last().is_none_or(|(known, _)| *known != path) {
            motions.push((path, formula.clone()));
        }
    }

    /// Records what follows from time alone, as a motion, once for each path.
    pub fn over_time(&self, path: String, courses: impl FnOnce() -> Vec<Course>) {
        let mut known = self.over_time.borrow_mut();
        if known.last().is_none_or(|last| last.path != path) {
            known.extend(courses().into_iter().map(|course| OverTime { path: path.clone(), course, is_motion: true }));
        }
    }

    /// Records what looks like a slip and is no fault, once for each path.
    pub fn note(&self, path: &str, message: impl FnOnce() -> String) {
        let mut notes = self.notes.borrow_mut();
        if notes.len() < MOST && notes.iter().all(|(known, _)| known != path) {
            notes.push((path.to_string(), message()));
        }
    }

    /// All notes, each with its path.
    pub fn notes(&self) -> Vec<String> {
        self.notes.borrow().iter().map(|(path, message)| format!("{path}: {message}")).collect()
    }

    /// Whether further faults are only counted.
    pub fn is_full(&self) -> bool {
        self.faults.borrow().len() >= MOST
    }

    /// Number of faults so far.
    pub fn count(&self) -> usize {
        self.faults.borrow().len() + self.dropped.get()
    }

    /// Whether there was a fault in the table at a path, or of it as a whole.
    pub fn has_fault_in(&self, path: &str) -> bool {
        self.faults.borrow().iter().any(|fault| fault.path.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('.')))
    }

    /// Whether a key of the table at a path was taken for one that is called `key`: that is not missing as well.
    pub fn has_taken_for(&self, path: &str, key: &str) -> bool {
        let is_in = |fault: &Fault| fault.on_key && fault.path == key_path(path, &fault.offending);
        self.faults.borrow().iter().any(|fault| is_in(fault) && fault.cure == taken_for(key))
    }

    /// Nothing, or all that was wrong.
    pub fn finish(self) -> Result<(), Faults> {
        let mut faults = self.faults.into_inner();
        if self.dropped.get() > 0 {
            faults.push(Fault::new("", "", format!("{} more faults are not shown", self.dropped.get()), "put these right first"));
        }
        if faults.is_empty() { Ok(()) } else { Err(Faults(faults)) }
    }
}

/// Farthest spelling that still counts as near, as a share of the name's length.
const NEAR: f64 = 0.5;

/// Characters of a name that are compared.
const LONGEST: usize = 64;

/// The known name that is meant by one that is misspelt, or called so elsewhere, unless all are far.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let known: Vec<&str> = known.into_iter().collect();
    let near = || nearest_few(name, known.iter().copied(), 1).first().copied();
    synonyms::same(name, known.iter().copied()).or_else(near)
}

/// The known names nearest to a misspelt one, the nearest first, at most `most` of them.
pub fn nearest_few<'a>(name: &str, known: impl IntoIterator<Item = &'a str>, most: usize) -> Vec<&'a str> {
    let plain = |name: &str| name.chars().take(LONGEST).flat_map(char::to_lowercase).collect::<String>();
    let wanted = plain(name);
    let is_near = |&(distance, candidate): &(usize, &str)| {
        let all = wanted.chars().count().max(candidate.chars().count());
        let limit = (NEAR * all as f64) as usize;
        // Names of which no letter is the same have nothing in common.
        distance <= limit.max(1) && distance < all
    };
    let distances = known.into_iter().map(|candidate| (strsim::osa_distance(&wanted, &plain(candidate)), candidate));
    let mut sorted: Vec<(usize, &str)> = distances.collect();
    sorted.sort_by_key(|&(distance, _)| distance);
    sorted.into_iter().take_while(is_near).map(|(_, candidate)| candidate).take(most).collect()
}

/// The cure where a name is taken for a known one.
fn taken_for(near: &str) -> String {
    format!("did you mean `{near}`?")
}

/// A cure from the nearest known name, or from the list of all when none is near and they are few.
pub fn suggest<'a>(name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> String {
    match nearest(name, known.clone()) {
        Some(near) => taken_for(near),
        None => {
            let all: Vec<&str> = known.into_iter().take(25).collect();
            match all.len() {
                0 => "add it first, or remove this".to_string(),
                1..25 => format!("known are: {}", all.join(", ")),
                _ => "name one that is there".to_string(),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn near_names_are_found_and_far_ones_are_not() {
        assert_eq!(nearest("lenght", ["length", "between"]), Some("length"));
        assert_eq!(nearest("m3", ["m1", "other"]), Some("m1"));
        assert_eq!(nearest("stiffness", ["x", "damping"]), None);
        assert_eq!(nearest("anything", []), None);
        assert_eq!(nearest("slider", ["linear", "prismatic"]), Some("prismatic"));
        assert_eq!(nearest("π", ["e", "t"]), None);
        assert_eq!(nearest_few("car.azz", ["t", "car.ax", "car.az", "car.vx", "wheel.az"], 3), ["car.az", "car.ax", "car.vx"]);
    }

    #[test]
    fn only_so_many_faults_are_kept() {
        let sink = Sink::default();
        for _ in 0..MOST + 5 {
            sink.report(|| Fault::new("a", "", "wrong", ""));
        }
        let faults = sink.finish().unwrap_err().0;
        assert_eq!(faults.len(), MOST + 1);
        assert_eq!(faults[MOST].message, "5 more faults are not shown");
    }
}
