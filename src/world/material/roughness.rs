//! Textured roughness: one model per level of it, so that the tables by roughness are those of a constant roughness,
//! and a constant roughness costs nothing more.
//!
//! Deviations: a level represents values within 1.1 % of its own. This is less than half a step of an 8-bit image at
//! 0.5 in a texture of α², or at 0.18 in a texture of α. Up to 32 texels without interpolation are levels of their own.
//! Where two textures give the roughness along u and v, or roughness and anisotropy, there is a model for each pair of
//! levels. Levels are then up to 4.4 % off, or more where that takes more than 2048 models. The tables of the coat are
//! made for every eighth level. Values below 1/1024 are clamped to it. The roughness of other lobes is the mean of its
//! texture.

use base::math::{Rgb, luminance};
use rayon::prelude::*;
use scene::{AttributeTexture, Filter, Lobe, Material, Roughness, Scene, Texture, TextureId};

/// Number of levels between a value and its double.
const LEVELS_PER_OCTAVE: i32 = 32;

/// Number of roughness levels per level of the coat.
const COAT_STEP: i32 = 8;

/// Level of the smallest value that is told apart, 2^-10.
const MIN_LEVEL: i32 = -10 * LEVELS_PER_OCTAVE;

/// Maximum number of pairs of levels.
const MAX_PAIRS: usize = 2048;

/// Minimum distance of the levels in pairs.
const MIN_STEP: i32 = 4;

/// Value of a texture, and the values near it that count as one roughness.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct RoughnessLevel(f32);

impl RoughnessLevel {
    /// Returns the number of the level of a texture's value.
    fn number(value: f32) -> i32 {
        ((value.log2() * LEVELS_PER_OCTAVE as f32).round() as i32).max(MIN_LEVEL)
    }

    /// Returns the level of a number.
    fn numbered(number: i32) -> RoughnessLevel {
        RoughnessLevel((number as f32 / LEVELS_PER_OCTAVE as f32).exp2())
    }

    /// Returns the level whose coat tables this level uses.
    fn of_coat(self) -> RoughnessLevel {
        let number = Self::number(self.0) as f32 / COAT_STEP as f32;
        Self::numbered(number.round() as i32 * COAT_STEP)
    }
}

/// Levels of one texture.
#[derive(Clone, Debug)]
struct TextureLevels {
    texture: TextureId,
    /// Levels that have models, in the order of their values.
    levels: Vec<RoughnessLevel>,
}

impl TextureLevels {
    /// Returns the levels of a texture at a distance of `step`, or its texels if they are few and not interpolated;
    /// `None` if there is no such texture.
    fn new(texture: TextureId, scene: &Scene, step: i32) -> Option<TextureLevels> {
        let is_exact = |image: &&Texture| {
            image.filter == Filter::Nearest && image.texels.len() <= LEVELS_PER_OCTAVE as usize
        };
        if let Some(image) = scene.textures.by_id(texture).filter(is_exact) {
            let least = RoughnessLevel::numbered(MIN_LEVEL).0;
            let level = |texel| RoughnessLevel(luminance(texel).max(least));
            let mut levels: Vec<RoughnessLevel> = image.texels.iter().map(level).collect();
            levels.sort_by(|a, b| a.0.total_cmp(&b.0));
            levels.dedup();
            return Some(TextureLevels { texture, levels });
        }
        let (low, high) = scene.luminance_range(texture)?;
        let [low, high] = [low, high].map(RoughnessLevel::number);
        let levels = (low..high + step).step_by(step as usize).map(RoughnessLevel::numbered).collect();
        Some(TextureLevels { texture, levels })
    }

    /// Returns the index of the level nearest to a value of the texture.
    #[inline]
    fn index(&self, value: f32) -> usize {
        let above =
            self.levels.partition_point(|level| level.0 < value).clamp(1, self.levels.len().max(2) - 1);
        let is_below =
            self.levels.get(above).is_none_or(|level| value * value < level.0 * self.levels[above - 1].0);
        if is_below { above - 1 } else { above }
    }
}

/// Levels of a material's textured roughness: those of its texture, or pairs of those of its two textures.
#[derive(Clone, Debug)]
pub(super) struct RoughnessLevels {
    first: TextureLevels,
    second: Option<TextureLevels>,
}

/// Textures whose levels are known while a model is built, and the levels.
pub(super) type LevelPair = Vec<(TextureId, RoughnessLevel)>;

impl RoughnessLevels {
    /// Returns the levels of the first part of `material` whose roughness is textured, if there is any.
    pub fn new(material: &Material, scene: &Scene) -> Option<RoughnessLevels> {
        let of_lobe = |lobe: &Lobe| match lobe {
            Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => textures(&[*alpha]),
            Lobe::Anisotropic { alpha, .. } => textures(alpha),
            Lobe::Mirror { .. } | Lobe::Dielectric { .. } => None,
        };
        let of_part = |part: &Material| match &part.principled {
            Some(principled) => textures(&[principled.roughness, principled.anisotropic]),
            None => part.lobes.iter().find_map(of_lobe),
        };
        let (first, second) = material.parts().find_map(of_part)?;
        let levels = |texture, step| TextureLevels::new(texture, scene, step);
        // Levels of two textures are wider, so that there are few enough pairs.
        let mut step = MIN_STEP;
        while let Some(second) = second.and_then(|second| levels(second, step)) {
            let first = levels(first, step)?;
            if first.levels.len() * second.levels.len() <= MAX_PAIRS {
                return Some(RoughnessLevels { first, second: Some(second) });
            }
            step *= 2;
        }
        Some(RoughnessLevels { first: levels(first, 1)?, second: None })
    }

    /// Returns the texture that is looked up first.
    pub fn first_texture(&self) -> TextureId {
        self.first.texture
    }

    /// Lists the levels of all models, by index.
    pub fn all(&self) -> impl Iterator<Item = LevelPair> + use<> {
        let RoughnessLevels { first, second } = self.clone();
        let of_second = second.as_ref().map_or(1, |second| second.levels.len());
        (0..first.levels.len() * of_second).map(move |index| {
            let mut pair = vec![(first.texture, first.levels[index / of_second])];
            pair.extend(second.as_ref().map(|second| (second.texture, second.levels[index % of_second])));
            pair
        })
    }

    /// Returns the index of the model for the values of the textures, which `value` returns.
    #[inline]
    pub fn index(&self, value: impl Fn(TextureId) -> f32) -> usize {
        let first = self.first.index(value(self.first.texture));
        match &self.second {
            Some(second) => first * second.levels.len() + second.index(value(second.texture)),
            None => first,
        }
    }
}

/// Returns the first texture of parameters, and the second if it is another one; `None` if none is textured.
fn textures(parameters: &[Roughness]) -> Option<(TextureId, Option<TextureId>)> {
    let mut all = parameters.iter().filter_map(Roughness::texture);
    let first = all.next()?;
    Some((first, all.find(|other| *other != first)))
}

/// Values of textured roughness while a model is built.
#[derive(Clone, Copy)]
pub(super) struct RoughnessValues<'a> {
    /// Means of the scene's textures.
    pub means: &'a TextureMeans,
    /// Textures whose levels are known.
    pub levels: Option<&'a LevelPair>,
}

impl RoughnessValues<'_> {
    /// Returns α: that of the level if that of its texture is known, else that of the texture's mean.
    pub fn alpha(&self, roughness: &Roughness) -> f32 {
        self.alpha_at(roughness, |level| level)
    }

    /// Returns α for the tables of a coat.
    pub fn alpha_of_coat(&self, roughness: &Roughness) -> f32 {
        self.alpha_at(roughness, RoughnessLevel::of_coat)
    }

    fn alpha_at(&self, roughness: &Roughness, level: impl Fn(RoughnessLevel) -> RoughnessLevel) -> f32 {
        roughness.value(|texture| {
            let known = self.levels.and_then(|levels| levels.iter().find(|(known, _)| *known == texture));
            known.map_or_else(|| luminance(self.means.mean(texture)), |(_, found)| level(*found).0)
        })
    }
}

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
    pub fn mean(&self, id: TextureId) -> Rgb {
        let found = self.images.get(id.0 as usize).or_else(|| self.attributes.get(id.attribute_number()?));
        found.copied().unwrap_or(Rgb::ONE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testkit::{add_texture, scene, texture};
    use base::math::Rgb;
    use scene::{Camera, Distribution, Fresnel};

    #[test]
    fn few_texels_are_levels_of_their_own() {
        let mut scene = scene(Camera::default(), [1, 1]);
        let values = [0.3, 0.05, 0.05, 0.3];
        let ids = [(); 2].map(|()| add_texture(&mut scene, texture(2, &values.map(Rgb::splat))));
        let alpha = ids.map(|texture| Roughness::Textured { texture, scale: 1.0 });
        let (distribution, fresnel, scale) = (Distribution::Ggx, Fresnel::One, Rgb::ONE.into());
        let lobes = vec![Lobe::Anisotropic { distribution, alpha, fresnel, scale }];
        let levels =
            RoughnessLevels::new(&Material { lobes, ..Material::default() }, &scene).expect("levels");
        let all: Vec<LevelPair> = levels.all().collect();
        assert_eq!(all.len(), 4);
        for wanted in [[0.3, 0.05], [0.05, 0.3], [0.3, 0.3], [0.05, 0.05]] {
            let found = &all[levels.index(|id| wanted[usize::from(id == ids[1])])];
            for ((_, level), wanted) in found.iter().zip(wanted) {
                assert!((level.0 / wanted - 1.0).abs() < 1e-6, "{level:?} for {wanted}");
            }
        }
    }

    #[test]
    fn pairs_of_levels_are_few_and_near_the_values() {
        for (least, most_off) in [(0.25f32, 0.045), (1e-3, 0.4)] {
            let mut scene = scene(Camera::default(), [1, 1]);
            let values: Vec<Rgb> = (0..64).map(|i| Rgb::splat(least.powf(i as f32 / 63.0))).collect();
            let ids = [(); 2].map(|()| add_texture(&mut scene, texture(64, &values)));
            let alpha = ids.map(|texture| Roughness::Textured { texture, scale: 1.0 });
            let (distribution, fresnel, scale) = (Distribution::Ggx, Fresnel::One, Rgb::ONE.into());
            let lobes = vec![Lobe::Anisotropic { distribution, alpha, fresnel, scale }];
            let levels =
                RoughnessLevels::new(&Material { lobes, ..Material::default() }, &scene).expect("levels");
            let all: Vec<LevelPair> = levels.all().collect();
            assert!(all.len() <= MAX_PAIRS, "{}", all.len());
            for (i, j) in [(0, 0), (63, 63), (5, 40), (63, 1), (31, 33)] {
                let wanted = [values[i].x, values[j].x];
                let found = &all[levels.index(|id| wanted[usize::from(id == ids[1])])];
                for ((_, level), wanted) in found.iter().zip(wanted) {
                    let off = (level.0 / wanted - 1.0).abs();
                    assert!(off < most_off, "{least}: {off} at {i}, {j}");
                }
            }
        }
    }
}
