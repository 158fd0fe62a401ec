//! Images of groups at several places against images of copies: by paths, by the default method, and layer by layer.

use crate::kit::*;
use crate::oracle::{Estimate, assert_same_mean, on_threads, over_seeds};
use lightsplat::film::{Image, Pixels};
use lightsplat::math::Rgb;
use lightsplat::method::{LightStore, Method, path};
use lightsplat::progress::Control;
use lightsplat::readers::{LoadOptions, load};
use lightsplat::session::{Feature, Goal};
use lightsplat::view::View;
use std::collections::BTreeMap;

/// A room with pots of masked leaves: groups of groups, turned, stretched and mirrored. Faces of a ball are smooth.
const ROOM: &str = "resolution = [32, 24]\nmax_depth = 6\n\
    camera = { origin = [0, 1.2, 5.5], target = [0, -0.4, 0], fov = 60 }\n\
    light = [{ kind = \"point\", position = [1, 2.5, 3], intensity = [20, 18, 16] }]\n\
    environment = { radiance = 0.4 }\n\
    [[material]]\nname = \"clay\"\nkind = \"diffuse\"\nreflectance = [0.7, 0.4, 0.3]\n\
    [[material]]\nname = \"leaf\"\nkind = \"diffuse\"\nreflectance = [0.2, 0.6, 0.2]\nopacity = \"mask.png\"\n\
    [[material]]\nname = \"glaze\"\nkind = \"roughplastic\"\ndiffuse = [0.2, 0.3, 0.6]\nalpha = 0.2\n\
    [[mesh]]\nshape = \"rectangle\"\nmaterial = \"clay\"\n\
    transform = [{ scale = 6 }, { rotate = { axis = [1, 0, 0], angle = -90 } }, { translate = [0, -1, 0] }]\n\
    [[mesh]]\nshape = \"rectangle\"\nmaterial = \"clay\"\ntransform = [{ scale = 6 }, { translate = [0, 0, -3] }]\n\
    [[mesh]]\nshape = \"sphere\"\nmaterial = \"glaze\"\nmember_of = \"pot\"\n\
    transform = [{ scale = [0.5, 0.5, 0.5] }, { translate = [0, -0.5, 0] }]\n\
    [[mesh]]\nshape = \"rectangle\"\nmaterial = \"leaf\"\nmember_of = \"leaf\"\n\
    transform = [{ translate = [0, 1, 0] }, { scale = [0.2, 0.5, 1] }]\n\
    [[instance]]\ngroup = \"leaf\"\nmember_of = \"pot\"\nplaces = [\
    [1, 0, 0, 0, 0, 1, 0, -0.1, 0, 0, 1, 0], [0.5, 0, 0.8, 0.1, 0.3, 0.9, 0, -0.1, -0.8, 0.3, 0.5, 0.1], \
    [-0.7, 0.4, 0.7, -0.1, 0, 0.9, 0, -0.1, 0.6, 0.2, 0.7, 0]]\n\
    [[instance]]\ngroup = \"pot\"\ntransform = [{ translate = [-1.6, 0, 0.5] }]\n\
    [[instance]]\ngroup = \"pot\"\ntransform = [{ scale = [-1, 1.3, 1] }, \
    { rotate = { axis = [0, 1, 0], angle = 50 } }, { translate = [0.1, 0.3, -1] }]\n\
    [[instance]]\ngroup = \"pot\"\ntransform = [{ scale = [0.7, 1, 1.2] }, \
    { rotate = { axis = [0.2, 1, 0], angle = 170 } }, { translate = [1.5, 0, 0.8] }]\n";

/// The room with at most so many triangles copied.
fn room(most_copied: u64) -> WorldAndView {
    let folder = tempfile::tempdir().expect("a folder");
    let mask = image::GrayImage::from_fn(16, 16, |x, y| {
        let [u, v] = [x, y].map(|at| at as f32 / 7.5 - 1.0);
        image::Luma([if u * u + v * v < 1.0 { 255 } else { 0 }])
    });
    mask.save(folder.path().join("mask.png")).expect("the mask is written");
    let file = folder.path().join("room.toml");
    std::fs::write(&file, ROOM).expect("the scene is written");
    let options = LoadOptions { most_copied: Some(most_copied), strict: true, ..LoadOptions::default() };
    let loaded = load(&file, &options).unwrap_or_else(|e| panic!("{e}"));
    let view = View::whole(loaded.cameras.still, loaded.cameras.resolution);
    world(SceneAndView { scene: loaded.scene, view })
}

/// The image of a world by a method.
fn by(world: &WorldAndView, method: &Method) -> Image {
    let output = method.render(world, &LightStore::default(), &world.view, &Control::new());
    assert!(output.complete);
    output.color
}

/// Instances and copies.
fn both() -> [WorldAndView; 2] {
    let [instances, copies] = [room(0), room(u64::MAX)];
    let counts = |world: &WorldAndView| (world.scene.groups.len(), world.scene.meshes.len());
    assert_eq!((counts(&instances), counts(&copies)), ((2, 4), (0, 14)));
    [instances, copies]
}

#[test]
fn paths_see_instances_as_copies() {
    let [instances, copies] =
        both().map(|world| by_paths(&world, path::Settings { spp: 256, ..Default::default() }));
    assert_same_mean(&instances, &copies, "paths");
}

#[test]
fn the_default_sees_instances_as_copies() {
    let estimate = |world: &WorldAndView| -> Estimate {
        over_seeds(6, |seed| {
            let mut method = small_methods()[0].1;
            method.set("seed", &seed.to_string()).expect("a seed");
            by(world, &method)
        })
    };
    let [instances, copies] = both().map(|world| estimate(&world));
    let mean = |estimate: &Estimate| crate::oracle::mean(&estimate.mean);
    crate::oracle::assert_means_within(0.01, mean(&instances), mean(&copies), "the cache");
    crate::oracle::assert_rms_below(0.05, &instances.mean, &copies.mean, "the cache");
}

#[test]
fn instances_have_the_same_bits_on_any_number_of_threads() {
    let world = room(0);
    for (name, method) in small_methods() {
        let bits = |threads: usize| {
            let picture = on_threads(threads, || by(&world, &method));
            picture.pixels.iter().flat_map(|p: &Rgb| p.to_array().map(f32::to_bits)).collect::<Vec<u32>>()
        };
        let one = bits(1);
        assert!([2, 4].into_iter().all(|threads| bits(threads) == one), "{name}");
    }
}

#[test]
fn layers_of_instances_are_those_of_copies() {
    let films = [0, u64::MAX].map(|most| {
        let WorldAndView { world, view } = room(most);
        let (session, view) = session(SceneAndView { scene: world.scene, view });
        let method = Method::Path(path::Settings { spp: 64, ..Default::default() });
        let goal = Goal {
            method,
            denoise: Some(false),
            features: Feature::ALL.into_iter().collect(),
            ..Goal::default()
        };
        session.frame(&view, &goal, &Control::new()).expect("a frame").film
    });
    let [instances, copies] = &films;
    assert_eq!(instances.layers.len(), copies.layers.len());
    let mut compared = 0;
    for (one, other) in instances.layers.iter().zip(&copies.layers) {
        match (&one.pixels, &other.pixels) {
            (Pixels::Id(one), Pixels::Id(other)) => {
                // Numbers differ in their order alone.
                let mut names: BTreeMap<(u32, u32), u32> = BTreeMap::new();
                one.pixels
                    .iter()
                    .zip(&other.pixels)
                    .for_each(|pair| *names.entry((*pair.0, *pair.1)).or_default() += 1);
                let common = names.iter().filter(|(_, count)| **count > 2).map(|(pair, _)| *pair);
                let (ones, others): (Vec<u32>, Vec<u32>) = common.unzip();
                let distinct = |ids: &[u32]| ids.iter().collect::<std::collections::BTreeSet<_>>().len();
                assert!(distinct(&ones) == ones.len() && distinct(&others) == others.len(), "{names:?}");
                compared += ones.len();
            }
            _ => {
                let (Some(a), Some(b)) = (one.triples(), other.triples()) else { continue };
                let far =
                    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| (**a - **b).abs().max_element() > 0.05);
                assert!(far.count() < 8, "{}", one.name);
            }
        }
    }
    assert!(compared > 8, "{compared}");
}
