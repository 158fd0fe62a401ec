//! Settings for a time.
//!
//! Small renders of the film fit a model of time ([`super::trials`]). The plan takes the highest settings that fit the
//! time by the model. The small renders count towards the time.
//!
//! The plan assumes a steady machine: if other work uses the processors later, the run is late.

use super::ladder::Ladder;
use super::time_model::Timed;
use super::trials::{Trial, Trials, size};
use crate::method::{LightStore, Method};
use base::progress::Control;
use base::stats::{Stage, Stopwatch};
use world::World;
use world::view::View;

/// Factor on the time wanted above which a plan is called late.
pub const LATE: f64 = 1.1;
/// Share of the time that is reserved for costs outside the model.
const RESERVE: f64 = 0.02;
/// Seconds to encode and write a pixel.
const WRITE: f64 = 5e-7;

/// End of a render.
pub struct Deadline<'a> {
    /// Returns the seconds that are left, as of its call.
    pub left: &'a dyn Fn() -> f64,
    /// Seconds per eye sample after the render.
    pub finishing: f64,
}

/// Settings and their predicted time.
pub struct TimePlan {
    /// The method with its settings.
    pub method: Method,
    /// The settings as options.
    pub options: String,
    /// Seconds until the image is complete and its samples are finished.
    pub seconds: f64,
    /// Number of small renders.
    pub trials: u64,
}

/// Plans a render of a view that ends at the deadline; `None` if cancelled.
pub fn for_time(
    world: &World,
    view: &View,
    ladder: &Ladder,
    deadline: &Deadline,
    control: &Control,
) -> Option<TimePlan> {
    let usable = || (deadline.left)() * (1.0 - RESERVE) - WRITE * view.window.pixel_count() as f64;
    let mut trials = Trials::new(ladder, view, deadline.finishing);
    while let Some(trial) = trials.next(usable()) {
        trials.add(render(world, ladder, &trial, control)?);
    }
    let (level, seconds) = trials.best(usable())?;
    let method = ladder.at(level);
    Some(TimePlan { method, options: method.scaled_options(), seconds, trials: trials.count() })
}

/// Renders a trial and times it; `None` if cancelled.
fn render(world: &World, ladder: &Ladder, trial: &Trial, control: &Control) -> Option<Timed> {
    let Trial { level, view } = trial;
    let method = ladder.at(*level);
    let watch = Stopwatch::start();
    let output = method.render(world, &LightStore::default(), view, control);
    if !output.complete {
        return None;
    }
    let all = watch.elapsed().wall_seconds;
    let stage = |stage| output.stats.stage(stage).map_or(0.0, |time| time.wall_seconds);
    let light = stage(Stage::LightPass) + stage(Stage::Tree);
    let size = size(&method, view);
    // Without virtual lights all time depends on the samples.
    let eye = if size.vpls > 0.0 { stage(Stage::EyePass) } else { all };
    let samples = size.samples + output.work.extra_samples as f64;
    Some(Timed { level: *level, size, samples, light, eye, rest: (all - light - eye).max(0.0) })
}
