//! Sixteen paths that arrive at surfaces: the absorption along their edges, and the emission that they find.

use super::packet::{Packet, PathStage};
use super::policy::PathPolicy;
use base::math::{LANES, Rgb, lanes_in};
use base::sampling::power_heuristic;
use world::light::Receivers16;
use world::{Surfaces16, World};

impl Packet {
    /// Absorbs light along the edges, and adds to `results` the emission of the surfaces hit in the lanes of `found`.
    #[inline]
    pub fn arrive<'w, R: PathPolicy<'w>>(
        &mut self,
        world: &World,
        surfaces: &Surfaces16,
        found: u16,
        policy: &R,
        results: &mut [Rgb],
    ) {
        if !world.absorbs() {
            return self.add_emitted(world, surfaces, found, policy, results);
        }
        let sent = self.emission_throughput;
        let mut shares = [[Rgb::ONE; 2]; LANES];
        for lane in lanes_in(found) {
            let ray = self.rays.get(lane);
            let met = surfaces.get(lane);
            shares[lane] = world.edge_shares(self.interior[lane], &met, ray.direction, ray.t_near);
            self.emission_throughput.set(lane, sent.get(lane) * shares[lane][0]);
        }
        self.add_emitted(world, surfaces, found, policy, results);
        for lane in lanes_in(found) {
            self.emission_throughput.set(lane, sent.get(lane) * shares[lane][1]);
            self.throughput.set(lane, self.throughput.get(lane) * shares[lane][1]);
        }
    }

    /// Sets the interiors in which the paths of `lanes` go on along their rays from the surfaces hit. `straight` are
    /// the lanes that pass these surfaces in their direction.
    #[inline]
    pub fn enter(&mut self, world: &World, surfaces: &Surfaces16, lanes: u16, straight: u16) {
        if world.absorbs() {
            for lane in lanes_in(lanes) {
                let (met, passes) = (surfaces.get(lane), straight >> lane & 1 != 0);
                let direction = self.rays.get(lane).direction;
                self.interior[lane] = world.interior_after(self.interior[lane], &met, direction, passes);
            }
        }
    }

    /// Adds to `results` the emission of the surfaces hit in the lanes of `found`.
    #[inline]
    fn add_emitted<'w, R: PathPolicy<'w>>(
        &self,
        world: &World,
        surfaces: &Surfaces16,
        found: u16,
        policy: &R,
        results: &mut [Rgb],
    ) {
        let lit = lanes_in(found).filter(|i| world.emitters.is_light(surfaces.mesh[*i]));
        let lit = lit.fold(0u16, |mask, i| mask | 1 << i);
        if lit == 0 {
            return;
        }
        let directions = self.rays.directions();
        let mut cos = [0.0; LANES];
        for i in 0..LANES {
            cos[i] = surfaces.normal.get(i).dot(directions.get(i));
        }
        let start =
            Receivers16 { position: &self.rays.origins(), normal: &self.normal, learned: policy.learned() };
        let light_pdf = world.emitters.pdf_areas(start, &surfaces.mesh, &surfaces.t, &cos);
        for i in lanes_in(lit) {
            let emitted = world.emitted(&surfaces.get(i), -directions.get(i));
            let weight = self.share_of_paths(i, emitted, policy) * self.weight_against(i, light_pdf[i]);
            results[self.slot[i] as usize] += self.emission_throughput.get(i) * emitted * weight;
        }
    }

    /// Returns the share of an emitter's radiance that a lane's path is to find.
    #[inline]
    pub fn share_of_paths<'w, R: PathPolicy<'w>>(&self, lane: usize, radiance: Rgb, policy: &R) -> f32 {
        match self.stage[lane] == PathStage::Bent as u32 {
            true => policy.share_of_paths(radiance, self.distance[lane]),
            false => 1.0,
        }
    }

    /// Returns the MIS weight of a lane that hit a light by its edge, against light sampling of the given density.
    #[inline]
    pub fn weight_against(&self, lane: usize, light_pdf: f32) -> f32 {
        let pdf = self.pdf[lane];
        let light_pdf = self.light_samples[lane] * light_pdf;
        if pdf == f32::INFINITY { 1.0 } else { power_heuristic(pdf, light_pdf) }
    }
}
