//! The part of a texture that the cone around a ray covers.
//!
//! Paper: Akenine-Möller et al., *Improved Shader and Texture Level of Detail Using Ray Cones*, 2021. The width of the
//! cone is divided by the root of the cosine. The result is multiplied by the root of the ratio of the two areas of the
//! triangle, in texture coordinates and in the scene.
//! Deviations: the paper divides by the cosine, which gives the length of the covered ellipse. The root gives the side
//! of a square of the same area.

use glam::{Vec2, Vec3};

/// Minimum cosine between a ray and the normal. The covered area does not grow beyond it.
const MIN_COS: f32 = 0.01;

/// Returns the length in texture coordinates of one unit of length on a triangle, the mean over all directions. This
/// is the root of the ratio of the areas. Zero if the triangle is degenerate.
pub fn uv_scale(uvs: [Vec2; 3], [e1, e2]: [Vec3; 2]) -> f32 {
    let [a, b, c] = uvs;
    let scale = ((b - a).perp_dot(c - a).abs() / e1.cross(e2).length()).sqrt();
    if scale.is_finite() { scale } else { 0.0 }
}

/// Returns the side, in texture coordinates, of a square as large as the area that a cone covers of a plane.
///
/// `normal` is the plane's unit normal. `footprint` points along the ray and is as long as the cone is wide; if it is
/// zero, so is the result. `uv_scale` is the scale of the triangle (see [`uv_scale`]).
#[inline]
pub fn covered(uv_scale: f32, normal: Vec3, footprint: Vec3) -> f32 {
    let width_sq = footprint.length_squared();
    let width_cos = normal.dot(footprint).abs().max(MIN_COS * width_sq.sqrt());
    match width_sq > 0.0 {
        true => uv_scale * (width_sq * width_sq.sqrt() / width_cos).sqrt(),
        false => 0.0,
    }
}
