//! Chains through mirrors and glass, visibility samples and features, against closed forms.

use super::ExtraSamples;
use super::chain::{ChainTracer, ChainVertex, EdgeEnd, Follow};
use super::counts::EyeCounts;
use super::{
    DirectSampling, EyePass, EyeSettings, Feature, FeatureSettings, Features, LightSources, SeenPixels,
};
use crate::paths::Estimand;
use base::film::{Layer, Pixels, Window};
use base::math::{Cone, Rgb};
use base::progress::Control;
use base::sampling::Sampler;
use glam::{DVec3, Vec2, Vec3};
use scene::{
    Camera, Coat, DeltaLight, Distribution, Emission, Fresnel, Lobe, Material, MaterialId, Mesh, Reflectance,
};
use std::time::Duration;
use world::World;
use world::testkit::*;
use world::view::View;

/// Index of refraction of an interface that reflects a quarter of the light at normal incidence.
const ETA: f32 = 3.0;

/// A scene seen from the origin along -z.
fn seen_from_origin(resolution: [u32; 2]) -> SceneAndView {
    scene(Camera { tan_half_x: 0.5, ..Camera::default() }, resolution)
}

/// A large square at `z` that faces +z.
fn wall(z: f32, material: MaterialId) -> Mesh {
    quad(Vec3::new(-50.0, -50.0, z), Vec3::X * 100.0, Vec3::Y * 100.0, material)
}

/// A large square at `z` that faces -z.
fn back_wall(z: f32, material: MaterialId) -> Mesh {
    quad(Vec3::new(-50.0, -50.0, z), Vec3::Y * 100.0, Vec3::X * 100.0, material)
}

/// Returns the surfaces hit by a ray nearly along -z, and the counts.
fn chain(world: &WorldAndView, max_depth: u32, seed: u32) -> (Vec<ChainVertex<'_>>, EyeCounts) {
    let [width, height] = world.view.window.film;
    let ray = world.view.primary_ray([width / 2, height / 2], Vec2::splat(1e-3));
    let (mut vertices, mut counts) = (Vec::new(), EyeCounts::default());
    let (world, cone) = (&world.world, Cone::default());
    let tracer = ChainTracer { world, cone, max_depth, follow: Follow::DeltaAndSharp };
    tracer.trace(ray, &mut Sampler::new(seed, 0), &mut counts, |end| {
        if let EdgeEnd::Surface(vertex) = end {
            vertices.push(vertex);
        }
    });
    (vertices, counts)
}

#[test]
fn mirrors_pass_all_light_on_until_the_chain_is_too_long() {
    let mut scene = seen_from_origin([64, 64]);
    let mirror = add_material(&mut scene, mirror());
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    // Light goes to and fro between the mirror in front and the one behind; the grey wall is out of sight.
    scene.meshes.push(wall(-1.0, mirror));
    scene.meshes.push(back_wall(2.0, mirror));
    scene.meshes.push(wall(-9.0, grey));
    let world = world(scene);
    let (vertices, counts) = chain(&world, 6, 0);
    assert_eq!(vertices.iter().map(|v| v.surface.mesh).collect::<Vec<_>>(), [0, 1, 0, 1, 0, 1]);
    for (i, vertex) in vertices.iter().enumerate() {
        assert_eq!((vertex.depth, vertex.throughput), (i as u32 + 1, Rgb::ONE));
        let unfolded = 1.0 + 3.0 * i as f32;
        assert!((vertex.distance - unfolded).abs() < 1e-3 * unfolded, "{}", vertex.distance);
    }
    assert_eq!((counts.rays, counts.overflow), (6, 0));
}

#[test]
fn glass_splits_light_by_fresnels_equations() {
    let mut scene = seen_from_origin([64, 64]);
    let glass = add_material(&mut scene, glass(ETA));
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.extend([wall(-1.0, glass), wall(-3.0, grey), back_wall(2.0, grey)]);
    let world = world(scene);
    let (vertices, counts) = chain(&world, 2, 0);
    let share = |mesh: u32| vertices.iter().find(|v| v.surface.mesh == mesh).unwrap().throughput.x;
    let reflected = ((ETA - 1.0) / (ETA + 1.0)).powi(2);
    assert!((share(2) - reflected).abs() < 1e-4, "{}", share(2));
    // Radiance is compressed in the denser medium.
    assert!((share(1) * ETA * ETA - (1.0 - reflected)).abs() < 1e-4, "{}", share(1));
    assert_eq!((vertices.len(), counts.rays), (3, 3));
}

#[test]
fn a_pane_lets_through_and_reflects_what_the_series_of_its_reflections_adds_up_to() {
    let mut scene = seen_from_origin([64, 64]);
    let glass = add_material(&mut scene, glass(ETA));
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    let pane = [wall(-1.0, glass), back_wall(-1.5, glass)];
    scene.meshes.extend(pane.into_iter().chain([wall(-3.0, grey), back_wall(2.0, grey)]));
    let world = world(scene);
    let chains = 4000;
    let mut shares = [0.0; 4];
    for seed in 0..chains {
        for vertex in chain(&world, 64, seed).0 {
            shares[vertex.surface.mesh as usize] += vertex.throughput.x / chains as f32;
        }
    }
    let r = ((ETA - 1.0) / (ETA + 1.0)).powi(2);
    let through = (1.0 - r).powi(2) / (1.0 - r * r);
    assert!((shares[2] - through).abs() < 0.005, "{shares:?} {through}");
    assert!((shares[3] - (1.0 - through)).abs() < 0.005, "{shares:?} {through}");
}

#[test]
fn branches_beyond_those_that_can_wait_are_counted() {
    let mut scene = seen_from_origin([64, 64]);
    // Each interface reflects little, so that there is something left to reflect after many of them.
    let glass = add_material(&mut scene, glass(1.33));
    for i in 0..400 {
        scene.meshes.push(if i % 2 == 0 {
            wall(-1.0 - i as f32, glass)
        } else {
            back_wall(-1.0 - i as f32, glass)
        });
    }
    let world = world(scene);
    let overflow = |max_depth| (0..200).map(|seed| chain(&world, max_depth, seed).1.overflow).sum::<u64>();
    assert_eq!(overflow(20), 0);
    assert!(overflow(u32::MAX) > 0);
}

#[test]
fn visibility_samples_carry_the_whole_light_of_each_pixel() {
    let (mut scene, _) = lit_room(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.8), 20);
    let glass = add_material(&mut scene, glass(1.5));
    scene.meshes.push(sphere(Vec3::new(0.2, -0.3, -0.2), 0.3, 16, glass));
    let world = world(scene);
    let pass = |spp| {
        let settings = EyeSettings { spp, seed: 1, max_depth: 32 };
        EyePass::trace(&world, &world.view, settings, &Control::new())
    };
    let pass = pass(64);
    let mut sums = vec![Rgb::ZERO; 400];
    let mut samples = 0;
    for point in 0..pass.len() {
        for sample in pass.visibility.at_point(point) {
            sums[sample.pixel as usize] += sample.weight;
            samples += 1;
        }
    }
    assert_eq!(samples, pass.len());
    // Only Russian roulette at glass leaves noise.
    let exact = sums.iter().filter(|sum| (**sum - Rgb::ONE).abs().max_element() < 1e-4).count();
    assert!(exact > 200 && exact < 400, "{exact}");
    let mean = sums.iter().sum::<Rgb>() / 400.0;
    assert!((mean - Rgb::ONE).abs().max_element() < 0.01, "{mean}");
}

/// A room with glass and a mirror ball in it.
fn room_with_chains() -> WorldAndView {
    let (mut scene, _) = lit_room(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.8), 20);
    for (x, material) in [(0.35, glass(1.5)), (-0.35, mirror())] {
        let material = add_material(&mut scene, material);
        scene.meshes.push(sphere(Vec3::new(x, -0.3, -0.2), 0.3, 16, material));
    }
    world(scene)
}

fn drawn<'w>(world: &'w WorldAndView, view: &View, spp: u32) -> EyePass<'w> {
    drawn_with(world, view, spp, 0.0)
}

/// The eye pass with extra samples.
fn drawn_with<'w>(world: &'w World, view: &View, spp: u32, extra_samples: f32) -> EyePass<'w> {
    let settings = EyeSettings { spp, seed: 1, max_depth: 32 };
    let extra_samples = ExtraSamples { most: extra_samples, other_rays: None };
    let direct = DirectSampling { extra_samples, ..DirectSampling::default() };
    EyePass::with_direct_light(
        world,
        view,
        settings,
        LightSources { direct: &direct, caustics: None, learned: None, path_ends: None },
        &Control::new(),
    )
}

#[test]
fn merged_points_carry_the_whole_light_of_each_pixel() {
    let world = room_with_chains();
    // Pixels of 48 and of 192 samples, or of 12, 24 and 48; or with parts of their own.
    for (spp, extra_samples) in [(64, 0.0), (48, 0.5), (12, 1.0), (700, 0.5)] {
        check_weights(drawn_with(&world, &world.view, spp, extra_samples), spp, extra_samples > 0.0);
    }
}

fn check_weights(pass: EyePass, spp: u32, extra: bool) {
    assert_eq!(pass.chains.extra_samples > 0, extra);
    let mut sums = vec![Rgb::ZERO; 400];
    for point in 0..pass.len() {
        for sample in pass.visibility.at_point(point) {
            sums[sample.pixel as usize] += sample.weight;
        }
    }
    // Glass, which reflects or refracts at random, leaves noise, and so does the thinning of chains.
    let exact = sums.iter().filter(|sum| (**sum - Rgb::ONE).abs().max_element() < 1e-4).count();
    assert!(exact > 200 && exact < 400, "{exact}");
    let mean = sums.iter().sum::<Rgb>() / 400.0;
    assert!((mean - Rgb::ONE).abs().max_element() < 0.02, "{mean}");
    // Ends of first samples and of more are merged together.
    assert!(pass.len() >= 400 && (pass.len() < 1600 || spp > 512), "{}", pass.len());
}

#[test]
fn passes_that_are_cancelled_have_no_points() {
    let world = room_with_chains();
    let settings = EyeSettings { spp: 4, seed: 0, max_depth: 8 };
    for delay in (0..40).map(|step| Duration::from_micros(100 * step)) {
        let control = Control::new();
        let pass = std::thread::scope(|scope| {
            scope.spawn(|| {
                std::thread::sleep(delay);
                control.cancel();
            });
            EyePass::trace(&world, &world.view, settings, &control)
        });
        assert_eq!(pass.len() > 0, pass.complete);
        assert!((0..pass.len()).all(|point| !pass.visibility.at_point(point).is_empty()));
    }
}

#[test]
fn chains_follow_the_share_of_a_sharp_coat_on_a_base() {
    // Many pixels, since few of them keep a point behind the coat.
    let mut scene = seen_from_origin([192, 192]);
    let lobe = Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: 0.05.into(),
        fresnel: Fresnel::Dielectric(1.5),
        scale: Reflectance::Constant(Rgb::ONE),
    };
    let coat = Some(Coat { eta: 1.5, nonlinear: false });
    let coated = Material { lobes: vec![lobe], coat, ..diffuse(Rgb::splat(0.6)) };
    let coated = add_material(&mut scene, coated);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.extend([wall(-1.0, coated), back_wall(2.0, grey)]);
    let world = world(scene);
    let surface = world.intersect(&world.view.primary_ray([96, 96], Vec2::ZERO)).expect("the coat");
    let (_, sharp) = world.bsdf(&surface).split_sharp_lobes().expect("a sharp lobe");
    let expected = sharp.albedo(Vec3::Z);
    let pass = drawn(&world, &world.view, 8);
    let mut sums = [Rgb::ZERO; 2];
    for point in 0..pass.len() {
        let behind = pass.points.geometry[point].position.z > 0.0;
        sums[usize::from(behind)] +=
            pass.visibility.at_point(point).iter().map(|sample| sample.weight).sum::<Rgb>();
    }
    let [front, behind] = sums.map(|sum| sum / (192.0 * 192.0));
    assert_near(front, Rgb::ONE);
    assert!(((behind - expected) / expected).abs().max_element() < 0.03, "{behind} {expected}");
}

#[test]
fn a_crop_has_the_whole_pictures_merged_points_with_extra_samples_too() {
    let world = room_with_chains();
    let points = |window: Window| {
        let view = View { window, ..world.view };
        let pass = drawn_with(&world, &view, 16, 0.3);
        assert!(pass.chains.extra_samples > 0);
        let mut points = Vec::new();
        for point in 0..pass.len() {
            for sample in pass.visibility.at_point(point) {
                let [x, y] = window.film_pixel([sample.pixel % window.width, sample.pixel / window.width]);
                let position = pass.points.geometry[point].position.to_array().map(f32::to_bits);
                points.push(([x, y], position, sample.weight.to_array().map(f32::to_bits)));
            }
        }
        points.sort_unstable();
        points
    };
    let whole = points(world.view.window);
    let window = Window { offset: [3, 7], width: 13, height: 9, ..world.view.window };
    let inside = |[x, y]: [u32; 2]| (3..16).contains(&x) && (7..16).contains(&y);
    let expected: Vec<_> = whole.into_iter().filter(|(pixel, ..)| inside(*pixel)).collect();
    assert!(points(window) == expected);
}

#[test]
fn the_back_of_a_one_sided_surface_is_black() {
    for (two_sided, lit) in [(true, 64), (false, 0)] {
        let mut scene = seen_from_origin([8, 8]);
        let material = add_material(&mut scene, Material { two_sided, ..diffuse(Rgb::splat(0.5)) });
        scene.meshes.push(back_wall(-2.0, material));
        let (position, intensity) = (Vec3::new(0.5, 0.3, 0.0), Rgb::ONE);
        scene.lights.push(DeltaLight::Point { position, intensity });
        let world = world(scene);
        let pass = drawn(&world, &world.view, 16);
        assert_eq!(pass.len(), lit);
        assert_eq!(pass.known.pixels.iter().filter(|light| **light != Rgb::ZERO).count(), lit);
    }
}

fn all_features(world: &WorldAndView, spp: u32) -> Vec<Layer> {
    let settings = FeatureSettings { estimand: Estimand::EyeSamples { spp, seed: 0 }, spp, seed: 0 };
    let wanted = Feature::ALL.into_iter().collect();
    SeenPixels::new(world, &world.view, &settings, &Control::new()).layers(world, wanted)
}

/// Returns the values of a layer, or the first of three if there are no more.
fn values(layers: &[Layer], name: &str) -> Vec<Vec3> {
    let layer = layers.iter().find(|layer| layer.name == name).unwrap_or_else(|| panic!("no layer {name}"));
    match &layer.pixels {
        Pixels::Color(image) | Pixels::Vector(image) => image.pixels.clone(),
        Pixels::Scalar(image) => image.pixels.iter().map(|&x| Vec3::X * x).collect(),
        Pixels::Id(image) => image.pixels.iter().map(|&id| Vec3::X * id as f32).collect(),
        Pixels::Ranks(image) => image.pixels.iter().map(|ranks| Vec3::from_slice(ranks)).collect(),
    }
}

fn assert_near(found: Vec3, expected: Vec3) {
    assert!((found - expected).abs().max_element() <= 1e-4 * (1.0 + expected.length()), "{found} {expected}");
}

#[test]
fn a_plane_half_in_view_has_its_own_features_and_the_rest_none() {
    let mut scene = seen_from_origin([8, 4]);
    scene.centre = DVec3::new(1000.0, -7.0, 0.25);
    let _unseen = add_material(&mut scene, diffuse(Rgb::ONE));
    let red = add_material(&mut scene, diffuse(Rgb::new(0.8, 0.1, 0.2)));
    scene.meshes.push(wall(60.0, red));
    scene.meshes.push(quad(Vec3::new(0.0, -50.0, -4.0), Vec3::X * 50.0, Vec3::Y * 100.0, red));
    let world = world(scene);
    let layers = all_features(&world, 1);
    let of = |name| values(&layers, name);
    for (i, position) in of("position").into_iter().enumerate() {
        let (x, y) = (i % 8, i / 8);
        if x < 4 {
            assert_eq!(of("depth.Z")[i].x, 1e10);
            for name in ["albedo", "normal", "geometricNormal", "position", "materialId", "objectId", "A"] {
                assert_eq!(of(name)[i], Vec3::ZERO, "{name}");
            }
            continue;
        }
        // The film is 4 wide at a distance of 4.
        let on_plane = Vec3::new((x as f32 + 0.5 - 4.0) * 0.5, (1.5 - y as f32) * 0.5, -4.0);
        assert_near(position, Vec3::new(1000.0, -7.0, 0.25) + on_plane);
        assert_near(of("albedo")[i], Rgb::new(0.8, 0.1, 0.2));
        assert_near(of("normal")[i], Vec3::Z);
        assert_near(of("geometricNormal")[i], Vec3::Z);
        assert_near(of("depth.Z")[i], Vec3::X * 4.0);
        assert_eq!([of("materialId")[i].x, of("objectId")[i].x, of("A")[i].x], [2.0, 2.0, 1.0]);
    }
}

#[test]
fn a_sign_has_its_picture_for_albedo_whatever_its_brightness() {
    for brightness in [1e-6, 14.0] {
        let mut scene = seen_from_origin([8, 4]);
        let dark = add_material(&mut scene, diffuse(Rgb::new(0.1, 0.02, 0.02)));
        let texels = [Rgb::new(0.5, 0.0, 0.05), Rgb::new(0.0, 0.25, 0.125)];
        let texture = Some(add_texture(&mut scene, texture(2, &texels)));
        let mut sign = wall(-4.0, dark);
        sign.uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec();
        sign.emission = Some(Emission { radiance: Rgb::splat(brightness), texture, two_sided: true });
        scene.meshes.push(sign);
        let layers = all_features(&world(scene), 4);
        let albedo = values(&layers, "albedo");
        assert_near(albedo[8], Rgb::new(1.0, 0.02, 0.1));
        assert_near(albedo[15], Rgb::new(0.1, 0.5, 0.25));
    }
}

#[test]
fn a_pixel_on_an_edge_averages_what_can_be_averaged() {
    let mut scene = seen_from_origin([1, 1]);
    let grey = add_material(&mut scene, diffuse(Rgb::splat(0.5)));
    scene.meshes.push(quad(Vec3::new(0.0, -50.0, -4.0), Vec3::X * 50.0, Vec3::Y * 100.0, grey));
    let layers = all_features(&world(scene), 16);
    let of = |name| values(&layers, name)[0];
    // Sixteen stratified samples: eight to the left, eight to the right.
    assert_eq!(of("A").x, 0.5);
    assert_near(of("normal"), Vec3::Z * 0.5);
    assert_near(of("albedo"), Rgb::splat(0.25));
    assert_near(of("depth.Z"), Vec3::X * 4.0);
    assert_eq!((of("materialId").x, of("objectId").x, of("position").z), (1.0, 1.0, -4.0));
}

#[test]
fn a_mirror_shows_the_features_of_what_is_seen_in_it() {
    let mut scene = seen_from_origin([5, 3]);
    let mirror = add_material(&mut scene, mirror());
    let red = add_material(&mut scene, diffuse(Rgb::new(0.8, 0.1, 0.2)));
    scene.meshes.extend([wall(-2.0, mirror), back_wall(3.0, red)]);
    let layers = all_features(&world(scene), 4);
    for i in 0..15 {
        let of = |name| values(&layers, name)[i];
        assert_near(of("albedo"), Rgb::new(0.8, 0.1, 0.2));
        assert_near(of("normal"), -Vec3::Z);
        assert_near(of("depth.Z"), Vec3::X * 7.0);
        assert!((of("position").z - 3.0).abs() < 1e-5);
        assert_eq!([of("materialId").x, of("objectId").x, of("A").x], [2.0, 2.0, 1.0]);
    }
}

#[test]
fn glass_shows_what_most_light_comes_from_and_itself_before_the_sky() {
    let features_behind = |with_wall: bool| {
        let mut scene = seen_from_origin([1, 1]);
        let glass = add_material(&mut scene, glass(1.5));
        let (red, blue) = (Rgb::new(0.8, 0.1, 0.2), Rgb::new(0.0, 0.2, 0.9));
        let [red, blue] = [red, blue].map(|colour| add_material(&mut scene, diffuse(colour)));
        scene.meshes.extend([wall(-2.0, glass), back_wall(-2.5, glass), back_wall(3.0, blue)]);
        if with_wall {
            scene.meshes.push(wall(-6.0, red));
        }
        all_features(&world(scene), 1)
    };
    let behind = features_behind(true);
    assert_eq!(values(&behind, "objectId")[0].x, 4.0);
    assert_near(values(&behind, "normal")[0], Vec3::Z);
    // The red wall by the light let through, the blue one by that reflected.
    let albedo = values(&behind, "albedo")[0];
    assert!(albedo.x > 0.6 && albedo.x < 0.8 && albedo.z > 0.18 && albedo.z < 0.3, "{albedo}");
    let sky = features_behind(false);
    assert_eq!([values(&sky, "objectId")[0].x, values(&sky, "A")[0].x], [1.0, 1.0]);
    assert_near(values(&sky, "depth.Z")[0], Vec3::X * 2.0);
}

#[test]
fn only_what_is_wanted_is_made() {
    let (scene, _) = lit_room(camera(Vec3::new(0.0, 0.0, 0.9), Vec3::ZERO, 0.8), 4);
    let world = world(scene);
    let settings = FeatureSettings { estimand: Estimand::Pixels, spp: 2, seed: 0 };
    let seen = SeenPixels::new(&world, &world.view, &settings, &Control::new());
    let layers = |wanted: Features| seen.layers(&world, wanted);
    let wanted = ["depth".parse(), "albedo".parse()].into_iter().map(Result::unwrap).collect();
    assert_eq!(layers(wanted).iter().map(|l| l.name.as_str()).collect::<Vec<_>>(), ["albedo", "depth.Z"]);
    assert!(layers(Features::default()).is_empty());
    let error = "normals".parse::<Feature>().unwrap_err().to_string();
    assert!(error.contains("`normals`") && error.contains("geometric-normal, position"), "{error}");
}
