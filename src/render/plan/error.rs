//! Settings for an error.
//!
//! A search ([`super::bracket`]) begins with cheap images. It finds the cheapest settings whose measured error is low
//! enough. All its images are compared with the same traced paths. The error of the final image is then measured at
//! other pixels with other paths. If that error is too high, the settings are raised, a bounded number of times.
//!
//! An image meets the goal if the upper end of the confidence interval and the noise of the paths are below it. If the
//! paths are too noisy to decide, they are traced again, four times as many where a pixel reached the limit. All raised
//! settings are compared with one set of paths, so that an image found after several raises has had as many chances.

use super::bracket::{ErrorBracket, FALL, Next};
use super::choice::Chooser;
use super::ladder::Ladder;
use crate::method::{Method, Output, SPP};
use crate::verify::{Truth, Verified, VerifySettings};
use base::film::Image;
use base::progress::Control;
use base::sampling::hash;
use base::stats::{StageTime, Stopwatch};
use transport::paths::Estimand;
use world::World;
use world::view::View;

/// Factor on the goal for the search, since the confidence interval reaches above the estimate.
const AIM: f64 = 0.85;
/// Number of steps between levels of the quality scale.
const STEPS: f64 = 2.0;
/// Step at which the search begins: its image is cheap.
const START: usize = 4;
/// Maximum number of times that the settings are raised after the search.
const MAX_RAISES: u64 = 4;
/// Seed that separates the pixels and paths of the search from others.
const SEED: u32 = 0x5ea7_c4ed;

/// Goal of the search.
#[derive(Clone, Copy)]
pub struct ErrorGoal<'a> {
    /// Relative RMS error.
    pub error: f64,
    /// Settings of its measurement.
    pub measure: VerifySettings,
    /// Maximum number of paths per pixel, if paths are too noisy to decide.
    pub max_samples: u32,
    /// Renders the final image of a method.
    pub render: &'a dyn Fn(&Method) -> Output,
}

/// An image and its error.
pub struct PlannedImage {
    /// The method with its settings.
    pub method: Method,
    /// The settings as options.
    pub options: String,
    /// Error that the search expected of the settings.
    pub expected: f64,
    /// The image.
    pub output: Output,
    /// Time of rendering it.
    pub time: StageTime,
    /// Measured error; `None` if measuring was cancelled.
    pub verified: Option<Verified>,
    /// True if the measured error meets the goal.
    pub met: bool,
    /// Settings of the final measurement.
    pub measure: VerifySettings,
    /// Number of images rendered.
    pub renders: u64,
    /// Error of another method that was tried before and missed the goal.
    pub missed: Option<f64>,
}

/// Renders a view with the cheapest settings that meet the goal; `None` if cancelled before the image was begun.
///
/// With a chooser, the error of the first image predicts the samples needed, and so whether paths take less work. Paths
/// are tried, too, if the cache misses the goal at the top of its scale.
pub fn for_error(
    world: &World,
    view: &View,
    ladder: &Ladder,
    chooser: Option<&Chooser>,
    goal: &ErrorGoal,
    control: &Control,
) -> Option<PlannedImage> {
    let search = Search { world, view, goal, control };
    let Some(chooser) = chooser else { return search.on_scale(ladder, START, None) };
    let first = search.first(ladder)?;
    let error = first.truth.judge(&first.image.output.color).relative_rms.value;
    let further = (error / (AIM * goal.error)).ln() / FALL;
    let needed = ((START as f64 + further) / STEPS).clamp(0.0, ladder.top());
    let choice = chooser.on_film(&ladder.at(needed)).method;
    if let Method::Path(paths) = choice {
        return search.by_paths(chooser, paths.spp);
    }
    let found = search.on_scale(ladder, START, Some(first))?;
    let missed = found.verified.map(|v| v.relative_rms.value).filter(|error| *error > goal.error);
    let Some(missed) = missed.filter(|_| !control.is_cancelled()) else { return Some(found) };
    let Some(other) = search.by_paths(chooser, found.method.spp()) else { return Some(found) };
    let lower = other.verified.is_some_and(|v| v.relative_rms.value < missed);
    let renders = found.renders + other.renders;
    Some(match other.met || lower {
        true => PlannedImage { missed: Some(missed), renders, ..other },
        false => PlannedImage { renders, ..found },
    })
}

/// A rendered image and its time.
struct Rendered {
    output: Output,
    time: StageTime,
}

/// The first image of a search, and the paths with which all its images are compared.
struct FirstImage {
    image: Rendered,
    truth: Truth,
}

/// Result of a search.
struct Searched {
    step: f64,
    /// Error by the paths of the search.
    error: f64,
    image: Rendered,
}

/// Inputs of a search.
struct Search<'a> {
    world: &'a World,
    view: &'a View,
    goal: &'a ErrorGoal<'a>,
    control: &'a Control,
}

impl Search<'_> {
    fn render(&self, method: &Method) -> Rendered {
        let watch = Stopwatch::start();
        let output = (self.goal.render)(method);
        Rendered { output, time: watch.elapsed() }
    }

    fn trace(&self, image: &Image, settings: &VerifySettings) -> Option<Truth> {
        Truth::trace(self.world, self.view, image, settings, self.control)
    }

    /// Returns the settings of measurements during the search.
    fn measure(&self) -> VerifySettings {
        VerifySettings { seed: hash(self.goal.measure.seed, SEED), ..self.goal.measure }
    }

    /// Renders the first image, and traces the paths of the search; `None` if cancelled.
    fn first(&self, ladder: &Ladder) -> Option<FirstImage> {
        let image = self.render(&ladder.at(START as f64 / STEPS));
        let truth = self.trace(&image.output.color, &self.measure())?;
        image.output.complete.then_some(FirstImage { image, truth })
    }

    /// Finds the cheapest image by paths. The search begins at the highest step with at most `spp` samples.
    fn by_paths(&self, chooser: &Chooser, spp: u32) -> Option<PlannedImage> {
        let scale = Ladder::new(chooser.of_paths(), &[])?;
        let steps = 0..=(STEPS * scale.top()) as usize;
        let start = steps.rev().find(|step| scale.at(*step as f64 / STEPS).spp() <= spp).unwrap_or(0);
        self.on_scale(&scale, start, None)
    }

    /// Finds the cheapest image of one scale, with a search that begins at `start`.
    fn on_scale(&self, ladder: &Ladder, start: usize, first: Option<FirstImage>) -> Option<PlannedImage> {
        let mut ladder = ladder.clone();
        // More eye samples do not reduce an error that is measured at the image's own eye samples.
        if matches!(self.goal.measure.estimand, Estimand::EyeSamples { .. }) {
            ladder.pin(SPP);
        }
        let (Searched { mut step, error: expected, mut image }, searched) =
            self.search(&ladder, start, first)?;
        let mut judge = Judge { search: self, measure: self.goal.measure, truth: None };
        let mut raises = 0;
        loop {
            let method = ladder.at(step / STEPS);
            let verified = image.output.complete.then(|| judge.verified(&image.output.color)).flatten();
            let verdict = Verdict::new(verified, self.goal.error);
            let last = verdict.is_final || step >= STEPS * ladder.top() || raises >= MAX_RAISES;
            if last || self.control.is_cancelled() {
                return Some(PlannedImage {
                    method,
                    options: method.scaled_options(),
                    expected,
                    output: image.output,
                    time: image.time,
                    verified,
                    met: verdict.met,
                    measure: judge.measure,
                    renders: searched + raises,
                    missed: None,
                });
            }
            // The level rises to the next step, or one step further if the measured error exceeds the goal.
            step = (step.floor() + if verdict.over { 2.0 } else { 1.0 }).min(STEPS * ladder.top());
            image = self.render(&ladder.at(step / STEPS));
            raises += 1;
        }
    }

    /// Finds the lowest step whose error seems to meet the goal, or a place below it; the last step tried if none does.
    ///
    /// The second result is the number of images rendered. The result is `None` if cancelled.
    fn search(&self, ladder: &Ladder, start: usize, first: Option<FirstImage>) -> Option<(Searched, u64)> {
        let goal = AIM * self.goal.error;
        let (mut first, mut truth) =
            first.map_or((None, None), |first| (Some(first.image), Some(first.truth)));
        let mut renders = 0;
        let mut attempt = |step: f64| {
            let image = first.take().unwrap_or_else(|| self.render(&ladder.at(step / STEPS)));
            if !image.output.complete {
                return None;
            }
            if truth.is_none() {
                truth = Some(self.trace(&image.output.color, &self.measure())?);
            }
            let error = truth.as_ref()?.judge(&image.output.color).relative_rms.value;
            renders += 1;
            Some(Searched { step, error, image })
        };
        let mut bracket = ErrorBracket::new(goal, (STEPS * ladder.top()) as usize);
        let mut best = None;
        let mut step = start;
        let found = loop {
            let tried = attempt(step as f64)?;
            let next = bracket.add(step, tried.error);
            if next == Next::Missed {
                break tried;
            }
            best = Some(tried).filter(|tried| tried.error <= goal).or(best);
            match next {
                Next::Try(next) => step = next,
                Next::TryBetween(place) => {
                    let tried = attempt(place)?;
                    break if tried.error <= goal { tried } else { best? };
                }
                Next::Met | Next::Missed => break best?,
            }
        };
        Some((found, renders))
    }
}

/// Measures the errors of images with one set of paths, which grows if it is too noisy to decide.
struct Judge<'a> {
    search: &'a Search<'a>,
    measure: VerifySettings,
    truth: Option<Truth>,
}

impl Judge<'_> {
    /// Returns the error of an image; `None` if cancelled.
    fn verified(&mut self, image: &Image) -> Option<Verified> {
        let goal = self.search.goal;
        loop {
            if self.truth.is_none() {
                self.truth = Some(self.search.trace(image, &self.measure)?);
            }
            let verified = self.truth.as_ref()?.judge(image);
            let is_decided = verified.noise <= goal.error || verified.relative_rms.low > goal.error;
            let more = self.measure.max_samples.saturating_mul(4).min(goal.max_samples);
            if is_decided || more <= self.measure.max_samples {
                return Some(verified);
            }
            self.measure.max_samples = more;
            self.truth = None;
        }
    }
}

/// Meaning of a measured error.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Verdict {
    /// True if the error meets the goal.
    met: bool,
    /// True if the estimate is above the goal.
    over: bool,
    /// True if better settings would not change the verdict.
    is_final: bool,
}

impl Verdict {
    fn new(verified: Option<Verified>, goal: f64) -> Verdict {
        let met = verified.is_some_and(|v| v.relative_rms.high <= goal && v.noise <= goal);
        let over = verified.is_some_and(|v| v.relative_rms.value > goal);
        let is_hidden_by_noise = verified.is_some_and(|v| v.noise > goal) && !over;
        Verdict { met, over, is_final: met || is_hidden_by_noise || verified.is_none() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::verify::Estimate;

    #[test]
    fn errors_are_met_missed_or_hidden_by_the_noise_of_paths() {
        let estimate = |value: f64, width: f64| Estimate { value, low: value - width, high: value + width };
        let verdict = |value: f64, width: f64, noise: f64| {
            let verified = Verified {
                relative_bias: estimate(0.0, width),
                relative_rms: estimate(value, width),
                relative_error_95: estimate(2.0 * value, width),
                error_95_resolved: true,
                noise,
                pixels: 100,
                pixels_at_cap: 0,
                paths: 1,
                nonfinite: 0,
            };
            let Verdict { met, over, is_final } = Verdict::new(Some(verified), 0.02);
            [met, over, is_final]
        };
        assert_eq!(verdict(0.01, 0.005, 0.01), [true, false, true]);
        // The interval reaches above the goal.
        assert_eq!(verdict(0.019, 0.005, 0.01), [false, false, false]);
        assert_eq!(verdict(0.03, 0.005, 0.01), [false, true, false]);
        assert_eq!(verdict(0.01, 0.005, 0.03), [false, false, true]);
        assert_eq!(verdict(0.03, 0.005, 0.03), [false, true, false]);
        assert_eq!(Verdict::new(None, 0.02), Verdict { met: false, over: false, is_final: true });
    }
}
