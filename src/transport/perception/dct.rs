//! Just visible differences in a block of 8x8 pixels, from its cosine transform.
//!
//! Paper: Herzog et al. 2009, section 6.4 (thresholds from 8x8 blocks, quantisation matrix of MPEG); luminance and
//! contrast masking by Watson, *DCT quantization matrices visually optimized for individual images*, 1993.
//!
//! Deviations: the paper does not say which pattern the threshold of a pixel refers to. Here it is a step across the
//! middle of the block, the shape of a seam between records, in the direction in which it is more visible.
//!
//! Units: grey levels from 0 to 255, encoded for display.

use std::f32::consts::PI;
use std::sync::LazyLock;

/// Pixels along the edge of a block.
pub const SIDE: usize = 8;

/// Quantisation steps by frequency: MPEG's matrix for intra-coded blocks.
const STEPS: [[f32; SIDE]; SIDE] = [
    [8.0, 16.0, 19.0, 22.0, 26.0, 27.0, 29.0, 34.0],
    [16.0, 16.0, 22.0, 24.0, 27.0, 29.0, 34.0, 37.0],
    [19.0, 22.0, 26.0, 27.0, 29.0, 34.0, 34.0, 38.0],
    [22.0, 22.0, 26.0, 27.0, 29.0, 34.0, 37.0, 40.0],
    [22.0, 26.0, 27.0, 29.0, 32.0, 35.0, 40.0, 48.0],
    [26.0, 27.0, 29.0, 32.0, 35.0, 40.0, 48.0, 58.0],
    [26.0, 27.0, 29.0, 34.0, 38.0, 46.0, 56.0, 69.0],
    [27.0, 29.0, 35.0, 38.0, 46.0, 56.0, 69.0, 83.0],
];

/// Quantisation scale to which the matrix refers.
const SCALE: f32 = 16.0;

/// Mean grey level to which the matrix refers.
const MEAN: f32 = 128.0;

/// Exponent of the mean grey level in thresholds.
const MEAN_EXPONENT: f32 = 0.649;

/// Lower bound of the mean grey level.
const MIN_MEAN: f32 = 4.0;

/// Exponent of the contrast at a frequency in the threshold of that frequency.
const CONTRAST_EXPONENT: f32 = 0.7;

/// Orthonormal cosines by frequency, at the pixels of a row.
static COSINES: LazyLock<[[f32; SIDE]; SIDE]> = LazyLock::new(|| {
    std::array::from_fn(|frequency| {
        let norm = if frequency == 0 { 1.0 } else { 2f32.sqrt() } / (SIDE as f32).sqrt();
        std::array::from_fn(|x| norm * ((2 * x + 1) as f32 * frequency as f32 * PI / 16.0).cos())
    })
});

/// Coefficients of a step of one grey level across the middle of a block, by frequency across it.
static STEP: LazyLock<[f32; SIDE]> = LazyLock::new(|| {
    let of_row =
        |row: &[f32; SIDE]| (0..SIDE).map(|x| if x < SIDE / 2 { -0.5 } else { 0.5 } * row[x]).sum::<f32>();
    COSINES.each_ref().map(|row| of_row(row) * (SIDE as f32).sqrt())
});

/// Returns the height of the smallest visible step across a block, in grey levels, for a quantisation scale.
pub fn visible_step(block: &[[f32; SIDE]; SIDE], q_scale: f32) -> f32 {
    let mean = block.as_flattened().iter().sum::<f32>() / (SIDE * SIDE) as f32;
    let adaptation = (mean.max(MIN_MEAN) / MEAN).powf(MEAN_EXPONENT) * q_scale / SCALE;
    let mut least = f32::INFINITY;
    // A step has no even frequencies.
    for frequency in (1..SIDE).step_by(2) {
        let response = STEP[frequency].abs();
        let cosines = &COSINES[frequency];
        let mut across = [0.0; 2];
        for (y, row) in block.iter().enumerate() {
            for (x, grey) in row.iter().enumerate() {
                across[0] += grey * cosines[x];
                across[1] += grey * cosines[y];
            }
        }
        let steps = [STEPS[0][frequency], STEPS[frequency][0]];
        for (sum, step) in across.into_iter().zip(steps) {
            let plain = step * adaptation;
            let contrast = sum.abs() / (SIDE as f32).sqrt();
            let masked = contrast.powf(CONTRAST_EXPONENT) * plain.powf(1.0 - CONTRAST_EXPONENT);
            least = least.min(plain.max(masked) / response);
        }
    }
    least
}

#[cfg(test)]
mod tests {
    use super::*;

    fn block(grey: impl Fn(usize, usize) -> f32) -> [[f32; SIDE]; SIDE] {
        std::array::from_fn(|y| std::array::from_fn(|x| grey(x, y)))
    }

    #[test]
    fn steps_on_flat_blocks_are_seen_at_the_quantisation_of_their_lowest_frequency() {
        // A step of 1 has 3.6245 of the first cosine, which is quantised by 16 · 4 / 16 = 4.
        let flat = visible_step(&block(|_, _| 128.0), 4.0);
        assert!((flat - 4.0 / 3.6245).abs() < 1e-3, "{flat}");
        assert!((visible_step(&block(|_, _| 128.0), 8.0) - 2.0 * flat).abs() < 1e-4);
        let dark = visible_step(&block(|_, _| 32.0), 4.0);
        assert!((dark / flat - 0.25f32.powf(0.649)).abs() < 1e-4);
        assert!(visible_step(&block(|_, _| 0.0), 4.0) > 0.0);
    }

    #[test]
    fn contrast_hides_steps_along_both_directions_only_where_it_has_both() {
        let flat = visible_step(&block(|_, _| 128.0), 4.0);
        let striped = block(|x, _| if x < 4 { 78.0 } else { 178.0 });
        assert!((visible_step(&striped, 4.0) - flat).abs() < 1e-3);
        let crossed = |height: f32| {
            block(|x, y| 128.0 + 0.5 * height * ((x < 4) as u8 as f32 + (y < 4) as u8 as f32 - 1.0))
        };
        let seen = visible_step(&crossed(100.0), 4.0);
        assert!(seen > 2.0 * flat, "{seen} {flat}");
        assert!(visible_step(&crossed(200.0), 4.0) > seen);
        // Not by contrast that is hardly visible itself.
        assert!((visible_step(&crossed(0.5 * flat), 4.0) - flat).abs() < 1e-3);
    }
}
