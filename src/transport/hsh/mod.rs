//! Hemispherical harmonics (HSH): an orthonormal basis over the hemisphere above a surface, in which cache
//! records of glossy surfaces represent incoming radiance.
//!
//! An [`Accumulator`] sums the light of a record into a [`Radiance`]. [`MaterialSeries`] holds the reflection
//! of each material of a scene: seen from one inclination it is a [`kernel::Profile`], from one direction a
//! [`Kernel`], and [`Radiance::reflected`] is the radiance that the surface reflects there. Two bands hold
//! the irradiance exactly.
//!
//! Functions are numbered k = l² + l + m: degree l (the band) from 0, order m from -l to l, negative orders
//! being those with sin |m|φ. The first n² functions are the first n bands.
//!
//! Directions are local: z is the surface normal, x and y are its tangents u and v, unit length.
//!
//! Paper: Gautron, Křivánek, Pattanaik and Bouatouch, *A Novel Hemispherical Basis for Accurate and Efficient
//! Rendering*, EGSR 2004.
//! Deviations: see [`basis::for_each`]: no poles.

mod accumulate;
mod basis;
mod kernel;
mod lobe_table;
mod material_series;
mod projection;
mod radiance;

pub use accumulate::Accumulator;
pub use kernel::Kernel;
pub use material_series::{Caching, MaterialSeries, SeriesSettings};
pub use radiance::{Radiance, Reflected};

/// Number of colour channels.
const CHANNELS: usize = 3;

#[cfg(test)]
mod tests;
