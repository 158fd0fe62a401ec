//! Smooth curves through given points, for turned profiles and bent things.

use glam::{Vec2, Vec3};
use std::ops::{Add, Mul, Sub};

/// Uniform Catmull-Rom curve through `points` with `steps` segments between neighbours.
pub fn spline(points: &[impl Into<Vec2> + Copy], steps: usize) -> Vec<Vec2> {
    through(&super::points(points), steps)
}

/// Uniform Catmull-Rom curve in space.
pub fn spline3(points: &[impl Into<Vec3> + Copy], steps: usize) -> Vec<Vec3> {
    let points: Vec<Vec3> = points.iter().map(|&p| p.into()).collect();
    through(&points, steps)
}

fn through<V>(points: &[V], steps: usize) -> Vec<V>
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f32, Output = V>,
{
    let last = points.len().saturating_sub(1);
    let mut curve = Vec::with_capacity(last * steps + 1);
    for k in 0..last {
        let (p1, p2) = (points[k], points[k + 1]);
        // The neighbours beyond the ends are reflected.
        let p0 = if k > 0 { points[k - 1] } else { p1 + (p1 - p2) };
        let p3 = if k + 2 <= last { points[k + 2] } else { p2 + (p2 - p1) };
        for s in 0..steps {
            let t = s as f32 / steps as f32;
            let (t2, t3) = (t * t, t * t * t);
            curve.push(
                (p1 * 2.0
                    + (p2 - p0) * t
                    + (p0 * 2.0 - p1 * 5.0 + p2 * 4.0 - p3) * t2
                    + (p1 * 3.0 - p0 - p2 * 3.0 + p3) * t3)
                    * 0.5,
            );
        }
    }
    curve.extend(points.last());
    curve
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_goes_through_its_points_and_keeps_lines_straight() {
        let points = [[0.0, 0.0], [1.0, 2.0], [3.0, 1.0], [4.0, 4.0]].map(Vec2::from_array);
        let curve = spline(&points, 5);
        assert_eq!(curve.len(), 16);
        for (k, p) in points.iter().enumerate() {
            assert!(curve[5 * k].distance(*p) < 1e-6);
        }
        let line = spline(&[Vec2::ZERO, Vec2::ONE, Vec2::ONE * 2.0], 4);
        assert!(line.iter().enumerate().all(|(k, p)| p.distance(Vec2::splat(k as f32 * 0.25)) < 1e-6));
    }
}
