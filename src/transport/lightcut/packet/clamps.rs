//! Limits of the contributions of single indirect VPLs to the points of a packet.
//!
//! Papers: Kollig and Keller 2004 (geometry terms G = cosθ_x cosθ_y / r² are limited to a bound b); Herzog et al. 2009,
//! Eq. 13 (a VPL of the mean intensity around the point gives a share of the frozen luminance if G = b).
//! Deviations: VPLs much brighter than the mean are limited more, see [`BRIGHTER`]. If clamped light is not
//! compensated, or the point has no base, luminances are limited and geometry terms are not.

use super::{ReceiverPacket, luminances};
use crate::lightcut::clamp::is_weak;
use crate::lightcut::{Receiver, Transfer};
use crate::lights::LightNode;
use base::math::{F32x16, LANES, Lane, Vec3x16, f32x16, lanes_in, luminance};

/// Maximum luminance that a VPL may give, relative to the limit, if geometry terms are limited. A much brighter one
/// would leave a spot.
const BRIGHTER: f32 = 2.0;

/// Limits of the contributions of indirect VPLs to the points of a packet.
#[derive(Clone, Copy, Debug)]
pub struct Clamps {
    /// Maximum geometry terms; infinite if they are not limited.
    pub bounds: F32x16,
    /// Maximum luminances.
    pub luminances: F32x16,
}

impl Default for Clamps {
    /// Returns limits that are never reached.
    fn default() -> Clamps {
        Clamps { bounds: [f32::INFINITY; LANES], luminances: [f32::INFINITY; LANES] }
    }
}

impl Clamps {
    /// Returns the limits at which VPLs of the mean intensities around the points give these `shares` of luminance.
    pub fn new(transfer: &Transfer, receivers: &ReceiverPacket, shares: &F32x16) -> Clamps {
        let mut clamps = Clamps { luminances: *shares, ..Clamps::default() };
        for lane in lanes_in(receivers.valid) {
            let bound = bound(transfer, receivers.get(lane), shares[lane]);
            if bound < f32::INFINITY {
                clamps.bounds[lane] = bound;
                clamps.luminances[lane] *= BRIGHTER;
            }
        }
        clamps
    }

    /// Returns the contribution of a VPL relative to the limits. `responses` are its contributions at unit intensity. A
    /// VPL above 1 is clamped.
    #[inline]
    pub fn strain(
        &self,
        transfer: &Transfer,
        receivers: &ReceiverPacket,
        node: &LightNode,
        responses: &Vec3x16,
    ) -> f32x16 {
        let (position, normal) = (receivers.position.load(), receivers.frame.normal().load());
        let vpl = &transfer.trees.vpls[node.representative()];
        let geometry = transfer.geometry_term(position, normal, vpl, node.kind());
        let luminances = f32x16::new(luminances(node.intensity, responses));
        (geometry / f32x16::new(self.bounds)).max(luminances / f32x16::new(self.luminances))
    }

    /// Returns the share of a cluster's contribution that each point retains.
    #[inline]
    pub fn retained(
        &self,
        transfer: &Transfer,
        receivers: &ReceiverPacket,
        node: &LightNode,
        responses: &Vec3x16,
    ) -> F32x16 {
        if !is_weak(node) {
            return [1.0; LANES];
        }
        self.strain(transfer, receivers, node, responses).max(f32x16::from(1.0)).recip().to_array()
    }

    /// Returns the share of a contribution of this `geometry` term and `luminance` that the point in a lane retains.
    #[inline]
    pub fn retained_in(&self, lane: usize, geometry: f32, luminance: f32) -> f32 {
        let strain = Lane::max(geometry / self.bounds[lane], luminance / self.luminances[lane]);
        Lane::max(strain, 1.0).recip()
    }
}

/// Returns the geometry term at which a VPL of the mean intensity gives a `share` of luminance; infinite if geometry
/// terms are not limited.
fn bound(transfer: &Transfer, receiver: &Receiver, share: f32) -> f32 {
    let base = luminance(receiver.base_brdf());
    if base > 0.0 { transfer.bound(receiver.position(), share / base) } else { f32::INFINITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lightcut::fixtures::{RandomNumbers, alone, room};
    use crate::lights::{Intensities, IntensitySamples, LightTrees, Profiles};
    use base::math::Frame;
    use base::progress::Control;
    use glam::Vec3;

    #[test]
    fn geometry_terms_and_luminances_are_kept_within_their_limits() {
        let set = room(300, &mut RandomNumbers(5));
        let intensities =
            Intensities::new(&IntensitySamples::new(std::slice::from_ref(&set), &Profiles::default()));
        let trees = LightTrees::build(&[set], Vec::new(), 1.7, &Control::new());
        let plain = Transfer::new(&trees, 1.7);
        let transfer = Transfer { intensities: intensities.as_ref(), ..plain };
        let x = Vec3::new(0.02, 0.4, 0.5);
        let point = alone(Receiver::irradiance(x, Vec3::Z, &Frame::from_normal(Vec3::Z)));
        let mut clamped = 0;
        for share in [0.01f32, 0.1, 1.0] {
            let bounded = Clamps::new(&transfer, &point, &[share; LANES]);
            let mean = intensities.as_ref().expect("there are lights").around(x);
            assert!(
                (bounded.bounds[0] * mean / share - 1.0).abs() < 1e-5 && bounded.bounds[1] == f32::INFINITY
            );
            for clamps in [bounded, Clamps::new(&plain, &point, &[share; LANES])] {
                for leaf in trees.leaves() {
                    let vpl = &trees.vpls[leaf.representative()];
                    let (_, responses) = transfer.unshadowed16(&point, vpl, leaf.kind());
                    let retained = clamps.retained(&transfer, &point, leaf, &responses)[0];
                    let (geometry, y) = (responses.x[0], luminance(responses.get(0) * leaf.intensity));
                    let limited = y.min(clamps.luminances[0]).min(y * clamps.bounds[0] / geometry.max(1e-30));
                    assert!((retained * y - limited).abs() <= 1e-4 * limited, "{retained} of {y}: {limited}");
                    clamped += usize::from(retained < 1.0);
                    assert!((clamps.retained_in(0, geometry, y) - retained).abs() < 1e-4);
                }
            }
        }
        assert!(clamped > 10, "{clamped}");
        assert_eq!(Clamps::default().retained_in(3, 1e30, 1e30), 1.0);
    }
}
