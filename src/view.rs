//! The view of a scene: from where it is seen, and which part of the film is rendered.
//!
//! Every method takes a view beside the world; nothing in a [`crate::world::World`] depends on it, so that one world, its
//! lights and its cache records serve any number of views.

use crate::embree::Ray;
use crate::film::Window;
use crate::scene::Camera;
use glam::Vec2;

/// A camera and the part of its film to render.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// The film and the rectangle of it that is rendered.
    pub window: Window,
}

impl View {
    /// The whole film of `resolution` pixels, seen by `camera`.
    pub fn whole(camera: Camera, resolution: [u32; 2]) -> View {
        View { camera, window: Window::whole(resolution) }
    }

    /// The ray through the film's pixel `[x, y]` at `jitter` within it, from the camera's near to its far plane.
    #[inline]
    pub fn primary_ray(&self, [x, y]: [u32; 2], jitter: Vec2) -> Ray {
        let camera = &self.camera;
        let direction = camera.direction([x as f32 + jitter.x, y as f32 + jitter.y], self.window.film);
        let cos = direction.dot(camera.forward);
        Ray { origin: camera.origin, t_near: camera.near / cos, direction, t_far: camera.far / cos }
    }

    /// Angle between neighbouring pixels at the film's centre, in radians.
    pub fn pixel_angle(&self) -> f32 {
        2.0 * self.camera.tan_half_x / self.window.film[0] as f32
    }
}
