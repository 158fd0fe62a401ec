//! Reasons why there is no frame.

/// Reason why there is no frame.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrameError {
    /// Rendering was cancelled before the first pixel.
    #[error("interrupted before the first pixel; nothing is written")]
    Interrupted,
    /// Rendering was cancelled before its settings were planned.
    #[error("interrupted while planning; nothing is written")]
    Unplanned,
    /// The frame needs more memory than there is.
    #[error(
        "the image would take about {needed:.2} GiB, and {available:.2} GiB of memory are available: take fewer \
         samples (--spp), virtual lights (--set vpls, direct-vpls) or photons (--set photons), render the film in parts with \
         --crop, or use --method lightcuts"
    )]
    Memory {
        /// Memory needed, in GiB.
        needed: f64,
        /// Memory available, in GiB.
        available: f64,
    },
    /// Settings of the method cannot be planned.
    #[error("settings of --method {0} cannot be planned for a time or an error")]
    Unplannable(&'static str),
}
