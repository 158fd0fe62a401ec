//! A frame, from its goal to its facts.

use super::finish::Finish;
use super::frame::{self, Frame, Remark};
use super::goal::{Goal, Wanted};
use super::planned::{Made, Planning};
use super::{Session, report};
use crate::method::Method;
use crate::method::RetainedRecords;
use crate::method::path::Begun;
use crate::verify::{self, Verified, verify};
use base::film::Image;
use base::progress::Control;
use base::stats::{Counter, Stage, Stats, Stopwatch, available_bytes};
use serde_json::json;
use transport::eye::DROPPED_BRANCHES;
use transport::perception::Thresholds;
use transport::reprojection::PreviousImage;
use world::view::View;

/// Reason why there is no frame.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum FrameError {
    /// Rendering was cancelled before there was anything to keep.
    #[error("interrupted before the first pixel; nothing is written")]
    Interrupted,
    /// Rendering was cancelled before its settings were planned.
    #[error("interrupted while planning; nothing is written")]
    Unplanned,
    /// The frame needs more memory than there is.
    #[error(
        "the picture would take about {needed:.2} GiB, and {available:.2} GiB of memory are available: take fewer \
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
pub struct Kept<'a> {
    /// Records.
    pub records: &'a mut RetainedRecords,
    /// The picture before, if drawn light is to be carried over from it.
    pub last: Option<&'a mut PreviousImage>,
    /// Differences that are seen in the picture before, and the quantisation scale, if they are to be used.
    pub thresholds: Option<(&'a mut Thresholds, f32)>,
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
        let planning = Planning { session: self, view, finish: &finish, control };
        let made = planning.picture(goal, former, &mut stats, &mut remarks)?;
        let Made { method, output, seconds, measured, plan } = made;
        stats.merge(&output.stats);
        if let Some(Counter::Count(dropped @ 1..)) = stats.get(DROPPED_BRANCHES) {
            remarks.push(Remark::Warning(format!(
                "{dropped} branches of eye paths were dropped, because too many mirrors and panes of glass follow each \
                 other: their light is missing"
            )));
        }
        if matches!(method, Method::Path(_)) && self.world.scene.focuses_lights() {
            remarks.push(Remark::Warning(frame::FOCUSED.to_owned()));
        }
        if let Some(error) = finish.failure() {
            remarks.push(Remark::Warning(format!("the picture is not denoised: {error}")));
        }

        let complete = output.complete;
        // Of a scene without light, people have been warned.
        if complete && !self.world.scene.is_dark() && output.color.is_black() {
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
        if complete && view.camera.filter.sharpening() > 0.0 {
            film.metadata.set("sharpened", "true");
        }
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
        let mut measured_remarks = Vec::new();
        let verified = measured.map(|(settings, found)| {
            let found = found?;
            measured_remarks = report::of_measured(&found);
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
        Ok(Frame { film, method, stats, facts, remarks, measured: measured_remarks, complete, unverified })
    }

    /// States the scene, the method and its settings.
    fn describe(&self, method: &Method, metadata: &mut base::film::Metadata) {
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
}
