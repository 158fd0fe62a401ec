//! Materials prepared for evaluation: values that do not depend on the point are computed once a scene.

use super::base::{BaseModel, CoatInterface, RoughCoat};
use super::bsdf::{Bsdf, Colours};
use super::lobe::{
    DIFFUSE_ALPHA, Interface, LobeModel, MAX_LOBES, Mirror, Passage, RoughInterface, RoughLobe, albedo_table,
    max_reflectance_table,
};
use super::microfacet::Microfacets;
use super::principled::PrincipledModel;
use super::roughness::{self, Level, Levels};
use super::table::AngleTable;
use crate::math::{Rgb, luminance};
use crate::scene::{Fresnel, Lobe, Material, MaterialId, Reflectance, Scene, Share, Texture, TextureId};
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
    /// True if the surface's two sides are the two sides of one interface.
    pub transmits: bool,
    /// True if light may go to the other side, there or by gaps.
    pub passes_light: bool,
    /// Material of the scene.
    pub material: MaterialId,
    /// Models to look up instead, if the roughness is textured.
    pub levels: Option<Levels>,
    source: Source,
    /// Share of the surface that is there, and the slot of the rest.
    opacity: Option<(Share, usize)>,
    /// The colours, if nothing is textured.
    constant: Option<Colours<Rgb>>,
}

/// Colours of a material before textures are looked up.
#[derive(Clone, Debug)]
enum Source {
    Layers(Colours<Reflectance>),
    Principled(PrincipledModel),
    Blend(Box<BlendSource>),
}

/// Two sources, the lobes of one before those of the other.
#[derive(Clone, Debug)]
struct BlendSource {
    /// Share of the second.
    weight: Share,
    sources: [(Source, BaseModel); 2],
    /// Number of the first one's lobes.
    first: usize,
}

impl Source {
    fn is_textured(&self) -> bool {
        match self {
            Source::Layers(colours) => {
                colours.base.is_textured() || colours.scales.iter().any(Reflectance::is_textured)
            }
            Source::Principled(principled) => principled.is_textured(),
            Source::Blend(blend) => {
                blend.weight.is_textured() || blend.sources.iter().any(|(source, _)| source.is_textured())
            }
        }
    }

    /// Returns BRDF of the base and factors on the lobes where each texture has the value `texel` of it.
    fn colours(&self, base: &BaseModel, texel: &dyn Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let value = |reflectance: Reflectance| match reflectance {
            Reflectance::Constant(value) => value,
            textured => textured.value(texel).max(Rgb::ZERO),
        };
        match self {
            Source::Layers(colours) => {
                Colours { base: base.brdf(value(colours.base)), scales: colours.scales.map(value) }
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
struct Layers {
    source: Source,
    base: BaseModel,
    /// True if the base is black.
    black: bool,
    /// True if there is a coat on it.
    coated: bool,
    lobes: Vec<LobeModel>,
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

impl Layers {
    /// Base and lobes of a material, of which at most `most` are kept, for a level of its roughness if that is
    /// textured.
    fn new(
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
                    let lobe = RoughLobe { facets, fresnel, max_reflectance: None, albedo: None };
                    add(LobeModel::Rough(lobe), scale);
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
        Layers { source: Source::Layers(source), base, black, coated: coat.is_some(), lobes }
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
        let most = MAX_LOBES - usize::from(material.opacity.is_some());
        let Layers { source, base, black, coated, mut lobes } =
            Layers::new(material, textures, level, most, tables);
        let bare = !black && !coated;
        let needs_albedo = bare || lobes.len() > 1 || material.parts().any(|part| part.principled.is_some());
        for lobe in &mut lobes {
            let LobeModel::Rough(rough) = lobe else { continue };
            if needs_albedo || rough.facets.alpha >= DIFFUSE_ALPHA {
                rough.albedo = Some(tables.albedo(rough.facets, rough.fresnel));
            }
            if let Fresnel::Conductor { .. } | Fresnel::Schlick { .. } = rough.fresnel {
                rough.max_reflectance = Some(Arc::new(max_reflectance_table(&rough.fresnel)));
            }
        }
        let transmits = lobes.iter().any(LobeModel::transmits);
        let opacity = material.opacity.map(|opacity| (opacity, lobes.len()));
        lobes.extend(opacity.map(|_| LobeModel::Gap));
        let is_textured =
            source.is_textured() || material.opacity.is_some_and(|opacity| opacity.is_textured());
        let mut model = Model {
            two_sided: material.two_sided,
            base,
            coat: 0,
            lobe_list: 0,
            lambert: bare && lobes.is_empty(),
            smooth_lobes: lobes.iter().any(|lobe| !lobe.is_delta()),
            delta_lobes: lobes.iter().any(LobeModel::is_delta),
            transmits,
            passes_light: transmits || opacity.is_some(),
            lobes,
            material: id,
            levels: None,
            source,
            opacity,
            constant: None,
        };
        if !is_textured {
            model.constant = Some(model.colours(|_| Rgb::ONE));
        }
        model
    }

    /// Returns the colours where each texture has the value `texel` of it.
    fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let mut colours = self.source.colours(&self.base, &texel);
        if let Some((opacity, gap)) = self.opacity {
            let share = opacity.value(|id| luminance(texel(id))).clamp(0.0, 1.0);
            colours.base *= share;
            colours.scales.iter_mut().for_each(|scale| *scale *= share);
            colours.scales[gap] = Rgb::splat(1.0 - share);
        }
        colours
    }
}
