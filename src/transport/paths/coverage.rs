//! Positions of paths in a pixel that are chosen by what many eye rays hit there.
//!
//! A few paths cannot tell how much of a pixel each surface covers, and a denoiser keeps such an error of an edge. So
//! more eye rays divide the pixel into strata: the parts that see surfaces of one mesh and similar orientation. Every
//! stratum has paths, at the positions of some of its rays, and counts in proportion to its rays. That is unbiased.
//!
//! Paper: Pharr, Jakob & Humphreys, *Physically Based Rendering*, 2023, section 2.2.1: stratified sampling, here with
//! numbers of paths in proportion.
//! Deviations: the smallest strata count as one if there are more strata than paths.

use super::estimand::pixel_seed;
use base::math::{LANES, first_lanes};
use base::sampling::Samplers16;
use embree::Hits16;
use glam::Vec3;
use std::ops::Range;
use world::World;
use world::view::View;

/// Number of eye rays per path.
const RAYS_PER_PATH: u32 = 4;

/// Position of a path.
#[derive(Clone, Copy, Debug)]
pub struct Position {
    /// Number of the eye ray whose position it is.
    pub ray: u32,
    /// Weight of the path; the mean over a pixel is 1.
    pub weight: f32,
}

impl Position {
    /// Returns the position of a sample of its own, as all pixels without strata have them.
    pub fn own(sample: u32) -> Position {
        Position { ray: sample, weight: 1.0 }
    }
}

/// Finder of the positions of paths.
pub struct Coverage<'a> {
    world: &'a World,
    view: &'a View,
    seed: u32,
    /// Number of paths in each pixel.
    paths: u32,
    /// Number of the first eye ray.
    first: u32,
    /// Stratum of each ray of a pixel.
    strata: Vec<u32>,
    /// Numbers of the strata, with their numbers of rays.
    counts: Vec<(u32, u32)>,
    /// Number of eye rays traced.
    pub covering: u64,
}

impl<'a> Coverage<'a> {
    /// Creates the finder for the paths of these numbers in each pixel.
    pub fn new(world: &'a World, view: &'a View, seed: u32, numbers: Range<u32>) -> Coverage<'a> {
        let (paths, first) = (numbers.len() as u32, numbers.start.saturating_mul(RAYS_PER_PATH));
        Coverage { world, view, seed, paths, first, strata: Vec::new(), counts: Vec::new(), covering: 0 }
    }

    /// Returns the number of eye rays in a pixel that is divided; 0 for a single path, which has no choice.
    fn rays(&self) -> u32 {
        if self.paths > 1 { (RAYS_PER_PATH * self.paths).next_multiple_of(LANES as u32) } else { 0 }
    }

    /// Appends the positions of the paths of a film pixel to `found`. An even pixel is not divided.
    pub fn add(&mut self, pixel: [u32; 2], is_even: bool, found: &mut Vec<Position>) {
        self.strata.clear();
        let rays = if is_even { 0 } else { self.rays() };
        self.covering += u64::from(rays);
        for first in (0..rays).step_by(LANES) {
            self.trace(pixel, self.first.saturating_add(first));
        }
        self.counts.clear();
        for stratum in &self.strata {
            match self.counts.iter_mut().find(|(other, _)| other == stratum) {
                Some((_, count)) => *count += 1,
                None => self.counts.push((*stratum, 1)),
            }
        }
        if self.counts.len() <= 1 {
            return found.extend((self.first..).take(self.paths as usize).map(Position::own));
        }
        self.merge();
        self.choose(found);
    }

    /// Traces sixteen eye rays and appends the strata that they hit.
    fn trace(&mut self, pixel: [u32; 2], first: u32) {
        let seed = pixel_seed(pixel, self.seed);
        let index = std::array::from_fn(|lane| first.wrapping_add(lane as u32));
        let jitter = Samplers16 { seed: [seed; LANES], index }.point(1);
        let mut rays = self.view.sample_rays(&[pixel; LANES], &jitter, &[self.seed; LANES], &index);
        self.world.put_behind_hidden(&mut rays);
        let mut hits = Hits16::default();
        let met = self.world.accel.closest_hit16(&rays, first_lanes(LANES), true, &mut hits);
        let mut last = None;
        for lane in 0..LANES {
            let at = (met >> lane & 1 != 0).then(|| (hits.geometry[lane], hits.primitive[lane]));
            let stratum = match last {
                Some((other, stratum)) if other == at => stratum,
                _ => at.map_or(0, |(mesh, triangle)| {
                    let side = side(self.world.geometric_normal(mesh, triangle));
                    1 + mesh.wrapping_mul(SIDES) + side
                }),
            };
            last = Some((at, stratum));
            self.strata.push(stratum);
        }
    }

    /// Makes the smallest strata one, so that every stratum may have a path.
    fn merge(&mut self) {
        self.counts.sort_by_key(|(stratum, count)| (std::cmp::Reverse(*count), *stratum));
        let kept = self.counts.len().min(self.paths as usize);
        let last = self.counts[kept - 1].0;
        for (stratum, count) in self.counts.drain(kept..).collect::<Vec<_>>() {
            self.counts[kept - 1].1 += count;
            self.strata.iter_mut().filter(|other| **other == stratum).for_each(|other| *other = last);
        }
    }

    /// Divides the paths among the strata and appends their positions.
    fn choose(&self, found: &mut Vec<Position>) {
        let (rays, mut left) = (self.rays(), self.paths);
        let mut rays_left = rays;
        for (i, (stratum, count)) in self.counts.iter().enumerate() {
            let others = (self.counts.len() - i - 1) as u32;
            let share = (count * left + rays_left / 2) / rays_left;
            let paths = if others == 0 { left } else { share.clamp(1, left - others) };
            (left, rays_left) = (left - paths, rays_left - count);
            let weight = *count as f32 * self.paths as f32 / (rays * paths) as f32;
            let own = self.strata.iter().enumerate().filter(|(_, other)| *other == stratum);
            // At most every ray of a stratum has a path; a path may share a ray.
            let step = (*count / paths).max(1) as usize;
            let mut chosen = own.step_by(step).map(|(ray, _)| self.first + ray as u32).cycle();
            found.extend((0..paths).filter_map(|_| chosen.next()).map(|ray| Position { ray, weight }));
        }
    }
}

/// Number of orientations that are told apart: octants of the sphere.
const SIDES: u32 = 8;

/// Returns the octant of a normal, turned so that the axes of a scene lie within octants.
fn side(normal: Vec3) -> u32 {
    let axes = [Vec3::new(0.7, 0.5, 0.3), Vec3::new(-0.4, 0.6, 0.5), Vec3::new(0.3, -0.5, 0.7)];
    axes.map(|axis| axis.dot(normal)).iter().fold(0, |side, x| 2 * side + u32::from(*x < 0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use world::testkit::*;

    /// Returns a finder with these strata, by the numbers of their rays.
    fn finder<'a>(world: &'a WorldAndView, paths: u32, rays: &[u32]) -> Coverage<'a> {
        let mut coverage = Coverage::new(world, &world.view, 0, 0..paths);
        coverage.counts = rays.iter().enumerate().map(|(i, count)| (i as u32, *count)).collect();
        coverage.strata = rays.iter().enumerate().flat_map(|(i, n)| vec![i as u32; *n as usize]).collect();
        coverage
    }

    #[test]
    fn strata_count_by_their_rays_and_each_has_a_path() {
        let world = room_with_ball(None);
        for rays in [&[15, 1][..], &[8, 8], &[1; 16], &[5, 1, 1, 1, 8], &[16], &[2, 14], &[11, 3, 2]] {
            let mut coverage = finder(&world, 4, rays);
            coverage.merge();
            let (mut found, merged) = (Vec::new(), coverage.strata.clone());
            coverage.choose(&mut found);
            assert_eq!(found.len(), 4);
            let mut weights = std::collections::BTreeMap::new();
            for position in &found {
                *weights.entry(merged[position.ray as usize]).or_insert(0.0) += position.weight;
            }
            for (stratum, count) in &coverage.counts {
                let expected = *count as f32 / 4.0;
                assert!((weights[stratum] - expected).abs() < 1e-5, "{rays:?} {found:?}");
            }
            assert!(coverage.counts.len() == rays.len().min(4));
        }
    }

    #[test]
    fn a_pixel_without_edges_and_a_single_path_have_their_own_positions() {
        let world = room_with_ball(None);
        let positions = |numbers: Range<u32>, pixel| {
            let mut found = Vec::new();
            Coverage::new(&world, &world.view, 1, numbers).add(pixel, false, &mut found);
            found
        };
        for (numbers, first) in [(0..1, 0), (5..6, 20), (0..4, 0), (16..32, 64)] {
            let found = positions(numbers.clone(), [0, 0]);
            assert!(found.iter().zip(first..).all(|(p, ray)| p.ray == ray && p.weight == 1.0), "{found:?}");
            assert_eq!(found.len(), numbers.len());
        }
        let [width, height] = world.view.window.film;
        let mixed = (0..width * height)
            .filter(|i| positions(0..4, [i % width, i / width]).iter().any(|p| p.weight != 1.0));
        assert!(mixed.count() > 8);
    }
}
