//! Pixel filters.
//!
//! Filters are sampled, not splatted: samples of a pixel are distributed by a density and have equal weights. So the
//! noise of neighbours is independent, as denoisers expect. Every method filters by the positions of its eye rays.
//!
//! A filter with negative lobes is no density. Its samples follow a wider density, and the clean image is sharpened.
//! Along both axes a sharpened pixel is (1 + 2a) times its value minus a times each neighbour.
//!
//! The density is the filter's convolution with the inverse of (-a, 1 + 2a, -a), clipped at [`REACH`] and at 0. The
//! constant a minimises the mean square difference that clipping leaves. Relative to the filter's norm, the difference
//! is at most 0.2 % for cubics, and 2.8 % for Lanczos with three lobes.
//!
//! Papers: M. Ernst, M. Stamminger, G. Greiner, *Filter Importance Sampling*, 2006; D. Mitchell, A. Netravali,
//! *Reconstruction Filters in Computer Graphics*, 1988. F. Harris, *On the Use of Windows for Harmonic Analysis with
//! the Discrete Fourier Transform*, 1978.

use base::sampling::uniform_disk;
use glam::Vec2;
use std::f32::consts::PI;
use std::sync::OnceLock;

/// Weights of samples around a pixel's centre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum PixelFilter {
    /// Box: constant over the pixel.
    #[default]
    Box,
    /// Tent: falls linearly along each axis to 0 at distance `radius`.
    Tent {
        /// Half the width, in pixels.
        radius: f32,
    },
    /// Normal distribution, clipped at four standard deviations.
    Gaussian {
        /// Standard deviation, in pixels.
        deviation: f32,
    },
    /// Window of Blackman and Harris of four terms, three pixels wide.
    BlackmanHarris,
    /// Cubic of Mitchell and Netravali with B = C = 1/3, four pixels wide.
    Mitchell,
    /// Interpolating cubic of Catmull and Rom, four pixels wide.
    CatmullRom,
    /// Windowed sinc of three lobes, six pixels wide.
    Lanczos,
}

/// Half the width of the window of Blackman and Harris, in pixels.
const BLACKMAN_HARRIS: f32 = 1.5;

/// Half the width of the density of samples for filters with negative lobes, in pixels.
const REACH: f32 = 2.5;

/// Number of integration steps per pixel for tables of densities.
const STEPS: usize = 64;

/// Number of parts of equal probability in a table.
const PARTS: usize = 512;

/// Quantiles of the distance along an axis, for the probabilities 0, 1 / PARTS, ..., 1.
type Quantiles = [f32; PARTS + 1];

impl PixelFilter {
    /// Tent of Mitsuba's default width.
    pub const TENT: PixelFilter = PixelFilter::Tent { radius: 1.0 };
    /// Gaussian of Mitsuba's default width.
    pub const GAUSSIAN: PixelFilter = PixelFilter::Gaussian { deviation: 0.5 };

    /// Maps the unit square to the position of a sample, in pixels from the pixel's top-left corner.
    ///
    /// The square's middle becomes the pixel's middle.
    #[inline]
    pub fn place(&self, u: Vec2) -> Vec2 {
        match *self {
            PixelFilter::Box => u,
            PixelFilter::Tent { radius } => {
                let tent =
                    |u: f32| if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() };
                Vec2::splat(0.5) + radius * Vec2::new(tent(u.x), tent(u.y))
            }
            PixelFilter::Gaussian { deviation } => {
                let disk = uniform_disk(u);
                let radius_sq = disk.length_squared();
                if radius_sq == 0.0 {
                    return Vec2::splat(0.5);
                }
                let cut = 1.0 - (-8.0f32).exp();
                let distance = deviation * (-2.0 * (1.0 - (cut * radius_sq).min(cut)).ln()).sqrt();
                Vec2::splat(0.5) + disk * (distance / radius_sq.sqrt())
            }
            PixelFilter::BlackmanHarris
            | PixelFilter::Mitchell
            | PixelFilter::CatmullRom
            | PixelFilter::Lanczos => {
                let quantiles = self.quantiles();
                Vec2::splat(0.5) + Vec2::new(quantile(quantiles, u.x), quantile(quantiles, u.y))
            }
        }
    }

    /// Returns the weight a of sharpening, by which a pixel is diminished by each neighbour along an axis; 0 for
    /// densities.
    pub fn sharpening(&self) -> f32 {
        match self {
            PixelFilter::Mitchell => 0.07,
            PixelFilter::CatmullRom => 0.1225,
            PixelFilter::Lanczos => 0.24,
            PixelFilter::Box
            | PixelFilter::Tent { .. }
            | PixelFilter::Gaussian { .. }
            | PixelFilter::BlackmanHarris => 0.0,
        }
    }

    /// Returns the filter along an axis at distance `x` in pixels, up to a factor, for filters with tables.
    fn weight(&self, x: f32) -> f32 {
        let x = x.abs();
        match self {
            PixelFilter::BlackmanHarris if x < BLACKMAN_HARRIS => {
                let angle = PI * x / BLACKMAN_HARRIS;
                0.35875
                    + 0.48829 * angle.cos()
                    + 0.14128 * (2.0 * angle).cos()
                    + 0.01168 * (3.0 * angle).cos()
            }
            PixelFilter::Mitchell => cubic(x, 1.0 / 3.0, 1.0 / 3.0),
            PixelFilter::CatmullRom => cubic(x, 0.0, 0.5),
            PixelFilter::Lanczos if x < 3.0 => sinc(x) * sinc(x / 3.0),
            _ => 0.0,
        }
    }

    /// Returns the density of samples along an axis, up to a factor. Sharpening turns it into the filter.
    fn density(&self, x: f32) -> f32 {
        let a = self.sharpening();
        if a == 0.0 {
            return self.weight(x);
        }
        if x.abs() >= REACH {
            return 0.0;
        }
        // The inverse of (-a, 1 + 2a, -a) sums powers of the root of its polynomial inside the unit circle.
        let root = (1.0 + 2.0 * a - (1.0 + 4.0 * a).sqrt()) / (2.0 * a);
        let shifted = (-8..=8).map(|shift: i32| root.powi(shift.abs()) * self.weight(x - shift as f32));
        shifted.sum::<f32>().max(0.0)
    }

    /// Returns the table of a filter's density along an axis.
    fn quantiles(&self) -> &'static Quantiles {
        static TABLES: [OnceLock<Quantiles>; 4] = [const { OnceLock::new() }; 4];
        let table = match self {
            PixelFilter::Mitchell => 1,
            PixelFilter::CatmullRom => 2,
            PixelFilter::Lanczos => 3,
            _ => 0,
        };
        TABLES[table].get_or_init(|| {
            let steps = (REACH * STEPS as f32) as usize;
            let mut sums = vec![0.0f64];
            for step in 0..steps {
                let x = (step as f32 + 0.5) / STEPS as f32;
                sums.push(sums[step] + f64::from(self.density(x)));
            }
            let mut step = 0;
            std::array::from_fn(|part| {
                let wanted = sums[steps] * part as f64 / PARTS as f64;
                while step + 1 < steps && sums[step + 1] < wanted {
                    step += 1;
                }
                let within = (wanted - sums[step]) / (sums[step + 1] - sums[step]).max(f64::MIN_POSITIVE);
                (step as f32 + within.clamp(0.0, 1.0) as f32) / STEPS as f32
            })
        })
    }
}

/// Maps the unit interval to a distance along an axis; 0.5 becomes 0.
fn quantile(quantiles: &Quantiles, u: f32) -> f32 {
    let side = 2.0 * u - 1.0;
    let part = (side.abs() * PARTS as f32).min(PARTS as f32);
    let index = (part as usize).min(PARTS - 1);
    let within = part - index as f32;
    (quantiles[index] + within * (quantiles[index + 1] - quantiles[index])).copysign(side)
}

/// Returns the cubic of Mitchell and Netravali at distance `x`.
fn cubic(x: f32, b: f32, c: f32) -> f32 {
    let polynomial = |k: [f32; 4]| k[0] + x * (k[1] + x * (k[2] + x * k[3]));
    if x < 1.0 {
        polynomial([6.0 - 2.0 * b, 0.0, -18.0 + 12.0 * b + 6.0 * c, 12.0 - 9.0 * b - 6.0 * c])
    } else if x < 2.0 {
        polynomial([8.0 * b + 24.0 * c, -12.0 * b - 48.0 * c, 6.0 * b + 30.0 * c, -b - 6.0 * c])
    } else {
        0.0
    }
}

fn sinc(x: f32) -> f32 {
    if x == 0.0 { 1.0 } else { (PI * x).sin() / (PI * x) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;
    use std::f32::consts::TAU;

    const TABLED: [PixelFilter; 4] =
        [PixelFilter::BlackmanHarris, PixelFilter::Mitchell, PixelFilter::CatmullRom, PixelFilter::Lanczos];

    #[test]
    fn samples_lie_around_the_pixel_by_the_filters_density() {
        let n = 1 << 14;
        for (filter, variance, reach) in [
            (PixelFilter::Box, 1.0 / 12.0, 0.5),
            (PixelFilter::TENT, 1.0 / 6.0, 1.0),
            (PixelFilter::Tent { radius: 2.0 }, 4.0 / 6.0, 2.0),
            (PixelFilter::GAUSSIAN, 0.25, 2.0),
            (PixelFilter::BlackmanHarris, 0.172_65, 1.5),
        ] {
            let offsets = (0..n).map(|i| filter.place(owen_sobol_2d(i, 5)) - 0.5);
            let (mut mean, mut squares) = (Vec2::ZERO, Vec2::ZERO);
            for offset in offsets {
                assert!(offset.abs().max_element() <= reach + 1e-5, "{filter:?} {offset}");
                mean += offset / n as f32;
                squares += offset * offset / n as f32;
            }
            assert!(
                mean.length() < 2e-3 && (squares / variance - 1.0).abs().max_element() < 0.01,
                "{filter:?} {squares}"
            );
        }
        for filter in [PixelFilter::Box, PixelFilter::TENT, PixelFilter::GAUSSIAN].into_iter().chain(TABLED) {
            assert_eq!(filter.place(Vec2::splat(0.5)), Vec2::splat(0.5));
            for corner in [Vec2::ZERO, Vec2::ONE, Vec2::new(0.0, 1.0)] {
                assert!(filter.place(corner).is_finite());
            }
        }
    }

    /// Samples and sharpening together pass waves along the film as the filter itself does.
    #[test]
    fn sharpened_densities_are_the_filters_with_negative_lobes() {
        let n = 1 << 14;
        for (filter, tolerance) in
            [(PixelFilter::Mitchell, 0.004), (PixelFilter::CatmullRom, 0.008), (PixelFilter::Lanczos, 0.06)]
        {
            let a = filter.sharpening();
            let grid = || (-4096..4096).map(|i| (i as f32 + 0.5) / 1024.0);
            let whole: f32 = grid().map(|x| filter.weight(x)).sum();
            for frequency in [0.0, 0.1, 0.25, 0.5, 0.75, 1.0, 1.5] {
                let wave = |x: f32| (TAU * frequency * x).cos();
                let expected: f32 = grid().map(|x| filter.weight(x) * wave(x)).sum::<f32>() / whole;
                let sampled =
                    (0..n).map(|i| wave(filter.place(owen_sobol_2d(i, 3)).x - 0.5)).sum::<f32>() / n as f32;
                let sharpened = sampled * (1.0 + 2.0 * a - 2.0 * a * (TAU * frequency).cos());
                assert!(
                    (sharpened - expected).abs() < tolerance,
                    "{filter:?} at {frequency}: {sharpened} {expected}"
                );
            }
        }
    }
}
