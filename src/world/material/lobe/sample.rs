//! A sampled direction and its weight.

use base::math::{Lane, Rgb, V3};
use glam::Vec3;

/// Sampled direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// Unit direction, away from the surface.
    pub wi: Vec3,
    /// BSDF · cos / pdf, for radiance. For flux (photons), which refraction does not compress, multiply by `eta`².
    pub weight: Rgb,
    /// Density per solid angle; for a delta lobe, the probability of its choice.
    pub pdf: f32,
    /// True if the lobe scatters into this direction only.
    pub delta: bool,
    /// Index of refraction on the side of `wi` over that on the side of `wo`; 1 unless refracted.
    pub eta: f32,
    /// True if light keeps its direction and changes only its colour.
    pub straight: bool,
}

/// Directions into which a delta lobe scatters light, with probability 1.
pub(in crate::material) struct Delta<L: Lane> {
    pub wi: V3<L>,
    /// Reflectance or transmittance, for radiance.
    pub weight: V3<L>,
    /// Index of refraction on the side of `wi` over that on the side of `wo`.
    pub eta: L,
    /// Lanes in which light is scattered.
    pub found: L::Mask,
    /// True if light keeps its direction.
    pub straight: bool,
}
