//! Last steps of reading, for all formats alike: repairs, division of large meshes, and local coordinates.

mod coincident;
pub mod divide;
pub mod framing;
pub mod recentre;
pub mod sanitize;
