//! Views of a list: cameras of one scene that follow no path.
//!
//! Virtual lights are made once for the surfaces that all views see, so that no view depends on the views before it in
//! this. Records stay from view to view, unless each view begins a walk of its own.

use crate::session::Session;
use base::progress::Control;
use readers::{SceneError, SceneView, ViewList};
use scene::Cameras;
use std::num::NonZeroUsize;
use world::view::{Framing, FramingError, View};

pub use crate::method::Outlook;

/// Views of a list in the scene of a session.
#[derive(Clone, Debug)]
pub struct ListedViews {
    /// Numbers of the views in the list, in rising order.
    numbers: Vec<usize>,
    views: Vec<View>,
}

impl ListedViews {
    /// Places the cameras of a list in the session's scene. `resolution` changes the size of each film, and `crop` is
    /// the part of each film to render.
    ///
    /// # Errors
    /// If a camera cannot be represented, or a film cannot be rendered. The error of a film has the number of the view.
    pub fn new(
        session: &Session,
        list: &ViewList,
        resolution: impl Fn([u32; 2]) -> [u32; 2],
        crop: Option<[[u32; 2]; 2]>,
    ) -> Result<ListedViews, ListedViewsError> {
        let numbers = list.numbers().to_owned();
        let place = |(&number, view): (&usize, SceneView)| {
            let film = resolution(view.resolution.unwrap_or(session.cameras.resolution));
            let framing = Framing { frame: None, resolution: Some(film), crop };
            let cameras = Cameras { still: session.through_lens(view.camera), ..Cameras::default() };
            View::new(&cameras, &framing).map_err(|error| ListedViewsError::Film { number, error })
        };
        let cameras = list.in_scene(&session.world.scene)?;
        let views: Result<Vec<View>, ListedViewsError> = numbers.iter().zip(cameras).map(place).collect();
        let views = views?;
        Ok(ListedViews { numbers, views })
    }

    /// Returns the views in the order of the list.
    pub fn all(&self) -> &[View] {
        &self.views
    }

    /// Returns the view with a number of the list.
    pub fn numbered(&self, number: usize) -> Option<&View> {
        self.views.get(self.numbers.binary_search(&number).ok()?)
    }

    /// Finds the surfaces that the views see together. Chunks of `chunk` views share records; without it all do.
    pub fn outlook(&self, session: &Session, chunk: Option<NonZeroUsize>, control: &Control) -> Outlook {
        let count = chunk.map_or(self.views.len(), NonZeroUsize::get);
        Outlook::new(&session.world, &self.views, control).in_chunks(count)
    }
}

/// Reason why the views of a list cannot be rendered.
#[derive(Debug, thiserror::Error)]
pub enum ListedViewsError {
    /// A camera that the scene cannot represent.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A film that cannot be rendered.
    #[error("view {number}: {error}")]
    Film {
        /// Number of the view, counted from 1.
        number: usize,
        /// Reason.
        error: FramingError,
    },
}
