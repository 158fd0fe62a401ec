//! Exponential function by arithmetic alone, for loops over lanes.

use std::f32::consts::LOG2_E;

/// ln 2 in two parts; the first has so few digits that its products with small whole numbers are exact.
const LN_2: [f32; 2] = [0.693_359_4, -2.121_944_4e-4];

/// 1.5 · 2²³: numbers between half and twice of it are whole, so that adding it rounds.
const WHOLE: f32 = 12_582_912.0;

/// Returns eˣ for -87 <= x <= 88, with a relative error of at most 3e-7.
///
/// Unlike that of the library, the function neither calls nor branches, so that loops compile to vector code.
#[inline(always)]
pub fn lane_exp(x: f32) -> f32 {
    let shifted = x * LOG2_E + WHOLE;
    let power = shifted - WHOLE;
    let r = (x - power * LN_2[0]) - power * LN_2[1];
    let series =
        1.0 + r * (1.0 + r * (0.5 + r * (1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r / 720.0)))));
    // The power stands in the low bits of the shifted number.
    series * f32::from_bits((shifted.to_bits() << 23).wrapping_add(1.0f32.to_bits()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_exponential_function() {
        for i in -87_000..=88_000 {
            let x = i as f32 / 1000.0;
            let exact = f64::from(x).exp();
            assert!((f64::from(lane_exp(x)) / exact - 1.0).abs() < 3e-7, "{x}: {} {exact}", lane_exp(x));
        }
        assert_eq!(lane_exp(0.0), 1.0);
    }
}
