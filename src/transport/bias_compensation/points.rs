//! Compensation of up to sixteen points for clamped virtual lights close to them.
//!
//! Every point traces short rays. Irradiance is gathered at up to sixteen of the surfaces that they meet, and
//! interpolated to the other surfaces met. Further points of a patch use the irradiance of its first points.
//!
//! Deviations: only light that bases reflect is compensated, not that of lobes.

use super::near_surface::NearSurface;
use super::short_rays::{self, ClampedPoint};
use super::{Compensation, choose_evenly};
use crate::lightcut::{
    CutCounts, CutSettings, Lightcut, MAX_STEPS, PacketCut, PacketSum, Receiver, ReceiverPacket, SampledCut,
    SampledSettings, Samples, frozen_luminance,
};
use crate::lights::Origin;
use base::math::{Frame, LANES, Rgb, luminance};
use base::stats::add_fields;
use std::f32::consts::PI;
use world::SurfacePoint;
use world::shadow::Engine;

/// Number of rays per point.
const RAYS: u32 = 16;

/// Maximum lacking irradiance that is ignored, relative to the whole.
const NEGLIGIBLE: f32 = 0.01;

/// ε of the lightcuts at surfaces met, relative to the light of the points.
const EPSILON: f32 = 0.1;

/// Maximum number of clusters in these lightcuts.
const MAX_CUT: usize = 600;

/// Samples at a surface met, if points are lit by samples.
const SAMPLES: Samples = Samples { whole: 16.0, least: 16.0 };

/// Maximum cosine between normals of surfaces that face opposite ways.
const OPPOSITE: f32 = -0.5;

/// Weight of surfaces of perpendicular orientation, relative to those of equal orientation.
const ASIDE: f32 = 1e-3;

/// Workspace for the compensation of shading points. Each thread has one, so that buffers are allocated once.
#[derive(Default)]
pub struct Compensator {
    /// Surfaces met, with the lanes of their rays.
    met: Vec<(usize, NearSurface)>,
    packet: Lightcut,
    sampled: SampledCut,
    receivers: ReceiverPacket<'static>,
    counts: CompensationCounts,
}

/// Work of compensation.
#[derive(Clone, Copy, Debug, Default)]
pub struct CompensationCounts {
    /// Number of short rays.
    pub rays: u64,
    /// Cuts at surfaces met.
    pub cuts: CutCounts,
    /// Sum of the luminance of reflected light added to points.
    pub found: f64,
}
add_fields!(CompensationCounts { rays, cuts, found });

/// Irradiance at some of the surfaces close to a patch.
pub struct NearLight {
    /// Origin of the light that the patch gathers; `None` for both.
    origin: Option<Origin>,
    places: Vec<(SurfacePoint, Rgb)>,
}

/// Irradiance that a point lacks from a surface, but for a coat of the point.
pub struct Lacking<'a> {
    /// The surface.
    pub near: &'a NearSurface,
    /// Light that the surface reflects.
    pub reflected: Rgb,
    /// Light that the surface emits.
    pub emitted: Rgb,
}

impl Compensator {
    /// Adds the light that the anchors of a patch lack to their `sum` of the light of one origin or of both. Returns
    /// the light near the patch; `None` if it is so little that other points need no compensation. With a `seed`, the
    /// surfaces met are lit by samples.
    pub fn anchors(
        &mut self,
        c: &Compensation,
        origin: Option<Origin>,
        receivers: &ReceiverPacket,
        sum: &mut PacketSum,
        seed: Option<u32>,
    ) -> Option<NearLight> {
        let irradiance = mean_irradiance(receivers, &sum.radiance);
        let mut found = 0.0;
        let places = self.lacking(
            c,
            &clamped(origin, receivers, sum),
            irradiance,
            seed,
            reflect(receivers, sum, &mut found),
        );
        self.counts.found += found;
        Some(NearLight { origin, places: places? })
    }

    /// Adds the light that further points of the patch lack to their `sum`.
    pub fn others(
        &mut self,
        c: &Compensation,
        light: &NearLight,
        receivers: &ReceiverPacket,
        sum: &mut PacketSum,
    ) {
        let mut found = 0.0;
        self.trace(c, &clamped(light.origin, receivers, sum));
        self.interpolate(c, &light.places, reflect(receivers, sum, &mut found));
        self.counts.found += found;
    }

    /// Calls `add` with the light that each of up to sixteen points lacks from each surface close to it. `irradiance`
    /// is the mean luminance at the points. Returns the irradiance at some of the surfaces; `None` if the lacking light
    /// is negligible. With a `seed`, the surfaces are lit by samples.
    pub fn lacking(
        &mut self,
        c: &Compensation,
        points: &[ClampedPoint],
        irradiance: f32,
        seed: Option<u32>,
        add: impl FnMut(usize, Lacking),
    ) -> Option<Vec<(SurfacePoint, Rgb)>> {
        self.trace(c, points);
        let mut lacking = [0.0; LANES];
        for (lane, near) in &self.met {
            // The threshold assumes that the surfaces met are lit like the points.
            let radiance = irradiance * luminance(near.weight) + luminance(near.emitted);
            lacking[*lane] += radiance * (PI / RAYS as f32);
        }
        if !lacking.iter().any(|&lacking| lacking > NEGLIGIBLE * irradiance) {
            return None;
        }
        let places = self.gather(c, points, irradiance, seed);
        self.interpolate(c, &places, add);
        Some(places)
    }

    /// Returns the work since the last call.
    pub fn take_counts(&mut self) -> CompensationCounts {
        let mut cuts = std::mem::take(&mut self.packet.counts);
        cuts += std::mem::take(&mut self.sampled.counts);
        CompensationCounts { cuts, ..std::mem::take(&mut self.counts) }
    }

    fn trace(&mut self, c: &Compensation, points: &[ClampedPoint]) {
        self.met.clear();
        let met = &mut self.met;
        self.counts.rays += short_rays::trace(c, points, RAYS, |lane, near| met.push((lane, near)));
    }

    /// Gathers irradiance at some of the surfaces met, chosen in proportion to their weights, by a cut or by samples of
    /// this `seed`. Its error is relative to the points' irradiance `baseline`, to which it is added.
    fn gather(
        &mut self,
        c: &Compensation,
        points: &[ClampedPoint],
        baseline: f32,
        seed: Option<u32>,
    ) -> Vec<(SurfacePoint, Rgb)> {
        // Surfaces of one mesh are neighbours in this order.
        let mut order: Vec<u32> = (0..self.met.len() as u32).collect();
        order.sort_by_key(|&i| (self.met[i as usize].1.surface.mesh, self.met[i as usize].0));
        let total: f32 = self.met.iter().map(|(_, near)| luminance(near.weight)).sum();
        if !(total > 0.0) {
            return Vec::new();
        }
        let met = |i: u32| &self.met[i as usize];
        let mut places = Vec::with_capacity(LANES);
        let mut edges = Vec::with_capacity(LANES);
        choose_evenly(order.iter().map(|&i| luminance(met(i).1.weight)), total, LANES, |i, _| {
            let (lane, near) = met(order[i]);
            let (position, geometric_normal) = (near.surface.position, near.surface.normal);
            places.push((SurfacePoint { position, normal: near.normal, geometric_normal }, Rgb::ZERO));
            edges.push(points[*lane].edges.saturating_sub(1));
        });
        let receiver = |((p, _), edges): (&(SurfacePoint, Rgb), &u16)| {
            Receiver::irradiance(p.position, p.geometric_normal, &Frame::from_normal(p.normal))
                .with_baseline(baseline)
                .with_edges(*edges)
        };
        self.receivers.set(places.iter().zip(&edges).map(receiver));
        let settings = CutSettings {
            epsilon: EPSILON,
            max_cut: MAX_CUT,
            clamp: Some(EPSILON),
            ..CutSettings::default()
        };
        let samples = seed.and_then(|seed| {
            let settings = SampledSettings { cut: &settings, samples: &SAMPLES, seed };
            self.sampled.gather(&c.transfer, &Engine::new(c.world), &self.receivers, &settings)
        });
        if let Some(sum) = samples {
            for ((_, irradiance), found) in places.iter_mut().zip(sum.radiance) {
                *irradiance = if found.is_finite() { found } else { Rgb::ZERO };
            }
            return places;
        }
        let cut = self.packet.gather(&c.transfer, &Engine::new(c.world), &self.receivers, &settings);
        for (lane, (_, irradiance)) in places.iter_mut().enumerate() {
            let gathered = limited(c, &cut, lane, baseline);
            *irradiance = if gathered.is_finite() { gathered } else { Rgb::ZERO };
        }
        places
    }

    /// Calls `add` with the light of each surface met, which is lit like the `places` near it.
    fn interpolate(
        &self,
        c: &Compensation,
        places: &[(SurfacePoint, Rgb)],
        mut add: impl FnMut(usize, Lacking),
    ) {
        let min_distance = 1e-6 * c.world.diagonal;
        for (lane, near) in &self.met {
            let reflected = near.weight * interpolated(places, near, min_distance * min_distance);
            let [reflected, emitted] =
                [reflected, near.emitted].map(|radiance| radiance * (PI / RAYS as f32));
            if (reflected + emitted).is_finite() {
                add(*lane, Lacking { near, reflected, emitted });
            }
        }
    }
}

/// Returns the mean irradiance of the places, weighted towards near places of similar orientation. Places that face the
/// other way, which may be on the other side of a wall, count as dark.
fn interpolated(places: &[(SurfacePoint, Rgb)], near: &NearSurface, min_sq: f32) -> Rgb {
    let (mut sum, mut weights) = (Rgb::ZERO, 0.0);
    for (place, irradiance) in places {
        let cos = place.normal.dot(near.normal);
        let facing = cos.max(0.0);
        let dist_sq = place.position.distance_squared(near.surface.position);
        let weight = (ASIDE + facing * facing) / (dist_sq + min_sq);
        sum += if cos > OPPOSITE { *irradiance * weight } else { Rgb::ZERO };
        weights += weight;
    }
    if weights > 0.0 { sum / weights } else { Rgb::ZERO }
}

/// Returns the points whose light of one origin, or of both, a cut has clamped.
fn clamped(origin: Option<Origin>, receivers: &ReceiverPacket, sum: &PacketSum) -> Vec<ClampedPoint> {
    let gathers = |of: Origin| origin.is_none_or(|origin| origin == of);
    let point = |lane: usize| {
        let r = receivers.get(lane);
        let has_base = luminance(r.base_brdf()) > 0.0;
        let (position, normal) = r.place();
        ClampedPoint {
            point: SurfacePoint { position, normal, geometric_normal: r.geometric_normal() },
            bound: if gathers(Origin::Indirect) { sum.clamps.bounds[lane] } else { f32::INFINITY },
            direct: gathers(Origin::Direct) && has_base,
            edges: r.edges(),
        }
    };
    (0..receivers.len()).map(point).collect()
}

/// Returns a function that adds the light reflected by the points' bases to `sum`, and its luminance to `found`.
fn reflect<'a>(
    receivers: &'a ReceiverPacket,
    sum: &'a mut PacketSum,
    found: &'a mut f64,
) -> impl FnMut(usize, Lacking) + 'a {
    |lane, Lacking { near, reflected, emitted }| {
        let r = receivers.get(lane);
        let factor = r.base_brdf() * r.coat_transmittance(near.surface.position - r.position());
        sum.radiance[lane] += factor * (reflected + emitted);
        *found += f64::from(luminance(factor * reflected));
    }
}

/// Returns the irradiance of a lane from a `cut`. No indirect cluster may give more than ε of the light to which it is
/// added. Otherwise a coarse cut would leave clusters whose representative happens to be next to the point.
fn limited(c: &Compensation, cut: &PacketCut, lane: usize, baseline: f32) -> Rgb {
    let sum = |limit: f32| {
        let given = cut.clusters.iter().map(|cluster| {
            let node = &c.transfer.trees.nodes[cluster.node as usize];
            let given = node.intensity * cluster.responses.get(lane);
            let max = match node.origin() {
                Origin::Direct => f32::INFINITY,
                Origin::Indirect => limit,
            };
            let y = luminance(given);
            if y > max { given * (max / y) } else { given }
        });
        given.sum::<Rgb>()
    };
    let mut irradiance = sum(f32::INFINITY);
    frozen_luminance(luminance(irradiance) + baseline, MAX_STEPS, |total| {
        irradiance = sum(EPSILON * total);
        luminance(irradiance) + baseline
    });
    irradiance
}

/// Returns the mean luminance of the irradiance of which the base alone would reflect this radiance.
fn mean_irradiance(receivers: &ReceiverPacket, radiance: &[Rgb; LANES]) -> f32 {
    let irradiance = |lane: usize| {
        let base = luminance(receivers.get(lane).base_brdf());
        (base > 0.0).then(|| luminance(radiance[lane]) / base)
    };
    let (sum, count) =
        (0..receivers.len()).filter_map(irradiance).fold((0.0, 0), |(sum, n), e| (sum + e, n + 1));
    sum / count.max(1) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use embree::Ray;
    use glam::Vec3;
    use scene::Camera;
    use world::testkit::*;

    #[test]
    fn light_on_one_side_of_a_sheet_says_nothing_of_the_other() {
        let mut scene = scene(Camera::default(), [1, 1]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        scene.meshes.push(quad(Vec3::ZERO, Vec3::X, Vec3::Y, grey));
        let origin = Vec3::new(0.3, 0.3, 1.0);
        let ray = Ray { origin, t_near: 0.0, direction: -Vec3::Z, t_far: f32::INFINITY };
        let surface = world(scene).intersect(&ray).expect("the sheet");
        let place = |normal| SurfacePoint { position: surface.position, normal, geometric_normal: Vec3::Z };
        let seen = |normal| NearSurface {
            surface,
            distance: 1.0,
            cos: 1.0,
            normal,
            weight: Rgb::ONE,
            emitted: Rgb::ZERO,
        };
        let places = [(place(Vec3::Z), Rgb::ONE)];
        assert_eq!(interpolated(&places, &seen(-Vec3::Z), 1e-12), Rgb::ZERO);
        let slanted = Vec3::new(0.6, 0.0, 0.8);
        for normal in [Vec3::Z, slanted, Vec3::X] {
            let error = interpolated(&places, &seen(normal), 1e-12) - Rgb::ONE;
            assert!(error.abs().max_element() < 1e-6, "{normal}");
        }
        let both = [(place(Vec3::Z), Rgb::ONE), (place(-Vec3::Z), Rgb::X)];
        assert!((interpolated(&both, &seen(-Vec3::Z), 1e-12) - Rgb::X).abs().max_element() < 2e-3);
    }
}
