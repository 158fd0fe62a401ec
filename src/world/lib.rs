//! A scene prepared for rendering: acceleration structure, material tables and emitters beside the data.
//!
//! [`material`] tells how surfaces scatter, [`light`] what emits, [`shadow`] whether segments are free; [`view`] is a
//! camera and the part of its film to render.
//!
//! Units: positions relative to the scene's centre. A `World` is immutable and shared by all threads.

#![forbid(unsafe_code)]

use crate::light::{Emitters, emitted};
use crate::material::{Bsdf, Materials};
use base::math::{Frame, Rgb};
use embree::{Accel, BuildQuality, Device, Hit, TriangleId, TriangleMesh};
use glam::{Vec2, Vec3};
use scene::{Mesh, Scene};

mod footprint;
mod hidden;
pub mod light;
pub mod material;
mod packet;
mod relief;
pub mod shadow;
mod sheets;
mod specular;
#[cfg(any(test, feature = "testkit"))]
pub mod testkit;
mod towards;
mod triangle;
pub mod view;

pub use embree::{EmbreeError, Ray};
pub use packet::Surfaces16;
use relief::Reliefs;
pub use sheets::beyond;
use specular::Specular;
pub use towards::Faces;
use triangle::{Triangle, Triangles};

/// A scene with all tables that methods need.
pub struct World {
    /// The scene as loaded.
    pub scene: Scene,
    /// Ray queries over its meshes.
    pub accel: Accel,
    /// Per-material tables.
    pub materials: Materials,
    /// Emitters of light.
    pub emitters: Emitters,
    /// Mirrors and glass.
    pub specular: Specular,
    /// Diagonal of the bounds of all surfaces, or where these reach very far beyond what is around the camera, a
    /// thousand times the distance of that; 1 if there are none. Lengths that depend on scale derive from it.
    pub diagonal: f32,
    triangles: Triangles,
    /// Reliefs, if there are any.
    reliefs: Option<Reliefs>,
    /// Surfaces that light passes straight through, if there are any.
    sheets: Option<Accel>,
}

/// Returns the meshes of a scene as input of an acceleration structure.
pub fn triangle_meshes<'a>(scene: &'a Scene, materials: &Materials) -> Vec<TriangleMesh<'a>> {
    let straight: Vec<bool> = materials.averages().map(|average| average.passes_straight()).collect();
    let meshes = scene.meshes.iter().map(|mesh| TriangleMesh {
        positions: &mesh.positions,
        triangles: &mesh.triangles,
        occludes: !straight[mesh.material.0 as usize],
    });
    meshes.collect()
}

/// Unit interpolated normal at barycentric weights `b` of a triangle; its own where the mesh has none.
#[inline]
fn shading_normal(mesh: &Mesh, triangle: &Triangle, b: Vec2) -> Vec3 {
    match mesh.normal(&triangle.vertices, b) {
        Some(interpolated) => interpolated.try_normalize().unwrap_or(triangle.normal),
        None => triangle.normal,
    }
}

/// A surface point that gathers light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Position.
    pub position: Vec3,
    /// Unit shading normal, on the side that light comes from.
    pub normal: Vec3,
    /// Unit geometric normal.
    pub geometric_normal: Vec3,
}

/// A point on a surface, hit by a ray.
#[derive(Clone, Copy, Debug)]
pub struct Surface {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal, on the front by winding.
    pub normal: Vec3,
    /// Shading frame; its z axis is the interpolated normal, on the mesh's front.
    pub frame: Frame,
    /// Barycentric weights of corners 1 and 2.
    pub barycentric: Vec2,
    /// Mesh index.
    pub mesh: u32,
    /// Triangle of that mesh.
    pub triangle: u32,
    /// Distance along the ray in units of its direction.
    pub t: f32,
    /// Vector along the ray as long as the cone around it is wide here: textures are averaged over what the cone
    /// covers; zero where they are looked up at the point.
    pub footprint: Vec3,
}

impl World {
    /// Builds the world; `threads` is the number of Embree's build threads.
    pub fn new(scene: Scene, threads: usize) -> Result<World, EmbreeError> {
        let device = Device::new(threads)?;
        let materials = Materials::new(&scene);
        let accel = Accel::build(&device, &triangle_meshes(&scene, &materials))?;
        let diagonal = match accel.bounds() {
            Some((low, high)) if high != low => (high - low).length(),
            _ => 1.0,
        };
        let emitters = Emitters::new(&scene, diagonal);
        let diagonal = scene.extent(diagonal);
        let specular = Specular::new(&scene, &materials);
        let triangles = Triangles::new(&scene);
        let sheets = sheets::sheets(&scene, &materials, &accel)?;
        let reliefs = Reliefs::new(&scene);
        Ok(World { scene, accel, materials, emitters, specular, diagonal, triangles, reliefs, sheets })
    }

    /// Builds the acceleration structure anew, at another quality, for benchmarks.
    pub fn rebuild(&mut self, quality: BuildQuality) -> Result<(), EmbreeError> {
        let meshes = triangle_meshes(&self.scene, &self.materials);
        self.accel = Accel::build_with(self.accel.device(), &meshes, quality)?;
        Ok(())
    }

    /// Returns the nearest surface along a ray.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        self.accel.closest_hit(ray).map(|hit| self.surface(&hit))
    }

    /// Returns the surface at a hit.
    #[inline]
    pub fn surface(&self, hit: &Hit) -> Surface {
        let triangle = self.triangles.get(hit.geometry, hit.primitive);
        let barycentric = Vec2::new(hit.u, hit.v);
        let mesh = &self.scene.meshes[hit.geometry as usize];
        let mut frame = Frame::from_normal(shading_normal(mesh, triangle, barycentric));
        self.relieve(&mut frame, hit.geometry, triangle, barycentric);
        Surface {
            position: triangle.position(barycentric),
            normal: triangle.normal,
            frame,
            barycentric,
            mesh: hit.geometry,
            triangle: hit.primitive,
            t: hit.t,
            footprint: Vec3::ZERO,
        }
    }

    /// Unit geometric normal of a triangle, on the front by winding.
    #[inline]
    pub fn geometric_normal(&self, mesh: u32, triangle: u32) -> Vec3 {
        self.triangles.get(mesh, triangle).normal
    }

    /// Corner 0 of a triangle, and its edges from there to corners 1 and 2.
    #[inline]
    pub fn corner_and_edges(&self, id: TriangleId) -> (Vec3, [Vec3; 2]) {
        let triangle = self.triangles.get(id.geometry, id.primitive);
        (triangle.corner, triangle.edges)
    }

    /// Returns the BSDF of the surface, textures looked up.
    #[inline]
    pub fn bsdf(&self, s: &Surface) -> Bsdf<'_> {
        let mesh = &self.scene.meshes[s.mesh as usize];
        let uv = || mesh.uv(&self.triangles.get(s.mesh, s.triangle).vertices, s.barycentric);
        let covered = || self.covered(s.mesh, s.triangle, s.footprint);
        self.materials.at_coordinates(mesh.material, uv, covered)
    }

    /// Radiance the surface emits towards the unit vector `out`.
    #[inline]
    pub fn emitted(&self, s: &Surface, out: Vec3) -> Rgb {
        let mesh = &self.scene.meshes[s.mesh as usize];
        let Some(emission) = mesh.emission else { return Rgb::ZERO };
        let factor = |texture| {
            let uv = mesh.uv(&mesh.triangles[s.triangle as usize], s.barycentric);
            self.scene.textures.lookup(texture, uv)
        };
        emitted(&emission, s.normal, out, factor)
    }

    /// The albedo that guides denoisers, towards the unit vector `out`: the share of light that `bsdf` reflects, or the
    /// radiance emitted over the greatest of the surface's mesh, whichever is more, from 0 to 1.
    #[inline]
    pub fn guide_albedo(&self, s: &Surface, bsdf: &Bsdf, out: Vec3) -> Rgb {
        let albedo = bsdf.albedo(s.frame.to_local(out)).min(Rgb::ONE);
        match self.emitters.area(s.mesh) {
            Some(light) => albedo.max(light.relative(self.emitted(s, out))),
            None => albedo,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testkit::diffuse;
    use embree::Hits16;
    use scene::MaterialId;

    /// A triangle in the plane z = 2 whose front is below, and a tiny one.
    fn world(normals: Vec<Vec3>) -> World {
        let mesh = |positions, normals| Mesh {
            name: String::new(),
            positions,
            normals,
            uvs: Vec::new(),
            triangles: vec![[0, 1, 2]],
            material: MaterialId(0),
            emission: None,
        };
        let triangle = vec![Vec3::new(0.0, 0.0, 2.0), Vec3::new(0.0, 3.0, 2.0), Vec3::new(4.0, 0.0, 2.0)];
        let tiny = [Vec3::ZERO, Vec3::X, Vec3::Z].map(|v| v * 1e-20);
        let meshes = vec![mesh(triangle, normals), mesh(tiny.to_vec(), Vec::new())];
        World::new(Scene { meshes, materials: vec![diffuse(Rgb::ONE)], ..Scene::default() }, 1)
            .expect("a world")
    }

    /// The hit of a ray straight up at (x, y).
    fn above(world: &World, x: f32, y: f32) -> Option<Surface> {
        world.intersect(&Ray {
            origin: Vec3::new(x, y, 0.5),
            t_near: 0.0,
            direction: Vec3::Z * 0.5,
            t_far: 9.0,
        })
    }

    #[test]
    fn a_hit_is_where_the_ray_meets_the_triangle() {
        let world = world(Vec::new());
        let s = above(&world, 1.0, 1.5).expect("a hit");
        assert!((s.position - Vec3::new(1.0, 1.5, 2.0)).length() < 1e-6);
        assert!((s.barycentric - Vec2::new(0.5, 0.25)).length() < 1e-6);
        assert!((s.t - 3.0).abs() < 1e-6 && (s.mesh, s.triangle) == (0, 0));
        // The front is where the corners go round anticlockwise.
        assert_eq!((s.normal, s.frame.normal), (-Vec3::Z, -Vec3::Z));
        assert!(above(&world, 3.0, 1.5).is_none());
    }

    #[test]
    fn geometric_normals_follow_the_winding_of_the_smallest_triangles_too() {
        let world = world(Vec::new());
        assert_eq!(world.geometric_normal(0, 0), -Vec3::Z);
        assert!((world.geometric_normal(1, 0) + Vec3::Y).length() < 1e-6);
        let (corner, edges) = world.corner_and_edges(TriangleId { geometry: 0, primitive: 0 });
        assert_eq!((corner, edges), (Vec3::Z * 2.0, [Vec3::Y * 3.0, Vec3::X * 4.0]));
    }

    #[test]
    fn shading_normals_are_interpolated_unless_they_cancel() {
        let tilted = world(vec![-Vec3::Z, Vec3::new(0.0, 0.6, -0.8), Vec3::new(0.6, 0.0, -0.8)]);
        let s = above(&tilted, 1.0, 1.5).expect("a hit");
        let expected = (-Vec3::Z * 0.25 + Vec3::new(0.0, 0.6, -0.8) * 0.5 + Vec3::new(0.6, 0.0, -0.8) * 0.25)
            .normalize();
        assert!((s.frame.normal - expected).length() < 1e-6 && s.normal == -Vec3::Z);
        let cancelling = world(vec![Vec3::X, -Vec3::X, Vec3::ZERO]);
        let degenerate = Hit { t: 1.0, u: 0.5, v: 0.0, geometry: 0, primitive: 0 };
        assert_eq!(cancelling.surface(&degenerate).frame.normal, -Vec3::Z);
    }

    #[test]
    fn sixteen_surfaces_are_those_of_each_hit() {
        let world = world(vec![Vec3::X, -Vec3::X, Vec3::new(0.6, 0.0, -0.8)]);
        let mut hits = Hits16::default();
        for lane in 0..16 {
            (hits.u[lane], hits.v[lane], hits.t[lane]) = (lane as f32 / 32.0, 0.5 - lane as f32 / 32.0, 1.5);
        }
        let all = world.surfaces(&hits);
        for lane in 0..16 {
            let hit = Hit { t: 1.5, u: hits.u[lane], v: hits.v[lane], geometry: 0, primitive: 0 };
            assert_eq!(format!("{:?}", all.get(lane)), format!("{:?}", world.surface(&hit)));
        }
    }

    #[test]
    fn the_diagonal_is_that_of_all_surfaces() {
        assert!((world(Vec::new()).diagonal - Vec3::new(4.0, 3.0, 2.0).length()).abs() < 1e-5);
        assert_eq!(World::new(Scene::default(), 1).expect("an empty world").diagonal, 1.0);
    }
}
