//! Shading of a frame, and its part by one thread.

use super::patches::next_group;
use super::{Gatherers, ShadeSettings, Shaded, ShadingContext, ShadingTask};
use crate::bias_compensation::points::CompensationCounts;
use crate::eye::ShadingPoints;
use crate::lightcut::CutCounts;
use base::math::Rgb;
use base::parallel::{ShortRuns, Workspaces};
use base::progress::Control;
use base::stats::add_fields;
use rayon::prelude::*;
use std::mem::take;
use world::shadow::{Engine, ShadowCounts};

/// Work of shading.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadingCounts {
    /// Counts of cuts.
    pub cuts: CutCounts,
    /// Counts of shadow rays.
    pub shadows: ShadowCounts,
    /// Counts of compensation.
    pub compensation: CompensationCounts,
}
add_fields!(ShadingCounts { cuts, shadows, compensation });

/// Workspaces and shadow rays of one thread.
pub struct Shader<'c, 'w> {
    context: &'c ShadingContext<'w>,
    settings: &'c ShadeSettings<'c>,
    gatherers: Gatherers<'w>,
    shadows: Engine<'w>,
    /// Points that have no group yet.
    left: Vec<u32>,
    /// Group under construction.
    group: Vec<ShadingTask>,
}

impl<'c, 'w> Shader<'c, 'w> {
    /// Creates the workspaces of a thread.
    pub fn new(context: &'c ShadingContext<'w>, settings: &'c ShadeSettings<'c>) -> Shader<'c, 'w> {
        let ShadeSettings { share, shadows, .. } = settings;
        let shadows = Engine::with(context.world, shadows.for_samples(*share), shadows.cache);
        let (left, group) = Default::default();
        Shader { context, settings, gatherers: Gatherers::default(), shadows, left, group }
    }

    /// Clears the occluder cache. Call it at boundaries of the work that do not depend on the number of threads.
    pub fn begin_chunk(&mut self) {
        self.shadows.begin_chunk();
    }

    /// Shades a patch of tasks that differ only in their points; calls `shaded` with each task.
    pub fn shade(
        &mut self,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        shaded: impl FnMut(ShadingTask, Shaded),
    ) {
        self.gatherers.shade(self.context, &self.shadows, points, patch, self.settings, shaded);
    }

    /// Shades all light of some points, in groups of up to sixteen that share a cut; calls `shaded` with each task.
    /// Skips the remaining points if `control` is cancelled.
    pub fn shade_all(
        &mut self,
        points: &ShadingPoints<'w>,
        control: &Control,
        mut shaded: impl FnMut(ShadingTask, Shaded),
    ) {
        let (mut left, mut group) = (take(&mut self.left), take(&mut self.group));
        left.clear();
        left.extend(0..points.len() as u32);
        let diagonal = self.context.world.diagonal;
        while !control.is_cancelled() && next_group(points, self.settings, diagonal, &mut left, &mut group) {
            self.shade(points, &group, &mut shaded);
        }
        (self.left, self.group) = (left, group);
    }

    /// Returns the work since the last call.
    pub fn take_counts(&mut self) -> ShadingCounts {
        let (cuts, compensation) = self.gatherers.take_counts();
        ShadingCounts { cuts, shadows: self.shadows.take_counts(), compensation }
    }
}

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
