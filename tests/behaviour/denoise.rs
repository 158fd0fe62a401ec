//! Denoised pictures against references; left out, saying so, where there is no library.

use crate::common::lacks_denoiser;
use lightsplat::film::metrics::{Variances, compare};
use lightsplat::method::{Method, path};
use lightsplat::progress::Control;
use lightsplat::readers::LoadOptions;
use lightsplat::session::{Frame, Goal, Session};
use lightsplat::view::{Framing, View};
use std::path::Path;

/// Paths through a scene of this repository.
fn frame(session: &Session, size: u32, spp: u32, seed: u32, denoise: bool) -> Frame {
    let framing = Framing { resolution: Some([size, size]), ..Framing::default() };
    let view = View::new(&session.cameras, &framing).unwrap();
    let method = Method::Path(path::Settings { spp, seed, ..Default::default() });
    session
        .frame(&view, &Goal { method, denoise: Some(denoise), ..Goal::default() }, &Control::new())
        .unwrap()
}

#[test]
fn few_paths_denoised_are_far_nearer_to_the_reference() {
    for (scene, factor) in [("cornell", 8.0), ("knot", 3.0)] {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("scenes/{scene}.toml"));
        let session = Session::open(&file, &LoadOptions::default()).unwrap();
        let clean = frame(&session, 64, 4, 1, true);
        if lacks_denoiser(&clean) {
            return;
        }
        let reference = frame(&session, 64, 256, 2, false).film.color;
        let noisy = frame(&session, 64, 4, 1, false).film.color;
        let error = |image| compare(image, &reference, Variances::default()).unwrap().rel_mse_trimmed;
        let [noisy, clean] = [&noisy, &clean.film.color].map(error);
        assert!(factor * clean < noisy, "{scene}: {clean} and {noisy} without denoising");
    }
}
