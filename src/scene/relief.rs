//! Reliefs: textures that turn the shading normals of a surface.

use super::texture::TextureId;

/// Relief of a surface, by a texture whose texels are taken as they are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relief {
    /// Normals in the frame of the texture coordinates: texels from 0 to 1 stand for coordinates from -1 to 1, of which
    /// x is along ∂p/∂u, z along the shading normal.
    Normals {
        /// The texture.
        texture: TextureId,
        /// Factor on x and y.
        strength: f32,
        /// True: y points towards growing v (as in glTF, where v is turned up). False: it completes a right-handed
        /// frame, also where the texture is mirrored (as in Mitsuba).
        y_along_v: bool,
    },
    /// Heights above the surface, by the luminances of texels.
    Heights {
        /// The texture.
        texture: TextureId,
        /// Height in the scene's unit that a texel of 1 stands for.
        scale: f32,
    },
}
