//! Eye rays one by one: their random numbers, their places in pixels, and the surfaces that they make visible.

use super::chain::{ChainCounts, Follow, Met, trace};
use super::guides::KeptGuide;
use super::points::{ShadingPoints, VisibilitySample, shading_point};
use crate::paths::eye_sampler;
use base::math::{Cone, Rgb};
use world::World;
use world::view::View;

/// Settings of eye rays.
#[derive(Clone, Copy, Debug)]
pub struct EyeSettings {
    /// Eye rays a pixel.
    pub spp: u32,
    /// Another seed, other rays.
    pub seed: u32,
    /// Longest path in edges, the one to the light included.
    pub max_depth: u32,
}

/// The eye rays of a frame.
#[derive(Clone, Copy)]
pub struct EyeRays<'a, 'w> {
    world: &'w World,
    view: &'a View,
    settings: EyeSettings,
    /// Angle between neighbouring rays at the film's centre, in radians.
    angle: f32,
    cone: Cone,
}

/// Surfaces that eye rays have made visible, in the order of the rays, each with one visibility sample. Weights and
/// light are those of a ray, not of a pixel.
#[derive(Default)]
pub struct VisibleSurfaces<'w> {
    /// The surfaces.
    pub points: ShadingPoints<'w>,
    /// Visibility sample of each of them.
    pub visibility: Vec<VisibilitySample>,
    /// By pixel: light, other than 0, that is known (see [`super::EyePass::known`]).
    pub known: Vec<(u32, Rgb)>,
    /// By pixel: what a denoiser is to know of it, if that is wanted.
    pub guides: Vec<(u32, KeptGuide)>,
    /// Rays traced.
    pub chains: ChainCounts,
    /// Radiances that were not finite and left out.
    pub nonfinite: u64,
}

impl VisibleSurfaces<'_> {
    /// Forgets surfaces and light, and keeps the memory.
    pub fn clear(&mut self) {
        self.points.geometry.clear();
        self.points.surfaces.clear();
        self.visibility.clear();
        self.known.clear();
    }
}

impl<'a, 'w> EyeRays<'a, 'w> {
    /// Rays of the camera of `view` into `world`.
    pub fn new(world: &'w World, view: &'a View, settings: EyeSettings) -> EyeRays<'a, 'w> {
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        // Angle between neighbouring samples, at the film's centre.
        let angle = view.pixel_angle() / (settings.spp as f32).sqrt();
        EyeRays { world, view, settings, angle, cone: view.cone(settings.spp) }
    }

    /// Follows eye ray `sample` of the film's pixel `film_pixel` and appends what it makes visible to `found`, where
    /// the pixel has the number `pixel`.
    pub fn trace(&self, film_pixel: [u32; 2], sample: u32, pixel: u32, found: &mut VisibleSurfaces<'w>) {
        let EyeSettings { spp, seed, max_depth } = self.settings;
        let (mut sampler, jitter) = eye_sampler(film_pixel, seed, sample, spp);
        let ray = self.world.behind_hidden(self.view.sample_ray(film_pixel, jitter, (seed, sample)));
        let VisibleSurfaces { points, visibility, chains, .. } = found;
        let visit = |met: Met<'w>| {
            if let Met::Surface(vertex) = met
                && vertex.bsdf.has_smooth()
                && vertex.depth < max_depth
                && let Some((geometry, surface)) =
                    shading_point(&vertex.surface, vertex.bsdf, vertex.out, self.angle * vertex.distance)
            {
                points.geometry.push(geometry);
                points.surfaces.push(surface);
                visibility.push(VisibilitySample { pixel, weight: vertex.throughput });
            }
        };
        let emitted = trace(
            self.world,
            ray,
            self.cone,
            (max_depth, Follow::DeltaAndSharp),
            &mut sampler,
            chains,
            visit,
        );
        if !emitted.is_finite() {
            found.nonfinite += 1;
        } else if emitted != Rgb::ZERO {
            found.known.push((pixel, emitted));
        }
    }
}
