//! Sobol points in pairs of dimensions, Owen-scrambled and decorrelated by hashing.
//!
//! Paper: Burley, *Practical Hash-based Owen Scrambling*, JCGT 2020. Each pair of dimensions is the first two of
//! Sobol's. A seed of its own scrambles it, and another shuffles its order ("padding").
//!
//! The second dimension's generator matrix is Pascal's triangle modulo 2, a Kronecker power. Five shifted XORs apply it
//! without a loop over bits.
//!
//! Deviations: the nested uniform scramble uses the constants of Vegdahl's *Building a Better LK Hash* (2021).
//! All 32 bits of the index are used, so a pass of 2^32 samples has no duplicate.

use glam::Vec2;

/// Seed of the first dimension of a pair: digits of π.
const X_SEED: u32 = 0x6487_ed51;
/// Seed of the second dimension of a pair: digits of e.
const Y_SEED: u32 = 0xb7e1_5162;
/// Difference of the seeds of consecutive pairs: digits of the golden ratio.
pub(super) const DIMENSION_STEP: u32 = 0x9e37_79b9;

/// Returns a well-mixed 32-bit hash of two words.
#[inline]
pub fn hash(a: u32, b: u32) -> u32 {
    // The finaliser of MurmurHash3 over a 64-bit product mix.
    let mut x =
        (a as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (b as u64).wrapping_mul(0xd1b5_4a32_d192_ed03);
    x ^= x >> 32;
    x = x.wrapping_mul(0xff51_afd7_ed55_8ccd);
    x ^= x >> 33;
    x as u32
}

/// Returns a cheaper hash of one word (Wellons' *lowbias32*), for seeds that the scramble mixes further.
#[inline(always)]
pub(super) fn mix(mut x: u32) -> u32 {
    x ^= x >> 16;
    x = x.wrapping_mul(0x7feb_352d);
    x ^= x >> 15;
    x = x.wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// Applies Owen scrambling to a bit-reversed number: a hash of the lower bits flips every bit.
#[inline(always)]
fn scramble_reversed(mut x: u32, seed: u32) -> u32 {
    x ^= x.wrapping_mul(0x3d20_adea);
    x = x.wrapping_add(seed);
    x = x.wrapping_mul((seed >> 16) | 1);
    x ^= x.wrapping_mul(0x0552_6c56);
    x ^ x.wrapping_mul(0x53a2_2864)
}

/// Returns the second Sobol dimension of `index`, bit-reversed.
#[inline(always)]
fn sobol_second_reversed(mut x: u32) -> u32 {
    x ^= (x >> 16) & 0x0000_ffff;
    x ^= (x >> 8) & 0x00ff_00ff;
    x ^= (x >> 4) & 0x0f0f_0f0f;
    x ^= (x >> 2) & 0x3333_3333;
    x ^ ((x >> 1) & 0x5555_5555)
}

/// Maps 32 random bits to [0, 1), never 1.
#[inline(always)]
pub fn unit(bits: u32) -> f32 {
    (bits >> 8) as f32 * (1.0 / 16_777_216.0)
}

/// Returns the position of point `index` in the order of `seed`.
///
/// The shuffle is nested, so every run of a power of two stays stratified.
#[inline(always)]
fn shuffled(index: u32, seed: u32) -> u32 {
    scramble_reversed(index.reverse_bits(), seed).reverse_bits()
}

/// Returns point `index` of the two-dimensional Owen-scrambled Sobol sequence of seed `seed`, in [0, 1)².
#[inline]
pub fn owen_sobol_2d(index: u32, seed: u32) -> Vec2 {
    let i = shuffled(index, seed);
    // Reversing the bits of the first Sobol dimension gives the index back.
    let x = scramble_reversed(i, mix(seed ^ X_SEED)).reverse_bits();
    let y = scramble_reversed(sobol_second_reversed(i), mix(seed ^ Y_SEED)).reverse_bits();
    Vec2::new(unit(x), unit(y))
}

/// Returns point `index` of the one-dimensional Owen-scrambled van der Corput sequence of seed `seed`, in [0, 1).
#[inline]
pub fn owen_van_der_corput(index: u32, seed: u32) -> f32 {
    unit(scramble_reversed(shuffled(index, seed), mix(seed ^ X_SEED)).reverse_bits())
}

/// Random numbers of one sample, in any number of dimensions. Each is stratified over the samples of a seed.
#[derive(Clone, Copy, Debug)]
pub struct Sampler {
    seed: u32,
    index: u32,
    dimension: u32,
}

impl Sampler {
    /// Creates the sampler of sample `index` of the sequence of seed `seed`: one seed per pixel, one index per sample.
    #[inline]
    pub fn new(seed: u32, index: u32) -> Sampler {
        Sampler { seed, index, dimension: 0 }
    }

    /// Returns the next dimension, in [0, 1).
    #[inline]
    pub fn next_1d(&mut self) -> f32 {
        owen_van_der_corput(self.index, self.next_seed())
    }

    /// Returns the next two dimensions, in [0, 1)².
    #[inline]
    pub fn next_2d(&mut self) -> Vec2 {
        owen_sobol_2d(self.index, self.next_seed())
    }

    #[inline]
    fn next_seed(&mut self) -> u32 {
        self.dimension = self.dimension.wrapping_add(DIMENSION_STEP);
        mix(self.seed ^ self.dimension)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn second_dimension_is_sobols() {
        // The first eight values of Sobol's second dimension.
        let expected = [0.0, 0.5, 0.75, 0.25, 0.625, 0.125, 0.375, 0.875];
        for (i, e) in expected.iter().enumerate() {
            assert_eq!(unit(sobol_second_reversed(i as u32).reverse_bits()), *e);
        }
    }

    /// Asserts that every elementary interval of area 2^-m contains exactly one point of any aligned run of 2^m points.
    #[test]
    fn runs_are_nets_in_base_two() {
        let m = 8;
        for seed in [1, 77, 0xdead_beef] {
            for run in [0u32, 3, 1 << 16] {
                for split in 0..=m {
                    let (nx, ny) = (1usize << split, 1usize << (m - split));
                    let mut seen = vec![false; nx * ny];
                    for i in 0..1u32 << m {
                        let p = owen_sobol_2d((run << m) + i, seed);
                        let cell = (p.x * nx as f32) as usize * ny + (p.y * ny as f32) as usize;
                        assert!(!seen[cell], "seed {seed} run {run} split {split}");
                        seen[cell] = true;
                    }
                }
            }
        }
    }

    #[test]
    fn scrambles_are_unbiased_over_seeds() {
        // The mean of one point over many seeds is the mean of the uniform distribution.
        let n = 20_000;
        let mean = (0..n).map(|s| owen_sobol_2d(5, hash(s, 9))).sum::<Vec2>() / n as f32;
        // Five standard errors of a uniform mean.
        let tolerance = 5.0 * (1.0f32 / 12.0).sqrt() / (n as f32).sqrt();
        assert!((mean - 0.5).abs().max_element() < tolerance, "{mean}");
    }

    #[test]
    fn dimensions_are_uncorrelated() {
        let n = 1 << 14;
        let mut sum = 0.0f64;
        for i in 0..n {
            let mut s = Sampler::new(42, i);
            let (a, b) = (s.next_2d(), s.next_2d());
            sum += ((a.x - 0.5) * (b.x - 0.5)) as f64;
        }
        assert!((sum / n as f64).abs() < 5.0 / 12.0 / (n as f64).sqrt());
    }
}
