//! Settings of `render --verify`.

use super::args::{VerifyAgainst, VerifyArgs};
use render::method::Method;
use render::verify::VerifySettings;
use transport::paths::Estimand;

/// Returns the settings of the verification if the options ask for it, or `always`: planning by the error needs it.
pub fn settings(args: &VerifyArgs, method: &Method, always: bool) -> Option<VerifySettings> {
    let defaults = VerifySettings::default();
    if args.verify.is_none() && !always {
        return None;
    }
    Some(VerifySettings {
        pixels: args.verify.map_or(defaults.pixels, |n| n as usize),
        estimand: match args.verify_against {
            None => method.estimand(),
            Some(VerifyAgainst::Pixels) => Estimand::Pixels,
            Some(VerifyAgainst::EyeSamples) => {
                Estimand::EyeSamples { spp: method.spp(), seed: method.seed() }
            }
        },
        seed: method.seed(),
        max_depth: method.sampling().max_depth,
        max_samples: args.verify_samples.unwrap_or(defaults.max_samples),
    })
}
