//! Paths through the pixels of a view that end at the first surfaces which scatter light broadly.

use super::caustic_lookups::CausticLookups;
use super::direct_sampling::{DirectSampling, LightSources};
use super::first_hits::FirstHits;
use super::guides::{FirstSurfaces, Guide};
use super::merge::{MergedPoint, MergedPoints};
use super::{EyeCounts, EyeSettings, FeatureSettings, guide};
use crate::caustics::Caustics;
use crate::irradiance::PathEnds;
use crate::paths::{Batch, Estimand, LightSamples, PathStart, RayCounts, ScatteredEdges, start};
use base::math::{LANES, Rgb, luminance};
use base::progress::Control;
use std::ops::Range;
use world::World;
use world::light::Learned;
use world::view::View;

/// Approximate number of paths traced together: enough to fill packets, few enough for the second-level cache.
pub(super) const BATCH: u32 = 1024;

/// Minimum number of samples of a pixel that are shaded in groups.
const MIN_GROUPED: usize = 4;

/// Share of a pixel's edge that counts as the distance to the next point: that of four eye samples per pixel, for
/// which the footprint sizes of records are tuned.
const SPACING: f32 = 0.5;

/// Buffers of a thread.
pub(super) struct TracerWorkspace<'a, 'w> {
    batch: Batch,
    ends: FirstHits<'a, 'w>,
    merged: Vec<MergedPoint<'w>>,
}

/// Tracer of paths through the pixels of a view.
pub(super) struct Tracer<'a, 'w> {
    pub(super) world: &'w World,
    pub(super) view: &'a View,
    pub(super) settings: EyeSettings,
    pub(super) direct: &'a DirectSampling,
    pub(super) caustics: Option<&'a Caustics>,
    pub(super) learned: Option<&'a Learned>,
    pub(super) path_ends: Option<&'a PathEnds>,
    pub(super) edges: ScatteredEdges,
    pub(super) light_samples: LightSamples,
    pub(super) control: &'a Control,
}

/// Samples of one pixel that were traced together.
pub(super) struct PixelSamples<'b, 'w> {
    /// Index of the pixel in the call.
    pub(super) index: usize,
    pub(super) first: u32,
    /// Sum of the samples' radiances.
    pub(super) sum: Rgb,
    /// Sum over the first half of the samples requested.
    pub(super) half: Rgb,
    /// Number of radiances left out because they were not finite.
    pub(super) nonfinite: u64,
    pub(super) guide: Guide,
    ends: &'b [MergedPoint<'w>],
    /// Path and index in `ends` of the pixel's first hits, in order of path.
    order: &'b [(u32, u32)],
}

impl<'b, 'w> PixelSamples<'b, 'w> {
    pub(super) fn ends(&self) -> impl Iterator<Item = &'b MergedPoint<'w>> {
        let ends = self.ends;
        self.order.iter().map(|(_, number)| &ends[*number as usize])
    }
}

/// Sums over the radiances of some samples of a pixel.
#[derive(Default)]
struct PixelSums {
    all: Rgb,
    /// Sum over the samples before the middle.
    half: Rgb,
    /// Number of radiances left out because they were not finite.
    nonfinite: u64,
}

impl PixelSums {
    /// Sums numbered radiances.
    fn new(radiances: impl Iterator<Item = (u32, Rgb)>, middle: u32) -> PixelSums {
        let mut sums = PixelSums::default();
        for (number, value) in radiances {
            if value.is_finite() {
                sums.all += value;
                sums.half += if number < middle { value } else { Rgb::ZERO };
            } else {
                sums.nonfinite += 1;
            }
        }
        sums
    }
}

/// Light and shading points of the first samples of a tile's pixels.
pub(super) struct SampledTile<'w> {
    /// Pixels of the window.
    pub(super) pixels: Vec<[u32; 2]>,
    /// Sum of the samples' radiances per pixel.
    pub(super) sums: Vec<Rgb>,
    /// Number of samples per pixel.
    pub(super) samples: Vec<u32>,
    /// Denoiser guide per pixel, if guides are requested.
    pub(super) guides: Vec<Guide>,
    pub(super) points: MergedPoints<'w>,
    /// Range of `points` per pixel.
    pub(super) ranges: Vec<Range<usize>>,
    pub(super) chains: EyeCounts,
    pub(super) nonfinite: u64,
}

impl SampledTile<'_> {
    /// Returns the light found so far, by index in the rows of a window of this width.
    pub(super) fn light(&self, width: u32) -> impl Iterator<Item = (usize, Rgb)> {
        let indices = self.pixels.iter().map(move |[x, y]| (y * width + x) as usize);
        let means = self.sums.iter().zip(&self.samples).map(|(sum, samples)| *sum / *samples as f32);
        indices.zip(means)
    }
}

/// Returns the number of pixels that are traced together if each has so many samples.
pub(super) fn traced_together(samples: u32) -> usize {
    (BATCH / samples.max(1)).max(1) as usize
}

impl<'a, 'w> Tracer<'a, 'w> {
    /// Creates a tracer whose scattered edges are guided as a pilot finds best; adds the pilot's rays to `counts`.
    pub(super) fn new(
        world: &'w World,
        view: &'a View,
        settings: EyeSettings,
        sources: LightSources<'a>,
        control: &'a Control,
        counts: &mut RayCounts,
    ) -> Tracer<'a, 'w> {
        let LightSources { direct, caustics, learned, path_ends } = sources;
        let (edges, light_samples) = (ScatteredEdges::default(), LightSamples::ONE);
        let mut tracer = Tracer {
            world,
            view,
            settings,
            direct,
            caustics,
            learned,
            path_ends,
            edges,
            light_samples,
            control,
        };
        let all = || tracer.workspace().ends;
        tracer.edges = guide::edges(world, view, settings, all, caustics, counts);
        tracer
    }

    pub(super) fn workspace(&self) -> TracerWorkspace<'_, 'w> {
        let spacing_by_distance = SPACING * self.view.pixel_angle();
        let Tracer { direct, caustics, learned, path_ends, edges, light_samples, .. } = *self;
        let max_depth = if self.world.has_sheets() { self.settings.max_depth } else { u32::MAX };
        let ends = FirstHits {
            direct,
            learned,
            path_ends,
            caustics,
            lookups: CausticLookups::default(),
            spacing_by_distance,
            max_depth,
            in_groups: false,
            edges,
            light_samples,
            found: Vec::new(),
            order: Vec::new(),
            first_surfaces: None,
        };
        TracerWorkspace { batch: Batch::default(), ends, merged: Vec::new() }
    }

    /// Returns buffers for samples that compute guides, if guides are requested.
    pub(super) fn workspace_with_guides(&self) -> TracerWorkspace<'_, 'w> {
        let mut workspace = self.workspace();
        workspace.ends.first_surfaces = self.finds_guides().then(FirstSurfaces::default);
        workspace
    }

    /// Returns true if the samples compute guides. Paths limited to one edge know nothing of surfaces.
    pub(super) fn finds_guides(&self) -> bool {
        self.direct.guides && self.settings.spp > 1 && self.settings.max_depth > 1
    }

    /// Traces samples of film pixels and calls `each` for every pixel in order. If the samples of a pixel exceed a
    /// batch, `each` is called for every part.
    pub(super) fn sample(
        &self,
        pixels: &[[u32; 2]],
        samples: Range<u32>,
        seed: u32,
        work: &mut TracerWorkspace<'_, 'w>,
        mut each: impl FnMut(PixelSamples<'_, 'w>, &mut Vec<MergedPoint<'w>>),
    ) -> EyeCounts {
        let TracerWorkspace { batch, ends, merged } = work;
        let mut chains = EyeCounts::default();
        let middle = samples.start + samples.len() as u32 / 2;
        let together = traced_together(samples.len() as u32);
        for (chunk, pixels) in pixels.chunks(together).enumerate() {
            for first in samples.clone().step_by(BATCH as usize) {
                let part = first..first.saturating_add(BATCH).min(samples.end);
                let n = part.len();
                ends.in_groups = n >= MIN_GROUPED;
                self.start(batch, pixels, part.clone(), seed);
                ends.lookups = CausticLookups::new(n as u32);
                ends.found.clear();
                ends.order.clear();
                if let Some(first_surfaces) = &mut ends.first_surfaces {
                    first_surfaces.begin(pixels.len(), part.clone());
                }
                let mut counts = RayCounts::default();
                let mut radiance = batch.trace(self.world, self.settings.max_depth, ends, &mut counts);
                chains.rays += counts.rays;
                chains.shadow_rays += counts.shadow_rays;
                chains.by_photons += ends.lookups.found;
                chains.square_by_photons += ends.lookups.square;
                ends.order.sort_unstable();
                if let Some(first_surfaces) = &mut ends.first_surfaces {
                    let settings =
                        FeatureSettings { estimand: Estimand::Pixels, spp: self.settings.spp, seed };
                    first_surfaces.finish(self.world, self.view, settings, pixels);
                }
                let (found, mut rest) = (&ends.found[..], &ends.order[..]);
                for i in 0..pixels.len() {
                    let sums = PixelSums::new(part.clone().zip(radiance.by_ref().take(n)), middle);
                    chains.light += f64::from(luminance(sums.all));
                    let own;
                    (own, rest) =
                        rest.split_at(rest.partition_point(|(path, _)| *path < ((i + 1) * n) as u32));
                    let index = chunk * together + i;
                    let guide = ends.first_surfaces.as_ref().map_or_else(Guide::default, |first| first.at(i));
                    let PixelSums { all: sum, half, nonfinite } = sums;
                    each(
                        PixelSamples { index, first, sum, half, nonfinite, guide, ends: found, order: own },
                        merged,
                    );
                }
            }
        }
        chains
    }

    /// Starts one path for each of some samples of pixels.
    fn start(&self, batch: &mut Batch, pixels: &[[u32; 2]], samples: Range<u32>, seed: u32) {
        let spp = self.settings.spp;
        let estimand = if spp > 1 { Estimand::Pixels } else { Estimand::EyeSamples { spp: 1, seed } };
        let n = samples.len();
        let mut paths = pixels
            .iter()
            .flat_map(|pixel| samples.clone().map(move |sample| PathStart::new(*pixel, sample, seed)));
        let add = |batch: &mut Batch, paths: &mut dyn Iterator<Item = PathStart>| {
            start(batch, paths, self.world, self.view, estimand, spp);
        };
        match n.is_multiple_of(LANES) || LANES.is_multiple_of(n) {
            true => add(batch, &mut paths),
            // A pixel's samples share packets in one way, whatever pixels are traced with it.
            false => (0..pixels.len()).for_each(|_| add(batch, &mut paths.by_ref().take(n))),
        }
    }
}
