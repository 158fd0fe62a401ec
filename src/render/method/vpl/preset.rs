//! Presets: names of settings on the command line, and the options that they have there.

use super::gathering::GatheringSettings;
use base::setting::{self, COMPENSATION, INSPECT, PATCHES};
use transport::radiance_cache::CacheSettings;

/// A preset.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Preset {
    /// The radiance cache.
    Cache,
    /// Reconstruction cuts.
    Reconstruction,
    /// The radiance cache over a photon map.
    PhotonCache,
    /// Lightcuts per pixel.
    Lightcuts,
}

impl Preset {
    /// All presets.
    pub const ALL: [Preset; 4] =
        [Preset::Cache, Preset::Reconstruction, Preset::PhotonCache, Preset::Lightcuts];

    /// Returns the name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Preset::Cache => "cache",
            Preset::Reconstruction => "reconstruction",
            Preset::PhotonCache => "photon-cache",
            Preset::Lightcuts => "lightcuts",
        }
    }

    /// Returns a line for `--help`.
    pub fn about(self) -> &'static str {
        match self {
            Preset::Cache => {
                "Radiance cache: direct light is sampled, indirect light comes from records splatted onto nearby \
                 points"
            }
            Preset::Reconstruction => {
                "Reconstruction cuts: a few eye samples of each patch share a lightcut, which also lights the other \
                 samples"
            }
            Preset::PhotonCache => "Radiance cache with final gathering over a photon map, for comparison",
            Preset::Lightcuts => {
                "Lightcuts per pixel: clusters of virtual point lights, refined to an expected error"
            }
        }
    }

    /// Returns true if the setting of this key has an effect.
    pub fn has(self, key: &str) -> bool {
        let of_records = || lists(&mut CacheSettings::default(), key) || key == INSPECT.key;
        let of_gathering = || lists(&mut GatheringSettings::default(), key);
        match self {
            Preset::Cache => !of_gathering(),
            // There are no indirect virtual lights, and the clamp is for these.
            Preset::PhotonCache => !["vpls", "clamp", COMPENSATION.key, "indirect"].contains(&key),
            Preset::Reconstruction => !of_records() && !of_gathering(),
            Preset::Lightcuts => key != PATCHES.key && Preset::Reconstruction.has(key),
        }
    }
}

/// Returns true if a setting of the group has this key.
fn lists(group: &mut dyn setting::Settings, key: &str) -> bool {
    let mut listed = false;
    group.each(&mut |spec, _| listed |= spec.key == key);
    listed
}
