//! Report of textures on meshes without texture coordinates.

use crate::decode::DecodedImage;
use crate::draft::DraftMesh;
use crate::error::{Location, Log, SceneError};
use crate::plan::{Contents, MeshPlan, TextureSource};
use scene::{Lobe, Material, Parameter, Relief, TextureId};

/// Maximum number of meshes that a message lists.
const MAX_LISTED: usize = 4;

/// Meshes of one description that lack texture coordinates.
struct Finding<'a> {
    place: &'a Location,
    /// True if Mitsuba, too, takes barycentric coordinates.
    is_modelled: bool,
    names: Vec<&'a str>,
}

/// Reports meshes whose triangles lack the texture coordinates that their textures need; `meshes` are those of each
/// plan.
pub(crate) fn report(
    contents: &Contents,
    meshes: &[Vec<DraftMesh>],
    images: &[Option<DecodedImage>],
    log: &mut Log,
) -> Result<(), SceneError> {
    let mut findings: Vec<Finding> = Vec::new();
    let needs = |plan: &MeshPlan, mesh: &DraftMesh| {
        let textures = textures(contents, plan, mesh);
        textures.into_iter().any(|texture| varies(contents, images, texture))
    };
    for (plan, meshes) in contents.meshes.iter().zip(meshes) {
        let is_modelled = plan.placement.needs_uv && meshes.iter().all(|mesh| !mesh.uvs.is_empty());
        let lacking = meshes.iter().filter(|mesh| mesh.lacks_uvs && !mesh.triangles.is_empty());
        for mesh in lacking.filter(|mesh| needs(plan, mesh)) {
            match findings.iter_mut().find(|f| *f.place == plan.place && f.is_modelled == is_modelled) {
                Some(finding) => finding.names.push(&mesh.name),
                None => findings.push(Finding { place: &plan.place, is_modelled, names: vec![&mesh.name] }),
            }
        }
    }
    for Finding { place, is_modelled, mut names } in findings {
        names.dedup();
        let mut listed: Vec<String> =
            names.iter().take(MAX_LISTED).map(|name| format!("\"{name}\"")).collect();
        if names.len() > MAX_LISTED {
            listed.push(format!("{} more", names.len() - MAX_LISTED));
        }
        let what = format!("triangles lack the coordinates that their textures need: {}", listed.join(", "));
        match is_modelled {
            true => log.note(place, what, "each shows half of its texture, as in Mitsuba"),
            false => log.warn(place, what, "a part of the texture stands in; export texture coordinates")?,
        }
    }
    Ok(())
}

/// Returns the textures on a mesh.
fn textures(contents: &Contents, plan: &MeshPlan, mesh: &DraftMesh) -> Vec<TextureId> {
    let emission = plan.emission.or(mesh.emission).and_then(|emission| emission.texture);
    let material = contents.materials.get(mesh.material.0 as usize);
    let mut all: Vec<TextureId> = material.map(of_material).unwrap_or_default();
    all.extend(emission);
    all
}

fn of_material(material: &Material) -> Vec<TextureId> {
    let mut all = Vec::new();
    for part in material.parts() {
        let mut part = Material { blend: None, ..part.clone() };
        all.extend(part.reflectances_mut().into_iter().filter_map(|colour| texture(colour)));
        all.extend(part.shares_mut().into_iter().filter_map(|share| texture(share)));
        let of_lobe = |lobe: &Lobe| match lobe {
            Lobe::Rough { alpha, .. } | Lobe::RoughDielectric { alpha, .. } => texture(alpha),
            Lobe::Anisotropic { .. } | Lobe::Mirror { .. } | Lobe::Dielectric { .. } => None,
        };
        all.extend(part.lobes.iter().filter_map(of_lobe));
        all.extend(part.relief.map(|relief| match relief {
            Relief::Normals { texture, .. } | Relief::Heights { texture, .. } => texture,
        }));
    }
    // The weight of a mixture belongs to no part.
    let mut mixed = material.blend.as_deref();
    while let Some(blend) = mixed {
        all.extend(texture(&blend.weight));
        mixed = blend.other.blend.as_deref();
    }
    all
}

fn texture<T>(parameter: &Parameter<T>) -> Option<TextureId> {
    match parameter {
        Parameter::Constant(_) => None,
        Parameter::Textured { texture, .. } => Some(*texture),
    }
}

/// True if a texture has more than one colour.
fn varies(contents: &Contents, images: &[Option<DecodedImage>], texture: TextureId) -> bool {
    if let Some(number) = texture.attribute_number() {
        let image = contents.attribute_textures.get(number).and_then(|texture| texture.image);
        return image.is_some_and(|image| varies(contents, images, image));
    }
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
