//! One ray and what it meets.

use embree4_sys as sys;
use glam::Vec3;

/// Ray mask that meets geometry of any mask but zero.
pub const ALL_GEOMETRY: u32 = u32::MAX;

/// The segment `origin + t direction`, `t_near < t <= t_far`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where `t` is 0.
    pub origin: Vec3,
    /// Start of the segment, at least 0.
    pub t_near: f32,
    /// Direction, of any length but 0.
    pub direction: Vec3,
    /// End of the segment; may be infinite.
    pub t_far: f32,
}

impl Ray {
    /// The half-line from `origin`.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Ray {
        Ray { origin, t_near: 0.0, direction, t_far: f32::INFINITY }
    }

    /// The segment between two points: `t` is 0 at `from` and 1 at `to`.
    #[inline]
    pub fn between(from: Vec3, to: Vec3) -> Ray {
        Ray { origin: from, t_near: 0.0, direction: to - from, t_far: 1.0 }
    }

    /// The point at `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }

    /// Whether the segment exists; if not, it meets nothing and Embree is not asked.
    #[inline]
    pub(super) fn is_traceable(&self) -> bool {
        self.origin.is_finite()
            && self.direction.is_finite()
            && self.direction != Vec3::ZERO
            && self.t_near <= self.t_far
    }

    #[inline]
    pub(super) fn to_embree(self, mask: u32) -> sys::RTCRay {
        sys::RTCRay {
            org_x: self.origin.x,
            org_y: self.origin.y,
            org_z: self.origin.z,
            tnear: self.t_near,
            dir_x: self.direction.x,
            dir_y: self.direction.y,
            dir_z: self.direction.z,
            time: 0.0,
            tfar: self.t_far,
            mask,
            id: 0,
            flags: 0,
        }
    }
}

/// Where a ray met a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Ray parameter of the point.
    pub t: f32,
    /// Barycentric coordinate of the triangle's corner 1.
    pub u: f32,
    /// Barycentric coordinate of the triangle's corner 2.
    pub v: f32,
    /// Index of the mesh, as given to [`super::Accel::build`].
    pub geometry: u32,
    /// Index of the triangle in that mesh.
    pub primitive: u32,
}
