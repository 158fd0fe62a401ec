//! Visibility of virtual lights.

use base::math::{Rgb, Vec3x16, lanes_in};
use embree::Rays16;
use world::World;
use world::shadow::Engine;

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
    fn attenuate16(
        &self,
        rays: &Rays16,
        lanes: u16,
        most: impl Fn(usize) -> Option<u32>,
        light: &mut Vec3x16,
    ) {
        let Some(world) = self.sheets() else { return };
        for lane in lanes_in(lanes) {
            let passed = most(lane).map_or(Rgb::ZERO, |most| world.transmittance_of(&rays.get(lane), most));
            light.set(lane, light.get(lane) * passed);
        }
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
