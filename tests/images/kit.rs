//! Scenes of [`lightsplat::world::testkit`], of TOML and of files, sessions over them, and their images.

use lightsplat::film::Image;
use lightsplat::method::{LightStore, Method, Output, Renderer, path};
use lightsplat::progress::Control;
use lightsplat::readers::{LoadOptions, Loaded, load};
use lightsplat::scene::Cameras;
use lightsplat::session::{Goal, Remark, RenderedFrame, Session};
use lightsplat::view::View;
pub use lightsplat::world::testkit::*;
use std::path::{Path, PathBuf};

use crate::oracle::Estimate;

/// Loads a scene from a file, with the view of its still camera on a film of `resolution`, or of its own.
pub fn load_scene(path: &Path, resolution: Option<[u32; 2]>) -> SceneAndView {
    let Loaded { scene, cameras, .. } = load(path, &LoadOptions::default()).expect("the scene loads");
    let view = View::whole(cameras.still, resolution.unwrap_or(cameras.resolution));
    SceneAndView { scene, view }
}

/// Path of a scene of this repository.
pub fn own_path(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes").join(name).with_extension("toml")
}

/// A scene of this repository on a square film.
pub fn own(name: &str, size: u32) -> WorldAndView {
    world(load_scene(&own_path(name), Some([size; 2])))
}

/// A scene of TOML.
pub fn toml(text: &str) -> WorldAndView {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, text).expect("the scene is written");
    world(load_scene(&file, None))
}

/// TOML of a room of five units with a lamp and a camera in it, all lengths times `scale`.
pub fn room_file(scale: f64) -> String {
    let mut text = format!(
        "resolution = [16, 16]\n[camera]\norigin = [{:e}, {:e}, {:e}]\ntarget = [0, 0, 0]\nfov = 70\n\
         [[material]]\nname = \"wall\"\nkind = \"diffuse\"\nreflectance = [0.6, 0.5, 0.4]\n\
         [[mesh]]\nshape = \"rectangle\"\nmaterial = \"wall\"\nemission = [8, 7, 6]\n\
         transform = [{{ scale = 0.7 }}, {{ rotate = {{ axis = [1, 0, 0], angle = 90 }} }}, \
         {{ translate = [0, 2.4, 0] }}, {{ scale = {scale:e} }}]\n\
         [[mesh]]\nshape = \"sphere\"\nmaterial = \"wall\"\n\
         transform = [{{ translate = [0.5, -1.5, -0.5] }}, {{ scale = {scale:e} }}]\n",
        0.3 * scale,
        0.4 * scale,
        2.3 * scale,
    );
    for turn in ["[0, 1, 0], angle = 0", "[0, 1, 0], angle = 90", "[0, 1, 0], angle = -90"]
        .into_iter()
        .chain(["[0, 1, 0], angle = 180", "[1, 0, 0], angle = 90", "[1, 0, 0], angle = -90"])
    {
        text += &format!(
            "[[mesh]]\nshape = \"rectangle\"\nmaterial = \"wall\"\ntransform = [{{ scale = 2.5 }}, \
             {{ translate = [0, 0, -2.5] }}, {{ rotate = {{ axis = {turn} }} }}, {{ scale = {scale:e} }}]\n"
        );
    }
    text
}

/// A session over a scene, with its view.
pub fn session(SceneAndView { scene, view }: SceneAndView) -> (Session, View) {
    let cameras = Cameras { still: view.camera, path: Vec::new(), resolution: view.window.film, crop: None };
    (Session::of(scene, cameras).expect("the scene builds"), view)
}

/// The frame of a view by a method as it is set, denoised or not.
pub fn frame(session: &Session, view: &View, method: Method, denoise: bool) -> RenderedFrame {
    let goal = Goal { method, denoise: Some(denoise), ..Goal::default() };
    session.frame(view, &goal, &Control::new()).expect("a frame")
}

/// True, with a line that says so, if a frame that was to be denoised is noisy since there is no library.
pub fn lacks_denoiser(frame: &RenderedFrame) -> bool {
    let warning = frame.remarks.iter().find(|remark| matches!(remark, Remark::Warning(_)));
    if let Some(warning) = warning {
        eprintln!("skipped: {warning:?}");
    }
    warning.is_some()
}

/// Renders the view of a world by a method. The image must be complete and finite.
#[track_caller]
pub fn rendered<R: Renderer + ?Sized>(world: &WorldAndView, settings: &R) -> Output {
    rendered_view(world, &world.view, settings)
}

/// Renders any view of a world. The image must be complete and finite.
#[track_caller]
pub fn rendered_view<R: Renderer + ?Sized>(world: &WorldAndView, view: &View, settings: &R) -> Output {
    let output = settings.render(world, &LightStore::default(), view, &Control::new());
    assert!(output.complete, "the image is not complete");
    assert_eq!(output.nonfinite, 0, "samples are not finite");
    output
}

/// The image of a world by a method. It must be complete and finite.
#[track_caller]
pub fn image<R: Renderer + ?Sized>(world: &WorldAndView, settings: &R) -> Image {
    rendered(world, settings).color
}

/// The path tracer's image and its variance.
pub fn by_paths(world: &WorldAndView, settings: path::Settings) -> Estimate {
    let output = rendered(world, &settings);
    Estimate { mean: output.color, variance: output.variance.expect("more than one sample") }
}

/// Methods and record modes by name, with settings for films of some hundred pixels.
pub fn small_methods() -> [(&'static str, Method); 6] {
    let cuts = ["vpls 3000", "direct_vpls 512"];
    let records = ["direct records", "indirect records", "least_cell 16", "spp 2"];
    let photons = ["photons 10000", "gather_rays 64", "least_cell 16", "spp 2"];
    let of = |name: &str, settings: &[&str]| {
        let mut method = Method::named(name).expect("a method");
        for setting in settings {
            let (key, value) = setting.split_once(' ').expect("a key and a value");
            assert_eq!(method.set(key, value), Ok(true), "{name} {setting}");
        }
        method
    };
    [
        ("cache", of("cache", &[&cuts[..], &["least_cell 16", "spp 8"]].concat())),
        ("records", of("cache", &[&cuts[..], &records].concat())),
        ("reconstruction", of("reconstruction", &[&cuts[..], &["spp 2"]].concat())),
        ("lightcuts", of("lightcuts", &[&cuts[..], &["spp 1"]].concat())),
        ("photons", of("photon-cache", &[&cuts[1..], &photons].concat())),
        ("path", of("path", &["spp 64"])),
    ]
}
