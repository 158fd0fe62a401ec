//! Attributes of meshes as textures.

use super::image::TextureId;
use crate::attribute::AttributeId;

/// First of the ids of attribute textures.
const FIRST: u32 = 1 << 31;

/// Texture that is an attribute of the mesh, or the product of an attribute and an image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AttributeTexture {
    /// The attribute.
    pub attribute: AttributeId,
    /// The image.
    pub image: Option<TextureId>,
    /// Value from which on the texture is 1, and below which it is 0. Masks alone have one.
    pub cut: Option<f32>,
}

impl TextureId {
    /// Returns the id of the attribute texture of a number.
    pub fn of_attribute(number: usize) -> TextureId {
        TextureId(FIRST | number as u32)
    }

    /// Returns the number of the attribute texture; `None` for an image.
    #[inline]
    pub fn attribute_number(self) -> Option<usize> {
        (self.0 >= FIRST).then_some((self.0 ^ FIRST) as usize)
    }
}
