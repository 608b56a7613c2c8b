//! What an integrator hands to a formulation: how velocity and acceleration depend on the unknown position, and where
//! forces and rows are evaluated.

/// Where forces and gradients are taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sampling {
    /// At the start of the step, with velocities of the increment.
    Start,
    /// At the end of the step.
    End,
    /// At the point half way.
    Middle,
    /// Between start and end, by discrete gradients.
    Between,
}

/// Which positions must satisfy the rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowsAt {
    /// Φ(q_{n+1}) = 0
    End,
    /// Φ at the point half way.
    Middle,
    /// ½(Φ_n + Φ_{n+1}) = 0, the update (18) as the paper prints it.
    Mean,
}

/// One implicit stage over the increment d = q_{n+1} − q_n of the free coordinates (n):
/// ϖ a = d − drift, and the velocity at which forces are taken is rate·d + offset.
#[derive(Clone, Copy, Debug)]
pub struct Stage {
    /// Where forces and gradients are taken.
    pub sampling: Sampling,
    /// Which positions are put on the rows.
    pub rows: RowsAt,
    /// Time at the start, s.
    pub start: f64,
    /// Step, s.
    pub step: f64,
    /// ϖ, s².
    pub inertia: f64,
    /// ∂v/∂d, 1/s.
    pub rate: f64,
}

impl Stage {
    /// Share of the increment that the position of evaluation moves by.
    pub fn share(&self) -> f64 {
        match self.sampling {
            Sampling::Start => 0.0,
            Sampling::End => 1.0,
            Sampling::Middle | Sampling::Between => 0.5,
        }
    }

    /// Time at which forces are taken, s.
    pub fn time(&self) -> f64 {
        self.start + self.share() * self.step
    }

    /// Time at the end of the step, s.
    pub fn end(&self) -> f64 {
        self.start + self.step
    }
}
