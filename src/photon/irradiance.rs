//! Irradiance anywhere: that of the nearest estimate on a surface turned the same way.
//!
//! Paper: Christensen 1999: one look-up at each hit of a final gathering, instead of an estimate.

use super::density::{Estimate, LEAST_COS, surface_distance_sq};
use crate::eye::EyeIndex;
use crate::math::Rgb;
use glam::Vec3;

/// Estimates in the order of an index over them, as structures of arrays.
pub struct IrradianceMap {
    position: [Vec<f32>; 3],
    normal: [Vec<f32>; 3],
    irradiance: Vec<Rgb>,
    /// Radii of the discs they are means over.
    radius: Vec<f32>,
    index: EyeIndex,
}

impl IrradianceMap {
    /// Of estimates in the order of the index.
    pub fn new(estimates: &[Estimate], index: EyeIndex) -> IrradianceMap {
        let of = |value: &dyn Fn(&Estimate) -> f32| estimates.iter().map(value).collect();
        IrradianceMap {
            position: [of(&|e| e.position.x), of(&|e| e.position.y), of(&|e| e.position.z)],
            normal: [of(&|e| e.normal.x), of(&|e| e.normal.y), of(&|e| e.normal.z)],
            irradiance: estimates.iter().map(|e| e.irradiance).collect(),
            radius: of(&|e| e.radius),
            index,
        }
    }

    /// How many estimates.
    pub fn len(&self) -> usize {
        self.irradiance.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.irradiance.is_empty()
    }

    /// Irradiance at a point of a surface with unit normal `normal`, and the radius of the disc it is the mean
    /// over; `None` where the nearest estimate on a surface like it does not reach: so few photons came by that it is dark.
    #[inline]
    pub fn at(&self, point: Vec3, normal: Vec3) -> Option<(Rgb, f32)> {
        let mut best = None;
        let (position, normals) = (&self.position, &self.normal);
        self.index.leaves_nearest(point, f32::INFINITY, |leaf, mut nearest| {
            let range = self.index.leaf(leaf);
            let (first, count) = (range.start, range.len().min(MOST_IN_LEAF));
            let part = first..first + count;
            // Slices of one length, so that the loop becomes vector code.
            let (x, y, z) =
                (&position[0][part.clone()], &position[1][part.clone()], &position[2][part.clone()]);
            let (nx, ny, nz) =
                (&normals[0][part.clone()], &normals[1][part.clone()], &normals[2][part.clone()]);
            let mut distances = [f32::INFINITY; MOST_IN_LEAF];
            for i in 0..count {
                let offset = Vec3::new(x[i] - point.x, y[i] - point.y, z[i] - point.z);
                let cos = nx[i] * normal.x + ny[i] * normal.y + nz[i] * normal.z;
                let d = surface_distance_sq(offset, normal);
                distances[i] = if cos >= LEAST_COS { d } else { f32::INFINITY };
            }
            for (i, &distance) in distances[..count].iter().enumerate() {
                if distance < nearest {
                    nearest = distance;
                    best = Some((first + i, distance));
                }
            }
            nearest
        });
        let (i, distance_sq) = best?;
        let reach = REACH * self.radius[i];
        (distance_sq <= reach * reach).then_some((self.irradiance[i], self.radius[i]))
    }
}

/// How far from its place an estimate is used, in radii of its disc. Were there as much light further on, photons would have
/// left a site nearer by: of k photons in a disc, none but for e^(-k/4) of places.
const REACH: f32 = 1.0;

/// Leaves of the index hold no more.
const MOST_IN_LEAF: usize = 32;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::owen_sobol_2d;

    #[test]
    fn the_nearest_estimate_on_the_right_side_is_found() {
        // Two sides of a sheet, and a wall.
        let estimate = |i: u32| {
            let u = owen_sobol_2d(i, 5);
            let (position, normal) = match i % 3 {
                0 => (Vec3::new(u.x, u.y, 0.0), Vec3::Z),
                1 => (Vec3::new(u.x, u.y, 0.0), Vec3::NEG_Z),
                _ => (Vec3::new(0.0, u.x, u.y), Vec3::X),
            };
            Estimate { position, normal, irradiance: Rgb::splat(i as f32), radius: 0.1 }
        };
        let estimates: Vec<Estimate> = (0..3000).map(estimate).collect();
        let (index, order) = EyeIndex::build(estimates.iter().map(|e| e.position));
        let estimates: Vec<Estimate> = order.iter().map(|&i| estimates[i as usize]).collect();
        let map = IrradianceMap::new(&estimates, index);
        for (point, normal, near) in [
            (Vec3::new(0.01, 0.5, 0.0), Vec3::Z, true),
            (Vec3::new(0.01, 0.5, 0.0), Vec3::NEG_Z, true),
            (Vec3::new(0.0, 0.4, 0.01), Vec3::X, true),
            (Vec3::new(0.5, 0.4, 0.01), Vec3::new(0.6, 0.0, 0.8), true),
            (Vec3::new(5.0, 0.4, 0.01), Vec3::new(0.6, 0.0, 0.8), false),
        ] {
            let rated = |e: &&Estimate| surface_distance_sq(e.position - point, normal);
            let same = estimates.iter().filter(|e| e.normal.dot(normal) >= LEAST_COS);
            let nearest = same.min_by(|a, b| rated(a).total_cmp(&rated(b))).unwrap();
            let expected = near.then_some((nearest.irradiance, 0.1));
            assert_eq!(map.at(point, normal), expected);
        }
        assert_eq!(map.at(Vec3::ZERO, Vec3::NEG_Y), None);
        assert_eq!(IrradianceMap::new(&[], EyeIndex::build([].into_iter()).0).at(Vec3::ZERO, Vec3::Z), None);
    }
}
