//! Meshes that are stored once and seen at several places.

use base::math::Placement;
use std::ops::Range;

/// Meshes in coordinates of their own, and the places at which they are seen. Meshes of groups do not emit.
#[derive(Clone, Debug)]
pub struct Group {
    /// Indices of the meshes in [`crate::Scene::meshes`].
    pub meshes: Range<usize>,
    /// Transforms to the scene's coordinates.
    pub placements: Vec<Placement>,
}
