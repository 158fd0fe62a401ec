//! Compensation at records of the light clamped from virtual lights close to them (see
//! [`crate::bias_compensation`]).
//!
//! Deviations: light is gathered at up to `LOOKUPS` of the points hit by a record's rays, chosen in
//! proportion to their possible contribution, and is itself clamped without compensation. Series (light
//! reflected by lobes) are clamped too and not compensated.
//!
//! Units: b in 1/m².

use super::gather::GatheredLayer;
use super::source::{Candidate, LightcutSource};
use crate::bias_compensation::near_surface::{BRIGHTER, Limit, NearSurface};
use crate::bias_compensation::short_rays::{self, ClampedPoint};
use crate::bias_compensation::{Compensation, choose_evenly, lobes};
use crate::lightcut::{CutSettings, PacketLightcut, Receiver, ReceiverPacket, group_compact};
use crate::lights::DirectIndirect;
use base::math::{F32x16, Frame, LANES, LUMINANCE, Rgb, Vec3x16, luminance};
use std::f32::consts::{FRAC_1_PI, PI};

/// Rays from each record.
const RAYS: u32 = 32;

/// Maximum number of lightcuts at points hit by rays of one record.
const LOOKUPS: usize = 2;

/// A record's light may change by less than about this without lightcuts to find it.
const NEGLIGIBLE: f32 = 5e-3;

/// Error bound of those lightcuts; their share in a record's light is small.
const EPSILON: f32 = 0.3;

/// Divisor of a record's maximum number of clusters that gives the maximum in those lightcuts.
const CUT_FRACTION: usize = 16;

/// Limits of the contributions of indirect virtual lights to the points of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Clamps {
    limits: F32x16,
    /// Limits of luminances besides.
    luminances: F32x16,
    /// True if the first limit geometry terms, false for luminances.
    geometry: bool,
}

impl Clamps {
    /// Limits such that none gives more than the luminances `limits` to the points of `task`.
    pub fn new(compensation: &Option<Compensation>, limits: &F32x16, task: &[Candidate]) -> Clamps {
        let Some(c) = compensation else {
            return Clamps { limits: *limits, luminances: [f32::INFINITY; LANES], geometry: false };
        };
        let mut bounds = [f32::INFINITY; LANES];
        for ((bound, limit), candidate) in bounds.iter_mut().zip(limits).zip(task) {
            *bound = c.bound(candidate.point.position, *limit);
        }
        Clamps { limits: bounds, luminances: limits.map(|limit| limit * BRIGHTER), geometry: true }
    }

    /// Shares that are kept of the contributions of a light, by the irradiance `responses` to one of unit intensity.
    #[inline]
    pub fn kept(&self, intensity: Rgb, responses: &Vec3x16) -> F32x16 {
        let weights = if self.geometry { Rgb::X } else { intensity * LUMINANCE };
        let mut kept = [1.0; LANES];
        for l in 0..LANES {
            let (value, limit) = (weights.dot(responses.get(l)), self.limits[l]);
            kept[l] = if value > limit { limit / value } else { 1.0 };
            let given = (intensity * LUMINANCE).dot(responses.get(l)) * kept[l];
            if given > self.luminances[l] {
                kept[l] *= self.luminances[l] / given;
            }
        }
        kept
    }

    /// Returns the maximum geometry term at a point, infinite if another quantity is limited.
    pub fn bound(&self, lane: usize) -> f32 {
        if self.geometry { self.limits[lane] } else { f32::INFINITY }
    }
}

/// A point chosen to look up its light.
#[derive(Clone, Copy)]
struct Lookup {
    /// Record of the task.
    record: usize,
    near: NearSurface,
    /// Irradiance at the record for an irradiance of 1 at the point.
    factor: Rgb,
}

/// Workspaces of a thread's cuts.
pub struct Cutter<'a> {
    /// The cut.
    pub cut: &'a mut PacketLightcut,
    /// The points that the cut lights.
    pub points: &'a mut ReceiverPacket<'static>,
}

/// Adds the compensation of clamped virtual lights to the direct and indirect light of a task's records.
pub fn add(
    c: &Compensation,
    source: &LightcutSource,
    mut cutter: Cutter,
    task: &[Candidate],
    gathered: &mut [&mut DirectIndirect<GatheredLayer>],
) {
    let world = source.context.world;
    let clamped = |(candidate, gathered): (&Candidate, &&mut DirectIndirect<GatheredLayer>)| ClampedPoint {
        point: candidate.point,
        limit: Limit::Geometry(if candidate.missing.indirect {
            gathered.indirect.bound
        } else {
            f32::INFINITY
        }),
        direct: candidate.missing.direct,
    };
    let points: Vec<ClampedPoint> = task.iter().zip(gathered.iter()).map(clamped).collect();
    let mut met = vec![Vec::new(); points.len()];
    short_rays::trace(c, &points, RAYS, |record, near| {
        let passed = match task[record].coat {
            0 => 1.0,
            coat => world.materials.coat_transmittance(coat, near.cos),
        };
        let emitted = near.emitted * (passed * PI / RAYS as f32);
        if emitted.is_finite() && emitted != Rgb::ZERO {
            let normal = task[record].point.normal;
            gathered[record].direct.compensate(normal, emitted, near.distance);
        }
        met[record].push(NearSurface { weight: near.weight * passed, ..near });
    });
    let mut lookups = Vec::new();
    for (record, met) in met.iter().enumerate() {
        choose(met, record, &mut lookups);
    }
    let place = |lookup: &Lookup| (lookup.near.surface.position, lookup.near.normal);
    for group in group_compact(lookups, world.diagonal, place) {
        let irradiance = cutter.irradiance(c, source, &group);
        for (lookup, irradiance) in group.iter().zip(irradiance) {
            let found = lookup.factor * irradiance;
            if found.is_finite() {
                let normal = task[lookup.record].point.normal;
                gathered[lookup.record].indirect.compensate(normal, found, lookup.near.distance);
            }
        }
    }
}

/// Chooses the points at which to gather light, and the factors of their contributions.
fn choose(near: &[NearSurface], record: usize, lookups: &mut Vec<Lookup>) {
    let total: f32 = near.iter().map(|n| luminance(n.weight)).sum();
    // As if the points met were lit as the record is.
    if total < NEGLIGIBLE * RAYS as f32 * FRAC_1_PI {
        return;
    }
    choose_evenly(near.iter().map(|n| luminance(n.weight)), total, LOOKUPS, |i, chosen| {
        let near = near[i];
        let factor = near.weight * (chosen / luminance(near.weight) * PI / RAYS as f32);
        lookups.push(Lookup { record, near, factor });
    });
}

impl Cutter<'_> {
    /// Irradiance at points met, on the side of the records.
    fn irradiance(&mut self, c: &Compensation, source: &LightcutSource, group: &[Lookup]) -> [Rgb; LANES] {
        let settings = CutSettings {
            epsilon: EPSILON,
            max_cut: source.settings.cut.max_cut.div_ceil(CUT_FRACTION),
            ..CutSettings::default()
        };
        self.points.set(group.iter().map(|lookup| {
            let s = &lookup.near.surface;
            Receiver::irradiance(s.position, s.normal, &Frame::from_normal(lookup.near.normal))
        }));
        let (transfer, world) = (&source.context.transfer, source.context.world);
        let cut = self.cut.gather(transfer, world, self.points, &settings);
        let mut irradiance = cut.sum.radiance;
        for (lane, lookup) in group.iter().enumerate() {
            let Some(factors) = lobes::factors(c, &lookup.near, &cut) else { continue };
            let given = cut.clusters.iter().zip(factors).map(|(cluster, factor)| {
                let intensity = transfer.trees.nodes[cluster.node as usize].intensity;
                intensity * cluster.responses.get(lane) * factor
            });
            irradiance[lane] = given.sum();
        }
        irradiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamps_keep_what_is_within_the_limit() {
        for (intensity, term) in [(0.5, 8.0), (2.0, 0.25), (4.0, 16.0)] {
            let kept = |limit: f32, geometry: bool| {
                let responses = Vec3x16::splat(Rgb::splat(term));
                Clamps { limits: [limit; LANES], luminances: [f32::INFINITY; LANES], geometry }
                    .kept(Rgb::splat(intensity), &responses)[3]
            };
            let luminance = kept(2.0, false) * intensity * term;
            assert!((luminance - (intensity * term).min(2.0)).abs() < 1e-5);
            assert_eq!(kept(4.0, true) * term, term.min(4.0));
            assert_eq!(kept(f32::INFINITY, false), 1.0);
            let both = Clamps { limits: [4.0; LANES], luminances: [2.0; LANES], geometry: true };
            let given =
                intensity * term * both.kept(Rgb::splat(intensity), &Vec3x16::splat(Rgb::splat(term)))[3];
            assert!((given - (intensity * f32::min(term, 4.0)).min(2.0)).abs() < 1e-5);
        }
        let clamps = Clamps::new(&None, &[2.0; LANES], &[]);
        assert_eq!((clamps.bound(0), Clamps { geometry: true, ..clamps }.bound(0)), (f32::INFINITY, 2.0));
    }
}
