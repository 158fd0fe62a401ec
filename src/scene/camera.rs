//! Cameras: pinhole, thin lens, parallel projection.

use super::PixelFilter;
use base::sampling::uniform_disk;
use glam::{Vec2, Vec3};

/// A camera. Pixel (0, 0) is the top-left corner of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Position of the pinhole, of the lens centre, or of the film centre of a parallel projection, relative to the
    /// scene's centre.
    pub origin: Vec3,
    /// Unit vector along the axis: through the film's centre, unless the film is shifted.
    pub forward: Vec3,
    /// Unit vector towards the film's right edge.
    pub right: Vec3,
    /// Unit vector towards the film's top edge.
    pub up: Vec3,
    /// Tangent of half the horizontal field of view, for the scene's own aspect ratio. Half the film's width for a
    /// parallel projection.
    pub tan_half_x: f32,
    /// Offset of the film's middle from the axis, to the right and up, in the unit of `tan_half_x`.
    pub shift: [f32; 2],
    /// Height of a pixel over its width.
    pub pixel_height: f32,
    /// Near clipping distance along `forward`.
    pub near: f32,
    /// Far clipping distance along `forward`.
    pub far: f32,
    /// Projection onto the film.
    pub projection: Projection,
    /// Pixel filter of the film.
    pub filter: PixelFilter,
}

/// Projection of the scene onto the film.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Projection {
    /// Projection through a point; everything is in focus.
    #[default]
    Pinhole,
    /// Projection through a thin lens.
    Lens {
        /// Radius of the lens.
        radius: f32,
        /// Distance along `forward` of the plane in focus.
        distance: f32,
    },
    /// Parallel projection along `forward`.
    Parallel,
}

/// Maximum number of pixels along a side of the film.
pub const MAX_SIDE: u32 = 65536;

/// Maximum number of frames in a camera path.
pub const MAX_FRAMES: usize = 1 << 20;

/// Cameras of a scene file, and the size of their film.
#[derive(Clone, Debug, Default)]
pub struct Cameras {
    /// The camera of a still.
    pub still: Camera,
    /// Camera of each frame of a camera path; empty without a path.
    pub path: Vec<Camera>,
    /// Width and height of the film in pixels.
    pub resolution: [u32; 2],
    /// Offset and size of the part of the film to render, if not all of it.
    pub crop: Option<[[u32; 2]; 2]>,
}

/// The camera at the centre, looking along -z with y up, with a horizontal field of view of 90°.
impl Default for Camera {
    fn default() -> Camera {
        Camera {
            origin: Vec3::ZERO,
            forward: -Vec3::Z,
            right: Vec3::X,
            up: Vec3::Y,
            tan_half_x: 1.0,
            shift: [0.0; 2],
            pixel_height: 1.0,
            near: 0.0,
            far: f32::INFINITY,
            projection: Projection::Pinhole,
            filter: PixelFilter::Box,
        }
    }
}

impl Camera {
    /// Returns the unit direction from a pinhole through film position `pixel` (in pixels, continuous) of a
    /// `resolution` film.
    ///
    /// The horizontal field of view is the same for all aspect ratios.
    #[inline(always)]
    pub fn direction(&self, pixel: [f32; 2], resolution: [u32; 2]) -> Vec3 {
        let [x, y] = self.across(pixel, resolution);
        (self.forward + self.right * x + self.up * y).normalize()
    }

    /// Returns the offset to the right and up from the axis to `pixel`, at distance 1 from a pinhole.
    #[inline(always)]
    fn across(&self, pixel: [f32; 2], resolution: [u32; 2]) -> [f32; 2] {
        let [w, h] = resolution.map(|r| r as f32);
        let x = (2.0 * pixel[0] / w - 1.0) * self.tan_half_x;
        let y = (h - 2.0 * pixel[1]) / w * self.tan_half_x * self.pixel_height;
        [x + self.shift[0], y + self.shift[1]]
    }

    /// Returns origin and unit direction of the ray through film position `pixel`.
    ///
    /// `lens` in the unit square chooses the position on a lens.
    #[inline(always)]
    pub fn ray(&self, pixel: [f32; 2], resolution: [u32; 2], lens: Vec2) -> (Vec3, Vec3) {
        let across = |[x, y]: [f32; 2]| self.right * x + self.up * y;
        match self.projection {
            Projection::Pinhole => (self.origin, self.direction(pixel, resolution)),
            Projection::Lens { radius, distance } => {
                let on_lens = across((uniform_disk(lens) * radius).to_array());
                let in_focus = (self.forward + across(self.across(pixel, resolution))) * distance;
                (self.origin + on_lens, (in_focus - on_lens).normalize())
            }
            Projection::Parallel => (self.origin + across(self.across(pixel, resolution)), self.forward),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;

    #[test]
    fn focal_lengths_and_the_principal_point_are_those_of_a_calibrated_camera() {
        let ([w, h], [fx, fy], [cx, cy]) = ([64.0, 48.0], [50.0, 40.0], [30.5, 20.25]);
        let camera = Camera {
            tan_half_x: 0.5 * w / fx,
            shift: [(0.5 * w - cx) / fx, (cy - 0.5 * h) / fy],
            pixel_height: fx / fy,
            ..Camera::default()
        };
        for pixel in [[0.0, 0.0], [30.5, 20.25], [64.0, 48.0], [7.5, 40.0]] {
            let expected = Vec3::new((pixel[0] - cx) / fx, -(pixel[1] - cy) / fy, -1.0).normalize();
            assert!((camera.direction(pixel, [64, 48]) - expected).length() < 1e-6, "{pixel:?}");
        }
    }

    #[test]
    fn rays_through_a_lens_meet_in_the_plane_in_focus_and_parallel_ones_never() {
        let lens = Projection::Lens { radius: 0.5, distance: 4.0 };
        let camera = Camera { projection: lens, tan_half_x: 0.7, ..Camera::default() };
        let (pixel, film) = ([3.0, 5.0], [16, 8]);
        let pinhole = camera.direction(pixel, film);
        let meeting = pinhole * (4.0 / pinhole.dot(camera.forward));
        let mut spread = 0.0f32;
        for i in 0..64 {
            let (origin, direction) = camera.ray(pixel, film, owen_sobol_2d(i, 1));
            spread = spread.max(origin.length());
            let t = 4.0 / direction.dot(camera.forward);
            assert!((origin + direction * t - meeting).length() < 1e-5);
        }
        assert!(spread > 0.45 && spread <= 0.5, "{spread}");
        let parallel = Camera { projection: Projection::Parallel, tan_half_x: 3.0, ..Camera::default() };
        let (origin, direction) = parallel.ray([16.0, 0.0], film, Vec2::ZERO);
        assert_eq!((origin, direction), (Vec3::new(3.0, 1.5, 0.0), -Vec3::Z));
    }
}
