//! Safe interface to Embree 4: device, triangle scene, closest-hit and occlusion queries for single rays and packets.
//!
//! Only this crate and `vendor-bindings/` contain unsafe code.
//!
//! A [`Device`] is created once, an [`Accel`] once per scene. Any number of threads may query the `Accel`. Guarantees
//! of the queries, and their limits:
//!
//! * Every answer is for the segment `t_near < t <= t_far` of the ray, half-open up to rounding. It is the same for any
//!   number of threads. It is *not* bit-identical between processors (Embree has AVX-512, AVX2 and SSE kernels). A
//!   packet may differ from single rays for rays within rounding of an edge.
//! * Hits next to the origin count. The caller has to keep rays off their own surface.
//! * A ray hits nothing if its origin or direction is NaN or infinite, its direction is zero, `t_near > t_far`, or
//!   either is NaN. `t_far` may be infinite.
//! * Both sides of a triangle are hit. Triangles of zero area are not.
//! * The floating-point control word (MXCSR) of the calling thread stays unchanged.
//!
//! A group of meshes may be stored once and seen at several places ([`PlacedGroup`]). Hits number the seen meshes:
//! first the meshes without placements, then the meshes of each group, placement by placement.
//!
//! Units: `t` is in lengths of the ray's direction, which need not be a unit vector.

#![allow(unsafe_code)]

mod accel;
mod crossed;
mod device;
mod error;
mod leave;
mod numbers;
mod occluder;
mod packet;
mod placed;
mod prepared;
mod query;
mod raw_scene;
mod ray;
mod tbb;
#[cfg(test)]
mod tests;
mod triangles;
mod version;
mod width;

pub use accel::Accel;
pub use device::Device;
pub use error::EmbreeError;
pub use leave::leave;
pub use occluder::{Occluder, Occluders16, TriangleId};
pub use packet::{Hits16, Rays16};
pub use placed::PlacedGroup;
pub use prepared::PreparedRays;
pub use ray::{Hit, Ray};
pub use tbb::tbb_version;
pub use triangles::TriangleMesh;
pub use version::Version;
pub use width::Width;
