//! Groups of first hits: lanes of a packet that see nearly the same part of one surface through one pixel. A group has
//! one BSDF, the mean of its lanes' BSDFs, and is one shading point.
//!
//! Every lane keeps its own position and geometric normal, so that shadows and penumbrae are sampled as finely as
//! visibility. Shading frame and directions are means over the lanes.
//!
//! Errors: the mean of BSDFs seen along the mean direction differs from the mean of values. Normals may differ by an
//! angle that is small against the sharpest lobe.

use base::math::{Frame, LANES, U32x16, Vec3x16, lanes_in, mask_of};
use glam::Vec3;
use scene::MaterialId;
use world::material::Bsdf;
use world::{Surfaces16, World};

/// Minimum cosine between the normals of a group without sharper lobes: 5.7 degrees.
const MIN_COS: f32 = 0.995;

/// Maximum angle between the normals of a group, as a share of the roughness α of its sharpest lobe.
const ALPHA_SHARE: f32 = 0.18;

/// Minimum cosine between the directions towards the eye of samples that are one shading point: 11 degrees.
pub(crate) const MIN_OUT_COS: f32 = 0.98;

/// Maximum distance between samples that are one shading point, in spacings.
pub(crate) const MAX_DISTANCE: f32 = 16.0;

/// Maximum distance of a sample from the plane of another of one shading point, in spacings.
pub(crate) const MAX_HEIGHT: f32 = 0.5;

/// Lanes that share one BSDF.
pub(super) struct Group<'w> {
    pub lanes: u16,
    /// BSDF of the whole group.
    pub bsdf: Bsdf<'w>,
    /// Shading frame, on the front of the surface.
    pub frame: Frame,
    /// Shading normal on the side of the eye.
    pub normal: Vec3,
    /// Unit vector towards the eye.
    pub out: Vec3,
    /// Sum of the lanes' shading normals on the side of the eye.
    pub normal_sum: Vec3,
}

impl Group<'_> {
    /// Returns the first lane, which gives the shading point its position.
    pub fn first(&self) -> usize {
        self.lanes.trailing_zeros() as usize
    }

    /// Returns the number of lanes.
    pub fn len(&self) -> f32 {
        self.lanes.count_ones() as f32
    }
}

/// First hits of a packet of eye rays.
pub(super) struct FirstHits16<'a> {
    pub surfaces: &'a Surfaces16,
    /// Unit directions of the eye rays.
    pub directions: &'a Vec3x16,
    /// Seeds of the pixels' random numbers, which tell pixels apart.
    pub pixel: &'a U32x16,
    /// Distance between neighbouring points over the distance from the eye.
    pub spacing: f32,
}

/// Divides the hits in `lanes` into groups, in the order of their first lanes.
pub(super) fn collect<'w>(world: &'w World, hits: &FirstHits16, lanes: u16, groups: &mut Vec<Group<'w>>) {
    groups.clear();
    let FirstHits16 { surfaces, directions, .. } = *hits;
    let mut left = lanes;
    while left != 0 {
        let first = left.trailing_zeros() as usize;
        let alike = hits.like(world, first) & left | 1 << first;
        let (bsdf, lanes) = world.mean_bsdf(surfaces, alike);
        let bsdf = bsdf.on_relief(|| world.level_normal(&surfaces.get(first)));
        left &= !lanes;
        let front = directions.get(first).dot(surfaces.shading_normal.get(first)) < 0.0;
        let (mut normal_sum, mut out) = (Vec3::ZERO, Vec3::ZERO);
        for lane in lanes_in(lanes) {
            normal_sum += surfaces.shading_normal.get(lane);
            out -= directions.get(lane);
        }
        let (mut frame, mut out) = (frame_of(world, surfaces, first, normal_sum), out.normalize_or_zero());
        if (frame.normal.dot(out) > 0.0) != front {
            // At grazing angles the means may be on different sides.
            (frame, out) = (surfaces.frame(first), -directions.get(first));
        }
        let side = if front { 1.0 } else { -1.0 };
        groups.push(Group {
            lanes,
            bsdf,
            normal: frame.normal * side,
            frame,
            out,
            normal_sum: normal_sum * side,
        });
    }
}

/// Returns the shading frame around a sum of normals. Where tangents matter, it is that of the first lane.
fn frame_of(world: &World, surfaces: &Surfaces16, first: usize, normals: Vec3) -> Frame {
    match normals.try_normalize() {
        Some(normal) if !world.turns_frames() => Frame::from_normal(normal),
        _ => surfaces.frame(first),
    }
}

impl FirstHits16<'_> {
    /// Returns the lanes that see about what the lane `first` sees, whatever their BSDFs.
    fn like(&self, world: &World, first: usize) -> u16 {
        let FirstHits16 { surfaces: s, directions, pixel, spacing } = *self;
        let material = |mesh: u32| world.material(mesh);
        let id = material(s.mesh[first]);
        let min_cos = min_cos(world, id);
        let (position, normal) = (s.position.get(first), s.shading_normal.get(first));
        let along = directions.get(first);
        let front = along.dot(normal) < 0.0;
        let spacing = spacing * s.t[first] / along.dot(normal).abs().max(0.05).sqrt();
        let most_sq = (MAX_DISTANCE * spacing) * (MAX_DISTANCE * spacing);
        let mut same: U32x16 = [1; LANES];
        if s.mesh != [s.mesh[first]; LANES] {
            same = s.mesh.map(|mesh| u32::from(material(mesh) == id));
        }
        for i in 0..LANES {
            let between = s.position.get(i) - position;
            let (n, direction) = (s.shading_normal.get(i), directions.get(i));
            let near =
                (between.length_squared() < most_sq) & (normal.dot(between).abs() < MAX_HEIGHT * spacing);
            let alike = (normal.dot(n) > min_cos) & ((direction.dot(n) < 0.0) == front);
            let seen = (along.dot(direction) > MIN_OUT_COS) & (pixel[i] == pixel[first]);
            same[i] &= u32::from(near & alike & seen);
        }
        mask_of(&same)
    }
}

/// Returns the minimum cosine between the normals of a group of a material.
fn min_cos(world: &World, id: MaterialId) -> f32 {
    let angle = ALPHA_SHARE * world.materials.min_alpha(id);
    (1.0 - 0.5 * angle * angle).max(MIN_COS)
}
