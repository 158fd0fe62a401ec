//! Up to sixteen segments to be asked for together.

use super::{Packing, segment};
use crate::embree::{Rays16, Skip16, TriangleId};
use glam::Vec3;

/// An end of a segment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct End {
    /// Where.
    pub position: Vec3,
    /// Unit geometric normal, zero on no surface.
    pub normal: Vec3,
    /// The triangle it lies on, which does not occlude it; [`TriangleId::NONE`] if that is not known.
    pub triangle: TriangleId,
}

/// Segments that share a packet.
#[derive(Clone, Debug)]
pub struct Batch {
    /// What they have in common.
    pub packing: Packing,
    pub(super) rays: Rays16,
    pub(super) skip: Skip16,
    pub(super) keys: [u32; 16],
    pub(super) count: usize,
}

impl Batch {
    /// None yet.
    pub fn new(packing: Packing) -> Batch {
        Batch { packing, rays: Rays16::default(), skip: Skip16::default(), keys: [0; 16], count: 0 }
    }

    /// Adds the segment from a receiver to a light, both ends moved off their surfaces. `key` names the light to the
    /// occluder cache. Returns whether the batch is now full; a full batch takes no more.
    pub fn push(&mut self, from: &End, to: &End, key: u32) -> bool {
        if self.count < 16 {
            let ray = segment(from.position, from.normal, to.position, to.normal);
            self.rays.set(self.count, &ray);
            self.skip.set(self.count, [from.triangle, to.triangle]);
            self.keys[self.count] = key;
            self.count += 1;
        }
        self.count == 16
    }

    /// How many segments.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// Takes all segments out.
    pub fn clear(&mut self) {
        self.count = 0;
    }

    /// From the start of a segment to its occluder at `t`.
    pub fn distance(&self, lane: usize, t: f32) -> f32 {
        t * self.rays.get(lane).direction.length()
    }
}
