//! Images for display: exposure, and the standard view: clip at 1, sRGB.
//!
//! Units: display values are in [0, 1], encoded with the sRGB curve.

use super::Image;
use crate::math::{Rgb, luminance};
use std::fmt;
use std::str::FromStr;

/// Luminance quantile that automatic exposure maps to [`AUTO_TARGET`].
pub const AUTO_PERCENTILE: f64 = 0.9;
/// Linear display value of that quantile.
pub const AUTO_TARGET: f64 = 0.8;

/// Scale of radiance before clipping.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Exposure {
    /// So many stops over automatic: with 0, the 90th percentile of luminance becomes 0.8.
    Auto(f32),
    /// Exposure value: radiance times 2^EV.
    Ev(f32),
}

impl Default for Exposure {
    fn default() -> Exposure {
        Exposure::Auto(0.0)
    }
}

impl Exposure {
    /// Returns the factor on radiance, given the factor of automatic exposure.
    pub fn factor(self, automatic: impl FnOnce() -> f32) -> f32 {
        match self {
            Exposure::Auto(stops) => automatic() * stops.exp2(),
            Exposure::Ev(ev) => ev.exp2(),
        }
    }
}

impl FromStr for Exposure {
    type Err = String;

    fn from_str(text: &str) -> Result<Exposure, String> {
        let stops = |text: &str| text.parse::<f32>().ok().filter(|stops| (-60.0..=60.0).contains(stops));
        let exposure = match text.split_at_checked(4) {
            Some((auto, "")) if auto.eq_ignore_ascii_case("auto") => Some(Exposure::Auto(0.0)),
            Some((auto, more)) if auto.eq_ignore_ascii_case("auto") => {
                stops(more).filter(|_| more.starts_with(['+', '-'])).map(Exposure::Auto)
            }
            _ => stops(text).map(Exposure::Ev),
        };
        exposure.ok_or_else(|| {
            "expected `auto`, stops over automatic exposure like `auto+1` or `auto-0.5`, or an exposure value between -60 \
             and 60"
                .to_owned()
        })
    }
}

impl fmt::Display for Exposure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Exposure::Auto(0.0) => f.write_str("auto"),
            Exposure::Auto(stops) => write!(f, "auto{stops:+}"),
            Exposure::Ev(ev) => write!(f, "{ev}"),
        }
    }
}

/// Returns the factor that maps the 90th percentile of luminance to 0.8.
///
/// If that percentile is black, the brightest pixel is used; for a black image the factor is 1. Pixels that only show a
/// transparent background do not count.
pub fn auto_factor<'a>(image: impl Into<Shown<'a>>) -> f32 {
    let colors = image.into().colors().filter(|(_, alpha)| *alpha > 0.0).map(|(color, _)| color);
    let mut luminances: Vec<f32> = colors.map(luminance).filter(|l| l.is_finite()).collect();
    let level = match percentile(&mut luminances, AUTO_PERCENTILE) {
        level if level > 0.0 => level,
        _ => luminances.iter().fold(0.0f32, |a, &b| a.max(b)) as f64,
    };
    let factor = (AUTO_TARGET / level) as f32;
    if level > 0.0 && factor.is_finite() && factor > 0.0 { factor } else { 1.0 }
}

/// Returns the `share` quantile, linear between order statistics; 0 without values. Reorders the values.
fn percentile(values: &mut [f32], share: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let position = share * (values.len() - 1) as f64;
    let (_, &mut low, above) = values.select_nth_unstable_by(position as usize, f32::total_cmp);
    // The next order statistic is the minimum of the values above. At the end there is none, and the fraction is 0.
    let high = above.iter().copied().fold(f32::INFINITY, f32::min);
    let fraction = position.fract();
    if fraction == 0.0 || above.is_empty() {
        low as f64
    } else {
        low as f64 + (high as f64 - low as f64) * fraction
    }
}

/// Encodes a linear value as sRGB, clipped to [0, 1]; NaN becomes 0.
#[inline]
pub fn srgb_encode(linear: f32) -> f32 {
    // `max` returns the other operand for NaN.
    let x = linear.max(0.0);
    if x <= 0.0031308 {
        12.92 * x
    } else if x < 1.0 {
        1.055 * x.powf(1.0 / 2.4) - 0.055
    } else {
        // 1.055 - 0.055 is not 1 in f32.
        1.0
    }
}

/// Returns the derivative of the sRGB encoding at a linear value; on white, the limit from below.
#[inline]
pub fn srgb_slope(linear: f32) -> f32 {
    let x = linear.clamp(0.0, 1.0);
    if x <= 0.0031308 { 12.92 } else { 1.055 / 2.4 * x.powf(1.0 / 2.4 - 1.0) }
}

/// Returns the exposed, clipped and encoded display colour.
#[inline]
pub fn display(radiance: Rgb, factor: f32) -> Rgb {
    let exposed = radiance * factor;
    Rgb::new(srgb_encode(exposed.x), srgb_encode(exposed.y), srgb_encode(exposed.z))
}

/// Converts the image to 8-bit sRGB, clipped at 1, row-major, three bytes per pixel.
pub fn to_srgb8(image: &Image, factor: f32) -> Vec<u8> {
    let quantise = |value: f32| (value * 255.0 + 0.5) as u8;
    image.pixels.iter().flat_map(|&p| display(p, factor).to_array().map(quantise)).collect()
}

/// An image for display.
#[derive(Clone, Copy, Debug)]
pub struct Shown<'a> {
    /// Radiance; premultiplied if the background is transparent.
    pub color: &'a Image,
    /// Share of each pixel that surfaces cover, if the background is transparent.
    pub alpha: Option<&'a Image<f32>>,
}

impl<'a> From<&'a Image> for Shown<'a> {
    fn from(color: &'a Image) -> Shown<'a> {
        Shown { color, alpha: None }
    }
}

impl<'a> Shown<'a> {
    /// Returns the mean radiance of the surfaces in each pixel, and the share of it that they cover, from 0 to 1.
    pub fn colors(self) -> impl Iterator<Item = (Rgb, f32)> + 'a {
        self.color.pixels.iter().enumerate().map(move |(i, &color)| match self.alpha {
            None => (color, 1.0),
            Some(alpha) => match alpha.pixels.get(i).copied().unwrap_or(1.0).clamp(0.0, 1.0) {
                alpha if alpha > 0.0 => (color / alpha, alpha),
                _ => (Rgb::ZERO, 0.0),
            },
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(values: &[f32]) -> Image {
        let pixels = values.iter().map(|&v| Rgb::splat(v)).collect();
        Image { width: values.len() as u32, height: 1, pixels }
    }

    #[test]
    fn percentiles_interpolate_between_order_statistics() {
        let mut values = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(percentile(&mut values, 0.5), 3.0);
        assert!((percentile(&mut values, 0.9) - 4.6).abs() < 1e-12);
        assert_eq!(percentile(&mut values, 1.0), 5.0);
        assert_eq!(percentile(&mut [], 0.9), 0.0);
    }

    #[test]
    fn auto_exposure_puts_the_percentile_at_its_target() {
        let image = grey(&(0..=10).map(|i| i as f32).collect::<Vec<_>>());
        // The 90th percentile of 0..=10 is 9.
        assert!((auto_factor(&image) * 9.0 - 0.8).abs() < 1e-6);
    }

    #[test]
    fn auto_exposure_survives_black_and_nonfinite_images() {
        assert_eq!(auto_factor(&grey(&[0.0; 5])), 1.0);
        assert_eq!(auto_factor(&grey(&[])), 1.0);
        assert_eq!(auto_factor(&grey(&[f32::NAN, f32::INFINITY])), 1.0);
        assert_eq!(auto_factor(&grey(&[-1.0; 3])), 1.0);
        // The image is mostly black, so the brightest pixel counts.
        let mut values = [0.0; 100];
        values[3] = 4.0;
        assert!((auto_factor(&grey(&values)) - 0.2).abs() < 1e-7);
    }

    #[test]
    fn srgb_matches_the_standard_at_known_points() {
        for (linear, encoded) in
            [(0.0, 0.0), (1.0, 1.0), (0.5, 0.735357), (0.0031308, 0.04045), (0.18, 0.461356)]
        {
            assert!((srgb_encode(linear) - encoded).abs() < 1e-5, "{linear}");
        }
        assert_eq!([-1.0, f32::NAN, 7.0, f32::INFINITY].map(srgb_encode), [0.0, 0.0, 1.0, 1.0]);
    }

    #[test]
    fn slopes_are_differences_of_encoded_values() {
        for linear in [0.001, 0.01, 0.18, 0.9] {
            let difference = (srgb_encode(linear * 1.01) - srgb_encode(linear * 0.99)) / (0.02 * linear);
            assert!((srgb_slope(linear) / difference - 1.0).abs() < 1e-3, "{linear}");
        }
        assert_eq!(srgb_slope(7.0), srgb_slope(1.0));
    }

    #[test]
    fn exposures_are_parsed_and_refused() {
        for (text, exposure) in [
            ("Auto", Exposure::Auto(0.0)),
            ("auto+1", Exposure::Auto(1.0)),
            ("AUTO-0.5", Exposure::Auto(-0.5)),
            ("-1.5", Exposure::Ev(-1.5)),
            ("+1", Exposure::Ev(1.0)),
        ] {
            assert_eq!(text.parse(), Ok(exposure), "{text}");
            assert_eq!(exposure.to_string().parse(), Ok(exposure), "{text}");
        }
        // Automatic exposure scales .4 to .8; one stop more doubles it.
        let of_grey = |exposure: Exposure| exposure.factor(|| auto_factor(&grey(&[0.4])));
        assert_eq!([Exposure::Ev(3.0), Exposure::Auto(1.0)].map(of_grey), [8.0, 4.0]);
        for bad in ["", "nan", "inf", "1e9", "two", "auto1", "auto+", "auto+61", "auto+-1", "auto 1", "äuto"]
        {
            assert!(bad.parse::<Exposure>().is_err(), "{bad}");
        }
    }
}
