//! The part of the film that is rendered, and the rays through it.

use crate::embree::Ray;
use crate::scene::Camera;
use glam::Vec2;

/// A rectangle of pixels of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Width and height of the whole film in pixels.
    pub film: [u32; 2],
    /// First column and row of the rectangle.
    pub offset: [u32; 2],
    /// Columns rendered.
    pub width: u32,
    /// Rows rendered.
    pub height: u32,
}

impl Window {
    /// The whole film.
    pub fn whole(film: [u32; 2]) -> Window {
        Window { film, offset: [0, 0], width: film[0], height: film[1] }
    }

    /// Film coordinates of a pixel of the window.
    #[inline]
    pub fn film_pixel(&self, [x, y]: [u32; 2]) -> [u32; 2] {
        [x + self.offset[0], y + self.offset[1]]
    }
}

/// The ray through the film's pixel `[x, y]` at `jitter` within it, from the camera's near to its far plane.
#[inline]
pub fn primary_ray(camera: &Camera, window: &Window, [x, y]: [u32; 2], jitter: Vec2) -> Ray {
    let direction = camera.direction([x as f32 + jitter.x, y as f32 + jitter.y], window.film);
    let cos = direction.dot(camera.forward);
    Ray { origin: camera.origin, t_near: camera.near / cos, direction, t_far: camera.far / cos }
}
