//! Virtual lights and photons of projected images, and scenes without surfaces that store them.

use super::*;
use crate::caustics::PilotPaths;
use base::math::Rgb;
use base::progress::Control;
use base::sampling::{owen_sobol_2d, uniform_sphere};
use glam::{Mat3, Vec3};
use scene::{Camera, DeltaLight, Environment, FovAxis, Material, Projector, Reflectance, SpotImage};
use std::f32::consts::PI;
use world::light::DeltaEmitter;
use world::testkit::*;

/// Rotation of world directions to the frame of a light that shines downwards.
fn downwards() -> Mat3 {
    Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::NEG_Y).transpose()
}

/// A scene of one light over a floor of 2 by 2, and a picture in colour.
fn with_light(material: Material, light: impl Fn(&mut SceneAndView) -> DeltaLight) -> SceneAndView {
    let mut scene = scene(Camera::default(), [8, 8]);
    let floor = add_material(&mut scene, material);
    scene.meshes.push(quad(Vec3::new(-1.0, 0.0, 1.0), Vec3::X * 2.0, Vec3::Z * -2.0, floor));
    let light = light(&mut scene);
    scene.lights.push(light);
    scene
}

/// A projector or a spot light at a height, whose image of four texels covers the floor.
fn projected(scene: &mut SceneAndView, height: f32, is_spot: bool) -> DeltaLight {
    let texels = [Rgb::X, Rgb::new(0.0, 0.5, 0.0), Rgb::ZERO, Rgb::new(0.25, 0.25, 2.0)];
    let texture = add_texture(scene, texture(2, &texels));
    let (position, intensity) = (Vec3::Y * height, Rgb::splat(height * height));
    match is_spot {
        true => DeltaLight::Spot {
            position,
            direction: Vec3::NEG_Y,
            intensity,
            inner_angle: (1.5 / height).atan(),
            outer_angle: (1.5 / height).atan() * 1.0001,
            image: Some(SpotImage { texture, to_local: downwards() }),
        },
        false => {
            let tan_half = 1.0 / height;
            let (to_local, axis) = (downwards(), FovAxis::X);
            let projector = Projector { intensity, texture: Some(texture), to_local, tan_half, axis };
            DeltaLight::Projector { position, projector }
        }
    }
}

#[test]
fn virtual_lights_of_images_send_their_intensity() {
    for is_spot in [false, true] {
        let world = world(with_light(diffuse(Rgb::ONE), |scene| projected(scene, 2.0, is_spot)));
        let lights = light_pass(&world, &LightPassSettings::default(), &[], 2, &Control::new());
        let emitter: &DeltaEmitter = &world.emitters.deltas[0];
        let image = emitter.image.as_ref().expect("an image");
        let [set] = &lights.sets.iter().filter(|set| set.kind == VplKind::Omni).collect::<Vec<_>>()[..]
        else {
            panic!()
        };
        assert_eq!(set.len(), 3);
        let mut lit = 0;
        for i in 0..4000 {
            let away = uniform_sphere(owen_sobol_2d(i, 2));
            let sent: Rgb = set
                .vpls
                .iter()
                .zip(&set.intensities)
                .map(|(vpl, intensity)| {
                    let profile = vpl.spot_profile().expect("a profile");
                    *intensity * lights.profiles.spots[profile].falloff(away)
                })
                .sum();
            let expected = image.intensity(away);
            lit += u32::from(expected != Rgb::ZERO);
            assert!(
                (sent - expected).abs().max_element() <= 1e-4 * image.peak.max_element(),
                "{sent} {expected}"
            );
        }
        assert!(lit > 100, "{lit}");
    }
}

#[test]
fn photons_of_images_bring_the_flux_of_their_texels() {
    // The floor is lit by E(u, v), of mean (1.25, .75, 2) / 4 over an area of 4, near by and far off.
    for height in [0.5, 2.0, 1e3] {
        let scene = with_light(diffuse(Rgb::splat(0.5)), |scene| projected(scene, height, false));
        let settings = LightPassSettings { indirect: 20_000, ..LightPassSettings::default() };
        let lights = light_pass(&world(scene), &settings, &[], u32::MAX, &Control::new());
        let indirect = lights.sets.iter().filter(|set| set.origin == Origin::Indirect);
        let flux = indirect.flat_map(|set| &set.intensities).copied().sum::<Rgb>() * PI;
        let expected = Rgb::new(1.25, 0.75, 2.0) * 0.5;
        assert!((flux / expected - 1.0).abs().max_element() < 0.03, "{height}: {flux} {expected}");
    }
}

#[test]
fn no_photon_is_traced_where_nothing_stores_it() {
    let sharp = rough_metal(0.1, 0.9);
    let black = Material { diffuse: Reflectance::BLACK, ..diffuse(Rgb::ZERO) };
    let point = |_: &mut SceneAndView| DeltaLight::Point { position: Vec3::Y, intensity: Rgb::ONE };
    for (material, stores) in
        [(mirror(), false), (glass(1.5), false), (sharp, false), (black, false), (diffuse(Rgb::ONE), true)]
    {
        let mut scene = with_light(material.clone(), point);
        scene.environment = Some(Environment::Constant(Rgb::ONE));
        let world = world(scene);
        let settings = LightPassSettings { indirect: 1000, ..LightPassSettings::default() };
        let lights = light_pass(&world, &settings, &[], u32::MAX, &Control::new());
        assert_eq!((lights.photons.rays > 0, lights.photons.paths > 0), (stores, stores), "{material:?}");
        if !world.specular.spread_light() {
            assert_eq!(PilotPaths::new(&world, 16, 1, u32::MAX, &Control::new()).rays(), 0, "{material:?}");
        }
    }
}
