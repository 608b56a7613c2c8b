//! Numbers with their first and second derivatives by time: from a position in closed form, its velocity and acceleration.

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A function of time, its rate and its second derivative.
#[derive(Clone, Copy, Debug)]
pub struct Jet(pub f64, pub f64, pub f64);

impl Jet {
    pub fn constant(value: f64) -> Jet {
        Jet(value, 0.0, 0.0)
    }

    /// f of it, with f', f'' at its value.
    fn through(self, f: f64, slope: f64, bend: f64) -> Jet {
        Jet(f, slope * self.1, bend * self.1 * self.1 + slope * self.2)
    }

    pub fn sin(self) -> Jet {
        self.through(self.0.sin(), self.0.cos(), -self.0.sin())
    }

    pub fn cos(self) -> Jet {
        self.through(self.0.cos(), -self.0.sin(), -self.0.cos())
    }

    pub fn sqrt(self) -> Jet {
        let root = self.0.sqrt();
        self.through(root, 0.5 / root, -0.25 / (root * self.0))
    }

    pub fn acos(self) -> Jet {
        let across = (1.0 - self.0 * self.0).sqrt();
        self.through(self.0.acos(), -1.0 / across, -self.0 / across.powi(3))
    }

    /// Direction of (x, y), from −π to π.
    pub fn atan2(y: Jet, x: Jet) -> Jet {
        let square = x.0 * x.0 + y.0 * y.0;
        let rate = (x.0 * y.1 - y.0 * x.1) / square;
        let second = (x.0 * y.2 - y.0 * x.2) / square - 2.0 * rate * (x.0 * x.1 + y.0 * y.1) / square;
        Jet(y.0.atan2(x.0), rate, second)
    }
}

impl Neg for Jet {
    type Output = Jet;
    fn neg(self) -> Jet {
        Jet(-self.0, -self.1, -self.2)
    }
}

impl Add for Jet {
    type Output = Jet;
    fn add(self, other: Jet) -> Jet {
        Jet(self.0 + other.0, self.1 + other.1, self.2 + other.2)
    }
}

impl Sub for Jet {
    type Output = Jet;
    fn sub(self, other: Jet) -> Jet {
        self + -other
    }
}

impl Mul for Jet {
    type Output = Jet;
    fn mul(self, other: Jet) -> Jet {
        Jet(self.0 * other.0, self.1 * other.0 + self.0 * other.1, self.2 * other.0 + 2.0 * self.1 * other.1 + self.0 * other.2)
    }
}

impl Mul<f64> for Jet {
    type Output = Jet;
    fn mul(self, factor: f64) -> Jet {
        self * Jet::constant(factor)
    }
}

impl Add<f64> for Jet {
    type Output = Jet;
    fn add(self, other: f64) -> Jet {
        self + Jet::constant(other)
    }
}

impl Div for Jet {
    type Output = Jet;
    fn div(self, other: Jet) -> Jet {
        let inverse = 1.0 / other.0;
        self * other.through(inverse, -inverse * inverse, 2.0 * inverse.powi(3))
    }
}

/// A rigid body in the plane.
pub struct Plate {
    pub mass: f64,
    pub inertia: f64,
    /// Its centre of mass and its angle.
    pub place: [Jet; 2],
    pub angle: Jet,
}

impl Plate {
    /// What it takes to move it so in this gravity, W: d'Alembert.
    pub fn power(&self, gravity: [f64; 2]) -> f64 {
        self.work(self, gravity)
    }

    /// Virtual work, J/unit, of what it takes to move it so, along the way that it goes at the rates of `way`.
    pub fn work(&self, way: &Plate, gravity: [f64; 2]) -> f64 {
        let along = |k: usize| (self.place[k].2 - gravity[k]) * way.place[k].1;
        self.mass * (along(0) + along(1)) + self.inertia * self.angle.2 * way.angle.1
    }
}
