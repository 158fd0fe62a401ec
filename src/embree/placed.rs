//! Groups of meshes that are stored once and seen at several places.
//!
//! Each group is a scene of its own, and one geometry of the whole scene: an array of instances. The array stores 48
//! bytes per place. Embree would build one geometry per place otherwise, of about eight times as many.

use super::numbers::{GroupNumbers, PlacedNumbers};
use super::raw_scene::RawScene;
use super::ray::ALL_GEOMETRY;
use super::triangles::TriangleMesh;
use super::{Device, EmbreeError};
use base::math::Placement;
use embree4_sys as sys;

/// Meshes in coordinates of their own, and their places. [`super::Accel::build_placed`] copies them.
#[derive(Clone, Copy, Debug)]
pub struct PlacedGroup<'a> {
    /// The meshes.
    pub meshes: &'a [TriangleMesh<'a>],
    /// Transforms to the coordinates of the other meshes.
    pub placements: &'a [Placement],
}

/// Adds groups to a scene of `own` meshes, and returns the numbers of the seen meshes; `None` without groups.
pub(super) fn attach(
    whole: &RawScene,
    device: &Device,
    own: usize,
    groups: &[PlacedGroup],
) -> Result<Option<PlacedNumbers>, EmbreeError> {
    let count = groups.iter().fold(own, |count, g| count.saturating_add(g.meshes.len() * g.placements.len()));
    if u32::try_from(count).is_err() {
        return Err(EmbreeError::TooMany { what: "meshes at all places", count });
    }
    let mut numbers = PlacedNumbers { own: own as u32, groups: Vec::new() };
    let mut first = numbers.own;
    for (id, group) in (numbers.own..).zip(groups) {
        let meshes = group.meshes.len() as u32;
        numbers.groups.push(GroupNumbers { first, meshes });
        first += meshes * group.placements.len() as u32;
        let scene = RawScene::new(device)?;
        for (id, mesh) in (0u32..).zip(group.meshes) {
            scene.attach(device, id, mesh)?;
        }
        scene.commit(device)?;
        if scene.bounds().is_some() && !group.placements.is_empty() {
            attach_places(whole, device, id, &scene, group.placements)?;
        }
    }
    Ok((!groups.is_empty()).then_some(numbers))
}

/// Adds a scene at several places to another.
fn attach_places(
    whole: &RawScene,
    device: &Device,
    id: u32,
    scene: &RawScene,
    placements: &[Placement],
) -> Result<(), EmbreeError> {
    const { assert!(size_of::<Placement>() == 48) };
    // SAFETY: the device is live.
    let geometry = unsafe { sys::rtcNewGeometry(device.handle(), sys::RTC_GEOMETRY_TYPE_INSTANCE_ARRAY) };
    device.check("making instances")?;
    // SAFETY: geometry and scenes are live. The geometry keeps a reference to the scene that it shows. The format is of
    // 48 bytes, and the new buffer holds as many placements, is 16-byte aligned and overlaps nothing of ours.
    // Placements are plain numbers: three columns of a matrix, and the translation. The whole scene takes a reference
    // to the geometry, so ours is released.
    unsafe {
        sys::rtcSetGeometryInstancedScene(geometry, scene.handle());
        let buffer = sys::rtcSetNewGeometryBuffer(
            geometry,
            sys::RTC_BUFFER_TYPE_TRANSFORM,
            0,
            sys::RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR,
            size_of::<Placement>(),
            placements.len(),
        );
        if !buffer.is_null() {
            std::ptr::copy_nonoverlapping(placements.as_ptr(), buffer.cast::<Placement>(), placements.len());
            sys::rtcSetGeometryMask(geometry, ALL_GEOMETRY);
            sys::rtcCommitGeometry(geometry);
            sys::rtcAttachGeometryByID(whole.handle(), geometry, id);
        }
        sys::rtcReleaseGeometry(geometry);
    }
    device.check("placing instances")
}
