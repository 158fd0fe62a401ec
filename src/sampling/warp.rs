//! Maps from the unit square to the domains that are sampled, all area-preserving up to the stated density.

use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_4, TAU};

/// Unit disk, uniform, by concentric squares (Shirley & Chiu 1997), which keeps strata compact.
#[inline]
pub fn uniform_disk(u: Vec2) -> Vec2 {
    let p = 2.0 * u - Vec2::ONE;
    if p == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (r, phi) = if p.x.abs() > p.y.abs() {
        (p.x, FRAC_PI_4 * (p.y / p.x))
    } else {
        (p.y, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (p.x / p.y))
    };
    let (sin, cos) = phi.sin_cos();
    Vec2::new(r * cos, r * sin)
}

/// Unit vectors about +z with density cosθ/π.
#[inline]
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    let d = uniform_disk(u);
    d.extend((1.0 - d.length_squared()).max(0.0).sqrt())
}

/// Unit vectors with density 1/4π.
#[inline]
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    Vec3::new(r * cos, r * sin, z)
}

/// Barycentric weights of corners 1 and 2, uniform over a triangle (Heitz 2019, a low-distortion map).
#[inline]
pub fn uniform_triangle(u: Vec2) -> Vec2 {
    if u.y > u.x {
        let b1 = 0.5 * u.x;
        Vec2::new(b1, u.y - b1)
    } else {
        let b2 = 0.5 * u.y;
        Vec2::new(u.x - b2, b2)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::owen_sobol_2d;

    /// First and second moments against their integrals.
    #[test]
    fn moments_match() {
        let n = 1 << 16;
        let points = |i| owen_sobol_2d(i, 7);
        let mean = |f: &dyn Fn(Vec2) -> f64| (0..n).map(|i| f(points(i))).sum::<f64>() / n as f64;
        assert!((mean(&|u| uniform_disk(u).length_squared() as f64) - 0.5).abs() < 1e-3);
        assert!((mean(&|u| cosine_hemisphere(u).z as f64) - 2.0 / 3.0).abs() < 1e-3);
        assert!((mean(&|u| (uniform_sphere(u).z as f64).powi(2)) - 1.0 / 3.0).abs() < 1e-3);
        assert!((mean(&|u| uniform_sphere(u).x as f64)).abs() < 1e-3);
        assert!((mean(&|u| uniform_triangle(u).x as f64) - 1.0 / 3.0).abs() < 1e-3);
        assert!((mean(&|u| (uniform_triangle(u).y as f64).powi(2)) - 1.0 / 6.0).abs() < 1e-3);
    }
}
