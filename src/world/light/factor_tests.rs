//! Emitters whose radiance and opacity vary: what they emit, and their power.

use super::AreaLight;
use crate::testkit::*;
use base::math::Rgb;
use base::sampling::owen_sobol_2d;
use glam::{Vec2, Vec3};
use scene::{Camera, Emission, Filter, Material, Share, Texture, Wrap};
use std::f32::consts::PI;

/// Returns a sign of four square metres that emits 2 where `colour` is white and as much as `opacity` says. Both are
/// the texels of an image of two columns.
fn sign(colour: Option<[f32; 2]>, opacity: Option<[f32; 2]>, filter: Filter) -> WorldAndView {
    let mut scene = scene(Camera::default(), [1, 1]);
    let mut image = |texels: [f32; 2]| {
        let plain = texture(2, &texels.map(Rgb::splat));
        add_texture(&mut scene, Texture { filter, wrap: Wrap::Clamp, ..plain })
    };
    let colour = colour.map(&mut image);
    let opacity = opacity.map(&mut image).map(|texture| Share::Textured { texture, scale: 1.0 });
    let material = add_material(&mut scene, Material { opacity, ..diffuse(Rgb::ZERO) });
    let square = quad(Vec3::new(-1.0, -1.0, 0.0), Vec3::X * 2.0, Vec3::Y * 2.0, material);
    let emission = Some(Emission { radiance: Rgb::splat(2.0), texture: colour, two_sided: false });
    scene.meshes.push(scene::Mesh { emission, ..textured(square, Vec2::ONE) });
    world(scene)
}

fn only(world: &WorldAndView) -> &AreaLight {
    &world.emitters.areas[0]
}

#[test]
fn power_is_that_of_the_mean_product_of_radiance_and_opacity() {
    let nearest = |colour, opacity| sign(colour, opacity, Filter::Nearest);
    for (world, mean) in [
        (nearest(None, None), 1.0),
        (nearest(Some([0.2, 0.6]), None), 0.4),
        (nearest(None, Some([0.5, 0.25])), 0.375),
        // The means alone would give 0.5 · 0.5 for each.
        (nearest(Some([0.0, 1.0]), Some([0.0, 1.0])), 0.5),
        (nearest(Some([0.2, 0.8]), Some([0.9, 0.1])), 0.13),
        (sign(None, Some([0.0, 1.0]), Filter::Cut(0.75)), 0.375),
    ] {
        let (found, expected) = (only(&world).power, 2.0 * 4.0 * PI * mean);
        assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
    }
    for [colour, opacity] in [[[0.0; 2], [1.0; 2]], [[1.0; 2], [0.0; 2]]] {
        assert!(nearest(Some(colour), Some(opacity)).emitters.areas.is_empty());
    }
    // Textures that exclude each other leave little, and no division by it.
    let power = only(&nearest(Some([1.0, 0.0]), Some([0.0, 1.0]))).power;
    assert!(power > 0.0 && power < 0.01, "{power}");
}

#[test]
fn samples_and_hits_find_the_same_radiance() {
    let world = sign(Some([0.3, 0.7]), Some([0.0, 1.0]), Filter::Bilinear);
    let light = only(&world);
    let mut darkest = f32::INFINITY;
    for i in 0..1000 {
        let point = light.sample(owen_sobol_2d(i, 1));
        let ray = embree::Ray::new(point.position + Vec3::Z, -Vec3::Z);
        let surface = world.intersect(&ray).expect("the sign");
        let (sampled, seen) = (light.radiance(&point, Vec3::Z), world.emitted(&surface, Vec3::Z));
        let ramp = (point.position.x + 0.5).clamp(0.0, 1.0);
        let expected = 2.0 * (0.3 + 0.4 * ramp) * ramp;
        assert!((sampled.x - expected).abs() < 1e-5 && (seen.x - expected).abs() < 1e-5, "{sampled} {seen}");
        assert_eq!(world.emitted(&surface, -Vec3::Z), Rgb::ZERO);
        darkest = darkest.min(sampled.x);
    }
    assert_eq!(darkest, 0.0);
}

#[test]
fn surfaces_of_constant_opacity_shine_by_it() {
    let mut scene = scene(Camera::default(), [1, 1]);
    for opacity in [1.0, 0.25, 0.0] {
        let material = Material { opacity: Some(opacity.into()), ..diffuse(Rgb::ZERO) };
        let material = add_material(&mut scene, material);
        let square = quad(Vec3::Z * opacity, Vec3::X, Vec3::Y, material);
        scene.meshes.push(emitting(square, Rgb::splat(4.0)));
    }
    let world = world(scene);
    let powers: Vec<f32> = world.emitters.areas.iter().map(|light| light.power / PI).collect();
    assert_eq!(powers.len(), 2);
    assert!((powers[0] - 4.0).abs() < 1e-5 && (powers[1] - 1.0).abs() < 1e-5, "{powers:?}");
    for (z, expected) in [(1.0, 4.0), (0.25, 1.0), (0.0, 0.0)] {
        let ray = embree::Ray::new(Vec3::new(0.5, 0.4, z + 0.1), -Vec3::Z);
        let surface = world.intersect(&ray).expect("a square");
        let out = Vec3::Z;
        assert!((world.emitted(&surface, out).x - expected).abs() < 1e-5);
        // Denoisers are guided by as much of the surface as is there.
        let albedo = world.guide_albedo(&surface, &world.bsdf(&surface), out).x;
        assert!((albedo - expected / 4.0).abs() < 1e-5, "{albedo}");
    }
}
