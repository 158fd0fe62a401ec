//! Light transfer from one VPL to a receiver.
//!
//! Paper: Walter et al. 2005, Eq. 1: M · G, the material and the geometric term.
//! Units: values per unit intensity, before visibility.

use super::Receiver;
use crate::lights::{Intensities, LightTrees, Lights, Vpl, VplKind, min_dist_sq, near_sq_of_size};
use base::math::{Lane, Rgb, V3};
use glam::Vec3;

/// Transfer from all VPLs of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Transfer<'a> {
    /// All VPLs and their clusters.
    pub trees: &'a LightTrees,
    /// Minimum squared distance that the geometry term divides by.
    pub min_dist_sq: f32,
    /// True if VPLs on area lights divide by no less than the area that they represent. A closer point sees more of the
    /// light than one VPL can represent, and short rays find the rest (see [`crate::bias_compensation`]).
    pub patches: bool,
    /// Intensities that bound geometry terms, whose rest short rays find; `None` if geometry terms are not limited.
    pub intensities: Option<&'a Intensities>,
}

impl<'a> Transfer<'a> {
    /// Creates the transfer from the VPLs of `trees` in a scene of this `diagonal`.
    pub fn new(trees: &'a LightTrees, diagonal: f32) -> Transfer<'a> {
        Transfer { trees, min_dist_sq: min_dist_sq(diagonal), patches: false, intensities: None }
    }

    /// Creates the transfer from the VPLs of a scene. If `compensated`, short rays find the light of near VPLs.
    pub fn of(lights: &Lights, compensated: bool) -> Transfer<'_> {
        let intensities = lights.intensities.as_ref().filter(|_| compensated);
        Transfer { patches: compensated, intensities, ..Transfer::new(&lights.trees, lights.diagonal) }
    }

    /// Returns the bound of the geometry term at which a VPL of the mean intensity around a point gives it the
    /// irradiance `limit`; infinite if geometry terms are not limited.
    pub fn bound(&self, x: Vec3, limit: f32) -> f32 {
        let intensity = self.intensities.map_or(0.0, |intensities| intensities.around(x));
        if intensity > 0.0 { limit / intensity } else { f32::INFINITY }
    }

    /// Minimum squared distance that the geometry term of a VPL divides by.
    #[inline]
    pub fn near_sq(&self, vpl: &Vpl, kind: VplKind) -> f32 {
        match kind {
            VplKind::Oriented if self.patches => near_sq_of_size(vpl.size(), self.min_dist_sq),
            _ => self.min_dist_sq,
        }
    }

    /// Returns the unit direction to a VPL, 0 if it has none, and the irradiance across it per unit intensity, at one
    /// position or at sixteen.
    #[inline(always)]
    pub(super) fn incident<L: Lane>(&self, position: V3<L>, vpl: &Vpl, kind: VplKind) -> (V3<L>, L) {
        let one = L::from(1.0);
        if kind == VplKind::Directional {
            return (V3::splat(vpl.position), one);
        }
        let offset = V3::splat(vpl.position) - position;
        let inverse = offset.length_sq().max(L::from(1e-37)).rsqrt();
        let wi = offset.times(inverse);
        let emitted = match kind {
            VplKind::Oriented => (-wi.along(vpl.normal())).positive(),
            VplKind::Lobed => self.trees.profiles.lobes[vpl.lobe()].shares(-wi),
            _ => match vpl.spot_profile() {
                None => one,
                Some(spot) => {
                    let spot = &self.trees.profiles.spots[spot];
                    L::from_fn(|lane| spot.falloff(-wi.lane(lane)))
                }
            },
        };
        (wi, emitted * inverse.sq().min(L::from(1.0 / self.near_sq(vpl, kind))))
    }

    /// Returns the geometry term of a VPL: the irradiance per unit intensity if it is visible.
    #[inline(always)]
    pub(super) fn geometry_term<L: Lane>(&self, x: V3<L>, normal: V3<L>, vpl: &Vpl, kind: VplKind) -> L {
        let (wi, irradiance) = self.incident(x, vpl, kind);
        wi.dot(normal).positive() * irradiance
    }

    /// Contribution of a visible VPL of unit intensity.
    #[inline]
    pub fn unshadowed(&self, receiver: &Receiver, vpl: &Vpl, kind: VplKind) -> Rgb {
        let (wi, irradiance) = self.incident(V3::splat(receiver.position()), vpl, kind);
        if irradiance > 0.0 { receiver.response(wi.into()) * irradiance } else { Rgb::ZERO }
    }
}
