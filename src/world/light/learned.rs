//! Knowledge by which emitters are sampled: what of them is seen from each region of the scene.

use super::{LearnedLamps, LearnedSky};

/// Knowledge gained before the picture.
#[derive(Clone, Debug, Default)]
pub struct Learned {
    /// Directions of the environment, if there is one.
    pub sky: Option<LearnedSky>,
    /// Lamps, if they are many.
    pub lamps: Option<LearnedLamps>,
}
