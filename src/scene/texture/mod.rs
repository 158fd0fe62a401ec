//! Textures: the layout of texels in memory, interpolation between them, their mip maps, and the part of a texture that
//! a ray stands for.
//!
//! The module is not a crate of its own. The scene has the textures, and everything else here needs only `base`. All
//! crates that look textures up use the scene already. [`Textures`] is shared, so materials and emitters hold what they
//! look up and copy no texels.

mod coverage;
mod halving;
mod image;
mod mip_maps;
mod texels;
mod textures;

pub use coverage::{covered, uv_scale};
pub use image::{AttributeTexture, Filter, Texture, TextureId, Wrap};
pub use mip_maps::MipMaps;
pub use texels::Texels;
pub use textures::Textures;
