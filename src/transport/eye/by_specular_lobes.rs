//! Caustic layer: light that reaches visible surfaces by specular or glossy bounces.
//!
//! Virtual lights cannot carry this light, since they shine diffusely along straight segments. Methods based on
//! virtual lights add the layer to their image.
//!
//! Deviations: the layer is path-traced, and noisy in images that are otherwise smooth.

use super::caustic_lookups::CausticLookups;
use super::rays::TILE;
use super::{EyeCounts, EyeSettings};
use crate::caustics::Caustics;
use crate::paths::{Batch, ChainEnd, Estimand, PathPolicy, PathStart, RayCounts, ScatteredEdges, start};
use base::film::Image;
use base::math::{Rgb, luminance};
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::stats::Contributions;
use rayon::prelude::*;
use world::World;
use world::view::View;

/// Number of paths per eye sample.
const PATHS: u32 = 4;

/// Maximum share of scattered edges that are aimed at mirrors and glass.
pub(super) const MAX_GUIDED: f32 = 0.5;

/// Policy of paths that find the light which reaches visible surfaces by specular lobes.
pub(super) struct BySpecularLobes<'a> {
    /// True if light by glossy lobes, too sharp to count as diffuse, is included.
    pub glossy: bool,
    /// Photons that find part of the light.
    pub caustics: Option<&'a Caustics>,
    /// Choice of the paths that look up photons.
    pub lookups: CausticLookups,
}

impl<'w> PathPolicy<'w> for BySpecularLobes<'_> {
    const STOPS_AT_DIFFUSE: bool = true;
    const ONLY_BY_SPECULAR_LOBES: bool = true;

    fn edges(&self) -> ScatteredEdges {
        ScatteredEdges { guided: MAX_GUIDED, ..Default::default() }
    }

    fn goes_on_by_glossy_lobes(&self) -> bool {
        self.glossy
    }

    fn reflected(&mut self, end: &ChainEnd<'w>) -> Rgb {
        self.caustics.map_or(Rgb::ZERO, |caustics| self.lookups.reflected(caustics, end))
    }

    fn share_of_paths(&self, radiance: Rgb, distance: f32) -> f32 {
        self.caustics.map_or(1.0, |caustics| caustics.share_of_paths(radiance, distance))
    }
}

/// Light in the pixels of a window that reaches the visible surfaces by mirrors and glass.
pub struct LightBySpecularLobes {
    /// Image of the light; `None` if nothing in the scene bends light.
    pub image: Option<Image>,
    /// Rays traced.
    pub chains: EyeCounts,
    /// Number of radiances left out because they were not finite.
    pub nonfinite: u64,
}

impl LightBySpecularLobes {
    /// Finds the light by paths from the eye samples of `settings`; some tiles are missing if cancelled.
    pub fn new(
        world: &World,
        view: &View,
        settings: EyeSettings,
        caustics: Option<&Caustics>,
        control: &Control,
    ) -> LightBySpecularLobes {
        let mut light = LightBySpecularLobes { image: None, chains: EyeCounts::default(), nonfinite: 0 };
        if !world.specular.bends_light() {
            return light;
        }
        let window = &view.window;
        let EyeSettings { spp, seed, max_depth } = settings;
        let (estimand, samples) = (Estimand::EyeSamples { spp, seed }, spp.max(1).saturating_mul(PATHS));
        let trace = |batch: &mut Batch, index| {
            let mut found: Vec<(usize, Rgb)> = Vec::new();
            let (mut counts, mut nonfinite) = (RayCounts::default(), 0);
            let (mut light, mut by_photons) = (0.0, 0.0);
            for [x, y] in window.tile(index, TILE) {
                if control.is_cancelled() {
                    break;
                }
                let pixel = window.film_pixel([x, y]);
                let paths = (0..samples).map(|sample| PathStart::new(pixel, sample, seed));
                start(batch, paths, world, view, estimand, spp);
                let (mut sum, mut finite) = (Rgb::ZERO, 0);
                let lookups = CausticLookups::new(samples);
                let mut policy = BySpecularLobes { glossy: true, caustics, lookups };
                for radiance in batch.trace(world, max_depth, &mut policy, &mut counts) {
                    if radiance.is_finite() {
                        sum += radiance;
                        finite += 1;
                    }
                }
                light += f64::from(luminance(sum));
                by_photons += policy.lookups.found;
                nonfinite += u64::from(samples - finite);
                found.push(((y * window.width + x) as usize, sum / samples as f32));
            }
            let chains = EyeCounts {
                rays: counts.rays,
                shadow_rays: counts.shadow_rays,
                light,
                by_photons,
                ..EyeCounts::default()
            };
            (found, chains, nonfinite)
        };
        let batches = Workspaces::new(Batch::default);
        let tiles = (0..window.tile_count(TILE)).into_par_iter().one_by_one();
        let tiles: Vec<_> = tiles.map(|index| batches.with(|batch| trace(batch, index))).collect();
        let mut image = Image::new(window.width, window.height);
        for (found, chains, nonfinite) in tiles {
            found.into_iter().for_each(|(pixel, radiance)| image.pixels[pixel] = radiance);
            light.chains += chains;
            light.nonfinite += nonfinite;
        }
        light.image = Some(image);
        light
    }

    /// Adds the light to an image of the window, and to its contributions by technique.
    pub fn add_to(&self, picture: &mut Image, contributions: &mut Contributions) {
        let luminance = self.image.as_ref().map_or(0.0, Image::luminance);
        let by_photons = self.chains.by_photons(luminance);
        contributions.add(Contributions::PHOTONS, by_photons);
        contributions.add("paths through glass or by mirrors", luminance - by_photons);
        for (pixel, light) in picture.pixels.iter_mut().zip(self.image.iter().flat_map(|image| &image.pixels))
        {
            *pixel += *light;
        }
    }
}
