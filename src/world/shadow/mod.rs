//! Shadow rays: segments whose ends are offset from their surfaces, and the engine that tests them for occlusion, one
//! by one or in packets.
//!
//! [`segment()`] and [`ray_from`] make rays. [`Engine`] traces and counts them, and may test an occluder cache first.
//! The cache changes the time of a query and which occluder it returns, but never whether a ray is occluded.

mod cache;
mod counts;
mod engine;
mod segment;
#[cfg(test)]
mod tests;

pub use cache::{OccluderCacheSettings, ShadowSettings};
pub use counts::ShadowCounts;
pub use engine::Engine;
pub use segment::{Segment, arriving, ray_from, segment, to_light};
