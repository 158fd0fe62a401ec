//! VPLs of reflected light: one for every photon.
//!
//! Paper: Keller, *Instant Radiosity*, 1997; Herzog et al. 2009, section 3: the first hit's reflected light
//! is already indirect, and moderately glossy reflection counts as diffuse where light is deposited.

use super::photons::{PhotonCounts, PhotonSettings, trace_photons};
use super::{LightPassSettings, Origin, Vpl, VplKind, VplSet};
use crate::progress::Control;
use crate::world::World;
use std::f32::consts::FRAC_1_PI;

/// Returns about `settings.indirect` indirect VPLs (whole chunks of paths, so a few more), or fewer where few
/// paths hit a surface.
pub fn indirect_vpls(
    world: &World,
    settings: &LightPassSettings,
    max_depth: u32,
    control: &Control,
) -> (VplSet, PhotonCounts) {
    // One edge is the eye's, one joins VPL and receiver.
    let max_edges = max_depth.saturating_sub(2);
    let wanted = PhotonSettings { photons: settings.indirect, max_edges, seed: settings.seed };
    let (photons, counts) = trace_photons(world, &wanted, control, |photon| {
        let intensity = photon.flux * photon.albedo * FRAC_1_PI;
        (Vpl::oriented(photon.position, photon.normal), intensity)
    });
    let mut set = VplSet::new(VplKind::Oriented, Origin::Indirect);
    let share = 1.0 / counts.paths.max(1) as f32;
    for (vpl, intensity) in photons {
        set.push(vpl, intensity * share);
    }
    (set, counts)
}
