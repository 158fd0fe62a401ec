//! Repairs of the values of attributes. Those that would create energy are clamped, as texels are.

use super::report::SanitizeReport;
use super::texels::clamp_value;
use crate::draft::Draft;
use crate::error::{Log, SceneError};
use base::math::Rgb;
use scene::{AttributeId, Material, Parameter, TextureId, Textures};

/// Use of an attribute by a material, and the greatest value that it may have there.
struct AttributeUse {
    attribute: AttributeId,
    limit: Rgb,
}

/// Repairs the attributes of all meshes, and names values that are no numbers or negative.
pub(super) fn repair_attributes(
    draft: &mut Draft,
    report: &mut SanitizeReport,
    log: &mut Log,
) -> Result<(), SceneError> {
    if draft.attribute_names.is_empty() {
        return Ok(());
    }
    let textures = &draft.scene.textures;
    let uses: Vec<Vec<AttributeUse>> =
        draft.scene.materials.iter().map(|material| uses(material, textures)).collect();
    let (names, place) = (&draft.attribute_names, draft.main_file());
    for mesh in &mut draft.meshes {
        let of_material = uses.get(mesh.material.0 as usize);
        for attribute in &mut mesh.attributes {
            let is_it = |of: &&AttributeUse| names.get(of.attribute.0 as usize) == Some(&attribute.name);
            let limits = of_material.into_iter().flatten().filter(is_it).map(|of| of.limit);
            let limit = limits.fold(Rgb::MAX, Rgb::min);
            let before = report.bad_texels;
            attribute.values.all_mut().iter_mut().for_each(|value| clamp_value(value, limit, report));
            if report.bad_texels > before {
                let count = report.bad_texels - before;
                let what = format!(
                    "mesh \"{}\": {count} values of the attribute \"{}\" are infinite, negative or no numbers",
                    mesh.name, attribute.name
                );
                log.warn(
                    &place,
                    what,
                    "infinity counts as 65504 or the greatest value allowed, others as 0",
                )?;
            }
        }
    }
    Ok(())
}

/// Returns the attributes that a material uses.
fn uses(material: &Material, textures: &Textures) -> Vec<AttributeUse> {
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
    let of_factor = |(texture, scale): (TextureId, Rgb)| {
        let source = textures.attribute(texture)?;
        let limit = scale.max(Rgb::splat(f32::MIN_POSITIVE)).recip();
        Some(AttributeUse { attribute: source.attribute, limit })
    };
    factors.into_iter().filter_map(of_factor).collect()
}
