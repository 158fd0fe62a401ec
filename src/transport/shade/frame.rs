//! Shading of all patches of a frame.

use super::{ShadeSettings, Shader, ShadingContext, ShadingCounts, ShadingTask};
use crate::eye::ShadingPoints;
use base::math::Rgb;
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use rayon::prelude::*;

/// Radiance of the points of a patch.
pub type ShadedPatch = Vec<(ShadingTask, Rgb)>;

/// Radiance of shading points.
#[derive(Default)]
pub struct Shading {
    /// Radiance by patch, in the order of the patches.
    pub patches: Vec<ShadedPatch>,
    /// Work done.
    pub counts: ShadingCounts,
}

/// Shades patches of tasks; skips the remaining ones if `control` is cancelled. Calls `show` with every patch that is
/// done.
pub fn shade<'w>(
    context: &ShadingContext<'w>,
    points: &ShadingPoints<'w>,
    patches: &[Vec<ShadingTask>],
    settings: &ShadeSettings,
    control: &Control,
    show: impl Fn(&ShadedPatch) + Sync,
) -> Shading {
    let shaders = Workspaces::new(|| Shader::new(context, settings));
    let shade = |patch: &Vec<ShadingTask>| {
        let mut radiance = Vec::with_capacity(patch.len());
        if control.is_cancelled() {
            return (radiance, ShadingCounts::default());
        }
        shaders.with(|shader| {
            shader.begin_chunk();
            shader.shade(points, patch, |task, shaded| radiance.push((task, shaded.radiance)));
            show(&radiance);
            control.advance(patch.len() as u64);
            (radiance, shader.take_counts())
        })
    };
    let done: Vec<(ShadedPatch, ShadingCounts)> = patches.par_iter().one_by_one().map(shade).collect();
    let mut all = Shading { patches: Vec::with_capacity(done.len()), ..Shading::default() };
    for (patch, counts) in done {
        all.patches.push(patch);
        all.counts += counts;
    }
    all
}
