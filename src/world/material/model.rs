//! Materials prepared for evaluation: values that do not depend on the point are computed once a scene.

use super::base::{BaseModel, CoatInterface};
use super::bsdf::{Bsdf, Colours};
use super::layers::{Layers, Source, Tables};
use super::lobe::{DIFFUSE_ALPHA, LobeModel, MAX_LOBES, max_reflectance_table};
use super::roughness::{Level, Levels};
use super::straight::Straight;
use base::math::{Rgb, luminance};
use glam::Vec2;
use rayon::prelude::*;
use scene::texture::MipMaps;
use scene::{Fresnel, Material, MaterialId, Scene, Share, Texture, TextureId};
use std::cell::RefCell;
use std::sync::Arc;

/// Materials of a scene, ready to be looked up at points.
#[derive(Clone, Debug)]
pub struct Materials {
    /// Materials by their id, then further models for levels of textured roughness.
    models: Vec<Model>,
    count: usize,
    /// Every coat that differs from others; the first is none.
    coats: Vec<CoatInterface>,
    textures: MipMaps,
    /// Colours of the materials with every texture replaced by its mean.
    averages: Vec<Colours<Rgb>>,
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
    /// True if light passes straight by that rest alone.
    only_by_gaps: bool,
    /// The first texture read, if any.
    first_texture: Option<TextureId>,
    /// The colours, if nothing is textured.
    constant: Option<Colours<Rgb>>,
    /// Light that passes straight, likewise.
    straight: Option<Straight>,
    /// True if light reflected by the mean of texels is the mean of that reflected by each.
    filters: bool,
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
            model.first_texture = Some(levels.texture);
            (model.levels, model.constant, model.straight) = (Some(levels), None, None);
        }
        let mut coats = vec![CoatInterface::None];
        let mut lobe_lists: Vec<Vec<LobeModel>> = Vec::new();
        for model in &mut models {
            model.coat = number(&mut coats, &model.base.interface);
            model.lobe_list = number(&mut lobe_lists, &model.lobes);
        }
        let mip_maps = MipMaps::new(textures, models.iter().flat_map(Model::filtered_textures));
        let count = scene.materials.len();
        let means: Vec<Rgb> = textures.par_iter().map(Texture::mean).collect();
        let mean = |id: TextureId| means.get(id.0 as usize).copied().unwrap_or(Rgb::ONE);
        let averages = models[..count].iter().map(|model| model.colours(mean)).collect();
        Materials { models, count, coats, textures: mip_maps, averages }
    }

    /// True if some textures are averaged over what a ray stands for.
    #[inline]
    pub fn filter_textures(&self) -> bool {
        self.textures.filter()
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

    /// Returns the material at texture coordinates `uv`.
    #[inline]
    pub fn at(&self, id: MaterialId, uv: Vec2) -> Bsdf<'_> {
        self.at_coordinates(id, || uv, || 0.0)
    }

    /// Returns the material at texture coordinates that are only asked for where there is a texture, textures averaged
    /// over the square around them of side `covered` if it makes no difference to the mean.
    #[inline]
    pub fn at_coordinates(
        &self,
        id: MaterialId,
        uv: impl FnOnce() -> Vec2,
        covered: impl FnOnce() -> f32,
    ) -> Bsdf<'_> {
        let model = &self.models[id.0 as usize];
        match &model.constant {
            Some(colours) => Bsdf { model, base: colours.base, scales: colours.scales },
            None => {
                let covered = if model.filters { covered() } else { 0.0 };
                self.textured(model, uv(), covered)
            }
        }
    }

    /// Texture of the material that a look-up reads first; `None` if it has none.
    #[inline]
    pub fn texture(&self, id: MaterialId) -> Option<&Texture> {
        let first = self.models[id.0 as usize].first_texture?;
        self.textures.textures().by_id(first)
    }

    fn textured<'m>(&'m self, mut model: &'m Model, uv: Vec2, covered: f32) -> Bsdf<'m> {
        let texel = |id: TextureId| self.textures.lookup(id, uv, covered);
        if let Some(levels) = &model.levels {
            model = &self.models[levels.model(luminance(texel(levels.texture)))];
        }
        let colours = model.constant.unwrap_or_else(|| model.colours(texel));
        Bsdf { model, base: colours.base, scales: colours.scales }
    }

    /// Share of the surface that is not there, where light passes straight by such gaps alone and something is
    /// textured; `None` elsewhere.
    #[inline]
    pub(super) fn gaps(&self, id: MaterialId, uv: impl FnOnce() -> Vec2) -> Option<f32> {
        let model = &self.models[id.0 as usize];
        let (share, _) = model.opacity.filter(|_| model.only_by_gaps && model.constant.is_none())?;
        let uv = uv();
        let texel = |id: TextureId| self.textures.textures().lookup(id, uv);
        Some(1.0 - opaque(&share, texel))
    }

    /// Lobes that light passes straight, if there are any and nothing of the material is textured.
    #[inline]
    pub(super) fn straight(&self, id: MaterialId) -> Option<&Straight> {
        self.models[id.0 as usize].straight.as_ref()
    }

    /// Returns all materials in order, each with every texture replaced by its mean.
    pub fn averages(&self) -> impl Iterator<Item = Bsdf<'_>> {
        (0..self.count as u32).map(|id| self.average(MaterialId(id)))
    }

    /// Returns the material with every texture replaced by its mean.
    pub fn average(&self, id: MaterialId) -> Bsdf<'_> {
        let (model, colours) = (&self.models[id.0 as usize], &self.averages[id.0 as usize]);
        Bsdf { model, base: colours.base, scales: colours.scales }
    }
}

/// Share of a surface that is there where each texture has the value `texel` of it.
fn opaque(opacity: &Share, texel: impl Fn(TextureId) -> Rgb) -> f32 {
    opacity.value(|id| luminance(texel(id))).clamp(0.0, 1.0)
}

/// Returns the place of `item` among `known`, to which it is added if it is not there.
fn number<T: PartialEq + Clone>(known: &mut Vec<T>, item: &T) -> u32 {
    let at = known.iter().position(|k| k == item).unwrap_or_else(|| {
        known.push(item.clone());
        known.len() - 1
    });
    at as u32
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
            if rough.may_radiate() {
                rough.white = Some(tables.albedo(rough.facets, Fresnel::One));
            }
            if let Fresnel::Conductor { .. } | Fresnel::Schlick { .. } = rough.fresnel {
                rough.max_reflectance = Some(Arc::new(max_reflectance_table(&rough.fresnel)));
            }
        }
        let transmits = lobes.iter().any(LobeModel::transmits);
        let opacity = material.opacity.map(|opacity| (opacity, lobes.len()));
        lobes.extend(opacity.map(|_| LobeModel::Gap));
        let only_by_gaps = lobes.iter().all(|lobe| matches!(lobe, LobeModel::Gap) || !lobe.passes_straight());
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
            only_by_gaps,
            first_texture: None,
            constant: None,
            straight: None,
            filters: false,
        };
        // Factors on each other vary together.
        let is_of_one_factor = material.opacity.is_none_or(|opacity| !opacity.is_textured())
            && material.relief.is_none()
            && material.parts().all(|part| !part.has_textured_roughness());
        model.filters = is_textured && is_of_one_factor && model.source.is_linear(&model.base);
        if is_textured {
            model.first_texture = model.textures().first().copied();
        } else {
            let colours = model.colours(|_| Rgb::ONE);
            model.straight = Straight::new(&model.lobes, &colours.scales);
            model.constant = Some(colours);
        }
        model
    }

    /// Textures that are averaged.
    fn filtered_textures(&self) -> Vec<TextureId> {
        if self.filters { self.textures() } else { Vec::new() }
    }

    /// Textures in the order in which they are read, but for those of levels.
    fn textures(&self) -> Vec<TextureId> {
        let found = RefCell::new(Vec::new());
        self.colours(|texture| {
            found.borrow_mut().push(texture);
            Rgb::ONE
        });
        found.into_inner()
    }

    /// Returns the colours where each texture has the value `texel` of it.
    fn colours(&self, texel: impl Fn(TextureId) -> Rgb) -> Colours<Rgb> {
        let mut colours = self.source.colours(&self.base, &texel);
        if let Some((opacity, gap)) = self.opacity {
            let share = opaque(&opacity, texel);
            colours.base *= share;
            colours.scales.iter_mut().for_each(|scale| *scale *= share);
            colours.scales[gap] = Rgb::splat(1.0 - share);
        }
        colours
    }
}
