//! Hemispherical harmonics (HSH): an orthonormal basis over the hemisphere above a surface, in which cache
//! records of glossy surfaces represent incoming radiance.
//!
//! An [`Accumulator`] sums the light of a record into a [`Radiance`]. [`MaterialSeries`] holds the reflection of each
//! material of a scene: a [`kernel::Profile`] for one inclination of view, a [`Kernel`] for one direction of view.
//! [`Radiance::reflected`] returns the radiance that the surface reflects in this direction. Two bands hold the
//! irradiance exactly.
//!
//! Functions are numbered k = l² + l + m: degree l (the band) from 0, order m from -l to l. Negative orders have the
//! factor sin |m|φ. The first n² functions are the first n bands.
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

#[cfg(test)]
mod tests;
