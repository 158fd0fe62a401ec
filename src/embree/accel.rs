//! Acceleration structure over triangle meshes, and queries of single rays.

use super::ray::{ALL_GEOMETRY, CLEAR, OCCLUDING, without_hit};
use super::{Device, EmbreeError, Hit, Ray, Width};
use embree4_sys as sys;
use glam::Vec3;

/// Coordinate from which Embree leaves out a triangle (its `FLT_LARGE`).
const COORDINATE_LIMIT: f32 = 1.844e18;

/// Triangles to build from. [`Accel::build`] copies them.
#[derive(Clone, Copy, Debug)]
pub struct TriangleMesh<'a> {
    /// Vertex positions.
    pub positions: &'a [Vec3],
    /// Vertex indices of each triangle.
    pub triangles: &'a [[u32; 3]],
    /// False if queries for occlusion ignore it.
    pub occludes: bool,
}

/// Effort of Embree's build, and size of the result.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BuildQuality {
    /// Morton order: fastest build, slowest traversal.
    Low,
    /// Binned surface-area heuristic. It is the fastest quality without significant loss of hits: occlusion differs
    /// from `Robust` for about one ray in a million.
    #[default]
    Medium,
    /// Quality `Medium` with spatial splits.
    High,
    /// Quality `Medium`, with traversal that rounds outwards.
    Robust,
}

impl BuildQuality {
    fn to_embree(self) -> (sys::RTCBuildQuality, sys::RTCSceneFlags) {
        match self {
            BuildQuality::Low => (sys::RTC_BUILD_QUALITY_LOW, sys::RTC_SCENE_FLAG_NONE),
            BuildQuality::Medium => (sys::RTC_BUILD_QUALITY_MEDIUM, sys::RTC_SCENE_FLAG_NONE),
            BuildQuality::High => (sys::RTC_BUILD_QUALITY_HIGH, sys::RTC_SCENE_FLAG_NONE),
            BuildQuality::Robust => (sys::RTC_BUILD_QUALITY_MEDIUM, sys::RTC_SCENE_FLAG_ROBUST),
        }
    }
}

/// A bounding volume hierarchy, ready for queries from any thread.
pub struct Accel {
    scene: sys::RTCScene,
    bounds: Option<(Vec3, Vec3)>,
    widest: Width,
    device: Device,
}

// SAFETY: a committed scene is not changed any more, and Embree allows queries of it, and its release,
// from any thread.
unsafe impl Send for Accel {}
// SAFETY: as above; all methods take `&self` and only query.
unsafe impl Sync for Accel {}

impl Accel {
    /// Builds with all threads of `device`, at medium quality.
    ///
    /// Ids in hits are indices into `meshes` and into a mesh's `triangles`. Meshes without triangles keep their index
    /// and are never hit. Vertices are copied.
    ///
    /// # Errors
    /// If a triangle refers to a missing vertex, or has a coordinate for which Embree would silently ignore it. Also if
    /// Embree fails (memory).
    pub fn build(device: &Device, meshes: &[TriangleMesh]) -> Result<Accel, EmbreeError> {
        Accel::build_with(device, meshes, BuildQuality::default())
    }

    /// Builds like [`Accel::build`], with a quality.
    ///
    /// # Errors
    /// Like [`Accel::build`].
    pub fn build_with(
        device: &Device,
        meshes: &[TriangleMesh],
        quality: BuildQuality,
    ) -> Result<Accel, EmbreeError> {
        if u32::try_from(meshes.len()).is_err() {
            return Err(EmbreeError::TooMany { what: "meshes", count: meshes.len() });
        }
        for (index, mesh) in meshes.iter().enumerate() {
            validate(index, mesh)?;
        }
        // SAFETY: the device is live.
        let scene = unsafe { sys::rtcNewScene(device.handle()) };
        device.check("making a scene")?;
        // Dropping `accel` releases the scene.
        let widest = device.widest_packets();
        let mut accel = Accel { scene, bounds: None, widest, device: device.clone() };
        let (quality, flags) = quality.to_embree();
        // SAFETY: the scene is live and not yet committed. The flag allows a query to pass its own filter;
        // without it Embree ignores the filter silently.
        unsafe {
            sys::rtcSetSceneBuildQuality(scene, quality);
            sys::rtcSetSceneFlags(scene, flags | sys::RTC_SCENE_FLAG_FILTER_FUNCTION_IN_ARGUMENTS);
        }
        for (id, mesh) in (0u32..).zip(meshes) {
            if !mesh.triangles.is_empty() {
                accel.attach(id, mesh, quality)?;
            }
        }
        // SAFETY: the scene is live; committing takes no pointers. Embree restores MXCSR afterwards.
        unsafe { sys::rtcCommitScene(scene) };
        device.check("building the acceleration structure")?;
        accel.bounds = accel.committed_bounds();
        Ok(accel)
    }

    fn attach(
        &mut self,
        id: u32,
        mesh: &TriangleMesh,
        quality: sys::RTCBuildQuality,
    ) -> Result<(), EmbreeError> {
        // SAFETY: the device is live.
        let geometry = unsafe { sys::rtcNewGeometry(self.device.handle(), sys::RTC_GEOMETRY_TYPE_TRIANGLE) };
        self.device.check("making a mesh")?;
        let copied =
            copy_buffer(geometry, sys::RTC_BUFFER_TYPE_VERTEX, sys::RTC_FORMAT_FLOAT3, mesh.positions)
                && copy_buffer(geometry, sys::RTC_BUFFER_TYPE_INDEX, sys::RTC_FORMAT_UINT3, mesh.triangles);
        // SAFETY: geometry and scene are live; the scene takes a reference of its own, so ours is released. A
        // geometry whose buffers are missing is not attached.
        unsafe {
            if copied {
                sys::rtcSetGeometryBuildQuality(geometry, quality);
                sys::rtcSetGeometryMask(geometry, if mesh.occludes { ALL_GEOMETRY } else { CLEAR });
                sys::rtcCommitGeometry(geometry);
                sys::rtcAttachGeometryByID(self.scene, geometry, id);
            }
            sys::rtcReleaseGeometry(geometry);
        }
        self.device.check("copying a mesh")
    }

    fn committed_bounds(&self) -> Option<(Vec3, Vec3)> {
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
        unsafe { sys::rtcGetSceneBounds(self.scene, &mut b) };
        let (lower, upper) =
            (Vec3::new(b.lower_x, b.lower_y, b.lower_z), Vec3::new(b.upper_x, b.upper_y, b.upper_z));
        (lower.is_finite() && upper.is_finite()).then_some((lower, upper))
    }

    /// Returns the minimum and maximum corner of the box around all triangles; `None` without triangles.
    #[inline]
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds
    }

    /// Returns the first triangle along the ray. The choice among several at one `t` is unspecified but deterministic.
    #[inline]
    pub fn closest_hit(&self, ray: &Ray) -> Option<Hit> {
        let ray = ray.to_embree(ALL_GEOMETRY).filter(|_| !self.is_empty())?;
        let mut rayhit = without_hit(ray);
        // SAFETY: the scene is committed; the ray is ours, has the library's layout (the version is checked)
        // and is 16-byte aligned by its type; null arguments stand for the defaults.
        unsafe { sys::rtcIntersect1(self.scene, &mut rayhit, std::ptr::null_mut()) };
        let hit = &rayhit.hit;
        (hit.geomID != sys::RTC_INVALID_GEOMETRY_ID).then_some(Hit {
            t: rayhit.ray.tfar,
            u: hit.u,
            v: hit.v,
            geometry: hit.geomID,
            primitive: hit.primID,
        })
    }

    /// True if a triangle of an occluding mesh intersects the ray's segment.
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let Some(mut shadow_ray) = ray.to_embree(OCCLUDING).filter(|_| !self.is_empty()) else {
            return false;
        };
        // SAFETY: as for `rtcIntersect1` above.
        unsafe { sys::rtcOccluded1(self.scene, &mut shadow_ray, std::ptr::null_mut()) };
        // Embree marks an occluded ray by `tfar` = -inf. A traceable ray never starts with it, since t_near <= t_far.
        shadow_ray.tfar == f32::NEG_INFINITY
    }

    /// True without triangles. Queries then skip Embree.
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.bounds.is_none()
    }

    /// Returns the width of the widest packets that are traced natively.
    #[inline]
    pub fn widest(&self) -> Width {
        self.widest
    }

    /// Returns the device of the structure.
    pub fn device(&self) -> &Device {
        &self.device
    }

    pub(super) fn scene(&self) -> sys::RTCScene {
        self.scene
    }
}

impl Drop for Accel {
    fn drop(&mut self) {
        // SAFETY: the scene is live and this is our only reference.
        unsafe { sys::rtcReleaseScene(self.scene) };
    }
}

/// Copies `items`, of three 32-bit numbers each, into a new buffer of Embree, which pads it as required.
///
/// Returns false if there is no memory. Embree has then reported it.
fn copy_buffer<T: Copy>(
    geometry: sys::RTCGeometry,
    buffer_type: sys::RTCBufferType,
    format: sys::RTCFormat,
    items: &[T],
) -> bool {
    const { assert!(size_of::<T>() == 12) };
    // SAFETY: the geometry is live and the format is of 12 bytes.
    let buffer = unsafe {
        sys::rtcSetNewGeometryBuffer(geometry, buffer_type, 0, format, size_of::<T>(), items.len())
    };
    if buffer.is_null() {
        return false;
    }
    // SAFETY: the new buffer holds at least `items.len()` items of 12 bytes, is 16-byte aligned and
    // overlaps nothing of ours; `T` is `Copy`.
    unsafe { std::ptr::copy_nonoverlapping(items.as_ptr(), buffer.cast::<T>(), items.len()) };
    true
}

/// Rejects input that Embree would read out of bounds or silently ignore.
fn validate(mesh_index: usize, mesh: &TriangleMesh) -> Result<(), EmbreeError> {
    for (what, count) in [("triangles", mesh.triangles.len()), ("vertices", mesh.positions.len())] {
        if u32::try_from(count).is_err() {
            return Err(EmbreeError::TooMany { what, count });
        }
    }
    let (mut first, mut count) = (0, 0);
    for (triangle, corners) in mesh.triangles.iter().enumerate() {
        let mut is_valid = true;
        for &index in corners {
            let Some(p) = mesh.positions.get(index as usize) else {
                let vertices = mesh.positions.len();
                return Err(EmbreeError::VertexIndex { mesh: mesh_index, triangle, index, vertices });
            };
            // This is false for NaN.
            is_valid &= p.abs().cmplt(Vec3::splat(COORDINATE_LIMIT)).all();
        }
        if !is_valid {
            first = if count == 0 { triangle } else { first };
            count += 1;
        }
    }
    if count > 0 { Err(EmbreeError::InvalidTriangles { mesh: mesh_index, first, count }) } else { Ok(()) }
}
