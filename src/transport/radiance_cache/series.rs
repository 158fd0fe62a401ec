//! Sums of the light at a record into series of radiance.

use super::cells::Candidate;
use super::lit_cluster::LitCluster;
use crate::gradient::Incidence;
use crate::hsh::{Accumulator, Radiance};
use crate::lights::{DirectIndirect, Origin};
use base::math::{Frame, Rgb};
use glam::Vec3;

/// Gatherer of a record's light as series, cluster by cluster.
#[derive(Default)]
pub struct SeriesGatherer {
    /// Sums per layer; `None` before the first series.
    sums: Option<DirectIndirect<Accumulator>>,
    /// Tangent frame and position of the record, if it needs series.
    place: Option<(Frame, Vec3)>,
}

impl SeriesGatherer {
    /// Begins a record. Nothing is summed if irradiance is enough there.
    pub fn begin(&mut self, candidate: &Candidate) {
        let bands = usize::from(candidate.bands);
        let point = &candidate.point;
        self.place = (bands > 0).then(|| (Frame::from_normal(point.normal), point.position));
        if bands > 0 {
            let sums = self.sums.get_or_insert_with(|| DirectIndirect::from_fn(|_| Accumulator::new(bands)));
            sums.direct.reset(bands);
            sums.indirect.reset(bands);
        }
    }

    /// Adds a visible cluster, of which clamping retains a share.
    #[inline]
    pub fn add(&mut self, cluster: &LitCluster, retained: f32) {
        let Some((frame, position)) = &self.place else { return };
        let &LitCluster { transfer, node, vpl } = cluster;
        let profiles = &transfer.trees.profiles;
        let incidence = Incidence::of_vpl(frame, *position, vpl, node.kind(), profiles, cluster.near_sq());
        if let Some(incidence) = incidence {
            let incidence = if retained < 1.0 { incidence.held(retained) } else { incidence };
            self.add_incidence(node.origin(), &incidence, node.intensity);
        }
    }

    /// Returns true if the record needs series.
    pub fn is_wanted(&self) -> bool {
        self.place.is_some()
    }

    /// Adds light to a layer, in the tangent frame of the record.
    #[inline]
    pub fn add_incidence(&mut self, origin: Origin, incidence: &Incidence, intensity: Rgb) {
        if let (Some(_), Some(sums)) = (self.place, &mut self.sums) {
            sums[origin].add(incidence, intensity);
        }
    }

    /// Ends the record. Returns the light of each layer as a series, if the record needs one.
    pub fn finish(&mut self) -> DirectIndirect<Option<Radiance>> {
        match (self.place, &mut self.sums) {
            (Some(_), Some(sums)) => {
                DirectIndirect { direct: Some(sums.direct.finish()), indirect: Some(sums.indirect.finish()) }
            }
            _ => DirectIndirect::default(),
        }
    }
}
