//! Changes of units and of the frame that a model is seen in, and what becomes of its motion.

/// Rows of a matrix; a planar model uses the first two of each.
pub type Matrix = [[f64; 3]; 3];

pub const SAME: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// What turns body axes over where the world is reflected, so that both stay right-handed.
const OVER: Matrix = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// x' = length · turn x + shift + drift t', with t' = time · t and masses `mass` times as large.
#[derive(Clone, Copy, Debug)]
pub struct Change {
    pub length: f64,
    pub mass: f64,
    pub time: f64,
    /// A rotation, or a reflection.
    pub turn: Matrix,
    pub shift: [f64; 3],
    pub drift: [f64; 3],
}

impl Default for Change {
    fn default() -> Self {
        Self { length: 1.0, mass: 1.0, time: 1.0, turn: SAME, shift: [0.0; 3], drift: [0.0; 3] }
    }
}

impl Change {
    pub fn units(length: f64, mass: f64, time: f64) -> Self {
        Self { length, mass, time, ..Self::default() }
    }

    /// −1 of a reflection.
    pub fn parity(&self) -> f64 {
        let [a, b, c] = self.turn;
        let minor = |k: usize, l: usize| b[k] * c[l] - b[l] * c[k];
        (a[0] * minor(1, 2) - a[1] * minor(0, 2) + a[2] * minor(0, 1)).signum()
    }

    /// What becomes of components in body axes.
    pub fn over(&self) -> Matrix {
        if self.parity() < 0.0 { OVER } else { SAME }
    }

    pub fn turns(&self) -> bool {
        self.turn != SAME
    }

    pub fn factor(&self, [m, kg, s]: [i32; 3]) -> f64 {
        self.length.powi(m) * self.mass.powi(kg) * self.time.powi(s)
    }

    /// A position of the changed model at time t' as it is in the first one.
    pub fn position_back(&self, x: [f64; 3], t: f64) -> [f64; 3] {
        let relative = std::array::from_fn(|c| x[c] - self.shift[c] - self.drift[c] * t);
        apply(&transposed(&self.turn), relative).map(|c| c / self.length)
    }

    pub fn velocity_back(&self, v: [f64; 3]) -> [f64; 3] {
        let relative = std::array::from_fn(|c| v[c] - self.drift[c]);
        apply(&transposed(&self.turn), relative).map(|c| c * self.time / self.length)
    }

    /// From body axes to the world's.
    pub fn orientation_back(&self, matrix: &Matrix) -> Matrix {
        product(&product(&transposed(&self.turn), matrix), &self.over())
    }
}

pub fn apply(matrix: &Matrix, x: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|i| (0..3).map(|j| matrix[i][j] * x[j]).sum())
}

pub fn transposed(matrix: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}

pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// The rotation about an axis (of any length).
pub fn rotation(axis: [f64; 3], angle: f64) -> Matrix {
    let size = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let [x, y, z] = axis.map(|c| c / size);
    let (sin, cos) = angle.sin_cos();
    let one = 1.0 - cos;
    [
        [cos + x * x * one, x * y * one - z * sin, x * z * one + y * sin],
        [y * x * one + z * sin, cos + y * y * one, y * z * one - x * sin],
        [z * x * one - y * sin, z * y * one + x * sin, cos + z * z * one],
    ]
}
