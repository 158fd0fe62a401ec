//! Sums of light at pixels on all threads, with the bits of sums on one thread.
//!
//! The order of additions determines the last bits of a pixel. The image is divided into bands. Light is sorted by band
//! run by run, and each band adds its light in the order of runs.

use crate::eye::EyePass;
use crate::lights::Origin;
use base::film::Image;
use base::math::Rgb;
use rayon::prelude::*;

/// Maximum number of bands of an image.
pub(super) const BANDS: usize = 64;

/// Light that a shading point reflects.
#[derive(Clone, Copy, Debug)]
pub struct Reflected {
    /// Index of the point.
    pub point: u32,
    /// Origin of the light; `None` for both.
    pub origin: Option<Origin>,
    /// Radiance.
    pub radiance: Rgb,
}

/// Light that reaches a pixel.
#[derive(Clone, Copy, Default)]
pub(super) struct PixelLight {
    /// Index of the pixel in the window.
    pixel: u32,
    /// Origin of the light; `None` for both.
    pub(super) origin: Option<Origin>,
    light: Rgb,
}

/// Light of a run of points at the pixels that see them, sorted by band.
pub(super) struct BandedLight {
    light: Vec<PixelLight>,
    /// Index of each band's first light, followed by the number of lights.
    starts: Vec<u32>,
    /// Number of radiances left out because they are not finite.
    pub(super) nonfinite: u64,
}

impl BandedLight {
    /// Finds the light that points send to the pixels of bands of `band` pixels each.
    pub(super) fn new(eye: &EyePass, reflected: impl Iterator<Item = Reflected>, band: usize) -> BandedLight {
        let (mut all, mut starts, mut nonfinite) = (Vec::new(), vec![0; BANDS + 1], 0);
        for Reflected { point, origin, radiance } in reflected {
            for seen in eye.visibility.at_point(point as usize) {
                let light = seen.weight * radiance;
                if light.is_finite() {
                    starts[seen.pixel as usize / band + 1] += 1;
                    all.push(PixelLight { pixel: seen.pixel, origin, light });
                } else {
                    nonfinite += 1;
                }
            }
        }
        for i in 0..BANDS {
            starts[i + 1] += starts[i];
        }
        let (mut light, mut next) = (vec![PixelLight::default(); all.len()], starts.clone());
        for item in all {
            let place = &mut next[item.pixel as usize / band];
            light[*place as usize] = item;
            *place += 1;
        }
        BandedLight { light, starts, nonfinite }
    }

    /// Returns the light of a band, in the order of points.
    fn band(&self, number: usize) -> &[PixelLight] {
        &self.light[self.starts[number] as usize..self.starts[number + 1] as usize]
    }
}

/// Adds the `wanted` light of runs to an image, in the order of runs.
pub(super) fn add_by_band(
    image: &mut Image,
    band: usize,
    runs: &[BandedLight],
    wanted: impl Fn(&PixelLight) -> bool + Sync,
) {
    image.pixels.par_chunks_mut(band).enumerate().for_each(|(number, pixels)| {
        for light in runs.iter().flat_map(|run| run.band(number)).filter(|light| wanted(light)) {
            pixels[light.pixel as usize - number * band] += light.light;
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eye::EyeSettings;
    use base::progress::Control;
    use base::sampling::{hash, unit};
    use world::testkit::{lit_room, room_camera, world};

    #[test]
    fn sums_have_the_bits_of_sums_in_order() {
        let (staged, _) = lit_room(room_camera(), 33);
        let world = world(staged);
        let settings = EyeSettings { spp: 3, seed: 1, max_depth: 4 };
        let eye = EyePass::trace(&world, &world.view, settings, &Control::new());
        let reflected = |i: u32| {
            let light = if i.is_multiple_of(97) { f32::INFINITY } else { unit(hash(i, 1)) };
            let origin = [Some(Origin::Direct), Some(Origin::Indirect), None][hash(i, 2) as usize % 3];
            Reflected { point: hash(i, 3) % eye.len() as u32, origin, radiance: Rgb::splat(light) }
        };
        let all: Vec<Reflected> = (0..20_000).map(reflected).collect();
        for wanted in [None, Some(Origin::Direct)] {
            let mut expected = Image::new(33, 33);
            for Reflected { point, origin, radiance } in &all {
                let seen = eye.visibility.at_point(*point as usize).iter();
                let light = seen.map(|seen| (seen.pixel as usize, seen.weight * *radiance));
                for (pixel, light) in light.filter(|(_, light)| light.is_finite()) {
                    if origin == &wanted {
                        expected.pixels[pixel] += light;
                    }
                }
            }
            assert!(expected.pixels.iter().any(|light| *light != Rgb::ZERO));
            for run in [1, 100, 7000] {
                let band = expected.pixels.len().div_ceil(BANDS);
                let runs = all.chunks(run).map(|run| BandedLight::new(&eye, run.iter().copied(), band));
                let runs: Vec<BandedLight> = runs.collect();
                let mut image = Image::new(33, 33);
                add_by_band(&mut image, band, &runs, |light| light.origin == wanted);
                assert_eq!(image.pixels, expected.pixels);
                let left_out = runs.iter().map(|run| run.nonfinite).sum::<u64>();
                assert_eq!(left_out as usize, all.iter().filter(|r| !r.radiance.is_finite()).count());
            }
        }
    }
}
