//! Light of evaluated clusters, and corrections of sampled clusters, at points among the anchors.

use super::basis::BasisValues;
use super::classify::{EvaluatedCluster, MAX_CORRECTION, SampledCluster};
use crate::lightcut::clamp::is_weak;
use crate::lightcut::packet::{PacketCluster, luminances};
use crate::lightcut::{CutCounts, ReceiverPacket, Transfer, Visibility};
use base::math::{LANES, Rgb, Vec3x16};

/// Gathering of a packet's light.
pub(super) struct Gathering<'a, 't, 'm, V> {
    pub transfer: &'a Transfer<'t>,
    pub visibility: &'a V,
    pub receivers: &'a ReceiverPacket<'m>,
    /// Light gathered so far that is not clamped.
    pub strong: Vec3x16,
    /// Clusters that may be clamped.
    pub weak: &'a mut Vec<PacketCluster>,
    pub counts: &'a mut CutCounts,
}

impl<V: Visibility> Gathering<'_, '_, '_, V> {
    /// Adds evaluated clusters. If a cluster is split, its children are split above the luminance `min_split`.
    pub fn evaluate(&mut self, clusters: &[EvaluatedCluster], min_split: f32) {
        let mut parts: Vec<EvaluatedCluster> = Vec::new();
        for &cluster in clusters {
            parts.push(cluster);
            while let Some(EvaluatedCluster { node, shadow_above, split_above }) = parts.pop() {
                let n = &self.transfer.trees.nodes[node as usize];
                let Some(responses) = self.responses(node, shadow_above) else { continue };
                let too_bright = || luminances(n.intensity, &responses).iter().any(|&y| y > split_above);
                match n.children() {
                    _ if is_weak(n) => self.weak.push(PacketCluster { node, responses }),
                    Some(left) if too_bright() => {
                        let part =
                            |node| EvaluatedCluster { node, shadow_above: 0.0, split_above: min_split };
                        parts.extend([part(left), part(left + 1)]);
                    }
                    _ => self.strong.add_scaled(n.intensity, &responses),
                }
            }
        }
    }

    /// Corrects the fits of sampled clusters, each with its probability. No correction is brighter than half the
    /// luminance of the point or half the anchors' mean `luminance`. Otherwise an unlikely cluster that is much
    /// brighter at the point than at any anchor would be a firefly.
    pub fn correct(&mut self, clusters: &[SampledCluster], basis: &BasisValues, start: f32, luminance: f32) {
        let limits = luminances(Rgb::ONE, &self.strong).map(|y| MAX_CORRECTION * y.max(luminance));
        let mut ticket = start;
        for SampledCluster { node, probability, fit } in clusters {
            ticket += probability;
            if ticket < 1.0 {
                continue;
            }
            ticket -= 1.0;
            let mut error = fit.reflected(self.receivers, basis);
            for row in [&mut error.x, &mut error.y, &mut error.z] {
                row.iter_mut().for_each(|e| *e = -*e);
            }
            if let Some(responses) = self.responses(*node, 0.0) {
                error.add_scaled(Rgb::ONE, &responses);
            }
            let scale = self.transfer.trees.nodes[*node as usize].intensity / *probability;
            let y = luminances(scale, &error);
            for row in [&mut error.x, &mut error.y, &mut error.z] {
                for l in 0..LANES {
                    row[l] *= if y[l].abs() > limits[l] { limits[l] / y[l].abs() } else { 1.0 };
                }
            }
            self.strong.add_scaled(scale, &error);
        }
    }

    /// Returns the contribution of a cluster of unit intensity to each point, with a shadow ray if its luminance is
    /// above `shadow_above`; `None` if it lights no point.
    fn responses(&mut self, node: u32, shadow_above: f32) -> Option<Vec3x16> {
        let n = &self.transfer.trees.nodes[node as usize];
        let vpl = &self.transfer.trees.vpls[n.representative()];
        let (lit, mut responses) = self.transfer.unshadowed16(self.receivers, vpl, n.kind());
        if lit == 0 {
            return None;
        }
        let y = luminances(n.intensity, &responses);
        let doubtful = (0..LANES).fold(0, |mask, l| mask | u16::from(y[l] > shadow_above) << l) & lit;
        if doubtful != 0 {
            self.counts.rays += u64::from(doubtful.count_ones());
            self.counts.packets += 1;
            let visible = self.receivers.visible(self.visibility, doubtful, vpl, n);
            responses.keep(visible | !doubtful);
            self.receivers.attenuate(self.visibility, visible, self.transfer.trees, n, &mut responses);
        }
        Some(responses)
    }
}
