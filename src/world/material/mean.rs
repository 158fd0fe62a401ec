//! Plain mean of materials at several points of one surface.

use super::model::Bsdf;

/// Mean of BSDFs that differ only in colour, all with one weight.
#[derive(Clone, Copy, Debug)]
pub struct MeanBsdf<'m> {
    /// Sums of the colours.
    sum: Bsdf<'m>,
    count: f32,
}

impl<'m> MeanBsdf<'m> {
    /// Starts the mean with one BSDF.
    #[inline]
    pub fn new(bsdf: Bsdf<'m>) -> MeanBsdf<'m> {
        MeanBsdf { sum: bsdf, count: 1.0 }
    }

    /// Adds a BSDF of the same lobes.
    #[inline]
    pub fn add(&mut self, bsdf: &Bsdf<'m>) {
        debug_assert!(self.sum.same_lobes(bsdf) && self.sum.coat() == bsdf.coat());
        self.count += 1.0;
        self.sum.base += bsdf.base;
        for slot in 0..self.sum.model.lobes.len() {
            self.sum.scales[slot] += bsdf.scales[slot];
        }
    }

    /// Returns the mean of all BSDFs.
    #[inline]
    pub fn mean(&self) -> Bsdf<'m> {
        let share = 1.0 / self.count;
        let mut mean = self.sum;
        mean.base *= share;
        for scale in &mut mean.scales {
            *scale *= share;
        }
        mean
    }
}
