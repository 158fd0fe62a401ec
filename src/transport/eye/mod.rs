//! Eye samples: surfaces visible in a pixel, directly or through mirrors and glass.

mod adaptive;
mod by_specular_lobes;
mod caustic_looks;
mod chain;
mod drawn;
mod effort;
mod ends;
mod extra;
mod features;
mod guide;
mod guides;
mod learn;
mod merge;
mod needs;
mod pass;
mod photons_worth;
mod pilot;
mod points;
mod rays;
mod seen;
mod settled;
mod sharp;
#[cfg(test)]
mod tests;

pub use by_specular_lobes::LightBySpecularLobes;
pub use chain::{ChainCounts, DROPPED_BRANCHES};
pub use drawn::{DrawnLight, merged_points};
pub use extra::ExtraSamples;
pub use features::{EvenSurface, Feature, Features, SeenPixels, UnknownFeature};
pub use guides::{FirstSurfaces, FullPaths, Guide, KeptGuide, KeptGuides};
pub use pass::{EyePass, TILE};
pub use pilot::{ByPhotons, EyePilot};
pub use points::{PointGeometry, PointSurface, ShadingPoints, VisibilitySamples};
pub use rays::{EyeRays, EyeSettings, VisibleSurfaces};
pub use seen::FeatureSettings;
pub use settled::Settled;
