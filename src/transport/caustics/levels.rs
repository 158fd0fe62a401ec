//! Photons by the radii of their discs. All discs of a level have one radius in pixels, so that a range query finds the
//! photons around a point.

use super::photons::CausticPhoton;
use base::kd_tree::{KdTree, WideKdTree};
use base::math::{LANES, Vec3x16, lanes_in, mask_of};
use base::sampling::hash;
use glam::Vec3;
use rayon::prelude::*;
use std::f32::consts::PI;

/// Number of levels. Discs are twice as wide from level to level.
const LEVELS: usize = 9;

/// Level of the discs of the standard radius ([`super::RADIUS`]).
const STANDARD_LEVEL: i32 = 4;

/// Number of photons in a disc of the smallest level above which photons are thinned, relative to ordinary discs.
const MAX_CROWD: f32 = 2.0;

/// Maximum distance of a photon from the plane of the surface, in radii of the disc.
const FLATNESS: f32 = 0.3;

/// Photons with discs of one width.
pub struct DiscLevel {
    photons: Vec<CausticPhoton>,
    /// Positions of the photons, in packets of sixteen; at infinity beyond the last photon.
    positions: Vec<Vec3x16>,
    index: KdTree,
    tree: WideKdTree,
    /// Radius of the discs, relative to the standard radius.
    scale: f32,
}

/// Divides photons into levels by their radii. `unit` returns the standard radius at a photon.
pub fn levels(photons: &[CausticPhoton], unit: impl Fn(&CausticPhoton) -> f32) -> Vec<DiscLevel> {
    let mut by_level: [Vec<CausticPhoton>; LEVELS] = Default::default();
    for (photon, number) in photons.iter().zip(0..) {
        let radius = photon.radius / unit(photon);
        let level = (0..LEVELS - 1).find(|level| radius <= scale(*level)).unwrap_or(LEVELS - 1);
        let crowd = (scale(level) / radius).powi(2);
        let probability = if level == 0 { (MAX_CROWD / crowd).min(1.0) } else { 1.0 };
        if probability < 1.0 && hash(number, 0x7417) as f32 >= probability * 4_294_967_296.0 {
            continue;
        }
        by_level[level].push(CausticPhoton { flux: photon.flux / probability, ..*photon });
    }
    let levels = by_level.into_iter().enumerate().filter(|(_, photons)| !photons.is_empty());
    levels.map(|(level, photons)| DiscLevel::new(&photons, scale(level))).collect()
}

/// Radius of the discs of a level, relative to the standard radius.
fn scale(level: usize) -> f32 {
    2.0f32.powi(level as i32 - STANDARD_LEVEL)
}

impl DiscLevel {
    fn new(photons: &[CausticPhoton], scale: f32) -> DiscLevel {
        let (index, order) = KdTree::build(photons.par_iter().map(|photon| photon.position));
        let photons: Vec<CausticPhoton> = order.iter().map(|i| photons[*i as usize]).collect();
        let positions: Vec<Vec3> = photons.iter().map(|photon| photon.position).collect();
        let tree = WideKdTree::new(&index, &positions);
        let packet = |positions: &[Vec3]| {
            let mut packet = Vec3x16::splat(Vec3::INFINITY);
            positions.iter().enumerate().for_each(|(lane, position)| packet.set(lane, *position));
            packet
        };
        let positions = positions.chunks(LANES).map(packet).collect();
        DiscLevel { photons, positions, index, tree, scale }
    }

    /// Calls `visit` with every photon whose disc contains a point of a surface, and with the value of its kernel
    /// there. `unit` is the standard radius at the point.
    #[inline]
    pub fn visit(&self, point: Vec3, normal: Vec3, unit: f32, mut visit: impl FnMut(&CausticPhoton, f32)) {
        let radius = self.scale * unit;
        let radius_sq = radius * radius;
        let peak = 2.0 / (PI * radius_sq);
        if !(peak < f32::INFINITY) {
            return;
        }
        self.tree.leaves(point, radius_sq, |leaf, _| {
            let leaf = self.index.leaf(leaf);
            for packet in leaf.start / LANES..leaf.end.div_ceil(LANES) {
                let (mut dist_sq, mut inside) = ([0.0; LANES], [0; LANES]);
                for lane in 0..LANES {
                    let offset = self.positions[packet].get(lane) - point;
                    dist_sq[lane] = offset.length_squared();
                    let is_near = dist_sq[lane] < radius_sq;
                    inside[lane] = u32::from(is_near & (offset.dot(normal).abs() < FLATNESS * radius));
                }
                for lane in lanes_in(mask_of(&inside)) {
                    let number = packet * LANES + lane;
                    if leaf.contains(&number) {
                        visit(&self.photons[number], peak * (1.0 - dist_sq[lane] / radius_sq));
                    }
                }
            }
            radius_sq
        });
    }
}
