//! The textures of a scene, shared by all that look them up.

use super::image::{AttributeTexture, Texture, TextureId, cut};
use crate::attribute::AttributeId;
use base::math::Rgb;
use glam::Vec2;
use std::ops::Deref;
use std::sync::Arc;

/// Textures of a scene by [`TextureId`]: images, and attributes of meshes. A clone shares the texels.
///
/// As a slice, the type is the slice of the images.
#[derive(Clone, Debug)]
pub struct Textures {
    images: Arc<[Texture]>,
    attributes: Arc<[AttributeTexture]>,
}

impl Textures {
    /// Returns the images with textures that are attributes of meshes.
    pub fn with_attributes(self, attributes: Vec<AttributeTexture>) -> Textures {
        Textures { attributes: attributes.into(), ..self }
    }

    /// Returns the image of an id; `None` if there is none.
    #[inline]
    pub fn by_id(&self, id: TextureId) -> Option<&Texture> {
        self.images.get(id.0 as usize)
    }

    /// Returns the attribute texture of an id; `None` for images.
    pub fn attribute(&self, id: TextureId) -> Option<&AttributeTexture> {
        self.attributes.get(id.attribute_number()?)
    }

    /// Returns all textures that are attributes of meshes.
    pub fn attributes(&self) -> &[AttributeTexture] {
        &self.attributes
    }

    /// Adds images behind those that are there, which are copied.
    pub fn add(&mut self, images: Vec<Texture>) {
        if !images.is_empty() {
            self.images = self.images.iter().cloned().chain(images).collect();
        }
    }

    /// Returns the colour of a texture at a point with the texture coordinates `uv`; white if there is no such texture.
    /// `attribute` returns the value of an attribute at the point.
    #[inline]
    pub fn lookup(&self, id: TextureId, uv: Vec2, attribute: impl FnOnce(AttributeId) -> Rgb) -> Rgb {
        match self.by_id(id) {
            Some(image) => image.lookup(uv),
            None => self.lookup_attribute(id, uv, attribute),
        }
    }

    /// Returns the colour of an attribute texture; see [`Textures::lookup`]. Few scenes have one, so look-ups of images
    /// stay free of this code.
    #[cold]
    #[inline(never)]
    pub(super) fn lookup_attribute(
        &self,
        id: TextureId,
        uv: Vec2,
        attribute: impl FnOnce(AttributeId) -> Rgb,
    ) -> Rgb {
        let Some(texture) = self.attribute(id) else { return Rgb::ONE };
        let image = texture.image.and_then(|image| self.by_id(image));
        let value = image.map_or(Rgb::ONE, |image| image.lookup(uv)) * attribute(texture.attribute);
        texture.cut.map_or(value, |from| cut(value, from))
    }
}

impl FromIterator<Texture> for Textures {
    fn from_iter<I: IntoIterator<Item = Texture>>(textures: I) -> Textures {
        Textures { images: textures.into_iter().collect(), attributes: Arc::new([]) }
    }
}

impl Default for Textures {
    fn default() -> Textures {
        Textures::from(Vec::new())
    }
}

impl From<Vec<Texture>> for Textures {
    fn from(textures: Vec<Texture>) -> Textures {
        Textures { images: textures.into(), attributes: Arc::new([]) }
    }
}

impl<'a> IntoIterator for &'a Textures {
    type Item = &'a Texture;
    type IntoIter = std::slice::Iter<'a, Texture>;

    fn into_iter(self) -> Self::IntoIter {
        self.images.iter()
    }
}

impl Deref for Textures {
    type Target = [Texture];

    #[inline]
    fn deref(&self) -> &[Texture] {
        &self.images
    }
}
