//! A ray and its hit.

use embree4_sys as sys;
use glam::{Vec3, Vec4};

/// Ray mask that includes all geometry, and the mask of occluding geometry.
pub(super) const ALL_GEOMETRY: u32 = u32::MAX;

/// Mask of geometry that does not occlude.
pub(super) const CLEAR: u32 = 2;

/// Mask of the rays of occlusion queries.
pub(super) const OCCLUDING: u32 = !CLEAR;

/// The segment `origin + t direction`, `t_near < t <= t_far`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Point at which `t` is 0.
    pub origin: Vec3,
    /// Start of the segment, at least 0.
    pub t_near: f32,
    /// Direction, of any length but 0.
    pub direction: Vec3,
    /// End of the segment; may be infinite.
    pub t_far: f32,
}

impl Ray {
    /// Returns the half-line from `origin`.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Ray {
        Ray { origin, t_near: 0.0, direction, t_far: f32::INFINITY }
    }

    /// Returns the segment between two points: `t` is 0 at `from` and 1 at `to`.
    #[inline]
    pub fn between(from: Vec3, to: Vec3) -> Ray {
        Ray { origin: from, t_near: 0.0, direction: to - from, t_far: 1.0 }
    }

    /// Returns the point at `t`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }

    /// Converts to Embree's layout, for geometry of `mask`; `None` if the segment is empty or invalid and so hits
    /// nothing.
    ///
    /// Whole vectors are written, as Embree reads them. After writes of single words the read would stall.
    #[inline(always)]
    pub(super) fn to_embree(self, mask: u32) -> Option<sys::RTCRay> {
        let origin = self.origin.extend(self.t_near);
        let direction = self.direction.extend(0.0); // time
        let end = Vec4::new(self.t_far, f32::from_bits(mask), 0.0, 0.0); // mask, id, flags
        let is_finite = origin.abs().cmplt(Vec4::INFINITY) & direction.abs().cmplt(Vec4::INFINITY);
        let is_traceable = is_finite.all() & direction.cmpne(Vec4::ZERO).any() & (self.t_near <= self.t_far);
        // SAFETY: both are 48 bytes of plain numbers in the same order: origin, t_near, direction, time, t_far,
        // mask, id, flags.
        is_traceable
            .then(|| unsafe { std::mem::transmute::<[Vec4; 3], sys::RTCRay>([origin, direction, end]) })
    }
}

/// Returns a ray in Embree's layout with room for its hit.
#[inline(always)]
pub(super) fn without_hit(ray: sys::RTCRay) -> sys::RTCRayHit {
    let hit = sys::RTCHit {
        Ng_x: 0.0,
        Ng_y: 0.0,
        Ng_z: 0.0,
        u: 0.0,
        v: 0.0,
        primID: sys::RTC_INVALID_GEOMETRY_ID,
        geomID: sys::RTC_INVALID_GEOMETRY_ID,
        instID: [sys::RTC_INVALID_GEOMETRY_ID],
        instPrimID: [sys::RTC_INVALID_GEOMETRY_ID],
    };
    sys::RTCRayHit { ray, hit }
}

/// Intersection of a ray with a triangle.
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
