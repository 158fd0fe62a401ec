//! Ends of paths at diffuse surfaces, by the light of photons ([`crate::irradiance::PathEnds`]).

use super::packet::{Packet, PathStage};
use super::policy::PathPolicy;
use crate::irradiance::Arrival;
use base::math::{Rgb, lanes_in};
use world::Surfaces16;
use world::material::Bsdfs16;

impl Packet {
    /// Adds to `results` what diffuse surfaces reflect, and removes their diffuse lobes. Returns the lanes of `found`
    /// that have other lobes, or no such end.
    pub fn end_by_photons<'w, R: PathPolicy<'w>>(
        &self,
        surfaces: &Surfaces16,
        bsdfs: &mut Bsdfs16,
        (found, depth): (u16, u32),
        policy: &R,
        results: &mut [Rgb],
    ) -> u16 {
        let Some(ends) = policy.path_ends() else { return found };
        let mut left = found;
        let bent = if R::STOPS_AT_DIFFUSE { self.at(PathStage::Bent) } else { 0 };
        for lane in lanes_in(found & (self.at(PathStage::Full) | bent)) {
            let (albedo, rest) = bsdfs.lane(lane).split_diffuse(bsdfs.wo(lane));
            let normal = surfaces.normal.get(lane);
            let normal = if normal.dot(self.rays.get(lane).direction) < 0.0 { normal } else { -normal };
            let arrival =
                Arrival { depth, length: surfaces.t[lane], position: surfaces.position.get(lane), normal };
            let Some(reflected) = ends.reflected(&arrival, albedo) else { continue };
            results[self.slot[lane] as usize] += self.throughput.get(lane) * reflected;
            bsdfs.replace(lane, &rest);
            let goes_on = rest.has_smooth() || rest.has_delta();
            left &= !(u16::from(!goes_on) << lane);
        }
        left
    }
}
