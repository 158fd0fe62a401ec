//! Linear functions of position, fitted to what the makers of a cut get from its clusters.
//!
//! A cluster of unit intensity gives each maker an irradiance vector (0 if it is not seen), and its lobe, if it has one,
//! reflects something of it. To both, functions of the position on the patch's tangent plane are fitted by
//! least squares; the sum over the clusters, weighted by their intensities, serves all points of the patch, each
//! with its own normal and base.

use crate::light_tree::Node;
use crate::lightcut::packet::receivers::{Vec3Lanes, lanes_of};
use crate::lightcut::packet::{LANES, Lanes, RgbLanes};
use crate::lightcut::{ReceiverPacket, Transfer};
use crate::math::{Frame, LUMINANCE, Rgb, luminance};
use crate::vpl::{Vpl, VplKind};
use glam::Vec3;

/// Fewer makers than this are not fitted.
const LEAST_MAKERS: u32 = 8;
/// Extent of the makers along an axis, relative to their largest, below which nothing is fitted along it.
const LEAST_EXTENT: f32 = 1e-3;

/// Orthonormal functions of position over the makers: constant, and linear in the tangent plane.
#[derive(Clone, Copy)]
struct Basis {
    centre: Vec3,
    /// The constant function's value.
    constant: f32,
    /// Largest squared distance of a maker from the centre.
    radius_sq: f32,
    axes: [Vec3; 2],
    /// Least and largest value of the linear functions at the makers.
    ranges: [[f32; 2]; 2],
    at_makers: [Lanes; 3],
}

/// What is fitted to one cluster of unit intensity: coefficients of the three functions.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Share {
    /// Irradiance vector.
    vector: [Vec3; 3],
    /// What the lobe reflects.
    lobe: [Rgb; 3],
}

/// What a cluster of unit intensity gives to each maker.
pub(super) struct Given {
    vector: Vec3Lanes,
    lobe: RgbLanes,
}

/// The fit to a cut.
#[derive(Default)]
pub(super) struct Fit {
    basis: Option<Basis>,
    /// Mean BRDF of the makers' bases.
    base: Rgb,
    /// Coefficients of the irradiance vectors, by function and channel.
    vectors: [[Vec3; 3]; 3],
    /// Coefficients of what the lobe reflects, by function.
    lobe: [Rgb; 3],
}

/// Values of the functions, by lane.
pub(super) type At = [Lanes; 3];

impl Fit {
    /// Starts afresh for these makers.
    pub fn begin(&mut self, makers: &ReceiverPacket) {
        *self = Fit { basis: Basis::new(makers), ..Fit::default() };
        let count = makers.len().max(1) as f32;
        self.base = (0..makers.len()).map(|l| makers.get(l).base_brdf()).sum::<Rgb>() / count;
    }

    /// The fit to a cluster that `seen` of the makers see, and what it was fitted to; `None` if there are too few makers
    /// or the cluster is too near.
    pub fn share(
        &self,
        transfer: &Transfer,
        makers: &ReceiverPacket,
        node: &Node,
        vpl: &Vpl,
        seen: u16,
        responses: &RgbLanes,
    ) -> Option<(Share, Given)> {
        let near = |basis: &Basis| {
            let at = |l: usize| makers.get(l).position().distance_squared(vpl.position);
            node.kind() != VplKind::Directional
                && (0..makers.len()).map(at).fold(f32::INFINITY, f32::min) < basis.radius_sq
        };
        let basis = self.basis.as_ref().filter(|basis| !near(basis))?;
        let mut vector = transfer.incidence16(makers, vpl, node.kind());
        for row in &mut vector {
            for (l, v) in row.iter_mut().enumerate() {
                *v = if seen >> l & 1 != 0 { *v } else { 0.0 };
            }
        }
        let mut lobe = [[0.0; LANES]; 3];
        if makers.general & seen != 0 {
            pass_coat(makers, &mut vector);
            let n = &makers.frame[2];
            let general: Lanes = std::array::from_fn(|l| f32::from((makers.general & seen) >> l & 1));
            for c in 0..3 {
                for l in 0..LANES {
                    let cos = vector[0][l] * n[0][l] + vector[1][l] * n[1][l] + vector[2][l] * n[2][l];
                    lobe[c][l] = (responses[c][l] - makers.base[c][l] * cos) * general[l];
                }
            }
        }
        let mut share = Share::default();
        for (f, function) in basis.at_makers.iter().enumerate() {
            share.vector[f] = Vec3::from_array(std::array::from_fn(|axis| dot(function, &vector[axis])));
            if makers.general != 0 {
                share.lobe[f] = Rgb::from_array(std::array::from_fn(|c| dot(function, &lobe[c])));
            }
        }
        Some((share, Given { vector, lobe }))
    }

    /// Root mean square of the luminance that the fit to `given` lacks or has too much at the makers, times
    /// `inverse_totals`.
    pub fn error(&self, makers: &ReceiverPacket, node: &Node, given: &Given, inverse_totals: &Lanes) -> f32 {
        let Some(basis) = &self.basis else { return f32::INFINITY };
        let (v, r, n) = (&given.vector, &given.lobe, &makers.frame[2]);
        let reflected = luminance(node.intensity * self.base);
        let base =
            std::array::from_fn(|l| reflected * (v[0][l] * n[0][l] + v[1][l] * n[1][l] + v[2][l] * n[2][l]));
        let mut squares = basis.squared_error(&base, inverse_totals);
        if makers.general != 0 {
            let w = node.intensity * LUMINANCE;
            let lobe = std::array::from_fn(|l| w.x * r[0][l] + w.y * r[1][l] + w.z * r[2][l]);
            squares += basis.squared_error(&lobe, inverse_totals);
        }
        // Three degrees of freedom are spent.
        (squares / (makers.len() as f32 - 3.0)).sqrt()
    }

    /// Adds what was fitted to a cluster.
    pub fn add(&mut self, node: &Node, share: &Share) {
        for f in 0..3 {
            for (c, vector) in self.vectors[f].iter_mut().enumerate() {
                *vector += node.intensity[c] * share.vector[f];
            }
            self.lobe[f] += node.intensity * share.lobe[f];
        }
    }

    /// The functions at some points.
    pub fn at(&self, points: &ReceiverPacket) -> At {
        let mut at = [[0.0; LANES]; 3];
        let Some(basis) = &self.basis else { return at };
        for l in 0..LANES {
            let x = Vec3::from_array(std::array::from_fn(|c| points.position[c][l]));
            let offset = x - basis.centre;
            at[0][l] = basis.constant;
            // Nothing is extrapolated.
            for (f, axis) in basis.axes.iter().enumerate() {
                let [least, most] = basis.ranges[f];
                at[f + 1][l] = offset.dot(*axis).clamp(least, most);
            }
        }
        at
    }

    /// What each point reflects of the sum.
    pub fn reflected(&self, points: &ReceiverPacket, at: &At) -> RgbLanes {
        let mut radiance = [[0.0; LANES]; 3];
        for (c, row) in radiance.iter_mut().enumerate() {
            let irradiance = irradiance(points, at, self.vectors.map(|vectors| vectors[c]));
            for l in 0..LANES {
                let lobe =
                    at[0][l] * self.lobe[0][c] + at[1][l] * self.lobe[1][c] + at[2][l] * self.lobe[2][c];
                let lobe = if points.general >> l & 1 != 0 { lobe } else { 0.0 };
                row[l] = points.base[c][l] * irradiance[l] + lobe;
            }
        }
        radiance
    }
}

/// Irradiance at each point from the coefficients of one irradiance vector.
#[inline]
fn irradiance(points: &ReceiverPacket, at: &At, vectors: [Vec3; 3]) -> Lanes {
    let n = &points.frame[2];
    let mut irradiance = [0.0; LANES];
    for (v, at) in vectors.iter().zip(at) {
        for l in 0..LANES {
            irradiance[l] += at[l] * (v.x * n[0][l] + v.y * n[1][l] + v.z * n[2][l]);
        }
    }
    irradiance
}

/// Takes from irradiance vectors what coats reflect.
fn pass_coat(points: &ReceiverPacket, vector: &mut Vec3Lanes) {
    let n = &points.frame[2];
    let passes: Lanes = match &points.glossy {
        Some(glossy) => {
            let mut cos = [0.0; LANES];
            for l in 0..LANES {
                let v = Vec3::new(vector[0][l], vector[1][l], vector[2][l]);
                let length = v.length();
                let along = v.x * n[0][l] + v.y * n[1][l] + v.z * n[2][l];
                cos[l] = if length > 0.0 { along / length } else { 1.0 };
            }
            let passes = glossy.coat_transmittance(&cos);
            std::array::from_fn(|l| if points.general >> l & 1 != 0 { passes[l] } else { 1.0 })
        }
        None => std::array::from_fn(|l| {
            let v = Vec3::new(vector[0][l], vector[1][l], vector[2][l]);
            if points.general >> l & 1 != 0 { points.get(l).coat_transmittance(v) } else { 1.0 }
        }),
    };
    for row in vector {
        row.iter_mut().zip(&passes).for_each(|(v, passes)| *v *= passes);
    }
}

impl Share {
    /// What each point reflects of it.
    pub fn reflected(&self, points: &ReceiverPacket, at: &At) -> RgbLanes {
        let mut radiance = [[0.0; LANES]; 3];
        let irradiance = irradiance(points, at, self.vector);
        for (c, row) in radiance.iter_mut().enumerate() {
            for l in 0..LANES {
                row[l] = points.base[c][l] * irradiance[l];
            }
        }
        if points.general != 0 {
            for l in lanes_of(points.general) {
                let reflected: Rgb = self.lobe.iter().zip(at).map(|(lobe, at)| *lobe * at[l]).sum();
                for c in 0..3 {
                    radiance[c][l] += reflected[c];
                }
            }
        }
        radiance
    }
}

impl Basis {
    fn new(makers: &ReceiverPacket) -> Option<Basis> {
        let count = makers.len() as f32;
        if makers.valid.count_ones() < LEAST_MAKERS {
            return None;
        }
        let at = |l: usize| makers.get(l).position();
        let centre = (0..makers.len()).map(at).sum::<Vec3>() / count;
        let normal: Vec3 = (0..makers.len()).map(|l| makers.get(l).place().1).sum();
        let frame = Frame::from_normal(normal.normalize_or(Vec3::Z));
        let along = |axis: Vec3| {
            let mut lanes = [0.0; LANES];
            lanes_of(makers.valid).for_each(|l| lanes[l] = (at(l) - centre).dot(axis));
            lanes
        };
        let constant = 1.0 / count.sqrt();
        let mut one = [0.0; LANES];
        lanes_of(makers.valid).for_each(|l| one[l] = constant);
        let (u, v) = (along(frame.tangent), along(frame.bitangent));
        let (uu, uv, vv) = (dot(&u, &u), dot(&u, &v), dot(&v, &v));
        // The longer axis first, so that what is left of the other is well conditioned.
        let (first, second, longer) = if uu >= vv {
            (frame.tangent, frame.bitangent, uu)
        } else {
            (frame.bitangent, frame.tangent, vv)
        };
        if !(longer > 0.0) {
            return None;
        }
        let second = second - first * (uv / longer);
        let rest = along(second);
        let shorter = dot(&rest, &rest);
        let wide = shorter > LEAST_EXTENT * LEAST_EXTENT * longer;
        let second = if wide { second / shorter.sqrt() } else { Vec3::ZERO };
        let axes = [first / longer.sqrt(), second];
        let functions = axes.map(along);
        let ranges = functions.map(|f| {
            let least = f.into_iter().fold(f32::INFINITY, f32::min);
            [least, f.into_iter().fold(f32::NEG_INFINITY, f32::max)]
        });
        let radius_sq = (0..makers.len()).map(|l| at(l).distance_squared(centre)).fold(0.0, f32::max);
        Some(Basis {
            centre,
            constant,
            radius_sq,
            axes,
            ranges,
            at_makers: [one, functions[0], functions[1]],
        })
    }

    /// Sum of the squares of what the fit of `values` leaves, relative to `inverse_totals`.
    fn squared_error(&self, values: &Lanes, inverse_totals: &Lanes) -> f32 {
        let k = self.at_makers.each_ref().map(|f| dot(f, values));
        let [one, u, v] = &self.at_makers;
        let mut squares = [0.0; LANES];
        for l in 0..LANES {
            // The functions are 0 in lanes without a maker, and so are the values.
            let left = (values[l] - k[0] * one[l] - k[1] * u[l] - k[2] * v[l]) * inverse_totals[l];
            squares[l] = left * left;
        }
        squares.iter().sum()
    }
}

fn dot(a: &Lanes, b: &Lanes) -> f32 {
    let mut products: Lanes = std::array::from_fn(|l| a[l] * b[l]);
    let mut half = LANES / 2;
    while half > 0 {
        for l in 0..half {
            products[l] += products[l + half];
        }
        half /= 2;
    }
    products[0]
}
