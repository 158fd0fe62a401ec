//! Settings of records.

use crate::eye::merged_points;
use crate::hsh::SeriesSettings;
use crate::lights::DirectIndirect;
use crate::paths::Estimand;
use base::setting::{DOWN, JudgedBy, PAPER, UP, choices, settings};

choices! {
    /// Shape of footprints.
    pub enum Footprints {
        /// Circles (LCache1 of the paper).
        Isotropic = "isotropic",
        /// Ellipses, short along the gradient at constant visibility (LCache2 of the paper).
        Anisotropic = "anisotropic",
        /// Ellipses from second derivatives. Probe rays find the edges of occluders, which correct the gradients.
        Occlusion = "occlusion",
    }
}

choices! {
    /// Source of indirect light.
    pub enum FoundBy {
        /// Records splatted onto nearby eye samples, as in the paper.
        Records = "records",
        /// Lightcuts of some eye samples, reconstructed at their neighbours.
        Cuts = "cuts",
    }
}

choices! {
    /// Source of direct light.
    pub enum DirectBy {
        /// Monte Carlo samples of emitters and BSDFs at every eye sample. The eye samples of a pixel are merged for
        /// indirect light.
        Sampled = "drawn",
        /// Records of direct light.
        Records = "records",
        /// Lightcuts.
        Cuts = "cuts",
    }
}

/// Maximum share of a point's light that one virtual light may give, in cuts of records and of eye samples.
pub const CLAMP: Option<f32> = Some(0.01);

/// Maximum number of clusters in a cut, of records and of eye samples.
pub const MAX_CUT: usize = 10_000;

/// Settings that give both layers records.
const RECORDS: &[(&str, &str)] = &[("direct", "records"), ("indirect", "records")];

settings! {
    /// Settings of the cache.
    pub struct CacheSettings in "Records" {
        /// Source of direct light.
        direct: DirectBy = DirectBy::Sampled => [.values(&["drawn", "records", "cuts"]).judged_by(JudgedBy::Flip)];
        /// Budget of extra samples for high-contrast pixels, as a fraction of all samples (1 = as many again). A chosen
        /// pixel gets up to 3 x `spp` more. The budget is at most 0.2 if samples dominate the time. With 1, noisy
        /// images whose samples cost little get all samples twice.
        extra_samples: f32 = 1.0 => [.fraction().values(&["0", "0.2", "0.5", "1"]).with(&[("direct", "drawn")])];
        /// Source of indirect light.
        indirect: FoundBy = FoundBy::Records => [.values(&["records", "cuts"])];
        /// Maximum error bound of a cluster in the cut of a record, relative to the luminance of the record.
        epsilon: f32 = 0.005 => [.named("record_epsilon").fraction().scaled(&DOWN)];
        /// Shape of the footprints of records.
        footprints: Footprints = Footprints::Occlusion => [
            .heading(PAPER).values(&["isotropic", "anisotropic", "occlusion"])
        ];
        /// Number of probe rays per record, in whole rings of sixteen. Probe rays find the edges of occluders.
        probe_rays: u32 = 128 => [.heading(PAPER).range(1.0, 4096.0).scaled(&UP)];
        /// Radius of footprints for direct and indirect light (the paper's a). The radius is relative to the distance
        /// of the geometry that sends or blocks light.
        accuracy: [f32; 2] = [0.3, 0.2] => [
            .positive().placeholder("DIRECT,INDIRECT").scaled(&DOWN).parts(&["direct", "indirect"]).with(RECORDS)
        ];
        /// Minimum and maximum radius of footprints, in spacings of eye samples. Two numbers set both kinds of light,
        /// four set direct, then indirect light.
        reach: [[f32; 2]; 2] = [[1.5, 20.0], [1.5, 40.0]] => [
            .positive().placeholder("LEAST,LARGEST").scaled(&DOWN).parts(&["", "", "least", "largest"])
        ];
        /// Choice of the glossy surfaces lit by records, and accuracy of their series.
        series: SeriesSettings = SeriesSettings::default() => [group];
        /// Extrapolate records with their gradients. Gradients shape the footprints in either case.
        gradients: bool = true => [.heading(PAPER)];
        /// Relative change of luminance across an anisotropic footprint that halves it along the gradient (the paper's
        /// μ).
        mu: f32 = 0.5 => [.heading(PAPER).positive().scaled(&DOWN).with(&[("footprints", "anisotropic")])];
        /// Maximum number of passes that shrink footprints at visible seams.
        passes: u32 = 1 => [.heading(PAPER).values(&["0", "1", "2", "5"])];
        /// Minimum number of eye samples in a cell of the kd-tree that gets a record. Smaller cells use cuts or final
        /// gathering.
        least_cell: u32 = 256 => [.at_least(1.0).scaled(&UP)];
    }
}

/// Approximate number of frames of a walk-through over which the cost of a record is amortised.
pub(super) const WALK_FRAMES: u32 = 8;

/// Maximum share of extra samples in a frame of a walk-through, whose time is mostly that of samples.
const WALK_EXTRA_SAMPLES: f32 = 0.2;

/// Factor on the minimum radius of footprints in walk-throughs. Eye samples on fine detail move from frame to frame,
/// and should find the records of the last frame.
const WALK_REACH: f32 = 2.0;

impl CacheSettings {
    /// Returns the settings for a frame of a walk-through, whose records later frames will use.
    pub fn for_walk(&self) -> CacheSettings {
        let mut settings = *self;
        settings.least_cell = (self.least_cell / WALK_FRAMES).max(1);
        settings.extra_samples = self.extra_samples.min(WALK_EXTRA_SAMPLES);
        for [least, largest] in &mut settings.reach {
            *least = (*least * WALK_REACH).min(*largest);
        }
        settings
    }

    /// Returns the maximum radius of any footprint, in spacings of eye samples.
    pub fn farthest(&self) -> f32 {
        self.reach.into_iter().map(|[_, largest]| largest).fold(0.0, f32::max)
    }

    /// Returns true for the layers lit by records.
    pub fn cached(&self) -> DirectIndirect<bool> {
        DirectIndirect {
            direct: self.direct == DirectBy::Records,
            indirect: self.indirect == FoundBy::Records,
        }
    }

    /// Returns true if the eye pass samples direct light.
    pub fn samples_direct_light(&self) -> bool {
        self.direct == DirectBy::Sampled
    }

    /// Returns the estimand of a pixel with `spp` eye samples. If direct light is sampled, they are samples of its
    /// square.
    pub fn estimand(&self, spp: u32, seed: u32) -> Estimand {
        // A single sample always passes through the pixel's centre.
        if self.samples_direct_light() && spp > 1 {
            Estimand::Pixels
        } else {
            Estimand::EyeSamples { spp, seed }
        }
    }

    /// Returns the expected maximum number of shading points per pixel with `spp` eye samples.
    pub fn points_per_pixel(&self, spp: u32) -> u64 {
        match self.samples_direct_light() {
            true => merged_points((spp as f32 * (1.0 + self.extra_samples)) as u32),
            false => spp.into(),
        }
    }

    /// Returns true if cuts light both layers.
    pub fn lights_by_cuts(&self) -> bool {
        self.direct == DirectBy::Cuts && self.indirect == FoundBy::Cuts
    }
}
