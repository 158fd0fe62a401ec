//! Photon mapping: flux of photons stored on surfaces, gathered over the hemisphere.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996; Christensen, *Faster Photon Map Global
//! Illumination*, 1999; Ward and Heckbert, *Irradiance Gradients*, 1992; Krivanek et al., *Radiance Caching*,
//! 2005.
//!
//! - [`map`]: the photons, in an order in which neighbours in space are neighbours in memory;
//! - [`density`]: irradiance from the photons around a point; [`disc`]: the part of the disc around it that
//!   is surface;
//! - [`irradiance`]: look-ups of it anywhere;
//! - [`strata`]: the directions of a final gathering; [`hemisphere`]: the surfaces they hit, and gradients;
//! - [`indirect_light`]: light that a surface reflects along a ray; [`near`]: from surfaces nearer than the
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
