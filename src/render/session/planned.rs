//! The picture for a goal: by the method as it is set, by the better of two, or by settings planned for a time or an
//! error.

use super::finish::Finish;
use super::frame::Remark;
use super::goal::{Goal, Wanted};
use super::render::{Former, FrameError, Kept};
use super::{Session, report};
use crate::method::{Before, LightStore, Method, Output};
use crate::plan::{self, Chooser, LATE, Ladder};
use crate::verify::{self, Verified};
use base::progress::Control;
use base::stats::{Stage, Stats, Stopwatch};
use serde_json::{Value, json};
use transport::eye::Settled;
use transport::reprojection::Reprojected;
use world::view::View;

/// A picture by the settings that its goal led to.
pub struct Made {
    /// The method with the settings used.
    pub method: Method,
    /// The picture.
    pub output: Output,
    /// Seconds that it took to render.
    pub seconds: f64,
    /// Settings and result of the measurement of the error, where settings were planned by it; no result if
    /// cancelled.
    pub measured: Option<(verify::Settings, Option<Verified>)>,
    /// Goal, plan and result; null if nothing was planned.
    pub plan: Value,
}

/// A frame of a session.
pub struct Planning<'a> {
    /// The session.
    pub session: &'a Session,
    /// Its view.
    pub view: &'a View,
    /// Stages after the method's own.
    pub finish: &'a Finish<'a>,
    /// Progress and cancellation.
    pub control: &'a Control,
}

impl Planning<'_> {
    /// The finished picture; of `former` renders where no settings are planned.
    pub fn picture(
        &self,
        goal: &Goal,
        former: Former,
        stats: &mut Stats,
        remarks: &mut Vec<Remark>,
    ) -> Result<Made, FrameError> {
        let control = self.control;
        let watch = Stopwatch::start();
        // Paths are worth as many samples as they are only where their noise is taken off.
        let may_choose = goal.may_choose && self.finish.denoises();
        let plan = || control.plan(|| self.chooser(&goal.method));
        let chooser = may_choose.then(plan).flatten();
        if may_choose && control.is_cancelled() {
            return Err(FrameError::Unplanned);
        }
        let pilot_time = watch.elapsed();
        if chooser.is_some() {
            stats.add_time(Stage::Plan, pilot_time);
        }
        let mut choice = None;
        let mut made = match &goal.wanted {
            Wanted::AsSet => {
                choice = chooser.map(|chooser| chooser.as_good_as(&goal.method));
                self.as_set(choice.map_or(goal.method, |choice| choice.method), former)
            }
            Wanted::Time { seconds, run, held } => {
                if let Some(chooser) = chooser {
                    let left = seconds - run.elapsed().wall_seconds;
                    let finishing = control.plan(|| self.finish.expected_time(&goal.method, left));
                    let left = *seconds - run.elapsed().wall_seconds - finishing.denoising;
                    let ladder = self.ladder(goal.method, held)?;
                    choice = Some(chooser.for_time(&ladder, left, pilot_time.wall_seconds));
                }
                let method = choice.map_or(goal.method, |choice| choice.method);
                self.for_time(&method, (*seconds, run, held), stats, remarks)?
            }
            Wanted::Error { error, max_samples, held } => {
                let asked = (*error, goal.verify.unwrap_or_default(), *max_samples);
                let ladder = self.ladder(goal.method, held)?;
                let (made, missed) = self.for_error(&ladder, chooser.as_ref(), asked, stats, remarks)?;
                choice = chooser.map(|chooser| chooser.of(made.method, missed));
                made
            }
        };
        if let Some(choice) = choice {
            let is_measured = made.measured.is_some() || goal.verify.is_some();
            report::add_choice(&choice, made.method.spp(), is_measured, &mut made.plan, stats, remarks);
        }
        Ok(made)
    }

    fn chooser(&self, method: &Method) -> Option<Chooser> {
        Chooser::new((&self.session.world, &self.session.lights), self.view, method, self.control)
    }

    fn ladder(&self, method: Method, held: &[&'static str]) -> Result<Ladder, FrameError> {
        let ladder =
            Ladder::new(self.finish.guided(method), held).ok_or(FrameError::Unplannable(method.name()))?;
        Ok(ladder.within(&self.view.window))
    }

    /// The finished picture by a method as it is set.
    fn as_set(&self, method: Method, former: Former) -> Made {
        let Planning { session: Session { world, lights, .. }, view, control, .. } = *self;
        let watch = Stopwatch::start();
        let method = self.finish.guided(method);
        let mut seconds = 0.0;
        let output = match former {
            Former::Frames(kept) => self.next_frame(&method, kept),
            Former::Samples(begun) => {
                seconds += begun.seconds;
                let mut output = method.render_rest(world, lights, &begun, view, control);
                self.finish.apply(&method, &mut output);
                output
            }
            Former::Nothing => {
                let mut output = method.render(world, lights, view, control);
                self.finish.apply(&method, &mut output);
                output
            }
        };
        seconds += watch.elapsed().wall_seconds;
        Made { method, output, seconds, measured: None, plan: Value::Null }
    }

    /// The finished next picture of a walk-through.
    fn next_frame(&self, method: &Method, kept: Kept) -> Output {
        let Planning { session: Session { world, lights, .. }, view, finish, control } = *self;
        let Kept { records, last, thresholds } = kept;
        let draws = method.keeps_records() && method.leaves_noise();
        let last = last.filter(|_| draws && finish.denoises());
        let ends_clean = finish.denoises() || !draws;
        let thresholds = thresholds.filter(|_| method.keeps_records() && ends_clean);
        let seen_by_map = thresholds.as_ref().map(|(thresholds, _)| &**thresholds);
        if last.is_none() && thresholds.is_none() {
            let before = Before { records, settled: Settled::default(), thresholds: None };
            let mut output = method.render_next(world, lights, before, view, control);
            finish.apply(method, &mut output);
            return output;
        }
        let watch = Stopwatch::start();
        let seen = finish.look(method);
        let reprojected = last.as_ref().map(|last| last.reproject(view, &seen));
        let looking = watch.elapsed();
        let settled = reprojected.as_ref().map(Reprojected::settled).unwrap_or_default();
        let number = settled.pixels.iter().filter(|is_settled| **is_settled).count();
        let before = Before { records, settled, thresholds: seen_by_map };
        let mut output = method.render_next(world, lights, before, view, control);
        output.stats.add_time(Stage::EyePass, looking);
        output.stats.count("Walk/pixels settled", number as u64);
        if let Some(reprojected) = reprojected {
            reprojected.mix_into(&mut output.color, &seen);
        }
        let is_denoised = finish.apply_to_seen(&seen, &mut output);
        if let Some(last) = last {
            last.replace(view, &seen, is_denoised.then_some(&output.color));
        }
        if let Some((thresholds, q_scale)) = thresholds {
            let is_clean = output.complete && (is_denoised || !draws);
            thresholds.replace(q_scale, view, &seen, is_clean.then_some(&output.color));
        }
        finish.sharpen(&mut output);
        output
    }

    /// The finished picture by settings planned for a time, of a run that began with `run`.
    fn for_time(
        &self,
        method: &Method,
        (asked, run, held): (f64, &Stopwatch, &[&'static str]),
        stats: &mut Stats,
        remarks: &mut Vec<Remark>,
    ) -> Result<Made, FrameError> {
        let Planning { session: Session { world, .. }, view, finish, control } = *self;
        let watch = Stopwatch::start();
        let ladder = self.ladder(*method, held)?;
        let passed = || run.elapsed().wall_seconds;
        let finishing = control.plan(|| finish.expected_time(&finish.guided(*method), asked - passed()));
        let left = (|| asked - finishing.denoising - passed(), finishing.a_sample);
        let found = control.plan(|| plan::for_time(world, view, &ladder, left, control));
        let found = found.ok_or(FrameError::Unplanned)?;
        let spent = found.spent();
        stats.add_time(Stage::Plan, watch.elapsed().without(spent));
        let before = run.elapsed().wall_seconds;
        let planned = before + found.seconds + finishing.denoising;
        let in_reach = planned <= asked * LATE;
        remarks.extend(report::of_time(asked, [before, planned], in_reach, &found.options));
        stats.add("Plan/time asked [s]", asked);
        stats.add("Plan/time planned, without writing [s]", planned);
        stats.count("Plan/in time (1: yes)", u64::from(in_reach));
        stats.count("Plan/small renders and trials", found.pilots);
        let plan = json!({
            "asked_seconds": asked,
            "planned_seconds": planned,
            "in_reach": in_reach,
            "options": found.options,
        });
        let method = found.method;
        let watch = Stopwatch::start();
        let mut output = found.render(world, view, control);
        finish.apply(&method, &mut output);
        let seconds = spent.wall_seconds + watch.elapsed().wall_seconds;
        Ok(Made { method, output, seconds, measured: None, plan })
    }

    /// The finished picture by the cheapest settings found whose error is as low as asked, and whether another method
    /// did not come to it before.
    fn for_error(
        &self,
        ladder: &Ladder,
        chooser: Option<&Chooser>,
        (error, measure, most_samples): (f64, verify::Settings, u32),
        stats: &mut Stats,
        remarks: &mut Vec<Remark>,
    ) -> Result<(Made, bool), FrameError> {
        let Planning { session: Session { world, .. }, view, finish, control } = *self;
        let render = |method: &Method| {
            let method = finish.guided(*method);
            let mut output = method.render(world, &LightStore::default(), view, control);
            finish.apply(&method, &mut output);
            output
        };
        let asked = plan::Asked { error, measure, most_samples, render: &render };
        let watch = Stopwatch::start();
        let found = control.plan(|| plan::for_error(world, view, (ladder, chooser), &asked, control));
        let found = found.ok_or(FrameError::Unplanned)?;
        stats.add_time(Stage::Plan, watch.elapsed().without(found.time));
        let got = found.verified.map(|v| v.relative_rms);
        remarks.extend(found.missed.map(report::of_missed));
        remarks.extend(report::of_error(error, &found.options, got.filter(|_| !found.met)));
        stats.add("Plan/error asked [%]", 100.0 * error);
        stats.add("Plan/error planned [%]", 100.0 * found.expected);
        stats.count("Plan/error met (1: yes)", u64::from(found.met));
        stats.count("Plan/renders", found.renders);
        let plan = json!({
            "asked_error": error,
            "planned_error": found.expected,
            "got_error": got,
            "met": found.met,
            "options": found.options,
        });
        let missed = found.missed.is_some();
        let measured = Some((found.measure.of(&found.method), found.verified));
        let (method, output, seconds) = (found.method, found.output, found.time.wall_seconds);
        Ok((Made { method, output, seconds, measured, plan }, missed))
    }
}
