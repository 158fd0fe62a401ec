//! Pictures embedded in pages.

use crate::document::escaped;
use ::image::codecs::jpeg::JpegEncoder;
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use base::film::{Image, heatmap, tone};

/// Returns a picture with a caption; if there is a second picture, it shows while the pointer is over the
/// first.
pub fn figure(source: &str, beneath: Option<&str>, caption: &str, class: &str) -> String {
    let swap = beneath.map_or_else(String::new, |_| {
        " onmouseenter=\"this.dataset.own=this.src;this.src=document.getElementById(this.dataset.other).src\" \
         onmouseleave=\"this.src=this.dataset.own\""
            .to_owned()
    });
    let other = beneath.map_or_else(String::new, |id| format!(" data-other=\"{id}\""));
    format!(
        "<figure><img class=\"{class}\" src=\"{source}\"{other}{swap} alt=\"\"><figcaption>{}</figcaption></figure>\n",
        escaped(caption)
    )
}

/// Encodes a tone-mapped picture as a data URL; JPEG, for pages of many pictures.
pub fn shown(image: &Image, exposure: f32) -> String {
    jpeg(&tone::to_srgb8(image, exposure), image.width, image.height)
}

/// Encodes errors from 0 to 1 in magma colours, as a data URL.
pub fn heat(error: &[f32], image: &Image) -> String {
    jpeg(&heatmap::colours(error), image.width, image.height)
}

fn jpeg(bytes: &[u8], width: u32, height: u32) -> String {
    let mut file = Vec::new();
    // Writing to memory fails only for sizes beyond the limits of JPEG; those give an empty image.
    let _ = JpegEncoder::new_with_quality(&mut file, 92).write_image(
        bytes,
        width,
        height,
        ExtendedColorType::Rgb8,
    );
    format!("data:image/jpeg;base64,{}", base64(&file))
}

/// A square part of a picture, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// First column and row.
    pub at: [u32; 2],
    /// Number of columns, and of rows.
    pub side: u32,
}

/// Encodes a part of a picture, tone-mapped, losslessly as a data URL.
pub fn zoom(image: &Image, exposure: f32, part: Part) -> String {
    let rows = (part.at[1]..part.at[1] + part.side).flat_map(|y| {
        let first = (y * image.width + part.at[0]) as usize;
        &image.pixels[first..first + part.side as usize]
    });
    let cut = Image { width: part.side, height: part.side, pixels: rows.copied().collect() };
    let mut file = Vec::new();
    let bytes = tone::to_srgb8(&cut, exposure);
    let _ = PngEncoder::new(&mut file).write_image(&bytes, part.side, part.side, ExtendedColorType::Rgb8);
    format!("data:image/png;base64,{}", base64(&file))
}

/// Returns the `count` square parts with the largest mean error that do not overlap, a sixth of the shorter
/// side wide.
pub fn worst(error: &[f32], width: u32, height: u32, count: usize) -> Vec<Part> {
    let side = (width.min(height) / 6).max(1);
    let mut parts: Vec<(f64, Part)> = Vec::new();
    // Parts start half a part's side apart.
    let step = (side / 2).max(1) as usize;
    for y in (0..=height - side).step_by(step) {
        for x in (0..=width - side).step_by(step) {
            let rows = (y..y + side).flat_map(|row| {
                let first = (row * width + x) as usize;
                &error[first..first + side as usize]
            });
            parts.push((rows.map(|&e| f64::from(e)).sum(), Part { at: [x, y], side }));
        }
    }
    parts.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut chosen: Vec<Part> = Vec::new();
    for (_, part) in parts {
        let apart = |c: &Part| (0..2).any(|axis| c.at[axis].abs_diff(part.at[axis]) >= side);
        if chosen.len() < count && chosen.iter().all(apart) {
            chosen.push(part);
        }
    }
    chosen
}

/// Encodes bytes as base64 (RFC 4648).
fn base64(bytes: &[u8]) -> String {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let word = (0..3).fold(0u32, |word, i| word << 8 | u32::from(chunk.get(i).copied().unwrap_or(0)));
        for i in 0..4 {
            let letter = LETTERS[(word >> (18 - 6 * i) & 63) as usize] as char;
            text.push(if i <= chunk.len() { letter } else { '=' });
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_that_of_the_standard() {
        let pairs = [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")];
        pairs.iter().for_each(|(plain, coded)| assert_eq!(base64(plain.as_bytes()), *coded));
    }

    #[test]
    fn the_worst_parts_lie_where_the_errors_are_and_apart() {
        let mut error = vec![0.0; 36 * 24];
        error[10 * 36 + 30] = 1.0;
        error[20 * 36 + 2] = 0.5;
        let parts = worst(&error, 36, 24, 2);
        let holds = |p: &Part, x: u32, y: u32| {
            (p.at[0]..p.at[0] + 4).contains(&x) && (p.at[1]..p.at[1] + 4).contains(&y)
        };
        assert!(holds(&parts[0], 30, 10) && holds(&parts[1], 2, 20), "{parts:?}");
        assert_eq!(worst(&[0.0; 2], 2, 1, 9).len(), 2);
    }
}
