//! Ends of chains: surfaces that scatter light by lobes which a chain does not follow, and paths that leave their
//! chains there.

use super::found_light::FoundLight;
use super::groups::Group;
use super::packet::{Packet, PathStage};
use super::policy::{ChainEnd, PathPolicy};
use super::vertices::Vertices;
use base::math::{Rgb, lanes_in};
use base::sampling::hash;
use glam::Vec3;
use world::material::BsdfSamples16;

impl<'w> Vertices<'_, 'w> {
    /// Passes first surfaces and ends of chains to `policy`, lane by lane, and adds the light that it knows of.
    #[inline]
    pub fn end_chains<R: PathPolicy<'w>>(&mut self, packet: &Packet, policy: &mut R, light: &mut FoundLight) {
        let (world, surfaces) = (self.world, self.surfaces);
        if self.depth == 1 && policy.sees() {
            for lane in lanes_in(self.found) {
                let (bsdf, out) = (self.bsdfs.lane(lane), -packet.rays.get(lane).direction);
                let albedo = (!bsdf.has_delta()).then(|| world.guide_albedo(&surfaces.get(lane), &bsdf, out));
                policy.see(packet.slot[lane], albedo, self.normal.get(lane));
            }
        }
        if world.specular.scatter_across() {
            // Light reaches these lobes from both sides.
            let across = |lane: &usize| self.bsdfs.lane(*lane).scatters_across();
            lanes_in(self.found).filter(across).for_each(|lane| self.normal.set(lane, Vec3::ZERO));
        }
        for lane in lanes_in(self.bsdfs.smooth() & self.found & packet.at(PathStage::Chain)) {
            let whole = self.bsdfs.lane(lane);
            self.chained[lane] = policy.followed(&whole);
            let bsdf = whole.without(self.chained[lane]);
            if !bsdf.has_smooth() {
                continue;
            }
            let end = ChainEnd {
                path: packet.slot[lane],
                surface: surfaces.get(lane),
                bsdf,
                out: -packet.rays.get(lane).direction,
                throughput: packet.throughput.get(lane),
                distance: packet.distance[lane] + surfaces.t[lane],
                path_class: packet.path_class[lane],
                depth: self.depth,
            };
            let reflected = policy.reflected(&end);
            if reflected != Rgb::ZERO {
                light.add(end.path, end.throughput * reflected);
            }
            policy.end(&end);
        }
    }

    /// Passes the groups to `policy` as first surfaces and ends of chains, and adds the light that it knows of.
    pub fn end_chains_of_groups<R: PathPolicy<'w>>(
        &mut self,
        packet: &Packet,
        groups: &[Group<'w>],
        policy: &mut R,
        light: &mut FoundLight,
    ) {
        let surfaces = self.surfaces;
        for group in groups {
            let (first, whole) = (group.first(), &group.bsdf);
            let mut surface = surfaces.get(first);
            surface.frame = group.frame;
            if policy.sees() {
                let albedo = self.world.guide_albedo(&surface, whole, group.out);
                policy.see(packet.slot[first], Some(albedo * group.len()), group.normal_sum);
            }
            let chained = policy.followed(whole);
            lanes_in(group.lanes).for_each(|lane| self.chained[lane] = chained);
            let bsdf = whole.without(chained);
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
                depth: self.depth,
            };
            for lane in lanes_in(group.lanes) {
                if policy.looks_up(packet.slot[lane]) {
                    let mut end = end(lane, Rgb::ONE);
                    end.surface = surfaces.get(lane);
                    light.add(end.path, policy.reflected(&end));
                }
            }
            policy.end(&end(first, Rgb::splat(group.len())));
        }
    }
}

impl Packet {
    /// Splits the throughput at the chain ends `at_end` between the lobes that chains follow and the others.
    ///
    /// Directions of delta lobes stay in the chain. In other directions the path stays with a probability equal to the
    /// share of the chained lobes. Otherwise it leaves the chain, with the throughput of the other lobes.
    pub fn leave_chains(&mut self, at: &Vertices, samples: &BsdfSamples16, at_end: u16, pair: u32) {
        let delta = samples.delta() & at_end;
        let may_go_on = lanes_in(at_end).filter(|lane| !at.chained[*lane].is_empty());
        let sharp = may_go_on.fold(0, |mask, lane| mask | 1u16 << lane) & !delta;
        let mut leaving = at_end & !(delta | sharp);
        if sharp != 0 {
            let draws = self.samplers.point(pair).y;
            let chained = at.bsdfs.eval_lobes(&at.chained, &samples.wi, sharp);
            for lane in lanes_in(sharp) {
                let value = samples.weight.get(lane) * (samples.pdf[lane] / samples.wi.z[lane].abs());
                let share = chained.get(lane) / value.max(Rgb::splat(f32::MIN_POSITIVE));
                let stays = share.max_element().min(1.0);
                let factor = match draws[lane] < stays {
                    true => share / stays,
                    false => (Rgb::ONE - share).max(Rgb::ZERO) / (1.0 - stays),
                };
                leaving |= u16::from(!(draws[lane] < stays)) << lane;
                self.throughput.set(lane, self.throughput.get(lane) * factor);
            }
        }
        for lane in lanes_in(leaving) {
            self.stage[lane] = PathStage::Scattered as u32;
            self.distance[lane] += at.surfaces.t[lane];
        }
        for lane in lanes_in((delta | sharp) & !leaving & !samples.straight()) {
            self.distance[lane] += at.surfaces.t[lane];
            let same_side = (at.bsdfs.wo(lane).z > 0.0) == (samples.wi.z[lane] > 0.0);
            let by_delta = delta >> lane & 1 != 0;
            self.path_class[lane] =
                next_class(self.path_class[lane], [same_side, by_delta], at.surfaces.mesh[lane]);
        }
    }
}

/// Returns the hash of a chain continued by a surface of `mesh`, on the same side or by a delta lobe.
fn next_class(path_class: u32, [same_side, by_delta]: [bool; 2], mesh: u32) -> u32 {
    let side = u32::from(same_side) + 2 * u32::from(by_delta);
    hash(path_class ^ side.wrapping_mul(0x9e37_79b9), 1 + mesh)
}
