//! Settings for a time.
//!
//! Small renders of the film, cheap ones at two sizes and some near the settings that those before suggest, fit the
//! model of [`super::cost`]; the highest settings that fit the time by the model are taken. Where the cache
//! lights by cuts, the cheap ones only suggest the numbers of samples and virtual lights; once those exist,
//! the fineness of cuts is tuned by shading some patches of the picture itself ([`super::tune`]). All of it
//! counts towards the time.
//!
//! The plan assumes a steady machine: if other work takes the processors later on, the run is late.

use super::cost::{Cost, Size, Timed};
use super::ladder::{Ladder, options};
use super::smaller;
use super::tune::tune;
use crate::method::{LightStore, Method, Output, Prepared};
use base::progress::Control;
use base::stats::{Counter, Stage, StageTime, Stopwatch};
use world::World;
use world::view::View;

/// Share of the remaining time that a small render near the settings wanted may take.
const PILOT_SHARE: f64 = 0.08;
/// Share that a trial may take of the time that lighting is thought to take.
const TRIAL_SHARE: f64 = 0.03;
/// Maximum number of trials of the fineness of cuts, once samples and lights go with them.
const TRIALS: usize = 3;
/// A plan that takes this much longer than there is time is not the best that can be done.
pub const LATE: f64 = 1.1;
/// Factor on the height of samples and lights where they are too many for any cuts.
const LESS: f64 = 0.3;
/// Rungs by which half the way from samples and lights to cuts may be off.
const CLOSE: f64 = 0.5;
/// Share of the remaining time that samples and lights may take, as far as is known, so that cuts have the rest.
const PREPARE_SHARE: f64 = 0.4;
/// Maximum number of times that samples and lights are chosen.
const ROUNDS: u32 = 3;
/// Share reserved for costs outside the model.
const RESERVE: f64 = 0.02;
/// Maximum number of small renders near the settings wanted, and levels within which they are near enough.
const NEAR_RENDERS: u32 = 3;
const NEAR: f64 = 0.75;
/// Seconds to encode and write a pixel, and to sum up its samples.
const WRITE: f64 = 5e-7;
/// Divisors of each side of the first two small renders.
const SCALES: [u32; 2] = [16, 8];
/// Minimum number of pixels for an estimate of the time of others.
const LEAST_PIXELS: u64 = 1000;
/// Number of steps between levels that are considered.
const STEPS: u32 = 16;

/// Settings and their predicted time.
pub struct Planned<'w> {
    /// The method with its settings.
    pub method: Method,
    /// The settings as options.
    pub options: String,
    /// Seconds until the picture is there and its samples have been looked through.
    pub seconds: f64,
    /// Small renders made, and trials of the picture itself.
    pub pilots: u64,
    /// Prepared part of the picture, and its time.
    prepared: Option<(Prepared<'w>, StageTime)>,
}

impl Planned<'_> {
    /// Returns the time already spent on the picture.
    pub fn spent(&self) -> StageTime {
        self.prepared.as_ref().map_or(StageTime::default(), |(_, time)| *time)
    }

    /// Renders `window`, as planned, or its missing part.
    pub fn render(self, world: &World, view: &View, control: &Control) -> Output {
        let lit = self.prepared.and_then(|(prepared, _)| self.method.light(world, prepared, control));
        lit.unwrap_or_else(|| self.method.render(world, &LightStore::default(), view, control))
    }
}

/// Plans a render of a view that ends when `left()` seconds, as of its call, have passed; `None` if cancelled. Each eye
/// sample takes `looking` seconds after the render.
pub fn for_time<'w>(
    world: &'w World,
    view: &View,
    ladder: &Ladder,
    (left, looking): (impl Fn() -> f64, f64),
    control: &Control,
) -> Option<Planned<'w>> {
    let usable = || left() * (1.0 - RESERVE) - WRITE * view.window.pixel_count() as f64;
    let tunes = ladder.at(0.0).prepares();
    let (cost, pilots) = small_renders(world, view, ladder, (tunes, looking), &usable, control)?;
    let coarse = highest(&cost, ladder, view, usable());
    if tunes {
        return tuned(world, view, ladder, (&cost, coarse), pilots, &usable, control);
    }
    let (method, seconds) = (ladder.at(coarse), whole(&cost, ladder, view, coarse));
    let options = options(&method);
    Some(Planned { method, options, seconds, pilots, prepared: None })
}

/// Plans cuts as fine as trials allow, on eye samples and virtual lights of about the same level. `guess` is
/// a model of cost and the level to start from.
fn tuned<'w>(
    world: &'w World,
    view: &View,
    ladder: &Ladder,
    guess: (&Cost, f64),
    mut pilots: u64,
    usable: &impl Fn() -> f64,
    control: &Control,
) -> Option<Planned<'w>> {
    let (cost, mut coarse) = guess;
    // Of all trials. Their processor time is steady where other work makes the clock's jump.
    let mut tried = StageTime::default();
    // Samples and lights with cuts as cheap as can be; the model knows lights of the first small renders alone, so what
    // they take in truth corrects it.
    let mut correction = 1.0;
    let preparing = |height: f64| cost.seconds(0.0, &size(&ladder.at(height), view));
    for round in 1.. {
        coarse = highest_within(ladder, coarse, |height| {
            correction * preparing(height) <= PREPARE_SHARE * usable()
        });
        let method = ladder.at(coarse);
        let looking = cost.looking(&size(&method, view));
        let usable = || usable() - looking;
        let seconds = usable();
        let watch = Stopwatch::start();
        let there = method.prepare(world, view, control)?;
        let spent = watch.elapsed();
        if control.is_cancelled() {
            return None;
        }
        correction = spent.wall_seconds / preparing(coarse).max(1e-9);
        let lighting = (seconds - spent.wall_seconds).max(0.0);
        let every = (lighting / (TRIAL_SHARE * usable()).max(1e-9)).ceil().clamp(1.0, 64.0) as usize;
        let mut try_at = |fine: f64| {
            let time = ladder.between(coarse, fine).lighting_time(world, &there, every)?;
            tried += time;
            Some(time.cpu_seconds * tried.wall_seconds / tried.cpu_seconds.max(f64::MIN_POSITIVE))
        };
        let first = tune(coarse, ladder.top(), 1, usable, &mut try_at)?;
        // Samples and lights that do not go with how fine cuts can be are given up.
        let late = first.seconds > LATE * usable();
        let next = if late { LESS * coarse } else { 0.5 * (coarse + first.height) };
        let same = options(&ladder.between(next, coarse)) == options(&ladder.at(coarse));
        let off = late || (next - coarse).abs() > CLOSE;
        pilots += first.trials;
        // Samples and lights in hand are not given up for others that would leave no time for cuts.
        let affordable = match late {
            true => usable() > 0.0,
            false => correction * preparing(next) <= PREPARE_SHARE * usable(),
        };
        if off && !same && affordable && round < ROUNDS {
            coarse = next;
            continue;
        }
        let tuned = tune(first.height, ladder.top(), TRIALS, usable, &mut try_at)?;
        let method = ladder.between(coarse, tuned.height);
        let (options, prepared) = (options(&method), Some((there, spent)));
        pilots += tuned.trials;
        let seconds = tuned.seconds + looking;
        return Some(Planned { method, options, seconds, pilots, prepared });
    }
    None
}

/// Returns a model of cost, from the first small renders or from all, and their number.
fn small_renders(
    world: &World,
    view: &View,
    ladder: &Ladder,
    (only_rough, looking): (bool, f64),
    usable: &impl Fn() -> f64,
    control: &Control,
) -> Option<(Cost, u64)> {
    let mut timed = Vec::new();
    let mut time = |height: f64, small: View| -> Option<Cost> {
        let method = ladder.at(height);
        let watch = Stopwatch::start();
        let output = method.render(world, &LightStore::default(), &small, control);
        if !output.complete {
            return None;
        }
        let all = watch.elapsed().wall_seconds;
        let stage = |stage| output.stats.stage(stage).map_or(0.0, |t| t.wall_seconds);
        let light = stage(Stage::LightPass) + stage(Stage::Tree);
        let size = size(&method, &small);
        // Without virtual lights all time goes with the samples.
        let eye = if size.vpls > 0.0 { stage(Stage::EyePass) } else { all };
        let extra = match output.stats.get("Eye/extra samples") {
            Some(Counter::Count(extra)) => extra as f64,
            _ => 0.0,
        };
        let drawn = size.samples + extra;
        timed.push(Timed { height, size, drawn, light, eye, rest: (all - light - eye).max(0.0) });
        Cost::fit(&timed, looking)
    };
    let small = |scale: u32| {
        let scales = (1..=scale).rev();
        let big = |&scale: &u32| smaller(view, scale).window.pixel_count() >= LEAST_PIXELS;
        smaller(view, scales.into_iter().find(big).unwrap_or(1))
    };
    let mut cost = time(0.0, small(SCALES[0]))?;
    let mut pilots = 1;
    let second = small(SCALES[1]);
    if whole(&cost, ladder, &second, 0.0) < PILOT_SHARE * usable() {
        cost = time(0.0, second)?;
        pilots += 1;
    }
    if only_rough {
        return Some((cost, pilots));
    }
    // As near to the settings wanted as the time for this render lets, smaller first, then cheaper; again where these
    // turn out to be others.
    for round in 0..NEAR_RENDERS {
        let allowed = PILOT_SHARE * usable();
        let wanted = highest(&cost, ladder, view, usable() - allowed);
        let scale = [4, 6, 8].into_iter().find(|&s| whole(&cost, ladder, &small(s), wanted) < allowed);
        let near = scale.map_or_else(|| highest(&cost, ladder, &second, allowed), |_| wanted);
        let is_known = |height: f64| (height - cost.height()).abs() < if round > 0 { NEAR } else { 1e-9 };
        if near == 0.0 || is_known(near) || is_known(wanted) {
            break;
        }
        cost = time(near, small(scale.unwrap_or(SCALES[1])))?;
        pilots += 1;
    }
    Some((cost, pilots))
}

/// The highest settings that take no longer than `seconds`; the lowest if none do.
fn highest(cost: &Cost, ladder: &Ladder, view: &View, seconds: f64) -> f64 {
    highest_within(ladder, ladder.top(), |height| whole(cost, ladder, view, height) <= seconds)
}

/// The highest level up to `top` that fits; the lowest if none does.
fn highest_within(ladder: &Ladder, top: f64, fits: impl Fn(f64) -> bool) -> f64 {
    let steps = (ladder.top() * f64::from(STEPS)) as u32;
    let heights = (0..=steps).rev().map(|k| f64::from(k) / f64::from(STEPS)).filter(|height| *height < top);
    std::iter::once(top).chain(heights).find(|&height| fits(height)).unwrap_or(0.0)
}

fn whole(cost: &Cost, ladder: &Ladder, view: &View, height: f64) -> f64 {
    let size = size(&ladder.at(height), view);
    cost.seconds(height, &size) + cost.looking(&size)
}

fn size(method: &Method, view: &View) -> Size {
    let pixels = view.window.pixel_count() as f64;
    // Methods that draw light merge the samples of a pixel before all else.
    let merged = method.leaves_noise();
    let extra = method.number("extra_samples").filter(|_| merged);
    Size {
        pixels,
        samples: pixels * f64::from(method.spp()),
        merged,
        patches: method.number("patches").is_some(),
        most_extra: extra.unwrap_or(0.0) as f32,
        vpls: ["vpls", "direct_vpls"].iter().filter_map(|key| method.number(key)).sum(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_highest_level_that_fits_is_no_higher_than_the_one_wanted() {
        let ladder = Ladder::new(Method::named("reconstruction").unwrap(), &[]).unwrap();
        let step = 1.0 / f64::from(STEPS);
        for top in [0.0, 0.7, 2.3, ladder.top()] {
            assert_eq!(highest_within(&ladder, top, |_| true), top);
            assert_eq!(highest_within(&ladder, top, |_| false), 0.0);
            for limit in [0.1, 1.9, 5.0] {
                let found = highest_within(&ladder, top, |height| height <= limit);
                assert!(found <= limit.min(top) && found > limit.min(top) - step, "{found} {limit} {top}");
            }
        }
    }
}
