//! What acts on invariants (laws) and on nodes directly (loads).

/// Most invariants that one law may depend on.
pub const MAX_ARGUMENTS: usize = 6;

/// Generalised forces f (m) of a law, conjugate to its invariants: the force on the nodes is −Σ f_i ∇π_i.
#[derive(Clone, Debug, Default)]
pub struct Response {
    /// f_i
    pub force: [f64; MAX_ARGUMENTS],
    /// ∂f_i/∂π_j, at the end of the step for [`Law::between`].
    pub by_value: [[f64; MAX_ARGUMENTS]; MAX_ARGUMENTS],
    /// ∂f_i/∂π̇_j
    pub by_rate: [[f64; MAX_ARGUMENTS]; MAX_ARGUMENTS],
}

/// Two positions and the step from one to the other.
#[derive(Clone, Copy, Debug)]
pub struct Reach<'a> {
    /// Invariants at the start of the step (m).
    pub from: &'a [f64],
    /// Invariants at the end of the step (m).
    pub to: &'a [f64],
    /// Step, s.
    pub step: f64,
    /// Time at the middle of the step, s.
    pub middle: f64,
}

/// A number that tells where a force bends.
#[derive(Clone, Copy, Debug)]
pub enum Bend {
    /// Goes through zero where the force jumps or has a kink, as that of a stop at its limit.
    Corner(f64),
    /// Has a maximum where a factor of the force has a peak, which may be narrow: its logarithm, but for a constant.
    Peak(f64),
}

/// A potential V(π) or a dissipative force f(π, π̇, t) of at most [`MAX_ARGUMENTS`] invariants.
pub trait Law: Send + Sync {
    /// V(π), J. Laws without energy leave this at zero; what they do is booked as work.
    fn energy(&self, _value: &[f64]) -> f64 {
        0.0
    }

    /// Whether [`Law::energy`] accounts for all the law does.
    fn conservative(&self) -> bool;

    /// Whether it may give energy as well as take it, as a formula may.
    fn may_supply(&self) -> bool {
        false
    }

    /// Hands over where the force bends: steps by accuracy end there. It is as much at every state.
    fn bends(&self, _value: &[f64], _rate: &[f64], _t: f64, _note: &mut dyn FnMut(Bend)) {}

    /// Forces and derivatives at a state. `out` arrives zeroed.
    fn at(&self, value: &[f64], rate: &[f64], t: f64, out: &mut Response);

    /// Forces and derivatives between two positions: the discrete gradient, with f·Δπ = ΔV for a potential
    /// (methods §5) and f·Δπ equal to the energy taken out for a dissipative force. Only `by_value` is read, as the
    /// derivative by the value at the end. `out` arrives zeroed.
    fn between(&self, reach: Reach<'_>, out: &mut Response);
}

/// A force on nodes given directly, booked as work.
pub trait Load: Send + Sync {
    /// Writes the force on each of the load's nodes (D × nodes), N, for their positions `x`, velocities `v` and time. It arrives zeroed.
    fn force(&self, x: &[f64], v: &[f64], t: f64, force: &mut [f64]);

    /// Hands over where the force bends, as [`Law::bends`] does.
    fn bends(&self, _x: &[f64], _v: &[f64], _t: f64, _note: &mut dyn FnMut(Bend)) {}

    /// Writes ∂F/∂x and ∂F/∂v, both row-major (D·nodes × D·nodes). Both arrive zeroed.
    fn tangent(&self, x: &[f64], v: &[f64], t: f64, by_position: &mut [f64], by_velocity: &mut [f64]);
}
