//! Report of repairs.

use serde::Serialize;
use std::fmt;

/// Counts of removals and repairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SanitizeReport {
    /// Triangles with a vertex index out of range.
    pub out_of_range: usize,
    /// Triangles with NaN or infinite corners.
    pub not_finite: usize,
    /// Triangles with coordinates beyond 1e18, or beyond 1e18 times the size of the camera's surroundings.
    pub huge: usize,
    /// Triangles with two equal indices, or without area in f32.
    pub degenerate: usize,
    /// Meshes without triangles after the removals.
    pub empty_meshes: usize,
    /// Zero vertex normals, replaced by the geometric ones.
    pub bad_normals: usize,
    /// NaN or infinite vertex normals, replaced by the geometric ones.
    pub nan_normals: usize,
    /// Triangles whose winding was reversed to agree with their vertex normals.
    pub turned: usize,
    /// NaN or infinite texture coordinates, set to 0.
    pub bad_uvs: usize,
    /// NaN or infinite tangents; the direction of growing u stands in.
    pub bad_tangents: usize,
    /// Reflectances clamped to 1, and texels and attributes clamped to values that cannot create energy.
    pub clamped: usize,
    /// NaN, infinite or negative values of attributes, and negative texels.
    pub bad_texels: usize,
    /// Emitters, lights and environments without light, dropped.
    pub black_lights: usize,
}

impl SanitizeReport {
    /// True if nothing was removed or repaired.
    pub fn is_clean(&self) -> bool {
        *self == SanitizeReport::default()
    }
}

impl fmt::Display for SanitizeReport {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let counts = [
            (self.out_of_range, "triangles with indices out of range dropped"),
            (self.not_finite, "triangles with NaN or infinite corners dropped"),
            (self.huge, "triangles beyond 1e18 dropped"),
            (self.degenerate, "triangles without area dropped"),
            (self.empty_meshes, "empty meshes dropped"),
            (self.bad_normals, "zero normals replaced"),
            (self.nan_normals, "NaN normals replaced"),
            (self.turned, "triangles turned to face along their vertex normals"),
            (self.bad_uvs, "NaN texture coordinates set to 0"),
            (self.bad_tangents, "NaN tangents left out"),
            (self.clamped, "reflectances clamped"),
            (self.bad_texels, "NaN, infinite or negative values mended"),
            (self.black_lights, "lights without light dropped"),
        ];
        let said: Vec<String> =
            counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
        if said.is_empty() { write!(f, "nothing to repair") } else { write!(f, "{}", said.join(", ")) }
    }
}
