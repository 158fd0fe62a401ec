//! A frame, from its goal to its facts.

use super::context::FrameContext;
use super::error::FrameError;
use super::finish::Finish;
use super::former::Former;
use super::frame::{self, Remark, RenderedFrame};
use super::frame_report::FrameReport;
use super::goal::Goal;
use super::notes::Notes;
use super::planned::{self, Made, Measurement};
use super::{Session, report};
use crate::method::path::PartialImage;
use crate::method::{Method, Output};
use crate::verify::verify;
use base::film::Image;
use base::progress::Control;
use base::stats::{Stage, Stats, Stopwatch, available_bytes};
use transport::eye::{Averaging, Feature};
use world::view::View;

impl Session {
    /// Renders the image of `view` for `goal`. A frame that was cancelled halfway is partial, not an error.
    ///
    /// # Errors
    /// If memory is too small, if the settings cannot be planned, or if cancelled before the first pixel.
    pub fn frame(&self, view: &View, goal: &Goal, control: &Control) -> Result<RenderedFrame, FrameError> {
        self.frame_from(view, goal, Former::Nothing, control)
    }

    /// Resumes an interrupted frame. The result has the bits of an uninterrupted one, unless its settings are planned.
    ///
    /// # Errors
    /// As [`Session::frame`].
    pub fn rest_of_frame(
        &self,
        view: &View,
        goal: &Goal,
        partial: PartialImage,
        control: &Control,
    ) -> Result<RenderedFrame, FrameError> {
        self.frame_from(view, goal, Former::Samples(partial), control)
    }

    /// Returns the approximate memory in bytes that an image takes beside the scene.
    ///
    /// # Errors
    /// If memory is too small.
    pub fn expected_memory(&self, view: &View, goal: &Goal) -> Result<u64, FrameError> {
        let needed = goal.method.expected_bytes(&view.window);
        match available_bytes().filter(|available| needed > *available) {
            Some(available) => {
                let [needed, available] = [needed, available].map(|bytes| bytes as f64 / f64::from(1 << 30));
                Err(FrameError::Memory { needed, available })
            }
            None => Ok(needed),
        }
    }

    /// Renders a frame that builds on `former` renders, if no settings are planned.
    pub(crate) fn frame_from(
        &self,
        view: &View,
        goal: &Goal,
        former: Former,
        control: &Control,
    ) -> Result<RenderedFrame, FrameError> {
        self.expected_memory(view, goal)?;
        let watch = Stopwatch::start();
        let mut notes = Notes::default();
        let (world, lights) = (&self.world, &self.lights);
        let finish = Finish::new(world, view, goal, control, &mut notes.stats);
        let context = FrameContext { world, lights, view, finish: &finish, control };
        let made = planned::image(&context, goal, former, &mut notes)?;
        let Made { method, output, seconds, measured, plan } = made;
        let Notes { mut stats, mut remarks } = notes;
        stats.merge(&output.stats);
        let complete = output.complete;
        remarks.extend(self.warnings(&method, &output, &finish));
        let denoised_by = finish.denoised_by(&output);
        let nonfinite_samples = output.nonfinite;
        let (mut film, nonfinite_channels) = frame::film(output, view, &world.scene);
        remarks.extend(nonfinite_warning(nonfinite_samples, "samples"));
        remarks.extend(nonfinite_warning(nonfinite_channels, "channels of the image"));
        let report = FrameReport {
            scene: &world.scene.name,
            scene_hash: format!("{:016x}", self.hash),
            method: &method,
            window: view.window,
            complete,
            sharpened: complete && view.camera.filter.sharpening() > 0.0,
            render_seconds: seconds,
            run_seconds: goal.run().unwrap_or(&watch).elapsed().wall_seconds,
            nonfinite: nonfinite_samples + nonfinite_channels,
            denoises: goal.denoises(),
            denoised_by,
            plan,
        };
        report.store(&mut film.metadata);
        if goal.averaging == Averaging::First {
            film.metadata.set("aov_mode", "first");
        }
        let masks = Feature::ALL.into_iter().filter(|feature| goal.features.contains(*feature));
        for (key, value) in masks.filter_map(Feature::masks).flat_map(|masks| masks.attributes(&world.scene))
        {
            film.metadata.set(&key, value);
        }
        let measure = || measure(&context, goal, &method, &film.color, &mut stats);
        let measured = if complete { measured.or_else(measure) } else { None };
        let measured_error = measured.as_ref().and_then(|m| Some((m.result.as_ref()?, &m.settings)));
        if let Some((error, settings)) = measured_error {
            report::store_error(error, settings, &mut stats, &mut film.metadata);
        }
        let facts = report.json(&film.metadata, measured_error);
        let measured_remarks = measured_error.map_or_else(Vec::new, |(error, _)| report::of_measured(error));
        let unverified = measured.is_some() && measured_error.is_none();
        Ok(RenderedFrame {
            film,
            method,
            stats,
            facts,
            remarks,
            measured: measured_remarks,
            complete,
            unverified,
        })
    }

    /// Returns the warnings about an image.
    fn warnings(&self, method: &Method, output: &Output, finish: &Finish) -> Vec<Remark> {
        let mut warnings = Vec::new();
        let dropped = output.work.dropped_branches;
        if dropped > 0 {
            warnings.push(format!(
                "{dropped} branches of eye paths were dropped, because too many mirrors and panes of glass follow each \
                 other: their light is missing"
            ));
        }
        let scene = &self.world.scene;
        if matches!(method, Method::Path(_)) && scene.focuses_lights() {
            warnings.push(frame::FOCUSED.to_owned());
        }
        let failure = output.denoised.as_ref().and_then(|denoised| denoised.as_ref().err());
        if let Some(error) = finish.load_error().or(failure) {
            warnings.push(format!("the image is not denoised: {error}"));
        }
        // Scenes without light have a warning of their own.
        if output.complete && !scene.is_dark() && output.color.is_black() {
            warnings.push(frame::black_warning(scene));
        }
        warnings.into_iter().map(Remark::Warning).collect()
    }
}

/// Measures the error of a complete image, if the goal asks for it.
fn measure(
    context: &FrameContext,
    goal: &Goal,
    method: &Method,
    image: &Image,
    stats: &mut Stats,
) -> Option<Measurement> {
    let FrameContext { world, view, control, .. } = *context;
    let settings = goal.verify?.with_samples_of(method);
    let result = stats.time(Stage::Verify, || verify(world, view, image, &settings, control));
    Some(Measurement { settings, result })
}

/// Warns of numbers that were not finite.
fn nonfinite_warning(number: u64, what: &str) -> Option<Remark> {
    (number > 0).then(|| {
        Remark::Warning(format!(
            "{number} {what} were NaN or infinite and count as 0; this is a defect, please report it"
        ))
    })
}
