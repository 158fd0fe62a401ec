//! A scene prepared for rendering.

use crate::instances::{Instances, SeenAt};
use crate::light::Emitters;
use crate::material::{Bsdf, Materials};
use crate::meshes::{self, build};
use crate::relief::Reliefs;
use crate::specular::Specular;
use crate::surface::Surface;
use crate::triangle::{Triangle, Triangles};
use base::math::{Frame, Placement, Rgb};
use embree::{Accel, Device, EmbreeError, Hit, Ray, TriangleId};
use glam::{Vec2, Vec3};
use scene::{MaterialId, Mesh, Scene};

/// A scene with all tables that rendering needs.
pub struct World {
    /// The scene as loaded.
    pub scene: Scene,
    /// Ray queries over the meshes.
    pub accel: Accel,
    /// Materials, looked up at points.
    pub materials: Materials,
    /// Emitters of light.
    pub emitters: Emitters,
    /// Surfaces with mirrors, glass and sharp lobes.
    pub specular: Specular,
    /// Extent from which lengths that depend on scale derive: the diagonal of all surfaces, limited by
    /// [`Scene::extent`]; 1 if there are no surfaces.
    pub diagonal: f32,
    /// Seen meshes, if some are in groups.
    pub(super) instances: Option<Instances>,
    pub(super) triangles: Triangles,
    /// Reliefs, if there are any.
    pub(super) reliefs: Option<Reliefs>,
    /// Ray queries over the surfaces that light passes straight through, if there are any.
    pub(super) sheets: Option<Accel>,
    pub(super) absorption: Absorption,
}

impl World {
    /// Builds the world. `threads` is the number of Embree's build threads.
    ///
    /// # Errors
    /// If Embree cannot build an acceleration structure.
    pub fn new(scene: Scene, threads: usize) -> Result<World, EmbreeError> {
        let device = Device::new(threads)?;
        let materials = Materials::new(&scene);
        let accel = build(&device, &scene, &materials)?;
        let diagonal = match accel.bounds() {
            Some((low, high)) if high != low => (high - low).length(),
            _ => 1.0,
        };
        let emitters = Emitters::new(&scene, diagonal);
        let diagonal = scene.extent(diagonal);
        let specular = Specular::new(&scene, &materials);
        let (instances, triangles) = (Instances::new(&scene), Triangles::new(&scene));
        let sheets = meshes::sheets(&scene, &materials, &accel)?;
        let reliefs = Reliefs::new(&scene);
        let absorption = Absorption::new(&scene);
        Ok(World {
            scene,
            accel,
            materials,
            emitters,
            specular,
            diagonal,
            instances,
            triangles,
            reliefs,
            sheets,
            absorption,
        })
    }

    /// Returns the nearest surface along a ray.
    #[inline]
    pub fn intersect(&self, ray: &Ray) -> Option<Surface> {
        self.accel.closest_hit(ray).map(|hit| self.surface_from(&hit, -ray.direction))
    }

    /// Returns the surface at a hit, with the relief as it is without a viewer.
    #[inline]
    pub fn surface(&self, hit: &Hit) -> Surface {
        self.surface_from(hit, Vec3::ZERO)
    }

    /// Returns the surface at a hit, seen from the vector `out`.
    #[inline]
    fn surface_from(&self, hit: &Hit, out: Vec3) -> Surface {
        let barycentric = Vec2::new(hit.u, hit.v);
        self.with_triangle(hit.geometry, hit.primitive, |seen, triangle| {
            let mut surface = Surface {
                position: triangle.position(barycentric),
                normal: triangle.normal,
                frame: Frame::from_normal(seen.shading_normal(triangle, barycentric)),
                barycentric,
                mesh: hit.geometry,
                triangle: hit.primitive,
                t: hit.t,
                footprint: Vec3::ZERO,
            };
            if let Some(reliefs) = &self.reliefs {
                reliefs.turn(&mut surface, seen, triangle, out);
            }
            surface
        })
    }

    /// Returns the unit geometric normal of a triangle, on the front by winding.
    #[inline]
    pub fn geometric_normal(&self, mesh: u32, triangle: u32) -> Vec3 {
        let stored = self.triangles.get(mesh, triangle).normal;
        self.placement(mesh).map_or(stored, |placement| placement.normal(stored))
    }

    /// Returns corner 0 of a triangle, and the edges from there to corners 1 and 2.
    #[inline]
    pub fn corner_and_edges(&self, id: TriangleId) -> (Vec3, [Vec3; 2]) {
        self.with_triangle(id.geometry, id.primitive, |_, triangle| (triangle.corner, triangle.edges))
    }

    /// Returns the BSDF of a surface at its texture coordinates.
    #[inline]
    pub fn bsdf(&self, s: &Surface) -> Bsdf<'_> {
        let mesh = self.mesh(s.mesh);
        let uv = || mesh.uv(&self.triangles.get(s.mesh, s.triangle).vertices, s.barycentric);
        let covered = || self.covered(s.mesh, s.triangle, s.footprint);
        let attribute = |id| mesh.attribute(id, s.triangle as usize, s.barycentric);
        let bsdf = self.materials.at_coordinates(mesh.material, uv, covered, attribute);
        bsdf.on_relief(|| self.level_normal(s))
    }

    /// Returns the normal of a surface without its relief, in the shading frame.
    pub fn level_normal(&self, s: &Surface) -> Vec3 {
        let level = |seen: SeenAt, triangle: &Triangle| seen.shading_normal(triangle, s.barycentric);
        s.frame.to_local(self.with_triangle(s.mesh, s.triangle, level))
    }

    /// Returns the radiance that a surface emits towards the unit vector `out`: as much as the surface is opaque there.
    #[inline]
    pub fn emitted(&self, s: &Surface, out: Vec3) -> Rgb {
        match self.emitters.area(s.mesh) {
            Some(light) => light.emitted(s.triangle, s.barycentric, s.normal, out),
            None => Rgb::ZERO,
        }
    }

    /// Returns the albedo that guides denoisers, towards the unit vector `out`, from 0 to 1: the larger of the share of
    /// light that `bsdf` reflects and the emitted radiance relative to the maximum of the mesh.
    #[inline]
    pub fn guide_albedo(&self, s: &Surface, bsdf: &Bsdf, out: Vec3) -> Rgb {
        let albedo = bsdf.albedo(s.frame.to_local(out)).min(Rgb::ONE);
        match self.emitters.area(s.mesh) {
            Some(light) => albedo.max(light.relative(self.emitted(s, out))),
            None => albedo,
        }
    }

    /// Returns true if some shading frames are turned by reliefs or towards the axes of anisotropic materials.
    #[inline]
    pub fn turns_frames(&self) -> bool {
        self.reliefs.is_some()
    }

    /// Returns true if some textures are averaged over footprints.
    #[inline]
    pub fn filters_textures(&self) -> bool {
        self.materials.filter_textures()
    }

    /// Returns the side, in texture coordinates, of a square as large as the area that a cone with the given footprint
    /// (see [`super::Surface`]) covers of a triangle's plane.
    #[inline]
    pub(super) fn covered(&self, mesh: u32, primitive: u32, footprint: Vec3) -> f32 {
        let covered =
            |triangle: &Triangle| scene::texture::covered(triangle.uv_scale, triangle.normal, footprint);
        self.with_triangle(mesh, primitive, |_, triangle| covered(triangle))
    }
}

/// Absorption coefficients of a scene.
#[derive(Clone, Debug, Default)]
pub(super) struct Absorption {
    /// Coefficient by seen mesh, 0 for those that do not absorb; empty if no mesh does.
    by_mesh: Vec<Rgb>,
}

impl Absorption {
    /// Collects the coefficients of a scene.
    pub fn new(scene: &Scene) -> Absorption {
        let of = |id: usize| scene.materials.get(id).and_then(|material| material.interior_absorption());
        let by_mesh: Vec<Rgb> =
            scene.meshes.iter().map(|mesh| of(mesh.material.0 as usize).unwrap_or(Rgb::ZERO)).collect();
        match by_mesh.iter().all(|absorption| *absorption == Rgb::ZERO) {
            true => Absorption::default(),
            false => Absorption { by_mesh: scene.seen().map(|(mesh, _)| by_mesh[mesh]).collect() },
        }
    }

    /// Returns true if no mesh absorbs.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.by_mesh.is_empty()
    }

    /// Returns the coefficient inside a mesh; `None` if it does not absorb.
    #[inline]
    pub fn coefficient(&self, mesh: u32) -> Option<Rgb> {
        self.by_mesh.get(mesh as usize).copied().filter(|absorption| *absorption != Rgb::ZERO)
    }
}

impl World {
    /// Returns the stored mesh of a seen mesh.
    #[inline(always)]
    pub fn mesh(&self, number: u32) -> &Mesh {
        match &self.instances {
            None => &self.scene.meshes[number as usize],
            Some(instances) => &self.scene.meshes[instances.stored(number)],
        }
    }

    /// Returns the material of a seen mesh.
    #[inline(always)]
    pub fn material(&self, number: u32) -> MaterialId {
        self.mesh(number).material
    }

    /// Returns the placement of a seen mesh, if it has one.
    #[inline(always)]
    pub(super) fn placement(&self, number: u32) -> Option<&Placement> {
        self.instances.as_ref().and_then(|instances| instances.placement(number))
    }

    /// Returns a seen mesh at its place.
    #[inline(always)]
    pub(super) fn seen(&self, number: u32) -> SeenAt<'_> {
        SeenAt { mesh: self.mesh(number), placement: self.placement(number) }
    }

    /// Returns what `of` returns for a triangle of a seen mesh, in the scene's coordinates.
    #[inline(always)]
    pub(super) fn with_triangle<T>(
        &self,
        number: u32,
        primitive: u32,
        of: impl Fn(SeenAt, &Triangle) -> T,
    ) -> T {
        let stored = self.triangles.get(number, primitive);
        match &self.instances {
            // Worlds without instances neither copy triangles nor ask for placements.
            None => of(SeenAt::own(&self.scene.meshes[number as usize]), stored),
            Some(_) => {
                let seen = self.seen(number);
                of(seen, &seen.triangle(stored))
            }
        }
    }
}
