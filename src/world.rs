//! A scene made ready to render: acceleration structure, material tables and emitters beside the data.
//!
//! Units: positions relative to the scene's centre. A `World` is immutable and shared by all threads.

use crate::embree::{Accel, Device, EmbreeError, Hit, Ray, TriangleMesh};
use crate::light::{Emitters, emitted};
use crate::material::{Bsdf, Materials};
use crate::math::{Frame, Rgb};
use crate::scene::Scene;
use crate::shadow;
use glam::{Vec2, Vec3};

/// Everything a method needs to know of a scene.
pub struct World {
    /// The scene as loaded.
    pub scene: Scene,
    /// Ray queries over its meshes.
    pub accel: Accel,
    /// Per-material tables.
    pub materials: Materials,
    /// What shines.
    pub emitters: Emitters,
    /// Diagonal of the bounds of all surfaces; 1 if there are none. Lengths that depend on scale derive from it.
    pub diagonal: f32,
}

/// A point on a surface, seen along a ray.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal, on the front by winding.
    pub normal: Vec3,
    /// Shading frame; its z axis is the interpolated normal, on the front as the mesh says.
    pub frame: Frame,
    /// Barycentric weights of corners 1 and 2.
    pub barycentric: Vec2,
    /// Mesh index.
    pub mesh: u32,
    /// Triangle of that mesh.
    pub triangle: u32,
    /// Distance along the ray in units of its direction.
    pub t: f32,
}

impl World {
    /// Builds what rendering needs; `threads` is Embree's number for the build.
    pub fn new(scene: Scene, threads: usize) -> Result<World, EmbreeError> {
        let device = Device::new(threads)?;
        let meshes: Vec<TriangleMesh> = scene
            .meshes
            .iter()
            .map(|m| TriangleMesh { positions: &m.positions, triangles: &m.triangles, mask: u32::MAX })
            .collect();
        let accel = Accel::build(&device, &meshes)?;
        let diagonal = match accel.bounds() {
            Some((low, high)) if high != low => (high - low).length(),
            _ => 1.0,
        };
        let materials = Materials::new(&scene);
        let emitters = Emitters::new(&scene, diagonal);
        Ok(World { scene, accel, materials, emitters, diagonal })
    }

    /// The nearest surface along a ray.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        self.accel.closest_hit(ray).map(|hit| self.surface(&hit))
    }

    /// The surface at a hit.
    #[inline]
    pub fn surface(&self, hit: &Hit) -> Surface {
        let mesh = &self.scene.meshes[hit.geometry as usize];
        let [i, j, k] = mesh.triangles[hit.primitive as usize].map(|i| i as usize);
        let (a, b, c) = (mesh.positions[i], mesh.positions[j], mesh.positions[k]);
        let (e1, e2) = (b - a, c - a);
        let normal = unit_normal(e1, e2);
        let w = 1.0 - hit.u - hit.v;
        let shading = if mesh.normals.is_empty() {
            normal
        } else {
            let n = mesh.normals[i] * w + mesh.normals[j] * hit.u + mesh.normals[k] * hit.v;
            n.try_normalize().unwrap_or(normal)
        };
        Surface {
            position: a * w + b * hit.u + c * hit.v,
            normal,
            frame: Frame::from_normal(shading),
            barycentric: Vec2::new(hit.u, hit.v),
            mesh: hit.geometry,
            triangle: hit.primitive,
            t: hit.t,
        }
    }

    /// How the surface scatters, textures looked up.
    #[inline]
    pub fn bsdf(&self, s: &Surface) -> Bsdf<'_> {
        let mesh = &self.scene.meshes[s.mesh as usize];
        self.materials.at(&self.scene, mesh.material, mesh.uv(s.triangle as usize, s.barycentric))
    }

    /// Radiance the surface emits towards the unit vector `out`.
    #[inline]
    pub fn emitted(&self, s: &Surface, out: Vec3) -> Rgb {
        emitted(&self.scene, s.mesh, s.triangle, s.barycentric, s.normal, out)
    }

    /// Whether the segment between two surface points is free. A zero normal marks a point that lies on no surface.
    #[inline]
    pub fn visible(&self, a: Vec3, a_normal: Vec3, b: Vec3, b_normal: Vec3) -> bool {
        !self.accel.occluded(&shadow::segment(a, a_normal, b, b_normal))
    }

    /// Whether nothing is met from a surface point on in a direction.
    #[inline]
    pub fn escapes(&self, a: Vec3, a_normal: Vec3, direction: Vec3) -> bool {
        !self.accel.occluded(&shadow::ray_from(a, a_normal, direction))
    }
}

/// Unit normal of a triangle from two edges, scaled first so that tiny triangles do not underflow.
#[inline]
fn unit_normal(e1: Vec3, e2: Vec3) -> Vec3 {
    let cross = e1.cross(e2);
    let length_sq = cross.length_squared();
    if length_sq > 1e-30 && length_sq < 1e30 {
        return cross / length_sq.sqrt();
    }
    let scale = e1.abs().max_element().max(e2.abs().max_element());
    (e1 / scale).cross(e2 / scale).try_normalize().unwrap_or(Vec3::Z)
}
