//! Owen-scrambled Sobol points, the warps from the unit square, and weights for combining samples.

mod packet;
mod sobol;
mod warp;

pub use packet::Samplers16;
pub use sobol::{Sampler, hash, owen_sobol_2d, unit};
pub use warp::{
    cosine_direction, cosine_hemisphere, disk_point, uniform_disk, uniform_sphere, uniform_triangle,
};

/// Returns the MIS weight of a sample of density `a` against another technique of density `b` (Veach, β = 2).
#[inline(always)]
pub fn power_heuristic(a: f32, b: f32) -> f32 {
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
