//! Tests of attributes of meshes as textures, against closed forms.

use crate::testkit::*;
use base::math::{LANES, Rgb, luminance};
use base::sampling::owen_sobol_2d;
use embree::{Hits16, Ray};
use glam::{Vec2, Vec3};
use scene::{
    Attribute, AttributeId, AttributeValues, Camera, Emission, Filter, Lobe, Material, MaterialId, Mesh,
    Parameter, Reflectance, Roughness, Texture, TextureId,
};
use std::f32::consts::PI;

const COLOUR: AttributeId = AttributeId(0);

/// Colours of the corners of [`square`].
const CORNERS: [Rgb; 4] =
    [Rgb::new(0.1, 0.2, 0.3), Rgb::new(0.9, 0.1, 0.5), Rgb::new(0.4, 0.8, 0.0), Rgb::new(0.7, 0.6, 1.0)];

/// Returns a unit square in the plane z = 0 of two triangles, with the colours of its corners.
fn square(material: MaterialId) -> Mesh {
    let mut square = textured(quad(Vec3::ZERO, Vec3::X, Vec3::Y, material), Vec2::ONE);
    square.attributes.push(Attribute { id: COLOUR, values: AttributeValues::Vertices(CORNERS.to_vec()) });
    square
}

/// Returns the colour at (x, y): linear on each triangle.
fn colour(x: f32, y: f32) -> Rgb {
    let [a, b, c, d] = CORNERS;
    if y < x { a * (1.0 - x) + b * (x - y) + c * y } else { a * (1.0 - y) + c * x + d * (y - x) }
}

/// Points on the square, away from the diagonal.
const POINTS: [(f32, f32); 5] = [(0.3, 0.1), (0.9, 0.2), (0.1, 0.8), (0.55, 0.5), (0.02, 0.97)];

fn down(x: f32, y: f32) -> Ray {
    Ray::new(Vec3::new(x, y, 1.0), -Vec3::Z)
}

/// Returns the albedo of a diffuse surface at (x, y), and checks that packets and means of lanes have the same.
fn albedo(world: &WorldAndView, x: f32, y: f32) -> Rgb {
    let hit = world.accel.closest_hit(&down(x, y)).expect("a surface");
    let surface = world.surface(&hit);
    let albedo = world.bsdf(&surface).base_brdf() * PI;
    let hits = Hits16 {
        t: [hit.t; LANES],
        u: [hit.u; LANES],
        v: [hit.v; LANES],
        geometry: [hit.geometry; LANES],
        primitive: [hit.primitive; LANES],
    };
    let surfaces = world.surfaces(&hits);
    let wo = base::math::Vec3x16::splat(Vec3::Z);
    let lane = world.bsdfs(&surfaces, wo).lane(7).base_brdf() * PI;
    let mean = world.mean_bsdf(&surfaces, 0b1011).0.base_brdf() * PI;
    assert_eq!(lane, albedo);
    assert!((mean - albedo).length() < 1e-6, "{mean} {albedo}");
    albedo
}

#[test]
fn colours_of_vertices_are_linear_on_triangles_and_those_of_faces_constant() {
    let mut scene = scene(Camera::default(), [1, 1]);
    let texture = add_attribute_texture(&mut scene, COLOUR, None);
    let diffuse = Reflectance::Textured { texture, scale: Rgb::new(0.5, 1.0, 0.25) };
    let material = add_material(&mut scene, Material { diffuse, ..Material::default() });
    let mut of_faces = square(material);
    of_faces.attributes[0].values = AttributeValues::Triangles(CORNERS[..2].to_vec());
    of_faces.positions.iter_mut().for_each(|p| p.x += 2.0);
    let mut without = square(material);
    without.attributes.clear();
    without.positions.iter_mut().for_each(|p| p.x += 4.0);
    scene.meshes.extend([square(material), of_faces, without]);
    let world = world(scene);
    for (x, y) in POINTS {
        let near = |found: Rgb, expected: Rgb| {
            assert!((found - expected * Rgb::new(0.5, 1.0, 0.25)).length() < 2e-6, "({x}, {y}): {found}");
        };
        near(albedo(&world, x, y), colour(x, y));
        near(albedo(&world, x + 2.0, y), CORNERS[usize::from(y > x)]);
        near(albedo(&world, x + 4.0, y), Rgb::ONE);
    }
    // The mean stands for the material where no point is known: of the corners on each triangle, of the faces.
    let of_vertices = (CORNERS[0] * 2.0 + CORNERS[1] + CORNERS[2] * 2.0 + CORNERS[3]) / 6.0;
    let mean = 0.5 * of_vertices + 0.25 * (CORNERS[0] + CORNERS[1]);
    let found = world.materials.average(material).base_brdf() * PI;
    assert!((found - mean * Rgb::new(0.5, 1.0, 0.25)).length() < 1e-6, "{found}");
}

#[test]
fn an_attribute_times_an_image_is_their_product_and_no_mean_of_texels() {
    let mut scene = scene(Camera::default(), [1, 1]);
    let texels = [Rgb::new(0.2, 1.0, 0.5), Rgb::new(1.0, 0.3, 0.8)];
    let image = add_texture(&mut scene, Texture { filter: Filter::Nearest, ..texture(2, &texels) });
    let texture = add_attribute_texture(&mut scene, COLOUR, Some(image));
    let diffuse = Reflectance::Textured { texture, scale: Rgb::ONE };
    let material = add_material(&mut scene, Material { diffuse, ..Material::default() });
    scene.meshes.push(square(material));
    let world = world(scene);
    for (x, y) in POINTS {
        let expected = colour(x, y) * texels[usize::from(x > 0.5)];
        let found = albedo(&world, x, y);
        assert!((found - expected).length() < 2e-6, "({x}, {y}): {found} {expected}");
    }
    assert!(!world.materials.averages_texels(material) && !world.filters_textures());
}

#[test]
fn light_passes_where_an_attribute_leaves_gaps() {
    let mut scene = scene(Camera::default(), [1, 1]);
    let texture = add_attribute_texture(&mut scene, COLOUR, None);
    let opacity = Some(Parameter::Textured { texture, scale: 0.75 });
    let material = add_material(&mut scene, Material { opacity, ..diffuse(Rgb::ONE) });
    scene.meshes.push(square(material));
    let world = world(scene);
    for (x, y) in POINTS {
        let found = world.transmittance(&Ray::between(Vec3::new(x, y, 1.0), Vec3::new(x, y, -1.0)));
        let expected = 1.0 - 0.75 * luminance(colour(x, y));
        assert!((found - Rgb::splat(expected)).length() < 1e-5, "({x}, {y}): {found} {expected}");
        albedo(&world, x, y);
    }
}

#[test]
fn emission_follows_an_attribute() {
    let mut scene = scene(Camera::default(), [1, 1]);
    let texture = Some(add_attribute_texture(&mut scene, COLOUR, None));
    let material = add_material(&mut scene, diffuse(Rgb::ZERO));
    let radiance = Rgb::new(3.0, 1.0, 2.0);
    let emission = Some(Emission { radiance, texture, two_sided: false });
    scene.meshes.push(Mesh { emission, ..square(material) });
    let world = world(scene);
    for (x, y) in POINTS {
        let surface = world.intersect(&down(x, y)).expect("the square");
        let found = world.emitted(&surface, Vec3::Z);
        assert!((found - radiance * colour(x, y)).length() < 1e-5, "({x}, {y}): {found}");
    }
    let light = &world.emitters.areas[0];
    let mean = (CORNERS[0] * 2.0 + CORNERS[1] + CORNERS[2] * 2.0 + CORNERS[3]) / 6.0;
    let expected = PI * luminance(radiance * mean);
    assert!((light.power / expected - 1.0).abs() < 1e-5, "{} {expected}", light.power);
    let mut sum = Rgb::ZERO;
    for i in 0..256 {
        let point = light.sample(owen_sobol_2d(i, 1));
        let (found, at) = (light.radiance(&point, Vec3::Z), point.position);
        assert!((found - radiance * colour(at.x, at.y)).length() < 1e-4, "{at}: {found}");
        sum += found / 256.0;
    }
    assert!((sum - radiance * mean).length() < 0.02, "{sum}");
    assert!((light.relative(radiance * CORNERS[1]) - radiance * CORNERS[1] / 2.7).length() < 1e-6);
}

#[test]
fn roughness_follows_an_attribute() {
    let (wo, wi) = (Vec3::new(0.3, 0.2, 0.9).normalize(), Vec3::new(-0.5, 0.1, 0.8).normalize());
    let value = |roughness: Roughness, values: Option<[f32; 4]>| {
        let mut scene = scene(Camera::default(), [1, 1]);
        add_attribute_texture(&mut scene, COLOUR, None);
        let mut metal = rough_metal(0.5, 1.0);
        let Lobe::Rough { alpha, .. } = &mut metal.lobes[0] else { unreachable!("a rough lobe") };
        *alpha = roughness;
        let material = add_material(&mut scene, metal);
        let mut mesh = square(material);
        if let Some(values) = values {
            mesh.attributes[0].values = AttributeValues::Vertices(values.map(Rgb::splat).to_vec());
        }
        scene.meshes.push(mesh);
        let world = world(scene);
        let surface = world.intersect(&down(0.75, 0.25)).expect("the square");
        world.bsdf(&surface).eval(wo, wi)
    };
    // The value at (3/4, 1/4) is the sum of a quarter, a half and a quarter of the first three corners.
    let texture = TextureId::of_attribute(0);
    let textured = value(Roughness::Textured { texture, scale: 0.5 }, Some([0.2, 0.6, 1.0, 0.0]));
    let constant = value(Roughness::Constant(0.3), None);
    // Levels of roughness are within 1.1 %.
    assert!((textured / constant - 1.0).abs().max_element() < 0.03, "{textured} {constant}");
}
