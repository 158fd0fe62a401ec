//! Sum over a packet's cut, with weak singularities clamped.

use super::{PacketCluster, PacketSum, ReceiverPacket};
use crate::lightcut::CutCounts;
use crate::lightcut::clamp::{DOMINANT, Unclamped, is_weak};
use crate::lights::LightTrees;
use base::math::{F32x16, LANES, LUMINANCE, Rgb, Vec3x16, lanes_in, luminance};

/// Light that a packet gathers.
pub(in crate::lightcut) struct PacketLight<'a> {
    /// Clusters; the weak singularities among them are clamped.
    pub clusters: &'a [PacketCluster],
    /// Further light, which is not clamped.
    pub strong: Vec3x16,
}

impl PacketLight<'_> {
    /// Returns the sum, in which no weak singularity has more than the share `clamp`.
    pub fn sum(
        &self,
        trees: &LightTrees,
        receivers: &ReceiverPacket,
        clamp: Option<f32>,
        counts: &mut CutCounts,
    ) -> PacketSum {
        let (sums, brightest_leaf) = self.unclamped(trees);
        let mut all = PacketSum::default();
        for lane in lanes_in(receivers.valid) {
            let (sum, baseline) = (sums.get(lane), receivers.baseline[lane]);
            let total = luminance(sum) + baseline;
            counts.luminance += f64::from(luminance(sum));
            (all.radiance[lane], all.limits[lane]) = match clamp {
                // Otherwise nothing is clamped: the frozen luminance is less than the total only if a leaf is dominant.
                Some(clamp) if total > 0.0 && brightest_leaf[lane] > clamp.min(DOMINANT) * total => {
                    let contributions = self
                        .clusters
                        .iter()
                        .map(|c| (c.node, trees.nodes[c.node as usize].intensity * c.responses.get(lane)));
                    let strong = self.strong.get(lane);
                    Unclamped { trees, contributions, strong, sum, baseline }.clamped(clamp, counts)
                }
                _ => (sum, clamp.map_or(f32::INFINITY, |clamp| clamp * total)),
            };
        }
        all
    }

    /// Returns the sum before clamping, and the luminance of the brightest weak singularity.
    fn unclamped(&self, trees: &LightTrees) -> (Vec3x16, F32x16) {
        let mut sums = self.strong;
        let mut brightest_leaf = [0.0; LANES];
        for cluster in self.clusters {
            let node = &trees.nodes[cluster.node as usize];
            sums.add_scaled(node.intensity, &cluster.responses);
            if is_weak(node) {
                for (b, y) in brightest_leaf.iter_mut().zip(luminances(node.intensity, &cluster.responses)) {
                    *b = if y > *b { y } else { *b };
                }
            }
        }
        (sums, brightest_leaf)
    }
}

/// Returns the luminance of each lane's colour times `intensity`.
#[inline]
pub(in crate::lightcut) fn luminances(intensity: Rgb, responses: &Vec3x16) -> F32x16 {
    let (w, r) = (intensity * LUMINANCE, responses);
    // Closures might not be inlined here, so this is a loop.
    let mut luminances = [0.0; LANES];
    for l in 0..LANES {
        luminances[l] = w.x * r.x[l] + w.y * r.y[l] + w.z * r.z[l];
    }
    luminances
}
