//! `render --time` and `--error`: the picture by planned settings, and what was asked, planned and got.

use super::args::RenderArgs;
use super::exit::Failure;
use super::job::RenderJob;
use super::{progress, talk};
use crate::film::Metadata;
use crate::method::{Method, Output};
use crate::plan::{self, Held, LATE, Ladder};
use crate::progress::Control;
use crate::stats::{Stage, Stats, Stopwatch};
use crate::verify::{Settings as VerifySettings, Verified};
use crate::view::View;
use crate::world::World;
use anyhow::anyhow;
use serde_json::{Value, json};

/// Most paths a pixel where its error is measured, unless typed.
const MOST_SAMPLES: u32 = 1 << 16;

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
    /// Most paths at a pixel whose error is measured.
    pub most_samples: u32,
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
    let most_samples = args.verify.verify_samples.unwrap_or(MOST_SAMPLES);
    Ok(Some(Wish { wanted, held: held(args), most_samples }))
}

/// The method with its settings: those typed, and for the rest the defaults or what a quality stands for.
pub fn method(args: &RenderArgs) -> Result<Method, Failure> {
    let base = super::method::method(args)?;
    let named = args.plan.quality.zip(Ladder::new(base, held(args)));
    Ok(named.map_or(base, |(quality, ladder)| ladder.at(quality.height())))
}

/// What was typed.
fn held(args: &RenderArgs) -> Held {
    Held {
        spp: args.spp.is_some(),
        epsilon: args.lightcuts.epsilon.is_some(),
        record_epsilon: args.cache.record_epsilon.is_some(),
        max_cut: args.lightcuts.max_cut.is_some(),
        vpls: args.lightcuts.vpls.is_some(),
        patches: args.cache.patches.is_some(),
    }
}

/// A picture and how it came about.
pub struct Made {
    /// The method with the settings used.
    pub method: Method,
    /// The picture.
    pub output: Output,
    /// Seconds that it took to render.
    pub seconds: f64,
    /// Its error, unless measuring was cancelled, and how it was measured: where settings were planned by it.
    pub measured: Option<(VerifySettings, Option<Verified>)>,
    /// What was asked, planned and got, for programs; nothing if nothing was asked.
    pub report: Value,
}

/// Renders the job's picture, by its settings or those that meet the wish. `run` was started with the command.
pub fn make(
    job: &RenderJob,
    world: &World,
    view: &View,
    control: &Control,
    run: &Stopwatch,
    stats: &mut Stats,
) -> Result<Made, Failure> {
    let plain = |method: Method, report: Value| {
        let watch = Stopwatch::start();
        let output = progress::watched(job.progress, control, || method.render(world, view, control));
        let seconds = watch.elapsed().wall_seconds;
        Made { method, output, seconds, measured: None, report }
    };
    let wish = job.wish.and_then(|wish| Some((wish, Ladder::new(job.method, wish.held)?)));
    let Some((wish, ladder)) = wish else { return Ok(plain(job.method, Value::Null)) };
    let ladder = ladder.within(&view.window);
    let interrupted = || Failure::interrupted(anyhow!("interrupted while planning; nothing is written"));
    match wish.wanted {
        Wanted::Time(asked) => {
            let left = || asked - run.elapsed().wall_seconds;
            let search = || plan::for_time(world, view, &ladder, left, control);
            let watch = Stopwatch::start();
            let found = progress::watched(job.progress, control, search).ok_or_else(interrupted)?;
            let spent = found.spent();
            stats.add_time(Stage::Plan, watch.elapsed().without(spent));
            let planned = run.elapsed().wall_seconds + found.render_seconds;
            if planned > asked * LATE {
                talk::warning(&format!(
                    "{asked} s are too short: the cheapest settings are planned to take {planned:.2} s"
                ));
            }
            talk::note(&format!("planned for {asked} s on this machine, this time: {}", found.options));
            stats.add("Plan/time asked [s]", asked);
            stats.add("Plan/time planned, without writing [s]", planned);
            stats.count("Plan/in time (1: yes)", u64::from(planned <= asked * LATE));
            stats.count("Plan/small renders and trials", found.pilots);
            let report = json!({
                "asked_seconds": asked,
                "planned_seconds": planned,
                "in_reach": planned <= asked * LATE,
                "options": found.options,
            });
            let method = found.method;
            let watch = Stopwatch::start();
            let output = progress::watched(job.progress, control, || found.render(world, view, control));
            let seconds = spent.wall_seconds + watch.elapsed().wall_seconds;
            Ok(Made { method, output, seconds, measured: None, report })
        }
        Wanted::Error(error) => {
            let measure = job.verify.unwrap_or_default();
            let asked = plan::Asked { error, measure, most_samples: wish.most_samples };
            let search = || plan::for_error(world, view, &ladder, &asked, control);
            let watch = Stopwatch::start();
            let found = progress::watched(job.progress, control, search).ok_or_else(interrupted)?;
            let all = watch.elapsed();
            stats.add_time(Stage::Plan, all.without(found.time));
            tell(error, &found);
            stats.add("Plan/error asked [%]", 100.0 * error);
            stats.add("Plan/error planned [%]", 100.0 * found.expected);
            stats.count("Plan/error met (1: yes)", u64::from(found.met));
            stats.count("Plan/renders", found.renders);
            let got = found.verified.map(|v| v.relative_rms);
            let report = json!({
                "asked_error": error,
                "planned_error": found.expected,
                "got_error": got,
                "met": found.met,
                "options": found.options,
            });
            let measured = Some((found.measure.of(&found.method), found.verified));
            let (method, output, seconds) = (found.method, found.output, found.time.wall_seconds);
            Ok(Made { method, output, seconds, measured, report })
        }
    }
}

fn tell(asked: f64, found: &plan::Found) {
    talk::note(&format!("planned for an error of {} %: {}", 100.0 * asked, found.options));
    let Some(rms) = found.verified.map(|v| v.relative_rms).filter(|_| !found.met) else { return };
    let [value, low, high] = [rms.value, rms.low, rms.high].map(|x| 100.0 * x);
    talk::warning(&format!(
        "the error is not known to be {} % or less: {value:.2} % ({low:.2} to {high:.2}); \
         more --verify or --verify-samples may tell more",
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
