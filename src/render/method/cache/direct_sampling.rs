//! Order for direct light of the methods that cache indirect light.

use transport::eye::{DirectSampling, ExtraSamples, Settled};
use transport::radiance_cache::CacheSettings;
use transport::radiance_cache::glossy::Glossy;

/// Returns the order for direct light, or `None` if the eye pass does not sample it. Chains follow the lobes that
/// records cannot light. `other_rays` is the number of rays that the image of the whole film takes besides samples, if
/// known.
pub fn direct_sampling(
    glossy: Option<&Glossy>,
    settings: &CacheSettings,
    settled: Settled,
    other_rays: Option<f64>,
) -> Option<DirectSampling> {
    let followed = || glossy.map_or(Vec::new(), Glossy::too_sharp);
    settings.samples_direct_light().then(|| DirectSampling {
        followed: followed(),
        extra_samples: ExtraSamples { most: settings.extra_samples, other_rays },
        settled,
        guides: false,
    })
}
