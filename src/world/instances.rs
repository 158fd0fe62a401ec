//! Meshes that are stored once and seen at several places.
//!
//! Hits and surfaces carry the number of a seen mesh (see [`scene::Group`]). Here alone its triangles, normals and
//! tangents are moved to the scene's coordinates. All other code sees what it would see of a copy.
//!
//! Precision: Embree moves rays to the coordinates of the group, and a point is moved back from there. Both round
//! relative to the distance between the origin and the group's place, not to the coordinates of the point. Readers
//! choose the origin outside of the box of all surfaces. So coordinates of points are at least as large, and offsets of
//! rays cover this rounding.

use super::triangle::Triangle;
use base::math::Placement;
use glam::{Vec2, Vec3, Vec4};
use scene::{Mesh, Scene, interpolated};

/// Placement of a mesh that has none.
const OWN: u32 = u32::MAX;

/// Stored meshes and placements by number of seen mesh.
pub(super) struct Instances {
    seen: Vec<SeenMesh>,
    placements: Vec<Placement>,
}

#[derive(Clone, Copy)]
struct SeenMesh {
    /// Index of the stored mesh.
    mesh: u32,
    /// Index of the placement, or [`OWN`].
    placement: u32,
}

impl Instances {
    /// Collects the seen meshes of a scene; `None` if each is stored.
    pub fn new(scene: &Scene) -> Option<Instances> {
        if scene.groups.is_empty() {
            return None;
        }
        let own = (0..scene.own_mesh_count() as u32).map(|mesh| SeenMesh { mesh, placement: OWN });
        let mut all = Instances { seen: own.collect(), placements: Vec::new() };
        for group in &scene.groups {
            for placement in &group.placements {
                let number = all.placements.len() as u32;
                let seen = |mesh: usize| SeenMesh { mesh: mesh as u32, placement: number };
                all.seen.extend(group.meshes.clone().map(seen));
                all.placements.push(*placement);
            }
        }
        Some(all)
    }

    /// Returns the index of a stored mesh.
    #[inline]
    pub fn stored(&self, number: u32) -> usize {
        self.seen[number as usize].mesh as usize
    }

    /// Returns the placement of a seen mesh, if it has one.
    #[inline]
    pub fn placement(&self, number: u32) -> Option<&Placement> {
        self.placements.get(self.seen[number as usize].placement as usize)
    }
}

/// A mesh at its place.
#[derive(Clone, Copy)]
pub(super) struct SeenAt<'a> {
    pub mesh: &'a Mesh,
    pub placement: Option<&'a Placement>,
}

impl SeenAt<'_> {
    /// Returns a mesh in the scene's coordinates.
    #[inline(always)]
    pub fn own(mesh: &Mesh) -> SeenAt<'_> {
        SeenAt { mesh, placement: None }
    }

    /// Returns a triangle in the scene's coordinates.
    #[inline]
    pub fn triangle(&self, stored: &Triangle) -> Triangle {
        match self.placement {
            None => *stored,
            Some(placement) => stored.placed(placement, self.mesh),
        }
    }

    /// Returns the unit interpolated normal at barycentric weights `b` of a triangle in the scene's coordinates; the
    /// triangle's own normal if the mesh has none or they cancel.
    #[inline]
    pub fn shading_normal(&self, triangle: &Triangle, b: Vec2) -> Vec3 {
        self.normal(&triangle.vertices, b).and_then(Vec3::try_normalize).unwrap_or(triangle.normal)
    }

    /// Returns the interpolated normal (see [`Mesh::normal`]).
    #[inline]
    pub fn normal(&self, vertices: &[u32; 3], b: Vec2) -> Option<Vec3> {
        let Some(placement) = self.placement else { return self.mesh.normal(vertices, b) };
        let placed = |normals: [Vec3; 3]| normals.map(|normal| placement.normal(normal));
        self.mesh.corner_normals(vertices).map(|normals| interpolated(placed(normals), b))
    }

    /// Returns the interpolated tangent (see [`Mesh::tangent`]).
    #[inline]
    pub fn tangent(&self, vertices: &[u32; 3], b: Vec2) -> Option<Vec4> {
        let Some(placement) = self.placement else { return self.mesh.tangent(vertices, b) };
        if self.mesh.tangents.is_empty() {
            return None;
        }
        let placed = |i| placement.tangent(self.mesh.tangents[i as usize]);
        Some(interpolated(vertices.map(placed), b))
    }
}
