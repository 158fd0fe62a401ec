//! Falloff of spot lights.

/// Returns the share of a spot's axial intensity at the given cosine to its axis.
#[inline]
pub fn spot_falloff(cos: f32, inner_angle: f32, outer_angle: f32) -> f32 {
    let angle = cos.clamp(-1.0, 1.0).acos();
    if angle <= inner_angle {
        1.0
    } else if angle >= outer_angle {
        0.0
    } else {
        (outer_angle - angle) / (outer_angle - inner_angle)
    }
}
