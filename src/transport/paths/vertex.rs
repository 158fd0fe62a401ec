//! Sixteen vertices of paths: their direct light, and the next edges.
//!
//! Paths arrive (`arrival`), find the BSDFs of their lanes ([`Vertices`]), and chains may end (`chain_ends`). Then
//! light is sampled, a direction is chosen, and paths go on. The stage of a path ([`PathStage`]) is the light that it
//! still looks for:
//!
//! | stage on arrival | light samples | goes on by |
//! |---|---|---|
//! | `Chain` | of all lobes | chained lobes as `Chain`, other lobes as `Scattered` |
//! | `Scattered` | of glossy lobes | delta lobes as `Bent`, glossy lobes as `Full` |
//! | `Bent` | of all lobes | delta lobes as `Bent`, other lobes as `Full` |
//! | `Full` | of all lobes | all lobes as `Full` |
//!
//! With [`PathPolicy::path_ends`], `Bent` and `Full` paths find the light of diffuse lobes by photons. They sample
//! light and go on by the other lobes alone. Paths that do not stop at diffuse surfaces are `Bent` from the eye on, and
//! end so as `Full` paths alone.
//!
//! So a path that stops at the first surface which ends a chain ([`PathPolicy`]) has one more edge, which finds
//! emitters: the counterpart of the light samples in multiple importance sampling. If that edge hits a mirror, glass or
//! a glossy lobe, the path continues by this lobe alone, since virtual lights carry the other lobes.
//!
//! Paper: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapters 9 and 10.
//! Deviations: a path survives Russian roulette with the square root of its throughput, from the second vertex on. The
//! throughput itself would end paths between dark walls so often that the few that then hit the sun are fireflies.

use super::found_light::{FoundLight, ShadowPacket};
use super::guided::Guided;
use super::packet::{Packet, PathStage};
use super::policy::{LightSamples, PathPolicy};
use super::vertices::Vertices;
use base::math::{Cone, F32x16, LANES, Rgb, Vec2x16, Vec3x16, lanes_in, mask_of};
use base::sampling::{Samplers16, power_heuristic};
use embree::Rays16;
use world::light::{DirectSamples16, Learned, Receivers16};
use world::material::BsdfSamples16;
use world::{Surfaces16, beyond, shadow};

/// Vertex number, counted from the eye, from which on Russian roulette may end a path.
const ROULETTE_DEPTH: u32 = 2;

/// Maximum probability of survival.
const MAX_SURVIVAL: f32 = 0.95;

/// Minimum density by solid angle of directions whose lobe shows images (GGX with α 0.2). Broader lobes average the
/// texture that they see.
const MIN_DENSITY_OF_IMAGES: f32 = 2.0;

/// Pairs of random numbers before the first vertex: the position in the pixel.
const PAIRS_BEFORE: u32 = 1;

/// Pairs of random numbers per vertex: for the light, for the direction, for the choices of emitter and lobe, and for
/// Russian roulette.
const PAIRS_PER_VERTEX: u32 = 4;

/// Lanes of a packet by what they do at their vertices.
struct Roles {
    /// Lanes at ends of chains.
    at_end: u16,
    /// Lanes behind a chain's end.
    scattered: u16,
    /// Lanes that sample light.
    lit: u16,
    /// Lanes that take all light samples that the policy asks for.
    many: u16,
    /// Numbers of light samples.
    light_samples: F32x16,
    /// Lanes that may aim directions at mirrors and glass.
    guided: Guided,
}

/// One light sample in some lanes.
struct LightStep<'a> {
    lanes: u16,
    /// Random numbers that choose emitters.
    u_choice: F32x16,
    /// Random numbers that choose points on them.
    u_place: Vec2x16,
    learned: Option<&'a Learned>,
}

/// Returns the index of the first pair of random numbers of vertex `depth`.
fn first_pair(depth: u32) -> u32 {
    PAIRS_BEFORE + 1 + (depth - 1).wrapping_mul(PAIRS_PER_VERTEX)
}

impl Packet {
    /// Samples light and the next directions at vertices, and adds to `light` what arrives. Turns the paths into their
    /// continuations and returns the lanes that continue.
    #[inline]
    pub fn scatter<'w, R: PathPolicy<'w>>(
        &mut self,
        at: &Vertices,
        policy: &R,
        light: &mut FoundLight,
    ) -> u16 {
        let (roles, pair) = (self.roles(at, policy), first_pair(at.depth));
        let (requested, mut lanes) = (policy.light_samples(), roles.lit);
        let choices = self.samplers.point(pair + 2);
        for sample in 0..requested.count {
            if lanes != 0 {
                let samplers = self.light_samplers(&roles, requested, sample);
                let u_choice = if roles.many == 0 { choices.x } else { samplers.number(pair + 2) };
                let step =
                    LightStep { lanes, u_choice, u_place: samplers.point(pair), learned: policy.learned() };
                self.sample_light(at, &roles, &step, light);
            }
            lanes &= roles.many;
        }
        let samples = self.choose(at, &roles.guided, &choices.y);
        self.go_on::<R>(at, &roles, &samples)
    }

    /// Divides the lanes by what they do.
    #[inline]
    fn roles<'w, R: PathPolicy<'w>>(&self, at: &Vertices, policy: &R) -> Roles {
        let [at_end, scattered] =
            [PathStage::Chain, PathStage::Scattered].map(|stage| at.found & self.at(stage));
        // Virtual lights carry the light of other lobes behind a chain's end.
        let unlit = (scattered & !at.glossy) | if R::ONLY_BY_SPECULAR_LOBES { at_end } else { 0 };
        let lit = at.bsdfs.smooth() & at.found & !unlit;
        let requested = policy.light_samples();
        let many = if requested == LightSamples::ONE { 0 } else { lit & at_end };
        let mut light_samples = [1.0; LANES];
        lanes_in(many).for_each(|lane| light_samples[lane] = requested.count as f32);
        let share = if at_end != 0 { policy.edges().guided } else { 0.0 };
        let guided = Guided { lanes: if share > 0.0 { at_end & at.bsdfs.lambertian() } else { 0 }, share };
        Roles { at_end, scattered, lit, many, light_samples, guided }
    }

    /// Returns the generators of a light sample. Lanes that take many divide their sequences among them.
    #[inline]
    fn light_samplers(&self, roles: &Roles, requested: LightSamples, sample: u32) -> Samplers16 {
        let mut samplers = self.samplers;
        for lane in lanes_in(roles.many) {
            let first = samplers.index[lane].wrapping_mul(requested.count);
            samplers.index[lane] = first.wrapping_add(requested.first.wrapping_add(sample));
        }
        samplers
    }

    /// Samples an emitter in some lanes, and a point on it: next-event estimation.
    #[inline]
    fn sample_light(&self, at: &Vertices, roles: &Roles, step: &LightStep, light: &mut FoundLight) {
        let (world, surfaces) = (at.world, at.surfaces);
        let receivers =
            Receivers16 { position: &surfaces.position, normal: &at.normal, learned: step.learned };
        let lights = world.emitters.sample_direct(receivers, &step.u_choice, &step.u_place, step.lanes);
        let wanted = step.lanes & lights.useful();
        if wanted == 0 {
            return;
        }
        let wi = at.to_local(&lights.direction);
        let (value, mut pdf) = at.bsdfs.eval_pdf(&wi, wanted);
        for i in lanes_in(wanted & roles.guided.lanes) {
            let (x, n) = (surfaces.position.get(i), at.normal.get(i));
            pdf[i] = roles.guided.density(world, x, n, lights.direction.get(i), pdf[i]);
        }
        // Throughput · BSDF · radiance · cos / pdf, weighted against the density of the BSDF's own samples.
        let (mut radiance, mut scattered) = (Vec3x16::default(), [0; LANES]);
        for i in 0..LANES {
            let light_pdf = roles.light_samples[i] * lights.pdf[i];
            let weight = if lights.delta[i] != 0 { 1.0 } else { power_heuristic(light_pdf, pdf[i]) };
            let value = value.get(i);
            let factor = wi.z[i].abs() * weight / light_pdf;
            radiance.set(i, self.throughput.get(i) * value * lights.radiance.get(i) * factor);
            scattered[i] = u32::from((value.x != 0.0) | (value.y != 0.0) | (value.z != 0.0));
        }
        if world.absorbs() {
            for i in lanes_in(wanted) {
                let share = world.share_from(&surfaces.get(i), lights.direction.get(i), lights.distance[i]);
                radiance.set(i, radiance.get(i) * share);
            }
        }
        let packet = ShadowPacket { rays: segments(surfaces, &lights), radiance, slot: self.slot };
        light.test(packet, wanted & mask_of(&scattered));
    }

    /// Samples the next directions by the BSDFs, or by a mixture with directions aimed at mirrors and glass.
    #[inline]
    fn choose(&self, at: &Vertices, guided: &Guided, choices: &F32x16) -> BsdfSamples16 {
        let places = self.samplers.point(first_pair(at.depth) + 1);
        let mut samples = at.bsdfs.sample(choices, &places, at.found);
        for lane in lanes_in(guided.lanes) {
            guided.turn(at.world, &at.lane(lane), choices[lane], places.get(lane), &mut samples);
        }
        samples
    }

    /// Turns the paths into their continuations along sampled directions. Returns the lanes that continue.
    #[inline]
    fn go_on<'w, R: PathPolicy<'w>>(&mut self, at: &Vertices, roles: &Roles, samples: &BsdfSamples16) -> u16 {
        let (world, pair) = (at.world, first_pair(at.depth));
        let (delta, straight) = (samples.delta(), samples.straight());
        let before = (at.found & straight != 0).then(|| self.clone());
        let (survivals, survives) = self.survive(at.depth, samples);
        for i in 0..LANES {
            self.throughput.set(i, self.throughput.get(i) * samples.weight.get(i) / survivals[i]);
        }
        // The edge finds emitters by all lobes, whether the path then stays in its chain or not.
        self.emission_throughput = self.throughput;
        let mut found = at.found & samples.going_on() & survives;
        // Behind a chain's end, only glossy and delta lobes go on.
        found &= !roles.scattered | delta | at.glossy;
        self.leave_chains(at, samples, found & roles.at_end, pair + 3);
        // Edges that have left a chain need not be traced if nothing can be found.
        let in_chain = self.at(PathStage::Chain);
        let blind = if world.emitters.are_hittable() { 0 } else { found & roles.at_end & !in_chain };
        if world.specular.bends_light() {
            self.emission_throughput.keep(!blind);
        } else {
            found &= !blind;
        }
        let narrow = if R::STOPS_AT_DIFFUSE { delta } else { narrow(samples) };
        self.enter_stages(found, roles.scattered, [delta, narrow, straight]);
        if R::ONLY_BY_SPECULAR_LOBES {
            self.emission_throughput.keep(self.at(PathStage::Full) | self.at(PathStage::Bent));
        }
        self.leave(at, roles, samples, found);
        if let Some(before) = before {
            for lane in lanes_in(found & straight) {
                self.pass_sheet(at, lane, &before, samples.weight.get(lane) / survivals[lane]);
            }
        }
        self.enter(world, at.surfaces, found, straight);
        found
    }

    /// Plays Russian roulette. Returns the probabilities of survival, and the lanes that survive.
    #[inline]
    fn survive(&mut self, depth: u32, samples: &BsdfSamples16) -> (F32x16, u16) {
        for i in 0..LANES {
            self.eta_sq[i] *= samples.eta[i] * samples.eta[i];
        }
        if depth < ROULETTE_DEPTH {
            return ([1.0; LANES], u16::MAX);
        }
        let numbers = self.samplers.number(first_pair(depth) + 3);
        let (mut survivals, mut survives) = ([0.0; LANES], [0; LANES]);
        for i in 0..LANES {
            let throughput = self.throughput.get(i) * samples.weight.get(i);
            survivals[i] = (throughput.max_element() * self.eta_sq[i]).sqrt().min(MAX_SURVIVAL);
            survives[i] = u32::from(numbers[i] < survivals[i]);
        }
        (survivals, mask_of(&survives))
    }

    /// Moves paths that go on to their next stages.
    #[inline]
    fn enter_stages(&mut self, found: u16, scattered: u16, [delta, narrow, straight]: [u16; 3]) {
        let spread = found & self.at(PathStage::Bent) & !narrow;
        lanes_in(spread).for_each(|lane| self.stage[lane] = PathStage::Full as u32);
        for lane in lanes_in(found & scattered & !straight) {
            let bent = delta >> lane & 1 != 0;
            self.stage[lane] = if bent { PathStage::Bent } else { PathStage::Full } as u32;
        }
    }

    /// Begins the next edges.
    #[inline]
    fn leave(&mut self, at: &Vertices, roles: &Roles, samples: &BsdfSamples16, found: u16) {
        let surfaces = at.surfaces;
        let directions = at.to_world(&samples.wi);
        for i in 0..LANES {
            let (position, normal) = (surfaces.position.get(i), surfaces.normal.get(i));
            self.rays.set(i, &shadow::ray_from(position, normal, directions.get(i)));
        }
        if at.world.filters_textures() {
            for i in lanes_in(found) {
                continue_cone(&mut self.cones[i], samples.pdf[i], surfaces.t[i]);
            }
        }
        (self.normal, self.pdf, self.light_samples) = (at.normal, samples.pdf, roles.light_samples);
    }

    /// Extends a lane's edge, which was that of `before`, beyond the sheet that it has hit. It remains one edge in
    /// multiple importance sampling, as shadow rays pass sheets too.
    fn pass_sheet(&mut self, at: &Vertices, lane: usize, before: &Packet, share: Rgb) {
        let (position, normal) = (at.surfaces.position.get(lane), at.surfaces.normal.get(lane));
        self.rays.set(lane, &beyond(&before.rays.get(lane), position, normal, at.surfaces.t[lane]));
        self.normal.set(lane, before.normal.get(lane));
        self.pdf[lane] = before.pdf[lane];
        self.light_samples[lane] = before.light_samples[lane];
        self.cones[lane] = before.cones[lane];
        self.emission_throughput.set(lane, before.emission_throughput.get(lane) * share);
        self.gaps[lane] += u32::from(at.bsdfs.lane(lane).passes_gaps_alone());
    }

    /// Continues the paths of `lanes`, scattered at vertex `depth`, with the given probability. Returns the lanes that
    /// stop.
    pub fn thin(&mut self, lanes: u16, probability: f32, depth: u32) -> u16 {
        if lanes == 0 || probability >= 1.0 {
            return 0;
        }
        // The number that chose an emitter does not affect the direction.
        let numbers = self.samplers.number(first_pair(depth) + 2);
        let mut left = 0;
        for lane in lanes_in(lanes) {
            match numbers[lane] < probability {
                true => self.throughput.set(lane, self.throughput.get(lane) / probability),
                false => left |= 1 << lane,
            }
        }
        left
    }
}

/// Returns the lanes whose directions are sampled by narrow lobes.
#[inline]
fn narrow(samples: &BsdfSamples16) -> u16 {
    mask_of(&samples.pdf.map(|pdf| u32::from(pdf > MIN_DENSITY_OF_IMAGES)))
}

/// Continues the cone around an edge of length `t`, whose next direction has the density `pdf`.
#[inline]
fn continue_cone(cone: &mut Cone, pdf: f32, t: f32) {
    match pdf > MIN_DENSITY_OF_IMAGES {
        true => cone.width = cone.width_at(t),
        false => *cone = Cone::default(),
    }
}

/// Returns the segments from surfaces to sampled lights.
#[inline]
fn segments(surfaces: &Surfaces16, lights: &DirectSamples16) -> Rays16 {
    let mut segments = Rays16::default();
    for i in 0..LANES {
        let (position, normal) = (surfaces.position.get(i), surfaces.normal.get(i));
        segments.set(i, &shadow::to_light(position, normal, lights, i));
    }
    segments
}
