//! Surfaces at which the paths of a packet have arrived, and their BSDFs: each lane has its own, or shares one in a
//! group.

use super::groups::Group;
use super::guided::LaneVertex;
use super::packet::{Packet, PathStage};
use super::policy::PathPolicy;
use base::math::{Frame, LANES, Mask16, V3, Vec3x16, lanes_in};
use world::material::{Bsdfs16, LobeSet};
use world::{Surfaces16, World};

/// Surfaces of a packet.
pub(super) struct Vertices<'a, 'w> {
    pub world: &'w World,
    pub surfaces: &'a Surfaces16,
    /// Number of edges from the eye.
    pub depth: u32,
    /// Lanes with a surface.
    pub found: u16,
    pub bsdfs: &'a Bsdfs16<'w>,
    /// Axes of the shading frames.
    pub axes: [&'a Vec3x16; 3],
    /// Shading normals on the side of arrival; zero where light from both sides counts.
    pub normal: Vec3x16,
    /// Lanes behind a chain's end that go on by glossy and delta lobes alone.
    pub glossy: u16,
    /// Lobes that chains follow.
    pub chained: [LobeSet; LANES],
}

/// Directions towards the eye in shading frames, and shading normals on that side.
pub(super) struct Seen16 {
    pub wo: Vec3x16,
    pub normal: Vec3x16,
}

/// Lanes of groups: each has the frame, view and BSDF of its group.
pub(super) struct GroupLanes<'w> {
    pub axes: [Vec3x16; 3],
    pub bsdfs: Bsdfs16<'w>,
    pub normal: Vec3x16,
    pub found: u16,
}

impl Packet {
    /// Returns how the paths see the surfaces that they have hit.
    #[inline(always)]
    pub fn seen(&self, surfaces: &Surfaces16) -> Seen16 {
        let mut seen = Seen16 { wo: Vec3x16::default(), normal: Vec3x16::default() };
        for i in 0..LANES {
            let frame = surfaces.frame(i);
            let local = frame.to_local(-self.rays.get(i).direction);
            seen.wo.set(i, local);
            seen.normal.set(i, if local.z < 0.0 { -frame.normal } else { frame.normal });
        }
        seen
    }

    /// Reduces BSDFs behind chains' ends to the lobes by which paths go on, and returns their lanes.
    #[inline]
    pub fn keep_glossy<'w, R: PathPolicy<'w>>(&self, bsdfs: &mut Bsdfs16, found: u16, policy: &R) -> u16 {
        let scattered = found & self.at(PathStage::Scattered);
        let goes_on = scattered != 0 && policy.goes_on_by_glossy_lobes();
        if goes_on { bsdfs.keep_glossy(scattered) } else { 0 }
    }
}

impl<'w> GroupLanes<'w> {
    /// Gives the lanes of each group one BSDF; there is a group.
    #[inline]
    pub fn new(groups: &[Group<'w>]) -> GroupLanes<'w> {
        let (mut axes, mut wo, mut normal) = ([Vec3x16::ZERO; 3], Vec3x16::ZERO, Vec3x16::ZERO);
        let (mut group_of, mut found) = ([0; LANES], 0);
        for (index, group) in groups.iter().enumerate() {
            let (lanes, frame) = (Mask16::of(group.lanes), &group.frame);
            for (axis, v) in axes.iter_mut().zip([frame.tangent, frame.bitangent, frame.normal]) {
                axis.put(lanes, V3::splat(v));
            }
            wo.put(lanes, V3::splat(frame.to_local(group.out)));
            normal.put(lanes, V3::splat(group.normal));
            lanes_in(group.lanes).for_each(|lane| group_of[lane] = index);
            found |= group.lanes;
        }
        GroupLanes { axes, bsdfs: Bsdfs16::new(wo, |lane| groups[group_of[lane]].bsdf), normal, found }
    }
}

impl<'w> Vertices<'_, 'w> {
    /// Returns directions in the shading frames.
    #[inline(always)]
    pub fn to_local(&self, directions: &Vec3x16) -> Vec3x16 {
        let (d, [x, y, z]) = (directions.load(), self.axes.map(Vec3x16::load));
        V3::new(d.dot(x), d.dot(y), d.dot(z)).into()
    }

    /// Returns directions of the shading frames in the world.
    #[inline(always)]
    pub fn to_world(&self, directions: &Vec3x16) -> Vec3x16 {
        let (d, [x, y, z]) = (directions.load(), self.axes.map(Vec3x16::load));
        (x.times(d.x) + y.times(d.y) + z.times(d.z)).into()
    }

    /// Returns the surface point of a lane.
    pub fn lane(&self, lane: usize) -> LaneVertex<'w> {
        let (bsdf, wo) = (self.bsdfs.lane(lane), self.bsdfs.wo(lane));
        let (position, normal) = (self.surfaces.position.get(lane), self.normal.get(lane));
        LaneVertex { lane, position, normal, frame: self.frame(lane), bsdf, wo }
    }

    /// Returns the shading frame of a lane.
    #[inline(always)]
    fn frame(&self, lane: usize) -> Frame {
        let [tangent, bitangent, normal] =
            [self.axes[0].get(lane), self.axes[1].get(lane), self.axes[2].get(lane)];
        Frame { tangent, bitangent, normal }
    }
}
