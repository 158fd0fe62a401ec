//! The picture: eye pass, light pass, trees, then patches of shading points.
//!
//! All but the shading is [`Prepared`] first, so that a plan can measure the time of shading.

use super::Settings;
use crate::eye::EyePass;
use crate::method::lights::{LightStore, Lights, LightsWanted};
use crate::method::{Output, Renderer, Sampled, counts};
use crate::progress::Control;
use crate::shade::{Picture, ShadingTask, patches, shade};
use crate::stats::{Stage, StageTime, Stats, Stopwatch};
use crate::view::View;
use crate::vpl::LightPassSettings;
use crate::world::World;
use std::sync::Arc;

/// Minimum number of patches for an estimate of the time of all.
const MIN_TRIED: usize = 32;

/// Renders the picture of `view`.
pub fn render(world: &World, view: &View, settings: &Settings, control: &Control) -> Output {
    settings.render(world, &LightStore::default(), view, control)
}

/// Shading points and virtual lights: all of the picture but its shading.
pub struct Prepared<'w> {
    world: &'w World,
    eye: EyePass<'w>,
    lights: Arc<Lights>,
    stats: Stats,
}

impl<'w> Prepared<'w> {
    /// Runs the eye pass and the light pass by the settings of their numbers.
    pub fn new(
        world: &'w World,
        lights: &LightStore,
        view: &View,
        settings: &Settings,
        control: &Control,
    ) -> Prepared<'w> {
        let mut stats = Stats::new();
        let rays = settings.sampling().eye(&world.scene);
        control.begin(Stage::EyePass, view.window.tile_count(16) as u64);
        let eye = stats.time(Stage::EyePass, || EyePass::trace(world, view, rays, control));
        counts::eye(&mut stats, &eye.chains);
        let pass = LightPassSettings { seed: settings.seed, ..settings.light };
        let wanted = LightsWanted { pass, family: settings.family, max_depth: rays.max_depth };
        let lights = lights.get(world, wanted, control, &mut stats);
        Prepared { world, eye, lights, stats }
    }

    /// Time that shading would take, tried on one patch in `every`, or on more where those would be few.
    pub fn lighting_time(&self, settings: &Settings, every: usize) -> StageTime {
        let watch = Stopwatch::start();
        let patches = self.patches(settings);
        let mut time = watch.elapsed();
        let every = every.min(patches.len() / MIN_TRIED).max(1);
        let some: Vec<Vec<ShadingTask>> = patches.iter().skip(every / 2).step_by(every).cloned().collect();
        let context = self.lights.context(self.world, settings.compensation);
        let watch = Stopwatch::start();
        shade(&context, &self.eye.points, &some, &settings.shading(), &Control::new());
        let points = |patches: &[Vec<ShadingTask>]| patches.iter().map(Vec::len).sum::<usize>() as f64;
        let share = points(&patches) / points(&some).max(1.0);
        let StageTime { wall_seconds, cpu_seconds } = watch.elapsed();
        time += StageTime { wall_seconds: wall_seconds * share, cpu_seconds: cpu_seconds * share };
        time
    }

    /// The picture.
    pub fn light(mut self, settings: &Settings, control: &Control) -> Output {
        let mut stats = std::mem::take(&mut self.stats);
        control.begin(Stage::Render, self.eye.len() as u64);
        let context = self.lights.context(self.world, settings.compensation);
        let mut picture = Picture::new(&self.eye, false);
        let counts = stats.time(Stage::Render, || {
            let patches = self.patches(settings);
            let shading = shade(&context, &self.eye.points, &patches, &settings.shading(), control);
            picture.add_patches(&self.eye, &shading.patches);
            shading.counts
        });
        stats.count("Shading/tasks by cuts", self.eye.len() as u64);
        counts::cuts(&mut stats, "Lightcut", &counts.cuts);
        counts::clamping(&mut stats, &counts.cuts, settings.compensation.then_some(&counts.compensation));
        counts.shadows.report(&mut stats);
        let complete = self.eye.complete && !control.is_cancelled();
        let (color, extra, nonfinite) = picture.finish();
        Output { color, variance: None, extra, stats, complete, nonfinite }
    }

    /// Patches of all shading points.
    fn patches(&self, settings: &Settings) -> Vec<Vec<ShadingTask>> {
        let tasks: Vec<ShadingTask> = (0..self.eye.len() as u32).map(ShadingTask::all).collect();
        patches(&self.eye.points, &tasks, settings.patches, self.world.diagonal)
    }
}
