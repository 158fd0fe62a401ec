//! Light that reaches the surfaces seen through glass, over mirrors and over lobes too sharp to pass for diffuse, as a
//! layer of its own, for pictures whose other light is that of virtual lights: these shine along straight segments, and
//! diffusely.
//!
//! Deviations: it is found by paths, and leaves noise where all else in the picture is smooth.

use super::caustic_looks::CausticLooks;
use super::pass::TILE;
use super::{ChainCounts, EyeSettings};
use crate::caustics::Caustics;
use crate::paths::{Batch, ChainEnd, Counts, Look, Reach, ScatteredEdges, Start, start};
use base::film::Image;
use base::math::{Rgb, luminance};
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::stats::Ways;
use rayon::prelude::*;
use world::World;
use world::view::View;

/// Paths from each eye sample.
const PATHS: u32 = 4;

/// Greatest share of scattered edges that are drawn towards mirrors and glass.
pub(super) const MAX_GUIDED: f32 = 0.5;

/// Of the light that surfaces seen reflect, that which comes to them by specular lobes.
pub(super) struct BySpecularLobes<'a> {
    /// True if that counts which comes by lobes too sharp to pass for diffuse, too.
    pub glossy: bool,
    /// Photons that find part of it.
    pub caustics: Option<&'a Caustics>,
    /// Paths that look for the photons.
    pub looks: CausticLooks,
}

impl<'w> Reach<'w> for BySpecularLobes<'_> {
    const ENDS: bool = true;
    const ONLY_BY_SPECULAR_LOBES: bool = true;

    fn edges(&self) -> ScatteredEdges {
        ScatteredEdges { guided: MAX_GUIDED, ..Default::default() }
    }

    fn goes_on_by_glossy_lobes(&self) -> bool {
        self.glossy
    }

    fn reflected(&mut self, end: &ChainEnd<'w>) -> Rgb {
        self.caustics.map_or(Rgb::ZERO, |caustics| self.looks.reflected(caustics, end))
    }

    fn share_of_paths(&self, radiance: Rgb, distance: f32) -> f32 {
        self.caustics.map_or(1.0, |caustics| caustics.share_of_paths(radiance, distance))
    }
}

/// Light in the pixels of a window that comes to the surfaces seen by mirrors and glass.
pub struct LightBySpecularLobes {
    /// The light; `None` if nothing in the scene bends light.
    pub image: Option<Image>,
    /// Rays traced.
    pub chains: ChainCounts,
    /// Radiances that were not finite and left out.
    pub nonfinite: u64,
}

impl LightBySpecularLobes {
    /// Finds it by paths from the eye samples of `settings`; not in all tiles if cancelled.
    pub fn new(
        world: &World,
        view: &View,
        settings: EyeSettings,
        caustics: Option<&Caustics>,
        control: &Control,
    ) -> LightBySpecularLobes {
        let mut light = LightBySpecularLobes { image: None, chains: ChainCounts::default(), nonfinite: 0 };
        if !world.specular.bends_light() {
            return light;
        }
        let window = &view.window;
        let EyeSettings { spp, seed, max_depth } = settings;
        let (look, samples) = (Look::EyeSamples { spp, seed }, spp.max(1).saturating_mul(PATHS));
        let trace = |batch: &mut Batch, index| {
            let mut found: Vec<(usize, Rgb)> = Vec::new();
            let (mut counts, mut nonfinite) = (Counts::default(), 0);
            let (mut light, mut by_photons) = (0.0, 0.0);
            for [x, y] in window.tile(index, TILE) {
                if control.is_cancelled() {
                    break;
                }
                let pixel = window.film_pixel([x, y]);
                let paths = (0..samples).map(|sample| Start { pixel, sample, seed });
                start(batch, paths, (world, view), (look, spp));
                let (mut sum, mut finite) = (Rgb::ZERO, 0);
                let looks = CausticLooks::new(samples);
                let mut reach = BySpecularLobes { glossy: true, caustics, looks };
                for radiance in batch.trace(world, max_depth, &mut reach, &mut counts) {
                    if radiance.is_finite() {
                        sum += radiance;
                        finite += 1;
                    }
                }
                light += f64::from(luminance(sum));
                by_photons += reach.looks.found;
                nonfinite += u64::from(samples - finite);
                found.push(((y * window.width + x) as usize, sum / samples as f32));
            }
            let chains = ChainCounts {
                rays: counts.rays,
                shadow_rays: counts.shadow_rays,
                light,
                by_photons,
                ..ChainCounts::default()
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

    /// Adds the light to a picture of the window, and to the ways that its light came.
    pub fn add_to(&self, picture: &mut Image, ways: &mut Ways) {
        let found = self.image.as_ref().map_or(0.0, Image::luminance);
        let by_photons = self.chains.by_photons(found);
        ways.add(Ways::PHOTONS, by_photons);
        ways.add("paths through glass or by mirrors", found - by_photons);
        for (pixel, light) in picture.pixels.iter_mut().zip(self.image.iter().flat_map(|image| &image.pixels))
        {
            *pixel += *light;
        }
    }
}
