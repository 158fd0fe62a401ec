//! Shadow rays: segments that keep off their ends, packets of them, and the engine that answers whether they are free.
//!
//! [`segment()`] and [`ray_from`] make rays; [`Engine`] traces and counts them, and may ask an occluder cache first.
//! The cache changes how long an answer takes and which occluder is named, never whether there is one.

mod cache;
mod counts;
mod engine;
mod segment;
mod settings;
#[cfg(test)]
mod tests;

pub use cache::OccluderCacheSettings;
pub use counts::{QueryCounts, ShadowCounts};
pub use engine::Engine;
pub(crate) use segment::ULPS;
pub use segment::{escapes, offset, ray_from, segment, visible};
pub use settings::ShadowSettings;
