//! Textured roughness: a model for each level of it, so that tables by roughness are the same as for a
//! constant one, and constant ones cost nothing more.
//!
//! Deviations: a level represents values within 1.1 % of its own, which is less than half a step of an 8-bit
//! picture at 0.5 in a texture of α² or of one at 0.18 in one of α; the coat's tables are made for every
//! eighth level. Values below 1/1024 are clamped to it. Textures of other lobes' roughness are replaced by
//! their means.

use base::math::luminance;
use scene::{Lobe, Material, Roughness, Texture, TextureId};
use std::ops::RangeInclusive;

/// Levels from one value to its double.
const LEVELS_PER_OCTAVE: i32 = 32;

/// Levels per level of the coat.
const COAT_STEP: i32 = 8;

/// Level of the smallest value told apart, 2^-10.
const MIN_LEVEL: i32 = -10 * LEVELS_PER_OCTAVE;

/// Values of a texture that count as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Level(i32);

impl Level {
    /// Returns the level of a texture's value.
    #[inline]
    fn of(value: f32) -> Level {
        Level(((value.log2() * LEVELS_PER_OCTAVE as f32).round() as i32).max(MIN_LEVEL))
    }

    fn value(self) -> f32 {
        (self.0 as f32 / LEVELS_PER_OCTAVE as f32).exp2()
    }

    /// Returns the level whose coat tables this one uses.
    pub fn of_coat(self) -> Level {
        Level((self.0 as f32 / COAT_STEP as f32).round() as i32 * COAT_STEP)
    }
}

/// The models of a material by the level of its roughness.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    pub texture: TextureId,
    range: RangeInclusive<i32>,
    /// Index of the lowest level's model.
    pub first: usize,
}

impl Levels {
    /// Returns the levels of the first textured roughness of `material`, if there is any.
    pub fn of(material: &Material, textures: &[Texture], first: usize) -> Option<Levels> {
        let textured = |roughness: &Roughness| match roughness {
            Roughness::Textured { texture, .. } => Some(*texture),
            Roughness::Constant(_) => None,
        };
        let of_lobe = |lobe: &Lobe| match lobe {
            Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => textured(alpha),
            Lobe::Anisotropic { .. } | Lobe::Mirror { .. } | Lobe::Dielectric { .. } => None,
        };
        let of_part = |part: &Material| match &part.principled {
            Some(principled) => textured(&principled.roughness),
            None => part.lobes.iter().find_map(of_lobe),
        };
        let texture = material.parts().find_map(of_part)?;
        let texels = &textures.get(texture.0 as usize)?.texels;
        let levels = || texels.iter().map(|texel| Level::of(luminance(texel)).0);
        Some(Levels { texture, range: levels().min()?..=levels().max()?, first })
    }

    pub fn all(&self) -> impl Iterator<Item = Level> + use<> {
        self.range.clone().map(Level)
    }

    /// Returns the index of the model for a value of the texture.
    #[inline]
    pub fn model(&self, value: f32) -> usize {
        let level = Level::of(value).0.clamp(*self.range.start(), *self.range.end());
        self.first + (level - self.range.start()) as usize
    }
}

/// Returns α where `level` is that of its texture, and by the means of other textures.
pub(super) fn alpha(roughness: &Roughness, level: Option<(TextureId, Level)>, textures: &[Texture]) -> f32 {
    roughness.value(|texture| match level {
        Some((known, level)) if known == texture => level.value(),
        _ => textures.get(texture.0 as usize).map_or(1.0, |texture| luminance(texture.mean())),
    })
}
