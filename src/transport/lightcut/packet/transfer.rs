//! Light transfer from one VPL to all receivers of a packet.

use super::ReceiverPacket;
use crate::lightcut::Transfer;
use crate::lights::{Vpl, VplKind};
use base::math::{F32x16, LANES, LUMINANCE, Lane, Mask16, Rgb, V3, Vec3x16, lanes_in};

impl Transfer<'_> {
    /// Returns the lanes that a visible VPL of unit intensity lights, and its contributions.
    pub fn unshadowed16(&self, receivers: &ReceiverPacket, vpl: &Vpl, kind: VplKind) -> (u16, Vec3x16) {
        let (wi, irradiance) = self.incident(receivers.position.load(), vpl, kind);
        let [x, y, z] = receivers.frame.load();
        let cos = wi.dot(z);
        let mut responses = receivers.brdf.load().times(cos.positive() * irradiance);
        let general = Mask16::of(receivers.general);
        let lit = (general & cos.is_positive() & irradiance.is_positive()).bits();
        if lit != 0 {
            let reflected = match &receivers.glossy {
                Some(glossy) => glossy.response(V3::new(wi.dot(x), wi.dot(y), cos)).times(irradiance),
                None => {
                    let mut reflected = Vec3x16::ZERO;
                    for lane in lanes_in(lit) {
                        reflected.set(lane, self.unshadowed(receivers.get(lane), vpl, kind));
                    }
                    reflected.load()
                }
            };
            responses = V3::select(general, reflected, responses);
        }
        let lit = (responses.x + responses.y + responses.z).is_positive();
        (lit.bits() & receivers.valid, responses.into())
    }

    /// Returns the irradiance vector at each receiver from a visible VPL of unit intensity; 0 if it is below the
    /// horizon.
    pub(in crate::lightcut) fn incidence16(
        &self,
        receivers: &ReceiverPacket,
        vpl: &Vpl,
        kind: VplKind,
    ) -> Vec3x16 {
        let (wi, irradiance) = self.incident(receivers.position.load(), vpl, kind);
        wi.times(irradiance).keep(wi.dot(receivers.frame.normal().load()).is_positive()).into()
    }
}

/// Returns the luminance of each lane's colour times `intensity`.
#[inline]
pub(in crate::lightcut) fn luminances(intensity: Rgb, responses: &Vec3x16) -> F32x16 {
    let (w, r) = (intensity * LUMINANCE, responses);
    // Closures might not be inlined here, so this is a loop.
    let mut luminances = [0.0; LANES];
    for l in 0..LANES {
        luminances[l] = w.x * r.x[l] + w.y * r.y[l] + w.z * r.z[l];
    }
    luminances
}
