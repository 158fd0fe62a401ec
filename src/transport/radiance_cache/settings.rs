//! Settings of records: their number, and their reach.

use crate::eye::merged_points;
use crate::hsh::SeriesSettings;
use crate::lightcut::CutSettings;
use crate::lights::DirectIndirect;
use crate::paths::Look;
use base::setting::{DOWN, JudgedBy, PATCHES, SHARE, UP, choices, settings};
use world::shadow::ShadowSettings;

choices! {
    /// Shape of footprints.
    pub enum Footprints {
        /// Circles: LCache1 of the paper.
        Isotropic = "isotropic",
        /// Ellipses, short along the gradient that the virtual lights have while their visibility is held: LCache2 of
        /// the paper.
        Anisotropic = "anisotropic",
        /// Ellipses by second derivatives, gradients corrected at the edges of occluders, which probe rays find.
        Occlusion = "occlusion",
    }
}

choices! {
    /// Source of indirect light.
    pub enum FoundBy {
        /// Records, as in the paper, splatted onto the eye samples.
        Records = "records",
        /// Cuts that neighbouring eye samples share, reconstructed between them.
        Cuts = "cuts",
    }
}

choices! {
    /// Source of direct light.
    pub enum DirectBy {
        /// Points drawn on emitters and directions drawn from materials, at every eye sample; the eye samples of a
        /// pixel are merged for indirect light.
        Drawn = "drawn",
        /// Records.
        Records = "records",
        /// Cuts.
        Cuts = "cuts",
    }
}

/// Most that one virtual light may give of the light at a point, in cuts of records and in those beside them.
///
/// The paper lets a virtual light give 2 %. Those that give nearly as much are the noise of creases, which short rays
/// do not have: 1 % is worth .1 to .3 dB of the denoised picture in the box, the knot, Sibenik and a kitchen. With half
/// a per cent light is lost that glossy surfaces reflect.
pub const CLAMP: Option<f32> = Some(0.01);

/// Most clusters in a cut, of records and of those beside them.
///
/// Sixteen records that share a cut need more than each alone. Where 5,000 are enough for fewer than half of them, as
/// in a room of glossy surfaces, those that the cut serves badly stand out as spots, and the denoised picture loses
/// 1 dB; elsewhere more are hardly ever needed.
pub const MAX_CUT: usize = 10_000;

/// Settings with which both layers have records.
const RECORDS: &[(&str, &str)] = &[("direct", "records"), ("indirect", "records")];

settings! {
    /// Settings of the cache.
    pub struct CacheSettings in "Records" {
        /// Source of direct light.
        direct: DirectBy = DirectBy::Drawn => [.values(&["drawn", "records", "cuts"]).judged_by(JudgedBy::Flip)];
        /// Most samples beside `spp` for the pixels with the greatest contrast around them, three times `spp` each, as
        /// a share of all pixels' `spp`; a fifth where samples take most of the time.
        ///
        /// A fifth is worth .6, .7 and .9 dB of the denoised picture on the knot, Sibenik and the living room, twice
        /// the samples everywhere .6, 1.3 and 1.3 dB.
        extra_samples: f32 = 1.0 => [.fraction().values(&["0", "0.2", "0.5", "1"]).with(&[("direct", "drawn")])];
        /// Source of indirect light.
        indirect: FoundBy = FoundBy::Records => [.values(&["records", "cuts"])];
        /// Largest error bound of a cluster in a record's cut, relative to its luminance.
        ///
        /// The paper has 1 %. Errors of representatives are the same for many records and do not average; half of
        /// that, at a few per cent of the time, is worth .2 to .5 dB of the denoised picture on the box, the knot and
        /// Sibenik.
        cut: CutSettings = CutSettings { epsilon: 0.005, clamp: CLAMP, max_cut: MAX_CUT, ..CutSettings::default() } => [
            at epsilon .named("record_epsilon").fraction().scaled(&DOWN)
        ];
        /// Shape of footprints.
        footprints: Footprints = Footprints::Occlusion => [.values(&["isotropic", "anisotropic", "occlusion"])];
        /// Rays that find the edges of occluders around a record, in whole rings of sixteen.
        probe_rays: u32 = 128 => [.range(1.0, 4096.0).scaled(&UP)];
        /// Radius of footprints relative to the distance of what casts light and shadow, for direct and for indirect
        /// light; the paper's a.
        accuracy: [f32; 2] = [0.3, 0.2] => [
            .positive().placeholder("DIRECT,INDIRECT").scaled(&DOWN).parts(&["direct", "indirect"]).with(RECORDS)
        ];
        /// Least and largest radius of footprints, in spacings of eye samples, of all or of direct and of indirect
        /// light.
        reach: [[f32; 2]; 2] = [[1.5, 20.0], [1.5, 40.0]] => [
            .positive().placeholder("LEAST,LARGEST").scaled(&DOWN).parts(&["", "", "least", "largest"])
        ];
        /// Choice of the glossy surfaces lit by records, and accuracy of series.
        series: SeriesSettings = SeriesSettings::default() => [group];
        /// Extrapolation of records by their gradients, for comparison.
        ///
        /// The gradients shape the footprints in any case.
        gradients: bool = true => [];
        /// Relative change of luminance across an anisotropic footprint that halves it along the gradient; the
        /// paper's μ.
        mu: f32 = 0.5 => [.positive().scaled(&DOWN).with(&[("footprints", "anisotropic")])];
        /// Root of 1 - cos of the angle between normals at which a footprint ends.
        normal_tolerance: f32 = 0.4 => [.positive().scaled(&[2.0, 1.0, 0.5])];
        /// Most passes that shrink footprints at visible seams.
        passes: u32 = 1 => [.values(&["0", "1", "2", "5"])];
        /// Smallest relative difference of luminance that counts as visible.
        threshold: f32 = 0.02 => [.fraction().scaled(&DOWN)];
        /// Smallest kd-tree cell, in eye samples, that gets a record; cuts, or gathering, light smaller ones.
        ///
        /// A record costs as much as the reconstruction cuts of some hundred samples.
        least_cell: u32 = 256 => [.at_least(1.0).scaled(&UP)];
        /// Number of patches, about, of the eye samples without records: sixteen of each share a cut, which is
        /// reconstructed at the others. The cost of cuts is in proportion to it, whatever the resolution.
        patches: u32 = 4096 => [is PATCHES];
        /// Sharing of cuts between neighbours; if off, records and samples all have their own, whatever `patches` says.
        share: bool = true => [is SHARE];
        /// Use of the occluder cache by shadow rays of cuts. It is emptied before every group of neighbours.
        shadows: ShadowSettings = ShadowSettings::default() => [group];
    }
}

/// Number of frames of a walk-through, about, in which a record has to make good what it costs.
const WALK_FRAMES: u32 = 8;

/// Most samples beside the first ones in a frame of a walk-through, as a share of these: they take most of its time.
const WALK_EXTRA_SAMPLES: f32 = 0.2;

/// Factor on the minimum radius of footprints in walk-throughs: eye samples on fine detail lie elsewhere in each frame,
/// and are to find the records of the last.
///
/// In the apartment's first frames it halves the number of new records, for less than .2 dB.
const WALK_REACH: f32 = 2.0;

impl CacheSettings {
    /// The same for a frame of a walk-through, whose records later frames will use.
    pub fn of_walk(&self) -> CacheSettings {
        let mut settings = *self;
        settings.least_cell = (self.least_cell / WALK_FRAMES).max(1);
        settings.extra_samples = self.extra_samples.min(WALK_EXTRA_SAMPLES);
        for [least, largest] in &mut settings.reach {
            *least = (*least * WALK_REACH).min(*largest);
        }
        settings
    }

    /// Largest radius of any footprint, in spacings of eye samples.
    pub fn farthest(&self) -> f32 {
        self.reach.into_iter().map(|[_, largest]| largest).fold(0.0, f32::max)
    }

    /// Layers whose light is found by records.
    pub fn cached(&self) -> DirectIndirect<bool> {
        DirectIndirect {
            direct: self.direct == DirectBy::Records,
            indirect: self.indirect == FoundBy::Records,
        }
    }

    /// True if the eye pass finds the direct light.
    pub fn draws_direct_light(&self) -> bool {
        self.direct == DirectBy::Drawn
    }

    /// Value that a pixel of `spp` eye samples is to have: where direct light is drawn, they are samples of its square.
    pub fn look(&self, spp: u32, seed: u32) -> Look {
        // A single sample looks through the pixel's centre, drawn or not.
        if self.draws_direct_light() && spp > 1 { Look::Pixels } else { Look::EyeSamples { spp, seed } }
    }

    /// Shading points of a pixel of `spp` eye samples, about, at most.
    pub fn points_a_pixel(&self, spp: u32) -> u64 {
        match self.draws_direct_light() {
            true => merged_points((spp as f32 * (1.0 + self.extra_samples)) as u32),
            false => spp.into(),
        }
    }

    /// True if all light is found by cuts.
    pub fn lights_by_cuts(&self) -> bool {
        self.direct == DirectBy::Cuts && self.indirect == FoundBy::Cuts
    }
}
