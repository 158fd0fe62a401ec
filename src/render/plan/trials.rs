//! The small renders of a plan for a time: which one comes next, and which settings they suggest.
//!
//! The first renders are as cheap as possible, at two sizes. Further ones approach the settings that the model of
//! [`super::time_model`] suggests, as far as their share of the time allows.

use super::ladder::Ladder;
use super::time_model::{Size, TimeModel, Timed};
use crate::method::{Demand, Method};
use base::film::Window;
use world::view::View;

/// Maximum share of the remaining time for a small render.
const PILOT_SHARE: f64 = 0.08;
/// Maximum number of small renders near the settings that the model suggests.
const NEAR_RENDERS: u32 = 3;
/// Maximum difference of levels between a render and the settings that it is near to.
const NEAR: f64 = 0.75;
/// Divisors of each side of the first two small renders.
const ROUGH: [u32; 2] = [16, 8];
/// Divisors of each side of small renders near the settings suggested.
const FINE: [u32; 3] = [4, 6, 8];
/// Minimum number of pixels of a small render.
const MIN_PIXELS: u64 = 1000;
/// Number of steps between levels that are considered.
const STEPS: u32 = 16;

/// A small render.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    /// Level on the quality scale.
    pub level: f64,
    /// The view on its film.
    pub view: View,
}

/// Next kind of trial.
#[derive(Clone, Copy, Debug)]
enum TrialKind {
    Rough,
    Larger,
    Near(u32),
}

/// Trials of a plan.
pub struct Trials<'a> {
    ladder: &'a Ladder,
    view: &'a View,
    /// Seconds per eye sample after the render.
    finishing: f64,
    timed: Vec<Timed>,
    model: Option<TimeModel>,
    kind: TrialKind,
}

impl<'a> Trials<'a> {
    /// Begins without trials. Each eye sample takes `finishing` seconds after the render.
    pub fn new(ladder: &'a Ladder, view: &'a View, finishing: f64) -> Trials<'a> {
        Trials { ladder, view, finishing, timed: Vec::new(), model: None, kind: TrialKind::Rough }
    }

    /// Returns the next trial, if `usable` seconds are left; `None` if there is enough known, or no time.
    pub fn next(&mut self, usable: f64) -> Option<Trial> {
        let second = self.small(ROUGH[1]);
        if let TrialKind::Rough = self.kind {
            self.kind = TrialKind::Larger;
            return Some(Trial { level: 0.0, view: self.small(ROUGH[0]) });
        }
        if let TrialKind::Larger = self.kind {
            self.kind = TrialKind::Near(0);
            if self.seconds_of(&second, 0.0)? < PILOT_SHARE * usable {
                return Some(Trial { level: 0.0, view: second });
            }
        }
        let TrialKind::Near(round) = self.kind else { return None };
        self.kind = TrialKind::Near(round + 1);
        let allowed = PILOT_SHARE * usable;
        let wanted = self.highest(self.view, usable - allowed)?;
        let fits = |&divisor: &u32| {
            self.seconds_of(&self.small(divisor), wanted).is_some_and(|seconds| seconds < allowed)
        };
        let (level, view) = match FINE.into_iter().find(fits) {
            Some(divisor) => (wanted, self.small(divisor)),
            None => (self.highest(&second, allowed)?, second),
        };
        let known = self.model?.level();
        let is_known = |level: f64| (level - known).abs() < if round > 0 { NEAR } else { 1e-9 };
        let is_last = round >= NEAR_RENDERS || level == 0.0 || is_known(level) || is_known(wanted);
        (!is_last).then_some(Trial { level, view })
    }

    /// Adds a trial that was timed.
    pub fn add(&mut self, timed: Timed) {
        self.timed.push(timed);
        self.model = TimeModel::fit(&self.timed, self.finishing);
    }

    /// Returns the number of trials.
    pub fn count(&self) -> u64 {
        self.timed.len() as u64
    }

    /// Returns the highest level that takes at most `seconds`, and its time; the lowest level if none fits.
    pub fn best(&self, seconds: f64) -> Option<(f64, f64)> {
        let level = self.highest(self.view, seconds)?;
        Some((level, self.seconds_of(self.view, level)?))
    }

    fn highest(&self, view: &View, seconds: f64) -> Option<f64> {
        self.model?;
        let fits = |level| self.seconds_of(view, level).is_some_and(|time| time <= seconds);
        let steps = (self.ladder.top() * f64::from(STEPS)) as u32;
        let levels = (0..=steps).rev().map(|step| f64::from(step) / f64::from(STEPS));
        Some(levels.into_iter().find(|&level| fits(level)).unwrap_or(0.0))
    }

    /// Returns the seconds of a render of `view`, with those of finishing its samples.
    fn seconds_of(&self, view: &View, level: f64) -> Option<f64> {
        let size = size(&self.ladder.at(level), view);
        self.model.map(|model| model.seconds(level, &size) + model.finishing(&size))
    }

    /// Returns the view on a film that many times smaller along each side, or less if few pixels would be left.
    fn small(&self, divisor: u32) -> View {
        let is_large = |&divisor: &u32| smaller(self.view, divisor).window.pixel_count() >= MIN_PIXELS;
        smaller(self.view, (1..=divisor).rev().find(is_large).unwrap_or(1))
    }
}

/// Returns the counts on which the time of a render depends.
pub fn size(method: &Method, view: &View) -> Size {
    let pixels = view.window.pixel_count() as f64;
    let Demand { direct_vpls, vpls, extra_samples, shares_patches } = method.demand();
    // Methods that sample light merge the samples of a pixel first.
    let merged = method.leaves_noise();
    Size {
        pixels,
        samples: pixels * f64::from(method.spp()),
        merged,
        patches: shares_patches,
        most_extra: if merged { extra_samples } else { 0.0 },
        vpls: f64::from(direct_vpls) + f64::from(vpls),
    }
}

/// Returns the view on a film `scale` times smaller along each side.
pub fn smaller(view: &View, scale: u32) -> View {
    let window = &view.window;
    let side = |n: u32| n.div_ceil(scale).max(1);
    let film = window.film.map(side);
    let offset = [0, 1].map(|k| (window.offset[k] / scale).min(film[k] - 1));
    let [width, height] =
        [(0, window.width), (1, window.height)].map(|(k, size)| side(size).min(film[k] - offset[k]));
    View { window: Window { film, offset, width, height }, ..*view }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::film::Window;
    use scene::Camera;

    fn view() -> View {
        View { camera: Camera::default(), window: Window::whole([512, 512]) }
    }

    /// Returns the time of a trial on a machine that agrees with the model.
    fn timed(ladder: &Ladder, trial: &Trial) -> Timed {
        let size = size(&ladder.at(trial.level), &trial.view);
        let (light, eye) = (1e-7 * size.vpls, 1e-7 * size.samples);
        let rest = 1e-5 * size.samples.powf(0.75) * (0.35 * trial.level).exp();
        Timed { level: trial.level, size, samples: size.samples, light, eye, rest }
    }

    #[test]
    fn trials_are_few_and_cheap_and_the_best_level_rises_with_the_time() {
        let ladder = Ladder::new(Method::named("reconstruction").unwrap(), &[]).unwrap();
        let view = view();
        let plan = |seconds: f64| {
            let mut trials = Trials::new(&ladder, &view, 0.0);
            let mut left = seconds;
            while let Some(trial) = trials.next(left) {
                assert!(trials.count() > 0 || trial.level == 0.0);
                let timed = timed(&ladder, &trial);
                let time = timed.light + timed.eye + timed.rest;
                assert!(trials.count() == 0 || time < 1.1 * PILOT_SHARE * left, "{seconds} {trial:?} {time}");
                left -= time;
                trials.add(timed);
            }
            assert!((1..=2 + u64::from(NEAR_RENDERS)).contains(&trials.count()));
            let (level, time) = trials.best(left).unwrap();
            assert!(time <= left || level == 0.0, "{seconds} {level} {time}");
            level
        };
        let levels = [1e-3, 0.1, 1.0, 10.0, 100.0, 1e6].map(plan);
        assert!(levels.is_sorted() && levels[0] == 0.0 && levels[5] == ladder.top(), "{levels:?}");
    }

    #[test]
    fn nothing_is_suggested_before_the_first_trial_or_without_one() {
        let ladder = Ladder::new(Method::named("path").unwrap(), &[]).unwrap();
        let view = view();
        let mut trials = Trials::new(&ladder, &view, 0.0);
        assert!(trials.best(1.0).is_none() && trials.next(1.0).is_some());
        assert!(trials.next(1.0).is_none());
    }

    #[test]
    fn small_films_are_valid_whatever_the_crop() {
        let small = |window, scale| smaller(&View { camera: Camera::default(), window }, scale).window;
        let crop = Window { film: [97, 41], offset: [90, 3], width: 7, height: 38 };
        for window in [crop, Window::whole([1, 1]), Window::whole([1, 500]), Window::whole([512, 512])] {
            for scale in [1, 2, 4, 8, 1000] {
                assert!(small(window, scale).is_valid(), "{window:?} {scale}");
            }
            assert_eq!(small(window, 1), window);
        }
        assert_eq!(small(Window::whole([512, 256]), 8), Window::whole([64, 32]));
    }
}
