//! Principled materials as a base and lobes, whose colours follow from the parameters of the material.
//!
//! A Lambertian base gets the light that the dielectric does not reflect, and sends on what the dielectric lets pass. A
//! base of albedo ρ under a dielectric of albedo E reflects ρ (1 - E), as in Blender. Appendix B of the glTF
//! specification has 1 - F for 1 - E, F at the half-way vector.
//!
//! Deviations: E is tabulated for steps of a textured roughness. The last of more than [`MAX_LOBES`] lobes are left
//! out. Only textures that mix metal, glass, varnish and sheen at one point need as many.

use super::base::CoatInterface;
use super::lobe::{
    AnisotropicLobe, ClearCoat, Grazing, GrazingKind, LobeModel, MAX_LOBES, Passage, RoughInterface,
    RoughLobe, Thin, ThinFacets,
};
use super::microfacet::Microfacets;
use super::model::Colours;
use super::roughness::RoughnessValues;
use super::tables::Tables;
use base::math::{Rgb, luminance};
use scene::{Diffuse, Distribution, Fresnel, Principled, Share, TextureId};

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
    /// Transmission of a sheet around the direction of the light.
    ThinRough,
    /// Diffuse transmission of a sheet.
    ThinDiffuse,
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
    /// Share of the diffuse light that a sheet transmits; `None` for other surfaces.
    thin: Option<f32>,
}

impl PrincipledValues {
    /// Evaluates the parameters; `texel` returns the value of a texture.
    fn new(p: &Principled, texel: impl Fn(TextureId) -> Rgb) -> PrincipledValues {
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
            thin: p.thin.as_ref().map(share),
        }
    }

    /// Returns the albedo of the diffuse base.
    fn diffuse(&self) -> Rgb {
        self.colour * ((1.0 - self.metallic) * (1.0 - self.spec_trans) * (1.0 - self.thin.unwrap_or(0.0)))
    }

    /// Returns the factor on specular reflection, which a sheet has only where it transmits light.
    fn specular(&self) -> f32 {
        if self.thin.is_some() { self.spec_trans } else { 1.0 }
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
            PrincipledLobe::Dielectric => {
                Rgb::splat((1.0 - self.metallic) * (1.0 - self.spec_tint) * self.specular())
            }
            PrincipledLobe::Hued => Rgb::splat(self.specular()),
            PrincipledLobe::HuedNormal => self.hued_normal(eta) * self.specular(),
            PrincipledLobe::HuedEdge => Rgb::splat(self.hued_edge() * self.specular()),
            PrincipledLobe::ThinRough => self.colour * self.spec_trans,
            PrincipledLobe::ThinDiffuse => self.colour * ((1.0 - self.spec_trans) * self.thin.unwrap_or(0.0)),
            PrincipledLobe::Transmission => self.tint * transmitted,
            PrincipledLobe::Inside => Rgb::splat(transmitted),
            PrincipledLobe::Retro => self.diffuse(),
            PrincipledLobe::ClearCoat => Rgb::splat(self.clearcoat),
            PrincipledLobe::Sheen => {
                let hue = Rgb::ONE.lerp(self.hue, self.sheen_tint);
                let of_sheet = self.thin.map_or(1.0, |thin| (1.0 - thin) * (1.0 - self.spec_trans));
                hue * (self.sheen * (1.0 - self.metallic) * of_sheet)
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
        if let Some(transmitted) = p.thin {
            return self.of_sheet(transmitted);
        }
        let is_dielectric = not_all(p.metallic);
        let mut all = self.reflection();
        if is_dielectric && some(p.spec_trans) && p.eta != 1.0 {
            all.push((PrincipledLobe::Transmission, self.interface(Passage::Refraction, false)));
            all.push((PrincipledLobe::Inside, self.interface(Passage::Reflection, true)));
        }
        if is_dielectric && not_all(p.spec_trans) && p.diffuse == Diffuse::Burley {
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

    /// Builds all lobes of a thin sheet that transmits a share of its diffuse light.
    fn of_sheet(&self, transmitted: Share) -> Vec<(PrincipledLobe, LobeModel)> {
        let p = self.parameters;
        let mut all = Vec::new();
        if some(p.spec_trans) {
            all.extend(self.reflection());
            // Burley 2015, figure 15.
            let roughness = (0.65 * p.eta - 0.35) * self.roughness;
            let facets = ggx(roughness);
            let facets = match (LobeBuilder { facets, ..*self }).brushed() {
                Some(alpha) => {
                    let lobe = AnisotropicLobe::new(Distribution::Ggx, alpha, Fresnel::One);
                    ThinFacets::Anisotropic(lobe)
                }
                None => ThinFacets::Isotropic(RoughLobe::new(facets, Fresnel::One)),
            };
            all.push((PrincipledLobe::ThinRough, LobeModel::Thin(Thin::Rough { facets, eta: p.eta })));
        }
        if not_all(p.spec_trans) {
            if some(transmitted) {
                all.push((PrincipledLobe::ThinDiffuse, LobeModel::Thin(Thin::Diffuse)));
            }
            if not_all(transmitted) {
                let kind = GrazingKind::Retro { roughness: self.roughness };
                all.push((PrincipledLobe::Retro, LobeModel::Grazing(Grazing::new(kind))));
            }
            if some(p.sheen) && not_all(transmitted) {
                all.push((PrincipledLobe::Sheen, LobeModel::Grazing(Grazing::new(GrazingKind::Sheen))));
            }
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
            let values = PrincipledValues::new(p, |_| Rgb::ONE);
            let (normal, edge) = (values.hued_normal(p.eta), values.hued_edge());
            all.push((PrincipledLobe::Hued, self.rough(Fresnel::Schlick { normal, edge })));
        } else if has_hue {
            let schlick = |normal, edge| self.rough(Fresnel::Schlick { normal: Rgb::splat(normal), edge });
            all.push((PrincipledLobe::HuedNormal, schlick(1.0, 0.0)));
            all.push((PrincipledLobe::HuedEdge, schlick(0.0, 1.0)));
        }
        all
    }

    /// Returns the roughness α along u and along v, if they differ.
    fn brushed(&self) -> Option<[f32; 2]> {
        if self.parameters.anisotropic == Share::Constant(0.0) {
            return None;
        }
        let alpha = self.parameters.stretch.alphas(self.facets.alpha, self.anisotropy);
        Some(alpha.map(|alpha| alpha.max(MIN_ALPHA)))
    }

    /// Builds a lobe of microfacet reflection.
    fn rough(&self, fresnel: Fresnel) -> LobeModel {
        match self.brushed() {
            None => LobeModel::Rough(RoughLobe::new(self.facets, fresnel)),
            Some(alpha) => {
                LobeModel::Anisotropic(AnisotropicLobe::new(self.facets.distribution, alpha, fresnel))
            }
        }
    }

    /// Builds a lobe of the rough dielectric interface.
    fn interface(&self, passage: Passage, inside_only: bool) -> LobeModel {
        let (facets, eta) = (self.facets, self.parameters.eta);
        LobeModel::RoughInterface(RoughInterface { facets, eta, passage, inside_only })
    }
}

/// Returns the microfacets of a roughness, the square root of α.
fn ggx(roughness: f32) -> Microfacets {
    Microfacets::new(Distribution::Ggx, (roughness * roughness).max(MIN_ALPHA))
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
    /// Prepares a material; returns the surface over its base, and its lobes, too, at most `most` of them. Most lobes
    /// lack their tables of albedo.
    pub fn new(
        parameters: &Principled,
        roughness: RoughnessValues,
        most: usize,
        tables: &mut Tables,
    ) -> (PrincipledColours, CoatInterface, Vec<LobeModel>) {
        let anisotropy = roughness.alpha(&parameters.anisotropic).clamp(0.0, 1.0);
        let of_layer = roughness.alpha_of_coat(&parameters.roughness);
        let roughness = roughness.alpha(&parameters.roughness);
        let facets = ggx(roughness);
        let mut all = LobeBuilder { parameters, roughness, anisotropy, facets }.all(tables);
        all.truncate(most);
        let (kinds, lobes) = all.into_iter().unzip();
        let interface = match parameters.diffuse {
            Diffuse::Lambertian if parameters.thin.is_none() && not_all(parameters.metallic) => {
                CoatInterface::Rough(tables.layer(ggx(of_layer), parameters.eta))
            }
            Diffuse::Burley | Diffuse::Lambertian => CoatInterface::Burley,
        };
        (PrincipledColours { parameters: Box::new(parameters.clone()), lobes: kinds }, interface, lobes)
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
        let shares = [p.metallic, p.sheen, p.clearcoat, p.thin.unwrap_or(Share::Constant(0.0))];
        // The hue is not linear in the colour.
        let without_hue = none(p.spec_tint) && (none(p.sheen_tint) || none(p.sheen));
        without_hue && none(p.spec_trans) && !shares.iter().any(Share::is_textured)
    }

    /// Returns the albedo of the base and the factors on the lobes; `texel` returns the value of a texture.
    pub fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let values = PrincipledValues::new(&self.parameters, texel);
        let mut scales = [Rgb::ZERO; MAX_LOBES];
        for (scale, lobe) in scales.iter_mut().zip(&self.lobes) {
            *scale = values.factor(*lobe, self.parameters.eta);
        }
        Colours { base: values.diffuse(), scales }
    }
}
