//! A scene of Embree while it is filled.

use super::ray::{ALL_GEOMETRY, CLEAR};
use super::triangles::{TriangleMesh, copy_buffer};
use super::{Device, EmbreeError};
use embree4_sys as sys;
use glam::Vec3;

/// Quality of hierarchies: a binned surface-area heuristic. Rays lose about one hit in a million.
const BUILD_QUALITY: sys::RTCBuildQuality = sys::RTC_BUILD_QUALITY_MEDIUM;

/// A scene, which is released when it is dropped. Instances of it keep it alive.
pub(super) struct RawScene(sys::RTCScene);

impl RawScene {
    /// Makes an empty scene.
    pub fn new(device: &Device) -> Result<RawScene, EmbreeError> {
        // SAFETY: the device is live.
        let scene = unsafe { sys::rtcNewScene(device.handle()) };
        device.check("making a scene")?;
        // SAFETY: the scene is live and not yet committed. The flag allows a query to pass its own filter;
        // without it Embree ignores the filter silently.
        unsafe {
            sys::rtcSetSceneBuildQuality(scene, BUILD_QUALITY);
            sys::rtcSetSceneFlags(scene, sys::RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS);
        }
        Ok(RawScene(scene))
    }

    /// Copies a mesh into the scene. Meshes without triangles are left out.
    pub fn attach(&self, device: &Device, id: u32, mesh: &TriangleMesh) -> Result<(), EmbreeError> {
        if mesh.triangles.is_empty() {
            return Ok(());
        }
        // SAFETY: the device is live.
        let geometry = unsafe { sys::rtcNewGeometry(device.handle(), sys::RTC_GEOMETRY_TYPE_TRIANGLE) };
        device.check("making a mesh")?;
        let copied =
            copy_buffer(geometry, sys::RTC_BUFFER_TYPE_VERTEX, sys::RTC_FORMAT_FLOAT3, mesh.positions)
                && copy_buffer(geometry, sys::RTC_BUFFER_TYPE_INDEX, sys::RTC_FORMAT_UINT3, mesh.triangles);
        // SAFETY: geometry and scene are live; the scene takes a reference of its own, so ours is released. A
        // geometry whose buffers are missing is not attached.
        unsafe {
            if copied {
                sys::rtcSetGeometryBuildQuality(geometry, BUILD_QUALITY);
                sys::rtcSetGeometryMask(geometry, if mesh.occludes { ALL_GEOMETRY } else { CLEAR });
                sys::rtcCommitGeometry(geometry);
                sys::rtcAttachGeometryByID(self.0, geometry, id);
            }
            sys::rtcReleaseGeometry(geometry);
        }
        device.check("copying a mesh")
    }

    /// Builds the hierarchy.
    pub fn commit(&self, device: &Device) -> Result<(), EmbreeError> {
        // SAFETY: the scene is live; committing takes no pointers. Embree restores MXCSR afterwards.
        unsafe { sys::rtcCommitScene(self.0) };
        device.check("building the acceleration structure")
    }

    pub fn handle(&self) -> sys::RTCScene {
        self.0
    }

    /// Returns the minimum and maximum corner of the box around the committed scene; `None` if it is empty.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let mut b = sys::RTCBounds {
            lower_x: f32::INFINITY,
            lower_y: f32::INFINITY,
            lower_z: f32::INFINITY,
            align0: 0.0,
            upper_x: f32::NEG_INFINITY,
            upper_y: f32::NEG_INFINITY,
            upper_z: f32::NEG_INFINITY,
            align1: 0.0,
        };
        // SAFETY: the scene is committed, and the bounds are of the type and alignment asked for.
        unsafe { sys::rtcGetSceneBounds(self.0, &mut b) };
        let (lower, upper) =
            (Vec3::new(b.lower_x, b.lower_y, b.lower_z), Vec3::new(b.upper_x, b.upper_y, b.upper_z));
        (lower.is_finite() && upper.is_finite()).then_some((lower, upper))
    }
}

impl Drop for RawScene {
    fn drop(&mut self) {
        // SAFETY: the scene is live and this is our only reference.
        unsafe { sys::rtcReleaseScene(self.0) };
    }
}
