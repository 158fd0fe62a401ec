//! The quality scale: settings that qualities and plans move together, as factors on the defaults, from cheap to exact.
//!
//! | table | each level | reason |
//! |---|---|---|
//! | [`CUTS`] | halves ε; the virtual lights follow | the cost of cuts depends on √ε; fine cuts need a fine tree |
//! | [`SAMPLED`] | doubles the samples; ε falls slowly | direct light has most noise; errors of cuts correlate |
//! | [`PATHS`] | quadruples the samples | path tracing has no other setting |
//!
//! Factors between two levels are interpolated geometrically, so that a plan need not jump.

use base::setting::Value;

/// Number of levels of the scale.
pub const LEVELS: usize = 9;

/// A setting that the scale moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaledSetting {
    /// Samples per pixel.
    Spp,
    /// Error bound of clusters in cuts of eye samples.
    Epsilon,
    /// Maximum number of clusters in a cut.
    MaxCut,
    /// Number of indirect virtual lights.
    Vpls,
    /// Number of patches whose eye samples share cuts.
    Patches,
    /// Error bound of clusters in cuts of records.
    RecordEpsilon,
}

/// Factors on the default of a setting.
#[derive(Debug)]
pub struct Move {
    /// The setting.
    pub setting: ScaledSetting,
    /// Factors from the cheapest level to the most exact.
    pub factors: [f64; LEVELS],
}

/// Limits on the settings at a level.
#[derive(Clone, Debug)]
pub struct ScaleLimits {
    /// Settings that stay as they are.
    pub pinned: Vec<ScaledSetting>,
    /// Maximum samples per pixel.
    pub max_spp: u32,
}

/// Numbers on which the work of a method depends, besides the samples per pixel. Numbers that a method lacks are 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Demand {
    /// Number of direct virtual lights.
    pub direct_vpls: u32,
    /// Number of indirect virtual lights.
    pub vpls: u32,
    /// Maximum number of extra samples, as a share of the first ones.
    pub extra_samples: f32,
    /// True if eye samples share cuts by patches.
    pub shares_patches: bool,
}

/// A method on the quality scale.
pub trait Scales {
    /// Returns the factors of all settings that the scale moves.
    fn moves(&self) -> &'static [Move];

    /// Returns a setting that the scale moves; `None` if the method lacks it.
    fn scaled(&mut self, setting: ScaledSetting) -> Option<&mut dyn Value>;

    /// Returns the numbers on which the work depends.
    fn demand(&self) -> Demand;
}

impl dyn Scales + '_ {
    /// Multiplies the settings by their factors at `level`, within `limits`.
    pub fn scale(&mut self, level: f64, limits: &ScaleLimits) {
        for moved in self.moves().iter().filter(|moved| !limits.pinned.contains(&moved.setting)) {
            let Some(value) = self.scaled(moved.setting) else { continue };
            let Some(&base) = value.numbers().first() else { continue };
            let factor = factor(level, &moved.factors);
            let number = match moved.setting {
                ScaledSetting::Spp => (base * factor).round().clamp(1.0, f64::from(limits.max_spp)),
                _ if factor == 1.0 => base,
                // Three significant digits are enough, and shorter numbers are easier to type again.
                _ => format!("{:.2e}", base * factor).parse().unwrap_or(base),
            };
            value.put(0, moved.setting.clamped(number));
        }
    }

    /// Returns the command-line options of all settings that the scale moves.
    pub fn options(&mut self) -> String {
        let moves = self.moves();
        let option = |moved: &Move| {
            let text = self.scaled(moved.setting)?.text();
            Some(format!("--{} {text}", moved.setting.key().replace('_', "-")))
        };
        moves.iter().filter_map(option).collect::<Vec<_>>().join(" ")
    }
}

impl ScaledSetting {
    const ALL: [ScaledSetting; 6] = [
        ScaledSetting::Spp,
        ScaledSetting::Epsilon,
        ScaledSetting::MaxCut,
        ScaledSetting::Vpls,
        ScaledSetting::Patches,
        ScaledSetting::RecordEpsilon,
    ];

    /// Returns the key of the setting.
    pub fn key(self) -> &'static str {
        match self {
            ScaledSetting::Spp => "spp",
            ScaledSetting::Epsilon => "epsilon",
            ScaledSetting::MaxCut => "max_cut",
            ScaledSetting::Vpls => "vpls",
            ScaledSetting::Patches => "patches",
            ScaledSetting::RecordEpsilon => "record_epsilon",
        }
    }

    /// Returns the setting of a key; `None` if the scale does not move it.
    pub fn of_key(key: &str) -> Option<ScaledSetting> {
        ScaledSetting::ALL.into_iter().find(|setting| setting.key() == key)
    }

    /// Returns the nearest number that the setting can have.
    fn clamped(self, number: f64) -> f64 {
        match self {
            ScaledSetting::Epsilon | ScaledSetting::RecordEpsilon => number.clamp(0.0, 1.0),
            ScaledSetting::Vpls => number.max(0.0),
            ScaledSetting::Spp | ScaledSetting::MaxCut | ScaledSetting::Patches => number.max(1.0),
        }
    }
}

/// Returns a factor at `level`, which is clamped to the first and the last level.
fn factor(level: f64, factors: &[f64; LEVELS]) -> f64 {
    let level = level.clamp(0.0, (LEVELS - 1) as f64);
    let below = (level as usize).min(LEVELS - 2);
    let (a, b) = (factors[below], factors[below + 1]);
    let part = level - below as f64;
    // Exact on the levels, where logarithms would round.
    if part == 0.0 { a } else { a * (b / a).powf(part) }
}

const EPSILON: [f64; LEVELS] = [50.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25];

/// Factors of methods that light by cuts.
#[rustfmt::skip]
pub static CUTS: [Move; 6] = [
    Move { setting: ScaledSetting::Spp, factors: [0.25, 0.25, 0.5, 1.0, 1.0, 1.0, 2.0, 2.0, 4.0] },
    Move { setting: ScaledSetting::Epsilon, factors: EPSILON },
    Move { setting: ScaledSetting::MaxCut, factors: [0.01, 0.06, 0.25, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0] },
    Move { setting: ScaledSetting::Vpls, factors: [0.016, 0.033, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] },
    Move { setting: ScaledSetting::Patches, factors: [0.016, 0.0625, 0.125, 0.25, 0.25, 0.25, 0.5, 1.0, 2.0] },
    Move { setting: ScaledSetting::RecordEpsilon, factors: EPSILON },
];

/// Factors of the cache if it samples direct light. The defaults are level 4.
#[rustfmt::skip]
pub static SAMPLED: [Move; 6] = [
    Move { setting: ScaledSetting::Spp, factors: [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] },
    Move { setting: ScaledSetting::Epsilon, factors: [12.0, 6.0, 3.0, 1.5, 1.0, 0.6, 0.4, 0.28, 0.2] },
    Move { setting: ScaledSetting::MaxCut, factors: [0.06, 0.125, 0.25, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0] },
    Move { setting: ScaledSetting::Vpls, factors: [0.07, 0.12, 0.25, 0.5, 1.0, 1.4, 2.0, 3.0, 6.0] },
    Move { setting: ScaledSetting::Patches, factors: [0.125, 0.25, 0.5, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0] },
    Move { setting: ScaledSetting::RecordEpsilon, factors: [16.0, 6.0, 3.0, 1.5, 1.0, 0.6, 0.4, 0.3, 0.2] },
];

/// Factors of path tracing.
pub static PATHS: [Move; 1] = [Move {
    setting: ScaledSetting::Spp,
    factors: [0.00390625, 0.015625, 0.0625, 0.25, 1.0, 4.0, 16.0, 64.0, 256.0],
}];
