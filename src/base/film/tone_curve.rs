//! Views: curves from exposed radiance to display values.
//!
//! Sources:
//! - neutral: Khronos PBR Neutral tone mapper, specification of 2024. Colours up to 0.76 keep hue and saturation.
//! - agx: AgX of T. Sobotka, in the polynomial approximation by B. Wrensch, *Minimal AgX Implementation*, 2023.
//! - filmic: J. Hable, *Filmic Tonemapping Operators*, 2010 (Uncharted 2).
//! - standard: clip at 1, then sRGB.
//!
//! Deviations: the range of AgX ends at its white, so brighter radiance is white.

use super::tone::srgb_encode;
use crate::math::Rgb;
use glam::{Mat3, Vec3};

/// A curve from exposed radiance to display values.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ToneCurve {
    /// Khronos PBR Neutral: highlights are compressed, other colours equal the standard view.
    #[default]
    Neutral,
    /// Clip at 1, and sRGB.
    Standard,
    /// AgX: soft contrast; bright colours turn to white.
    Agx,
    /// Hable's filmic curve: strong contrast in shadows and highlights, by channel.
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
            ToneCurve::Agx => return agx(finite(exposed)),
            ToneCurve::Filmic => filmic(finite(exposed)),
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

/// Returns the sRGB-encoded display colour of AgX.
fn agx(color: Rgb) -> Rgb {
    const INSET: Mat3 = Mat3::from_cols(
        Vec3::new(0.842_479_06, 0.042_328_24, 0.042_375_65),
        Vec3::new(0.078_433_6, 0.878_468_64, 0.078_433_6),
        Vec3::new(0.079_223_745, 0.079_166_13, 0.879_143),
    );
    const OUTSET: Mat3 = Mat3::from_cols(
        Vec3::new(1.196_879, -0.052_896_85, -0.052_971_635),
        Vec3::new(-0.098_020_88, 1.151_903_1, -0.098_043_45),
        Vec3::new(-0.099_029_74, -0.098_961_18, 1.151_073_7),
    );
    // Stops of black and white relative to 1.
    const STOPS: [f32; 2] = [-12.473_93, 4.026_069];
    let curve = |channel: f32| {
        let x = ((channel.log2() - STOPS[0]) / (STOPS[1] - STOPS[0])).clamp(0.0, 1.0);
        let powers = [-0.00232, 0.1191, 0.4298, -6.868, 31.96, -40.14, 15.5];
        powers.iter().rev().fold(0.0, |sum, power| sum * x + power)
    };
    let encoded = OUTSET * Vec3::from((INSET * color).to_array().map(curve));
    encoded.clamp(Rgb::ZERO, Rgb::ONE)
}

/// Returns the linear display colour of Hable's curve.
fn filmic(color: Rgb) -> Rgb {
    // Exposure before the curve, and the radiance after it that becomes white.
    const BIAS: f32 = 2.0;
    const WHITE: f32 = 11.2;
    let curve = |x: f32| {
        let [a, b, c, d, e, f] = [0.15, 0.50, 0.10, 0.20, 0.02, 0.30];
        // The curve is flat beyond; the products of larger numbers overflow.
        let x = x.min(1e6);
        (x * (a * x + c * b) + d * e) / (x * (a * x + b) + d * f) - e / f
    };
    Rgb::from(color.to_array().map(|channel| curve(channel * BIAS) / curve(WHITE)))
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

    #[test]
    fn filmic_and_agx_have_their_published_values() {
        // Hable's curve: black stays, 11.2 / 2 is white. At .5 the value is f(1) / f(11.2).
        assert!(filmic(Rgb::ZERO).length() < 1e-6);
        assert!((filmic(Rgb::splat(5.6)) - Rgb::ONE).length() < 1e-5);
        let f = |x: f64| (x * (0.15 * x + 0.05) + 0.004) / (x * (0.15 * x + 0.5) + 0.06) - 1.0 / 15.0;
        assert!((f64::from(filmic(Rgb::splat(0.5)).x) - f(1.0) / f(11.2)).abs() < 1e-5);
        // AgX: the curve maps middle grey to 18 % of the light of a display with the exponent 2.4.
        let grey = agx(Rgb::splat(0.18)).x;
        assert!((grey.powf(2.4) - 0.18).abs() < 0.01, "{grey}");
        assert!(agx(Rgb::ZERO).length() < 1e-6 && agx(Rgb::splat(1e9)).min_element() > 0.97);
        // Strong red turns towards white rather than to flat red.
        let [dim, bright] = [0.5, 30.0].map(|level| agx(Rgb::new(level, 0.0, 0.0)));
        assert!(bright.y > dim.y + 0.2, "{dim} {bright}");
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
