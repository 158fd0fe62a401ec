//! Conversion of colours and textures.
//!
//! Mitsuba's v of bitmaps counts downwards, the renderer's upwards. So `to_uv` is conjugated with a flip.

use super::converter::Converter;
use super::tree::Object;
use super::value::PropertyValue;
use super::{cie, value};
use crate::decode::DecodedImage;
use crate::error::{Location, SceneError};
use crate::file::read_text;
use crate::plan::{TexturePlan, TextureSource};
use base::math::Rgb;
use glam::{DMat3, DMat4, DVec2, DVec3};
use scene::{Filter, Reflectance, Texels, TextureId, Wrap};

/// RGB value of an emissive spectrum of 1 at every wavelength, in the `rgb` variants of Mitsuba 3.
const EQUAL_ENERGY: DVec3 = DVec3::new(1.204795, 0.94829, 0.908915);

/// Name of checkerboards.
const CHECKERBOARD: &str = "checkerboard";

impl Converter<'_> {
    /// Returns a constant reflectance colour; `None` if the parameter is absent or a texture.
    pub(super) fn colour(&mut self, object: &Object, name: &str) -> Result<Option<Rgb>, SceneError> {
        self.spectrum(object, name, false)
    }

    /// Returns a constant colour of emitted light; `None` if the parameter is absent.
    pub(super) fn emissive_colour(&mut self, object: &Object, name: &str) -> Result<Option<Rgb>, SceneError> {
        let colour = self.spectrum(object, name, true)?;
        let object = if colour.is_none() { self.document.named(object, name)? } else { None };
        match object.map(|object| Ok((self.texture(&object, 0)?, object))).transpose()? {
            Some((Reflectance::Constant(colour), _)) => Ok(Some(colour)),
            Some((Reflectance::Textured { .. }, object)) => {
                Err(object.place.wrong(format!("\"{name}\" is an image"), "give an <rgb> or a <spectrum>"))
            }
            None => Ok(colour),
        }
    }

    fn spectrum(&mut self, object: &Object, name: &str, emissive: bool) -> Result<Option<Rgb>, SceneError> {
        let Some(property) = object.property(name) else { return Ok(None) };
        // Version 0.6 reads one number as a grey.
        let white = if emissive && !self.document.is_old { EQUAL_ENERGY } else { DVec3::ONE };
        let colour = match &property.value {
            PropertyValue::Rgb(colour) => *colour,
            PropertyValue::Float(v) => DVec3::splat(*v),
            PropertyValue::Integer(v) => DVec3::splat(*v as f64),
            PropertyValue::Spectrum(v) => white * *v,
            PropertyValue::Samples(samples) => self.sampled(samples, emissive, &property.place),
            PropertyValue::SamplesFile(name) => {
                let path = self.beside(name, &property.place);
                let (text, hash) = read_text(&path, &property.place)?;
                if !self.sources.iter().any(|source| source.0 == path) {
                    self.sources.push((path.clone(), hash));
                }
                let samples = value::samples_of_file(&text).map_err(|line| {
                    let remedy = "write one wavelength in nm and one value per line, wavelengths ascending";
                    Location::line(&path, line).wrong("this is not a sampled spectrum", remedy)
                })?;
                self.sampled(&samples, emissive, &property.place)
            }
            _ => {
                let what = format!("\"{name}\" of {} \"{}\" is not a colour", object.tag, object.plugin);
                return Err(property.place.wrong(what, "give an <rgb> or a <texture>"));
            }
        };
        Ok(Some(value::rgb(colour)))
    }

    /// Returns the colour of a sampled spectrum, clamped to Rec. 709 as in Mitsuba.
    fn sampled(&mut self, samples: &[(f64, f64)], emissive: bool, place: &Location) -> DVec3 {
        let rgb = cie::rgb_of_samples(samples, !emissive);
        let limit = if emissive { f64::INFINITY } else { 1.0 };
        let clamped = rgb.clamp(DVec3::ZERO, DVec3::splat(limit));
        if (rgb - clamped).abs().max_element() > 1e-2 * rgb.max_element() {
            let what = format!("the spectrum's colour {rgb:.3} lies outside Rec. 709");
            self.log.note(place, what, "it is clamped");
        }
        clamped
    }

    /// Returns a reflectance, constant or textured.
    pub(super) fn reflectance(
        &mut self,
        object: &Object,
        name: &str,
        default: f32,
    ) -> Result<Reflectance, SceneError> {
        self.reflectance_within(object, name, default, 0)
    }

    /// Returns a reflectance inside `depth` nested textures.
    fn reflectance_within(
        &mut self,
        object: &Object,
        name: &str,
        default: f32,
        depth: u32,
    ) -> Result<Reflectance, SceneError> {
        if let Some(colour) = self.colour(object, name)? {
            return Ok(Reflectance::Constant(colour));
        }
        match self.document.named(object, name)? {
            Some(texture) => self.texture(&texture, depth),
            None => Ok(Reflectance::Constant(Rgb::splat(default))),
        }
    }

    /// Converts a texture object to a reflectance.
    pub(super) fn texture(&mut self, object: &Object, depth: u32) -> Result<Reflectance, SceneError> {
        if object.tag != "texture" {
            let what = format!("expected a texture, found a <{}>", object.tag);
            return Err(object.place.wrong(what, "give a <texture>"));
        }
        if depth > 8 {
            return Err(object.place.wrong("textures refer to each other", "break the cycle"));
        }
        let reflectance = match object.plugin.as_str() {
            "bitmap" => self.bitmap(object)?,
            "checkerboard" => self.checkerboard(object, depth)?,
            "mesh_attribute" => self.mesh_attribute(object)?,
            "uniform" | "srgb" | "rgb" | "spectrum" | "d65" => {
                let value = match self.colour(object, "color")? {
                    Some(colour) => Some(colour),
                    None => self.colour(object, "value")?,
                };
                let scale = if object.plugin == "d65" { object.float("scale")?.unwrap_or(1.0) } else { 1.0 };
                let colour = value.unwrap_or(Rgb::ONE) * scale as f32;
                match self.first(object, "texture")?.filter(|_| object.plugin == "d65") {
                    Some(nested) => self.texture(&nested, depth + 1)?.times(colour),
                    None => Reflectance::Constant(colour),
                }
            }
            "rawconstant" => {
                let value = match object.property("value").map(|property| &property.value) {
                    Some(PropertyValue::Vector(value)) => Some(value::rgb(*value)),
                    _ => self.colour(object, "value")?,
                };
                let none = || object.place.wrong("the texture has no value", "give a <float> or a <vector>");
                Reflectance::Constant(value.ok_or_else(none)?)
            }
            "blackbody" => {
                let samples = cie::blackbody(object.positive("temperature", 5000.0)?);
                let scale = object.float("scale")?.unwrap_or(1.0);
                Reflectance::Constant(value::rgb(self.sampled(&samples, true, &object.place) * scale))
            }
            "scale" => self.scaled(object, depth)?,
            other => {
                let what = format!("the texture \"{other}\" is not supported");
                self.log.warn(&object.place, what, "reflectance 0.5 is used instead")?;
                return Ok(Reflectance::Constant(Rgb::splat(0.5)));
            }
        };
        object.report_unused(self.log)?;
        Ok(reflectance)
    }

    /// Converts an attribute of meshes.
    fn mesh_attribute(&mut self, object: &Object) -> Result<Reflectance, SceneError> {
        let name = object.string("name")?.unwrap_or_default();
        if !name.starts_with("vertex_") && !name.starts_with("face_") {
            let what = format!("the mesh attribute \"{name}\" is neither of vertices nor of faces");
            return Err(object.place.wrong(what, "give a name that starts with vertex_ or face_"));
        }
        let scale = Rgb::splat(object.float("scale")?.unwrap_or(1.0) as f32);
        Ok(Reflectance::Textured { texture: self.contents.add_attribute(&name, None), scale })
    }

    /// Converts a `scale` texture of Mitsuba 0.6: another texture times a constant.
    fn scaled(&mut self, object: &Object, depth: u32) -> Result<Reflectance, SceneError> {
        let factor = match object.float("scale") {
            Ok(Some(v)) => Rgb::splat(v as f32),
            _ => self.colour(object, "scale")?.unwrap_or(Rgb::ONE),
        };
        let Some(nested) = self.first(object, "texture")? else {
            return Err(object.place.wrong("nothing to scale", "nest a <texture>"));
        };
        Ok(match self.texture(&nested, depth + 1)? {
            Reflectance::Constant(colour) => Reflectance::Constant(colour * factor),
            Reflectance::Textured { texture, scale } => {
                Reflectance::Textured { texture, scale: scale * factor }
            }
        })
    }

    fn bitmap(&mut self, object: &Object) -> Result<Reflectance, SceneError> {
        let path = self.file(object, "filename")?;
        let filter = match object.string("filter_type")?.as_deref() {
            None | Some("bilinear" | "trilinear" | "ewa") => Filter::Bilinear,
            Some("nearest") => Filter::Nearest,
            Some(other) => {
                let what = format!("the texture filter \"{other}\" is not supported");
                self.log.note(&object.place, what, "texels are joined bilinearly");
                Filter::Bilinear
            }
        };
        let wrap = match object.string("wrap_mode")?.as_deref() {
            None | Some("repeat") => Wrap::Repeat,
            Some("mirror") => Wrap::Mirror,
            Some("clamp") => Wrap::Clamp,
            Some(other) => {
                let what = format!("the texture wrap mode \"{other}\" is not supported");
                self.log.warn(&object.place, what, "the image is repeated")?;
                Wrap::Repeat
            }
        };
        let mut raw = object.boolean("raw", false)?;
        if let Some(gamma) = object.float("gamma")? {
            // In Mitsuba 0.6, a gamma of 1 means linear, and -1 the encoding that the file states.
            raw |= gamma == 1.0;
            if gamma != 1.0 && gamma > 0.0 {
                self.log.warn(
                    &object.place,
                    format!("a gamma of {gamma} is not supported"),
                    "sRGB is used",
                )?;
            }
        }
        if let Some(channel) = object.string("channel")? {
            self.log.warn(
                &object.place,
                format!("the channel \"{channel}\" is asked for"),
                "all are used",
            )?;
        }
        let to_uv = self.to_uv(object)?;
        let place = object.place.clone();
        let texture = self.contents.add_texture(TexturePlan {
            place,
            image: TextureSource::File { path, raw },
            filter,
            wrap,
            to_uv,
        });
        Ok(Reflectance::Textured { texture, scale: Rgb::ONE })
    }

    /// Converts a checkerboard to two by two texels without interpolation. A square is half a unit wide.
    fn checkerboard(&mut self, object: &Object, depth: u32) -> Result<Reflectance, SceneError> {
        let mut texel =
            |name: &str, default: f32| match self.reflectance_within(object, name, default, depth + 1)? {
                Reflectance::Constant(colour) => Ok(colour),
                Reflectance::Textured { .. } => {
                    Err(object.place.wrong("a checkerboard of textures", "give its colours as <rgb>"))
                }
            };
        let (even, odd) = (texel("color0", 0.4)?, texel("color1", 0.2)?);
        let texels = Texels::new(2, &[even, odd, odd, even]);
        let image = DecodedImage { width: 2, height: 2, texels };
        let texture = self.contents.add_texture(TexturePlan {
            place: object.place.clone(),
            image: TextureSource::Ready(CHECKERBOARD.into(), image),
            filter: Filter::Nearest,
            wrap: Wrap::Repeat,
            to_uv: self.to_uv(object)?,
        });
        Ok(Reflectance::Textured { texture, scale: Rgb::ONE })
    }

    /// Returns a texture as it looks to a number. Mitsuba 3 exchanges the squares of checkerboards there.
    pub(super) fn of_numbers(&mut self, id: TextureId) -> TextureId {
        match self.contents.textures.get(id.0 as usize) {
            Some(TexturePlan { image: TextureSource::Ready(name, image), .. })
                if name == CHECKERBOARD && !self.document.is_old =>
            {
                let (even, odd) = (image.texels.get(0, 0), image.texels.get(1, 0));
                let image = DecodedImage { texels: Texels::new(2, &[odd, even, even, odd]), ..*image };
                let image = TextureSource::Ready(format!("{CHECKERBOARD} of numbers"), image);
                let plan = TexturePlan { image, ..self.contents.textures[id.0 as usize].clone() };
                self.contents.add_texture(plan)
            }
            _ => id,
        }
    }

    fn to_uv(&self, object: &Object) -> Result<glam::Mat3, SceneError> {
        let mut to_uv = DMat3::IDENTITY;
        if let Some(m) = object.transform("to_uv")? {
            to_uv = planar(&m);
        }
        let get = |name: &str, default: f64| Ok(object.float(name)?.unwrap_or(default));
        let offset = DVec2::new(get("uoffset", 0.0)?, get("voffset", 0.0)?);
        let scale = DVec2::new(get("uscale", 1.0)?, get("vscale", 1.0)?);
        // Mitsuba 0.6 alone has these four parameters. It scales first.
        let to_uv = to_uv * DMat3::from_translation(offset) * DMat3::from_scale(scale);
        let flip = DMat3::from_cols(DVec3::X, DVec3::NEG_Y, DVec3::new(0.0, 1.0, 1.0));
        Ok((flip * to_uv * flip).as_mat3())
    }
}

/// Returns the part of a transform that acts in the xy plane.
fn planar(m: &DMat4) -> DMat3 {
    let column = |c: glam::DVec4, w: f64| DVec3::new(c.x, c.y, w);
    DMat3::from_cols(column(m.x_axis, 0.0), column(m.y_axis, 0.0), column(m.w_axis, 1.0))
}
