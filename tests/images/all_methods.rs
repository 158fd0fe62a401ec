//! Every method against scenes whose radiance is known in closed form.
//!
//! All scenes are scaled so that the mean of their image is 1. Most errors of energy show here: a factor of π or of a
//! cosine, light counted twice, emitters that are left out.

use crate::kit::*;
use crate::oracle::{assert_means_within, mean};
use glam::{DVec3, Mat3, Vec2, Vec3};
use lightsplat::math::Rgb;
use lightsplat::scene::{
    Attribute, AttributeId, AttributeValues, DeltaLight, DistantDisc, Emission, Environment, Filter, FovAxis,
    Material, MaterialId, Mesh, Principled, Projector, Reflectance, Scene, Share, SpotImage, Texture, Wrap,
};
use std::f32::consts::PI;

/// Albedo of all diffuse surfaces.
const ALBEDO: f32 = 0.5;

/// Difference from 1 that noise and the bias of methods explain.
const TOLERANCE: f64 = 0.03;

/// Name of a scene, and the function that makes it.
type NamedScene = (&'static str, fn() -> WorldAndView);

/// Scenes of mean 1, each with the reason.
const SCENES: [NamedScene; 20] = [
    ("nothing before a sky of radiance 1", || {
        let mut scene = scene(camera(Vec3::ZERO, Vec3::X, 0.5), [8, 8]);
        scene.environment = Some(Environment::Constant(Rgb::ONE));
        world(scene)
    }),
    ("a closed room that emits what it absorbs: L / (1 - albedo)", || furnace(|_| {})),
    ("a ball of glass in that room, which is not seen", || {
        furnace(|scene| {
            let material = add_material(scene, glass(1.5));
            scene.meshes.push(sphere(Vec3::new(0.1, 0.0, -0.2), 0.3, 24, material));
        })
    }),
    ("a mirror in that room, which is not seen either", || {
        furnace(|scene| {
            let material = add_material(scene, mirror());
            scene.meshes.push(sphere(Vec3::new(0.1, 0.0, -0.2), 0.3, 24, material));
        })
    }),
    ("a white sheet in that room that transmits all its light, which is not seen either", || {
        furnace(|scene| {
            let base_color = Reflectance::Constant(Rgb::ONE);
            let sheet = Principled { base_color, thin: Some(1.0.into()), ..Principled::default() };
            let principled = Some(Box::new(sheet));
            let sheet = Material { two_sided: true, principled, ..diffuse(Rgb::ZERO) };
            let material = add_material(scene, sheet);
            scene.meshes.push(quad(Vec3::new(-0.3, -0.3, -0.2), Vec3::X * 0.7, Vec3::Y * 0.6, material));
        })
    }),
    ("a floor under a sky of radiance 1 / albedo", || {
        floor(|scene| scene.environment = Some(Environment::Constant(Rgb::splat(1.0 / ALBEDO))))
    }),
    ("a floor under a point light: I cos / d²", || {
        let (position, cos, dist_sq) = (Vec3::new(0.0, 2.0, 1.5), 2.0 / 2.5, 6.25);
        floor(|scene| {
            let intensity = Rgb::splat(IRRADIANCE * dist_sq / cos);
            scene.lights.push(DeltaLight::Point { position, intensity });
        })
    }),
    ("a floor under a point light in a block of glass that absorbs: I cos / d² exp(-σ l)", || {
        let (position, cos, dist_sq) = (Vec3::new(0.0, 2.0, 1.5), 2.0 / 2.5, 6.25);
        let (absorption, inside) = (Rgb::new(0.5, 1.0, 2.0), 0.5 / cos);
        floor(|scene| {
            let intensity = (absorption * inside).exp() * (IRRADIANCE * dist_sq / cos);
            scene.lights.push(DeltaLight::Point { position, intensity });
            let material = Material { absorption: Some(absorption), ..glass(1.0) };
            let material = add_material(scene, material);
            for mut side in room(position - 0.5, position + 0.5, material) {
                side.triangles.iter_mut().for_each(|corners| corners.swap(1, 2));
                scene.meshes.push(side);
            }
        })
    }),
    ("a floor under a spot light, within its inner cone", || {
        let (position, cos, dist_sq) = (Vec3::new(0.0, 2.0, 1.5), 2.0 / 2.5, 6.25);
        floor(|scene| {
            scene.lights.push(DeltaLight::Spot {
                position,
                direction: -position.normalize(),
                intensity: Rgb::splat(IRRADIANCE * dist_sq / cos),
                inner_angle: 0.2,
                outer_angle: 0.4,
                image: None,
            });
        })
    }),
    ("a floor under a spot light through an image of a half", || {
        floor(|scene| {
            let texture = add_texture(scene, texture(1, &[Rgb::splat(0.5)]));
            scene.lights.push(DeltaLight::Spot {
                position: Vec3::Y * 2.0,
                direction: Vec3::NEG_Y,
                intensity: Rgb::splat(2.0 * IRRADIANCE * 4.0),
                inner_angle: 0.3,
                outer_angle: 0.4,
                image: Some(SpotImage { texture, to_local: downwards() }),
            });
        })
    }),
    ("a floor under a projector: I / height²", || {
        floor(|scene| {
            // 1 / cos³ of the intensity and the distance cancel: the place is off the axis.
            let position = Vec3::new(0.0, 2.0, 1.5);
            let intensity = Rgb::splat(IRRADIANCE * 4.0);
            let (to_local, axis) = (downwards(), FovAxis::X);
            let projector = Projector { intensity, texture: None, to_local, tan_half: 1.0, axis };
            scene.lights.push(DeltaLight::Projector { position, projector });
        })
    }),
    ("a floor under light from one direction: E cos", || {
        let direction = -Vec3::new(0.0, 2.0, 1.5).normalize();
        floor(|scene| {
            let irradiance = Rgb::splat(IRRADIANCE / 0.8);
            scene.lights.push(DeltaLight::Directional { direction, irradiance });
        })
    }),
    ("a floor under a distant disc: L Ω cos", || {
        let (half_angle, direction) = (0.01f32, Vec3::new(0.0, 2.0, 1.5).normalize());
        floor(|scene| {
            let radiance = Rgb::splat(IRRADIANCE / (0.8 * PI * half_angle * half_angle));
            scene.discs.push(DistantDisc { direction, half_angle, radiance });
        })
    }),
    // Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11, applied to four corners.
    ("a floor under a parallel square of half-width h at height d", || {
        floor(|scene| {
            let black = add_material(scene, diffuse(Rgb::ZERO));
            square_lamp(scene, black, 1.0);
        })
    }),
    ("a floor under that square, of which a quarter is there everywhere", || {
        floor(|scene| {
            let veil = add_material(scene, Material { opacity: Some(0.25.into()), ..diffuse(Rgb::ZERO) });
            square_lamp(scene, veil, 0.25);
        })
    }),
    ("a floor under that square, half of which is cut out", || {
        floor(|scene| {
            let opacity = Some(ramp(scene, Filter::Cut(0.5)));
            let half = add_material(scene, Material { opacity, ..diffuse(Rgb::ZERO) });
            square_lamp(scene, half, 0.5);
        })
    }),
    ("a veil in the closed room that emits what it absorbs, as far as it is there: not seen", || {
        furnace(|scene| leaves(scene, Filter::Bilinear))
    }),
    ("leaves cut out of it: not seen either", || furnace(|scene| leaves(scene, Filter::Cut(0.4)))),
    ("a floor of vertex colours under a sky of radiance 1 / their value at the point seen", || {
        let colour = |x: f32, z: f32| Rgb::new(0.5 + 0.4 * x, 0.5 - 0.4 * x, 0.5 + 0.4 * z);
        let at = Vec3::new(0.6, 0.0, -0.5);
        let mut scene = scene(camera(at + Vec3::Y, at, 0.05), [8, 8]);
        let texture = add_attribute_texture(&mut scene, AttributeId(0), None);
        let diffuse = Reflectance::Textured { texture, scale: Rgb::ONE };
        let material = add_material(&mut scene, Material { diffuse, ..Material::default() });
        let floor = quad(Vec3::new(-1.0, 0.0, -1.0), Vec3::Z * 2.0, Vec3::X * 2.0, material);
        let colours = floor.positions.iter().map(|p| colour(p.x, p.z)).collect();
        scene.meshes.push(with_attribute(floor, AttributeValues::Vertices(colours)));
        scene.environment = Some(Environment::Constant(colour(at.x, at.z).recip()));
        world(scene)
    }),
    // Both triangles of the lamp have the same form factor.
    ("a floor under a parallel square whose triangles emit unequally", || {
        let (h, d) = (0.5f32, 2.0f32);
        let a = h / d;
        let corner_factor = a / (1.0 + a * a).sqrt() * (a / (1.0 + a * a).sqrt()).atan() / PI;
        floor(|scene| {
            let texture = Some(add_attribute_texture(scene, AttributeId(0), None));
            let black = add_material(scene, diffuse(Rgb::ZERO));
            let lamp = quad(Vec3::new(-h, d, -h), Vec3::X * 2.0 * h, Vec3::Z * 2.0 * h, black);
            let radiance = Rgb::splat(IRRADIANCE / (PI * 4.0 * corner_factor));
            let shares = vec![Rgb::new(0.2, 1.0, 2.0), Rgb::new(1.8, 1.0, 0.0)];
            let mut lamp = with_attribute(lamp, AttributeValues::Triangles(shares));
            lamp.emission = Some(Emission { radiance, texture, two_sided: false });
            scene.meshes.push(lamp);
        })
    }),
    ("a floor in the shadow of a screen whose vertices are opaque in part", || {
        let direction = -Vec3::new(0.0, 2.0, 1.5).normalize();
        floor(|scene| {
            let texture = add_attribute_texture(scene, AttributeId(0), None);
            let opacity = Some(Share::Textured { texture, scale: 0.5 });
            let screen = add_material(scene, Material { opacity, ..diffuse(Rgb::ZERO) });
            let screen = quad(Vec3::new(-0.2, 1.0, 0.55), Vec3::X * 0.4, Vec3::Z * 0.4, screen);
            // The ray to the point passes the middle of the diagonal between the first and the third corner.
            let opacities = [0.6, 0.0, 1.0, 0.0].map(Rgb::splat).to_vec();
            scene.meshes.push(with_attribute(screen, AttributeValues::Vertices(opacities)));
            let irradiance = Rgb::splat(IRRADIANCE / 0.8 / (1.0 - 0.5 * 0.8));
            scene.lights.push(DeltaLight::Directional { direction, irradiance });
        })
    }),
];

/// Adds the parallel square over the floor. Its material covers the share `opacity` of it on average.
fn square_lamp(scene: &mut Scene, material: MaterialId, opacity: f32) {
    let (h, d) = (0.5f32, 2.0f32);
    let a = h / d;
    let corner_factor = a / (1.0 + a * a).sqrt() * (a / (1.0 + a * a).sqrt()).atan() / PI;
    let lamp = quad(Vec3::new(-h, d, -h), Vec3::X * 2.0 * h, Vec3::Z * 2.0 * h, material);
    let radiance = IRRADIANCE / (PI * 4.0 * corner_factor) / opacity;
    scene.meshes.push(emitting(textured(lamp, Vec2::ONE), Rgb::splat(radiance)));
}

/// Adds a texture that is black on the left and white on the right, with a ramp between them.
fn ramp(scene: &mut Scene, filter: Filter) -> Share {
    let texels = [Rgb::ZERO, Rgb::ONE];
    let ramp = Texture { filter, wrap: Wrap::Clamp, ..texture(2, &texels) };
    Share::Textured { texture: add_texture(scene, ramp), scale: 1.0 }
}

/// Adds two sheets, one behind the other, whose opacity is a ramp. Where they are there, they emit what they absorb.
fn leaves(scene: &mut Scene, filter: Filter) {
    let opacity = Some(ramp(scene, filter));
    let leaf = add_material(scene, Material { opacity, ..diffuse(Rgb::splat(ALBEDO)) });
    for z in [-0.4, 0.0] {
        let mut mesh = textured(quad(Vec3::new(-0.5, -0.6, z), Vec3::X, Vec3::Y, leaf), Vec2::splat(2.5));
        mesh.emission = Some(Emission { radiance: Rgb::splat(1.0 - ALBEDO), texture: None, two_sided: true });
        scene.meshes.push(mesh);
    }
}

/// Gives a mesh an attribute.
fn with_attribute(mut mesh: Mesh, values: AttributeValues) -> Mesh {
    mesh.attributes.push(Attribute { id: AttributeId(0), values });
    mesh
}

/// Irradiance of a floor whose radiance is 1.
const IRRADIANCE: f32 = PI / ALBEDO;

/// Rotation of world directions to the frame of a light that shines downwards.
fn downwards() -> Mat3 {
    Mat3::from_cols(Vec3::X, Vec3::Z, Vec3::NEG_Y).transpose()
}

/// A closed room whose walls emit 1 - albedo, so that the radiance is 1 everywhere.
fn furnace(add: impl FnOnce(&mut Scene)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.3, 0.2, 0.8), Vec3::ZERO, 0.7), [16, 16]);
    let wall = add_material(&mut scene, diffuse(Rgb::splat(ALBEDO)));
    for mesh in room(Vec3::splat(-1.0), Vec3::ONE, wall) {
        scene.meshes.push(emitting(mesh, Rgb::splat(1.0 - ALBEDO)));
    }
    add(&mut scene);
    world(scene)
}

/// A point of a floor, seen from above.
fn floor(light: impl FnOnce(&mut Scene)) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 1.0, 0.0), Vec3::ZERO, 1e-3), [8, 8]);
    let floor = add_material(&mut scene, diffuse(Rgb::splat(ALBEDO)));
    scene.meshes.push(quad(Vec3::new(-5.0, 0.0, -5.0), Vec3::Z * 10.0, Vec3::X * 10.0, floor));
    light(&mut scene);
    world(scene)
}

#[test]
fn every_method_finds_the_light_of_every_scene() {
    for (what, scene) in SCENES {
        let world = scene();
        for (name, method) in small_methods() {
            let image = image(&world, method.renderer());
            assert_means_within(TOLERANCE, mean(&image), DVec3::ONE, &format!("{what}, by {name}"));
        }
    }
}
