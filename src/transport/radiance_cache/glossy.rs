//! Choice of the glossy materials whose lobes series light.

use super::settings::CacheSettings;
use crate::eye::{PointSurface, ShadingPoints};
use crate::hsh::{Caching, MaterialSeries};
use scene::MaterialId;
use world::World;

/// Lobes of a scene's materials as series.
pub struct Glossy {
    pub(super) surfaces: MaterialSeries,
}

impl Glossy {
    /// Builds the series of a scene's lobes; returns `None` if no material has a rough lobe.
    pub fn new(world: &World, settings: &CacheSettings) -> Option<Glossy> {
        let materials = 0..world.materials.count() as u32;
        let rough = |id| world.materials.average(MaterialId(id)).split_base(1.0).1.is_some();
        let surfaces = || MaterialSeries::new(&world.materials, &settings.series);
        materials.into_iter().any(rough).then(|| Glossy { surfaces: surfaces() })
    }

    /// Returns the series if there are to be records and any point has a lobe broad enough.
    pub fn for_points(&self, points: &ShadingPoints, settings: &CacheSettings) -> Option<&Glossy> {
        let needed = settings.cached().any()
            && self.surfaces.any_series()
            && points.surfaces.any(|surface| surface.bsdf.split_base(1.0).1.is_some());
        needed.then_some(self)
    }

    /// Returns true for the materials whose lobes neither irradiance nor series can light.
    pub fn too_sharp(&self) -> Vec<bool> {
        self.surfaces.cachings().map(|caching| caching == Caching::PerSample).collect()
    }

    /// Returns the bands of the series that a surface needs; 0 without a lobe or if the lobe is too sharp.
    pub fn bands(&self, surface: &PointSurface) -> u8 {
        match self.surfaces.caching(surface.bsdf.material()) {
            Caching::Series(bands) if surface.bsdf.split_base(1.0).1.is_some() => bands,
            _ => 0,
        }
    }
}
