//! Statistics and remarks that the stages of a frame collect.

use super::frame::Remark;
use base::stats::Stats;

/// Statistics and remarks of a frame so far.
#[derive(Default)]
pub struct Notes {
    /// Counters and times.
    pub stats: Stats,
    /// Remarks for the user.
    pub remarks: Vec<Remark>,
}
