//! `render --quality`, `--time` and `--error`: from what was typed to what settings are planned for.

use super::args::RenderArgs;
use super::exit::Failure;
use crate::method::Method;
use crate::plan::{Held, Ladder};
use crate::session::Wanted;
use crate::stats::Stopwatch;
use anyhow::anyhow;

/// Most paths a pixel where its error is measured, unless typed.
const MOST_SAMPLES: u32 = 1 << 16;

/// What settings are planned for in a run that started with `run`.
pub fn wanted(args: &RenderArgs, method: &Method, run: Stopwatch) -> Result<Wanted, Failure> {
    let max_samples = args.verify.verify_samples.unwrap_or(MOST_SAMPLES);
    let wanted = match (args.plan.time, args.plan.error) {
        (Some(seconds), _) => Wanted::Time { seconds, run, held: held(args) },
        (None, Some(error)) => Wanted::Error { error, max_samples, held: held(args) },
        (None, None) => return Ok(Wanted::AsSet),
    };
    if matches!(method, Method::PhotonCache(_)) {
        return Err(Failure::usage(anyhow!(
            "--time and --error plan settings of --method cache, lightcuts and path"
        )));
    }
    Ok(wanted)
}

/// The method with its settings: those typed, and for the rest the defaults or what a quality stands for.
pub fn method(args: &RenderArgs) -> Result<Method, Failure> {
    let base = super::method::method(args)?;
    let named = args.plan.quality.zip(Ladder::new(base, held(args)));
    Ok(named.map_or(base, |(quality, ladder)| ladder.at(quality.height())))
}

/// What was typed.
fn held(args: &RenderArgs) -> Held {
    Held {
        spp: args.spp.is_some(),
        epsilon: args.lightcuts.epsilon.is_some(),
        record_epsilon: args.cache.record_epsilon.is_some(),
        max_cut: args.lightcuts.max_cut.is_some(),
        vpls: args.lightcuts.vpls.is_some(),
        patches: args.cache.patches.is_some(),
    }
}
