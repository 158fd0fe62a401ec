//! Photon mapping: flux of photons stored on surfaces, gathered over the hemisphere.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996; Christensen, *Faster Photon Map Global
//! Illumination*, 1999; Ward and Heckbert, *Irradiance Gradients*, 1992; Krivanek et al., *Radiance Caching*,
//! 2005.
//!
//! - [`map`]: photons, ordered so that neighbours in space are neighbours in memory;
//! - [`density`]: irradiance from the photons around a point; [`disc`]: the part of the disc around the point that
//!   is surface;
//! - [`irradiance`]: look-ups of irradiance anywhere;
//! - [`strata`]: directions of a final gathering; [`hemisphere`]: the surfaces that they hit, and gradients;
//! - [`indirect_light`]: light that a surface reflects along a ray; [`near`]: light of surfaces nearer than the
//!   map resolves; [`radiance`]: light along packets of rays;
//! - [`records`]: records of indirect light for the cache; [`own`]: light at single samples.

pub mod density;
pub mod disc;
pub mod hemisphere;
pub mod indirect_light;
pub mod irradiance;
pub mod map;
pub mod near;
pub mod own;
pub mod radiance;
pub mod records;
pub mod strata;
#[cfg(test)]
mod tests;

pub use irradiance::IrradianceMap;
pub use map::PhotonMap;
