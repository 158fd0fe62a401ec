//! The view of a scene: from where it is seen, and which part of the film is rendered.
//!
//! Every method takes a view beside the world; nothing in a [`crate::world::World`] depends on it, so that one world, its
//! lights and its cache records serve any number of views.

use crate::embree::Ray;
use crate::film::Window;
use crate::scene::{Camera, Cameras};
use glam::Vec2;

/// Most pixels rendered at once: 16384 by 65536. More would exhaust the memory of most machines.
const MAX_PIXELS: u64 = 1 << 30;

/// A camera and the part of its film to render.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// The film and the rectangle of it that is rendered.
    pub window: Window,
}

/// Frame, film size and crop that are wanted in place of the scene file's own.
#[derive(Clone, Copy, Debug, Default)]
pub struct Framing {
    /// Frame of the camera path, counted from 0, in place of the still camera.
    pub frame: Option<usize>,
    /// Width and height of the film in pixels.
    pub resolution: Option<[u32; 2]>,
    /// The only part of the film to render, as offset and size in pixels.
    pub crop: Option<[[u32; 2]; 2]>,
}

/// Reason why a framing gives no view.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FramingError {
    /// The camera path is not that long.
    #[error("--frame {frame}: the scene has {frames} frames; {}", match frames {
        0 => "leave --frame out".to_owned(),
        _ => format!("at most {}", frames - 1),
    })]
    Frame {
        /// The frame wanted.
        frame: usize,
        /// Length of the camera path.
        frames: usize,
    },
    /// The crop is empty or not on the film.
    #[error("--crop must lie within the film of {}x{} pixels", film[0], film[1])]
    Crop {
        /// Width and height of the film.
        film: [u32; 2],
    },
    /// The film has too many pixels to be rendered at once.
    #[error("{pixels} pixels are more than {MAX_PIXELS}: render the film in parts with --crop")]
    Pixels {
        /// Pixels in the window.
        pixels: u64,
    },
}

impl View {
    /// The view that `framing` wants through the cameras of a scene file.
    pub fn new(cameras: &Cameras, framing: &Framing) -> Result<View, FramingError> {
        let film = framing.resolution.unwrap_or(cameras.resolution);
        let mut window = Window::whole(film);
        if let Some([offset, [width, height]]) = framing.crop {
            window = Window { film, offset, width, height };
        }
        if !window.is_valid() {
            return Err(FramingError::Crop { film });
        }
        let pixels = window.pixel_count();
        if pixels > MAX_PIXELS {
            return Err(FramingError::Pixels { pixels });
        }
        let camera = match framing.frame {
            None => cameras.still,
            Some(frame) => {
                let frames = cameras.path.len();
                *cameras.path.get(frame).ok_or(FramingError::Frame { frame, frames })?
            }
        };
        Ok(View { camera, window })
    }

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

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn cameras() -> Cameras {
        let path = (0..3).map(|i| Camera { origin: Vec3::X * i as f32, ..Camera::default() }).collect();
        Cameras { still: Camera::default(), path, resolution: [8, 4] }
    }

    #[test]
    fn a_framing_takes_the_place_of_what_the_file_says() {
        let plain = View::new(&cameras(), &Framing::default()).unwrap();
        assert_eq!(plain, View::whole(Camera::default(), [8, 4]));
        let framing = Framing { frame: Some(2), resolution: Some([16, 16]), crop: Some([[3, 4], [5, 6]]) };
        let view = View::new(&cameras(), &framing).unwrap();
        assert_eq!(view.camera.origin, Vec3::X * 2.0);
        assert_eq!(view.window, Window { film: [16, 16], offset: [3, 4], width: 5, height: 6 });
    }

    #[test]
    fn what_gives_no_view_is_named() {
        let error = |framing: Framing| View::new(&cameras(), &framing).unwrap_err();
        let frame = error(Framing { frame: Some(3), ..Framing::default() });
        assert_eq!(frame.to_string(), "--frame 3: the scene has 3 frames; at most 2");
        let crop = error(Framing { crop: Some([[7, 0], [2, 1]]), ..Framing::default() });
        assert_eq!(crop, FramingError::Crop { film: [8, 4] });
        let large = error(Framing { resolution: Some([1 << 16, 1 << 16]), ..Framing::default() });
        assert_eq!(large, FramingError::Pixels { pixels: 1 << 32 });
    }

    #[test]
    fn the_ray_through_the_films_centre_goes_forward() {
        let view = View::whole(Camera { near: 0.5, far: 3.0, ..Camera::default() }, [8, 4]);
        let ray = view.primary_ray([4, 2], Vec2::ZERO);
        assert_eq!((ray.direction, ray.t_near, ray.t_far), (-Vec3::Z, 0.5, 3.0));
        // Half the film's width lies at the tangent of half the field of view, which is 1.
        let edge = view.primary_ray([0, 2], Vec2::ZERO).direction;
        assert!((edge.x / edge.z - 1.0).abs() < 1e-6 && edge.y.abs() < 1e-6, "{edge}");
        assert_eq!(view.pixel_angle(), 0.25);
    }
}
