//! The radiance along one ray.
//!
//! Paper: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapters 9 and 10.
//!
//! Deviations: Russian roulette compares the throughput with that of the path's own start, so that a path seen
//! through dark glass is not ended earlier than one that is not.

use crate::embree::Ray;
use crate::math::Rgb;
use crate::sampling::Sampler;
use crate::shadow;
use crate::world::World;
use glam::Vec3;

/// Edges of a path before Russian roulette may end it.
const ROULETTE_DEPTH: u32 = 3;

/// Rays traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
}

/// Where a path was before the current ray, for weighing emission it meets by chance.
struct Previous {
    position: Vec3,
    /// Shading normal on the side the path arrived from.
    normal: Vec3,
    /// Density of the sampled direction; `None` if no light sampling could have found it.
    pdf: Option<f32>,
}

/// Radiance arriving along `ray`, over paths of at most `max_depth` edges.
pub fn radiance(world: &World, ray: Ray, max_depth: u32, sampler: &mut Sampler, counts: &mut Counts) -> Rgb {
    let mut ray = ray;
    let mut result = Rgb::ZERO;
    let mut throughput = Rgb::ONE;
    // Undoes the scaling of radiance inside dense media, for Russian roulette.
    let mut eta_sq = 1.0;
    let mut previous = Previous { position: ray.origin, normal: Vec3::ZERO, pdf: None };
    let mut depth = 1;
    loop {
        counts.rays += 1;
        let Some(surface) = world.intersect(&ray) else {
            if let Some(environment) = &world.emitters.environment {
                let weight = previous.pdf.map_or(1.0, |pdf| {
                    let light =
                        world.emitters.pdf_environment(previous.position, previous.normal, ray.direction);
                    power_heuristic(pdf, light)
                });
                result += throughput * environment.radiance(ray.direction) * weight;
            }
            return result;
        };
        let out = -ray.direction;
        let emitted = world.emitted(&surface, out);
        if emitted != Rgb::ZERO {
            let weight = previous.pdf.map_or(1.0, |pdf| {
                let offset = surface.position - previous.position;
                let light = world.emitters.pdf_area(
                    previous.position,
                    previous.normal,
                    surface.mesh,
                    offset.length(),
                    surface.normal.dot(out),
                );
                power_heuristic(pdf, light)
            });
            result += throughput * emitted * weight;
        }
        if depth >= max_depth {
            return result;
        }
        let bsdf = world.bsdf(&surface);
        let wo = surface.frame.to_local(out);
        let normal = if wo.z < 0.0 { -surface.frame.normal } else { surface.frame.normal };
        let (u_choice, u_light) = (sampler.next_1d(), sampler.next_2d());
        let (u_lobe, u_direction, u_roulette) = (sampler.next_1d(), sampler.next_2d(), sampler.next_1d());
        if bsdf.has_smooth()
            && let Some(light) =
                world.emitters.sample_direct(&world.scene, surface.position, normal, u_choice, u_light)
        {
            let wi = surface.frame.to_local(light.direction);
            let (value, pdf) = bsdf.eval_pdf(wo, wi);
            if value != Rgb::ZERO {
                counts.shadow_rays += 1;
                let visible = if light.distance.is_finite() {
                    let target = surface.position + light.direction * light.distance;
                    world.visible(surface.position, surface.normal, target, light.normal)
                } else {
                    world.escapes(surface.position, surface.normal, light.direction)
                };
                if visible {
                    let weight = if light.delta { 1.0 } else { power_heuristic(light.pdf, pdf) };
                    result += throughput * value * light.radiance * (wi.z.abs() * weight / light.pdf);
                }
            }
        }
        let Some(sample) = bsdf.sample(wo, u_lobe, u_direction) else { return result };
        throughput *= sample.weight;
        eta_sq *= sample.eta * sample.eta;
        previous = Previous {
            position: surface.position,
            normal,
            pdf: if sample.delta { None } else { Some(sample.pdf) },
        };
        depth += 1;
        if depth > ROULETTE_DEPTH {
            let survival = (throughput.max_element() * eta_sq).min(0.95);
            if u_roulette >= survival {
                return result;
            }
            throughput /= survival;
        }
        let direction = surface.frame.to_world(sample.wi);
        ray = shadow::ray_from(surface.position, surface.normal, direction);
    }
}

/// Weight of a sample of density `a` against another technique of density `b` (Veach, β = 2).
#[inline]
fn power_heuristic(a: f32, b: f32) -> f32 {
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
