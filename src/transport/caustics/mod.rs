//! Light that mirrors and glass throw onto surfaces, by photons that came by delta lobes alone.
//!
//! Papers: Jensen, *Global Illumination using Photon Maps*, 1996 (the caustics map); Hachisuka, Pantaleoni and Jensen,
//! *A Path Space Extension for Robust Light Transport Simulation*, 2012, and Georgiev et al., *Light Transport
//! Simulation with Vertex Connection and Merging*, 2012 (photons and paths combined); Silverman, *Density Estimation*,
//! 1986, section 5.3 (discs as large as photons are rare).
//!
//! Photons find light of small emitters, and of points and directions; paths that of large ones. Each has the share of
//! an emitter's light that the balance heuristic gives it for a Lambertian surface under an emitter that sends photons
//! evenly, with a path for many photons: a function of the emitter's radiance and the distance from the eye alone, so
//! that both sides know it.
//!
//! Deviations: the width of discs does not shrink from pass to pass, and blurs whatever is finer.
//!
//! - [`aims`]: where paths are worth beginning; [`photons`]: the paths;
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
use levels::Level;
use photons::{CausticPhoton, First};
use std::f32::consts::PI;
use world::material::Bsdf;
use world::{Surface, World};

/// Photons in the disc of a photon, about.
const NEIGHBOURS: f32 = 40.0;

/// Photons that the paths of a pixel are worth, by which these have more of the light: their noise differs from pixel
/// to pixel, which denoisers take off, while neighbours share photons. Measured with lamps of several sizes in and
/// beside glass.
const PATHS_WORTH: f32 = 1000.0;

/// Unit of the radii of discs, in edges of a pixel: that by which photons and paths share the light.
const RADIUS: f32 = 1.5;

/// The photons of a scene.
pub struct CausticPhotons {
    photons: Vec<CausticPhoton>,
    /// Photons that an emitter of radiance 1 in a whole hemisphere sends through a disc of radius 1, over those that
    /// paths are worth.
    density: f32,
    /// Number of paths.
    pub paths: u64,
    /// Closest-hit queries.
    pub rays: u64,
}

/// The first paths, which tell where photons come from.
pub struct FirstPaths {
    /// `None` if there can be no photons.
    first: Option<First>,
    seed: u32,
    max_edges: u32,
}

/// The photons, as they light the surfaces of a view.
pub struct Caustics {
    levels: Vec<Level>,
    /// That of [`CausticPhotons`].
    density: f32,
    /// Unit of the radii of discs over the distance from the eye.
    radius_by_distance: f32,
    max_depth: u32,
}

impl FirstPaths {
    /// Traces them for paths of at most `max_depth` edges from the eye.
    pub fn new(world: &World, seed: u32, max_depth: u32, control: &Control) -> FirstPaths {
        // Those of the lights come by three edges at least, the one to the eye included.
        let max_edges = max_depth.saturating_sub(1);
        let may_be = world.specular.has_delta_lobes() && max_edges >= 2;
        let emitter = if may_be { PhotonEmitter::new(world) } else { None };
        let first = emitter.map(|emitter| photons::first(world, &emitter, seed, max_edges, control));
        FirstPaths { first, seed, max_edges }
    }

    /// Number of the paths.
    pub fn paths(&self) -> u64 {
        self.first.as_ref().map_or(0, |_| photons::FIRST_PATHS.into())
    }

    /// Closest-hit queries.
    pub fn rays(&self) -> u64 {
        self.first.as_ref().map_or(0, |first| first.rays)
    }

    /// Traces photons, `many` times as many as usual; there may be none. Fewer if `control` is cancelled.
    pub fn photons(&self, world: &World, many: f32, control: &Control) -> CausticPhotons {
        let mut found = CausticPhotons { photons: Vec::new(), density: 0.0, paths: 0, rays: 0 };
        let Some((first, emitter)) = self.first.as_ref().zip(PhotonEmitter::new(world)) else { return found };
        let traced = photons::trace(world, (&emitter, first), (self.seed, many), self.max_edges, control);
        (found.paths, found.rays) = (traced.paths, traced.rays);
        let (index, order) = KdTree::build(traced.photons.iter().map(|photon| photon.position));
        found.photons = order.iter().map(|i| traced.photons[*i as usize]).collect();
        for leaf in 0..index.leaves() {
            let leaf = &mut found.photons[index.leaf(leaf)];
            let radius = radius_around(leaf);
            leaf.iter_mut().for_each(|photon| photon.radius = radius);
        }
        found.density = traced.even_paths * PI * PI / (PATHS_WORTH * emitter.power());
        found
    }
}

impl CausticPhotons {
    /// Number of photons.
    pub fn len(&self) -> usize {
        self.photons.len()
    }

    /// Their light in a view whose pixels are seen from `eye` under `pixel_angle`, of paths of at most `max_depth`
    /// edges; `None` if there are none.
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
pub struct Reflected {
    /// Radiance.
    pub radiance: Rgb,
    /// Luminance times that of the radiance emitted, which is what a path finds, rarely, in place of photons: their
    /// product is the mean square of paths. As large as can be of emitters that no path can meet.
    pub by_emitted: f32,
}

impl Caustics {
    /// Share of an emitter's light, of a radiance of that luminance, that photons find on surfaces at a distance from
    /// the eye.
    #[inline]
    fn share(&self, radiance: f32, distance: f32) -> f32 {
        let radius = self.radius_by_distance * distance;
        1.0 / (1.0 + 1.0 / (self.density * radius * radius * radiance))
    }

    /// Share that paths find.
    #[inline]
    pub fn share_of_paths(&self, radiance: Rgb, distance: f32) -> f32 {
        1.0 - self.share(luminance(radiance), distance)
    }

    /// Light that a surface, seen at vertex `depth` by a chain of length `distance`, reflects along `out` of that which
    /// photons find.
    pub fn reflected(
        &self,
        surface: &Surface,
        bsdf: &Bsdf,
        out: Vec3,
        (distance, depth): (f32, u32),
    ) -> Reflected {
        let wo = surface.frame.to_local(out);
        let unit = self.radius_by_distance * distance;
        let mut sum = Reflected::default();
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

/// Radius of a disc that holds some photons, where they are as dense as those of a leaf.
fn radius_around(leaf: &[CausticPhoton]) -> f32 {
    let (low, high) = leaf.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), photon| {
        (low.min(photon.position), high.max(photon.position))
    });
    let size = high - low;
    let area = (size.x * size.y).max(size.y * size.z).max(size.z * size.x);
    (NEIGHBOURS * area / (PI * leaf.len() as f32)).sqrt()
}
