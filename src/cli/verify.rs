//! `render --verify`: the picture's measured error, in the statistics and in the file.

use super::args::{VerifyAgainst, VerifyArgs};
use crate::eye::Look;
use crate::film::Metadata;
use crate::method::Method;
use crate::stats::Stats;
use crate::verify::{Settings, Verified};

/// What to verify, if that was asked for; `always`, as where settings are planned by it, whether or not.
pub fn settings(
    args: &VerifyArgs,
    method: &Method,
    max_depth: Option<u32>,
    always: bool,
) -> Option<Settings> {
    let defaults = Settings::default();
    if args.verify.is_none() && !always {
        return None;
    }
    Some(Settings {
        pixels: args.verify.map_or(defaults.pixels, |n| n as usize),
        look: match args.verify_against {
            None => method.look(),
            Some(VerifyAgainst::Pixels) => Look::Pixels,
            Some(VerifyAgainst::EyeSamples) => Look::EyeSamples { spp: method.spp(), seed: method.seed() },
        },
        seed: method.seed(),
        max_depth,
        most_samples: args.verify_samples.unwrap_or(defaults.most_samples),
    })
}

/// Puts the result where people and programs look for it.
pub fn report(found: &Verified, settings: &Settings, stats: &mut Stats, metadata: &mut Metadata) {
    let errors = [
        ("relative bias", "bias", found.relative_bias),
        ("relative RMS", "rms", found.relative_rms),
        ("relative error, 95 % of pixels", "error_95", found.relative_error_95),
    ];
    for (name, key, estimate) in errors {
        stats.add(&format!("Verify/{name} [%]"), 100.0 * estimate.value);
        stats.add(&format!("Verify/{name}, from"), 100.0 * estimate.low);
        stats.add(&format!("Verify/{name}, to"), 100.0 * estimate.high);
        metadata.set(&format!("verified_{key}"), estimate.value);
        metadata.set(&format!("verified_{key}_low"), estimate.low);
        metadata.set(&format!("verified_{key}_high"), estimate.high);
    }
    stats.add("Verify/noise of the paths [%]", 100.0 * found.noise);
    stats.count("Verify/pixels", found.pixels as u64);
    stats.count("Verify/pixels at the cap", found.pixels_at_cap as u64);
    stats.count("Verify/paths", found.paths);
    stats.count("Verify/95 % hidden by noise (1: yes)", u64::from(!found.error_95_resolved));
    metadata.set("verified_against", against(settings.look));
    metadata.set("verified_error_95_resolved", if found.error_95_resolved { "true" } else { "false" });
    metadata.set("verified_noise", found.noise);
    metadata.set("verified_pixels", found.pixels as f64);
    metadata.set("verified_pixels_at_cap", found.pixels_at_cap as f64);
}

/// The same for programs.
pub fn to_json(found: &Verified, settings: &Settings) -> serde_json::Value {
    let mut facts = serde_json::json!(found);
    facts["against"] = against(settings.look).into();
    facts["most_samples"] = settings.most_samples.into();
    facts
}

fn against(look: Look) -> &'static str {
    match look {
        Look::Pixels => "pixels",
        Look::EyeSamples { .. } => "eye-samples",
    }
}
