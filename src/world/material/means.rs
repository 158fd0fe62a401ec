//! Means of a scene's textures.

use base::math::Rgb;
use rayon::prelude::*;
use scene::{AttributeTexture, Scene, Texture, TextureId};

/// Mean of each texture of a scene, over its texels or over the surfaces that have its attribute.
pub(super) struct TextureMeans {
    images: Vec<Rgb>,
    /// Attribute textures and their means.
    attributes: Vec<Rgb>,
}

impl TextureMeans {
    /// Computes the mean of each texture. That of a product is the product of the means, as if nothing cut it.
    pub fn new(scene: &Scene) -> TextureMeans {
        let textures = &scene.textures;
        let images: Vec<Rgb> = textures.par_iter().map(Texture::mean).collect();
        let of_attribute = |AttributeTexture { attribute, image, .. }: &AttributeTexture| {
            let of_image = image.and_then(|id| images.get(id.0 as usize)).copied();
            scene.attribute_mean(*attribute) * of_image.unwrap_or(Rgb::ONE)
        };
        let attributes = textures.attributes().iter().map(of_attribute).collect();
        TextureMeans { images, attributes }
    }

    /// Returns the mean of a texture; white if there is no such texture.
    pub fn of(&self, id: TextureId) -> Rgb {
        let found = self.images.get(id.0 as usize).or_else(|| self.attributes.get(id.attribute_number()?));
        found.copied().unwrap_or(Rgb::ONE)
    }
}
