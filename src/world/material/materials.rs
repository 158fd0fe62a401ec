//! Materials of a scene, looked up at points. Values that do not depend on the point are computed once per scene.

use super::base::CoatInterface;
use super::build::{Builder, Colouring, MaterialEntry};
use super::model::{Bsdf, Model};
use super::straight::LastStraight;
use base::math::{Rgb, luminance};
use glam::Vec2;
use scene::texture::MipMaps;
use scene::{AttributeId, MaterialId, Scene, Texture, TextureId};

/// Materials of a scene, with the textures that they look up.
#[derive(Clone, Debug)]
pub struct Materials {
    /// Materials by their id.
    entries: Vec<MaterialEntry>,
    /// Every distinct coat; the first stands for none.
    coats: Vec<CoatInterface>,
    textures: MipMaps,
}

impl Materials {
    /// Prepares every material of the scene.
    pub fn new(scene: &Scene) -> Materials {
        let mut builder = Builder::new(scene);
        let ids = (0..).map(MaterialId);
        let entries: Vec<MaterialEntry> =
            scene.materials.iter().zip(ids).map(|(material, id)| builder.entry(material, id)).collect();
        let filtered = entries.iter().flat_map(|entry| &entry.filtered).copied();
        let textures = MipMaps::new(&scene.textures, filtered);
        Materials { coats: builder.coats, textures, entries }
    }

    /// Returns true if some textures are averaged over the area that a ray stands for.
    #[inline]
    pub fn filter_textures(&self) -> bool {
        self.textures.filter()
    }

    /// Returns the number of materials.
    pub fn count(&self) -> usize {
        self.entries.len()
    }

    /// Returns the share of the light at the cosine `cos` > 0 that passes the coat of the given number (see
    /// [`Bsdf::coat`]).
    #[inline]
    pub fn coat_transmittance(&self, coat: u32, cos: f32) -> f32 {
        self.coats.get(coat as usize).map_or(1.0, |coat| coat.transmittance(cos))
    }

    /// Returns true if a material scatters light by densities alone: by no mirrors, no glass and no gaps.
    #[inline]
    pub fn has_only_densities(&self, id: MaterialId) -> bool {
        let by_densities = |model: &Model| !model.kinds.delta && !model.kinds.pass_light;
        let entry = &self.entries[id.0 as usize];
        by_densities(&entry.coloured.model)
            && entry.levels.iter().flat_map(|levels| &levels.models).all(|level| by_densities(&level.model))
    }

    /// Returns the minimum roughness α of the rough lobes of a material; 1 without one.
    #[inline]
    pub fn min_alpha(&self, id: MaterialId) -> f32 {
        let entry = &self.entries[id.0 as usize];
        let levels = entry.levels.iter().flat_map(|levels| &levels.models);
        levels.map(|level| level.model.min_alpha).fold(entry.coloured.model.min_alpha, f32::min)
    }

    /// Returns a material that is the same everywhere; `None` if something of it is textured.
    #[inline]
    pub fn constant(&self, id: MaterialId) -> Option<Bsdf<'_>> {
        let coloured = &self.entries[id.0 as usize].coloured;
        match &coloured.colours {
            Colouring::Constant(colours) => Some(coloured.model.with_colours(colours)),
            Colouring::Textured(_) => None,
        }
    }

    /// Returns the material at texture coordinates `uv`, with white attributes.
    #[inline]
    pub fn at(&self, id: MaterialId, uv: Vec2) -> Bsdf<'_> {
        self.at_coordinates(id, || uv, || 0.0, |_| Rgb::ONE)
    }

    /// Returns the material at the texture coordinates that `uv` returns, which is called only if something is
    /// textured. Textures are averaged over a square around them, of the side that `covered` returns, if the mean of
    /// the reflected light stays the same. `attribute` returns the value of an attribute.
    #[inline]
    pub fn at_coordinates(
        &self,
        id: MaterialId,
        uv: impl FnOnce() -> Vec2,
        covered: impl FnOnce() -> f32,
        attribute: impl Fn(AttributeId) -> Rgb,
    ) -> Bsdf<'_> {
        let entry = &self.entries[id.0 as usize];
        match &entry.coloured.colours {
            Colouring::Constant(colours) => entry.coloured.model.with_colours(colours),
            Colouring::Textured(_) => {
                let covered = if entry.filtered.is_empty() { 0.0 } else { covered() };
                self.textured(entry, uv(), covered, attribute)
            }
        }
    }

    /// Returns true if the mean of a material over places is the material of the mean texels.
    #[inline]
    pub fn averages_texels(&self, id: MaterialId) -> bool {
        !self.entries[id.0 as usize].filtered.is_empty()
    }

    /// Returns the material of the mean texels over places. Each is given by texture coordinates and the side of the
    /// square that it covers. `attribute` returns the value of an attribute at the place of an index.
    #[inline]
    pub fn mean(
        &self,
        id: MaterialId,
        places: &[(Vec2, f32)],
        attribute: impl Fn(usize, AttributeId) -> Rgb,
    ) -> Bsdf<'_> {
        let texel = |id: TextureId| {
            let at = |(i, (uv, covered)): (usize, &(Vec2, f32))| {
                self.textures.lookup(id, *uv, *covered, |found| attribute(i, found))
            };
            let sum: Rgb = places.iter().enumerate().map(at).sum();
            sum / places.len() as f32
        };
        self.entries[id.0 as usize].coloured.bsdf(&texel)
    }

    fn textured<'m>(
        &'m self,
        entry: &'m MaterialEntry,
        uv: Vec2,
        covered: f32,
        attribute: impl Fn(AttributeId) -> Rgb,
    ) -> Bsdf<'m> {
        let texel = |id: TextureId| self.textures.lookup(id, uv, covered, &attribute);
        let coloured = match &entry.levels {
            Some(levels) => &levels.models[levels.levels.index(luminance(texel(levels.levels.texture)))],
            None => &entry.coloured,
        };
        coloured.bsdf(&texel)
    }

    /// Returns the texture of the material that a lookup reads first; `None` if it has none.
    #[inline]
    pub fn texture(&self, id: MaterialId) -> Option<&Texture> {
        self.textures.textures().by_id(self.entries[id.0 as usize].first_texture?)
    }

    /// Returns the share of the light that passes straight through a surface.
    ///
    /// `cos` returns the cosine to the shading normal, of either sign, and is called only if the share depends on it.
    /// `uv` returns texture coordinates, and `attribute` the value of an attribute. `last` remembers the surface
    /// before.
    #[inline]
    pub fn straight_transmittance(
        &self,
        id: MaterialId,
        cos: impl FnOnce() -> f32,
        uv: impl FnOnce() -> Vec2,
        attribute: impl Fn(AttributeId) -> Rgb,
        last: &mut Option<LastStraight>,
    ) -> Rgb {
        let entry = &self.entries[id.0 as usize];
        if let Some(straight) = &entry.straight {
            return straight.transmittance_after(id, cos(), last);
        }
        match &entry.opacity {
            Some(opacity) => {
                let uv = uv();
                Rgb::splat(1.0 - opacity.share(|id| self.textures.textures().lookup(id, uv, &attribute)))
            }
            None => self.at_coordinates(id, uv, || 0.0, attribute).straight_transmittance(cos()),
        }
    }

    /// Returns all materials in order, each with every texture replaced by its mean.
    pub fn averages(&self) -> impl Iterator<Item = Bsdf<'_>> {
        (0..self.entries.len() as u32).map(|id| self.average(MaterialId(id)))
    }

    /// Returns the material with every texture replaced by its mean.
    pub fn average(&self, id: MaterialId) -> Bsdf<'_> {
        let entry = &self.entries[id.0 as usize];
        entry.coloured.model.with_colours(&entry.average)
    }
}
