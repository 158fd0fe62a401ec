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

    /// How many pixels are rendered.
    pub fn pixel_count(&self) -> u64 {
        self.width as u64 * self.height as u64
    }

    /// Whether the rectangle lies on the film and has at least one pixel.
    pub fn is_valid(&self) -> bool {
        let end = |offset: u32, length: u32| offset as u64 + length as u64;
        self.pixel_count() > 0
            && end(self.offset[0], self.width) <= self.film[0] as u64
            && end(self.offset[1], self.height) <= self.film[1] as u64
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
