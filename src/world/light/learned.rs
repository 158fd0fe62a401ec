//! Light that arrives from the emitters, by region of the scene, learned from free and occluded rays. It guides their
//! sampling. Most of the sky is occluded in a room, and most lamps in a building: samples by flux alone are wasted.
//!
//! A region knows what its own rays have found. For want of rays it takes what the larger regions around it know.
//!
//! Paper: Vévoda, Kondapaneni & Křivánek, *Bayesian online regression for adaptive direct illumination sampling*, 2018.
//! Deviations: light is learned in waves before the image is sampled. The prior of a region is the estimate of the node
//! above it in a kd-tree. Estimates of the image are unbiased, because no probability is 0.

use super::environment::LearnedSky;
use super::regions::Regions;
use super::tree::LearnedEmitters;
use base::math::{LANES, Vec3x16};

/// Light from the emitters, learned before the image is rendered.
#[derive(Clone, Debug)]
pub struct Learned {
    pub(super) regions: Regions,
    /// Light of the environment, if there is one.
    pub(super) sky: Option<LearnedSky>,
    /// Visibility of the other emitters, if there are many.
    pub(super) emitters: Option<LearnedEmitters>,
}

impl Learned {
    /// Returns the regions of sixteen points.
    #[inline]
    pub(super) fn regions(&self, x: &Vec3x16) -> [usize; LANES] {
        self.regions.find(x)
    }
}
