//! The quality scale: settings that qualities and plans move together, as factors on the defaults, from cheap to exact.
//!
//! | table | each level | reason |
//! |---|---|---|
//! | [`CUTS`] | halves ε; the virtual lights follow | the cost of cuts depends on √ε; fine cuts need a fine tree |
//! | [`SAMPLED`] | doubles the samples; ε falls slowly | direct light has most noise; errors of cuts correlate |
//! | [`PATHS`] | quadruples the samples | path tracing has no other setting |
//!
//! Factors between two levels are interpolated geometrically, so that a plan need not jump.

use base::setting::{Spec, Value};

/// Number of levels of the scale.
pub const LEVELS: usize = 9;

/// Factors on the default of a setting.
#[derive(Debug)]
pub struct Move {
    /// Key of the setting.
    pub key: &'static str,
    /// Factors from the cheapest level to the most exact.
    pub factors: [f64; LEVELS],
}

/// Limits on the settings at a level.
#[derive(Clone, Debug)]
pub struct ScaleLimits {
    /// Keys of settings that stay as they are.
    pub pinned: Vec<&'static str>,
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

impl Move {
    /// Multiplies the setting by its factor at `level`, within `limits`.
    pub fn scale(&self, spec: &Spec, value: &mut dyn Value, level: f64, limits: &ScaleLimits) {
        let Some(&base) = value.numbers().first() else { return };
        let factor = factor(level, &self.factors);
        let number = match self.key {
            SPP => (base * factor).round().min(f64::from(limits.max_spp)),
            _ if factor == 1.0 => base,
            // Three significant digits are enough, and shorter numbers are easier to type again.
            _ => format!("{:.2e}", base * factor).parse().unwrap_or(base),
        };
        spec.set_number(value, 0, number);
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

/// Key of the samples per pixel.
pub const SPP: &str = "spp";

const EPSILON: [f64; LEVELS] = [50.0, 32.0, 16.0, 8.0, 4.0, 2.0, 1.0, 0.5, 0.25];

/// Factors of methods that light by cuts.
#[rustfmt::skip]
pub static CUTS: [Move; 6] = [
    Move { key: SPP, factors: [0.25, 0.25, 0.5, 1.0, 1.0, 1.0, 2.0, 2.0, 4.0] },
    Move { key: "epsilon", factors: EPSILON },
    Move { key: "max_cut", factors: [0.01, 0.06, 0.25, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0] },
    Move { key: "vpls", factors: [0.016, 0.033, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] },
    Move { key: "patches", factors: [0.016, 0.0625, 0.125, 0.25, 0.25, 0.25, 0.5, 1.0, 2.0] },
    Move { key: "record_epsilon", factors: EPSILON },
];

/// Factors of the cache if it samples direct light. The defaults are level 4.
#[rustfmt::skip]
pub static SAMPLED: [Move; 6] = [
    Move { key: SPP, factors: [0.0625, 0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0] },
    Move { key: "epsilon", factors: [12.0, 6.0, 3.0, 1.5, 1.0, 0.6, 0.4, 0.28, 0.2] },
    Move { key: "max_cut", factors: [0.06, 0.125, 0.25, 0.5, 1.0, 1.0, 2.0, 4.0, 8.0] },
    Move { key: "vpls", factors: [0.07, 0.12, 0.25, 0.5, 1.0, 1.4, 2.0, 3.0, 6.0] },
    Move { key: "patches", factors: [0.125, 0.25, 0.5, 1.0, 1.0, 1.0, 1.0, 2.0, 2.0] },
    Move { key: "record_epsilon", factors: [16.0, 6.0, 3.0, 1.5, 1.0, 0.6, 0.4, 0.3, 0.2] },
];

/// Factors of path tracing.
pub static PATHS: [Move; 1] =
    [Move { key: SPP, factors: [0.00390625, 0.015625, 0.0625, 0.25, 1.0, 4.0, 16.0, 64.0, 256.0] }];
