//! Light that paths find at vertices, if nothing occludes it, and counts of the rays.

use base::math::{LANES, Rgb, U32x16, Vec3x16, first_lanes, lanes_in};
use embree::Rays16;
use world::World;

/// Segments to lights, and the light that arrives if they are unoccluded.
#[derive(Default)]
pub(super) struct ShadowPacket {
    pub rays: Rays16,
    /// Radiances at the eye.
    pub radiance: Vec3x16,
    /// Indices of the paths.
    pub slot: U32x16,
}

/// Light of paths that are in flight.
pub(super) struct FoundLight<'a> {
    pub world: &'a World,
    /// Radiance of each path.
    pub radiance: &'a mut [Rgb],
    /// Segments that wait for a full packet, and their number.
    pub waiting: &'a mut (ShadowPacket, usize),
    pub counts: &'a mut RayCounts,
    /// True if shadow rays of a packet are nearly parallel.
    pub coherent: bool,
    /// Maximum number of sheets that light passes.
    pub sheets: u32,
    /// True if the packet of a vertex is traced as it is, since its rays are alike.
    pub at_once: bool,
}

impl FoundLight<'_> {
    /// Adds light that is known to arrive.
    #[inline]
    pub fn add(&mut self, slot: u32, radiance: Rgb) {
        self.radiance[slot as usize] += radiance;
    }

    /// Adds the light in `lanes` of a packet whose segments are unoccluded, now or later.
    #[inline]
    pub fn test(&mut self, mut packet: ShadowPacket, lanes: u16) {
        if self.at_once {
            return self.trace(&mut packet, lanes);
        }
        for lane in lanes_in(lanes) {
            let (waiting, count) = &mut *self.waiting;
            waiting.rays.set(*count, &packet.rays.get(lane));
            waiting.radiance.set(*count, packet.radiance.get(lane));
            waiting.slot[*count] = packet.slot[lane];
            *count += 1;
            if *count == LANES {
                self.finish();
            }
        }
    }

    /// Traces the segments that wait for a full packet.
    pub fn finish(&mut self) {
        let (mut packet, count) = std::mem::take(self.waiting);
        self.trace(&mut packet, first_lanes(count));
    }

    /// Traces the segments in `lanes` of a packet, and adds the light of unoccluded ones.
    #[inline]
    fn trace(&mut self, packet: &mut ShadowPacket, lanes: u16) {
        let ShadowPacket { rays, radiance, slot } = packet;
        self.counts.shadow_rays += u64::from(lanes.count_ones());
        let free = lanes & !self.world.accel.occluded16(rays, lanes, self.coherent);
        self.world.attenuate(rays, free, |_| Some(self.sheets), radiance);
        for lane in lanes_in(free) {
            self.radiance[slot[lane] as usize] += radiance.get(lane);
        }
    }
}

/// Rays traced.
#[derive(Clone, Copy, Debug, Default)]
pub struct RayCounts {
    /// Closest-hit queries.
    pub rays: u64,
    /// Occlusion queries.
    pub shadow_rays: u64,
}
