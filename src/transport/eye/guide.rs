//! Share of the scattered edges that are drawn towards mirrors and glass, where enough of the light comes from there,
//! and share that is followed of those that look for nothing but light sent on by polished surfaces.
//!
//! Some paths through the whole film tell how much light comes to surfaces seen by specular lobes, beside all that the
//! eye pass with direct light finds; light that photons find does not count. Of all the light the square of the mean
//! root counts, so that lamps and windows in view count little.
//!
//! Measured in rooms that are lit through panes and by bulbs: 1 to 2 dB of denoised pictures for the same time. Where
//! little light comes that way nothing is drawn so, and pictures are the same.

use super::EyeSettings;
use super::by_specular_lobes::{BySpecularLobes, MAX_GUIDED};
use super::caustic_looks::CausticLooks;
use crate::caustics::Caustics;
use crate::paths::{Batch, Counts, Look, Reach, ScatteredEdges, Start, start};
use base::math::{Rgb, luminance};
use base::parallel::ShortRuns;
use base::sampling::owen_sobol_2d;
use rayon::prelude::*;
use world::World;
use world::view::View;

/// Number of paths.
const PATHS: u32 = 8192;

/// Paths traced together.
const BATCH: u32 = 256;

/// Seed of the paths over that of the picture's samples.
const SEED: u32 = 0x51de_c0de;

/// Share of the light from which half of the greatest share of edges is drawn there; with less, fewer in proportion.
const MUCH: f32 = 0.1;

/// Share of light below which no edge is worth it: where about .02 comes so, in a living room and a kitchen with glass
/// ware, edges drawn towards glass take 15 % of the eye pass, and pictures are the same.
const LITTLE: f32 = 0.03;

/// Number of paths, by their weights, that must have found the light: what fewer find is chance.
const MIN_PATHS: f64 = 8.0;

/// Share of light that comes by lobes other than diffuse ones from which all blind edges are followed; with less, fewer
/// in proportion, but no fewer than the least share.
///
/// Where a tenth of the light comes so, half of the edges spare the staircase and the living room 10 and 5 % of all
/// time for less than .1 dB.
const ALL_BLIND: f32 = 0.2;
const MIN_BLIND: f32 = 0.1;

/// The edges; each reach that `all` makes finds the light of the eye pass along paths drawn without this knowledge.
pub(super) fn edges<'w, R: Reach<'w>>(
    world: &'w World,
    view: &View,
    settings: EyeSettings,
    (all, caustics): (impl Fn() -> R + Sync, Option<&Caustics>),
    counts: &mut Counts,
) -> ScatteredEdges {
    let mut edges = ScatteredEdges::default();
    if !world.specular.bends_light() {
        return edges;
    }
    let has_delta_lobes = world.specular.has_delta_lobes();
    let film = view.window.film;
    let seed = settings.seed ^ SEED;
    // Light that comes by delta lobes, by these and others too sharp to pass for diffuse; roots of all light; squares
    // of the first.
    let sums_of = |first: u32| {
        let (mut batch, mut counts, mut sums) = (Batch::default(), Counts::default(), [0.0; 4]);
        let paths = (first..first + BATCH).map(|sample| {
            let at = owen_sobol_2d(sample, seed);
            let pixel = |at: f32, length: u32| ((at * length as f32) as u32).min(length - 1);
            Start { pixel: [pixel(at.x, film[0]), pixel(at.y, film[1])], sample, seed }
        });
        let finite = |light: Rgb| if light.is_finite() { f64::from(luminance(light)) } else { 0.0 };
        // Without delta lobes there is nothing to be drawn towards.
        let wanted = [(0, false), (1, true)].into_iter().filter(|(_, glossy)| *glossy || has_delta_lobes);
        for (i, glossy) in wanted {
            start(&mut batch, paths.clone(), (world, view), (Look::Pixels, 1));
            let mut reach = BySpecularLobes { glossy, caustics, looks: CausticLooks::NONE };
            for light in batch.trace(world, settings.max_depth, &mut reach, &mut counts).map(finite) {
                sums[i] += light;
                sums[3] += if glossy { 0.0 } else { light * light };
            }
        }
        start(&mut batch, paths, (world, view), (Look::Pixels, 1));
        let found = batch.trace(world, settings.max_depth, &mut all(), &mut counts);
        sums[2] = found.map(|light| finite(light).sqrt()).sum::<f64>();
        (sums, counts)
    };
    let found: Vec<([f64; 4], Counts)> =
        (0..PATHS / BATCH).into_par_iter().one_by_one().map(|batch| sums_of(batch * BATCH)).collect();
    let mut sums = [0.0; 4];
    for (of_batch, traced) in found {
        sums.iter_mut().zip(of_batch).for_each(|(sum, of_batch)| *sum += of_batch);
        counts.rays += traced.rays;
        counts.shadow_rays += traced.shadow_rays;
    }
    let [by_delta, by_all, roots, squares] = sums.map(|sum| sum / f64::from(PATHS));
    let share = |light: f64| (light / (light + roots * roots).max(f64::MIN_POSITIVE)) as f32;
    let guided = share(by_delta);
    let is_chance = f64::from(PATHS) * by_delta * by_delta < MIN_PATHS * squares;
    if has_delta_lobes && guided >= LITTLE && !is_chance {
        edges.guided = MAX_GUIDED * guided / (guided + MUCH);
    }
    edges.blind = (share(by_all) / ALL_BLIND).clamp(MIN_BLIND, 1.0);
    edges
}
