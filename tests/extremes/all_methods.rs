//! Every method with settings for small films, and scenes written as text.

use crate::common::*;
use lightsplat::film::Image;
use lightsplat::math::luminance;
use lightsplat::method::{LightStore, Method, Output};
use lightsplat::progress::Control;

/// Methods and record modes by name, with settings for films of some hundred pixels.
pub fn all() -> [(&'static str, Method); 6] {
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
        ("drawn", of("cache", &[&cuts[..], &["least_cell 16", "spp 8"]].concat())),
        ("records", of("cache", &[&cuts[..], &records].concat())),
        ("reconstruction", of("reconstruction", &[&cuts[..], &["spp 2"]].concat())),
        ("lightcuts", of("lightcuts", &[&cuts[..], &["spp 1"]].concat())),
        ("photons", of("photon-cache", &[&cuts[1..], &photons].concat())),
        ("path", of("path", &["spp 64"])),
    ]
}

/// The picture by a method; it must be complete and finite.
#[track_caller]
pub fn picture(world: &WorldAndView, method: &Method) -> Image {
    let Output { color, complete, nonfinite, .. } =
        method.render(world, &LightStore::default(), &world.view, &Control::new());
    assert!(complete && nonfinite == 0, "{nonfinite} samples were not finite");
    color
}

/// Mean luminance.
pub fn mean(image: &Image) -> f32 {
    image.pixels.iter().map(|p| luminance(*p)).sum::<f32>() / image.pixels.len() as f32
}

/// A scene from TOML.
pub fn toml(text: &str) -> WorldAndView {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("scene.toml");
    std::fs::write(&file, text).expect("the scene is written");
    world(load_scene(&file, None))
}

/// A room of five units with a lamp and a camera in it, all lengths times `scale`.
pub fn room(scale: f64) -> String {
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
