//! Content of an image file: named layers over one window of the film, and metadata.

use super::{ALPHA, BACKGROUND, Image, ImageError, Layer, NO_BACKGROUND, Pixels, Shown};
use crate::film::Window;

/// The image of one frame, with its layers and metadata.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The part of the film that the layers cover.
    pub window: Window,
    /// Radiance of each pixel, W/(sr m²).
    pub color: Image,
    /// Further images.
    pub layers: Vec<Layer>,
    /// Camera of the image, if there is one.
    pub camera: Option<CameraMatrices>,
    /// Metadata: settings, statistics and scene of the image.
    pub metadata: Metadata,
    /// True if the file is to hold colours, albedos and normals as half floats, and no variances.
    pub half: bool,
}

/// Standard attributes `worldToCamera` and `worldToNDC` of OpenEXR. Matrices are stored by rows and multiply row
/// vectors from the right, as in Imath. World coordinates are the coordinates of the scene file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraMatrices {
    /// Transform to camera coordinates: x to the right, y up, z forward.
    pub world_to_camera: [f32; 16],
    /// Transform to the film, before division by the fourth coordinate. x and y range from 0 to 1, from the top left to
    /// the bottom right corner; z is the inverse depth.
    pub world_to_ndc: [f32; 16],
}

impl Film {
    /// Creates a film of one complete image.
    pub fn new(color: Image) -> Film {
        let window = Window::whole([color.width, color.height]);
        Film { window, color, layers: Vec::new(), camera: None, metadata: Metadata::default(), half: false }
    }

    /// Replaces every non-finite channel of all images by 0; returns their number.
    pub fn remove_nonfinite(&mut self) -> u64 {
        self.color.remove_nonfinite() + self.layers.iter_mut().map(Layer::remove_nonfinite).sum::<u64>()
    }

    /// Returns the image for display. Its background is transparent if it is hidden from the camera.
    pub fn shown(&self) -> Shown<'_> {
        let hidden = self.metadata.text(BACKGROUND) == Some(NO_BACKGROUND);
        let alpha = self.layers.iter().find(|layer| hidden && layer.name == ALPHA);
        let alpha = alpha.and_then(|layer| match &layer.pixels {
            Pixels::Scalar(alpha) => Some(alpha),
            _ => None,
        });
        Shown { color: &self.color, alpha }
    }

    /// Checks that every image has the window's size and that the window lies on the film.
    ///
    /// # Errors
    /// If not.
    pub fn check_sizes(&self) -> Result<(), ImageError> {
        let window = [self.window.width, self.window.height];
        if !self.window.is_valid() {
            let what = "the rendered window lies outside the image".to_owned();
            return Err(ImageError::Size { what, sizes: [window, self.window.film] });
        }
        let layers = self.layers.iter().map(|layer| (layer.name.as_str(), layer.size()));
        for (name, (size, count)) in std::iter::once(("", self.color.size())).chain(layers) {
            if size != window || count as u64 != self.window.pixel_count() {
                let what = format!("layer `{name}` and the image differ in size");
                return Err(ImageError::Size { what, sizes: [size, window] });
            }
        }
        Ok(())
    }
}

/// Facts about an image, in order. Keys are written as `lightsplat.KEY`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata(Vec<(String, Fact)>);

/// A fact about an image.
#[derive(Clone, Debug, PartialEq)]
pub enum Fact {
    /// Text.
    Text(String),
    /// Number.
    Number(f64),
}

impl From<&str> for Fact {
    fn from(text: &str) -> Fact {
        Fact::Text(text.to_owned())
    }
}

impl From<String> for Fact {
    fn from(text: String) -> Fact {
        Fact::Text(text)
    }
}

impl From<f64> for Fact {
    fn from(number: f64) -> Fact {
        Fact::Number(number)
    }
}

impl Metadata {
    /// Sets the value of `key`.
    pub fn set(&mut self, key: &str, value: impl Into<Fact>) {
        let value = value.into();
        match self.0.iter_mut().find(|(present, _)| present == key) {
            Some((_, held)) => *held = value,
            None => self.0.push((key.to_owned(), value)),
        }
    }

    /// Removes the value of `key`.
    pub fn remove(&mut self, key: &str) {
        self.0.retain(|(present, _)| present != key);
    }

    /// Returns the value of `key`.
    pub fn get(&self, key: &str) -> Option<&Fact> {
        self.0.iter().find(|(present, _)| present == key).map(|(_, value)| value)
    }

    /// Returns the value of `key`, if it is text.
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.get(key) {
            Some(Fact::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// Returns the value of `key`, if it is a number.
    pub fn number(&self, key: &str) -> Option<f64> {
        match self.get(key) {
            Some(Fact::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// Returns all facts in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Fact)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::Pixels;
    use crate::math::Rgb;

    #[test]
    fn nonfinite_channels_are_counted_once_each_in_every_layer() {
        let mut film = Film::new(Image::new(2, 1));
        film.color.pixels[0] = Rgb::new(f32::NAN, 1.0, f32::INFINITY);
        let variance = film.color.map(|_| Rgb::new(2.0, f32::NEG_INFINITY, 3.0));
        film.layers.push(Layer::color("variance", variance));
        film.layers.push(Layer::scalar("depth.Z", film.color.map(|p| p.z)));
        film.layers.push(Layer::id("objectId", film.color.map(|_| u32::MAX)));
        assert_eq!(film.remove_nonfinite(), 5);
        assert_eq!(film.color.pixels[0], Rgb::new(0.0, 1.0, 0.0));
        assert_eq!(film.layers[0].triples().unwrap().pixels, [Rgb::new(2.0, 0.0, 3.0); 2]);
        assert_eq!(film.layers[1].pixels, Pixels::Scalar(film.color.map(|_| 0.0)));
        assert_eq!(film.layers[2].pixels, Pixels::Id(film.color.map(|_| u32::MAX)));
        assert_eq!(film.remove_nonfinite(), 0);
    }

    #[test]
    fn unlike_sizes_are_refused() {
        let mut film = Film::new(Image::new(3, 2));
        film.check_sizes().unwrap();
        film.layers.push(Layer::color("variance", Image::new(2, 3)));
        assert!(film.check_sizes().unwrap_err().to_string().contains("variance"));
        film.layers.clear();
        film.window.offset[0] = 1;
        assert!(film.check_sizes().is_err());
    }

    #[test]
    fn setting_a_key_twice_keeps_its_place_and_the_last_value() {
        let mut metadata = Metadata::default();
        metadata.set("method", "path");
        metadata.set("spp", 16.0);
        metadata.set("method", "lightcuts");
        assert_eq!(metadata.iter().map(|f| f.0).collect::<Vec<_>>(), ["method", "spp"]);
        assert_eq!((metadata.text("method"), metadata.number("spp")), (Some("lightcuts"), Some(16.0)));
        assert_eq!(metadata.number("method"), None);
    }
}
