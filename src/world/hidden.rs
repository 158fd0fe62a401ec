//! Emitters that are hidden from the camera.

use super::World;
use super::sheets::beyond;
use embree::Ray;

/// Maximum number of emitting surfaces along a ray that are hidden.
const MAX_HIDDEN: u32 = 64;

impl World {
    /// Returns the rest of a camera ray behind the emitters that are hidden from it.
    #[inline]
    pub fn behind_hidden(&self, ray: Ray) -> Ray {
        if !self.scene.hides_emitters { ray } else { self.behind_emitters(ray) }
    }

    /// Returns the rest of a ray behind the emitters in front.
    fn behind_emitters(&self, mut ray: Ray) -> Ray {
        for _ in 0..MAX_HIDDEN {
            match self.intersect(&ray) {
                Some(surface) if self.mesh(surface.mesh).emission.is_some() => {
                    ray = beyond(&ray, surface.position, surface.normal, surface.t);
                }
                _ => break,
            }
        }
        ray
    }
}
