//! Layers of data as pictures: numbers in magma colours, directions as hues, points over the picture.

use super::{Image, metrics, tone};
use crate::math::Rgb;
use std::f32::consts::TAU;

/// Display bytes of the layer `name` of a picture exposed by `factor`; see `radiance_cache::inspect` for the
/// names.
pub fn show(name: &str, layer: &Image, picture: &Image, factor: f32) -> Vec<u8> {
    match name.split('.').next().unwrap_or_default() {
        "records" | "seams" => points(layer, picture, factor),
        "gradient" => hues(layer),
        "footprint" => numbers(layer, |p| p.x - 1.0),
        "weights" | "cut" => numbers(layer, |p| p.x + p.y),
        "clamped" => numbers(layer, |p| p.x),
        _ => tone::to_srgb8(layer, factor),
    }
}

/// Red where the first, green where the second channel is above 0, over the picture at half its brightness.
fn points(layer: &Image, picture: &Image, factor: f32) -> Vec<u8> {
    let mut bytes = tone::to_srgb8(picture, factor);
    for (pixel, mark) in bytes.chunks_exact_mut(3).zip(&layer.pixels) {
        pixel.iter_mut().for_each(|b| *b /= 2);
        for c in 0..2 {
            if mark[c] > 0.0 {
                pixel[c] = 255;
                pixel[2] = 0;
            }
        }
    }
    bytes
}

/// Magma colours from 0 to the 99th percentile of the positive values.
fn numbers(layer: &Image, value: impl Fn(&Rgb) -> f32) -> Vec<u8> {
    let lut = metrics::magma();
    let values: Vec<f32> = layer.pixels.iter().map(value).collect();
    let mut positive: Vec<f32> = values.iter().copied().filter(|v| *v > 0.0 && v.is_finite()).collect();
    positive.sort_by(f32::total_cmp);
    let largest = positive.get(positive.len() * 99 / 100).copied().unwrap_or(1.0);
    // `as` saturates and turns NaN into 0.
    let colour = |v: &f32| lut[((v / largest * 255.0 + 0.5) as usize).min(lut.len() - 1)];
    values.iter().flat_map(colour).collect()
}

/// Hues of the directions, in the plane of the two axes along which the layer varies most; brightness is the
/// length, saturating.
fn hues(layer: &Image) -> Vec<u8> {
    let mean = layer.pixels.iter().map(|p| p.length()).sum::<f32>() / layer.pixels.len().max(1) as f32;
    let squares = layer.pixels.iter().fold(Rgb::ZERO, |sum, p| sum + *p * *p);
    let least = squares.min_position();
    let (a, b) = ((least + 1) % 3, (least + 2) % 3);
    let colour = |p: &Rgb| {
        let brightness = 1.0 - (-p.length() / mean.max(f32::MIN_POSITIVE)).exp();
        let angle = p[b].atan2(p[a]);
        [0.0, TAU / 3.0, 2.0 * TAU / 3.0]
            .map(|phase| (255.0 * brightness * (0.5 + 0.5 * (angle - phase).cos())) as u8)
    };
    layer.pixels.iter().flat_map(colour).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(pixels: &[Rgb]) -> Image {
        Image { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec() }
    }

    #[test]
    fn points_are_drawn_over_the_darkened_picture() {
        let picture = layer(&[Rgb::ONE; 3]);
        let marks = layer(&[Rgb::ZERO, Rgb::X, Rgb::Y]);
        let shown = show("records", &marks, &picture, 1.0);
        assert_eq!(shown, [127, 127, 127, 255, 127, 0, 127, 255, 0]);
    }

    #[test]
    fn numbers_rise_through_magma_and_nothing_breaks_on_nan() {
        let magma = metrics::magma();
        let cuts = layer(&[Rgb::ZERO, Rgb::new(300.0, 100.0, 0.0), Rgb::splat(f32::NAN)]);
        assert_eq!(show("cut", &cuts, &cuts, 1.0), [magma[0], magma[255], magma[0]].concat());
        let flat = layer(&[Rgb::ZERO; 2]);
        assert_eq!(show("seams.2", &flat, &flat, 1.0), [0; 6]);
        assert_eq!(show("gradient", &flat, &flat, 1.0), [0; 6]);
    }

    #[test]
    fn opposite_gradients_differ_in_hue() {
        let g = layer(&[Rgb::X, -Rgb::X, Rgb::Z]);
        let shown = show("gradient", &g, &g, 1.0);
        assert_ne!(shown[..3], shown[3..6]);
        assert_ne!(shown[..3], shown[6..]);
    }
}
