//! Light of emitters that sharp lobes reflect into the eye.
//!
//! A sampled direction of the lobe finds large emitters well and small ones hardly ever; points sampled on emitters do
//! the opposite. Multiple importance sampling combines both. One of sixteen points on emitters, chosen in proportion
//! to its unoccluded contribution, is tested for visibility. Thus the lobe costs one shadow ray.
//!
//! Papers: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, section 9.2 (power heuristic);
//! Talbot et al., *Importance Resampling for Global Illumination*, 2005.

use super::counts::EyeCounts;
use base::math::{LANES, Rgb, Vec2x16, Vec3x16, lanes_in, luminance};
use base::sampling::{Sampler, power_heuristic};
use glam::{Vec2, Vec3};
use world::light::Receivers16;
use world::material::{Bsdf, Bsdfs16};
use world::shadow;
use world::{Surface, World};

/// Number of points sampled on emitters.
const CANDIDATES: f32 = LANES as f32;

/// Steps between these points in the unit square, modulo 1: powers of the inverse plastic number, which fill it
/// evenly.
const STEPS: Vec2 = Vec2::new(0.754_877_7, 0.569_840_3);

/// Direction that a lobe sampled at a surface.
#[derive(Clone, Copy, Debug)]
pub(super) struct LobeSample {
    at: LightReceiver,
    /// Density of the direction in the lobe, by solid angle.
    pdf: f32,
}

/// Point that receives light.
#[derive(Clone, Copy, Debug)]
struct LightReceiver {
    position: Vec3,
    /// Normal of the reflecting side; zero if light from both sides counts.
    normal: Vec3,
}

impl LightReceiver {
    /// Returns the point on `surface`, seen along `wo` in its shading frame through `lobe`.
    fn new(surface: &Surface, lobe: &Bsdf, wo: Vec3) -> LightReceiver {
        let normal = match surface.frame.normal {
            _ if lobe.scatters_across() => Vec3::ZERO,
            normal if wo.z < 0.0 => -normal,
            normal => normal,
        };
        LightReceiver { position: surface.position, normal }
    }

    /// Returns position and normal in all lanes.
    fn splat(&self) -> (Vec3x16, Vec3x16) {
        (Vec3x16::splat(self.position), Vec3x16::splat(self.normal))
    }
}

impl LobeSample {
    /// Returns the sample at `surface`, whose lobe is seen along `wo` in its shading frame.
    pub fn new(surface: &Surface, lobe: &Bsdf, wo: Vec3, pdf: f32) -> LobeSample {
        LobeSample { at: LightReceiver::new(surface, lobe, wo), pdf }
    }

    /// Returns the MIS weight of the emission of the surface hit, which points sampled on emitters find as well.
    pub fn weight_of_area(&self, world: &World, met: &Surface, direction: Vec3) -> f32 {
        let (x, n) = self.at.splat();
        let at = Receivers16 { position: &x, normal: &n, learned: None };
        let cos = met.normal.dot(direction);
        let distance = met.position.distance(self.at.position);
        let pdf = world.emitters.pdf_areas(at, &[met.mesh; LANES], &[distance; LANES], &[cos; LANES]);
        self.weight(pdf[0])
    }

    /// Returns the MIS weight of the environment's radiance. `pdf` is its density by solid angle once the environment
    /// is chosen.
    pub fn weight_of_environment(&self, world: &World, pdf: f32) -> f32 {
        let (x, n) = self.at.splat();
        let at = Receivers16 { position: &x, normal: &n, learned: None };
        self.weight(pdf * world.emitters.environment_choice(at)[0])
    }

    fn weight(&self, light_pdf: f32) -> f32 {
        power_heuristic(self.pdf, CANDIDATES * light_pdf)
    }
}

/// Lobe that the chain follows, on a surface seen along `wo` in its shading frame.
pub(super) struct Sharp<'a> {
    pub world: &'a World,
    pub surface: &'a Surface,
    pub lobe: &'a Bsdf<'a>,
    pub wo: Vec3,
    /// Maximum number of sheets that light from emitters passes.
    pub sheets: u32,
}

impl Sharp<'_> {
    /// Returns the radiance that emitters leave along `wo`: all of it for point, spot and directional lights, and the
    /// MIS-weighted part for others.
    pub fn reflected(&self, sampler: &mut Sampler, counts: &mut EyeCounts) -> Rgb {
        self.point_lights(counts) + self.area_lights(sampler, counts)
    }

    fn point_lights(&self, counts: &mut EyeCounts) -> Rgb {
        let mut radiance = Rgb::ZERO;
        for light in &self.world.emitters.deltas {
            let (direction, distance, irradiance) = light.irradiance(self.surface.position);
            let wi = self.surface.frame.to_local(direction);
            let value = self.lobe.eval(self.wo, wi) * irradiance * wi.z.abs();
            if value == Rgb::ZERO || !value.is_finite() {
                continue;
            }
            radiance += value * self.arriving(direction, distance, Vec3::ZERO, counts);
        }
        radiance
    }

    fn area_lights(&self, sampler: &mut Sampler, counts: &mut EyeCounts) -> Rgb {
        let emitters = &self.world.emitters;
        if emitters.areas.is_empty() && emitters.environment.is_none() {
            return Rgb::ZERO;
        }
        let (first, place, draw) = (sampler.next_1d(), sampler.next_2d(), sampler.next_1d());
        let (mut choices, mut places) = ([0.0; LANES], Vec2x16::default());
        for i in 0..LANES {
            choices[i] = (first + i as f32 / CANDIDATES).fract();
            places.set(i, (place + i as f32 * STEPS).fract());
        }
        let (x, n) = LightReceiver::new(self.surface, self.lobe, self.wo).splat();
        let at = Receivers16 { position: &x, normal: &n, learned: None };
        let lights = emitters.sample_direct(at, &choices, &places, u16::MAX);
        let mut wi = Vec3x16::default();
        for i in 0..LANES {
            wi.set(i, self.surface.frame.to_local(lights.direction.get(i)));
        }
        let (value, pdf) =
            Bsdfs16::new(Vec3x16::splat(self.wo), |_| *self.lobe).eval_pdf(&wi, lights.useful());
        let (mut values, mut sum) = ([Rgb::ZERO; LANES], 0.0);
        for i in lanes_in(lights.useful()).filter(|i| lights.delta[*i] == 0) {
            let density = CANDIDATES * lights.pdf[i];
            let factor = wi.z[i].abs() * power_heuristic(density, pdf[i]) / density;
            let value = value.get(i) * lights.radiance.get(i) * factor;
            if value.is_finite() {
                values[i] = value;
                sum += luminance(value);
            }
        }
        let mut left = draw * sum;
        for i in (0..LANES).filter(|i| luminance(values[*i]) > 0.0) {
            let share = luminance(values[i]);
            left -= share;
            if left < 0.0 {
                let (direction, distance) = (lights.direction.get(i), lights.distance[i]);
                let arriving = self.arriving(direction, distance, lights.normal.get(i), counts);
                return values[i] * arriving * (sum / share);
            }
        }
        Rgb::ZERO
    }

    /// Returns the share of an emitter's light that arrives. `normal` is that of its surface, zero without one.
    fn arriving(&self, direction: Vec3, distance: f32, normal: Vec3, counts: &mut EyeCounts) -> Rgb {
        counts.shadow_rays += 1;
        let Surface { position, normal: own, .. } = *self.surface;
        if distance.is_finite() {
            let share = self.world.share_from(self.surface, direction, distance);
            let segment = shadow::segment(position, own, position + direction * distance, normal);
            share * shadow::arriving(self.world, &segment, self.sheets)
        } else {
            shadow::arriving(self.world, &shadow::ray_from(position, own, direction), self.sheets)
        }
    }
}
