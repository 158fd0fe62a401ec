//! Small scenes made in memory, for the tests of all crates from here up.
#![allow(missing_docs)]

use crate::World;
use crate::view::View;
use base::math::Rgb;
use glam::{Mat3, Vec2, Vec3};
use scene::{
    Camera, Distribution, Emission, Filter, Fresnel, Lobe, Material, MaterialId, Mesh, Parameter,
    Reflectance, Roughness, Scene, Texels, Texture, TextureId, Wrap,
};
use std::ops::{Deref, DerefMut};

pub fn camera(origin: Vec3, target: Vec3, tan_half_x: f32) -> Camera {
    let forward = (target - origin).normalize();
    let helper = if forward.y.abs() > 0.9 { Vec3::Z } else { Vec3::Y };
    let right = forward.cross(helper).normalize();
    Camera { origin, forward, right, up: right.cross(forward), tan_half_x, ..Camera::default() }
}

/// A scene being built, and its view.
#[derive(Clone)]
pub struct SceneAndView {
    pub scene: Scene,
    pub view: View,
}

impl Deref for SceneAndView {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        &self.scene
    }
}

impl DerefMut for SceneAndView {
    fn deref_mut(&mut self) -> &mut Scene {
        &mut self.scene
    }
}

/// A world and its view.
pub struct WorldAndView {
    pub world: World,
    pub view: View,
}

impl Deref for WorldAndView {
    type Target = World;

    fn deref(&self) -> &World {
        &self.world
    }
}

pub fn scene(camera: Camera, resolution: [u32; 2]) -> SceneAndView {
    let scene = Scene { name: "test".into(), ..Scene::default() };
    SceneAndView { scene, view: View::whole(camera, resolution) }
}

/// Returns a world's scene and view for changes.
pub fn staged(WorldAndView { world, view }: WorldAndView) -> SceneAndView {
    SceneAndView { scene: world.scene, view }
}

pub fn diffuse(reflectance: Rgb) -> Material {
    Material {
        name: "diffuse".into(),
        two_sided: true,
        diffuse: Reflectance::Constant(reflectance),
        ..Material::default()
    }
}

pub fn mirror() -> Material {
    Material {
        lobes: vec![Lobe::Mirror { fresnel: Fresnel::One, scale: Reflectance::Constant(Rgb::ONE) }],
        ..diffuse(Rgb::ZERO)
    }
}

/// A metal of a roughness, whose facets reflect a share of the light.
pub fn rough_metal(alpha: f32, reflectance: f32) -> Material {
    let lobe = Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: Roughness::Constant(alpha),
        fresnel: Fresnel::One,
        scale: Reflectance::Constant(Rgb::splat(reflectance)),
    };
    Material { lobes: vec![lobe], ..diffuse(Rgb::ZERO) }
}

pub fn glass(eta: f32) -> Material {
    let one = Reflectance::Constant(Rgb::ONE);
    let lobes = vec![Lobe::Dielectric { eta, thin: false, reflectance: one, transmittance: one }];
    Material { lobes, ..diffuse(Rgb::ZERO) }
}

/// A thin sheet of glass that takes part of the light which passes it.
pub fn pane(eta: f32, transmittance: Rgb) -> Material {
    let (reflectance, transmittance) =
        (Reflectance::Constant(Rgb::ONE), Reflectance::Constant(transmittance));
    let lobes = vec![Lobe::Dielectric { eta, thin: true, reflectance, transmittance }];
    Material { lobes, ..diffuse(Rgb::ZERO) }
}

/// Diffuse by the texels of a texture, top row first, which repeats.
pub fn checkered(scene: &mut Scene, width: usize, texels: Vec<Rgb>) -> Material {
    let height = texels.len() / width;
    let (filter, wrap) = (Filter::Nearest, Wrap::Repeat);
    let name = "checker".into();
    let texels = Texels::new(width, &texels);
    let to_uv = Mat3::IDENTITY;
    let texture = add_texture(scene, Texture { name, width, height, texels, filter, wrap, to_uv });
    Material { diffuse: Parameter::Textured { texture, scale: Rgb::ONE }, ..diffuse(Rgb::ZERO) }
}

/// Adds a texture to a scene.
pub fn add_texture(scene: &mut Scene, texture: Texture) -> TextureId {
    let textures: Vec<Texture> = scene.textures.iter().cloned().chain([texture]).collect();
    scene.textures = textures.into();
    TextureId(scene.textures.len() as u32 - 1)
}

pub fn add_material(scene: &mut Scene, material: Material) -> MaterialId {
    scene.materials.push(material);
    MaterialId(scene.materials.len() as u32 - 1)
}

/// A scene of nothing but materials (and one 2x1 texture: red at u < 1/2, green beyond).
pub fn textured_materials(materials: Vec<Material>) -> Scene {
    Scene {
        materials,
        textures: vec![Texture {
            name: String::new(),
            width: 2,
            height: 1,
            texels: Texels::new(2, &[Rgb::X, Rgb::Y]),
            filter: Filter::Nearest,
            wrap: Wrap::Repeat,
            to_uv: Mat3::IDENTITY,
        }]
        .into(),
        ..Scene::default()
    }
}

/// A parallelogram `corner + s·a + t·b` whose front is on the side of `a × b`.
pub fn quad(corner: Vec3, a: Vec3, b: Vec3, material: MaterialId) -> Mesh {
    Mesh {
        name: "quad".into(),
        positions: vec![corner, corner + a, corner + a + b, corner + b],
        normals: Vec::new(),
        uvs: Vec::new(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material,
        emission: None,
    }
}

/// The same with texture coordinates that repeat a texture so many times along each edge.
pub fn textured(mut quad: Mesh, repeats: Vec2) -> Mesh {
    quad.uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|uv| uv * repeats).into();
    quad
}

/// The six walls of an axis-aligned box, fronts inward.
pub fn room(low: Vec3, high: Vec3, material: MaterialId) -> Vec<Mesh> {
    let d = high - low;
    let (x, y, z) = (Vec3::X * d.x, Vec3::Y * d.y, Vec3::Z * d.z);
    vec![
        quad(low, z, x, material),
        quad(low + y, x, z, material),
        quad(low, x, y, material),
        quad(low + z, y, x, material),
        quad(low, y, z, material),
        quad(low + x, z, y, material),
    ]
}

/// A square room from -1 to 1 with a lamp below its ceiling, square pixels.
pub fn lit_room(camera: Camera, size: u32) -> (SceneAndView, MaterialId) {
    let mut scene = scene(camera, [size, size]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.6, 0.5)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    let lamp = quad(Vec3::new(-0.7, 0.98, -0.3), Vec3::X * 0.4, Vec3::Z * 0.4, wall);
    scene.meshes.push(emitting(lamp, Rgb::splat(20.0)));
    (scene, wall)
}

/// Grey room lit by a square under its ceiling, with a ball in it.
pub fn room_with_ball(ball: Option<Material>) -> WorldAndView {
    let mut scene = scene(camera(Vec3::new(0.0, 0.0, 0.95), Vec3::new(0.0, -0.3, 0.0), 0.9), [32, 32]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.5, 0.6)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    let corner = Vec3::new(-0.3, 0.99, -0.3);
    let lamp = quad(corner, Vec3::X * 0.6, Vec3::Z * 0.6, wall);
    scene.meshes.push(emitting(lamp, Rgb::new(10.0, 9.0, 8.0)));
    if let Some(material) = ball {
        let material = add_material(&mut scene, material);
        scene.meshes.push(sphere(Vec3::new(0.2, -0.6, -0.2), 0.4, 32, material));
    }
    world(scene)
}

pub fn emitting(mut mesh: Mesh, radiance: Rgb) -> Mesh {
    mesh.emission = Some(Emission { radiance, texture: None, two_sided: false });
    mesh
}

/// A sphere with smooth normals, `n` steps around the equator.
pub fn sphere(centre: Vec3, radius: f32, n: u32, material: MaterialId) -> Mesh {
    let rows = n / 2;
    let mut mesh = quad(centre, Vec3::X, Vec3::Y, material);
    mesh.positions.clear();
    mesh.triangles.clear();
    for r in 0..=rows {
        let (sin_t, cos_t) = (std::f32::consts::PI * r as f32 / rows as f32).sin_cos();
        for c in 0..=n {
            let (sin_p, cos_p) = (std::f32::consts::TAU * c as f32 / n as f32).sin_cos();
            let normal = Vec3::new(sin_t * cos_p, cos_t, sin_t * sin_p);
            mesh.positions.push(centre + normal * radius);
            mesh.normals.push(normal);
        }
    }
    for r in 0..rows {
        for c in 0..n {
            let i = r * (n + 1) + c;
            let j = i + n + 1;
            mesh.triangles.push([i, i + 1, j]);
            mesh.triangles.push([i + 1, j + 1, j]);
        }
    }
    mesh
}

pub fn world(SceneAndView { scene, view }: SceneAndView) -> WorldAndView {
    WorldAndView { world: World::new(scene, 2).expect("the scene builds"), view }
}
