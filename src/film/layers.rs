//! What a picture file holds: named layers over one window of the film, and what is known about them.

use super::{Image, ImageError};
use crate::film::Window;

/// The picture of one frame with everything that is written beside the colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Film {
    /// The part of the film that the layers cover.
    pub window: Window,
    /// Radiance by pixel.
    pub color: Image,
    /// Further images; layer `name` becomes the channels `name.R`, `name.G`, `name.B`.
    pub layers: Vec<(String, Image)>,
    /// How the picture came about.
    pub metadata: Metadata,
}

impl Film {
    /// A film of one complete image.
    pub fn new(color: Image) -> Film {
        let window = Window::whole([color.width, color.height]);
        Film { window, color, layers: Vec::new(), metadata: Metadata::default() }
    }

    /// All images with their layer names; the colour's is empty.
    pub fn images(&self) -> impl Iterator<Item = (&str, &Image)> {
        let layers = self.layers.iter().map(|(name, image)| (name.as_str(), image));
        std::iter::once(("", &self.color)).chain(layers)
    }

    /// Replaces every channel that is not finite by 0 in all images and says how many there were.
    pub fn remove_nonfinite(&mut self) -> u64 {
        let layers = self.layers.iter_mut().map(|(_, image)| image);
        std::iter::once(&mut self.color).chain(layers).map(Image::remove_nonfinite).sum()
    }

    /// Fails unless every image has the window's size and the window lies on the film.
    pub fn check_sizes(&self) -> Result<(), ImageError> {
        let window = [self.window.width, self.window.height];
        if !self.window.is_valid() {
            let what = "the rendered window does not lie on the film".to_owned();
            return Err(ImageError::Size { what, sizes: [window, self.window.film] });
        }
        for (name, image) in self.images() {
            if [image.width, image.height] != window || image.pixels.len() as u64 != self.window.pixel_count()
            {
                let what = format!("layer `{name}` and the film's window differ in size");
                return Err(ImageError::Size { what, sizes: [[image.width, image.height], window] });
            }
        }
        Ok(())
    }
}

/// Ordered facts about a picture; keys are written as `lightsplat.KEY`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metadata(Vec<(String, Value)>);

/// One fact.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// Words.
    Text(String),
    /// A quantity.
    Number(f64),
}

impl From<&str> for Value {
    fn from(text: &str) -> Value {
        Value::Text(text.to_owned())
    }
}

impl From<String> for Value {
    fn from(text: String) -> Value {
        Value::Text(text)
    }
}

impl From<f64> for Value {
    fn from(number: f64) -> Value {
        Value::Number(number)
    }
}

impl Metadata {
    /// Sets `key`, replacing what it held.
    pub fn set(&mut self, key: &str, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(present, _)| present == key) {
            Some((_, held)) => *held = value,
            None => self.0.push((key.to_owned(), value)),
        }
    }

    /// What `key` holds.
    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|(present, _)| present == key).map(|(_, value)| value)
    }

    /// What `key` holds, if that is words.
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.get(key) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    /// What `key` holds, if that is a number.
    pub fn number(&self, key: &str) -> Option<f64> {
        match self.get(key) {
            Some(Value::Number(number)) => Some(*number),
            _ => None,
        }
    }

    /// All facts in order.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.0.iter().map(|(key, value)| (key.as_str(), value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Rgb;

    #[test]
    fn nonfinite_channels_are_counted_once_each_in_every_layer() {
        let mut film = Film::new(Image::new(2, 1));
        film.color.pixels[0] = Rgb::new(f32::NAN, 1.0, f32::INFINITY);
        film.layers.push(("variance".to_owned(), Image::new(2, 1)));
        film.layers[0].1.pixels[1] = Rgb::new(2.0, f32::NEG_INFINITY, 3.0);
        assert_eq!(film.remove_nonfinite(), 3);
        assert_eq!(film.color.pixels[0], Rgb::new(0.0, 1.0, 0.0));
        assert_eq!(film.layers[0].1.pixels[1], Rgb::new(2.0, 0.0, 3.0));
        assert_eq!(film.remove_nonfinite(), 0);
    }

    #[test]
    fn unlike_sizes_are_refused() {
        let mut film = Film::new(Image::new(3, 2));
        film.check_sizes().unwrap();
        film.layers.push(("variance".to_owned(), Image::new(2, 3)));
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
