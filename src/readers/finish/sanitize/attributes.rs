//! Repairs of the values of attributes. Those that would create energy are clamped, as texels are.

use super::materials::{clamp_texels, clamp_value};
use super::report::SanitizeReport;
use crate::draft::Draft;
use base::math::Rgb;
use scene::{AttributeId, Material, Parameter, TextureId, Textures};

/// Use of an attribute by a material, and the greatest value that it may have there.
struct AttributeUse {
    attribute: AttributeId,
    limit: Rgb,
}

/// Repairs the attributes of all meshes, and clamps the images that materials multiply with them.
pub(super) fn repair_attributes(draft: &mut Draft, report: &mut SanitizeReport) {
    if draft.attribute_names.is_empty() {
        return;
    }
    let textures = &mut draft.scene.textures;
    let uses: Vec<Vec<AttributeUse>> =
        draft.scene.materials.iter().map(|material| uses(material, textures, report)).collect();
    let names = &draft.attribute_names;
    for mesh in &mut draft.meshes {
        let of_material = uses.get(mesh.material.0 as usize);
        for attribute in &mut mesh.attributes {
            let is_it = |of: &&AttributeUse| names.get(of.attribute.0 as usize) == Some(&attribute.name);
            let limits = of_material.into_iter().flatten().filter(is_it).map(|of| of.limit);
            let limit = limits.fold(Rgb::MAX, Rgb::min);
            attribute.values.all_mut().iter_mut().for_each(|value| clamp_value(value, limit, report));
        }
    }
}

/// Returns the attributes that a material uses, and clamps the images that it multiplies with them.
fn uses(material: &Material, textures: &mut Textures, report: &mut SanitizeReport) -> Vec<AttributeUse> {
    let mut material = material.clone();
    let mut factors: Vec<(TextureId, Rgb)> = Vec::new();
    for parameter in material.reflectances_mut() {
        if let Parameter::Textured { texture, scale } = *parameter {
            factors.push((texture, scale));
        }
    }
    let numbers = material.shares_mut().into_iter().map(|share| *share);
    let numbers: Vec<Parameter<f32>> = numbers.collect();
    for parameter in numbers.into_iter().chain(material.alphas_mut().into_iter().map(|alpha| *alpha)) {
        if let Parameter::Textured { texture, scale } = parameter {
            factors.push((texture, Rgb::splat(scale)));
        }
    }
    let mut uses = Vec::new();
    for (texture, scale) in factors {
        let Some(found) = textures.attribute(texture).copied() else { continue };
        uses.push(AttributeUse { attribute: found.attribute, limit: scale.max(Rgb::ONE).recip() });
        if let Some(image) = found.image.and_then(|image| textures.edit().get_mut(image.0 as usize)) {
            clamp_texels(image, Rgb::ONE, report);
        }
    }
    uses
}
