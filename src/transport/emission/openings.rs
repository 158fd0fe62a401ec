//! Aims for photons from infinitely far: where their light comes to what the eye may see the reflection of.
//!
//! Seen from within a room, nearly all photons of the sky are lost on what is outside. Short paths from surfaces that
//! the eye sees find the places that light comes to ([`super::entries`]); spheres around these are the aims, by source.
//! Some photons still go anywhere, so that flux is the same on the average, however little was found.
//!
//! Paper: Georgiev & Slusallek, *Simple and Robust Iterative Importance Sampling of Virtual Point Lights*, 2010, for
//! the aim: virtual lights in proportion to what they give to the picture.
//! Deviations: photons are drawn where they count, not rejected afterwards.

use super::EmissionSample;
use super::entries::{Entry, entries};
use super::far::FarLights;
use super::target::Target;
use base::math::Frame;
use base::sampling::{hash, uniform_disk};
use embree::Ray;
use glam::{Vec2, Vec3};
use std::f32::consts::PI;
use world::light::{DiscreteDistribution, Regions};
use world::{SurfacePoint, World};

/// Shares of the photons that go anywhere, of which the best is taken.
const SHARES: [f32; 3] = [0.25, 0.5, 0.75];

/// Number of the points seen for each that says how good the aims are.
const TRIED: usize = 4;

/// Number of places of light below which they say too little.
const FEW: usize = 256;

/// Number of aims, about.
const AIMS: usize = 64;

/// Radius of an aim over that of the places it is made of, and its least share of the radius of all.
const WIDER: f32 = 1.3;
const LEAST: f32 = 1e-3;

/// Weight of the products of the frequencies of source and aim over those of the pairs found, which are few.
const SMOOTHED: f32 = 1.0;

/// Gain from which on aims are worth it.
const LEAST_GAIN: f32 = 2.0;

/// Aims, and how often photons of each source are drawn to each.
pub(super) struct Openings<'w> {
    lights: FarLights<'w>,
    /// Centres and squared radii.
    aims: Vec<(Vec3, f32)>,
    /// Pairs of source and aim.
    pairs: DiscreteDistribution,
    /// Share of the photons that go anywhere.
    pub share: f32,
    /// Mean flux of the photons that bring light to what the eye sees if all go anywhere, over that of those aimed.
    pub gain: f32,
}

impl<'w> Openings<'w> {
    /// Finds those of light to points `seen` by the eye; `None` if there are none, or aims are not worth it.
    pub fn new(world: &'w World, target: &Target, seen: &[SurfacePoint], seed: u32) -> Option<Openings<'w>> {
        if seen.is_empty() {
            return None;
        }
        let lights = FarLights::new(world)?;
        let entries = entries(world, &lights, seen, seed);
        if entries.len() < FEW {
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
                (centre, (WIDER * WIDER * radius_sq).max(LEAST * LEAST * extent_sq))
            })
            .collect();
        let pairs = pairs(lights.len(), &members, &entries);
        let mut openings = Openings { lights, aims, pairs, share: 1.0, gain: 1.0 };
        let others: Vec<SurfacePoint> = seen.iter().skip(TRIED / 2).step_by(TRIED).copied().collect();
        let tried = self::entries(world, &openings.lights, &others, hash(seed, 0x7121));
        openings.weigh(target, &tried);
        (openings.gain >= LEAST_GAIN && openings.gain.is_finite()).then_some(openings)
    }

    /// Chooses the share that goes anywhere by which photons that bring the light of the places `entries`, none of
    /// which the aims were made of, have the least flux in the mean, and measures the gain.
    fn weigh(&mut self, target: &Target, entries: &[Entry]) {
        let gain = |anywhere: f32| {
            let (mut flux, mut all) = (0.0f64, 0.0f64);
            for Entry { place, source, towards, weight } in entries {
                let without = self.anywhere(target, *source, *place, *towards);
                let with = anywhere * without + (1.0 - anywhere) * self.aimed(*source, *place, *towards);
                flux += f64::from(*weight) * f64::from(without / with);
                all += f64::from(*weight);
            }
            (all / flux) as f32
        };
        let gains = SHARES.map(gain);
        for (share, found) in SHARES.into_iter().zip(gains) {
            if found > self.gain {
                (self.share, self.gain) = (share, found);
            }
        }
    }

    /// Density with which photons that go anywhere are drawn from a source on the line through a place towards it, by
    /// area across it.
    fn anywhere(&self, target: &Target, source: usize, place: Vec3, towards: Vec3) -> f32 {
        self.lights.probability(source) * target.density(place, towards)
    }

    /// The same for photons that are aimed.
    fn aimed(&self, source: usize, place: Vec3, towards: Vec3) -> f32 {
        let mut density = 0.0;
        for (aim, (centre, radius_sq)) in self.aims.iter().enumerate() {
            if (place - *centre).cross(towards).length_squared() <= *radius_sq {
                density += self.pairs.probability(source * self.aims.len() + aim) / (PI * radius_sq);
            }
        }
        density
    }

    /// Begins a path, with the flux of paths that all begin infinitely far.
    pub fn sample(
        &self,
        target: &Target,
        u_pair: f32,
        u_place: Vec2,
        u_direction: Vec2,
    ) -> Option<EmissionSample> {
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

/// Weights of pairs of source and aim.
fn pairs(sources: usize, members: &[Vec<u32>], entries: &[Entry]) -> DiscreteDistribution {
    let aims = members.len();
    let (mut of_pairs, mut of_sources, mut of_aims) =
        (vec![0.0; sources * aims], vec![0.0; sources], vec![0.0; aims]);
    let mut total = 0.0f64;
    for (aim, members) in members.iter().enumerate() {
        for Entry { source, weight, .. } in members.iter().map(|i| &entries[*i as usize]) {
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
        ((of_pairs[pair] + f64::from(SMOOTHED) * smoothed) / total) as f32
    };
    DiscreteDistribution::new((0..sources * aims).map(weight))
}

/// Middle of some of the places and the squared distance of the farthest from it.
fn around(places: &[Vec3], members: &[u32]) -> (Vec3, f32) {
    let of_members = || members.iter().map(|i| places[*i as usize]);
    let low = of_members().fold(Vec3::INFINITY, Vec3::min);
    let high = of_members().fold(Vec3::NEG_INFINITY, Vec3::max);
    let middle = 0.5 * (low + high);
    (middle, of_members().map(|place| place.distance_squared(middle)).fold(0.0, f32::max))
}
