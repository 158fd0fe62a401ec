//! Materials made ready for evaluation: what does not depend on the point is computed once a scene.

use super::base::{BaseModel, CoatInterface, RoughCoat};
use super::bsdf::Bsdf;
use super::lobe::{
    DIFFUSE_ALPHA, Interface, LobeModel, MAX_LOBES, Mirror, Passage, RoughLobe, albedo_table,
    max_reflectance_table,
};
use super::microfacet::Microfacets;
use super::table::AngleTable;
use crate::math::Rgb;
use crate::scene::{Fresnel, Lobe, Material, MaterialId, Reflectance, Scene, TextureId};
use glam::{DVec3, Vec2};
use std::sync::Arc;

const BLACK: Reflectance = Reflectance::Constant(Rgb::ZERO);

/// The scene's materials, ready to be looked up at points.
#[derive(Clone, Debug)]
pub struct Materials {
    models: Vec<Model>,
    /// Every coat that differs from others; the first is none.
    coats: Vec<CoatInterface>,
}

/// One material.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// Whether the back behaves as the front; never so where an interface has two sides of its own.
    pub two_sided: bool,
    pub base: BaseModel,
    /// Number of the coat on it; 0 for none.
    pub coat: u32,
    pub lobes: Vec<LobeModel>,
    /// Number of the list of lobes: equal where lobes agree but for their factors.
    pub lobe_list: u32,
    /// Whether it is Lambertian and nothing else.
    pub lambert: bool,
    /// Whether some lobe scatters into more than isolated directions.
    pub smooth_lobes: bool,
    /// Whether some lobe scatters into isolated directions.
    pub delta_lobes: bool,
    /// Whether light may go to the other side.
    pub transmits: bool,
    source: Colours<Reflectance>,
    /// Where nothing is textured, what `at` returns.
    constant: Option<Colours<Rgb>>,
}

/// The colours of a material.
#[derive(Clone, Copy, Debug)]
struct Colours<T> {
    /// Albedo or BRDF of the base.
    base: T,
    /// Factors on the lobes.
    scales: [T; MAX_LOBES],
}

impl Materials {
    /// Prepares every material of the scene.
    pub fn new(scene: &Scene) -> Materials {
        let mut tables = Tables::default();
        let mut models: Vec<Model> = scene.materials.iter().map(|m| Model::new(m, &mut tables)).collect();
        let mut coats = vec![CoatInterface::None];
        let mut lobe_lists: Vec<Vec<LobeModel>> = Vec::new();
        for model in &mut models {
            model.coat = number(&mut coats, &model.base.interface);
            model.lobe_list = number(&mut lobe_lists, &model.lobes);
        }
        Materials { models, coats }
    }

    /// Number of materials.
    pub fn count(&self) -> usize {
        self.models.len()
    }

    /// Share of the light at the cosine `cos` > 0 that passes the coat of the given number (see [`Bsdf::coat`]).
    #[inline]
    pub fn coat_transmittance(&self, coat: u32, cos: f32) -> f32 {
        self.coats.get(coat as usize).map_or(1.0, |coat| coat.transmittance(cos))
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
        let colours = match model.constant {
            Some(colours) => colours,
            None => {
                let uv = uv();
                model.colours(|id| scene.textures.get(id.0 as usize).map_or(Rgb::ONE, |t| t.lookup(uv)))
            }
        };
        Bsdf { model, base: colours.base, scales: colours.scales }
    }

    /// The material with every texture replaced by its mean.
    pub fn average(&self, scene: &Scene, id: MaterialId) -> Bsdf<'_> {
        let model = &self.models[id.0 as usize];
        let colours = model.colours(|id| {
            let texels = scene.textures.get(id.0 as usize).map_or(&[][..], |t| &t.texels);
            let sum = texels.iter().fold(DVec3::ZERO, |sum, t| sum + t.as_dvec3());
            if texels.is_empty() { Rgb::ONE } else { (sum / texels.len() as f64).as_vec3() }
        });
        Bsdf { model, base: colours.base, scales: colours.scales }
    }
}

/// Place of `item` among `known`, to which it is added if it is not there.
fn number<T: PartialEq + Clone>(known: &mut Vec<T>, item: &T) -> u32 {
    let at = known.iter().position(|k| k == item).unwrap_or_else(|| {
        known.push(item.clone());
        known.len() - 1
    });
    at as u32
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
        let albedo = Arc::new(albedo_table(&facets, &fresnel));
        self.albedos.push((facets, fresnel, albedo.clone()));
        albedo
    }
}

impl Model {
    fn new(material: &Material, tables: &mut Tables) -> Model {
        let mut source = Colours { base: material.diffuse, scales: [BLACK; MAX_LOBES] };
        let mut lobes = Vec::new();
        let mut add = |lobe, scale| {
            if let Some(slot) = source.scales.get_mut(lobes.len()) {
                *slot = scale;
                lobes.push(lobe);
            }
        };
        for lobe in &material.lobes {
            match *lobe {
                Lobe::Rough { distribution, alpha, fresnel, scale } => {
                    let facets = Microfacets::new(distribution, alpha);
                    let lobe = RoughLobe { facets, fresnel, max_reflectance: None, albedo: None };
                    add(LobeModel::Rough(lobe), scale);
                }
                Lobe::Mirror { fresnel, scale } => add(LobeModel::Mirror(Mirror { fresnel }), scale),
                Lobe::Dielectric { eta, reflectance, transmittance } => {
                    let way = |passage| LobeModel::Interface(Interface { eta, passage });
                    add(way(Passage::Reflection), reflectance);
                    add(way(Passage::Refraction), transmittance);
                }
            }
        }
        let transmits = lobes.iter().any(LobeModel::transmits);
        // Nothing could lie beneath an interface that light passes.
        let black = material.diffuse == BLACK || transmits;
        if black {
            source.base = BLACK;
        }
        let coat = material.coat.filter(|_| !black);
        let facets = lobes.iter().find_map(|lobe| match lobe {
            LobeModel::Rough(rough) => Some(rough.facets),
            _ => None,
        });
        let interface = match (coat, facets) {
            (None, _) => CoatInterface::None,
            (Some(coat), Some(facets)) => CoatInterface::Rough(tables.coat(facets, coat.eta)),
            (Some(coat), None) => CoatInterface::Smooth(coat.eta),
        };
        let bare = !black && coat.is_none();
        let alone = lobes.len() == 1;
        for lobe in &mut lobes {
            let LobeModel::Rough(rough) = lobe else { continue };
            if bare || !alone || rough.facets.alpha >= DIFFUSE_ALPHA {
                rough.albedo = Some(tables.albedo(rough.facets, rough.fresnel));
            }
            if let Fresnel::Conductor { .. } = rough.fresnel {
                rough.max_reflectance = Some(Arc::new(max_reflectance_table(&rough.fresnel)));
            }
        }
        let mut model = Model {
            two_sided: material.two_sided,
            base: BaseModel::new(coat, interface),
            coat: 0,
            lobe_list: 0,
            lambert: bare && lobes.is_empty(),
            smooth_lobes: lobes.iter().any(|lobe| !lobe.is_delta()),
            delta_lobes: lobes.iter().any(LobeModel::is_delta),
            transmits,
            lobes,
            source,
            constant: None,
        };
        let textured = |r: &Reflectance| matches!(r, Reflectance::Textured { .. });
        if !textured(&source.base) && !source.scales.iter().any(textured) {
            model.constant = Some(model.colours(|_| Rgb::ONE));
        }
        model
    }

    /// The colours where each texture has the value `texel` of it.
    fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let value = |reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            Reflectance::Textured { texture, scale } => (texel(texture) * scale).max(Rgb::ZERO),
        };
        Colours { base: self.base.brdf(value(self.source.base)), scales: self.source.scales.map(value) }
    }
}
