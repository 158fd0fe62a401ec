//! Shadow rays: segments that keep off their ends, packets of them, and the engine that answers whether they are free.
//!
//! [`segment()`] and [`ray_from`] make rays, [`Packing`] says what shares a packet and how it is traced,
//! [`Engine`] traces, counts, and may ask an [`OccluderCache`] first. The cache changes how long an answer takes
//! and which occluder is named, never whether there is one.

mod batch;
mod cache;
mod counts;
mod engine;
mod packing;
mod segment;
mod settings;
#[cfg(test)]
mod tests;

pub use batch::{Batch, End};
pub use cache::{OccluderCache, OccluderCacheSettings};
pub use counts::{Counts, Tally};
pub use engine::Engine;
pub use packing::Packing;
pub(crate) use segment::ULPS;
pub use segment::{escapes, offset, ray_from, segment, visible};
pub use settings::ShadowSettings;
