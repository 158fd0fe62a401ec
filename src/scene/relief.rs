//! Reliefs: textures that change the shading normals of a surface.

use super::texture::TextureId;

/// Relief of a surface, from the raw texels of a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    /// Normals in the frame of the texture coordinates: x along ∂p/∂u, z along the shading normal.
    ///
    /// Texels from 0 to 1 stand for coordinates from -1 to 1.
    Normals {
        /// The texture.
        texture: TextureId,
        /// Factor on x and y.
        strength: f32,
        /// True if y points along growing v, as in glTF with v upwards. Else y completes a right-handed frame, as in
        /// Mitsuba, also if the texture is mirrored.
        y_along_v: bool,
    },
    /// Heights above the surface, from the luminance of texels.
    Heights {
        /// The texture.
        texture: TextureId,
        /// Height of a texel of 1, in the scene's unit.
        scale: f32,
    },
}
