//! Sixteen points that gather light.

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
        let emitters = self.learned.and_then(|learned| learned.emitters.as_ref())?;
        Some(emitters.at(self.position))
    }
}
