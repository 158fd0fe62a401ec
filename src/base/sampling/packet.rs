//! Random numbers of sixteen samplers at once.

use super::sobol::{DIMENSION_STEP, mix, owen_sobol_2d, owen_van_der_corput};
use crate::math::{F32x16, LANES, U32x16, Vec2x16};

/// Sixteen sequences. Each lane has the points of a [`super::Sampler`].
#[derive(Clone, Copy, Debug, Default)]
pub struct Samplers16 {
    /// Seeds of the sequences.
    pub seed: U32x16,
    /// Indices of the samples.
    pub index: U32x16,
}

impl Samplers16 {
    /// Returns the points of pair `pair` of dimensions, counted from 1: those of each sampler's `pair`-th call.
    // Copies inlined into large functions do not become vector code.
    #[inline(never)]
    pub fn point(&self, pair: u32) -> Vec2x16 {
        let dimension = pair.wrapping_mul(DIMENSION_STEP);
        let mut points = Vec2x16::default();
        for i in 0..LANES {
            points.set(i, owen_sobol_2d(self.index[i], mix(self.seed[i] ^ dimension)));
        }
        points
    }

    /// Returns the first coordinates of [`Samplers16::point`].
    #[inline(never)]
    pub fn number(&self, pair: u32) -> F32x16 {
        let dimension = pair.wrapping_mul(DIMENSION_STEP);
        let mut numbers = [0.0; LANES];
        for i in 0..LANES {
            numbers[i] = owen_van_der_corput(self.index[i], mix(self.seed[i] ^ dimension));
        }
        numbers
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Sampler;

    #[test]
    fn lanes_are_the_samplers_points_in_order() {
        let seed = std::array::from_fn(|i| 77 * i as u32 + 5);
        let index = std::array::from_fn(|i| 1000 * i as u32 + 3);
        let all = Samplers16 { seed, index };
        for lane in 0..LANES {
            let mut one = Sampler::new(seed[lane], index[lane]);
            for pair in 1..9 {
                let expected = one.next_2d();
                assert_eq!(all.point(pair).get(lane), expected);
                assert_eq!(all.number(pair)[lane], expected.x);
            }
        }
    }
}
