//! Emitters that are not there everywhere, as files describe them: seen, they shine as much as they are there.

use crate::kit::*;
use crate::oracle::{assert_means_within, mean};
use glam::{DVec3, Vec2, Vec3};
use lightsplat::math::Rgb;
use lightsplat::method::path;
use lightsplat::scene::{DeltaLight, Environment, Filter, Material, Scene, Share, Texture};

/// Loads the first of some files, all of them in one folder.
fn files(files: &[(&str, &str)]) -> WorldAndView {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("the file is written");
    }
    world(load_scene(&folder.path().join(files[0].0), None))
}

/// Scene file of a camera that sees nothing but a square.
const CAMERA: &str = "resolution = [4, 4]\ncamera = { origin = [0, 0, 5], target = [0, 0, 0], film_width = 1 }\n\
    environment = { radiance = 0.5 }\n";

#[test]
fn what_is_not_there_shines_in_no_format() {
    let toml = |opacity: f32| {
        format!(
            "{CAMERA}material = [{{ name = \"m\", kind = \"diffuse\", reflectance = 0, opacity = {opacity} }}]\n\
             mesh = [{{ shape = \"rectangle\", material = \"m\", emission = 8 }}]"
        )
    };
    let obj = "mtllib s.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nusemtl m\nf 1 2 3 4\n";
    let of_obj = format!("{CAMERA}mesh = [{{ file = \"s.obj\" }}]");
    let mtl = |d: f32| format!("newmtl m\nKd 0 0 0\nKe 8 8 8\nd {d}\n");
    let xml = |opacity: f32| {
        format!(
            "<scene version=\"3.0.0\"><sensor type=\"orthographic\"><transform name=\"to_world\">\
             <scale value=\"0.5\"/><lookat origin=\"0,0,5\" target=\"0,0,0\" up=\"0,1,0\"/></transform>\
             <film type=\"hdrfilm\"><integer name=\"width\" value=\"4\"/><integer name=\"height\" value=\"4\"/>\
             <rfilter type=\"box\"/></film></sensor>\
             <emitter type=\"constant\"><rgb name=\"radiance\" value=\"0.5\"/></emitter>\
             <shape type=\"rectangle\"><bsdf type=\"mask\"><float name=\"opacity\" value=\"{opacity}\"/>\
             <bsdf type=\"diffuse\"><rgb name=\"reflectance\" value=\"0\"/></bsdf></bsdf>\
             <emitter type=\"area\"><rgb name=\"radiance\" value=\"8\"/></emitter></shape></scene>"
        )
    };
    for opacity in [0.0, 0.25, 1.0] {
        let worlds = [
            ("TOML", files(&[("s.toml", &toml(opacity))])),
            ("MTL", files(&[("s.toml", &of_obj), ("s.obj", obj), ("s.mtl", &mtl(opacity))])),
            ("Mitsuba", files(&[("s.xml", &xml(opacity))])),
        ];
        for (format, world) in &worlds {
            let expected = DVec3::splat(f64::from(8.0 * opacity + 0.5 * (1.0 - opacity)));
            let found = mean(&image(world, &path::Settings { spp: 256, ..Default::default() }));
            assert_means_within(0.01, found, expected, &format!("{format}, opacity {opacity}"));
            assert_eq!(world.emitters.areas.len(), usize::from(opacity > 0.0), "{format}");
        }
    }
}

/// Returns a sign before the eye, whose mask is a ramp with these filters.
fn sign(filter: Filter) -> WorldAndView {
    let mut scene = scene(camera(Vec3::Z, Vec3::ZERO, 0.5), [64, 4]);
    let mask = Texture { filter, ..texture(2, &[Rgb::ZERO, Rgb::ONE]) };
    let texture = add_texture(&mut scene, mask);
    let opacity = Some(Share::Textured { texture, scale: 1.0 });
    let material = add_material(&mut scene, Material { opacity, ..diffuse(Rgb::ZERO) });
    let square = quad(Vec3::new(-0.5, -0.5, 0.0), Vec3::X, Vec3::Y, material);
    // The film shows u from 1/4 to 3/4: alpha from 0 to 1.
    let uvs = [[0.25, 0.0], [0.75, 0.0], [0.75, 1.0], [0.25, 1.0]].map(Vec2::from).to_vec();
    scene.meshes.push(emitting(lightsplat::scene::Mesh { uvs, ..square }, Rgb::splat(3.0)));
    scene.environment = Some(Environment::Constant(Rgb::ONE));
    world(scene)
}

#[test]
fn seen_masks_are_sharp_and_blends_are_smooth() {
    let column = |filter: Filter| {
        let picture = image(&sign(filter), &path::Settings { spp: 1024, ..Default::default() });
        (0..64).map(|x| picture.pixels[x].x).collect::<Vec<f32>>()
    };
    let (blend, cut) = (column(Filter::Bilinear), column(Filter::Cut(0.75)));
    for x in 0..64 {
        let alpha = (x as f32 + 0.5) / 64.0;
        let expected = 1.0 + 2.0 * alpha;
        assert!((blend[x] - expected).abs() < 0.15, "{x}: {} for {expected}", blend[x]);
        // The border lies between two pixels.
        assert_eq!(cut[x], if alpha > 0.75 { 3.0 } else { 1.0 }, "{x}");
    }
}

/// Returns what an eye over the middle of a floor sees that lies under a horizontal mask.
fn under_a_mask(height: f32, max_depth: u32, add_light: impl Fn(&mut Scene)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, height, 0.01), Vec3::ZERO, 1e-3), [8, 8]);
    scene.max_depth = Some(max_depth);
    let floor = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    let mask = Material { opacity: Some(Share::Constant(0.5)), two_sided: true, ..diffuse(Rgb::ZERO) };
    let mask = add_material(&mut scene, mask);
    for (y, material) in [(0.0, floor), (1.0, mask)] {
        scene.meshes.push(quad(Vec3::new(-5.0, y, -5.0), Vec3::Z * 10.0, Vec3::X * 10.0, material));
    }
    add_light(&mut scene);
    world(scene)
}

#[test]
fn masks_that_light_passes_count_as_edges() {
    let methods = small_methods();
    // The eye is below the mask or above it. Light from above has one edge less to the eye below.
    for (height, max_depth, expected) in [(0.5, 2, 0.0), (0.5, 3, 0.5), (2.0, 3, 0.0), (2.0, 4, 0.25)] {
        let irradiance = Rgb::splat(2.0 * std::f32::consts::PI);
        let world = under_a_mask(height, max_depth, |scene| {
            scene.lights.push(DeltaLight::Directional { direction: Vec3::NEG_Y, irradiance });
        });
        for (name, method) in &methods {
            let found = mean(&image(&world, method.renderer()));
            let what = format!("{name}, at most {max_depth} edges, eye at {height}");
            assert!((found - DVec3::splat(expected)).abs().max_element() < 0.04, "{what}: {found}");
        }
    }
}

#[test]
fn masks_that_indirect_light_passes_count_as_edges() {
    let mut methods = small_methods();
    // One path in thousands finds the spot of light.
    const PATHS: u32 = 4096;
    methods.iter_mut().filter(|(name, _)| *name == "path").for_each(|(_, method)| method.set_spp(PATHS));
    for (height, max_depth) in [(0.5, 3), (0.5, 4), (2.0, 4), (2.0, 5)] {
        // Light of a ceiling that a lamp over the mask lights.
        let world = under_a_mask(height, max_depth, |scene| {
            let ceiling = add_material(scene, diffuse(Rgb::ONE));
            let corner = Vec3::new(-5.0, 4.0, -5.0);
            scene.meshes.push(quad(corner, Vec3::X * 10.0, Vec3::Z * 10.0, ceiling));
            let (position, direction) = (Vec3::Y * 3.0, Vec3::Y);
            let [inner_angle, outer_angle] = [0.7, 0.8];
            let intensity = Rgb::splat(100.0);
            scene.lights.push(DeltaLight::Spot {
                position,
                direction,
                intensity,
                inner_angle,
                outer_angle,
                image: None,
            });
        });
        let expected = mean(&image(&world, &path::Settings { spp: PATHS, seed: 1, ..Default::default() }));
        assert_eq!(expected == DVec3::ZERO, max_depth == if height < 1.0 { 3 } else { 4 });
        for (name, method) in &methods {
            let found = mean(&image(&world, method.renderer()));
            let what = format!("{name}, at most {max_depth} edges, eye at {height}");
            let error = (found - expected).abs().max_element();
            assert!(error <= 0.1 * expected.max_element(), "{what}: {found}, not {expected}");
        }
    }
}
