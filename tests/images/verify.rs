//! Errors measured by `verify` against known errors.

use crate::kit::*;
use crate::oracle::on_threads;
use glam::{DVec3, Vec3};
use lightsplat::film::metrics::{rel_mse, rel_mse_of_variance, relative_error_map};
use lightsplat::film::{Image, Window};
use lightsplat::math::Rgb;
use lightsplat::method::path::{PixelPaths, PixelSampling, RayCounts, pixel_means};
use lightsplat::method::{Estimand, Method, path, vpl};
use lightsplat::progress::Control;
use lightsplat::scene::PixelFilter;
use lightsplat::verify::{Estimate, Verified, VerifySettings, verify};
use lightsplat::view::View;
use rayon::prelude::*;

/// A closed room of albedo ρ whose walls all emit L: radiance L/(1-ρ) everywhere.
fn furnace() -> (WorldAndView, Rgb) {
    let (albedo, emitted) = (Rgb::new(0.5, 0.3, 0.6), Rgb::new(1.0, 0.5, 2.0));
    let mut scene = scene(camera(Vec3::new(0.3, 0.2, 0.8), Vec3::ZERO, 0.7), [40, 30]);
    let wall = add_material(&mut scene, diffuse(albedo));
    for mesh in room(Vec3::splat(-1.0), Vec3::ONE, wall) {
        scene.meshes.push(emitting(mesh, emitted));
    }
    (world(scene), emitted / (Rgb::ONE - albedo))
}

/// A room with a lamp and a sphere: dark corners, a penumbra, an emitter in view.
fn lit_room() -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.1, 0.0, 0.95), Vec3::new(0.0, -0.1, 0.0), 0.8), [48, 36]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.4)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.3), 0.35, 24, wall));
    let lamp = quad(Vec3::new(-0.3, 0.99, -0.5), Vec3::X * 0.6, Vec3::Z * 0.4, wall);
    scene.meshes.push(emitting(lamp, Rgb::splat(9.0)));
    world(scene)
}

fn check(world: &WorldAndView, image: &Image, settings: &VerifySettings) -> Verified {
    verify(world, &world.view, image, settings, &Control::new()).expect("nobody cancels")
}

#[test]
fn a_right_picture_is_measured_as_right() {
    let (world, radiance) = furnace();
    let mut image = Image::new(40, 30);
    image.pixels.fill(radiance);
    let found = check(&world, &image, &VerifySettings { pixels: 300, ..VerifySettings::default() });
    assert!(found.relative_bias.covers(0.0), "{found:?}");
    assert!(found.relative_rms.low == 0.0 && found.relative_rms.high < 0.006, "{found:?}");
    // Hidden by noise, and no more than if all of that were error: 1.96 times its deviation, more by the
    // interval.
    assert!(!found.error_95_resolved && found.relative_error_95.low == 0.0, "{found:?}");
    assert!(found.relative_error_95.high < 2.5 * found.noise, "{found:?}");
    assert!(found.noise <= 0.013 && found.nonfinite == 0, "{found:?}");
}

#[test]
fn errors_put_into_a_right_picture_are_measured_within_their_intervals() {
    let (world, radiance) = furnace();
    // 3 % too bright everywhere, every twentieth pixel 30 % too dark.
    let mut image = Image::new(40, 30);
    let factor = |i: usize| if i % 20 == 7 { 0.7 } else { 1.03 };
    image.pixels.iter_mut().enumerate().for_each(|(i, p)| *p = radiance * factor(i));
    let mut truth = image.clone();
    truth.pixels.fill(radiance);
    for seed in 0..4 {
        let found = check(&world, &image, &VerifySettings { pixels: 400, seed, ..VerifySettings::default() });
        let bias = 0.95f64 * 0.03 - 0.05 * 0.3;
        assert!(found.relative_bias.covers(bias) && width(found.relative_bias) < 0.02, "{found:?}");
        let rms = rel_mse(&image, &truth, 0.0).sqrt();
        assert!(found.relative_rms.covers(rms) && width(found.relative_rms) < 0.6 * rms, "{found:?}");
        // The error jumps from 3 % to 30 % at exactly that share of the pixels.
        assert!((0.02..0.31).contains(&found.relative_error_95.value), "{found:?}");
    }
}

fn width(estimate: Estimate) -> f64 {
    estimate.high - estimate.low
}

#[test]
fn a_path_traced_picture_has_the_error_that_its_own_variance_states() {
    let world = lit_room();
    let settings = path::Settings { spp: 64, ..path::Settings::default() };
    let output = rendered(&world, &settings);
    let noise = rel_mse_of_variance(&output.variance.unwrap(), &output.color).sqrt();
    let found = check(&world, &output.color, &VerifySettings { pixels: 600, ..VerifySettings::default() });
    // The variance is a conservative estimate, since samples are stratified.
    assert!(found.relative_rms.low < noise && found.relative_rms.high > 0.5 * noise, "{noise} {found:?}");
    assert!(found.relative_bias.low < 0.0 && found.relative_bias.high > 0.0, "{found:?}");
}

#[test]
fn edges_count_as_errors_of_pixels_but_not_of_eye_samples() {
    // Emitters in view, and nothing that reflects: a sample through the pixel's centre is exact there.
    let mut scene = scene(camera(Vec3::ZERO, -Vec3::Z, 1.0), [40, 40]);
    let black = add_material(&mut scene, diffuse(Rgb::ZERO));
    for k in 0..5 {
        let corner = Vec3::new(-0.93 + 0.4 * k as f32, -0.9, -1.0);
        let slanted = Vec3::new(0.13, 1.8, 0.0);
        scene.meshes.push(emitting(quad(corner, Vec3::X * 0.2, slanted, black), Rgb::ONE));
    }
    let world = world(scene);
    let one = vpl::Settings { spp: 1, ..vpl::Settings::lightcuts() };
    let by_one = image(&world, &one);
    let at = |estimand: Estimand| {
        check(&world, &by_one, &VerifySettings { pixels: 700, estimand, ..VerifySettings::default() })
    };
    let light = at(Estimand::EyeSamples { spp: 1, seed: 0 });
    assert_eq!((light.relative_rms.high, light.relative_bias.value), (0.0, 0.0), "{light:?}");
    let all = at(Estimand::Pixels);
    let exact = image(&world, &path::Settings { spp: 4096, ..path::Settings::default() });
    let rms = rel_mse(&by_one, &exact, 0.0).sqrt();
    assert!(rms > 0.1 && all.relative_rms.covers(rms), "{rms} {all:?}");

    // Errors at several eye samples with positions of their own are found as well, and differ from those of
    // another seed.
    let four = vpl::Settings { spp: 4, seed: 3, ..vpl::Settings::lightcuts() };
    let by_four = image(&world, &four);
    let at = |estimand: Estimand| {
        check(&world, &by_four, &VerifySettings { pixels: 700, estimand, ..VerifySettings::default() })
    };
    assert!(at(Estimand::EyeSamples { spp: 4, seed: 3 }).relative_rms.high < 1e-6);
    assert!(at(Estimand::EyeSamples { spp: 4, seed: 4 }).relative_rms.low > 0.02);
}

#[test]
fn pictures_by_filters_with_negative_lobes_are_measured_as_they_are() {
    let mut world = lit_room();
    world.view.camera.filter = PixelFilter::Lanczos;
    // Fewer pixels of as many samples: what filters differ by is greater.
    world.view = View::whole(world.view.camera, [24, 18]);
    let a = world.view.camera.filter.sharpening();
    let converged = path::Settings { spp: 4096, ..path::Settings::default() };
    let output = rendered(&world, &converged);
    let settings = VerifySettings { pixels: 600, ..VerifySettings::default() };
    let sharp = check(&world, &output.color.sharpened(a), &settings);
    let soft = check(&world, &output.color, &settings);
    let noise = rel_mse_of_variance(&output.variance.unwrap().sharpened_variance(a), &output.color).sqrt();
    assert!(
        sharp.relative_rms.low < noise && soft.relative_rms.low > 1.5 * noise,
        "{noise} {sharp:?} {soft:?}"
    );
}

#[test]
fn crops_threads_and_seeds() {
    let world = lit_room();
    let window = Window { offset: [10, 5], width: 20, height: 16, ..world.view.window };
    let view = View { window, ..world.view };
    let settings = path::Settings { spp: 16, ..path::Settings::default() };
    let image = rendered_view(&world, &view, &settings).color;
    let settings = VerifySettings { pixels: 100, max_samples: 256, ..VerifySettings::default() };
    let run = |threads: usize, settings: &VerifySettings| {
        on_threads(threads, || verify(&world, &view, &image, settings, &Control::new())).unwrap()
    };
    let one = run(1, &settings);
    assert_eq!(one, run(3, &settings));
    assert_ne!(one, run(1, &VerifySettings { seed: 1, ..settings }));
    // The crop's pixels are those of the whole film: their error is noise, not displacement.
    assert!(one.relative_rms.value < 0.5 && one.pixels <= 100, "{one:?}");
    let control = Control::new();
    control.cancel();
    assert_eq!(verify(&world, &view, &image, &settings, &control), None);
}

/// Renders independent references through the positions of `estimand`.
fn references(world: &WorldAndView, estimand: Estimand, spp: u32) -> Vec<Image> {
    const MEANS: u32 = 16;
    let [width, height] = world.view.window.film;
    let depth = world.scene.max_depth.unwrap_or(u32::MAX);
    let row = |y: u32, seed: u32| -> Vec<Rgb> {
        let wanted: Vec<PixelPaths> =
            (0..width).map(|x| PixelPaths { pixel: [x, y], samples: spp / MEANS }).collect();
        let sampling = PixelSampling { estimand, seed: 0x00c0_ffee + seed, max_depth: depth, learned: None };
        let (row, _) = pixel_means(world, &world.view, sampling, &wanted, &mut RayCounts::default());
        row.into_iter().map(|mean| mean.as_vec3()).collect()
    };
    let reference = |seed: u32| {
        let mut image = Image::new(width, height);
        image.pixels = (0..height).into_par_iter().flat_map_iter(|y| row(y, seed)).collect();
        image
    };
    (0..MEANS).map(reference).collect()
}

/// Bias, and mean and 95th percentile of the relative square error, each with its standard error, of an image
/// by independent references. The jackknife removes the bias due to their noise, except for the percentile,
/// which it is not made for: that is extrapolated linearly from half of the references through all to zero
/// noise, and its error is taken to be the length of the step.
fn known(image: &Image, references: &[Image]) -> [(f64, f64); 3] {
    let by = |wanted: &dyn Fn(usize) -> bool| {
        let mut reference = image.clone();
        let chosen: Vec<&Image> = (0..).zip(references).filter(|r| wanted(r.0)).map(|r| r.1).collect();
        for (i, p) in reference.pixels.iter_mut().enumerate() {
            let sum: DVec3 = chosen.iter().map(|r| r.pixels[i].as_dvec3()).sum();
            *p = (sum / chosen.len() as f64).as_vec3();
        }
        let mean = |image: &Image| image.pixels.iter().map(|p| p.as_dvec3().element_sum()).sum::<f64>();
        let mut errors = relative_error_map(image, &reference);
        errors.sort_by(f32::total_cmp);
        let percentile = f64::from(errors[errors.len() * 95 / 100]);
        [mean(image) / mean(&reference) - 1.0, rel_mse(image, &reference, 0.0), percentile * percentile]
    };
    let n = references.len() as f64;
    let all = by(&|_| true);
    let others: Vec<[f64; 3]> = (0..references.len()).map(|k| by(&|r| r != k)).collect();
    let jackknife = |i: usize| {
        let pseudo: Vec<f64> = others.iter().map(|o| n * all[i] - (n - 1.0) * o[i]).collect();
        let mean = pseudo.iter().sum::<f64>() / n;
        let squares: f64 = pseudo.iter().map(|p| (p - mean) * (p - mean)).sum();
        (mean, (squares / (n * (n - 1.0))).sqrt())
    };
    // Eight partitions into halves.
    let halves: f64 = (0..8).map(|k| by(&|r| (r + k) % 16 < 8)[2] + by(&|r| (r + k) % 16 >= 8)[2]).sum();
    let noise = (halves / 16.0 - all[2]).max(0.0);
    [jackknife(0), jackknife(1), (all[2] - noise, noise / 1.96)]
}

/// True if an estimate and a truth with its standard error agree within both their tolerances.
fn agree(e: Estimate, (truth, standard_error): (f64, f64)) -> bool {
    let end = if truth > e.value { e.high } else { e.low };
    (truth - e.value).abs() <= (end - e.value).hypot(1.96 * standard_error)
}

/// Thirteen pairs of scene and settings, each verified with four seeds. Prints the table: the truth's interval by
/// a whole reference, which is itself noisy, and the estimate with its own.
#[test]
#[ignore = "a study: minutes of path tracing"]
fn intervals_cover_the_true_error_at_least_nine_times_in_ten() {
    let (mut covered, mut trials) = ([0; 3], 0);
    for name in ["cornell", "knot", "nave", "kitchen", "apartment"] {
        let world = own(name, 64);
        let cached = vpl::Settings::reconstruction();
        let eye = Estimand::EyeSamples { spp: cached.spp, seed: cached.seed };
        let mut few = cached;
        (few.light.indirect, few.cut.epsilon) = (20_000, 0.04);
        let cuts = vpl::Settings::lightcuts();
        let few_paths = path::Settings { spp: 64, ..Default::default() };
        let by_default = vpl::Settings::cache();
        let pairs = match name {
            "cornell" | "kitchen" => vec![
                ("cache", image(&world, &by_default), Estimand::Pixels),
                ("reconstruction", image(&world, &cached), eye),
                ("reconstruction, few VPLs", image(&world, &few), eye),
            ],
            "knot" => vec![
                ("reconstruction", image(&world, &cached), eye),
                ("cache", image(&world, &by_default), Estimand::Pixels),
                ("path, 64 spp", image(&world, &few_paths), Estimand::Pixels),
            ],
            "nave" => vec![
                ("reconstruction", image(&world, &cached), eye),
                ("reconstruction, pixels", image(&world, &cached), Estimand::Pixels),
            ],
            _ => vec![
                ("lightcuts", image(&world, &cuts), eye),
                ("path, 64 spp", image(&world, &few_paths), Estimand::Pixels),
            ],
        };
        let mut traced: Vec<(Estimand, Vec<Image>)> = Vec::new();
        for (method, image, estimand) in pairs {
            if !traced.iter().any(|(l, _)| *l == estimand) {
                traced.push((estimand, references(&world, estimand, 16384)));
            }
            let (_, references) = traced.iter().find(|(l, _)| *l == estimand).unwrap();
            let truth = known(&image, references);
            for seed in 0..4 {
                let settings = VerifySettings { pixels: 500, estimand, seed, ..VerifySettings::default() };
                let found = check(&world, &image, &settings);
                let square = |e: Estimate| e.map(|e| e * e);
                let estimates =
                    [found.relative_bias, square(found.relative_rms), square(found.relative_error_95)];
                trials += 1;
                print!(
                    "{name:10} {method:16} {seed} paths ±{:.2} %, {} at the cap |",
                    100.0 * found.noise,
                    found.pixels_at_cap
                );
                for (i, (truth, e)) in truth.into_iter().zip(estimates).enumerate() {
                    let agrees = agree(e, truth);
                    covered[i] += u32::from(agrees);
                    let mark = if agrees { ' ' } else { '!' };
                    let shown = |x: f64| 100.0 * if i == 0 { x } else { x.max(0.0).sqrt() };
                    let [low, high] = [-1.96, 1.96].map(|z| shown(truth.0 + z * truth.1));
                    let [value, least, most] = [e.value, e.low, e.high].map(shown);
                    print!(" [{low:6.2}, {high:6.2}] by {value:6.2} [{least:6.2}, {most:6.2}]{mark}|");
                }
                println!();
            }
        }
    }
    println!("covered of {trials}: bias {}, RMS {}, percentile {}", covered[0], covered[1], covered[2]);
    assert!(covered.iter().all(|&c| c * 10 >= trials * 9), "{covered:?} of {trials}");
}

mod study_of_default {
    use super::*;

    /// The default in a room with a ball and a lamp, without denoising and, where there is the library, with it.
    #[test]
    #[ignore = "a study: minutes of path tracing"]
    fn intervals_cover_the_error_of_the_default_noisy_and_denoised() {
        let settings = vpl::Settings::cache();
        let mut scene = staged(lit_room());
        scene.max_depth = Some(6);
        let (session, view) = session(scene);
        let noisy = frame(&session, &view, Method::Vpl(settings), false).film.color;
        let denoised = frame(&session, &view, Method::Vpl(settings), true);
        let world = WorldAndView { world: session.world, view };
        // With 4096 paths their own noise is part of the error: they cover 70 of 80, with these 75.
        let references = references(&world, Estimand::Pixels, 32768);
        let mut pictures = vec![noisy];
        if !lacks_denoiser(&denoised) {
            pictures.push(denoised.film.color);
        }
        let (mut covered, mut trials) = ([0; 3], 0);
        for image in pictures {
            let truth = known(&image, &references);
            for seed in 0..20 {
                let settings = VerifySettings { pixels: 400, seed, ..VerifySettings::default() };
                let found = check(&world, &image, &settings);
                let square = |e: Estimate| e.map(|e| e * e);
                let estimates =
                    [found.relative_bias, square(found.relative_rms), square(found.relative_error_95)];
                for (i, estimate) in estimates.into_iter().enumerate() {
                    covered[i] += u32::from(agree(estimate, truth[i]));
                }
                trials += 1;
            }
        }
        assert!(covered.iter().all(|&c| c * 10 >= trials * 9), "{covered:?} of {trials}");
    }
}
