//! Fits of prices and constants ([`Prices`]) to the images of all scenes.
//!
//! A price is the geometric mean over images, or a line over the doublings of the triangles. The work of a step is
//! priced by the step's own time. Prices of rays beside paths are relative to a ray of a path in the scene.

use super::answer::SceneAnswer;
use crate::study::{Bounded, Shot, time_to};
use base::film::Image;
use base::stats::{Stage, Stopwatch};
use render::calibration::PRICES;
use render::denoise::{Denoiser, Guides, Quality};
use render::prices::Prices;
use serde::Serialize;

/// Microseconds per second.
const MICROSECONDS: f64 = 1e6;

/// A fitted price or constant.
#[derive(Serialize)]
pub struct Fitted {
    /// Name of the field of [`Prices`].
    pub name: &'static str,
    /// Value that plans use.
    pub used: f64,
    /// Value that fits the images.
    pub value: f64,
    /// Factor by which single images differ from the value, as a root mean square.
    pub residual: f64,
    /// Number of images.
    pub images: usize,
}

/// An image, in a scene of so many doublings of the triangles.
struct Sample<'s> {
    doublings: f64,
    shot: &'s Shot,
}

impl Sample<'_> {
    fn time(&self, stages: &[Stage]) -> f64 {
        MICROSECONDS * self.shot.counted.seconds(stages)
    }

    /// Returns the rays outside the eye pass and the paths of virtual lights.
    fn rays_of_cuts(&self) -> f64 {
        let work = &self.shot.counted.work;
        let all = (work.rays + work.shadow_rays) as f64;
        (all - self.shot.counted.eye_rays - PRICES.vpl_rays * work.vpls as f64).max(1.0)
    }
}

/// Returns how often the triangles double from the smallest scene to that of an answer.
fn doublings(scene: &SceneAnswer) -> f64 {
    (scene.answer.triangles as f64 / PRICES.smallest_scene).max(1.0).log2()
}

/// Returns the images of a scene.
fn samples_of(scene: &SceneAnswer) -> Vec<Sample<'_>> {
    let doublings = doublings(scene);
    scene.answer.shots.iter().map(|shot| Sample { doublings, shot }).collect()
}

/// Fits all prices that images of so many pixels tell.
pub fn fit(scenes: &[SceneAnswer], pixels: f64) -> Vec<Fitted> {
    let samples = scenes.iter().flat_map(samples_of);
    let (paths, cache): (Vec<Sample>, Vec<Sample>) = samples.partition(|s| s.shot.candidate.is_path());
    let mut fitted = Fits::default();
    let prices = |shadow: f64| -> Vec<(f64, f64)> {
        let price = |sample: &Sample| {
            let work = &sample.shot.counted.work;
            sample.time(&[Stage::Render]) / (work.rays as f64 + shadow * work.shadow_rays as f64)
        };
        paths.iter().map(|sample| (sample.doublings, price(sample))).collect()
    };
    let of_rays = prices(1.0);
    let [ray, by_doubling] = line(&of_rays);
    let price = |doublings: f64| (ray + by_doubling * doublings).max(f64::MIN_POSITIVE);
    let factor = residual(of_rays.iter().map(|(doublings, found)| (*found, price(*doublings))));
    fitted.add("ray", ray, factor, of_rays.len());
    fitted.add("ray_by_doubling", by_doubling, factor, of_rays.len());
    let counted = prices(PRICES.shadow).into_iter().filter(|(doublings, _)| *doublings > 0.0);
    fitted.mean("counted_ray_by_doubling", counted.map(|(doublings, found)| (found - ray) / doublings));
    let of_lights = |sample: &Sample| {
        sample.time(&[Stage::LightPass, Stage::Tree]) / sample.shot.counted.work.vpls.max(1) as f64
    };
    let ray_of = |sample: &Sample| price(sample.doublings);
    fitted.mean("counted_vpl", cache.iter().map(of_lights));
    fitted.mean("vpl", cache.iter().map(|s| of_lights(s) - PRICES.vpl_rays * ray_of(s)));
    let eye = |s: &Sample| s.time(&[Stage::EyePass]) / s.shot.counted.eye_rays.max(1.0);
    fitted.mean("sampled", cache.iter().map(|s| eye(s) / ray_of(s)));
    fitted.mean("rays_a_vpl", cache.iter().map(|s| of_lights(s) / eye(s)));
    let of_cuts = |s: &Sample| s.time(&[Stage::Records, Stage::Splat, Stage::Render]) / s.rays_of_cuts();
    fitted.mean("cached", cache.iter().map(|s| of_cuts(s) / ray_of(s)));
    let of_pilot = |scene: &SceneAnswer| {
        let rays = scene.choice.pilot_rays as f64 * price(doublings(scene));
        MICROSECONDS * scene.pilot_seconds / rays
    };
    fitted.mean("pilot", scenes.iter().map(of_pilot));
    fitted.rays_of_cuts(&cache, pixels);
    fitted.networks(scenes);
    fitted.paths_for_samples(scenes);
    fitted.0
}

/// Fitted prices.
#[derive(Default)]
struct Fits(Vec<Fitted>);

impl Fits {
    fn add(&mut self, name: &'static str, value: f64, residual: f64, images: usize) {
        if images > 0 && value.is_finite() && value > 0.0 {
            let used = serde_json::json!(PRICES)[name].as_f64().unwrap_or(0.0);
            self.0.push(Fitted { name, used, value, residual, images });
        }
    }

    /// Adds the geometric mean of positive values.
    fn mean(&mut self, name: &'static str, values: impl Iterator<Item = f64>) {
        let values: Vec<f64> = values.filter(|value| value.is_finite() && *value > 0.0).collect();
        let sum: f64 = values.iter().map(|value| value.ln()).sum();
        let mean = (sum / values.len().max(1) as f64).exp();
        self.add(name, mean, residual(values.iter().map(|value| (*value, mean))), values.len());
    }

    /// Adds the number of rays of records and cuts, and its growth with the samples.
    fn rays_of_cuts(&mut self, cache: &[Sample], pixels: f64) {
        let Prices { indirect_pixels, indirect_by_pixels, indirect_spp, .. } = PRICES;
        let point = |sample: &Sample| {
            let rays = sample.rays_of_cuts() / (pixels / indirect_pixels).powf(indirect_by_pixels);
            ((f64::from(sample.shot.candidate.method.spp()) / indirect_spp).ln(), rays.ln())
        };
        let points: Vec<(f64, f64)> = cache.iter().map(point).collect();
        let [log_rays, by_spp] = line(&points);
        let pairs = points.iter().map(|(x, y)| (y.exp(), (log_rays + by_spp * x).exp()));
        let factor = residual(pairs);
        self.add("indirect_rays", log_rays.exp(), factor, points.len());
        self.add("indirect_by_spp", by_spp, factor, points.len());
    }

    /// Adds the prices of the denoiser's networks.
    fn networks(&mut self, scenes: &[SceneAnswer]) {
        let of = |quality: usize| scenes.iter().filter_map(move |scene| scene.denoising[quality]);
        let over_best = |quality: usize| of(quality).zip(of(2)).map(|(price, best)| price / best);
        self.mean("denoised_pixel", of(2).map(|price| MICROSECONDS * price));
        self.mean("balanced_denoising", over_best(1));
        self.mean("fast_denoising", over_best(0));
    }

    /// Adds the constants of the number of paths that replace a sample of the cache.
    fn paths_for_samples(&mut self, scenes: &[SceneAnswer]) {
        let mut found = Vec::new();
        for scene in scenes {
            let paths = scene.answer.shots.iter().filter(|shot| shot.candidate.is_path());
            let point = |shot: &Shot| (f64::from(shot.candidate.method.spp()), shot.errors.displayed_rmse());
            let curve: Vec<(f64, f64)> = paths.map(point).collect();
            for budget in &scene.budgets {
                // Fewer paths than samples are never expected, so that such images tell nothing.
                let paths = time_to(budget.cache[0], &curve).filter(|_| budget.paths_a_sample > 1.0);
                let Some(Bounded::About(paths)) = paths else { continue };
                let of_variance = PRICES.paths_per_sample * budget.quotient.powf(PRICES.by_variance);
                let by_smallness = budget.paths_a_sample / of_variance;
                found.push((budget.quotient.ln(), (paths / budget.spp / by_smallness).ln()));
            }
        }
        let [log_paths, by_variance] = line(&found);
        let factor = residual(found.iter().map(|(x, y)| (y.exp(), (log_paths + by_variance * x).exp())));
        self.add("paths_per_sample", log_paths.exp(), factor, found.len());
        self.add("by_variance", by_variance, factor, found.len());
    }
}

/// Returns intercept and slope of the line through some points; slope 0 if their first coordinates are equal.
fn line(points: &[(f64, f64)]) -> [f64; 2] {
    let n = points.len().max(1) as f64;
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    let [xx, xy] = [mean(&|p| (p.0 - x).powi(2)), mean(&|p| (p.0 - x) * (p.1 - y))];
    let slope = if xx > 1e-9 { xy / xx } else { 0.0 };
    [y - slope * x, slope]
}

/// Returns the factor by which values differ from what is expected of them, as a root mean square of logarithms.
fn residual(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    let squares: Vec<f64> = pairs.map(|(value, expected)| (value / expected).ln().powi(2)).collect();
    (squares.iter().sum::<f64>() / squares.len().max(1) as f64).sqrt().exp()
}

/// Measures the processor seconds of denoising a pixel, by quality: fast, balanced, high. The image guides itself.
pub fn denoising(image: &Image) -> [Option<f64>; 3] {
    let guides = Guides { albedo: Some(image), normal: Some(image), noise_free: true, ..Guides::default() };
    let Ok(denoiser) = Denoiser::load() else { return [None; 3] };
    [Quality::Fast, Quality::Balanced, Quality::High].map(|quality| {
        // The first image of a quality takes longer.
        denoiser.denoise(image, &guides, quality).ok()?;
        let watch = Stopwatch::start();
        denoiser.denoise(image, &guides, quality).ok()?;
        Some(watch.elapsed().cpu_seconds / image.pixels.len().max(1) as f64)
    })
}

/// Head of the file of the prices.
const HEAD: &str = "//! Prices of work, and constants of the choice between methods.\n//!\n\
    //! `lightsplat bench calibrate` fits them to images and writes this file. A comment has the factor by which\n\
    //! single images differ from the value, as a root mean square. Values without a comment are not fitted.\n";

/// Returns the text of `src/render/calibration.rs`, with the program and machine that it is from.
pub fn source(fitted: &[Fitted], from: &str) -> String {
    let mut text = format!(
        "{HEAD}//!\n//! {from}\n\nuse crate::prices::Prices;\n\n\
         /// The prices that all choices use.\npub const PRICES: Prices = Prices {{\n"
    );
    for (name, used) in serde_json::json!(PRICES).as_object().into_iter().flatten() {
        text += &match fitted.iter().find(|price| price.name == name) {
            Some(Fitted { value, residual, images, .. }) => {
                let value: f64 = format!("{value:.2e}").parse().unwrap_or(*value);
                format!("    // Factor {residual:.2}, {images} images.\n    {name}: {value:?},\n")
            }
            None => format!("    {name}: {used},\n"),
        };
    }
    text + "};\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_prices_are_in_the_form_in_which_they_are_written() {
        let written = include_str!("../../render/calibration.rs");
        let code = |text: &str| -> Vec<String> {
            text.lines().filter(|line| !line.trim_start().starts_with("//")).map(str::to_owned).collect()
        };
        assert_eq!(code(written), code(&source(&[], "")));
        assert!(written.starts_with(HEAD));
        let fitted = Fitted { name: "ray", used: 0.08, value: 0.12345, residual: 1.5, images: 7 };
        assert!(source(&[fitted], "").contains("    // Factor 1.50, 7 images.\n    ray: 0.123,\n"));
    }

    #[test]
    fn lines_and_factors_are_found_again() {
        let points = [0.0, 1.0, 5.0, 7.0].map(|x| (x, 3.0 - 0.5 * x));
        let [intercept, slope] = line(&points);
        assert!((intercept - 3.0).abs() < 1e-12 && (slope + 0.5).abs() < 1e-12);
        assert_eq!(line(&[(2.0, 1.0), (2.0, 3.0)]), [2.0, 0.0]);
        assert!((residual([(2.0, 1.0), (1.0, 2.0)].into_iter()) - 2.0).abs() < 1e-12);
    }
}
