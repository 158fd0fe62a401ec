//! Light that reaches visible surfaces through glass and over mirrors: all methods against path tracing.

use crate::kit::*;
use crate::oracle::{Estimate, assert_means_within, mean, sum};
use crate::presets::with_lights_over;
use glam::{DVec3, Vec2, Vec3};
use lightsplat::math::Rgb;
use lightsplat::method::{Renderer, path, vpl};
use lightsplat::scene::{DeltaLight, Distribution, Environment, Lobe, Material, MaterialId, Mesh, Parameter};

/// A room seen from inside, dark but for what comes through a hole in its wall towards +x, from a lamp in another room.
pub(crate) fn two_rooms(add: impl FnOnce(&mut SceneAndView)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.5, 0.1, 0.9), Vec3::new(-0.4, -0.3, -0.6), 0.9), [16, 16]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.6, 0.5)));
    let is_between = |mesh: &Mesh, x: f32| mesh.positions.iter().all(|p| p.x == x);
    for (low, high, open) in [(-1.0, 1.0, 1.0), (1.2, 2.2, 1.2)] {
        let walls = room(Vec3::new(low, -1.0, -1.0), Vec3::new(high, 1.0, 1.0), wall);
        scene.meshes.extend(walls.into_iter().filter(|mesh| !is_between(mesh, open)));
    }
    // The wall between them, about the hole.
    let (y, z) = (Vec3::Y, Vec3::Z);
    for (y0, y1, z0, z1) in
        [(-1.0, 1.0, -1.0, -0.6), (-1.0, 1.0, 0.5, 1.0), (-1.0, -0.3, -0.6, 0.5), (0.7, 1.0, -0.6, 0.5)]
    {
        for x in [1.0, 1.2] {
            scene.meshes.push(quad(Vec3::new(x, y0, z0), y * (y1 - y0), z * (z1 - z0), wall));
        }
    }
    let black = add_material(&mut scene, diffuse(Rgb::ZERO));
    // Paths find it in the end, as it covers the ceiling.
    let lamp = quad(Vec3::new(1.25, 0.95, -0.95), Vec3::X * 0.9, Vec3::Z * 1.9, black);
    scene.meshes.push(emitting(lamp, Rgb::new(12.0, 10.0, 8.0)));
    add(&mut scene);
    world(scene)
}

/// A sheet over the hole.
fn sheet(scene: &mut SceneAndView, x: f32, material: Material) {
    let material = add_material(scene, material);
    let corner = Vec3::new(x, -0.35, -0.65);
    scene.meshes.push(quad(corner, Vec3::Y * 1.1, Vec3::Z * 1.2, material));
}

/// A closed room with a ball and a small lamp.
pub(crate) fn lamp_room(add: impl Fn(&mut SceneAndView)) -> WorldAndView {
    let mut scene = scene(room_camera(), [16, 16]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.6, 0.5, 0.4)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    scene.meshes.push(sphere(Vec3::new(-0.4, -0.7, -0.2), 0.3, 24, wall));
    add(&mut scene);
    world(scene)
}

/// A lamp in a shell of glass.
pub(crate) fn bulb(scene: &mut SceneAndView) {
    let (material, black) = (add_material(scene, glass(1.5)), add_material(scene, diffuse(Rgb::ZERO)));
    let centre = Vec3::new(0.3, 0.3, -0.2);
    let mut inside = sphere(centre, 0.27, 24, material);
    inside.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
    inside.normals.iter_mut().for_each(|normal| *normal = -*normal);
    scene.meshes.extend([sphere(centre, 0.3, 24, material), inside]);
    scene.meshes.push(emitting(sphere(centre, 0.2, 24, black), Rgb::new(3.6, 3.2, 2.4)));
}

/// A lamp that shines upon a mirror alone.
fn spotlight(scene: &mut SceneAndView) {
    let (material, black) = (add_material(scene, mirror()), add_material(scene, diffuse(Rgb::ZERO)));
    let corner = Vec3::new(-0.5, 0.95, -0.9);
    scene.meshes.push(quad(corner, Vec3::X, Vec3::Z, material));
    let lamp = quad(Vec3::new(-0.25, 0.4, -0.65), Vec3::Z * 0.5, Vec3::X * 0.5, black);
    scene.meshes.push(emitting(lamp, Rgb::new(9.0, 8.0, 6.0)));
}

/// Relative difference of means that the noise of these images explains.
pub(crate) const NOISE: f64 = 0.02;

/// Samples per pixel for so many samples of the whole image.
fn spp_of(world: &WorldAndView, samples: u32) -> u32 {
    samples / world.view.window.pixel_count() as u32
}

/// Mean of the image by a method.
pub(crate) fn mean_by(world: &WorldAndView, settings: &impl Renderer) -> DVec3 {
    mean(&image(world, settings))
}

/// Mean of the image by paths, which seldom find lamps behind glass.
pub(crate) fn by_paths(world: &WorldAndView) -> DVec3 {
    by_so_many_paths(world, 1 << 18)
}

/// Mean of the image by so many paths in all. Its standard error is half of [`NOISE`] at most.
pub(crate) fn by_so_many_paths(world: &WorldAndView, paths: u32) -> DVec3 {
    let settings = path::Settings { spp: spp_of(world, paths), ..Default::default() };
    let Estimate { mean: image, variance } = crate::kit::by_paths(world, settings);
    let error = (mean(&variance) / variance.pixels.len() as f64).map(f64::sqrt) / mean(&image);
    assert!(error.max_element() < 0.5 * NOISE, "standard error of {paths} paths: {error}");
    mean(&image)
}

/// Mean of the default's images over some seeds.
///
/// Few virtual lights count behind a coloured pane. They scatter the mean of one seed by a per cent.
pub(crate) fn by_default(world: &WorldAndView) -> DVec3 {
    const SEEDS: u32 = 4;
    let spp = spp_of(world, (1 << 17) / SEEDS);
    let settings = vpl::Settings { spp, ..with_lights_over(SEEDS, vpl::Settings::cache()) };
    let of_seed = |seed| mean_by(world, &vpl::Settings { seed, ..settings });
    (0..SEEDS).map(of_seed).sum::<DVec3>() / f64::from(SEEDS)
}

/// A solid pane in the hole.
pub(crate) fn solid_pane(scene: &mut SceneAndView) {
    let material = add_material(scene, glass(1.5));
    for mut side in room(Vec3::new(1.05, -0.35, -0.65), Vec3::new(1.1, 0.75, 0.55), material) {
        side.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
        scene.meshes.push(side);
    }
}

/// A frosted one.
pub(crate) fn frosted_pane(scene: &mut SceneAndView) {
    solid_pane(scene);
    let white = Parameter::Constant(Rgb::ONE);
    let lobe = Lobe::RoughDielectric {
        distribution: Distribution::Ggx,
        alpha: 0.3.into(),
        eta: 1.5,
        reflectance: white,
        transmittance: white,
    };
    let pane = scene.materials.last_mut().expect("that of the pane");
    *pane = Material { lobes: vec![lobe], ..diffuse(Rgb::ZERO) };
}

/// Two thin panes in the hole.
fn thin_panes(scene: &mut SceneAndView) {
    sheet(scene, 1.1, pane(1.5, Rgb::new(0.9, 0.6, 0.3)));
    sheet(scene, 1.15, pane(1.3, Rgb::ONE));
}

/// A curtain of holes, dark threads and veils in the hole.
fn curtain(scene: &mut SceneAndView) {
    let checker = checkered(scene, 2, vec![Rgb::ZERO, Rgb::ONE, Rgb::splat(0.4), Rgb::ZERO]);
    let Parameter::Textured { texture, .. } = checker.diffuse else { unreachable!("it is textured") };
    let opacity = Some(Parameter::Textured { texture, scale: 1.0 });
    sheet(scene, 1.1, Material { opacity, ..diffuse(Rgb::new(0.6, 0.3, 0.2)) });
    let hung = scene.meshes.pop().expect("a sheet");
    scene.meshes.push(textured(hung, Vec2::splat(3.0)));
}

fn worlds() -> [(WorldAndView, &'static str); 6] {
    [
        (two_rooms(frosted_pane), "frosted pane"),
        (two_rooms(solid_pane), "solid pane"),
        (two_rooms(thin_panes), "thin panes"),
        (two_rooms(curtain), "curtain"),
        (lamp_room(bulb), "bulb"),
        (lamp_room(spotlight), "mirror"),
    ]
}

#[test]
fn light_comes_through_panes_and_bulbs() {
    let [_, solid_pane, _, curtain, bulb, _] = worlds();
    for (world, what) in &[solid_pane, curtain, bulb] {
        assert_means_within(NOISE, by_default(world), by_so_many_paths(world, 1 << 19), what);
    }
}

/// A sun that shines through the hole.
fn sun(scene: &mut SceneAndView) {
    scene.meshes.retain(|mesh| !mesh.positions.iter().all(|p| p.x == 2.2) && mesh.emission.is_none());
    let direction = Vec3::new(-1.0, -0.4, -0.1).normalize();
    scene.lights.push(DeltaLight::Directional { direction, irradiance: Rgb::new(9.0, 8.0, 7.0) });
}

#[test]
fn the_sun_comes_through_a_solid_pane_as_through_a_thin_one() {
    let lit = |pane: &dyn Fn(&mut SceneAndView)| {
        two_rooms(|scene| {
            pane(scene);
            sun(scene);
        })
    };
    let (solid, thin) = (lit(&solid_pane), lit(&|scene| sheet(scene, 1.1, pane(1.5, Rgb::ONE))));
    assert_means_within(0.03, by_default(&solid), by_default(&thin), "sun through a solid pane");
}

/// A ball of glass before a lamp.
fn lens(scene: &mut SceneAndView) {
    let material = add_material(scene, glass(1.5));
    scene.meshes.push(sphere(Vec3::new(0.2, -0.2, 0.0), 0.3, 48, material));
}

#[test]
fn a_point_of_light_shines_through_a_ball_as_a_small_lamp_does() {
    const RADIUS: f32 = 0.05;
    let position = Vec3::new(0.2, 0.6, 0.0);
    let radiance = Rgb::new(9.0, 8.0, 6.0);
    let lamp = lamp_room(|scene| {
        lens(scene);
        let black = add_material(scene, diffuse(Rgb::ZERO));
        scene.meshes.push(emitting(sphere(position, RADIUS, 48, black), radiance));
    });
    let point = lamp_room(|scene| {
        lens(scene);
        let intensity = radiance * (std::f32::consts::PI * RADIUS * RADIUS);
        scene.lights.push(DeltaLight::Point { position, intensity });
    });
    let stats = rendered(&point, &vpl::Settings { spp: 4, ..vpl::Settings::cache() }).stats;
    let percent = sum(&stats, "Light/by photons through glass or by mirrors [%]");
    assert!(percent.is_some_and(|percent| percent > 1.0 && percent < 50.0), "{percent:?}");
    let found = by_default(&point);
    let of_lamp = by_default(&lamp);
    assert_means_within(NOISE, found, of_lamp, "a point of light and a small lamp");
    assert_means_within(NOISE, of_lamp, by_so_many_paths(&lamp, 1 << 20), "a small lamp");
}

#[test]
fn sheets_that_do_nothing_are_as_if_they_were_not_there() {
    for with_sun in [false, true] {
        let light = |scene: &mut SceneAndView| {
            if with_sun {
                sun(scene);
            }
        };
        let open = two_rooms(light);
        let hung = two_rooms(|scene| {
            light(scene);
            sheet(scene, 1.1, glass(1.0));
            sheet(scene, 1.12, Material { opacity: Some(0.0.into()), ..diffuse(Rgb::ONE) });
        });
        let exact = by_paths(&open);
        assert_means_within(NOISE, by_paths(&hung), exact, "paths");
        assert_means_within(NOISE, by_default(&hung), exact, "default");
    }
}

#[test]
fn the_sun_comes_through_a_thin_pane_by_its_transmittance() {
    // One bounce: the light that comes straight in.
    let direct = |scene: &mut SceneAndView| {
        sun(scene);
        let black = MaterialId(1);
        let outside = |mesh: &&mut Mesh| mesh.positions.iter().all(|p| p.x >= 1.0);
        scene.meshes.iter_mut().filter(outside).for_each(|mesh| mesh.material = black);
    };
    let open = two_rooms(direct);
    let hung = two_rooms(|scene| {
        direct(scene);
        sheet(scene, 1.1, pane(1.5, Rgb::new(0.9, 0.6, 0.3)));
    });
    let settings = path::Settings { spp: 1024, max_depth: Some(2), ..Default::default() };
    // The light has an edge more through the pane.
    let behind = path::Settings { max_depth: Some(3), ..settings };
    let share = mean_by(&hung, &behind) / mean_by(&open, &settings);
    // Fresnel's reflectance at the sun's 22.4 degrees, by both sides of the sheet.
    let cos: f64 = 1.0 / (1.0f64 + 0.16 + 0.01).sqrt();
    let inside = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
    let (s, p) = ((cos - 1.5 * inside) / (cos + 1.5 * inside), (inside - 1.5 * cos) / (inside + 1.5 * cos));
    let one = 0.5 * (s * s + p * p);
    let expected = DVec3::new(0.9, 0.6, 0.3) * (1.0 - 2.0 * one / (1.0 + one));
    assert_means_within(1e-3, share, expected, "paths");
    let by_cache = vpl::Settings { spp: 256, max_depth: Some(2), ..vpl::Settings::cache() };
    let behind = vpl::Settings { max_depth: Some(3), ..by_cache };
    let share = mean_by(&hung, &behind) / mean_by(&open, &by_cache);
    assert_means_within(1e-3, share, expected, "cache");
}

#[test]
fn glass_ware_under_a_lamp_and_the_sky_agrees_with_paths() {
    // Solid balls, one in the other's light, on a floor before a wall.
    let mut scene = scene(camera(Vec3::new(0.0, 1.2, 3.0), Vec3::new(0.0, 0.3, 0.0), 0.5), [16, 16]);
    let floor = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.7, 0.6)));
    let (black, clear) = (add_material(&mut scene, diffuse(Rgb::ZERO)), add_material(&mut scene, glass(1.5)));
    scene.meshes.push(quad(Vec3::new(-4.0, 0.0, -1.5), Vec3::Z * 6.0, Vec3::X * 8.0, floor));
    scene.meshes.push(quad(Vec3::new(-4.0, 0.0, -1.5), Vec3::X * 8.0, Vec3::Y * 3.0, floor));
    for (centre, radius) in [
        (Vec3::new(-0.5, 0.5, -0.2), 0.45),
        (Vec3::new(0.6, 0.4, 0.3), 0.35),
        (Vec3::new(0.1, 1.2, -0.4), 0.3),
    ] {
        scene.meshes.push(sphere(centre, radius, 32, clear));
    }
    let lamp = quad(Vec3::new(-0.2, 2.6, -0.4), Vec3::X * 0.6, Vec3::Z * 0.6, black);
    scene.meshes.push(emitting(lamp, Rgb::new(12.0, 11.0, 9.0)));
    scene.environment = Some(Environment::Constant(Rgb::new(0.2, 0.25, 0.3)));
    let world = &world(scene);
    assert_means_within(NOISE, by_default(world), by_paths(world), "glass ware");
}

/// Asserts that methods which gather light by cuts or photons agree with paths.
pub(crate) fn assert_methods_agree(world: &WorldAndView, exact: DVec3, spp: u32, what: &str) {
    /// Relative difference of means that the noise of few paths through glass explains.
    const NOISE: f64 = 0.05;
    let agrees = |found, name: &str| assert_means_within(NOISE, found, exact, &format!("{what}, {name}"));
    agrees(mean_by(world, &vpl::Settings { spp, ..vpl::Settings::lightcuts() }), "lightcuts");
    agrees(mean_by(world, &vpl::Settings { spp, ..vpl::Settings::reconstruction() }), "reconstruction");
    agrees(mean_by(world, &vpl::Settings { spp, ..vpl::Settings::photon_cache() }), "photon-cache");
}

#[test]
fn all_methods_agree_behind_a_thin_pane() {
    let world = two_rooms(thin_panes);
    assert_methods_agree(&world, by_paths(&world), 32, "thin panes");
}

#[test]
#[ignore = "a study: all methods behind all kinds of panes and mirrors"]
fn all_methods_agree_behind_panes_and_mirrors() {
    for (world, what) in &worlds() {
        let exact = by_so_many_paths(world, 1 << 20);
        assert_means_within(NOISE, by_default(world), exact, what);
        assert_methods_agree(world, exact, 128, what);
    }
}
