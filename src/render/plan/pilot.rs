//! Pilot of the light that the cache samples, and of paths, at a few pixels: the noise of a sample in a denoised image,
//! and its rays.
//!
//! Each method samples every pixel twice. Half the squared difference estimates the variance of a mean, with the effect
//! of stratification. It is relative to the brightness of the square of pixels around. The greatest 1 % is left out,
//! since a denoiser removes single bright dots.
//!
//! Paths seldom find light of small emitters through glass and over mirrors, and the pilot's few paths do not. The
//! photons of the cache estimate that light, and the noise of paths that find it.
//!
//! The pilot does not see errors of the cache itself, for instance of light through small windows and by sharp lobes.
//!
//! The pilot covers the whole film and has seeds of its own. So crops of an image, and images to be merged, have the
//! same method.

use crate::calibration::PRICES;
use crate::method::{LightStore, Method, PILOT_SPP, SampledPixels};
use base::film::Window;
use base::progress::Control;
use transport::eye::ByPhotons;
use world::World;
use world::view::View;

/// Side of a square in pixels.
const SQUARE: u32 = 4;
/// Minimum number of squares.
const MIN_SQUARES: u64 = 16;
/// Maximum number of squares.
const MAX_SQUARES: u64 = 256;
/// Number of film pixels for each square, so that 1/64 of a film is sampled.
const PIXELS_A_SQUARE: u64 = 1024;
/// Seed of the places of squares.
const SEED: u32 = 0x6c62_272e;
/// Share of the pixels with the greatest differences, which is left out.
const TRIMMED: f64 = 0.01;
/// Luminance that counts as dark, over the 90th percentile.
const DARK: f64 = 0.1;
/// Exponent by which the number of paths that replace a sample grows below [`SMALL`] pixels. Extra samples gain more if
/// more of a film is edges.
const BY_SMALLNESS: f64 = 0.25;
/// Number of pixels of a small film.
const SMALL: f64 = 262_144.0;
/// Variance of the cache's own errors at [`CACHED_SPP`] samples, times their number, over the squared brightness.
///
/// The variance is in inverse proportion to the samples, since lower levels of quality have fewer virtual lights, too.
const CACHED: f64 = 0.004;
/// Samples per pixel of [`CACHED`].
const CACHED_SPP: f64 = 16.0;

/// Number of paths that a denoiser pools. Light that fewer than one of them finds is removed as single bright dots, so
/// that all of it is error. Light that more of them find is in the noise of the pilot's paths.
const POOLED: f64 = 10_000.0;

/// Results of the pilot.
#[derive(Clone, Copy, Debug)]
pub struct Pilot {
    /// Variance of a sample of the cache, over the squared brightness.
    pub variance_of_sampled: f64,
    /// Variance of a path, over the squared brightness.
    pub variance_of_paths: f64,
    /// Rays per sample of the cache.
    pub rays_of_sampled: f64,
    /// Rays per path.
    pub rays_of_paths: f64,
    /// Rays of the pilot.
    pub rays: u64,
    /// Share of the light that paths find too seldom for it to be in their noise.
    pub seldom: f64,
}

impl Pilot {
    /// Samples squares of the film by the cache and by paths.
    ///
    /// The result is `None` if the cache samples no light, if the film is dark, or if cancelled.
    pub fn of(
        world: &World,
        lights: &LightStore,
        view: &View,
        methods: [&Method; 2],
        control: &Control,
    ) -> Option<Pilot> {
        let squares = squares(view.window.film);
        let sample = |method: &Method| method.sample_pixels(world, lights, view, &squares, control);
        let [cache, path] = methods;
        let (sampled, paths) = (sample(cache)?, sample(path)?);
        Pilot::by(squares[0].len(), &sampled, &paths)
    }

    /// Evaluates the light of squares of so many pixels each.
    fn by(square: usize, sampled: &SampledPixels, paths: &SampledPixels) -> Option<Pilot> {
        let [a, b] = &paths.luminances;
        let is_lost = |photons: &&ByPhotons| photons.square > POOLED * photons.mean.powi(2);
        let lost =
            |square: usize| sampled.photons.get(square).filter(is_lost).map_or(0.0, |photons| photons.mean);
        let found = a.iter().zip(b).enumerate();
        let means: Vec<f64> = found.map(|(pixel, (a, b))| 0.5 * (a + b) + lost(pixel / square)).collect();
        let brightness: Vec<f64> = means.chunks(square).map(mean).collect();
        let mut sorted = means.clone();
        sorted.sort_by(f64::total_cmp);
        let dark = DARK * sorted[sorted.len() * 9 / 10].max(mean(&means));
        if !(dark > 0.0 && dark < f64::INFINITY) {
            return None;
        }
        let weight = |pixel: usize| (brightness[pixel / square] + dark).powi(-2);
        let variance = |light: &SampledPixels| {
            let [a, b] = &light.luminances;
            let differences = a.iter().zip(b).enumerate();
            let half_squares = differences.map(|(pixel, (a, b))| 0.5 * (a - b).powi(2) * weight(pixel));
            f64::from(PILOT_SPP) * trimmed_mean(half_squares.collect())
        };
        let lost_squares = (0..brightness.len()).map(|i| lost(i).powi(2) * weight(i * square));
        let variance_of_lost = POOLED * mean(lost_squares.collect::<Vec<_>>());
        Some(Pilot {
            variance_of_sampled: variance(sampled),
            variance_of_paths: variance(paths).max(variance_of_lost),
            rays_of_sampled: sampled.rays_a_sample,
            rays_of_paths: paths.rays_a_sample,
            rays: sampled.rays + paths.rays,
            seldom: mean((0..brightness.len()).map(lost).collect::<Vec<_>>()) / mean(&brightness),
        })
    }

    /// Returns the number of paths that replace a sample of the cache in a denoised image; at least 1, since edges have
    /// the same aliasing.
    ///
    /// The quality is that of the level with `spp` samples, on a film of so many pixels.
    pub fn paths_a_sample(&self, spp: f64, film_pixels: u64) -> f64 {
        let smallness = (SMALL / film_pixels.max(1) as f64).max(1.0);
        let paths = PRICES.paths_per_sample * self.quotient(spp).powf(PRICES.by_variance);
        (paths * smallness.powf(BY_SMALLNESS)).max(1.0)
    }

    /// Returns the variance of a path over that of a sample of the cache, at the level with `spp` samples.
    pub fn quotient(&self, spp: f64) -> f64 {
        let cached = CACHED * (CACHED_SPP / spp.max(1.0));
        self.variance_of_paths / (self.variance_of_sampled + cached)
    }
}

/// Returns the pixels of the squares. They are the same for every crop of a film.
fn squares(film: [u32; 2]) -> Vec<Vec<[u32; 2]>> {
    let pixels = u64::from(film[0]) * u64::from(film[1]);
    let count = (pixels / PIXELS_A_SQUARE).clamp(MIN_SQUARES, MAX_SQUARES) as u32;
    Window::spread(film, SQUARE, count, SEED).map(|square| square.film_pixels().collect()).collect()
}

fn mean(values: impl AsRef<[f64]>) -> f64 {
    let values = values.as_ref();
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn trimmed_mean(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let kept = values.len() - (TRIMMED * values.len() as f64) as usize;
    mean(&values[..kept])
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::hash;

    /// Creates light of squares of sixteen pixels that alternate between two radiances, with relative noise of a given
    /// variance per sample.
    fn light(radiances: [f64; 2], variance: f64, seed: u32) -> SampledPixels {
        let sigma = (12.0 * variance / f64::from(PILOT_SPP)).sqrt();
        let set = |set: u32| {
            let pixel = |i: u32| {
                let uniform = f64::from(hash(i, seed + set)) / 4_294_967_296.0 - 0.5;
                radiances[i as usize % 2] * (1.0 + sigma * uniform)
            };
            (0..16 * 512).map(pixel).collect()
        };
        SampledPixels::new([set(0), set(1)], 1 << 20, 5)
    }

    #[test]
    fn variances_are_those_of_samples() {
        for (radiances, has_edges) in [([1.0, 1.0], false), ([0.5, 1.5], true)] {
            let pilot = Pilot::by(16, &light(radiances, 0.02, 1), &light(radiances, 0.3, 7)).unwrap();
            // Dark is a tenth of the 90th percentile, here 1 or 1.5. Mean squares of the radiances are 1 or 1.25. The
            // hundredth of uniform noise that is left out has a twentieth of the variance.
            let (scale, squares) = if has_edges { (1.0 / 1.15f64.powi(2), 1.25) } else { (1.0 / 1.21, 1.0) };
            let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.12;
            assert!(near(pilot.variance_of_sampled, 0.02 * squares * scale), "{pilot:?}");
            assert!(near(pilot.variance_of_paths, 0.3 * squares * scale), "{pilot:?}");
            assert_eq!(pilot.rays, (1 << 21) + 10);
        }
    }

    #[test]
    fn single_bright_dots_do_not_count() {
        let even = light([1.0, 1.0], 0.02, 1);
        let mut dotted = light([1.0, 1.0], 0.02, 1);
        (0..16 * 512).step_by(200).for_each(|i| dotted.luminances[0][i] = 1e3);
        let pilot = Pilot::by(16, &dotted, &even).unwrap();
        assert!((pilot.variance_of_sampled / pilot.variance_of_paths - 1.0).abs() < 0.1, "{pilot:?}");
    }

    #[test]
    fn light_that_photons_find_counts_as_the_noise_of_paths() {
        let [even, paths] = [1, 7].map(|seed| light([1.0, 1.0], 0.02, seed));
        let with = |mean: f64, square: f64| {
            let photons = vec![ByPhotons { mean, square }; 512];
            Pilot::by(16, &SampledPixels { photons, ..light([1.0, 1.0], 0.02, 1) }, &paths).unwrap()
        };
        let none = Pilot::by(16, &even, &paths).unwrap();
        assert_eq!(with(0.0, 0.0).variance_of_paths, none.variance_of_paths);
        let near = |found: f64, expected: f64| (found / expected - 1.0).abs() < 0.05;
        // The brightness has a tenth added that counts as dark.
        let of_lost = |mean: f64| POOLED * (mean / (1.1 * (1.0 + mean))).powi(2);
        assert!(near(with(0.1, 101.0).variance_of_paths, of_lost(0.1)));
        assert!(near(with(0.1, 101.0).seldom, 0.1 / 1.1));
        // Light that paths find often enough is in their own noise.
        assert_eq!(with(0.1, 99.0).variance_of_paths, none.variance_of_paths);
        assert_eq!(with(0.1, 99.0).seldom, 0.0);
        // An emitter that no path can hit.
        assert!(near(with(0.01, f64::MAX).variance_of_paths, of_lost(0.01)));
        assert!(with(0.3, 1e18).paths_a_sample(16.0, 1 << 18) > 5.0 * none.paths_a_sample(16.0, 1 << 18));
    }

    #[test]
    fn a_dark_film_has_no_pilot() {
        let dark = || light([0.0, 0.0], 0.0, 1);
        assert!(Pilot::by(16, &dark(), &dark()).is_none());
    }

    #[test]
    fn paths_are_worth_less_the_noisier_they_are_and_no_more_than_a_sample() {
        let pilot =
            |paths: f64| Pilot::by(16, &light([1.0, 1.0], 0.02, 1), &light([1.0, 1.0], paths, 7)).unwrap();
        assert_eq!(pilot(1e-4).paths_a_sample(16.0, 1 << 18), 1.0);
        let at = |paths: f64, spp: f64| pilot(paths).paths_a_sample(spp, 1 << 18);
        assert!(at(0.4, 16.0) > 1.2 * at(0.2, 16.0));
        // The cache's own errors have the variance 0.004 at 16 samples, and eight times as much at 2.
        let noise = pilot(0.4).variance_of_sampled;
        let expected = ((noise + 0.032) / (noise + 0.004)).powf(PRICES.by_variance);
        let found = at(0.4, 16.0) / at(0.4, 2.0);
        assert!((found / expected - 1.0).abs() < 1e-9 && found > 1.3, "{found} {expected}");
    }

    #[test]
    fn samples_of_small_films_are_worth_more_paths() {
        let pilot = Pilot::by(16, &light([1.0, 1.0], 0.02, 1), &light([1.0, 1.0], 0.4, 7)).unwrap();
        let at = [14, 18, 22].map(|log| pilot.paths_a_sample(16.0, 1 << log));
        assert!((at[0] / at[1] - 2.0).abs() < 1e-9 && at[1] == at[2], "{at:?}");
    }

    #[test]
    fn squares_are_few_and_lie_in_the_film() {
        for film in [[1, 1], [3, 500], [64, 64], [512, 512], [4096, 4096]] {
            let squares = squares(film);
            let pixels: usize = squares.iter().map(Vec::len).sum();
            assert!(
                squares.iter().flatten().all(|pixel| pixel[0] < film[0] && pixel[1] < film[1]),
                "{film:?}"
            );
            let share = pixels as f64 / f64::from(film[0] * film[1]);
            assert!(share <= 1.0 / 64.0 || pixels <= 256, "{film:?} {share}");
        }
    }
}
