//! Light transfer from one VPL to a receiver.
//!
//! Paper: Walter et al. 2005, Eq. 1: M · G, the material and the geometric term.
//! Units: values per unit intensity, before visibility.

use super::Receiver;
use crate::lights::{LightTrees, Lights, Vpl, VplKind, min_dist_sq, near_sq_of_size};
use base::math::{Lane, Rgb, V3};

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
}

impl<'a> Transfer<'a> {
    /// Creates the transfer from the VPLs of `trees` in a scene of this `diagonal`.
    pub fn new(trees: &'a LightTrees, diagonal: f32) -> Transfer<'a> {
        Transfer { trees, min_dist_sq: min_dist_sq(diagonal), patches: false }
    }

    /// Creates the transfer from the VPLs of a scene. With `patches`, VPLs on area lights divide by no less than their
    /// area.
    pub fn of(lights: &Lights, patches: bool) -> Transfer<'_> {
        Transfer { patches, ..Transfer::new(&lights.trees, lights.diagonal) }
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

    /// Contribution of a visible VPL of unit intensity.
    #[inline]
    pub fn unshadowed(&self, receiver: &Receiver, vpl: &Vpl, kind: VplKind) -> Rgb {
        let (wi, irradiance) = self.incident(V3::splat(receiver.position()), vpl, kind);
        if irradiance > 0.0 { receiver.response(wi.into()) * irradiance } else { Rgb::ZERO }
    }
}
