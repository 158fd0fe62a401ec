//! The eye pass as a whole: every eye sample of a window, found once and kept in an order in which
//! neighbours in space are neighbours in memory.
//!
//! Paper: Herzog et al. 2009, section 4: eye samples are stored through specular chains and sorted by a kd-tree.
//! Units: positions relative to the scene's centre, throughputs per pixel (they include 1/spp).

use super::{ChainCounts, EyeIndex, EyeSample, Sharing, eye_sampler, trace};
use crate::film::{Image, Window};
use crate::material::Bsdf;
use crate::math::Rgb;
use crate::progress::Control;
use crate::scene::MaterialId;
use crate::view::View;
use crate::world::World;
use glam::Vec3;
use rayon::prelude::*;

/// Pixels along the edge of the square that one task looks through.
const TILE: u32 = 16;

/// What splatting reads of an eye sample: half a cache line.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(32))]
pub struct EyePoint {
    /// Where.
    pub position: Vec3,
    /// Root of the area that the pixel covers on the surface: the distance to the next sample, about.
    pub spacing: f32,
    /// Unit shading normal on the side of the eye.
    pub normal: Vec3,
    /// Which records can light it.
    pub sharing: Sharing,
}

/// What is needed of an eye sample to light it.
#[derive(Clone, Copy, Debug)]
pub struct EyeSurface<'w> {
    /// How it scatters; lobes that the chain follows itself are taken out.
    pub bsdf: Bsdf<'w>,
    /// Of the mesh.
    pub material: MaterialId,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// What the pixel's colour gains per radiance leaving along `out`.
    pub throughput: Rgb,
    /// Pixel of the window, in rows.
    pub pixel: u32,
}

/// All eye samples of a view.window.
pub struct EyeSamples<'w> {
    /// Geometry, in the order of the index.
    pub points: Vec<EyePoint>,
    /// The rest, in the same order.
    pub surfaces: Vec<EyeSurface<'w>>,
    /// The hierarchy over `points`.
    pub index: EyeIndex,
    /// Light that reaches the eye from emitters, directly or along specular chains.
    pub emitted: Image,
    /// Rays traced.
    pub chains: ChainCounts,
    /// Radiances that were not finite and left out.
    pub nonfinite: u64,
    /// False if the pass was cancelled.
    pub complete: bool,
}

#[derive(Default)]
struct Found<'w> {
    samples: Vec<(EyePoint, EyeSurface<'w>)>,
    emitted: Vec<(u32, Rgb)>,
    chains: ChainCounts,
    nonfinite: u64,
    done: bool,
}

/// How the window is looked at.
#[derive(Clone, Copy, Debug)]
pub struct EyeSettings {
    /// Eye samples a pixel.
    pub spp: u32,
    /// Another seed, other samples.
    pub seed: u32,
    /// Longest path in edges, the one to the light included.
    pub max_depth: u32,
}

impl<'w> EyeSamples<'w> {
    /// Looks through every pixel of `window`, a single sample through its centre.
    pub fn look(world: &'w World, view: &View, settings: EyeSettings, control: &Control) -> EyeSamples<'w> {
        let tiles: Vec<Found> = (0..view.window.tile_count(TILE))
            .into_par_iter()
            .map(|tile| {
                let mut found = Found::default();
                if !control.is_cancelled() {
                    found.look(world, view, settings, tile);
                    control.advance(1);
                }
                found
            })
            .collect();

        let mut emitted = Image::new(view.window.width, view.window.height);
        let mut chains = ChainCounts::default();
        let mut nonfinite = 0;
        let mut complete = true;
        let mut samples = Vec::with_capacity(tiles.iter().map(|t| t.samples.len()).sum());
        for tile in tiles {
            samples.extend(tile.samples);
            for (pixel, radiance) in tile.emitted {
                emitted.pixels[pixel as usize] += radiance;
            }
            chains += tile.chains;
            nonfinite += tile.nonfinite;
            complete &= tile.done;
        }
        let (index, order) = EyeIndex::build(samples.iter().map(|s| s.0.position));
        let points = order.par_iter().map(|&i| samples[i as usize].0).collect();
        let surfaces = order.par_iter().map(|&i| samples[i as usize].1).collect();
        EyeSamples { points, surfaces, index, emitted, chains, nonfinite, complete }
    }

    /// Memory in bytes that it takes to render `window` from eye samples kept all at once, if every ray meets one
    /// surface: they themselves, and as measured half as much again for sorting and lighting them.
    pub fn expected_bytes(window: &Window, spp: u32) -> u64 {
        let each = 3 * (size_of::<EyePoint>() + size_of::<EyeSurface>()) / 2;
        window.pixel_count().saturating_mul(u64::from(spp)).saturating_mul(each as u64)
    }

    /// How many.
    pub fn len(&self) -> usize {
        self.points.len()
    }

    /// Whether nothing is seen.
    pub fn is_empty(&self) -> bool {
        self.points.is_empty()
    }
}

impl<'w> Found<'w> {
    fn look(&mut self, world: &'w World, view: &View, settings: EyeSettings, tile: usize) {
        let spp = settings.spp.max(1);
        // Angle between neighbouring samples, at the film's centre.
        let angle = view.pixel_angle() / (spp as f32).sqrt();
        for pixel in view.window.tile(tile, TILE) {
            let film_pixel = view.window.film_pixel(pixel);
            let place = pixel[1] * view.window.width + pixel[0];
            for sample in 0..spp {
                let (mut sampler, jitter) = eye_sampler(film_pixel, settings.seed, sample, spp);
                let ray = view.primary_ray(film_pixel, jitter);
                let samples = &mut self.samples;
                let visit = |eye: EyeSample<'w>| {
                    if eye.depth < settings.max_depth {
                        let material = world.scene.meshes[eye.surface.mesh as usize].material;
                        samples.extend(stored(&eye, material, angle, place, spp));
                    }
                };
                let emitted =
                    trace(world, ray, settings.max_depth, &mut sampler, &mut self.chains, visit) / spp as f32;
                if !emitted.is_finite() {
                    self.nonfinite += 1;
                } else if emitted != Rgb::ZERO {
                    self.emitted.push((place, emitted));
                }
            }
        }
        self.done = true;
    }
}

/// The sample as it is kept, or `None` if it cannot be lit.
fn stored<'w>(
    eye: &EyeSample<'w>,
    material: MaterialId,
    angle: f32,
    pixel: u32,
    spp: u32,
) -> Option<(EyePoint, EyeSurface<'w>)> {
    let s = &eye.surface;
    let front = s.frame.normal.dot(eye.out) > 0.0;
    if !front && !eye.bsdf.two_sided() {
        return None;
    }
    let normal = if front { s.frame.normal } else { -s.frame.normal };
    // Foreshortening is limited, so that grazing samples do not claim whole floors.
    let spacing = angle * eye.distance / normal.dot(eye.out).max(0.05).sqrt();
    let point = EyePoint { position: s.position, spacing, normal, sharing: Sharing::new(eye.bsdf.coat(), 0) };
    let surface = EyeSurface {
        bsdf: eye.bsdf,
        material,
        geometric_normal: s.normal,
        out: eye.out,
        throughput: eye.throughput / spp as f32,
        pixel,
    };
    (point.position.is_finite() && spacing.is_finite()).then_some((point, surface))
}
