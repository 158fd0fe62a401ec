//! Acceleration structure over triangle meshes, and queries of single rays.

use super::numbers::PlacedNumbers;
use super::placed::{self, PlacedGroup};
use super::raw_scene::RawScene;
use super::ray::{ALL_GEOMETRY, OCCLUDING, without_hit};
use super::triangles::{self, TriangleMesh};
use super::{Device, EmbreeError, Hit, Ray, Width};
use base::stats::meter::{self, Query};
use embree4_sys as sys;
use glam::Vec3;

/// A bounding volume hierarchy, ready for queries from any thread.
pub struct Accel {
    scene: RawScene,
    bounds: Option<(Vec3, Vec3)>,
    /// Numbers of the seen meshes, if there are groups.
    numbers: Option<PlacedNumbers>,
    widest: Width,
    device: Device,
}

// SAFETY: a committed scene is not changed any more, and Embree allows queries of it, and its release,
// from any thread.
unsafe impl Send for Accel {}
// SAFETY: as above; all methods take `&self` and only query.
unsafe impl Sync for Accel {}

impl Accel {
    /// Builds with all threads of `device`.
    ///
    /// Ids in hits are indices into `meshes` and into a mesh's `triangles`. Meshes without triangles keep their index
    /// and are never hit. Vertices are copied.
    ///
    /// # Errors
    /// If a triangle refers to a missing vertex, or has a coordinate for which Embree would silently ignore it. Also if
    /// Embree fails (memory).
    pub fn build(device: &Device, meshes: &[TriangleMesh]) -> Result<Accel, EmbreeError> {
        Accel::build_placed(device, meshes, &[])
    }

    /// Builds like [`Accel::build`], with groups of meshes that are seen at several places.
    ///
    /// # Errors
    /// Like [`Accel::build`].
    pub fn build_placed(
        device: &Device,
        meshes: &[TriangleMesh],
        groups: &[PlacedGroup],
    ) -> Result<Accel, EmbreeError> {
        triangles::check(meshes.iter().chain(groups.iter().flat_map(|group| group.meshes)))?;
        let scene = RawScene::new(device)?;
        for (id, mesh) in (0u32..).zip(meshes) {
            scene.attach(device, id, mesh)?;
        }
        let numbers = placed::attach(&scene, device, meshes.len(), groups)?;
        scene.commit(device)?;
        let bounds = scene.bounds();
        Ok(Accel { scene, bounds, numbers, widest: device.widest_packets(), device: device.clone() })
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
        let trace = || unsafe { sys::rtcIntersect1(self.scene(), &mut rayhit, std::ptr::null_mut()) };
        meter::query(Query::Hits, || 1, trace);
        let hit = &rayhit.hit;
        (hit.geomID != sys::RTC_INVALID_GEOMETRY_ID).then_some(Hit {
            t: rayhit.ray.tfar,
            u: hit.u,
            v: hit.v,
            geometry: match &self.numbers {
                None => hit.geomID,
                Some(numbers) => numbers.number(hit.geomID, hit.instID[0], hit.instPrimID[0]),
            },
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
        let trace = || unsafe { sys::rtcOccluded1(self.scene(), &mut shadow_ray, std::ptr::null_mut()) };
        meter::query(Query::Shadows, || 1, trace);
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

    #[inline]
    pub(super) fn scene(&self) -> sys::RTCScene {
        self.scene.handle()
    }

    /// Returns the numbers of the seen meshes, if there are groups.
    #[inline]
    pub(super) fn placed_numbers(&self) -> Option<&PlacedNumbers> {
        self.numbers.as_ref()
    }
}
