//! A cut as it lights the points of up to sixteen records, and the sums over its clusters.
//!
//! One pass computes the light of each cluster at all points ([`Arriving16`]). Irradiance, second derivatives and
//! series are sums over that light.

use super::cells::Candidate;
use super::gather::GatheredLayer16;
use super::lit_cluster::{Arriving16, LitCluster, RecordPoints};
use super::occluder_distance::OccluderDistances;
use super::occlusion_hessian::OcclusionHessian;
use super::series::SeriesGatherer;
use crate::hsh::Radiance;
use crate::lightcut::{Clamps, PacketCluster, ReceiverPacket, Transfer};
use crate::lights::{DirectIndirect, Origin};
use base::math::{Rgb, lanes_in, luminance};
use rayon::prelude::*;

/// Minimum number of clusters whose light a thread computes at once.
const MIN_CLUSTERS: usize = 32;

/// Clusters of a cut with their light at the points of records.
pub struct LitCut<'a> {
    transfer: &'a Transfer<'a>,
    clusters: &'a [PacketCluster],
    /// Light of each cluster.
    arriving: &'a [Arriving16],
}

impl<'a> LitCut<'a> {
    /// Computes the light of `clusters` at the points, clamped by the `clamps` of the `receivers` there. `arriving` is
    /// the buffer for it.
    pub fn new(
        transfer: &'a Transfer<'a>,
        clusters: &'a [PacketCluster],
        points: &RecordPoints,
        receivers: &ReceiverPacket,
        clamps: &Clamps,
        arriving: &'a mut Vec<Arriving16>,
    ) -> LitCut<'a> {
        let light = |PacketCluster { node, responses }: &PacketCluster| {
            let cluster = LitCluster::new(transfer, *node);
            let retained = clamps.retained(transfer, receivers, cluster.node, responses);
            points.arriving(&cluster, responses, retained)
        };
        clusters.par_iter().with_min_len(MIN_CLUSTERS).map(light).collect_into_vec(arriving);
        LitCut { transfer, clusters, arriving }
    }

    /// Iterates over the clusters and their light.
    fn lit(&self) -> impl Iterator<Item = (LitCluster<'a>, &'a Arriving16)> {
        let clusters = self.clusters.iter().map(|cluster| LitCluster::new(self.transfer, cluster.node));
        clusters.zip(self.arriving)
    }

    /// Sums the light of each layer. Adds the light, and the second derivatives of the sums, to the hessians of the
    /// points.
    pub fn layers(
        &self,
        points: &RecordPoints,
        hessians: &mut [OcclusionHessian],
    ) -> DirectIndirect<GatheredLayer16> {
        let (layers, ()) = rayon::join(
            || {
                let mut layers = DirectIndirect::<GatheredLayer16>::default();
                for (cluster, light) in self.lit() {
                    layers[cluster.node.origin()].add(points, &cluster, light);
                }
                layers
            },
            || {
                for (cluster, light) in self.lit() {
                    OcclusionHessian::add_arriving(hessians, cluster.node.origin(), light);
                }
            },
        );
        for (lane, hessian) in hessians.iter_mut().enumerate() {
            let add = |origin| hessian.add_smooth(origin, layers[origin].second_derivatives(lane));
            Origin::ALL.into_iter().for_each(add);
        }
        layers
    }

    /// Adds the clusters that are hidden from a point to the distances of `layers`. `points` are the receivers of the
    /// cut.
    pub fn add_hidden(
        &self,
        occluders: &OccluderDistances,
        points: &ReceiverPacket,
        clamps: &Clamps,
        layers: &mut DirectIndirect<GatheredLayer16>,
    ) {
        for PacketCluster { node, responses } in self.clusters {
            let cluster = LitCluster::new(self.transfer, *node);
            let (lit, unshadowed) = self.transfer.unshadowed16(points, cluster.vpl, cluster.node.kind());
            let retained = clamps.retained(self.transfer, points, cluster.node, &unshadowed);
            let y = luminance(cluster.node.intensity);
            // A pane may take one colour of light that arrives.
            for lane in lanes_in(lit).filter(|&lane| responses.get(lane) == Rgb::ZERO) {
                let distance = occluders.get(cluster.node, lane);
                let arriving = y * unshadowed.x[lane] * retained[lane];
                layers[cluster.node.origin()].hidden(lane, arriving, distance);
            }
        }
    }

    /// Sums the light of each layer at the point in `lane` as a series, if the candidate there needs one.
    pub fn series(
        &self,
        gatherer: &mut SeriesGatherer,
        candidate: &Candidate,
        lane: usize,
    ) -> DirectIndirect<Option<Radiance>> {
        gatherer.begin(candidate);
        if gatherer.is_wanted() {
            let visible = self.clusters.iter().map(|cluster| cluster.responses.get(lane) != Rgb::ZERO);
            for ((cluster, light), _) in self.lit().zip(visible).filter(|(_, is_visible)| *is_visible) {
                gatherer.add(&cluster, light.retained[lane]);
            }
        }
        gatherer.finish()
    }
}
