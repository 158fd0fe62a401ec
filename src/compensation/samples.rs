//! What eye samples lack of the light of virtual lights close to them.
//!
//! Samples of a patch that may lack something trace short rays each. The irradiance of what these meet is looked up
//! at a few places only, met by the rays of those of the patch that made its cut, and interpolated.
//!
//! Deviations: only what bases reflect is compensated, not lobes. Cuts limit the luminance that a virtual light
//! gives, not its geometry term: the same for lights of mean intensity.

use super::Compensation;
use super::near::{self, Clamped, Near};
use crate::light_tree::LightTrees;
use crate::lightcut::{
    CutCounts, CutSettings, PacketCut, PacketLightcut, PacketSum, Receiver, ReceiverPacket, frozen_luminance,
};
use crate::math::{Frame, LANES, Rgb, luminance};
use crate::stats::add_fields;
use crate::vpl::Origin;
use glam::Vec3;
use std::f32::consts::PI;

/// Rays from each sample.
const RAYS: u32 = 16;

/// Irradiance relative to that of what is near, below which it does not matter.
const NEGLIGIBLE: f32 = 0.01;

/// Error of the lightcuts that look up light, relative to the light of the samples.
const EPSILON: f32 = 0.3;

/// Most clusters in them.
const MAX_CUT: usize = 600;

/// Most steps towards the total that no cluster of them gives more than ε of.
const MAX_STEPS: u32 = 8;

/// How they are clamped: less, since light lost here is lost.
const CLAMP: f32 = 0.05;

/// Weight of places that face away, relative to those that face alike.
const ASIDE: f32 = 1e-3;

/// Finds what the samples of one patch after the other lack; one a thread.
#[derive(Default)]
pub struct NearLight {
    /// Where light was looked up, and its irradiance.
    places: Vec<Place>,
    /// Whether anything is near.
    lacks: bool,
    origin: Option<Origin>,
    met: Vec<(usize, Near)>,
    group: PacketLightcut,
    points: ReceiverPacket<'static>,
    counts: NearCounts,
}

/// What was done to find light again.
#[derive(Clone, Copy, Debug, Default)]
pub struct NearCounts {
    /// Short rays.
    pub rays: u64,
    /// Cuts that looked up light.
    pub cuts: CutCounts,
    /// Luminance of reflected light that was added to the radiance of samples, summed.
    pub found: f64,
}
add_fields!(NearCounts { rays, cuts, found });

struct Place {
    position: Vec3,
    geometric_normal: Vec3,
    normal: Vec3,
    irradiance: Rgb,
}

impl NearLight {
    /// Begins a patch with the points that made its cut, of light of one origin or of both. Adds what their `sum` lacks.
    pub fn begin(
        &mut self,
        c: &Compensation,
        origin: Option<Origin>,
        points: &ReceiverPacket,
        sum: &mut PacketSum,
    ) {
        self.origin = origin;
        self.places.clear();
        self.trace(c, points, &sum.limits);
        let known = irradiance(points, &sum.radiance);
        let mut lacking = [0.0; LANES];
        for (lane, near) in &self.met {
            lacking[*lane] += (known * luminance(near.weight) + luminance(near.emitted)) * (PI / RAYS as f32);
        }
        self.lacks = lacking.iter().any(|&lacking| lacking > NEGLIGIBLE * known);
        if self.lacks {
            self.look_up(c, known);
            self.add_met(c, points, &mut sum.radiance);
        }
    }

    /// Adds what the `sum` of further points of the patch lacks.
    pub fn add(&mut self, c: &Compensation, points: &ReceiverPacket, sum: &mut PacketSum) {
        if self.lacks {
            self.trace(c, points, &sum.limits);
            self.add_met(c, points, &mut sum.radiance);
        }
    }

    /// What was done since this was last asked.
    pub fn take_counts(&mut self) -> NearCounts {
        let cuts = std::mem::take(&mut self.group.counts);
        NearCounts { cuts, ..std::mem::take(&mut self.counts) }
    }

    fn trace(&mut self, c: &Compensation, points: &ReceiverPacket, limits: &[f32; LANES]) {
        let [direct, indirect] =
            [Origin::Direct, Origin::Indirect].map(|origin| self.origin.is_none_or(|o| o == origin));
        let clamped: Vec<Clamped> = (0..points.len())
            .map(|lane| {
                let r = points.get(lane);
                let base = luminance(r.base_brdf());
                let bound = if indirect && base > 0.0 { c.bound(limits[lane] / base) } else { f32::INFINITY };
                let (position, normal) = r.place();
                let frame = Frame::from_normal(normal);
                let geometric_normal = r.geometric_normal();
                Clamped { position, geometric_normal, frame, bound, direct: direct && base > 0.0 }
            })
            .collect();
        self.met.clear();
        let met = &mut self.met;
        self.counts.rays += near::trace(c, &clamped, RAYS, |lane, near| met.push((lane, near)));
    }

    /// Irradiance at some of what was met, in proportion to what it weighs. It is added to points that have the
    /// irradiance `known`, so it need not be known better than that.
    fn look_up(&mut self, c: &Compensation, known: f32) {
        // Evenly spaced along the sum of the weights, one surface after the other.
        let mut order: Vec<u32> = (0..self.met.len() as u32).collect();
        order.sort_by_key(|&i| (self.met[i as usize].1.surface.mesh, self.met[i as usize].0));
        let total: f32 = self.met.iter().map(|(_, near)| luminance(near.weight)).sum();
        if !(total > 0.0) {
            return;
        }
        let share = total / LANES as f32;
        let (mut reached, mut next) = (0.0, 0.5 * share);
        for i in order {
            let near = &self.met[i as usize].1;
            reached += luminance(near.weight);
            if next < reached {
                let (surface, normal) = (&near.surface, near.normal);
                let (position, geometric_normal) = (surface.position, surface.normal);
                self.places.push(Place { position, geometric_normal, normal, irradiance: Rgb::ZERO });
            }
            while next < reached {
                next += share;
            }
        }
        let collector = |p: &Place| {
            Receiver::irradiance(p.position, p.geometric_normal, &Frame::from_normal(p.normal))
                .with_baseline(known)
        };
        self.points.set(self.places.iter().map(collector));
        let settings =
            CutSettings { epsilon: EPSILON, max_cut: MAX_CUT, clamp: Some(CLAMP), ..CutSettings::default() };
        let cut = self.group.gather(&c.transfer, c.world, &self.points, &settings);
        for (lane, place) in self.places.iter_mut().enumerate() {
            let irradiance = limited(c.transfer.trees, &cut, lane, known);
            place.irradiance = if irradiance.is_finite() { irradiance } else { Rgb::ZERO };
        }
    }

    fn add_met(&mut self, c: &Compensation, points: &ReceiverPacket, radiance: &mut [Rgb; LANES]) {
        let least = 1e-6 * c.world.diagonal;
        for (lane, near) in &self.met {
            let r = points.get(*lane);
            let passed = r.coat_transmittance(near.surface.position - r.position());
            let reflected = near.weight * interpolated(&self.places, near, least * least);
            let factor = r.base_brdf() * (passed * PI / RAYS as f32);
            let found = factor * (reflected + near.emitted);
            if found.is_finite() {
                radiance[*lane] += found;
                self.counts.found += f64::from(luminance(factor * reflected));
            }
        }
    }
}

/// Irradiance of a place by a `cut`, of which no indirect cluster may give more than ε of the light that it
/// is added to: so coarse a cut leaves clusters whose representative happens to be next to the place.
fn limited(trees: &LightTrees, cut: &PacketCut, lane: usize, known: f32) -> Rgb {
    let sum = |limit: f32| {
        let given = cut.clusters.iter().map(|cluster| {
            let node = &trees.nodes[cluster.node as usize];
            let given = node.intensity * cluster.responses.get(lane);
            let most = match node.origin() {
                Origin::Direct => f32::INFINITY,
                Origin::Indirect if node.is_leaf() => cut.sum.limits[lane].min(limit),
                Origin::Indirect => limit,
            };
            let y = luminance(given);
            if y > most { given * (most / y) } else { given }
        });
        given.sum::<Rgb>()
    };
    let mut irradiance = sum(f32::INFINITY);
    frozen_luminance(luminance(irradiance) + known, MAX_STEPS, |total| {
        irradiance = sum(EPSILON * total);
        luminance(irradiance) + known
    });
    irradiance
}

/// Mean luminance of the irradiance that would reflect this radiance from the base alone.
fn irradiance(points: &ReceiverPacket, radiance: &[Rgb; LANES]) -> f32 {
    let known = |lane: usize| {
        let base = luminance(points.get(lane).base_brdf());
        (base > 0.0).then(|| luminance(radiance[lane]) / base)
    };
    let (sum, count) = (0..points.len()).filter_map(known).fold((0.0, 0), |(sum, n), e| (sum + e, n + 1));
    sum / count.max(1) as f32
}

/// Mean irradiance of the places, mostly of those close by that face alike.
fn interpolated(places: &[Place], near: &Near, least_sq: f32) -> Rgb {
    let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
    for place in places {
        let facing = place.normal.dot(near.normal).max(0.0);
        let weight =
            (ASIDE + facing * facing) / (place.position.distance_squared(near.surface.position) + least_sq);
        sum += place.irradiance * weight;
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { Rgb::ZERO }
}
