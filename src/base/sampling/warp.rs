//! Maps from the unit square to other domains, each with the density that its comment states.

use crate::math::{Lane, V3};
use glam::{Vec2, Vec3};
use std::f32::consts::{FRAC_PI_4, TAU};

/// Returns a uniform point of the unit disk, by the concentric map (Shirley & Chiu 1997), which keeps strata compact.
#[inline(always)]
pub fn disk_point<L: Lane>([x, y]: [L; 2]) -> [L; 2] {
    let (one, x, y) = (L::from(1.0), x * 2.0 - L::from(1.0), y * 2.0 - L::from(1.0));
    let steep = y.abs().gt(x.abs());
    let (r, s) = (L::pick(steep, y, x), L::pick(steep, x, y));
    let at_centre = !r.abs().is_positive();
    let [sin, cos] = sin_cos_octant(s / L::pick(at_centre, one, r) * FRAC_PI_4);
    [r * L::pick(steep, sin, cos), r * L::pick(steep, cos, sin)]
}

/// Returns sine and cosine of an angle within ±π/4, by Taylor polynomials to a relative error of 1e-7.
///
/// The library's functions would dominate the time of this map.
#[inline(always)]
fn sin_cos_octant<L: Lane>(x: L) -> [L; 2] {
    let x2 = x.sq();
    let series = |factors: [f32; 4]| {
        let mut sum = L::from(factors[0]);
        for factor in &factors[1..] {
            sum = sum.mul_add(x2, L::from(*factor));
        }
        sum.mul_add(x2, L::from(1.0))
    };
    let sin = x * series([1.0 / 362_880.0, -1.0 / 5040.0, 1.0 / 120.0, -1.0 / 6.0]);
    [sin, series([1.0 / 40_320.0, -1.0 / 720.0, 1.0 / 24.0, -0.5])]
}

/// Returns a unit vector around +z with density cosθ/π.
#[inline(always)]
pub fn cosine_direction<L: Lane>(u: [L; 2]) -> V3<L> {
    let [x, y] = disk_point(u);
    // The floor keeps the direction on the open hemisphere.
    V3::new(x, y, (x.sq() + y.sq()).rest().max(L::from(1e-12)).sqrt())
}

/// Returns [`disk_point`] of one point.
#[inline]
pub fn uniform_disk(u: Vec2) -> Vec2 {
    Vec2::from(disk_point(u.to_array()))
}

/// Returns [`cosine_direction`] of one point.
#[inline]
pub fn cosine_hemisphere(u: Vec2) -> Vec3 {
    cosine_direction(u.to_array()).into()
}

/// Returns a unit vector with density 1/4π.
#[inline]
pub fn uniform_sphere(u: Vec2) -> Vec3 {
    let z = 1.0 - 2.0 * u.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    Vec3::new(r * cos, r * sin, z)
}

/// Returns barycentric weights of corners 1 and 2, uniform over a triangle (Heitz 2019, low-distortion map).
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

    #[test]
    fn octant_functions_match_the_library() {
        for i in -1000..=1000 {
            let x = i as f32 / 1000.0 * FRAC_PI_4;
            let [sin, cos] = sin_cos_octant(x);
            let (true_sin, true_cos) = (x as f64).sin_cos();
            assert!((sin as f64 - true_sin).abs() < 1e-7 && (cos as f64 - true_cos).abs() < 1.5e-7, "{x}");
        }
    }

    /// Asserts that the first and second moments equal their integrals.
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
