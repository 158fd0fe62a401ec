//! Emitters of photons: the beginnings of paths are sampled in proportion to the flux of emitters.
//!
//! Units: flux in watts by channel, for a single path; to be divided by the number of paths.

use super::contributions;
use super::openings::Openings;
use super::target::{LitSphere, Target};
use super::{EmissionNumbers, EmissionSample};
use base::math::{Frame, luminance};
use base::sampling::{Sampler, uniform_sphere};
use glam::Vec3;
use scene::DeltaLight;
use std::f32::consts::{PI, TAU};
use world::light::{DiscreteDistribution, spot_falloff};
use world::shadow;
use world::{SurfacePoint, World};

/// The flux of a scene's emitters, sampled in proportion to power, or to what it brings to the eye.
pub struct PhotonEmitter<'w> {
    world: &'w World,
    by_power: DiscreteDistribution,
    /// By the light that they bring to the eye, where that is another.
    by_worth: Option<DiscreteDistribution>,
    target: Target,
    lit: LitSphere,
    /// Aims that paths from infinitely far are drawn to.
    pub aims: Option<Aims<'w>>,
}

/// Aims of paths from infinitely far, which carry so much less flux.
pub struct Aims<'w> {
    openings: Openings<'w>,
    by_paths: DiscreteDistribution,
    /// Share of the paths that begin infinitely far.
    share: f32,
}

impl Aims<'_> {
    /// Mean flux of the paths that bring light to what the eye sees if all go anywhere, over that of those aimed, of as
    /// many paths.
    pub fn gain(&self) -> f32 {
        self.openings.gain
    }

    /// Share of the paths that begin infinitely far which go anywhere.
    pub fn anywhere(&self) -> f32 {
        self.openings.share
    }
}

impl<'w> PhotonEmitter<'w> {
    /// Prepares sampling; `None` if there is no emitter or no surface.
    pub fn new(world: &'w World) -> Option<PhotonEmitter<'w>> {
        let target = Target::new(world)?;
        let emitters = &world.emitters;
        let lit = LitSphere::new(world, &target);
        let areas = emitters.areas_and_spheres().map(|(light, sphere)| lit.power(light, sphere));
        let deltas = emitters.deltas.iter().map(|light| target.power(light));
        let disk = PI * target.core * target.core;
        let environment = emitters.environment.iter().map(|e| 4.0 * PI * disk * e.mean_luminance());
        let by_power = DiscreteDistribution::new(areas.chain(deltas).chain(environment));
        (!by_power.is_empty()).then_some(PhotonEmitter {
            world,
            by_power,
            by_worth: None,
            target,
            lit,
            aims: None,
        })
    }

    /// Aims for photons whose light is wanted that points `seen` by the eye reflect; `None` if photons that go anywhere
    /// come there as well.
    pub fn aims(&self, seen: &[SurfacePoint], seed: u32) -> Option<Aims<'w>> {
        let openings = Openings::new(self.world, &self.target, seen, seed)?;
        let far = |index: &usize| self.is_far(*index);
        let weight =
            |index: usize| self.by_power.probability(index) / if far(&index) { openings.gain } else { 1.0 };
        let by_paths = DiscreteDistribution::new((0..self.by_power.len()).map(weight));
        let share = (0..by_paths.len()).filter(far).map(|index| by_paths.probability(index)).sum();
        Some(Aims { openings, by_paths, share })
    }

    /// Has as many paths begin at emitters as these are worth for the light of points `seen`, if that is not about as
    /// many as their power says; returns the share of those that begin infinitely far if it is changed.
    pub fn share_by_worth(&mut self, seen: &[SurfacePoint], seed: u32) -> Option<f32> {
        let shares = contributions::shares(self.world, self.by_paths(), seen, seed)?;
        let far = (0..shares.len())
            .filter(|index| self.is_far(*index))
            .map(|index| shares.probability(index))
            .sum();
        match &mut self.aims {
            Some(aims) => (aims.by_paths, aims.share) = (shares, far),
            None => self.by_worth = Some(shares),
        }
        Some(far)
    }

    /// Emitters by their numbers of paths.
    fn by_paths(&self) -> &DiscreteDistribution {
        let otherwise = self.by_worth.as_ref().unwrap_or(&self.by_power);
        self.aims.as_ref().map_or(otherwise, |aims| &aims.by_paths)
    }

    /// True of emitters that are infinitely far.
    fn is_far(&self, index: usize) -> bool {
        let emitters = &self.world.emitters;
        let delta = index.checked_sub(emitters.areas.len()).map(|delta| emitters.deltas.get(delta));
        matches!(delta, Some(None | Some(DeltaLight::Directional { .. })))
    }

    /// Flux of all emitters, as luminance, that paths carry on the average.
    pub fn power(&self) -> f32 {
        self.by_power.total() as f32
    }

    /// Share of the flux that is that of emitter `index`, by emitter.
    pub fn shares(&self) -> impl ExactSizeIterator<Item = f32> {
        (0..self.by_power.len()).map(|index| self.by_power.probability(index))
    }

    /// True if paths are aimed by the number for places rather than by that for directions.
    pub fn aims_by_place(&self, index: usize) -> bool {
        self.is_far(index)
    }

    /// Samples the beginning of a path; `None` where an emitter is dark.
    pub fn sample(&self, sampler: &mut Sampler) -> Option<EmissionSample> {
        let (index, _) = self.by_paths().sample(sampler.next_1d());
        self.sample_of(index, &EmissionNumbers::new(sampler))
    }

    /// Begins a path at emitter `index`, with the flux of paths that choose emitters in proportion to power.
    pub fn sample_of(&self, index: usize, numbers: &EmissionNumbers) -> Option<EmissionSample> {
        let EmissionNumbers { place: u_place, direction: u_direction, side: u_side } = *numbers;
        if let Some(Aims { openings, share, .. }) = self.aims.as_ref().filter(|_| self.is_far(index)) {
            let emission = openings.sample(&self.target, u_side, u_place, u_direction)?;
            return Some(EmissionSample { flux: emission.flux / *share, ..emission });
        }
        let inv_probability = 1.0 / self.by_paths().probability(index);
        let emitters = &self.world.emitters;
        if let Some(light) = emitters.areas.get(index) {
            let point = light.sample(u_place);
            let (direction, projected) = self.lit.direction(light, &point, (u_direction, u_side))?;
            let radiance = light.radiance(&self.world.scene, &point, point.normal);
            let flux = radiance * (projected * light.area * inv_probability);
            let ray = shadow::ray_from(point.position, point.normal, direction);
            return EmissionSample::new(ray, flux, Some(luminance(radiance)));
        }
        if let Some(light) = emitters.deltas.get(index - emitters.areas.len()) {
            return match *light {
                DeltaLight::Point { position, intensity } => {
                    if let Some(towards) = self.target.towards(position) {
                        let ray = self.target.ray_in(&towards, u_direction);
                        return EmissionSample::new(
                            ray,
                            intensity * (towards.solid_angle() * inv_probability),
                            None,
                        );
                    }
                    let ray = shadow::ray_from(position, Vec3::ZERO, uniform_sphere(u_direction));
                    EmissionSample::new(ray, intensity * (4.0 * PI * inv_probability), None)
                }
                DeltaLight::Spot { position, direction, intensity, inner_angle, outer_angle } => {
                    let one_minus_cos = 1.0 - outer_angle.cos();
                    let towards = self.target.towards(position);
                    if let Some(towards) = towards.filter(|towards| towards.one_minus_cos < one_minus_cos) {
                        let ray = self.target.ray_in(&towards, u_direction);
                        let falloff = spot_falloff(ray.direction.dot(direction), inner_angle, outer_angle);
                        let angle = towards.solid_angle();
                        return EmissionSample::new(
                            ray,
                            intensity * (falloff * angle * inv_probability),
                            None,
                        );
                    }
                    let cos = 1.0 - u_direction.x * one_minus_cos;
                    let sin = (1.0 - cos * cos).max(0.0).sqrt();
                    let (sin_phi, cos_phi) = (TAU * u_direction.y).sin_cos();
                    let local = Vec3::new(sin * cos_phi, sin * sin_phi, cos);
                    let ray =
                        shadow::ray_from(position, Vec3::ZERO, Frame::from_normal(direction).to_world(local));
                    let falloff = spot_falloff(cos, inner_angle, outer_angle);
                    EmissionSample::new(
                        ray,
                        intensity * (falloff * TAU * one_minus_cos * inv_probability),
                        None,
                    )
                }
                DeltaLight::Directional { direction, irradiance } => {
                    let (ray, area) = self.target.ray(direction, u_place);
                    EmissionSample::new(ray, irradiance * (area * inv_probability), None)
                }
            };
        }
        let s = emitters.environment.as_ref()?.sample(u_direction)?;
        let (ray, area) = self.target.ray(-s.direction, u_place);
        EmissionSample::new(ray, s.radiance * (area * inv_probability / s.pdf), Some(luminance(s.radiance)))
    }
}
