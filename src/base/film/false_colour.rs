//! Display of data layers: numbers in magma colours, directions as hues, points over the image.

use super::{Image, Layer, Pixels, Preview, metrics, tone};
use crate::math::Rgb;
use std::f32::consts::TAU;

/// Returns the display bytes of a layer, if it has a preview. `factor` is the exposure of the image.
pub fn show(layer: &Layer, picture: &Image, factor: f32) -> Option<Vec<u8>> {
    let preview = layer.preview?;
    Some(match (&layer.pixels, preview) {
        (Pixels::Color(image) | Pixels::Vector(image), Preview::Exposed) => tone::to_srgb8(image, factor),
        (Pixels::Color(image) | Pixels::Vector(image), Preview::Marks) => points(image, picture, factor),
        (Pixels::Color(image) | Pixels::Vector(image), Preview::Hues) => hues(image),
        (Pixels::Color(image) | Pixels::Vector(image), Preview::Magma { weights, offset }) => {
            numbers(image.pixels.iter().map(|p| p.dot(weights) - offset))
        }
        (Pixels::Scalar(image), _) => numbers(image.pixels.iter().copied()),
        (Pixels::Ranks(image), _) => numbers(image.pixels.iter().map(|ranks| ranks[1])),
        (Pixels::Id(image), _) => numbers(image.pixels.iter().map(|&id| id as f32)),
    })
}

/// Draws points over the image at half brightness: red if the first channel is above 0, green if the second is.
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

/// Maps values to magma colours, from 0 to the 99th percentile of the positive values.
fn numbers(values: impl Iterator<Item = f32>) -> Vec<u8> {
    let lut = metrics::magma();
    let values: Vec<f32> = values.collect();
    let mut positive: Vec<f32> = values.iter().copied().filter(|v| *v > 0.0 && v.is_finite()).collect();
    positive.sort_by(f32::total_cmp);
    let largest = positive.get(positive.len() * 99 / 100).copied().unwrap_or(1.0);
    // `as` saturates and turns NaN into 0.
    let colour = |v: &f32| lut[((v / largest * 255.0 + 0.5) as usize).min(lut.len() - 1)];
    values.iter().flat_map(colour).collect()
}

/// Maps directions to hues, in the plane of the two axes of greatest variation. The brightness is the saturated length.
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

    fn image(pixels: &[Rgb]) -> Image {
        Image { width: pixels.len() as u32, height: 1, pixels: pixels.to_vec() }
    }

    fn shown(pixels: &[Rgb], preview: Preview, picture: &Image) -> Vec<u8> {
        show(&Layer::color("any", image(pixels)).shown(preview), picture, 1.0).unwrap()
    }

    #[test]
    fn points_are_drawn_over_the_darkened_picture() {
        let picture = image(&[Rgb::ONE; 3]);
        let marked = shown(&[Rgb::ZERO, Rgb::X, Rgb::Y], Preview::Marks, &picture);
        assert_eq!(marked, [127, 127, 127, 255, 127, 0, 127, 255, 0]);
    }

    #[test]
    fn numbers_rise_through_magma_and_nothing_breaks_on_nan() {
        let magma = metrics::magma();
        let cuts = [Rgb::ZERO, Rgb::new(300.0, 100.0, 7.0), Rgb::splat(f32::NAN)];
        let sum = Preview::Magma { weights: Rgb::new(1.0, 1.0, 0.0), offset: 0.0 };
        assert_eq!(shown(&cuts, sum, &image(&cuts)), [magma[0], magma[255], magma[0]].concat());
        let sizes = Layer::scalar("cut", image(&cuts).map(|p| p.x)).shown(sum);
        assert_eq!(show(&sizes, &image(&cuts), 1.0).unwrap(), [magma[0], magma[255], magma[0]].concat());
        let flat = [Rgb::ZERO; 2];
        assert_eq!(shown(&flat, Preview::Marks, &image(&flat)), [0; 6]);
        assert_eq!(shown(&flat, Preview::Hues, &image(&flat)), [0; 6]);
    }

    #[test]
    fn opposite_gradients_differ_in_hue() {
        let g = [Rgb::X, -Rgb::X, Rgb::Z];
        let shown = shown(&g, Preview::Hues, &image(&g));
        assert_ne!(shown[..3], shown[3..6]);
        assert_ne!(shown[..3], shown[6..]);
    }

    #[test]
    fn layers_are_not_shown_unasked() {
        let picture = image(&[Rgb::ONE]);
        assert_eq!(show(&Layer::color("variance", picture.clone()), &picture, 1.0), None);
    }
}
