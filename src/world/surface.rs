//! Points on surfaces.

use base::math::Frame;
use glam::{Vec2, Vec3};

/// A surface point that gathers light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub position: Vec3,
    /// Unit shading normal, on the side that light comes from.
    pub normal: Vec3,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
}

/// A point on a surface, hit by a ray.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal, on the front by winding.
    pub normal: Vec3,
    /// Shading frame; its z axis is the interpolated normal, on the mesh's front.
    pub frame: Frame,
    /// Barycentric weights of corners 1 and 2.
    pub barycentric: Vec2,
    /// Mesh index.
    pub mesh: u32,
    /// Triangle of that mesh.
    pub triangle: u32,
    /// Distance along the ray in units of its direction.
    pub t: f32,
    /// Vector along the ray as long as the cone around it is wide here: textures are averaged over what the cone
    /// covers; zero where they are looked up at the point.
    pub footprint: Vec3,
}
