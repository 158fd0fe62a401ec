//! Settings for an error.
//!
//! A search that begins with cheap pictures finds the cheapest settings whose measured error is low enough,
//! all pictures compared with the same traced paths. The error of the picture found is then measured at other
//! pixels by other paths; while that does not meet the goal, the settings are raised, a bounded number of
//! times.
//!
//! A picture meets the goal if both the upper end of the confidence interval and the noise of the paths are
//! below it. Paths that are too noisy to decide are traced anew, four times as many where a pixel had as many
//! as it may. The steps are compared with one set of paths, so that a picture met after several has had as
//! many chances.

use super::choice::Chooser;
use super::ladder::{Ladder, options};
use crate::method::{Method, Output};
use crate::verify::{Settings, Truth, Verified};
use base::film::Image;
use base::progress::Control;
use base::sampling::hash;
use base::stats::{StageTime, Stopwatch};
use transport::paths::Estimand;
use world::World;
use world::view::View;

/// Factor on the goal that the search aims at: about as much lower as the interval reaches above its
/// estimate.
const AIM: f64 = 0.85;
/// Number of steps between levels.
const STEPS: f64 = 2.0;
/// Level at which the search begins: cheap pictures cost it little.
const START: usize = 4;
/// Approximate fall of the logarithm of the error with a step.
const FALL: f64 = 0.15;
/// Maximum number of steps, besides one, that the search goes up or down by that: seven levels cost twenty
/// times as much.
const LEAP: f64 = 3.0;
/// Number of finer steps after which the search stops if they leave at least `STILL` of the error: something
/// other than these settings dominates it.
const STALL: usize = 4;
/// See [`STALL`].
const STILL: f64 = 0.93;
/// Safety margin, in steps, added to the interpolated step at which the error is predicted to meet the goal.
const MARGIN: f64 = 0.1;
/// Part of a step that must be saved for that to be tried.
const WORTH: f64 = 0.2;
/// Maximum number of times that the settings are raised once the search is over.
const RAISES: u64 = 4;
/// Keeps the pixels and paths of the search apart.
const SEED: u32 = 0x5ea7_c4ed;

/// Goal of the search.
#[derive(Clone, Copy)]
pub struct Asked<'a> {
    /// Relative RMS error.
    pub error: f64,
    /// Settings of its measurement.
    pub measure: Settings,
    /// Maximum number of paths a pixel, where those are too noisy to decide.
    pub most_samples: u32,
    /// Renders the picture of a method, as it is to be kept.
    pub render: &'a dyn Fn(&Method) -> Output,
}

/// A picture and its error.
pub struct Found {
    /// The method with its settings.
    pub method: Method,
    /// The settings as options.
    pub options: String,
    /// Error that the search expected of them.
    pub expected: f64,
    /// The picture.
    pub output: Output,
    /// Time of rendering it.
    pub time: StageTime,
    /// Its error; `None` if measuring was cancelled.
    pub verified: Option<Verified>,
    /// True if the measured error meets the goal.
    pub met: bool,
    /// Settings of its final measurement.
    pub measure: Settings,
    /// Pictures rendered.
    pub renders: u64,
    /// Error that another method came to, before this one was tried.
    pub missed: Option<f64>,
}

/// Renders `window` with the cheapest settings that meet the goal; `None` if cancelled before that film was
/// begun. With a chooser the first picture's error tells about how many samples it takes, and so whether paths take
/// less work; they are tried too where the scale of the cache does not come down to the goal.
pub fn for_error(
    world: &World,
    view: &View,
    (ladder, chooser): (&Ladder, Option<&Chooser>),
    asked: &Asked,
    control: &Control,
) -> Option<Found> {
    let Some(chooser) = chooser else {
        return on_scale(world, view, (ladder, START), None, (asked, control));
    };
    let watch = Stopwatch::start();
    let output = (asked.render)(&ladder.at(START as f64 / STEPS));
    let time = watch.elapsed();
    let measure = Settings { seed: hash(asked.measure.seed, SEED), ..asked.measure };
    let truth = Truth::trace(world, view, &output.color, &measure, control).filter(|_| output.complete)?;
    let first = First { output, time, truth };
    let error = first.truth.judge(&first.output.color).relative_rms.value;
    let further = (error / (AIM * asked.error)).ln() / FALL;
    let needed = ((START as f64 + further) / STEPS).clamp(0.0, ladder.top());
    let paths = || Ladder::new(chooser.of_paths(), &[]);
    let by_paths = |spp: u32| {
        let scale = paths()?;
        let steps = 0..=(STEPS * scale.top()) as usize;
        let start = steps.rev().find(|step| scale.at(*step as f64 / STEPS).spp() <= spp).unwrap_or(0);
        on_scale(world, view, (&scale, start), None, (asked, control))
    };
    let choice = chooser.on_film(&ladder.at(needed)).method;
    if let Method::Path(paths) = choice {
        return by_paths(paths.spp);
    }
    let found = on_scale(world, view, (ladder, START), Some(first), (asked, control))?;
    let missed = found.verified.map(|v| v.relative_rms.value).filter(|error| *error > asked.error);
    let Some(missed) = missed.filter(|_| !control.is_cancelled()) else { return Some(found) };
    let Some(other) = by_paths(found.method.spp()) else { return Some(found) };
    let lower = other.verified.is_some_and(|v| v.relative_rms.value < missed);
    let renders = found.renders + other.renders;
    Some(match other.met || lower {
        true => Found { missed: Some(missed), renders, ..other },
        false => Found { renders, ..found },
    })
}

/// A picture by the settings that a search begins with, before it does.
struct First {
    output: Output,
    time: StageTime,
    /// The search's paths.
    truth: Truth,
}

/// The cheapest picture of one scale, from a search that begins at `start`.
fn on_scale(
    world: &World,
    view: &View,
    (ladder, start): (&Ladder, usize),
    first: Option<First>,
    (asked, control): (&Asked, &Control),
) -> Option<Found> {
    let mut ladder = ladder.clone();
    // Errors of the light at the picture's own samples do not go away by taking more of them.
    if matches!(asked.measure.estimand, Estimand::EyeSamples { .. }) {
        ladder.hold("spp");
    }
    let top = STEPS * ladder.top();
    let Searched { mut step, error: expected, mut output, mut time, renders: searched } =
        search(world, view, (&ladder, start), first, (asked, control))?;

    let mut truth: Option<Truth> = None;
    let mut measure = asked.measure;
    let mut raises = 0;
    loop {
        let method = ladder.at(step / STEPS);
        let verified = if output.complete {
            judge(world, view, &output.color, asked, &mut measure, &mut truth, control)
        } else {
            None
        };
        let met = verified.is_some_and(|v| v.relative_rms.high <= asked.error && v.noise <= asked.error);
        let over = verified.is_some_and(|v| v.relative_rms.value > asked.error);
        // Better settings would not show.
        let hidden = verified.is_some_and(|v| v.noise > asked.error) && !over;
        let last = met || hidden || verified.is_none() || step >= top || raises >= RAISES;
        if last || control.is_cancelled() {
            let (options, renders) = (options(&method), searched + raises);
            let missed = None;
            return Some(Found {
                method,
                options,
                expected,
                output,
                time,
                verified,
                met,
                measure,
                renders,
                missed,
            });
        }
        // From between two steps to the upper one, or the next.
        step = (step.floor() + if over { 2.0 } else { 1.0 }).min(top);
        let watch = Stopwatch::start();
        output = (asked.render)(&ladder.at(step / STEPS));
        time = watch.elapsed();
        raises += 1;
    }
}

/// The error of a picture by `truth`, which is traced as `measure` says where there is none, and anew where
/// it cannot tell; `None` if cancelled.
fn judge(
    world: &World,
    view: &View,
    image: &Image,
    asked: &Asked,
    measure: &mut Settings,
    truth: &mut Option<Truth>,
    control: &Control,
) -> Option<Verified> {
    loop {
        if truth.is_none() {
            *truth = Some(Truth::trace(world, view, image, measure, control)?);
        }
        let verified = truth.as_ref()?.judge(image);
        let told = verified.noise <= asked.error || verified.relative_rms.low > asked.error;
        let more = measure.most_samples.saturating_mul(4).min(asked.most_samples);
        if told || more <= measure.most_samples {
            return Some(verified);
        }
        measure.most_samples = more;
        *truth = None;
    }
}

/// Result of a search.
struct Searched {
    step: f64,
    /// The error by the paths of the search.
    error: f64,
    output: Output,
    time: StageTime,
    renders: u64,
}

/// The lowest step that seems to do, or settings between it and the one below that do too; where none is
/// found, the last that was tried.
fn search(
    world: &World,
    view: &View,
    (ladder, start): (&Ladder, usize),
    mut first: Option<First>,
    (asked, control): (&Asked, &Control),
) -> Option<Searched> {
    let measure = Settings { seed: hash(asked.measure.seed, SEED), ..asked.measure };
    let goal = AIM * asked.error;
    let top = (STEPS * ladder.top()) as usize;
    let mut truth: Option<Truth> = None;
    let mut renders = 0;
    let mut attempt = |step: f64| {
        let (output, time) = match first.take() {
            Some(first) => {
                truth = Some(first.truth);
                (first.output, first.time)
            }
            None => {
                let watch = Stopwatch::start();
                let output = (asked.render)(&ladder.at(step / STEPS));
                (output, watch.elapsed())
            }
        };
        if !output.complete {
            return None;
        }
        if truth.is_none() {
            truth = Some(Truth::trace(world, view, &output.color, &measure, control)?);
        }
        let error = truth.as_ref()?.judge(&output.color).relative_rms.value;
        renders += 1;
        Some(Searched { step, error, output, time, renders })
    };
    let mut met: Option<(usize, Searched)> = None;
    let mut failed: Vec<(usize, f64)> = Vec::new();
    let mut step = start;
    loop {
        let tried = attempt(step as f64)?;
        let error = tried.error;
        // Steps by which the error is likely to be off.
        let off = ((error / goal).ln().abs() / FALL).min(LEAP) as usize;
        if error <= goal {
            met = Some((step, tried));
            step = step.saturating_sub(off.max(1));
        } else {
            let stalls = failed.iter().any(|&(below, e)| below + STALL <= step && error > STILL * e);
            if met.is_none() && (stalls || step >= top) {
                return Some(tried);
            }
            failed.push((step, error));
            step += off + 1;
        }
        let lowest = failed.iter().map(|&(step, _)| step + 1).max().unwrap_or(0);
        step = match &met {
            Some((least, _)) if lowest >= *least => break,
            Some((least, _)) => step.clamp(lowest, least - 1),
            None => step.min(top),
        };
    }
    let (_, found) = met?;
    let below = failed.into_iter().max_by_key(|&(step, _)| step);
    let Some(step) = below.and_then(|below| between(below, (found.step, found.error), goal)) else {
        return Some(found);
    };
    let tried = attempt(step)?;
    let renders = tried.renders;
    Some(if tried.error <= goal { tried } else { Searched { renders, ..found } })
}

/// The step at which the error comes down to `goal`, by the line in logarithms from a step that fails to the
/// next, which does, and a little more; `None` where that saves little.
fn between(failed: (usize, f64), met: (f64, f64), goal: f64) -> Option<f64> {
    let part = (failed.1 / goal).ln() / (failed.1 / met.1).ln() + MARGIN;
    let step = failed.0 as f64 + part * (met.0 - failed.0 as f64);
    (met.0 - step >= WORTH).then_some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_between_steps_is_tried_where_it_saves_much() {
        // The error falls from 4 % to 1 % in a step.
        let at = |goal: f64| between((6, 0.04), (7.0, 0.01), goal);
        let found = at(0.02).unwrap();
        assert!((found - 6.6).abs() < 1e-9, "{found}");
        assert!(at(0.039).unwrap() < 6.2 && at(0.0101).is_none());
        // No error at all.
        assert!(between((6, 0.04), (7.0, 0.0), 0.02).unwrap() < 6.2);
    }
}
