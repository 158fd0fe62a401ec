//! A picture, and the bare queries measured after it.

use super::bare::Bare;
use super::picture::Picture;
use base::stats::Stage;
use std::iter::Sum;

/// A picture, and the bare queries measured after it.
pub struct Round {
    pub picture: Picture,
    pub bare: Bare,
}

/// Time of some work, and its rays.
#[derive(Clone, Copy, Default)]
pub struct Cost {
    /// Processor seconds.
    pub seconds: f64,
    /// Number of rays.
    pub rays: f64,
}

impl Sum for Cost {
    fn sum<I: Iterator<Item = Cost>>(costs: I) -> Cost {
        costs.fold(Cost::default(), |sum, cost| Cost {
            seconds: sum.seconds + cost.seconds,
            rays: sum.rays + cost.rays,
        })
    }
}

impl Cost {
    /// Returns the cost of rays at a price in seconds per ray.
    fn of(rays: f64, price: f64) -> Cost {
        Cost { seconds: rays * price, rays }
    }
}

impl Round {
    /// Returns the time of the eye pass, and its rays.
    pub fn eye_pass(&self) -> Cost {
        let rays = self.picture.rays(Stage::EyePass);
        Cost { seconds: self.picture.step(Stage::EyePass), rays: rays.hits + rays.shadows }
    }

    /// Returns the rays that the eye pass reports at their bare prices: eye rays, further closest-hit rays, and shadow
    /// rays. Rays of pilots count as further rays.
    pub fn by_number(&self) -> [Cost; 3] {
        let (rays, eye) = (self.picture.rays(Stage::EyePass), self.picture.eye_rays());
        [
            Cost::of(eye, self.bare.eye.price().unwrap_or(0.0)),
            Cost::of((rays.hits - eye).max(0.0), self.bare.bsdf_price()),
            Cost::of(rays.shadows, self.bare.shadow_price()),
        ]
    }

    /// Returns the rays that the other steps report at their bare prices: closest-hit rays and shadow rays.
    pub fn others_by_number(&self) -> [Cost; 2] {
        let (all, eye) = (self.picture.all_rays(), self.picture.rays(Stage::EyePass));
        [
            Cost::of(all.hits - eye.hits, self.bare.scattered_price()),
            Cost::of(all.shadows - eye.shadows, self.bare.shadow_price()),
        ]
    }
}
