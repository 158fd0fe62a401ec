//! Emitters that the camera is not to show.

use super::World;
use super::sheets::beyond;
use embree::Ray;

/// Maximum number of emitting surfaces one behind the other that are hidden.
const MAX_HIDDEN: u32 = 64;

impl World {
    /// The rest of a ray of the camera behind the emitters that are hidden from it.
    #[inline]
    pub fn behind_hidden(&self, ray: Ray) -> Ray {
        if !self.scene.hides_emitters { ray } else { self.behind_emitters(ray) }
    }

    fn behind_emitters(&self, mut ray: Ray) -> Ray {
        for _ in 0..MAX_HIDDEN {
            match self.intersect(&ray) {
                Some(surface) if self.scene.meshes[surface.mesh as usize].emission.is_some() => {
                    ray = beyond(&ray, surface.position, surface.normal, surface.t);
                }
                _ => break,
            }
        }
        ray
    }
}
