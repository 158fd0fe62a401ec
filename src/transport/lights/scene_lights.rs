//! The light pass, and the virtual lights of a scene as shading uses them: trees, intensities, and distances below
//! which a VPL cannot represent its patch.

use super::direct::{DirectVpls, direct_vpls};
use super::indirect::{IndirectVpls, indirect_vpls};
use super::{
    Intensities, IntensitySamples, LightPassSettings, LightTrees, Profiles, VplSet, min_dist_sq,
    near_sq_of_size,
};
use crate::emission::PhotonCounts;
use base::progress::Control;
use base::stats::{Stage, Stats, give_back};
use world::{SurfacePoint, World};

/// Minimum number of VPLs before whose trees free memory is returned to the system.
///
/// Trees are the largest arrays of most images, and find no room among the parts of what was freed before.
const MANY: usize = 1 << 17;

/// Parameters of the virtual lights of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct LightsWanted {
    /// Numbers of VPLs and the seed.
    pub pass: LightPassSettings,
    /// Maximum number of edges of a path.
    pub max_depth: u32,
    /// Points whose indirect light is wanted; if empty, all points of the scene.
    pub seen: Vec<SurfacePoint>,
}

/// Virtual lights of a scene.
pub struct Lights {
    /// Trees over all VPLs.
    pub trees: LightTrees,
    /// Squared distance from each mesh below which a VPL on it cannot represent the patch around it; 0 for meshes that
    /// do not emit.
    pub near_sq: Vec<f32>,
    /// Intensities of indirect VPLs by region; `None` if there are no indirect VPLs.
    pub intensities: Option<Intensities>,
    /// Diagonal of the scene.
    pub diagonal: f32,
    /// Seed of the VPLs.
    pub seed: u32,
    /// Number of VPLs.
    pub vpls: u64,
    /// Closest-hit rays of the photon paths.
    pub rays: u64,
}

impl Lights {
    /// Makes the virtual lights of a scene, with fewer VPLs or no trees if `control` is cancelled. Counts and times the
    /// work in `stats`.
    pub fn new(world: &World, wanted: &LightsWanted, control: &Control, stats: &mut Stats) -> Lights {
        control.begin(Stage::LightPass, u64::from(wanted.pass.indirect));
        let pass = || light_pass(world, &wanted.pass, &wanted.seen, wanted.max_depth, control);
        let made = stats.time(Stage::LightPass, pass);
        let (vpls, rays) = (made.len() as u64, made.photons.rays);
        stats.count("VPLs/total", vpls);
        stats.count("VPLs/photon paths", made.photons.paths);
        if made.photons.gain > 0.0 {
            stats.add("VPLs/gain of aims", made.photons.gain.into());
        }
        stats.count("Rays/closest hit", rays);

        if made.len() > MANY {
            give_back();
        }
        control.begin(Stage::Tree, 0);
        let diagonal = world.diagonal;
        let build = || {
            let samples = IntensitySamples::new(&made.sets, &made.profiles);
            rayon::join(
                || LightTrees::build(&made.sets, made.profiles, diagonal, control),
                || Intensities::new(&samples),
            )
        };
        let (trees, intensities) = stats.time(Stage::Tree, build);
        let min_dist_sq = min_dist_sq(diagonal);
        let near_sq = |&size: &u32| if size > 0 { near_sq_of_size(size, min_dist_sq) } else { 0.0 };
        let near_sq = made.sizes.iter().map(near_sq).collect();
        Lights { trees, near_sq, intensities, diagonal, seed: wanted.pass.seed, vpls, rays }
    }
}

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
