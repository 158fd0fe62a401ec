//! Properties of pictures of random scenes that need no reference: the same scene told otherwise gives the same
//! picture, light adds up, as much of it goes from one place to another as back, and where all surfaces and the sky are
//! equally bright, so is the picture.
//!
//! `LIGHTSPLAT_RANDOM_SCENES=1000 cargo test --release --test images random -- --nocapture` tries so many scenes and
//! says how far pictures were from what they should be, in standard errors; with `200..300`, the scenes of these
//! numbers; by those methods alone with `LIGHTSPLAT_RANDOM_METHODS=path,records`.

use super::random_scenes::{Change, Dice, Spec};
use crate::kit::{WorldAndView, small_methods, toml};
use lightsplat::film::Image;
use lightsplat::math::luminance;
use lightsplat::method::Method;
use std::ops::Range;

/// Numbers of seeds of each picture: at first, and of those that seem to be wrong by the ones before.
const SEEDS: [u32; 4] = [4, 12, 40, 400];
/// Deviation in standard errors from which on more seeds are taken, and by the most seeds is a defect.
const MAX_DEVIATION: f64 = 5.0;
/// Difference relative to the picture that is none: rounding, and what depends on the order of surfaces.
const TOLERANCE: f64 = 0.005;
/// Tolerance of few photons, whose density is blurred: in a closed cube 2,000 photons lack 1 % of the
/// light, 20,000 half of that, and 200,000 a tenth.
const BLUR_TOLERANCE: f64 = 0.03;
/// Tolerance of the mean difference over many scenes.
const MEAN_TOLERANCE: f64 = 0.002;

/// Numbers of scenes: the first `few` unless the environment says others.
fn scenes(few: u64) -> Range<u64> {
    let Ok(wanted) = std::env::var("LIGHTSPLAT_RANDOM_SCENES") else { return 0..few };
    let (first, end) = wanted.split_once("..").unwrap_or(("0", &wanted));
    let number =
        |text: &str| text.parse().expect("LIGHTSPLAT_RANDOM_SCENES is a number, or two with .. between");
    number(first)..number(end)
}

/// True for methods that the environment does not leave out.
fn is_wanted(name: &str) -> bool {
    std::env::var("LIGHTSPLAT_RANDOM_METHODS")
        .map_or(true, |names| names.split(',').any(|wanted| wanted == name))
}

/// Methods with settings for pictures of twelve by twelve pixels.
fn methods() -> [(&'static str, Method); 6] {
    small_methods().map(|(name, mut method)| {
        let spp = if name == "path" { "16" } else { "2" };
        // With some thousand photons, points outside all discs are dark.
        let lights = [("vpls", "500"), ("direct_vpls", "128"), ("photons", "16000")];
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

/// Returns the means of the picture by a seed.
fn rendered(world: &WorldAndView, method: &Method, seed: u32) -> [f64; 5] {
    let mut method = *method;
    assert_eq!(method.set("seed", &seed.to_string()), Ok(true));
    means(&crate::kit::image(world, method.renderer()))
}

/// The means of the picture mirrored left and right.
fn mirrored([whole, a, b, c, d]: [f64; 5]) -> [f64; 5] {
    [whole, b, a, d, c]
}

/// Means of two pictures that should have the same expectation, from the same seed.
type Pair = [[f64; 5]; 2];

/// Difference of pictures over some seeds.
struct Difference {
    /// Greatest difference beyond the tolerance of the whole or a quarter, in standard errors.
    deviation: f64,
    /// Difference of the whole, relative to it; `None` where both are black.
    relative: Option<f64>,
    /// Standard error of the difference.
    error: f64,
}

impl Difference {
    /// Differences are taken seed by seed: what noise the pictures share cancels.
    fn of(pairs: &[Pair], tolerance: f64) -> Difference {
        let count = pairs.len() as f64;
        let mean_of = |value: &dyn Fn(&Pair) -> f64| pairs.iter().map(value).sum::<f64>() / count;
        let parts: [(f64, f64, f64); 5] = std::array::from_fn(|part| {
            let size = mean_of(&|[a, b]| a[part].abs().max(b[part].abs()));
            let mean = mean_of(&|[a, b]| a[part] - b[part]);
            let squares = mean_of(&|[a, b]| (a[part] - b[part] - mean).powi(2));
            (size, mean, (squares / (count - 1.0)).sqrt())
        });
        let whole = parts[0].0;
        let deviation = |(size, mean, error): &(f64, f64, f64)| {
            // Rounding, in quarters that are black but for it.
            let beyond = (mean.abs() - tolerance * size - 1e-6 * whole).max(0.0);
            if beyond > 0.0 { beyond / error.max(1e-6 * whole) } else { 0.0 }
        };
        let (size, mean, error) = parts[0];
        Difference {
            deviation: parts.iter().map(deviation).fold(0.0, f64::max),
            relative: (size > 0.0).then(|| mean / size),
            error: error / size,
        }
    }
}

/// Deviations of a method over all scenes.
#[derive(Default)]
struct Found {
    worst: f64,
    /// Numbers of scenes that took the seeds at first, and each of the greater numbers of seeds.
    tried: [usize; SEEDS.len()],
    /// Relative differences of whole pictures by the first seeds, and their standard errors.
    relative: Vec<f64>,
    errors: Vec<f64>,
    wrong: Vec<String>,
}

impl Found {
    /// Counts a scene by few seeds, or by many where it deviates.
    fn count(&mut self, scene: &str, tolerance: f64, pair: impl Fn(u32) -> Pair) {
        let (mut first, mut deviation, mut of_whole) = (0, 0.0, f64::NAN);
        for (stage, seeds) in SEEDS.into_iter().enumerate() {
            let pairs: Vec<Pair> = (first..first + seeds).map(&pair).collect();
            let difference = Difference::of(&pairs, tolerance);
            self.tried[stage] += 1;
            if let (0, Some(relative)) = (stage, difference.relative) {
                self.relative.push(relative);
                self.errors.push(difference.error);
            }
            (first, deviation) = (first + seeds, difference.deviation);
            of_whole = difference.relative.unwrap_or(of_whole);
            if deviation <= MAX_DEVIATION {
                break;
            }
        }
        self.worst = self.worst.max(deviation);
        if deviation > MAX_DEVIATION {
            let percent = 100.0 * of_whole;
            self.wrong.push(format!("{scene}: {deviation:.1} standard errors, the whole by {percent:.2} %"));
        }
    }

    /// Mean of the relative differences over all scenes, and its standard error from their spread.
    fn mean(&self) -> (f64, f64) {
        let count = self.relative.len() as f64;
        let mean = self.relative.iter().sum::<f64>() / count;
        let squares: f64 = self.relative.iter().map(|r| (r - mean).powi(2)).sum();
        (mean, (squares / (count * (count - 1.0))).sqrt())
    }

    /// Checks the mean over all scenes, where they are many, and says what was found.
    fn conclude(&mut self, name: &str) {
        self.errors.sort_unstable_by(f64::total_cmp);
        let (mean, error) = self.mean();
        eprintln!(
            "{name}: {:?} scenes by {SEEDS:?} seeds, at most {:.2} standard errors of {:.2} % (median); mean difference \
             {:.3} % +- {:.3} %",
            self.tried,
            self.worst,
            100.0 * self.errors.get(self.errors.len() / 2).unwrap_or(&f64::NAN),
            100.0 * mean,
            100.0 * error
        );
        if self.relative.len() >= 16 && mean.abs() - MEAN_TOLERANCE > MAX_DEVIATION * error {
            self.wrong.push(format!("the mean over all scenes by {name}: {mean} +- {error}"));
        }
        self.wrong.iter().for_each(|wrong| eprintln!("  {wrong}"));
    }
}

/// Tries a property by all methods, with a tolerance each, in `few` scenes, or as many as the environment says, and in
/// those that were `mended`, each of which is told in some ways; `pair` makes what should be the same of the means of
/// pictures of these.
fn over_scenes(
    few: u64,
    mended: impl Fn(&str) -> Vec<u64>,
    tolerance: impl Fn(&str) -> f64,
    told: impl Fn(u64, &str) -> Vec<Spec>,
    pair: impl Fn(u64, &dyn Fn(usize) -> [f64; 5]) -> Pair,
) {
    let mut wrong = Vec::new();
    for (name, method) in methods().into_iter().filter(|(name, _)| is_wanted(name)) {
        let mut found = Found::default();
        let numbers = scenes(few);
        for number in numbers.clone().chain(mended(name).into_iter().filter(|n| !numbers.contains(n))) {
            let worlds: Vec<WorldAndView> =
                told(number, name).iter().map(|spec| toml(&spec.text())).collect();
            found.count(&format!("scene {number} by {name}"), tolerance(name), |seed| {
                // Seeds differ between scenes, so that errors average out.
                let seed = number as u32 * 1000 + seed;
                pair(number, &|way| rendered(&worlds[way], &method, seed))
            });
        }
        found.conclude(name);
        wrong.extend(found.wrong);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

fn change(number: u64) -> Change {
    Change::ALL[number as usize % Change::ALL.len()]
}

#[test]
fn scenes_told_otherwise_look_the_same_by_every_method() {
    let told = |number, _: &str| {
        let spec = Spec::random(number);
        vec![spec.changed(change(number), number), spec]
    };
    over_scenes(
        7,
        |_| vec![],
        |_| TOLERANCE,
        told,
        |number, of| {
            let changed = of(0);
            [of(1), if change(number) == Change::Mirrored { mirrored(changed) } else { changed }]
        },
    );
}

#[test]
fn lamps_together_are_the_sum_of_each_alone_by_every_method() {
    let told =
        |number, _: &str| [[1.0, 1.0], [1.0, 0.0], [0.0, 1.0]].map(|on| Spec::random(number).lit(on)).into();
    over_scenes(
        2,
        |_| vec![],
        |_| TOLERANCE,
        told,
        |_, of| {
            let alone = [of(1), of(2)];
            [of(0), std::array::from_fn(|part| alone[0][part] + alone[1][part])]
        },
    );
}

#[test]
fn pictures_are_in_proportion_to_the_light_by_every_method() {
    let factor = |number| 10f64.powf(Dice::new(number).between(-9.0, 9.0));
    let told =
        |number, _: &str| [1.0, factor(number)].map(|power| Spec::random(number).lit([power; 2])).into();
    over_scenes(
        2,
        |_| vec![],
        |_| TOLERANCE,
        told,
        |number, of| [of(0), of(1).map(|mean| mean / factor(number))],
    );
}

#[test]
fn where_all_is_equally_bright_the_picture_is_by_every_method() {
    let told = |number, _: &str| vec![Spec::random(number).furnace(number)];
    let tolerance = |name: &str| if name == "photons" { BLUR_TOLERANCE } else { TOLERANCE };
    over_scenes(2, |_| vec![], tolerance, told, |_, of| [of(0), [1.0, 0.25, 0.25, 0.25, 0.25]]);
}

#[test]
fn as_much_light_goes_from_here_to_there_as_from_there_to_here_by_every_method() {
    let told = |number, name: &str| {
        let mut spec = Spec::random(number);
        // Photon maps take all surfaces to be so. They are blurred besides: by these photons, one scene in a dozen
        // differs by more than its noise, and by up to a third; by two million, those by a few hundredths at most.
        if name == "photons" {
            spec.make_diffuse(number);
        }
        [0, 1].map(|from| spec.exchange(number, from)).into()
    };
    // Rooms of rough metal, and short rays between surfaces that are not alike.
    let mended = |name: &str| if name == "photons" { vec![] } else { vec![62, 81, 82, 204, 944] };
    // The whole alone: the patches' quarters do not see each other alike.
    over_scenes(2, mended, |_| TOLERANCE, told, |_, of| [0, 1].map(|way| [of(way)[0]; 5]));
}
