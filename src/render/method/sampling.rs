//! The settings that all methods have.

use scene::Scene;
use transport::eye::EyeSettings;

/// Samples, seed and path length of a method.
#[derive(Clone, Copy, Debug)]
pub struct Sampling {
    /// Samples per pixel.
    pub spp: u32,
    /// Random seed.
    pub seed: u32,
    /// Maximum path length in edges; `None` for the scene's own limit.
    pub max_depth: Option<u32>,
}

/// Settings that include those of all methods.
pub trait HasSampling {
    /// Returns samples, seed and path length.
    fn sampling(&self) -> Sampling;

    /// Sets samples, seed and path length.
    fn set_sampling(&mut self, sampling: Sampling);

    /// Returns the samples per pixel.
    fn spp(&self) -> u32 {
        self.sampling().spp
    }

    /// Sets the samples per pixel.
    fn set_spp(&mut self, spp: u32) {
        self.set_sampling(Sampling { spp, ..self.sampling() });
    }

    /// Returns the random seed.
    fn seed(&self) -> u32 {
        self.sampling().seed
    }

    /// Sets the random seed.
    fn set_seed(&mut self, seed: u32) {
        self.set_sampling(Sampling { seed, ..self.sampling() });
    }
}

impl Sampling {
    /// Returns these settings for an eye pass of `scene`.
    pub fn eye(&self, scene: &Scene) -> EyeSettings {
        EyeSettings { spp: self.spp.max(1), seed: self.seed, max_depth: scene.path_limit(self.max_depth) }
    }
}

/// Declares the `Settings` of a method: those of all methods, with `spp` samples per pixel by default, and its own.
///
/// See [`base::setting`] for the syntax.
macro_rules! method_settings {
    ($(#[doc = $about:literal])+ spp = $spp:literal $(, of $preset:ident)? { $($own:tt)* }) => {
        ::base::setting::settings! {
            $(#[doc = $about])+
            pub struct Settings in "" $(of $preset)? {
                /// Samples per pixel.
                spp: u32 = $spp => [
                    .at_least(1.0).scaled(&::base::setting::UP)
                    .judged_by(::base::setting::JudgedBy::Flip)
                ];
                /// Random seed.
                seed: u32 = 0 => [];
                /// Maximum path length in edges from the eye. 1 shows visible emitters, 2 adds direct light [default:
                /// from the scene].
                max_depth: Option<u32> = None => [.at_least(1.0)];
                $($own)*
            }
        }

        impl $crate::method::HasSampling for Settings {
            fn sampling(&self) -> $crate::method::Sampling {
                $crate::method::Sampling { spp: self.spp, seed: self.seed, max_depth: self.max_depth }
            }

            fn set_sampling(&mut self, sampling: $crate::method::Sampling) {
                let $crate::method::Sampling { spp, seed, max_depth } = sampling;
                (self.spp, self.seed, self.max_depth) = (spp, seed, max_depth);
            }
        }
    };
}

pub(crate) use method_settings;
