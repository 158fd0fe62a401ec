//! Settings for a time.
//!
//! Three small renders of the film, a cheap one at two sizes and one near the settings that those suggest, fit the model of
//! [`super::cost`]; the highest settings that it says fit are taken. The renders get a share of the time themselves.
//!
//! The model is as good as the machine is steady: if other work takes the processors meanwhile, the run is late.

use super::cost::{Cost, Timed};
use super::ladder::{Ladder, options};
use super::smaller;
use crate::eye::Window;
use crate::method::{Control, Method};
use crate::stats::{Stage, Stopwatch};
use crate::world::World;

/// Share of what is left of the time that the last small render may take.
const PILOT_SHARE: f64 = 0.12;
/// Share kept back for what the model does not know: writing, and being wrong.
const RESERVE: f64 = 0.08;
/// How much smaller the first two renders are, along each side.
const SCALES: [u32; 2] = [16, 8];
/// Steps between rungs that are looked at.
const STEPS: u32 = 16;

/// Settings and what they are thought to take.
#[derive(Clone, Debug)]
pub struct Planned {
    /// The method with its settings.
    pub method: Method,
    /// The settings as options.
    pub options: String,
    /// Their height on the ladder.
    pub height: f64,
    /// Seconds of the render itself.
    pub render_seconds: f64,
    /// Small renders made.
    pub pilots: u64,
}

/// Plans a render of `window` that ends when `left()` seconds, as of its call, have passed; `None` if cancelled.
pub fn for_time(
    world: &World,
    window: &Window,
    ladder: &Ladder,
    left: impl Fn() -> f64,
    control: &Control,
) -> Option<Planned> {
    let mut timed = Vec::new();
    let mut time = |height: f64, scale: u32| -> Option<Cost> {
        let small = smaller(window, scale);
        let method = ladder.at(height);
        let watch = Stopwatch::start();
        let output = method.render(world, &small, control);
        if !output.complete {
            return None;
        }
        let all = watch.elapsed().wall_seconds;
        let stage = |stage| output.stats.stage(stage).map_or(0.0, |t| t.wall_seconds);
        let light = stage(Stage::LightPass) + stage(Stage::Tree);
        let (samples, vpls) = (samples(&method, &small), vpls(&method));
        timed.push(Timed { height, samples, vpls, light, rest: (all - light).max(0.0) });
        Cost::fit(&timed)
    };
    let mut cost = time(0.0, SCALES[0])?;
    let mut pilots = 1;
    let mut allowed = PILOT_SHARE * left();
    if whole(&cost, ladder, &smaller(window, SCALES[1]), 0.0) < allowed {
        cost = time(0.0, SCALES[1])?;
        pilots += 1;
    }
    // As near to the settings wanted as the time for this render lets, smaller first, then cheaper.
    allowed = PILOT_SHARE * left();
    let wanted = highest(&cost, ladder, window, left() * (1.0 - PILOT_SHARE - RESERVE));
    let small = |scale: u32| smaller(window, scale);
    let scale = [4, 6, 8].into_iter().find(|&s| whole(&cost, ladder, &small(s), wanted) < allowed);
    let near = scale.map_or_else(|| highest(&cost, ladder, &small(8), allowed), |_| wanted);
    if near > 0.0 {
        cost = time(near, scale.unwrap_or(8))?;
        pilots += 1;
    }
    let height = highest(&cost, ladder, window, left() * (1.0 - RESERVE));
    let method = ladder.at(height);
    let render_seconds = whole(&cost, ladder, window, height);
    Some(Planned { method, options: options(&method), height, render_seconds, pilots })
}

/// The highest settings that take no longer than `seconds`; the lowest if none do.
fn highest(cost: &Cost, ladder: &Ladder, window: &Window, seconds: f64) -> f64 {
    let steps = (ladder.top() * f64::from(STEPS)) as u32;
    let heights = (0..=steps).rev().map(|k| f64::from(k) / f64::from(STEPS));
    heights.into_iter().find(|&height| whole(cost, ladder, window, height) <= seconds).unwrap_or(0.0)
}

fn whole(cost: &Cost, ladder: &Ladder, window: &Window, height: f64) -> f64 {
    let method = ladder.at(height);
    cost.seconds(height, samples(&method, window), vpls(&method))
}

fn samples(method: &Method, window: &Window) -> f64 {
    window.pixel_count() as f64 * f64::from(method.spp())
}

/// All virtual lights asked for, a few at least so that they can be divided by.
fn vpls(method: &Method) -> f64 {
    let light = match method {
        Method::Path(_) | Method::PhotonCache(_) => return 0.0,
        Method::Cache(s) => &s.light,
        Method::Lightcuts(s) => &s.light,
    };
    f64::from(light.indirect) + f64::from(light.direct)
}
