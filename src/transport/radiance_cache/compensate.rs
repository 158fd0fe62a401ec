//! Compensation at records for the light clamped from nearby virtual lights (see [`crate::bias_compensation`]).
//!
//! Deviations: light is gathered at no more than `LOOKUPS` of the points that a record's short rays hit. They are
//! chosen in proportion to their possible contribution, and their own light is clamped without compensation. Series
//! are clamped and not compensated.
//!
//! Units: geometry terms in 1/m².

use super::candidate::Candidate;
use super::gather::GatheredLayer;
use super::source::LightcutSource;
use crate::bias_compensation::near_surface::{Limit, NearSurface};
use crate::bias_compensation::short_rays::{self, ClampedPoint};
use crate::bias_compensation::{Compensation, choose_evenly, lobes};
use crate::lightcut::{CutSettings, Lightcut, OrientedPoint, Receiver, ReceiverPacket, group_compact};
use crate::lights::DirectIndirect;
use base::math::{Frame, LANES, Rgb, luminance};
use std::f32::consts::{FRAC_1_PI, PI};
use world::shadow::Engine;

/// Number of short rays per record.
const RAYS: u32 = 32;

/// Maximum number of lightcuts per record, at points hit by its short rays.
const LOOKUPS: usize = 2;

/// Relative change of a record's light below which no lightcuts are computed.
const NEGLIGIBLE: f32 = 5e-3;

/// Error bound of these lightcuts, relative to their luminance.
const EPSILON: f32 = 0.3;

/// Divisor from the maximum cluster count of a record's cut to that of these lightcuts.
const CUT_FRACTION: usize = 16;

/// Point chosen for a lookup of its light.
#[derive(Clone, Copy)]
struct Lookup {
    /// Index of the record in the task.
    record: usize,
    near: NearSurface,
    /// Irradiance at the record per unit irradiance at the point.
    factor: Rgb,
}

/// Buffers of a thread for the lookups' cuts.
pub struct Cutter<'a> {
    /// Cut.
    pub cut: &'a mut Lightcut,
    /// Points that the cut lights.
    pub points: &'a mut ReceiverPacket<'static>,
}

/// Adds the compensation for clamped virtual lights to the direct and indirect light of a task's records.
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
    let place = |lookup: &Lookup| OrientedPoint {
        position: lookup.near.surface.position,
        normal: lookup.near.normal,
    };
    for group in group_compact(lookups, world.diagonal, place) {
        let irradiance = cutter.irradiance(c, source, task, &group);
        for (lookup, irradiance) in group.iter().zip(irradiance) {
            let found = lookup.factor * irradiance;
            if found.is_finite() {
                let normal = task[lookup.record].point.normal;
                gathered[lookup.record].indirect.compensate(normal, found, lookup.near.distance);
            }
        }
    }
}

/// Chooses the points at which to gather light, and computes the factors of their contributions.
fn choose(near: &[NearSurface], record: usize, lookups: &mut Vec<Lookup>) {
    let total: f32 = near.iter().map(|n| luminance(n.weight)).sum();
    // The threshold assumes that the points hit are lit like the record.
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
    /// Gathers the irradiance at points hit by short rays, on the side of the records.
    fn irradiance(
        &mut self,
        c: &Compensation,
        source: &LightcutSource,
        task: &[Candidate],
        group: &[Lookup],
    ) -> [Rgb; LANES] {
        let settings = CutSettings {
            epsilon: EPSILON,
            max_cut: source.cut.max_cut.div_ceil(CUT_FRACTION),
            ..CutSettings::default()
        };
        self.points.set(group.iter().map(|lookup| {
            let s = &lookup.near.surface;
            Receiver::irradiance(s.position, s.normal, &Frame::from_normal(lookup.near.normal))
                .with_edges(task[lookup.record].edges.saturating_sub(1))
        }));
        let (transfer, world) = (&source.context.transfer, source.context.world);
        let cut = self.cut.gather(transfer, &Engine::new(world), self.points, &settings);
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
