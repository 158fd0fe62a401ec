//! Rays traced along paths.

/// Rays traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct RayCounts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
}
