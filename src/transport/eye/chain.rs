//! Eye rays through mirrors and glass to the surfaces that scatter light into a pixel.
//!
//! Paper: Herzog et al. 2009, section 4. The eye pass follows specular chains; the lightcut or the cache shades the
//! smoothly scattering surface at their ends.
//!
//! Both branches at glass are followed, so that the image has no noise from choosing one. Branches of small throughput
//! are subject to Russian roulette.
//!
//! Deviations: sharp rough lobes are followed too, in one sampled direction per sample. Virtual lights would be
//! individually visible in them, and cannot represent reflections of such lobes in each other. This adds noise, which
//! falls with the samples per pixel. Emitters are sampled for the lobe as well (`sharp`).

use super::counts::EyeCounts;
use super::sharp::{LobeSample, Sharp};
use base::math::{Cone, Rgb};
use base::sampling::Sampler;
use embree::Ray;
use glam::Vec3;
use world::material::Bsdf;
use world::shadow;
use world::{Interior, Surface, World};

/// Maximum number of pending branches. Each bounce adds at most two, one of which is followed at once.
const PENDING: usize = 32;

/// Throughput below which a branch survives only with probability throughput / threshold.
const ROULETTE_THROUGHPUT: f32 = 0.05;

/// Number of edges, including those straight through sheets, from which on the survival probability is limited.
/// Otherwise chains without absorption would not end.
const MANY_EDGES: u32 = 64;

/// Maximum survival probability of a branch after [`MANY_EDGES`].
const MAX_SURVIVAL: f32 = 0.9;

/// End of an edge of a chain.
// Values are passed on at once and never stored.
#[expect(clippy::large_enum_variant)]
pub enum EdgeEnd<'w> {
    /// Surface.
    Surface(ChainVertex<'w>),
    /// No surface.
    Nothing {
        /// Share of radiance from there that reaches the eye.
        throughput: Rgb,
    },
}

/// Surface point that a chain has hit.
#[derive(Clone, Copy, Debug)]
pub struct ChainVertex<'w> {
    /// Surface.
    pub surface: Surface,
    /// BSDF without the sharp rough lobes that the chain itself follows.
    pub bsdf: Bsdf<'w>,
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Share of the radiance leaving along `out` that reaches the eye.
    pub throughput: Rgb,
    /// Number of edges from the eye to the surface.
    pub depth: u32,
    /// Total length of these edges.
    pub distance: f32,
}

/// Lobes that chains follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Follow {
    /// Mirrors and smooth glass.
    Delta,
    /// Sharp lobes too, with the light of emitters that they reflect.
    DeltaAndSharp,
}

struct ChainBranch {
    ray: Ray,
    throughput: Rgb,
    eta_sq: f32,
    depth: u32,
    /// Number of edges, counting each edge through a sheet.
    edges: u32,
    /// Length of the chain up to the ray's origin.
    distance: f32,
    /// Start of the ray, if a sharp lobe sampled it.
    start: Option<LobeSample>,
    /// Interior in which the ray starts.
    interior: Interior,
}

/// Tracer of the chains of eye rays.
#[derive(Clone, Copy)]
pub struct ChainTracer<'w> {
    /// Scene.
    pub world: &'w World,
    /// Cone around the rays.
    pub cone: Cone,
    /// Maximum number of edges, not counting those straight through sheets.
    pub max_depth: u32,
    /// Lobes that the chains follow.
    pub follow: Follow,
}

impl<'w> ChainTracer<'w> {
    /// Follows `ray` and calls `visit` for the end of every edge. Returns the radiance emitted into the ray by surfaces
    /// and the environment, directly or along specular chains. The result is incomplete if chains do not follow sharp
    /// lobes.
    pub fn trace(
        &self,
        ray: Ray,
        sampler: &mut Sampler,
        counts: &mut EyeCounts,
        mut visit: impl FnMut(EdgeEnd<'w>),
    ) -> Rgb {
        let ChainTracer { world, cone, max_depth, follow } = *self;
        let mut emitted = Rgb::ZERO;
        let mut pending: [Option<ChainBranch>; PENDING] = [const { None }; PENDING];
        let mut waiting = 0;
        let (throughput, eta_sq, depth, edges, distance) = (Rgb::ONE, 1.0, 1, 1, 0.0);
        let (start, interior) = (None, Interior::NONE);
        let mut current =
            Some(ChainBranch { ray, throughput, eta_sq, depth, edges, distance, start, interior });
        while let Some(mut branch) = current.take().or_else(|| {
            waiting = usize::checked_sub(waiting, 1)?;
            pending[waiting].take()
        }) {
            counts.rays += 1;
            let out = -branch.ray.direction;
            let Some(mut surface) = world.intersect(&branch.ray) else {
                visit(EdgeEnd::Nothing { throughput: branch.throughput });
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
            let [of_emission, of_rest] = match world.absorbs() {
                true => world.edge_shares(branch.interior, &surface, branch.ray.direction, branch.ray.t_near),
                false => [Rgb::ONE; 2],
            };
            let light = world.emitted(&surface, out);
            if light != Rgb::ZERO {
                let weight = |start: LobeSample| start.weight_of_area(world, &surface, branch.ray.direction);
                emitted += branch.throughput * of_emission * light * branch.start.map_or(1.0, weight);
            }
            branch.throughput *= of_rest;
            let whole = world.bsdf(&surface);
            let (bsdf, sharp) = match whole.split_sharp_lobes() {
                Some((bsdf, sharp)) if follow == Follow::DeltaAndSharp => (bsdf, Some(sharp)),
                _ => (whole, None),
            };
            let ChainBranch { throughput, depth, .. } = branch;
            visit(EdgeEnd::Surface(ChainVertex { surface, bsdf, out, throughput, depth, distance }));
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
                // Shadow rays pass sheets too, so an edge through a sheet keeps its start.
                let start = match lobe.straight {
                    true => branch.start,
                    false => {
                        sharp.filter(|_| !lobe.delta).map(|by| LobeSample::new(&surface, &by, wo, lobe.pdf))
                    }
                };
                let depth = branch.depth + u32::from(!lobe.straight);
                let edges = branch.edges + 1;
                let interior = world.interior_after(branch.interior, &surface, direction, lobe.straight);
                let next = ChainBranch { ray, throughput, eta_sq, depth, edges, distance, start, interior };
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
}
