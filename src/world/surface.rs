//! Points on surfaces.

use base::math::Frame;
use glam::{Vec2, Vec3};

/// A surface point that gathers light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub position: Vec3,
    /// Unit shading normal, on the side from which light comes.
    pub normal: Vec3,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
}

/// A surface point that a ray hit.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal, on the front by winding.
    pub normal: Vec3,
    /// Shading frame. The z axis is the interpolated normal, on the mesh's front.
    pub frame: Frame,
    /// Barycentric weights of corners 1 and 2.
    pub barycentric: Vec2,
    /// Index of the mesh.
    pub mesh: u32,
    /// Index of the triangle in the mesh.
    pub triangle: u32,
    /// Distance along the ray, in units of the ray's direction.
    pub t: f32,
    /// Vector along the ray, as long as the cone around the ray is wide here. Textures are averaged over the area that
    /// the cone covers; if it is zero, they are looked up at the point.
    pub footprint: Vec3,
}
