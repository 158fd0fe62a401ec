//! Samples of a cut on their way: down the trees, then along shadow rays.

use crate::lightcut::{CutCounts, Visibility};
use crate::lights::LightNode;
use base::math::{F32x16, LANES, Rgb, Vec3x16, first_lanes, lanes_in, luminance};
use embree::{Ray, Rays16};

/// Sample whose VPL is visible.
#[derive(Clone, Copy)]
pub(super) struct Sample {
    pub(super) light: Rgb,
    /// Inverse of the density for samples of leaves that may be clamped; infinite for others.
    pub(super) factor: f32,
    /// Geometry term of indirect light, which may be clamped; 0 for direct light.
    pub(super) geometry: f32,
}

/// Sample on its way from a cluster to a descendant.
#[derive(Clone, Copy)]
pub(super) struct Descent {
    /// Node reached.
    pub(super) node: u32,
    /// Random number that chooses the descendant.
    pub(super) u: f32,
    /// Number of samples per contribution of the cluster.
    pub(super) of_cluster: f32,
    /// Probability of the node among the cluster's descendants.
    pub(super) density: f32,
    /// Lane of the sample's point.
    pub(super) lane: u8,
}

/// Samples whose rays have not been traced yet.
#[derive(Default)]
pub(super) struct Pending {
    pub(super) rays: Rays16,
    pub(super) light: Vec3x16,
    pub(super) factors: F32x16,
    pub(super) geometries: F32x16,
    /// Maximum numbers of sheets that the samples' light passes (see [`crate::lightcut::Receiver::sheets`]).
    pub(super) sheets: [Option<u32>; LANES],
    /// Lanes of the samples' points.
    pub(super) points: [u8; LANES],
    pub(super) count: usize,
}

impl Pending {
    /// Adds a sample of the point in `lane`; returns true if the packet is full.
    #[inline]
    pub(super) fn push(&mut self, ray: &Ray, sample: Sample, lane: usize) -> bool {
        self.rays.set(self.count, ray);
        self.light.set(self.count, sample.light);
        self.factors[self.count] = sample.factor;
        self.geometries[self.count] = sample.geometry;
        self.points[self.count] = lane as u8;
        self.count += 1;
        self.count == LANES
    }

    /// Traces the rays, and keeps the samples whose VPLs are visible.
    pub(super) fn trace<V: Visibility>(
        &mut self,
        visibility: &V,
        visible: &mut [Vec<Sample>; LANES],
        counts: &mut CutCounts,
    ) {
        let count = std::mem::take(&mut self.count);
        if count == 0 {
            return;
        }
        counts.rays += count as u64;
        counts.packets += 1;
        let free = visibility.visible16(&self.rays, first_lanes(count), None);
        visibility.attenuate(&self.rays, free, |i| self.sheets[i], &mut self.light);
        for i in lanes_in(free) {
            let (factor, geometry) = (self.factors[i], self.geometries[i]);
            let sample = Sample { light: self.light.get(i), factor, geometry };
            visible[usize::from(self.points[i])].push(sample);
        }
    }
}

impl Descent {
    /// Descends to a child, in proportion to luminance; stays at a leaf.
    #[inline]
    pub(super) fn descend(&mut self, nodes: &[LightNode]) {
        let Some(left) = nodes[self.node as usize].children() else { return };
        let [of_left, of_right] = [left, left + 1].map(|child| luminance(nodes[child as usize].intensity));
        let p = of_left / (of_left + of_right);
        if self.u < p {
            (self.node, self.u, self.density) = (left, self.u / p, self.density * p);
        } else {
            // Rounding must not make the number 1, which would choose a right child of probability 0.
            let rest = ((self.u - p) / (1.0 - p)).min(1.0 - f32::EPSILON);
            (self.node, self.u, self.density) = (left + 1, rest, self.density * (1.0 - p));
        }
    }
}
