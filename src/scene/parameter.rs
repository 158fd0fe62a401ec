//! Parameters of materials: constant, or textured.

use super::texture::TextureId;
use base::math::{Rgb, luminance};
use std::ops::Mul;

/// Colour or number that may vary over the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Parameter<T> {
    /// A constant value.
    Constant(T),
    /// The texture's value times `scale`. A number uses the luminance of each texel.
    Textured {
        /// Index of the texture.
        texture: TextureId,
        /// Factor on every texel.
        scale: T,
    },
}

/// Fraction of the light that is scattered, per channel.
pub type Reflectance = Parameter<Rgb>;

/// Microfacet roughness α.
pub type Roughness = Parameter<f32>;

/// Number from 0 to 1.
pub type Share = Parameter<f32>;

impl<T: Copy + Mul<Output = T>> Parameter<T> {
    /// Returns the value of the parameter; `texel` returns the value of a texture.
    #[inline]
    pub fn value(&self, texel: impl FnOnce(TextureId) -> T) -> T {
        match *self {
            Parameter::Constant(value) => value,
            Parameter::Textured { texture, scale } => texel(texture) * scale,
        }
    }

    /// Returns the texture; `None` for a constant.
    pub fn texture(&self) -> Option<TextureId> {
        match *self {
            Parameter::Constant(_) => None,
            Parameter::Textured { texture, .. } => Some(texture),
        }
    }

    /// True if the parameter is textured.
    pub fn is_textured(&self) -> bool {
        matches!(self, Parameter::Textured { .. })
    }
}

impl Share {
    /// Returns the number, from 0 to 1; `texel` returns the colour of a texture.
    #[inline]
    pub fn share(&self, texel: impl FnOnce(TextureId) -> Rgb) -> f32 {
        self.value(|id| luminance(texel(id))).clamp(0.0, 1.0)
    }
}

impl<T> From<T> for Parameter<T> {
    fn from(value: T) -> Parameter<T> {
        Parameter::Constant(value)
    }
}

impl Reflectance {
    /// Returns the parameter times a factor.
    pub fn times(self, factor: Rgb) -> Reflectance {
        match self {
            Reflectance::Constant(value) => Reflectance::Constant(value * factor),
            Reflectance::Textured { texture, scale } => {
                Reflectance::Textured { texture, scale: scale * factor }
            }
        }
    }

    /// Reflectance 0.
    pub const BLACK: Reflectance = Reflectance::Constant(Rgb::ZERO);
}

impl Default for Reflectance {
    fn default() -> Reflectance {
        Reflectance::BLACK
    }
}
