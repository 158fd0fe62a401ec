//! Reflection by surfaces that are nearer than the photon map resolves.
//!
//! The map's irradiance is the mean over a disc. Seen from far, the blur averages out over the hemisphere. Seen from
//! nearer than the disc's width it does not: light leaks under objects, and creases are dark. Instead, paths continue
//! by further edges, with light sampled at their vertices, until they reach a surface that is far enough away.
//!
//! Papers: Jensen 1996 (importance of near hits); Christensen 1999; Veach 1997 (multiple importance sampling).

use super::indirect_light::{GatherCounts, IndirectLight};
use crate::irradiance::MIN_COS;
use base::math::{F32x16, Frame, LANES, Rgb, U32x16, Vec2x16, Vec3x16, lanes_in};
use base::sampling::{Sampler, cosine_hemisphere, hash, power_heuristic};
use embree::{Hits16, Rays16};
use glam::Vec3;
use std::f32::consts::FRAC_1_PI;
use world::Surface;
use world::light::Receivers16;
use world::shadow;

/// Maximum number of added edges. Surfaces that are still too near use the map.
const MAX_EDGES: u16 = 4;

/// Maximum number of near surfaces that share the irradiance of one of them.
const SHARED: usize = 4;

/// Surfaces that are too near to the points that they light.
#[derive(Default)]
pub struct NearHits {
    /// Lanes in use.
    pub lanes: u16,
    position: Vec3x16,
    /// Unit shading normals on the side that reflects.
    normal: Vec3x16,
    /// Unit geometric normals on the side that reflects.
    geometric: Vec3x16,
    /// Throughput of the rays that hit the surfaces, times albedo.
    throughput: Vec3x16,
}

impl NearHits {
    fn receivers(&self) -> Receivers16<'_> {
        Receivers16 { position: &self.position, normal: &self.normal, learned: None }
    }

    /// Adds a surface hit along `direction`; `throughput` includes the albedo.
    pub fn set(&mut self, lane: usize, surface: &Surface, direction: Vec3, throughput: Rgb) {
        let facing = |n: Vec3| if n.dot(direction) < 0.0 { n } else { -n };
        self.lanes |= 1 << lane;
        self.position.set(lane, surface.position);
        self.normal.set(lane, facing(surface.frame.normal));
        self.geometric.set(lane, facing(surface.normal));
        self.throughput.set(lane, throughput);
    }
}

impl IndirectLight<'_> {
    /// Adds to `radiance` the reflection of near surfaces hit by rays of neighbouring strata. Of up to four surfaces of
    /// similar orientation, a random one is followed, and its irradiance is used for all.
    pub fn follow_shared(
        &self,
        near: NearHits,
        seed: u32,
        radiance: &mut [Rgb; LANES],
        counts: &mut GatherCounts,
    ) {
        if near.lanes == 0 {
            return;
        }
        let (mut lender, mut chosen) = ([0; LANES], 0u16);
        let mut left = near.lanes;
        while left != 0 {
            let normal = near.geometric.get(left.trailing_zeros() as usize);
            let alike = |lane: &usize| near.geometric.get(*lane).dot(normal) >= MIN_COS;
            let group = || lanes_in(left).filter(alike).take(SHARED);
            let of = group().count().max(1);
            let sampled = hash(u32::from(left), seed) as usize % of;
            let follows = group().nth(sampled).unwrap_or(left.trailing_zeros() as usize);
            chosen |= 1 << follows;
            // The first is always taken, even if its normal is not a number.
            let mut taken = left & left.wrapping_neg();
            for lane in group() {
                taken |= 1 << lane;
            }
            lanes_in(taken).for_each(|lane| lender[lane] = follows);
            left &= !taken;
        }
        let mut lent = [Rgb::ZERO; LANES];
        let (lanes, albedo) = (near.lanes, near.throughput);
        let white = Vec3x16::splat(Rgb::ONE);
        self.follow(NearHits { lanes: chosen, throughput: white, ..near }, seed, &mut lent, counts);
        for lane in lanes_in(lanes) {
            radiance[lane] += albedo.get(lane) * lent[lender[lane]];
        }
    }

    /// Adds to `radiance` the reflection of the near surfaces.
    pub fn follow(
        &self,
        mut near: NearHits,
        seed: u32,
        radiance: &mut [Rgb; LANES],
        counts: &mut GatherCounts,
    ) {
        for edge in 1..=MAX_EDGES {
            if near.lanes == 0 || self.edges <= edge {
                return;
            }
            let seed = hash(edge.into(), seed);
            let mut samplers: [Sampler; LANES] = std::array::from_fn(|lane| Sampler::new(seed, lane as u32));
            counts.near += u64::from(near.lanes.count_ones());
            let there = self.within(if self.edges == u16::MAX { u16::MAX } else { self.edges - edge });
            there.lit(&near, &mut samplers, radiance);
            near = there.next(&near, edge == MAX_EDGES, &mut samplers, radiance, counts);
        }
    }

    /// Adds direct light by sampling emitters.
    fn lit(&self, near: &NearHits, samplers: &mut [Sampler; LANES], radiance: &mut [Rgb; LANES]) {
        let world = self.world;
        let Some(sheets) = self.edges.checked_sub(1) else { return };
        let (mut choice, mut u) = (F32x16::default(), Vec2x16::default());
        for lane in lanes_in(near.lanes) {
            choice[lane] = samplers[lane].next_1d();
            u.set(lane, samplers[lane].next_2d());
        }
        let at = near.receivers();
        let lights = world.emitters.sample_direct(at, &choice, &u, near.lanes);
        for lane in lanes_in(near.lanes & lights.useful()) {
            let direction = lights.direction.get(lane);
            let (position, geometric) = (near.position.get(lane), near.geometric.get(lane));
            let cos = near.normal.get(lane).dot(direction);
            if !(cos > 0.0 && geometric.dot(direction) > 0.0) {
                continue;
            }
            let ray = shadow::to_light(position, geometric, &lights, lane);
            let weight = if lights.delta[lane] != 0 {
                1.0
            } else {
                power_heuristic(lights.pdf[lane], cos * FRAC_1_PI)
            };
            let share = cos * FRAC_1_PI * weight / lights.pdf[lane];
            let arriving = near.throughput.get(lane) * lights.radiance.get(lane) * share;
            if arriving.is_finite() {
                radiance[lane] += arriving * shadow::arriving(world, &ray, sheets.into());
            }
        }
    }

    /// Traces a ray from each surface and adds the light that it hits; returns the surfaces hit that are too near
    /// again.
    fn next(
        &self,
        near: &NearHits,
        last: bool,
        samplers: &mut [Sampler; LANES],
        radiance: &mut [Rgb; LANES],
        counts: &mut GatherCounts,
    ) -> NearHits {
        let world = self.world;
        let (mut rays, mut above, mut pdf) = (Rays16::default(), 0, F32x16::default());
        for lane in lanes_in(near.lanes) {
            let local = cosine_hemisphere(samplers[lane].next_2d());
            let direction = Frame::from_normal(near.normal.get(lane)).to_world(local);
            let geometric = near.geometric.get(lane);
            rays.set(lane, &shadow::ray_from(near.position.get(lane), geometric, direction));
            pdf[lane] = local.z * FRAC_1_PI;
            above |= u16::from(geometric.dot(direction) > 0.0) << lane;
        }
        let mut hits = Hits16::default();
        let met = world.accel.closest_hit16(&rays, above, false, &mut hits);
        self.sky(near, &rays, &pdf, above & !met, radiance);
        let mut again = NearHits::default();
        for lane in lanes_in(met) {
            let surface = world.surface(&hits.get(lane));
            let (direction, throughput) = (rays.get(lane).direction, near.throughput.get(lane));
            if world.emitters.is_light(surface.mesh) {
                let emitted = world.emitted(&surface, -direction);
                let other = self.density(near, &surface, direction, lane);
                radiance[lane] += throughput * emitted * power_heuristic(pdf[lane], other);
            }
            let resolved = if last { f32::INFINITY } else { hits.t[lane] };
            let mut emitted = Rgb::ZERO;
            let behind = |met: Option<&Surface>, passed: Rgb| {
                emitted += passed * self.emitted_behind(near, met, direction, pdf[lane], lane);
            };
            let (sent, albedo) =
                self.sent(&surface, direction, resolved, &mut samplers[lane], counts, behind);
            radiance[lane] += throughput * (sent + emitted);
            if albedo != Rgb::ZERO {
                again.set(lane, &surface, direction, throughput * albedo);
            }
        }
        again
    }

    /// Adds the environment's light along rays that hit no surface.
    fn sky(&self, near: &NearHits, rays: &Rays16, pdf: &F32x16, lanes: u16, radiance: &mut [Rgb; LANES]) {
        let emitters = &self.world.emitters;
        let Some(environment) = emitters.environment.as_ref().filter(|_| lanes != 0) else { return };
        let choice = emitters.environment_choice(near.receivers());
        let radiance_pdfs = environment.radiance_pdf16(&rays.directions(), lanes, None);
        for lane in lanes_in(lanes) {
            let (light, other) = radiance_pdfs[lane];
            let weight = power_heuristic(pdf[lane], other * choice[lane]);
            radiance[lane] += near.throughput.get(lane) * light * weight;
        }
    }

    /// Returns the MIS-weighted emission of a surface behind sheets, or of the environment if nothing is there, along a
    /// ray with the density `pdf`. Emitters are sampled through sheets, too.
    fn emitted_behind(
        &self,
        near: &NearHits,
        met: Option<&Surface>,
        direction: Vec3,
        pdf: f32,
        lane: usize,
    ) -> Rgb {
        let emitters = &self.world.emitters;
        let (emitted, other) = match (met, &emitters.environment) {
            (Some(surface), _) if emitters.is_light(surface.mesh) => {
                let t = surface.position.distance(near.position.get(lane));
                let other = self.density(near, &Surface { t, ..*surface }, direction, lane);
                (self.world.emitted(surface, -direction), other)
            }
            (None, Some(environment)) => {
                let (radiance, other) = environment.radiance_pdf(direction);
                (radiance, other * emitters.environment_choice(near.receivers())[lane])
            }
            _ => return Rgb::ZERO,
        };
        emitted * power_heuristic(pdf, other)
    }

    /// Returns the density with which sampling of emitters from a lane would choose a point of an emitter.
    fn density(&self, near: &NearHits, surface: &Surface, direction: Vec3, lane: usize) -> f32 {
        let (mut mesh, mut distance, mut cos) = (U32x16::default(), F32x16::default(), F32x16::default());
        (mesh[lane], distance[lane], cos[lane]) = (surface.mesh, surface.t, surface.normal.dot(direction));
        let at = near.receivers();
        self.world.emitters.pdf_areas(at, &mesh, &distance, &cos)[lane]
    }
}
