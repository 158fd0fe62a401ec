//! Images encoded for pages.

use crate::document::Thumbnail;
use crate::study::Answer;
use ::image::codecs::jpeg::JpegEncoder;
use ::image::{ExtendedColorType, ImageEncoder};
use base::film::{Image, tone};

/// Quality of JPEG files.
const QUALITY: u8 = 92;

/// Encodes bytes of the size of an image as JPEG, since a page has many images.
pub fn jpeg(bytes: &[u8], image: &Image) -> Vec<u8> {
    let mut file = Vec::new();
    let encoder = JpegEncoder::new_with_quality(&mut file, QUALITY);
    // Writing to memory fails only for sizes beyond the limits of JPEG, which give an empty image.
    let _ = encoder.write_image(bytes, image.width, image.height, ExtendedColorType::Rgb8);
    file
}

/// Encodes a tone-mapped image as JPEG.
pub fn shown(image: &Image, exposure: f32) -> Vec<u8> {
    jpeg(&tone::to_srgb8(image, exposure), image)
}

/// Returns the reference and the images of some labels, for a strip. The answer must have kept its images.
pub fn strip(answer: &Answer, labels: &[&str]) -> Vec<Thumbnail> {
    let Some(reference) = &answer.reference else { return Vec::new() };
    let exposure = reference.exposure;
    let named = |name: &str, caption: String, image: &Image| Thumbnail {
        caption,
        name: format!("{}-{name}", answer.scene),
        jpeg: shown(image, exposure),
    };
    let truth = format!("reference: {} paths per pixel", reference.noise.spp);
    let mut images = vec![named("reference", truth, &reference.mean)];
    for shot in labels.iter().filter_map(|label| answer.find(label)) {
        let label = &shot.candidate.label;
        let caption = format!("{label}: {:.1} s, FLIP {:.3}", shot.seconds(), shot.errors.flip);
        images.push(named(label, caption, &shot.image));
    }
    images
}
