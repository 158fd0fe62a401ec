//! A frame, from its goal to its facts.

use super::finish::Finish;
use super::frame::{self, Frame, Remark};
use super::goal::{Goal, Wanted};
use super::{Session, report};
use crate::eye::{DROPPED_BRANCHES, Settled};
use crate::film::Image;
use crate::math::Rgb;
use crate::method::path::Begun;
use crate::method::{Before, KeptRecords, LightStore, Method, Output};
use crate::plan::{self, LATE, Ladder};
use crate::progress::Control;
use crate::reprojection::LastPicture;
use crate::stats::{Counter, Stage, Stats, Stopwatch, available_bytes};
use crate::verify::{self, Verified, verify};
use crate::view::View;
use serde_json::{Value, json};

/// Reason why there is no frame.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrameError {
    /// Rendering was cancelled before there was anything to keep.
    #[error("interrupted before the first pixel; nothing is written")]
    Interrupted,
    /// The frame needs more memory than there is.
    #[error(
        "the picture would take about {needed:.1} GiB, and {available:.1} GiB of memory are available: take fewer \
         samples (--spp), virtual lights (--vpls, --direct-vpls) or photons (--photons), render the film in parts with \
         --crop, or use --method lightcuts"
    )]
    Memory {
        /// Needed, in GiB.
        needed: f64,
        /// Available, in GiB.
        available: f64,
    },
    /// Settings of the method cannot be planned.
    #[error("settings of --method {0} cannot be planned for a time or an error")]
    Unplannable(&'static str),
}

/// Work of former renders on which one builds.
pub(crate) enum Former<'a> {
    /// None.
    Nothing,
    /// The frames before, in a walk-through.
    Frames(Kept<'a>),
    /// The same picture, interrupted.
    Samples(Begun),
}

/// Work of the frames before a frame, and of that for the next.
pub(crate) struct Kept<'a> {
    /// Records.
    pub records: &'a mut KeptRecords,
    /// The picture before, if drawn light is to be carried over from it.
    pub last: Option<&'a mut LastPicture>,
}

/// A picture by the settings that its goal led to.
struct Made {
    /// The method with the settings used.
    method: Method,
    output: Output,
    /// Seconds that it took to render.
    seconds: f64,
    /// Settings and result of the measurement of the error, where settings were planned by it; no result if
    /// cancelled.
    measured: Option<(verify::Settings, Option<Verified>)>,
    /// Goal, plan and result; null if nothing was planned.
    plan: Value,
}

impl Session {
    /// Renders the picture of `view` for `goal`. A frame that was cancelled halfway is partial, not an error.
    pub fn frame(&self, view: &View, goal: &Goal, control: &Control) -> Result<Frame, FrameError> {
        self.frame_by(view, goal, Former::Nothing, control)
    }

    /// The rest of the same frame where rendering it was interrupted. It has the bits of one that was not, unless its
    /// settings are planned.
    pub fn rest_of_frame(
        &self,
        view: &View,
        goal: &Goal,
        begun: Begun,
        control: &Control,
    ) -> Result<Frame, FrameError> {
        self.frame_by(view, goal, Former::Samples(begun), control)
    }

    /// The same with the help of `former` renders, where no settings are planned.
    pub(crate) fn frame_by(
        &self,
        view: &View,
        goal: &Goal,
        former: Former,
        control: &Control,
    ) -> Result<Frame, FrameError> {
        let needed = goal.method.expected_bytes(&view.window);
        if let Some(available) = available_bytes().filter(|available| needed > *available) {
            let [needed, available] = [needed, available].map(|bytes| bytes as f64 / f64::from(1 << 30));
            return Err(FrameError::Memory { needed, available });
        }
        let watch = Stopwatch::start();
        let mut stats = Stats::new();
        let mut remarks = Vec::new();
        let finish = Finish::new(&self.world, view, goal, control, &mut stats);
        let made = match goal.wanted {
            Wanted::AsSet => self.as_set(view, goal.method, former, &finish, control),
            _ => self.planned(view, goal, &finish, control, &mut stats, &mut remarks)?,
        };
        let Made { method, output, seconds, measured, plan } = made;
        stats.merge(&output.stats);
        if let Some(Counter::Count(dropped @ 1..)) = stats.get(DROPPED_BRANCHES) {
            remarks.push(Remark::Warning(format!(
                "{dropped} branches of eye paths were dropped, because too many mirrors and panes of glass follow each \
                 other: their light is missing"
            )));
        }
        if let Some(error) = finish.failure() {
            remarks.push(Remark::Warning(format!("the picture is not denoised: {error}")));
        }

        let complete = output.complete;
        let black = || output.color.pixels.iter().all(|pixel| *pixel == Rgb::ZERO);
        // Of a scene without light, people have been warned.
        if complete && !self.world.scene.is_dark() && black() {
            remarks.push(Remark::Warning(frame::BLACK.to_owned()));
        }
        let nonfinite_samples = output.nonfinite;
        let denoised_by = finish.denoised_by().filter(|_| complete);
        let (mut film, nonfinite_channels) =
            frame::film(output, view, &self.world.scene, denoised_by.is_some());
        for (n, what) in [(nonfinite_samples, "samples"), (nonfinite_channels, "channels of the picture")] {
            if n > 0 {
                remarks.push(Remark::Warning(format!(
                    "{n} {what} were NaN or infinite and count as 0; this is a defect, please report it"
                )));
            }
        }
        let nonfinite = nonfinite_samples + nonfinite_channels;
        self.describe(&method, &mut film.metadata);
        film.metadata.set("partial", if complete { "false" } else { "true" });
        film.metadata.set("render_seconds", seconds);
        film.metadata.set("nonfinite", nonfinite as f64);
        if goal.denoises() {
            film.metadata.set("denoised", denoised_by.as_deref().unwrap_or("false"));
        }
        let since_start = match &goal.wanted {
            Wanted::Time { run, .. } => run.elapsed(),
            _ => watch.elapsed(),
        };
        report::store_plan(&plan, since_start.wall_seconds, &mut film.metadata);

        let measured = measured.filter(|_| complete).or_else(|| {
            let settings = goal.verify.filter(|_| complete)?.of(&method);
            Some((settings, self.measure(view, &film.color, &settings, control, &mut stats)))
        });
        let verified = measured.map(|(settings, found)| {
            let found = found?;
            report::store_error(&found, &settings, &mut stats, &mut film.metadata);
            Some(report::error_facts(&found, &settings))
        });
        let unverified = matches!(verified, Some(None));
        let window = &view.window;
        let facts = json!({
            "scene": self.world.scene.name,
            "scene_hash": format!("{:016x}", self.hash),
            "method": method.name(),
            "settings": method.settings(),
            "threads": rayon::current_num_threads(),
            "window": { "film": window.film, "offset": window.offset, "size": [window.width, window.height] },
            "complete": complete,
            "nonfinite": nonfinite,
            "denoised": denoised_by,
            "standard_error": film.metadata.number("standard_error"),
            "relative_mse_of_noise": film.metadata.number("relative_mse_of_noise"),
            "verified": verified,
            "plan": plan,
        });
        Ok(Frame { film, method, stats, facts, remarks, complete, unverified })
    }

    /// States the scene, the method and its settings.
    fn describe(&self, method: &Method, metadata: &mut crate::film::Metadata) {
        metadata.set("version", env!("CARGO_PKG_VERSION"));
        metadata.set("scene", self.world.scene.name.as_str());
        metadata.set("scene_hash", format!("{:016x}", self.hash));
        metadata.set("method", method.name());
        metadata.set("settings", method.settings().to_string());
        metadata.set("spp", f64::from(method.spp()));
        metadata.set("seed", f64::from(method.seed()));
        metadata.set("threads", rayon::current_num_threads() as f64);
    }

    fn measure(
        &self,
        view: &View,
        image: &Image,
        settings: &verify::Settings,
        control: &Control,
        stats: &mut Stats,
    ) -> Option<Verified> {
        stats.time(Stage::Verify, || verify(&self.world, view, image, settings, control))
    }

    /// The finished picture by a method as it is set.
    fn as_set(
        &self,
        view: &View,
        method: Method,
        former: Former,
        finish: &Finish,
        control: &Control,
    ) -> Made {
        let watch = Stopwatch::start();
        let mut seconds = 0.0;
        let output = match former {
            Former::Frames(kept) => self.next_frame(view, &method, kept, finish, control),
            Former::Samples(begun) => {
                seconds += begun.seconds;
                let mut output = method.render_rest(&self.world, &self.lights, &begun, view, control);
                finish.apply(&method, &mut output);
                output
            }
            Former::Nothing => {
                let mut output = method.render(&self.world, &self.lights, view, control);
                finish.apply(&method, &mut output);
                output
            }
        };
        seconds += watch.elapsed().wall_seconds;
        Made { method, output, seconds, measured: None, plan: Value::Null }
    }

    /// The finished next picture of a walk-through.
    fn next_frame(
        &self,
        view: &View,
        method: &Method,
        kept: Kept,
        finish: &Finish,
        control: &Control,
    ) -> Output {
        let Kept { records, last } = kept;
        let draws = method.keeps_records() && method.leaves_noise();
        let Some(last) = last.filter(|_| draws && finish.denoises()) else {
            let before = Before { records, settled: Settled::default() };
            let mut output = method.render_next(&self.world, &self.lights, before, view, control);
            finish.apply(method, &mut output);
            return output;
        };
        let watch = Stopwatch::start();
        let seen = finish.look(method);
        let reprojected = last.reproject(view, &seen);
        let looking = watch.elapsed();
        let settled = reprojected.settled();
        let number = settled.pixels.iter().filter(|is_settled| **is_settled).count();
        let before = Before { records, settled };
        let mut output = method.render_next(&self.world, &self.lights, before, view, control);
        output.stats.add_time(Stage::EyePass, looking);
        output.stats.count("Walk/pixels settled", number as u64);
        reprojected.mix_into(&mut output.color, &seen);
        let is_denoised = finish.apply_to_seen(&seen, &mut output);
        last.replace(view, &seen, is_denoised.then_some(&output.color));
        output
    }

    /// The finished picture by settings planned for the goal.
    fn planned(
        &self,
        view: &View,
        goal: &Goal,
        finish: &Finish,
        control: &Control,
        stats: &mut Stats,
        remarks: &mut Vec<Remark>,
    ) -> Result<Made, FrameError> {
        let method = goal.method;
        let ladder = |held: &[&'static str]| {
            let ladder = Ladder::new(method, held).ok_or(FrameError::Unplannable(method.name()))?;
            Ok(ladder.within(&view.window))
        };
        match &goal.wanted {
            Wanted::AsSet => Ok(self.as_set(view, method, Former::Nothing, finish, control)),
            Wanted::Time { seconds, run, held } => {
                let asked = *seconds;
                let watch = Stopwatch::start();
                let finishing = finish.expected_seconds(&method);
                let left = || asked - finishing - run.elapsed().wall_seconds;
                let found = plan::for_time(&self.world, view, &ladder(held)?, left, control)
                    .ok_or(FrameError::Interrupted)?;
                let spent = found.spent();
                stats.add_time(Stage::Plan, watch.elapsed().without(spent));
                let before = run.elapsed().wall_seconds;
                let planned = before + found.render_seconds + finishing;
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
                let mut output = found.render(&self.world, view, control);
                finish.apply(&method, &mut output);
                let seconds = spent.wall_seconds + watch.elapsed().wall_seconds;
                Ok(Made { method, output, seconds, measured: None, plan })
            }
            Wanted::Error { error, max_samples, held } => {
                let (error, max_samples) = (*error, *max_samples);
                let measure = goal.verify.unwrap_or_default();
                let render = |method: &Method| {
                    let mut output = method.render(&self.world, &LightStore::default(), view, control);
                    finish.apply(method, &mut output);
                    output
                };
                let asked = plan::Asked { error, measure, most_samples: max_samples, render: &render };
                let watch = Stopwatch::start();
                let found = plan::for_error(&self.world, view, &ladder(held)?, &asked, control)
                    .ok_or(FrameError::Interrupted)?;
                stats.add_time(Stage::Plan, watch.elapsed().without(found.time));
                let got = found.verified.map(|v| v.relative_rms);
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
                let measured = Some((found.measure.of(&found.method), found.verified));
                let (method, output, seconds) = (found.method, found.output, found.time.wall_seconds);
                Ok(Made { method, output, seconds, measured, plan })
            }
        }
    }
}
