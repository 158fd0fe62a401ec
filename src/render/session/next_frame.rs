//! The next frame of a walk.

use super::context::FrameContext;
use super::former::{VisibleDifferences, WalkState};
use crate::method::{FormerFrames, Method, Output};
use base::stats::{Stage, Stopwatch};
use transport::eye::Settled;
use transport::reprojection::Reprojected;

/// Renders and finishes the next frame of a walk, and updates its state.
///
/// Methods without records render it as a frame of its own.
pub fn next_frame(context: &FrameContext, method: &Method, state: WalkState) -> Output {
    let FrameContext { world, lights, view, finish, control } = *context;
    let Some(walks) = method.as_walks() else {
        return finish.apply(method, method.render(world, lights, view, control));
    };
    let samples_light = method.leaves_noise();
    let WalkState { records, last, thresholds, outlook } = state;
    let last = last.filter(|_| samples_light && finish.denoises());
    let thresholds = thresholds.filter(|_| finish.denoises() || !samples_light);
    if last.is_none() && thresholds.is_none() {
        let former = FormerFrames { records, settled: Settled::default(), thresholds: None, outlook };
        return finish.apply(method, walks.render_next(world, lights, former, view, control));
    }
    let watch = Stopwatch::start();
    let seen = finish.look(method);
    let reprojected = last.as_ref().map(|last| last.reproject(view, &seen));
    let looking = watch.elapsed();
    let settled = reprojected.as_ref().map(Reprojected::settled).unwrap_or_default();
    let number = settled.pixels.iter().filter(|is_settled| **is_settled).count();
    let visible = thresholds.as_ref().map(|visible| &*visible.thresholds);
    let former = FormerFrames { records, settled, thresholds: visible, outlook };
    let mut output = walks.render_next(world, lights, former, view, control);
    output.stats.add_time(Stage::EyePass, looking);
    output.stats.count("Walk/pixels settled", number as u64);
    if let Some(reprojected) = reprojected {
        reprojected.mix_into(&mut output.color, &seen);
    }
    let mut output = finish.apply_to_seen(method, &seen, output);
    let is_denoised = matches!(output.denoised, Some(Ok(_)));
    if let Some(last) = last {
        last.replace(view, &seen, is_denoised.then_some(&output.color));
    }
    if let Some(VisibleDifferences { thresholds, q_scale }) = thresholds {
        let is_clean = output.complete && (is_denoised || !samples_light);
        thresholds.replace(q_scale, view, &seen, is_clean.then_some(&output.color));
    }
    finish.sharpen(&mut output);
    output
}
