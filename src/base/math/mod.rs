//! Mathematics shared by all stages: linear colour, directions, cones, orthonormal frames, quadrature, and lanes of
//! numbers.

mod cone;
mod frame;
mod lanes;
mod quadrature;
mod real;
mod unit;

pub use cone::Cone;
pub use frame::Frame;
pub use lanes::{F32x16, LANES, U32x16, Vec2x16, Vec3x16, first_lanes, lanes_in, mask_of};
pub use quadrature::gauss_legendre;
pub use real::{F32x8, Real, WIDTH};
pub use unit::{right_of, unit};

/// Linear colour with sRGB (Rec. 709) primaries: radiance, irradiance, flux or reflectance as the name says.
pub type Rgb = glam::Vec3;

/// Rec. 709 luminance weights, `dot` them with an [`Rgb`].
pub const LUMINANCE: Rgb = Rgb::new(0.2126, 0.7152, 0.0722);

/// Luminance of a linear colour, in the colour's own unit.
#[inline]
pub fn luminance(c: Rgb) -> f32 {
    c.dot(LUMINANCE)
}
