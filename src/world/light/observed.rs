//! Observations of the light from emitters: rays from points in regions of the scene.

use super::regions::Regions;
use glam::Vec3;

/// Maximum number of points in a region.
const POINTS: usize = 32;

/// Weight of what is known of a node in the nodes below it, in rays.
pub const PRIOR: f32 = 16.0;

/// Rays from each observer in turn, with as many from each.
#[derive(Clone, Debug, Default)]
pub struct LightRays {
    /// Tiles of the environment to which rays were traced, and the light that arrived relative to the tile's, times the
    /// cosine at the observer; 0 for occluded rays.
    pub sky: Vec<(u16, f32)>,
    /// Emitters to which rays were traced, and true if they are visible; `None` for rays to emitters that cannot light
    /// the observer.
    pub emitters: Vec<Option<(u32, bool)>>,
}

/// Regions of observers, and what these have seen.
pub struct Observed {
    /// Regions.
    pub(super) regions: Regions,
    /// Observers in each region.
    members: Vec<Vec<u32>>,
    /// Waves of rays from all observers.
    pub(super) waves: Vec<LightRays>,
    /// Number of observers.
    observers: usize,
}

impl Observed {
    /// Divides observers at some positions into regions of `fewest` observers or more.
    pub(super) fn new(observers: &[Vec3], fewest: usize) -> Observed {
        let (regions, members) = Regions::new(observers, POINTS.max(fewest));
        Observed { regions, members, waves: Vec::new(), observers: observers.len() }
    }

    /// Adds a wave of rays.
    pub fn add(&mut self, rays: LightRays) {
        self.waves.push(rays);
    }

    /// Lists the rays of one kind from a region's observers.
    pub(super) fn rays<'b, T: 'b>(
        &'b self,
        region: usize,
        kind: impl Fn(&'b LightRays) -> &'b [T] + 'b,
    ) -> impl Iterator<Item = &'b T> {
        self.waves.iter().flat_map(move |wave| {
            let rays = kind(wave);
            let each = rays.len() / self.observers.max(1);
            self.members[region].iter().flat_map(move |point| &rays[*point as usize * each..][..each])
        })
    }
}
