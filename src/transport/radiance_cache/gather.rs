//! Sums over the clusters of a converged cut that make up a record.
//!
//! Paper: Herzog et al. 2009, Eqs. 7 to 10 and section 5.1; Krivanek et al. 2005 for the gradient of one light. With q
//! from the record to a virtual light of normal n_y and a = -n_y·q, an unoccluded light of unit intensity gives the
//! irradiance vector a q/|q|⁴ and the tangential gradient (n·q)(n_y + 4 a q/|q|²)/|q|⁴. An omni light gives q/|q|³ and
//! 3 (n·q) q/|q|⁵, a directional light its direction and no gradient.
//!
//! Deviations: clamped lights and lights nearer than the minimum distance have no gradient. The falloff of a spot
//! light's cone is treated as constant. The footprint follows from the harmonic mean distance of visible lights and
//! occluders, weighted by the unoccluded contribution of each light. A multiple of the paper's minimum distance bounds
//! that mean. The occluder is the one that stopped the shadow ray, not the nearest.

use super::lit_cluster::{Arriving16, LitCluster, RecordPoints};
use crate::lights::{LobeProfile, VplKind};
use base::math::{F32x16, LANES, Rgb, Vec3x16, luminance};
use glam::{Mat3, Vec3};

/// Lower bound of the cosine that relative derivatives are divided by. Both vanish if the light is seen edge-on.
const MIN_COS: f32 = 1e-3;

/// Maximum ratio of the distance that sets the footprint to the minimum distance.
const MAX_OVER_MINIMUM: f32 = 2.0;

/// Sums over the lights of one layer at one point.
#[derive(Clone, Copy, Debug)]
pub struct GatheredLayer {
    /// Irradiance.
    pub irradiance: Rgb,
    /// Irradiance vector per channel.
    pub vector: Mat3,
    /// Gradient per channel, not yet projected onto the tangent plane.
    pub gradient: Mat3,
    /// Sum of the luminances of all lights, visible or hidden.
    pub weight: f32,
    /// Sum of luminance over distance, to the light or to its occluder.
    pub nearness: f32,
    /// Minimum of these distances.
    pub min_distance: f32,
    /// Maximum geometry term of a clamped light; infinite if another quantity is clamped.
    pub bound: f32,
    /// Clusters in the cut, of all layers.
    pub cut: u32,
    /// Luminance of the irradiance removed by clamping.
    pub clamped: f32,
    /// Luminance of the irradiance recovered by short rays.
    pub compensated: f32,
}

impl Default for GatheredLayer {
    fn default() -> GatheredLayer {
        GatheredLayer {
            irradiance: Rgb::ZERO,
            vector: Mat3::ZERO,
            gradient: Mat3::ZERO,
            weight: 0.0,
            nearness: 0.0,
            min_distance: f32::INFINITY,
            bound: f32::INFINITY,
            cut: 0,
            clamped: 0.0,
            compensated: 0.0,
        }
    }
}

/// Sums over the lights of one layer at the points of sixteen records: the fields of [`GatheredLayer`], and second
/// derivatives.
pub struct GatheredLayer16 {
    /// Columns of the irradiance vectors.
    vector: [Vec3x16; 3],
    /// Columns of the gradients.
    gradient: [Vec3x16; 3],
    weight: F32x16,
    nearness: F32x16,
    min_distance: F32x16,
    clamped: F32x16,
    /// Second derivatives uu, uv, vv of the luminance in the frame of each point, at constant visibility.
    second: [F32x16; 3],
}

impl Default for GatheredLayer16 {
    fn default() -> GatheredLayer16 {
        let zero = [0.0; LANES];
        GatheredLayer16 {
            vector: [Vec3x16::ZERO; 3],
            gradient: [Vec3x16::ZERO; 3],
            weight: zero,
            nearness: zero,
            min_distance: [f32::INFINITY; LANES],
            clamped: zero,
            second: [zero; 3],
        }
    }
}

impl GatheredLayer16 {
    /// Adds the light of a cluster of the cut.
    pub fn add(&mut self, points: &RecordPoints, cluster: &LitCluster, light: &Arriving16) {
        let oriented = cluster.node.kind() == VplKind::Oriented;
        let lobe = cluster.lobe();
        let normal = if oriented { cluster.vpl.normal() } else { Vec3::ZERO };
        // Powers of the distance in the ratio of falloff to height above the tangent plane.
        let power = if oriented { 4.0 } else { 3.0 };
        let max_inverse_sq = 1.0 / cluster.near_sq();
        let axes = &points.axes;
        for l in 0..LANES {
            let (passed, inverse, retained) = (light.passed.get(l), light.inverse[l], light.retained[l]);
            let y = luminance(passed);
            let lit = y > 0.0;
            let local = light.direction.get(l);
            let direction = axes[0].get(l) * local.x + axes[1].get(l) * local.y + axes[2].get(l) * local.z;
            // Irradiance = intensity · height · (the remaining factors). The vector lacks the height.
            let vector = direction * if lit { 1.0 / local.z } else { 0.0 };
            let moves = lit && retained >= 1.0 && inverse * inverse < max_inverse_sq;
            let rate = if moves { inverse } else { 0.0 };
            let cos = if oriented { -normal.dot(direction) } else { 1.0 };
            let (turning, bending) = match lobe {
                Some(lobe) if lit => relative_derivatives(lobe, -direction),
                _ => (normal * (1.0 / if cos > MIN_COS { cos } else { MIN_COS }), 0.0),
            };
            let gradient = (turning + direction * power) * rate;
            for c in 0..3 {
                let (v, g) = (&mut self.vector[c], &mut self.gradient[c]);
                v.x[l] += vector.x * passed[c];
                v.y[l] += vector.y * passed[c];
                v.z[l] += vector.z * passed[c];
                g.x[l] += gradient.x * passed[c];
                g.y[l] += gradient.y * passed[c];
                g.z[l] += gradient.z * passed[c];
            }
            self.weight[l] += y;
            self.nearness[l] += y * inverse;
            let distance = if lit && inverse > 0.0 { 1.0 / inverse } else { f32::INFINITY };
            self.min_distance[l] =
                if distance < self.min_distance[l] { distance } else { self.min_distance[l] };
            self.clamped[l] += y * if retained > 0.0 { 1.0 / retained - 1.0 } else { 0.0 };
            // Second derivatives of the irradiance over the irradiance, times the squared distance.
            let (u, v) = (local.x, local.y);
            let (n_u, n_v) = (turning.dot(axes[0].get(l)), turning.dot(axes[1].get(l)));
            let crossed = power * (power + 2.0);
            let scale = y * rate * inverse;
            self.second[0][l] += scale * (8.0 * n_u * u + crossed * u * u - power - bending);
            self.second[1][l] += scale * (4.0 * (n_u * v + n_v * u) + crossed * u * v);
            self.second[2][l] += scale * (8.0 * n_v * v + crossed * v * v - power - bending);
        }
    }

    /// Adds a light that an occluder at `distance` hides from a point.
    #[inline]
    pub fn hidden(&mut self, lane: usize, luminance: f32, distance: f32) {
        self.weight[lane] += luminance;
        self.nearness[lane] += luminance / distance;
        self.min_distance[lane] = self.min_distance[lane].min(distance);
    }

    /// Returns second derivatives uu, uv, vv of the luminance at a point, in its frame, at constant visibility.
    pub fn second_derivatives(&self, lane: usize) -> [f32; 3] {
        self.second.map(|derivative| derivative[lane])
    }

    /// Returns the sums at one point, whose cut has `cut` clusters and geometry terms up to `bound`.
    pub fn layer(&self, points: &RecordPoints, lane: usize, cut: u32, bound: f32) -> GatheredLayer {
        let columns = |of: &[Vec3x16; 3]| Mat3::from_cols(of[0].get(lane), of[1].get(lane), of[2].get(lane));
        let vector = columns(&self.vector);
        GatheredLayer {
            irradiance: vector.transpose() * points.axes[2].get(lane),
            vector,
            gradient: columns(&self.gradient),
            weight: self.weight[lane],
            nearness: self.nearness[lane],
            min_distance: self.min_distance[lane],
            bound,
            cut,
            clamped: self.clamped[lane],
            compensated: 0.0,
        }
    }
}

impl GatheredLayer {
    /// Adds irradiance, already filtered, that short rays found at `distance`.
    ///
    /// Deviations: the irradiance gets the direction of the normal, so that a grazing ray does not weigh heavily on
    /// other normals. It has no gradient.
    pub fn compensate(&mut self, normal: Vec3, irradiance: Rgb, distance: f32) {
        let y = luminance(irradiance);
        self.irradiance += irradiance;
        self.vector += outer(normal, irradiance);
        self.weight += y;
        self.nearness += y / distance;
        self.compensated += y;
    }

    /// Returns the distance that sets the size of the footprint: the harmonic mean over all lights, visible or hidden,
    /// bounded by a multiple of the minimum.
    pub fn distance(&self) -> f32 {
        let mean = if self.nearness > 0.0 { self.weight / self.nearness } else { f32::INFINITY };
        mean.min(MAX_OVER_MINIMUM * self.min_distance)
    }
}

/// Returns `v` times each channel, one column per channel.
#[inline]
fn outer(v: Vec3, c: Rgb) -> Mat3 {
    Mat3::from_cols(v * c.x, v * c.y, v * c.z)
}

/// Returns the first derivative, with respect to direction, of the light that a lobe sends in the unit direction
/// `away`, and the magnitude of the second derivatives. Both are relative to the light.
fn relative_derivatives(lobe: &LobeProfile, away: Vec3) -> (Vec3, f32) {
    let (share, slope, curvature) = lobe.share_and_derivatives(away);
    let share = share.max(MIN_COS);
    (slope / share, curvature / share)
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{MATERIALS, candidate, light, lit_by};
    use super::*;
    use crate::lightcut::Transfer;
    use crate::lightcut::fixtures::profiles;
    use crate::lights::{LightTrees, Origin, Profiles, Vpl, VplSet};
    use glam::Vec3;

    const INTENSITY: Rgb = Rgb::new(3.0, 1.0, 2.0);

    /// Irradiance of the only light at a point.
    fn irradiance(transfer: &Transfer, position: Vec3, normal: Vec3) -> Rgb {
        let node = &transfer.trees.nodes[transfer.trees.roots[0] as usize];
        let receiver = candidate(position, normal).receiver();
        INTENSITY * transfer.unshadowed(&receiver, &transfer.trees.vpls[0], node.kind())
    }

    /// Light gathered from the only light, of which clamping retains a share.
    fn gathered(transfer: &Transfer, position: Vec3, normal: Vec3, retained: f32) -> GatheredLayer {
        let cluster = LitCluster::new(transfer, transfer.trees.roots[0]);
        let response = irradiance(transfer, position, normal).x / INTENSITY.x;
        // The last of three, the others of which look elsewhere.
        let group = [candidate(position, -normal), candidate(-position, normal), candidate(position, normal)];
        let points = RecordPoints::new(&group, &MATERIALS);
        let mut layer = GatheredLayer16::default();
        let responses = Vec3x16::splat(Rgb::splat(response));
        let light = points.arriving(&cluster, &responses, [retained; LANES]);
        layer.add(&points, &cluster, &light);
        let layer = layer.layer(&points, 2, 1, f32::INFINITY);
        assert!((light.passed.get(2) - layer.irradiance).length() <= 1e-6 * INTENSITY.length());
        layer
    }

    fn lights() -> Vec<LightTrees> {
        let (near, far) = (Vec3::new(0.4, -0.3, 0.9), Vec3::new(-2.0, 1.0, 3.0));
        let facing = Vec3::new(-0.2, 0.5, -0.8).normalize();
        let towards_light = Vec3::new(-0.6, 0.1, -0.3).normalize();
        let lobe = LobeProfile { normal: facing, towards_light, ..profiles().lobes[0] };
        let mut lobed = VplSet::new(VplKind::Lobed, Origin::Indirect);
        lobed.push(Vpl::lobed(near, 0), INTENSITY);
        vec![
            light(VplKind::Omni, Vpl::omni(near), INTENSITY),
            light(VplKind::Omni, Vpl::omni(far), INTENSITY),
            light(VplKind::Oriented, Vpl::oriented(near, facing), INTENSITY),
            light(VplKind::Oriented, Vpl::oriented(far, -Vec3::Z), INTENSITY),
            light(VplKind::Directional, Vpl::directional(far.normalize()), INTENSITY),
            lit_by(&[lobed], Profiles { lobes: vec![lobe], ..Profiles::default() }),
        ]
    }

    #[test]
    fn vector_and_gradient_are_those_of_the_irradiance() {
        let (position, step) = (Vec3::new(0.1, 0.2, -0.3), 2e-3);
        let normal = Vec3::new(0.1, 0.2, 1.0).normalize();
        for trees in lights() {
            let transfer = Transfer::new(&trees, 1.0);
            let layer = gathered(&transfer, position, normal, 1.0);
            let here = irradiance(&transfer, position, normal);
            assert!((layer.irradiance - here).length() < 1e-6 * here.length());
            for tilted in [normal, Vec3::Z, Vec3::new(-0.2, 0.1, 1.0).normalize()] {
                let truth = irradiance(&transfer, position, tilted);
                let found = layer.vector.transpose() * tilted;
                assert!((found - truth).length() < 1e-5 * truth.length(), "{found} against {truth}");
            }
            for along in [normal.any_orthonormal_vector(), normal.cross(normal.any_orthonormal_vector())] {
                let at = |by: f32| irradiance(&transfer, position + along * by, normal);
                let truth = (at(step) - at(-step)) / (2.0 * step);
                let found = layer.gradient.transpose() * along;
                assert!((found - truth).length() < 2e-3 * here.length(), "{found} against {truth}");
            }
        }
    }

    #[test]
    fn clamped_and_too_near_lights_have_no_gradient() {
        let trees = &lights()[2];
        let transfer = Transfer::new(trees, 1.0);
        let whole = gathered(&transfer, Vec3::ZERO, Vec3::Z, 1.0);
        let half = gathered(&transfer, Vec3::ZERO, Vec3::Z, 0.5);
        assert!((half.irradiance - 0.5 * whole.irradiance).length() < 1e-6);
        assert!((half.clamped - 0.5 * luminance(whole.irradiance)).abs() < 1e-6);
        assert!(whole.clamped == 0.0 && whole.gradient != Mat3::ZERO && half.gradient == Mat3::ZERO);
        let near = Transfer { min_dist_sq: 4.0, ..transfer };
        assert_eq!(gathered(&near, Vec3::ZERO, Vec3::Z, 1.0).gradient, Mat3::ZERO);
        // Below the horizon there is no light.
        assert_eq!(gathered(&transfer, Vec3::ZERO, -Vec3::Z, 1.0).irradiance, Rgb::ZERO);
    }

    #[test]
    fn the_distance_is_a_harmonic_mean_near_the_least() {
        let group = [candidate(Vec3::ZERO, Vec3::Z)];
        let points = RecordPoints::new(&group, &MATERIALS);
        let mut sums = GatheredLayer16::default();
        let at_point = |sums: &GatheredLayer16| sums.layer(&points, 0, 1, f32::INFINITY);
        assert_eq!(at_point(&sums).distance(), f32::INFINITY);
        sums.hidden(0, 3.0, 2.0);
        sums.hidden(0, 1.0, 4.0);
        assert!((at_point(&sums).distance() - 4.0 / (3.0 / 2.0 + 1.0 / 4.0)).abs() < 1e-6);
        sums.hidden(0, 1e-9, 0.5);
        let mut layer = at_point(&sums);
        assert_eq!(layer.distance(), MAX_OVER_MINIMUM * 0.5);
        assert_eq!((layer.irradiance, layer.weight), (Rgb::ZERO, 4.0));
        layer.compensate(Vec3::Z, Rgb::ONE, 0.25);
        assert_eq!((layer.vector.transpose() * Vec3::Z, layer.gradient), (Rgb::ONE, Mat3::ZERO));
        assert!((layer.compensated - 1.0).abs() < 1e-6 && (layer.weight - 5.0).abs() < 1e-6);
    }
}
