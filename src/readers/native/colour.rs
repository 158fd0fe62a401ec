//! Colours of the native format.
//!
//! A colour is a number for a grey, linear `[r, g, b]`, `"#rrggbb"` in sRGB, or one of these times a factor. Surfaces
//! also accept an image, or an attribute of the mesh.

use super::builder::SceneBuilder;
use super::text::{AttributeText, ColourText, Number, TextureText};
use crate::error::{Location, SceneError};
use crate::lighting::hexadecimal;
use base::math::Rgb;
use glam::DVec3;
use scene::Reflectance;

impl ColourText {
    /// Returns the colour; `what` names it in errors.
    ///
    /// # Errors
    /// If the colour is an image or not finite.
    pub fn rgb(&self, what: &str, place: &Location) -> Result<Rgb, SceneError> {
        let colour = self.constant(place)?;
        let image =
            || place.wrong(format!("{what} is not a constant"), "give a number, [r, g, b] or \"#rrggbb\"");
        let colour = colour.ok_or_else(image)?;
        let wrong = || place.wrong(format!("{what} is not finite"), "write finite numbers");
        colour.is_finite().then_some(colour).ok_or_else(wrong)
    }

    /// Returns the colour; `None` for an image.
    pub fn constant(&self, place: &Location) -> Result<Option<Rgb>, SceneError> {
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
            ColourText::Attribute(_) | ColourText::Texture(_) => None,
        })
    }

    /// Returns the image with the factor on its texels; `None` for a constant colour.
    fn image(&self) -> Option<TextureText> {
        match self {
            ColourText::Named(file) => Some(TextureText { file: file.clone(), ..TextureText::default() }),
            ColourText::Texture(texture) => Some(texture.clone()),
            ColourText::Scaled { colour, scale } => {
                let inner = colour.image()?;
                Some(TextureText { scale: Some(Number(inner.scale() * scale.0)), ..inner })
            }
            ColourText::Grey(_) | ColourText::Rgb(_) | ColourText::Attribute(_) => None,
        }
    }

    /// Returns the attribute with the factor on its values; `None` for other colours.
    fn attribute(&self) -> Option<AttributeText> {
        match self {
            ColourText::Attribute(attribute) => Some(attribute.clone()),
            ColourText::Scaled { colour, scale } => {
                let inner = colour.attribute()?;
                Some(AttributeText { scale: Some(Number(inner.scale() * scale.0)), ..inner })
            }
            _ => None,
        }
    }
}

impl SceneBuilder<'_> {
    /// Returns the colour of a surface: constant, an image or an attribute of the mesh.
    pub(super) fn colour(&mut self, text: &ColourText, place: &Location) -> Result<Reflectance, SceneError> {
        if let Some(attribute) = text.attribute() {
            let scale = Rgb::splat(attribute.scale() as f32);
            return Ok(Reflectance::Textured { texture: self.attribute_id(&attribute, false, place), scale });
        }
        match (text.constant(place)?, text.image()) {
            (None, Some(image)) => Ok(self.texture(&image, place)),
            (colour, _) => Ok(Reflectance::Constant(colour.unwrap_or_default())),
        }
    }
}
