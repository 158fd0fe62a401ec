//! All methods. A new one is a folder and a line here.

use super::{Renderer, cache};
use base::setting::Each;
use serde_json::Value as Json;
use std::ops::{Deref, DerefMut};

macro_rules! methods {
    ($($(#[$about:meta])+ $Variant:ident($folder:ident),)+) => {
        /// Any of the methods, with its settings.
        #[derive(Clone, Copy, Debug)]
        pub enum Method {
            $($(#[$about])+ $Variant(super::$folder::Settings),)+
        }

        impl Method {
            /// All methods, with their defaults.
            pub fn all() -> impl Iterator<Item = Method> {
                [$(Method::$Variant(super::$folder::Settings::default()),)+].into_iter()
            }
        }

        impl Deref for Method {
            type Target = dyn Renderer;

            fn deref(&self) -> &(dyn Renderer + 'static) {
                match self { $(Method::$Variant(settings) => settings,)+ }
            }
        }

        impl DerefMut for Method {
            fn deref_mut(&mut self) -> &mut (dyn Renderer + 'static) {
                match self { $(Method::$Variant(settings) => settings,)+ }
            }
        }
    };
}

methods! {
    /// The radiance cache.
    Cache(cache),
    /// Reconstruction cuts.
    Reconstruction(reconstruction),
    /// The same cache over a photon map.
    PhotonCache(photon_cache),
    /// Lightcuts per pixel.
    Lightcuts(lightcuts),
    /// Path tracing.
    Path(path),
}

/// The radiance cache with its defaults, the first method.
impl Default for Method {
    fn default() -> Method {
        Method::Cache(cache::Settings::default())
    }
}

impl Method {
    /// The method of that name, with its defaults.
    pub fn named(name: &str) -> Option<Method> {
        Method::all().find(|method| method.name() == name)
    }

    /// Visits its settings, to read them.
    pub fn visit(mut self, each: Each) {
        self.each(each);
    }

    /// The text of a setting; `None` if it has none of that key.
    pub fn text(&self, key: &str) -> Option<String> {
        let mut found = None;
        self.visit(&mut |spec, value| {
            if spec.key == key {
                found = Some(value.text());
            }
        });
        found
    }

    /// A setting that is a number; `None` if it has none of that key.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.text(key)?.parse().ok()
    }

    /// Sets a number, one of several where `part` is not 0, to the nearest that it can be.
    pub fn set_number(&mut self, key: &str, part: usize, number: f64) {
        self.each(&mut |spec, value| {
            if spec.key == key {
                spec.set_number(value, part, number);
            }
        });
    }

    /// Samples a pixel.
    pub fn spp(&self) -> u32 {
        self.sampling().spp
    }

    /// The seed.
    pub fn seed(&self) -> u32 {
        self.sampling().seed
    }

    /// The settings by key, for the picture's metadata and the statistics.
    pub fn settings(&self) -> Json {
        let mut report = serde_json::Map::new();
        self.visit(&mut |spec, value| {
            report.insert(spec.key.to_owned(), value.json());
        });
        Json::Object(report)
    }
}
