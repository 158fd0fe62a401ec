//! The light pass: all VPLs of a scene.

use super::direct::{DirectVpls, direct_vpls};
use super::indirect::{IndirectVpls, indirect_vpls};
use super::{LightPassSettings, Profiles, VplSet};
use crate::emission::PhotonCounts;
use base::progress::Control;
use world::{SurfacePoint, World};

/// VPLs of a scene.
#[derive(Clone, Debug)]
pub struct LightPass {
    /// VPLs by kind and origin; some sets may be empty.
    pub sets: Vec<VplSet>,
    /// Profiles that VPLs refer to.
    pub profiles: Profiles,
    /// Size code of the patches of direct VPLs on each mesh (see [`super::size_of_area`]).
    pub sizes: Vec<u32>,
    /// Counts of photon tracing.
    pub photons: PhotonCounts,
}

impl LightPass {
    /// Number of VPLs.
    pub fn len(&self) -> usize {
        self.sets.iter().map(VplSet::len).sum()
    }
}

/// Makes the VPLs of a scene for paths of at most `max_depth` edges and the indirect light of the points `seen` (if
/// empty, of all points). Returns only some VPLs if `control` is cancelled.
pub fn light_pass(
    world: &World,
    settings: &LightPassSettings,
    seen: &[SurfacePoint],
    max_depth: u32,
    control: &Control,
) -> LightPass {
    let DirectVpls { mut sets, spots, sizes } = direct_vpls(world, settings, control);
    let IndirectVpls { sets: indirect, lobes, photons } =
        indirect_vpls(world, settings, seen, max_depth, control);
    sets.extend(indirect);
    LightPass { sets, profiles: Profiles { spots, lobes }, sizes, photons }
}
