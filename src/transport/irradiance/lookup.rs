//! Look-up of irradiance at any point: the nearest estimate on a surface of similar orientation.
//!
//! Paper: Christensen 1999: one look-up at each hit of a final gathering, instead of an estimate.

use super::PhotonMap;
use super::density::{IrradianceEstimate, MIN_COS, estimates, surface_distance_sq};
use base::kd_tree::{KdTree, WideKdTree};
use base::math::{F32x16, LANES, Rgb, U32x16, Vec3x16, lanes_in, mask_of};
use base::progress::Control;
use glam::Vec3;
use world::World;

/// Maximum number of packets of estimates in a leaf, which follows from the leaf size of the index.
const PACKETS: usize = 2;

/// Positions and unit normals of a leaf's estimates as structures of arrays. Normals are zero in empty lanes.
#[derive(Clone, Debug, Default)]
struct Leaf {
    position: [Vec3x16; PACKETS],
    normal: [Vec3x16; PACKETS],
    /// Index of the leaf's first estimate.
    first: u32,
}

/// Estimates in the order of an index over them.
pub struct IrradianceMap {
    leaves: Vec<Leaf>,
    index: WideKdTree,
    /// Irradiance of each estimate, with the radius of the disc over which it is the mean.
    irradiance: Vec<(Rgb, f32)>,
    /// Square of the maximum distance at which any estimate is used.
    reach_sq: f32,
}

impl IrradianceMap {
    /// Builds the map by the `nearest` photons of each site. Also returns the number of rays. The map is empty if
    /// `control` is cancelled.
    pub fn of_photons(
        world: &World,
        photons: &PhotonMap,
        nearest: usize,
        control: &Control,
    ) -> (IrradianceMap, u64) {
        match estimates(world, photons, nearest, control) {
            Some((estimates, rays)) => (IrradianceMap::new(&estimates, &photons.site_index), rays),
            None => (IrradianceMap::new(&[], &KdTree::empty()), 0),
        }
    }

    /// Builds the map from estimates in the order of the index.
    pub fn new(estimates: &[IrradianceEstimate], index: &KdTree) -> IrradianceMap {
        let leaves = (0..index.leaves())
            .map(|leaf| Leaf::new(estimates, index.leaf(leaf).start, index.leaf(leaf).len()));
        let positions: Vec<Vec3> = estimates.iter().map(|e| e.position).collect();
        let furthest = REACH * estimates.iter().map(|e| e.radius).fold(0.0, f32::max);
        IrradianceMap {
            leaves: leaves.collect(),
            index: WideKdTree::new(index, &positions),
            irradiance: estimates.iter().map(|e| (e.irradiance, e.radius)).collect(),
            // The square is rounded up, so that an estimate at exactly this distance counts.
            reach_sq: (furthest * furthest).next_up(),
        }
    }

    /// Number of estimates.
    pub fn len(&self) -> usize {
        self.irradiance.len()
    }

    /// Looks up the irradiance at a point of a surface with unit normal `normal`, and the radius of the disc
    /// over which it is the mean; `None` if there is no photon near, hence no light.
    #[inline]
    pub fn at(&self, point: Vec3, normal: Vec3) -> Option<(Rgb, f32)> {
        let mut best = None;
        self.index.leaves(point, self.reach_sq, |leaf, mut nearest| {
            let leaf = &self.leaves[leaf];
            for packet in 0..PACKETS {
                let distances = distances_sq(&leaf.position[packet], &leaf.normal[packet], point, normal);
                let mut nearer: U32x16 = [0; LANES];
                for i in 0..LANES {
                    nearer[i] = u32::from(distances[i] < nearest);
                }
                for i in lanes_in(mask_of(&nearer)) {
                    if distances[i] < nearest {
                        nearest = distances[i];
                        best = Some((leaf.first as usize + packet * LANES + i, nearest));
                    }
                }
            }
            nearest
        });
        let (i, distance_sq) = best?;
        let (irradiance, radius) = self.irradiance[i];
        let reach = REACH * radius;
        (distance_sq <= reach * reach).then_some((irradiance, radius))
    }
}

impl Leaf {
    fn new(estimates: &[IrradianceEstimate], first: usize, count: usize) -> Leaf {
        let mut leaf = Leaf { first: first as u32, ..Leaf::default() };
        for (i, e) in estimates[first..].iter().take(count.min(PACKETS * LANES)).enumerate() {
            leaf.position[i / LANES].set(i % LANES, e.position);
            leaf.normal[i / LANES].set(i % LANES, e.normal);
        }
        leaf
    }
}

/// Returns the squared distances to sixteen estimates; infinite for estimates on surfaces of another orientation.
#[inline(always)]
fn distances_sq(positions: &Vec3x16, normals: &Vec3x16, point: Vec3, normal: Vec3) -> F32x16 {
    let mut distances = [f32::INFINITY; LANES];
    for i in 0..LANES {
        let d = surface_distance_sq(positions.get(i) - point, normal);
        distances[i] = if normals.get(i).dot(normal) >= MIN_COS { d } else { f32::INFINITY };
    }
    distances
}

/// Maximum distance at which an estimate is used, in radii of its disc. If there were as much light farther
/// away, there would be a nearer site, except with probability e^(-k/4) for k photons in a disc.
const REACH: f32 = 1.0;

#[cfg(test)]
mod tests {
    use super::*;
    use base::sampling::owen_sobol_2d;
    use rayon::prelude::*;

    #[test]
    fn the_nearest_estimate_on_the_right_side_is_found() {
        // Two sides of a sheet, and a wall.
        let estimate = |i: u32| {
            let u = owen_sobol_2d(i, 5);
            let (position, normal) = match i % 3 {
                0 => (Vec3::new(u.x, u.y, 0.0), Vec3::Z),
                1 => (Vec3::new(u.x, u.y, 0.0), Vec3::NEG_Z),
                _ => (Vec3::new(0.0, u.x, u.y), Vec3::X),
            };
            IrradianceEstimate { position, normal, irradiance: Rgb::splat(i as f32), radius: 0.1 }
        };
        let estimates: Vec<IrradianceEstimate> = (0..3000).map(estimate).collect();
        let (index, order) = KdTree::build(estimates.par_iter().map(|e| e.position));
        let estimates: Vec<IrradianceEstimate> = order.iter().map(|&i| estimates[i as usize]).collect();
        let map = IrradianceMap::new(&estimates, &index);
        for (point, normal, near) in [
            (Vec3::new(0.01, 0.5, 0.0), Vec3::Z, true),
            (Vec3::new(0.01, 0.5, 0.0), Vec3::NEG_Z, true),
            (Vec3::new(0.0, 0.4, 0.01), Vec3::X, true),
            (Vec3::new(0.5, 0.4, 0.01), Vec3::new(0.6, 0.0, 0.8), true),
            (Vec3::new(5.0, 0.4, 0.01), Vec3::new(0.6, 0.0, 0.8), false),
        ] {
            let rated = |e: &&IrradianceEstimate| surface_distance_sq(e.position - point, normal);
            let same = estimates.iter().filter(|e| e.normal.dot(normal) >= MIN_COS);
            let nearest = same.min_by(|a, b| rated(a).total_cmp(&rated(b))).unwrap();
            let expected = near.then_some((nearest.irradiance, 0.1));
            assert_eq!(map.at(point, normal), expected);
        }
        assert_eq!(map.at(Vec3::ZERO, Vec3::NEG_Y), None);
        assert_eq!(IrradianceMap::new(&[], &KdTree::empty()).at(Vec3::ZERO, Vec3::Z), None);
    }
}
