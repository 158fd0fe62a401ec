//! AgX as Blender 4 and 5 show it on sRGB displays.
//!
//! Source: the formation of T. Sobotka's AgX by Z. E. Zhou, M. Faderbauer and S. Kapanen, with which Blender's table of
//! 57^3 nodes was made. Blender's table is interpolated, so this formula is evaluated at the same nodes and
//! interpolated likewise. The codes then differ from Blender's by at most 1 of 255.
//!
//! Negative channels are removed in Rec. 2020. Inset primaries follow, then a sigmoid of the logarithm by channel. The
//! hue goes back 60 % of the way. Outset primaries lead to Rec. 709, where negative channels are removed again.
//!
//! Units: exposed radiance, Rec. 709. The nodes are equidistant in stops, by the channels of FilmLight's E-Gamut.

use super::lattice::Lattice;
use super::tone::srgb_encode;
use crate::math::Rgb;
use glam::{Mat3, Vec3};
use std::sync::OnceLock;

/// Nodes along each side of the table.
const NODES: usize = 57;
/// Middle grey.
const GREY: f32 = 0.18;
/// Stops below and above middle grey of the first and the last node.
const STOPS: [f32; 2] = [-10.0, 15.0];
/// Stops above middle grey of white.
const WHITE: f32 = 6.5;
/// Exponent of the display for which the colours are formed.
const DISPLAY: f32 = 2.4;
/// Share of the change of hue by the sigmoid that stays.
const HUE_SHIFT: f32 = 0.4;

/// Rec. 709 to E-Gamut.
const TO_E_GAMUT: Mat3 = Mat3::from_cols(
    Vec3::new(0.559_365_4, 0.076_219_95, 0.065_526_07),
    Vec3::new(0.304_789_4, 0.787_987_55, 0.164_550_07),
    Vec3::new(0.135_822_77, 0.135_784_67, 0.769_797_2),
);
/// E-Gamut to Rec. 2020.
const TO_REC_2020: Mat3 = Mat3::from_cols(
    Vec3::new(1.137_588_9, -0.019_087_16, -0.097_325_63),
    Vec3::new(0.008_350_5, 1.215_316, -0.100_888_24),
    Vec3::new(-0.145_932_25, -0.196_244_66, 1.198_362_6),
);
/// Rec. 2020 to primaries inset and turned.
const INSET: Mat3 = Mat3::from_cols(
    Vec3::new(0.856_627_15, 0.137_318_97, 0.111_898_21),
    Vec3::new(0.095_121_24, 0.761_242, 0.076_799_42),
    Vec3::new(0.048_251_61, 0.101_439_04, 0.811_302_4),
);
/// Inset primaries to Rec. 709.
const OUTSET: Mat3 = Mat3::from_cols(
    Vec3::new(1.964_894, -0.299_309_07, -0.164_356_43),
    Vec3::new(-0.856_007_9, 1.326_391_9, -0.238_207_4),
    Vec3::new(-0.108_886_11, -0.027_082_8, 1.402_563_8),
);
/// Weights of luminance in Rec. 2020, by the colour matching functions of 2015.
const LUMINANCE_2020: Rgb = Rgb::new(0.258_923_54, 0.610_498_5, 0.130_577_93);
/// Weights of luminance in Rec. 709, likewise.
const LUMINANCE_709: Rgb = Rgb::new(0.206_772_48, 0.658_136_4, 0.135_091_1);

/// Returns the display colour, sRGB-encoded, of finite exposed radiance that is not negative.
pub fn display(exposed: Rgb) -> Rgb {
    static TABLE: OnceLock<Lattice> = OnceLock::new();
    let table = TABLE.get_or_init(|| {
        let range = STOPS[1] - STOPS[0];
        Lattice::new(NODES, |node| formed((node * range + STOPS[0]).exp2() * GREY))
    });
    let stops = Rgb::from((TO_E_GAMUT * exposed).to_array().map(|channel| (channel / GREY).max(1e-9).log2()));
    let formed = table.at((stops - STOPS[0]) / (STOPS[1] - STOPS[0]));
    Rgb::from(formed.to_array().map(|channel| srgb_encode(channel.powf(DISPLAY))))
}

/// Returns the colour for a display with the exponent [`DISPLAY`] of a colour in E-Gamut.
fn formed(color: Rgb) -> Rgb {
    let inset = INSET * without_negatives(TO_REC_2020 * color, LUMINANCE_2020, |_| 1.0);
    let shown = Rgb::from(inset.to_array().map(|channel| sigmoid(channel).powf(DISPLAY)));
    let (before, after) = (hue(inset), hue(shown));
    let shift = after - before - (after - before).round();
    let shown = with_hue(before + HUE_SHIFT * shift, shown);
    let share = |luminance: f32| 1.0 - luminance.max(0.0).powf(0.08).min(1.0);
    let shown = without_negatives(OUTSET * shown, LUMINANCE_709, share);
    Rgb::from(shown.to_array().map(|channel| channel.max(0.0).powf(1.0 / DISPLAY).min(1.0)))
}

/// Returns the display value of a channel: a line through middle grey on a scale of stops, bent at toe and shoulder.
fn sigmoid(channel: f32) -> f32 {
    const SLOPE: f32 = 2.4;
    const POWER: f32 = 1.5;
    let grey = [-STOPS[0] / (WHITE - STOPS[0]), GREY.powf(1.0 / DISPLAY)];
    let x = ((channel.max(1e-9) / GREY).log2() - STOPS[0]) / (WHITE - STOPS[0]) - grey[0];
    // Lengths from grey to black or white. The line, bent, ends there.
    let [width, height] = if x < 0.0 { grey } else { grey.map(|g| 1.0 - g) };
    let line = SLOPE * width;
    let scale = (line.powf(-POWER) * ((line / height).powf(POWER) - 1.0)).powf(-1.0 / POWER);
    let along = SLOPE * x / scale;
    (grey[1] + scale * along / (1.0 + along.abs().powf(POWER)).powf(1.0 / POWER)).max(0.0)
}

/// Returns a colour raised until no channel is negative, and darkened to its former brightness.
///
/// The brightness is the luminance, plus a share of what the opposite colour's luminance lacks to its largest channel.
/// `share` returns that share for a luminance.
fn without_negatives(color: Rgb, weights: Rgb, share: impl Fn(f32) -> f32) -> Rgb {
    let brightness = |color: Rgb| {
        let opposite = color.max_element() - color;
        let luminance = color.dot(weights);
        luminance + share(luminance) * (opposite.max_element() - opposite.dot(weights))
    };
    let raised = color - color.min_element().min(0.0);
    let [before, after] = [color, raised].map(brightness);
    if after > before { raised * (before / after) } else { raised }
}

/// Returns the hue in turns; 0 for greys.
fn hue(color: Rgb) -> f32 {
    let [r, g, b] = color.to_array();
    let (most, span) = (color.max_element(), color.max_element() - color.min_element());
    let sixths = match span > 0.0 {
        false => 0.0,
        true if most == r => (g - b) / span,
        true if most == g => (b - r) / span + 2.0,
        true => (r - g) / span + 4.0,
    };
    (sixths / 6.0).rem_euclid(1.0)
}

/// Returns the colour of a hue with the largest and smallest channel of another colour.
fn with_hue(hue: f32, color: Rgb) -> Rgb {
    let (most, least) = (color.max_element(), color.min_element());
    Rgb::from([5.0, 3.0, 1.0].map(|turn| {
        let k = (turn + 6.0 * hue).rem_euclid(6.0);
        most - (most - least) * k.min(4.0 - k).clamp(0.0, 1.0)
    }))
}
