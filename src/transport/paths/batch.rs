//! Many paths traced together, one edge at a time, in packets of sixteen that are compacted after every edge.
//!
//! Paths that stop at diffuse surfaces ([`PathPolicy::STOPS_AT_DIFFUSE`]) trace a last edge that only looks for
//! emitters. Such an edge is dropped if it misses the bounds of all emitting surfaces. If there is an environment, the
//! edge is tested for occlusion alone.
//!
//! Deviations: Embree's packets change the last bits of a hit, never its meaning. A batch always holds the same paths
//! in the same order, so that images do not depend on threads.

use super::found_light::{FoundLight, RayCounts, ShadowPacket};
use super::groups::{FirstHits16, collect};
use super::packet::{Packet, PathStage};
use super::policy::PathPolicy;
use super::vertices::{GroupLanes, Seen16, Vertices};
use base::math::{Cone, LANES, Rgb, U32x16, Vec3x16, first_lanes, lanes_in};
use base::sampling::Samplers16;
use embree::{Hits16, Rays16};
use std::mem;
use world::light::Receivers16;
use world::{Surfaces16, World};

/// Paths in flight, and their contributions so far.
#[derive(Default)]
pub struct Batch {
    packets: Vec<Packet>,
    /// Number of paths in the packets. Behind the first edge they fill all lanes from the first on.
    count: usize,
    /// Lanes of each packet that hold paths at their first edge, with numbers that tell their pixels apart.
    first: Vec<(u16, U32x16)>,
    /// Segments to lights that wait for a full packet, and their number.
    shadows: (ShadowPacket, usize),
    /// Edges that can find only the environment, until they fill a packet, and their number.
    outward: (Packet, usize),
    radiance: Vec<Rgb>,
}

impl Batch {
    /// Adds up to sixteen paths. Their results follow those of the call before. Numbers in `pixels` tell the paths'
    /// pixels apart.
    pub fn push(&mut self, rays: Rays16, samplers: Samplers16, pixels: U32x16, cone: Cone, count: usize) {
        self.packets.push(Packet::new(rays, samplers, cone, self.count as u32));
        self.first.push((first_lanes(count), pixels));
        self.count += count;
        self.radiance.resize(self.count, Rgb::ZERO);
    }

    /// Traces all paths to their ends, at most `max_depth` edges, and empties the batch. Returns the radiance that
    /// each path finds.
    pub fn trace<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &'w World,
        max_depth: u32,
        policy: &mut R,
        counts: &mut RayCounts,
    ) -> std::vec::Drain<'_, Rgb> {
        if !R::STOPS_AT_DIFFUSE {
            self.packets.iter_mut().for_each(|packet| packet.stage = [PathStage::Bent as u32; LANES]);
        }
        if R::ONLY_BY_SPECULAR_LOBES {
            self.packets.iter_mut().for_each(|packet| packet.emission_throughput = Vec3x16::ZERO);
        }
        let mut depth = 1;
        while self.count > 0 {
            match policy.group_spacing() {
                Some(spacing) if depth == 1 => {
                    self.extend_in_groups(world, max_depth, spacing, policy, counts);
                }
                _ => self.extend(world, [depth, max_depth], policy, counts),
            }
            depth += 1;
        }
        self.packets.clear();
        self.first.clear();
        self.radiance.drain(..)
    }

    /// Traces one edge of every path and shades its end. Paths that end are dropped; the others stay in order.
    fn extend<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &'w World,
        [depth, max_depth]: [u32; 2],
        policy: &mut R,
        counts: &mut RayCounts,
    ) {
        counts.rays += self.count as u64;
        let (mut kept, mut hits) = (0, Hits16::default());
        let packets = if depth == 1 { self.packets.len() } else { self.count.div_ceil(LANES) };
        for index in 0..packets {
            let mut packet = self.packets[index].clone();
            let valid =
                if depth == 1 { self.first[index].0 } else { first_lanes(self.count - index * LANES) };
            let hit_lanes = self.hit(world, &packet, valid, depth, policy, &mut hits);
            if hit_lanes == 0 {
                continue;
            }
            let surfaces = covered(world, &packet, &mut hits, hit_lanes);
            packet.arrive(world, &surfaces, hit_lanes, policy, &mut self.radiance);
            let edge = Edge { depth, max_depth, kept: &mut kept };
            self.scatter(world, &mut packet, Hit { surfaces: &surfaces, hit_lanes }, edge, policy, counts);
        }
        self.finish(world, Edge { depth, max_depth, kept: &mut kept }, policy, counts);
    }

    /// Traces the first edges and shades their ends in groups. Surfaces with mirrors, glass or gaps are shaded one by
    /// one, and gathered beforehand so that packets are full.
    fn extend_in_groups<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &'w World,
        max_depth: u32,
        spacing: f32,
        policy: &mut R,
        counts: &mut RayCounts,
    ) {
        counts.rays += self.count as u64;
        let (mut kept, mut hits) = (0, Hits16::default());
        let (mut single, mut groups) = (SingleHits::default(), Vec::with_capacity(LANES));
        for index in 0..self.packets.len() {
            let mut packet = self.packets[index].clone();
            let (valid, pixel) = self.first[index];
            let hit_lanes = self.hit(world, &packet, valid, 1, policy, &mut hits);
            if hit_lanes == 0 {
                continue;
            }
            let surfaces = covered(world, &packet, &mut hits, hit_lanes);
            packet.arrive(world, &surfaces, hit_lanes, policy, &mut self.radiance);
            if max_depth <= 1 {
                continue;
            }
            let grouped = hit_lanes & world.with_densities_alone(&surfaces.mesh);
            for lane in lanes_in(hit_lanes & !grouped) {
                if single.push(&packet, &hits, lane) {
                    let edge = Edge { depth: 1, max_depth, kept: &mut kept };
                    self.scatter_single(world, &mut single, edge, policy, counts);
                }
            }
            if grouped == 0 {
                continue;
            }
            let directions = packet.rays.directions();
            let surfaces = &surfaces;
            let first = FirstHits16 { surfaces, directions: &directions, pixel: &pixel, spacing };
            collect(world, &first, grouped, &mut groups);
            let edge = Edge { depth: 1, max_depth, kept: &mut kept };
            let lanes = GroupLanes::new(&groups);
            let GroupLanes { bsdfs, normal, found, .. } = &lanes;
            let (axes, chained) = (lanes.axes.each_ref(), Default::default());
            let (depth, found, normal, glossy) = (edge.depth, *found, *normal, 0);
            let mut vertices =
                Vertices { world, surfaces, depth, found, bsdfs, axes, normal, glossy, chained };
            let mut light = FoundLight { at_once: true, ..self.light(world, &edge, counts) };
            vertices.end_chains_of_groups(&packet, &groups, policy, &mut light);
            let going_on = packet.scatter(&vertices, policy, &mut light);
            self.go_on(world, &mut packet, going_on, edge, policy, counts);
        }
        let edge = Edge { depth: 1, max_depth, kept: &mut kept };
        self.scatter_single(world, &mut single, edge, policy, counts);
        self.finish(world, Edge { depth: 1, max_depth, kept: &mut kept }, policy, counts);
    }

    /// Traces the edges of a packet and adds the light of those that hit nothing. Returns the lanes with hits.
    fn hit<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &World,
        packet: &Packet,
        valid: u16,
        depth: u32,
        policy: &R,
        hits: &mut Hits16,
    ) -> u16 {
        let hit_lanes = world.accel.closest_hit16(&packet.rays, valid, depth == 1, hits);
        let hidden = match &world.scene {
            scene if scene.hides_background => packet.on_eye_ray(depth),
            scene if scene.hides_emitters && depth == 1 => u16::MAX,
            _ => 0,
        };
        self.escape(world, packet, valid & !hit_lanes & !hidden, policy);
        hit_lanes
    }

    /// Shades hits that were gathered.
    fn scatter_single<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &'w World,
        single: &mut SingleHits,
        edge: Edge,
        policy: &mut R,
        counts: &mut RayCounts,
    ) {
        let hit_lanes = first_lanes(mem::take(&mut single.count));
        if hit_lanes != 0 {
            let surfaces = covered(world, &single.packet, &mut single.hits, hit_lanes);
            let hit = Hit { surfaces: &surfaces, hit_lanes };
            self.scatter(world, &mut single.packet, hit, edge, policy, counts);
        }
    }

    /// Shades the hits of a packet one by one and stores the paths that continue.
    fn scatter<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &'w World,
        packet: &mut Packet,
        Hit { surfaces, hit_lanes }: Hit,
        edge: Edge,
        policy: &mut R,
        counts: &mut RayCounts,
    ) {
        let mut followed = hit_lanes & packet.followed();
        followed &= !packet.at(PathStage::Scattered) | world.specular.lanes(&surfaces.mesh);
        if followed == 0 || edge.depth >= edge.max_depth {
            return;
        }
        let Seen16 { wo, normal } = packet.seen(surfaces);
        let mut bsdfs = world.bsdfs(surfaces, wo);
        followed =
            packet.end_by_photons(surfaces, &mut bsdfs, (followed, edge.depth), policy, &mut self.radiance);
        if followed == 0 {
            return;
        }
        let glossy = packet.keep_glossy(&mut bsdfs, followed, policy);
        let axes = [&surfaces.tangent, &surfaces.bitangent, &surfaces.shading_normal];
        let (depth, found, bsdfs, chained) = (edge.depth, followed, &bsdfs, Default::default());
        let mut vertices = Vertices { world, surfaces, depth, found, bsdfs, axes, normal, glossy, chained };
        let mut light = self.light(world, &edge, counts);
        vertices.end_chains(packet, policy, &mut light);
        let going_on = packet.scatter(&vertices, policy, &mut light);
        self.go_on(world, packet, going_on, edge, policy, counts);
    }

    /// Returns the light of the paths at the vertices of an edge.
    fn light<'a>(&'a mut self, world: &'a World, edge: &Edge, counts: &'a mut RayCounts) -> FoundLight<'a> {
        let coherent = are_coherent(world, edge.depth);
        let (radiance, waiting, sheets) = (&mut self.radiance[..], &mut self.shadows, edge.sheets());
        FoundLight { world, radiance, waiting, counts, coherent, sheets, at_once: false }
    }

    /// Stores the paths of a packet that continue. Edges that can find only emitters are dropped or tested for
    /// occlusion alone.
    fn go_on<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &World,
        packet: &mut Packet,
        mut going_on: u16,
        edge: Edge,
        policy: &R,
        counts: &mut RayCounts,
    ) {
        if R::STOPS_AT_DIFFUSE {
            let blind = policy.edges().blind;
            let (traced, outward) = split_edges(world, packet, going_on, blind, edge.depth);
            going_on = traced;
            if world.emitters.environment.is_some() {
                self.add_outward(world, (packet, outward), edge.sheets(), policy, counts);
            }
        }
        self.keep(packet, going_on, edge.kept);
    }

    /// Traces the rays that still wait for a full packet.
    fn finish<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &World,
        edge: Edge,
        policy: &R,
        counts: &mut RayCounts,
    ) {
        self.light(world, &edge, counts).finish();
        self.trace_outward(world, edge.sheets(), policy, counts);
        self.count = *edge.kept;
    }

    /// Stores the paths of a packet that continue, behind the `kept` paths stored before.
    fn keep(&mut self, packet: &Packet, going_on: u16, kept: &mut usize) {
        if going_on == u16::MAX && kept.is_multiple_of(LANES) {
            self.packets[*kept / LANES].clone_from(packet);
            *kept += LANES;
            return;
        }
        for lane in lanes_in(going_on) {
            self.packets[*kept / LANES].copy_lane(*kept % LANES, packet, lane);
            *kept += 1;
        }
    }

    /// Adds the environment's light to the paths of a packet in the lanes of `sought` whose edges are unoccluded and
    /// pass at most `sheets` sheets.
    fn add_outward<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &World,
        (packet, sought): (&Packet, u16),
        sheets: u32,
        policy: &R,
        counts: &mut RayCounts,
    ) {
        for lane in lanes_in(sought) {
            let (outward, count) = &mut self.outward;
            outward.copy_lane(*count, packet, lane);
            *count += 1;
            if *count == LANES {
                self.trace_outward(world, sheets, policy, counts);
            }
        }
    }

    fn trace_outward<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &World,
        sheets: u32,
        policy: &R,
        counts: &mut RayCounts,
    ) {
        if self.outward.1 == 0 {
            return;
        }
        let (mut outward, count) = mem::take(&mut self.outward);
        counts.shadow_rays += count as u64;
        let valid = first_lanes(count);
        let free = valid & !world.accel.occluded16(&outward.rays, valid, false);
        world.attenuate(&outward.rays, free, |_| Some(sheets), &mut outward.emission_throughput);
        self.escape(world, &outward, free, policy);
        self.outward.0 = outward;
    }

    /// Adds the environment's light to the paths of a packet that hit nothing.
    fn escape<'w, R: PathPolicy<'w>>(&mut self, world: &World, packet: &Packet, escaped: u16, policy: &R) {
        let Some(environment) = &world.emitters.environment else { return };
        if escaped == 0 {
            return;
        }
        let (origins, learned) = (packet.rays.origins(), policy.learned());
        let at = Receivers16 { position: &origins, normal: &packet.normal, learned };
        let choice = world.emitters.environment_choice(at);
        let light = environment.radiance_pdf16(&packet.rays.directions(), escaped, at.sky());
        for lane in lanes_in(escaped) {
            let (radiance, pdf) = light[lane];
            let share = packet.share_of_paths(lane, radiance, policy);
            let weight = share * packet.weight_against(lane, pdf * choice[lane]);
            self.radiance[packet.slot[lane] as usize] +=
                packet.emission_throughput.get(lane) * radiance * weight;
        }
    }
}

/// Hits that are shaded one by one, gathered from several packets.
#[derive(Default)]
struct SingleHits {
    packet: Packet,
    hits: Hits16,
    count: usize,
}

impl SingleHits {
    /// Adds a lane of a packet. Returns true if all lanes are taken.
    fn push(&mut self, packet: &Packet, hits: &Hits16, lane: usize) -> bool {
        self.packet.copy_lane(self.count, packet, lane);
        self.hits.copy_lane(self.count, hits, lane);
        self.count += 1;
        self.count == LANES
    }
}

/// Surfaces that a packet has hit in the lanes of `hit_lanes`.
struct Hit<'a> {
    surfaces: &'a Surfaces16,
    hit_lanes: u16,
}

/// Number of the edge that is traced, and of paths stored so far behind it.
struct Edge<'a> {
    depth: u32,
    max_depth: u32,
    kept: &'a mut usize,
}

impl Edge<'_> {
    /// Returns the number of sheets that light may pass on one more edge. Each begins an edge of its own.
    fn sheets(&self) -> u32 {
        self.max_depth.saturating_sub(self.depth).saturating_sub(1)
    }
}

/// Returns true if the shadow rays of a packet at the end of edge `depth` are about parallel: neighbours' rays to small
/// lamps are, rays to a sky or a large lamp are not.
fn are_coherent(world: &World, depth: u32) -> bool {
    depth == 1 && world.emitters.send_from_few_directions()
}

/// Returns the surfaces that a packet has hit in the lanes of `hit_lanes`, with the footprints of its rays.
fn covered(world: &World, packet: &Packet, hits: &mut Hits16, hit_lanes: u16) -> Surfaces16 {
    hits.repeat(hit_lanes.trailing_zeros() as usize, !hit_lanes);
    let directions = packet.rays.directions();
    let mut surfaces = world.surfaces_along(hits, &directions);
    world.cover(&mut surfaces, &directions, hit_lanes, |lane| packet.cones[lane]);
    surfaces
}

/// Returns, among the paths that continue, those whose edges are to be traced, and those whose edges can find only the
/// environment. The share `blind` is traced of edges that are scattered at vertex `depth` and miss all emitting
/// surfaces.
fn split_edges(world: &World, packet: &mut Packet, going_on: u16, blind: f32, depth: u32) -> (u16, u16) {
    let sought = going_on & (packet.at(PathStage::Scattered) | !packet.followed());
    if sought == 0 {
        return (going_on, 0);
    }
    let (origins, directions) = (packet.rays.origins(), packet.rays.directions());
    let mut met = world.emitters.may_be_met(&origins, &directions);
    let mut seeing = u16::MAX;
    if world.specular.bends_light() {
        seeing = packet.sees_emitters();
        met &= seeing;
        let sent_on = sought & !met & packet.followed() & world.specular.may_be_met(&origins, &directions);
        met |= sent_on & !packet.thin(sent_on, blind, depth);
    }
    (going_on & (!sought | met), sought & seeing & !met)
}
