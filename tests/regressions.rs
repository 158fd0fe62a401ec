//! Bugs that were found and mended, each by its symptom.

#[path = "behaviour/common.rs"]
mod common;

use common::*;
use lightsplat::film::Image;
use lightsplat::math::luminance;
use lightsplat::method::{Output, cache, lightcuts, photon_cache, reconstruction};
use std::path::Path;

fn own(name: &str) -> WorldAndView {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml");
    world(load_scene(&path, Some([48, 48])))
}

fn relative_rms(test: &Image, reference: &Image) -> f32 {
    let pairs = || test.pixels.iter().zip(&reference.pixels);
    let squares: f32 = pairs().map(|(a, b)| luminance(*a - *b).powi(2)).sum();
    let mean: f32 = pairs().map(|(_, b)| luminance(*b)).sum::<f32>() / reference.pixels.len() as f32;
    (squares / reference.pixels.len() as f32).sqrt() / mean
}

fn brightest(image: &Image) -> f32 {
    image.pixels.iter().map(|p| luminance(*p)).fold(0.0, f32::max)
}

/// Coarse cuts whose representative lay next to a point gave it the light of their whole cluster: bright specks, and an
/// RMS error of 1176 % where there are 12 % now. No cluster gives more than a quarter of the light unsplit.
#[test]
fn coarse_cuts_leave_no_bright_specks() {
    let world = own("knot");
    let mut fine = lightcuts::Settings { spp: 1, ..Default::default() };
    fine.light.indirect = 75_000;
    let reference = rendered(&world, &fine).color;
    let mut coarse = fine;
    (coarse.cut.epsilon, coarse.cut.max_cut) = (0.32, 1250);
    let mut lent = reconstruction::Settings { spp: 1, patches: 512, ..Default::default() };
    (lent.light, lent.cut) = (coarse.light, coarse.cut);
    for (name, picture) in
        [("lightcuts", rendered(&world, &coarse)), ("reconstruction", rendered(&world, &lent))]
    {
        let error = relative_rms(&picture.color, &reference);
        assert!(error < 0.25, "{name}: {error}");
        let ratio = brightest(&picture.color) / brightest(&reference);
        assert!(ratio < 1.5, "{name}: {ratio}");
    }
}

/// A short ray's hit was lit by the coarse cut of a lookup, whose representative could lie next to it: fireflies in
/// creases. No cluster of such a cut gives more than its error allows.
#[test]
fn compensation_makes_no_fireflies_in_creases() {
    let world = own("cornell");
    let with = |compensation| {
        let mut settings = reconstruction::Settings { spp: 1, compensation, ..Default::default() };
        settings.light.indirect = 3000;
        rendered(&world, &settings).color
    };
    let ratio = brightest(&with(true)) / brightest(&with(false));
    assert!(ratio < 1.2, "{ratio}");
}

/// The layers of `--inspect` were written as PNG files by the cache alone, though the photon cache makes them too.
#[test]
fn every_method_with_records_returns_the_layers_of_inspection() {
    let world = own("cornell");
    let layers = |output: Output| output.extra.iter().map(|layer| layer.name.clone()).collect::<Vec<_>>();
    let mut records = cache::Settings { spp: 1, inspect: true, ..Default::default() };
    records.light.indirect = 3000;
    let photons = photon_cache::Settings { spp: 1, inspect: true, photons: 3000, ..Default::default() };
    let found = [layers(rendered(&world, &records)), layers(rendered(&world, &photons))];
    for layers in found {
        for name in ["direct", "indirect", "records", "weights"] {
            assert!(layers.iter().any(|layer| layer == name), "{name} is not among {layers:?}");
        }
    }
}
