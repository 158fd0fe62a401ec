//! Colours of a material before textures are looked up.

use super::base::BaseModel;
use super::lobe::MAX_LOBES;
use super::model::Colours;
use super::principled::PrincipledColours;
use base::math::Rgb;
use scene::{Reflectance, Share, TextureId};
use std::cell::RefCell;

/// Colours of base and lobes, and gaps.
#[derive(Clone, Debug)]
pub(super) struct ColourSource {
    pub layers: LayerColours,
    /// Share of the surface that is there, and the slot of the lobe that stands for the gaps.
    pub opacity: Option<(Share, usize)>,
}

impl ColourSource {
    /// Returns true if any colour is textured.
    pub fn is_textured(&self) -> bool {
        self.layers.is_textured() || self.opacity.is_some_and(|(opacity, _)| opacity.is_textured())
    }

    /// Returns the BRDF of the base and the factors on the lobes; `texel` returns the value of a texture.
    pub fn colours(&self, base: &BaseModel, texel: &dyn Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let mut colours = self.layers.colours(base, texel);
        if let Some((opacity, gap)) = self.opacity {
            let share = opacity.share(texel);
            colours.base *= share;
            colours.scales.iter_mut().for_each(|scale| *scale *= share);
            colours.scales[gap] = Rgb::splat(1.0 - share);
        }
        colours
    }

    /// Lists the textures in the order in which they are looked up.
    pub fn textures(&self, base: &BaseModel) -> Vec<TextureId> {
        let textures = RefCell::new(Vec::new());
        self.colours(base, &|texture| {
            textures.borrow_mut().push(texture);
            Rgb::ONE
        });
        textures.into_inner()
    }
}

/// Colours of base and lobes before textures are looked up.
#[derive(Clone, Debug)]
pub(super) enum LayerColours {
    /// Colours of a base, factors on lobes, and the number of lobes.
    Layers(Colours<Reflectance>, usize),
    Principled(PrincipledColours),
    Blend(Box<BlendColours>),
}

/// Colours of two materials; the lobes of the first come before the lobes of the second.
#[derive(Clone, Debug)]
pub(super) struct BlendColours {
    /// Share of the second material.
    pub weight: Share,
    pub parts: [(LayerColours, BaseModel); 2],
    /// Number of lobes of the first.
    pub first: usize,
}

impl LayerColours {
    /// Returns true if any colour is textured.
    pub fn is_textured(&self) -> bool {
        match self {
            LayerColours::Layers(colours, _) => {
                colours.base.is_textured() || colours.scales.iter().any(Reflectance::is_textured)
            }
            LayerColours::Principled(principled) => principled.is_textured(),
            LayerColours::Blend(blend) => {
                blend.weight.is_textured() || blend.parts.iter().any(|(colours, _)| colours.is_textured())
            }
        }
    }

    /// Returns true if the colours, on the base `base`, are linear in the texels of all textures together.
    pub fn is_linear(&self, base: &BaseModel) -> bool {
        match self {
            LayerColours::Layers(colours, _) => base.is_linear() || !colours.base.is_textured(),
            LayerColours::Principled(principled) => principled.is_linear(),
            LayerColours::Blend(blend) => {
                !blend.weight.is_textured()
                    && blend.parts.iter().all(|(colours, base)| colours.is_linear(base))
            }
        }
    }

    /// Returns the BRDF of the base and the factors on the lobes; `texel` returns the value of a texture.
    pub fn colours(&self, base: &BaseModel, texel: &dyn Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let value = |reflectance: Reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            textured => textured.value(texel).max(Rgb::ZERO),
        };
        match self {
            LayerColours::Layers(colours, count) => {
                let mut scales = [Rgb::ZERO; MAX_LOBES];
                for (scale, reflectance) in scales[..*count].iter_mut().zip(colours.scales) {
                    *scale = value(reflectance);
                }
                Colours { base: base.brdf(value(colours.base)), scales }
            }
            LayerColours::Principled(principled) => {
                let colours = principled.colours(texel);
                Colours { base: base.brdf(colours.base), ..colours }
            }
            LayerColours::Blend(blend) => {
                let weight = blend.weight.share(texel);
                let [mut mixed, other] =
                    blend.parts.each_ref().map(|(colours, base)| colours.colours(base, texel));
                mixed.base = mixed.base.lerp(other.base, weight);
                mixed.scales.iter_mut().for_each(|scale| *scale *= 1.0 - weight);
                for (mixed, other) in mixed.scales[blend.first..].iter_mut().zip(other.scales) {
                    *mixed = other * weight;
                }
                mixed
            }
        }
    }
}
