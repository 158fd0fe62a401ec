//! Tests of the module, by their reference.

mod basis;
mod projection;
mod radiance;

use glam::DVec3;
use std::f64::consts::TAU;

/// A small deterministic generator, enough for tests.
struct Random(u64);

impl Random {
    /// Uniform in [0, 1).
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let x = ((self.0 >> 18) ^ self.0) >> 27;
        (x.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform over the hemisphere.
    fn hemisphere(&mut self) -> DVec3 {
        let (z, (sin, cos)) = (self.next(), (TAU * self.next()).sin_cos());
        let r = (1.0 - z * z).sqrt();
        DVec3::new(r * cos, r * sin, z)
    }
}
