//! Hemispherical harmonics (HSH): an orthonormal basis over the hemisphere above a surface, in which cache records
//! of glossy surfaces keep the light that arrives.
//!
//! Functions are numbered k = l² + l + m: degree l (the band) from 0, order m from -l to l, negative orders
//! being those with sin |m|φ. The first n² functions are the first n bands.
//!
//! Directions are local: z is the surface normal, x and y are its tangents u and v, unit length.
//!
//! Paper: Gautron, Křivánek, Pattanaik and Bouatouch, *A Novel Hemispherical Basis for Accurate and Efficient
//! Rendering*, EGSR 2004.
//! Deviations: see [`for_each`]: no poles.

mod accumulate;
mod basis;
mod kernel;
mod radiance;

pub use accumulate::Accumulator;
pub use basis::{MAX_BANDS, MAX_FUNCTIONS, evaluate, for_each, index};
pub use kernel::{Kernel, MAX_EVEN, Profile, even_index};
pub use radiance::{Radiance, Reflected};

#[cfg(test)]
mod tests;
