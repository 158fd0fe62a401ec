//! Filmic as Blender shows it on sRGB displays with its default contrast.
//!
//! Source: T. Sobotka's Filmic. Its table of 33^3 nodes turns bright colours to white, and its curve of medium contrast
//! follows. The formula of the table is evaluated at the same nodes and interpolated likewise. The codes then differ
//! from Blender's by at most 1 of 255.
//!
//! Units: exposed radiance, Rec. 709. The nodes are equidistant in stops.

use super::lattice::Lattice;
use crate::math::Rgb;
use std::sync::OnceLock;

/// Nodes along each side of the table.
const NODES: usize = 33;
/// Middle grey.
const GREY: f32 = 0.18;
/// Stops below and above middle grey of the first and the last node.
const STOPS: [f32; 2] = [-10.0, 15.0];
/// Share of these stops that the curve covers.
const COVERED: f32 = 0.66;
/// Stops above middle grey from which on colours turn to white.
const WHITENS: f32 = 6.0;
/// Exponent of the share of white.
const POWER: f32 = 1.1;

/// Display values at equal distances over the covered stops.
const CURVE: [f32; 33] = [
    0.0, 0.00196, 0.00448, 0.00769, 0.0118, 0.01703, 0.02368, 0.03211, 0.04277, 0.05618, 0.07296, 0.09378,
    0.11941, 0.1506, 0.18803, 0.23221, 0.28332, 0.3411, 0.40471, 0.47267, 0.5424, 0.61175, 0.67869, 0.74109,
    0.79727, 0.84618, 0.88742, 0.9211, 0.94775, 0.96811, 0.98303, 0.9934, 1.0,
];

/// Returns the display colour, sRGB-encoded, of finite exposed radiance that is not negative.
pub fn display(exposed: Rgb) -> Rgb {
    static TABLE: OnceLock<Lattice> = OnceLock::new();
    let table = TABLE.get_or_init(|| Lattice::new(NODES, |node| position(whitened(radiance(node)))));
    Rgb::from(table.at(position(exposed)).to_array().map(curve))
}

/// Returns the radiance at a position of the table.
fn radiance(position: Rgb) -> Rgb {
    (position * (STOPS[1] - STOPS[0]) + STOPS[0]).exp2() * GREY
}

/// Returns the position of a radiance in the table.
fn position(radiance: Rgb) -> Rgb {
    let stops = radiance.to_array().map(|channel| (channel / GREY).max(1e-9).log2());
    (Rgb::from(stops) - STOPS[0]) / (STOPS[1] - STOPS[0])
}

/// Returns a colour mixed with the white of its largest channel.
fn whitened(color: Rgb) -> Rgb {
    let [begin, end] = [WHITENS, STOPS[1]].map(|stops| stops.exp2() * GREY);
    let most = color.max_element();
    let share = ((most - begin) / (end - begin)).clamp(0.0, 1.0).powf(POWER);
    color.lerp(Rgb::splat(most), share)
}

/// Returns the display value at a position of the table.
fn curve(position: f32) -> f32 {
    let last = (CURVE.len() - 1) as f32;
    let at = (position / COVERED).clamp(0.0, 1.0) * last;
    let low = at.floor().min(last - 1.0);
    let [before, after] = [0, 1].map(|next| CURVE[low as usize + next]);
    before + (after - before) * (at - low)
}
