//! Measures prices of [`crate::cost`] on this machine, by images of a view.

use crate::cost::{PRICES, ScenePrices};
use crate::denoise::{Denoiser, Guides, Quality};
use crate::method::{LightStore, Method, Output, path, vpl};
use base::film::Image;
use base::progress::Control;
use base::stats::{Stage, Stopwatch};
use world::World;
use world::view::View;

/// Samples per pixel of the path-traced image.
const PATHS: u32 = 16;
/// Microseconds per second.
const MICROSECONDS: f64 = 1e6;

/// A price as it is used, and as it was measured, in microseconds of one core.
#[derive(Clone, Copy, Debug)]
pub struct MeasuredPrice {
    /// Name of the price.
    pub name: &'static str,
    /// Price in the scene by [`PRICES`].
    pub used: f64,
    /// Price on this machine.
    pub measured: f64,
}

/// Measures the prices of rays, virtual lights and denoised pixels; `None` if cancelled.
///
/// Prices of denoising are left out if the library is missing.
pub fn measure_prices(world: &World, view: &View, control: &Control) -> Option<Vec<MeasuredPrice>> {
    let prices = ScenePrices::new(world.scene.seen_triangle_count());
    let render = |method: Method| {
        let output = method.render(world, &LightStore::default(), view, control);
        output.complete.then_some(output)
    };
    let by_paths = render(Method::Path(path::Settings { spp: PATHS, ..path::Settings::default() }))?;
    let by_cache = render(Method::Vpl(vpl::Settings::cache()))?;

    let path_time = time(&by_paths, &[Stage::Render]);
    let (rays, shadow_rays) = (by_paths.work.rays as f64, by_paths.work.shadow_rays as f64);
    let light_time = time(&by_cache, &[Stage::LightPass, Stage::Tree]);
    let mut measured = vec![
        MeasuredPrice { name: "ray of a path", used: prices.ray, measured: path_time / (rays + shadow_rays) },
        MeasuredPrice {
            name: "counted ray",
            used: prices.counted_ray,
            measured: path_time / (rays + PRICES.shadow * shadow_rays),
        },
        MeasuredPrice {
            name: "counted virtual light",
            used: PRICES.counted_vpl,
            measured: light_time / by_cache.work.vpls.max(1) as f64,
        },
        MeasuredPrice {
            name: "pixel of the cache",
            used: prices.time(&by_cache.work) / by_cache.color.pixels.len() as f64,
            measured: time(&by_cache, &Stage::ALL) / by_cache.color.pixels.len() as f64,
        },
    ];
    if let Ok(denoiser) = Denoiser::load() {
        measured.extend(denoised_pixels(&denoiser, &by_paths.color));
    }
    Some(measured)
}

/// Returns the processor time of some stages of an image.
fn time(output: &Output, stages: &[Stage]) -> f64 {
    let seconds = |stage: &Stage| output.stats.stage(*stage).map_or(0.0, |time| time.cpu_seconds);
    MICROSECONDS * stages.iter().map(seconds).sum::<f64>()
}

/// Measures the prices of a pixel by quality of denoising. The image guides itself.
fn denoised_pixels(denoiser: &Denoiser, image: &Image) -> Vec<MeasuredPrice> {
    let names = [
        (Quality::High, "pixel denoised, high quality"),
        (Quality::Balanced, "pixel denoised, balanced quality"),
        (Quality::Fast, "pixel denoised, fast quality"),
    ];
    let guides = Guides { albedo: Some(image), normal: Some(image), noise_free: true, ..Guides::default() };
    let price = |(quality, name): (Quality, &'static str)| {
        let mut time = 0.0;
        // The first image of a quality takes longer.
        for _ in 0..2 {
            let watch = Stopwatch::start();
            denoiser.denoise(image, &guides, quality).ok()?;
            time = MICROSECONDS * watch.elapsed().cpu_seconds;
        }
        let used = PRICES.denoised_pixel * PRICES.denoising(quality);
        Some(MeasuredPrice { name, used, measured: time / image.pixels.len() as f64 })
    };
    names.into_iter().filter_map(price).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::math::Rgb;
    use glam::Vec3;
    use scene::{Camera, DeltaLight};
    use world::testkit::*;

    #[test]
    fn prices_are_measured_in_a_lit_room_and_not_if_cancelled() {
        let mut scene = scene(Camera::default(), [32, 32]);
        let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
        scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, grey));
        scene.lights.push(DeltaLight::Point { position: Vec3::Z * 0.5, intensity: Rgb::ONE });
        let WorldAndView { world, view } = world(scene);
        let control = Control::new();
        let prices = measure_prices(&world, &view, &control).unwrap();
        assert!(prices.len() >= 4);
        for price in prices {
            assert!(price.used > 0.0 && price.measured > 0.0 && price.measured < 1e4, "{price:?}");
        }
        control.cancel();
        assert!(measure_prices(&world, &view, &control).is_none());
    }
}
