//! Coordinates that the renderer can hold.

use crate::local::LocalCoordinates;
use glam::DVec3;

/// Maximum coordinate, in the unit of the files and in the local unit.
///
/// Embree silently drops triangles beyond 1.8e18.
pub(super) const MAX_COORDINATE: f64 = 1e18;

/// Remedy for coordinates beyond [`MAX_COORDINATE`].
pub(super) const IN_REACH: &str =
    "keep within 1e18 of the origin, and within 1e18 times the scene's size of it";

/// True if f32 can represent a position.
pub(super) fn is_within_reach(world: DVec3, coordinates: &LocalCoordinates) -> bool {
    world.abs().max_element() <= MAX_COORDINATE
        && coordinates.local(world).abs().max_element() <= MAX_COORDINATE as f32
}
