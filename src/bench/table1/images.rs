//! Images embedded in the page: of every method, with its FLIP and enlarged parts.

use crate::document::Document;
use crate::escape::escaped;
use crate::study::{Answer, Shot};
use crate::thumbnail;
use ::image::codecs::png::PngEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use base::film::metrics::flip_map;
use base::film::{Image, heatmap, tone};
use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// Number of parts of the image that are shown pixel by pixel.
const ZOOMS: usize = 3;

/// Adds the images of the main rows, their FLIP, and the parts in which the FLIP of the first row is largest. The
/// reference appears while the pointer is over an image. `number` tells the scenes of the page apart.
pub fn show(document: &mut Document, answer: &Answer, number: usize) {
    let Some(reference) = &answer.reference else { return };
    let (truth, exposure) = (&reference.mean, reference.exposure);
    let main: Vec<(&Shot, Vec<f32>)> = answer
        .shots
        .iter()
        .filter(|shot| shot.candidate.main)
        .map(|shot| (shot, flip_map(&shot.image, truth, exposure)))
        .collect();
    let parts = main.first().map_or_else(Vec::new, |(_, flip)| worst(flip, truth.width, truth.height, ZOOMS));
    let id = |what: &str| format!("s{number}-{what}");
    let named = |figure: String, id: &str| figure.replacen("<img ", &format!("<img id=\"{id}\" "), 1);
    let mut html = "<p>Each image has its FLIP against the reference, and the parts in which the FLIP of the first method is \
                    largest. Hold the pointer over an image to see the reference.</p>\n<div>"
        .to_owned();
    html += &named(figure(&shown(truth, exposure), None, "reference", ""), &id("whole"));
    for (k, part) in parts.iter().enumerate() {
        html += &named(figure(&zoom(truth, exposure, *part), None, "", "zoom"), &id(&k.to_string()));
    }
    html += "</div>\n";
    for (shot, flip) in &main {
        let (label, flip_error) = (&shot.candidate.label, shot.errors.flip);
        let caption = format!("{label}: {:.2} s, FLIP {flip_error:.4}", shot.seconds());
        html += "<div>";
        html += &figure(&shown(&shot.image, exposure), Some(&id("whole")), &caption, "");
        let heat = data_url(&thumbnail::jpeg(&heatmap::colours(flip), &shot.image));
        html += &figure(&heat, None, "FLIP, 0 to 1", "");
        for (k, part) in parts.iter().enumerate() {
            let zoomed = zoom(&shot.image, exposure, *part);
            html += &figure(&zoomed, Some(&id(&k.to_string())), "", "zoom");
        }
        html += "</div>\n";
    }
    document.figure(&html);
}

/// Returns an image with a caption, which shows the image of the id `beneath` while the pointer is over it.
fn figure(source: &str, beneath: Option<&str>, caption: &str, class: &str) -> String {
    let swap = beneath.map_or_else(String::new, |id| {
        format!(
            " data-other=\"{id}\" onmouseenter=\"this.dataset.own=this.src;\
             this.src=document.getElementById(this.dataset.other).src\" onmouseleave=\"this.src=this.dataset.own\""
        )
    });
    let caption = escaped(caption);
    format!(
        "<figure><img class=\"{class}\" src=\"{source}\"{swap} alt=\"\"><figcaption>{caption}</figcaption></figure>\n"
    )
}

/// Encodes a tone-mapped image as a data URL.
fn shown(image: &Image, exposure: f32) -> String {
    data_url(&thumbnail::shown(image, exposure))
}

/// Returns the data URL of a JPEG file.
fn data_url(jpeg: &[u8]) -> String {
    format!("data:image/jpeg;base64,{}", STANDARD.encode(jpeg))
}

/// A square part of an image, in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Part {
    /// First column and row.
    at: [u32; 2],
    /// Number of columns, and of rows.
    side: u32,
}

/// Encodes a part of an image, tone-mapped, losslessly as a data URL.
fn zoom(image: &Image, exposure: f32, part: Part) -> String {
    let Part { at: [x, y], side } = part;
    let rows = (y..y + side).flat_map(|row| {
        let first = (row * image.width + x) as usize;
        &image.pixels[first..first + side as usize]
    });
    let cut = Image { width: side, height: side, pixels: rows.copied().collect() };
    let mut file = Vec::new();
    let bytes = tone::to_srgb8(&cut, exposure);
    let _ = PngEncoder::new(&mut file).write_image(&bytes, side, side, ExtendedColorType::Rgb8);
    format!("data:image/png;base64,{}", STANDARD.encode(file))
}

/// Returns the `count` square parts with the largest mean error that do not overlap, each with a sixth of the shorter
/// side.
fn worst(error: &[f32], width: u32, height: u32, count: usize) -> Vec<Part> {
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

#[cfg(test)]
mod tests {
    use super::*;

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
