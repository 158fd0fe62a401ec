//! Single eye rays: their random numbers, positions in pixels, and the surfaces that they make visible.

use super::chain::{ChainTracer, ChainVertex, EdgeEnd, Follow};
use super::counts::EyeCounts;
use super::guides::PackedGuide;
use super::points::{ShadingPoints, VisibilitySample, shading_point};
use crate::paths::eye_sampler;
use base::math::{Cone, Rgb};
use world::World;
use world::view::View;

/// Pixels along the edge of the square whose eye rays one task traces.
pub const TILE: u32 = 16;

/// Settings of eye rays.
#[derive(Clone, Copy, Debug)]
pub struct EyeSettings {
    /// Number of eye rays per pixel.
    pub spp: u32,
    /// Random seed.
    pub seed: u32,
    /// Maximum path length in edges, including the edge to the light.
    pub max_depth: u32,
}

/// Eye rays of a frame.
#[derive(Clone, Copy)]
pub struct EyeRays<'a, 'w> {
    world: &'w World,
    view: &'a View,
    settings: EyeSettings,
    /// Angle between neighbouring rays at the film's centre, in radians.
    angle: f32,
    cone: Cone,
}

/// Surfaces made visible by eye rays, in the order of the rays, each with one visibility sample. Weights and light are
/// per ray, not per pixel.
#[derive(Default)]
pub struct VisibleSurfaces<'w> {
    /// Surfaces.
    pub points: ShadingPoints<'w>,
    /// Visibility sample of each surface.
    pub visibility: Vec<VisibilitySample>,
    /// Nonzero known light by pixel (see [`super::EyePass::known`]).
    pub known: Vec<(u32, Rgb)>,
    /// Denoiser guides by pixel, if requested.
    pub guides: Vec<(u32, PackedGuide)>,
    /// Rays traced.
    pub chains: EyeCounts,
    /// Number of radiances left out because they were not finite.
    pub nonfinite: u64,
}

impl VisibleSurfaces<'_> {
    /// Gives memory of surfaces back that is not needed.
    pub fn shrink_to_fit(&mut self) {
        self.points.geometry.shrink_to_fit();
        self.points.surfaces.shrink_to_fit();
        self.visibility.shrink_to_fit();
    }

    /// Clears surfaces and light, and keeps the memory.
    pub fn clear(&mut self) {
        self.points.geometry.clear();
        self.points.surfaces.clear();
        self.visibility.clear();
        self.known.clear();
    }
}

impl<'a, 'w> EyeRays<'a, 'w> {
    /// Returns the rays of the camera of `view` into `world`.
    pub fn new(world: &'w World, view: &'a View, settings: EyeSettings) -> EyeRays<'a, 'w> {
        let settings = EyeSettings { spp: settings.spp.max(1), ..settings };
        // Angle between neighbouring samples at the film's centre.
        let angle = view.pixel_angle() / (settings.spp as f32).sqrt();
        EyeRays { world, view, settings, angle, cone: view.cone(settings.spp) }
    }

    /// Traces eye ray `sample` of the film pixel `film_pixel`. Appends what it makes visible to `found`, with the
    /// pixel index `pixel`.
    pub fn trace(&self, film_pixel: [u32; 2], sample: u32, pixel: u32, found: &mut VisibleSurfaces<'w>) {
        let EyeSettings { spp, seed, max_depth } = self.settings;
        let (mut sampler, jitter) = eye_sampler(film_pixel, seed, sample, spp);
        let ray = self.world.behind_hidden(self.view.sample_ray(film_pixel, jitter, seed, sample));
        let VisibleSurfaces { points, visibility, chains: counts, .. } = found;
        let visit = |met: EdgeEnd<'w>| {
            let EdgeEnd::Surface(vertex) = met else { return };
            let ChainVertex { surface, bsdf, out, depth, distance, .. } = vertex;
            let edges = if self.world.has_sheets() { max_depth.saturating_sub(depth) } else { u32::MAX };
            if bsdf.has_smooth()
                && depth < max_depth
                && let Some((geometry, surface)) =
                    shading_point(&surface, bsdf, out, self.angle * distance, edges)
            {
                points.geometry.push(geometry);
                points.surfaces.push(&surface);
                visibility.push(VisibilitySample { pixel, weight: vertex.throughput });
            }
        };
        let tracer =
            ChainTracer { world: self.world, cone: self.cone, max_depth, follow: Follow::DeltaAndSharp };
        let emitted = tracer.trace(ray, &mut sampler, counts, visit);
        if !emitted.is_finite() {
            found.nonfinite += 1;
        } else if emitted != Rgb::ZERO {
            found.known.push((pixel, emitted));
        }
    }
}
