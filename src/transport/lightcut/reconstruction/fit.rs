//! Linear functions of position, fitted to the light that anchors gather from clusters.
//!
//! A cluster of unit intensity gives each anchor an irradiance vector (0 if it is hidden), and the anchor's lobe, if it
//! has one, reflects some of the light. Functions of the position on the patch's tangent plane are fitted to both by
//! least squares. The sum over the clusters, weighted by their intensities, serves all points of the patch, each with
//! its own normal and base.

use super::basis::{BasisValues, LinearBasis, dot};
use crate::lightcut::packet::PacketCluster;
use crate::lightcut::{ReceiverPacket, Transfer};
use crate::lights::{LightNode, Vpl, VplKind};
use base::math::{F32x16, LANES, LUMINANCE, Rgb, Vec3x16, lanes_in, luminance};
use glam::Vec3;

/// Fit to one cluster of unit intensity: coefficients of the three functions.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LinearFit {
    /// Irradiance vector.
    vector: [Vec3; 3],
    /// Radiance that the lobe reflects.
    lobe: [Rgb; 3],
}

/// Light of a cluster of unit intensity at each anchor.
pub(super) struct AnchorValues {
    /// Irradiance vector.
    vector: Vec3x16,
    /// Radiance that the lobe reflects.
    lobe: Vec3x16,
}

/// Sum of the fits to the clusters of a cut.
#[derive(Default)]
pub(super) struct Interpolant {
    basis: Option<LinearBasis>,
    /// Mean BRDF of the anchors' bases.
    base: Rgb,
    /// Coefficients of the irradiance vectors, by function and channel.
    vectors: [[Vec3; 3]; 3],
    /// Coefficients of the radiance that the lobe reflects, by function.
    lobe: [Rgb; 3],
}

impl Interpolant {
    /// Starts afresh for these anchors.
    pub fn begin(&mut self, anchors: &ReceiverPacket) {
        *self = Interpolant { basis: LinearBasis::new(anchors), ..Interpolant::default() };
        let count = anchors.len().max(1) as f32;
        self.base = (0..anchors.len()).map(|l| anchors.get(l).base_brdf()).sum::<Rgb>() / count;
    }

    /// Fits a cluster that the anchors in the lanes `seen` see; returns the fit and the fitted values. Returns `None`
    /// if there are too few anchors or the cluster is too near.
    pub fn fit(
        &self,
        transfer: &Transfer,
        anchors: &ReceiverPacket,
        cluster: &PacketCluster,
        seen: u16,
    ) -> Option<(LinearFit, AnchorValues)> {
        let node = &transfer.trees.nodes[cluster.node as usize];
        let vpl = &transfer.trees.vpls[node.representative()];
        let basis = self.basis.as_ref().filter(|basis| !is_near(anchors, basis, node, vpl))?;
        let mut vector = transfer.incidence16(anchors, vpl, node.kind());
        vector.keep(seen);
        let mut lobe = Vec3x16::ZERO;
        if anchors.general & seen != 0 {
            pass_coat(anchors, &mut vector);
            lobe = cluster.responses;
            let (n, b) = (anchors.frame.normal(), &anchors.base);
            for l in 0..LANES {
                let cos = vector.x[l] * n.x[l] + vector.y[l] * n.y[l] + vector.z[l] * n.z[l];
                let general = f32::from((anchors.general & seen) >> l & 1);
                lobe.x[l] = (lobe.x[l] - b.x[l] * cos) * general;
                lobe.y[l] = (lobe.y[l] - b.y[l] * cos) * general;
                lobe.z[l] = (lobe.z[l] - b.z[l] * cos) * general;
            }
        }
        let mut fit = LinearFit::default();
        let coefficients =
            |f: &F32x16, values: &Vec3x16| Vec3::from_array(values.rows().map(|row| dot(f, row)));
        for (f, function) in basis.at_anchors.iter().enumerate() {
            fit.vector[f] = coefficients(function, &vector);
            if anchors.general != 0 {
                fit.lobe[f] = coefficients(function, &lobe);
            }
        }
        Some((fit, AnchorValues { vector, lobe }))
    }

    /// Returns the root mean square, over the anchors, of the error of the fit to `values`, as luminance relative to
    /// the totals.
    pub fn error(
        &self,
        anchors: &ReceiverPacket,
        node: &LightNode,
        values: &AnchorValues,
        inverse_totals: &F32x16,
    ) -> f32 {
        let Some(basis) = &self.basis else { return f32::INFINITY };
        let (v, r, n) = (&values.vector, &values.lobe, anchors.frame.normal());
        let reflected = luminance(node.intensity * self.base);
        let base = std::array::from_fn(|l| reflected * (v.x[l] * n.x[l] + v.y[l] * n.y[l] + v.z[l] * n.z[l]));
        let mut squares = basis.squared_error(&base, inverse_totals);
        if anchors.general != 0 {
            let w = node.intensity * LUMINANCE;
            let lobe = std::array::from_fn(|l| w.x * r.x[l] + w.y * r.y[l] + w.z * r.z[l]);
            squares += basis.squared_error(&lobe, inverse_totals);
        }
        // The fit has three degrees of freedom.
        (squares / (anchors.len() as f32 - 3.0)).sqrt()
    }

    /// Adds the fit to a cluster.
    pub fn add(&mut self, node: &LightNode, fit: &LinearFit) {
        for f in 0..3 {
            for (c, vector) in self.vectors[f].iter_mut().enumerate() {
                *vector += node.intensity[c] * fit.vector[f];
            }
            self.lobe[f] += node.intensity * fit.lobe[f];
        }
    }

    /// Returns the values of the functions at some points; 0 if there is no fit.
    pub fn basis_at(&self, receivers: &ReceiverPacket) -> BasisValues {
        self.basis.as_ref().map_or([[0.0; LANES]; 3], |basis| basis.at(receivers))
    }

    /// Returns the radiance that each point reflects from the sum.
    pub fn reflected(&self, receivers: &ReceiverPacket, basis: &BasisValues) -> Vec3x16 {
        let [one, u, v] = basis;
        let channel = |c: usize| {
            let irradiance = irradiance(receivers, basis, self.vectors.map(|vectors| vectors[c]));
            let base = receivers.base.rows()[c];
            let mut radiance = [0.0; LANES];
            for l in 0..LANES {
                let lobe = one[l] * self.lobe[0][c] + u[l] * self.lobe[1][c] + v[l] * self.lobe[2][c];
                let lobe = if receivers.general >> l & 1 != 0 { lobe } else { 0.0 };
                radiance[l] = base[l] * irradiance[l] + lobe;
            }
            radiance
        };
        Vec3x16 { x: channel(0), y: channel(1), z: channel(2) }
    }
}

impl LinearFit {
    /// Returns the radiance that each point reflects from the cluster of unit intensity.
    pub fn reflected(&self, receivers: &ReceiverPacket, basis: &BasisValues) -> Vec3x16 {
        let irradiance = irradiance(receivers, basis, self.vector);
        let base = receivers.base.rows();
        let channel = |c: usize| {
            let mut radiance = [0.0; LANES];
            for l in 0..LANES {
                radiance[l] = base[c][l] * irradiance[l];
            }
            radiance
        };
        let mut radiance = Vec3x16 { x: channel(0), y: channel(1), z: channel(2) };
        for l in lanes_in(receivers.general) {
            let lobe: Rgb = self.lobe.iter().zip(basis).map(|(lobe, value)| *lobe * value[l]).sum();
            radiance.set(l, radiance.get(l) + lobe);
        }
        radiance
    }
}

/// True if a representative is nearer to an anchor than the radius of the anchors. Its light is not linear there.
fn is_near(anchors: &ReceiverPacket, basis: &LinearBasis, node: &LightNode, vpl: &Vpl) -> bool {
    let dist_sq = |l: usize| anchors.get(l).position().distance_squared(vpl.position);
    node.kind() != VplKind::Directional
        && (0..anchors.len()).map(dist_sq).fold(f32::INFINITY, f32::min) < basis.radius_sq
}

/// Returns the irradiance at each point from the coefficients of one irradiance vector.
#[inline]
fn irradiance(receivers: &ReceiverPacket, basis: &BasisValues, vectors: [Vec3; 3]) -> F32x16 {
    let n = receivers.frame.normal();
    let mut irradiance = [0.0; LANES];
    for (v, value) in vectors.iter().zip(basis) {
        for l in 0..LANES {
            irradiance[l] += value[l] * (v.x * n.x[l] + v.y * n.y[l] + v.z * n.z[l]);
        }
    }
    irradiance
}

/// Multiplies irradiance vectors by the transmittance of the coats.
fn pass_coat(receivers: &ReceiverPacket, vector: &mut Vec3x16) {
    let n = receivers.frame.normal();
    let general = |l: usize| receivers.general >> l & 1 != 0;
    let passes: F32x16 = match &receivers.glossy {
        Some(glossy) => {
            let mut cos = [0.0; LANES];
            for l in 0..LANES {
                let v = vector.get(l);
                let length = v.length();
                let along = v.x * n.x[l] + v.y * n.y[l] + v.z * n.z[l];
                cos[l] = if length > 0.0 { along / length } else { 1.0 };
            }
            let passes = glossy.coat_transmittance(&cos);
            std::array::from_fn(|l| if general(l) { passes[l] } else { 1.0 })
        }
        None => std::array::from_fn(|l| {
            if general(l) { receivers.get(l).coat_transmittance(vector.get(l)) } else { 1.0 }
        }),
    };
    for row in [&mut vector.x, &mut vector.y, &mut vector.z] {
        row.iter_mut().zip(&passes).for_each(|(v, passes)| *v *= passes);
    }
}
