//! Memory that a scene needs, estimated before it is allocated.
//!
//! A short description may name large files. It may also place one mesh many times, and each instance is a copy.

use super::error::{Location, SceneError};
use base::stats::available_bytes;
use scene::requirements::BVH_BYTES_PER_TRIANGLE;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Estimated bytes per triangle of a scene that is ready to be rendered: half a vertex, three indices, and the
/// hierarchy.
const TRIANGLE_BYTES: u64 = 36 + BVH_BYTES_PER_TRIANGLE as u64;

/// Bytes up to which the available memory is not asked for.
const MIN_CHECKED_BYTES: u64 = 48 << 20;

/// Returns a description of `bytes` and of the available memory, if fewer bytes are available.
pub fn lacking(bytes: u64) -> Option<String> {
    let available = if bytes > MIN_CHECKED_BYTES { available_bytes()? } else { return None };
    let [needed, left] = [bytes, available].map(|bytes| bytes >> 20);
    (bytes > available).then(|| format!("about {needed} MiB of memory, and {left} MiB are available"))
}

/// Number of triangles that fit into memory, shared by all tasks that place meshes.
#[derive(Clone, Debug, Default)]
pub(crate) struct TriangleBudget(Arc<TriangleCounts>);

#[derive(Debug, Default)]
struct TriangleCounts {
    placed: AtomicU64,
    limit: OnceLock<u64>,
}

impl TriangleBudget {
    /// Counts the triangles of a mesh described at `place`.
    ///
    /// # Errors
    /// If all triangles so far do not fit into memory.
    pub fn take(&self, triangles: usize, place: &Location) -> Result<(), SceneError> {
        let TriangleCounts { placed, limit } = &*self.0;
        let limit = *limit.get_or_init(|| available_bytes().map_or(u64::MAX, |bytes| bytes / TRIANGLE_BYTES));
        let before = placed.fetch_add(triangles as u64, Ordering::Relaxed);
        if before.saturating_add(triangles as u64) <= limit {
            return Ok(());
        }
        let what =
            format!("its meshes, with all instances, exceed the {limit} triangles that fit into memory");
        Err(Location::file(&place.path).wrong(what, "leave some of them out"))
    }
}
