//! Warnings about parts of meshes that are left out or replaced, as their numbers are wrong.
//!
//! Readers of text name such parts with their lines. Meshes of other formats have names alone.

use super::report::SanitizeReport;
use crate::error::{Location, Log, SceneError};

/// Count of a report.
type Count = fn(&SanitizeReport) -> usize;

const LEFT_OUT: &str = "they are left out; repair or re-export the mesh";
const ZERO: &str = "0 is used instead; repair or re-export the mesh";

/// Counts with what they count, and what is used instead.
const KINDS: [(Count, &str, &str); 6] = [
    (|report| report.out_of_range, "triangles with a vertex that does not exist", LEFT_OUT),
    (|report| report.not_finite, "triangles with a position that is no finite number", LEFT_OUT),
    (|report| report.huge, "triangles beyond 1e18", "they are left out; scale the scene down"),
    (
        |report| report.nan_normals,
        "normals that are no finite numbers",
        "normals of the surface are used instead; repair or re-export the mesh",
    ),
    (|report| report.bad_uvs, "texture coordinates that are no finite numbers", ZERO),
    (
        |report| report.bad_tangents,
        "tangents that are no finite numbers",
        "the direction of growing u is used instead; repair or re-export the mesh",
    ),
];

/// Names of the first meshes with a loss of each kind.
#[derive(Default)]
pub(super) struct Losses([Option<String>; KINDS.len()]);

impl Losses {
    /// Keeps the name of a mesh whose repair changed the report.
    pub fn note(&mut self, mesh: &str, before: &SanitizeReport, after: &SanitizeReport) {
        for (first, (count, ..)) in self.0.iter_mut().zip(KINDS) {
            if count(after) > count(before) {
                first.get_or_insert_with(|| mesh.to_owned());
            }
        }
    }

    /// Warns of each kind of loss.
    ///
    /// # Errors
    /// Under `strict`.
    pub fn write(&self, report: &SanitizeReport, place: &Location, log: &mut Log) -> Result<(), SceneError> {
        for (first, (count, what, fallback)) in self.0.iter().zip(KINDS) {
            let Some(mesh) = first else { continue };
            log.warn(
                place,
                format!("{what}: {}, the first in the mesh \"{mesh}\"", count(report)),
                fallback,
            )?;
        }
        Ok(())
    }
}
