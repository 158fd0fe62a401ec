//! Virtual lights in the frame of their receiver.
//!
//! Units: per unit intensity (see [`crate::lights`]), so the factor is 1/m² and its gradient 1/m³.

use super::incidence::Incidence;
use crate::lights::{Profiles, Vpl, VplKind};
use base::math::Frame;
use glam::Vec3;

/// A virtual light in the receiver's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LocalVpl {
    /// A light whose intensity is proportional to the cosine to its normal.
    Oriented {
        /// Offset from the receiver.
        offset: [f32; 3],
        /// Unit normal.
        normal: [f32; 3],
    },
    /// A light of equal intensity in all directions.
    Omni {
        /// Offset from the receiver.
        offset: [f32; 3],
    },
    /// A light at infinite distance.
    Directional {
        /// Unit direction to the light.
        towards: [f32; 3],
    },
}

/// Direction, inverse distance and emitter's cosine of a light at a finite distance.
struct Connection {
    omega: [f32; 3],
    inverse: f32,
    /// Cosine at the emitter; 1 for omni lights.
    cos: f32,
    /// Tangential part of the derivative of `cos` by the offset, at unit distance: that of the normal; 0 for omni
    /// lights.
    normal: [f32; 2],
    /// True if the distance is below the minimum.
    too_near: bool,
}

impl LocalVpl {
    /// Returns the arriving light with its first derivatives; `None` at the light itself and behind it.
    ///
    /// Smaller distances are clamped to `min_dist_sq`, and then the light is constant.
    #[inline]
    pub fn incidence(&self, min_dist_sq: f32) -> Option<Incidence> {
        let LocalVpl::Directional { towards } = *self else {
            let Connection { omega, inverse, cos, normal, too_near } = self.sight(min_dist_sq)?;
            if too_near {
                let factor = cos / min_dist_sq;
                return Some(Incidence { direction: omega, inv_dist: 0.0, factor, gradient: [0.0; 2] });
            }
            // The falloff is r⁻². The cosine of oriented lights adds one power.
            let power = if self.is_oriented() { 3.0 } else { 2.0 };
            let square = inverse * inverse;
            let slope = |axis: usize| square * inverse * (normal[axis] + power * cos * omega[axis]);
            return Some(Incidence {
                direction: omega,
                inv_dist: inverse,
                factor: cos * square,
                gradient: [slope(0), slope(1)],
            });
        };
        Some(Incidence { direction: towards, inv_dist: 0.0, factor: 1.0, gradient: [0.0; 2] })
    }

    /// Returns the second derivatives uu, uv and vv of the irradiance.
    #[inline]
    pub fn irradiance_hessian(&self, min_dist_sq: f32) -> [f32; 3] {
        let Some(Connection { omega: [x, y, z], inverse, cos, normal: [n_u, n_v], too_near }) =
            self.sight(min_dist_sq)
        else {
            return [0.0; 3];
        };
        if too_near || !(z > 0.0) {
            return [0.0; 3];
        }
        // At constant height, the irradiance falls off with 3 powers of the distance. The cosine adds one.
        let (same, crossed) = if self.is_oriented() { (4.0, 24.0) } else { (3.0, 15.0) };
        let crossed = crossed * cos;
        let square = inverse * inverse;
        let scale = square * square * z;
        [
            scale * (4.0 * (n_u * x + n_u * x) + crossed * x * x - same * cos),
            scale * (4.0 * (n_u * y + n_v * x) + crossed * x * y),
            scale * (4.0 * (n_v * y + n_v * y) + crossed * y * y - same * cos),
        ]
    }

    fn is_oriented(&self) -> bool {
        matches!(self, LocalVpl::Oriented { .. })
    }

    #[inline]
    fn sight(&self, min_dist_sq: f32) -> Option<Connection> {
        let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (offset, normal) = match *self {
            LocalVpl::Oriented { offset, normal } => (offset, normal),
            LocalVpl::Omni { offset } => (offset, [0.0; 3]),
            LocalVpl::Directional { .. } => return None,
        };
        let dist_sq = dot(offset, offset);
        if !(dist_sq > 0.0) {
            return None;
        }
        let inverse = 1.0 / dist_sq.sqrt();
        let omega = [offset[0] * inverse, offset[1] * inverse, offset[2] * inverse];
        let cos = if self.is_oriented() { -dot(normal, omega) } else { 1.0 };
        let too_near = dist_sq < min_dist_sq;
        (cos > 0.0).then_some(Connection { omega, inverse, cos, normal: [normal[0], normal[1]], too_near })
    }

    /// Transforms a virtual light to the frame `frame` at `position`, without its profile, which [`Incidence::of_vpl`]
    /// applies.
    #[inline]
    pub fn of_vpl(frame: &Frame, position: Vec3, vpl: &Vpl, kind: VplKind) -> LocalVpl {
        let local = |v: Vec3| frame.to_local(v).to_array();
        match kind {
            VplKind::Oriented => {
                LocalVpl::Oriented { offset: local(vpl.position - position), normal: local(vpl.normal()) }
            }
            VplKind::Omni | VplKind::Lobed => LocalVpl::Omni { offset: local(vpl.position - position) },
            VplKind::Directional => LocalVpl::Directional { towards: local(vpl.position) },
        }
    }
}

impl Incidence {
    /// Computes the light that arrives from a virtual light at `position` in `frame`, with its profile from `profiles`.
    #[inline]
    pub fn of_vpl(
        frame: &Frame,
        position: Vec3,
        vpl: &Vpl,
        kind: VplKind,
        profiles: &Profiles,
        min_dist_sq: f32,
    ) -> Option<Incidence> {
        let incidence = LocalVpl::of_vpl(frame, position, vpl, kind).incidence(min_dist_sq)?;
        match vpl.spot_profile() {
            Some(profile) if kind == VplKind::Omni => incidence.through_spot(frame, &profiles.spots[profile]),
            _ if kind == VplKind::Lobed => incidence.through_lobe(frame, &profiles.lobes[vpl.lobe()]),
            _ => Some(incidence),
        }
    }
}
