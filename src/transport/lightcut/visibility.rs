//! Visibility of virtual lights. Only this file distinguishes kinds of VPLs for shadow rays.

use crate::lights::{Vpl, VplKind};
use base::math::{Lane, V3, Vec3x16};
use embree::Rays16;
use world::World;
use world::shadow::{Engine, Segment};

/// Visibility along rays from points to VPLs.
pub trait Visibility {
    /// Returns the lanes of `lanes` whose rays are not occluded. `light` identifies the VPL if all rays go to one.
    fn visible16(&self, rays: &Rays16, lanes: u16, light: Option<u32>) -> u16;

    /// World whose thin sheets attenuate light along the rays; `None` if there are no sheets.
    fn sheets(&self) -> Option<&World> {
        None
    }

    /// Multiplies the `light` along the rays in `lanes`, which are not occluded, by the transmittance of the thin
    /// sheets on its way. It is 0 if there are more than `most` sheets, or if `most` is `None` (see
    /// [`super::Receiver::sheets`]).
    fn attenuate(&self, rays: &Rays16, lanes: u16, most: impl Fn(usize) -> Option<u32>, light: &mut Vec3x16) {
        if let Some(world) = self.sheets() {
            world.attenuate(rays, lanes, most, light);
        }
    }
}

/// Returns the rays to a VPL from points `x` with geometric normals `normal`, which are zero for points that lie on no
/// surface. Rays start at the points, since a packet that fans out from the light would lose hits.
#[inline]
pub fn to_vpl<L: Lane>(x: V3<L>, normal: V3<L>, vpl: &Vpl, kind: VplKind) -> Segment<L> {
    let light = V3::splat(vpl.position);
    match kind {
        VplKind::Oriented => Segment::between(x, normal, light, V3::splat(vpl.normal())),
        VplKind::Omni | VplKind::Lobed => Segment::between(x, normal, light, V3::zero()),
        VplKind::Directional => Segment::from(x, normal, light),
    }
}

impl Visibility for Engine<'_> {
    #[inline]
    fn visible16(&self, rays: &Rays16, lanes: u16, light: Option<u32>) -> u16 {
        let occluded = match light {
            // Embree traces a ray alone faster, and the occluder cache knows single rays only.
            Some(light) if lanes.is_power_of_two() => {
                let lane = lanes.trailing_zeros();
                u16::from(self.occluded(&rays.get(lane as usize), light)) << lane
            }
            _ => self.occluded16(rays, lanes),
        };
        lanes & !occluded
    }

    #[inline]
    fn sheets(&self) -> Option<&World> {
        self.world().has_sheets().then(|| self.world())
    }
}
