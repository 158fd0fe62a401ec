//! Choice between the cache and denoised paths.
//!
//! The cache finds indirect light without noise, at a price that hardly depends on the number of samples. Direct light
//! has the noise of its samples. Paths have no such price, and all their light has noise. So paths are better
//!
//! - if most noise is in the light that both sample (foliage, glossy surfaces, light through glass and over mirrors),
//! - if paths are cheap,
//! - if few samples are wanted.
//!
//! A short [`Pilot`] of both methods decides, by [`ExpectedWork`].

use super::ladder::Ladder;
use super::pilot::Pilot;
use super::work::ExpectedWork;
use crate::method::{LightStore, Method, Sampling, path};
use base::progress::Control;
use world::World;
use world::view::View;

/// Number of levels of the quality scale that are considered for a time.
const STEPS: u32 = 64;

/// Minimum number of pixels that choices without a time assume. So an icon has the method of a small image.
const MIN_PIXELS: u64 = 1 << 15;

/// Reason for a choice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reason {
    /// An image of the same quality takes less work.
    Work,
    /// There is no time for either method, and the cheapest image of this one takes less work.
    NoTime,
    /// The other method did not reach the error that was asked for.
    Missed,
}

/// A method, and the reason for it.
#[derive(Clone, Copy, Debug)]
pub struct MethodChoice {
    /// Method with its settings.
    pub method: Method,
    /// Reason for it.
    pub reason: Reason,
    /// Expected work of the other method for the same quality, over that of this one.
    ///
    /// If there is no time, the work is that of the cheapest images.
    pub ahead: f64,
    /// Number of paths that reduce noise as much as a first sample of the cache, with its extra samples.
    pub paths_a_sample: f64,
    /// Variance of a path over that of a sample of the cache.
    pub quotient: f64,
    /// Rays per path over rays per sample of the cache.
    pub rays_ratio: f64,
    /// Rays of the pilot.
    pub pilot_rays: u64,
    /// Share of the light that paths seldom find.
    pub seldom: f64,
}

/// Work of both methods for images of one quality.
struct Compared {
    by_cache: f64,
    by_paths: f64,
    /// Paths per pixel.
    spp: f64,
}

impl MethodChoice {
    /// Describes the choice and its reason for users.
    pub fn text(&self) -> String {
        self.text_with(self.method.spp())
    }

    /// Describes the choice, if the final image has so many samples per pixel.
    pub fn text_with(&self, spp: u32) -> String {
        let (name, other) = match self.method {
            Method::Path(_) => (format!("path with denoising, {spp} samples per pixel"), "the cache"),
            _ => ("cache".to_owned(), "path tracing"),
        };
        let ahead = self.ahead;
        let why = match self.reason {
            Reason::Work => format!("{other} would need about {ahead:.1}x the work for the same quality"),
            Reason::NoTime => format!(
                "neither method meets the time, and the cheapest image by {other} would need about {ahead:.1}x the work"
            ),
            Reason::Missed => format!("{other} did not reach the required error"),
        };
        format!("Method: {name} ({why})")
    }
}

/// Chooses between the methods, from their pilot.
pub struct Chooser {
    /// Number of triangles of the scene. The price of a ray depends on it.
    triangles: usize,
    pilot: Pilot,
    film_pixels: u64,
    paths: path::Settings,
}

impl Chooser {
    /// Runs the pilot of `base`, the cache, and of paths.
    ///
    /// The result is `None` if there is no choice, for instance because paths miss part of the light, or if cancelled.
    pub fn new(
        world: &World,
        lights: &LightStore,
        view: &View,
        base: &Method,
        control: &Control,
    ) -> Option<Chooser> {
        let Method::Vpl(_) = base else { return None };
        if world.scene.focuses_lights() {
            return None;
        }
        let Sampling { seed, max_depth, .. } = base.sampling();
        let paths = path::Settings { seed, max_depth, ..path::Settings::default() };
        let pilot = Pilot::of(world, lights, view, [base, &Method::Path(paths)], control)?;
        let film_pixels = view.window.film_pixel_count();
        Some(Chooser { triangles: world.scene.seen_triangle_count(), pilot, film_pixels, paths })
    }

    /// Chooses the cheaper of `cache`, with its settings, and paths of the same quality, on a film of a minimum size.
    pub fn as_good_as(&self, cache: &Method) -> MethodChoice {
        self.cheaper(cache, self.film_pixels.max(MIN_PIXELS))
    }

    /// Chooses the cheaper of `cache`, with its settings, and paths of the same quality, on the film as it is.
    pub fn on_film(&self, cache: &Method) -> MethodChoice {
        self.cheaper(cache, self.film_pixels)
    }

    /// Chooses the method with the better image in `seconds`, given the time of the pilot.
    ///
    /// The settings of the cache are those of its quality scale that fit the time.
    pub fn for_time(&self, ladder: &Ladder, seconds: f64, pilot_seconds: f64) -> MethodChoice {
        let pixels = self.film_pixels;
        let work = ExpectedWork::new(self.triangles, pixels);
        let budget = work.of_pilot(&self.pilot) * seconds.max(0.0) / pilot_seconds.max(1e-9);
        let cheapest = ladder.at(0.0);
        let by_cache = work.of_cache(&self.pilot, &cheapest);
        let by_paths = work.of_paths(&self.pilot, 1.0);
        if budget < by_cache.min(by_paths) {
            let (method, ahead) = match by_paths < by_cache {
                true => (Method::Path(self.paths), by_cache / by_paths),
                false => (cheapest, by_paths / by_cache),
            };
            return MethodChoice { reason: Reason::NoTime, ..self.choice(&cheapest, method, ahead, pixels) };
        }
        let heights = (0..=STEPS).rev().map(|step| ladder.top() * f64::from(step) / f64::from(STEPS));
        let in_time = |height: &f64| work.of_cache(&self.pilot, &ladder.at(*height)) <= budget;
        let height = heights.into_iter().find(in_time);
        let cache = ladder.at(height.unwrap_or(0.0));
        // Settings of the cache that take too long count less.
        let excess = (work.of_cache(&self.pilot, &cache) / budget.max(1e-9)).max(1.0);
        let worth = self.paths_like(&cache, pixels) / excess;
        let paths = budget / by_paths;
        match paths > worth {
            true => self.choice(&cache, Method::Path(self.paths), paths / worth, pixels),
            false => self.choice(&cache, cache, worth / paths.max(1e-9), pixels),
        }
    }

    /// Returns path tracing with the settings from which plans start.
    pub(super) fn of_paths(&self) -> Method {
        Method::Path(self.paths)
    }

    /// Describes the choice of a search for an error by its work. The other method was tried before if `missed`.
    pub fn of(&self, method: Method, missed: bool) -> MethodChoice {
        let pixels = self.film_pixels;
        let work = ExpectedWork::new(self.triangles, pixels);
        let mut cache = method;
        if let Method::Path(paths) = method {
            cache = Method::default();
            let worth = self.pilot.paths_a_sample(f64::from(cache.spp()), pixels);
            cache.set_spp((f64::from(paths.spp) / worth).max(1.0).round() as u32);
        }
        let by_cache = work.of_cache(&self.pilot, &cache);
        let by_paths = work.of_paths(&self.pilot, self.paths_like(&cache, pixels));
        let ahead = if matches!(method, Method::Path(_)) { by_cache / by_paths } else { by_paths / by_cache };
        let reason = if missed { Reason::Missed } else { Reason::Work };
        MethodChoice { reason, ..self.choice(&cache, method, ahead, pixels) }
    }

    /// Returns the number of paths per pixel with the quality of `cache` on a film of so many pixels.
    fn paths_like(&self, cache: &Method, pixels: u64) -> f64 {
        let spp = f64::from(cache.spp());
        spp * self.pilot.paths_a_sample(spp, pixels)
    }

    /// Chooses the cheaper method on a film of so many pixels.
    fn cheaper(&self, cache: &Method, pixels: u64) -> MethodChoice {
        self.by_work(cache, self.work(cache, pixels), pixels)
    }

    /// Chooses one method for a series of images, of which `choosers` have pilots. An image of the cache takes the
    /// share `of_still` of the work of a still.
    pub fn for_series(choosers: &[Chooser], cache: &Method, of_still: f64) -> Option<MethodChoice> {
        let first = choosers.first()?;
        let pixels = |chooser: &Chooser| chooser.film_pixels.max(MIN_PIXELS);
        let works = || choosers.iter().map(|chooser| chooser.work(cache, pixels(chooser)));
        let mean = |value: fn(&Compared) -> f64| {
            works().map(|work| value(&work)).sum::<f64>() / choosers.len() as f64
        };
        let work = Compared {
            by_cache: of_still * mean(|work| work.by_cache),
            by_paths: mean(|work| work.by_paths),
            spp: mean(|work| work.spp).round(),
        };
        Some(first.by_work(cache, work, pixels(first)))
    }

    /// Returns the work of both methods for an image with the quality of `cache`.
    fn work(&self, cache: &Method, pixels: u64) -> Compared {
        let work = ExpectedWork::new(self.triangles, pixels);
        let spp = self.paths_like(cache, pixels).round();
        let (by_cache, by_paths) = (work.of_cache(&self.pilot, cache), work.of_paths(&self.pilot, spp));
        Compared { by_cache, by_paths, spp }
    }

    /// Chooses the method that takes less work.
    fn by_work(&self, cache: &Method, work: Compared, pixels: u64) -> MethodChoice {
        let Compared { by_cache, by_paths, spp } = work;
        let paths = path::Settings { spp: spp.clamp(1.0, f64::from(u32::MAX)) as u32, ..self.paths };
        match by_paths < by_cache {
            true => self.choice(cache, Method::Path(paths), by_cache / by_paths, pixels),
            false => self.choice(cache, *cache, by_paths / by_cache, pixels),
        }
    }

    /// Describes the choice of `method` on a film of so many pixels, if `cache` is one of the two compared.
    fn choice(&self, cache: &Method, method: Method, ahead: f64, pixels: u64) -> MethodChoice {
        let Pilot { rays_of_sampled, rays_of_paths, rays, seldom, .. } = self.pilot;
        MethodChoice {
            method,
            reason: Reason::Work,
            ahead,
            paths_a_sample: self.pilot.paths_a_sample(f64::from(cache.spp()), pixels),
            quotient: self.pilot.quotient(cache.spp().into()),
            rays_ratio: rays_of_paths / rays_of_sampled.max(f64::MIN_POSITIVE),
            pilot_rays: rays,
            seldom,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::ladder::{DRAFT, FINAL, PREVIEW};

    /// Creates a chooser for a film of 512 by 512, from variances and rays of sampled light and of paths.
    fn chooser(triangles: usize, variances: [f64; 2], rays: [f64; 2]) -> Chooser {
        let pilot = Pilot {
            variance_of_sampled: variances[0],
            variance_of_paths: variances[1],
            rays_of_sampled: rays[0],
            rays_of_paths: rays[1],
            rays: 1_000_000,
            seldom: 0.0,
        };
        Chooser { triangles, pilot, film_pixels: 1 << 18, paths: path::Settings::default() }
    }

    /// Creates a chooser with the pilot of a box lit by an area light.
    fn in_box() -> Chooser {
        chooser(36, [0.0018, 0.2], [1.7, 4.5])
    }

    #[test]
    fn a_series_has_one_method_and_sharing_makes_it_the_cache_sooner() {
        let cache = Method::default();
        let [calm, noisy] = [[0.0018, 0.2], [0.2, 0.3]].map(|variances| chooser(36, variances, [1.7, 4.5]));
        assert!(Chooser::for_series(&[], &cache, 1.0).is_none());
        let alone = noisy.as_good_as(&cache);
        let series =
            |choosers: &[Chooser], of_still| Chooser::for_series(choosers, &cache, of_still).unwrap();
        let lone = series(std::slice::from_ref(&noisy), 1.0);
        assert!((lone.method.name(), lone.ahead) == (alone.method.name(), alone.ahead));
        let both = [calm, noisy];
        let is_path = |of_still: f64| is_path(&series(&both, of_still));
        assert!(is_path(1e3) && !is_path(1e-3));
        let spp = |choosers: &[Chooser]| series(choosers, 1e6).method.spp();
        let [first, second] = [spp(&both[..1]), spp(&both[1..])];
        assert!((first.min(second)..=first.max(second)).contains(&spp(&both)) && first != second);
    }

    fn is_path(choice: &MethodChoice) -> bool {
        assert!(choice.ahead >= 1.0, "{choice:?}");
        matches!(choice.method, Method::Path(_))
    }

    #[test]
    fn little_time_is_best_spent_on_paths_where_much_is_on_the_cache() {
        let ladder = Ladder::new(Method::default(), &[]).unwrap();
        let choices: Vec<bool> =
            (-6..6).map(|k| is_path(&in_box().for_time(&ladder, 2f64.powi(k), 0.1))).collect();
        assert!(choices[0] && !choices[11], "{choices:?}");
        assert!(choices.is_sorted_by(|a, b| a >= b), "{choices:?}");
    }

    #[test]
    fn without_time_the_cheapest_picture_is_taken() {
        let ladder = Ladder::new(Method::default(), &[]).unwrap();
        for seconds in [-1.0, 0.0, 1e-9] {
            let choice = in_box().for_time(&ladder, seconds, 0.1);
            assert!(is_path(&choice) && choice.reason == Reason::NoTime, "{choice:?}");
            // Paths of many rays.
            let choice = chooser(36, [0.0018, 0.2], [1.7, 1e9]).for_time(&ladder, seconds, 0.1);
            assert!(!is_path(&choice) && choice.reason == Reason::NoTime, "{choice:?}");
        }
        assert_eq!(in_box().for_time(&ladder, 30.0, 0.1).reason, Reason::Work);
    }

    #[test]
    fn drafts_of_a_calm_box_are_left_to_the_cache() {
        let ladder = Ladder::new(Method::default(), &[]).unwrap();
        for level in [DRAFT, PREVIEW, FINAL] {
            let choice = in_box().as_good_as(&ladder.at(level));
            assert!(!is_path(&choice) && choice.ahead > 1.3, "{level}: {choice:?}");
        }
    }

    #[test]
    fn paths_are_taken_where_the_light_that_both_draw_has_most_of_the_noise() {
        let cache = Method::default();
        assert!(!is_path(&in_box().as_good_as(&cache)));
        let choice = chooser(100_000, [3.0, 3.5], [5.0, 4.5]).as_good_as(&cache);
        assert!(is_path(&choice) && choice.method.spp() >= cache.spp(), "{choice:?}");
        // The number of virtual lights does not depend on the film.
        let noisier = |film_pixels| Chooser { film_pixels, ..chooser(36, [0.0018, 4.0], [1.7, 4.5]) };
        let small = noisier(1 << 10);
        assert!(!is_path(&small.as_good_as(&cache)) && is_path(&small.on_film(&cache)));
        assert!(!is_path(&noisier(1 << 15).on_film(&cache)));
    }

    #[test]
    fn paths_chosen_are_as_many_as_are_worth_the_samples() {
        let chooser = chooser(100_000, [3.0, 7.0], [4.0, 1.0]);
        let choice = chooser.as_good_as(&Method::default());
        let expected = 16.0 * choice.paths_a_sample;
        assert!(is_path(&choice) && (f64::from(choice.method.spp()) - expected).abs() <= 0.5, "{choice:?}");
    }
}
