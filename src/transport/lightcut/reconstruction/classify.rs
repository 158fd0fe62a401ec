//! Classes of the clusters of an anchors' cut.
//!
//! ε is that of the cut. "Share" is a cluster's unshadowed luminance relative to the anchors' totals, averaged over the
//! anchors. "Error" is the root mean square, over the anchors, of the difference between fit and cluster relative to
//! the total:
//!
//! | threshold | value | meaning |
//! |---|--:|---|
//! | `LARGE` | 0.35 | a share above `LARGE` · ε is evaluated with a shadow ray at every point (1) |
//! | `SMOOTH` | 0.3 | a cluster visible from all anchors is fitted if error ≤ `SMOOTH` · ε · √share (2) |
//! | `DOUBT` | 0.2 | minimum error, relative to the share, of a cluster visible from some anchors only |
//! | `CERTAIN` | 0.4 | such a cluster is sampled with probability error / (`CERTAIN` · ε), and evaluated at 1 |
//! | `BRIGHTER` | 2 | minimum brightness, relative to all anchors, at which a point needs a shadow ray (3) |
//! | `MAX_CORRECTION` | 0.5 | maximum luminance of one correction, relative to the point's or the anchors' |
//! | `MIN_LUMINANCE` | 1/16 | minimum luminance of an anchor where errors are judged, relative to the brightest |
//!
//! 1. The more light a small occluder blocks, the more visible its shadow is.
//! 2. The larger the cluster, the less relative error is tolerated.
//! 3. This holds even if all anchors see the cluster. It is split if it gives more than ε of the radiance, since it is
//!    much nearer to the point than to the anchors.

use super::fit::{Interpolant, LinearFit};
use crate::lightcut::clamp::is_weak;
use crate::lightcut::packet::{PacketCluster, Unshadowed, luminances};
use crate::lightcut::{PacketSum, ReceiverPacket, Transfer};
use base::math::{F32x16, lanes_in, luminance};

const LARGE: f32 = 0.35;
const SMOOTH: f32 = 0.3;
const DOUBT: f32 = 0.2;
const CERTAIN: f32 = 0.4;
const BRIGHTER: f32 = 2.0;
pub(super) const MAX_CORRECTION: f32 = 0.5;
const MIN_LUMINANCE: f32 = 1.0 / 16.0;

/// Minimum contribution of a weak singularity that is evaluated, relative to the limits of clamping.
const NEARLY_CLAMPED: f32 = 0.5;

/// Minimum relative loss of light that counts as attenuation by thin sheets; less is rounding.
const UNATTENUATED: f32 = 1e-4;

/// Cluster that is evaluated at every point.
#[derive(Clone, Copy, Debug)]
pub(super) struct EvaluatedCluster {
    pub node: u32,
    /// Luminance above which a point needs a shadow ray; 0 if the anchors disagree on the cluster's visibility.
    pub shadow_above: f32,
    /// Luminance above which the cluster is split.
    pub split_above: f32,
}

/// Cluster that is fitted, and corrected at random.
#[derive(Clone, Copy, Debug)]
pub(super) struct SampledCluster {
    pub node: u32,
    /// Probability of the correction.
    pub probability: f32,
    pub fit: LinearFit,
}

/// Class of a cluster.
pub(super) enum Class {
    Dropped,
    Fitted(LinearFit),
    Evaluated(EvaluatedCluster),
    Sampled(SampledCluster),
}

/// Anchors and the light that they gather.
pub(super) struct Anchors<'a, 't, 'm> {
    transfer: &'a Transfer<'t>,
    receivers: &'a ReceiverPacket<'m>,
    sum: &'a PacketSum,
    epsilon: f32,
    /// Inverse of each anchor's luminance, which is limited from below for this.
    inverse_totals: F32x16,
    /// Mean luminance.
    pub luminance: f32,
}

/// Light of a cluster at the anchors.
struct AtAnchors {
    /// Anchors that it would light without occluders.
    lit: u16,
    /// Anchors that see it.
    seen: u16,
    /// True if enough anchors are lit to judge visibility.
    sufficient: bool,
    /// True if some anchors see it through thin sheets that absorb light, which fits do not model.
    attenuated: bool,
    /// Unshadowed luminance.
    luminances: F32x16,
    /// Mean of the luminance over the anchors, relative to their totals.
    share: f32,
}

impl<'a, 't, 'm> Anchors<'a, 't, 'm> {
    pub fn new(
        transfer: &'a Transfer<'t>,
        receivers: &'a ReceiverPacket<'m>,
        sum: &'a PacketSum,
        epsilon: f32,
    ) -> Anchors<'a, 't, 'm> {
        let valid = || lanes_in(receivers.valid);
        let totals: F32x16 = std::array::from_fn(|l| receivers.baseline[l] + luminance(sum.radiance[l]));
        let brightest = valid().map(|l| totals[l]).fold(f32::MIN_POSITIVE, f32::max);
        let inverse_totals = totals.map(|total| 1.0 / total.max(MIN_LUMINANCE * brightest));
        let luminance = valid().map(|l| totals[l]).sum::<f32>() / receivers.len().max(1) as f32;
        Anchors { transfer, receivers, sum, epsilon, inverse_totals, luminance }
    }

    /// Returns the class of a cluster, and the linear fit to it by the functions of `interpolant`.
    pub fn classify(
        &self,
        cluster: &PacketCluster,
        unshadowed: &Unshadowed,
        interpolant: &Interpolant,
    ) -> Class {
        let node = &self.transfer.trees.nodes[cluster.node as usize];
        let at = self.light(cluster, unshadowed);
        let min_split = self.epsilon * self.luminance;
        let evaluated = |shadow_above, split_above| {
            Class::Evaluated(EvaluatedCluster { node: cluster.node, shadow_above, split_above })
        };
        if at.lit == 0 {
            // The cluster is below every anchor's horizon, but part of it may be above a point's horizon.
            return evaluated(0.0, min_split);
        }
        if at.sufficient && at.seen == 0 {
            return Class::Dropped;
        }
        let large = at.share > LARGE * self.epsilon;
        let disputed = at.seen != at.lit || !at.sufficient || large || at.attenuated;
        let brighter = BRIGHTER * lanes_in(at.lit).map(|l| at.luminances[l]).fold(0.0, f32::max);
        let evaluated = || evaluated(if disputed { 0.0 } else { brighter }, brighter.max(min_split));
        let nearly_clamped = || {
            let responses = &unshadowed.responses;
            let strain = self.sum.clamps.strain(self.transfer, self.receivers, node, responses).to_array();
            lanes_in(at.lit).any(|l| strain[l] > NEARLY_CLAMPED)
        };
        if large || at.attenuated || is_weak(node) && nearly_clamped() {
            return evaluated();
        }
        let Some((fit, values)) = interpolant.fit(self.transfer, self.receivers, cluster, at.seen) else {
            return evaluated();
        };
        let error = interpolant.error(self.receivers, node, &values, &self.inverse_totals);
        if !disputed {
            let tolerated = SMOOTH * self.epsilon;
            let smooth = error * error <= tolerated * tolerated * at.share;
            return if smooth { Class::Fitted(fit) } else { evaluated() };
        }
        let probability = error.max(DOUBT * at.share) / (CERTAIN * self.epsilon);
        if probability >= 1.0 {
            return evaluated();
        }
        Class::Sampled(SampledCluster { node: cluster.node, probability, fit })
    }

    fn light(&self, cluster: &PacketCluster, unshadowed: &Unshadowed) -> AtAnchors {
        let node = &self.transfer.trees.nodes[cluster.node as usize];
        let &Unshadowed { lit, responses: ref unshadowed } = unshadowed;
        let r = &cluster.responses;
        let reached = |&l: &usize| r.x[l] + r.y[l] + r.z[l] > 0.0;
        let seen = lanes_in(lit).filter(reached).fold(0u16, |mask, lane| mask | 1 << lane);
        let lacks = |l| (unshadowed.get(l) - r.get(l)).cmpgt(UNATTENUATED * unshadowed.get(l)).any();
        let attenuated = lanes_in(seen).any(lacks);
        let sufficient = lit.count_ones() * 2 >= self.receivers.valid.count_ones();
        let luminances = luminances(node.intensity, unshadowed);
        let relative = lanes_in(lit).map(|l| luminances[l] * self.inverse_totals[l]);
        let share = relative.sum::<f32>() / self.receivers.len() as f32;
        AtAnchors { lit, seen, sufficient, attenuated, luminances, share }
    }
}
