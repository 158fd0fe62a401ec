//! Removal and repair of invalid scene content, with one report.
//!
//! - Triangles that no ray can hit are dropped.
//! - Invalid normals are replaced by geometric ones.
//! - Lights without power are dropped.
//! - Reflectances that would create energy are clamped.
//! - Negative light is an error, because no image could be computed from it.

mod attributes;
mod cameras;
mod lights;
mod losses;
mod materials;
mod meshes;
mod places;
mod reach;
mod report;
mod texels;

use super::coincident::drop_coincident_emitters;
use super::framing;
use crate::draft::{Draft, DraftMesh};
use crate::error::{Log, SceneError};
use crate::local::LocalCoordinates;
use attributes::repair_attributes;
use glam::{Vec2, Vec4};
use lights::{check_lights, fit_light_texels};
use losses::Losses;
use materials::check_material;
use meshes::{drop_rounded, drop_unusable, repair_normals, use_all_vertices};
use places::{drop_places, set_coordinates};
use scene::{AttributeTexture, Scene};
use std::iter;
use texels::TexelLimits;

pub(crate) use cameras::check_camera;
pub use report::SanitizeReport;

/// Fraction of triangles that may vanish by rounding without a warning. Fine models lose some.
const MAX_LOST: f64 = 0.01;

/// Repairs the draft, and moves a camera with `fits`; returns the report and the local coordinates.
pub(crate) fn sanitize(
    draft: &mut Draft,
    log: &mut Log,
) -> Result<(SanitizeReport, LocalCoordinates), SceneError> {
    let (mut report, mut losses) = (SanitizeReport::default(), Losses::default());
    for mesh in &mut draft.meshes {
        let before = report;
        drop_unusable(mesh, &mut report);
        losses.note(&mesh.name, &before, &report);
    }
    drop_coincident_emitters(draft, &draft.main_file(), log)?;
    set_coordinates(draft);
    let coordinates = LocalCoordinates::around(draft);
    let (mut lost, mut triangles) = drop_places(draft, &coordinates, &mut report);
    for mesh in &mut draft.meshes {
        let before = report;
        let group = mesh.group.and_then(|group| draft.groups.get(group));
        triangles += mesh.triangles.len();
        lost += drop_rounded(mesh, group.map_or(&coordinates, |group| &group.coordinates), &mut report);
        use_all_vertices(mesh);
        repair_normals(mesh, &mut report);
        repair_coordinates(mesh, &mut report);
        report.turned += mesh.turned;
        losses.note(&mesh.name, &before, &report);
    }
    losses.write(&report, &draft.main_file(), log)?;
    if lost as f64 > MAX_LOST * triangles as f64 {
        let what = format!(
            "{lost} triangles are too small for their distance from the camera or the scene's middle"
        );
        log.warn(
            &draft.main_file(),
            what,
            "they are left out; move distant parts of the scene closer together",
        )?;
    }
    for mesh in draft.meshes.iter().filter(|mesh| mesh.triangles.is_empty() && mesh.emission.is_some()) {
        let what = format!("the emitter \"{}\" has no triangle with an area", mesh.name);
        log.warn(&draft.main_file(), what, "it gives no light; repair its mesh or transform")?;
    }
    let before = draft.meshes.len();
    draft.meshes.retain(|mesh| !mesh.triangles.is_empty());
    report.empty_meshes = before - draft.meshes.len();
    check_materials(draft, &mut report, log)?;
    repair_attributes(draft, &mut report, log)?;
    if let Some(texture) = draft.scene.textures.iter().find(|texture| !texture.to_uv.is_finite()) {
        let what = format!("the texture transform of the image \"{}\" overflows", texture.name);
        log.part::<()>(Err(draft.main_file().wrong(what, "correct its transform")));
    }
    framing::frame(draft, coordinates.centre);
    let place = draft.main_file();
    let mut cameras = iter::once(&draft.shot.camera).chain(&draft.shot.path);
    let checked = cameras.try_for_each(|camera| check_camera(camera, &coordinates, &place));
    log.part(checked);
    let checked = check_lights(draft, &coordinates, &mut report);
    log.conclude(checked)?;
    Ok((report, coordinates))
}

/// Checks materials, and limits the texels of all surfaces and lights.
fn check_materials(draft: &mut Draft, report: &mut SanitizeReport, log: &mut Log) -> Result<(), SceneError> {
    let main_file = draft.main_file();
    let Scene { materials, textures, .. } = &mut draft.scene;
    let mut texels = TexelLimits::new(textures);
    for (i, material) in materials.iter_mut().enumerate() {
        let place = draft.material_places.get(i).unwrap_or(&main_file);
        let checked = check_material(material, &mut texels, place, report, log);
        log.part(checked);
    }
    let mut attributes: Vec<AttributeTexture> = textures.attributes().to_vec();
    attributes.iter_mut().for_each(|of| texels.fit_image(of, &main_file, report));
    fit_light_texels(&mut draft.meshes, &mut draft.lights, &mut texels, &main_file, report);
    let (copies, remarks) = texels.finish();
    remarks.into_iter().try_for_each(|remark| log.add(remark))?;
    if !copies.is_empty() {
        textures.add(copies);
        *textures = std::mem::take(textures).with_attributes(attributes);
    }
    Ok(())
}

/// Sets texture coordinates and tangents that are not finite to zero.
fn repair_coordinates(mesh: &mut DraftMesh, report: &mut SanitizeReport) {
    let bad_uvs = mesh.uvs.iter_mut().filter(|uv| !uv.is_finite());
    report.bad_uvs += bad_uvs.map(|uv| *uv = Vec2::ZERO).count();
    let bad_tangents = mesh.tangents.iter_mut().filter(|tangent| !tangent.is_finite());
    report.bad_tangents += bad_tangents.map(|tangent| *tangent = Vec4::ZERO).count();
}

#[cfg(test)]
mod tests;
