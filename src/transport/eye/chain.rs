//! From a pixel through mirrors and glass to the surfaces that scatter light into it.
//!
//! Paper: Herzog et al. 2009, section 4: specular chains are followed by the eye pass, and the smoothly
//! scattering surface at their ends is shaded by the lightcut or the cache.
//!
//! Both branches at glass are followed, so that the picture has no noise from choosing; a branch of small
//! throughput is subject to Russian roulette.
//!
//! Deviations: sharp rough lobes are followed as well, in one sampled direction a sample: virtual lights
//! would be visible in them one by one, and reflections of such lobes in each other cannot be represented by
//! virtual lights at all. This brings noise, which falls with the samples a pixel. Emitters are sampled for
//! the lobe as well (`sharp`).

use super::sharp::{Sharp, Start};
use base::math::{Cone, Rgb};
use base::sampling::Sampler;
use base::stats::add_fields;
use embree::Ray;
use glam::Vec3;
use std::iter::Sum;
use world::material::Bsdf;
use world::shadow;
use world::{Surface, World};

/// Branches waiting to be followed; two a bounce at most, one of them followed at once.
const PENDING: usize = 32;

/// Below this throughput a branch survives only with probability throughput / threshold.
const ROULETTE_THROUGHPUT: f32 = 0.05;

/// Edges, straight through sheets too, from which on a branch survives with no more than this probability: chains end
/// where nothing absorbs.
const MANY_EDGES: u32 = 64;
const MAX_SURVIVAL: f32 = 0.9;

/// The end of an edge of a chain.
// It is handed on at once and stored nowhere.
#[expect(clippy::large_enum_variant)]
pub enum Met<'w> {
    /// A surface.
    Surface(Vertex<'w>),
    /// None; with the share of radiance from there that reaches the eye.
    Nothing {
        /// Share of the light.
        throughput: Rgb,
    },
}

/// A surface point that a chain has met.
#[derive(Clone, Copy, Debug)]
pub struct Vertex<'w> {
    /// The surface.
    pub surface: Surface,
    /// BSDF less the lobes that are rough but so sharp that the chain follows them itself.
    pub bsdf: Bsdf<'w>,
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Share of the radiance leaving along `out` that reaches the eye.
    pub throughput: Rgb,
    /// Edges from the eye to the surface.
    pub depth: u32,
    /// Their length in all.
    pub distance: f32,
}

/// Lobes that chains follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// Mirrors and smooth glass.
    Delta,
    /// Sharp lobes too, where they reflect the light of emitters.
    DeltaAndSharp,
}

/// Name of the counter of [`ChainCounts::overflow`].
pub const DROPPED_BRANCHES: &str = "Eye/branches dropped";

/// Rays traced by eye chains, and the light that paths behind them found.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChainCounts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
    /// Branches dropped because too many were pending; their light is missing.
    pub overflow: u64,
    /// Samples that some pixels have and others have not.
    pub extra_samples: u64,
    /// Luminance of all light found where photons are looked for, as a sum over the samples.
    pub light: f64,
    /// Luminance of that of the photons.
    pub by_photons: f64,
    /// Mean square of the luminance that paths find in place of the photons, as a sum over the samples.
    pub square_by_photons: f64,
}
add_fields!(ChainCounts { rays, shadow_rays, overflow, extra_samples, light, by_photons, square_by_photons });

impl Sum for ChainCounts {
    fn sum<I: Iterator<Item = ChainCounts>>(counts: I) -> ChainCounts {
        counts.fold(ChainCounts::default(), |mut sum, counts| {
            sum += counts;
            sum
        })
    }
}

impl ChainCounts {
    /// The photons' part of such light whose luminance is `found`.
    pub fn by_photons(&self, found: f64) -> f64 {
        if self.light > 0.0 { found * (self.by_photons / self.light) } else { 0.0 }
    }
}

struct Branch {
    ray: Ray,
    throughput: Rgb,
    eta_sq: f32,
    depth: u32,
    /// Edges, those that pass sheets straight counted each.
    edges: u32,
    /// Length of the chain up to the ray's origin.
    distance: f32,
    /// Start of the ray, if a sharp lobe sampled it.
    start: Option<Start>,
}

/// Follows `ray` in its `cone` and calls `visit` for the end of every edge; returns the radiance emitted into the ray
/// by surfaces and the environment, directly or along specular chains of at most `max_depth` edges; not all of it if
/// chains do not follow sharp lobes.
pub fn trace<'w>(
    world: &'w World,
    ray: Ray,
    cone: Cone,
    (max_depth, follow): (u32, Follow),
    sampler: &mut Sampler,
    counts: &mut ChainCounts,
    mut visit: impl FnMut(Met<'w>),
) -> Rgb {
    let mut emitted = Rgb::ZERO;
    let mut pending: [Option<Branch>; PENDING] = [const { None }; PENDING];
    let mut waiting = 0;
    let (throughput, eta_sq, depth, edges, distance) = (Rgb::ONE, 1.0, 1, 1, 0.0);
    let mut current = Some(Branch { ray, throughput, eta_sq, depth, edges, distance, start: None });
    while let Some(branch) = current.take().or_else(|| {
        waiting = usize::checked_sub(waiting, 1)?;
        pending[waiting].take()
    }) {
        counts.rays += 1;
        let out = -branch.ray.direction;
        let Some(mut surface) = world.intersect(&branch.ray) else {
            visit(Met::Nothing { throughput: branch.throughput });
            let is_hidden = branch.edges == 1 && world.scene.hides_emitters;
            if let Some(environment) = world.emitters.environment.as_ref().filter(|_| !is_hidden) {
                let direction = branch.ray.direction;
                let radiance = match branch.start {
                    Some(start) => {
                        let (radiance, pdf) = environment.radiance_pdf(direction);
                        radiance * start.weight_of_environment(world, pdf)
                    }
                    None => environment.radiance(direction),
                };
                emitted += branch.throughput * radiance;
            }
            continue;
        };
        let distance = branch.distance + surface.t;
        surface.footprint = branch.ray.direction * cone.width_at(distance);
        let light = world.emitted(&surface, out);
        if light != Rgb::ZERO {
            let weight = |start: Start| start.weight_of_area(world, &surface, branch.ray.direction);
            emitted += branch.throughput * light * branch.start.map_or(1.0, weight);
        }
        let whole = world.bsdf(&surface);
        let (bsdf, sharp) = match whole.split_sharp_lobes() {
            Some((bsdf, sharp)) if follow == Follow::DeltaAndSharp => (bsdf, Some(sharp)),
            _ => (whole, None),
        };
        let Branch { throughput, depth, .. } = branch;
        visit(Met::Surface(Vertex { surface, bsdf, out, throughput, depth, distance }));
        if branch.depth >= max_depth || !(bsdf.has_delta() || sharp.is_some()) {
            continue;
        }
        let wo = surface.frame.to_local(out);
        let lobes = bsdf.delta_lobes(wo);
        let sampled = sharp.and_then(|sharp| {
            emitted += branch.throughput
                * Sharp { world, surface: &surface, lobe: &sharp, wo }.reflected(sampler, counts);
            sharp.sample(wo, sampler.next_1d(), sampler.next_2d())
        });
        for lobe in [lobes.refraction, lobes.reflection, sampled].into_iter().flatten() {
            let mut throughput = branch.throughput * lobe.weight;
            let eta_sq = branch.eta_sq * lobe.eta * lobe.eta;
            let carried = throughput.max_element() * eta_sq;
            let limit = if branch.edges >= MANY_EDGES { MAX_SURVIVAL } else { 1.0 };
            let survival = (carried / ROULETTE_THROUGHPUT).min(limit);
            if survival < 1.0 {
                if sampler.next_1d() >= survival {
                    continue;
                }
                throughput /= survival;
            }
            let direction = surface.frame.to_world(lobe.wi);
            let ray = shadow::ray_from(surface.position, surface.normal, direction);
            // Shadow rays pass sheets too, so an edge that does stays what it is.
            let start = match lobe.straight {
                true => branch.start,
                false => sharp.filter(|_| !lobe.delta).map(|by| Start::new(&surface, &by, wo, lobe.pdf)),
            };
            let depth = branch.depth + u32::from(!lobe.straight);
            let edges = branch.edges + 1;
            let next = Branch { ray, throughput, eta_sq, depth, edges, distance, start };
            if current.is_none() {
                current = Some(next);
            } else if waiting < PENDING {
                pending[waiting] = Some(next);
                waiting += 1;
            } else {
                counts.overflow += 1;
            }
        }
    }
    emitted
}
