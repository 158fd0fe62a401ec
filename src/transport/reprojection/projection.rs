//! Positions of surfaces in an image taken by another camera.

use base::film::Window;
use glam::{DVec3, Vec2, Vec3};
use serde::{Deserialize, Serialize};
use world::view::View;

/// Projection from space to the pixels of an image.
#[derive(Serialize, Deserialize)]
pub struct ViewProjection {
    /// Projection to the film: row vectors, as in [`base::film::CameraMatrices`].
    to_film: [f32; 16],
    /// Position of the camera.
    origin: Vec3,
    forward: Vec3,
    /// Film, offset and size of the window.
    window: [[u32; 2]; 3],
}

impl ViewProjection {
    /// Returns the projection of a view.
    pub fn of(view: &View) -> ViewProjection {
        let Window { film, offset, width, height } = view.window;
        let to_film = view.matrices(DVec3::ZERO, 1.0).world_to_ndc;
        let (origin, forward) = (view.camera.origin, view.camera.forward);
        ViewProjection { to_film, origin, forward, window: [film, offset, [width, height]] }
    }

    /// Returns true if the projection is valid for an image of `pixels` pixels.
    pub fn is_sound_for(&self, pixels: usize) -> bool {
        let window = self.window();
        window.is_valid() && pixels as u64 == window.pixel_count()
    }

    fn window(&self) -> Window {
        let [film, offset, [width, height]] = self.window;
        Window { film, offset, width, height }
    }

    /// Returns the position on the film in pixels, whose centres are integers, and the depth along the camera's axis;
    /// `None` behind the camera.
    pub fn place(&self, position: Vec3) -> Option<(Vec2, f32)> {
        let [x, y, w] = [0, 1, 3].map(|c| {
            let row = |r: usize| self.to_film[4 * r + c];
            position.x * row(0) + position.y * row(1) + position.z * row(2) + row(3)
        });
        let depth = (position - self.origin).dot(self.forward);
        let is_before = w > 0.0 && depth > 0.0;
        let film = Vec2::from(self.window[0].map(|n| n as f32));
        is_before.then(|| (Vec2::new(x, y) / w * film - 0.5, depth))
    }

    /// Returns the index of the pixel at an integer position; `None` outside the image.
    pub fn pixel(&self, place: Vec2) -> Option<usize> {
        let is_number = place.min_element() >= 0.0 && place.max_element() <= u32::MAX as f32;
        is_number.then(|| self.window().index([place.x as u32, place.y as u32])).flatten()
    }
}
