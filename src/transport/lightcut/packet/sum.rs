//! Sum over a packet's cut, with weak singularities clamped.

use super::{Clamps, PacketCluster, PacketSum, ReceiverPacket, luminances};
use crate::lightcut::clamp::{DOMINANT, MAX_STEPS, frozen_luminance, is_weak};
use crate::lightcut::{CutCounts, Transfer};
use base::math::{F32x16, LANES, Vec3x16, lanes_in, luminance};

/// Light that a packet gathers.
pub(in crate::lightcut) struct PacketLight<'a> {
    /// Clusters; the weak singularities among them are clamped.
    pub clusters: &'a [PacketCluster],
    /// Further light, which is not clamped.
    pub strong: Vec3x16,
}

/// Sums before clamping.
struct Unclamped {
    /// Light that is not clamped.
    strong: Vec3x16,
    /// Weak singularities.
    weak: Vec3x16,
    /// Luminance of the brightest weak singularity.
    brightest: F32x16,
}

impl PacketLight<'_> {
    /// Returns the sum, in which weak singularities are limited by the share `clamp` of the frozen luminance.
    pub fn sum(
        &self,
        transfer: &Transfer,
        receivers: &ReceiverPacket,
        clamp: Option<f32>,
        counts: &mut CutCounts,
    ) -> PacketSum {
        let Unclamped { strong, weak, brightest } = self.unclamped(transfer);
        let mut all = PacketSum::default();
        let mut shares = [f32::INFINITY; LANES];
        for lane in lanes_in(receivers.valid) {
            let (sum, baseline) = (strong.get(lane) + weak.get(lane), receivers.baseline[lane]);
            all.radiance[lane] = sum;
            counts.luminance += f64::from(luminance(sum));
            let total = luminance(sum) + baseline;
            if let Some(clamp) = clamp {
                let rest = luminance(strong.get(lane)) + baseline;
                let dominated = total > 0.0 && brightest[lane] > DOMINANT * total;
                let limited = |frozen: f32| rest + self.limited(transfer, lane, DOMINANT * frozen);
                shares[lane] =
                    clamp * if dominated { frozen_luminance(total, MAX_STEPS, limited) } else { total };
            }
        }
        if clamp.is_some() {
            all.clamps = Clamps::new(transfer, receivers, &shares);
            let clamped = self.clamped(transfer, receivers, &all.clamps, counts);
            for lane in lanes_in(receivers.valid) {
                let sum = strong.get(lane) + clamped.get(lane);
                counts.lost += f64::from(luminance(all.radiance[lane] - sum));
                all.radiance[lane] = sum;
            }
        }
        all
    }

    fn unclamped(&self, transfer: &Transfer) -> Unclamped {
        let mut sums = Unclamped { strong: self.strong, weak: Vec3x16::ZERO, brightest: [0.0; LANES] };
        for cluster in self.clusters {
            let node = &transfer.trees.nodes[cluster.node as usize];
            if !is_weak(node) {
                sums.strong.add_scaled(node.intensity, &cluster.responses);
                continue;
            }
            sums.weak.add_scaled(node.intensity, &cluster.responses);
            for (b, y) in sums.brightest.iter_mut().zip(luminances(node.intensity, &cluster.responses)) {
                *b = if y > *b { y } else { *b };
            }
        }
        sums
    }

    /// Returns the luminance of a lane's weak singularities if none gives more than `limit`.
    fn limited(&self, transfer: &Transfer, lane: usize, limit: f32) -> f32 {
        let nodes = self.clusters.iter().map(|c| (&transfer.trees.nodes[c.node as usize], &c.responses));
        let weak = nodes.filter(|(node, _)| is_weak(node));
        weak.map(|(node, responses)| luminance(node.intensity * responses.get(lane)).min(limit)).sum()
    }

    /// Returns the sum of the weak singularities within the limits.
    fn clamped(
        &self,
        transfer: &Transfer,
        receivers: &ReceiverPacket,
        clamps: &Clamps,
        counts: &mut CutCounts,
    ) -> Vec3x16 {
        let mut sum = Vec3x16::ZERO;
        for cluster in self.clusters {
            let node = &transfer.trees.nodes[cluster.node as usize];
            if is_weak(node) {
                let retained = clamps.retained(transfer, receivers, node, &cluster.responses);
                let mut responses = cluster.responses;
                let mut clamped = 0;
                for l in 0..LANES {
                    clamped += u64::from(
                        retained[l] < 1.0 && responses.x[l] + responses.y[l] + responses.z[l] > 0.0,
                    );
                    responses.x[l] *= retained[l];
                    responses.y[l] *= retained[l];
                    responses.z[l] *= retained[l];
                }
                counts.clamped += clamped;
                sum.add_scaled(node.intensity, &responses);
            }
        }
        sum
    }
}
