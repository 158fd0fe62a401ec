//! Pictures of OpenEXR files: chosen channels as linear colours over the display window.

use super::channels::{ColourModel, picture_channels};
use super::error::ExrError;
use super::primaries::Primaries;
use super::source::ExrSource;
use crate::math::Rgb;
use ::exr::meta::attribute::IntegerBounds;
use ::exr::meta::header::Header;
use ::exr::prelude::Vec2;
use std::io::{Read, Seek};

/// A picture in memory, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct ExrPicture {
    /// Columns and rows.
    pub size: [usize; 2],
    /// `size[0] * size[1]` linear colours.
    pub pixels: Vec<Rgb>,
}

/// Reads the picture of an open file. Alpha is dropped.
///
/// `check` gets the sizes in pixels of the data and of the picture, and the bytes that a pixel has in the file, before
/// memory for pixels is allocated. Colours become Rec. 709 unless they are `raw`.
///
/// The picture is the display window. Pixels outside the window of the data are black, and data outside the display
/// window is left out (*Technical Introduction to OpenEXR*, "Display Window and Data Window").
///
/// # Errors
/// If no channels are clearly the picture, `check` fails, the file is damaged, or the display window has no data.
pub fn read_picture<R: Read + Seek, E: From<ExrError>>(
    source: &mut ExrSource<R>,
    raw: bool,
    check: impl Fn([usize; 2], u64) -> Result<(), E>,
) -> Result<ExrPicture, E> {
    let content = |what: String| E::from(ExrError::Content(what));
    let place = picture_channels(&source.names()).map_err(|none| content(none.to_string()))?;
    let header = &source.headers()[place.part];
    let list = &header.channels.list;
    let bytes: usize = place.channels.iter().map(|&c| list[c].sample_type.bytes_per_sample()).sum();
    let (data, display) = (data_window(header), header.shared_attributes.display_window);
    for Vec2(width, height) in [data.size, display.size] {
        check([width, height], bytes as u64)?;
    }
    let chromaticities = header.shared_attributes.chromaticities;
    let primaries = Primaries::new(chromaticities).ok_or_else(|| {
        content("the attribute chromaticities has primaries that span no colours".to_owned())
    })?;
    if overlap(data, display).is_none() {
        return Err(content("the data window lies outside the display window".to_owned()));
    }
    let channels: &[usize] = match place.model {
        ColourModel::Luma => &place.channels[..1],
        _ => &place.channels,
    };
    let planes = source.read(place.part, channels).map_err(E::from)?;
    let mut values = planes.iter().map(|plane| plane.values_as_f32());
    let colour = |colour: Rgb| if raw { colour } else { primaries.rec_709(colour) };
    let pixels: Vec<Rgb> = match (values.next(), values.next(), values.next()) {
        (Some(a), Some(b), Some(c)) => {
            let triples = a.zip(b).zip(c).map(|((a, b), c)| [a, b, c]);
            match place.model {
                ColourModel::LumaChroma => {
                    triples.map(|triple| colour(from_luma_chroma(triple, primaries.weights))).collect()
                }
                _ => triples.map(|triple| colour(Rgb::from(triple))).collect(),
            }
        }
        (Some(luma), ..) => luma.map(Rgb::splat).collect(),
        _ => Vec::new(),
    };
    Ok(place_over(pixels, data, display))
}

/// Returns the window of the data of a part.
fn data_window(header: &Header) -> IntegerBounds {
    IntegerBounds { position: header.own_attributes.layer_position, size: header.layer_size }
}

/// Returns the first and the last coordinates that two windows share, by axis.
fn overlap(a: IntegerBounds, b: IntegerBounds) -> Option<[[i64; 2]; 2]> {
    let shared = |a: (i32, usize), b: (i32, usize)| {
        let end = |(start, size): (i32, usize)| i64::from(start) + size as i64;
        let (start, end) = (i64::from(a.0.max(b.0)), end(a).min(end(b)));
        (start < end).then_some([start, end])
    };
    let (p, q) = (a.position, b.position);
    Some([shared((p.0, a.size.0), (q.0, b.size.0))?, shared((p.1, a.size.1), (q.1, b.size.1))?])
}

/// Places the pixels of the data in the display window.
fn place_over(pixels: Vec<Rgb>, data: IntegerBounds, display: IntegerBounds) -> ExrPicture {
    let size = [display.size.0, display.size.1];
    let shared = overlap(data, display).filter(|_| data != display);
    let Some([[left, right], [top, bottom]]) = shared else {
        return ExrPicture { size: [data.size.0, data.size.1], pixels };
    };
    let mut placed = vec![Rgb::ZERO; size[0] * size[1]];
    // Coordinates inside a window are not negative.
    let index = |window: IntegerBounds, y: i64| {
        let (x, y) = (left - i64::from(window.position.0), y - i64::from(window.position.1));
        y as usize * window.size.0 + x as usize
    };
    let width = (right - left) as usize;
    for y in top..bottom {
        let (from, to) = (index(data, y), index(display, y));
        placed[to..to + width].copy_from_slice(&pixels[from..from + width]);
    }
    ExrPicture { size, pixels: placed }
}

/// Returns the colour of luminance Y and chroma RY = (R - Y) / Y and BY = (B - Y) / Y.
///
/// `weights` are the luminances of the primaries, whose sum is 1. Source: *Technical Introduction to OpenEXR*,
/// "Luminance/Chroma Images".
pub fn from_luma_chroma([y, ry, by]: [f32; 3], weights: Rgb) -> Rgb {
    if ry == 0.0 && by == 0.0 {
        return Rgb::splat(y);
    }
    let (red, blue) = ((1.0 + ry) * y, (1.0 + by) * y);
    Rgb::new(red, (y - red * weights.x - blue * weights.z) / weights.y, blue)
}
