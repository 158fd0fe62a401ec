//! Final gathering over the irradiance of photons ([`crate::irradiance`]).
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996; Christensen, *Faster Photon Map Global
//! Illumination*, 1999; Ward and Heckbert, *Irradiance Gradients*, 1992; Krivanek et al., *Radiance Caching*,
//! 2005.
//!
//! - [`strata`]: directions of a final gathering; [`hemisphere`]: the surfaces that they hit, and gradients;
//! - [`indirect_light`]: light that a surface reflects along a ray; [`near`]: light of surfaces nearer than the
//!   map resolves; [`radiance`]: light along packets of rays;
//! - [`records`]: records of indirect light for the cache; [`own`]: light at single samples.

pub mod hemisphere;
pub mod indirect_light;
pub mod near;
pub mod own;
pub mod radiance;
pub mod records;
pub mod strata;
#[cfg(test)]
mod tests;
