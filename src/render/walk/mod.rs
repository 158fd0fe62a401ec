//! Walk-throughs: frames along a camera path, lit by records that persist from frame to frame.
//!
//! Paper: Herzog et al. 2009, section 6.4.
//!
//! A [`Walk`] renders one frame after the other. The session holds the scene, virtual lights and light trees. The walk
//! holds the records of indirect light (see [`RetainedRecords`]), so that a frame computes only records that former
//! frames lack. Sampled direct light of smooth surfaces is reprojected from frame to frame and refreshed by few samples
//! (see [`transport::reprojection`]). Elsewhere the random numbers of a pixel are the same in every frame, so that
//! noise which the denoiser leaves does not flicker.
//!
//! A walk may also render views of a list, which follow no path (see [`Walk::of_views`]). They share records and
//! virtual lights, and each view is rendered as a still otherwise: nothing is reprojected, and noise may differ from
//! view to view. [`views`] has what they share before the first one.
//!
//! A frame has the same bits for any number of threads. It depends on the frames that the walk rendered before.
//!
//! Walks are cut into chunks, which begin without records. The records of a chunk are saved beside its frames, so that
//! an interrupted walk resumes with the same records. `docs/walk.md` has figures of time, error, flicker and memory.
//!
//! Footprints shrink at differences that are visible against the contrasts of the previous frame (see
//! [`transport::perception`]).
//!
//! [`choice`] chooses a method for a whole path or list. [`frames`] lists frames, [`names`] names their files,
//! [`exposure`] computes one exposure for a whole path. [`posed`] has the cameras of models that move, whose frames
//! share nothing else.

pub mod choice;
pub mod chunk;
pub mod exposure;
pub mod frames;
pub mod names;
pub mod posed;
pub mod saved;
pub mod views;

use crate::method::{Outlook, RetainedRecords};
use crate::session::{Former, FrameError, Goal, RenderedFrame, Session, VisibleDifferences, WalkState};
use base::progress::Control;
use transport::perception::Thresholds;
use transport::reprojection::PreviousImage;
use world::view::View;

pub use crate::method::RetentionLimits;
pub use frames::FrameList;
pub use names::FileNames;
pub use transport::perception::Q_SCALE;

/// A walk through a session's scene.
pub struct Walk<'a> {
    session: &'a Session,
    goal: Goal,
    limits: RetentionLimits,
    records: RetainedRecords,
    last: PreviousImage,
    thresholds: Thresholds,
    /// Surfaces that all views see; `None` for the frames of a film.
    outlook: Option<&'a Outlook>,
}

/// Bytes of the number that states the length of a saved image.
const LENGTH: usize = size_of::<u64>();

impl<'a> Walk<'a> {
    /// Begins a walk without records. If `goal` plans settings, each frame is rendered alone.
    pub fn new(session: &'a Session, goal: Goal, limits: RetentionLimits) -> Walk<'a> {
        let (records, last) = (RetainedRecords::new(limits), PreviousImage::default());
        Walk { session, goal, limits, records, last, thresholds: Thresholds::default(), outlook: None }
    }

    /// Makes the frames views of their own, which see `outlook` together.
    pub fn of_views(self, outlook: &'a Outlook) -> Walk<'a> {
        Walk { outlook: Some(outlook), ..self }
    }

    /// Resumes a walk from the bytes that [`Walk::save`] returned; `None` if the bytes are damaged.
    pub fn restored(
        session: &'a Session,
        goal: Goal,
        limits: RetentionLimits,
        saved: &[u8],
    ) -> Option<Walk<'a>> {
        let (length, rest) = saved.split_at_checked(LENGTH)?;
        let length = u64::from_le_bytes(length.try_into().ok()?);
        let (last, records) = rest.split_at_checked(length.try_into().ok()?)?;
        let ((last, thresholds), excess): ((PreviousImage, Thresholds), _) =
            postcard::take_from_bytes(last).ok()?;
        let is_sound = excess.is_empty() && last.is_sound() && thresholds.is_sound();
        let records = RetainedRecords::restored(limits, records)?;
        is_sound.then_some(Walk { session, goal, limits, records, last, thresholds, outlook: None })
    }

    /// Saves the records and the last image between frames.
    ///
    /// A walk that is resumed from the bytes renders frames of the same bits.
    pub fn save(&self) -> Vec<u8> {
        // Plain numbers can always be written; a walk cannot be restored from no bytes.
        let last = postcard::to_stdvec(&(&self.last, &self.thresholds)).unwrap_or_default();
        [&(last.len() as u64).to_le_bytes()[..], &last, &self.records.save()].concat()
    }

    /// Renders the next frame, seen by `view`. A frame that was cancelled halfway is partial, not an error.
    ///
    /// # Errors
    /// As [`Session::frame`].
    pub fn frame(&mut self, view: &View, control: &Control) -> Result<RenderedFrame, FrameError> {
        let last = self.limits.reprojects.then_some(&mut self.last);
        let thresholds = &mut self.thresholds;
        let thresholds = self.limits.q_scale.map(|q_scale| VisibleDifferences { thresholds, q_scale });
        let state = WalkState { records: &mut self.records, last, thresholds, outlook: self.outlook };
        self.session.frame_from(view, &self.goal, Former::Frames(state), control)
    }
}
