//! Photons by the radii of their discs: all those of a level have the same, in pixels, so that those around a point are
//! found without a search for the nearest.

use super::photons::CausticPhoton;
use base::kd_tree::{KdTree, WideKdTree};
use base::math::{LANES, Vec3x16, lanes_in, mask_of};
use base::sampling::hash;
use glam::Vec3;
use std::f32::consts::PI;

/// Number of levels; the discs of each are twice as wide as those of the one before.
const LEVELS: usize = 9;

/// Level of the discs of radius 1, in units of [`super::RADIUS`].
const MIDDLE: i32 = 4;

/// Photons in a disc of the least level, over those in ordinary ones, above which they are thinned.
const MANY: f32 = 2.0;

/// Greatest distance of a photon from the plane of the surface, in radii.
const FLATNESS: f32 = 0.3;

/// Photons with discs of one width.
pub struct Level {
    photons: Vec<CausticPhoton>,
    /// Their positions, sixteen at a time; at infinity beyond the last.
    positions: Vec<Vec3x16>,
    index: KdTree,
    tree: WideKdTree,
    /// Their radius in units.
    scale: f32,
}

/// Divides photons by the radii that they want, in units that `unit` gives.
pub fn levels(photons: &[CausticPhoton], unit: impl Fn(&CausticPhoton) -> f32) -> Vec<Level> {
    let mut by_level: [Vec<CausticPhoton>; LEVELS] = Default::default();
    for (photon, number) in photons.iter().zip(0..) {
        let radius = photon.radius / unit(photon);
        let level = (0..LEVELS - 1).find(|level| radius <= scale(*level)).unwrap_or(LEVELS - 1);
        let crowd = (scale(level) / radius).powi(2);
        let kept = if level == 0 { (MANY / crowd).min(1.0) } else { 1.0 };
        if kept < 1.0 && hash(number, 0x7417) as f32 >= kept * 4_294_967_296.0 {
            continue;
        }
        by_level[level].push(CausticPhoton { flux: photon.flux / kept, ..*photon });
    }
    let levels = by_level.into_iter().enumerate().filter(|(_, photons)| !photons.is_empty());
    levels.map(|(level, photons)| Level::new(&photons, scale(level))).collect()
}

/// Radius of the discs of a level in units.
fn scale(level: usize) -> f32 {
    2.0f32.powi(level as i32 - MIDDLE)
}

impl Level {
    fn new(photons: &[CausticPhoton], scale: f32) -> Level {
        let (index, order) = KdTree::build(photons.iter().map(|photon| photon.position));
        let photons: Vec<CausticPhoton> = order.iter().map(|i| photons[*i as usize]).collect();
        let positions: Vec<Vec3> = photons.iter().map(|photon| photon.position).collect();
        let tree = WideKdTree::new(&index, &positions);
        let packet = |positions: &[Vec3]| {
            let mut packet = Vec3x16::splat(Vec3::INFINITY);
            positions.iter().enumerate().for_each(|(lane, position)| packet.set(lane, *position));
            packet
        };
        let positions = positions.chunks(LANES).map(packet).collect();
        Level { photons, positions, index, tree, scale }
    }

    /// Calls `visit` with the photons in whose discs a point of a surface is, and the value of their kernels there.
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
