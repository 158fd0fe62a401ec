//! All methods. A new one is a folder and a line here.

use super::renderer::{Noisy, Pilots, Renderer, Resumes, Walks};
use super::scale::{Demand, Scales};
use super::{Estimand, LightStore, Output, Sampling, cache};
use crate::denoise::effort::Sampled;
use base::film::Window;
use base::progress::Control;
use base::setting::{Each, Parsed};
use serde_json::Value as Json;
use world::World;
use world::view::View;

macro_rules! methods {
    ($($(#[$about:meta])+ $Variant:ident($folder:ident),)+) => {
        /// Any of the methods, with its settings.
        #[derive(Clone, Copy, Debug)]
        pub enum Method {
            $($(#[$about])+ $Variant(super::$folder::Settings),)+
        }

        impl Method {
            /// Returns all methods with their defaults.
            pub fn all() -> impl Iterator<Item = Method> {
                [$(Method::$Variant(super::$folder::Settings::default()),)+].into_iter()
            }

            /// Returns the settings as a renderer.
            pub fn renderer(&self) -> &dyn Renderer {
                match self { $(Method::$Variant(settings) => settings,)+ }
            }

            fn renderer_mut(&mut self) -> &mut dyn Renderer {
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
    /// The radiance cache over a photon map.
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

/// Functions of every method; see [`Renderer`].
impl Method {
    /// Returns the method of that name with its defaults.
    pub fn named(name: &str) -> Option<Method> {
        Method::all().find(|method| method.name() == name)
    }

    /// Returns the name on the command line.
    pub fn name(&self) -> &'static str {
        self.renderer().name()
    }

    /// Returns a line for `--help`.
    pub fn about(&self) -> &'static str {
        self.renderer().about()
    }

    /// Renders the image of `view`. The image is partial if `control` is cancelled.
    pub fn render(&self, world: &World, lights: &LightStore, view: &View, control: &Control) -> Output {
        self.renderer().render(world, lights, view, control)
    }

    /// Rejects settings that contradict each other.
    ///
    /// # Errors
    /// The contradiction and its remedy.
    pub fn check(&self) -> Result<(), String> {
        self.renderer().check()
    }

    /// Returns the quantity that a pixel estimates.
    pub fn estimand(&self) -> Estimand {
        self.renderer().estimand()
    }

    /// Returns the approximate memory of a render of `window`, in bytes, without the scene.
    pub fn expected_bytes(&self, window: &Window) -> u64 {
        self.renderer().expected_bytes(window)
    }
}

/// Abilities of some methods.
impl Method {
    /// Returns the method as one that renders frames of walk-throughs, if it is one.
    pub fn as_walks(&self) -> Option<&dyn Walks> {
        self.renderer().as_walks()
    }

    /// Returns the method as one that resumes interrupted images, if it is one.
    pub fn as_resumes(&self) -> Option<&dyn Resumes> {
        self.renderer().as_resumes()
    }

    /// Returns the method as one whose images have noise, if it is one.
    pub fn as_noisy(&self) -> Option<&dyn Noisy> {
        self.renderer().as_noisy()
    }

    /// Returns the method as one that samples single pixels, if it is one.
    pub fn as_pilots(&self) -> Option<&dyn Pilots> {
        self.renderer().as_pilots()
    }

    /// Returns the method as one on the quality scale, if it is one.
    pub fn as_scales(&self) -> Option<&dyn Scales> {
        self.renderer().as_scales()
    }

    /// Returns the method as one on the quality scale, to move it there.
    pub fn as_scales_mut(&mut self) -> Option<&mut dyn Scales> {
        self.renderer_mut().as_scales_mut()
    }

    /// True if its images are denoised by default.
    pub fn leaves_noise(&self) -> bool {
        self.as_noisy().is_some_and(Noisy::leaves_noise)
    }

    /// True if renders return a denoiser's guides.
    pub fn finds_guides(&self) -> bool {
        self.as_noisy().is_some_and(Noisy::finds_guides)
    }

    /// Returns the light that is sampled.
    pub fn sampled(&self) -> Sampled {
        self.as_noisy().map_or(Sampled::Part, Noisy::sampled)
    }

    /// Makes renders return a denoiser's guides, if the method can.
    pub fn find_guides(&mut self) {
        if let Method::Path(settings) = self {
            settings.find_guides();
        }
    }

    /// True if renders return images of the records.
    pub fn inspects(&self) -> bool {
        match self {
            Method::Cache(settings) => settings.inspect,
            Method::PhotonCache(settings) => settings.inspect,
            _ => false,
        }
    }

    /// Returns the numbers on which its work depends; zeros if the method is not on the quality scale.
    pub fn demand(&self) -> Demand {
        self.as_scales().map_or_else(Demand::default, Scales::demand)
    }
}

/// Settings of every method.
impl Method {
    /// Returns samples, seed and path length.
    pub fn sampling(&self) -> Sampling {
        self.renderer().sampling()
    }

    /// Sets samples, seed and path length.
    pub fn set_sampling(&mut self, sampling: Sampling) {
        self.renderer_mut().set_sampling(sampling);
    }

    /// Returns the samples per pixel.
    pub fn spp(&self) -> u32 {
        self.sampling().spp
    }

    /// Sets the samples per pixel.
    pub fn set_spp(&mut self, spp: u32) {
        self.set_sampling(Sampling { spp, ..self.sampling() });
    }

    /// Returns the random seed.
    pub fn seed(&self) -> u32 {
        self.sampling().seed
    }

    /// Sets the random seed.
    pub fn set_seed(&mut self, seed: u32) {
        self.set_sampling(Sampling { seed, ..self.sampling() });
    }

    /// Visits all settings.
    pub fn each(&mut self, each: Each) {
        self.renderer_mut().each(each);
    }

    /// Visits all settings, to read them.
    pub fn visit(mut self, each: Each) {
        self.each(each);
    }

    /// Sets the setting of this key from text; returns false if there is none.
    ///
    /// # Errors
    /// A description of the values expected. Nothing is set then.
    pub fn set(&mut self, key: &str, text: &str) -> Result<bool, String> {
        self.renderer_mut().set(key, text)
    }

    /// Sets the setting of this key from text; returns its value, or `None` if there is none.
    ///
    /// # Errors
    /// A description of the values expected. Nothing is set then.
    pub fn parse(&mut self, key: &str, text: &str) -> Result<Option<Parsed>, String> {
        self.renderer_mut().parse(key, text)
    }

    /// Sets the setting of this key to a parsed value; returns false if there is none.
    pub fn assign(&mut self, key: &str, value: &Parsed) -> bool {
        self.renderer_mut().assign(key, value)
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
