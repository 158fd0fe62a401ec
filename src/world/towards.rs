//! Sampling of directions towards the boxes around mirrors and glass.
//!
//! A front face of a box, as seen from the point, is chosen by its approximate solid angle, and a point on it
//! uniformly. A ray enters a box through one front face, so that the density of a direction follows without tracing
//! rays.
//!
//! Units: densities are per solid angle.

use base::math::{F32x16, LANES, Vec3x16};
use embree::Ray;
use glam::{Vec2, Vec3};

/// Coordinate of a direction that replaces smaller ones, 0 among them.
pub(super) const MIN_DIRECTION: f32 = 1e-20;

/// Minimum cosine in the weight of a face, whose centre may lie below the horizon while a part lies above.
const MIN_COS: f32 = 0.1;

/// Up to sixteen boxes. Boxes without extent are ignored.
#[derive(Clone, Debug, Default)]
pub(super) struct Boxes16 {
    low: Vec3x16,
    high: Vec3x16,
}

/// Front faces of the boxes, seen from a point.
pub struct Faces<'a> {
    boxes: &'a Boxes16,
    x: Vec3,
    /// Coordinates of the planes of the faces, by axis.
    at: [F32x16; 3],
    /// Approximate solid angles times the cosines at the point; 0 for faces that are not front faces.
    weights: [F32x16; 3],
    /// Sum of the weights.
    total: f32,
}

impl Boxes16 {
    /// Collects the first sixteen boxes, given as lowest and highest corners.
    pub fn new(corners: &[(Vec3, Vec3)]) -> Boxes16 {
        let mut boxes = Boxes16::default();
        for (lane, (low, high)) in corners.iter().take(LANES).enumerate() {
            boxes.low.set(lane, *low);
            boxes.high.set(lane, *high);
        }
        boxes
    }

    /// Returns the lowest and the highest corner of a box.
    fn corners(&self, lane: usize) -> (Vec3, Vec3) {
        (self.low.get(lane), self.high.get(lane))
    }
}

impl Boxes16 {
    /// Returns the front faces seen from `x`, where the normal is `n`.
    pub fn faces(&self, x: Vec3, n: Vec3) -> Faces<'_> {
        let (low, high) = (self.low.rows(), self.high.rows());
        let (mut centre, mut half, mut height) = ([[0.0; LANES]; 3], [[0.0; LANES]; 3], [0.0; LANES]);
        for axis in 0..3 {
            for i in 0..LANES {
                centre[axis][i] = 0.5 * (low[axis][i] + high[axis][i]) - x[axis];
                half[axis][i] = 0.5 * (high[axis][i] - low[axis][i]);
                height[i] += n[axis] * centre[axis][i] + n[axis].abs() * half[axis][i];
            }
        }
        let mut faces =
            Faces { boxes: self, x, at: [[0.0; LANES]; 3], weights: [[0.0; LANES]; 3], total: 0.0 };
        let mut totals = [0.0; LANES];
        for axis in 0..3 {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let (low, high, x) = (&low[axis], &high[axis], x[axis]);
            let (centre_b, centre_c, half_b, half_c) = (&centre[b], &centre[c], &half[b], &half[c]);
            let (n_a, n_b, n_c) = (n[axis], n[b], n[c]);
            let (at, weights) = (&mut faces.at[axis], &mut faces.weights[axis]);
            for i in 0..LANES {
                let below = low[i] - x;
                let distance = below.max(x - high[i]);
                at[i] = if below > 0.0 { low[i] } else { high[i] };
                let (to_a, to_b, to_c) = (at[i] - x, centre_b[i], centre_c[i]);
                let area = 4.0 * half_b[i] * half_c[i];
                let dist_sq = to_a * to_a + to_b * to_b + to_c * to_c + 0.25 * area;
                let inv_dist = 1.0 / dist_sq.sqrt();
                let cos = (n_a * to_a + n_b * to_b + n_c * to_c) * inv_dist;
                let weight = cos.max(MIN_COS) * area * distance * inv_dist * inv_dist * inv_dist;
                let is_front = (distance > 0.0) & (height[i] > 0.0) & (weight > 0.0);
                weights[i] = if is_front { weight } else { 0.0 };
                totals[i] += weights[i];
            }
        }
        faces.total = totals.iter().sum();
        faces
    }
    /// Returns true if a ray hits a box.
    #[inline]
    pub fn may_be_met(&self, ray: &Ray) -> bool {
        let (low, high) = (self.low.rows(), self.high.rows());
        let (mut near, mut far) = ([0.0f32; LANES], [f32::INFINITY; LANES]);
        for axis in 0..3 {
            let d = ray.direction[axis];
            let inverse = 1.0 / if d.abs() < MIN_DIRECTION { MIN_DIRECTION } else { d };
            for i in 0..LANES {
                let (a, b) = (
                    (low[axis][i] - ray.origin[axis]) * inverse,
                    (high[axis][i] - ray.origin[axis]) * inverse,
                );
                let (least, most) = if a < b { (a, b) } else { (b, a) };
                near[i] = if least > near[i] { least } else { near[i] };
                far[i] = if most < far[i] { most } else { far[i] };
            }
        }
        (0..LANES).any(|i| near[i] <= far[i] && low[0][i] < high[0][i])
    }
}

impl Faces<'_> {
    /// Samples a direction; `None` if there is no front face.
    pub fn towards(&self, u_face: f32, u: Vec2) -> Option<Vec3> {
        let (mut left, mut chosen) = (u_face * self.total, None);
        for (i, weight) in self.weights.iter().flatten().enumerate().filter(|(_, weight)| **weight > 0.0) {
            left -= weight;
            chosen = Some(i);
            if left < 0.0 {
                break;
            }
        }
        let (axis, lane) = chosen.map(|i| (i / LANES, i % LANES))?;
        let (mut point, high) = self.boxes.corners(lane);
        for (axis, u) in [((axis + 1) % 3, u.x), ((axis + 2) % 3, u.y)] {
            point[axis] += u * (high[axis] - point[axis]);
        }
        point[axis] = self.at[axis][lane];
        (point - self.x).try_normalize()
    }

    /// Returns the density with which [`Faces::towards`] samples the unit vector `direction`; `None` if there is no
    /// front face.
    pub fn density(&self, direction: Vec3) -> Option<f32> {
        let (low, high) = (self.boxes.low.rows(), self.boxes.high.rows());
        let mut density = [0.0; LANES];
        for axis in 0..3 {
            let (b, c) = ((axis + 1) % 3, (axis + 2) % 3);
            let inv_cos = 1.0 / direction[axis];
            for i in 0..LANES {
                let t = (self.at[axis][i] - self.x[axis]) * inv_cos;
                let (y, z) = (self.x[b] + t * direction[b], self.x[c] + t * direction[c]);
                let within = (low[b][i] <= y) & (y <= high[b][i]) & (low[c][i] <= z) & (z <= high[c][i]);
                let area = (high[b][i] - low[b][i]) * (high[c][i] - low[c][i]);
                let met = (t > 0.0) & (t < f32::INFINITY) & within & (self.weights[axis][i] > 0.0);
                density[i] += if met { self.weights[axis][i] * t * t * inv_cos.abs() / area } else { 0.0 };
            }
        }
        (self.total > 0.0).then(|| density.iter().sum::<f32>() / self.total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;
    use std::f32::consts::PI;

    #[test]
    fn densities_are_those_of_the_directions_drawn() {
        let boxes = vec![
            (Vec3::new(1.0, 1.0, -1.0), Vec3::new(2.0, 1.1, 0.5)),
            (Vec3::new(-2.0, -0.5, 0.3), Vec3::new(-1.0, 0.8, 0.3)),
            (Vec3::new(-1.0, -9.0, -1.0), Vec3::new(1.0, -8.0, 1.0)),
        ];
        let boxes = Boxes16::new(&boxes);
        let faces = boxes.faces(Vec3::ZERO, Vec3::Y);
        // Means of functions over sampled directions must equal those over the sphere, weighted by the density.
        let functions = [|_: Vec3| 1.0, |d: Vec3| d.x * d.x, |d: Vec3| (d.z + 0.3) * d.y];
        let count = 1 << 16;
        let (mut drawn, mut whole, mut missed) = ([0.0f64; 3], [0.0f64; 3], 0);
        for i in 0..count {
            let d = faces.towards(owen_sobol_2d(i, 1).x, owen_sobol_2d(i, 2)).expect("boxes");
            missed += u32::from(faces.density(d) == Some(0.0));
            let u = owen_sobol_2d(i, 3);
            let (z, phi) = (1.0 - 2.0 * u.x, 2.0 * PI * u.y);
            let sin = (1.0 - z * z).sqrt();
            let even = Vec3::new(sin * phi.cos(), sin * phi.sin(), z);
            let pdf = faces.density(even).expect("boxes") * 4.0 * PI;
            for (k, f) in functions.iter().enumerate() {
                drawn[k] += f64::from(f(d)) / f64::from(count);
                whole[k] += f64::from(f(even) * pdf) / f64::from(count);
            }
        }
        assert!(missed < 10, "{missed} at the edges");
        for (drawn, whole) in drawn.iter().zip(whole) {
            assert!((drawn - whole).abs() < 0.01, "{drawn} {whole}");
        }
        // The third box is below the horizon. No box has a front face from its inside.
        assert_eq!(faces.density(-Vec3::Y), Some(0.0));
        let inside = boxes.faces(Vec3::new(0.0, -8.5, 0.0), -Vec3::Y);
        assert!(inside.towards(0.5, Vec2::splat(0.5)).is_none() && inside.density(Vec3::X).is_none());
    }
}
