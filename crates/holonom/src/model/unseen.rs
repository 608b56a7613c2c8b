//! What equal steps do not see of forces and motions that are formulas or tables of time: what happens within a step, and what is nearly the same in
//! every step, as 100 Hz are in steps of 0.01 s.

use smallvec::SmallVec;

use super::bodies::short;
use super::expression::{Program, TimeProgram};
use super::spline::Spline;
use super::{Model, knocks};
use crate::simulation::Method;
use crate::system::zeros;

/// Most steps that are looked at, evenly over the run, and as many of those in which something jumps or has a peak.
const MOST_STEPS: usize = 2000;

/// The same of all functions together, and fewest of each where there are very many.
const ALL_STEPS: usize = 100_000;
const FEWEST_STEPS: usize = 20;

/// Most places in a step of which its mean is found; those that any step has, and how many more there are for each on average: what is too fast for
/// steps of any length would want all of them in every step, and a start would take long.
const MOST_PLACES: usize = 256;
const PLACES_OF_EACH: usize = 32;
const MORE_PLACES: usize = 50;

/// To this share of how far a function goes in a step its mean is told.
const MEAN: f64 = 1e-4;

/// To this share of how far a function goes in the run its mean over a step is found: few places do where it is nearly straight.
const LOOK: f64 = 1e-3;

/// Where a step is divided first: not evenly, so that nothing has the same period.
const DIVISIONS: [f64; 6] = [0.0, 0.137, 0.382, 0.55, 0.791, 1.0];

/// Places in a step that are not put on the heap.
const PLACES: usize = 8;

/// Share of how far a function goes in the run that the mean over a step may be missed by.
const MISSED: f64 = 0.1;

/// How far a function goes over its largest value that is round-off.
const ROUNDED: f64 = 1e-9;

/// What is missed over the largest value that need not be told: in a run of a step or two a function does not go far, and any share of that is less.
const NOTHING: f64 = 1e-5;

/// How far a function goes in the run times this is told as zero.
const SMALL: f64 = 1e-3;

/// Steps at whose beginnings it is seen how far a function goes at least.
const SAMPLES: usize = 16;

/// Switches of a formula from which on their zeros are not looked for one by one.
const MANY_SWITCHES: usize = 20;

/// Shares of the step that may see what it does not.
const FINER: [f64; 9] = [0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 5e-3, 2e-3, 1e-3];

/// Most that are named.
const MOST_NAMED: usize = 5;

/// A part of a force or of a motion that follows from time alone.
#[derive(Clone, Debug)]
pub(crate) struct OverTime {
    /// Where it is in the description.
    pub path: String,
    pub course: Course,
    /// Whether it is a motion, of which steps see where it is at their ends.
    pub is_motion: bool,
}

/// How it is told.
#[derive(Clone, Debug)]
pub(crate) enum Course {
    Formula(Program),
    Table(Spline),
}

impl Course {
    fn at(&self, t: f64) -> f64 {
        match self {
            Self::Formula(program) => program.evaluate(&[t]),
            Self::Table(spline) => spline.evaluate(t),
        }
    }

    /// The times before `end` (s) at which it jumps, or has a kink or a short peak, as far as they are known; in order.
    fn bends(&self, end: f64) -> Vec<f64> {
        let mut times = match self {
            Self::Table(spline) => spline.knots().to_vec(),
            Self::Formula(program) => {
                let switches = program.switches(0);
                let has_many = |switch: &Program| switch.even_zeros().is_none_or(|zeros| zeros.apart.is_finite());
                let are_many = switches.iter().filter(|switch| has_many(switch)).count() > MANY_SWITCHES;
                let zeros = |switch: Program| {
                    if are_many && has_many(&switch) { Vec::new() } else { zeros(&TimeProgram(switch), end) }
                };
                let peaks = if knocks::may_have(program) { knocks::times(program, end) } else { Vec::new() };
                switches.into_iter().flat_map(zeros).chain(peaks).collect()
            }
        };
        times.retain(|t| *t > 0.0 && *t < end);
        times.sort_by(f64::total_cmp);
        times
    }
}

/// A step as it is: the function at its ends, its mean, and what a method takes for that.
#[derive(Clone, Copy)]
struct Seen {
    number: usize,
    ends: [f64; 2],
    mean: f64,
    taken: f64,
    /// Places of which its mean was found, but for the first few.
    places: usize,
}

/// A step, or two, of which the method takes something else than there is.
struct Missed {
    /// Where it begins and ends, s.
    times: [f64; 2],
    mean: f64,
    taken: f64,
}

impl Model {
    /// What a method with equal steps of length `step` (s) up to `end` (s) does not see of forces and motions over time, with the step that would.
    pub fn unseen(&self, method: &Method, step: f64, end: f64) -> Vec<String> {
        if method.accuracy.is_some() {
            return Vec::new();
        }
        let looks = (method.integrator.looks)(&method.parameters);
        let most = (ALL_STEPS / self.over_time.len().max(1)).clamp(FEWEST_STEPS, MOST_STEPS);
        let note = |part: &OverTime| {
            // Rows hold at the ends of steps, and at what stages there are.
            let ends = [[0.0, 0.5], [1.0, 0.5]];
            let looks = if part.is_motion && looks.len() == 1 { &ends[..] } else { &looks[..] };
            let bends = part.course.bends(end);
            let missed = first_missed(&part.course, &bends, looks, most, [step, end])?;
            let is_seen = |step: &f64| first_missed(&part.course, &bends, looks, most, [*step, end]).is_none();
            let finer = FINER.map(|share| share * step);
            let finest = finer.last().filter(|finest| is_seen(finest));
            let cure = match finest.and_then(|_| finer.into_iter().find(is_seen)) {
                Some(step) => format!("a step of {} s sees it, and so do steps by accuracy", short(step)),
                None => "steps by accuracy end where it changes".into(),
            };
            let Missed { times: [from, to], mean, taken } = missed;
            Some(format!(
                "{}: steps of {} s do not see what this does within them: from {} s to {} s its mean is {} and is taken to be {} ({cure})",
                part.path,
                short(step),
                short(from),
                short(to),
                short(mean),
                short(taken)
            ))
        };
        let mut notes: Vec<String> = Vec::new();
        for part in &self.over_time {
            let is_new = notes.iter().all(|known| !known.starts_with(&format!("{}:", part.path)));
            if notes.len() < MOST_NAMED && is_new {
                notes.extend(note(part));
            }
        }
        notes
    }
}

/// The first of at most so many steps, and of as many that bend, whose mean is missed by more than a jump between its ends would explain.
fn first_missed(course: &Course, bends: &[f64], looks: &[[f64; 2]], most: usize, [step, end]: [f64; 2]) -> Option<Missed> {
    let count = (end / step * (1.0 - ROUNDED)).ceil().max(1.0) as usize;
    let spread = |all: usize| (0..most.min(all)).map(move |k| (k as f64 * all as f64 / most.min(all) as f64) as usize);
    let mut numbers: Vec<usize> = Vec::new();
    if count <= most {
        numbers.extend(0..count);
    } else {
        let bending = spread(bends.len()).map(|k| (bends[k] / step) as usize);
        numbers.extend(spread(count).chain(bending).flat_map(|k| [k.saturating_sub(1), k, k + 1]).filter(|k| *k < count));
        numbers.sort_unstable();
        numbers.dedup();
    }
    // How far it goes beside the straight line through its ends: a motion may go on for ever.
    let [begin, last] = [0.0, end].map(|t| course.at(t));
    let slope = (last - begin) / end;
    let beside = |t: f64, value: f64| (value - begin - slope * t).abs();
    if is_nearly_straight(course, looks, &numbers, [step, end], beside) {
        return None;
    }
    let far = |seen: &Seen| {
        let [from, to] = Seen::times(seen.number, step);
        beside(from, seen.ends[0]).max(beside(to, seen.ends[1])).max(beside(0.5 * (from + to), seen.mean))
    };
    let (mut reach, mut more) = (0.0_f64, MORE_PLACES * numbers.len());
    let mut steps: Vec<Seen> = Vec::with_capacity(numbers.len());
    for number in numbers {
        let places = MOST_PLACES.min(PLACES_OF_EACH + more);
        let seen = Seen::of(course, bends, looks, step, number, (LOOK * reach, places), steps.last());
        more -= seen.places.saturating_sub(PLACES_OF_EACH).min(more);
        let far = far(&seen);
        reach = if far.is_finite() { reach.max(far) } else { reach };
        steps.push(seen);
    }
    let largest = steps.iter().map(|seen| seen.mean.abs()).filter(|mean| mean.is_finite()).fold(0.0, f64::max);
    if reach <= ROUNDED * largest {
        return None;
    }
    // A method that looks at one end alone takes the line itself for that of another time.
    let late = looks.iter().map(|[share, weight]| weight * (share - 0.5)).sum::<f64>() * step;
    let is_missed = |seen: &Seen, length: f64| {
        let jump = seen.ends[1] - seen.ends[0] - slope * length;
        (seen.taken - seen.mean - slope * late).abs() - jump.abs() > (MISSED * reach).max(NOTHING * largest)
    };
    let alone = steps.iter().copied().find(|seen| is_missed(seen, step)).map(|seen| (seen, step));
    // What happens beside the end of a step is seen by both or by none.
    let pairs = || steps.windows(2).filter(|pair| pair[1].number == pair[0].number + 1).map(|pair| pair[0].joined(&pair[1]));
    let (seen, length) = alone.or_else(|| pairs().find(|seen| is_missed(seen, 2.0 * step)).map(|seen| (seen, 2.0 * step)))?;
    let exactly = |number| Seen::of(course, bends, looks, step, number, (0.0, MOST_PLACES), None);
    let told = if length > step { exactly(seen.number).joined(&exactly(seen.number + 1)) } else { exactly(seen.number) };
    let begin = seen.number as f64 * step;
    let known = |value: f64| if value.abs() < SMALL * reach { 0.0 } else { value };
    Some(Missed { times: [begin, begin + length], mean: known(told.mean), taken: known(told.taken) })
}

/// Whether a function is so near to a straight line in every step that none is missed. With f'' of no more than B its mean over a step of length h,
/// and what a method takes for that, are off by less than h²B/3 together beside what the difference of the ends explains.
fn is_nearly_straight(
    course: &Course,
    looks: &[[f64; 2]],
    numbers: &[usize],
    [step, end]: [f64; 2],
    beside: impl Fn(f64, f64) -> f64,
) -> bool {
    let Course::Formula(program) = course else { return false };
    let Some(bend) = program.largest_bend(end + step) else { return false };
    let is_mean = looks.iter().all(|[share, weight]| (0.0..=1.0).contains(share) && *weight >= 0.0);
    let begins = (0..SAMPLES).map(|k| numbers[k * numbers.len() / SAMPLES] as f64 * step);
    let reach = begins.map(|t| beside(t, course.at(t))).fold(0.0, f64::max);
    is_mean && bend * step * step <= MISSED * reach
}

impl Seen {
    /// This step and the next as one.
    fn joined(&self, next: &Self) -> Self {
        let both = |of: fn(&Self) -> f64| 0.5 * (of(self) + of(next));
        let (mean, taken) = (both(|seen| seen.mean), both(|seen| seen.taken));
        Self { ends: [self.ends[0], next.ends[1]], mean, taken, ..*self }
    }

    /// When a step of this number begins and ends, s.
    fn times(number: usize, step: f64) -> [f64; 2] {
        [number, number + 1].map(|k| k as f64 * step)
    }

    /// A step, with its mean as near as `near`, or as the share `MEAN` of how far the function goes in it, as far as that takes no more than `allowed`
    /// places; `last` is the step seen last.
    fn of(
        course: &Course,
        bends: &[f64],
        looks: &[[f64; 2]],
        step: f64,
        number: usize,
        (near, allowed): (f64, usize),
        last: Option<&Self>,
    ) -> Self {
        let [from, to] = Self::times(number, step);
        let known = last.filter(|last| last.number + 1 == number).map(|last| last.ends[1]);
        let inside = &bends[bends.partition_point(|t| *t <= from)..bends.partition_point(|t| *t < to)];
        let mut places: SmallVec<[f64; PLACES]> =
            DIVISIONS.iter().map(|share| from + share * (to - from)).chain(inside.iter().copied()).collect();
        places.sort_by(f64::total_cmp);
        places.dedup();
        let first = known.unwrap_or_else(|| course.at(places[0]));
        let values: SmallVec<[f64; PLACES]> = std::iter::once(first).chain(places[1..].iter().map(|t| course.at(*t))).collect();
        let pairs = places.windows(2).zip(values.windows(2));
        let pieces: SmallVec<[Piece; PLACES]> =
            pairs.map(|(ends, values)| Piece::new(course, [ends[0], ends[1]], [values[0], values[1]])).collect();
        // What jumps at an end has one value there.
        let ends = [values[0], values[values.len() - 1]];
        let at = |share: f64| match share {
            0.0 => ends[0],
            1.0 => ends[1],
            _ => course.at(from + share * step),
        };
        let taken = looks.iter().map(|[share, weight]| weight * at(*share)).sum();
        let values = pieces.iter().flat_map(|piece| piece.values);
        let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        let width = near.max(MEAN * (most - least)) * (to - from);
        let mut left = allowed;
        let integral: f64 = pieces.iter().map(|piece| piece.integral(course, width, &mut left)).sum();
        Self { number, ends, mean: integral / (to - from), taken, places: allowed - left }
    }
}

/// A part of a step, with the values at its ends and in its middle.
struct Piece {
    ends: [f64; 2],
    values: [f64; 3],
}

impl Piece {
    fn new(course: &Course, ends: [f64; 2], values: [f64; 2]) -> Self {
        Self { ends, values: [values[0], course.at(0.5 * (ends[0] + ends[1])), values[1]] }
    }

    /// By Simpson's rule.
    fn rule(&self) -> f64 {
        (self.ends[1] - self.ends[0]) / 6.0 * (self.values[0] + 4.0 * self.values[1] + self.values[2])
    }

    /// The same on halves until both are as near as `width`, at no more than as many places as are `left`; as it is where a straight line would do.
    fn integral(&self, course: &Course, width: f64, left: &mut usize) -> f64 {
        let ([begin, end], [first, middle, last]) = (self.ends, self.values);
        if (0.5 * (end - begin) * (first + last) - self.rule()).abs() <= width {
            return self.rule();
        }
        let half = 0.5 * (begin + end);
        let [early, late] = [0.5 * (begin + half), 0.5 * (half + end)].map(|t| course.at(t));
        let halves =
            [Self { ends: [begin, half], values: [first, early, middle] }, Self { ends: [half, end], values: [middle, late, last] }];
        let found = halves[0].rule() + halves[1].rule();
        *left = left.saturating_sub(2);
        if *left > 0 && (found - self.rule()).abs() > width {
            return halves.iter().map(|half| half.integral(course, width, left)).sum();
        }
        found
    }
}
