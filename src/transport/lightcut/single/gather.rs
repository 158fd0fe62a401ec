//! Light that a single point gathers from a cut.

use super::refine::PointRefinement;
use super::{Cut, Lightcut};
use crate::lightcut::clamp::Unclamped;
use crate::lightcut::{CutSettings, Receiver, Transfer, Visibility};
use crate::lights::LightTrees;
use base::math::{Rgb, luminance};
use glam::DVec3;

impl Lightcut {
    /// Creates an empty workspace.
    pub fn new() -> Lightcut {
        Lightcut::default()
    }

    /// Gathers the light of all VPLs to within the error of `settings`.
    pub fn gather<V: Visibility>(
        &mut self,
        transfer: &Transfer,
        visibility: &V,
        receiver: &Receiver,
        settings: &CutSettings,
    ) -> Cut<'_> {
        PointRefinement {
            trees: transfer.trees,
            transfer,
            visibility,
            receiver,
            settings,
            total: 0.0,
            cut: self,
        }
        .run();
        self.counts.cuts += 1;
        self.counts.clusters += self.clusters.len() as u64;
        let (radiance, limit) = self.sum(transfer.trees, settings.clamp, receiver.baseline_luminance());
        Cut { radiance, limit, clusters: &self.clusters }
    }

    /// Returns the sum over the cut, without the rounding errors of the running total, and the luminance above which
    /// leaves were clamped.
    fn sum(&mut self, trees: &LightTrees, clamp: Option<f32>, baseline: f32) -> (Rgb, f32) {
        let sum = self.clusters.iter().fold(DVec3::ZERO, |sum, c| sum + c.contribution.as_dvec3()).as_vec3();
        self.counts.luminance += f64::from(luminance(sum));
        let Some(clamp) = clamp else { return (sum, f32::INFINITY) };
        let contributions = self.clusters.iter().map(|c| (c.node, c.contribution));
        Unclamped { trees, contributions, strong: Rgb::ZERO, sum, baseline }.clamped(clamp, &mut self.counts)
    }
}
