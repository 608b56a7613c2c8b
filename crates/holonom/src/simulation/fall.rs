//! How a mechanism on a ridge falls: along which move, and in steps about as long as that takes.

/// By how much forces drive a mechanism on in a step of a fall that is about as long as the fall takes, over what it is off by then: what is longer ends
/// beyond the ridge. And by which share of it a step takes it on that becomes longer.
const OWN: f64 = 0.5;
const SLOW: f64 = 0.4;

/// How a mechanism may leave where it is at rest.
pub(crate) struct Fall {
    /// A small move (full) along which it may fall.
    pub push: Vec<f64>,
    /// The length of a step in which forces drive it on by half of what it is off by then, or by less, s. `None` where it is not known that they do.
    pub time: Option<f64>,
}

impl Fall {
    /// A fall whose forces drive it on in a step of length h by so many times what it is off by then.
    pub fn new(push: Vec<f64>, on: f64, h: f64) -> Self {
        Self { push, time: Some((OWN / on).sqrt() * h) }
    }
}

/// Steps from beside a ridge, as long as each takes a mechanism farther than the one before.
pub(super) struct Falling {
    /// Length of the first one, s.
    pub step: f64,
    before: f64,
    /// By how much the last step was longer than the one before.
    growth: f64,
    /// Whether one did that was no longer.
    pub is_seen: bool,
    is_over: bool,
}

impl Falling {
    pub fn new(step: f64) -> Self {
        Self { step, before: 0.0, growth: f64::INFINITY, is_seen: false, is_over: false }
    }

    /// By how much the next step is longer than one that went so far, to where it is off by that. `None` when the fall is over.
    pub fn growth(&mut self, way: f64, off: f64) -> Option<f64> {
        self.is_over |= way <= self.before;
        self.is_seen |= !self.is_over && self.growth == 1.0;
        self.before = way;
        self.growth = if way < SLOW * off { std::f64::consts::SQRT_2 } else { 1.0 };
        (!self.is_over).then_some(self.growth)
    }
}
