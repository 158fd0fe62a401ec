//! Owen-scrambled Sobol points and the warps from the unit square.

mod packet;
mod sobol;
mod warp;

pub use packet::Samplers16;
pub use sobol::{Sampler, hash, owen_sobol_2d, owen_van_der_corput};
pub use warp::{cosine_hemisphere, uniform_disk, uniform_sphere, uniform_triangle};
