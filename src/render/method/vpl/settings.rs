//! Settings: the ways to find each layer of light, and their accuracy.

use super::gathering::GatheringSettings;
use super::preset::Preset;
use crate::method::sampling::method_settings;
use base::setting::{COMPENSATION, INSPECT, PATCHES, SHARE};
use transport::eye::{DirectSampling, ExtraSamples, Settled};
use transport::lightcut::{CutSettings, Samples};
use transport::lights::LightPassSettings;
use transport::radiance_cache::glossy::Glossy;
use transport::radiance_cache::{CLAMP, CacheSettings, DirectBy, FoundBy, MAX_CUT};
use transport::shade::ShadeSettings;
use world::shadow::ShadowSettings;

/// Samples of a cut at a point without records, times the cut's ε and the pixel's relative error of direct light.
///
/// Variance times cost is least if the samples are in inverse proportion to that error.
const CUT_SAMPLES: f32 = 0.45;
/// Minimum number of samples of a cut.
const MIN_CUT_SAMPLES: f32 = 4.0;

/// Source of indirect light, at records and at the points that records do not reach.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IndirectSource {
    /// Cuts of virtual lights.
    VirtualLights,
    /// Final gathering over a photon map.
    PhotonMap,
}

/// Neighbours that share cuts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbours {
    /// Shading points of a patch of surfaces. The eye pass finds all points of the image first.
    Patches,
    /// Eye samples of a block of pixels. Blocks are traced and lit one by one, so all light is by cuts.
    Blocks,
}

method_settings! {
    /// Settings of the method; those of the cache by default.
    spp = 16, of preset {
        /// Name on the command line, and settings there.
        preset: Preset = Preset::Cache;
        /// Numbers of VPLs; their seed is not used.
        light: LightPassSettings = LightPassSettings { indirect: 600_000, ..LightPassSettings::default() } => [group];
        /// Accuracy of the cut of an eye sample; cap and clamp are those of records, too.
        cut: CutSettings = CutSettings { clamp: CLAMP, max_cut: MAX_CUT, ..CutSettings::default() } => [group];
        /// Compensation by short rays for light lost to clamping.
        compensation: bool = true => [is COMPENSATION];
        /// Sources of direct and indirect light, number and accuracy of records.
        cache: CacheSettings = CacheSettings::default() => [group];
        /// Source of indirect light at records.
        source: IndirectSource = IndirectSource::VirtualLights;
        /// Neighbours that share cuts.
        neighbours: Neighbours = Neighbours::Patches;
        /// Approximate number of patches of the eye samples without records. Sixteen samples of each share a cut,
        /// which is reconstructed at the others. The cost of cuts is proportional to it at any resolution.
        patches: u32 = 4096 => [is PATCHES];
        /// Sharing of cuts between neighbours. If off, every record and sample has its own cut, and `patches` has no
        /// effect.
        share: bool = true => [is SHARE];
        /// Occluder cache for the shadow rays of cuts. It is emptied before every group of neighbours.
        shadows: ShadowSettings = ShadowSettings::default() => [group];
        /// Images of the records, beside the image; see `radiance_cache::inspect`.
        inspect: bool = false => [is INSPECT];
        /// Photon map and final gathering.
        gathering: GatheringSettings = GatheringSettings::default() => [group];
    }
}

impl Settings {
    /// Returns the settings of a preset.
    pub fn of(preset: Preset) -> Settings {
        match preset {
            Preset::Cache => Settings::default(),
            Preset::Reconstruction => Settings::reconstruction(),
            Preset::PhotonCache => Settings::photon_cache(),
            Preset::Lightcuts => Settings::lightcuts(),
        }
    }

    /// Returns the settings of the radiance cache.
    pub fn cache() -> Settings {
        Settings::default()
    }

    /// Returns the settings of reconstruction cuts.
    pub fn reconstruction() -> Settings {
        let cache =
            CacheSettings { direct: DirectBy::Cuts, indirect: FoundBy::Cuts, ..CacheSettings::default() };
        let (light, cut) = (LightPassSettings::default(), CutSettings::default());
        Settings { preset: Preset::Reconstruction, spp: 4, light, cut, cache, ..Settings::default() }
    }

    /// Returns the settings of lightcuts per pixel.
    pub fn lightcuts() -> Settings {
        let neighbours = Neighbours::Blocks;
        Settings { preset: Preset::Lightcuts, neighbours, ..Settings::reconstruction() }
    }

    /// Returns the settings of the radiance cache over a photon map. Cells of 32 samples have as many rays of their own
    /// as a record.
    pub fn photon_cache() -> Settings {
        let light = LightPassSettings { indirect: 0, ..LightPassSettings::default() };
        let cut = CutSettings { max_cut: MAX_CUT, ..CutSettings::default() };
        let cache = CacheSettings { direct: DirectBy::Cuts, least_cell: 32, ..CacheSettings::default() };
        let source = IndirectSource::PhotonMap;
        Settings { preset: Preset::PhotonCache, spp: 4, light, cut, cache, source, ..Settings::default() }
    }

    /// True if a photon map has the indirect light.
    pub fn gathers(&self) -> bool {
        self.source == IndirectSource::PhotonMap
    }

    /// Returns the settings of the shading stage.
    pub fn shading(&self) -> ShadeSettings<'_> {
        ShadeSettings { cut: &self.cut, share: self.share, patches: self.patches, shadows: &self.shadows }
    }

    /// Returns the samples of a cut for an image whose pixels have this relative variance; `None` if it has no noise.
    pub fn cut_samples(&self, noise: f32) -> Option<Samples> {
        let whole = CUT_SAMPLES / (self.cut.epsilon * noise.sqrt());
        (noise > 0.0 && self.share).then_some(Samples { whole, least: MIN_CUT_SAMPLES })
    }

    /// Returns the order for direct light, or `None` if the eye pass does not sample it. Chains follow the lobes that
    /// records cannot light. `other_rays` is the number of rays that the image of the whole film takes besides samples,
    /// if known.
    pub fn direct_sampling(
        glossy: Option<&Glossy>,
        cache: &CacheSettings,
        settled: Settled,
        other_rays: Option<f64>,
    ) -> Option<DirectSampling> {
        cache.samples_direct_light().then(|| DirectSampling {
            followed: glossy.map_or(Vec::new(), Glossy::too_sharp),
            extra_samples: ExtraSamples { most: cache.extra_samples, other_rays },
            settled,
            guides: false,
        })
    }
}
