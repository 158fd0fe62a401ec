//! Last steps of reading, common to all formats: repairs, division of large triangles, and local coordinates.

mod coincident;
mod corners;
mod dark;
pub mod divide;
pub mod framing;
pub mod recentre;
pub mod sanitize;
pub mod wanted;
