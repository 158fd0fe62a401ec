//! Figures that the paper reports, for comparison with ours.
//!
//! Paper: Herzog et al. 2009, Table 1. Of the table, only the ratios of times with the light pass were
//! available when this was written; its rows, on scenes other than ours, are missing.

/// A claim of the paper's.
pub struct Claim {
    /// Description of the comparison.
    pub what: &'static str,
    /// Our rows: the faster one and the one that it is compared with.
    pub of: [&'static str; 2],
    /// Minimum and maximum ratio of times over the paper's scenes, where it reports any.
    pub range: Option<[f64; 2]>,
}

/// All claims, the paper's methods first, then our own against the same opponents and denoised paths.
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
        what: "LWalk2, a frame of a walk-through by records kept against the picture alone (281 frames: 18 s for 82 s)",
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
