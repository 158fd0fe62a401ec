//! Light transfer from one VPL to all receivers of a packet: the formulas for single points as loops over lanes, which
//! compile to vector code.

use super::ReceiverPacket;
use crate::lightcut::Transfer;
use crate::lights::{Vpl, VplKind};
use base::math::{F32x16, LANES, Vec3x16, lanes_in};
use glam::Vec3;
use world::material::AlikeBsdfs16;

impl Transfer<'_> {
    /// Returns the lanes that a visible VPL of unit intensity lights, and its contributions.
    pub fn unshadowed16(&self, receivers: &ReceiverPacket, vpl: &Vpl, kind: VplKind) -> (u16, Vec3x16) {
        let mut responses = Vec3x16::ZERO;
        let mut one_by_one = receivers.general;
        match kind {
            VplKind::Oriented => self.lambert_oriented(receivers, vpl, &mut responses),
            VplKind::Directional => lambert_directional(receivers, vpl.position, &mut responses),
            VplKind::Lobed => self.lambert_lobed(receivers, vpl, &mut responses),
            VplKind::Omni => one_by_one = receivers.valid,
        }
        if let (Some(glossy), false) = (&receivers.glossy, kind == VplKind::Omni) {
            self.respond(glossy, receivers, vpl, kind, &mut responses);
            one_by_one = 0;
        }
        for lane in lanes_in(one_by_one) {
            responses.set(lane, self.unshadowed(receivers.get(lane), vpl, kind));
        }
        let mut lit = 0;
        for l in 0..LANES {
            lit |= u16::from(responses.x[l] + responses.y[l] + responses.z[l] > 0.0) << l;
        }
        (lit & receivers.valid, responses)
    }

    /// Sets the contributions of a VPL without spot profile to the general lanes, if they have equal lobes.
    fn respond(
        &self,
        glossy: &AlikeBsdfs16,
        receivers: &ReceiverPacket,
        vpl: &Vpl,
        kind: VplKind,
        responses: &mut Vec3x16,
    ) {
        let (mut wi, mut emitted) = (Vec3x16::ZERO, [1.0; LANES]);
        let frame = &receivers.frame.axes;
        let (distant, normal) = (kind == VplKind::Directional, vpl.normal());
        let near_sq = self.near_sq(vpl, kind);
        for l in 0..LANES {
            let offset = if distant { vpl.position } else { vpl.position - receivers.position.get(l) };
            let dist_sq = offset.length_squared();
            let towards = offset * if dist_sq > 0.0 { 1.0 / dist_sq.sqrt() } else { 0.0 };
            let limited = if dist_sq > near_sq { dist_sq } else { near_sq };
            let local = |f: &Vec3x16| f.x[l] * towards.x + f.y[l] * towards.y + f.z[l] * towards.z;
            wi.set(l, Vec3::new(local(&frame[0]), local(&frame[1]), local(&frame[2])));
            emitted[l] = if distant { 1.0 } else { positive(-normal.dot(towards)) / limited };
        }
        if kind == VplKind::Lobed {
            emitted = self.lobe_irradiance(receivers, vpl);
        }
        let mut lit = 0;
        for l in 0..LANES {
            lit |= u16::from((wi.z[l] > 0.0) & (emitted[l] > 0.0)) << l;
        }
        // Most clusters below one point's horizon are below every point's horizon.
        if lit & receivers.general == 0 {
            return;
        }
        let response = glossy.response(&wi);
        for l in 0..LANES {
            let general = receivers.general >> l & 1 != 0;
            responses.x[l] = if general { response.x[l] * emitted[l] } else { responses.x[l] };
            responses.y[l] = if general { response.y[l] * emitted[l] } else { responses.y[l] };
            responses.z[l] = if general { response.z[l] * emitted[l] } else { responses.z[l] };
        }
    }

    /// Returns the irradiance vector at each receiver from a visible VPL of unit intensity; 0 if it is below the
    /// horizon.
    pub(in crate::lightcut) fn incidence16(
        &self,
        receivers: &ReceiverPacket,
        vpl: &Vpl,
        kind: VplKind,
    ) -> Vec3x16 {
        let mut vector = Vec3x16::ZERO;
        let n = receivers.frame.normal();
        let near_sq = self.near_sq(vpl, kind);
        let lobe = if kind == VplKind::Lobed { self.lobe_irradiance(receivers, vpl) } else { [0.0; LANES] };
        for l in 0..LANES {
            let distant = kind == VplKind::Directional;
            let offset = if distant { vpl.position } else { vpl.position - receivers.position.get(l) };
            let dist_sq = offset.length_squared();
            let limited = if dist_sq > near_sq { dist_sq } else { near_sq };
            let unit = if dist_sq > 0.0 { 1.0 / dist_sq } else { 0.0 };
            let scale = match kind {
                VplKind::Directional => 1.0,
                VplKind::Oriented => positive(-offset.dot(vpl.normal())) * unit / limited,
                VplKind::Omni => unit.sqrt() / limited,
                VplKind::Lobed => unit.sqrt() * lobe[l],
            };
            let above = offset.x * n.x[l] + offset.y * n.y[l] + offset.z * n.z[l] > 0.0;
            vector.set(l, offset * if above { scale } else { 0.0 });
        }
        if let (VplKind::Omni, Some(profile)) = (kind, vpl.spot_profile()) {
            for l in lanes_in(receivers.valid) {
                let offset = vpl.position - receivers.get(l).position();
                let falloff = self.trees.profiles.spots[profile].falloff(-offset.normalize_or_zero());
                vector.set(l, vector.get(l) * falloff);
            }
        }
        vector
    }

    /// Returns the irradiance from a lobed VPL of unit intensity on a surface at each receiver that faces it.
    fn lobe_irradiance(&self, receivers: &ReceiverPacket, vpl: &Vpl) -> F32x16 {
        let (mut away, mut falloff) = (Vec3x16::ZERO, [0.0; LANES]);
        let (y, x) = (vpl.position, &receivers.position);
        for l in 0..LANES {
            let (dx, dy, dz) = (x.x[l] - y.x, x.y[l] - y.y, x.z[l] - y.z);
            let dist_sq = dx * dx + dy * dy + dz * dz;
            let limited = if dist_sq > self.min_dist_sq { dist_sq } else { self.min_dist_sq };
            let unit = if dist_sq > 0.0 { 1.0 / dist_sq.sqrt() } else { 0.0 };
            (away.x[l], away.y[l], away.z[l]) = (dx * unit, dy * unit, dz * unit);
            falloff[l] = 1.0 / limited;
        }
        let mut sent = self.trees.profiles.lobes[vpl.lobe()].share16(&away);
        for l in 0..LANES {
            sent[l] *= falloff[l];
        }
        sent
    }

    fn lambert_lobed(&self, receivers: &ReceiverPacket, vpl: &Vpl, responses: &mut Vec3x16) {
        let sent = self.lobe_irradiance(receivers, vpl);
        let (y, x, n, brdf) = (vpl.position, &receivers.position, receivers.frame.normal(), &receivers.brdf);
        for l in 0..LANES {
            let (dx, dy, dz) = (y.x - x.x[l], y.y - x.y[l], y.z - x.z[l]);
            let dist_sq = dx * dx + dy * dy + dz * dz;
            let at_x = positive(dx * n.x[l] + dy * n.y[l] + dz * n.z[l]);
            let geometry = if dist_sq > 0.0 { at_x * sent[l] / dist_sq.sqrt() } else { 0.0 };
            responses.x[l] = brdf.x[l] * geometry;
            responses.y[l] = brdf.y[l] * geometry;
            responses.z[l] = brdf.z[l] * geometry;
        }
    }

    fn lambert_oriented(&self, receivers: &ReceiverPacket, vpl: &Vpl, responses: &mut Vec3x16) {
        let (y, normal) = (vpl.position, vpl.normal());
        let near_sq = self.near_sq(vpl, VplKind::Oriented);
        let (x, n, brdf) = (&receivers.position, receivers.frame.normal(), &receivers.brdf);
        for l in 0..LANES {
            let (dx, dy, dz) = (y.x - x.x[l], y.y - x.y[l], y.z - x.z[l]);
            let dist_sq = dx * dx + dy * dy + dz * dz;
            let at_x = positive(dx * n.x[l] + dy * n.y[l] + dz * n.z[l]);
            let at_y = positive(-(dx * normal.x + dy * normal.y + dz * normal.z));
            let limited = if dist_sq > near_sq { dist_sq } else { near_sq };
            // Each cosine is still multiplied by the distance.
            let unit = if dist_sq > 0.0 { 1.0 / dist_sq } else { 0.0 };
            let geometry = at_x * at_y * unit / limited;
            responses.x[l] = brdf.x[l] * geometry;
            responses.y[l] = brdf.y[l] * geometry;
            responses.z[l] = brdf.z[l] * geometry;
        }
    }
}

fn lambert_directional(receivers: &ReceiverPacket, towards: Vec3, responses: &mut Vec3x16) {
    let (n, brdf) = (receivers.frame.normal(), &receivers.brdf);
    for l in 0..LANES {
        let cos = positive(towards.x * n.x[l] + towards.y * n.y[l] + towards.z * n.z[l]);
        responses.x[l] = brdf.x[l] * cos;
        responses.y[l] = brdf.y[l] * cos;
        responses.z[l] = brdf.z[l] * cos;
    }
}

/// Returns the positive part, by one plain comparison.
#[inline(always)]
pub(super) fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}
