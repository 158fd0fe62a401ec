//! Derivatives of the light from one virtual light as its receiver moves over the surface. They extrapolate a cache
//! record to its surroundings.
//!
//! All quantities are per unit intensity and for unchanged visibility, in the record's frame: u and v are the
//! tangents x and y, n is the normal z. Derivatives are with respect to motion of the receiver along u and v in a fixed
//! frame.
//!
//! Paper: Herzog, Myszkowski and Seidel, *Anisotropic Radiance-Cache Splatting for Efficiently Computing
//! High-Quality Global Illumination with Lightcuts*, Eurographics 2009, equations 8 and 9. The second derivatives are
//! derived likewise.
//! Deviations: formulas use the unit direction and the inverse distance, so that single precision neither overflows nor
//! underflows at any scale of the scene. The receiver's cosine is not part of the factor, since records of radiance
//! have none; irradiance gets it from the direction.

mod incidence;
mod source;

pub use incidence::Incidence;
pub use source::LocalVpl;

#[cfg(test)]
pub(crate) mod tests;
