//! Mending of texels that are no light: NaN, infinity, numbers beyond all light, and negative light.
//!
//! Filters, skies and tables of light spread one such texel over the whole image, or put an emitter out.

use crate::decode::{Channel, DecodedImage, decode};
use crate::error::{Location, SceneError, Warning};
use base::math::Rgb;
use scene::Texels;
use std::path::Path;

/// Value of infinite texels, unless finite ones are greater: the greatest half-precision number.
pub(crate) const INFINITE: f32 = 65504.0;

/// Value beyond which a texel counts as infinite. Sums and squares of smaller ones are finite.
const MAX_TEXEL: f32 = 1e18;

/// Decodes an image, and mends its texels; returns the image and a warning about them. Negative texels of light are
/// mended, too.
pub(crate) fn decode_mended(
    bytes: &[u8],
    channel: Channel,
    path: &Path,
    place: &Location,
    is_light: bool,
) -> Result<(DecodedImage, Option<Warning>), SceneError> {
    let mut image = decode(bytes, channel, path, place)?;
    let remark = mend(&mut image, is_light);
    Ok((image, remark.map(|what| Warning::new(place.clone(), format!("{}: {what}", path.display()), REMEDY))))
}

/// Replacement of bad texels, and the remedy.
const REMEDY: &str = "infinity becomes 65504 or the brightest texel, NaN and negative light 0; \
    repair the image";

/// Mends the texels of an image; returns how many there were, and where the first was.
fn mend(image: &mut DecodedImage, is_light: bool) -> Option<String> {
    let is_sound = |texel: Rgb| {
        texel.abs().cmple(Rgb::splat(MAX_TEXEL)).all() && !(is_light && texel.min_element() < 0.0)
    };
    if image.texels.all(is_sound) {
        return None;
    }
    let texels: Vec<Rgb> = image.texels.iter().collect();
    let greatest = texels.iter().flat_map(|texel| texel.to_array()).filter(|value| *value <= MAX_TEXEL);
    let infinite = greatest.fold(INFINITE, f32::max);
    let mut mended = texels.clone();
    let bad: Vec<usize> = (0..texels.len()).filter(|i| !is_sound(texels[*i])).collect();
    for &i in &bad {
        let value = |channel: usize| match texels[i][channel] {
            value if value.is_nan() => 0.0,
            value if value > MAX_TEXEL => infinite,
            value if value < -MAX_TEXEL || is_light => value.max(0.0),
            value => value,
        };
        mended[i] = Rgb::from(std::array::from_fn(value));
    }
    image.texels = Texels::new(image.width, &mended);
    Some(counted(bad.len(), bad[0], image.width, "infinite, negative or no numbers"))
}

/// Says how many texels are `what`, and where the first is.
pub(crate) fn counted(count: usize, first: usize, width: usize, what: &str) -> String {
    let (column, row) = (first % width + 1, first / width + 1);
    match count {
        1 => format!("the texel in column {column} of row {row} is {what}"),
        _ => format!("{count} texels are {what}, the first in column {column} of row {row}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mended(rows: [[f32; 3]; 3], is_light: bool) -> (Vec<f32>, Option<String>) {
        let texels: Vec<Rgb> = rows.as_flattened().iter().map(|value| Rgb::splat(*value)).collect();
        let mut image = DecodedImage { width: 3, height: 3, texels: Texels::new(3, &texels) };
        let said = mend(&mut image, is_light);
        (image.texels.iter().map(|texel| texel.x).collect(), said)
    }

    #[test]
    fn bad_texels_become_what_is_nearest_to_them_and_are_named() {
        let inf = f32::INFINITY;
        let (values, said) = mended([[1.0, 2.0, inf], [3.0, f32::NAN, 5.0], [6.0, -7.0, 3e38]], true);
        assert_eq!(values, [1.0, 2.0, 65504.0, 3.0, 0.0, 5.0, 6.0, 0.0, 65504.0]);
        let said = said.unwrap();
        assert!(said.starts_with("4 texels are") && said.ends_with("column 3 of row 1"), "{said}");
        // A sun of 1e6 is no brighter than one of infinity.
        let (values, said) = mended([[1e6, inf, 0.0], [0.0; 3], [0.0; 3]], true);
        assert_eq!((values[1], said.unwrap().contains("column 2 of row 1 is")), (1e6, true));
        // Heights may be negative.
        let (values, said) = mended([[-1.0, 2.0, 0.0]; 3], false);
        assert_eq!((values[0], said), (-1.0, None));
        assert_eq!(mended([[f32::NAN; 3]; 3], true).0, [0.0; 9]);
        assert_eq!(mended([[-inf, 1.0, 1.0]; 3], false).0[0], 0.0);
    }
}
