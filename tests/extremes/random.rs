//! Properties of pictures of random scenes that need no reference: the same scene told otherwise gives the same
//! picture, light adds up, and where all surfaces and the sky are equally bright, so is the picture.
//!
//! `LIGHTSPLAT_RANDOM_SCENES=1000 cargo test --release --test extremes random -- --nocapture` tries so many scenes and
//! says how far pictures were from what they should be, in standard errors.

use crate::all_methods::{all, toml};
use crate::common::*;
use crate::random_scenes::{Change, Dice, Spec};
use lightsplat::film::Image;
use lightsplat::math::luminance;
use lightsplat::method::{LightStore, Method};
use lightsplat::progress::Control;

/// Number of seeds of each picture, and of those that seem to be wrong.
const SEEDS: [u32; 2] = [4, 40];
/// Deviation in standard errors from which on more seeds are taken.
const SUSPECT: f64 = 4.5;
/// Deviation in standard errors by more seeds that is a defect.
const MAX_DEVIATION: f64 = 5.0;
/// Deviation relative to the picture that is none: rounding, and what depends on the order of surfaces.
const TOLERANCE: f64 = 0.005;

/// Number of scenes, `few` unless the environment says another.
fn count(few: u64) -> u64 {
    let wanted = std::env::var("LIGHTSPLAT_RANDOM_SCENES").ok();
    wanted.and_then(|number| number.parse().ok()).unwrap_or(few)
}

/// Methods with settings for pictures of twelve by twelve pixels.
fn methods() -> [(&'static str, Method); 6] {
    all().map(|(name, mut method)| {
        let spp = if name == "path" { "16" } else { "2" };
        let lights = [("vpls", "500"), ("direct_vpls", "128"), ("photons", "2000")];
        for (key, value) in
            lights.into_iter().chain([("gather_rays", "32"), ("least_cell", "4"), ("spp", spp)])
        {
            // Methods have some of them.
            let _ = method.set(key, value);
        }
        (name, method)
    })
}

/// Mean luminance of the picture and of its quarters, in rows.
fn means(image: &Image) -> [f64; 5] {
    let mut sums = [0.0; 5];
    for (i, pixel) in image.pixels.iter().enumerate() {
        let (x, y) = (i as u32 % image.width, i as u32 / image.width);
        let quarter = u32::from(2 * x >= image.width) + 2 * u32::from(2 * y >= image.height);
        let value = f64::from(luminance(*pixel)) / image.pixels.len() as f64;
        sums[0] += value;
        sums[1 + quarter as usize] += value;
    }
    sums
}

/// Means of the pictures by some seeds, and the squares of their standard errors.
#[derive(Clone, Copy, Default)]
struct Estimate([(f64, f64); 5]);

impl Estimate {
    fn of(world: &WorldAndView, method: &Method, seeds: std::ops::Range<u32>) -> Estimate {
        let samples: Vec<[f64; 5]> = seeds
            .map(|seed| {
                let mut method = *method;
                assert_eq!(method.set("seed", &seed.to_string()), Ok(true));
                let output = method.render(world, &LightStore::default(), &world.view, &Control::new());
                assert!(
                    output.complete && output.nonfinite == 0,
                    "{} samples were not finite",
                    output.nonfinite
                );
                means(&output.color)
            })
            .collect();
        let count = samples.len() as f64;
        let mut estimate = Estimate::default();
        for (part, (mean, square)) in estimate.0.iter_mut().enumerate() {
            *mean = samples.iter().map(|s| s[part]).sum::<f64>() / count;
            *square =
                samples.iter().map(|s| (s[part] - *mean).powi(2)).sum::<f64>() / (count * (count - 1.0));
        }
        estimate
    }

    fn plus(&self, other: &Estimate) -> Estimate {
        let mut sum = *self;
        sum.0.iter_mut().zip(&other.0).for_each(|(a, b)| *a = (a.0 + b.0, a.1 + b.1));
        sum
    }

    fn times(&self, factor: f64) -> Estimate {
        Estimate(self.0.map(|(mean, square)| (mean * factor, square * factor * factor)))
    }

    /// The estimate of the picture mirrored left and right.
    fn mirrored(&self) -> Estimate {
        let [whole, a, b, c, d] = self.0;
        Estimate([whole, b, a, d, c])
    }

    /// Greatest difference in standard errors, to which [`TOLERANCE`] is added.
    fn deviation(&self, other: &Estimate) -> f64 {
        let pairs = self.0.iter().zip(&other.0);
        let deviations = pairs.map(|((a, va), (b, vb))| {
            let tolerance = TOLERANCE * a.abs().max(b.abs()) + 1e-9;
            (a - b).abs() / (va + vb + tolerance * tolerance).sqrt()
        });
        deviations.fold(0.0, f64::max)
    }
}

/// Deviations of a method over all scenes.
#[derive(Default)]
struct Found {
    worst: f64,
    suspects: usize,
    tried: usize,
    wrong: Vec<String>,
}

impl Found {
    /// Counts a deviation by few seeds, or by many where that is much.
    fn count(&mut self, what: impl Fn() -> String, deviation: impl Fn(std::ops::Range<u32>) -> f64) {
        let [few, many] = SEEDS;
        self.tried += 1;
        let mut found = deviation(0..few);
        if found > SUSPECT {
            self.suspects += 1;
            found = deviation(few..few + many);
        }
        self.worst = self.worst.max(found);
        if found > MAX_DEVIATION {
            self.wrong.push(format!("{}: {found:.1} standard errors", what()));
        }
    }

    fn tell(&self, name: &str) {
        let Found { worst, suspects, tried, wrong } = self;
        eprintln!(
            "{name}: {tried} tried, {suspects} again with more seeds, at most {worst:.2} standard errors"
        );
        wrong.iter().for_each(|wrong| eprintln!("  {wrong}"));
    }
}

/// Tries a property by all methods but one in `few` scenes, or as many as the environment says, each of which is told
/// in some ways.
fn over_scenes(
    few: u64,
    left_out: Option<&str>,
    told: impl Fn(u64) -> Vec<Spec>,
    deviation: impl Fn(u64, &dyn Fn(usize) -> Estimate) -> f64,
) {
    let mut found = methods().map(|_| Found::default());
    for number in 0..count(few) {
        let worlds: Vec<WorldAndView> = told(number).iter().map(|spec| toml(&spec.text())).collect();
        let tried = found.iter_mut().zip(methods()).filter(|(_, (name, _))| Some(*name) != left_out);
        for (found, (name, method)) in tried {
            let by_seeds = |seeds: std::ops::Range<u32>| {
                deviation(number, &|way| Estimate::of(&worlds[way], &method, seeds.clone()))
            };
            found.count(|| format!("scene {number} by {name}"), by_seeds);
        }
    }
    found.iter().zip(methods()).for_each(|(found, (name, _))| found.tell(name));
    assert!(found.iter().all(|found| found.wrong.is_empty()));
}

fn change(number: u64) -> Change {
    Change::ALL[number as usize % Change::ALL.len()]
}

#[test]
fn scenes_told_otherwise_look_the_same_by_every_method() {
    let told = |number| {
        let spec = Spec::random(number);
        vec![spec.changed(change(number), number), spec]
    };
    over_scenes(7, None, told, |number, of| {
        let changed = of(0);
        of(1).deviation(&if change(number) == Change::Mirrored { changed.mirrored() } else { changed })
    });
}

#[test]
fn lamps_together_are_the_sum_of_each_alone_by_every_method() {
    let told = |number| [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(|on| Spec::random(number).lit(on)).into();
    over_scenes(2, None, told, |_, of| of(0).deviation(&of(1).plus(&of(2))));
}

#[test]
fn pictures_are_in_proportion_to_the_light_by_every_method() {
    let factor = |number| 10f64.powf(Dice::new(number).between(-9.0, 9.0));
    let told = |number| [1.0, factor(number)].map(|power| Spec::random(number).lit([power; 2])).into();
    over_scenes(2, None, told, |number, of| of(0).deviation(&of(1).times(1.0 / factor(number))));
}

#[test]
fn where_all_is_equally_bright_the_picture_is_by_every_method() {
    let told = |number| vec![Spec::random(number).furnace(number)];
    // Few photons give a biased density along edges.
    over_scenes(2, Some("photons"), told, |_, of| {
        let mut expected = Estimate([(0.25, 0.0); 5]);
        expected.0[0].0 = 1.0;
        of(0).deviation(&expected)
    });
}
