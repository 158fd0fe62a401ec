//! Facts about a frame, for the film's metadata and for programs.

use super::report;
use crate::method::Method;
use crate::verify::{Verified, VerifySettings};
use base::film::{Metadata, Window};
use serde_json::{Value, json};

/// Facts about a frame.
pub struct FrameReport<'a> {
    /// Name of the scene.
    pub scene: &'a str,
    /// Hash over the bytes of the scene's files.
    pub scene_hash: String,
    /// The method with the settings used.
    pub method: &'a Method,
    /// Window of the film.
    pub window: Window,
    /// False if the image is partial.
    pub complete: bool,
    /// True if the image is sharpened.
    pub sharpened: bool,
    /// Seconds that the image took to render.
    pub render_seconds: f64,
    /// Seconds since the start of the run.
    pub run_seconds: f64,
    /// Samples and channels that were not finite.
    pub nonfinite: u64,
    /// True if the image was to be denoised.
    pub denoises: bool,
    /// Denoiser that removed the noise, if one did.
    pub denoised_by: Option<String>,
    /// Goal, plan and result; null if nothing was planned.
    pub plan: Value,
}

impl FrameReport<'_> {
    /// Stores the facts in the metadata of a film.
    pub fn store(&self, metadata: &mut Metadata) {
        metadata.set("version", env!("CARGO_PKG_VERSION"));
        metadata.set("scene", self.scene);
        metadata.set("scene_hash", self.scene_hash.as_str());
        metadata.set("method", self.method.name());
        metadata.set("settings", self.method.settings().to_string());
        metadata.set("spp", f64::from(self.method.spp()));
        metadata.set("seed", f64::from(self.method.seed()));
        metadata.set("threads", rayon::current_num_threads() as f64);
        metadata.set("partial", if self.complete { "false" } else { "true" });
        if self.sharpened {
            metadata.set("sharpened", "true");
        }
        metadata.set("render_seconds", self.render_seconds);
        metadata.set("nonfinite", self.nonfinite as f64);
        if self.denoises {
            metadata.set("denoised", self.denoised_by.as_deref().unwrap_or("false"));
        }
        report::store_plan(&self.plan, self.run_seconds, metadata);
    }

    /// Returns the facts for programs, with the error estimates of `metadata` and the measured error.
    ///
    /// The measured error is null if nothing was measured, or if measuring was cancelled.
    pub fn json(&self, metadata: &Metadata, verified: Option<(&Verified, &VerifySettings)>) -> Value {
        let window = &self.window;
        json!({
            "scene": self.scene,
            "scene_hash": self.scene_hash,
            "method": self.method.name(),
            "settings": self.method.settings(),
            "threads": rayon::current_num_threads(),
            "window": { "film": window.film, "offset": window.offset, "size": [window.width, window.height] },
            "complete": self.complete,
            "nonfinite": self.nonfinite,
            "denoised": self.denoised_by,
            "standard_error": metadata.number("standard_error"),
            "relative_mse_of_noise": metadata.number("relative_mse_of_noise"),
            "verified": verified.map(|(found, settings)| report::error_facts(found, settings)),
            "plan": self.plan,
        })
    }
}
