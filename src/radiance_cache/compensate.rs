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
use crate::bias_compensation::short_rays::{self, ClampedPoint, NearSurface};
use crate::bias_compensation::{Compensation, choose_evenly};
use crate::lightcut::{
    CoherenceLimit, CutSettings, Lightcut, MIN_SHARED, PacketLightcut, Receiver, ReceiverPacket,
    group_coherent,
};
use crate::math::{Frame, LANES, Rgb, luminance};
use crate::vpl::DirectIndirect;
use std::f32::consts::{FRAC_1_PI, PI};

/// Rays from each record.
const RAYS: u32 = 32;

/// Maximum number of lightcuts at points hit by rays of one record.
const LOOKUPS: usize = 2;

/// A record's light may change by less than about this without lightcuts to find it.
const NEGLIGIBLE: f32 = 5e-3;

/// Error bound of those lightcuts; their share in a record's light is small.
const EPSILON: f32 = 0.1;

/// Divisor of a record's maximum number of clusters that gives the maximum in those lightcuts.
const CUT_FRACTION: usize = 8;

/// Limit of the contribution of an indirect virtual light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clamp {
    /// Its luminance is at most this.
    Luminance(f32),
    /// Its geometry term is at most this.
    Geometry(f32),
}

impl Clamp {
    /// Share of a contribution that is kept, of the given luminance and geometry term.
    #[inline]
    pub fn kept(self, luminance: f32, geometry: f32) -> f32 {
        let (value, limit) = match self {
            Clamp::Luminance(limit) => (luminance, limit),
            Clamp::Geometry(limit) => (geometry, limit),
        };
        if value > limit { limit / value } else { 1.0 }
    }

    /// Returns the maximum geometry term, infinite if another quantity is limited.
    pub fn bound(self) -> f32 {
        match self {
            Clamp::Luminance(_) => f32::INFINITY,
            Clamp::Geometry(bound) => bound,
        }
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
pub struct Cutters<'a> {
    /// For one point.
    pub single: &'a mut Lightcut,
    /// For several.
    pub group: &'a mut PacketLightcut,
    /// The several.
    pub points: &'a mut ReceiverPacket<'static>,
}

/// Returns the clamp of indirect leaves, none of which may give more than the luminance `limit`.
pub fn clamp(compensation: &Option<Compensation>, limit: f32) -> Clamp {
    compensation.as_ref().map_or(Clamp::Luminance(limit), |c| Clamp::Geometry(c.bound(limit)))
}

/// Adds the compensation of clamped virtual lights to the direct and indirect light of a task's records.
pub fn add(
    c: &Compensation,
    source: &LightcutSource,
    mut cutters: Cutters,
    task: &[Candidate],
    gathered: &mut [&mut DirectIndirect<GatheredLayer>],
) {
    let world = source.context.world;
    let clamped = |(candidate, gathered): (&Candidate, &&mut DirectIndirect<GatheredLayer>)| ClampedPoint {
        point: candidate.point,
        bound: if candidate.missing.indirect { gathered.indirect.bound } else { f32::INFINITY },
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
    // Sorted by the mesh hit: neighbours gather light side by side.
    lookups.sort_by_key(|lookup| (lookup.near.surface.mesh, lookup.record));
    let place = |lookup: &Lookup| (lookup.near.surface.position, lookup.near.normal);
    for group in group_coherent(CoherenceLimit::CLOSE, lookups, LANES, world.diagonal, place, |_, _| true) {
        let irradiance = cutters.irradiance(source, &group);
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

impl Cutters<'_> {
    /// Irradiance at points met, on the side of the records.
    fn irradiance(&mut self, source: &LightcutSource, group: &[Lookup]) -> [Rgb; LANES] {
        let settings = CutSettings {
            epsilon: EPSILON,
            max_cut: source.settings.cut.max_cut.div_ceil(CUT_FRACTION),
            ..CutSettings::default()
        };
        let collectors = group.iter().map(|lookup| {
            let s = &lookup.near.surface;
            Receiver::irradiance(s.position, s.normal, &Frame::from_normal(lookup.near.normal))
        });
        let (transfer, world) = (&source.context.transfer, source.context.world);
        if group.len() >= MIN_SHARED {
            self.points.set(collectors);
            return self.group.gather(transfer, world, self.points, &settings).sum.radiance;
        }
        let mut irradiance = [Rgb::ZERO; LANES];
        for (irradiance, collector) in irradiance.iter_mut().zip(collectors) {
            *irradiance = self.single.gather(transfer, world, &collector, &settings).radiance;
        }
        irradiance
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clamps_keep_what_is_within_the_limit() {
        for (luminance, geometry) in [(0.5, 8.0), (2.0, 0.25), (4.0, 16.0)] {
            let kept = Clamp::Luminance(2.0).kept(luminance, geometry);
            assert_eq!(kept * luminance, luminance.min(2.0));
            let kept = Clamp::Geometry(4.0).kept(luminance, geometry);
            assert_eq!(kept * geometry, geometry.min(4.0));
            assert_eq!(Clamp::Luminance(f32::INFINITY).kept(luminance, geometry), 1.0);
        }
        assert_eq!((Clamp::Luminance(2.0).bound(), Clamp::Geometry(4.0).bound()), (f32::INFINITY, 4.0));
    }
}
