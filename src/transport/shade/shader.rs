//! A thread's part in the shading of a frame.

use super::patches::next_group;
use super::{Gatherers, ShadeSettings, Shaded, ShadingContext, ShadingTask};
use crate::bias_compensation::points::CompensationCounts;
use crate::eye::ShadingPoints;
use crate::lightcut::CutCounts;
use base::progress::Control;
use base::stats::add_fields;
use std::mem::take;
use world::shadow::{Engine, ShadowCounts};

/// Work done.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShadingCounts {
    /// Cuts.
    pub cuts: CutCounts,
    /// Their shadow rays.
    pub shadows: ShadowCounts,
    /// Compensation of clamped light.
    pub compensation: CompensationCounts,
}
add_fields!(ShadingCounts { cuts, shadows, compensation });

/// Workspaces and shadow rays of one thread.
pub struct Shader<'c, 'w> {
    context: &'c ShadingContext<'w>,
    settings: &'c ShadeSettings,
    gatherers: Gatherers<'w>,
    shadows: Engine<'w>,
    /// Points that have no group yet, and the group in the making.
    left: Vec<u32>,
    group: Vec<ShadingTask>,
}

impl<'c, 'w> Shader<'c, 'w> {
    /// A thread's workspaces.
    pub fn new(context: &'c ShadingContext<'w>, settings: &'c ShadeSettings) -> Shader<'c, 'w> {
        let ShadeSettings { share, shadows, .. } = settings;
        let shadows = Engine::with(context.world, shadows.for_samples(*share), shadows.cache);
        let (left, group) = Default::default();
        Shader { context, settings, gatherers: Gatherers::default(), shadows, left, group }
    }

    /// Forgets the occluders seen, at boundaries of the work that do not depend on the number of threads.
    pub fn begin_chunk(&mut self) {
        self.shadows.begin_chunk();
    }

    /// Shades a patch of tasks that differ in nothing but their points, and calls `shaded` with each.
    pub fn shade(
        &mut self,
        points: &ShadingPoints<'w>,
        patch: &[ShadingTask],
        shaded: impl FnMut(ShadingTask, Shaded),
    ) {
        self.gatherers.shade(self.context, &self.shadows, points, patch, self.settings, shaded);
    }

    /// Shades all light of some points, in groups of up to sixteen that share a cut, and calls `shaded` with each; no
    /// more of them once cancelled.
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

    /// Work done since this was last asked.
    pub fn take_counts(&mut self) -> ShadingCounts {
        let (cuts, compensation) = self.gatherers.take_counts();
        ShadingCounts { cuts, shadows: self.shadows.take_counts(), compensation }
    }
}
