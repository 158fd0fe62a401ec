//! Figures that the paper reports, and the caption of our table.
//!
//! Paper: Herzog et al. 2009, Table 1. Only its ratios of times with the light pass are listed. Its rows are of other
//! scenes than ours.

/// Explanation of the columns.
pub const LEGEND: &str = "Times are processor seconds over all threads. N_c: records; direct %: share of them that hold \
    direct light; cut: clusters; T_light: light pass and trees; T_f: records and cuts of eye samples; T_cache: splatting and adaptation; total: all stages, including denoising and the eye pass, in which the default \
    finds direct light. FLIP includes the noise of the reference. PSNR and relMSE are without it, relMSE also without the \
    worst pixel of a thousand. Brightness below 1 mostly shows clamping. The default and paths are denoised and estimate \
    the whole pixel; the other rows keep four eye samples per pixel, whose aliasing counts in FLIP, PSNR and relMSE. \
    \"Light\" is measured against the reference of those eye samples alone, so that aliasing does not count; for the \
    default and paths, against the reference of pixels. \"To LC\": against lightcuts per pixel on the same eye samples \
    and virtual lights. \"Speed\": time of lightcuts (LC), photon-cache (PM) or denoised paths over the row's time. \"At \
    equal FLIP\", \"PSNR\" and \"light\": the same ratio for equal FLIP, PSNR or relMSE of light, interpolated between \
    the other's rows. > and < are bounds, if no row of the other is as good or as bad.";

/// A claim of the paper's.
pub struct Claim {
    /// Description of the comparison.
    pub what: &'static str,
    /// Labels of our rows: the faster one and the one that it is compared with.
    pub of: [&'static str; 2],
    /// Minimum and maximum ratio of times over the paper's scenes, if it reports any.
    pub range: Option<[f64; 2]>,
}

/// All claims: the paper's methods first, then our own.
pub const CLAIMS: [Claim; 7] = [
    Claim {
        what: "LCache2, both layers, against photon mapping with radiance caching",
        of: ["cache, anisotropic", "photon-cache"],
        range: Some([6.5, 30.0]),
    },
    Claim {
        what: "LCache2, both layers, against lightcuts per pixel",
        of: ["cache, anisotropic", "lightcuts, unshared"],
        range: Some([3.0, 5.7]),
    },
    Claim {
        what: "reconstruction cuts (not in the paper) against photon-cache",
        of: ["reconstruction", "photon-cache"],
        range: Some([6.5, 30.0]),
    },
    Claim {
        what: "reconstruction cuts (not in the paper) against lightcuts per pixel",
        of: ["reconstruction", "lightcuts, unshared"],
        range: Some([3.0, 5.7]),
    },
    Claim {
        what: "reconstruction cuts against lightcuts that neighbouring pixels share (neither in the paper)",
        of: ["reconstruction", "lightcuts"],
        range: None,
    },
    Claim {
        what: "LWalk2, a frame of a walk with kept records against the image alone (281 frames: 18 s for 82 s)",
        of: ["walk, a frame", "default"],
        range: Some([4.5, 4.6]),
    },
    Claim {
        what: "the default against denoised paths (neither in the paper)",
        of: ["default", "path --denoise"],
        range: None,
    },
];

/// Share of the records that anisotropy saves, minimum and maximum.
pub const SAVED_BY_ANISOTROPY: [f64; 2] = [0.03, 0.06];
