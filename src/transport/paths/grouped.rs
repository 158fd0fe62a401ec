//! First vertices of paths that stop at diffuse surfaces, shaded in groups of lanes ([`Group`]): one BSDF and one
//! shading point a group, one packet of light samples for all groups, and one packet of shadow rays.
//!
//! Lane i takes its light sample from its own position, with its own random numbers, so that visibility and light are
//! sampled as finely as by single paths. The rules of vertices hold here, too (`vertex`).

use super::counts::RayCounts;
use super::groups::Group;
use super::guided::{Guided, LaneVertex};
use super::packet::{Packet, PathStage};
use super::policy::{ChainEnd, LightSamples, PathPolicy};
use super::vertex::{continue_cone, first_pair, next_class, segments};
use base::math::{F32x16, LANES, Rgb, Vec3x16, blend, lanes_in, mask_of};
use base::sampling::power_heuristic;
use world::light::{DirectSamples16, Receivers16};
use world::{Surfaces16, World, shadow};

/// Vertex number of first hits.
const FIRST: u32 = 1;

/// Vertices of a packet in groups.
pub(super) struct GroupedVertices<'a, 'w> {
    pub world: &'w World,
    pub surfaces: &'a Surfaces16,
    pub groups: &'a mut [Group<'w>],
    /// True if shadow rays of a packet are nearly parallel.
    pub coherent: bool,
    /// Maximum number of sheets that light samples pass.
    pub sheets: u32,
    /// Radiance of each path.
    pub radiance: &'a mut [Rgb],
    pub counts: &'a mut RayCounts,
}

/// One light sample in every lane.
#[derive(Clone, Copy)]
struct PacketLightSample<'a> {
    /// Number of the sample among those requested.
    sample: u32,
    requested: LightSamples,
    /// Lanes to sample.
    lit: u16,
    guided: &'a Guided,
}

/// Directions sampled at the vertices.
struct Sampled {
    direction: Vec3x16,
    throughput: Vec3x16,
    pdf: F32x16,
    goes_on: u16,
    /// Lanes that stay in the chain.
    in_chain: u16,
}

impl<'w> GroupedVertices<'_, 'w> {
    /// Samples light and the next directions. Turns the paths of the groups' lanes into their continuations and returns
    /// the lanes that continue.
    pub fn scatter<R: PathPolicy<'w>>(&mut self, packet: &mut Packet, policy: &mut R) -> u16 {
        let (mut all, mut smooth, mut lambert) = (0, 0, 0);
        for group in self.groups.iter_mut() {
            packet.normal.fill(&group.bits, group.normal);
            all |= group.lanes;
            smooth |= if group.bsdf.bsdf().has_smooth() { group.lanes } else { 0 };
            lambert |= if group.bsdf.is_lambert() { group.lanes } else { 0 };
            group.chained = policy.followed(group.bsdf.bsdf());
        }
        let guided = Guided {
            lanes: if policy.edges().guided > 0.0 { lambert } else { 0 },
            share: policy.edges().guided,
        };
        self.end_chains(packet, policy);
        let requested = policy.light_samples();
        packet.light_samples = [requested.count as f32; LANES];
        for sample in 0..requested.count {
            let step = PacketLightSample { sample, requested, lit: smooth, guided: &guided };
            if smooth != 0 {
                self.light(packet, step, policy);
            }
        }
        let sampled = self.sample(packet, all, &guided);
        self.go_on(packet, &sampled)
    }

    /// Passes the groups to `policy` as ends of chains and first surfaces, and adds the light that it knows of.
    fn end_chains<R: PathPolicy<'w>>(&mut self, packet: &Packet, policy: &mut R) {
        let surfaces = self.surfaces;
        for group in self.groups.iter() {
            let first = group.first();
            let mut surface = surfaces.get(first);
            surface.frame = group.frame;
            if policy.sees() {
                let albedo = self.world.guide_albedo(&surface, group.bsdf.bsdf(), group.out);
                policy.see(packet.slot[first], Some(albedo * group.len()), group.normal_sum);
            }
            let bsdf = group.bsdf.bsdf().without(group.chained);
            if !bsdf.has_smooth() {
                continue;
            }
            let end = |lane: usize, throughput: Rgb| ChainEnd {
                path: packet.slot[lane],
                surface,
                bsdf,
                out: group.out,
                throughput,
                distance: surfaces.t[lane],
                path_class: 0,
                depth: FIRST,
            };
            for lane in lanes_in(group.lanes) {
                if policy.looks_up(packet.slot[lane]) {
                    let mut end = end(lane, Rgb::ONE);
                    end.surface = surfaces.get(lane);
                    self.radiance[packet.slot[lane] as usize] += policy.reflected(&end);
                }
            }
            policy.end(&end(first, Rgb::splat(group.len())));
        }
    }

    /// Samples light once in every lane: an emitter, and a point on it.
    fn light<R: PathPolicy<'w>>(&mut self, packet: &Packet, step: PacketLightSample, policy: &R) {
        let (world, surfaces, pair) = (self.world, self.surfaces, first_pair(FIRST));
        let mut samplers = packet.samplers;
        if step.requested != LightSamples::ONE {
            for index in &mut samplers.index {
                *index = index
                    .wrapping_mul(step.requested.count)
                    .wrapping_add(step.requested.first.wrapping_add(step.sample));
            }
        }
        let at =
            Receivers16 { position: &surfaces.position, normal: &packet.normal, learned: policy.learned() };
        let (choices, places) = (samplers.number(pair + 2), samplers.point(pair));
        let lights = world.emitters.sample_direct(at, &choices, &places, step.lit);
        let useful = step.lit & lights.useful();
        if useful == 0 {
            return;
        }
        let (mut radiance, scattered) = self.reflected(packet, &lights, useful, step);
        let wanted = useful & scattered;
        let segments = segments(surfaces, &lights);
        self.counts.shadow_rays += u64::from(wanted.count_ones());
        let free = wanted & !world.accel.occluded16(&segments, wanted, self.coherent);
        world.transmittance16(&segments, free, self.sheets, |lane, share| {
            radiance.set(lane, radiance.get(lane) * share);
        });
        for lane in lanes_in(free) {
            self.radiance[packet.slot[lane] as usize] += radiance.get(lane);
        }
    }

    /// Returns the light of samples that the groups reflect towards the eye, and the lanes in which there is any.
    fn reflected(
        &self,
        packet: &Packet,
        lights: &DirectSamples16,
        useful: u16,
        step: PacketLightSample,
    ) -> (Vec3x16, u16) {
        let (mut value, mut pdf, mut cos) = (Vec3x16::default(), [0.0; LANES], [0.0; LANES]);
        for group in self.groups.iter().filter(|group| group.lanes & useful != 0) {
            let mut wi = Vec3x16::default();
            for i in 0..LANES {
                wi.set(i, group.frame.to_local(lights.direction.get(i)));
            }
            let (f, p) = group.bsdf.eval_pdf16(&wi);
            value.blend(&group.bits, &f);
            blend(&mut pdf, &group.bits, &p);
            blend(&mut cos, &group.bits, &wi.z);
        }
        for i in lanes_in(useful & step.guided.lanes) {
            let (x, n) = (self.surfaces.position.get(i), packet.normal.get(i));
            pdf[i] = step.guided.density(self.world, x, n, lights.direction.get(i), pdf[i]);
        }
        let count = step.requested.count as f32;
        let (mut radiance, mut scattered) = (Vec3x16::default(), [0; LANES]);
        for i in 0..LANES {
            let light_pdf = count * lights.pdf[i];
            let weight = if lights.delta[i] != 0 { 1.0 } else { power_heuristic(light_pdf, pdf[i]) };
            let value = value.get(i);
            radiance.set(i, value * lights.radiance.get(i) * (cos[i].abs() * weight / light_pdf));
            scattered[i] = u32::from((value.x != 0.0) | (value.y != 0.0) | (value.z != 0.0));
        }
        (radiance, mask_of(&scattered))
    }

    /// Samples the next directions in the lanes of `wanted`.
    fn sample(&self, packet: &Packet, wanted: u16, guided: &Guided) -> Sampled {
        let pair = first_pair(FIRST);
        let (choices, places) = (packet.samplers.point(pair + 2).y, packet.samplers.point(pair + 1));
        let mut sampled = Sampled {
            direction: Vec3x16::default(),
            throughput: Vec3x16::default(),
            pdf: [0.0; LANES],
            goes_on: 0,
            in_chain: 0,
        };
        for group in self.groups.iter().filter(|group| group.lanes & wanted != 0) {
            let lanes = group.lanes & wanted;
            let mut samples = group.bsdf.sample16(&choices, &places, lanes);
            for lane in lanes_in(lanes & guided.lanes) {
                let vertex = LaneVertex {
                    lane,
                    position: self.surfaces.position.get(lane),
                    normal: group.normal,
                    frame: group.frame,
                    bsdf: group.bsdf.bsdf(),
                    wo: group.bsdf.wo(),
                };
                guided.turn(self.world, &vertex, choices[lane], places.get(lane), &mut samples);
            }
            let (mut direction, mut throughput) = (Vec3x16::default(), samples.weight);
            for i in 0..LANES {
                direction.set(i, group.frame.to_world(samples.wi.get(i)));
            }
            if !group.chained.is_empty() {
                let values = group.bsdf.eval_lobes16(group.chained, &samples.wi);
                let draws = packet.samplers.point(pair + 3).y;
                for lane in lanes_in(lanes & samples.going_on()) {
                    let weight = samples.weight.get(lane);
                    let value = weight * (samples.pdf[lane] / samples.wi.z[lane].abs());
                    let share = values.get(lane) / value.max(Rgb::splat(f32::MIN_POSITIVE));
                    let stays = share.max_element().min(1.0);
                    let factor = match draws[lane] < stays {
                        true => share / stays,
                        false => (Rgb::ONE - share).max(Rgb::ZERO) / (1.0 - stays),
                    };
                    sampled.in_chain |= u16::from(draws[lane] < stays) << lane;
                    throughput.set(lane, weight * factor);
                }
            }
            sampled.direction.blend(&group.bits, &direction);
            sampled.throughput.blend(&group.bits, &throughput);
            blend(&mut sampled.pdf, &group.bits, &samples.pdf);
            sampled.goes_on |= lanes & samples.going_on();
        }
        sampled
    }

    /// Turns the paths into their continuations along the sampled directions. Returns the lanes that continue.
    fn go_on(&self, packet: &mut Packet, sampled: &Sampled) -> u16 {
        let (world, surfaces) = (self.world, self.surfaces);
        let mut found = sampled.goes_on;
        packet.throughput = sampled.throughput;
        packet.emission_throughput = sampled.throughput;
        packet.pdf = sampled.pdf;
        for lane in lanes_in(found) {
            packet.distance[lane] += surfaces.t[lane];
            if sampled.in_chain >> lane & 1 == 0 {
                packet.stage[lane] = PathStage::Scattered as u32;
            } else {
                packet.path_class[lane] =
                    next_class(packet.path_class[lane], [true, false], surfaces.mesh[lane]);
            }
        }
        let blind = if world.emitters.are_hittable() { 0 } else { found & !sampled.in_chain };
        if world.specular.bends_light() {
            packet.emission_throughput.keep(!blind);
        } else {
            found &= !blind;
        }
        if world.filters_textures() {
            for lane in lanes_in(found) {
                continue_cone(&mut packet.cones[lane], sampled.pdf[lane], surfaces.t[lane]);
            }
        }
        for i in 0..LANES {
            let ray =
                shadow::ray_from(surfaces.position.get(i), surfaces.normal.get(i), sampled.direction.get(i));
            packet.rays.set(i, &ray);
        }
        found
    }
}
