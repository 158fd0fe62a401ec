//! From a converged cut to the contents of a record.
//!
//! Paper: Herzog et al. 2009, Eqs. 7 to 10 and section 5.1; Krivanek et al. 2005 for the gradient of one
//! light. With q from the record to a virtual light of normal n_y and a = -n_y·q, an unoccluded light of unit
//! intensity gives the irradiance vector a q/|q|⁴ and the tangential gradient (n·q)(n_y + 4 a q/|q|²)/|q|⁴;
//! an omni light q/|q|³ and 3 (n·q) q/|q|⁵; a directional light its direction and no gradient.
//!
//! Deviations: a clamped light has no gradient, nor have lights nearer than the minimum distance. The falloff
//! of a spot light's cone is taken as constant. The distance that sets the footprint is the paper's, the
//! minimum to a visible light or an occluder, tempered by the harmonic mean of the same, weighted by each
//! light's unoccluded contribution; the occluder is the one that stopped the shadow ray, not the nearest.

use super::source::Candidate;
use crate::light_tree::Node;
use crate::lightcut::Transfer;
use crate::material::Materials;
use crate::math::{Rgb, luminance};
use crate::vpl::{Vpl, VplKind};
use crate::world::SurfacePoint;
use glam::{Mat3, Vec3};

/// Maximum ratio of the distance that sets the footprint to the minimum one.
const MAX_OVER_LEAST: f32 = 2.0;

/// Sums over the lights of one layer as seen from one point.
#[derive(Clone, Copy, Debug)]
pub struct GatheredLayer {
    /// Irradiance.
    pub irradiance: Rgb,
    /// Irradiance vector per channel.
    pub vector: Mat3,
    /// Gradient per channel, not yet projected on the tangent plane.
    pub gradient: Mat3,
    /// Sum of the luminances of all lights, hidden or not.
    pub weight: f32,
    /// Sum of the same over the distance to the light or to its occluder.
    pub nearness: f32,
    /// Minimum of those distances.
    pub least: f32,
    /// Maximum geometry term of a clamped light; infinite if another quantity is clamped.
    pub bound: f32,
    /// Clusters in the cut, of all layers.
    pub cut: u32,
    /// Luminance of the irradiance that clamping took away.
    pub clamped: f32,
    /// Luminance of the irradiance that short rays gave back.
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
            least: f32::INFINITY,
            bound: f32::INFINITY,
            cut: 0,
            clamped: 0.0,
            compensated: 0.0,
        }
    }
}

/// Cluster of a cut, as its representative lights the point of a record.
#[derive(Clone, Copy)]
pub struct LitCluster<'t> {
    /// Transfer from the virtual lights.
    pub transfer: &'t Transfer<'t>,
    /// The cluster.
    pub node: &'t Node,
    /// Its representative.
    pub vpl: &'t Vpl,
    /// Irradiance before clamping and coat.
    pub irradiance: Rgb,
    /// Share of it that clamping leaves; 1 if it is not clamped.
    pub kept: f32,
}

impl LitCluster<'_> {
    /// Returns the minimum squared distance that the geometry term of the representative divides by.
    #[inline]
    pub fn near_sq(&self) -> f32 {
        self.transfer.near_sq(self.vpl, self.node.kind())
    }
}

impl GatheredLayer {
    /// Adds a cluster of the cut. Returns its irradiance at the point after clamping and coat.
    #[inline]
    pub fn add(&mut self, point: &Candidate, materials: &Materials, cluster: &LitCluster) -> Rgb {
        let &LitCluster { node, vpl, irradiance, kept, .. } = cluster;
        let SurfacePoint { position, normal, .. } = point.point;
        let filter = |cos: f32| match point.coat {
            0 => 1.0,
            coat => materials.coat_transmittance(coat, cos.min(1.0)),
        };
        let kind = node.kind();
        if kind == VplKind::Directional {
            let cos = normal.dot(vpl.position);
            if cos <= 0.0 {
                return Rgb::ZERO;
            }
            let passed = irradiance * filter(cos);
            self.irradiance += passed;
            self.weight += luminance(passed);
            self.vector += outer(vpl.position / cos, passed);
            return passed;
        }
        let q = vpl.position - position;
        let dist_sq = q.length_squared();
        let height = normal.dot(q);
        if !(height > 0.0) {
            return Rgb::ZERO;
        }
        let distance = dist_sq.sqrt();
        let filtered = irradiance * filter(height / distance);
        let passed = filtered * kept;
        self.clamped += luminance(filtered - passed);
        self.irradiance += passed;
        self.weight += luminance(passed);
        self.nearness += luminance(passed) / distance;
        self.least = self.least.min(distance);
        // Irradiance = intensity · height · (the rest); the vector lacks the height.
        self.vector += outer(q / height, passed);
        if kept < 1.0 || dist_sq <= cluster.near_sq() {
            return passed;
        }
        let relative = match kind {
            VplKind::Oriented => {
                let n = vpl.normal();
                let a = -n.dot(q);
                // Where the light is seen edge-on, a and the contribution vanish together.
                n / a.max(1e-3 * distance) + 4.0 * q / dist_sq
            }
            _ => 3.0 * q / dist_sq,
        };
        self.gradient += outer(relative, passed);
        passed
    }

    /// Adds irradiance, already filtered, that short rays found at `distance`.
    ///
    /// Deviations: it is given the direction of the normal, lest a grazing ray weigh heavily where the normal
    /// differs, and no gradient.
    pub fn compensate(&mut self, normal: Vec3, irradiance: Rgb, distance: f32) {
        let y = luminance(irradiance);
        self.irradiance += irradiance;
        self.vector += outer(normal, irradiance);
        self.weight += y;
        self.nearness += y / distance;
        self.compensated += y;
    }

    /// Adds a light that is hidden by something at `distance`.
    #[inline]
    pub fn hidden(&mut self, luminance: f32, distance: f32) {
        self.weight += luminance;
        self.nearness += luminance / distance;
        self.least = self.least.min(distance);
    }

    /// Returns the distance that sets the reach of the record: the harmonic mean over all lights, visible or
    /// not, but at most a multiple of the minimum.
    pub fn distance(&self) -> f32 {
        let mean = if self.nearness > 0.0 { self.weight / self.nearness } else { f32::INFINITY };
        mean.min(MAX_OVER_LEAST * self.least)
    }
}

/// One column a channel: `v` times the channel.
#[inline]
fn outer(v: Vec3, c: Rgb) -> Mat3 {
    Mat3::from_cols(v * c.x, v * c.y, v * c.z)
}

#[cfg(test)]
mod tests {
    use super::super::fixtures::{MATERIALS, candidate, light};
    use super::*;
    use crate::light_tree::LightTrees;
    use glam::Vec3;

    const INTENSITY: Rgb = Rgb::new(3.0, 1.0, 2.0);

    /// Irradiance of the only light at a point.
    fn irradiance(transfer: &Transfer, position: Vec3, normal: Vec3) -> Rgb {
        let node = &transfer.trees.nodes[transfer.trees.roots[0] as usize];
        let receiver = candidate(position, normal).receiver();
        INTENSITY * transfer.unshadowed(&receiver, &transfer.trees.vpls[0], node.kind())
    }

    /// Light gathered from the only light, of which `kept` is left.
    fn gathered(transfer: &Transfer, position: Vec3, normal: Vec3, kept: f32) -> GatheredLayer {
        let node = &transfer.trees.nodes[transfer.trees.roots[0] as usize];
        let vpl = &transfer.trees.vpls[0];
        let irradiance = irradiance(transfer, position, normal);
        let cluster = LitCluster { transfer, node, vpl, irradiance, kept };
        let mut layer = GatheredLayer::default();
        let passed = layer.add(&candidate(position, normal), &MATERIALS, &cluster);
        assert_eq!(passed, layer.irradiance);
        layer
    }

    fn lights() -> Vec<LightTrees> {
        let (near, far) = (Vec3::new(0.4, -0.3, 0.9), Vec3::new(-2.0, 1.0, 3.0));
        let facing = Vec3::new(-0.2, 0.5, -0.8).normalize();
        vec![
            light(VplKind::Omni, Vpl::omni(near), INTENSITY),
            light(VplKind::Omni, Vpl::omni(far), INTENSITY),
            light(VplKind::Oriented, Vpl::oriented(near, facing), INTENSITY),
            light(VplKind::Oriented, Vpl::oriented(far, -Vec3::Z), INTENSITY),
            light(VplKind::Directional, Vpl::directional(far.normalize()), INTENSITY),
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
        let mut layer = GatheredLayer::default();
        assert_eq!(layer.distance(), f32::INFINITY);
        layer.hidden(3.0, 2.0);
        layer.hidden(1.0, 4.0);
        assert!((layer.distance() - 4.0 / (3.0 / 2.0 + 1.0 / 4.0)).abs() < 1e-6);
        layer.hidden(1e-9, 0.5);
        assert_eq!(layer.distance(), MAX_OVER_LEAST * 0.5);
        assert_eq!((layer.irradiance, layer.weight), (Rgb::ZERO, 4.0));
        layer.compensate(Vec3::Z, Rgb::ONE, 0.25);
        assert_eq!((layer.vector.transpose() * Vec3::Z, layer.gradient), (Rgb::ONE, Mat3::ZERO));
        assert!((layer.compensated - 1.0).abs() < 1e-6 && (layer.weight - 5.0).abs() < 1e-6);
    }
}
