//! Derivatives of the light from one virtual light as its receiver moves over the surface: they extrapolate a
//! cache record to its surroundings.
//!
//! All quantities are per unit intensity and for unchanged visibility, in the record's frame: u and v are the
//! tangents x and y, n the normal z. Derivatives are by the motion of the receiver along u and v, the frame
//! kept.
//!
//! Paper: Herzog, Myszkowski and Seidel, *Anisotropic Radiance-Cache Splatting for Efficiently Computing
//! High-Quality Global Illumination with Lightcuts*, Eurographics 2009, equations 8 and 9; the second
//! derivatives follow the same way.
//! Deviations: written in the unit direction and the inverse distance, so that single precision neither
//! overflows nor underflows whatever the scene's scale. The receiver's cosine is not part of the factor,
//! because records of radiance have none; irradiance gets it from the direction.

mod incidence;
mod profile;
mod source;

pub use incidence::Incidence;
pub use source::LocalVpl;

#[cfg(test)]
mod tests;
