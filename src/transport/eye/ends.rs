//! Ends of paths, where direct light is drawn and indirect light is wanted.

use super::DrawnLight;
use super::caustic_looks::CausticLooks;
use super::guides::FirstSurfaces;
use super::merge::MergedPoint;
use crate::caustics::Caustics;
use crate::paths::{ChainEnd, LightSamples, Reach, ScatteredEdges};
use base::math::Rgb;
use glam::Vec3;
use world::light::Learned;
use world::material::{Bsdf, LobeSet};

/// The ends of paths, in the order of the paths' edges.
pub(super) struct Ends<'a, 'w> {
    pub drawn: &'a DrawnLight,
    pub learned: Option<&'a Learned>,
    pub caustics: Option<&'a Caustics>,
    pub looks: CausticLooks,
    /// Distance between neighbouring points over that from the eye, on surfaces that face it.
    pub spacing_by_distance: f32,
    pub edges: ScatteredEdges,
    pub light_samples: LightSamples,
    pub found: Vec<MergedPoint<'w>>,
    /// Their paths, and their numbers.
    pub order: Vec<(u32, u32)>,
    /// Where guides are wanted.
    pub first_surfaces: Option<FirstSurfaces>,
}

impl<'w> Reach<'w> for Ends<'_, 'w> {
    const ENDS: bool = true;

    fn followed(&self, bsdf: &Bsdf) -> LobeSet {
        match self.drawn.followed.get(bsdf.material().0 as usize) {
            Some(true) => bsdf.rough_lobes(),
            _ => bsdf.sharp_lobes(),
        }
    }

    fn learned(&self) -> Option<&Learned> {
        self.learned
    }

    fn edges(&self) -> ScatteredEdges {
        self.edges
    }

    fn light_samples(&self) -> LightSamples {
        self.light_samples
    }

    fn reflected(&mut self, end: &ChainEnd<'w>) -> Rgb {
        self.caustics.map_or(Rgb::ZERO, |caustics| self.looks.reflected(caustics, end))
    }

    fn share_of_paths(&self, radiance: Rgb, distance: f32) -> f32 {
        self.caustics.map_or(1.0, |caustics| caustics.share_of_paths(radiance, distance))
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
        if let Some(point) = MergedPoint::new(end, self.spacing_by_distance * end.distance) {
            self.order.push((end.path, self.found.len() as u32));
            self.found.push(point);
        }
    }
}
