//! From a converged cut to the contents of a record.
//!
//! Paper: Herzog et al. 2009, Eqs. 7 to 10 and section 5.1; Krivanek et al. 2005 for the gradient of one light.
//! With q from the record to a virtual light of normal n_y and a = -n_y·q, an unoccluded light of unit intensity
//! gives the irradiance vector a q/|q|⁴ and the tangential gradient (n·q)(n_y + 4 a q/|q|²)/|q|⁴; an omni light
//! q/|q|³ and 3 (n·q) q/|q|⁵; a directional light its direction and no gradient.
//!
//! Deviations: a clamped light has no gradient, and lights nearer than the least distance neither. The falloff
//! of a spot light's cone is taken as constant. The distance that sets the footprint is the paper's, the
//! least to a visible light or an occluder, tempered by the harmonic mean of the same, weighted by what each light
//! gives or would give; occluders are whatever stops a shadow ray, not the nearest.

use crate::light_tree::Node;
use crate::lightcut::{Receiver, Transfer};
use crate::material::Materials;
use crate::math::{Rgb, luminance};
use crate::vpl::{Vpl, VplKind};
use glam::{Mat3, Vec3};

/// Largest ratio of the distance that sets the footprint to the least one.
const NEAR_LIMIT: f32 = 2.0;

/// Sums over the lights of one layer as seen from one point.
#[derive(Clone, Copy, Debug)]
pub struct Gathered {
    /// Irradiance.
    pub irradiance: Rgb,
    /// Irradiance vector per channel.
    pub vector: Mat3,
    /// Gradient per channel, not yet projected on the tangent plane.
    pub gradient: Mat3,
    /// Sum of the luminances of all lights, hidden or not.
    pub weight: f32,
    /// Sum of the same over the distance to the light or to what hides it.
    pub nearness: f32,
    /// Least of those distances.
    pub least: f32,
    /// Largest geometry term that a clamped light counts with; infinite if that is not how they are clamped.
    pub bound: f32,
    /// Clusters in the cut, of all layers.
    pub cut: u32,
    /// Luminance of the irradiance that clamping took away.
    pub clamped: f32,
    /// Luminance of the irradiance that short rays gave back.
    pub compensated: f32,
}

impl Default for Gathered {
    fn default() -> Gathered {
        Gathered {
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

/// The point that gathers.
#[derive(Clone, Copy, Debug)]
pub struct Gatherer<'a> {
    /// What gathers the irradiance.
    pub collector: Receiver<'static>,
    /// Where.
    pub position: Vec3,
    /// Unit shading normal.
    pub normal: Vec3,
    /// Coat that filters the light.
    pub coat: u32,
    /// Of the scene.
    pub materials: &'a Materials,
}

impl Gathered {
    /// Adds a cluster of the cut: its representative gives the irradiance `contribution`, of which `kept` is left
    /// after clamping (1: not clamped). Returns the irradiance added.
    #[inline]
    pub fn add(
        &mut self,
        g: &Gatherer,
        transfer: &Transfer,
        node: &Node,
        vpl: &Vpl,
        contribution: Rgb,
        kept: f32,
    ) -> Rgb {
        let kind = node.kind();
        if kind == VplKind::Directional {
            let cos = g.normal.dot(vpl.position);
            if cos <= 0.0 {
                return Rgb::ZERO;
            }
            let passed = contribution * self.filtered(g, cos);
            self.irradiance += passed;
            self.weight += luminance(passed);
            self.vector += outer(vpl.position / cos, passed);
            return passed;
        }
        let q = vpl.position - g.position;
        let dist_sq = q.length_squared();
        let height = g.normal.dot(q);
        if !(height > 0.0) {
            return Rgb::ZERO;
        }
        let distance = dist_sq.sqrt();
        let filtered = contribution * self.filtered(g, height / distance);
        let passed = filtered * kept;
        self.clamped += luminance(filtered - passed);
        self.irradiance += passed;
        self.weight += luminance(passed);
        self.nearness += luminance(passed) / distance;
        self.least = self.least.min(distance);
        // Contribution = intensity · height · (the rest); the vector lacks the height.
        self.vector += outer(q / height, passed);
        if kept < 1.0 || dist_sq <= transfer.near_sq(vpl, kind) {
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

    /// The distance that sets how far the record reaches: the harmonic mean over all lights, visible or not,
    /// though no more than a multiple of the least.
    pub fn distance(&self) -> f32 {
        let mean = if self.nearness > 0.0 { self.weight / self.nearness } else { f32::INFINITY };
        mean.min(NEAR_LIMIT * self.least)
    }

    #[inline]
    fn filtered(&self, g: &Gatherer, cos: f32) -> f32 {
        if g.coat == 0 { 1.0 } else { g.materials.coat_transmittance(g.coat, cos.min(1.0)) }
    }
}

/// One column a channel: `v` times the channel.
#[inline]
fn outer(v: Vec3, c: Rgb) -> Mat3 {
    Mat3::from_cols(v * c.x, v * c.y, v * c.z)
}
