//! Numbers of seen meshes by the ids that Embree gives.
//!
//! Meshes without placements have their index as their geometry id, so that nothing is left to do. The type parameter
//! of queries makes the difference: queries of structures without groups contain no trace of placements.

use embree4_sys as sys;

/// Ids of hits, one entry per lane.
#[derive(Clone, Copy)]
pub(super) struct HitIds {
    pub geometry: *const u32,
    pub instance: *const u32,
    pub place: *const u32,
}

/// Numbering of seen meshes.
pub(super) trait Numbers: Copy {
    /// Returns the number of the mesh that the hit of a lane is on.
    ///
    /// # Safety
    /// The pointers of `ids` must be valid for that lane.
    unsafe fn of(self, ids: HitIds, lane: usize) -> u32;
}

/// Numbers of meshes without placements.
#[derive(Clone, Copy)]
pub(super) struct OwnNumbers;

impl Numbers for OwnNumbers {
    #[inline(always)]
    unsafe fn of(self, ids: HitIds, lane: usize) -> u32 {
        // SAFETY: by contract.
        unsafe { *ids.geometry.add(lane) }
    }
}

/// Numbers of meshes, some of which are in groups.
#[derive(Debug, Default)]
pub(super) struct PlacedNumbers {
    /// Number of meshes without placements.
    pub own: u32,
    pub groups: Vec<GroupNumbers>,
}

/// Numbers of a group's meshes at all places.
#[derive(Clone, Copy, Debug)]
pub(super) struct GroupNumbers {
    /// Number of the first mesh at the first place.
    pub first: u32,
    /// Number of meshes in the group.
    pub meshes: u32,
}

impl PlacedNumbers {
    /// Returns the number of the mesh `geometry` at the place `place` of the group whose geometry id is `instance`.
    #[inline]
    pub fn number(&self, geometry: u32, instance: u32, place: u32) -> u32 {
        // Lanes without a hit may have any ids.
        match self.groups.get(instance.wrapping_sub(self.own) as usize) {
            Some(GroupNumbers { first, meshes }) if instance != sys::RTC_INVALID_GEOMETRY_ID => {
                first.wrapping_add(place.wrapping_mul(*meshes)).wrapping_add(geometry)
            }
            _ => geometry,
        }
    }
}

impl Numbers for &PlacedNumbers {
    #[inline]
    unsafe fn of(self, ids: HitIds, lane: usize) -> u32 {
        // SAFETY: by contract.
        unsafe { self.number(*ids.geometry.add(lane), *ids.instance.add(lane), *ids.place.add(lane)) }
    }
}
