//! Probe rays: the nearest surface in each cell of a point's hemisphere.
//!
//! Paper: Ward and Heckbert, *Irradiance Gradients*, 1992, for the division of the hemisphere into rings of equal
//! irradiance from a uniform sky, cut into sectors.
//!
//! Deviations: one ray passes through the middle of each cell. The sectors of each point are rotated by a random
//! angle, so that features missed between rays differ from point to point.
//!
//! Units: directions in the point's frame; inverse distances in 1/m.

use base::math::{F32x16, Frame, LANES, Vec3x16, first_lanes, lanes_in};
use base::sampling::{hash, unit};
use embree::{Hits16, Rays16};
use glam::Vec3;
use std::f32::consts::TAU;
use world::shadow;
use world::{SurfacePoint, World};

/// Sectors per ring: one packet of rays.
pub const SECTORS: usize = 16;
/// Maximum number of rings from the normal to the horizon.
const MAX_RINGS: u32 = 256;

/// Surfaces seen by the cells; cell `ring · SECTORS + sector`.
#[derive(Clone, Debug)]
pub struct Probes {
    /// Frame whose z axis is the normal.
    pub frame: Frame,
    /// Number of rings from the normal to the horizon.
    pub rings: usize,
    /// Azimuth, in sectors, at which sector 0 begins.
    turn: f32,
    /// Unit directions of the rays in the frame.
    pub direction: Vec<Vec3>,
    /// Inverse distance to the surface; 0 without a surface.
    pub inverse: Vec<f32>,
    /// Plane of the surface as n/h, for a unit normal n in the frame and the distance h of the plane. The product with
    /// a direction is the inverse distance along it. Zero without a surface.
    pub plane: Vec<Vec3>,
    /// Distance h of that plane.
    pub height: Vec<f32>,
}

impl Probes {
    /// Returns probes that see nothing, in `rings` rings around a normal. `seed` rotates the sectors.
    fn new(normal: Vec3, rings: usize, seed: u32) -> Probes {
        let cells = rings * SECTORS;
        let mut probes = Probes {
            frame: Frame::from_normal(normal),
            rings,
            turn: unit(hash(seed, 0x9b05)),
            direction: vec![Vec3::Z; cells],
            inverse: vec![0.0; cells],
            plane: vec![Vec3::ZERO; cells],
            height: vec![0.0; cells],
        };
        let azimuths: [(f32, f32); SECTORS] =
            std::array::from_fn(|k| probes.azimuth(k as f32 + 0.5).sin_cos());
        for (cell, direction) in probes.direction.iter_mut().enumerate() {
            let sin_sq = ((cell / SECTORS) as f32 + 0.5) / rings as f32;
            let (sin, cos) = (sin_sq.sqrt(), (1.0 - sin_sq).sqrt());
            let (sin_phi, cos_phi) = azimuths[cell % SECTORS];
            *direction = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
        }
        probes
    }

    /// Traces `rays` rays, in whole rings, from each point to the side of its normal. The seed of a point rotates its
    /// sectors.
    pub fn trace(world: &World, points: &[(SurfacePoint, u32)], rays: u32) -> Vec<Probes> {
        let rings = rays.div_ceil(SECTORS as u32).clamp(1, MAX_RINGS) as usize;
        let mut probes: Vec<Probes> =
            points.iter().map(|(point, seed)| Probes::new(point.normal, rings, *seed)).collect();
        let count = points.len() * rings * SECTORS;
        let (mut rays, mut hits) = (Rays16::default(), Hits16::default());
        for first in (0..count).step_by(LANES) {
            let place = |lane: usize| ((first + lane) % points.len(), (first + lane) / points.len());
            let valid = first_lanes(count - first);
            for lane in lanes_in(valid) {
                let (i, cell) = place(lane);
                let (point, probes) = (&points[i].0, &probes[i]);
                let direction = probes.frame.to_world(probes.direction[cell]);
                rays.set(lane, &shadow::ray_from(point.position, point.geometric_normal, direction));
            }
            for lane in lanes_in(world.accel.closest_hit16(&rays, valid, false, &mut hits)) {
                let (i, cell) = place(lane);
                let normal = world.geometric_normal(hits.geometry[lane], hits.primitive[lane]);
                let normal = probes[i].frame.to_local(normal);
                probes[i].set(cell, hits.t[lane], normal);
            }
        }
        probes
    }

    /// Sets the surface seen by a cell to one at `distance` along the ray, with a unit normal in the frame.
    pub(super) fn set(&mut self, cell: usize, distance: f32, normal: Vec3) {
        let cos = normal.dot(self.direction[cell]);
        let distance = distance.max(f32::MIN_POSITIVE);
        self.inverse[cell] = 1.0 / distance;
        // A surface seen edge-on is treated as facing the ray.
        let (normal, cos) = if cos.abs() > 1e-3 { (normal, cos) } else { (self.direction[cell], 1.0) };
        self.plane[cell] = normal / (distance * cos);
        self.height[cell] = distance * cos.abs();
    }

    /// Returns the azimuth of a sector coordinate, in radians.
    #[inline]
    pub fn azimuth(&self, sector: f32) -> f32 {
        (sector + self.turn) * (TAU / SECTORS as f32)
    }

    /// Returns ring and sector coordinates of a unit direction in the frame, given its azimuth in turns. Cell (j, k)
    /// is [j, j + 1) × [k, k + 1). Sectors are not wrapped.
    #[inline]
    pub fn coordinates(&self, direction: Vec3, turns: f32) -> (f32, f32) {
        let sin_sq = (1.0 - direction.z * direction.z).max(0.0);
        (sin_sq * self.rings as f32, turns * SECTORS as f32 - self.turn)
    }

    /// Returns the number of cells.
    pub fn cells(&self) -> usize {
        self.inverse.len()
    }

    /// Returns the harmonic mean of the distances, weighted by each cell's irradiance from a uniform sky; infinite if
    /// nothing is seen.
    pub fn harmonic_mean(&self) -> f32 {
        let sum: f32 = self.inverse.iter().sum();
        if sum > 0.0 { self.cells() as f32 / sum } else { f32::INFINITY }
    }
}

/// Returns azimuths of directions in turns, in [-½, ½], with an error up to 2e-6.
///
/// Paper: Abramowitz and Stegun, *Handbook of Mathematical Functions*, 1964, 4.4.49.
pub fn azimuths16(direction: &Vec3x16) -> F32x16 {
    let mut turns = [0.0; LANES];
    for l in 0..LANES {
        let (x, y) = (direction.x[l], direction.y[l]);
        let (a, b) = (x.abs(), y.abs());
        let (less, more) = if a < b { (a, b) } else { (b, a) };
        let t = less / if more > f32::MIN_POSITIVE { more } else { f32::MIN_POSITIVE };
        let s = t * t;
        let series = 0.999_866 + s * (-0.330_299_5 + s * (0.180_141 + s * (-0.085_133 + s * 0.020_835_1)));
        let octant = series * t * (1.0 / TAU);
        let quadrant = if a < b { 0.25 - octant } else { octant };
        let half = if x < 0.0 { 0.5 - quadrant } else { quadrant };
        turns[l] = if y < 0.0 { -half } else { half };
    }
    turns
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::{MaterialId, Scene};
    use world::testkit::{diffuse, quad};

    /// A ceiling at height 2 that reaches very far, and a point looking up at it from height 0.5.
    fn under_a_ceiling(rays: u32) -> Probes {
        let corner = Vec3::new(-1e4, -1e4, 2.0);
        let mut scene = Scene { materials: vec![diffuse(Vec3::ONE)], ..Scene::default() };
        scene.meshes.push(quad(corner, Vec3::X * 2e4, Vec3::Y * 2e4, MaterialId(0)));
        let world = World::new(scene, 1).expect("the world is built");
        let (position, normal) = (Vec3::new(0.3, 0.2, 0.5), Vec3::Z);
        let point = SurfacePoint { position, normal, geometric_normal: normal };
        // Alone, and as the third of many.
        let alone = Probes::trace(&world, &[(point, 7)], rays).remove(0);
        let elsewhere = SurfacePoint { position: position + Vec3::X, ..point };
        let mut others = vec![(elsewhere, 3); 11];
        others[2] = (point, 7);
        let among = Probes::trace(&world, &others, rays).remove(2);
        assert!(alone.direction == among.direction && alone.inverse == among.inverse);
        among
    }

    #[test]
    fn rays_go_through_the_middles_of_cells() {
        let probes = under_a_ceiling(100);
        assert_eq!((probes.rings, probes.cells()), (7, 7 * SECTORS));
        for (cell, direction) in probes.direction.iter().enumerate() {
            let turns = azimuths16(&Vec3x16::splat(*direction))[0];
            assert!((turns - direction.y.atan2(direction.x) / TAU).abs() < 3e-6);
            let (ring, sector) = probes.coordinates(*direction, turns);
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
            // The plane gives the distance in every other direction too.
            let other = probes.direction[(cell + 29) % probes.cells()];
            assert!((probes.plane[cell].dot(other) - other.z / 1.5).abs() < 1e-4);
        }
        // The mean of the cosine over a uniform sky's irradiance is 2/3.
        assert!((probes.harmonic_mean() / (1.5 * 1.5) - 1.0).abs() < 1e-2, "{}", probes.harmonic_mean());
    }
}
