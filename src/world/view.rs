//! The view of a scene: its camera, and the part of the film to render.
//!
//! Nothing in a [`crate::World`] depends on the view, so that one world, its lights and its cache records serve any
//! number of views.

use base::film::{CameraMatrices, Window};
use base::math::{Cone, LANES, U32x16, Vec2x16};
use base::sampling::{Sampler, hash};
use embree::{Ray, Rays16};
use glam::{DVec3, Vec2, Vec3};
use scene::{Camera, Cameras, Projection};

/// Maximum number of pixels rendered at once (16384 × 65536), which bounds the memory.
const MAX_PIXELS: u64 = 1 << 30;

/// Seed of points on the lens, combined with that of the samples.
const LENS_SEED: u32 = 0x1e45_0f0c;

/// A camera and the part of its film to render.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Film, and the rectangle of it that is rendered.
    pub window: Window,
}

/// Frame, film size and crop that replace those of the scene file.
#[derive(Clone, Copy, Debug, Default)]
pub struct Framing {
    /// Frame of the camera path, counted from 1, which replaces the still camera.
    pub frame: Option<usize>,
    /// Width and height of the film in pixels.
    pub resolution: Option<[u32; 2]>,
    /// Part of the film to render, as offset and size in pixels.
    pub crop: Option<[[u32; 2]; 2]>,
}

/// Error of a framing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FramingError {
    /// The camera path is shorter than the frame's number.
    #[error("frame {frame}: {}", match frames {
        0 => "the scene has no camera path, only a still camera; give a TOML scene keys in [camera.path], or a glTF \
              model an animation".to_owned(),
        _ => format!("the scene's camera path has {frames} frames, counted from 1"),
    })]
    Frame {
        /// Requested frame.
        frame: usize,
        /// Length of the camera path.
        frames: usize,
    },
    /// The crop is empty or not on the film.
    #[error("--crop must lie within the image of {}x{} pixels", film[0], film[1])]
    Crop {
        /// Width and height of the film.
        film: [u32; 2],
    },
    /// The window has too many pixels.
    #[error("{pixels} pixels are more than {MAX_PIXELS}: render the image in parts with --crop")]
    Pixels {
        /// Number of pixels in the window.
        pixels: u64,
    },
}

impl View {
    /// Returns the view through the cameras of a scene file, as `framing` changes it.
    ///
    /// # Errors
    /// If the frame is not in the camera path, the crop is not on the film, or the window has too many pixels.
    pub fn new(cameras: &Cameras, framing: &Framing) -> Result<View, FramingError> {
        let film = framing.resolution.unwrap_or(cameras.resolution);
        let mut window = Window::whole(film);
        // The file's crop applies to the file's film only.
        let crop = framing.crop.or(cameras.crop.filter(|_| framing.resolution.is_none()));
        if let Some([offset, [width, height]]) = crop {
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
                let camera = frame.checked_sub(1).and_then(|index| cameras.path.get(index));
                *camera.ok_or(FramingError::Frame { frame, frames })?
            }
        };
        Ok(View { camera, window })
    }

    /// Returns the view of the complete film of `resolution` pixels.
    pub fn whole(camera: Camera, resolution: [u32; 2]) -> View {
        View { camera, window: Window::whole(resolution) }
    }

    /// Returns the ray through the film's pixel `[x, y]`, from the camera's near plane to its far plane, through the
    /// middle of the lens. The pixel filter maps `jitter` to a point around the pixel.
    #[inline]
    pub fn primary_ray(&self, pixel: [u32; 2], jitter: Vec2) -> Ray {
        self.ray(pixel, jitter, Vec2::splat(0.5))
    }

    /// Returns the ray of a sample of the pixel (see [`View::primary_ray`]), through a sampled point of the lens.
    #[inline]
    pub fn sample_ray(&self, pixel: [u32; 2], jitter: Vec2, seed: u32, sample: u32) -> Ray {
        let lens = match self.camera.projection {
            Projection::Lens { .. } => {
                let seed = hash(hash(hash(pixel[0], pixel[1]), seed), LENS_SEED);
                Sampler::new(seed, sample).next_2d()
            }
            Projection::Pinhole | Projection::Parallel => Vec2::splat(0.5),
        };
        self.ray(pixel, jitter, lens)
    }

    /// Returns the rays of sixteen samples (see [`View::sample_ray`]).
    #[inline(never)]
    pub fn sample_rays(
        &self,
        pixels: &[[u32; 2]; LANES],
        jitter: &Vec2x16,
        seeds: &U32x16,
        samples: &U32x16,
    ) -> Rays16 {
        let mut rays = Rays16::default();
        if self.camera.projection != Projection::Pinhole {
            for i in 0..LANES {
                rays.set(i, &self.sample_ray(pixels[i], jitter.get(i), seeds[i], samples[i]));
            }
            return rays;
        }
        // With a constant projection, the second loop becomes vector code.
        let camera = Camera { projection: Projection::Pinhole, ..self.camera };
        let mut places = Vec2x16::default();
        (0..LANES).for_each(|i| places.set(i, camera.filter.place(jitter.get(i))));
        for i in 0..LANES {
            rays.set(i, &self.through(&camera, pixels[i], places.get(i), Vec2::splat(0.5)));
        }
        rays
    }

    /// Returns the ray through a pixel and a point of the lens.
    #[inline]
    fn ray(&self, pixel: [u32; 2], jitter: Vec2, lens: Vec2) -> Ray {
        self.through(&self.camera, pixel, self.camera.filter.place(jitter), lens)
    }

    /// Returns the ray of a camera through a place in a pixel and a point of the lens.
    #[inline(always)]
    fn through(&self, camera: &Camera, [x, y]: [u32; 2], place: Vec2, lens: Vec2) -> Ray {
        let (origin, direction) =
            camera.ray([x as f32 + place.x, y as f32 + place.y], self.window.film, lens);
        let cos = direction.dot(camera.forward);
        Ray { origin, t_near: camera.near / cos, direction, t_far: camera.far / cos }
    }

    /// Returns the matrices to camera and film from the coordinates of the scene's file, where `centre` is the scene's
    /// centre and `unit` the local unit of length.
    pub fn matrices(&self, centre: DVec3, unit: f64) -> CameraMatrices {
        let camera = &self.camera;
        let origin = centre + camera.origin.as_dvec3() * unit;
        let axes = [camera.right, camera.up, camera.forward].map(Vec3::as_dvec3);
        // The rows are the images of the world's axes and of its origin.
        let basis = [DVec3::X, DVec3::Y, DVec3::Z, -origin].map(|v| axes.map(|axis| v.dot(axis)));
        let [width, height] = self.window.film.map(f64::from);
        let is_length = camera.projection == Projection::Parallel;
        let length = if is_length { unit } else { 1.0 };
        let scale = 0.5 / (f64::from(camera.tan_half_x) * length);
        let [right, up] = camera.shift.map(|shift| f64::from(shift) * length);
        let height = height * f64::from(camera.pixel_height);
        let (mut world_to_camera, mut world_to_ndc) = ([0.0; 16], [0.0; 16]);
        for (row, [x, y, z]) in basis.into_iter().enumerate() {
            let w = if row == 3 { 1.0 } else { 0.0 };
            let [depth, by] = if camera.projection == Projection::Parallel { [z, w] } else { [w, z] };
            let ndc = [
                0.5 * by + scale * (x - right * by),
                0.5 * by - scale * width / height * (y - up * by),
                depth,
                by,
            ];
            for (column, (to_camera, to_ndc)) in [x, y, z, w].into_iter().zip(ndc).enumerate() {
                world_to_camera[4 * row + column] = to_camera as f32;
                world_to_ndc[4 * row + column] = to_ndc as f32;
            }
        }
        CameraMatrices { world_to_camera, world_to_ndc }
    }

    /// Returns the distance between neighbouring pixels at the film's centre, projected onto a surface at `position`
    /// that faces the camera.
    pub fn spacing(&self, position: Vec3) -> f32 {
        let spacing = 2.0 * self.camera.tan_half_x / self.window.film[0] as f32;
        match self.camera.projection {
            Projection::Parallel => spacing,
            Projection::Pinhole | Projection::Lens { .. } => spacing * position.distance(self.camera.origin),
        }
    }

    /// Returns the cone around an eye ray, for `samples` rays per pixel.
    pub fn cone(&self, samples: u32) -> Cone {
        let across = 2.0 * self.camera.tan_half_x / self.window.film[0] as f32;
        let width = across / (samples.max(1) as f32).sqrt();
        match self.camera.projection {
            Projection::Pinhole | Projection::Lens { .. } => Cone { width: 0.0, spread: width },
            Projection::Parallel => Cone { width, spread: 0.0 },
        }
    }

    /// Returns the angle between neighbouring pixels at the film's centre, in radians. For a parallel projection it is
    /// taken at the distance of the scene's centre, but at least of half the film's width.
    pub fn pixel_angle(&self) -> f32 {
        let spacing = 2.0 * self.camera.tan_half_x / self.window.film[0] as f32;
        match self.camera.projection {
            Projection::Pinhole | Projection::Lens { .. } => spacing,
            Projection::Parallel => {
                let to_centre = -self.camera.origin.dot(self.camera.forward);
                spacing / to_centre.max(self.camera.tan_half_x)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use scene::PixelFilter;

    fn cameras() -> Cameras {
        let path = (0..3).map(|i| Camera { origin: Vec3::X * i as f32, ..Camera::default() }).collect();
        Cameras { still: Camera::default(), path, resolution: [8, 4], crop: None }
    }

    #[test]
    fn a_framing_takes_the_place_of_what_the_file_says() {
        let plain = View::new(&cameras(), &Framing::default()).unwrap();
        assert_eq!(plain, View::whole(Camera::default(), [8, 4]));
        let cropped = Cameras { crop: Some([[1, 2], [3, 1]]), ..cameras() };
        let view = View::new(&cropped, &Framing::default()).unwrap();
        assert_eq!(view.window, Window { film: [8, 4], offset: [1, 2], width: 3, height: 1 });
        let framing = Framing { frame: Some(3), resolution: Some([16, 16]), crop: Some([[3, 4], [5, 6]]) };
        let view = View::new(&cropped, &framing).unwrap();
        assert_eq!(view.camera.origin, Vec3::X * 2.0);
        assert_eq!(view.window, Window { film: [16, 16], offset: [3, 4], width: 5, height: 6 });
    }

    #[test]
    fn what_gives_no_view_is_named() {
        let error = |framing: Framing| View::new(&cameras(), &framing).unwrap_err();
        for frame in [0, 4] {
            let error = error(Framing { frame: Some(frame), ..Framing::default() }).to_string();
            assert_eq!(error, format!("frame {frame}: the scene's camera path has 3 frames, counted from 1"));
        }
        let crop = error(Framing { crop: Some([[7, 0], [2, 1]]), ..Framing::default() });
        assert_eq!(crop, FramingError::Crop { film: [8, 4] });
        let large = error(Framing { resolution: Some([1 << 16, 1 << 16]), ..Framing::default() });
        assert_eq!(large, FramingError::Pixels { pixels: 1 << 32 });
    }

    #[test]
    fn points_on_a_ray_are_projected_to_its_pixel() {
        let (forward, right) = (Vec3::new(0.6, 0.0, -0.8), Vec3::new(0.8, 0.0, 0.6));
        let (origin, up) = (Vec3::new(3.0, -2.0, 1.0), Vec3::Y);
        let film = Camera { tan_half_x: 0.7, shift: [0.1, -0.07], pixel_height: 1.2, ..Camera::default() };
        let camera = Camera { origin, forward, right, up, ..film };
        let view = View::whole(camera, [40, 30]);
        let centre = DVec3::new(100.0, -50.0, 25.0);
        let matrices = view.matrices(centre, 1.0);
        // Row vectors: each row of the matrix is scaled by one coordinate.
        let product = |p: DVec3, m: &[f32; 16]| -> [f64; 4] {
            let p = [p.x, p.y, p.z, 1.0];
            std::array::from_fn(|column| (0..4).map(|row| p[row] * f64::from(m[4 * row + column])).sum())
        };
        for (pixel, distance) in [([0, 0], 2.0), ([31, 7], 5.0), ([20, 29], 0.5)] {
            let direction = view.primary_ray(pixel, Vec2::splat(0.5)).direction;
            let point = centre + (origin + direction * distance).as_dvec3();
            let [x, y, z, w] = product(point, &matrices.world_to_camera);
            let depth = f64::from(distance * direction.dot(forward));
            assert!((z - depth).abs() < 1e-4 && w == 1.0, "{z} {depth}");
            assert!(((x * x + y * y + z * z).sqrt() - f64::from(distance)).abs() < 1e-4);
            let [x, y, z, w] = product(point, &matrices.world_to_ndc);
            assert!((x / w * 40.0 - f64::from(pixel[0]) - 0.5).abs() < 5e-3, "{x} {w}");
            assert!((y / w * 30.0 - f64::from(pixel[1]) - 0.5).abs() < 5e-3, "{y} {w}");
            assert!((z / w * depth - 1.0).abs() < 1e-3);
        }
    }

    #[test]
    fn parallel_rays_are_projected_to_their_pixel() {
        let parallel = Camera { projection: Projection::Parallel, ..Camera::default() };
        let camera = Camera { tan_half_x: 3.0, shift: [0.5, 0.2], ..parallel };
        let view = View::whole(camera, [40, 30]);
        let matrix = view.matrices(DVec3::ZERO, 1.0).world_to_ndc;
        for pixel in [[0, 0], [31, 7], [20, 29]] {
            let ray = view.primary_ray(pixel, Vec2::splat(0.5));
            let point = (ray.origin + ray.direction * 2.5).as_dvec3();
            let p = [point.x, point.y, point.z, 1.0];
            let image: [f64; 4] = std::array::from_fn(|column| {
                (0..4).map(|row| p[row] * f64::from(matrix[4 * row + column])).sum()
            });
            assert!((image[0] / image[3] * 40.0 - f64::from(pixel[0]) - 0.5).abs() < 1e-4, "{image:?}");
            assert!((image[1] / image[3] * 30.0 - f64::from(pixel[1]) - 0.5).abs() < 1e-4, "{image:?}");
        }
    }

    #[test]
    fn rays_of_sixteen_samples_are_the_rays_of_each() {
        let seeds: U32x16 = std::array::from_fn(|i| 7 * i as u32);
        let samples: U32x16 = std::array::from_fn(|i| 5 + i as u32);
        let pixels: [[u32; 2]; LANES] = std::array::from_fn(|i| [i as u32 % 8, i as u32 / 4]);
        let mut jitter = Vec2x16::default();
        (0..LANES).for_each(|i| jitter.set(i, Vec2::new(0.06 * i as f32, 1.0 - 0.03 * i as f32)));
        let lens = Projection::Lens { radius: 0.1, distance: 2.0 };
        let turned = Camera {
            forward: Vec3::new(0.6, 0.0, -0.8),
            right: Vec3::new(0.8, 0.0, 0.6),
            ..Camera::default()
        };
        for projection in [Projection::Pinhole, lens, Projection::Parallel] {
            for filter in [PixelFilter::Box, PixelFilter::TENT] {
                let camera = Camera { projection, filter, near: 0.1, far: 9.0, ..turned };
                let view = View::whole(camera, [8, 4]);
                let rays = view.sample_rays(&pixels, &jitter, &seeds, &samples);
                for i in 0..LANES {
                    let ray = view.sample_ray(pixels[i], jitter.get(i), seeds[i], samples[i]);
                    assert_eq!(format!("{:?}", rays.get(i)), format!("{ray:?}"));
                }
            }
        }
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
