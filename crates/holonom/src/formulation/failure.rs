//! Why a step was not taken.

use crate::system::{Cornered, System};

/// What to write in place of a force that jumps with what it moves.
pub(crate) const SMOOTH: &str = "friction that holds is a force of type \"friction\", or a formula with tanh(x/small) in place of sign(x)";

/// Why a step was not taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Failure {
    /// Newton's iteration ended without an answer.
    NotConverged {
        /// How many there were.
        iterations: usize,
        /// The last increment, over the size of the mechanism.
        increment: f64,
    },
    /// The matrix of the step has no inverse, or none with finite numbers: the unknown whose pivot is none.
    Singular(Unknown),
    /// Positions, velocities, forces or derivatives of these that are not finite.
    NotFinite,
    /// No step is short enough for the accuracy.
    TooSmall,
    /// No step is short enough for the accuracy, as a force jumps to and fro.
    JumpsBack {
        /// Which of the numbers that go through zero at corners of forces.
        corner: usize,
    },
    /// Steps for the accuracy are so short that the run would hardly ever end.
    Crawling {
        /// What each comes on by, s.
        pace: f64,
        /// How many the rest of the run would take.
        left: f64,
    },
    /// Near singular positions round-off hid errors of steps that have changed the energy by more than the accuracy leaves.
    Hidden {
        /// Of all energy there was to move.
        share: f64,
    },
    /// A step whose result misses what the method promises.
    Broken {
        /// What is promised, in words.
        promise: &'static str,
        /// By how much it is missed, J or the unit of the row.
        by: f64,
        /// By how much it may be, as round-off explains that much, in the same unit.
        bound: f64,
        /// The row that misses it; `None` where it is the energy.
        row: Option<usize>,
    },
    /// Energy that nothing supplied is several times all there was to move: the error of the method is all that is left.
    Unsupplied {
        /// What there is more than at the start and all work that was put in, J.
        excess: f64,
        /// All there was to move, J.
        supply: f64,
    },
    /// Energy that nothing took and no damping of the method either is most of what there was to move.
    Vanished {
        /// What is missing, J.
        lost: f64,
        /// All there was to move, J.
        supply: f64,
    },
    /// Steps are too long for a strong damper, which turns a motion round in each of them instead of ending it.
    Ringing {
        /// Which of the system's laws.
        law: usize,
        /// What dampers would take in the step of the motion that was turned round, J.
        taken: f64,
        /// All there was to move, J.
        supply: f64,
    },
    /// Steps are too long for what a strong damper holds back: what moves on in one of them drives a spring, with energy that was not there.
    Driving {
        /// Which of the system's laws.
        law: usize,
        /// What dampers would make in the step, J.
        made: f64,
        /// All there was to move, J.
        supply: f64,
    },
    /// A composition goes back in time through a damper that is too strong for that.
    GoesBack {
        /// Which of the system's laws.
        law: usize,
    },
    /// A row or a law has a corner that the step goes across, where no motion goes on smoothly.
    Corner {
        /// Which it is.
        of: Cornered,
        /// What happens there, in words.
        what: &'static str,
    },
    /// A recorded angle turns so far in a step that its turns are not counted for sure.
    Turned {
        /// Which of the system's gauges.
        gauge: usize,
        /// How far it turns, rad.
        by: f64,
    },
    /// A number that an event sets an input to has no value.
    NoSetting {
        /// Which of the system's events.
        event: usize,
    },
    /// An event happens again and again at one time.
    Chattering {
        /// Which of the system's events.
        event: usize,
    },
    /// The condition of an event has no value, so that nobody knows whether it holds.
    NoIndicator {
        /// Which of the system's events.
        event: usize,
    },
}

/// An unknown of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// The multiplier of a row.
    Row(usize),
    /// A coordinate of a node.
    Node(usize),
}

impl Failure {
    /// What happened, in words.
    pub fn describe(&self, system: &System) -> String {
        match *self {
            Self::NotConverged { iterations, increment } if increment.is_finite() => {
                format!(
                    "the iteration did not converge: after {iterations} iterations increments are {increment:.1e} of the mechanism's size"
                )
            }
            Self::NotConverged { iterations, .. } => format!("the iteration did not converge in {iterations} iterations"),
            Self::Singular(Unknown::Row(row)) => {
                format!("the matrix of the step is singular at the row `{}`: nothing there resists it", system.row_names()[row])
            }
            Self::Singular(Unknown::Node(node)) => {
                let row = system.slots.rows.iter().position(|row| system.slots.nodes[row.clone()].contains(&(node as u32)));
                let place = row.map_or(format!("node {node}"), |row| format!("a node of `{}`", system.row_names()[row]));
                format!("the matrix of the step is singular at {place}: it has no mass and nothing holds it")
            }
            Self::NotFinite => {
                "positions, velocities, forces or their derivatives are not finite (a formula may be outside its domain, or a table outside its range)".into()
            }
            Self::Broken { promise, by, bound, row } => {
                let of = row.map_or(String::new(), |row| format!(" of `{}`", system.row_names()[row]));
                let [by, bound] = told_apart(by, bound);
                format!("the step breaks a promise of the method: {promise}{of} is off by {by}, where round-off explains {bound}")
            }
            Self::Unsupplied { excess, supply } => format!(
                "{excess:.1e} J of energy came from nothing where {supply:.1e} J could move (shorter steps help, or a method that keeps the energy)"
            ),
            Self::Vanished { lost, supply } => format!(
                "{lost:.1e} J of the {supply:.1e} J of energy that could move went nowhere (a method that keeps the energy helps, and one that holds positions)"
            ),
            Self::Ringing { law, taken, supply } => format!(
                "the step turns round what `{}` brakes, which would take {taken:.1e} J of the {supply:.1e} J that could move: it is too long for a damper so strong (shorter steps help, or conserving-ggl and radau, where dampers do not ring)",
                system.laws[law].name
            ),
            Self::Driving { law, made, supply } => format!(
                "what `{}` brakes goes so far in the step that it would have {made:.1e} J from it, where {supply:.1e} J could move: the step is too long for a damper so strong (shorter steps help, or radau)",
                system.laws[law].name
            ),
            Self::GoesBack { law } => format!(
                "the method goes back in time in parts of its step, and `{}` is too strong a damper for that (shorter steps help, or conserving-ggl and radau, which only go ahead)",
                system.laws[law].name
            ),
            Self::Corner { of, what } => format!("at `{}` {what}", system.cornered(of)),
            Self::Turned { gauge, by } => {
                format!("`{}` turns by {by:.2} rad in a step, too far for turns to be counted: give a shorter step", system.gauges()[gauge])
            }
            Self::NoIndicator { event } => format!(
                "what the event `{}` waits for has no value there: a formula is outside its domain, or a table outside its range",
                system.events[event].name
            ),
            Self::Chattering { event } => format!(
                "the event `{}` happens again and again at the same time: what it sets makes its condition turn round at once (give the conditions some distance, as a switch has)",
                system.events[event].name
            ),
            Self::NoSetting { event } => format!(
                "what the event `{}` sets an input to has no value there: a formula is outside its domain, or a table outside its range",
                system.events[event].name
            ),
            Self::TooSmall => "no step is short enough for the accuracy".into(),
            Self::JumpsBack { corner } => format!(
                "no step is short enough for the accuracy, as the force of `{}` jumps to and fro with what it moves ({SMOOTH})",
                system.cornering_force(corner)
            ),
            Self::Hidden { share } => format!(
                "no step is good enough for the accuracy: near a singular position, where rows hardly differ from others, round-off hides the errors of steps, and these have changed the energy by {share:.0e} of what could move (ask for less, or take radau)"
            ),
            Self::Crawling { pace, left } => format!(
                "the accuracy asks for steps of {pace:.1e} s, of which the rest of the run would take {left:.0e}: ask for less, or end the run sooner"
            ),
        }
    }
}

/// Two numbers for people, with the digits that tell them apart: two at least.
fn told_apart(a: f64, b: f64) -> [String; 2] {
    let told = |digits: usize| [a, b].map(|number| format!("{number:.digits$e}"));
    (1..f64::DIGITS as usize).map(told).find(|[a, b]| a != b).unwrap_or_else(|| told(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Place, SystemBuilder};

    #[test]
    fn a_node_has_the_name_of_a_row_that_it_is_in() {
        let mut builder = SystemBuilder::new(2, [0.0; 3]);
        let [alone, held] = [0.0, 1.0].map(|x| builder.free_node([x, 0.0, 0.0], [0.0; 3]));
        let square = builder.square(&[(Place::Node(held), 1.0)]);
        builder.constant_row("rod", square, 0.5);
        let system = builder.build();
        for (node, place) in [(alone, "at node 0:"), (held, "at a node of `rod`:")] {
            let what = Failure::Singular(Unknown::Node(node.index())).describe(&system);
            assert!(what.contains(place), "{what}");
        }
    }

    #[test]
    fn what_is_off_is_told_from_what_round_off_explains() {
        assert_eq!(told_apart(2.41e-5, 1.1e-7), ["2.4e-5", "1.1e-7"]);
        assert_eq!(told_apart(2.412e-5, 2.398e-5), ["2.41e-5", "2.40e-5"]);
        assert_eq!(told_apart(2.4123e-5, 2.4119e-5), ["2.4123e-5", "2.4119e-5"]);
        assert_eq!(told_apart(1.0, 1.0), ["1.0e0", "1.0e0"]);
    }
}
