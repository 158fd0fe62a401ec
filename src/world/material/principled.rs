//! Principled materials as a base and lobes: the colours of these by the material's own parameters.
//!
//! Deviations: of more than [`MAX_LOBES`] lobes, which need several textures that mix metal, glass, varnish and sheen
//! at one place, the last are left out.

use super::bsdf::Colours;
use super::lobe::{
    AnisotropicLobe, ClearCoat, Grazing, GrazingKind, LobeModel, MAX_LOBES, Passage, RoughInterface,
    RoughLobe,
};
use super::microfacet::Microfacets;
use super::roughness::{self, Level};
use base::math::{Rgb, luminance};
use scene::{Distribution, Fresnel, Principled, Share, Texture, TextureId};

/// Minimum roughness α, that of Mitsuba.
const MIN_ALPHA: f32 = 1e-3;

/// A principled material without its textures' values.
#[derive(Clone, Debug)]
pub(super) struct PrincipledModel {
    parameters: Box<Principled>,
    /// Share of the light that each lobe has.
    parts: Vec<Part>,
}

/// Lobe of a principled material, by its factor.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Part {
    /// Reflection by the dielectric, without hue.
    Dielectric,
    /// Reflection with a hue, by metal too: all of it, where it is the same everywhere.
    Hued,
    /// The same, the part of it that is there at normal incidence and vanishes at grazing incidence.
    HuedNormal,
    /// The rest.
    HuedEdge,
    Transmission,
    /// Reflection of light inside.
    Inside,
    Retro,
    ClearCoat,
    Sheen,
}

/// Parameters at a place.
struct Values {
    colour: Rgb,
    /// Colour of the same hue and a luminance of 1.
    hue: Rgb,
    metallic: f32,
    spec_tint: f32,
    spec_trans: f32,
    sheen: f32,
    sheen_tint: f32,
    clearcoat: f32,
}

impl Values {
    fn of(p: &Principled, texel: impl Fn(TextureId) -> Rgb) -> Values {
        let share = |share: &Share| share.value(|id| luminance(texel(id))).clamp(0.0, 1.0);
        let colour = p.base_color.value(&texel).max(Rgb::ZERO);
        let of_colour = luminance(colour);
        Values {
            colour,
            hue: if of_colour > 0.0 { colour / of_colour } else { Rgb::ONE },
            metallic: share(&p.metallic),
            spec_tint: share(&p.spec_tint),
            spec_trans: share(&p.spec_trans),
            sheen: share(&p.sheen),
            sheen_tint: share(&p.sheen_tint),
            clearcoat: share(&p.clearcoat),
        }
    }

    fn diffuse(&self) -> Rgb {
        self.colour * ((1.0 - self.metallic) * (1.0 - self.spec_trans))
    }

    fn hued_normal(&self, eta: f32) -> Rgb {
        let f0 = ((eta - 1.0) / (eta + 1.0)).powi(2);
        self.colour * self.metallic + self.hue * ((1.0 - self.metallic) * self.spec_tint * f0)
    }

    fn hued_edge(&self) -> f32 {
        self.metallic + (1.0 - self.metallic) * self.spec_tint
    }

    fn factor(&self, part: Part, eta: f32) -> Rgb {
        let transmitted = (1.0 - self.metallic) * self.spec_trans;
        match part {
            Part::Dielectric => Rgb::splat((1.0 - self.metallic) * (1.0 - self.spec_tint)),
            Part::Hued => Rgb::ONE,
            Part::HuedNormal => self.hued_normal(eta),
            Part::HuedEdge => Rgb::splat(self.hued_edge()),
            Part::Transmission => Rgb::from_array(self.colour.to_array().map(f32::sqrt)) * transmitted,
            Part::Inside => Rgb::splat(transmitted),
            Part::Retro => self.diffuse(),
            Part::ClearCoat => Rgb::splat(self.clearcoat),
            Part::Sheen => {
                let hue = Rgb::ONE.lerp(self.hue, self.sheen_tint);
                hue * (self.sheen * (1.0 - self.metallic))
            }
        }
    }
}

impl PrincipledModel {
    /// Prepares a material, for a level of its roughness if that is textured; returns its lobes, too, most of which
    /// lack their tables, and at most `most` of them.
    pub fn new(
        p: &Principled,
        level: Option<(TextureId, Level)>,
        textures: &[Texture],
        most: usize,
    ) -> (PrincipledModel, Vec<LobeModel>) {
        let roughness = roughness::alpha(&p.roughness, level, textures);
        let facets = Microfacets::new(Distribution::Ggx, (roughness * roughness).max(MIN_ALPHA));
        let some = |share: Share| share != Share::Constant(0.0);
        let not_all = |share: Share| share != Share::Constant(1.0);
        let (has_hue, eta) = (some(p.metallic) || some(p.spec_tint), p.eta);
        let is_dielectric = not_all(p.metallic);
        let aspect = (1.0 - 0.9 * p.anisotropic).sqrt();
        let alpha = [facets.alpha / aspect, facets.alpha * aspect].map(|alpha| alpha.max(MIN_ALPHA));
        let rough = |fresnel| match p.anisotropic {
            0.0 => LobeModel::Rough(RoughLobe {
                facets,
                fresnel,
                max_reflectance: None,
                albedo: None,
                white: None,
            }),
            _ => LobeModel::Anisotropic(AnisotropicLobe::new(facets.distribution, alpha, fresnel)),
        };
        let interface = |passage, inside_only| {
            LobeModel::RoughInterface(RoughInterface { facets, eta, passage, inside_only })
        };
        let mut all = Vec::new();
        if is_dielectric && not_all(p.spec_tint) {
            all.push((Part::Dielectric, rough(Fresnel::Dielectric(eta))));
        }
        let is_even = !p.base_color.is_textured() && !p.metallic.is_textured() && !p.spec_tint.is_textured();
        if has_hue && is_even {
            let values = Values::of(p, |_| Rgb::ONE);
            let (normal, edge) = (values.hued_normal(eta), values.hued_edge());
            all.push((Part::Hued, rough(Fresnel::Schlick { normal, edge })));
        } else if has_hue {
            let schlick = |normal, edge| rough(Fresnel::Schlick { normal: Rgb::splat(normal), edge });
            all.extend([(Part::HuedNormal, schlick(1.0, 0.0)), (Part::HuedEdge, schlick(0.0, 1.0))]);
        }
        if is_dielectric && some(p.spec_trans) && eta != 1.0 {
            all.push((Part::Transmission, interface(Passage::Refraction, false)));
            all.push((Part::Inside, interface(Passage::Reflection, true)));
        }
        if is_dielectric && not_all(p.spec_trans) {
            all.push((Part::Retro, LobeModel::Grazing(Grazing::new(GrazingKind::Retro { roughness }))));
        }
        if some(p.clearcoat) {
            all.push((Part::ClearCoat, LobeModel::ClearCoat(ClearCoat::new(p.clearcoat_gloss))));
        }
        if is_dielectric && some(p.sheen) {
            all.push((Part::Sheen, LobeModel::Grazing(Grazing::new(GrazingKind::Sheen))));
        }
        all.truncate(most);
        let (parts, lobes) = all.into_iter().unzip();
        (PrincipledModel { parameters: Box::new(p.clone()), parts }, lobes)
    }

    /// True if any colour is textured.
    pub fn is_textured(&self) -> bool {
        let mut colours = self.parameters.clone();
        colours.roughness = Share::Constant(0.0);
        colours.is_textured()
    }

    /// True if the colours are linear in the texels of all textures together.
    pub fn is_linear(&self) -> bool {
        let p = &self.parameters;
        let none = |share: Share| share == Share::Constant(0.0);
        let shares = [p.metallic, p.sheen, p.clearcoat];
        // The hue is no linear function of the colour.
        let without_hue = none(p.spec_tint) && (none(p.sheen_tint) || none(p.sheen));
        without_hue && none(p.spec_trans) && !shares.iter().any(Share::is_textured)
    }

    /// Returns albedo of the base and factors on the lobes where each texture has the value `texel` of it.
    pub fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let values = Values::of(&self.parameters, texel);
        let mut scales = [Rgb::ZERO; MAX_LOBES];
        for (scale, part) in scales.iter_mut().zip(&self.parts) {
            *scale = values.factor(*part, self.parameters.eta);
        }
        Colours { base: values.diffuse(), scales }
    }
}
