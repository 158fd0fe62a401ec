//! Packets of sixteen rays and their hits.

use super::{Hit, Ray};
use base::math::Vec3x16;
use embree4_sys as sys;
use glam::Vec3;

/// Sixteen rays, one per lane, as a structure of arrays.
///
/// Lanes that were never set hit nothing.
#[derive(Clone, Debug)]
#[repr(C, align(64))]
pub struct Rays16 {
    /// Origins.
    pub origin_x: [f32; 16],
    /// Origins.
    pub origin_y: [f32; 16],
    /// Origins.
    pub origin_z: [f32; 16],
    /// Starts of the segments, at least 0.
    pub t_near: [f32; 16],
    /// Directions, of any length but 0.
    pub direction_x: [f32; 16],
    /// Directions.
    pub direction_y: [f32; 16],
    /// Directions.
    pub direction_z: [f32; 16],
    /// Ends of the segments; may be infinite.
    pub t_far: [f32; 16],
}

impl Default for Rays16 {
    fn default() -> Rays16 {
        Rays16 {
            origin_x: [0.0; 16],
            origin_y: [0.0; 16],
            origin_z: [0.0; 16],
            t_near: [0.0; 16],
            direction_x: [0.0; 16],
            direction_y: [0.0; 16],
            direction_z: [0.0; 16],
            t_far: [f32::NEG_INFINITY; 16],
        }
    }
}

impl Rays16 {
    /// Sets the ray in a lane.
    ///
    /// # Panics
    /// If `lane` is 16 or more.
    #[inline(always)]
    pub fn set(&mut self, lane: usize, ray: &Ray) {
        self.origin_x[lane] = ray.origin.x;
        self.origin_y[lane] = ray.origin.y;
        self.origin_z[lane] = ray.origin.z;
        self.t_near[lane] = ray.t_near;
        self.direction_x[lane] = ray.direction.x;
        self.direction_y[lane] = ray.direction.y;
        self.direction_z[lane] = ray.direction.z;
        self.t_far[lane] = ray.t_far;
    }

    /// Returns the ray in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Ray {
        Ray {
            origin: Vec3::new(self.origin_x[lane], self.origin_y[lane], self.origin_z[lane]),
            t_near: self.t_near[lane],
            direction: Vec3::new(self.direction_x[lane], self.direction_y[lane], self.direction_z[lane]),
            t_far: self.t_far[lane],
        }
    }

    /// Returns the origins of all lanes.
    #[inline]
    pub fn origins(&self) -> Vec3x16 {
        Vec3x16 { x: self.origin_x, y: self.origin_y, z: self.origin_z }
    }

    /// Returns the directions of all lanes.
    #[inline]
    pub fn directions(&self) -> Vec3x16 {
        Vec3x16 { x: self.direction_x, y: self.direction_y, z: self.direction_z }
    }

    /// Returns the lanes of `valid` as Embree's mask, without lanes whose segment is empty or invalid.
    #[inline]
    pub(super) fn lanes(&self, valid: u16) -> LaneMask {
        let mut lanes = LaneMask([0; 16]);
        for i in 0..16 {
            // This is zero for finite numbers, and NaN for others.
            let zero = 0.0 * self.origin_x[i]
                + 0.0 * self.origin_y[i]
                + 0.0 * self.origin_z[i]
                + 0.0 * self.direction_x[i]
                + 0.0 * self.direction_y[i]
                + 0.0 * self.direction_z[i];
            let direction =
                self.direction_x[i].abs().max(self.direction_y[i].abs()).max(self.direction_z[i].abs());
            let is_traceable = (zero == 0.0) & (direction > 0.0) & (self.t_near[i] <= self.t_far[i]);
            let is_wanted = (valid >> i) & 1 != 0;
            lanes.0[i] = if is_traceable & is_wanted { sys::RTC_LANE_VALID } else { 0 };
        }
        lanes
    }
}

/// Ids of the rays: their lanes. Filters need them if Embree splits the packet.
pub(super) const LANE_IDS: [u32; 16] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

/// Embree's mask of lanes.
#[repr(C, align(64))]
pub(super) struct LaneMask(pub(super) [i32; 16]);

impl LaneMask {
    #[inline]
    pub(super) fn any(&self) -> bool {
        self.0 != [0; 16]
    }

    /// Returns the bit mask of the valid lanes that satisfy `f`.
    #[inline(always)]
    pub(super) fn mask_where(&self, f: impl Fn(usize) -> bool) -> u16 {
        let mut bits = [0; 16];
        for (i, bit) in bits.iter_mut().enumerate() {
            *bit = if f(i) { self.0[i] & (1 << i) } else { 0 };
        }
        bits.into_iter().fold(0, |mask, bit| mask | bit) as u16
    }
}

/// Hits of sixteen rays; see [`super::Hit`] for the members. Lanes without a hit stay unchanged.
#[derive(Clone, Debug, Default)]
#[repr(C, align(64))]
pub struct Hits16 {
    /// Ray parameters.
    pub t: [f32; 16],
    /// Barycentric coordinates of corner 1 of the triangles.
    pub u: [f32; 16],
    /// Barycentric coordinates of corner 2 of the triangles.
    pub v: [f32; 16],
    /// Indices of the meshes.
    pub geometry: [u32; 16],
    /// Indices of the triangles in their meshes.
    pub primitive: [u32; 16],
}

impl Hits16 {
    /// Returns the hit in a lane.
    #[inline(always)]
    pub fn get(&self, lane: usize) -> Hit {
        Hit {
            t: self.t[lane],
            u: self.u[lane],
            v: self.v[lane],
            geometry: self.geometry[lane],
            primitive: self.primitive[lane],
        }
    }

    /// Copies a lane of other hits into a lane.
    #[inline]
    pub fn copy_lane(&mut self, to: usize, hits: &Hits16, from: usize) {
        self.t[to] = hits.t[from];
        self.u[to] = hits.u[from];
        self.v[to] = hits.v[from];
        self.geometry[to] = hits.geometry[from];
        self.primitive[to] = hits.primitive[from];
    }

    /// Copies lane `from` into the lanes of `to`.
    #[inline]
    pub fn repeat(&mut self, from: usize, to: u16) {
        for i in 0..16 {
            let copied = (to >> i) & 1 != 0;
            self.t[i] = if copied { self.t[from] } else { self.t[i] };
            self.u[i] = if copied { self.u[from] } else { self.u[i] };
            self.v[i] = if copied { self.v[from] } else { self.v[i] };
            self.geometry[i] = if copied { self.geometry[from] } else { self.geometry[i] };
            self.primitive[i] = if copied { self.primitive[from] } else { self.primitive[i] };
        }
    }
}
