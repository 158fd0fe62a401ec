//! Subsampled channels, which the library for OpenEXR files does not read: decompression and interpolation.

use super::error::ExrError;
use ::exr::block::chunk::{Chunk, CompressedBlock};
use ::exr::compression::Compression;
use ::exr::meta::BlockDescription;
use ::exr::meta::attribute::{ChannelList, IntegerBounds};
use ::exr::meta::header::Header;
use ::exr::prelude::{FlatSamples, Text, Vec2};

/// Decompresses the section of a block of lines of a part with subsampled channels.
///
/// The library expects as many bytes as pixels have without subsampling. It gets a header that claims the true number.
pub(super) fn decompress(header: &Header, block: Chunk, section: IntegerBounds) -> Result<Vec<u8>, ExrError> {
    let CompressedBlock::ScanLine(block) = block.compressed_block else {
        return Err(ExrError::content("subsampled channels in tiles are not supported"));
    };
    let bytes = section_bytes(header, section);
    if bytes == 0 {
        return Ok(Vec::new());
    }
    let mut claimed = Header::new(Text::from(""), header.layer_size, header.channels.list.clone());
    claimed.compression = header.compression;
    claimed.blocks = BlockDescription::ScanLines;
    let claim =
        |bytes_per_pixel| ChannelList { bytes_per_pixel, ..ChannelList::new(header.channels.list.clone()) };
    let claimed_section = match header.compression {
        compression if is_of_bytes(compression) => {
            claimed.layer_size = Vec2(bytes, 1);
            claimed.channels = claim(1);
            IntegerBounds { position: Vec2(0, 0), size: claimed.layer_size }
        }
        // The library counts their samples twice.
        Compression::B44 | Compression::B44A => {
            return Err(ExrError::content("subsampled channels under B44 compression are not supported"));
        }
        compression => {
            let pixels = section.size.area();
            if !bytes.is_multiple_of(pixels) {
                return Err(ExrError::content(format!(
                    "subsampled channels of this size under {compression} are not supported"
                )));
            }
            claimed.channels = claim(bytes / pixels);
            section
        }
    };
    Ok(header.compression.decompress_image_section_from_le(
        &claimed,
        block.compressed_pixels_le,
        claimed_section,
        false,
    )?)
}

/// Returns the number of bytes of the samples of a section.
fn section_bytes(header: &Header, section: IntegerBounds) -> usize {
    let (top, Vec2(width, height)) = (section.position.1.max(0) as usize, section.size);
    let of_row = |y: usize| -> usize {
        let sampled = header.channels.list.iter().filter(|channel| y.is_multiple_of(channel.sampling.1));
        sampled.map(|channel| width / channel.sampling.0 * channel.sample_type.bytes_per_sample()).sum()
    };
    (top..top + height).map(of_row).sum()
}

/// Interpolates a subsampled channel to full size, linearly between samples. Integers are repeated.
///
/// Samples lie on the pixels whose coordinates are multiples of `sampling`. Pixels beyond the last sample repeat it.
///
/// Deviations: the reference library interpolates chroma by a filter of 27 samples.
pub(super) fn enlarge(samples: FlatSamples, size: [usize; 2], sampling: [usize; 2]) -> FlatSamples {
    if sampling == [1, 1] {
        return samples;
    }
    let [width, height] = [size[0] * sampling[0], size[1] * sampling[1]];
    let places = |length: usize| 0..length;
    if let FlatSamples::U32(numbers) = &samples {
        let at = |x: usize, y: usize| numbers[y / sampling[1] * size[0] + x / sampling[0]];
        return FlatSamples::U32(places(height).flat_map(|y| places(width).map(move |x| at(x, y))).collect());
    }
    let numbers: Vec<f32> = samples.values_as_f32().collect();
    let between = |at: usize, axis: usize| {
        let (first, rest) = (at / sampling[axis], at % sampling[axis]);
        (first, (first + 1).min(size[axis] - 1), rest as f32 / sampling[axis] as f32)
    };
    let mix = |a: f32, b: f32, t: f32| if t == 0.0 { a } else { a + (b - a) * t };
    let value = |x: usize, y: usize| {
        let ((left, right, s), (top, bottom, t)) = (between(x, 0), between(y, 1));
        let row = |y: usize| mix(numbers[y * size[0] + left], numbers[y * size[0] + right], s);
        mix(row(top), row(bottom), t)
    };
    FlatSamples::F32(places(height).flat_map(|y| places(width).map(move |x| value(x, y))).collect())
}

/// Returns true if a compression stores bytes without regard to their channels.
fn is_of_bytes(compression: Compression) -> bool {
    matches!(
        compression,
        Compression::Uncompressed | Compression::RLE | Compression::ZIP1 | Compression::ZIP16
    )
}
