//! Light transfer from one VPL to a receiver.
//!
//! Paper: Walter et al. 2005, Eq. 1: M · G, the material and the geometric term.
//! Units: values per unit intensity, before visibility.

use super::Receiver;
use crate::lights::{LightTrees, Lights, Vpl, VplKind, min_dist_sq, near_sq_of_size};
use base::math::Rgb;

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

    /// Contribution of a visible VPL of unit intensity.
    #[inline]
    pub fn unshadowed(&self, receiver: &Receiver, vpl: &Vpl, kind: VplKind) -> Rgb {
        if kind == VplKind::Directional {
            return receiver.response(vpl.position);
        }
        let offset = vpl.position - receiver.position();
        let dist_sq = offset.length_squared();
        if dist_sq == 0.0 {
            return Rgb::ZERO; // A VPL on the receiver itself has no direction.
        }
        let wi = offset / dist_sq.sqrt();
        let emitted = match kind {
            VplKind::Oriented => -vpl.normal().dot(wi),
            VplKind::Lobed => self.trees.profiles.lobes[vpl.lobe()].share(-wi),
            _ => match vpl.spot_profile() {
                None => 1.0,
                Some(profile) => self.trees.profiles.spots[profile].falloff(-wi),
            },
        };
        if emitted <= 0.0 {
            return Rgb::ZERO;
        }
        receiver.response(wi) * (emitted / dist_sq.max(self.near_sq(vpl, kind)))
    }
}
