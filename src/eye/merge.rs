//! Merging of the ends of a pixel's chains into shading points: one point stands for all samples of the pixel that see
//! much the same of one surface by the same way.
//!
//! A point has the position and normals of its first sample and the weights of all, and reflects by their mean
//! factors, so that textures are antialiased. Deviations: ends of chains through mirrors, glass and sharp lobes, which
//! may be many to a pixel, are thinned in proportion to the light they may carry, with weights that keep the mean.

use super::points::{PointGeometry, PointSurface};
use crate::math::{Rgb, luminance};
use crate::paths::ChainEnd;

/// Minimum cosine between normals of samples that are merged: 11 degrees.
const MIN_COS: f32 = 0.98;

/// Maximum distance between samples that are merged, and from each other's plane, in spacings.
const MAX_DISTANCE: f32 = 16.0;
const MAX_HEIGHT: f32 = 0.5;

/// Mean number of points a pixel that ends of chains beyond mirrors, glass and sharp lobes get if all its light comes
/// through them.
const CHAINED_POINTS: f32 = 2.0;

/// A shading point in the making.
#[derive(Clone, Copy, Debug)]
pub struct MergedPoint<'w> {
    /// Geometry of its first sample.
    pub geometry: PointGeometry,
    /// Surface with the mean BSDF of its samples.
    pub surface: PointSurface<'w>,
    /// Sum of the samples' throughputs.
    pub weight: Rgb,
    way: u32,
    depth: u32,
}

impl<'w> MergedPoint<'w> {
    /// The point of one chain's end; `spacing` is the distance to that of the next pixel. `None` if it cannot be lit.
    pub fn new(end: &ChainEnd<'w>, spacing: f32) -> Option<MergedPoint<'w>> {
        let ChainEnd { surface: s, bsdf, out, .. } = end;
        let front = s.frame.normal.dot(*out) > 0.0;
        let normal = if front { s.frame.normal } else { -s.frame.normal };
        // Foreshortening is limited, so that grazing samples do not claim whole floors.
        let spacing = spacing / normal.dot(*out).max(0.05).sqrt();
        let geometry = PointGeometry { position: s.position, spacing, normal, coat: bsdf.coat() };
        let surface = PointSurface { bsdf: *bsdf, geometric_normal: s.normal, out: *out };
        let finite = s.position.is_finite() && spacing.is_finite() && end.throughput.is_finite();
        let point = MergedPoint { geometry, surface, weight: end.throughput, way: end.way, depth: end.depth };
        finite.then_some(point)
    }

    /// True if `other` may be merged into it.
    fn takes(&self, other: &MergedPoint) -> bool {
        let (a, b) = (&self.geometry, &other.geometry);
        let (mine, others) = (&self.surface.bsdf, &other.surface.bsdf);
        let between = b.position - a.position;
        self.way == other.way
            && mine.material() == others.material()
            && mine.same_lobes(others)
            && a.normal.dot(b.normal) > MIN_COS
            && between.length_squared() < (MAX_DISTANCE * a.spacing).powi(2)
            && a.normal.dot(between).abs() < MAX_HEIGHT * a.spacing
    }

    fn merge(&mut self, other: &MergedPoint<'w>) {
        self.surface.bsdf = self.surface.bsdf.mean(self.weight, &other.surface.bsdf, other.weight);
        self.weight += other.weight;
    }

    /// Luminance of the share of the light that the point reflects into the pixel.
    fn carried(&self) -> f32 {
        let cos = self.surface.out.dot(self.geometry.normal);
        luminance(self.weight * self.surface.bsdf.mean_albedo(cos))
    }
}

/// Merges the points of one pixel, in order, and thins those beyond mirrors, glass and sharp lobes; `draw` in [0, 1)
/// chooses among them.
pub fn merge<'w>(
    samples: impl Iterator<Item = MergedPoint<'w>>,
    draw: f32,
    merged: &mut Vec<MergedPoint<'w>>,
) {
    merged.clear();
    for sample in samples {
        match merged.iter_mut().find(|point| point.takes(&sample)) {
            Some(point) => point.merge(&sample),
            None => merged.push(sample),
        }
    }
    if merged.iter().all(|point| point.depth <= 1) {
        return;
    }
    let total: f32 = merged.iter().map(MergedPoint::carried).sum();
    let mut reached = draw;
    merged.retain_mut(|point| {
        if point.depth <= 1 {
            return true;
        }
        let kept = (CHAINED_POINTS * point.carried() / total).min(1.0);
        let before = reached;
        reached += kept;
        point.weight /= kept;
        before.floor() != reached.floor()
    });
}
