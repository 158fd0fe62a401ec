//! First non-specular hits of paths. Direct light is sampled there, indirect light is requested.

use super::DirectSampling;
use super::caustic_lookups::CausticLookups;
use super::guides::FirstSurfaces;
use super::merge::MergedPoint;
use crate::caustics::Caustics;
use crate::irradiance::PathEnds;
use crate::paths::{ChainEnd, LightSamples, PathPolicy, ScatteredEdges};
use base::math::Rgb;
use glam::Vec3;
use world::light::Learned;
use world::material::{Bsdf, LobeSet};

/// First hits of paths, in the order of the paths' edges.
pub(super) struct FirstHits<'a, 'w> {
    pub direct: &'a DirectSampling,
    pub learned: Option<&'a Learned>,
    pub path_ends: Option<&'a PathEnds>,
    pub caustics: Option<&'a Caustics>,
    pub lookups: CausticLookups,
    /// Distance between neighbouring points over the distance from the eye, on surfaces that face it.
    pub spacing_by_distance: f32,
    /// Maximum number of edges of a path; `u32::MAX` if light passes no sheets.
    pub max_depth: u32,
    /// True if first hits are shaded in groups.
    pub in_groups: bool,
    pub edges: ScatteredEdges,
    pub light_samples: LightSamples,
    pub found: Vec<MergedPoint<'w>>,
    /// Path of each hit, and index in `found`.
    pub order: Vec<(u32, u32)>,
    /// First surfaces, if guides are requested.
    pub first_surfaces: Option<FirstSurfaces>,
}

impl<'w> PathPolicy<'w> for FirstHits<'_, 'w> {
    const STOPS_AT_DIFFUSE: bool = true;

    fn followed(&self, bsdf: &Bsdf) -> LobeSet {
        match self.direct.followed.get(bsdf.material().0 as usize) {
            Some(true) => bsdf.rough_lobes(),
            _ => bsdf.sharp_lobes(),
        }
    }

    fn learned(&self) -> Option<&Learned> {
        self.learned
    }

    fn path_ends(&self) -> Option<&PathEnds> {
        self.path_ends
    }

    fn edges(&self) -> ScatteredEdges {
        self.edges
    }

    fn light_samples(&self) -> LightSamples {
        self.light_samples
    }

    fn reflected(&mut self, end: &ChainEnd<'w>) -> Rgb {
        self.caustics.map_or(Rgb::ZERO, |caustics| self.lookups.reflected(caustics, end))
    }

    fn share_of_paths(&self, radiance: Rgb, distance: f32) -> f32 {
        self.caustics.map_or(1.0, |caustics| caustics.share_of_paths(radiance, distance))
    }

    fn group_spacing(&self) -> Option<f32> {
        self.in_groups.then_some(self.spacing_by_distance)
    }

    #[inline]
    fn looks_up(&self, path: u32) -> bool {
        self.caustics.is_some() && self.lookups.looks_up(path)
    }

    fn sees(&self) -> bool {
        self.first_surfaces.is_some()
    }

    #[inline]
    fn see(&mut self, path: u32, albedo: Option<Rgb>, normal: Vec3) {
        if let Some(first) = &mut self.first_surfaces {
            first.see(path, albedo, normal);
        }
    }

    #[inline]
    fn end(&mut self, end: &ChainEnd<'w>) {
        let edges = self.max_depth.saturating_sub(end.depth);
        if let Some(point) = MergedPoint::new(end, self.spacing_by_distance * end.distance, edges) {
            self.order.push((end.path, self.found.len() as u32));
            self.found.push(point);
        }
    }
}
