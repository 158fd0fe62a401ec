//! From a pixel through mirrors and glass to the surfaces that scatter light into it.
//!
//! Paper: Herzog et al. 2009, section 4: specular chains are followed by the eye pass, and what scatters
//! smoothly at their ends is an eye sample for the lightcut or the cache.
//!
//! Both branches at glass are followed, so that the picture has no noise from choosing; a branch that carries
//! little goes on by Russian roulette.

use crate::embree::Ray;
use crate::math::Rgb;
use crate::sampling::Sampler;
use crate::shadow;
use crate::world::{Surface, World};
use glam::Vec3;

/// Branches waiting to be followed; two a bounce at most, one of them followed at once.
const PENDING: usize = 32;

/// Below this throughput a branch survives only with probability throughput / threshold.
const ROULETTE_THROUGHPUT: f32 = 0.05;

/// A surface point that scatters light into a pixel.
#[derive(Clone, Copy, Debug)]
pub struct EyeSample {
    /// The surface.
    pub surface: Surface,
    /// Unit vector back along the ray.
    pub out: Vec3,
    /// Share of the radiance leaving along `out` that reaches the eye.
    pub throughput: Rgb,
    /// Edges from the eye to the surface.
    pub depth: u32,
}

/// Rays traced by eye chains.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChainCounts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Branches dropped because too many were pending; their light is missing.
    pub overflow: u64,
}

struct Branch {
    ray: Ray,
    throughput: Rgb,
    eta_sq: f32,
    depth: u32,
}

/// Follows `ray` and calls `visit` for every surface with a smooth part; returns the radiance emitted into the ray
/// by surfaces and the environment, directly or along specular chains of at most `max_depth` edges.
pub fn trace(
    world: &World,
    ray: Ray,
    max_depth: u32,
    sampler: &mut Sampler,
    counts: &mut ChainCounts,
    mut visit: impl FnMut(EyeSample),
) -> Rgb {
    let mut emitted = Rgb::ZERO;
    let mut pending: [Option<Branch>; PENDING] = [const { None }; PENDING];
    let mut waiting = 0;
    let mut current = Some(Branch { ray, throughput: Rgb::ONE, eta_sq: 1.0, depth: 1 });
    while let Some(branch) = current.take().or_else(|| {
        waiting = usize::checked_sub(waiting, 1)?;
        pending[waiting].take()
    }) {
        counts.rays += 1;
        let out = -branch.ray.direction;
        let Some(surface) = world.intersect(&branch.ray) else {
            if let Some(environment) = &world.emitters.environment {
                emitted += branch.throughput * environment.radiance(branch.ray.direction);
            }
            continue;
        };
        emitted += branch.throughput * world.emitted(&surface, out);
        let bsdf = world.bsdf(&surface);
        if bsdf.has_smooth() {
            visit(EyeSample { surface, out, throughput: branch.throughput, depth: branch.depth });
        }
        if branch.depth >= max_depth || !bsdf.has_delta() {
            continue;
        }
        let lobes = bsdf.delta_lobes(surface.frame.to_local(out));
        for lobe in [lobes.refraction, lobes.reflection].into_iter().flatten() {
            let mut throughput = branch.throughput * lobe.weight;
            let eta_sq = branch.eta_sq * lobe.eta * lobe.eta;
            let carried = throughput.max_element() * eta_sq;
            if carried < ROULETTE_THROUGHPUT {
                let survival = carried / ROULETTE_THROUGHPUT;
                if sampler.next_1d() >= survival {
                    continue;
                }
                throughput /= survival;
            }
            let direction = surface.frame.to_world(lobe.wi);
            let ray = shadow::ray_from(surface.position, surface.normal, direction);
            let next = Branch { ray, throughput, eta_sq, depth: branch.depth + 1 };
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
