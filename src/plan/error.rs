//! Settings for an error.
//!
//! On a small film a search by halves finds the cheapest settings whose measured error is low enough, all pictures held
//! to the same traced paths. The film is then rendered with them and its error measured at other pixels by other paths; while
//! that is not known to be low enough, the settings are raised, a bounded number of times.
//!
//! A picture meets the error if the upper end of the interval does and the noise of the paths is below it too: what is not known
//! is not met. Paths that are too noisy to tell are traced anew, four times as many where a pixel had as many as it may. The
//! steps are held to one set of paths, so that a picture met after several has had as many chances.

use super::ladder::{FINAL, Ladder, options};
use super::smaller;
use crate::eye::{Look, Window};
use crate::image::Image;
use crate::method::{Control, Method, Output};
use crate::sampling::hash;
use crate::stats::{StageTime, Stopwatch};
use crate::verify::{Settings, Truth, Verified};
use crate::world::World;

/// Most pixels of the small film.
const SMALL: u64 = 128 * 128;
/// Pixels of it that are traced, of those that the picture gets.
const SHARE: f64 = 0.4;
/// How far below the error asked for the search aims: about as much as the interval reaches above its estimate.
const AIM: f64 = 0.85;
/// Steps between rungs.
const STEPS: f64 = 2.0;
/// Most times that the settings are raised once the film is rendered.
const RAISES: u32 = 4;
/// Keeps the pixels and paths of the search apart.
const SEED: u32 = 0x5ea7_c4ed;

/// What is asked.
#[derive(Clone, Copy, Debug)]
pub struct Asked {
    /// Relative RMS error.
    pub error: f64,
    /// How it is measured.
    pub measure: Settings,
    /// Most paths a pixel, where those are too noisy to tell.
    pub most_samples: u32,
}

/// A picture and its error.
pub struct Found {
    /// The method with its settings.
    pub method: Method,
    /// The settings as options.
    pub options: String,
    /// What the search expected of them.
    pub expected: f64,
    /// The picture.
    pub output: Output,
    /// What rendering it took.
    pub time: StageTime,
    /// Its error; `None` if measuring was cancelled.
    pub verified: Option<Verified>,
    /// Whether the error is known to be as low as asked.
    pub met: bool,
    /// How it was measured in the end.
    pub measure: Settings,
    /// Pictures rendered on the small film, and of the whole.
    pub renders: [u64; 2],
}

/// Renders `window` as cheaply as meets what is asked; `None` if cancelled before that film was begun.
pub fn for_error(
    world: &World,
    window: &Window,
    ladder: &Ladder,
    asked: &Asked,
    control: &Control,
) -> Option<Found> {
    let mut ladder = *ladder;
    // Errors of the light at the picture's own samples do not go away by taking more of them.
    ladder.held.spp |= matches!(asked.measure.look, Look::EyeSamples { .. });
    let top = (STEPS * ladder.top()) as usize;
    let height = |step: usize| step as f64 / STEPS;
    let (mut step, expected, small) = search(world, window, &ladder, asked, control)?;

    let mut truth: Option<Truth> = None;
    let mut measure = asked.measure;
    let mut renders = 0;
    loop {
        let method = ladder.at(height(step));
        let watch = Stopwatch::start();
        let output = method.render(world, window, control);
        let time = watch.elapsed();
        renders += 1;
        let verified = if output.complete {
            judge(world, window, &output.color, asked, &mut measure, &mut truth, control)
        } else {
            None
        };
        let met = verified.is_some_and(|v| v.relative_rms.high <= asked.error && v.noise <= asked.error);
        let over = verified.is_some_and(|v| v.relative_rms.value > asked.error);
        // Better settings would not show.
        let hidden = verified.is_some_and(|v| v.noise > asked.error) && !over;
        let last = met || hidden || verified.is_none() || step >= top || renders > u64::from(RAISES);
        if last || control.is_cancelled() {
            let (options, renders) = (options(&method), [small, renders]);
            return Some(Found { method, options, expected, output, time, verified, met, measure, renders });
        }
        step = (step + if over { 2 } else { 1 }).min(top);
    }
}

/// The error of a picture by `truth`, which is traced as `measure` says where there is none, and anew where it cannot tell;
/// `None` if cancelled.
fn judge(
    world: &World,
    window: &Window,
    image: &Image,
    asked: &Asked,
    measure: &mut Settings,
    truth: &mut Option<Truth>,
    control: &Control,
) -> Option<Verified> {
    loop {
        if truth.is_none() {
            *truth = Some(Truth::trace(world, window, image, measure, control)?);
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

/// The lowest step that seems to do, the error it has on the small film, and how many pictures that took.
fn search(
    world: &World,
    window: &Window,
    ladder: &Ladder,
    asked: &Asked,
    control: &Control,
) -> Option<(usize, f64, u64)> {
    let scale = (1..).find(|&s| smaller(window, s).pixel_count() <= SMALL).unwrap_or(1);
    let small = smaller(window, scale);
    let measure = Settings {
        pixels: ((SHARE * asked.measure.pixels as f64) as usize).max(16),
        seed: hash(asked.measure.seed, SEED),
        ..asked.measure
    };
    let mut truth: Option<Truth> = None;
    let mut renders = 0;
    let mut error = |step: usize| -> Option<f64> {
        let output = ladder.at(step as f64 / STEPS).render(world, &small, control);
        if !output.complete {
            return None;
        }
        renders += 1;
        if truth.is_none() {
            truth = Some(Truth::trace(world, &small, &output.color, &measure, control)?);
        }
        Some(truth.as_ref()?.judge(&output.color).relative_rms.value)
    };
    let top = (STEPS * ladder.top()) as usize;
    let (mut low, mut high, mut expected) = (0, top, None);
    let mut middle = (STEPS * FINAL) as usize;
    while low < high {
        let found = error(middle)?;
        if found <= AIM * asked.error {
            (high, expected) = (middle, Some(found));
        } else {
            low = middle + 1;
        }
        middle = (low + high) / 2;
    }
    let expected = match expected {
        Some(expected) => expected,
        None => error(top)?,
    };
    Some((high, expected, renders))
}
