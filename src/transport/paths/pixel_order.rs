//! Random numbers of paths that are stratified over neighbouring pixels, too.
//!
//! The noise of one pixel stays as it is, and that of means over neighbours falls. Such means are what a denoiser and
//! the eye take.
//!
//! Paper: Ahmed & Wonka, *Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of
//! Pixels*, 2020. The pixels of a block, in Z-order, take consecutive runs of one Owen-scrambled sequence, so that the
//! pixels of every square in the order share one net.
//! Deviations: blocks have at most 16 by 16 pixels, and each has a sequence of its own, so that 32 bits are enough.

use base::math::morton;
use base::sampling::hash;

/// Binary logarithm of the side of a block.
const BLOCK_BITS: u32 = 4;

/// Changes the seeds of blocks, which are not to be those of pixels.
const BLOCKS: u32 = 0x51ed_270b;

/// Returns seed and index of the random numbers of a pixel's sample of this number. Pixels have `samples` samples;
/// those beyond have sequences of their own.
#[inline]
pub fn sequence([x, y]: [u32; 2], seed: u32, sample: u32, samples: u32) -> [u32; 2] {
    let bits = samples.max(1).checked_next_power_of_two().map_or(u32::BITS, u32::trailing_zeros);
    let run = sample.checked_shr(bits).unwrap_or(0);
    let block = hash(hash(x >> BLOCK_BITS, y >> BLOCK_BITS), hash(seed ^ BLOCKS, run));
    let inside = (1 << BLOCK_BITS) - 1;
    let place = morton(x & inside, y & inside) as u32;
    let first = place.checked_shl(bits).unwrap_or(0);
    [block, first.wrapping_add(sample - (run.checked_shl(bits).unwrap_or(0)))]
}

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::Sampler;

    #[test]
    fn squares_of_pixels_share_a_net() {
        for (samples, side, at) in [(4, 2, [6, 10]), (1, 4, [16, 4]), (2, 8, [24, 8]), (1, 16, [32, 16])] {
            let total = (samples * side * side) as usize;
            let mut counts = [vec![0; total], vec![0; total]];
            for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                for sample in 0..samples {
                    let [seed, index] = sequence([at[0] + x, at[1] + y], 7, sample, samples);
                    let mut sampler = Sampler::new(seed, index);
                    sampler.next_2d();
                    let point = sampler.next_2d();
                    for (counts, value) in counts.iter_mut().zip(point.to_array()) {
                        counts[(value * total as f32) as usize] += 1;
                    }
                }
            }
            assert!(counts.iter().flatten().all(|count| *count == 1), "{samples} {side}");
        }
    }

    #[test]
    fn no_two_samples_have_the_same_numbers() {
        for samples in [1, 3, 4, 37] {
            let mut all: Vec<[u32; 2]> = Vec::new();
            for pixel in (0..20 * 20).map(|i| [i % 20, i / 20]) {
                all.extend((0..4 * samples).map(|sample| sequence(pixel, 1, sample, samples)));
            }
            let count = all.len();
            all.sort_unstable();
            all.dedup();
            assert_eq!(all.len(), count);
        }
        assert_ne!(sequence([0, 0], 1, u32::MAX, u32::MAX), sequence([0, 0], 2, u32::MAX, u32::MAX));
    }
}
