//! One method for all frames of a path or all views of a list, chosen as for a still.
//!
//! Pilots of views spread over the whole path or list decide together. So the choice does not depend on the images that
//! are rendered, and a walk does not change its method halfway. Images of a series that share records take less work
//! than stills, which makes the cache the better choice more often.

use super::exposure::spread;
use crate::denoise::Denoiser;
use crate::method::LightStore;
use crate::plan::{Chooser, MethodChoice};
use crate::session::{Goal, Session};
use base::progress::Control;
use world::view::View;

/// Maximum number of pilots.
const PILOTS: usize = 4;

/// Records and lights that images of a series share.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sharing {
    /// No records.
    Nothing,
    /// Records of views of a list.
    Views,
    /// Records and reprojected light of the frames of a path.
    Frames,
}

impl Sharing {
    /// Returns the work of an image of the cache over its work as a still.
    fn work(self) -> f64 {
        match self {
            Sharing::Nothing => 1.0,
            Sharing::Views => 0.8,
            Sharing::Frames => 0.5,
        }
    }
}

/// Chooses the method of a series of `views`.
///
/// The result is `None` if the goal leaves no choice, if no pilot sees light, or if cancelled.
pub fn of_series(
    session: &Session,
    views: &[View],
    goal: &Goal,
    sharing: Sharing,
    control: &Control,
) -> Option<MethodChoice> {
    // The comparison with paths assumes that their noise is removed.
    if !goal.may_choose || !goal.denoises() || Denoiser::load().is_err() {
        return None;
    }
    let chosen = spread(views.len(), PILOTS).filter_map(|i| views.get(i));
    // Lights of the session are made for all views, not for those with pilots.
    let lights = LightStore::default();
    let pilot = |view: &View| {
        let whole = View::whole(view.camera, view.window.film);
        control.plan(|| Chooser::new(&session.world, &lights, &whole, &goal.method, control))
    };
    let choosers: Vec<Chooser> = chosen.filter_map(pilot).collect();
    Chooser::for_series(&choosers, &goal.method, sharing.work()).filter(|_| !control.is_cancelled())
}
