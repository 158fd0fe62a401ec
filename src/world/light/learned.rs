//! Learned visibility of emitters, by region of the scene, which guides their sampling.

use super::environment::LearnedSky;
use super::tree::LearnedEmitters;

/// Visibility of emitters, learned before the image is rendered.
#[derive(Clone, Debug, Default)]
pub struct Learned {
    /// Visibility of the environment, if there is one.
    pub sky: Option<LearnedSky>,
    /// Visibility of the other emitters, if there are many.
    pub emitters: Option<LearnedEmitters>,
}
