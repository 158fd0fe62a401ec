//! Denoised images against references. Without the library the tests are skipped with a message.

use crate::kit::{frame, lacks_denoiser, own_path};
use lightsplat::film::metrics::{Variances, compare};
use lightsplat::method::{Method, path};
use lightsplat::readers::LoadOptions;
use lightsplat::session::Session;
use lightsplat::view::{Framing, View};

#[test]
fn few_paths_denoised_are_far_nearer_to_the_reference() {
    for (scene, factor) in [("cornell", 8.0), ("knot", 3.0)] {
        let session = Session::open(&own_path(scene), &LoadOptions::default()).unwrap().session;
        let framing = Framing { resolution: Some([64, 64]), ..Framing::default() };
        let view = View::new(&session.cameras, &framing).unwrap();
        let frame = |spp, seed, denoise| {
            let method = Method::Path(path::Settings { spp, seed, ..Default::default() });
            frame(&session, &view, method, denoise)
        };
        let clean = frame(4, 1, true);
        if lacks_denoiser(&clean) {
            return;
        }
        let reference = frame(256, 2, false).film.color;
        let noisy = frame(4, 1, false).film.color;
        let error = |image| compare(image, &reference, Variances::default()).unwrap().rel_mse_trimmed;
        let [noisy, clean] = [&noisy, &clean.film.color].map(error);
        assert!(factor * clean < noisy, "{scene}: {clean} and {noisy} without denoising");
    }
}
