//! Random numbers that follow from a seed, the same on every machine.

use nalgebra::Vector3;

/// The generator splitmix64 (Steele, Lea and Flood, OOPSLA 2014).
pub struct Random(u64);

impl Random {
    /// Neighbouring seeds give numbers that have nothing in common.
    pub fn new(seed: u64) -> Self {
        let mut random = Self(seed);
        Self(random.next())
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 up to but not 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Every decade is as likely as every other.
    pub fn log_between(&mut self, low: f64, high: f64) -> f64 {
        libm::exp(self.between(libm::log(low), libm::log(high)))
    }

    /// True with a probability.
    pub fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// A whole number below `count`.
    pub fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    pub fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// 1 or −1.
    pub fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// A unit vector, in the plane without a third component.
    pub fn direction(&mut self, dim: usize) -> Vector3<f64> {
        loop {
            let z = if dim == 3 { self.between(-1.0, 1.0) } else { 0.0 };
            let v = Vector3::new(self.between(-1.0, 1.0), self.between(-1.0, 1.0), z);
            let size = v.norm();
            if (0.1..=1.0).contains(&size) {
                return v / size;
            }
        }
    }

    /// A unit vector at right angles to another one, in space.
    pub fn across(&mut self, u: &Vector3<f64>) -> Vector3<f64> {
        loop {
            let v = self.direction(3).cross(u);
            if v.norm() > 0.1 {
                return v.normalize();
            }
        }
    }

    /// A unit quaternion, its real part first; every rotation is as likely as every other (Shoemake 1992).
    pub fn quaternion(&mut self) -> [f64; 4] {
        let (u, v) = (self.direction(2), self.direction(2));
        let share = self.unit();
        let (a, b) = (share.sqrt(), (1.0 - share).sqrt());
        [a * u[0], a * u[1], b * v[0], b * v[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seed_gives_its_numbers_within_their_bounds() {
        let mut random = Random::new(7);
        assert_eq!(random.next(), Random::new(7).next());
        assert!((0..1000).all(|_| (1e-3..1e3).contains(&random.log_between(1e-3, 1e3)) && random.below(3) < 3));
        let u = random.direction(3);
        assert!((u.norm() - 1.0).abs() < 1e-15 && random.across(&u).dot(&u).abs() < 1e-15);
        assert_eq!(random.direction(2)[2], 0.0);
    }
}
