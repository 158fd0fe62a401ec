//! Candidates for records, and cells of the kd-tree over the eye samples that are worth a record, in an image whose
//! records other images may use.

use super::settings::{CacheSettings, WALK_FRAMES};
use crate::lightcut::Receiver;
use crate::lights::DirectIndirect;
use base::math::Frame;
use world::SurfacePoint;

/// Minimum share of the eye samples in a cell that must lack light, for the cell to get a record, in views of a list.
const VIEWS_LACKING: f32 = 0.25;

/// Approximate time of an exact record over the time of a loose one.
const EXACT_OVER_LOOSE: f32 = 2.0;

/// Limits on the cells that get a record.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellLimits {
    /// Minimum number of eye samples in a cell that gets a record.
    pub least: u32,
    /// Minimum share of the eye samples in a cell that records must lack, for the cell to get a record.
    pub least_lacking: f32,
    /// Minimum number of eye samples in a cell whose record is exact. Records of smaller cells are loose.
    exact: u32,
    /// Minimum error bound of a cluster in the cut of a loose record.
    loose_epsilon: f32,
}

impl CellLimits {
    /// Creates the limits of a still or of a film's frame: every cell of sufficient size that lacks light anywhere gets
    /// an exact record.
    pub fn new(settings: &CacheSettings) -> CellLimits {
        CellLimits { least: settings.least_cell, least_lacking: 0.0, exact: 0, loose_epsilon: 0.0 }
    }

    /// Creates the limits of a view of a list, which has the records of former views. `overlap` is the mean number of
    /// views that see a surface, over which the cost of a record is amortised.
    ///
    /// Cells too small for the record of a still have a loose record: it takes the place of a few cuts of eye samples,
    /// whose error bound is `epsilon`, and is as exact as they are.
    ///
    /// Without overlap, a view is a still. A still gives a record to every cell that lacks light anywhere. If most of a
    /// cell has light already, the rest is mostly fine detail, which a record hardly covers.
    pub fn of_views(settings: &CacheSettings, overlap: f32, epsilon: f32) -> CellLimits {
        if overlap <= 1.0 {
            return CellLimits::new(settings);
        }
        let exact = settings.least_cell;
        let finer = 1.0 + EXACT_OVER_LOOSE * (overlap.min(WALK_FRAMES as f32) - 1.0);
        let least = ((exact as f32 / finer) as u32).max(1);
        CellLimits { least, least_lacking: VIEWS_LACKING, exact, loose_epsilon: epsilon }
    }

    /// Returns the error bound of the cut of a record in a cell of so many eye samples, given the bound of exact ones.
    pub fn epsilon(&self, exact: f32, cell: u32) -> f32 {
        if cell < self.exact { exact.max(self.loose_epsilon) } else { exact }
    }
}

/// Point at which records are to be computed.
#[derive(Clone, Copy, Debug)]
pub struct Candidate {
    /// Index of the eye sample that it was chosen from; seeds the directions of rays.
    pub sample: u32,
    /// Position and normals.
    pub point: SurfacePoint,
    /// Approximate number of eye samples in the cell that it was chosen for.
    pub cell: u32,
    /// Approximate distance to the next eye sample: the unit of footprint radii.
    pub spacing: f32,
    /// Distance to the nearest visible point that rises from the surface; infinite if there is none nearby.
    pub clearance: f32,
    /// Coat that the light has to pass (see [`world::material::Bsdf::coat`]); 0 without a coat.
    pub coat: u32,
    /// Maximum number of edges that light may take to the point.
    pub edges: u16,
    /// Bands of the series that the surface needs; 0 if irradiance is enough.
    pub bands: u8,
    /// Layers that lack a record here.
    pub missing: DirectIndirect<bool>,
    /// Luminance of the irradiance known from other sources: records of the other layer, and sampled light.
    pub baseline_luminance: f32,
}

impl Candidate {
    /// Returns the receiver of the irradiance on the side of the normal.
    pub fn receiver(&self) -> Receiver<'static> {
        let SurfacePoint { position, normal, geometric_normal } = self.point;
        Receiver::irradiance(position, geometric_normal, &Frame::from_normal(normal))
            .with_baseline(self.baseline_luminance)
            .with_edges(self.edges)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn records_of_views_are_finer_the_more_views_overlap_and_views_alone_are_stills() {
        let still = CacheSettings::default();
        let of = |still: &CacheSettings, overlap| CellLimits::of_views(still, overlap, 0.05);
        assert_eq!(of(&still, 1.0), CellLimits::new(&still));
        let cells = [1.5, 2.0, 6.0, 8.0, 100.0].map(|overlap| of(&still, overlap).least);
        assert!(cells[0] < still.least_cell && cells.is_sorted_by(|a, b| a >= b), "{cells:?}");
        assert_eq!(cells[3], cells[4]);
        assert!(of(&CacheSettings { least_cell: 1, ..still }, 9.0).least >= 1);
    }

    #[test]
    fn records_of_views_are_as_exact_as_a_still_in_its_cells_and_as_cuts_in_smaller_ones() {
        let still = CacheSettings::default();
        let exact = still.epsilon;
        let of_views = |epsilon| CellLimits::of_views(&still, 4.0, epsilon);
        for cell in [1, still.least_cell - 1, still.least_cell, 100_000] {
            assert_eq!(CellLimits::new(&still).epsilon(exact, cell), exact);
            let expected = if cell < still.least_cell { 0.05 } else { exact };
            assert_eq!(of_views(0.05).epsilon(exact, cell), expected);
            // Cuts that are more exact than records leave records as they are.
            assert_eq!(of_views(1e-4).epsilon(exact, cell), exact);
        }
    }
}
