//! Two probabilities for the edge after the first diffuse hit: of aiming it at specular objects, and of tracing it if
//! it can only reach them.
//!
//! A pilot of paths through the whole film measures the light that reaches visible surfaces by specular lobes, and all
//! light that the eye pass with direct light finds. Light found by photons does not count. Total light is measured as
//! (E√L)², so that visible lamps do not dominate.

use super::EyeSettings;
use super::by_specular_lobes::{BySpecularLobes, MAX_GUIDED};
use super::caustic_lookups::CausticLookups;
use crate::caustics::Caustics;
use crate::paths::{Batch, Estimand, PathPolicy, PathStart, RayCounts, ScatteredEdges, start};
use base::math::{Rgb, luminance};
use base::parallel::ShortRuns;
use rayon::prelude::*;
use world::World;
use world::view::View;

/// Number of paths.
const PATHS: u32 = 8192;

/// Number of paths traced together.
const BATCH: u32 = 256;

/// Seed of the pilot's paths, combined with the image's seed.
const SEED: u32 = 0x51de_c0de;

/// Share of specular light at which half of the maximum share of edges is aimed.
const HALF_MAX_SHARE: f32 = 0.1;

/// Minimum share of specular light for any edge to be aimed.
const MIN_SHARE: f32 = 0.03;

/// Minimum effective sample size for the share to be trusted.
const MIN_PATHS: f64 = 8.0;

/// Share of light by non-diffuse lobes at which all edges that find no emitter are traced. With less light the share
/// of traced edges falls in proportion.
const ALL_BLIND_SHARE: f32 = 0.2;

/// Minimum share of these edges that is traced.
const MIN_BLIND: f32 = 0.1;

/// Estimates both probabilities. Each policy that `all` makes finds the light of the eye pass along paths sampled
/// without guiding.
pub(super) fn edges<'w, R: PathPolicy<'w>>(
    world: &'w World,
    view: &View,
    settings: EyeSettings,
    all: impl Fn() -> R + Sync,
    caustics: Option<&Caustics>,
    counts: &mut RayCounts,
) -> ScatteredEdges {
    let mut edges = ScatteredEdges::default();
    if !world.specular.bends_light() {
        return edges;
    }
    let has_delta_lobes = world.specular.has_delta_lobes();
    let seed = settings.seed ^ SEED;
    // Sums: light by delta lobes, light by delta and glossy lobes, roots of all light, squares of the first.
    let sums_of = |first: u32| {
        let (mut batch, mut counts, mut sums) = (Batch::default(), RayCounts::default(), [0.0; 4]);
        let paths = (first..first + BATCH)
            .map(|sample| PathStart::new(view.window.spread_pixel(sample, seed), sample, seed));
        let finite = |light: Rgb| if light.is_finite() { f64::from(luminance(light)) } else { 0.0 };
        // Without delta lobes there is nothing to aim at.
        let wanted = [(0, false), (1, true)].into_iter().filter(|(_, glossy)| *glossy || has_delta_lobes);
        for (i, glossy) in wanted {
            start(&mut batch, paths.clone(), world, view, Estimand::Pixels, 1);
            let mut policy = BySpecularLobes { glossy, caustics, lookups: CausticLookups::NONE };
            for light in batch.trace(world, settings.max_depth, &mut policy, &mut counts).map(finite) {
                sums[i] += light;
                sums[3] += if glossy { 0.0 } else { light * light };
            }
        }
        start(&mut batch, paths, world, view, Estimand::Pixels, 1);
        let radiances = batch.trace(world, settings.max_depth, &mut all(), &mut counts);
        sums[2] = radiances.map(|light| finite(light).sqrt()).sum::<f64>();
        (sums, counts)
    };
    let batches: Vec<([f64; 4], RayCounts)> =
        (0..PATHS / BATCH).into_par_iter().one_by_one().map(|batch| sums_of(batch * BATCH)).collect();
    let mut sums = [0.0; 4];
    for (of_batch, traced) in batches {
        sums.iter_mut().zip(of_batch).for_each(|(sum, of_batch)| *sum += of_batch);
        counts.rays += traced.rays;
        counts.shadow_rays += traced.shadow_rays;
    }
    let [by_delta, by_all, roots, squares] = sums.map(|sum| sum / f64::from(PATHS));
    let share = |light: f64| (light / (light + roots * roots).max(f64::MIN_POSITIVE)) as f32;
    let guided = share(by_delta);
    let is_chance = f64::from(PATHS) * by_delta * by_delta < MIN_PATHS * squares;
    if has_delta_lobes && guided >= MIN_SHARE && !is_chance {
        edges.guided = MAX_GUIDED * guided / (guided + HALF_MAX_SHARE);
    }
    edges.blind = (share(by_all) / ALL_BLIND_SHARE).clamp(MIN_BLIND, 1.0);
    edges
}
