//! Colours of the native format, alike wherever one is expected: a number for a grey, linear `[r, g, b]`, `"#rrggbb"`
//! in sRGB, any of these times a factor, or a picture where a surface carries it.

use super::Builder;
use super::text::{ColourText, Number, TextureText};
use crate::error::{Place, SceneError};
use crate::picture::srgb_to_linear;
use base::math::Rgb;
use glam::DVec3;
use scene::Reflectance;

impl ColourText {
    /// Returns the colour; `what` names it in errors, among them that of a picture.
    pub fn rgb(&self, what: &str, place: &Place) -> Result<Rgb, SceneError> {
        let colour = self.constant(place)?;
        let picture =
            || place.wrong(format!("{what} is a picture"), "give a number, [r, g, b] or \"#rrggbb\"");
        let colour = colour.ok_or_else(picture)?;
        let wrong = || place.wrong(format!("{what} is not finite"), "write finite numbers");
        colour.is_finite().then_some(colour).ok_or_else(wrong)
    }

    /// Returns the colour, or nothing for a picture.
    pub fn constant(&self, place: &Place) -> Result<Option<Rgb>, SceneError> {
        Ok(match self {
            ColourText::Grey(grey) => Some(Rgb::splat(grey.0 as f32)),
            ColourText::Rgb(rgb) => Some(DVec3::from(*rgb).as_vec3()),
            ColourText::Named(name) => match name.strip_prefix('#') {
                Some(digits) => Some(hexadecimal(digits).ok_or_else(|| {
                    place.wrong(format!("cannot read the colour \"{name}\""), "write six digits: \"#rrggbb\"")
                })?),
                None => None,
            },
            ColourText::Scaled { colour, scale } => {
                colour.constant(place)?.map(|colour| colour * scale.0 as f32)
            }
            ColourText::Texture(_) => None,
        })
    }

    /// The picture, if it is one, with the factor on its texels.
    fn picture(&self) -> Option<TextureText> {
        match self {
            ColourText::Named(file) => Some(TextureText { file: file.clone(), ..TextureText::default() }),
            ColourText::Texture(texture) => Some(texture.clone()),
            ColourText::Scaled { colour, scale } => {
                let inner = colour.picture()?;
                Some(TextureText { scale: Some(Number(inner.scale() * scale.0)), ..inner })
            }
            ColourText::Grey(_) | ColourText::Rgb(_) => None,
        }
    }
}

impl Builder<'_> {
    /// Returns the colour of a surface, which may be a picture.
    pub(super) fn colour(&mut self, text: &ColourText, place: &Place) -> Result<Reflectance, SceneError> {
        match (text.constant(place)?, text.picture()) {
            (None, Some(picture)) => Ok(self.texture(&picture, place)),
            (colour, _) => Ok(Reflectance::Constant(colour.unwrap_or_default())),
        }
    }
}

/// Linear colour of six hexadecimal digits in sRGB.
fn hexadecimal(digits: &str) -> Option<Rgb> {
    if digits.len() != 6 || !digits.bytes().all(|b| b.is_ascii_hexdigit()) {
        return None;
    }
    let code = u32::from_str_radix(digits, 16).ok()?;
    let channel = |shift: u32| srgb_to_linear((code >> shift & 255) as f32 / 255.0);
    Some(Rgb::new(channel(16), channel(8), channel(0)))
}
