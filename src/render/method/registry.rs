//! All methods. A new one is a file or a folder, and a variant here with the arms that the compiler asks for.

use super::renderer::Renderer;
use super::scale::ScaleLimits;
use super::{Preset, path, vpl};
use base::setting::Each;
use serde_json::Value as Json;
use std::ops::{Deref, DerefMut};

/// Any of the methods, with its settings: a [`Renderer`].
#[derive(Clone, Copy, Debug)]
pub enum Method {
    /// Light by virtual point lights.
    Vpl(vpl::Settings),
    /// Path tracing.
    Path(path::Settings),
}

/// The radiance cache with its defaults, the first method.
impl Default for Method {
    fn default() -> Method {
        Method::Vpl(vpl::Settings::default())
    }
}

impl Deref for Method {
    type Target = dyn Renderer;

    fn deref(&self) -> &Self::Target {
        match self {
            Method::Vpl(settings) => settings,
            Method::Path(settings) => settings,
        }
    }
}

impl DerefMut for Method {
    fn deref_mut(&mut self) -> &mut Self::Target {
        match self {
            Method::Vpl(settings) => settings,
            Method::Path(settings) => settings,
        }
    }
}

impl Method {
    /// Returns all methods by their names on the command line, with their defaults.
    pub fn all() -> impl Iterator<Item = Method> {
        let presets = Preset::ALL.map(|preset| Method::Vpl(vpl::Settings::of(preset)));
        presets.into_iter().chain([Method::Path(path::Settings::default())])
    }

    /// Returns the method of that name with its defaults.
    pub fn named(name: &str) -> Option<Method> {
        Method::all().find(|method| method.name() == name)
    }

    /// Returns the settings as a renderer.
    pub fn renderer(&self) -> &dyn Renderer {
        &**self
    }

    /// Multiplies the settings by their factors on the quality scale at `level`, within `limits`.
    pub fn scale(&mut self, level: f64, limits: &ScaleLimits) {
        let moves = self.moves();
        self.each(&mut |spec, value| {
            let moved = moves.iter().find(|moved| moved.key == spec.key);
            if let Some(moved) = moved.filter(|moved| !limits.pinned.contains(&moved.key)) {
                moved.scale(spec, value, level, limits);
            }
        });
    }

    /// Returns the command-line options of all settings that the quality scale moves.
    pub fn scaled_options(&self) -> String {
        let mut options = Vec::new();
        self.visit(&mut |spec, value| {
            if let Some(place) = self.moves().iter().position(|moved| moved.key == spec.key) {
                options.push((place, spec.words(&value.text())));
            }
        });
        options.sort_by_key(|(place, _)| *place);
        options.into_iter().map(|(_, option)| option).collect::<Vec<_>>().join(" ")
    }

    /// Visits all settings, to read them.
    pub fn visit(mut self, each: Each) {
        self.each(each);
    }

    /// Returns the settings by key, for metadata and statistics.
    pub fn settings(&self) -> Json {
        let mut report = serde_json::Map::new();
        self.visit(&mut |spec, value| {
            report.insert(spec.key.to_owned(), value.json());
        });
        Json::Object(report)
    }
}
