//! Views: curves from exposed radiance to display values.
//!
//! Sources:
//! - neutral: Khronos PBR Neutral tone mapper, specification of 2024. Colours up to 0.76 keep hue and saturation.
//! - agx, filmic: Blender's views of these names, see [`super::agx`] and [`super::filmic`].
//! - standard: clip at 1, then sRGB.

use super::tone::srgb_encode;
use super::{agx, filmic};
use crate::math::Rgb;

/// A curve from exposed radiance to display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// Khronos PBR Neutral: highlights are compressed, other colours equal the standard view.
    #[default]
    Neutral,
    /// Clip at 1, and sRGB.
    Standard,
    /// Blender's AgX: soft contrast; bright colours turn to white.
    Agx,
    /// Blender's Filmic: bright colours keep their hue, and turn to white at 6 stops above grey.
    Filmic,
}

impl ToneCurve {
    /// All views.
    pub const ALL: [ToneCurve; 4] =
        [ToneCurve::Neutral, ToneCurve::Standard, ToneCurve::Agx, ToneCurve::Filmic];

    /// Returns the name.
    pub fn name(self) -> &'static str {
        match self {
            ToneCurve::Neutral => "neutral",
            ToneCurve::Standard => "standard",
            ToneCurve::Agx => "agx",
            ToneCurve::Filmic => "filmic",
        }
    }

    /// Returns the display values in [0, 1], sRGB-encoded, of exposed radiance. NaN counts as 0.
    #[inline]
    pub fn display(self, exposed: Rgb) -> Rgb {
        let linear = match self {
            ToneCurve::Standard => exposed,
            ToneCurve::Neutral => neutral(finite(exposed)),
            ToneCurve::Agx => return agx::display(finite(exposed)),
            ToneCurve::Filmic => return filmic::display(finite(exposed)),
        };
        Rgb::from(linear.to_array().map(srgb_encode))
    }
}

/// Returns the colour without negative and infinite channels and NaN.
fn finite(color: Rgb) -> Rgb {
    let of_channel = |channel: f32| if channel.is_nan() { 0.0 } else { channel.clamp(0.0, 1e30) };
    Rgb::from(color.to_array().map(of_channel))
}

/// Returns the linear display colour of Khronos PBR Neutral.
fn neutral(color: Rgb) -> Rgb {
    // Reflectance of dielectrics at normal incidence, and the least peak that is compressed.
    const F90: f32 = 0.04;
    const START: f32 = 0.8 - F90;
    const DESATURATION: f32 = 0.15;
    let least = color.min_element();
    let offset = if least < 2.0 * F90 { least - least * least / (4.0 * F90) } else { F90 };
    let color = color - offset;
    let peak = color.max_element();
    if peak < START {
        return color;
    }
    let range = 1.0 - START;
    let compressed = 1.0 - range * range / (peak + range - START);
    let white = 1.0 - 1.0 / (DESATURATION * (peak - compressed) + 1.0);
    (color * (compressed / peak)).lerp(Rgb::splat(compressed), white)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neutral_keeps_colours_and_compresses_highlights() {
        // The specification's formula at points worked out by hand: below the start only the offset of .04 goes.
        assert!((neutral(Rgb::new(0.5, 0.3, 0.1)) - Rgb::new(0.46, 0.26, 0.06)).length() < 1e-6);
        // Dark: x - 6.25 x^2 goes, so 6.25 x^2 stays.
        assert!((neutral(Rgb::splat(0.04)) - Rgb::splat(6.25 * 0.04 * 0.04)).length() < 1e-7);
        // A peak of 1.04 - .04 = 1: compressed to 1 - .24^2 / (1 + .24 - .76) = .88.
        assert!((neutral(Rgb::splat(1.04)) - Rgb::splat(0.88)).length() < 1e-5);
        // (2.04, .04, .04) less .03 is (2.01, .01, .01): peak .961345, and .135956 of white.
        let red = neutral(Rgb::new(2.04, 0.04, 0.04));
        let (compressed, white) =
            (1.0 - 0.0576 / (2.01 + 0.24 - 0.76), 1.0 - 1.0 / (0.15 * (2.01 - 0.961_342) + 1.0));
        let low = 0.01 / 2.01 * compressed;
        let expected =
            Rgb::new(compressed, low + (compressed - low) * white, low + (compressed - low) * white);
        assert!((red - expected).length() < 1e-4, "{red} {expected}");
    }

    /// Colours of a chart, and their codes in Blender 5.0 by AgX and by Filmic. A colour is given by the levels of its
    /// channels: level 0 lies 10 stops below middle grey, and level 15 6.5 stops above it.
    #[rustfmt::skip]
    const CHART: [[[u8; 3]; 3]; 49] = [
        [[3, 3, 3], [2, 2, 2], [7, 7, 7]],
        [[6, 6, 6], [28, 28, 28], [37, 37, 37]],
        [[9, 9, 9], [114, 114, 114], [124, 124, 124]],
        [[12, 12, 12], [212, 212, 212], [222, 222, 222]],
        [[15, 15, 15], [255, 255, 255], [255, 255, 255]],
        [[15, 0, 0], [255, 206, 199], [255, 18, 18]],
        [[0, 15, 0], [226, 255, 218], [18, 255, 18]],
        [[0, 0, 15], [197, 210, 255], [18, 18, 255]],
        [[15, 15, 0], [255, 253, 227], [255, 255, 18]],
        [[0, 15, 15], [235, 254, 254], [18, 255, 255]],
        [[15, 0, 15], [254, 228, 255], [255, 18, 255]],
        [[9, 0, 0], [105, 4, 0], [124, 0, 0]],
        [[0, 9, 0], [22, 106, 0], [0, 124, 0]],
        [[0, 0, 9], [0, 33, 107], [0, 0, 124]],
        [[12, 0, 6], [237, 95, 82], [222, 0, 37]],
        [[6, 12, 0], [142, 213, 119], [37, 222, 0]],
        [[9, 9, 0], [114, 109, 0], [124, 124, 0]],
        [[2, 9, 9], [14, 113, 114], [3, 124, 124]],
        [[4, 9, 7], [2, 108, 49], [13, 124, 58]],
        [[12, 13, 4], [212, 230, 171], [222, 240, 13]],
        [[13, 9, 10], [247, 167, 170], [240, 124, 162]],
        [[11, 7, 15], [209, 214, 255], [196, 65, 255]],
        [[4, 7, 8], [2, 51, 74], [13, 58, 88]],
        [[10, 8, 5], [158, 76, 6], [162, 88, 22]],
        [[4, 4, 4], [6, 6, 6], [13, 13, 13]],
        [[5, 15, 6], [226, 255, 218], [33, 255, 45]],
        [[11, 13, 6], [197, 231, 168], [196, 240, 37]],
        [[7, 9, 7], [53, 109, 47], [58, 124, 58]],
        [[15, 6, 14], [255, 221, 244], [255, 45, 250]],
        [[13, 14, 5], [230, 244, 201], [240, 250, 22]],
        [[8, 11, 9], [122, 186, 126], [88, 196, 124]],
        [[11, 12, 11], [192, 211, 190], [196, 222, 196]],
        [[4, 15, 10], [227, 255, 220], [26, 255, 163]],
        [[14, 7, 8], [255, 181, 174], [250, 58, 88]],
        [[14, 6, 4], [255, 179, 169], [250, 37, 13]],
        [[8, 12, 5], [148, 213, 122], [88, 222, 22]],
        [[14, 8, 6], [255, 181, 171], [250, 88, 37]],
        [[10, 14, 14], [220, 245, 245], [162, 250, 250]],
        [[14, 7, 4], [255, 180, 169], [250, 58, 13]],
        [[13, 12, 13], [231, 216, 231], [240, 222, 240]],
        [[4, 4, 10], [1, 53, 155], [13, 13, 162]],
        [[8, 9, 15], [199, 212, 255], [92, 126, 255]],
        [[6, 10, 7], [54, 151, 51], [37, 162, 58]],
        [[7, 13, 5], [179, 232, 163], [58, 240, 22]],
        [[7, 5, 5], [45, 16, 14], [58, 22, 22]],
        [[7, 12, 10], [156, 212, 166], [58, 222, 162]],
        [[9, 6, 13], [147, 158, 244], [124, 37, 240]],
        [[13, 6, 4], [254, 143, 129], [240, 37, 13]],
        [[7, 5, 13], [130, 154, 245], [58, 22, 240]],
    ];

    #[test]
    fn agx_and_filmic_have_blenders_codes() {
        for [levels, agx, filmic] in CHART {
            let level = |level: u8| 0.18 * (16.5 * f32::from(level) / 15.0 - 10.0).exp2();
            let color = Rgb::from(levels.map(level));
            for (view, codes) in [(ToneCurve::Agx, agx), (ToneCurve::Filmic, filmic)] {
                let found = view.display(color).to_array().map(|value| (255.0 * value).round() as u8);
                let near = (0..3).all(|channel| found[channel].abs_diff(codes[channel]) <= 1);
                assert!(near, "{view:?} of {levels:?}: {found:?}, not {codes:?}");
            }
        }
    }

    #[test]
    fn views_rise_stay_in_range_and_survive_any_number() {
        for view in ToneCurve::ALL {
            let mut last = -1.0;
            for i in 0..200 {
                let grey = view.display(Rgb::splat(0.002 * 1.06f32.powi(i))).x;
                assert!(
                    grey >= last - 1e-6 && (0.0..=1.0).contains(&grey),
                    "{view:?} {i}: {grey} after {last}"
                );
                last = grey;
            }
            for bad in [f32::NAN, f32::INFINITY, -1.0, f32::MAX, f32::MIN_POSITIVE] {
                let shown = view.display(Rgb::new(bad, 0.5, -bad));
                assert!(shown.to_array().iter().all(|c| (0.0..=1.0).contains(c)), "{view:?} {bad}: {shown}");
            }
        }
    }
}
