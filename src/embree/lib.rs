//! Safe interface to Embree 4: device, triangle scene, closest-hit and occlusion queries for one ray and for
//! packets. With `vendor-bindings/`, the only place with unsafe code.
//!
//! A [`Device`] is created once, an [`Accel`] once per scene; queries go to the `Accel` from any number of
//! threads. Guarantees of the queries, and their limits:
//!
//! * Every answer is for the segment `t_near < t <= t_far` of the ray, half-open up to rounding, and is the
//!   same for any number of threads. It is *not* the same bit for bit between processors (Embree has AVX-512,
//!   AVX2 and SSE kernels), nor need a packet agree with single rays where a ray passes within rounding of an
//!   edge.
//! * A hit next to the origin is a hit: the caller has to keep rays off their own surface.
//! * A ray with a NaN or infinite origin or direction, a zero direction, or `t_near > t_far` or either NaN
//!   hits nothing. `t_far` may be infinite.
//! * Both sides of a triangle are hit; triangles of zero area are not.
//! * The floating-point control word (MXCSR) of the calling thread is left as it is.
//!
//! Units: `t` counts in lengths of the ray's direction, which need not be a unit vector.

#![allow(unsafe_code)]

mod accel;
mod crossed;
mod device;
mod error;
mod leave;
mod occluder;
mod packet;
mod prepared;
mod query;
mod ray;
#[cfg(test)]
mod tests;
mod version;
mod width;

pub use accel::{Accel, BuildQuality, TriangleMesh};
pub use device::Device;
pub use error::EmbreeError;
pub use leave::leave;
pub use occluder::{Occluder, Occluders16, TriangleId};
pub use packet::{Hits16, Rays16};
pub use prepared::PreparedRays;
pub use ray::{Hit, Ray};
pub use version::Version;
pub use width::Width;
