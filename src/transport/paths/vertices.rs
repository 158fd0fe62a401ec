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
    pub bsdfs: Bsdfs16<'w>,
    /// Axes of the shading frames.
    axes: [Vec3x16; 3],
    /// Shading normals on the side of arrival; zero where light from both sides counts.
    pub normal: Vec3x16,
    /// Lanes behind a chain's end that go on by glossy and delta lobes alone.
    pub glossy: u16,
    /// Lobes that chains follow.
    pub chained: [LobeSet; LANES],
}

impl<'a, 'w> Vertices<'a, 'w> {
    /// Gives each lane of a packet that has hit `surfaces` a BSDF of its own.
    #[inline]
    pub fn one_by_one<R: PathPolicy<'w>>(
        world: &'w World,
        packet: &Packet,
        (surfaces, found): (&'a Surfaces16, u16),
        depth: u32,
        policy: &R,
    ) -> Self {
        let axes = [surfaces.tangent, surfaces.bitangent, surfaces.shading_normal];
        let (mut wo, mut normal) = (Vec3x16::default(), Vec3x16::default());
        for i in 0..LANES {
            let frame = surfaces.frame(i);
            let local = frame.to_local(-packet.rays.get(i).direction);
            wo.set(i, local);
            normal.set(i, if local.z < 0.0 { -frame.normal } else { frame.normal });
        }
        let mut bsdfs = world.bsdfs(surfaces, wo);
        let scattered = found & packet.at(PathStage::Scattered);
        let by_glossy = scattered != 0 && policy.goes_on_by_glossy_lobes();
        let glossy = if by_glossy { bsdfs.keep_glossy(scattered) } else { 0 };
        let chained = [LobeSet::default(); LANES];
        Vertices { world, surfaces, depth, found, bsdfs, axes, normal, glossy, chained }
    }

    /// Gives the lanes of each group one BSDF; there is a group. The paths come straight from the eye.
    #[inline]
    pub fn in_groups(world: &'w World, surfaces: &'a Surfaces16, groups: &[Group<'w>]) -> Self {
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
        let bsdfs = Bsdfs16::new(wo, |lane| groups[group_of[lane]].bsdf);
        let (chained, glossy) = ([LobeSet::default(); LANES], 0);
        Vertices { world, surfaces, depth: 1, found, bsdfs, axes, normal, glossy, chained }
    }
    /// Returns directions in the shading frames.
    #[inline]
    pub fn to_local(&self, directions: &Vec3x16) -> Vec3x16 {
        let mut local = Vec3x16::default();
        for i in 0..LANES {
            local.set(i, self.frame(i).to_local(directions.get(i)));
        }
        local
    }

    /// Returns directions of the shading frames in the world.
    #[inline]
    pub fn to_world(&self, directions: &Vec3x16) -> Vec3x16 {
        let mut world = Vec3x16::default();
        for i in 0..LANES {
            world.set(i, self.frame(i).to_world(directions.get(i)));
        }
        world
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
