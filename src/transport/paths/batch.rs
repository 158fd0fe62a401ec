//! Many paths traced together, an edge at a time, in packets of sixteen that are closed up after every edge.
//!
//! Edges of paths that end ([`Reach::ENDS`]) and only look for emitters are cheaper than others: those past the bounds
//! of all emitting surfaces are dropped, or where there is an environment, tested for occlusion alone.
//!
//! Deviations: Embree's packets change the last bits of a hit, never its meaning; since a batch always holds the
//! same paths in the same order, pictures do not depend on threads.

use super::packet::{Packet, Shadows, Stage};
use base::math::{Cone, LANES, Rgb, Vec3x16, first_lanes, lanes_in};
use base::sampling::Samplers16;
use embree::{Hits16, Ray, Rays16};
use glam::Vec3;
use std::mem;
use world::light::{Learned, Receivers16};
use world::material::{Bsdf, LobeSet};
use world::{Surface, World};

/// Surface that a chain of mirrors, glass and sharp lobes has led a path to, and that scatters light by other lobes;
/// not always on the side that is seen.
#[derive(Clone, Copy, Debug)]
pub struct ChainEnd<'w> {
    /// Index of the path in its batch.
    pub path: u32,
    /// The surface.
    pub surface: Surface,
    /// BSDF less the lobes that the chain follows.
    pub bsdf: Bsdf<'w>,
    /// Unit vector back along the edge.
    pub out: Vec3,
    /// Share of the radiance leaving along `out` that reaches the eye.
    pub throughput: Rgb,
    /// Length of the chain.
    pub distance: f32,
    /// Hash of the surfaces and lobes on the way: equal for paths that came the same way; 0 straight from the eye.
    pub way: u32,
    /// Edges from the eye; those before and behind a sheet that light passes straight count as one.
    pub depth: u32,
}

/// Edges scattered by diffuse surfaces at ends.
#[derive(Clone, Copy, Debug)]
pub struct ScatteredEdges {
    /// Share of them that is drawn towards mirrors and glass, in [0, 1).
    pub guided: f32,
    /// Share that is followed of those that only look for light that other surfaces send on, in (0, 1].
    pub blind: f32,
}

/// Light samples at a chain's end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightSamples {
    /// Their number, where the end is worth [`LightSamples::WORTH`].
    pub count: u32,
    /// Number of the first among those of the sequence by which light is sampled.
    pub first: u32,
}

impl LightSamples {
    /// One.
    pub const ONE: LightSamples = LightSamples { count: 1, first: 0 };
    /// Share of the radiance leaving an end that must reach the eye for more than one to be worth while.
    pub const WORTH: f32 = 0.5;
}

impl Default for ScatteredEdges {
    fn default() -> ScatteredEdges {
        ScatteredEdges { guided: 0.0, blind: 1.0 }
    }
}

/// The light that a batch finds along its paths.
pub trait Reach<'w> {
    /// True if paths end at the first surface that scatters by lobes which a chain does not follow: of the light that
    /// reaches it, only that is found which comes from emitters, by light samples and by one more edge, or by a
    /// specular lobe of the surface that this edge meets, from where the path is of full length: such light comes along
    /// no straight segment from a light or a virtual light. False for paths of full length from the eye.
    const ENDS: bool;

    /// True if of the light that reaches ends only that by specular lobes is wanted, and none that chains find.
    const ONLY_BY_SPECULAR_LOBES: bool = false;

    /// Returns the lobes that a chain follows besides delta lobes.
    fn followed(&self, bsdf: &Bsdf) -> LobeSet {
        bsdf.sharp_lobes()
    }

    /// Knowledge of the emitters by which they are sampled, if any.
    fn learned(&self) -> Option<&Learned> {
        None
    }

    /// The light samples at ends.
    fn light_samples(&self) -> LightSamples {
        LightSamples::ONE
    }

    /// The edges that are scattered at ends.
    fn edges(&self) -> ScatteredEdges {
        ScatteredEdges::default()
    }

    /// True if paths go on from the surface after a chain's end by lobes too sharp to pass for diffuse, as they do by
    /// delta lobes.
    fn goes_on_by_glossy_lobes(&self) -> bool {
        true
    }

    /// True if [`Reach::see`] is to be called.
    fn sees(&self) -> bool {
        false
    }

    /// Called with the [`World::guide_albedo`] of the first surface that each path meets, `None` of mirrors and glass,
    /// and with the shading normal on that side, if paths may go on from it; in an order that does not depend on
    /// threads.
    fn see(&mut self, _path: u32, _albedo: Option<Rgb>, _normal: Vec3) {}

    /// Called at every surface that ends a chain, in an order that does not depend on threads.
    fn end(&mut self, _end: &ChainEnd<'w>) {}

    /// Radiance that such a surface reflects of the light that is found otherwise than by paths.
    fn reflected(&mut self, _end: &ChainEnd<'w>) -> Rgb {
        Rgb::ZERO
    }

    /// Share of an emitter's light, of that radiance, that is for paths to find where it comes by delta lobes to a
    /// surface at the end of a chain of length `distance`; the rest is found otherwise.
    fn share_of_paths(&self, _radiance: Rgb, _distance: f32) -> f32 {
        1.0
    }
}

/// Rays traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
}

/// Paths in flight, and their contributions so far.
#[derive(Default)]
pub struct Batch {
    packets: Vec<Packet>,
    /// Paths in the packets; they fill the lanes from the first on.
    count: usize,
    shadows: Shadows,
    /// Edges that can find nothing but the environment, until they fill a packet; their number.
    outward: (Packet, usize),
    radiance: Vec<Rgb>,
}

impl Batch {
    /// Adds up to sixteen paths, of which none may be missing but in the last call before [`Batch::trace`]; their
    /// results follow those of the call before.
    pub fn push(&mut self, rays: Rays16, samplers: Samplers16, cone: Cone, count: usize) {
        self.packets.push(Packet::new(rays, samplers, cone, self.count as u32));
        self.count += count;
        self.radiance.resize(self.count, Rgb::ZERO);
    }

    /// Traces all paths to their ends, at most `max_depth` edges, and empties the batch.
    /// Returns the radiance that each finds.
    pub fn trace<'w, R: Reach<'w>>(
        &mut self,
        world: &'w World,
        max_depth: u32,
        reach: &mut R,
        counts: &mut Counts,
    ) -> std::vec::Drain<'_, Rgb> {
        if R::ONLY_BY_SPECULAR_LOBES {
            self.packets.iter_mut().for_each(|packet| packet.emission_throughput = Vec3x16::ZERO);
        }
        let mut depth = 1;
        while self.count > 0 {
            self.extend(world, [depth, max_depth], reach, counts);
            depth += 1;
        }
        self.packets.clear();
        self.radiance.drain(..)
    }

    /// Traces every path's edge and shades where it ends; paths that end are dropped, the others stay in order.
    fn extend<'w, R: Reach<'w>>(
        &mut self,
        world: &'w World,
        [depth, max_depth]: [u32; 2],
        reach: &mut R,
        counts: &mut Counts,
    ) {
        counts.rays += self.count as u64;
        let mut kept = 0;
        // Neighbours' rays to lamps go about the same way, those to a sky all ways.
        let coherent = depth == 1 && world.emitters.environment.is_none();
        let mut hits = Hits16::default();
        for index in 0..self.count.div_ceil(LANES) {
            let mut packet = self.packets[index].clone();
            let valid = first_lanes(self.count - index * LANES);
            let found = world.accel.closest_hit16(&packet.rays, valid, depth == 1, &mut hits);
            if !(depth == 1 && world.scene.hides_emitters) {
                self.escape(world, &packet, valid & !found, reach);
            }
            if found == 0 {
                continue;
            }
            hits.repeat(found.trailing_zeros() as usize, !found);
            let mut surfaces = world.surfaces(&hits);
            world.cover(&mut surfaces, &packet.rays.directions(), found, |lane| packet.cones[lane]);
            packet.add_emitted(world, &surfaces, found, reach, &mut self.radiance);
            let mut followed = if R::ENDS { found & packet.followed() } else { found };
            if R::ENDS {
                followed &= !packet.at(Stage::Scattered) | world.specular.lanes(&surfaces.mesh);
            }
            followed &= packet.may_go_on(depth, max_depth);
            if followed != 0 {
                let arrives = |segment: Option<&Ray>, radiance: Rgb, slot: u32| {
                    let Some(segment) = segment else {
                        self.radiance[slot as usize] += radiance;
                        return;
                    };
                    if self.shadows.push(segment, radiance, slot) {
                        self.shadows.trace(world, coherent, &mut self.radiance, counts);
                    }
                };
                let mut going_on = packet.scatter(world, &surfaces, depth, followed, reach, arrives);
                if R::ENDS {
                    let blind = reach.edges().blind;
                    let (kept, outward) = looked_along(world, &mut packet, going_on, (blind, depth));
                    going_on = kept;
                    self.look_outward(world, &packet, outward, reach, counts);
                }
                self.keep(&packet, going_on, &mut kept);
            }
        }
        self.shadows.trace(world, coherent, &mut self.radiance, counts);
        self.trace_outward(world, reach, counts);
        self.count = kept;
    }

    /// Stores the paths of a packet that go on behind the `kept` that were stored before.
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

    /// Adds the environment's light to the paths of a packet in the lanes of `sought` whose edges are free.
    fn look_outward<'w, R: Reach<'w>>(
        &mut self,
        world: &World,
        packet: &Packet,
        sought: u16,
        reach: &R,
        counts: &mut Counts,
    ) {
        if world.emitters.environment.is_none() {
            return;
        }
        for lane in lanes_in(sought) {
            let (outward, count) = &mut self.outward;
            outward.copy_lane(*count, packet, lane);
            *count += 1;
            if *count == LANES {
                self.trace_outward(world, reach, counts);
            }
        }
    }

    fn trace_outward<'w, R: Reach<'w>>(&mut self, world: &World, reach: &R, counts: &mut Counts) {
        if self.outward.1 == 0 {
            return;
        }
        let (mut outward, count) = mem::take(&mut self.outward);
        counts.shadow_rays += count as u64;
        let valid = first_lanes(count);
        let free = valid & !world.accel.occluded16(&outward.rays, valid, false);
        let throughput = &mut outward.emission_throughput;
        let attenuate = |lane, share| throughput.set(lane, throughput.get(lane) * share);
        world.transmittance16(&outward.rays, free, attenuate);
        self.escape(world, &outward, free, reach);
        self.outward.0 = outward;
    }

    /// Adds the environment's light to the paths of a packet that met nothing.
    fn escape<'w, R: Reach<'w>>(&mut self, world: &World, packet: &Packet, escaped: u16, reach: &R) {
        let Some(environment) = &world.emitters.environment else { return };
        if escaped == 0 {
            return;
        }
        let (origins, learned) = (packet.rays.origins(), reach.learned());
        let at = Receivers16 { position: &origins, normal: &packet.normal, learned };
        let choice = world.emitters.environment_choice(at);
        let guided = learned.and_then(|learned| learned.sky.as_ref()).map(|sky| (sky, &origins));
        let light = environment.radiance_pdf16(&packet.rays.directions(), escaped, guided);
        for lane in lanes_in(escaped) {
            let (radiance, pdf) = light[lane];
            let share = packet.share_of_paths(lane, radiance, reach);
            let weight = share * packet.weight_against(lane, pdf * choice[lane]);
            self.radiance[packet.slot[lane] as usize] +=
                packet.emission_throughput.get(lane) * radiance * weight;
        }
    }
}

/// Of the paths that go on, those whose edges are to be followed, and those whose edges can find nothing but the
/// environment. Of edges that are scattered at vertex `depth` and find no emitting surface, the share `blind` is
/// followed.
fn looked_along(world: &World, packet: &mut Packet, going_on: u16, (blind, depth): (f32, u32)) -> (u16, u16) {
    let sought = going_on & (packet.at(Stage::Scattered) | !packet.followed());
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
