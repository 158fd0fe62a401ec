//! One vertex of a path: what it emits, what light reaches it directly, and where the path goes on.
//!
//! Paper: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapters 9 and 10.
//!
//! Deviations: a path survives Russian roulette with the square root of its throughput. The throughput itself, from
//! the second bounce on, ends paths between dark walls so often that the few that then meet the sun are fireflies.
//! Against the throughput from the third bounce on, the root from the second takes 2 to 7 % less time in a Cornell
//! box, a glossy knot and a church, at the same variance a sample (the knot: a tenth less).

use crate::embree::Ray;
use crate::light::EnvironmentSample;
use crate::math::Rgb;
use crate::sampling::Sampler;
use crate::shadow;
use crate::world::{Surface, World};
use glam::{Vec2, Vec3};

/// From this vertex on, counted from the eye, Russian roulette may end a path.
const ROULETTE_DEPTH: u32 = 2;

/// A path on its way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Path {
    /// The edge to be traced.
    pub ray: Ray,
    /// Share of the radiance along the edge that reaches the eye.
    throughput: Rgb,
    /// Undoes the scaling of radiance inside dense media, for Russian roulette.
    eta_sq: f32,
    /// Where the edge starts.
    position: Vec3,
    /// Shading normal there, on the side the path arrived from.
    normal: Vec3,
    /// Density of the edge's direction; infinite where light sampling could not have chosen it.
    pdf: f32,
    sampler: Sampler,
    /// Which of the batch's results the path adds to.
    pub slot: u32,
}

/// What chance gives one vertex.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Draws {
    /// For the light, for the direction, for the choices of emitter and lobe, for Russian roulette.
    numbers: [Vec2; 4],
    /// The environment's sample for the light's numbers, where there is an environment.
    pub environment: Option<EnvironmentSample>,
}

impl Draws {
    /// The light's numbers.
    pub fn light(&self) -> Vec2 {
        self.numbers[0]
    }
}

/// Light that arrives if a segment is free.
#[derive(Clone, Debug)]
pub(super) struct DirectLight {
    /// The segment.
    pub segment: Ray,
    /// Radiance at the eye.
    pub radiance: Rgb,
    /// Which of the batch's results it is for.
    pub slot: u32,
}

impl Path {
    /// A path along an eye ray.
    pub fn new(ray: Ray, sampler: Sampler, slot: u32) -> Path {
        Path {
            ray,
            throughput: Rgb::ONE,
            eta_sq: 1.0,
            position: ray.origin,
            normal: Vec3::ZERO,
            pdf: f32::INFINITY,
            sampler,
            slot,
        }
    }

    /// The random numbers of the path's next vertex; the environment's sample is left out.
    #[inline]
    pub fn draw(&mut self) -> Draws {
        Draws { numbers: self.sampler.next_4x2d(), environment: None }
    }

    /// Radiance at the eye from the environment, the edge having met nothing; `radiance` is the environment's
    /// along the edge and `pdf` its density of sampling that direction.
    #[inline]
    pub fn escaped(&self, world: &World, (radiance, pdf): (Rgb, f32)) -> Rgb {
        let weight =
            self.weight_against(|| pdf * world.emitters.environment_choice(self.position, self.normal));
        self.throughput * radiance * weight
    }

    /// Radiance at the eye from what the surface emits.
    #[inline]
    pub fn emitted(&self, world: &World, surface: &Surface) -> Rgb {
        let out = -self.ray.direction;
        let emitted = world.emitted(surface, out);
        if emitted == Rgb::ZERO {
            return Rgb::ZERO;
        }
        let weight = self.weight_against(|| {
            let distance = (surface.position - self.position).length();
            let cos = surface.normal.dot(out);
            world.emitters.pdf_area(self.position, self.normal, surface.mesh, distance, cos)
        });
        self.throughput * emitted * weight
    }

    /// Samples light and the next direction at the surface that the edge, number `depth` of the path, has met.
    /// Turns the path into its continuation and returns true, or returns false where it ends.
    #[inline]
    pub fn scatter(
        &mut self,
        world: &World,
        surface: &Surface,
        depth: u32,
        draws: &Draws,
        direct: &mut Vec<DirectLight>,
    ) -> bool {
        let bsdf = world.bsdf(surface);
        let wo = surface.frame.to_local(-self.ray.direction);
        let normal = if wo.z < 0.0 { -surface.frame.normal } else { surface.frame.normal };
        let [u_light, u_direction, u_choices, u_roulette] = draws.numbers;
        if bsdf.has_smooth()
            && let Some(light) = world.emitters.sample_direct_with(
                &world.scene,
                surface.position,
                normal,
                u_choices.x,
                u_light,
                || draws.environment,
            )
        {
            let wi = surface.frame.to_local(light.direction);
            let (value, pdf) = bsdf.eval_pdf(wo, wi);
            if value != Rgb::ZERO {
                let weight = if light.delta { 1.0 } else { power_heuristic(light.pdf, pdf) };
                let segment = if light.distance.is_finite() {
                    let target = surface.position + light.direction * light.distance;
                    shadow::segment(surface.position, surface.normal, target, light.normal)
                } else {
                    shadow::ray_from(surface.position, surface.normal, light.direction)
                };
                let radiance = self.throughput * value * light.radiance * (wi.z.abs() * weight / light.pdf);
                direct.push(DirectLight { segment, radiance, slot: self.slot });
            }
        }
        let Some(sample) = bsdf.sample(wo, u_choices.y, u_direction) else { return false };
        self.throughput *= sample.weight;
        self.eta_sq *= sample.eta * sample.eta;
        if depth >= ROULETTE_DEPTH {
            let survival = (self.throughput.max_element() * self.eta_sq).sqrt().min(0.95);
            // The comparison also ends paths whose throughput is not a number.
            if !(u_roulette.x < survival) {
                return false;
            }
            self.throughput /= survival;
        }
        self.position = surface.position;
        self.normal = normal;
        self.pdf = if sample.delta { f32::INFINITY } else { sample.pdf };
        let direction = surface.frame.to_world(sample.wi);
        self.ray = shadow::ray_from(surface.position, surface.normal, direction);
        true
    }

    /// Weight of having met a light by chance, against light sampling of the given density.
    #[inline]
    fn weight_against(&self, light_pdf: impl FnOnce() -> f32) -> f32 {
        if self.pdf == f32::INFINITY { 1.0 } else { power_heuristic(self.pdf, light_pdf()) }
    }
}

/// Weight of a sample of density `a` against another technique of density `b` (Veach, β = 2).
#[inline]
fn power_heuristic(a: f32, b: f32) -> f32 {
    let ratio = b / a;
    1.0 / (1.0 + ratio * ratio)
}
