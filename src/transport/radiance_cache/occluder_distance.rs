//! Distances from records to the occluders of their virtual lights.
//!
//! Paper: Herzog et al. 2009, section 5.1. Occluders limit the footprint of a record, as visible lights do.
//!
//! Deviations: the occluder is the one that stopped the shadow ray, not the nearest.

use crate::lightcut::Visibility;
use crate::lights::LightNode;
use base::math::{F32x16, LANES};
use embree::{Occluders16, Rays16};
use glam::Vec3;
use std::cell::RefCell;
use world::World;
use world::shadow::Engine;

/// Visibility in the scene that logs the distances of occluders.
pub struct OccluderLog<'w> {
    engine: Engine<'w>,
    /// Representatives, each with the distance to its occluder per lane, or infinity.
    log: RefCell<Vec<(u32, F32x16)>>,
}

impl<'w> OccluderLog<'w> {
    /// Creates an empty log.
    pub fn new(world: &'w World) -> OccluderLog<'w> {
        OccluderLog { engine: Engine::scattered(world), log: RefCell::new(Vec::new()) }
    }

    /// Returns the distances, sorted by representative.
    pub fn sorted(self) -> OccluderDistances {
        let mut log = self.log.into_inner();
        log.sort_unstable_by_key(|entry| entry.0);
        OccluderDistances(log)
    }
}

/// Distances to the occluders of a cut's lights, sorted by representative.
pub struct OccluderDistances(Vec<(u32, F32x16)>);

impl OccluderDistances {
    /// Returns the distance from a lane to the occluder of a representative; infinite if there is none.
    pub fn get(&self, node: &LightNode, lane: usize) -> f32 {
        let place = self.0.binary_search_by_key(&(node.representative() as u32), |entry| entry.0);
        place.map_or(f32::INFINITY, |i| self.0[i].1[lane])
    }
}

impl Visibility for OccluderLog<'_> {
    fn visible16(&self, rays: &Rays16, lanes: u16, light: Option<u32>) -> u16 {
        let mut found = Occluders16::default();
        let occluded = self.engine.occluders16(rays, lanes, &mut found);
        if let Some(light) = light.filter(|_| occluded != 0) {
            let mut distances = [f32::INFINITY; LANES];
            for (lane, distance) in distances.iter_mut().enumerate() {
                let direction =
                    Vec3::new(rays.direction_x[lane], rays.direction_y[lane], rays.direction_z[lane]);
                if occluded >> lane & 1 != 0 {
                    *distance = found.t[lane] * direction.length();
                }
            }
            self.log.borrow_mut().push((light, distances));
        }
        lanes & !occluded
    }

    fn sheets(&self) -> Option<&World> {
        self.engine.sheets()
    }
}
