//! Work of images, counted and priced, so that choices do not depend on the machine or its load.
//!
//! [`Work`] counts what an image took. [`PRICES`] turns counts into time. [`ScenePrices`] holds the prices that depend
//! on the scene, since a ray takes longer among more triangles. Predictions of work are in [`crate::plan`].
//!
//! Units: microseconds of one core of the machine on which the prices were measured. `lightsplat bench calibrate` fits
//! them to another.

use crate::calibration::PRICES;
use serde::{Deserialize, Serialize};

/// Work that an image took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
    /// Virtual lights.
    pub vpls: u64,
    /// Eye samples besides the first ones.
    pub extra_samples: u64,
    /// Branches of eye paths that were dropped, because too many specular surfaces follow each other.
    pub dropped_branches: u64,
}

/// Prices of rays in a scene.
#[derive(Clone, Copy, Debug)]
pub struct ScenePrices {
    /// Price of a ray of a path.
    pub ray: f64,
    /// Price of a counted ray, with the work done between rays.
    pub counted_ray: f64,
}

impl ScenePrices {
    /// Returns the prices in a scene with so many triangles.
    pub fn new(triangles: usize) -> ScenePrices {
        let doublings = (triangles as f64 / PRICES.smallest_scene).max(1.0).log2();
        let ray = |by_doubling: f64| PRICES.ray + by_doubling * doublings;
        ScenePrices { ray: ray(PRICES.ray_by_doubling), counted_ray: ray(PRICES.counted_ray_by_doubling) }
    }

    /// Returns the time of counted work.
    pub fn time(&self, work: &Work) -> f64 {
        let rays = work.rays as f64 + PRICES.shadow * work.shadow_rays as f64;
        rays * self.counted_ray + work.vpls as f64 * PRICES.counted_vpl
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counted_work_is_that_of_all_rays_and_virtual_lights() {
        let prices = ScenePrices::new(32);
        let rays = Work { rays: 1_000_000, ..Work::default() };
        let of_rays = prices.time(&rays);
        assert_eq!(of_rays, 1e6 * PRICES.ray);
        let all = Work { shadow_rays: 3_000_000, vpls: 1000, extra_samples: 1 << 40, ..rays };
        assert!((prices.time(&all) - 2.5 * of_rays - 1000.0 * PRICES.counted_vpl).abs() < 1e-3);
    }

    #[test]
    fn rays_cost_more_among_more_triangles() {
        let prices = [1, 32, 64, 1 << 20].map(ScenePrices::new);
        assert_eq!(prices[0].ray, prices[1].ray);
        assert!(prices[1..].is_sorted_by(|a, b| a.ray < b.ray && a.counted_ray < b.counted_ray));
    }
}
