//! Base and lobes of a material of the scene, and their colours before textures are looked up.

use super::base::{BaseModel, CoatInterface, RoughCoat};
use super::bsdf::Colours;
use super::lobe::{
    AnisotropicLobe, Interface, LobeModel, MAX_LOBES, Mirror, Passage, RoughInterface, RoughLobe,
    albedo_table,
};
use super::microfacet::Microfacets;
use super::principled::PrincipledModel;
use super::roughness::{self, Level};
use super::table::AngleTable;
use base::math::{Rgb, luminance};
use scene::{Fresnel, Lobe, Material, Reflectance, Share, Texture, TextureId};
use std::sync::Arc;

/// Colours of a material before textures are looked up.
#[derive(Clone, Debug)]
pub(super) enum Source {
    /// Of a base and so many lobes.
    Layers(Colours<Reflectance>, usize),
    Principled(PrincipledModel),
    Blend(Box<BlendSource>),
}

/// Two sources, the lobes of one before those of the other.
#[derive(Clone, Debug)]
pub(super) struct BlendSource {
    /// Share of the second.
    weight: Share,
    sources: [(Source, BaseModel); 2],
    /// Number of the first one's lobes.
    first: usize,
}

impl Source {
    pub fn is_textured(&self) -> bool {
        match self {
            Source::Layers(colours, _) => {
                colours.base.is_textured() || colours.scales.iter().any(Reflectance::is_textured)
            }
            Source::Principled(principled) => principled.is_textured(),
            Source::Blend(blend) => {
                blend.weight.is_textured() || blend.sources.iter().any(|(source, _)| source.is_textured())
            }
        }
    }

    /// True if the colours, on the base `base`, are linear in the texels of all textures together.
    pub fn is_linear(&self, base: &BaseModel) -> bool {
        match self {
            Source::Layers(colours, _) => base.is_linear() || !colours.base.is_textured(),
            Source::Principled(principled) => principled.is_linear(),
            Source::Blend(blend) => {
                !blend.weight.is_textured()
                    && blend.sources.iter().all(|(source, base)| source.is_linear(base))
            }
        }
    }

    /// Returns BRDF of the base and factors on the lobes where each texture has the value `texel` of it.
    pub fn colours(&self, base: &BaseModel, texel: &dyn Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let value = |reflectance: Reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            textured => textured.value(texel).max(Rgb::ZERO),
        };
        match self {
            Source::Layers(colours, count) => {
                let mut scales = [Rgb::ZERO; MAX_LOBES];
                for (scale, reflectance) in scales[..*count].iter_mut().zip(colours.scales) {
                    *scale = value(reflectance);
                }
                Colours { base: base.brdf(value(colours.base)), scales }
            }
            Source::Principled(principled) => {
                let colours = principled.colours(texel);
                Colours { base: base.brdf(colours.base), ..colours }
            }
            Source::Blend(blend) => {
                let weight = blend.weight.value(|id| luminance(texel(id))).clamp(0.0, 1.0);
                let [mut mixed, other] =
                    blend.sources.each_ref().map(|(source, base)| source.colours(base, texel));
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

/// Content of a model.
pub(super) struct Layers {
    pub source: Source,
    pub base: BaseModel,
    /// True if the base is black.
    pub black: bool,
    /// True if there is a coat on it.
    pub coated: bool,
    pub lobes: Vec<LobeModel>,
}

/// Tables that materials share when roughness and indices agree.
#[derive(Default)]
pub(super) struct Tables {
    coats: Vec<(Microfacets, f32, Arc<RoughCoat>)>,
    albedos: Vec<(Microfacets, Fresnel, Arc<AngleTable<Rgb>>)>,
}

impl Tables {
    fn coat(&mut self, facets: Microfacets, eta: f32) -> Arc<RoughCoat> {
        if let Some((_, _, coat)) = self.coats.iter().find(|c| c.0 == facets && c.1 == eta) {
            return coat.clone();
        }
        let coat = Arc::new(RoughCoat::new(&facets, eta));
        self.coats.push((facets, eta, coat.clone()));
        coat
    }

    pub fn albedo(&mut self, facets: Microfacets, fresnel: Fresnel) -> Arc<AngleTable<Rgb>> {
        if let Some((_, _, albedo)) = self.albedos.iter().find(|a| a.0 == facets && a.1 == fresnel) {
            return albedo.clone();
        }
        let albedo = Arc::new(albedo_table(&facets, &fresnel));
        self.albedos.push((facets, fresnel, albedo.clone()));
        albedo
    }
}

impl Layers {
    /// Base and lobes of a material, of which at most `most` are kept, for a level of its roughness if that is
    /// textured.
    pub fn new(
        material: &Material,
        textures: &[Texture],
        level: Option<(TextureId, Level)>,
        most: usize,
        tables: &mut Tables,
    ) -> Layers {
        let first = Layers::of_one(material, textures, level, most, tables);
        let Some(blend) = &material.blend else { return first };
        let left = most - first.lobes.len();
        first.blend(blend.weight, Layers::new(&blend.other, textures, level, left, tables))
    }

    /// The mixture with another, whose share is `weight`.
    fn blend(self, weight: Share, other: Layers) -> Layers {
        let base = if self.black { other.base.clone() } else { self.base.clone() };
        let mut lobes = self.lobes;
        let first = lobes.len();
        lobes.extend(other.lobes);
        let sources = [(self.source, self.base), (other.source, other.base)];
        Layers {
            source: Source::Blend(Box::new(BlendSource { weight, sources, first })),
            base,
            black: self.black && other.black,
            coated: self.coated || other.coated,
            lobes,
        }
    }

    /// Base and lobes of a material by itself.
    fn of_one(
        material: &Material,
        textures: &[Texture],
        level: Option<(TextureId, Level)>,
        most: usize,
        tables: &mut Tables,
    ) -> Layers {
        if let Some(principled) = &material.principled {
            let (principled, lobes) = PrincipledModel::new(principled, level, textures, most);
            let base = BaseModel::new(None, CoatInterface::Burley);
            let source = Source::Principled(principled);
            return Layers { source, base, black: false, coated: true, lobes };
        }
        let mut source = Colours { base: material.diffuse, scales: [Reflectance::BLACK; MAX_LOBES] };
        let mut lobes = Vec::new();
        let mut add = |lobe, scale| {
            if let Some(slot) = source.scales[..most].get_mut(lobes.len()) {
                *slot = scale;
                lobes.push(lobe);
            }
        };
        let mut coat_facets = None;
        for lobe in &material.lobes {
            match *lobe {
                Lobe::Rough { distribution, alpha, fresnel, scale } => {
                    let facets =
                        |level| Microfacets::new(distribution, roughness::alpha(&alpha, level, textures));
                    let coat_level = level.map(|(texture, level)| (texture, level.of_coat()));
                    coat_facets = coat_facets.or_else(|| Some(facets(coat_level)));
                    let facets = facets(level);
                    let lobe =
                        RoughLobe { facets, fresnel, max_reflectance: None, albedo: None, white: None };
                    add(LobeModel::Rough(lobe), scale);
                }
                Lobe::Anisotropic { distribution, alpha, fresnel, scale } => {
                    add(LobeModel::Anisotropic(AnisotropicLobe::new(distribution, alpha, fresnel)), scale);
                }
                Lobe::Mirror { fresnel, scale } => add(LobeModel::Mirror(Mirror { fresnel }), scale),
                Lobe::RoughDielectric { distribution, alpha, eta, reflectance, transmittance }
                    if eta != 1.0 =>
                {
                    let facets = Microfacets::new(distribution, roughness::alpha(&alpha, level, textures));
                    let way = |passage| {
                        let inside_only = false;
                        LobeModel::RoughInterface(RoughInterface { facets, eta, passage, inside_only })
                    };
                    add(way(Passage::Reflection), reflectance);
                    add(way(Passage::Refraction), transmittance);
                }
                Lobe::Dielectric { eta, reflectance, transmittance, .. }
                | Lobe::RoughDielectric { eta, reflectance, transmittance, .. } => {
                    let thin = matches!(lobe, Lobe::Dielectric { thin: true, .. });
                    let way = |passage| LobeModel::Interface(Interface { eta, thin, passage });
                    add(way(Passage::Reflection), reflectance);
                    add(way(Passage::Refraction), transmittance);
                }
            }
        }
        // Nothing could lie beneath an interface that light passes.
        let black = material.diffuse == Reflectance::BLACK || lobes.iter().any(LobeModel::transmits);
        if black {
            source.base = Reflectance::BLACK;
        }
        let coat = material.coat.filter(|_| !black);
        let interface = match (coat, coat_facets) {
            (None, _) => CoatInterface::None,
            (Some(coat), Some(facets)) => CoatInterface::Rough(tables.coat(facets, coat.eta)),
            (Some(coat), None) => CoatInterface::Smooth(coat.eta),
        };
        let base = BaseModel::new(coat, interface);
        let source = Source::Layers(source, lobes.len().min(MAX_LOBES));
        Layers { source, base, black, coated: coat.is_some(), lobes }
    }
}
