//! Sessions and images over the small scenes of [`lightsplat::world::testkit`].
#![allow(dead_code, missing_docs)]

use lightsplat::film::Image;
use lightsplat::method::render;
use lightsplat::method::{LightStore, Output, Renderer, cache, lightcuts};
use lightsplat::progress::Control;
use lightsplat::readers::{LoadOptions, Loaded, load};
use lightsplat::scene::Cameras;
use lightsplat::session::{Frame, Remark, Session};
use lightsplat::stats::Stats;
use lightsplat::view::View;
pub use lightsplat::world::testkit::*;
use std::path::Path;

/// Loads a scene from a file, with the view of its still camera on a film of `resolution`, or of its own.
pub fn load_scene(path: &Path, resolution: Option<[u32; 2]>) -> SceneAndView {
    let Loaded { scene, cameras, .. } = load(path, &LoadOptions::default()).expect("the scene loads");
    let view = View::whole(cameras.still, resolution.unwrap_or(cameras.resolution));
    SceneAndView { scene, view }
}

/// A session over a scene, with its view.
pub fn session(SceneAndView { scene, view }: SceneAndView) -> (Session, View) {
    let cameras = Cameras { still: view.camera, path: Vec::new(), resolution: view.window.film, crop: None };
    let (warnings, repairs) = (Vec::new(), Default::default());
    let loaded = Loaded { scene, cameras, warnings, repairs, hash: 0, generator: None };
    (Session::of(loaded, Path::new("test"), Stats::new()).expect("the scene builds"), view)
}

/// True, with a line that says so, if a frame is noisy that was to be denoised: there is no library.
pub fn lacks_denoiser(frame: &Frame) -> bool {
    let warning = frame.remarks.iter().find(|remark| matches!(remark, Remark::Warning(_)));
    if let Some(warning) = warning {
        eprintln!("skipped: {warning:?}");
    }
    warning.is_some()
}

/// The picture by lightcuts per pixel over the same virtual lights, at a quarter of the default error.
pub fn per_pixel(world: &WorldAndView, like: &cache::Settings) -> Image {
    let mut settings =
        lightcuts::Settings { light: like.light, spp: like.spp, ..lightcuts::Settings::default() };
    (settings.cut.epsilon, settings.cut.max_cut, settings.cut.clamp) = (0.005, 10_000, like.cut.clamp);
    (settings.compensation, settings.seed) = (like.compensation, like.seed);
    render(world, &world.view, &settings, &Control::new()).color
}

/// Renders the picture by a method; it must be complete.
pub fn rendered(world: &WorldAndView, settings: &impl Renderer) -> Output {
    let output = settings.render(world, &LightStore::default(), &world.view, &Control::new());
    assert!(output.complete && output.nonfinite == 0);
    output
}
