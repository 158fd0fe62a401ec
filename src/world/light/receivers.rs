//! Sixteen points that gather light.

use super::environment::LearnedAt;
use super::learned::Learned;
use base::math::{LANES, Vec3x16};

/// Sixteen points that gather light.
#[derive(Clone, Copy, Debug)]
pub struct Receivers16<'a> {
    /// Positions.
    pub position: &'a Vec3x16,
    /// Unit normals of the reflecting sides; zero if light may come from both sides.
    pub normal: &'a Vec3x16,
    /// Learned visibility of the emitters, if it is to be used.
    pub learned: Option<&'a Learned>,
}

impl<'a> Receivers16<'a> {
    /// Returns the learned factors on the importance of emitters, by lane; `None` if they are not used.
    #[inline]
    pub(super) fn emitter_factors(&self) -> Option<[&'a [f32]; LANES]> {
        let learned = self.learned?;
        let emitters = learned.emitters.as_ref()?;
        Some(emitters.at(&learned.regions(self.position)))
    }

    /// Returns the learned distributions over tiles of the environment, by lane; `None` if they are not used.
    #[inline]
    pub fn sky(&self) -> Option<LearnedAt<'a>> {
        let learned = self.learned?;
        let sky = learned.sky.as_ref()?;
        Some(sky.at(&learned.regions(self.position)))
    }
}
