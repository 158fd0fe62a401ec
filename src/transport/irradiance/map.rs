//! Photon map of a scene.
//!
//! Every hit that reflects diffusely stores a photon, the first hit included: reflected direct light is indirect light
//! at the next surface. Direct light itself is computed elsewhere.
//!
//! Units: flux in watts.

use crate::emission::{Photon, PhotonCounts, PhotonHit, PhotonSettings, trace_photons};
use base::kd_tree::KdTree;
use base::math::Rgb;
use base::progress::Control;
use base::sampling::hash;
use glam::Vec3;
use rayon::prelude::*;
use world::World;

/// Number of photons per site.
const PHOTONS_PER_SITE: u32 = 4;

/// Point where irradiance is estimated: the hit of a photon of another set. So sites are dense where photons are dense,
/// and independent of them.
#[derive(Clone, Copy, Debug)]
pub struct Site {
    /// Position.
    pub position: Vec3,
    /// Unit geometric normal.
    pub normal: Vec3,
}

/// Photons and sites, each in the order of an index over their positions.
pub struct PhotonMap {
    /// Photons, with flux divided by the number of paths.
    pub photons: Vec<Photon>,
    /// Index over the photons.
    pub index: KdTree,
    /// Sites at which irradiance is estimated.
    pub sites: Vec<Site>,
    /// Index over the sites.
    pub site_index: KdTree,
    /// Counts of photon tracing.
    pub counts: PhotonCounts,
}

impl PhotonMap {
    /// Traces the photons of a scene; there may be none if `control` is cancelled.
    pub fn new(world: &World, settings: &PhotonSettings, control: &Control) -> PhotonMap {
        let (mut photons, mut counts) = trace_photons(world, settings, control, |hit| hit.photon);
        let share = 1.0 / counts.paths.max(1) as f32;
        photons.retain_mut(|photon| {
            photon.flux = (photon.flux * share).max(Rgb::ZERO);
            photon.position.is_finite() && photon.flux.is_finite()
        });
        let (index, photons) = indexed(photons, |photon| photon.position, control);

        let other = PhotonSettings {
            photons: settings.photons.div_ceil(PHOTONS_PER_SITE),
            seed: hash(settings.seed, 0x517e),
            ..*settings
        };
        let site = |hit: &PhotonHit| Site { position: hit.photon.position, normal: hit.photon.normal };
        let (mut sites, more) = trace_photons(world, &other, control, site);
        sites.retain(|site| site.position.is_finite());
        let (site_index, sites) = indexed(sites, |site| site.position, control);
        counts.paths += more.paths;
        counts.rays += more.rays;
        PhotonMap { photons, index, sites, site_index, counts }
    }
}

/// Number of items that are reordered between two tests for cancellation.
const ITEMS_PER_TEST: usize = 1 << 18;

/// Builds an index over the positions of items; returns it with the items in its order. Both are empty if `control` is
/// cancelled.
fn indexed<T: Copy + Send + Sync>(
    items: Vec<T>,
    position: impl Fn(&T) -> Vec3 + Sync + Send,
    control: &Control,
) -> (KdTree, Vec<T>) {
    let (index, order) = KdTree::build_unless_cancelled(items.par_iter().map(position), control);
    let mut ordered = Vec::with_capacity(items.len());
    for part in order.chunks(ITEMS_PER_TEST) {
        if control.is_cancelled() {
            return (KdTree::empty(), Vec::new());
        }
        ordered.par_extend(part.par_iter().map(|i| items[*i as usize]));
    }
    (index, ordered)
}
