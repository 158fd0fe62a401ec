//! Directions drawn towards the boxes around mirrors and glass, with their densities.
//!
//! A front face of a box, seen from the point, is chosen by its solid angle, about, and a point on it evenly. A ray
//! enters a box by one front face, so that the density of a direction needs no rays.
//!
//! Units: densities are by solid angle.

use super::specular::Specular;
use glam::{Vec2, Vec3};

/// Least cosine that counts for a face: its centre may be below a horizon that the face rises above.
const MIN_COS: f32 = 0.1;

/// A front face of a box.
struct Face {
    axis: usize,
    /// Coordinate of its plane.
    at: f32,
    low: Vec3,
    high: Vec3,
    area: f32,
    /// Solid angle, about, times the cosine at the point.
    weight: f32,
}

impl Specular {
    /// Front faces seen from `x`, where the normal is `n`.
    fn faces(&self, x: Vec3, n: Vec3) -> impl Iterator<Item = Face> {
        self.delta_boxes.iter().flat_map(move |&(low, high)| {
            let (centre, half) = (0.5 * (low + high) - x, 0.5 * (high - low));
            let rises = n.dot(centre) + n.abs().dot(half) > 0.0;
            (0..3).filter_map(move |axis| {
                let distance = (low[axis] - x[axis]).max(x[axis] - high[axis]);
                if !(rises && distance > 0.0) {
                    return None;
                }
                let at = if x[axis] < low[axis] { low[axis] } else { high[axis] };
                let mut to_face = centre;
                to_face[axis] = at - x[axis];
                let (a, b) = (half[(axis + 1) % 3], half[(axis + 2) % 3]);
                let area = 4.0 * a * b;
                let dist_sq = to_face.length_squared() + 0.25 * area;
                let cos = (n.dot(to_face) / dist_sq.sqrt()).max(MIN_COS);
                let weight = cos * area * distance / (dist_sq * dist_sq.sqrt());
                (weight > 0.0).then_some(Face { axis, at, low, high, area, weight })
            })
        })
    }

    /// Draws a direction from `x`, where the normal is `n`; `None` where no box is in front.
    pub fn towards(&self, x: Vec3, n: Vec3, u_face: f32, u: Vec2) -> Option<Vec3> {
        let total: f32 = self.faces(x, n).map(|face| face.weight).sum();
        let (mut left, mut chosen) = (u_face * total, None);
        for face in self.faces(x, n) {
            left -= face.weight;
            chosen = Some(face);
            if left < 0.0 {
                break;
            }
        }
        let Face { axis, at, low, high, .. } = chosen?;
        let mut point = low;
        point[axis] = at;
        for (axis, u) in [((axis + 1) % 3, u.x), ((axis + 2) % 3, u.y)] {
            point[axis] += u * (high[axis] - low[axis]);
        }
        (point - x).try_normalize()
    }

    /// Density with which [`Specular::towards`] draws the unit vector `direction`; `None` where it draws none.
    pub fn towards_pdf(&self, x: Vec3, n: Vec3, direction: Vec3) -> Option<f32> {
        let (mut total, mut density) = (0.0, 0.0);
        for face in self.faces(x, n) {
            total += face.weight;
            let Face { axis, at, low, high, .. } = face;
            let t = (at - x[axis]) / direction[axis];
            let point = x + t * direction;
            let within = |axis: usize| low[axis] <= point[axis] && point[axis] <= high[axis];
            if t > 0.0 && t < f32::INFINITY && within((axis + 1) % 3) && within((axis + 2) % 3) {
                density += face.weight * t * t / (face.area * direction[axis].abs());
            }
        }
        (total > 0.0).then(|| density / total)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::owen_sobol_2d;
    use std::f32::consts::PI;

    #[test]
    fn densities_are_those_of_the_directions_drawn() {
        let boxes = vec![
            (Vec3::new(1.0, 1.0, -1.0), Vec3::new(2.0, 1.1, 0.5)),
            (Vec3::new(-2.0, -0.5, 0.3), Vec3::new(-1.0, 0.8, 0.3)),
            (Vec3::new(-1.0, -9.0, -1.0), Vec3::new(1.0, -8.0, 1.0)),
        ];
        let specular = Specular { delta_boxes: boxes, ..Default::default() };
        let (x, n) = (Vec3::ZERO, Vec3::Y);
        // Means of functions of direction over directions drawn, and over the sphere by their density.
        let functions = [|_: Vec3| 1.0, |d: Vec3| d.x * d.x, |d: Vec3| (d.z + 0.3) * d.y];
        let count = 1 << 16;
        let (mut drawn, mut whole, mut missed) = ([0.0f64; 3], [0.0f64; 3], 0);
        for i in 0..count {
            let d = specular.towards(x, n, owen_sobol_2d(i, 1).x, owen_sobol_2d(i, 2)).expect("boxes");
            missed += u32::from(specular.towards_pdf(x, n, d) == Some(0.0));
            let u = owen_sobol_2d(i, 3);
            let (z, phi) = (1.0 - 2.0 * u.x, 2.0 * PI * u.y);
            let sin = (1.0 - z * z).sqrt();
            let even = Vec3::new(sin * phi.cos(), sin * phi.sin(), z);
            let pdf = specular.towards_pdf(x, n, even).expect("boxes") * 4.0 * PI;
            for (k, f) in functions.iter().enumerate() {
                drawn[k] += f64::from(f(d)) / f64::from(count);
                whole[k] += f64::from(f(even) * pdf) / f64::from(count);
            }
        }
        assert!(missed < 10, "{missed} at the edges");
        for (drawn, whole) in drawn.iter().zip(whole) {
            assert!((drawn - whole).abs() < 0.01, "{drawn} {whole}");
        }
        // The third box is below the horizon; all are from inside one of them.
        assert_eq!(specular.towards_pdf(x, n, -Vec3::Y), Some(0.0));
        assert!(specular.towards(Vec3::new(0.0, -8.5, 0.0), -Vec3::Y, 0.5, Vec2::splat(0.5)).is_none());
    }
}
