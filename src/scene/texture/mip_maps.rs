//! Mip maps: means of textures over the area that a ray stands for.
//!
//! Paper: L. Williams, *Pyramidal Parametrics*, 1983.
//! Deviations: a lookup reads one level, the coarsest whose texels are no larger than half of the area that the lookup
//! stands for. Linear interpolation reaches twice as far as a texel is wide, and the next level blurs fine patterns.
//! Pixels take several samples, which hide the steps between levels and average along areas that are longer than wide.

use super::image::{Filter, Texture, TextureId};
use super::textures::Textures;
use crate::attribute::AttributeId;
use base::math::Rgb;
use glam::Vec2;

/// Textures, some of them with coarser versions.
#[derive(Clone, Debug)]
pub struct MipMaps {
    textures: Textures,
    /// Coarser versions by texture; empty if no texture has any.
    pyramids: Vec<Pyramid>,
}

/// Coarser versions of a texture.
#[derive(Clone, Debug, Default)]
struct Pyramid {
    /// Textures, each half as wide and high as the one before; the first is half as wide as the original.
    levels: Vec<Texture>,
    /// Half the number of texels along the side of a unit square of texture coordinates.
    half_texels: f32,
}

impl MipMaps {
    /// Shares `textures`, and computes coarser versions of the `filtered` ones. Cut textures have none.
    pub fn new(textures: &Textures, filtered: impl Iterator<Item = TextureId>) -> MipMaps {
        let mut pyramids: Vec<Pyramid> = Vec::new();
        for TextureId(id) in filtered {
            let may_be_coarser =
                |texture: &&Texture| texture.texels.len() > 1 && !matches!(texture.filter, Filter::Cut(_));
            let Some(texture) = textures.get(id as usize).filter(may_be_coarser) else { continue };
            pyramids.resize(textures.len(), Pyramid::default());
            let pyramid = &mut pyramids[id as usize];
            if pyramid.levels.is_empty() {
                let texels = texture.width as f32 * texture.height as f32 * texture.to_uv.determinant().abs();
                *pyramid = Pyramid { levels: coarser(texture), half_texels: 0.5 * texels.sqrt() };
            }
        }
        MipMaps { textures: textures.clone(), pyramids }
    }

    /// Returns the textures at full resolution.
    #[inline]
    pub fn textures(&self) -> &Textures {
        &self.textures
    }

    /// Returns true if some textures have coarser versions.
    #[inline]
    pub fn filter(&self) -> bool {
        !self.pyramids.is_empty()
    }

    /// Returns the colour of a texture at `uv`; white if there is no such texture. If the texture has coarser
    /// versions, the colour is the mean over a square of side `covered` in texture coordinates. `attribute` returns the
    /// value of an attribute.
    #[inline]
    pub fn lookup(
        &self,
        id: TextureId,
        uv: Vec2,
        covered: f32,
        attribute: impl FnOnce(AttributeId) -> Rgb,
    ) -> Rgb {
        match self.textures.by_id(id) {
            Some(texture) if covered > 0.0 => self.level(texture, id, covered).lookup(uv),
            Some(texture) => texture.lookup(uv),
            None => self.textures.lookup_attribute(id, uv, attribute),
        }
    }

    /// Returns the version of a texture for lookups that stand for a square of side `covered` in texture coordinates.
    #[inline]
    fn level<'a>(&'a self, finest: &'a Texture, id: TextureId, covered: f32) -> &'a Texture {
        let Some(Pyramid { levels, half_texels }) = self.pyramids.get(id.0 as usize) else { return finest };
        // The binary exponent is the integer part of the logarithm.
        let level = ((covered * half_texels).max(1.0).to_bits() >> 23) as usize - 127;
        match level.min(levels.len()) {
            0 => finest,
            level => &levels[level - 1],
        }
    }
}

/// Returns the levels of a texture, from half its size down to one texel.
fn coarser(texture: &Texture) -> Vec<Texture> {
    let mut levels: Vec<Texture> = Vec::new();
    loop {
        let finer = levels.last().unwrap_or(texture);
        if finer.texels.len() <= 1 {
            return levels;
        }
        let texels = finer.texels.halved();
        let (width, height) = ((finer.width / 2).max(1), (finer.height / 2).max(1));
        let Texture { filter, wrap, to_uv, .. } = *finer;
        levels.push(Texture { name: String::new(), width, height, texels, filter, wrap, to_uv });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::texture::{Texels, Wrap};
    use glam::Mat3;

    /// Returns a checker of 64 × 32 texels, black and white in the upper half, black and red in the lower half.
    fn checker() -> Texture {
        let texel = |i: usize| match (i % 64 + i / 64) % 2 {
            0 => Rgb::ZERO,
            _ if i / 64 < 16 => Rgb::ONE,
            _ => Rgb::X,
        };
        let texels: Vec<Rgb> = (0..64 * 32).map(texel).collect();
        let (filter, wrap, to_uv) = (Filter::Bilinear, Wrap::Repeat, Mat3::from_scale(Vec2::new(2.0, 1.0)));
        let texels = Texels::new(64, &texels);
        Texture { name: "checker".into(), width: 64, height: 32, texels, filter, wrap, to_uv }
    }

    #[test]
    fn levels_have_texels_half_as_large_as_what_is_covered() {
        let texture = checker();
        let maps = MipMaps::new(&vec![texture.clone()].into(), [TextureId(0)].into_iter());
        let levels: Vec<usize> = maps.pyramids[0].levels.iter().map(|level| level.texels.len()).collect();
        assert_eq!(levels, [512, 128, 32, 8, 2, 1]);
        // A texel is a square of this side on average: there are 128 by 32 texels per unit.
        let texel = 1.0 / 64.0;
        let count = |covered: f32| maps.level(&texture, TextureId(0), covered * texel).texels.len();
        let found = [0.0, 0.9, 3.9, 4.1, 7.9, 8.1, 1e3, 1e30, f32::INFINITY].map(count);
        assert_eq!(found, [2048, 2048, 2048, 512, 512, 128, 1, 1, 1]);
        assert_eq!(count(f32::NAN), 2048);
        // A texture without coarser versions.
        assert_eq!(maps.level(&texture, TextureId(7), 1e3).texels.len(), 2048);
    }

    #[test]
    fn levels_are_the_means_of_what_their_texels_cover() {
        let texture = checker();
        let maps = MipMaps::new(&vec![texture.clone()].into(), [TextureId(0)].into_iter());
        for covered in [8.0, 16.0, 32.0] {
            for i in 0..20 {
                let at = |y: f32| {
                    let uv = Vec2::new(0.0317 * i as f32, y);
                    maps.lookup(TextureId(0), uv, covered / 64.0, |_| Rgb::ZERO)
                };
                let near = |found: Rgb, expected: Rgb| (found - expected).abs().max_element() < 1e-5;
                assert!(near(at(0.75), Rgb::splat(0.5)) && near(at(0.25), Rgb::X * 0.5), "{covered} {i}");
            }
        }
    }
}
