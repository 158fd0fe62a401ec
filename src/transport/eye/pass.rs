//! Eye pass: all surfaces that a window sees, found once and stored so that neighbours in space are neighbours in
//! memory.
//!
//! Paper: Herzog et al. 2009, section 4. Eye samples are stored through specular chains and sorted by a kd-tree.

use super::guides::{PackedGuide, PackedGuides};
use super::parts::{Parts, RELEASE_BYTES};
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
        self.visibility.at_point(point).iter().map(as_reflected).fold(f32::INFINITY, f32::min).min(MAX_KNOWN)
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
        let all_traced = tiles.len() == window.tile_count(TILE);
        EyePass::gather(window, tiles, settings.spp.max(1), all_traced, control)
    }

    /// Joins the surfaces found in a window with `spp` rays per pixel. If `control` is cancelled, the pass has no
    /// points, since nothing lights them. `all_traced` is false if tiles are missing then.
    pub(super) fn gather(
        window: &Window,
        mut tiles: Vec<VisibleSurfaces<'w>>,
        spp: u32,
        all_traced: bool,
        control: &Control,
    ) -> EyePass<'w> {
        let spp = spp as f32;
        let mut chains = EyeCounts::default();
        let mut nonfinite = 0;
        let seen: Vec<_> =
            tiles.iter_mut().map(|tile| (mem::take(&mut tile.guides), mem::take(&mut tile.known))).collect();
        for tile in &tiles {
            chains += tile.chains;
            nonfinite += tile.nonfinite;
        }
        let put = || {
            let mut known = Image::new(window.width, window.height);
            let mut guides = Vec::new();
            for (new_guides, light) in seen {
                for (pixel, guide) in new_guides {
                    guides.resize(known.pixels.len(), PackedGuide::default());
                    guides[pixel as usize] = guide;
                }
                for (pixel, radiance) in light {
                    known.pixels[pixel as usize] += radiance / spp;
                }
            }
            (known, guides)
        };
        let (arranged, (known, guides)) = rayon::join(|| Arranged::new(&mut tiles, control), put);
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
        let geometry = parts(tiles, |tile| mem::take(&mut tile.points.geometry)).joined_if_large(control)?;
        let position = |i: usize| geometry.get(i).position;
        let ((index, order), rest) = rayon::join(
            || KdTree::build_unless_cancelled((0..geometry.len()).into_par_iter().map(position), control),
            || {
                let (surfaces, factors) = joined_surfaces(tiles, control)?;
                let samples = parts(tiles, |tile| mem::take(&mut tile.visibility));
                Some((surfaces, factors, samples.joined_if_large(control)?))
            },
        );
        let (surfaces, factors, samples) = rest?;
        // Arrays are ordered in turn, so that only one at a time is in memory twice.
        let geometry = geometry.ordered(&order, control)?;
        let surfaces = PointSurfaces::from_parts(surfaces.ordered(&order, control)?, factors);
        let samples = samples.ordered(&order, control)?;
        Some(Arranged { points: ShadingPoints { geometry, surfaces }, index, samples })
    }

    fn empty() -> Arranged<'w> {
        let points = ShadingPoints::default();
        Arranged { points, index: KdTree::empty(), samples: Vec::new() }
    }
}

/// Returns one part of all tiles.
fn parts<'w, T>(
    tiles: &mut [VisibleSurfaces<'w>],
    part: impl FnMut(&mut VisibleSurfaces<'w>) -> Vec<T>,
) -> Parts<T> {
    Parts::new(tiles.iter_mut().map(part).collect())
}

/// Returns the surfaces of all tiles, and the factors of their lobes; `None` if `control` is cancelled.
fn joined_surfaces<'w>(
    tiles: &mut [VisibleSurfaces<'w>],
    control: &Control,
) -> Option<(Parts<PackedSurface<'w>>, Vec<Rgb>)> {
    let (mut factors, mut all) = (Vec::new(), Vec::with_capacity(tiles.len()));
    for tile in tiles {
        let (packed, own) = mem::take(&mut tile.points.surfaces).into_parts();
        all.push((packed, factors.len()));
        factors.extend(own);
    }
    let behind = |(mut packed, before): (Vec<PackedSurface<'w>>, usize)| {
        packed.iter_mut().for_each(|surface| surface.move_behind(before));
        packed
    };
    let surfaces = Parts::new(all.into_par_iter().map(behind).collect());
    Some((surfaces.joined_if_large(control)?, factors))
}
