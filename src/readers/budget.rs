//! Memory for a scene's files, pictures and triangles, reckoned before it is spent: a description of few lines may name
//! large files, and place a mesh many times, of which every instance is a copy.

use super::error::{Place, SceneError};
use base::stats::available_bytes;
use scene::requirements::BVH_BYTES_PER_TRIANGLE;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};

/// Memory of a triangle once a scene is ready to be rendered, about: half a vertex, three indices, and its part of the
/// hierarchy.
const TRIANGLE_BYTES: u64 = 36 + BVH_BYTES_PER_TRIANGLE as u64;

/// Memory from which on it is compared with what is available.
const MUCH: u64 = 48 << 20;

/// Says how much memory `bytes` are and how much is available, if that is less.
pub fn lacking(bytes: u64) -> Option<String> {
    let available = if bytes > MUCH { available_bytes()? } else { return None };
    let [needed, left] = [bytes, available].map(|bytes| bytes >> 20);
    (bytes > available).then(|| format!("about {needed} MiB of memory, and {left} MiB are available"))
}

/// Triangles for which there is memory, shared by all who place some.
#[derive(Clone, Debug, Default)]
pub(crate) struct TriangleBudget(Arc<Counts>);

#[derive(Debug, Default)]
struct Counts {
    placed: AtomicU64,
    limit: OnceLock<u64>,
}

impl TriangleBudget {
    /// Counts triangles that a mesh described at `place` is about to take memory for; an error if that is not there.
    pub fn take(&self, triangles: usize, place: &Place) -> Result<(), SceneError> {
        let Counts { placed, limit } = &*self.0;
        let limit = *limit.get_or_init(|| available_bytes().map_or(u64::MAX, |bytes| bytes / TRIANGLE_BYTES));
        let before = placed.fetch_add(triangles as u64, Ordering::Relaxed);
        if before.saturating_add(triangles as u64) <= limit {
            return Ok(());
        }
        let what = format!(
            "its meshes, instances counted each, come to more than the {limit} triangles that there is memory for"
        );
        Err(Place::file(&place.path).wrong(what, "leave some of them out"))
    }
}
