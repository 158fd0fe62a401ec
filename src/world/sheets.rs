//! Sheets: surfaces that light passes straight through, such as thin panes and those with gaps, and that shadow rays
//! pass with it.
//!
//! Queries for occlusion leave sheets out; the light of segments found free takes the colour of the sheets that they
//! cross, each of them once, in order.

use super::{World, triangle_meshes};
use crate::embree::{Accel, EmbreeError, Ray, Rays16};
use crate::material::Materials;
use crate::math::{Rgb, lanes_in};
use crate::scene::Scene;
use glam::Vec3;

/// Maximum number of sheets that a segment crosses; it is blocked by more.
const MAX_CROSSED: u32 = 64;

/// Distance by which a ray goes on behind a sheet, in units of the last place of the largest coordinate: that by which
/// rays start off their surfaces.
const ULPS: f32 = 8.0;

/// The rest of a ray behind the surface point `position` on it, of parameter `t` and geometric normal `normal`.
#[inline]
pub fn beyond(ray: &Ray, position: Vec3, normal: Vec3, t: f32) -> Ray {
    let length = ray.direction.length();
    let largest = position.abs().max(ray.origin.abs()).max_element().max(t * length);
    // A ray that grazes a sheet goes on at a hundred times that distance at most.
    let cos = normal.dot(ray.direction).abs().max(0.01 * length);
    Ray { t_near: t + largest * (ULPS * f32::EPSILON) / cos, ..*ray }
}

/// The sheets of a scene beside the structure `whole` over all its meshes; `None` if there are none.
pub(super) fn sheets(
    scene: &Scene,
    materials: &Materials,
    whole: &Accel,
) -> Result<Option<Accel>, EmbreeError> {
    let mut meshes = triangle_meshes(scene, materials);
    if meshes.iter().all(|mesh| mesh.occludes) {
        return Ok(None);
    }
    // Meshes keep their numbers.
    meshes.iter_mut().filter(|mesh| mesh.occludes).for_each(|mesh| mesh.triangles = &[]);
    Accel::build(whole.device(), &meshes).map(Some)
}

impl World {
    /// True if there are sheets.
    #[inline]
    pub(crate) fn has_sheets(&self) -> bool {
        self.sheets.is_some()
    }

    /// Share of the light that comes along a segment on which nothing occludes it.
    pub(crate) fn transmittance(&self, segment: &Ray) -> Rgb {
        let mut transmittance = Rgb::ONE;
        let Some(sheets) = &self.sheets else { return transmittance };
        let mut rest = *segment;
        for _ in 0..MAX_CROSSED {
            let Some(hit) = sheets.closest_hit(&rest) else { return transmittance };
            let surface = self.surface(&hit);
            let out = surface.frame.to_local(-segment.direction.normalize());
            transmittance *= self.bsdf(&surface).straight_transmittance(out);
            if transmittance == Rgb::ZERO {
                break;
            }
            rest = beyond(&rest, surface.position, surface.normal, surface.t);
        }
        Rgb::ZERO
    }

    /// Calls `through` with the lanes of `lanes` whose segments cross sheets and [`World::transmittance`] there.
    #[inline]
    pub(crate) fn transmittance16(&self, segments: &Rays16, lanes: u16, mut through: impl FnMut(usize, Rgb)) {
        if self.has_sheets() {
            lanes_in(lanes).for_each(|lane| through(lane, self.transmittance(&segments.get(lane))));
        }
    }
}
