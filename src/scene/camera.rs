//! Pinhole camera with square pixels.

use glam::Vec3;

/// A perspective pinhole camera. Pixel (0, 0) is the top-left corner of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Pinhole, relative to the scene's centre.
    pub origin: Vec3,
    /// Unit vector through the film's centre.
    pub forward: Vec3,
    /// Unit vector towards the film's right edge.
    pub right: Vec3,
    /// Unit vector towards the film's top edge.
    pub up: Vec3,
    /// Tangent of half the horizontal field of view, for the scene's own aspect ratio.
    pub tan_half_x: f32,
    /// Near clipping distance along `forward`.
    pub near: f32,
    /// Far clipping distance along `forward`.
    pub far: f32,
}

/// Maximum number of frames in a camera path.
pub const MAX_FRAMES: usize = 1 << 20;

/// Cameras that a scene's file describes, and the size of their film.
#[derive(Clone, Debug, Default)]
pub struct Cameras {
    /// The camera of a still.
    pub still: Camera,
    /// One camera a frame where the file has a walk-through, else empty.
    pub path: Vec<Camera>,
    /// Width and height of the film in pixels.
    pub resolution: [u32; 2],
}

/// At the centre, looking along -z with y up, with a horizontal field of view of a right angle.
impl Default for Camera {
    fn default() -> Camera {
        Camera {
            origin: Vec3::ZERO,
            forward: -Vec3::Z,
            right: Vec3::X,
            up: Vec3::Y,
            tan_half_x: 1.0,
            near: 0.0,
            far: f32::INFINITY,
        }
    }
}

impl Camera {
    /// Unit direction through film position `pixel` (in pixels, continuous) of a `resolution` film.
    ///
    /// The horizontal field of view is kept when the aspect ratio changes.
    #[inline]
    pub fn direction(&self, pixel: [f32; 2], resolution: [u32; 2]) -> Vec3 {
        let [w, h] = resolution.map(|r| r as f32);
        let x = (2.0 * pixel[0] / w - 1.0) * self.tan_half_x;
        let y = (h - 2.0 * pixel[1]) / w * self.tan_half_x;
        (self.forward + self.right * x + self.up * y).normalize()
    }
}
