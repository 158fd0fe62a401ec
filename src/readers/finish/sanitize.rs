//! Removal and repair of invalid scene content before anything else uses it, with one report.
//!
//! Triangles that no ray could meaningfully hit are dropped, invalid normals are replaced by the geometric
//! ones, lights without power are dropped, reflectances that would create energy are clamped. Negative light is an
//! error: no picture could be computed from it.

mod lights;
mod materials;

use super::coincident::drop_coincident_emitters;
use super::framing;
use super::recentre::Coordinates;
use crate::draft::{Draft, DraftCamera, DraftMesh};
use crate::error::{Log, Place, SceneError};
use glam::{DVec3, Vec2, Vec3};
use lights::check_lights;
use materials::check_material;
use scene::{PixelFilter, Projection};
use serde::Serialize;
use std::fmt;
use std::iter;
use std::path::PathBuf;

/// Maximum coordinate, in the files' unit and in that of the rendered scene; Embree silently drops triangles beyond
/// 1.8e18.
const HUGE: f64 = 1e18;
/// Remedy for what is beyond it.
const IN_REACH: &str = "keep within 1e18 of the origin, and within 1e18 times the scene's size of it";
/// Share of triangles that may vanish by rounding without a warning: those of fine models now and then do.
const MANY_LOST: f64 = 0.01;
/// Maximum width of a pixel filter, in pixels.
const MAX_FILTER: f32 = 1e3;

/// Counts of removals and repairs.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct SanitizeReport {
    /// Triangles with a vertex index out of range.
    pub out_of_range: usize,
    /// Triangles with NaN or infinite corners.
    pub not_finite: usize,
    /// Triangles with coordinates beyond 1e18, or beyond 1e18 times the size of what is around the camera.
    pub huge: usize,
    /// Triangles with two equal indices, or without area in f32.
    pub degenerate: usize,
    /// Meshes without a triangle left.
    pub empty_meshes: usize,
    /// Zero or NaN vertex normals, replaced by the geometric ones.
    pub bad_normals: usize,
    /// Triangles whose winding was reversed to agree with their vertex normals.
    pub turned: usize,
    /// NaN or infinite texture coordinates, set to 0.
    pub bad_uvs: usize,
    /// Reflectances clamped to 1, and texels clamped to values that cannot create energy.
    pub clamped: usize,
    /// NaN, infinite or negative texels, set to 0.
    pub bad_texels: usize,
    /// Emitters, lights and environments without light, dropped.
    pub black_lights: usize,
}

impl SanitizeReport {
    /// True if nothing was removed or repaired.
    pub fn is_clean(&self) -> bool {
        *self == SanitizeReport::default()
    }
}

impl fmt::Display for SanitizeReport {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let counts = [
            (self.out_of_range, "triangles with indices out of range dropped"),
            (self.not_finite, "triangles with NaN or infinite corners dropped"),
            (self.huge, "triangles beyond 1e18 dropped"),
            (self.degenerate, "triangles without area dropped"),
            (self.empty_meshes, "empty meshes dropped"),
            (self.bad_normals, "zero or NaN normals replaced"),
            (self.turned, "triangles turned to face along their vertex normals"),
            (self.bad_uvs, "NaN texture coordinates set to 0"),
            (self.clamped, "reflectances clamped"),
            (self.bad_texels, "NaN or negative texels set to 0"),
            (self.black_lights, "lights without light dropped"),
        ];
        let said: Vec<String> =
            counts.iter().filter(|(n, _)| *n > 0).map(|(n, what)| format!("{n} {what}")).collect();
        if said.is_empty() { write!(f, "nothing to repair") } else { write!(f, "{}", said.join(", ")) }
    }
}

/// Cleans the draft, and places a camera that is to see everything; returns the report and the coordinates to render it
/// in.
pub(crate) fn sanitize(
    draft: &mut Draft,
    log: &mut Log,
) -> Result<(SanitizeReport, Coordinates), SceneError> {
    let mut report = SanitizeReport::default();
    for mesh in &mut draft.meshes {
        drop_unusable(mesh, &mut report);
    }
    drop_coincident_emitters(draft, &main_file(&draft.sources), log)?;
    let coordinates = Coordinates::of(draft);
    let (mut lost, mut triangles) = (0, 0);
    for mesh in &mut draft.meshes {
        triangles += mesh.triangles.len();
        lost += drop_rounded(mesh, &coordinates, &mut report);
        use_all_vertices(mesh);
        repair_normals(mesh, &mut report);
        let bad_uvs = mesh.uvs.iter_mut().filter(|uv| !uv.is_finite());
        report.bad_uvs += bad_uvs.map(|uv| *uv = Vec2::ZERO).count();
        report.turned += mesh.turned;
    }
    if lost as f64 > MANY_LOST * triangles as f64 {
        let what = format!(
            "{lost} triangles are too small for their distance from the camera or the scene's middle"
        );
        log.warn(
            &main_file(&draft.sources),
            what,
            "they are left out; move what lies far apart closer together",
        )?;
    }
    for mesh in draft.meshes.iter().filter(|mesh| mesh.triangles.is_empty() && mesh.emission.is_some()) {
        let what = format!("the emitter \"{}\" has no triangle with an area", mesh.name);
        log.warn(&main_file(&draft.sources), what, "it gives no light; repair its mesh or transform")?;
    }
    let before = draft.meshes.len();
    draft.meshes.retain(|mesh| !mesh.triangles.is_empty());
    report.empty_meshes = before - draft.meshes.len();
    let place = |i: usize| draft.material_places.get(i).cloned().unwrap_or_else(|| main_file(&draft.sources));
    for (i, material) in draft.materials.iter_mut().enumerate() {
        let checked = check_material(material, &mut draft.textures, &place(i), &mut report, log);
        log.part(checked);
    }
    if let Some(texture) = draft.textures.iter().find(|texture| !texture.to_uv.is_finite()) {
        let what = format!("the picture \"{}\" is moved or scaled beyond all numbers", texture.name);
        log.part::<()>(Err(main_file(&draft.sources).wrong(what, "correct its transform")));
    }
    framing::frame(draft, coordinates.centre);
    let mut cameras = iter::once(&draft.shot.camera).chain(&draft.shot.path);
    let checked = cameras.try_for_each(|camera| check_camera(camera, &coordinates, &draft.sources));
    log.part(checked);
    let checked = check_lights(draft, &coordinates, &mut report);
    log.conclude(checked)?;
    Ok((report, coordinates))
}

fn main_file(sources: &[PathBuf]) -> Place {
    Place { path: sources.first().cloned().unwrap_or_default(), line: None }
}

/// Drops triangles with impossible corners, and those that have no area.
fn drop_unusable(mesh: &mut DraftMesh, report: &mut SanitizeReport) {
    let positions = &mesh.positions;
    mesh.triangles.retain(|t| {
        let [Some(&a), Some(&b), Some(&c)] = t.map(|i| positions.get(i as usize)) else {
            report.out_of_range += 1;
            return false;
        };
        let corners = [a, b, c];
        if !corners.iter().all(|p| p.is_finite()) {
            report.not_finite += 1;
            return false;
        }
        if corners.iter().any(|p| p.abs().max_element() > HUGE) {
            report.huge += 1;
            return false;
        }
        report.degenerate += usize::from(!has_area(corners));
        has_area(corners)
    });
}

fn has_area([a, b, c]: [DVec3; 3]) -> bool {
    (b - a).cross(c - a) != DVec3::ZERO
}

/// Drops triangles that have no area once their corners are rounded to f32, or lie beyond its reach; returns their
/// number.
fn drop_rounded(mesh: &mut DraftMesh, coordinates: &Coordinates, report: &mut SanitizeReport) -> usize {
    let positions = &mesh.positions;
    let local = |i: u32| positions.get(i as usize).map_or(Vec3::INFINITY, |p| coordinates.local(*p));
    let before = mesh.triangles.len();
    mesh.triangles.retain(|t| {
        let corners = t.map(local);
        let is_huge = corners.iter().any(|p| !(p.abs().max_element() <= HUGE as f32));
        let is_degenerate = !is_huge && !has_area(corners.map(|p| p.as_dvec3()));
        report.huge += usize::from(is_huge);
        report.degenerate += usize::from(is_degenerate);
        !is_huge && !is_degenerate
    });
    before - mesh.triangles.len()
}

/// Drops vertices that no triangle uses, and attributes that are not present for every vertex.
fn use_all_vertices(mesh: &mut DraftMesh) {
    let count = mesh.positions.len();
    if mesh.normals.len() != count {
        mesh.normals.clear();
    }
    if mesh.uvs.len() != count {
        mesh.uvs.clear();
    }
    let mut renumbered = vec![u32::MAX; count];
    mesh.triangles.iter().flatten().for_each(|&i| renumbered[i as usize] = 0);
    if !renumbered.contains(&u32::MAX) {
        return;
    }
    for (next, number) in (0..).zip(renumbered.iter_mut().filter(|n| **n == 0)) {
        *number = next;
    }
    let used = |i: usize| renumbered[i] != u32::MAX;
    keep(&mut mesh.positions, used);
    keep(&mut mesh.normals, used);
    keep(&mut mesh.uvs, used);
    mesh.triangles.iter_mut().flatten().for_each(|i| *i = renumbered[*i as usize]);
}

fn keep<T>(values: &mut Vec<T>, wanted: impl Fn(usize) -> bool) {
    let mut i = 0;
    values.retain(|_| {
        i += 1;
        wanted(i - 1)
    });
}

fn repair_normals(mesh: &mut DraftMesh, report: &mut SanitizeReport) {
    let bad = |n: &Vec3| !n.is_finite() || n.length_squared() < 0.25;
    if !mesh.normals.iter().any(bad) {
        return;
    }
    let geometric = crate::smooth_normals(&mesh.positions, &mesh.triangles);
    for (normal, geometric) in mesh.normals.iter_mut().zip(geometric) {
        if bad(normal) {
            report.bad_normals += 1;
            // Where faces cancel, any unit vector will do.
            *normal = if geometric == Vec3::ZERO { Vec3::Z } else { geometric };
        }
    }
}

/// True if a position is within reach of `f32`.
fn is_within_reach(world: DVec3, coordinates: &Coordinates) -> bool {
    world.abs().max_element() <= HUGE && coordinates.local(world).abs().max_element() <= HUGE as f32
}

/// Rejects cameras whose rays `f32` cannot hold.
fn check_camera(
    camera: &DraftCamera,
    coordinates: &Coordinates,
    sources: &[PathBuf],
) -> Result<(), SceneError> {
    let place = main_file(sources);
    if !is_within_reach(camera.origin, coordinates) {
        return Err(place.wrong(format!("a camera stands at {}", camera.origin), IN_REACH));
    }
    let camera = coordinates.local_camera(camera);
    let lens = match camera.projection {
        Projection::Lens { radius, distance } => [radius, distance],
        Projection::Pinhole | Projection::Parallel => [1.0; 2],
    };
    let is_length = |length: f32| length > 0.0 && length <= HUGE as f32;
    if !is_length(camera.tan_half_x) || !lens.into_iter().all(is_length) || camera.near > HUGE as f32 {
        let what = "a camera's film, lens, focus or near plane is no size";
        return Err(place.wrong(what, "give numbers above 0, up to 1e18 times the scene's size"));
    }
    let (PixelFilter::Tent { radius: width } | PixelFilter::Gaussian { deviation: width }) = camera.filter
    else {
        return Ok(());
    };
    match width > 0.0 && width <= MAX_FILTER {
        true => Ok(()),
        false => {
            Err(place
                .wrong(format!("the film's filter is {width} pixels wide"), "give more than 0, up to 1000"))
        }
    }
}

#[cfg(test)]
mod tests;
