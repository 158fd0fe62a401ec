//! Eye pass: all surfaces that a window sees, found once and stored so that neighbours in space are neighbours in
//! memory.
//!
//! Paper: Herzog et al. 2009, section 4. Eye samples are stored through specular chains and sorted by a kd-tree.

use super::guides::{PackedGuide, PackedGuides};
use super::points::{PointGeometry, VisibilitySample};
use super::rays::TILE;
use super::surfaces::{PackedSurface, PointSurfaces};
use super::{EyeCounts, EyeRays, EyeSettings, ShadingPoints, VisibilitySamples, VisibleSurfaces};
use base::film::{Image, Window};
use base::kd_tree::KdTree;
use base::math::{Rgb, luminance};
use base::parallel::ShortRuns;
use base::progress::Control;
use base::stats::{Contributions, give_back};
use rayon::prelude::*;
use std::mem;
use world::World;
use world::view::View;

/// Number of freed bytes at which memory is returned to the system. Ordinary images stay below; returning it there
/// would cost time and save nothing.
const RELEASE_BYTES: usize = 64 << 20;

/// Maximum size in bytes of an array that may be in memory twice. Copies of larger arrays would set the peak memory of
/// large images.
const MAX_COPIED_BYTES: usize = 128 << 20;

/// Maximum known luminance of a pixel that counts, so that sums stay finite.
const MAX_KNOWN: f32 = 1e30;

/// Result of the eye pass for a crop window.
pub struct EyePass<'w> {
    /// Visible surfaces, in the order of the index.
    pub points: ShadingPoints<'w>,
    /// Hierarchy over `points`.
    pub index: KdTree,
    /// Shares of the points' radiances that reach the pixels.
    pub visibility: VisibilitySamples,
    /// Known light: emitters seen directly or along specular chains, light that reaches visible surfaces by mirrors
    /// and glass, and direct light if it is sampled.
    pub known: Image,
    /// Contributions to the known light by technique.
    pub contributions: Contributions,
    /// Guides for a denoiser, if requested.
    pub guides: Option<PackedGuides>,
    /// Rays traced.
    pub chains: EyeCounts,
    /// Light samples per visible surface, if direct light is sampled.
    pub light_samples: u32,
    /// Mean over pixels of the relative variance of sampled light, at most 1 per pixel; 0 if unknown.
    pub noise: f32,
    /// Number of radiances left out because they were not finite.
    pub nonfinite: u64,
    /// False if the pass was cancelled.
    pub complete: bool,
}

impl<'w> EyePass<'w> {
    /// Returns the radiance that a shading point would have to reflect to give its pixel's known light. The error
    /// budget is relative to it.
    pub fn known_luminance(&self, point: usize) -> f32 {
        let as_reflected = |seen: &VisibilitySample| {
            let known = luminance(self.known.pixels[seen.pixel as usize]);
            let weight = luminance(seen.weight);
            match weight > 0.0 {
                true if known > 0.0 && known < f32::INFINITY => known / weight,
                true => 0.0,
                false => MAX_KNOWN,
            }
        };
        self.visibility.of(point).iter().map(as_reflected).fold(f32::INFINITY, f32::min).min(MAX_KNOWN)
    }

    /// Traces the eye rays of every pixel in the view's window.
    pub fn trace(world: &'w World, view: &View, settings: EyeSettings, control: &Control) -> EyePass<'w> {
        let rays = EyeRays::new(world, view, settings);
        let window = &view.window;
        let tiles: Vec<VisibleSurfaces> = (0..window.tile_count(TILE))
            .into_par_iter()
            .one_by_one()
            .filter_map(|tile| {
                if control.is_cancelled() {
                    return None;
                }
                let mut found = VisibleSurfaces::default();
                for [x, y] in window.tile(tile, TILE) {
                    for sample in 0..settings.spp.max(1) {
                        rays.trace(window.film_pixel([x, y]), sample, y * window.width + x, &mut found);
                    }
                }
                control.advance(1);
                Some(found)
            })
            .collect();
        EyePass::gather(window, tiles, settings.spp.max(1), control)
    }

    /// Joins the tiles of a window with `spp` rays per pixel. If `control` is cancelled, some tiles are missing and
    /// the pass has no points, since nothing lights them.
    pub(super) fn gather(
        window: &Window,
        mut tiles: Vec<VisibleSurfaces<'w>>,
        spp: u32,
        control: &Control,
    ) -> EyePass<'w> {
        let spp = spp as f32;
        let all_traced = tiles.len() == window.tile_count(TILE);
        let mut known = Image::new(window.width, window.height);
        let mut chains = EyeCounts::default();
        let mut nonfinite = 0;
        let mut guides = Vec::new();
        let seen: Vec<_> =
            tiles.iter_mut().map(|tile| (mem::take(&mut tile.guides), mem::take(&mut tile.known))).collect();
        for tile in &tiles {
            chains += tile.chains;
            nonfinite += tile.nonfinite;
        }
        let put = || {
            for (new_guides, light) in seen {
                for (pixel, guide) in new_guides {
                    guides.resize(known.pixels.len(), PackedGuide::default());
                    guides[pixel as usize] = guide;
                }
                for (pixel, radiance) in light {
                    known.pixels[pixel as usize] += radiance / spp;
                }
            }
        };
        let (arranged, ()) = rayon::join(|| Arranged::new(&mut tiles, control), put);
        let complete = all_traced && arranged.is_some();
        let Arranged { points, index, mut samples } = arranged.unwrap_or_else(Arranged::empty);
        samples.par_iter_mut().for_each(|sample| sample.weight /= spp);
        drop(tiles);
        if size_of_val(&samples[..]) > RELEASE_BYTES {
            give_back();
        }
        EyePass {
            points,
            index,
            visibility: VisibilitySamples::one_each(samples),
            known,
            contributions: Contributions::default(),
            guides: (!guides.is_empty()).then_some(PackedGuides(guides)),
            chains,
            light_samples: 1,
            noise: 0.0,
            nonfinite,
            complete,
        }
    }

    /// Returns the memory in bytes for rendering `window` with `points` shading points per pixel, all in memory at
    /// once: the film, the points, and twice as much and more for sorting and lighting them.
    pub fn expected_bytes(window: &Window, points: u64) -> u64 {
        let point = size_of::<PointGeometry>() + size_of::<PackedSurface>() + size_of::<u32>();
        let each = 10 * (point + size_of::<VisibilitySample>()) / 3;
        let points = window.pixel_count().saturating_mul(points).saturating_mul(each as u64);
        Image::expected_bytes(window).saturating_add(points)
    }

    /// Returns the number of shading points.
    pub fn len(&self) -> usize {
        self.points.len()
    }
}

/// Shading points of all tiles and their visibility samples, in the order of the hierarchy over them.
struct Arranged<'w> {
    points: ShadingPoints<'w>,
    index: KdTree,
    samples: Vec<VisibilitySample>,
}

impl<'w> Arranged<'w> {
    /// Moves points and samples out of the tiles; returns `None` if `control` is cancelled.
    fn new(tiles: &mut [VisibleSurfaces<'w>], control: &Control) -> Option<Arranged<'w>> {
        let geometry = joined(tiles, |tile| mem::take(&mut tile.points.geometry), control)?;
        let positions = || geometry.iter().map(|point| point.position);
        let ((index, order), rest) = rayon::join(
            || KdTree::build_unless_cancelled(positions(), control),
            || {
                let (surfaces, factors) = joined_surfaces(tiles, control)?;
                Some((surfaces, factors, joined(tiles, |tile| mem::take(&mut tile.visibility), control)?))
            },
        );
        let (surfaces, factors, samples) = rest?;
        // Arrays are ordered in turn, so that only one at a time is in memory twice.
        let geometry = ordered(geometry, &order, control)?;
        let surfaces = PointSurfaces::from_parts(ordered(surfaces, &order, control)?, factors);
        let samples = ordered(samples, &order, control)?;
        Some(Arranged { points: ShadingPoints { geometry, surfaces }, index, samples })
    }

    fn empty() -> Arranged<'w> {
        let points = ShadingPoints::default();
        Arranged { points, index: KdTree::empty(), samples: Vec::new() }
    }
}

/// Joins the surfaces of all tiles, and the factors of their lobes; returns `None` if `control` is cancelled.
fn joined_surfaces<'w>(
    tiles: &mut [VisibleSurfaces<'w>],
    control: &Control,
) -> Option<(Vec<PackedSurface<'w>>, Vec<Rgb>)> {
    let mut all = Vec::new();
    let take = |tile: &mut VisibleSurfaces<'w>| {
        let (mut packed, factors) = mem::take(&mut tile.points.surfaces).into_parts();
        packed.iter_mut().for_each(|surface| surface.move_behind(all.len()));
        all.extend(factors);
        packed
    };
    let surfaces = joined(tiles, take, control)?;
    Some((surfaces, all))
}

/// Joins one part of all tiles into one array; returns `None` if `control` is cancelled. The tiles' parts are freed
/// one by one, and memory is returned at intervals.
fn joined<'w, T>(
    tiles: &mut [VisibleSurfaces<'w>],
    part: impl FnMut(&mut VisibleSurfaces<'w>) -> Vec<T>,
    control: &Control,
) -> Option<Vec<T>> {
    let mut parts: Vec<Vec<T>> = tiles.iter_mut().map(part).collect();
    let mut all = Vec::with_capacity(parts.iter().map(Vec::len).sum());
    let mut freed = 0;
    for part in &mut parts {
        if control.is_cancelled() {
            return None;
        }
        freed += size_of_val(&part[..]);
        all.append(&mut mem::take(part));
        if freed > RELEASE_BYTES {
            give_back();
            freed = 0;
        }
    }
    Some(all)
}

/// Permutes the items: the item at `i` of the result was at `order[i]`. Returns `None` if `control` is cancelled.
fn ordered<T: Copy + Send + Sync>(items: Vec<T>, order: &[u32], control: &Control) -> Option<Vec<T>> {
    match size_of_val(&items[..]) > MAX_COPIED_BYTES {
        true => moved(items, order, control),
        false if control.is_cancelled() => None,
        false => Some(order.par_iter().map(|i| items[*i as usize]).collect()),
    }
}

/// Permutes the items in place, along the cycles of the permutation.
fn moved<T: Copy>(mut items: Vec<T>, order: &[u32], control: &Control) -> Option<Vec<T>> {
    let mut moved = vec![false; items.len()];
    for start in 0..items.len() {
        if moved[start] {
            continue;
        }
        let (first, mut at) = (items[start], start);
        loop {
            if control.is_cancelled() {
                return None;
            }
            moved[at] = true;
            let from = order[at] as usize;
            if from == start {
                break;
            }
            items[at] = items[from];
            at = from;
        }
        items[at] = first;
    }
    Some(items)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_ordered_along_cycles_of_any_length() {
        let items: Vec<u32> = (100..108).collect();
        let order = [0, 2, 3, 1, 5, 4, 7, 6];
        let expected: Vec<u32> = order.iter().map(|i| items[*i as usize]).collect();
        let control = Control::new();
        assert_eq!(moved(items.clone(), &order, &control), Some(expected));
        assert_eq!(moved(Vec::<u32>::new(), &[], &control), Some(vec![]));
        let turned: Vec<u32> = (0..1000).map(|i| (i + 7) % 1000).collect();
        assert_eq!(moved((0..1000).collect(), &turned, &control).as_ref(), Some(&turned));
        assert_eq!(ordered((0..1000).collect(), &turned, &control).as_ref(), Some(&turned));
        control.cancel();
        assert_eq!(moved(items, &order, &control), None);
    }
}
