//! VPLs of reflected light: one for each photon, and one for each strong lobe.
//!
//! Paper: Keller, *Instant Radiosity*, 1997; Herzog et al. 2009, section 3: the first hit's reflected light
//! is already indirect, and moderately glossy reflection counts as diffuse where light is deposited.
//! Deviations: only weak lobes, as plastics have, count as diffuse. Metals have VPLs that radiate by their lobes. If
//! the number of edges is limited and light passes no sheets, the receiver counts as seen directly: behind mirrors and
//! glass, light may use as many further edges as the eye's path has.

use super::{LightPassSettings, LobeProfile, Origin, Vpl, VplKind, VplSet};
use crate::emission::{PhotonCounts, PhotonHit, PhotonSettings, trace_in_parts};
use base::math::Rgb;
use base::parallel::ShortRuns;
use base::progress::Control;
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::FRAC_1_PI;
use world::shadow;
use world::{SurfacePoint, World};

/// VPLs of reflected light.
pub struct IndirectVpls {
    /// Diffuse VPLs, then VPLs with lobes.
    pub sets: [VplSet; 2],
    /// Profiles of the lobes.
    pub lobes: Vec<LobeProfile>,
    /// Counts of photon tracing.
    pub photons: PhotonCounts,
}

/// VPLs of one photon. Intensities are those of a single path.
struct PhotonVpls {
    diffuse: (Vpl, Rgb),
    /// Number of edges of the photon's path, at most 255.
    edges: u8,
    /// Lobes and their intensities; `None` if there are none.
    lobes: Option<Box<[(LobeProfile, Rgb)]>>,
}

impl PhotonVpls {
    fn left_by(hit: &PhotonHit) -> PhotonVpls {
        let photon = &hit.photon;
        let mut albedo = photon.albedo;
        let lobes: Box<[(LobeProfile, Rgb)]> = hit
            .bsdf
            .reflected_lobes(hit.wi)
            .map(|lobe| {
                albedo -= lobe.albedo;
                let profile = LobeProfile {
                    normal: hit.shading_normal,
                    towards_light: photon.towards_light,
                    shape: lobe.shape,
                    peak: lobe.peak,
                };
                (profile, photon.flux * lobe.albedo * lobe.peak)
            })
            .collect();
        let intensity = photon.flux * albedo.max(Rgb::ZERO) * FRAC_1_PI;
        let diffuse = (Vpl::oriented(photon.position, photon.normal), intensity);
        let edges = u8::try_from(hit.edges).unwrap_or(u8::MAX);
        PhotonVpls { diffuse, edges, lobes: (!lobes.is_empty()).then_some(lobes) }
    }

    /// Position of the lobes' VPLs.
    fn place(&self) -> Vec3 {
        let (vpl, _) = &self.diffuse;
        shadow::ray_from(vpl.position, vpl.normal(), vpl.normal()).origin
    }
}

/// Makes about `settings.indirect` diffuse VPLs, and up to as many with lobes, for the indirect light of points `seen`.
/// Whole chunks of paths are traced, so there may be a few more. There are fewer if few paths hit a surface, or if
/// paths are aimed.
pub fn indirect_vpls(
    world: &World,
    settings: &LightPassSettings,
    seen: &[SurfacePoint],
    max_depth: u32,
    control: &Control,
) -> IndirectVpls {
    // One edge ends at the eye, another joins VPL and receiver.
    let max_edges = max_depth.saturating_sub(2);
    let wanted = PhotonSettings { photons: settings.indirect, seen, max_edges, seed: settings.seed };
    let (found, photons) = trace_in_parts(world, &wanted, control, PhotonVpls::left_by);
    let share = 1.0 / photons.paths.max(1) as f32;
    let part = |found: Vec<PhotonVpls>| (!control.is_cancelled()).then(|| PartialVpls::new(found, share));
    let parts: Vec<PartialVpls> = found.into_par_iter().one_by_one().map(part).while_some().collect();
    let mut diffuse = VplSet::new(VplKind::Oriented, Origin::Indirect);
    let mut lobed = VplSet::new(VplKind::Lobed, Origin::Indirect);
    let mut lobes = Vec::new();
    diffuse.reserve(parts.iter().map(|part| part.diffuse.len()).sum());
    for part in parts {
        diffuse.append(part.diffuse);
        for (edges, place, profile, intensity) in part.lobed {
            lobed.push_behind(edges, Vpl::lobed(place, lobes.len() as u32), intensity);
            lobes.push(profile);
        }
    }
    IndirectVpls { sets: [diffuse, lobed], lobes, photons }
}

/// VPLs of some photons. Intensities are shares of all paths.
struct PartialVpls {
    diffuse: VplSet,
    /// Numbers of edges, positions, lobes and intensities.
    lobed: Vec<(u8, Vec3, LobeProfile, Rgb)>,
}

impl PartialVpls {
    /// Converts the VPLs of photons, each of which carries a `share` of a path's light.
    fn new(found: Vec<PhotonVpls>, share: f32) -> PartialVpls {
        let mut diffuse = VplSet::new(VplKind::Oriented, Origin::Indirect);
        let mut lobed = Vec::new();
        diffuse.reserve(found.len());
        for left in found {
            if left.lobes.is_some() {
                let (edges, place) = (left.edges, left.place());
                let of_photon = left.lobes.into_iter().flatten();
                lobed
                    .extend(of_photon.map(|(profile, intensity)| (edges, place, profile, intensity * share)));
            }
            let (vpl, intensity) = left.diffuse;
            diffuse.push_behind(left.edges, vpl, intensity * share);
        }
        PartialVpls { diffuse, lobed }
    }
}
