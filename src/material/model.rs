//! Materials prepared for evaluation: values that do not depend on the point are computed once a scene.

use super::base::{BaseModel, CoatInterface, RoughCoat};
use super::bsdf::Bsdf;
use super::lobe::{
    DIFFUSE_ALPHA, Interface, LobeModel, MAX_LOBES, Mirror, Passage, RoughLobe, albedo_table,
    max_reflectance_table,
};
use super::microfacet::Microfacets;
use super::roughness::{self, Level, Levels};
use super::table::AngleTable;
use crate::math::{Rgb, luminance};
use crate::scene::{Fresnel, Lobe, Material, MaterialId, Reflectance, Scene, Texture, TextureId};
use glam::Vec2;
use std::sync::Arc;

/// Materials of a scene, ready to be looked up at points.
#[derive(Clone, Debug)]
pub struct Materials {
    /// Materials by their id, then further models for levels of textured roughness.
    models: Vec<Model>,
    count: usize,
    /// Every coat that differs from others; the first is none.
    coats: Vec<CoatInterface>,
}

/// Material without its textures' values.
#[derive(Clone, Debug)]
pub(super) struct Model {
    /// True if the back behaves as the front, unless an interface has two sides of its own.
    pub two_sided: bool,
    pub base: BaseModel,
    /// Number of the coat on it; 0 for none.
    pub coat: u32,
    pub lobes: Vec<LobeModel>,
    /// Number of the list of lobes: equal where lobes agree but for their factors.
    pub lobe_list: u32,
    /// True if it is Lambertian and nothing else.
    pub lambert: bool,
    /// True if some lobe scatters into more than isolated directions.
    pub smooth_lobes: bool,
    /// True if some lobe scatters into isolated directions.
    pub delta_lobes: bool,
    /// True if light may go to the other side.
    pub transmits: bool,
    /// Material of the scene.
    pub material: MaterialId,
    /// Models to look up instead, if the roughness is textured.
    pub levels: Option<Levels>,
    source: Colours<Reflectance>,
    /// The colours, if nothing is textured.
    constant: Option<Colours<Rgb>>,
}

/// Colours of a material.
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
        let textures = &scene.textures;
        let ids = || scene.materials.iter().zip((0..).map(MaterialId));
        let mut models: Vec<Model> =
            ids().map(|(material, id)| Model::new(material, id, textures, None, &mut tables)).collect();
        for (material, id) in ids() {
            let Some(levels) = Levels::of(material, textures, models.len()) else { continue };
            for level in levels.all() {
                let level = Some((levels.texture, level));
                models.push(Model::new(material, id, textures, level, &mut tables));
            }
            let model = &mut models[id.0 as usize];
            (model.levels, model.constant) = (Some(levels), None);
        }
        let mut coats = vec![CoatInterface::None];
        let mut lobe_lists: Vec<Vec<LobeModel>> = Vec::new();
        for model in &mut models {
            model.coat = number(&mut coats, &model.base.interface);
            model.lobe_list = number(&mut lobe_lists, &model.lobes);
        }
        Materials { models, count: scene.materials.len(), coats }
    }

    /// Returns the number of materials.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Returns the share of the light at the cosine `cos` > 0 that passes the coat of the given number (see
    /// [`Bsdf::coat`]).
    #[inline]
    pub fn coat_transmittance(&self, coat: u32, cos: f32) -> f32 {
        self.coats.get(coat as usize).map_or(1.0, |coat| coat.transmittance(cos))
    }

    /// Returns the material at texture coordinates `uv`. `scene` must be the one the materials were made from.
    #[inline]
    pub fn at(&self, scene: &Scene, id: MaterialId, uv: Vec2) -> Bsdf<'_> {
        self.at_coordinates(scene, id, || uv)
    }

    /// Returns the material at texture coordinates that are only asked for where there is a texture.
    #[inline]
    pub fn at_coordinates(&self, scene: &Scene, id: MaterialId, uv: impl FnOnce() -> Vec2) -> Bsdf<'_> {
        let model = &self.models[id.0 as usize];
        match &model.constant {
            Some(colours) => Bsdf { model, base: colours.base, scales: colours.scales },
            None => self.textured(model, scene, uv()),
        }
    }

    fn textured<'m>(&'m self, mut model: &'m Model, scene: &Scene, uv: Vec2) -> Bsdf<'m> {
        let texel = |id: TextureId| scene.textures.get(id.0 as usize).map_or(Rgb::ONE, |t| t.lookup(uv));
        if let Some(levels) = &model.levels {
            model = &self.models[levels.model(luminance(texel(levels.texture)))];
        }
        let colours = model.constant.unwrap_or_else(|| model.colours(texel));
        Bsdf { model, base: colours.base, scales: colours.scales }
    }

    /// Returns all materials in order, each with every texture replaced by its mean.
    pub fn averages(&self, scene: &Scene) -> impl Iterator<Item = Bsdf<'_>> {
        (0..self.count() as u32).map(|id| self.average(scene, MaterialId(id)))
    }

    /// Returns the material with every texture replaced by its mean.
    pub fn average(&self, scene: &Scene, id: MaterialId) -> Bsdf<'_> {
        let model = &self.models[id.0 as usize];
        let colours =
            model.colours(|id| scene.textures.get(id.0 as usize).map_or(Rgb::ONE, |texture| texture.mean()));
        Bsdf { model, base: colours.base, scales: colours.scales }
    }
}

/// Returns the place of `item` among `known`, to which it is added if it is not there.
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
    /// Prepares a material; if its roughness is textured, for a level of it, or for the texture's mean.
    fn new(
        material: &Material,
        id: MaterialId,
        textures: &[Texture],
        level: Option<(TextureId, Level)>,
        tables: &mut Tables,
    ) -> Model {
        let mut source = Colours { base: material.diffuse, scales: [Reflectance::BLACK; MAX_LOBES] };
        let mut lobes = Vec::new();
        let mut add = |lobe, scale| {
            if let Some(slot) = source.scales.get_mut(lobes.len()) {
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
                    let lobe = RoughLobe { facets, fresnel, max_reflectance: None, albedo: None };
                    add(LobeModel::Rough(lobe), scale);
                }
                Lobe::Mirror { fresnel, scale } => add(LobeModel::Mirror(Mirror { fresnel }), scale),
                Lobe::Dielectric { eta, thin, reflectance, transmittance } => {
                    let way = |passage| LobeModel::Interface(Interface { eta, thin, passage });
                    add(way(Passage::Reflection), reflectance);
                    add(way(Passage::Refraction), transmittance);
                }
            }
        }
        let transmits = lobes.iter().any(LobeModel::transmits);
        // Nothing could lie beneath an interface that light passes.
        let black = material.diffuse == Reflectance::BLACK || transmits;
        if black {
            source.base = Reflectance::BLACK;
        }
        let coat = material.coat.filter(|_| !black);
        let interface = match (coat, coat_facets) {
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
            material: id,
            levels: None,
            source,
            constant: None,
        };
        if !source.base.is_textured() && !source.scales.iter().any(Reflectance::is_textured) {
            model.constant = Some(model.colours(|_| Rgb::ONE));
        }
        model
    }

    /// Returns the colours where each texture has the value `texel` of it.
    fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let value = |reflectance: Reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            textured => textured.value(&texel).max(Rgb::ZERO),
        };
        Colours { base: self.base.brdf(value(self.source.base)), scales: self.source.scales.map(value) }
    }
}
