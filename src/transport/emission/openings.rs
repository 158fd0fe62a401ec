//! Aims for photons from infinitely far: places where their light reaches surfaces that light the image indirectly.
//!
//! Nearly all photons of a sky miss a room that it lights through windows. Pilot paths from visible surfaces find the
//! places that light reaches ([`super::entries`]). Spheres around these places are the aims of photons, by source. Some
//! photons still go anywhere, so that flux is unbiased however few places were found.
//!
//! Paper: Georgiev & Slusallek, *Simple and Robust Iterative Importance Sampling of Virtual Point Lights*, 2010, for
//! the objective: virtual lights in proportion to their contributions to the image.
//! Deviations: photons are sampled in proportion to their contributions, not rejected afterwards.

use super::entries::{LightEntry, entries};
use super::far::FarLights;
use super::target::EmissionTarget;
use super::{EmissionNumbers, EmissionSample};
use base::math::Frame;
use base::sampling::{hash, uniform_disk};
use embree::Ray;
use glam::Vec3;
use std::f32::consts::PI;
use world::light::{DiscreteDistribution, Regions};
use world::{SurfacePoint, World};

/// Candidates for the share of the photons that go anywhere; the best is taken.
const SHARES: [f32; 3] = [0.25, 0.5, 0.75];

/// Stride between the visible points that evaluate the aims.
const EVALUATED_STRIDE: usize = 4;

/// Minimum number of entries of light for aims.
const MIN_ENTRIES: usize = 256;

/// Approximate number of aims.
const AIMS: usize = 64;

/// Radius of an aim, relative to the sphere around its entries.
const WIDENING: f32 = 1.3;

/// Minimum radius of an aim, relative to the sphere around all entries.
const MIN_RADIUS: f32 = 1e-3;

/// Weight of the product of the frequencies of source and aim, relative to the frequency of the pair.
const SMOOTHING: f32 = 1.0;

/// Minimum gain of aims.
const MIN_GAIN: f32 = 2.0;

/// Aims, and probabilities of the pairs of source and aim.
pub(super) struct Openings<'w> {
    lights: FarLights<'w>,
    /// Centres and squared radii.
    aims: Vec<(Vec3, f32)>,
    /// Pairs of source and aim, source by source.
    pairs: DiscreteDistribution,
    /// Share of the photons that go anywhere.
    pub share: f32,
    /// Mean flux of contributing photons without aims, relative to their mean flux with aims.
    pub gain: f32,
}

impl<'w> Openings<'w> {
    /// Finds the aims for light to the points `seen` by the eye; `None` if there are too few entries or the gain is
    /// small.
    pub fn new(
        world: &'w World,
        target: &EmissionTarget,
        seen: &[SurfacePoint],
        seed: u32,
    ) -> Option<Openings<'w>> {
        if seen.is_empty() {
            return None;
        }
        let lights = FarLights::new(world)?;
        let entries = entries(world, &lights, seen, seed);
        if entries.len() < MIN_ENTRIES {
            return None;
        }
        let places: Vec<Vec3> = entries.iter().map(|entry| entry.place).collect();
        let (_, members) = Regions::new(&places, places.len() / AIMS);
        let all: Vec<u32> = (0..places.len() as u32).collect();
        let (_, extent_sq) = around(&places, &all);
        let aims: Vec<(Vec3, f32)> = members
            .iter()
            .map(|members| {
                let (centre, radius_sq) = around(&places, members);
                (centre, (WIDENING * WIDENING * radius_sq).max(MIN_RADIUS * MIN_RADIUS * extent_sq))
            })
            .collect();
        let pairs = pairs(lights.len(), &members, &entries);
        let mut openings = Openings { lights, aims, pairs, share: 1.0, gain: 1.0 };
        let others: Vec<SurfacePoint> =
            seen.iter().skip(EVALUATED_STRIDE / 2).step_by(EVALUATED_STRIDE).copied().collect();
        let evaluated = self::entries(world, &openings.lights, &others, hash(seed, 0x7121));
        openings.choose_share(target, &evaluated);
        (openings.gain >= MIN_GAIN && openings.gain.is_finite()).then_some(openings)
    }

    /// Chooses the share of photons that go anywhere: the one with the least mean flux of photons to `entries`.
    /// Measures the gain. None of `entries` is among those that the aims were made of.
    fn choose_share(&mut self, target: &EmissionTarget, entries: &[LightEntry]) {
        let gain = |anywhere: f32| {
            let (mut flux, mut all) = (0.0f64, 0.0f64);
            for LightEntry { place, source, towards, weight } in entries {
                let without = self.anywhere(target, *source, *place, *towards);
                let with = anywhere * without + (1.0 - anywhere) * self.aimed(*source, *place, *towards);
                flux += f64::from(*weight) * f64::from(without / with);
                all += f64::from(*weight);
            }
            (all / flux) as f32
        };
        let gains = SHARES.map(gain);
        for (share, gain) in SHARES.into_iter().zip(gains) {
            if gain > self.gain {
                (self.share, self.gain) = (share, gain);
            }
        }
    }

    /// Density, by area across the line, with which a photon that goes anywhere comes from `source` along the line
    /// through `place`.
    fn anywhere(&self, target: &EmissionTarget, source: usize, place: Vec3, towards: Vec3) -> f32 {
        self.lights.probability(source) * target.density(place, towards)
    }

    /// Density, by area across the line, with which an aimed photon comes from `source` along the line through `place`.
    fn aimed(&self, source: usize, place: Vec3, towards: Vec3) -> f32 {
        let mut density = 0.0;
        for (aim, (centre, radius_sq)) in self.aims.iter().enumerate() {
            if (place - *centre).cross(towards).length_squared() <= *radius_sq {
                density += self.pairs.probability(source * self.aims.len() + aim) / (PI * radius_sq);
            }
        }
        density
    }

    /// Samples the beginning of a path, with the flux of paths that all begin infinitely far.
    pub fn sample(&self, target: &EmissionTarget, numbers: &EmissionNumbers) -> Option<EmissionSample> {
        let EmissionNumbers { place: u_place, direction: u_direction, side: u_pair } = *numbers;
        let goes_anywhere = u_pair < self.share;
        let (source, aim) = if goes_anywhere {
            (self.lights.source(u_pair / self.share), 0)
        } else {
            let (pair, _) = self.pairs.sample((u_pair - self.share) / (1.0 - self.share));
            (pair / self.aims.len(), pair % self.aims.len())
        };
        let light = self.lights.sample(source, u_direction)?;
        let place = if goes_anywhere {
            target.ray(-light.towards, u_place).0.origin
        } else {
            let (centre, radius_sq) = self.aims[aim];
            let across = uniform_disk(u_place) * radius_sq.sqrt();
            centre + Frame::from_normal(light.towards).to_world(across.extend(0.0))
        };
        let density = self.share * self.anywhere(target, source, place, light.towards)
            + (1.0 - self.share) * self.aimed(source, place, light.towards);
        let origin = target.before(place, light.towards);
        let ray = Ray { origin, t_near: 0.0, direction: -light.towards, t_far: f32::INFINITY };
        EmissionSample::new(ray, light.irradiance / density, Some(light.radiance))
    }
}

/// Returns the distribution of pairs of source and aim, source by source.
fn pairs(sources: usize, members: &[Vec<u32>], entries: &[LightEntry]) -> DiscreteDistribution {
    let aims = members.len();
    let (mut of_pairs, mut of_sources, mut of_aims) =
        (vec![0.0; sources * aims], vec![0.0; sources], vec![0.0; aims]);
    let mut total = 0.0f64;
    for (aim, members) in members.iter().enumerate() {
        for LightEntry { source, weight, .. } in members.iter().map(|i| &entries[*i as usize]) {
            let weight = f64::from(*weight);
            of_pairs[source * aims + aim] += weight;
            of_sources[*source] += weight;
            of_aims[aim] += weight;
            total += weight;
        }
    }
    let weight = |pair: usize| {
        let (source, aim) = (pair / aims, pair % aims);
        let smoothed = of_sources[source] * of_aims[aim] / total;
        ((of_pairs[pair] + f64::from(SMOOTHING) * smoothed) / total) as f32
    };
    DiscreteDistribution::new((0..sources * aims).map(weight))
}

/// Returns the middle of some of the places, and the squared distance of the farthest of them from it.
fn around(places: &[Vec3], members: &[u32]) -> (Vec3, f32) {
    let of_members = || members.iter().map(|i| places[*i as usize]);
    let low = of_members().fold(Vec3::INFINITY, Vec3::min);
    let high = of_members().fold(Vec3::NEG_INFINITY, Vec3::max);
    let middle = 0.5 * (low + high);
    (middle, of_members().map(|place| place.distance_squared(middle)).fold(0.0, f32::max))
}
