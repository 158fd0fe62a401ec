//! Caustics: light that mirrors and glass send onto surfaces, from photons that came by delta lobes alone.
//!
//! Photons and paths share this light. Photons find the light of small emitters, and of points and directions; paths
//! that of large emitters. The weights are those of the balance heuristic, for a Lambertian surface under an emitter
//! that sends photons evenly. They depend on L and d alone, so both sides know them:
//!
//! - photons: p = 1 / (1 + 1 / (ρ r² L)); paths: 1 - p;
//! - L: luminance of the emitter's radiance along the first edge ([`CausticPhoton::radiance`]);
//! - r = `radius_by_distance` · d: standard radius of discs at the distance d from the eye;
//! - ρ = π² N / (K Φ): number of photons through a disc of radius 1 under a hemisphere of radiance 1
//!   ([`CausticPhotons::density`]). N is the number of paths ([`photons::CausticTrace::even_paths`]), Φ the flux of all
//!   emitters ([`PhotonEmitter::power`]), and one path counts as K photons ([`PHOTONS_PER_PATH`]).
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996 (the caustics map); Hachisuka, Pantaleoni and Jensen,
//! *A Path Space Extension for Robust Light Transport Simulation*, 2012, and Georgiev et al., *Light Transport
//! Simulation with Vertex Connection and Merging*, 2012 (photons and paths combined); Silverman, *Density Estimation*,
//! 1986, section 5.3 (discs as large as photons are rare).
//!
//! Deviations: the width of discs does not shrink from pass to pass, and blurs finer detail.
//!
//! - [`aims`]: cells of emitters and directions where photon paths begin; [`photons`]: the paths;
//! - [`levels`]: photons by the radii of their discs.

mod aims;
mod levels;
mod photons;
#[cfg(test)]
mod tests;

use crate::emission::PhotonEmitter;
use base::kd_tree::KdTree;
use base::math::{Rgb, luminance};
use base::progress::Control;
use glam::Vec3;
use levels::DiscLevel;
use photons::{CausticPhoton, CausticTracer, PilotYield};
use rayon::prelude::*;
use std::f32::consts::PI;
use world::material::Bsdf;
use world::{Surface, World};

pub use photons::pilot_tasks;

/// Approximate number of photons in the disc of a photon.
const NEIGHBOURS: f32 = 40.0;

/// Number of photons that one path counts as, in MIS weights. Noise of paths differs from pixel to pixel, so denoisers
/// remove it; neighbouring pixels share photons.
const PHOTONS_PER_PATH: f32 = 1000.0;

/// Standard radius of discs, in widths of a pixel.
const RADIUS: f32 = 1.5;

/// Number of photons: a power of two times the standard number. Powers of two are coarse enough that most frames of a
/// walk share their photons.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct PhotonCount {
    log2: i32,
}

impl PhotonCount {
    /// Number for pilots.
    pub const PILOT: PhotonCount = PhotonCount { log2: -4 };
    /// Maximum number.
    pub const MAX: PhotonCount = PhotonCount { log2: 2 };

    /// Returns the number nearest to `factor` times the standard number, from [`PhotonCount::PILOT`] to
    /// [`PhotonCount::MAX`].
    pub fn nearest(factor: f64) -> PhotonCount {
        PhotonCount { log2: (factor.log2().round() as i32).clamp(Self::PILOT.log2, Self::MAX.log2) }
    }

    /// Number relative to the standard number.
    fn factor(self) -> f32 {
        2.0f32.powi(self.log2)
    }
}

/// Caustic photons of a scene.
pub struct CausticPhotons {
    photons: Vec<CausticPhoton>,
    /// ρ of the MIS weights.
    density: f32,
    /// Number of paths.
    pub paths: u64,
    /// Number of closest-hit queries.
    pub rays: u64,
}

/// Pilot paths, which find the emitters and directions that photons come from.
pub struct PilotPaths {
    /// `None` if the scene can have no caustic photons.
    found: Option<PilotYield>,
    seed: u32,
    max_edges: u32,
}

/// Caustic photons in the discs with which they light the surfaces of a view.
pub struct Caustics {
    levels: Vec<DiscLevel>,
    /// ρ of the MIS weights.
    density: f32,
    /// Standard radius of discs over the distance from the eye.
    radius_by_distance: f32,
    max_depth: u32,
}

impl PilotPaths {
    /// Traces the pilot paths of so many tasks, for paths of at most `max_depth` edges from the eye.
    pub fn new(world: &World, tasks: u32, seed: u32, max_depth: u32, control: &Control) -> PilotPaths {
        // Paths of photons have two edges at least, and the eye's path has another.
        let max_edges = max_depth.saturating_sub(1);
        let may_be = world.specular.has_delta_lobes() && world.specular.spread_light() && max_edges >= 2;
        let emitter = if may_be { PhotonEmitter::new(world) } else { None };
        let found =
            emitter.map(|emitter| CausticTracer::new(world, &emitter, seed, max_edges, control).pilot(tasks));
        PilotPaths { found, seed, max_edges }
    }

    /// Number of pilot paths.
    pub fn paths(&self) -> u64 {
        self.found.as_ref().map_or(0, |found| found.paths.into())
    }

    /// Number of closest-hit queries.
    pub fn rays(&self) -> u64 {
        self.found.as_ref().map_or(0, |found| found.rays)
    }

    /// Traces `count` photons; fewer if `control` is cancelled. The scene may have none.
    pub fn photons(&self, world: &World, count: PhotonCount, control: &Control) -> CausticPhotons {
        let mut all = CausticPhotons { photons: Vec::new(), density: 0.0, paths: 0, rays: 0 };
        let Some((found, emitter)) = self.found.as_ref().zip(PhotonEmitter::new(world)) else { return all };
        let tracer = CausticTracer::new(world, &emitter, self.seed, self.max_edges, control);
        let traced = tracer.photons(found, count.factor());
        (all.paths, all.rays) = (traced.paths, traced.rays);
        let (index, order) = KdTree::build(traced.photons.par_iter().map(|photon| photon.position));
        all.photons = order.iter().map(|i| traced.photons[*i as usize]).collect();
        for leaf in 0..index.leaves() {
            let leaf = &mut all.photons[index.leaf(leaf)];
            let radius = radius_around(leaf);
            leaf.iter_mut().for_each(|photon| photon.radius = radius);
        }
        all.density = traced.even_paths * PI * PI / (PHOTONS_PER_PATH * emitter.power());
        all
    }
}

impl CausticPhotons {
    /// Number of photons.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// Returns the photons in their discs for a view whose pixels are seen from `eye` under `pixel_angle`, for paths of
    /// at most `max_depth` edges; `None` if there are no photons.
    pub fn seen(&self, eye: Vec3, pixel_angle: f32, max_depth: u32) -> Option<Caustics> {
        let radius_by_distance = RADIUS * pixel_angle;
        let radius = |photon: &CausticPhoton| radius_by_distance * photon.position.distance(eye);
        (!self.photons.is_empty()).then(|| Caustics {
            levels: levels::levels(&self.photons, radius),
            density: self.density,
            radius_by_distance,
            max_depth,
        })
    }
}

/// Light of photons that a surface reflects.
#[derive(Clone, Copy, Debug, Default)]
pub struct CausticRadiance {
    /// Reflected radiance.
    pub radiance: Rgb,
    /// Sum over the photons of luminance of reflected radiance times luminance of the emitter's radiance: the second
    /// moment of paths that find this light. Bounded by `f32::MAX` for emitters that no path can meet.
    pub by_emitted: f32,
}

impl Caustics {
    /// MIS weight p of photons, for light of an emitter of the luminance `radiance` on surfaces at a `distance` from
    /// the eye.
    #[inline]
    fn share(&self, radiance: f32, distance: f32) -> f32 {
        let radius = self.radius_by_distance * distance;
        1.0 / (1.0 + 1.0 / (self.density * radius * radius * radiance))
    }

    /// MIS weight 1 - p of paths.
    #[inline]
    pub fn share_of_paths(&self, radiance: Rgb, distance: f32) -> f32 {
        1.0 - self.share(luminance(radiance), distance)
    }

    /// Returns the light of photons that a surface reflects along `out`, by MIS weight. The surface is vertex number
    /// `depth` of a path of length `distance` from the eye.
    pub fn reflected(
        &self,
        surface: &Surface,
        bsdf: &Bsdf,
        out: Vec3,
        distance: f32,
        depth: u32,
    ) -> CausticRadiance {
        let wo = surface.frame.to_local(out);
        let unit = self.radius_by_distance * distance;
        let mut sum = CausticRadiance::default();
        let lambert = bsdf.lambert_albedo().map(|_| bsdf.eval(wo, Vec3::new(0.0, 0.0, wo.z.signum())));
        for level in &self.levels {
            level.visit(surface.position, surface.normal, unit, |photon, kernel| {
                if photon.edges + depth > self.max_depth {
                    return;
                }
                let wi = surface.frame.to_local(photon.towards_light);
                let value = match lambert {
                    Some(_) if wi.z * wo.z <= 0.0 => return,
                    Some(value) => value,
                    None => bsdf.eval(wo, wi),
                };
                let radiance = value * photon.flux * (kernel * self.share(photon.radiance, distance));
                sum.radiance += radiance;
                sum.by_emitted += luminance(radiance) * photon.radiance.min(f32::MAX);
            });
        }
        sum
    }
}

/// Returns the radius of a disc that holds about [`NEIGHBOURS`] photons, if photons are as dense as in a leaf.
fn radius_around(leaf: &[CausticPhoton]) -> f32 {
    let (low, high) = leaf.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), photon| {
        (low.min(photon.position), high.max(photon.position))
    });
    let size = high - low;
    let area = (size.x * size.y).max(size.y * size.z).max(size.z * size.x);
    (NEIGHBOURS * area / (PI * leaf.len() as f32)).sqrt()
}
