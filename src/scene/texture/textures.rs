//! The textures of a scene, shared by all that look them up.

use super::image::{Texture, TextureId};
use base::math::Rgb;
use glam::Vec2;
use std::ops::Deref;
use std::sync::Arc;

/// Textures of a scene, indexed by [`TextureId`]. A clone shares the texels.
#[derive(Clone, Debug)]
pub struct Textures(Arc<[Texture]>);

impl Textures {
    /// Returns the texture of an id; `None` if there is none.
    #[inline]
    pub fn by_id(&self, id: TextureId) -> Option<&Texture> {
        self.0.get(id.0 as usize)
    }

    /// Returns the textures for changes. They are copied first if they are shared.
    pub fn edit(&mut self) -> &mut [Texture] {
        Arc::make_mut(&mut self.0)
    }

    /// Returns the colour of a texture at texture coordinates `uv`; white if there is no such texture.
    #[inline]
    pub fn lookup(&self, id: TextureId, uv: Vec2) -> Rgb {
        self.by_id(id).map_or(Rgb::ONE, |texture| texture.lookup(uv))
    }
}

impl FromIterator<Texture> for Textures {
    fn from_iter<I: IntoIterator<Item = Texture>>(textures: I) -> Textures {
        Textures(textures.into_iter().collect())
    }
}

impl Default for Textures {
    fn default() -> Textures {
        Textures::from(Vec::new())
    }
}

impl From<Vec<Texture>> for Textures {
    fn from(textures: Vec<Texture>) -> Textures {
        Textures(textures.into())
    }
}

impl<'a> IntoIterator for &'a Textures {
    type Item = &'a Texture;
    type IntoIter = std::slice::Iter<'a, Texture>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl Deref for Textures {
    type Target = [Texture];

    #[inline]
    fn deref(&self) -> &[Texture] {
        &self.0
    }
}
