//! Probe rays: the nearest surface in each cell of a point's hemisphere.
//!
//! Paper: Ward and Heckbert, *Irradiance Gradients*, 1992, for the division of the hemisphere: rings of equal
//! share of a uniform sky's irradiance, cut into sectors.
//!
//! Deviations: one ray through the middle of each cell; the sectors of each point are turned by an angle of its
//! own, so that features that fall between rays differ from point to point.
//!
//! Units: directions in the point's frame; inverse distances in 1/m.

use crate::embree::{Hits16, Rays16};
use crate::math::Frame;
use crate::sampling::hash;
use crate::shadow;
use crate::world::{SurfacePoint, World};
use glam::Vec3;
use std::f32::consts::TAU;

/// Sectors of each ring: one packet of rays.
pub const SECTORS: usize = 16;
/// Maximum number of rings from the normal to the horizon.
const MAX_RINGS: u32 = 256;

/// Surface seen in each cell; cell `ring · SECTORS + sector`.
#[derive(Clone, Debug)]
pub struct Probes {
    /// z is the normal.
    pub frame: Frame,
    /// Rings from the normal to the horizon.
    pub rings: usize,
    /// Azimuth, in sectors, at which sector 0 begins.
    turn: f32,
    /// Unit directions of the rays, in the frame.
    pub direction: Vec<Vec3>,
    /// One over the distance to the surface; 0 where there is none.
    pub inverse: Vec<f32>,
    /// The surface's plane as n/h, for a unit normal n in the frame and its distance h: the inverse distance in a
    /// direction is the product with it. Zero where there is no surface.
    pub plane: Vec<Vec3>,
}

impl Probes {
    /// Traces `rays` in whole rings from a point on the side of its normal; `seed` turns the sectors.
    pub fn trace(world: &World, point: &SurfacePoint, rays: u32, seed: u32) -> Probes {
        let frame = Frame::from_normal(point.normal);
        let rings = rays.div_ceil(SECTORS as u32).clamp(1, MAX_RINGS) as usize;
        let cells = rings * SECTORS;
        let turn = (hash(seed, 0x9b05) >> 8) as f32 * (1.0 / 16_777_216.0);
        let mut probes = Probes {
            frame,
            rings,
            turn,
            direction: vec![Vec3::Z; cells],
            inverse: vec![0.0; cells],
            plane: vec![Vec3::ZERO; cells],
        };
        let azimuths: [(f32, f32); SECTORS] =
            std::array::from_fn(|k| probes.azimuth(k as f32 + 0.5).sin_cos());
        for ring in 0..rings {
            let sin_sq = (ring as f32 + 0.5) / rings as f32;
            let (sin, cos) = (sin_sq.sqrt(), (1.0 - sin_sq).sqrt());
            let mut rays = Rays16::default();
            for (k, (sin_phi, cos_phi)) in azimuths.into_iter().enumerate() {
                let local = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
                probes.direction[ring * SECTORS + k] = local;
                rays.set(k, &shadow::ray_from(point.position, point.geometric_normal, frame.to_world(local)));
            }
            let mut hits = Hits16::default();
            let found = world.accel.closest_hit16(&rays, u16::MAX, false, &mut hits);
            for k in (0..SECTORS).filter(|k| found >> k & 1 != 0) {
                let normal = world.geometric_normal(hits.geometry[k], hits.primitive[k]);
                probes.set(ring * SECTORS + k, hits.t[k], frame.to_local(normal));
            }
        }
        probes
    }

    fn set(&mut self, cell: usize, distance: f32, normal: Vec3) {
        let cos = normal.dot(self.direction[cell]);
        let inverse = 1.0 / distance.max(f32::MIN_POSITIVE);
        self.inverse[cell] = inverse;
        // A surface seen edge-on is taken to face the ray.
        self.plane[cell] =
            if cos.abs() > 1e-3 { normal * (inverse / cos) } else { self.direction[cell] * inverse };
    }

    /// Azimuth of a sector coordinate.
    #[inline]
    pub fn azimuth(&self, sector: f32) -> f32 {
        (sector + self.turn) * (TAU / SECTORS as f32)
    }

    /// Ring and sector coordinates of a unit direction in the frame; cell (j, k) is [j, j + 1) × [k, k + 1).
    /// Sectors are not wrapped.
    #[inline]
    pub fn coordinates(&self, direction: Vec3) -> (f32, f32) {
        let sin_sq = (1.0 - direction.z * direction.z).max(0.0);
        let turns = direction.y.atan2(direction.x) * (1.0 / TAU);
        (sin_sq * self.rings as f32, turns * SECTORS as f32 - self.turn)
    }

    /// Number of cells.
    pub fn cells(&self) -> usize {
        self.inverse.len()
    }

    /// Harmonic mean of the distances, each cell by its share of a uniform sky's irradiance; infinite if nothing
    /// is seen.
    pub fn harmonic_mean(&self) -> f32 {
        let sum: f32 = self.inverse.iter().sum();
        if sum > 0.0 { self.cells() as f32 / sum } else { f32::INFINITY }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{MaterialId, Scene};
    use crate::test_scenes::{diffuse, quad};

    /// A ceiling at height 2 that reaches very far, and a point looking up at it from height 0.5.
    fn under_a_ceiling(rays: u32) -> Probes {
        let corner = Vec3::new(-1e4, -1e4, 2.0);
        let mut scene = Scene { materials: vec![diffuse(Vec3::ONE)], ..Scene::default() };
        scene.meshes.push(quad(corner, Vec3::X * 2e4, Vec3::Y * 2e4, MaterialId(0)));
        let world = World::new(scene, 1).expect("the world is built");
        let (position, normal) = (Vec3::new(0.3, 0.2, 0.5), Vec3::Z);
        Probes::trace(&world, &SurfacePoint { position, normal, geometric_normal: normal }, rays, 7)
    }

    #[test]
    fn rays_go_through_the_middles_of_cells() {
        let probes = under_a_ceiling(100);
        assert_eq!((probes.rings, probes.cells()), (7, 7 * SECTORS));
        for (cell, direction) in probes.direction.iter().enumerate() {
            let (ring, sector) = probes.coordinates(*direction);
            assert!((ring - ((cell / SECTORS) as f32 + 0.5)).abs() < 1e-4);
            let off = sector - ((cell % SECTORS) as f32 + 0.5);
            assert!((off - (off / SECTORS as f32).round() * SECTORS as f32).abs() < 1e-3, "{cell}: {sector}");
        }
    }

    #[test]
    fn a_plane_is_seen_at_its_distance_in_every_cell() {
        let probes = under_a_ceiling(256);
        for cell in 0..probes.cells() {
            let expected = probes.direction[cell].z / 1.5;
            assert!((probes.inverse[cell] - expected).abs() < 1e-4 * expected);
            // Its plane gives the distance in every other direction too.
            let other = probes.direction[(cell + 29) % probes.cells()];
            assert!((probes.plane[cell].dot(other) - other.z / 1.5).abs() < 1e-4);
        }
        // The mean of the cosine over a uniform sky's irradiance is 2/3.
        assert!((probes.harmonic_mean() / (1.5 * 1.5) - 1.0).abs() < 1e-2, "{}", probes.harmonic_mean());
    }
}
