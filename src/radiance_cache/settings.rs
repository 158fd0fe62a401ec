//! What decides how many records there are, and how far each reaches.

use crate::hsh::SeriesSettings;
use crate::lightcut::{CutSettings, MIN_SHARED};
use crate::shadow::ShadowSettings;

/// Patches of fewer samples than this would have too few that borrow.
pub const LEAST_PATCH: usize = 64;

/// How the shape of footprints is chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Footprints {
    /// Circles: LCache1 of the paper.
    Isotropic,
    /// Ellipses, short along the gradient that the virtual lights have while their visibility is held: LCache2 of
    /// the paper.
    Anisotropic,
    /// Ellipses by second derivatives, and gradients, that know of the edges of occluders, which probe rays find.
    #[default]
    Occlusion,
}

/// How the light of a layer is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FoundBy {
    /// By records, as in the paper.
    Records,
    /// By cuts that neighbouring eye samples share and lend each other.
    #[default]
    Samples,
}

/// Settings of one layer of the cache.
#[derive(Clone, Copy, Debug)]
pub struct LayerSettings {
    /// Radius of a footprint relative to the distance of what casts light and shadow; the paper's a.
    pub accuracy: f32,
    /// Least and largest radius of a footprint, in spacings of eye samples.
    pub reach: [f32; 2],
}

/// Settings of the cache.
#[derive(Clone, Copy, Debug)]
pub struct CacheSettings {
    /// When the cut of a record is good enough.
    pub cut: CutSettings,
    /// The layer of direct light, and that of indirect light.
    pub layers: [LayerSettings; 2],
    /// How direct light is found.
    pub direct: FoundBy,
    /// How indirect light is found.
    pub indirect: FoundBy,
    /// Which glossy surfaces records light, and how good series are.
    pub series: SeriesSettings,
    /// How the shape of footprints is chosen.
    pub footprints: Footprints,
    /// Rays that find the edges of occluders around a record, in whole rings of sixteen.
    pub probe_rays: u32,
    /// Whether the light of records is extrapolated by their gradients, which shape the footprints in any case.
    pub gradients: bool,
    /// Relative change of luminance across a footprint at which it is halved along the gradient; the paper's μ.
    pub mu: f32,
    /// Root of 1 - cos of the angle between normals at which a footprint ends.
    pub normal_tolerance: f32,
    /// Most passes of adaptation.
    pub passes: u32,
    /// Smallest relative difference of luminance that is visible.
    pub threshold: f32,
    /// About how many patches the eye samples without records form, of which sixteen each share a cut that is lent to
    /// the others. The cost of cuts is in proportion to it, whatever the resolution.
    pub patches: u32,
    /// Whether neighbours share cuts; if not, records and samples all have their own, whatever `patches` says.
    pub share: bool,
    /// Which shadow rays of cuts ask an occluder cache. It is emptied before every group of neighbours.
    pub shadows: ShadowSettings,
    /// Cells of fewer eye samples than this get no record: a record costs as much as the lent cuts of some hundred
    /// samples. Their samples have cuts of their own, which
    /// neighbours share.
    pub least_cell: u32,
}

impl CacheSettings {
    /// Most of so many samples in a patch.
    pub fn patch(&self, samples: usize) -> usize {
        (samples / self.patches.max(1) as usize).max(LEAST_PATCH)
    }

    /// How the light of a layer is found.
    pub fn found(&self, layer: usize) -> FoundBy {
        [self.direct, self.indirect][layer]
    }

    /// Whether so many neighbours share a cut.
    pub fn shares(&self, points: usize) -> bool {
        self.share && points >= MIN_SHARED
    }
}

impl Default for CacheSettings {
    fn default() -> CacheSettings {
        CacheSettings {
            cut: CutSettings { epsilon: 0.01, ..CutSettings::default() },
            layers: [
                LayerSettings { accuracy: 0.3, reach: [1.5, 20.0] },
                LayerSettings { accuracy: 0.2, reach: [1.5, 40.0] },
            ],
            direct: FoundBy::default(),
            indirect: FoundBy::default(),
            series: SeriesSettings::default(),
            footprints: Footprints::default(),
            probe_rays: 128,
            gradients: true,
            mu: 0.5,
            normal_tolerance: 0.4,
            passes: 1,
            threshold: 0.02,
            patches: 4096,
            share: true,
            shadows: ShadowSettings::default(),
            least_cell: 256,
        }
    }
}
