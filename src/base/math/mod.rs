//! Mathematics shared by all stages: linear colour, directions, cones, orthonormal frames, affine transforms,
//! quadrature, and lanes of numbers.

mod cone;
mod frame;
mod lane;
mod lanes;
mod morton;
mod placement;
mod quadrature;
mod unit;
mod vector;

pub use cone::Cone;
pub use frame::Frame;
pub use lane::{Lane, Mask, Mask16, f32x16};
pub use lanes::{F32x16, LANES, U32x16, Vec2x16, Vec3x16, first_lanes, lanes_in, lanes_with, mask_of};
pub use morton::morton;
pub use placement::Placement;
pub use quadrature::gauss_legendre;
pub use unit::{right_of, unflattened, unit};
pub use vector::V3;

/// Linear colour with Rec. 709 primaries: radiance, irradiance, flux or reflectance, as the variable's name says.
pub type Rgb = glam::Vec3;

/// Luminance weights of Rec. 709.
pub const LUMINANCE: Rgb = Rgb::new(0.2126, 0.7152, 0.0722);

/// Returns the luminance of a linear colour, in the colour's unit.
#[inline]
pub fn luminance(c: Rgb) -> f32 {
    c.dot(LUMINANCE)
}
