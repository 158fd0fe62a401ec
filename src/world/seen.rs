//! Meshes and triangles of a world by number of seen mesh.

use super::World;
use super::instances::SeenAt;
use super::triangle::Triangle;
use base::math::Placement;
use scene::{MaterialId, Mesh};

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
