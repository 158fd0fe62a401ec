//! Textured roughness: one model per level of it, so that the tables by roughness are those of a constant roughness,
//! and a constant roughness costs nothing more.
//!
//! Deviations: a level represents values within 1.1 % of its own. This is less than half a step of an 8-bit image at
//! 0.5 in a texture of α², or at 0.18 in a texture of α. The tables of the coat are made for every eighth level. Values
//! below 1/1024 are clamped to it. The roughness of other lobes is the mean of its texture.

use super::means::TextureMeans;
use base::math::luminance;
use scene::{Lobe, Material, Roughness, Scene, TextureId};
use std::ops::RangeInclusive;

/// Number of levels between a value and its double.
const LEVELS_PER_OCTAVE: i32 = 32;

/// Number of roughness levels per level of the coat.
const COAT_STEP: i32 = 8;

/// Level of the smallest value that is told apart, 2^-10.
const MIN_LEVEL: i32 = -10 * LEVELS_PER_OCTAVE;

/// Values of a texture that count as one roughness.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct RoughnessLevel(i32);

impl RoughnessLevel {
    /// Returns the level of a texture's value.
    #[inline]
    fn of(value: f32) -> RoughnessLevel {
        RoughnessLevel(((value.log2() * LEVELS_PER_OCTAVE as f32).round() as i32).max(MIN_LEVEL))
    }

    fn value(self) -> f32 {
        (self.0 as f32 / LEVELS_PER_OCTAVE as f32).exp2()
    }

    /// Returns the level whose coat tables this level uses.
    fn of_coat(self) -> RoughnessLevel {
        RoughnessLevel((self.0 as f32 / COAT_STEP as f32).round() as i32 * COAT_STEP)
    }
}

/// Levels of a material's textured roughness.
#[derive(Clone, Debug)]
pub(super) struct RoughnessLevels {
    /// Texture of the roughness.
    pub texture: TextureId,
    range: RangeInclusive<i32>,
}

impl RoughnessLevels {
    /// Returns the levels of the first textured roughness of `material`, if there is any.
    pub fn of(material: &Material, scene: &Scene) -> Option<RoughnessLevels> {
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
        let Some(image) = scene.textures.by_id(texture) else {
            let (low, high) = scene.luminance_range(texture)?;
            return Some(RoughnessLevels {
                texture,
                range: RoughnessLevel::of(low).0..=RoughnessLevel::of(high).0,
            });
        };
        let levels = || image.texels.iter().map(|texel| RoughnessLevel::of(luminance(texel)).0);
        Some(RoughnessLevels { texture, range: levels().min()?..=levels().max()? })
    }

    /// Lists all levels in ascending order.
    pub fn all(&self) -> impl Iterator<Item = RoughnessLevel> + use<> {
        self.range.clone().map(RoughnessLevel)
    }

    /// Returns the index of the level of a value of the texture, counted from the lowest level.
    #[inline]
    pub fn index(&self, value: f32) -> usize {
        let level = RoughnessLevel::of(value).0.clamp(*self.range.start(), *self.range.end());
        (level - self.range.start()) as usize
    }
}

/// Values of textured roughness while a model is built.
#[derive(Clone, Copy)]
pub(super) struct RoughnessValues<'a> {
    pub means: &'a TextureMeans,
    /// Texture whose level is known, and the level.
    pub level: Option<(TextureId, RoughnessLevel)>,
}

impl RoughnessValues<'_> {
    /// Returns α: that of the level if the texture is the level's, else that of the texture's mean.
    pub fn alpha(&self, roughness: &Roughness) -> f32 {
        roughness.value(|texture| match self.level {
            Some((known, level)) if known == texture => level.value(),
            _ => luminance(self.means.of(texture)),
        })
    }

    /// Returns the values for the tables of a coat.
    pub fn of_coat(self) -> Self {
        let level = self.level.map(|(texture, level)| (texture, level.of_coat()));
        RoughnessValues { level, ..self }
    }
}
