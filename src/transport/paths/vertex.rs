//! Sixteen vertices of paths: their emission, their direct light, and the next edges.
//!
//! Paper: Veach, *Robust Monte Carlo Methods for Light Transport Simulation*, 1997, chapters 9 and 10.
//!
//! A path may stop at the first surface that scatters by lobes which a chain does not follow ([`PathPolicy`]). It then
//! has one more edge, which finds emitters: the counterpart of the light samples in multiple importance sampling. If
//! that edge hits a mirror, glass or a glossy lobe, the path continues by this lobe alone, since virtual lights carry
//! the other lobes.
//!
//! Deviations: a path survives Russian roulette with the square root of its throughput, from the second vertex on. The
//! throughput itself would end paths between dark walls so often that the few that then hit the sun are fireflies.

use super::guided::{Guided, LaneVertex};
use super::packet::{Packet, PathStage};
use super::policy::{ChainEnd, LightSamples, PathPolicy, ScatteredEdges};
use base::math::{Cone, F32x16, LANES, Rgb, Vec2x16, Vec3x16, lanes_in, mask_of};
use base::sampling::{hash, power_heuristic};
use embree::{Ray, Rays16};
use glam::Vec3;
use world::light::{DirectSamples16, Receivers16};
use world::material::{BsdfSamples16, Bsdfs16, LobeSet};
use world::shadow;
use world::{Surfaces16, World, beyond};

/// Vertex number, counted from the eye, from which on Russian roulette may end a path.
const ROULETTE_DEPTH: u32 = 2;

/// Minimum density by solid angle of directions whose lobe shows images (GGX with α 0.2). Broader lobes average the
/// texture that they see.
const MIN_DENSITY_OF_IMAGES: f32 = 2.0;

/// Pairs of random numbers before the first vertex: the position in the pixel.
const PAIRS_BEFORE: u32 = 1;

/// Pairs of random numbers per vertex: for the light, for the direction, for the choices of emitter and lobe, and for
/// Russian roulette.
const PAIRS_PER_VERTEX: u32 = 4;

/// Light samples at the vertices of a packet.
struct LightStep<'a, 'w> {
    bsdfs: &'a Bsdfs16<'w>,
    at: Receivers16<'a>,
    /// Random numbers that choose emitters.
    u_choice: &'a F32x16,
    /// Random numbers that choose points on them.
    u_light: &'a Vec2x16,
    /// Lanes to sample.
    wanted: u16,
    guided: &'a Guided,
}

/// Returns the index of the first pair of random numbers of vertex `depth`.
pub(super) fn first_pair(depth: u32) -> u32 {
    PAIRS_BEFORE + 1 + (depth - 1).wrapping_mul(PAIRS_PER_VERTEX)
}

/// Continues the cone around an edge of length `t`, whose next direction has the density `pdf`.
#[inline]
pub(super) fn continue_cone(cone: &mut Cone, pdf: f32, t: f32) {
    match pdf > MIN_DENSITY_OF_IMAGES {
        true => cone.width = cone.width_at(t),
        false => *cone = Cone::default(),
    }
}

/// Returns the hash of a chain continued by a surface of `mesh`, on the same side or by a delta lobe.
#[inline]
pub(super) fn next_class(path_class: u32, [same_side, by_delta]: [bool; 2], mesh: u32) -> u32 {
    let side = u32::from(same_side) + 2 * u32::from(by_delta);
    hash(path_class ^ side.wrapping_mul(0x9e37_79b9), 1 + mesh)
}

/// Returns the segments from surfaces to sampled lights.
#[inline]
pub(super) fn segments(surfaces: &Surfaces16, lights: &DirectSamples16) -> Rays16 {
    let mut segments = Rays16::default();
    for i in 0..LANES {
        let (position, normal) = (surfaces.position.get(i), surfaces.normal.get(i));
        let (direction, distance) = (lights.direction.get(i), lights.distance[i]);
        let near = shadow::segment(position, normal, position + direction * distance, lights.normal.get(i));
        let far = shadow::ray_from(position, normal, direction);
        segments.set(i, &if distance < f32::INFINITY { near } else { far });
    }
    segments
}

impl Packet {
    /// Samples light and the next directions at the surfaces hit in the lanes of `found` by the edges with number
    /// `depth`. Calls `arrives` with each light sample: its segment, its radiance at the eye, and its result. Light
    /// that is known to arrive has no segment. Turns the paths into their continuations and returns the lanes that
    /// continue.
    #[inline]
    pub fn scatter<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &'w World,
        surfaces: &Surfaces16,
        depth: u32,
        found: u16,
        policy: &mut R,
        mut arrives: impl FnMut(Option<&Ray>, Rgb, u32),
    ) -> u16 {
        let pair = first_pair(depth);
        let before = world.has_sheets().then(|| self.clone());
        let mut wo = Vec3x16::default();
        for i in 0..LANES {
            let frame = surfaces.frame(i);
            let local = frame.to_local(-self.rays.get(i).direction);
            wo.set(i, local);
            self.normal.set(i, if local.z < 0.0 { -frame.normal } else { frame.normal });
        }
        let mut bsdfs = world.bsdfs(surfaces, wo);
        if depth == 1 && policy.sees() {
            for lane in lanes_in(found) {
                let (bsdf, out) = (bsdfs.lane(lane), -self.rays.get(lane).direction);
                let albedo = (!bsdf.has_delta()).then(|| world.guide_albedo(&surfaces.get(lane), &bsdf, out));
                policy.see(self.slot[lane], albedo, self.normal.get(lane));
            }
        }
        if world.specular.scatter_across() {
            // Light reaches these lobes from both sides.
            let across = |lane: &usize| bsdfs.lane(*lane).scatters_across();
            lanes_in(found).filter(across).for_each(|lane| self.normal.set(lane, Vec3::ZERO));
        }
        let choices = self.samplers.point(pair + 2);
        let mut at_end = if R::STOPS_AT_DIFFUSE { found & self.at(PathStage::Chain) } else { 0 };
        let scattered = if R::STOPS_AT_DIFFUSE { found & self.at(PathStage::Scattered) } else { 0 };
        let by_glossy = R::STOPS_AT_DIFFUSE && policy.goes_on_by_glossy_lobes();
        let glossy = if by_glossy { bsdfs.keep_glossy(scattered) } else { 0 };
        let edges = if R::STOPS_AT_DIFFUSE { policy.edges() } else { ScatteredEdges::default() };
        let share = edges.guided;
        let guided = Guided { lanes: if share > 0.0 { at_end & bsdfs.lambertian() } else { 0 }, share };
        let unlit = (scattered & !glossy) | if R::ONLY_BY_SPECULAR_LOBES { at_end } else { 0 };
        // This comes before the light samples, so that a path's light is summed in one order, whatever paths are
        // traced with it.
        let chained = if R::STOPS_AT_DIFFUSE {
            self.end_chains(&bsdfs, surfaces, depth, at_end, policy, &mut arrives)
        } else {
            [LobeSet::default(); LANES]
        };
        let mut lit = bsdfs.smooth() & found & !unlit;
        self.light_samples = [1.0; LANES];
        let requested = if R::STOPS_AT_DIFFUSE { policy.light_samples() } else { LightSamples::ONE };
        let many =
            if requested == LightSamples::ONE { 0 } else { lit & at_end & self.bright_enough(requested) };
        lanes_in(many).for_each(|lane| self.light_samples[lane] = requested.count as f32);
        for sample in 0..requested.count {
            if lit != 0 {
                let (mut samplers, step) = (self.samplers, requested.first.wrapping_add(sample));
                for lane in lanes_in(many) {
                    samplers.index[lane] =
                        samplers.index[lane].wrapping_mul(requested.count).wrapping_add(step);
                }
                let choice = if many == 0 { choices.x } else { samplers.number(pair + 2) };
                let learned = policy.learned();
                let at = Receivers16 { position: &surfaces.position, normal: &self.normal, learned };
                let (bsdfs, guided, wanted) = (&bsdfs, &guided, lit);
                let (u_choice, u_light) = (&choice, &samplers.point(pair));
                let step = LightStep { bsdfs, at, u_choice, u_light, wanted, guided };
                self.light(world, surfaces, step, &mut arrives);
            }
            lit &= many;
        }
        let places = self.samplers.point(pair + 1);
        let mut samples = bsdfs.sample(&choices.y, &places, found);
        for lane in lanes_in(guided.lanes) {
            let (position, normal) = (surfaces.position.get(lane), self.normal.get(lane));
            let (frame, bsdf, wo) = (surfaces.frame(lane), bsdfs.lane(lane), bsdfs.wo(lane));
            let vertex = LaneVertex { lane, position, normal, frame, bsdf: &bsdf, wo };
            guided.turn(world, &vertex, choices.y[lane], places.get(lane), &mut samples);
        }
        let roulette = if depth >= ROULETTE_DEPTH { self.samplers.number(pair + 3) } else { [0.0; LANES] };
        let (mut survives, mut survivals) = ([0; LANES], [1.0; LANES]);
        for i in 0..LANES {
            let throughput = self.throughput.get(i) * samples.weight.get(i);
            self.eta_sq[i] *= samples.eta[i] * samples.eta[i];
            let survival = (throughput.max_element() * self.eta_sq[i]).sqrt().min(0.95);
            let survival = if depth >= ROULETTE_DEPTH { survival } else { 1.0 };
            survives[i] = u32::from(roulette[i] < survival);
            survivals[i] = survival;
            self.throughput.set(i, throughput / survival);
            self.pdf[i] = samples.pdf[i];
        }
        self.emission_throughput = self.throughput;
        let mut found = found;
        if R::STOPS_AT_DIFFUSE {
            let by_specular_lobes = world.specular.bends_light();
            found &= samples.going_on() & mask_of(&survives) & (!scattered | samples.delta() | glossy);
            at_end &= found;
            self.follow(&bsdfs, &samples, surfaces, at_end, pair + 3, &chained);
            let blind = if world.emitters.are_hittable() { 0 } else { at_end & !self.at(PathStage::Chain) };
            if by_specular_lobes {
                self.emission_throughput.keep(!blind);
            } else {
                found &= !blind;
            }
            let leaving = found & scattered & !samples.straight();
            let bent = samples.delta();
            for lane in lanes_in(leaving) {
                self.stage[lane] =
                    if bent >> lane & 1 != 0 { PathStage::Bent } else { PathStage::Full } as u32;
            }
            let spread = found & self.at(PathStage::Bent) & !bent;
            lanes_in(spread).for_each(|lane| self.stage[lane] = PathStage::Full as u32);
            if R::ONLY_BY_SPECULAR_LOBES {
                self.emission_throughput.keep(self.at(PathStage::Full) | self.at(PathStage::Bent));
            }
        }
        if world.filters_textures() {
            for i in lanes_in(found) {
                continue_cone(&mut self.cones[i], samples.pdf[i], surfaces.t[i]);
            }
        }
        for i in 0..LANES {
            let direction = surfaces.frame(i).to_world(samples.wi.get(i));
            self.rays.set(i, &shadow::ray_from(surfaces.position.get(i), surfaces.normal.get(i), direction));
        }
        found &= samples.going_on() & mask_of(&survives);
        self.enter(world, surfaces, found, samples.straight());
        if let Some(before) = before {
            for i in lanes_in(found & samples.straight()) {
                self.pass_sheet(i, &before, surfaces, samples.weight.get(i) / survivals[i]);
                self.gaps[i] += u32::from(bsdfs.lane(i).passes_gaps_alone());
            }
        }
        found
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

    /// Returns the lanes whose surface gets all of these light samples.
    fn bright_enough(&self, samples: LightSamples) -> u16 {
        let least = if samples.count > 1 { LightSamples::MIN_THROUGHPUT } else { 0.0 };
        mask_of(&std::array::from_fn(|lane| u32::from(self.throughput.get(lane).max_element() >= least)))
    }

    /// Extends a lane's edge, which was that of `before`, beyond the sheet that it has hit. It remains one edge in
    /// multiple importance sampling, as shadow rays pass sheets too.
    fn pass_sheet(&mut self, lane: usize, before: &Packet, surfaces: &Surfaces16, weight: Rgb) {
        let (position, normal) = (surfaces.position.get(lane), surfaces.normal.get(lane));
        self.rays.set(lane, &beyond(&before.rays.get(lane), position, normal, surfaces.t[lane]));
        self.normal.set(lane, before.normal.get(lane));
        self.pdf[lane] = before.pdf[lane];
        self.light_samples[lane] = before.light_samples[lane];
        self.cones[lane] = before.cones[lane];
        self.emission_throughput.set(lane, before.emission_throughput.get(lane) * weight);
    }

    /// Passes the surfaces that end chains to `policy`. Returns the lobes that chains follow.
    fn end_chains<'w, R: PathPolicy<'w>>(
        &self,
        bsdfs: &Bsdfs16<'w>,
        surfaces: &Surfaces16,
        depth: u32,
        found: u16,
        policy: &mut R,
        arrives: &mut impl FnMut(Option<&Ray>, Rgb, u32),
    ) -> [LobeSet; LANES] {
        let mut chained = [LobeSet::default(); LANES];
        for lane in lanes_in(bsdfs.smooth() & found) {
            let whole = bsdfs.lane(lane);
            chained[lane] = policy.followed(&whole);
            let bsdf = whole.without(chained[lane]);
            if !bsdf.has_smooth() {
                continue;
            }
            let end = ChainEnd {
                path: self.slot[lane],
                surface: surfaces.get(lane),
                bsdf,
                out: -self.rays.get(lane).direction,
                throughput: self.throughput.get(lane),
                distance: self.distance[lane] + surfaces.t[lane],
                path_class: self.path_class[lane],
                depth,
            };
            let reflected = policy.reflected(&end);
            if reflected != Rgb::ZERO {
                arrives(None, end.throughput * reflected, end.path);
            }
            policy.end(&end);
        }
        chained
    }

    /// Splits the throughput at chain ends between the lobes that chains follow and the others. Directions of delta
    /// lobes stay in the chain. In other directions the path stays with a probability equal to the share of the lobes
    /// in `chained`. Otherwise it leaves the chain, with the throughput of the other lobes.
    fn follow(
        &mut self,
        bsdfs: &Bsdfs16,
        samples: &BsdfSamples16,
        surfaces: &Surfaces16,
        at_end: u16,
        pair: u32,
        chained: &[LobeSet; LANES],
    ) {
        let delta = samples.delta() & at_end;
        let may_go_on = lanes_in(at_end).filter(|lane| !chained[*lane].is_empty());
        let sharp = may_go_on.fold(0, |mask, lane| mask | 1u16 << lane) & !delta;
        for lane in lanes_in(at_end & !(delta | sharp)) {
            self.leave_chain(lane, surfaces);
        }
        if delta | sharp == 0 {
            return;
        }
        let draws = self.samplers.point(pair).y;
        for lane in lanes_in(sharp) {
            let (wo, wi) = (bsdfs.wo(lane), samples.wi.get(lane));
            let value = samples.weight.get(lane) * (samples.pdf[lane] / wi.z.abs());
            let share =
                bsdfs.lane(lane).eval_lobes(chained[lane], wo, wi) / value.max(Rgb::splat(f32::MIN_POSITIVE));
            let survival = share.max_element().min(1.0);
            let (share, probability) = match draws[lane] < survival {
                true => (share, survival),
                false => {
                    self.leave_chain(lane, surfaces);
                    ((Rgb::ONE - share).max(Rgb::ZERO), 1.0 - survival)
                }
            };
            self.throughput.set(lane, self.throughput.get(lane) * share / probability);
        }
        for lane in lanes_in((delta | sharp) & !samples.straight() & self.at(PathStage::Chain)) {
            self.distance[lane] += surfaces.t[lane];
            let same_side = (bsdfs.wo(lane).z > 0.0) == (samples.wi.z[lane] > 0.0);
            let by_delta = (delta >> lane) & 1 != 0;
            self.path_class[lane] =
                next_class(self.path_class[lane], [same_side, by_delta], surfaces.mesh[lane]);
        }
    }

    /// Samples light: an emitter, and a point on it. Calls `arrives` with each sample.
    #[inline]
    fn light(
        &self,
        world: &World,
        surfaces: &Surfaces16,
        step: LightStep,
        mut arrives: impl FnMut(Option<&Ray>, Rgb, u32),
    ) {
        let LightStep { bsdfs, at, u_choice, u_light, wanted, guided } = step;
        let lights = world.emitters.sample_direct(at, u_choice, u_light, wanted);
        let mut wi = Vec3x16::default();
        for i in 0..LANES {
            wi.set(i, surfaces.frame(i).to_local(lights.direction.get(i)));
        }
        let wanted = wanted & lights.useful();
        let (value, mut pdf) = bsdfs.eval_pdf(&wi, wanted);
        for i in lanes_in(wanted & guided.lanes) {
            let (x, n) = (surfaces.position.get(i), self.normal.get(i));
            pdf[i] = guided.density(world, x, n, lights.direction.get(i), pdf[i]);
        }
        let (mut radiance, mut scattered) = (Vec3x16::default(), [0; LANES]);
        for i in 0..LANES {
            let light_pdf = self.light_samples[i] * lights.pdf[i];
            let weight = if lights.delta[i] != 0 { 1.0 } else { power_heuristic(light_pdf, pdf[i]) };
            let value = value.get(i);
            let factor = wi.z[i].abs() * weight / light_pdf;
            radiance.set(i, self.throughput.get(i) * value * lights.radiance.get(i) * factor);
            scattered[i] = u32::from((value.x != 0.0) | (value.y != 0.0) | (value.z != 0.0));
        }
        let segments = segments(surfaces, &lights);
        if world.absorbs() {
            for i in lanes_in(wanted) {
                let share = world.share_from(&surfaces.get(i), lights.direction.get(i), lights.distance[i]);
                radiance.set(i, radiance.get(i) * share);
            }
        }
        for i in lanes_in(wanted & mask_of(&scattered)) {
            arrives(Some(&segments.get(i)), radiance.get(i), self.slot[i]);
        }
    }

    /// Ends a lane's chain at the surface that its edge has hit.
    fn leave_chain(&mut self, lane: usize, surfaces: &Surfaces16) {
        self.stage[lane] = PathStage::Scattered as u32;
        self.distance[lane] += surfaces.t[lane];
    }
}
