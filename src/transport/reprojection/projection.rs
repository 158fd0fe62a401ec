//! Places of surfaces in a picture that another camera took.

use base::film::Window;
use glam::{DVec3, Vec2, Vec3};
use serde::{Deserialize, Serialize};
use world::view::View;

/// The way from space to the pixels of a picture.
#[derive(Serialize, Deserialize)]
pub struct Projection {
    /// Projection to the film: row vectors, as in [`base::film::CameraMatrices`].
    to_film: [f32; 16],
    /// Place of the camera, and its axis.
    origin: Vec3,
    forward: Vec3,
    /// Film, offset and size of the window.
    window: [[u32; 2]; 3],
}

impl Projection {
    /// That of a view.
    pub fn of(view: &View) -> Projection {
        let Window { film, offset, width, height } = view.window;
        let to_film = view.matrices(DVec3::ZERO, 1.0).world_to_ndc;
        let (origin, forward) = (view.camera.origin, view.camera.forward);
        Projection { to_film, origin, forward, window: [film, offset, [width, height]] }
    }

    /// True if it can be that of a picture of so many pixels.
    pub fn is_sound_for(&self, pixels: usize) -> bool {
        let window = self.window();
        window.is_valid() && pixels as u64 == window.pixel_count()
    }

    fn window(&self) -> Window {
        let [film, offset, [width, height]] = self.window;
        Window { film, offset, width, height }
    }

    /// Place on the film in pixels, whose middles are whole numbers, and depth along the camera's axis; `None` behind
    /// the camera.
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

    /// Index of the picture's pixel at a whole place; `None` outside.
    pub fn pixel(&self, place: Vec2) -> Option<usize> {
        let is_number = place.min_element() >= 0.0 && place.max_element() <= u32::MAX as f32;
        is_number.then(|| self.window().index([place.x as u32, place.y as u32])).flatten()
    }
}
