//! Small scenes in memory, for the unit tests of this crate and of all crates above it (feature `testkit`).
//!
//! A test starts from [`scene`], adds materials and meshes to it, and calls [`world`]; or it starts from a preset:
//! [`lit_room`] and [`room_with_ball`] are closed rooms with an area light.

use crate::World;
use crate::view::View;
use base::math::Rgb;
use glam::{Mat3, Vec2, Vec3};
use scene::{
    AttributeId, AttributeTexture, Camera, Distribution, Emission, Filter, Fresnel, Lobe, Material,
    MaterialId, Mesh, Parameter, Reflectance, Roughness, Scene, Texels, Texture, TextureId, Textures, Wrap,
};
use std::ops::{Deref, DerefMut};

/// Returns a pinhole camera at `origin` that looks at `target`. `tan_half_x` is the tangent of half the horizontal
/// field of view.
pub fn camera(origin: Vec3, target: Vec3, tan_half_x: f32) -> Camera {
    let forward = (target - origin).normalize();
    let helper = if forward.y.abs() > 0.9 { Vec3::Z } else { Vec3::Y };
    let right = forward.cross(helper).normalize();
    Camera { origin, forward, right, up: right.cross(forward), tan_half_x, ..Camera::default() }
}

/// Returns the camera of the presets: near the front wall of a room from -1 to 1, looking slightly down.
pub fn room_camera() -> Camera {
    camera(Vec3::new(0.0, 0.0, 0.95), Vec3::new(0.0, -0.3, 0.0), 0.9)
}

/// A scene under construction and its view.
#[derive(Clone)]
pub struct SceneAndView {
    /// The scene.
    pub scene: Scene,
    /// Camera and film.
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
    /// The world.
    pub world: World,
    /// Camera and film.
    pub view: View,
}

impl Deref for WorldAndView {
    type Target = World;

    fn deref(&self) -> &World {
        &self.world
    }
}

/// Returns an empty scene that `camera` sees on a film of `resolution` pixels.
pub fn scene(camera: Camera, resolution: [u32; 2]) -> SceneAndView {
    let scene = Scene { name: "test".into(), ..Scene::default() };
    SceneAndView { scene, view: View::whole(camera, resolution) }
}

/// Takes a world apart, to change its scene.
pub fn staged(staged: WorldAndView) -> SceneAndView {
    SceneAndView { scene: staged.world.scene, view: staged.view }
}

/// Returns a two-sided Lambertian material.
pub fn diffuse(reflectance: Rgb) -> Material {
    Material {
        name: "diffuse".into(),
        two_sided: true,
        diffuse: Reflectance::Constant(reflectance),
        ..Material::default()
    }
}

/// Returns a perfect mirror that absorbs nothing.
pub fn mirror() -> Material {
    Material {
        lobes: vec![Lobe::Mirror { fresnel: Fresnel::One, scale: Reflectance::Constant(Rgb::ONE) }],
        ..diffuse(Rgb::ZERO)
    }
}

/// Returns a rough metal (GGX) whose facets reflect the share `reflectance` of the light.
pub fn rough_metal(alpha: f32, reflectance: f32) -> Material {
    let lobe = Lobe::Rough {
        distribution: Distribution::Ggx,
        alpha: Roughness::Constant(alpha),
        fresnel: Fresnel::One,
        scale: Reflectance::Constant(Rgb::splat(reflectance)),
    };
    Material { lobes: vec![lobe], ..diffuse(Rgb::ZERO) }
}

/// Returns clear solid glass of the given index of refraction.
pub fn glass(eta: f32) -> Material {
    let one = Reflectance::Constant(Rgb::ONE);
    let lobes = vec![Lobe::Dielectric { eta, thin: false, reflectance: one, transmittance: one }];
    Material { lobes, ..diffuse(Rgb::ZERO) }
}

/// Returns a thin sheet of tinted glass.
pub fn pane(eta: f32, transmittance: Rgb) -> Material {
    let (reflectance, transmittance) =
        (Reflectance::Constant(Rgb::ONE), Reflectance::Constant(transmittance));
    let lobes = vec![Lobe::Dielectric { eta, thin: true, reflectance, transmittance }];
    Material { lobes, ..diffuse(Rgb::ZERO) }
}

/// Adds a repeating texture of the given texels, top row first, and returns a Lambertian material of its colours.
pub fn checkered(scene: &mut Scene, width: usize, texels: Vec<Rgb>) -> Material {
    let texture = add_texture(scene, texture(width, &texels));
    Material { diffuse: Parameter::Textured { texture, scale: Rgb::ONE }, ..diffuse(Rgb::ZERO) }
}

/// Returns a repeating texture of the given texels, top row first, without interpolation.
pub fn texture(width: usize, texels: &[Rgb]) -> Texture {
    Texture {
        name: "texture".into(),
        width,
        height: texels.len() / width,
        texels: Texels::new(width, texels),
        filter: Filter::Nearest,
        wrap: Wrap::Repeat,
        to_uv: Mat3::IDENTITY,
    }
}

/// Adds a texture to a scene.
pub fn add_texture(scene: &mut Scene, texture: Texture) -> TextureId {
    let textures: Vec<Texture> = scene.textures.iter().cloned().chain([texture]).collect();
    scene.textures = Textures::from(textures).with_attributes(scene.textures.attributes().to_vec());
    TextureId(scene.textures.len() as u32 - 1)
}

/// Adds a texture to a scene that is an attribute of meshes, times an image if there is one.
pub fn add_attribute_texture(
    scene: &mut Scene,
    attribute: AttributeId,
    image: Option<TextureId>,
) -> TextureId {
    let mut attributes = scene.textures.attributes().to_vec();
    attributes.push(AttributeTexture { attribute, image, cut: None });
    let texture = TextureId::of_attribute(attributes.len() - 1);
    scene.textures = scene.textures.clone().with_attributes(attributes);
    texture
}

/// Adds a material to a scene.
pub fn add_material(scene: &mut Scene, material: Material) -> MaterialId {
    scene.materials.push(material);
    MaterialId(scene.materials.len() as u32 - 1)
}

/// Returns a scene without meshes: the materials, and one texture that is red for u < 1/2 and green for u > 1/2.
pub fn textured_materials(materials: Vec<Material>) -> Scene {
    let textures = vec![texture(2, &[Rgb::X, Rgb::Y])].into();
    Scene { materials, textures, ..Scene::default() }
}

/// Returns the parallelogram `corner + s·a + t·b`. Its front is on the side of `a × b`.
pub fn quad(corner: Vec3, a: Vec3, b: Vec3, material: MaterialId) -> Mesh {
    Mesh {
        name: "quad".into(),
        positions: vec![corner, corner + a, corner + a + b, corner + b],
        normals: Vec::new(),
        uvs: Vec::new(),
        tangents: Vec::new(),
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material,
        emission: None,
        attributes: Vec::new(),
    }
}

/// Gives a parallelogram texture coordinates from 0 to `repeats` along its edges.
pub fn textured(mut quad: Mesh, repeats: Vec2) -> Mesh {
    quad.uvs = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(|uv| uv * repeats).into();
    quad
}

/// Returns the six walls of an axis-aligned box. Their fronts face inwards.
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

/// Returns a diffuse room from -1 to 1 with an area light below its ceiling, and the material of the walls. The film
/// has `size` × `size` pixels.
pub fn lit_room(camera: Camera, size: u32) -> (SceneAndView, MaterialId) {
    let mut scene = scene(camera, [size, size]);
    let wall = add_material(&mut scene, diffuse(Rgb::new(0.7, 0.6, 0.5)));
    scene.meshes.extend(room(Vec3::splat(-1.0), Vec3::ONE, wall));
    let lamp = quad(Vec3::new(-0.7, 0.98, -0.3), Vec3::X * 0.4, Vec3::Z * 0.4, wall);
    scene.meshes.push(emitting(lamp, Rgb::splat(20.0)));
    (scene, wall)
}

/// Returns a diffuse room from -1 to 1 with an area light below its ceiling, seen by [`room_camera`] on 32 × 32 pixels.
/// If a material is given, a ball of it lies in the room.
pub fn room_with_ball(ball: Option<Material>) -> WorldAndView {
    let mut scene = scene(room_camera(), [32, 32]);
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

/// Makes a mesh emit `radiance` on its front.
pub fn emitting(mut mesh: Mesh, radiance: Rgb) -> Mesh {
    mesh.emission = Some(Emission { radiance, texture: None, two_sided: false });
    mesh
}

/// Returns a sphere with interpolated normals and `n` steps around its equator.
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

/// Builds the world of a scene.
///
/// # Panics
/// If Embree cannot build it.
pub fn world(staged: SceneAndView) -> WorldAndView {
    WorldAndView { world: World::new(staged.scene, 2).expect("the scene builds"), view: staged.view }
}
