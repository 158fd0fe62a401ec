//! Walk-throughs: frames along a camera path, lit by records that live from frame to frame.
//!
//! Paper: Herzog et al. 2009, section 6.4.
//!
//! A [`Walk`] renders one frame after the other. Scene, virtual lights and light trees are the session's; the records
//! of indirect light stay in the walk (see [`RetainedRecords`]), so that a frame computes only those that its
//! predecessors lack. Of drawn direct light, that of even surfaces is carried from picture to picture and refreshed by
//! few samples (see [`transport::reprojection`]). Elsewhere the random numbers of a pixel are the same in every frame,
//! so that noise which the denoiser leaves stays where it is: on static surfaces of the apartment, reprojected from
//! frame to frame, new numbers in each change the denoised picture 1.8 times as much. A frame has the same bits for
//! any number of threads; it depends on the frames that the walk rendered before it.
//!
//! Walks are cut into chunks, which begin without records, and a chunk's records are saved beside its frames, so that a
//! walk that was stopped goes on with the same. `docs/walk.md` has figures of time, error, flicker and memory.
//!
//! Footprints are adapted at differences that are seen beside the contrasts of the frame before (see
//! [`transport::perception`]), which in the apartment spares a tenth of the new records, in the paper a fifth.
//!
//! [`frames`] lists frames, [`names`] names their files, [`exposure`] finds one exposure for all of a path.

pub mod chunk;
pub mod exposure;
pub mod frames;
pub mod names;
pub mod saved;

use crate::method::RetainedRecords;
use crate::session::{Former, Frame, FrameError, Goal, Kept, Session};
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
}

/// Bytes of the length of a saved picture, before it and the records.
const LENGTH: usize = size_of::<u64>();

impl<'a> Walk<'a> {
    /// A walk that begins without records. Its frames are rendered for `goal`; where that plans settings, alone.
    pub fn new(session: &'a Session, goal: Goal, limits: RetentionLimits) -> Walk<'a> {
        let (records, last) = (RetainedRecords::new(limits), PreviousImage::default());
        Walk { session, goal, limits, records, last, thresholds: Thresholds::default() }
    }

    /// A walk that goes on from bytes that [`Walk::save`] returned; `None` if it did not.
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
        is_sound.then_some(Walk { session, goal, limits, records, last, thresholds })
    }

    /// The records and the last picture as they are between frames: a walk that goes on from them renders the same
    /// frames, bit for bit.
    pub fn save(&self) -> Vec<u8> {
        // Plain numbers, which cannot fail to be written; without bytes there would be none to restore.
        let last = postcard::to_stdvec(&(&self.last, &self.thresholds)).unwrap_or_default();
        [&(last.len() as u64).to_le_bytes()[..], &last, &self.records.save()].concat()
    }

    /// Renders the next frame, seen by `view`. One that was cancelled halfway is partial, not an error.
    pub fn frame(&mut self, view: &View, control: &Control) -> Result<Frame, FrameError> {
        let last = self.limits.reprojects.then_some(&mut self.last);
        let thresholds = self.limits.q_scale.map(|q_scale| (&mut self.thresholds, q_scale));
        let kept = Kept { records: &mut self.records, last, thresholds };
        self.session.frame_by(view, &self.goal, Former::Frames(kept), control)
    }
}
