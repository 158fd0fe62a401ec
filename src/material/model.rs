//! Materials made ready for evaluation: what does not depend on the point is computed once a scene.

use super::bsdf::Bsdf;
use super::fresnel;
use super::microfacet::Microfacets;
use super::table::{AngleTable, RoughCoat, lobe_albedo, max_reflectance};
use crate::math::Rgb;
use crate::scene::{Coat, Fresnel, Lobe, Material, MaterialId, Reflectance, Scene};
use glam::Vec2;
use std::f32::consts::FRAC_1_PI;
use std::sync::Arc;

/// Lobes at least this rough count as diffuse where a surface becomes a virtual light: among polished metals most of
/// the light would otherwise be lost, which is worse than its spreading too widely.
pub(super) const DIFFUSE_LOBE_ALPHA: f32 = 0.05;

/// Lobes up to this rough are followed from the eye like mirrors, by a sampled direction.
pub(super) const SHARP_LOBE_ALPHA: f32 = 0.1;

/// The scene's materials, ready to be looked up at points.
#[derive(Clone, Debug)]
pub struct Materials {
    pub(super) models: Vec<Model>,
    /// A base under each kind of coat; the first is bare.
    coats: Vec<Base>,
}

/// One material.
#[derive(Clone, Debug)]
pub(super) struct Model {
    pub two_sided: bool,
    pub base: Base,
    /// Number of the coat on it; 0 for none.
    pub coat: u32,
    pub lobe: Scattering,
    /// Cosine-weighted mean of the coat's transmittance; 1 without a coat.
    pub mean_transmittance: f32,
    /// Largest Fresnel reflectance of a rough conductor by the least cosine: its formula costs more than the
    /// rest of a bound.
    pub max_reflectance: Option<Arc<AngleTable<Rgb>>>,
    /// Albedo of a rough lobe by angle, where something asks for it.
    pub lobe_albedo: Option<Arc<AngleTable<Rgb>>>,
    /// Base albedo to its BRDF, less the transmittances by angle: factor, and internal reflectance.
    base_factor: f32,
    internal_reflectance: f32,
    nonlinear: bool,
    pub(super) source: Reflectances<Reflectance>,
    /// Where nothing is textured, what `at` returns.
    constant: Option<Reflectances<Rgb>>,
}

/// What may be textured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reflectances<T> {
    /// Of the base.
    pub base: T,
    /// Factor on reflection by the lobe.
    pub scale: T,
    /// Factor on refraction.
    pub transmittance: T,
}

/// What is below the lobe.
#[derive(Clone, Debug)]
pub(super) enum Base {
    None,
    Lambert,
    /// Lambert under a smooth interface of this index.
    SmoothCoat(f32),
    RoughCoat(Arc<RoughCoat>),
}

impl Base {
    /// Share of the light at `cos` > 0 that passes the coat; 1 where there is none.
    #[inline]
    pub fn coat_transmittance(&self, cos: f32) -> f32 {
        match self {
            Base::None | Base::Lambert => 1.0,
            Base::SmoothCoat(eta) => 1.0 - fresnel::dielectric(cos, *eta),
            Base::RoughCoat(coat) => coat.transmittance.lookup(cos),
        }
    }

    /// Whether the same light reaches the base.
    fn same_coat(&self, other: &Base) -> bool {
        match (self, other) {
            (Base::SmoothCoat(a), Base::SmoothCoat(b)) => a == b,
            (Base::RoughCoat(a), Base::RoughCoat(b)) => Arc::ptr_eq(a, b),
            (Base::None | Base::Lambert, Base::None | Base::Lambert) => true,
            _ => false,
        }
    }
}

/// The lobe.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scattering {
    None,
    Rough(Microfacets, Fresnel),
    Mirror(Fresnel),
    Glass(f32),
}

impl Materials {
    /// Prepares every material of the scene.
    pub fn new(scene: &Scene) -> Materials {
        let mut tables = Tables::default();
        let mut models: Vec<Model> = scene.materials.iter().map(|m| Model::new(m, &mut tables)).collect();
        let mut coats = vec![Base::None];
        for model in &mut models {
            let known = coats.iter().position(|coat| coat.same_coat(&model.base));
            model.coat = known.unwrap_or(coats.len()) as u32;
            if known.is_none() {
                coats.push(model.base.clone());
            }
        }
        Materials { models, coats }
    }

    /// Share of the light at the cosine `cos` > 0 that passes the coat of the given number (see [`Bsdf::coat`]).
    #[inline]
    pub fn coat_transmittance(&self, coat: u32, cos: f32) -> f32 {
        self.coats.get(coat as usize).map_or(1.0, |base| base.coat_transmittance(cos))
    }

    /// The material at texture coordinates `uv`. `scene` must be the one the materials were made from.
    #[inline]
    pub fn at(&self, scene: &Scene, id: MaterialId, uv: Vec2) -> Bsdf<'_> {
        self.at_coordinates(scene, id, || uv)
    }

    /// [`Materials::at`] texture coordinates that are only asked for where there is a texture.
    #[inline]
    pub fn at_coordinates(&self, scene: &Scene, id: MaterialId, uv: impl FnOnce() -> Vec2) -> Bsdf<'_> {
        let model = &self.models[id.0 as usize];
        let values = match model.constant {
            Some(values) => values,
            None => model.textured(scene, uv()),
        };
        Bsdf { model, base: values.base, scale: values.scale, transmittance: values.transmittance }
    }
}

/// Tables that materials share when roughness and indices agree.
#[derive(Default)]
struct Tables {
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

    fn albedo(&mut self, facets: Microfacets, fresnel: Fresnel) -> Arc<AngleTable<Rgb>> {
        if let Some((_, _, albedo)) = self.albedos.iter().find(|a| a.0 == facets && a.1 == fresnel) {
            return albedo.clone();
        }
        let albedo = Arc::new(lobe_albedo(&facets, &fresnel));
        self.albedos.push((facets, fresnel, albedo.clone()));
        albedo
    }
}

impl Model {
    fn new(material: &Material, tables: &mut Tables) -> Model {
        let zero = Reflectance::Constant(Rgb::ZERO);
        let (lobe, scale, transmittance) = match material.lobe {
            Lobe::None => (Scattering::None, zero, zero),
            Lobe::Rough { distribution, alpha, fresnel, scale } => {
                (Scattering::Rough(Microfacets::new(distribution, alpha), fresnel), scale, zero)
            }
            Lobe::Mirror { fresnel, scale } => (Scattering::Mirror(fresnel), scale, zero),
            Lobe::Dielectric { eta, reflectance, transmittance } => {
                (Scattering::Glass(eta), reflectance, transmittance)
            }
        };
        // Glass has no base: nothing could lie beneath it.
        let black = material.diffuse == zero || matches!(lobe, Scattering::Glass(_));
        let base = match (material.coat, lobe) {
            _ if black => Base::None,
            (None, _) => Base::Lambert,
            (Some(coat), Scattering::Rough(facets, _)) => Base::RoughCoat(tables.coat(facets, coat.eta)),
            (Some(coat), _) => Base::SmoothCoat(coat.eta),
        };
        let (mean_transmittance, internal_reflectance) = match &base {
            Base::None | Base::Lambert => (1.0, 0.0),
            // 1 - the mean reflectance outside follows from that inside by reciprocity; the fit inside is
            // the one that sets the base's brightness, so both come from it.
            Base::SmoothCoat(eta) => {
                let internal = fresnel::diffuse_reflectance(1.0 / eta);
                (eta * eta * (1.0 - internal), internal)
            }
            Base::RoughCoat(coat) => (coat.mean_transmittance, coat.internal_reflectance),
        };
        let lobe_albedo = match lobe {
            Scattering::Rough(facets, fresnel)
                if matches!(base, Base::Lambert) || facets.alpha >= DIFFUSE_LOBE_ALPHA =>
            {
                Some(tables.albedo(facets, fresnel))
            }
            _ => None,
        };
        let coat = material.coat.unwrap_or(Coat { eta: 1.0, nonlinear: false });
        let mut model = Model {
            two_sided: material.two_sided,
            base,
            coat: 0,
            lobe,
            mean_transmittance,
            max_reflectance: match lobe {
                Scattering::Rough(_, fresnel @ Fresnel::Conductor { .. }) => {
                    Some(Arc::new(max_reflectance(&fresnel)))
                }
                _ => None,
            },
            lobe_albedo,
            base_factor: FRAC_1_PI / (coat.eta * coat.eta),
            internal_reflectance,
            nonlinear: coat.nonlinear,
            source: Reflectances { base: if black { zero } else { material.diffuse }, scale, transmittance },
            constant: None,
        };
        if let Reflectances {
            base: Reflectance::Constant(base),
            scale: Reflectance::Constant(scale),
            transmittance: Reflectance::Constant(transmittance),
        } = model.source
        {
            let base = model.base_brdf(base);
            model.constant = Some(Reflectances { base, scale, transmittance });
        }
        model
    }

    fn textured(&self, scene: &Scene, uv: Vec2) -> Reflectances<Rgb> {
        let lookup = |reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            Reflectance::Textured { texture, scale } => {
                let texel = scene.textures.get(texture.0 as usize).map_or(Rgb::ONE, |t| t.lookup(uv));
                (texel * scale).max(Rgb::ZERO)
            }
        };
        Reflectances {
            base: self.base_brdf(lookup(self.source.base)),
            scale: lookup(self.source.scale),
            transmittance: lookup(self.source.transmittance),
        }
    }

    /// BRDF of the base, less the coat's transmittances by angle.
    #[inline]
    pub(super) fn base_brdf(&self, albedo: Rgb) -> Rgb {
        if self.internal_reflectance == 0.0 {
            return albedo * self.base_factor;
        }
        let returned = if self.nonlinear { albedo.min(Rgb::ONE) } else { Rgb::ONE };
        albedo * self.base_factor / (1.0 - returned * self.internal_reflectance)
    }
}
