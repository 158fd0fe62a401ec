//! The image for a goal: by the given method, by the better of two methods, or by settings planned for a time or an
//! error.

use super::context::FrameContext;
use super::error::FrameError;
use super::finishing_time::FinishingTime;
use super::former::Former;
use super::goal::{ErrorLimit, Goal, PlanGoal, TimeGoal};
use super::next_frame::next_frame;
use super::notes::Notes;
use super::report;
use crate::method::{LightStore, Method, Output};
use crate::plan::{self, Chooser, Deadline, ErrorGoal, LATE, Ladder, MethodChoice};
use crate::verify::{Verified, VerifySettings};
use base::stats::{Stage, Stopwatch};
use serde_json::{Value, json};

/// An image by the settings that its goal led to.
pub struct Made {
    /// The method with the settings used.
    pub method: Method,
    /// The finished image.
    pub output: Output,
    /// Seconds that it took to render.
    pub seconds: f64,
    /// Measurement of the error, if settings were planned by it.
    pub measured: Option<Measurement>,
    /// Goal, plan and result; null if nothing was planned.
    pub plan: Value,
}

/// A measurement of the error.
pub struct Measurement {
    /// Settings of the measurement.
    pub settings: VerifySettings,
    /// Result; `None` if cancelled.
    pub result: Option<Verified>,
}

/// Renders and finishes the image. It builds on `former` renders if no settings are planned.
pub fn image(
    context: &FrameContext,
    goal: &Goal,
    former: Former,
    notes: &mut Notes,
) -> Result<Made, FrameError> {
    let control = context.control;
    let watch = Stopwatch::start();
    // The comparison with paths assumes that their noise is removed.
    let may_choose = goal.may_choose && context.finish.denoises();
    let chooser = || Chooser::new(context.world, context.lights, context.view, &goal.method, control);
    let chooser = may_choose.then(|| control.plan(chooser)).flatten();
    if may_choose && control.is_cancelled() {
        return Err(FrameError::Unplanned);
    }
    let pilot_time = watch.elapsed();
    if chooser.is_some() {
        notes.stats.add_time(Stage::Plan, pilot_time);
    }
    let mut choice = None;
    let mut made = match &goal.plan {
        PlanGoal::AsSet => {
            choice = chooser.map(|chooser| chooser.as_good_as(&goal.method));
            let goal = Goal { method: choice.map_or(goal.method, |choice| choice.method), ..goal.clone() };
            as_set(context, &goal, former)
        }
        PlanGoal::Time(time) => {
            if let Some(chooser) = chooser {
                choice = Some(choose_for_time(context, &chooser, goal, time, pilot_time.wall_seconds)?);
            }
            for_time(context, &choice.map_or(goal.method, |choice| choice.method), time, notes)?
        }
        PlanGoal::Error(limit) => {
            let ladder = ladder(context, goal.method, &limit.pinned)?;
            let measure = goal.verify.unwrap_or_default();
            let (made, missed) = for_error(context, &ladder, chooser.as_ref(), limit, measure, notes)?;
            choice = chooser.map(|chooser| chooser.of(made.method, missed));
            made
        }
    };
    if let Some(choice) = choice {
        let is_measured = made.measured.is_some() || goal.verify.is_some();
        report::add_choice(&choice, made.method.spp(), is_measured, &mut made.plan, notes);
    }
    Ok(made)
}

/// Returns the quality scale of a method, within the memory available.
fn ladder(context: &FrameContext, method: Method, pinned: &[&'static str]) -> Result<Ladder, FrameError> {
    let ladder = Ladder::new(context.finish.guided(method), pinned);
    Ok(ladder.ok_or(FrameError::Unplannable(method.name()))?.within(&context.view.window))
}

/// Chooses the method with the better image in the time that the pilot leaves.
fn choose_for_time(
    context: &FrameContext,
    chooser: &Chooser,
    goal: &Goal,
    time: &TimeGoal,
    pilot_seconds: f64,
) -> Result<MethodChoice, FrameError> {
    let left = || time.seconds - time.run.elapsed().wall_seconds;
    let FrameContext { view, finish, control, .. } = *context;
    let finishing = control.plan(|| FinishingTime::of(finish, view, &goal.method, left()));
    let left = left() - finishing.denoising;
    let ladder = ladder(context, goal.method, &time.pinned)?;
    Ok(chooser.for_time(&ladder, left, pilot_seconds))
}

/// Renders and finishes the image by a method as it is set.
fn as_set(context: &FrameContext, goal: &Goal, former: Former) -> Made {
    let FrameContext { world, lights, view, finish, control } = *context;
    let watch = Stopwatch::start();
    let method = finish.guided(goal.method);
    let mut seconds = 0.0;
    let output = match former {
        Former::Frames(state) => next_frame(context, &method, state),
        Former::Samples(partial) => {
            seconds += partial.seconds;
            let output = match method.as_resumes() {
                Some(resumes) => resumes.render_rest(world, lights, &partial, view, control),
                None => method.render(world, lights, view, control),
            };
            finish.apply(&method, output)
        }
        Former::Nothing => {
            let output = method.render(world, lights, view, control);
            if goal.is_last {
                lights.forget();
            }
            finish.apply(&method, output)
        }
    };
    seconds += watch.elapsed().wall_seconds;
    Made { method, output, seconds, measured: None, plan: Value::Null }
}

/// Renders and finishes the image by settings planned for a time.
fn for_time(
    context: &FrameContext,
    method: &Method,
    time: &TimeGoal,
    notes: &mut Notes,
) -> Result<Made, FrameError> {
    let FrameContext { world, view, finish, control, .. } = *context;
    let watch = Stopwatch::start();
    let ladder = ladder(context, *method, &time.pinned)?;
    let asked = time.seconds;
    let passed = || time.run.elapsed().wall_seconds;
    let guided = finish.guided(*method);
    let finishing = control.plan(|| FinishingTime::of(finish, view, &guided, asked - passed()));
    let left = || asked - finishing.denoising - passed();
    let deadline = Deadline { left: &left, finishing: finishing.sample };
    let time_plan = control.plan(|| plan::for_time(world, view, &ladder, &deadline, control));
    let time_plan = time_plan.ok_or(FrameError::Unplanned)?;
    notes.stats.add_time(Stage::Plan, watch.elapsed());
    let before = passed();
    let planned = before + time_plan.seconds + finishing.denoising;
    let in_reach = planned <= asked * LATE;
    notes.remarks.extend(report::of_time(asked, [before, planned], in_reach, &time_plan.options));
    let stats = &mut notes.stats;
    stats.add("Plan/time asked [s]", asked);
    stats.add("Plan/time planned, without writing [s]", planned);
    stats.count("Plan/in time (1: yes)", u64::from(in_reach));
    stats.count("Plan/small renders", time_plan.trials);
    let plan = json!({
        "asked_seconds": asked,
        "planned_seconds": planned,
        "in_reach": in_reach,
        "options": time_plan.options,
    });
    let method = time_plan.method;
    let watch = Stopwatch::start();
    let output = method.render(world, &LightStore::default(), view, control);
    let output = finish.apply(&method, output);
    let seconds = watch.elapsed().wall_seconds;
    Ok(Made { method, output, seconds, measured: None, plan })
}

/// Renders and finishes the image by the cheapest settings whose error is low enough.
///
/// The second result is true if another method missed the error before.
fn for_error(
    context: &FrameContext,
    ladder: &Ladder,
    chooser: Option<&Chooser>,
    limit: &ErrorLimit,
    measure: VerifySettings,
    notes: &mut Notes,
) -> Result<(Made, bool), FrameError> {
    let FrameContext { world, view, finish, control, .. } = *context;
    let render = |method: &Method| {
        let method = finish.guided(*method);
        finish.apply(&method, method.render(world, &LightStore::default(), view, control))
    };
    let ErrorLimit { error, max_samples, .. } = *limit;
    let goal = ErrorGoal { error, measure, max_samples, render: &render };
    let watch = Stopwatch::start();
    let image = control.plan(|| plan::for_error(world, view, ladder, chooser, &goal, control));
    let image = image.ok_or(FrameError::Unplanned)?;
    notes.stats.add_time(Stage::Plan, watch.elapsed().without(image.time));
    let got = image.verified.map(|v| v.relative_rms);
    notes.remarks.extend(image.missed.map(report::of_missed));
    notes.remarks.extend(report::of_error(error, &image.options, got.filter(|_| !image.met)));
    let stats = &mut notes.stats;
    stats.add("Plan/error asked [%]", 100.0 * error);
    stats.add("Plan/error planned [%]", 100.0 * image.expected);
    stats.count("Plan/error met (1: yes)", u64::from(image.met));
    stats.count("Plan/renders", image.renders);
    let plan = json!({
        "asked_error": error,
        "planned_error": image.expected,
        "got_error": got,
        "met": image.met,
        "options": image.options,
    });
    let missed = image.missed.is_some();
    let settings = image.measure.with_samples_of(&image.method);
    let measured = Some(Measurement { settings, result: image.verified });
    let (method, output, seconds) = (image.method, image.output, image.time.wall_seconds);
    Ok((Made { method, output, seconds, measured, plan }, missed))
}
