//! `render --time` and `--error`: the picture by planned settings, and what was asked, planned and got.

use super::args::RenderArgs;
use super::exit::Failure;
use super::job::RenderJob;
use super::{progress, talk};
use crate::eye::Window;
use crate::image::Metadata;
use crate::method::{Control, Method, Output};
use crate::plan::{self, Held, Ladder};
use crate::stats::{Stage, StageTime, Stats, Stopwatch};
use crate::verify::Verified;
use crate::world::World;
use anyhow::anyhow;
use serde_json::{Value, json};

/// What the user wants.
#[derive(Clone, Copy, Debug)]
pub enum Wanted {
    /// A run of so many seconds.
    Time(f64),
    /// A relative RMS error.
    Error(f64),
}

/// A wish and what it may not touch.
#[derive(Clone, Copy, Debug)]
pub struct Wish {
    /// What is wanted.
    pub wanted: Wanted,
    /// What was typed.
    pub held: Held,
}

/// From what was typed.
pub fn wish(args: &RenderArgs, method: &Method) -> Result<Option<Wish>, Failure> {
    let wanted = match (args.plan.time, args.plan.error) {
        (Some(seconds), _) => Wanted::Time(seconds),
        (None, Some(error)) => Wanted::Error(error),
        (None, None) => return Ok(None),
    };
    if matches!(method, Method::PhotonCache(_)) {
        return Err(Failure::usage(anyhow!(
            "--time and --error plan settings of --method cache, lightcuts and path"
        )));
    }
    let held = Held {
        spp: args.spp.is_some(),
        epsilon: args.lightcuts.epsilon.is_some(),
        record_epsilon: args.cache.record_epsilon.is_some(),
        max_cut: args.lightcuts.max_cut.is_some(),
        vpls: args.lightcuts.vpls.is_some(),
        patches: args.cache.patches.is_some(),
    };
    Ok(Some(Wish { wanted, held }))
}

/// A picture and how it came about.
pub struct Made {
    /// The method with the settings used.
    pub method: Method,
    /// The picture.
    pub output: Output,
    /// Seconds that it took to render.
    pub seconds: f64,
    /// Its error, where settings were planned by it.
    pub verified: Option<Verified>,
    /// Whether they were, measured or not.
    pub by_error: bool,
    /// What was asked, planned and got, for programs; nothing if nothing was asked.
    pub report: Value,
}

/// Renders the job's picture, by its settings or those that meet the wish. `run` was started with the command.
pub fn make(
    job: &RenderJob,
    world: &World,
    window: &Window,
    control: &Control,
    run: &Stopwatch,
    stats: &mut Stats,
) -> Result<Made, Failure> {
    let plain = |method: Method, report: Value| {
        let watch = Stopwatch::start();
        let output = progress::watched(job.progress, control, || method.render(world, window, control));
        let seconds = watch.elapsed().wall_seconds;
        Made { method, output, seconds, verified: None, by_error: false, report }
    };
    let Some(wish) = job.wish else { return Ok(plain(job.method, Value::Null)) };
    let Some(ladder) = Ladder::new(job.method, wish.held, window) else {
        return Ok(plain(job.method, Value::Null));
    };
    let interrupted = || Failure::interrupted(anyhow!("interrupted while planning; nothing is written"));
    match wish.wanted {
        Wanted::Time(asked) => {
            let left = || asked - run.elapsed().wall_seconds;
            let search = || plan::for_time(world, window, &ladder, left, control);
            let found = stats.time(Stage::Plan, || progress::watched(job.progress, control, search));
            let found = found.ok_or_else(interrupted)?;
            let planned = run.elapsed().wall_seconds + found.render_seconds;
            if planned > asked {
                talk::warning(&format!(
                    "{asked} s are too short: the cheapest settings are planned to take {planned:.2} s"
                ));
            }
            talk::note(&format!("planned for {asked} s on this machine, this time: {}", found.options));
            stats.add("Plan/time asked [s]", asked);
            stats.add("Plan/time planned, without writing [s]", planned);
            stats.count("Plan/small renders", found.pilots);
            let report = json!({
                "asked_seconds": asked,
                "planned_seconds": planned,
                "height": found.height,
                "options": found.options,
            });
            Ok(plain(found.method, report))
        }
        Wanted::Error(error) => {
            let measure = job.verify.unwrap_or_default();
            let asked = plan::Asked { error, measure };
            let search = || plan::for_error(world, window, &ladder, &asked, control);
            let watch = Stopwatch::start();
            let found = progress::watched(job.progress, control, search).ok_or_else(interrupted)?;
            let all = watch.elapsed();
            stats.add_time(
                Stage::Plan,
                StageTime {
                    wall_seconds: all.wall_seconds - found.time.wall_seconds,
                    cpu_seconds: all.cpu_seconds - found.time.cpu_seconds,
                },
            );
            tell(error, &found);
            stats.add("Plan/error asked [%]", 100.0 * error);
            stats.add("Plan/error planned [%]", 100.0 * found.expected);
            stats.count("Plan/error met (1: yes)", u64::from(found.met));
            stats.count("Plan/small renders", found.renders[0]);
            stats.count("Plan/renders", found.renders[1]);
            let got = found.verified.map(|v| v.relative_rms);
            let report = json!({
                "asked_error": error,
                "planned_error": found.expected,
                "got_error": got,
                "met": found.met,
                "height": found.height,
                "options": found.options,
            });
            let (method, output, verified) = (found.method, found.output, found.verified);
            let seconds = found.time.wall_seconds;
            Ok(Made { method, output, seconds, verified, by_error: true, report })
        }
    }
}

fn tell(asked: f64, found: &plan::Found) {
    talk::note(&format!("planned for an error of {} %: {}", 100.0 * asked, found.options));
    let Some(rms) = found.verified.map(|v| v.relative_rms).filter(|_| !found.met) else { return };
    let [value, low, high] = [rms.value, rms.low, rms.high].map(|x| 100.0 * x);
    talk::warning(&format!(
        "the error is not known to be {} % or less: {value:.2} % ({low:.2} to {high:.2}); \
         more --verify or --verify-samples tell more",
        100.0 * asked
    ));
}

/// The report in the picture's file; `seconds` since the command started.
pub fn store(report: &Value, seconds: f64, metadata: &mut Metadata) {
    for (key, value) in report.as_object().into_iter().flatten() {
        let name = format!("plan_{key}");
        match value {
            Value::Number(number) => metadata.set(&name, number.as_f64().unwrap_or(f64::NAN)),
            Value::Bool(yes) => metadata.set(&name, if *yes { "true" } else { "false" }),
            Value::String(text) => metadata.set(&name, text.as_str()),
            Value::Object(estimate) => {
                metadata.set(&name, estimate.get("value").and_then(Value::as_f64).unwrap_or(f64::NAN));
            }
            _ => {}
        }
    }
    if report.get("asked_seconds").is_some() {
        metadata.set("plan_got_seconds_before_writing", seconds);
    }
}
