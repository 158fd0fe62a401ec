//! The lighting of the picture: patches of shading points.

use super::Settings;
use crate::method::{Output, Prepared, counts};
use base::progress::Control;
use base::stats::{Stage, StageTime, Stopwatch};
use transport::shade::{ShadedImage, ShadingContext, ShadingTask, patches, shade};
use world::World;

/// Minimum number of patches for an estimate of the time of all.
const MIN_TRIED: usize = 32;

/// Time that shading would take, tried on one patch in `every`, or on more where those would be few.
pub fn lighting_time(settings: &Settings, world: &World, prepared: &Prepared, every: usize) -> StageTime {
    let points = &prepared.eye.points;
    let watch = Stopwatch::start();
    let patches = patches(points, &tasks(prepared), settings.patches, world.diagonal);
    let mut time = watch.elapsed();
    let every = every.min(patches.len() / MIN_TRIED).max(1);
    let some: Vec<Vec<ShadingTask>> = patches.iter().skip(every / 2).step_by(every).cloned().collect();
    let context = ShadingContext::new(world, &prepared.lights, settings.compensation);
    let watch = Stopwatch::start();
    shade(&context, points, &some, &settings.shading(), &Control::new());
    let count = |patches: &[Vec<ShadingTask>]| patches.iter().map(Vec::len).sum::<usize>() as f64;
    let share = count(&patches) / count(&some).max(1.0);
    let StageTime { wall_seconds, cpu_seconds } = watch.elapsed();
    time += StageTime { wall_seconds: wall_seconds * share, cpu_seconds: cpu_seconds * share };
    time
}

/// The picture, lit.
pub fn light(settings: &Settings, world: &World, prepared: Prepared, control: &Control) -> Output {
    let tasks = tasks(&prepared);
    let Prepared { eye, lights, mut stats } = prepared;
    control.begin(Stage::Render, tasks.len() as u64);
    let context = ShadingContext::new(world, &lights, settings.compensation);
    let mut picture = ShadedImage::new(&eye, false);
    let counts = stats.time(Stage::Render, || {
        picture.shade(&context, &eye, &tasks, settings.patches, &settings.shading(), control)
    });
    picture.came_by("cuts");
    stats.count("Shading/tasks by cuts", tasks.len() as u64);
    counts::cuts(&mut stats, "Lightcut", &counts.cuts);
    counts::clamping(&mut stats, &counts.cuts, settings.compensation.then_some(&counts.compensation));
    counts.shadows.report(&mut stats);
    let complete = eye.complete && !control.is_cancelled();
    let (color, extra, nonfinite) = picture.finish(&mut stats);
    Output { extra, complete, nonfinite, ..Output::new(color, stats) }
}

/// All light of all shading points.
fn tasks(prepared: &Prepared) -> Vec<ShadingTask> {
    (0..prepared.eye.len() as u32).map(ShadingTask::all).collect()
}
