//! Methods with settings, to be rendered and judged.

use render::method::{Method, path, reconstruction};
use render::plan::{DRAFT, FINAL, Ladder, PREVIEW, REFERENCE, options};
use transport::paths::Estimand;

/// Samples a pixel of denoised paths that make their curve.
pub const DENOISED_SPP: [u32; 5] = [1, 4, 16, 64, 256];

/// A method with settings, under a label.
#[derive(Clone)]
pub struct Candidate {
    /// Label of the row or point.
    pub label: String,
    /// Method and settings.
    pub method: Method,
    /// True if its picture is denoised.
    pub denoise: bool,
    /// Frames of a walk-through that ends at the picture, which is its last; `None` for a picture alone.
    pub walk: Option<usize>,
}

impl Candidate {
    /// A method under a label, denoised if its pictures are meant to be.
    pub fn new(label: impl Into<String>, method: Method) -> Candidate {
        Candidate { label: label.into(), denoise: method.leaves_noise(), method, walk: None }
    }

    /// A walk-through of so many frames by a method that keeps records.
    pub fn walk(label: impl Into<String>, method: Method, frames: usize) -> Candidate {
        Candidate { walk: Some(frames), ..Candidate::new(label, method) }
    }

    /// The path tracer of a number of samples a pixel, denoised.
    pub fn denoised_path(label: impl Into<String>, spp: u32) -> Candidate {
        let method = Method::Path(path::Settings { spp, ..path::Settings::default() });
        Candidate { denoise: true, ..Candidate::new(label, method) }
    }
}

/// Returns the default method at the named levels of the quality scale, with its options.
pub fn qualities() -> impl Iterator<Item = (Candidate, String)> {
    let ladder = Ladder::new(Method::default(), &[]);
    let named = [("draft", DRAFT), ("preview", PREVIEW), ("final", FINAL), ("reference", REFERENCE)];
    ladder.into_iter().flat_map(move |ladder| {
        named.map(|(name, height)| {
            let method = ladder.at(height);
            (Candidate::new(name, method), options(&method))
        })
    })
}

/// Returns the positions of the samples of methods that keep eye samples: those of reconstruction cuts.
pub fn eye_samples() -> Estimand {
    let reconstruction::Settings { spp, seed, .. } = reconstruction::Settings::default();
    Estimand::EyeSamples { spp, seed }
}
