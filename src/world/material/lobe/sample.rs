//! A sampled direction and its weight.

use base::math::Rgb;
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

impl BsdfSample {
    /// Makes the sample of a delta lobe that is chosen with probability 1.
    #[inline]
    pub(in crate::material) fn delta(wi: Vec3, weight: Rgb, eta: f32) -> BsdfSample {
        BsdfSample { wi, weight, pdf: 1.0, delta: true, eta, straight: false }
    }
}
