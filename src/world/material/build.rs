//! Building of a material: its model, and the way its colours are looked up.

use super::base::CoatInterface;
use super::colours::ColourSource;
use super::layers::Layers;
use super::lobe::{DIFFUSE_ALPHA, LobeModel, MAX_LOBES};
use super::model::{Bsdf, Colours, LobeKinds, Model};
use super::roughness::{LevelPair, RoughnessLevels, RoughnessValues, TextureMeans};
use super::straight::Straight;
use super::tables::Tables;
use base::math::Rgb;
use scene::{Fresnel, Material, MaterialId, Scene, Share, TextureId};

/// Material of the scene, prepared to be looked up at points.
#[derive(Clone, Debug)]
pub(super) struct MaterialEntry {
    /// Model and colours; if the roughness is textured, those of its mean.
    pub coloured: ColouredModel,
    /// Colours with every texture replaced by its mean.
    pub average: Colours<Rgb>,
    /// Models by level of the roughness, if the roughness is textured.
    pub levels: Option<ModelLevels>,
    /// Lobes that light passes straight, if there are any and nothing is textured.
    pub straight: Option<Straight>,
    /// True if no model scatters light by mirrors, glass or gaps.
    pub only_densities: bool,
    /// Minimum roughness α of the rough lobes of all models; 1 without one.
    pub min_alpha: f32,
    /// Share of the surface that is there, if gaps are all that light passes straight and something is textured.
    pub opacity: Option<Share>,
    /// Texture that a lookup reads first, if any.
    pub first_texture: Option<TextureId>,
    /// Textures that may be averaged, because the reflected light is linear in their texels; none if roughness, relief
    /// or opacity are textured, too, or a texture is a product of an image and an attribute.
    pub filtered: Vec<TextureId>,
}

/// Model and the source of its colours.
#[derive(Clone, Debug)]
pub(super) struct ColouredModel {
    pub model: Model,
    pub colours: Colouring,
}

/// Source of the colours of a model.
#[derive(Clone, Debug)]
pub(super) enum Colouring {
    /// Nothing is textured.
    Constant(Colours<Rgb>),
    /// Colours, roughness or opacity are textured.
    Textured(ColourSource),
}

/// Models of a material by level of its roughness.
#[derive(Clone, Debug)]
pub(super) struct ModelLevels {
    pub levels: RoughnessLevels,
    pub models: Vec<ColouredModel>,
}

impl ColouredModel {
    /// Returns the material at a point; `texel` returns the value of a texture there.
    #[inline]
    pub fn bsdf(&self, texel: &dyn Fn(TextureId) -> Rgb) -> Bsdf<'_> {
        match &self.colours {
            Colouring::Constant(colours) => self.model.with_colours(colours),
            Colouring::Textured(source) => self.model.with_colours(&source.colours(&self.model.base, texel)),
        }
    }
}

/// Builder of the materials of a scene.
pub(super) struct Builder<'a> {
    scene: &'a Scene,
    means: TextureMeans,
    tables: Tables,
    /// Every distinct coat; the first stands for none.
    pub coats: Vec<CoatInterface>,
    /// Every distinct list of lobes, and whether it is on a relief with shadows.
    lobe_lists: Vec<(Vec<LobeModel>, bool)>,
}

impl<'a> Builder<'a> {
    /// Prepares to build materials of `scene`.
    pub fn new(scene: &'a Scene) -> Builder<'a> {
        Builder {
            scene,
            means: TextureMeans::new(scene),
            tables: Tables::default(),
            coats: vec![CoatInterface::None],
            lobe_lists: Vec::new(),
        }
    }

    /// Builds a material.
    pub fn entry(&mut self, material: &Material, id: MaterialId) -> MaterialEntry {
        let levels = RoughnessLevels::new(material, self.scene);
        let (mut model, source) = self.model(material, id, None);
        model.mean_roughness = levels.is_some();
        let mean = |id: TextureId| self.means.mean(id);
        let average = source.colours(&model.base, &mean);
        let textures = source.textures(&model.base);
        let is_textured = levels.is_some() || source.is_textured();
        let straight = Straight::new(&model.lobes, &average.scales).filter(|_| !is_textured);
        let passes_gaps_alone =
            model.lobes.iter().all(|lobe| matches!(lobe, LobeModel::Gap) || !lobe.passes_straight());
        let opacity = source.opacity.filter(|_| is_textured && passes_gaps_alone).map(|(share, _)| share);
        let is_product = |id: &TextureId| {
            self.scene.textures.attribute(*id).is_some_and(|texture| texture.image.is_some())
        };
        let is_linear = source.layers.is_linear(&model.base)
            && has_one_textured_factor(material)
            && !textures.iter().any(is_product);
        let first_texture = match &levels {
            Some(levels) => Some(levels.first_texture()),
            None => textures.first().copied(),
        };
        let colours = match is_textured {
            true => Colouring::Textured(source),
            false => Colouring::Constant(average),
        };
        let levels = levels.map(|levels| self.levels(material, id, levels));
        let models = || {
            let of_levels = levels.iter().flat_map(|levels| &levels.models);
            of_levels.map(|level| &level.model).chain([&model])
        };
        let only_densities = models().all(|model| !model.kinds.delta && !model.kinds.pass_light);
        let min_alpha = models().map(|model| model.min_alpha).fold(1.0, f32::min);
        MaterialEntry {
            coloured: ColouredModel { model, colours },
            average,
            levels,
            only_densities,
            min_alpha,
            straight,
            opacity,
            first_texture,
            filtered: if is_linear { textures } else { Vec::new() },
        }
    }

    /// Builds the models of a material by level of its roughness.
    fn levels(&mut self, material: &Material, id: MaterialId, levels: RoughnessLevels) -> ModelLevels {
        let coloured = |level| {
            let (model, source) = self.model(material, id, Some(level));
            let colours = match source.is_textured() {
                true => Colouring::Textured(source),
                false => Colouring::Constant(source.colours(&model.base, &|_| Rgb::ONE)),
            };
            ColouredModel { model, colours }
        };
        let models: Vec<ColouredModel> = levels.all().map(coloured).collect();
        ModelLevels { levels, models }
    }

    /// Builds the model of a material and the source of its colours, for a level of its roughness or for the mean.
    fn model(
        &mut self,
        material: &Material,
        id: MaterialId,
        levels: Option<LevelPair>,
    ) -> (Model, ColourSource) {
        let most = MAX_LOBES - usize::from(material.opacity.is_some());
        let roughness = RoughnessValues { means: &self.means, levels: levels.as_ref() };
        let Layers { colours, base, black, coated, mut lobes } =
            Layers::new(material, roughness, most, &mut self.tables);
        let bare = !black && !coated;
        let needs_albedo = bare || lobes.len() > 1 || material.parts().any(|part| part.principled.is_some());
        self.tabulate(&mut lobes, needs_albedo, levels.is_some());
        let opacity = material.opacity.map(|opacity| (opacity, lobes.len()));
        lobes.extend(opacity.map(|_| LobeModel::Gap));
        let shadows = material.relief.is_some() && material.relief_rules.shadows;
        let model = Model {
            material: id,
            two_sided: material.two_sided,
            shadows,
            coat: number(&mut self.coats, &base.interface),
            base,
            lobe_list: number(&mut self.lobe_lists, &(lobes.clone(), shadows)),
            kinds: LobeKinds::new(&lobes),
            lambert: bare && lobes.is_empty() && !shadows,
            min_alpha: lobes.iter().map(LobeModel::min_alpha).fold(1.0, f32::min),
            lobes,
            mean_roughness: false,
        };
        (model, ColourSource { layers: colours, opacity })
    }

    /// Adds the tables of albedo to rough lobes: to all if `needed`, else to those that count as diffuse. `is_level` is
    /// true if the lobes are those of a level of a textured roughness.
    fn tabulate(&mut self, lobes: &mut [LobeModel], needed: bool, is_level: bool) {
        for lobe in lobes {
            if let LobeModel::Anisotropic(rough) = lobe {
                rough.albedo = self.tables.anisotropic_albedo(rough, is_level);
            }
            let LobeModel::Rough(rough) = lobe else { continue };
            if needed || rough.facets.alpha >= DIFFUSE_ALPHA {
                rough.albedo = Some(self.tables.albedo(rough.facets, rough.fresnel));
            }
            if rough.may_radiate() {
                rough.white = Some(self.tables.albedo(rough.facets, Fresnel::One));
            }
        }
    }
}

/// Returns true if no factor of a material but its colours is textured, so that averages of texels are exact.
fn has_one_textured_factor(material: &Material) -> bool {
    material.opacity.is_none_or(|opacity| !opacity.is_textured())
        && material.relief.is_none()
        && material.parts().all(|part| !part.has_textured_roughness())
}

/// Returns the index of `item` in `items`, and adds it if it is not among them.
fn number<T: PartialEq + Clone>(items: &mut Vec<T>, item: &T) -> u32 {
    let index = items.iter().position(|other| other == item).unwrap_or_else(|| {
        items.push(item.clone());
        items.len() - 1
    });
    index as u32
}
