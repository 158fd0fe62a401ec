//! The settings that all methods have.

use scene::Scene;
use transport::eye::EyeSettings;

/// Samples of a method, and its path length.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Samples a pixel.
    pub spp: u32,
    /// Another seed, other noise.
    pub seed: u32,
    /// Longest path in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
}

/// Settings that hold those of all methods.
pub trait Sampled {
    /// Samples and limit of the method.
    fn sampling(&self) -> Sampling;
}

impl Sampling {
    /// The same for an eye pass.
    pub fn eye(&self, scene: &Scene) -> EyeSettings {
        EyeSettings { spp: self.spp.max(1), seed: self.seed, max_depth: scene.path_limit(self.max_depth) }
    }
}

/// `Settings` of a method of so many samples a pixel by default: those of all methods, and its own; see
/// [`base::setting`].
macro_rules! method_settings {
    ($(#[doc = $about:literal])+ spp = $spp:literal, $heading:literal { $($own:tt)* }) => {
        ::base::setting::settings! {
            $(#[doc = $about])+
            pub struct Settings in $heading {
                /// Samples a pixel.
                spp: u32 = $spp => [
                    .heading("").at_least(1.0).scaled(&::base::setting::UP)
                    .judged_by(::base::setting::JudgedBy::Flip)
                ];
                /// Another seed, other noise.
                seed: u32 = 0 => [.heading("")];
                /// Longest path in edges from the eye (1: emitters in view, 2: direct light), by default the scene's.
                max_depth: Option<u32> = None => [.heading("").at_least(1.0)];
                $($own)*
            }
        }

        impl $crate::method::Sampled for Settings {
            fn sampling(&self) -> $crate::method::Sampling {
                $crate::method::Sampling { spp: self.spp, seed: self.seed, max_depth: self.max_depth }
            }
        }
    };
}

pub(crate) use method_settings;
