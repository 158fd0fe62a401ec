//! Report of textures on meshes without texture coordinates.

use crate::decode::DecodedImage;
use crate::draft::DraftMesh;
use crate::error::{Location, Log, SceneError};
use crate::findings::listed;
use crate::instances::ReadPlan;
use crate::plan::{Contents, MeshPlan, TextureSource};
use scene::{Relief, TextureId};

/// Maximum number of meshes that a message lists.
const MAX_LISTED: usize = 4;

/// Meshes of one description that lack texture coordinates.
struct MeshesWithoutUvs<'a> {
    place: &'a Location,
    /// True if Mitsuba, too, takes barycentric coordinates.
    is_modelled: bool,
    names: Vec<&'a str>,
}

/// Reports meshes whose triangles lack the texture coordinates that their textures need; `meshes` are those of each
/// plan.
pub(crate) fn report(
    contents: &Contents,
    meshes: &[ReadPlan],
    images: &[Option<DecodedImage>],
    log: &mut Log,
) -> Result<(), SceneError> {
    let mut findings: Vec<MeshesWithoutUvs> = Vec::new();
    let needs = |plan: &MeshPlan, mesh: &DraftMesh| {
        let textures = textures(contents, plan, mesh);
        textures.into_iter().any(|texture| varies(contents, images, texture))
    };
    for (plan, ReadPlan { meshes, .. }) in contents.meshes.iter().zip(meshes) {
        let is_modelled = plan.placement.needs_uv && meshes.iter().all(|mesh| !mesh.uvs.is_empty());
        let lacking = meshes.iter().filter(|mesh| mesh.lacks_uvs && !mesh.triangles.is_empty());
        for mesh in lacking.filter(|mesh| needs(plan, mesh)) {
            match findings.iter_mut().find(|f| *f.place == plan.place && f.is_modelled == is_modelled) {
                Some(finding) => finding.names.push(&mesh.name),
                None => findings.push(MeshesWithoutUvs {
                    place: &plan.place,
                    is_modelled,
                    names: vec![&mesh.name],
                }),
            }
        }
    }
    for MeshesWithoutUvs { place, is_modelled, mut names } in findings {
        names.dedup();
        let names: Vec<String> = names.iter().map(|name| format!("\"{name}\"")).collect();
        let names = listed(&names, MAX_LISTED);
        let what = format!("triangles lack texture coordinates, which their textures need: {names}");
        match is_modelled {
            true => log.note(place, what, "each shows half of its texture, as in Mitsuba"),
            false => log.warn(place, what, "one part of the texture is used; export texture coordinates")?,
        }
    }
    Ok(())
}

/// Returns the textures on a mesh.
fn textures(contents: &Contents, plan: &MeshPlan, mesh: &DraftMesh) -> Vec<TextureId> {
    let emission = plan.emission.or(mesh.emission).and_then(|emission| emission.texture);
    let mut all = Vec::from_iter(emission);
    if let Some(material) = contents.materials.get(mesh.material.0 as usize) {
        all.extend(material.textures());
        all.extend(material.parts().filter_map(|part| part.relief).map(|relief| match relief {
            Relief::Normals { texture, .. } | Relief::Heights { texture, .. } => texture,
        }));
    }
    all
}

/// True if a texture has more than one colour in texture coordinates.
fn varies(contents: &Contents, images: &[Option<DecodedImage>], texture: TextureId) -> bool {
    let image_of = |number: usize| contents.attribute_textures.get(number).and_then(|texture| texture.image);
    let Some(texture) = texture.attribute_number().map_or(Some(texture), image_of) else { return false };
    let at = texture.0 as usize;
    let image = match contents.textures.get(at).map(|plan| &plan.image) {
        Some(TextureSource::Ready(_, image)) => Some(image),
        _ => images.get(at).and_then(Option::as_ref),
    };
    image.is_some_and(|image| {
        let first = image.texels.get(0, 0);
        !image.texels.all(|texel| texel == first)
    })
}
