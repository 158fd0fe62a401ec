//! Results of former renders on which a render builds.

use crate::method::path::PartialImage;
use crate::method::{Outlook, RetainedRecords};
use transport::perception::Thresholds;
use transport::reprojection::PreviousImage;

/// Results of former renders.
pub(crate) enum Former<'a> {
    /// No results.
    Nothing,
    /// The previous frames of a walk.
    Frames(WalkState<'a>),
    /// An interrupted image of the same goal.
    Samples(PartialImage),
}

/// State of a walk, which a frame reads and updates.
pub struct WalkState<'a> {
    /// Records of indirect light.
    pub records: &'a mut RetainedRecords,
    /// The previous image, if sampled light is reprojected from it.
    pub last: Option<&'a mut PreviousImage>,
    /// Visibility thresholds of the previous image, if records are adapted to them.
    pub thresholds: Option<VisibleDifferences<'a>>,
    /// Surfaces that all views see, if the frames are views of a list.
    pub outlook: Option<&'a Outlook>,
}

/// Visibility thresholds of the previous image, and how the next ones are made.
pub struct VisibleDifferences<'a> {
    /// The thresholds.
    pub thresholds: &'a mut Thresholds,
    /// Scale of the quantisation.
    pub q_scale: f32,
}
