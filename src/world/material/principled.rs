//! Principled materials as a base and lobes, whose colours follow from the parameters of the material.
//!
//! Deviations: the last of more than [`MAX_LOBES`] lobes are left out. Only textures that mix metal, glass, varnish and
//! sheen at one point need as many.

use super::lobe::{
    AnisotropicLobe, ClearCoat, Grazing, GrazingKind, LobeModel, MAX_LOBES, Passage, RoughInterface,
    RoughLobe,
};
use super::microfacet::Microfacets;
use super::model::Colours;
use super::roughness::RoughnessValues;
use super::tables::Tables;
use base::math::{Rgb, luminance};
use scene::{Distribution, Fresnel, Principled, Share, TextureId};

/// Minimum roughness α, as in Mitsuba.
const MIN_ALPHA: f32 = 1e-3;

/// Colours of a principled material before textures are looked up.
#[derive(Clone, Debug)]
pub(super) struct PrincipledColours {
    parameters: Box<Principled>,
    /// Kind of each lobe, which gives the factor on it.
    lobes: Vec<PrincipledLobe>,
}

/// Kind of a principled material's lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
enum PrincipledLobe {
    /// Reflection by the dielectric, without hue.
    Dielectric,
    /// Reflection with a hue, by metal and tinted dielectric, if it is constant.
    Hued,
    /// Part of the textured reflection with a hue that vanishes at grazing incidence.
    HuedNormal,
    /// Part of the textured reflection with a hue that vanishes at normal incidence.
    HuedEdge,
    /// Refraction by the rough interface.
    Transmission,
    /// Reflection of light inside.
    Inside,
    /// Retroreflection of the rough diffuse base.
    Retro,
    ClearCoat,
    Sheen,
}

/// Parameters at a point.
struct PrincipledValues {
    colour: Rgb,
    /// Colour of the same hue and a luminance of 1.
    hue: Rgb,
    metallic: f32,
    spec_tint: f32,
    spec_trans: f32,
    sheen: f32,
    sheen_tint: f32,
    clearcoat: f32,
    /// Factor on transmitted light.
    tint: Rgb,
}

impl PrincipledValues {
    /// Evaluates the parameters; `texel` returns the value of a texture.
    fn of(p: &Principled, texel: impl Fn(TextureId) -> Rgb) -> PrincipledValues {
        let share = |share: &Share| share.value(|id| luminance(texel(id))).clamp(0.0, 1.0);
        let colour = p.base_color.value(&texel).max(Rgb::ZERO);
        let brightness = luminance(colour);
        PrincipledValues {
            colour,
            hue: if brightness > 0.0 { colour / brightness } else { Rgb::ONE },
            metallic: share(&p.metallic),
            spec_tint: share(&p.spec_tint),
            spec_trans: share(&p.spec_trans),
            sheen: share(&p.sheen),
            sheen_tint: share(&p.sheen_tint),
            clearcoat: share(&p.clearcoat),
            tint: match p.tints_each_passage {
                true => colour,
                false => Rgb::from_array(colour.to_array().map(f32::sqrt)),
            },
        }
    }

    /// Returns the albedo of the diffuse base.
    fn diffuse(&self) -> Rgb {
        self.colour * ((1.0 - self.metallic) * (1.0 - self.spec_trans))
    }

    /// Returns the reflectance with a hue at normal incidence.
    fn hued_normal(&self, eta: f32) -> Rgb {
        let f0 = ((eta - 1.0) / (eta + 1.0)).powi(2);
        self.colour * self.metallic + self.hue * ((1.0 - self.metallic) * self.spec_tint * f0)
    }

    /// Returns the reflectance with a hue at grazing incidence.
    fn hued_edge(&self) -> f32 {
        self.metallic + (1.0 - self.metallic) * self.spec_tint
    }

    /// Returns the factor on a lobe.
    fn factor(&self, lobe: PrincipledLobe, eta: f32) -> Rgb {
        let transmitted = (1.0 - self.metallic) * self.spec_trans;
        match lobe {
            PrincipledLobe::Dielectric => Rgb::splat((1.0 - self.metallic) * (1.0 - self.spec_tint)),
            PrincipledLobe::Hued => Rgb::ONE,
            PrincipledLobe::HuedNormal => self.hued_normal(eta),
            PrincipledLobe::HuedEdge => Rgb::splat(self.hued_edge()),
            PrincipledLobe::Transmission => self.tint * transmitted,
            PrincipledLobe::Inside => Rgb::splat(transmitted),
            PrincipledLobe::Retro => self.diffuse(),
            PrincipledLobe::ClearCoat => Rgb::splat(self.clearcoat),
            PrincipledLobe::Sheen => {
                let hue = Rgb::ONE.lerp(self.hue, self.sheen_tint);
                hue * (self.sheen * (1.0 - self.metallic))
            }
        }
    }
}

/// Lobes of a principled material, of one roughness.
struct LobeBuilder<'a> {
    parameters: &'a Principled,
    /// Square root of α.
    roughness: f32,
    /// See [`Principled::anisotropic`].
    anisotropy: f32,
    facets: Microfacets,
}

impl LobeBuilder<'_> {
    /// Builds all lobes. Most lack their tables of albedo.
    fn all(&self, tables: &mut Tables) -> Vec<(PrincipledLobe, LobeModel)> {
        let p = self.parameters;
        let is_dielectric = not_all(p.metallic);
        let mut all = self.reflection();
        if is_dielectric && some(p.spec_trans) && p.eta != 1.0 {
            all.push((PrincipledLobe::Transmission, self.interface(Passage::Refraction, false)));
            all.push((PrincipledLobe::Inside, self.interface(Passage::Reflection, true)));
        }
        if is_dielectric && not_all(p.spec_trans) {
            all.push((PrincipledLobe::Retro, LobeModel::Grazing(tables.retro(self.roughness))));
        }
        if some(p.clearcoat) {
            all.push((PrincipledLobe::ClearCoat, LobeModel::ClearCoat(ClearCoat::new(p.clearcoat_gloss))));
        }
        if is_dielectric && some(p.sheen) {
            all.push((PrincipledLobe::Sheen, LobeModel::Grazing(Grazing::new(GrazingKind::Sheen))));
        }
        all
    }

    /// Builds the lobes of specular reflection, without and with a hue.
    fn reflection(&self) -> Vec<(PrincipledLobe, LobeModel)> {
        let p = self.parameters;
        let mut all = Vec::new();
        if not_all(p.metallic) && not_all(p.spec_tint) {
            all.push((PrincipledLobe::Dielectric, self.rough(Fresnel::Dielectric(p.eta))));
        }
        let has_hue = some(p.metallic) || some(p.spec_tint);
        let is_constant =
            !p.base_color.is_textured() && !p.metallic.is_textured() && !p.spec_tint.is_textured();
        if has_hue && is_constant {
            let values = PrincipledValues::of(p, |_| Rgb::ONE);
            let (normal, edge) = (values.hued_normal(p.eta), values.hued_edge());
            all.push((PrincipledLobe::Hued, self.rough(Fresnel::Schlick { normal, edge })));
        } else if has_hue {
            let schlick = |normal, edge| self.rough(Fresnel::Schlick { normal: Rgb::splat(normal), edge });
            all.push((PrincipledLobe::HuedNormal, schlick(1.0, 0.0)));
            all.push((PrincipledLobe::HuedEdge, schlick(0.0, 1.0)));
        }
        all
    }

    /// Builds a lobe of microfacet reflection.
    fn rough(&self, fresnel: Fresnel) -> LobeModel {
        let facets = self.facets;
        if self.parameters.anisotropic == Share::Constant(0.0) {
            return LobeModel::Rough(RoughLobe::new(facets, fresnel));
        }
        let alpha = self.parameters.stretch.alphas(facets.alpha, self.anisotropy);
        let alpha = alpha.map(|alpha| alpha.max(MIN_ALPHA));
        LobeModel::Anisotropic(AnisotropicLobe::new(facets.distribution, alpha, fresnel))
    }

    /// Builds a lobe of the rough dielectric interface.
    fn interface(&self, passage: Passage, inside_only: bool) -> LobeModel {
        let (facets, eta) = (self.facets, self.parameters.eta);
        LobeModel::RoughInterface(RoughInterface { facets, eta, passage, inside_only })
    }
}

/// Returns true if a share may differ from 0.
fn some(share: Share) -> bool {
    share != Share::Constant(0.0)
}

/// Returns true if a share may differ from 1.
fn not_all(share: Share) -> bool {
    share != Share::Constant(1.0)
}

impl PrincipledColours {
    /// Prepares a material; returns its lobes, too, at most `most` of them. Most lack their tables of albedo.
    pub fn new(
        parameters: &Principled,
        roughness: RoughnessValues,
        most: usize,
        tables: &mut Tables,
    ) -> (PrincipledColours, Vec<LobeModel>) {
        let anisotropy = roughness.alpha(&parameters.anisotropic).clamp(0.0, 1.0);
        let roughness = roughness.alpha(&parameters.roughness);
        let facets = Microfacets::new(Distribution::Ggx, (roughness * roughness).max(MIN_ALPHA));
        let mut all = LobeBuilder { parameters, roughness, anisotropy, facets }.all(tables);
        all.truncate(most);
        let (kinds, lobes) = all.into_iter().unzip();
        (PrincipledColours { parameters: Box::new(parameters.clone()), lobes: kinds }, lobes)
    }

    /// Returns true if any colour is textured.
    pub fn is_textured(&self) -> bool {
        let mut colours = self.parameters.clone();
        (colours.roughness, colours.anisotropic) = (Share::Constant(0.0), Share::Constant(0.0));
        colours.is_textured()
    }

    /// Returns true if the colours are linear in the texels of all textures together.
    pub fn is_linear(&self) -> bool {
        let p = &self.parameters;
        let none = |share: Share| share == Share::Constant(0.0);
        let shares = [p.metallic, p.sheen, p.clearcoat];
        // The hue is not linear in the colour.
        let without_hue = none(p.spec_tint) && (none(p.sheen_tint) || none(p.sheen));
        without_hue && none(p.spec_trans) && !shares.iter().any(Share::is_textured)
    }

    /// Returns the albedo of the base and the factors on the lobes; `texel` returns the value of a texture.
    pub fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let values = PrincipledValues::of(&self.parameters, texel);
        let mut scales = [Rgb::ZERO; MAX_LOBES];
        for (scale, lobe) in scales.iter_mut().zip(&self.lobes) {
            *scale = values.factor(*lobe, self.parameters.eta);
        }
        Colours { base: values.diffuse(), scales }
    }
}
