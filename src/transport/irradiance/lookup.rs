//! Look-up of irradiance at any point: an estimate nearby on a surface of similar orientation. It is the nearest one in
//! the point's cell of a kd-tree if its disc holds the point, else the nearest of all.
//!
//! Paper: Christensen 1999: one look-up at each hit of a final gathering, instead of an estimate.

use super::PhotonMap;
use super::density::{IrradianceEstimate, estimates};
use super::disc::{MIN_COS, surface_distance_sq};
use base::kd_tree::{KdTree, WideKdTree, least_lane};
use base::math::{F32x16, LANES, Rgb, Vec3x16};
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
    /// Irradiance of each estimate, with the radius of the disc over which it is the mean, and true if it is sure.
    irradiance: Vec<(Rgb, f32, bool)>,
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
            irradiance: estimates.iter().map(|e| (e.irradiance, e.radius, e.is_sure)).collect(),
            // The square is rounded up, so that an estimate at exactly this distance counts.
            reach_sq: (furthest * furthest).next_up(),
        }
    }

    /// Number of estimates.
    pub fn len(&self) -> usize {
        self.irradiance.len()
    }

    /// Looks up the irradiance at a point of a surface with unit normal `normal`, and the radius of the disc
    /// over which it is the mean, infinite if the irradiance is not sure. `None` if there is no photon near, hence no
    /// light.
    #[inline]
    pub fn at(&self, point: Vec3, normal: Vec3) -> Option<(Rgb, f32)> {
        if self.irradiance.is_empty() {
            return None;
        }
        let mut best = Best { estimate: 0, distance_sq: f32::INFINITY };
        self.leaves[self.index.near_leaf(point)].find_nearer(point, normal, &mut best);
        if !self.holds(&best) {
            best = Best { estimate: 0, distance_sq: self.reach_sq };
            self.index.leaves(point, self.reach_sq, |leaf, _| {
                self.leaves[leaf].find_nearer(point, normal, &mut best);
                best.distance_sq
            });
        }
        let (irradiance, radius, is_sure) = self.irradiance[best.estimate];
        self.holds(&best).then_some((irradiance, if is_sure { radius } else { f32::INFINITY }))
    }

    /// Returns true if the disc of an estimate holds the point.
    #[inline]
    fn holds(&self, best: &Best) -> bool {
        let reach = REACH * self.irradiance[best.estimate].1;
        best.distance_sq <= reach * reach
    }
}

/// Estimate nearest to a point so far.
struct Best {
    estimate: usize,
    distance_sq: f32,
}

impl Leaf {
    /// Replaces `best` by an estimate of the leaf that is nearer to a point of a surface.
    #[inline(always)]
    fn find_nearer(&self, point: Vec3, normal: Vec3, best: &mut Best) {
        for packet in 0..PACKETS {
            let distances = distances_sq(&self.position[packet], &self.normal[packet], point, normal);
            let (lane, least) = least_lane(&distances);
            if least < best.distance_sq {
                *best = Best { estimate: self.first as usize + packet * LANES + lane, distance_sq: least };
            }
        }
    }

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
    fn an_estimate_on_the_right_side_whose_disc_holds_the_point_is_found() {
        // Two sides of a sheet, and a wall.
        let estimate = |i: u32| {
            let u = owen_sobol_2d(i, 5);
            let (position, normal) = match i % 3 {
                0 => (Vec3::new(u.x, u.y, 0.0), Vec3::Z),
                1 => (Vec3::new(u.x, u.y, 0.0), Vec3::NEG_Z),
                _ => (Vec3::new(0.0, u.x, u.y), Vec3::X),
            };
            IrradianceEstimate {
                position,
                normal,
                irradiance: Rgb::splat(i as f32),
                radius: 0.1,
                is_sure: !i.is_multiple_of(5),
            }
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
            let found = map.at(point, normal);
            assert_eq!(found.is_some(), near);
            let Some((irradiance, radius)) = found else { continue };
            let number = irradiance.x;
            let estimate = estimates.iter().find(|e| e.irradiance.x == number).unwrap();
            assert!(estimate.normal.dot(normal) >= MIN_COS);
            assert!(surface_distance_sq(estimate.position - point, normal) <= 0.1f32.powi(2));
            assert_eq!(radius, if estimate.is_sure { 0.1 } else { f32::INFINITY });
        }
        assert_eq!(map.at(Vec3::ZERO, Vec3::NEG_Y), None);
        assert_eq!(IrradianceMap::new(&[], &KdTree::empty()).at(Vec3::ZERO, Vec3::Z), None);
    }
}
