//! Eye samples: surfaces visible in a pixel, directly or through mirrors and glass.

mod adaptive;
mod by_specular_lobes;
mod caustic_lookups;
mod chain;
mod counts;
mod cryptomatte;
mod direct_light;
mod direct_sampling;
mod effort;
mod extra;
mod features;
mod first_hits;
mod guide;
mod guides;
mod merge;
mod more;
mod parts;
mod pass;
#[cfg(test)]
mod path_end_tests;
mod photon_count;
mod pilot;
mod points;
mod rays;
mod seen;
mod settled;
mod sharp;
mod surfaces;
#[cfg(test)]
mod tests;
mod tiles;
mod tracer;
mod with_light;

pub use by_specular_lobes::LightBySpecularLobes;
pub use counts::{DROPPED_BRANCHES, EyeCounts};
pub use cryptomatte::Masks;
pub use direct_light::merged_points;
pub use direct_sampling::{DirectSampling, LightSources};
pub use extra::ExtraSamples;
pub use features::{Averaging, DEPTH, EvenSurface, Feature, Features, NO_DEPTH, SeenPixels, UnknownFeature};
pub use guides::{FullPaths, PackedGuides, SurveyedPixel, survey};
pub use pass::EyePass;
pub use pilot::{ByPhotons, EyePilot};
pub use points::{PointGeometry, ShadingPoints, VisibilitySamples, edge_class};
pub use rays::{EyeRays, EyeSettings, TILE, VisibleSurfaces};
pub use seen::FeatureSettings;
pub use settled::Settled;
pub use surfaces::{PointSurface, PointSurfaces};
