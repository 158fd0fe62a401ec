//! Irradiance from the density of photons.
//!
//! Papers: Jensen 1996 (the k nearest photons, on the area of a disc); Christensen 1999 (at photons, in
//! advance); Silverman, *Density Estimation*, 1986 (Epanechnikov's kernel).
//!
//! The disc lies on the surface: distances along its normal are scaled up, and photons that arrived on
//! surfaces of another orientation, or from behind, are ignored. Only the part of the disc that is surface
//! counts, and only photons there (see [`super::disc`]).
//!
//! Estimates are made at sites that are sampled independently of the photons that they count. Estimates at photons
//! would have two biases of about 1/k. The photon itself would count, and estimates of regions with few photons would
//! be used over larger areas.
//!
//! Deviations: about 1e-4 of the light just behind a closed wall leaks through.
//! Units: W/m².

use super::disc::{self, MIN_COS, SurfaceDisc, surface_distance_sq};
use super::map::{PhotonMap, Site};
use crate::emission::Photon;
use base::math::{LANES, Rgb, Vec3x16, lanes_in, mask_of};
use base::progress::Control;
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::PI;
use std::ops::Range;
use world::World;

/// Maximum radius of a disc, as a fraction of the scene's diagonal. If photons are rarer, the estimate is too dark.
const MAX_RADIUS: f32 = 0.05;

/// Share of a disc from which on all of it is surface, but for rounding.
const WHOLE: f32 = 0.99;

/// Minimum share of a disc that is taken to be surface.
const MIN_SHARE: f32 = 0.15;

/// Irradiance at a point of a surface.
#[derive(Clone, Copy, Debug)]
pub struct IrradianceEstimate {
    /// Position.
    pub position: Vec3,
    /// Unit normal.
    pub normal: Vec3,
    /// Irradiance.
    pub irradiance: Rgb,
    /// Radius of the disc over which it is the mean.
    pub radius: f32,
    /// False if too little of the disc is surface: the irradiance is too dark.
    pub is_sure: bool,
}

/// Computes the estimates at the sites of the map, in their order, and the number of rays. Returns `None` if `control`
/// is cancelled.
pub fn estimates(
    world: &World,
    map: &PhotonMap,
    nearest: usize,
    control: &Control,
) -> Option<(Vec<IrradianceEstimate>, u64)> {
    let of_leaf = |near: &mut PhotonPackets, leaf| {
        (!control.is_cancelled()).then(|| leaf_estimates(world, map, nearest, leaf, near))
    };
    let by_leaf: Option<Vec<Vec<IrradianceEstimate>>> =
        (0..map.site_index.leaves()).into_par_iter().map_init(PhotonPackets::default, of_leaf).collect();
    let all = by_leaf?.concat();
    let rays = all.len() as u64 * disc::RAYS;
    Some((all, rays))
}

/// Computes the estimates at the sites of a leaf, which share the search for photons around them.
fn leaf_estimates(
    world: &World,
    map: &PhotonMap,
    nearest: usize,
    leaf: usize,
    near: &mut PhotonPackets,
) -> Vec<IrradianceEstimate> {
    let (photons, sites) = (&map.photons, &map.sites[map.site_index.leaf(leaf)]);
    let count = sites.len() as f32;
    let centre = sites.iter().map(|s| s.position).sum::<Vec3>() / count.max(1.0);
    let extent = sites.iter().map(|s| s.position.distance(centre)).fold(0.0, f32::max);
    let largest = MAX_RADIUS * world.diagonal;
    // The number of photons is in proportion to the number of sites.
    let around = count * photons.len() as f32 / map.sites.len().max(1) as f32;
    let guess = 1.5 * extent * (nearest as f32 / around.max(1.0)).sqrt();
    let mut radius = guess.clamp(1e-4 * largest, largest);
    let mut found: Vec<Option<IrradianceEstimate>> = vec![None; sites.len()];
    let mut distances = Vec::new();
    while found.iter().any(Option::is_none) {
        near.clear();
        map.index.leaves_near(centre, extent + radius, |leaf| {
            near.extend(photons, map.index.leaf(leaf));
        });
        for (found, site) in found.iter_mut().zip(sites).filter(|(found, _)| found.is_none()) {
            distances.clear();
            near.within(site, radius * radius, &mut distances);
            if distances.len() >= nearest || radius >= largest {
                *found = Some(estimate(world, photons, site, nearest, radius, &mut distances));
            }
        }
        radius = (2.0 * radius).min(largest);
    }
    found.into_iter().flatten().collect()
}

/// Photons that may be near sites, in packets of sixteen.
#[derive(Default)]
struct PhotonPackets {
    /// Indices of the photons; the last packet may be partly empty.
    photon: Vec<u32>,
    position: Vec<Vec3x16>,
    normal: Vec<Vec3x16>,
    towards_light: Vec<Vec3x16>,
}

impl PhotonPackets {
    fn clear(&mut self) {
        self.photon.clear();
        for packets in [&mut self.position, &mut self.normal, &mut self.towards_light] {
            packets.clear();
        }
    }

    fn extend(&mut self, photons: &[Photon], range: Range<usize>) {
        for i in range {
            let (packet, lane) = (self.photon.len() / LANES, self.photon.len() % LANES);
            if lane == 0 {
                for packets in [&mut self.position, &mut self.normal, &mut self.towards_light] {
                    packets.push(Vec3x16::default());
                }
            }
            self.photon.push(i as u32);
            self.position[packet].set(lane, photons[i].position);
            self.normal[packet].set(lane, photons[i].normal);
            self.towards_light[packet].set(lane, photons[i].towards_light);
        }
    }

    /// Appends the photons that count at a site and are within the radius, with their squared distances.
    fn within(&self, at: &Site, radius_sq: f32, distances: &mut Vec<(f32, u32)>) {
        let Site { position, normal } = *at;
        for (packet, photons) in self.photon.chunks(LANES).enumerate() {
            let (p, n, l) = (&self.position[packet], &self.normal[packet], &self.towards_light[packet]);
            let (mut distance, mut counts) = ([0.0; LANES], [0; LANES]);
            for i in 0..LANES {
                let d = surface_distance_sq(p.get(i) - position, normal);
                // The normals of lanes without a photon are zero.
                let same = (n.get(i).dot(normal) >= MIN_COS) & (l.get(i).dot(normal) > 0.0);
                (distance[i], counts[i]) = (d, u32::from(same & (d < radius_sq)));
            }
            distances.extend(lanes_in(mask_of(&counts)).map(|i| (distance[i], photons[i])));
        }
    }
}

fn estimate(
    world: &World,
    photons: &[Photon],
    at: &Site,
    nearest: usize,
    radius: f32,
    distances: &mut [(f32, u32)],
) -> IrradianceEstimate {
    let order = |a: &(f32, u32), b: &(f32, u32)| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1));
    // The distance of the k-th photon is the radius of the disc, which does not contain it.
    let (inside, radius_sq) = match nearest.checked_sub(1).filter(|&k| k < distances.len()) {
        Some(k) => {
            let (inside, last, _) = distances.select_nth_unstable_by(k, order);
            (inside, last.0)
        }
        None => (distances, radius * radius),
    };
    let radius = radius_sq.sqrt();
    let (mut irradiance, mut is_sure) = (Rgb::ZERO, true);
    if radius > 0.0 {
        inside.sort_unstable_by(order);
        let disc = SurfaceDisc::probe(world, at, radius);
        let kernel = |&(d, j): &(f32, u32)| photons[j as usize].flux * (1.0 - d / radius_sq);
        let sum: Rgb = match disc.share < WHOLE {
            true => inside.iter().filter(|(_, j)| disc.sees(world, &photons[*j as usize])).map(kernel).sum(),
            false => inside.iter().map(kernel).sum(),
        };
        is_sure = disc.share >= MIN_SHARE;
        irradiance = sum * (2.0 / (PI * radius_sq * disc.share.max(MIN_SHARE)));
    }
    IrradianceEstimate { position: at.position, normal: at.normal, irradiance, radius, is_sure }
}
